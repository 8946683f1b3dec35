"""Minimum distance of points of two axes over the cycle, and the shift that keeps a wanted one.

An axis that starts earlier while the other is still on its way shortens the cycle: the usual gain of output.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import InputError, show
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.kernel.units.kinds import LENGTH
from linkwright.kernel.units.marks import positive
from linkwright.linkages.closure import require_full_turn
from linkwright.linkages.whole_cycle import over_whole_motion
from linkwright.machine.machine import Machine
from linkwright.machine.own_motors import axis_drivers
from linkwright.machine.program.compiled import CompiledMachine, compile_machine
from linkwright.machine.whole_mechanism import topology_of

# Angles of a revolution at which distances are looked at, shifts that are tried, halvings of the last step.
_ANGLES, _SHIFTS, _HALVINGS = 1440, 720, 40


@dataclass(frozen=True)
class Clearance(Result):
    """Distance of two points over the cycle, and the shift of the second's axis that keeps a wanted one."""

    crank_angle: Annotated[Floats, Label("master angle", "φ", "rad")]
    distance: Annotated[Floats, Label("distance of the points", "d", "m")]
    distance_min: Annotated[float, Label("minimum distance", "d_min", "m", table="clearance")]
    distance_min_angle: Annotated[float, Label("master angle of the minimum distance", "", "rad")]
    wanted: Annotated[float | None, Label("wanted distance", "", "m", table="clearance")]
    earlier: Annotated[
        float | None,
        Label(
            "earlier start that keeps the wanted distance",
            "Δφ",
            "rad",
            "By how much the axis of the second point may start earlier, or, negative, must start later; "
            "None if no shift keeps it, or none is wanted.",
            table="clearance",
        ),
    ]
    first: Annotated[str, About("The first point.")]
    second: Annotated[str, About("The second point.")]
    axis: Annotated[str, About("Axis, or driver, of the second point.")]


@public
def clearance(machine: Machine, first: str, second: str, *, keep: float | None = None) -> Clearance:
    """Minimum distance of two points over the cycle, and the shift of an axis that keeps a wanted one.

    Parameters
    ----------
    machine : Machine
    first, second : str
        Names of points; those that move must be moved by different drivers.
    keep : float, optional
        Distance to be kept [m]: by how much the axis of the second point may start earlier, or must start
        later, all other axes unchanged.

    Returns
    -------
    Clearance

    Raises
    ------
    InputError
        There is no such point, or one driver moves both.
    FindingError
        The mechanism does not close over the cycle.
    """
    compiled = compile_machine(machine)
    require_full_turn(compiled, machine)
    if keep is not None:
        in_range(keep=(keep, positive(LENGTH)))
    axis = _axis_of(machine, first, second)
    turns = (over_whole_motion(compiled) or compiled).turns
    angle = np.linspace(0.0, 2 * math.pi * turns, _ANGLES * turns + 1)
    fixed = _trace(compiled, first, angle)
    distance = _apart(fixed, _trace(compiled, second, angle))
    least, at = _least(angle, distance)
    return Clearance(
        crank_angle=angle,
        distance=distance,
        distance_min=least,
        distance_min_angle=at,
        wanted=keep,
        earlier=None if keep is None else _earlier(compiled, angle, fixed, second, keep),
        first=first,
        second=second,
        axis=axis,
    )


def _axis_of(machine: Machine, first: str, second: str) -> str:
    """The axis, or the driver, that moves the second point alone."""
    known = compile_machine(machine).points
    for name in (first, second):
        if name not in known:
            raise InputError(f"{show(name)}: the machine has no such point; {suggestion(name, known)}")
    topology = topology_of(machine)
    drivers = [set(topology.drivers_of(name)) for name in (first, second)]
    if shared := drivers[0] & drivers[1]:
        raise InputError(
            f"{first} and {second} are both moved by {', '.join(sorted(shared))}, expected points of two axes"
        )
    if len(drivers[1]) != 1:
        found = f"{len(drivers[1])} drivers" if drivers[1] else "no driver"
        other = f"; name it first, {second} {first}" if len(drivers[0]) == 1 else ""
        raise InputError(f"{second} is moved by {found}, expected one, whose start is shifted{other}")
    driver = drivers[1].pop()
    return axis_drivers(machine).get(driver, driver)


def _trace(compiled: CompiledMachine, name: str, angle: Floats) -> Floats:
    """Places of a point at master angles, (2, n)."""
    return compiled.point_motion(compiled.points[name], np.ascontiguousarray(angle)).place


def _apart(one: Floats, other: Floats) -> Floats:
    distance: Floats = np.hypot(*(other - one))
    return distance


def _least(angle: Floats, distance: Floats) -> tuple[float, float]:
    """Minimum of a distance and its angle, between samples by a parabola through three squares."""
    k = int(np.argmin(distance))
    if 0 < k < len(distance) - 1:
        a, b, c = (distance[k - 1 : k + 2] ** 2).tolist()
        bend = a - 2 * b + c
        if bend > 0:
            step = 0.5 * (a - c) / bend
            square = b - 0.25 * (a - c) * step
            return math.sqrt(max(square, 0.0)), float(angle[k] + step * (angle[1] - angle[0]))
    return float(distance[k]), float(angle[k])


def _earlier(
    compiled: CompiledMachine, angle: Floats, fixed: Floats, second: str, keep: float
) -> float | None:
    """The largest earlier start that keeps a distance up to it, else the smallest later one [rad]."""

    def kept(shift: float) -> float:
        """By how much the distance is above the wanted one."""
        return _least(angle, _apart(fixed, _trace(compiled, second, angle + shift)))[0] - keep

    step = 2 * math.pi / _SHIFTS
    sense = 1.0 if kept(0.0) >= 0 else -1.0
    for k in range(1, _SHIFTS):
        if (kept(sense * k * step) >= 0) != (sense > 0):
            inside, outside = sense * (k - 1) * step, sense * k * step
            if sense < 0:
                inside, outside = outside, inside
            for _ in range(_HALVINGS):
                middle = 0.5 * (inside + outside)
                inside, outside = (middle, outside) if kept(middle) >= 0 else (inside, middle)
            return inside
    # Within a whole revolution nothing changes.
    return 2 * math.pi if sense > 0 else None
