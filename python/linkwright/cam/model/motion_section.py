"""A motion programme as a machine file has it: sections one after the other over one revolution of the cam.

    sections = [
      { angle = "120 deg", lift = "20 mm", law = "cycloidal" },
      { angle = "60 deg" },
      { angle = "120 deg", lift = "-20 mm", law = { kind = "modified_sine", share = 0.2 } },
      { angle = "60 deg" },
    ]

A section without lift and law is a dwell. `section_faults` says what is wrong with a programme
(angles and lifts that do not close, ends that contradict it); `programme` makes it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import BeforeValidator, Field
from pydantic_core import InitErrorDetails

from linkwright.cam.laws.programme import CLOSES, TURN, boundaries, section_law
from linkwright.cam.model.motion_law import (
    CombinedLaw,
    LimitedLaw,
    ModifiedSineLaw,
    ModifiedTrapezoidLaw,
    OptimalLaw,
    PlainLaw,
    PolynomialLaw,
    SCurveLaw,
    TrapezoidalVelocityLaw,
)
from linkwright.cam.model.point_law import FormulaLaw, SplineLaw, TableLaw
from linkwright.kernel.description.base import Description, fault, wrong
from linkwright.kernel.errors import LawError
from linkwright.kernel.units.kinds import ANGLE, LENGTH, LIFT_D1, LIFT_D2, RATIO, SWING_D2, TIME
from linkwright.kernel.units.marks import Angle, Length, Quantity, positive
from linkwright.kernel.units.reading import to_text

if TYPE_CHECKING:
    from linkwright.cam.laws.programme import Programme, Section


Family = Literal["lift", "swing"]

# Entries of a family: what a section does, and the derivatives at its ends.
ENDS = ("velocity_start", "velocity_end", "acceleration_start", "acceleration_end")

LiftVelocity = Annotated[float, Quantity(LIFT_D1)]
LiftAcceleration = Annotated[float, Quantity(LIFT_D2)]
SwingVelocity = Annotated[float, Quantity(RATIO)]
SwingAcceleration = Annotated[float, Quantity(SWING_D2)]


def _as_table(value: object) -> object:
    return {"kind": value} if isinstance(value, str) else value


AnyLaw = Annotated[
    Annotated[
        PlainLaw
        | ModifiedTrapezoidLaw
        | ModifiedSineLaw
        | PolynomialLaw
        | OptimalLaw
        | CombinedLaw
        | TrapezoidalVelocityLaw
        | SCurveLaw
        | LimitedLaw
        | FormulaLaw
        | SplineLaw
        | TableLaw,
        Field(discriminator="kind"),
    ],
    BeforeValidator(_as_table),
]


# Law of a section that moves and names none.
_DEFAULT_LAW: Literal["polynomial_3_4_5"] = "polynomial_3_4_5"


class MotionSection(Description):
    """A section of a motion programme; without lift and law it is a dwell."""

    angle: Annotated[float, positive(ANGLE)] = Field(description="Cam angle of the section.")
    lift: Length | None = Field(
        None, description="Change of the lift over the section; negative for a return."
    )
    swing: Angle | None = Field(
        None, description="Change of the angle of an oscillating follower, instead of the lift."
    )
    law: AnyLaw | None = Field(
        None,
        description="Motion law: its name, or a table. Default: the polynomial 3-4-5 for a section "
        "with a lift.",
    )
    velocity_start: LiftVelocity | None = Field(
        None,
        description="First derivative of the lift at the start. Default: that of the neighbouring "
        "section, or zero.",
    )
    velocity_end: LiftVelocity | None = Field(None, description="Likewise at the end.")
    acceleration_start: LiftAcceleration | None = Field(
        None,
        description="Second derivative of the lift at the start. Default: that of the neighbouring "
        "section, or of the law.",
    )
    acceleration_end: LiftAcceleration | None = Field(None, description="Likewise at the end.")
    swing_velocity_start: SwingVelocity | None = Field(
        None, description="First derivative of the angle of an oscillating follower at the start."
    )
    swing_velocity_end: SwingVelocity | None = Field(None, description="Likewise at the end.")
    swing_acceleration_start: SwingAcceleration | None = Field(
        None, description="Second derivative of the angle of an oscillating follower at the start."
    )
    swing_acceleration_end: SwingAcceleration | None = Field(None, description="Likewise at the end.")

    @property
    def law_name(self) -> str:
        """Name of its law; that of a dwell is ``dwell``."""
        if self.is_dwell:
            return "dwell"
        return _DEFAULT_LAW if self.law is None else str(self.law.kind)

    @property
    def is_dwell(self) -> bool:
        """Whether the follower is at rest."""
        return self.lift is None and self.swing is None and self.law is None

    @property
    def is_steady(self) -> bool:
        """Whether its velocity is constant."""
        return isinstance(self.law, PlainLaw) and self.law.kind == "constant_velocity"

    def end(self, name: str, family: Family) -> float | None:
        """A derivative at an end [m/rad, m/rad², or –, 1/rad]."""
        value: float | None = getattr(self, key_of(name, family))
        return value

    def change(self, family: Family) -> float | None:
        """How far the section goes [m or rad]."""
        given: float | None = getattr(self, family)
        if given is not None:
            return given
        if self.law is None:
            return 0.0
        slopes = [self.end(name, family) for name in ENDS[:2]] if self.is_steady else []
        slope = next((slope for slope in slopes if slope is not None), None)
        if slope is not None:
            return slope * self.angle
        return self.law.own_lift(self.angle, swing=family == "swing")


class AxisSection(MotionSection):
    """A section of the motion of a servo axis, over an angle of the master or a time."""

    angle: Annotated[float, positive(ANGLE)] | None = Field(  # type: ignore[assignment]
        None, description="Angle of the master over the section."
    )
    time: Annotated[float, positive(TIME)] | None = Field(
        None, description="Duration of the section, instead of the angle; the master gives the cycle time."
    )

    def over(self, cycle_time: float | None) -> MotionSection:
        """The section over an angle of the master. `cycle_time`: of a revolution [s]."""
        entries = {name: getattr(self, name) for name in MotionSection.model_fields}
        if self.time is not None:
            assert cycle_time is not None
            entries["angle"] = TURN * self.time / cycle_time
        return MotionSection.model_construct(**entries)


def key_of(name: str, family: Family) -> str:
    """The key of an entry that the two families have under different names."""
    return f"swing_{name}" if family == "swing" else name


def programme(
    sections: Sequence[MotionSection], expected: Family = "lift", advance: float = 0.0
) -> Programme:
    """The motion that sections describe. `advance`: of the lift or swing over a revolution."""
    from linkwright.cam.laws.programme import programme as joined

    return joined([stretch(section, expected) for section in sections], advance)


def stretch(section: MotionSection, family: Family) -> Section:
    """One section as mathematics."""
    from linkwright.cam.laws.programme import Section

    if section.is_dwell:
        return Section(section.angle)
    law = section.law or PlainLaw(kind=_DEFAULT_LAW)
    shape = partial(law.over, angle=section.angle, swing=family == "swing")
    said = {name: section.end(name, family) for name in ENDS}
    return Section(section.angle, section.change(family) or 0.0, shape, section.is_steady, **said)


# Slopes that differ by less than this share are the same slope.
_SAME = 1e-9


def section_faults(
    sections: Sequence[MotionSection], expected: Family, advance: tuple[str, float] | None = None
) -> Iterator[InitErrorDetails]:
    """What is wrong with the sections of a programme.

    `advance`: key and value of what lift or swing advance by over a revolution; None if they must return.
    """
    if not sections:
        yield fault("sections", found="an empty list", expected="at least one section")
        return
    faults = [
        wrong_entry
        for i, section in enumerate(sections)
        for wrong_entry in (
            *_family_faults(section, expected, ("sections", i)),
            *_own_faults(section, expected, ("sections", i)),
        )
    ]
    faults += _turn_faults(sections)
    faults = faults or list(_lift_faults(sections, expected, advance))
    yield from faults or _law_faults(sections, expected)


def _family_faults(
    section: MotionSection, family: Family, place: tuple[str | int, ...]
) -> Iterator[InitErrorDetails]:
    other: Family = "lift" if family == "swing" else "swing"
    moves = "swings" if family == "swing" else "moves along a guide"
    for here, instead in ((other, family), *((key_of(n, other), key_of(n, family)) for n in ENDS)):
        value = getattr(section, here)
        if value is not None:
            yield fault(*place, here, found=value, expected=f"{instead}: the follower {moves}")


def _own_faults(
    section: MotionSection, family: Family, place: tuple[str | int, ...]
) -> Iterator[InitErrorDetails]:
    said = {name: section.end(name, family) for name in ENDS}
    if section.is_dwell:
        yield from _ends_other_than(0.0, said, "0, as the section is a dwell", family, place)
        return
    lift = section.change(family)
    if lift is None:
        other = f", or {key_of('velocity_start', family)}" if section.is_steady else ""
        yield fault(*place, family, expected=f"the lift or swing of the section{other}")
    elif section.is_steady:
        slope = lift / section.angle
        words = f"the slope {slope:.10g}, which is constant over the section"
        speeds = {name: value for name, value in said.items() if name.startswith("velocity")}
        yield from _ends_other_than(slope, speeds, words, family, place)
        bends = {name: value for name, value in said.items() if name.startswith("acceleration")}
        yield from _ends_other_than(0.0, bends, "0, as the velocity is constant", family, place)


def _ends_other_than(
    wanted: float,
    said: dict[str, float | None],
    expected: str,
    family: Family,
    place: tuple[str | int, ...],
) -> Iterator[InitErrorDetails]:
    for name, value in said.items():
        if value is not None and abs(value - wanted) > _SAME * abs(wanted):
            yield fault(*place, key_of(name, family), found=value, expected=expected)


def _turn_faults(sections: Sequence[MotionSection]) -> Iterator[InitErrorDetails]:
    turn = math.fsum(section.angle for section in sections)
    over = turn - TURN
    if abs(over) <= CLOSES * TURN:
        return
    # A dwell can give way without touching any motion; the longest changes least for its length.
    longest = max(range(len(sections)), key=lambda i: (sections[i].is_dwell, sections[i].angle))
    if sections[longest].angle <= over:
        longest = max(range(len(sections)), key=lambda i: sections[i].angle)
    new = sections[longest].angle - over
    few = f'{_degrees(over)} too much: sections.{longest}.angle = "{_degrees(new)}" closes the revolution'
    many = (
        f"{_degrees(over)} too much: more than any single section; shorten all to {TURN / turn:.6g} of "
        "their angle"
    )
    short = f'{_degrees(-over)} missing: sections.{longest}.angle = "{_degrees(new)}" closes the revolution'
    remedy = short if over < 0 else few if new > 0 else many
    found = f"angles that add to {_degrees(turn)}"
    problem = wrong(found, "angles that add to 360 deg", remedy)
    yield InitErrorDetails(type=problem, loc=("sections",), input=found)


def _lift_faults(
    sections: Sequence[MotionSection], family: Family, advance: tuple[str, float] | None
) -> Iterator[InitErrorDetails]:
    lifts = [section.change(family) or 0.0 for section in sections]
    key, wanted = advance or ("", 0.0)
    over, largest = math.fsum(lifts) - wanted, max(map(abs, lifts))
    if abs(over) <= CLOSES * largest:
        return
    # The last section that moves by an entry of its own brings the follower home; a law by points, or by a
    # formula, has none.
    given = [getattr(section, family) is not None for section in sections]
    last = max(range(len(lifts)), key=lambda i: (given[i] and lifts[i] != 0.0, given[i], lifts[i] != 0.0, i))
    noun = "swings" if family == "swing" else "lifts"
    found = f"{noun} that add to {_size(over + wanted, family)}"
    expected = f"{noun} that add to {key}, {_size(wanted, family)}" if wanted else f"{noun} that add to 0"
    remedy = f'sections.{last}.{family} = "{_size(lifts[last] - over, family)}" brings the follower back'
    if key:
        remedy = f'{key} = "{_size(over + wanted, family)}" for steps that add up from cycle to cycle'
    problem = wrong(found, expected, remedy)
    yield InitErrorDetails(type=problem, loc=("sections",), input=found)


def _law_faults(sections: Sequence[MotionSection], family: Family) -> Iterator[InitErrorDetails]:
    stretches = [stretch(section, family) for section in sections]
    for i, (section, task) in enumerate(zip(stretches, boundaries(stretches), strict=True)):
        try:
            section_law(section, task)
        except LawError as error:
            problem = error.problem
            below = (part for part in problem.key.split(".") if part)
            words = wrong(problem.found, problem.expected, problem.remedy)
            yield InitErrorDetails(type=words, loc=("sections", i, "law", *below), input=problem.found)


def _degrees(angle: float) -> str:
    return f"{math.degrees(angle):.10g} deg"


def _size(value: float, family: Family) -> str:
    """A lift or a swing with its unit, to ten digits."""
    return _degrees(value) if family == "swing" else to_text(float(f"{value:.10g}"), LENGTH)
