"""A motion programme as a machine file has it: sections one after the other over one revolution of the cam.

    sections = [
      { angle = "120 deg", lift = "20 mm", law = "cycloidal" },
      { angle = "60 deg" },
      { angle = "120 deg", lift = "-20 mm", law = { kind = "modified_sine", share = 0.2 } },
      { angle = "60 deg" },
    ]

A section without lift and law is a dwell. `section_faults` says what is wrong with a programme; `programme`
makes it.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import BeforeValidator, Field

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
from linkwright.kernel.description.base import Description
from linkwright.kernel.units import (
    ANGLE,
    LIFT_D1,
    LIFT_D2,
    RATIO,
    SWING_D2,
    Angle,
    Length,
    Quantity,
    positive,
)

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
    """The table that a bare name stands for."""
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


class MotionSection(Description):
    """A section of a motion programme; without lift and law it is a dwell."""

    angle: Annotated[float, positive(ANGLE)] = Field(description="Angle of the cam over the section.")
    lift: Length | None = Field(None, description="Change of the lift over the section, with its sign.")
    swing: Angle | None = Field(
        None, description="Change of the angle of an oscillating follower, in place of the lift."
    )
    law: AnyLaw | None = Field(
        None,
        description="How it moves: the name of a law, or a table. Default: and with a lift, "
        "the polynomial 3-4-5.",
    )
    velocity_start: LiftVelocity | None = Field(
        None, description="Lift per cam angle at the start. Default: that of the neighbour, or rest."
    )
    velocity_end: LiftVelocity | None = Field(None, description="The same at the end.")
    acceleration_start: LiftAcceleration | None = Field(
        None,
        description="Second derivative at the start. Default: that of the neighbour, or what the law has.",
    )
    acceleration_end: LiftAcceleration | None = Field(None, description="The same at the end.")
    swing_velocity_start: SwingVelocity | None = Field(
        None, description="Angle of an oscillating follower per cam angle at the start."
    )
    swing_velocity_end: SwingVelocity | None = Field(None, description="The same at the end.")
    swing_acceleration_start: SwingAcceleration | None = Field(
        None, description="Second derivative of that angle at the start."
    )
    swing_acceleration_end: SwingAcceleration | None = Field(None, description="The same at the end.")

    @property
    def is_dwell(self) -> bool:
        """Whether the follower stands still."""
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


def key_of(name: str, family: Family) -> str:
    """The key of an entry that the two families have under different names."""
    return f"swing_{name}" if family == "swing" else name


def programme(sections: Sequence[MotionSection], expected: Family = "lift") -> Programme:
    """The motion that sections describe."""
    from linkwright.cam.laws.programme import programme as joined

    return joined([stretch(section, expected) for section in sections])


def stretch(section: MotionSection, family: Family) -> Section:
    """One section as mathematics."""
    from linkwright.cam.laws.programme import Section

    if section.is_dwell:
        return Section(section.angle)
    law = section.law or PlainLaw(kind="polynomial_3_4_5")
    shape = partial(law.over, angle=section.angle, swing=family == "swing")
    said = {name: section.end(name, family) for name in ENDS}
    return Section(section.angle, section.change(family) or 0.0, shape, section.is_steady, **said)
