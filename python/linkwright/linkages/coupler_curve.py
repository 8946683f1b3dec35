r"""The path of a point: length, extent, curvature, its straightest portion, double points and cusps.

.. math::

    L = \int \lVert\mathbf p'\rVert\,d\varphi, \qquad \kappa = \frac{x'y'' - y'x''}{\lVert\mathbf p'\rVert^3}
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, NamedTuple

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import MachineError, Problem, ShapeError
from linkwright.kernel.numerics.zeros import brackets, minima, zeros
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.linkages.closure import closure_error, closure_of
from linkwright.linkages.period import turns_to_repeat
from linkwright.linkages.straight_portion import straightest
from linkwright.linkages.sweep import Cycle
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine, compile_machine
from linkwright.machine.program.motion import PointRows

# Maximum distance from the chord, over its length, of what counts as straight.
_STRAIGHT = 1e-3

# Speed of the point, over its maximum, at which its path has a cusp: its square is known to rounding.
_STANDS = 1e-7

# Extent of a path, over the size of the machine, that is rounding.
_ROUNDING = 1e-12

# Rounds of Newton for a double point; from a degree's polygon four suffice.
_ROUNDS = 20


class DoublePoint(NamedTuple):
    """Where a path crosses itself: place [m], and the two crank angles [rad]."""

    x: float
    y: float
    first_angle: float
    second_angle: float


class Cusp(NamedTuple):
    """Where the point is at rest and turns back: place [m], and the crank angle [rad]."""

    x: float
    y: float
    angle: float


@dataclass(frozen=True)
class CouplerCurve(Result):
    """The path of a point over the cycle."""

    crank_angle: Annotated[Floats, Label("crank angle", "φ", "rad")]
    x: Annotated[Floats, Label("x of the point", "x", "m")]
    y: Annotated[Floats, Label("y of the point", "y", "m")]
    curvature: Annotated[
        Floats,
        Label(
            "curvature of the path",
            "κ",
            "1/m",
            "Positive where it bends to the left; NaN where the point stands still.",
        ),
    ]
    point: Annotated[str, About("Name of the point.")]
    is_closed: Annotated[bool, About("Whether the path comes back to its start.")]
    length: Annotated[float, Label("length of the path", "", "m")]
    x_min: Annotated[float, Label("minimum x of the path", "x_min", "m", "Located exactly.")]
    x_max: Annotated[float, Label("maximum x of the path", "x_max", "m", "Located exactly.")]
    y_min: Annotated[float, Label("minimum y of the path", "y_min", "m", "Located exactly.")]
    y_max: Annotated[float, Label("maximum y of the path", "y_max", "m", "Located exactly.")]
    straight_length: Annotated[
        float,
        Label(
            "chord of the longest straight portion",
            "",
            "m",
            "Straight: nowhere farther from its chord than a thousandth of it.",
        ),
    ]
    straight_from: Annotated[float, Label("crank angle at the start of the straight portion", "", "rad")]
    straight_to: Annotated[
        float,
        Label("crank angle at the end of the straight portion", "", "rad", "Greater than that at its start."),
    ]
    straight_error: Annotated[
        float, Label("maximum distance from the chord of the straight portion", "", "m")
    ]
    double_points: Annotated[tuple[DoublePoint, ...], About("Where the path crosses itself.")]
    cusps: Annotated[tuple[Cusp, ...], About("Where the point stands still.")]


@public
def coupler_curve(machine: Machine, point: str, *, straight: float = _STRAIGHT) -> CouplerCurve:
    """The path of a point over the cycle.

    Parameters
    ----------
    machine : Machine
        The machine; of a batch, the first.
    point : str
        Name of a point that moves.
    straight : float
        Maximum distance from the chord of what counts as straight, over the chord's length.

    Returns
    -------
    CouplerCurve
        Over the period; of a mechanism with limits, over the first range in which it closes. Of a point that
        is at rest within rounding: its place, length 0, and nothing else.

    Raises
    ------
    MachineError
        There is no such point.
    ShapeError
        ``straight`` is not between 0 and 1.
    AssemblyError
        The mechanism closes nowhere.
    """
    if not 0 < straight < 1:
        raise ShapeError(f"straight = {straight:g}: expected a number between 0 and 1")
    compiled = compile_machine(machine).first()
    if point not in compiled.points:
        raise MachineError([Problem("point", point, f"one of {', '.join(compiled.points)}")])
    where = closure_of(compiled)
    if not where.moves:
        raise closure_error(where, machine)
    cycle = Cycle.of(where, turns_to_repeat(compiled) if where.turns_fully else None)
    path = _Path(compiled, compiled.points[point], cycle)
    return path.standing(point) if path.stands() else path.result(point, straight)


class _Path:
    """A path with its special points."""

    def __init__(self, compiled: CompiledMachine, index: int, cycle: Cycle) -> None:
        self.compiled, self.index, self.cycle = compiled, index, cycle
        self.motion = self.at(cycle.angles)
        self.place = self.motion.place.T

    def at(self, angles: Floats) -> PointRows:
        return self.compiled.point_motion(self.index, angles)

    def result(self, point: str, straight: float) -> CouplerCurve:
        (x, y), (x1, y1), (x2, y2) = self.motion
        speed = np.hypot(x1, y1)
        with np.errstate(divide="ignore", invalid="ignore"):
            curvature = (x1 * y2 - y1 * x2) / speed**3
        (x_min, x_max), (y_min, y_max) = self._extent(0), self._extent(1)
        start, end, chord, error = straightest(lambda angles: self.at(angles).place.T, self.cycle, straight)
        return CouplerCurve(
            crank_angle=self.cycle.angles,
            x=x,
            y=y,
            curvature=curvature,
            point=point,
            is_closed=self.cycle.repeats,
            length=self._length(),
            x_min=x_min,
            x_max=x_max,
            y_min=y_min,
            y_max=y_max,
            straight_length=chord,
            straight_from=start,
            straight_to=end,
            straight_error=error,
            double_points=tuple(self._double_points()),
            cusps=tuple(self._cusps()),
        )

    def stands(self) -> bool:
        """Whether the point moves by rounding alone: then its path is noise, full of crossings."""
        start = self.cycle.angles[:1]
        places = [self.compiled.point_motion(index, start).place for index in self.compiled.points.values()]
        size = max(float(np.abs(place).max()) for place in places)
        return bool(np.ptp(self.place, axis=0).max() <= _ROUNDING * size)

    def standing(self, point: str) -> CouplerCurve:
        (x, y), start = self.motion.place, float(self.cycle.angles[0])
        return CouplerCurve(
            crank_angle=self.cycle.angles,
            x=x,
            y=y,
            curvature=np.full_like(x, np.nan),
            point=point,
            is_closed=self.cycle.repeats,
            length=0.0,
            x_min=float(x.min()),
            x_max=float(x.max()),
            y_min=float(y.min()),
            y_max=float(y.max()),
            straight_length=0.0,
            straight_from=start,
            straight_to=start,
            straight_error=0.0,
            double_points=(),
            cusps=(),
        )

    def _length(self) -> float:
        """Gauss–Legendre between samples and points of rest, where the speed has a kink."""
        nodes, weights = np.polynomial.legendre.leggauss(4)
        ends = np.union1d(self.cycle.angles, self._stops())
        low, high = ends[:-1, None], ends[1:, None]
        at = 0.5 * (low + high) + 0.5 * (high - low) * nodes
        speed = np.hypot(*self.at(at.ravel()).d1).reshape(at.shape)
        return float((speed @ weights @ (0.5 * (high - low)[:, 0])).item())

    def _extent(self, axis: int) -> tuple[float, float]:
        _, column = brackets(self.motion.d1[axis][None])
        angles = self.cycle.angles
        at = angles[[0, -1]]
        if len(column):
            near, _ = zeros(lambda phi: self.at(phi).d1[axis], angles[column], angles[column + 1])
            at = np.concatenate([at, near])
        values = self.at(at).place[axis]
        return float(values.min()), float(values.max())

    # -- double points and cusps -------------------------------------------------------------------------

    def _double_points(self) -> list[DoublePoint]:
        """Crossings of the polygon through the samples, then Newton on p(φ₁) = p(φ₂)."""
        points: list[DoublePoint] = []
        size = float(np.ptp(self.place, axis=0).max())
        for first, second in _crossings(self.place, closed=self.cycle.repeats):
            angles = self.cycle.angles[[first, second]] + 0.5 * (self.cycle.angles[1] - self.cycle.angles[0])
            point = self._double_point(angles, size)
            if point is not None and not any(
                np.hypot(point.x - p.x, point.y - p.y) < 1e-9 * size for p in points
            ):
                points.append(point)
        return points

    def _double_point(self, angles: Floats, size: float) -> DoublePoint | None:
        for _ in range(_ROUNDS):
            motion = self.at(angles)
            off = motion.place[:, 0] - motion.place[:, 1]
            jacobian = motion.d1 * (1.0, -1.0)
            if not np.isfinite(motion).all() or abs(np.linalg.det(jacobian)) <= 1e-14 * size**2:
                return None
            step = np.linalg.solve(jacobian, -off)
            angles = angles + np.clip(step, -0.1, 0.1)
            if np.abs(step).max() < 1e-13:
                break
        place = self.at(angles).place
        apart = abs((angles[0] - angles[1] + np.pi) % (2 * np.pi) - np.pi)
        if np.hypot(*(place[:, 0] - place[:, 1])) > 1e-12 * size or apart < 1e-4:
            return None
        low, high = sorted(float(angle) % (2 * np.pi) for angle in angles)
        return DoublePoint(float(place[0, 0]), float(place[1, 0]), low, high)

    def _cusps(self) -> list[Cusp]:
        at = self._stops()
        return [
            Cusp(float(x), float(y), self.cycle.named(phi))
            for x, y, phi in zip(*self.at(at).place, at, strict=True)
        ]

    def _stops(self) -> Floats:
        """Crank angles at which the point is at rest: minima of its speed that are zero."""
        speed = np.hypot(*self.motion.d1)
        inner = np.flatnonzero((speed[1:-1] <= speed[:-2]) & (speed[1:-1] < speed[2:])) + 1
        inner = inner[speed[inner] < 0.1 * speed.max()]
        if not len(inner):
            return np.empty(0)
        angles = self.cycle.angles
        at, least = minima(lambda phi: np.hypot(*self.at(phi).d1), angles[inner - 1], angles[inner + 1])
        stops: Floats = at[least <= _STANDS * speed.max()]
        return stops


def _crossings(place: Floats, *, closed: bool) -> list[tuple[int, int]]:
    a, d = place[:-1], np.diff(place, axis=0)
    n = len(d)
    first, second = np.triu_indices(n, 2)
    if closed:
        keep = ~((first == 0) & (second == n - 1))
        first, second = first[keep], second[keep]
    r, s, q = d[first], d[second], a[second] - a[first]
    cross = r[:, 0] * s[:, 1] - r[:, 1] * s[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (q[:, 0] * s[:, 1] - q[:, 1] * s[:, 0]) / cross
        u = (q[:, 0] * r[:, 1] - q[:, 1] * r[:, 0]) / cross
    hit = (t >= 0) & (t <= 1) & (u >= 0) & (u <= 1)
    return list(zip(first[hit].tolist(), second[hit].tolist(), strict=True))
