"""The export of a law: the text of a cam table, and how far its controller deviates from the law.

The text is read back, interpolated as the controller does, and compared with the law. Of the ways to place
the points, the one with the minimum position deviation is taken.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, NamedTuple

import numpy as np

from linkwright.axes.export.cam_data import CamData, CamTitle
from linkwright.axes.export.formats import CamFormat
from linkwright.axes.export.interpolation import DEGREES, deviation, interpolated
from linkwright.axes.export.placement import as_polynomials, placed, sampled
from linkwright.axes.model.follower import cycle_time_of, family_of, programme_of
from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.cam.laws.programme import periodic
from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import ExchangeError, InputError, require_within, show
from linkwright.kernel.files.cam_tables import TAB_STEP
from linkwright.kernel.limits import LAW_POINTS
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.reader.out_units import OutUnits, reader
from linkwright.kernel.result import Result
from linkwright.machine.machine import Machine

# Velocities at both ends of a cycle that differ by less than this share of the peak are the same.
_SAME = 1e-9

# Shares of the points at equal distances that are tried: a spline needs some, other interpolations few.
_EVEN = {"spline": (0.03, 0.1, 0.3, 1.0), "cubic": (0.03, 0.1, 0.3, 1.0)}
_EVEN_ELSE = (0.0, 0.1)

# Decimals of angles that people give, and what rounding leaves of them in radians [deg].
_DECIMALS = 9
_ANGLE_ROUNDING = 4e-13


class MasterLaw(NamedTuple):
    """A law over one cycle of the master."""

    machine: str  # name of the machine
    name: str  # of the cam or axis
    law: MotionLaw  # position over the master angle from 0 to 2π [m or rad]
    unit: str  # SI unit of the position: "m" or "rad"


def law_of(machine: Machine, name: str | None = None) -> MasterLaw:
    """The law of a cam or a servo axis by its name or its address, over the master angle.

    The name may be left out if there is one. Raises `InputError` if there is none, none of this name, or
    several to choose from.
    """
    cams, moved = machine.mechanism.cams, {name for name, axis in machine.axes.items() if axis.sections}
    names = {f"mechanism.cams.{cam}": cam for cam in cams} | {f"axes.{axis}": axis for axis in moved}
    listed = ", ".join(names.values())
    if not names:
        raise InputError(
            "the machine has no law to export: give it [mechanism.cams.NAME], or an axis with sections"
        )
    if name is None and len(names) > 1:
        raise InputError(f"the machine has several laws: name one of {listed}")
    chosen = next(iter(names.values())) if name is None else names.get(name, name)
    if chosen in moved and not (chosen in cams and name == f"mechanism.cams.{chosen}"):
        return _law_of_axis(machine, chosen)
    if chosen not in cams:
        known = list(names.values())
        raise InputError(
            f"{show(chosen)}: the machine has no such cam or axis; {suggestion(chosen, known) or listed}"
        )
    cam = cams[chosen]
    law = cam.lift.primal.shifted(cam.phase)
    return MasterLaw(machine.name, chosen, law, "rad" if cam.is_oscillating else "m")


def _law_of_axis(machine: Machine, name: str) -> MasterLaw:
    """The law of an axis from φ = 0 on, where its position counts from zero if it advances."""
    axis = machine.axes[name]
    family = family_of(machine.mechanism, axis.driver or name)
    assert family is not None  # axes of cams have no sections
    programme = programme_of(axis, family, cycle_time_of(machine.master, machine.drive))
    law = periodic(programme.lift.primal.shifted(float(programme.phase)), -float(programme.advance))
    at_zero = law.value(law.start) if programme.advance else 0.0
    return MasterLaw(machine.name, name, law.scaled(1.0, -at_zero), "rad" if family == "swing" else "m")


@dataclass(frozen=True)
class LawExport(Result):
    """A law in the format of a controller, and the deviations measured in what was read back.

    Derivatives are by the master angle.
    """

    format: Annotated[str, About("Name of the format.")]
    maker: Annotated[str, About("Who reads it.")]
    about: Annotated[str, About("What is written.")]
    interpolation: Annotated[str, About("What the controller does between two points.")]
    numbers: Annotated[str, About("Type of the numbers, or their step.")]
    digits: Annotated[int, About("Significant decimal digits that the numbers keep, of 15.")]
    n_points: Annotated[int, Label("points", "", "")]
    position_deviation: Annotated[float, Label("maximum position deviation", "", "m or rad")]
    position_deviation_angle: Annotated[
        float, Label("master angle of the maximum position deviation", "", "rad")
    ]
    velocity_deviation: Annotated[float, Label("maximum velocity deviation", "", "m/rad or –")]
    velocity_deviation_angle: Annotated[
        float, Label("master angle of the maximum velocity deviation", "", "rad")
    ]
    acceleration_deviation: Annotated[float, Label("maximum acceleration deviation", "", "m/rad² or 1/rad")]
    acceleration_deviation_angle: Annotated[
        float, Label("master angle of the maximum acceleration deviation", "", "rad")
    ]
    velocity_jump: Annotated[
        float, Label("velocity jump", "", "m/rad or –", "Largest one at a point; 0 where there is none.")
    ]
    position_peak: Annotated[float, Label("travel of the law", "", "m or rad")]
    velocity_peak: Annotated[float, Label("peak velocity of the law", "", "m/rad or –")]
    acceleration_peak: Annotated[float, Label("peak acceleration of the law", "", "m/rad² or 1/rad")]
    text: Annotated[str, About("The text of the cam table.")]

    def to_dict(self, *, curves: bool = False) -> dict[str, object]:
        """All but the text."""
        return {name: value for name, value in super().to_dict(curves=curves).items() if name != "text"}


def exported(of: MasterLaw, form: CamFormat, points: int | None = None) -> LawExport:
    """A law in a format, with at most so many points, in the reader's unit of the position.

    Raises `InputError` for a number of points that the maker does not permit, `ExchangeError` for a law that
    the format cannot hold.
    """
    n = _permitted(form, points)
    # Controllers count the master in degrees, and the position in the unit of the machine.
    usual = "deg" if of.unit == "rad" else "mm"
    # A CNC counts in steps of these, whatever its user prefers.
    name, factor = (reader() if form.numbers != "0.0001" else OutUnits()).shown(of.unit, usual)
    unit = "deg" if name == "°" else name
    law = _in_degrees(of.law).scaled(1 / factor)
    low, high = (extreme.value for extreme in law.extremes())
    advance = law.value(law.end, 0, "before") - law.value(law.start)
    if abs(advance) <= _SAME * max(abs(low), abs(high)):
        advance = 0.0
    elif not form.advances:
        raise ExchangeError(
            f"the law advances by {advance:.6g} {unit} per cycle, and a table of {form.maker} begins anew "
            "with each; take another format"
        )
    title = CamTitle(of.machine, of.name, unit, of.unit == "rad", advance)
    best = min(_attempts(law, form, n, title), key=lambda attempt: attempt.deviations[0][0])
    scale = [factor * math.degrees(1.0) ** order for order in range(3)]
    (s, s_at), (v, v_at), (a, a_at) = (
        (value * by, math.radians(at)) for (value, at), by in zip(best.deviations, scale, strict=True)
    )
    jumps = np.abs(best.law.jumps(1)).max(initial=0.0) * scale[1]
    peaks = [abs(law.peak(order).value) * scale[order] for order in (1, 2)]
    return LawExport(
        format=form.name,
        maker=form.maker,
        about=form.about,
        interpolation=form.interpolation,
        numbers=form.numbers,
        digits={"LREAL": 15, "REAL": 6}.get(form.numbers) or _digits_of_step(high - low),
        n_points=len(best.data.x),
        position_deviation=s,
        position_deviation_angle=s_at,
        velocity_deviation=v,
        velocity_deviation_angle=v_at,
        acceleration_deviation=a,
        acceleration_deviation_angle=a_at,
        velocity_jump=float(jumps) if jumps > _SAME * peaks[0] else 0.0,
        position_peak=(high - low) * factor,
        velocity_peak=peaks[0],
        acceleration_peak=peaks[1],
        text=best.text,
    )


def _in_degrees(law: MotionLaw) -> MotionLaw:
    """A law over 360 degrees; segment boundaries at whole angles, but for rounding, are there."""
    turned = law.placed(0.0, 360.0)
    tidy = (round(x, _DECIMALS) for x in turned.breaks)
    breaks = (t if abs(t - x) < _ANGLE_ROUNDING else x for t, x in zip(tidy, turned.breaks, strict=True))
    return MotionLaw(tuple(breaks), turned.pieces)


def _digits_of_step(travel: float) -> int:
    """Significant digits of positions that are counted in steps."""
    return max(math.floor(math.log10(travel / TAB_STEP)), 0) if travel > TAB_STEP else 0


def _permitted(form: CamFormat, points: int | None) -> int:
    """The number of points to place; an `InputError` if the maker permits fewer, or it is too small."""
    if points is None:
        return form.usual
    if points < 2:
        raise InputError(f"--points: found {points}, expected at least 2")
    if form.most is not None and points > form.most:
        raise InputError(
            f"--points: found {points}, expected at most {form.most} in the format {form.name} of "
            f"{form.maker}; take fewer, or another format"
        )
    require_within(LAW_POINTS, points, "--points", "take fewer")
    return points


class _Attempt(NamedTuple):
    """A table as it was written and read back, and its deviations with their places, by order."""

    text: str
    data: CamData
    law: MotionLaw
    deviations: list[tuple[float, float]]


def _attempts(law: MotionLaw, form: CamFormat, n: int, title: CamTitle) -> Iterator[_Attempt]:
    """Tables with points at several places."""
    v = [law.value(law.start, 1), law.value(law.end, 1, "before")]
    periodic = abs(v[1] - v[0]) <= _SAME * abs(law.peak(1).value)
    for data in _tables(law, form, n):
        text = form.write(data, title)
        read = form.read(text)
        found = interpolated(read, form.interpolation, periodic=periodic)
        yield _Attempt(text, read, found, [deviation(law, found, order) for order in range(3)])


def _tables(law: MotionLaw, form: CamFormat, n: int) -> Iterator[CamData]:
    """Points of the law at several places."""
    if form.interpolation == "polynomials":
        yield as_polynomials(law, n)
        return
    degree = DEGREES[form.interpolation]
    shares = (1.0,) if form.is_even else _EVEN.get(form.interpolation, _EVEN_ELSE)
    for even in shares:
        x = _as_numbers(placed(law, degree, n, even, ramps=form.has_derivatives), form)
        y, v, a, j = sampled(law, x, 4)
        if form.has_derivatives:
            yield CamData(x, y, v, a, j)
        else:
            slopes = (float(v[0]), float(v[-1])) if form.is_clamped else None
            yield CamData(x, y, slopes=slopes)


def _as_numbers(x: Floats, form: CamFormat) -> Floats:
    """Master angles as the numbers of a format hold them, so far apart as it wants them."""
    if form.numbers == "REAL":
        x = x.astype(np.float32).astype(float)
    elif form.numbers != "LREAL":
        x = np.round(x / TAB_STEP) * TAB_STEP
    if not form.apart:
        return x
    kept = [x[0]]
    # Half a step, since a distance of numbers in decimals is rounded.
    least = form.apart - 0.5 * TAB_STEP
    for place in x[1:-1].tolist():
        if place - kept[-1] >= least and x[-1] - place >= least:
            kept.append(place)
    return np.array([*kept, x[-1]])
