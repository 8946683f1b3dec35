r"""A mechanism over time under any law of its crank: positions, velocities, accelerations and jerks.

.. math::

    \dot p = p'\dot\varphi, \quad \ddot p = p''\dot\varphi^2 + p'\ddot\varphi, \quad
    \dddot p = p'''\dot\varphi^3 + 3 p''\dot\varphi\ddot\varphi + p'\dddot\varphi
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from numpy.typing import ArrayLike

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import AssemblyError, ShapeError
from linkwright.kernel.numerics.zeros import brackets, zeros
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Record, Result
from linkwright.kernel.units.kinds import ANGLE, ANGULAR_ACCELERATION, SPEED, TIME
from linkwright.kernel.units.marks import Quantity
from linkwright.linkages.closure import Closure, closure_of, require_closed
from linkwright.linkages.kinematics import (
    checked_angles,
    columns_of,
    everything,
    kinematics_of,
    unit_of_coordinate,
)
from linkwright.linkages.law import Law, as_law
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine, compile_machine

_PATH_POSITION = "Of a point two columns [m], of a slide one [m], of a link one [rad]."


@dataclass(frozen=True)
class Path(Record):
    """A point, link or slide over time."""

    position: Annotated[Floats, About(_PATH_POSITION, "(n, 2) or (n,)")]
    velocity: Annotated[Floats, About("Likewise [m/s or rad/s].", "(n, 2) or (n,)")]
    acceleration: Annotated[Floats, About("Likewise [m/s² or rad/s²].", "(n, 2) or (n,)")]
    jerk: Annotated[
        Floats | None,
        About("Likewise [m/s³ or rad/s³]; None where that of the crank is not known.", "(n, 2) or (n,)"),
    ] = None


@dataclass(frozen=True)
class Motion(Result):
    """A mechanism over time."""

    time: Annotated[Floats, Label("time", "t", "s")]
    crank_angle: Annotated[Floats, Label("crank angle", "φ", "rad")]
    speed: Annotated[Floats, Label("speed of the crank", "ω", "rad/s")]
    acceleration: Annotated[Floats, Label("acceleration of the crank", "ε", "rad/s²")]
    crank_jerk: Annotated[
        Floats | None, Label("jerk of the crank", "dε/dt", "rad/s³", "None where it is not known.")
    ]
    points: Annotated[dict[str, Path], About("By name.")]
    links: Annotated[dict[str, Path], About("By name.")]
    slides: Annotated[dict[str, Path], About("By name.")]

    def curves(self) -> dict[str, np.ndarray]:
        """All columns by name: ``K.x``, ``K.x.velocity``, ``R.rocker.angle``, …."""
        curves = super().curves()
        for name, path in self.points.items():
            for k, axis in enumerate("xy"):
                curves |= columns_of(f"{name}.{axis}", path.position[..., k], _rates_of(path, k))
        for name, path in self.links.items():
            curves |= columns_of(f"{name}.angle", path.position, _rates_of(path))
        for name, path in self.slides.items():
            curves |= columns_of(f"{name}.place", path.position, _rates_of(path))
        return curves

    @public
    def unit_of(self, name: str) -> str:
        """SI unit of an attribute or a column by its name."""
        of, _, last = name.rpartition(".")
        if not of:
            return super().unit_of(name)
        return (
            self.unit_of(of) + _PER_TIME[last] if last in _PER_TIME else unit_of_coordinate(name, self.links)
        )


# What a rate adds to the unit of its coordinate.
_PER_TIME = {"velocity": "/s", "acceleration": "/s²", "jerk": "/s³"}


def _rates_of(path: Path, at: Any = slice(None)) -> dict[str, Floats]:
    """The derivatives of a path by time, as far as they are known."""
    known = {rate: getattr(path, rate) for rate in _PER_TIME}
    return {rate: values[..., at] for rate, values in known.items() if values is not None}


@public
def motion(
    machine: Machine, law: Law | Callable[[Any], Any] | Sequence[ArrayLike], times: ArrayLike
) -> Motion:
    """Motion of every point, link and slide over time under a law of the crank.

    Parameters
    ----------
    machine : Machine
        The machine; of a batch, the first. Drive and loads play no part.
    law : Law, callable or pair of array_like, shape (k,)
        Crank angle over time: a law of `linkwright.linkages.law`, a function written with numpy, or a table
        of times and angles [s, rad].
    times : array_like, shape (n,)
        Increasing [s].

    Returns
    -------
    Motion
        Positions with three exact derivatives by time.

    Raises
    ------
    AssemblyError
        The law leaves the range in which the mechanism closes; says at what time and crank angle.
    InputError
        Times or law are not usable, or the law goes beyond the range of angles, speeds or accelerations.
    """
    t = checked_angles(times)
    in_range(times=(t, Quantity(TIME)))
    if len(t) == 0 or (np.diff(t) <= 0).any():
        raise ShapeError("times must increase, and there must be at least one")
    driver = as_law(law)
    compiled = compile_machine(machine).first()
    rates = driver.at(t)
    if not np.isfinite(rates).all():
        first = t[int(np.argmin(np.isfinite(rates).all(axis=0)))]
        raise ShapeError(f"the law gives no finite angle or rate at t = {first:g} s")
    given = (
        ("angle", Quantity(ANGLE)),
        ("speed", Quantity(SPEED)),
        ("acceleration", Quantity(ANGULAR_ACCELERATION)),
    )
    in_range(**{f"crank {name} by the law": (rates[n], kind) for n, (name, kind) in enumerate(given)})
    _require_within(compiled, machine, driver, t)
    kinematics = kinematics_of(compiled, np.ascontiguousarray(rates[0]), everything(compiled), third=True)
    columns = rates[:, :, None]
    return Motion(
        time=t,
        crank_angle=rates[0],
        speed=rates[1],
        acceleration=rates[2],
        crank_jerk=rates[3],
        points={name: _path(point.position, point, columns) for name, point in kinematics.points.items()},
        links={name: _path(link.angle, link, rates) for name, link in kinematics.links.items()},
        slides={name: _path(slide.position, slide, rates) for name, slide in kinematics.slides.items()},
    )


def motion_along(
    machine: Machine, time: Floats, angle: Floats, speed: Floats, acceleration: Floats
) -> Motion:
    """Motion of every point, link and slide along a motion of the crank that was computed already; no jerk.

    Of the crank (n,) each [s, rad, rad/s, rad/s²]; of a batch, the first machine. Raises `AssemblyError` if
    the mechanism does not close at one of the angles.
    """
    compiled = compile_machine(machine).first()
    phi = np.ascontiguousarray(angle)
    require_closed(compiled, machine, phi)
    kinematics = kinematics_of(compiled, phi, everything(compiled))
    rates = np.array([speed, acceleration])
    columns = rates[:, :, None]
    return Motion(
        time=time,
        crank_angle=phi,
        speed=speed,
        acceleration=acceleration,
        crank_jerk=None,
        points={name: _rates(point.position, point, columns) for name, point in kinematics.points.items()},
        links={name: _rates(link.angle, link, rates) for name, link in kinematics.links.items()},
        slides={name: _rates(slide.position, slide, rates) for name, slide in kinematics.slides.items()},
    )


def _rates(position: Floats, part: Any, rates: Floats) -> Path:
    """The chain rule up to the acceleration; infinite where the part stands at the limit of its range."""
    w, a = rates
    with np.errstate(invalid="ignore", over="ignore"):
        return Path(position, part.d1 * w, part.d2 * w**2 + part.d1 * a)


def _path(position: Floats, point: Any, rates: Floats) -> Path:
    _, w, a, j = rates
    return Path(position, *rates_of(point, w, a), point.d3 * w**3 + 3 * point.d2 * w * a + point.d1 * j)


def rates_of(part: Any, speed: Floats, acceleration: Floats) -> tuple[Floats, Floats]:
    """Velocity and acceleration of a point, link or slide [m/s, m/s²; of a link rad/s, rad/s²].

    Those of the crank at the same angles are (n,), in a column (n, 1) for a point [rad/s, rad/s²].
    """
    return part.d1 * speed, part.d2 * speed**2 + part.d1 * acceleration


def _require_within(compiled: CompiledMachine, machine: Machine, law: Law, times: Floats) -> None:
    """Raise if the law leaves the range of the mechanism, also between the times."""
    where = closure_of(compiled)
    if where.turns_fully:
        return
    start = law.at(times[:1])[0]
    require_closed(compiled, machine, start)
    low, high = _range_around(float(start[0]), where)
    looked = _with_turning_points(law, times)
    angles = law.at(looked)[0]
    out = np.flatnonzero((angles < low) | (angles > high))
    if not len(out):
        return
    first = int(out[0])
    limit = low if angles[first] < low else high
    ends = np.array([looked[first - 1]]), np.array([looked[first]])
    at = float(zeros(lambda t: law.at(t)[0] - limit, *ends)[0][0])
    raise AssemblyError(
        f"the law of the crank passes the limit of {where.element} at t = {at:.6g} s, crank angle "
        f"{np.degrees(limit):.6g}°: the mechanism closes from {np.degrees(low):.6g}° to "
        f"{np.degrees(high):.6g}° only; keep the law within that range",
        element=where.element,
        crank_angle=limit,
    )


def _range_around(start: float, where: Closure) -> tuple[float, float]:
    ranges = where.ranges
    cycle = 2 * np.pi * (where.turns or 1)
    for low, high in ranges:
        turn = cycle * np.floor((start - low) / cycle)
        if low + turn <= start <= high + turn:
            return low + turn, high + turn
    # At a limit, by rounding.
    return min(
        ((low + turn, high + turn) for low, high in ranges for turn in (0.0, -cycle)),
        key=lambda curve: min(abs(start - curve[0]), abs(start - curve[1])),
    )


def _with_turning_points(law: Law, times: Floats) -> Floats:
    speed = law.at(times)[1]
    _, column = brackets(speed[None])
    if not len(column):
        return times
    near, _ = zeros(lambda t: law.at(t)[1], times[column], times[column + 1])
    return np.unique(np.concatenate([times, near]))
