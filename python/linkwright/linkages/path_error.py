"""How far a point of a mechanism passes from given points of a path, with its derivatives.

With crank angles the point is compared at those angles; without, at the nearest places of its curve over one
revolution, which follow one another in the order of the points, in either direction
(`linkwright.linkages.nearest_places`). There the place moves along the curve at most, which changes the
distance in second order only: the derivatives are those at fixed crank angles.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike

from linkwright.kernel.arrays import Complexes, Floats
from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import FindingError, MachineError, Problem, ShapeError, show
from linkwright.kernel.public import public
from linkwright.kernel.public.arguments import array
from linkwright.kernel.quantities import Label
from linkwright.kernel.result import Result
from linkwright.linkages.closure import require_closed
from linkwright.linkages.kinematics import checked_angles, motions, rows_along
from linkwright.linkages.nearest_places import TURN, ClosedCurves, nearest_in_order
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine

# Steps of the crank per revolution between which curves are interpolated.
_STEPS = 360

# Machines whose curves are in memory at once.
_TOGETHER = 500

# Gap of a curve over its size after a revolution that is rounding.
_GAP = 1e-9

# What a curve does that does not close after a revolution.
UNCLOSED = "the curve does not close after one revolution of the crank; give crank_angle"


@dataclass(frozen=True)
class PathError(Result):
    """Distances of a point of a mechanism from given points of a path."""

    error_rms: Annotated[
        float, Label("root-mean-square distance of the points from the curve", "", "m", "Path error.")
    ]
    error_max: Annotated[float, Label("maximum distance of the points from the curve", "", "m")]
    crank_angle: Annotated[
        Floats, Label("crank angle at each point", "", "rad", "Given, or of the nearest place.")
    ]
    error: Annotated[Floats, Label("distance of each point from the curve", "", "m")]
    x: Annotated[Floats, Label("x of the point at these crank angles", "", "m")]
    y: Annotated[Floats, Label("y of the point at these crank angles", "", "m")]


@public
def path_error(
    machine: Machine, point: str, x: ArrayLike, y: ArrayLike, crank_angle: ArrayLike | None = None
) -> PathError:
    """Distances of a point of a mechanism from given points of a path.

    Parameters
    ----------
    machine : Machine
        Any mechanism with a crank.
    point : str
        Name of its point.
    x, y : array_like, shape (n,)
        The points in their order [m].
    crank_angle : array_like, shape (n,), optional
        Crank angle at each point [rad]. Without them each point is compared with the nearest place of the
        curve over one revolution; the places follow one another in the order of the points, in either
        direction.

    Returns
    -------
    PathError

    Raises
    ------
    MachineError
        There is no such point.
    ShapeError
        The lists have not one number for each point.
    AssemblyError
        The links do not close at one of the crank angles, without them at some.
    FindingError
        Without crank angles: the curve does not close after one revolution.
    """
    targets, angles = _targets(x, y, crank_angle)
    _require_point(machine, point)
    places, phi = places_near(machine, point, targets, angles)
    if not np.isfinite(places).all():
        turn = np.linspace(0.0, TURN, _STEPS + 1) if angles is None else angles
        require_closed(compile_machine(machine), machine, turn)
        raise FindingError(UNCLOSED)
    error = np.abs(places[0] - targets)
    rms, most = float(np.sqrt((error**2).mean())), float(error.max())
    return PathError(rms, most, phi[0].copy(), error, places[0].real.copy(), places[0].imag.copy())


def places_near(
    machines: Machine, point: str, targets: Complexes, angles: Floats | None
) -> tuple[Complexes, Floats]:
    """Places x + i y of a point of one or many machines that belong to points of a path, and crank angles.

    `targets` (n,) [m]; `angles` (n,) [rad], or None for the nearest places in order. Returns: (rows, n) [m],
    NaN where a machine does not close or its curve does not; (rows, n) [rad].
    """
    if angles is not None:
        table = motions(machines, angles, points=[point])
        return table[:, 0] + 1j * table[:, 1], np.broadcast_to(angles, (len(table), len(angles)))
    turn = np.linspace(0.0, TURN, _STEPS + 1)
    table = motions(machines, turn, points=[point])
    x, y = table[:, ::2], table[:, 1::2]
    known = x + 1j * y
    ends = np.abs(known[:, 0, -1] - known[:, 0, 0])
    size = np.maximum(np.ptp(x[:, 0], axis=-1), np.ptp(y[:, 0], axis=-1))
    closed = np.flatnonzero(np.isfinite(known).all(axis=(1, 2)) & (ends <= _GAP * size))
    places = np.full((len(known), len(targets)), complex(np.nan, np.nan))
    phi = np.full(places.shape, np.nan)
    for start in range(0, len(closed), _TOGETHER):
        rows = closed[start : start + _TOGETHER]
        curves = ClosedCurves(*np.moveaxis(known[rows, :, :-1], 1, 0))
        phi[rows] = nearest_in_order(curves, targets)
        places[rows] = curves.at(phi[rows])[0]
    return places, phi


def places_along(machine: Machine, point: str, angles: Floats, directions: Floats) -> Complexes:
    """Derivatives of the places of a point at fixed crank angles by directions (parameters, k), (n, k).

    `angles` (n,) [rad]; `directions`: of the numbers of the program, one column each.
    """
    rows = rows_along(compile_machine(machine), checked_angles(angles), [("points", point)], directions)
    return np.asarray(rows[0] + 1j * rows[1])


def _targets(x: ArrayLike, y: ArrayLike, crank_angle: ArrayLike | None) -> tuple[Complexes, Floats | None]:
    """Points of a path x + i y, and their crank angles, (n,) each."""
    lists: dict[str, Floats] = {"x": array("x", x), "y": array("y", y)}
    if crank_angle is not None:
        lists["crank_angle"] = array("crank_angle", crank_angle)
    n = lists["x"].size
    for name, given in lists.items():
        if given.ndim != 1 or len(given) != n or not n:
            expected = f"a list of {n} numbers, one a point" if n and name != "x" else "a list of numbers"
            raise ShapeError(f"{name}: found an array of shape {given.shape}, expected {expected}")
    return lists["x"] + 1j * lists["y"], lists.get("crank_angle")


def _require_point(machine: Machine, point: str) -> None:
    points: Sequence[str] = list(compile_machine(machine).points)
    if point not in points:
        remedy = suggestion(point, points)
        raise MachineError([Problem("point", show(point), f"one of {', '.join(points)}", remedy)])
