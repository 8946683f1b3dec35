"""Elements of a mechanism: fixed points, cranks, dyads, gears, racks, cables, joints and bars.

| table | is | group |
| --- | --- | --- |
| `points` | points of the frame | – |
| `cranks` | cranks on the crankshaft | driver |
| `linear_drivers` | points moved along a guide, in proportion to the crank angle or by a law | driver |
| `sliders` | a rod to a slider on a guide | dyad RRP |
| `rockers` | a coupler and a rocker that meet in a joint | dyad RRR |
| `slotted_levers` | a lever with a slot, or an oscillating cylinder, moved by a pin | dyad RPR |
| `crossings` | a pin in two guides | dyad PRP |
| `yokes` | a body on a guide whose slot is moved by a pin | dyad RPP |
| `rigid_points` | points fixed to links | – |
| `gears` | gears, planets, pulleys | – |
| `racks`, `cables` | what a turning link moves along a guide | – |
| `joints`, `bars` | joints held by bars and guides, in any group | dyads, or solved together |
"""

import math
from collections.abc import Iterator
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, Description, fault
from linkwright.kernel.description.formula_faults import constant_faults, text_faults
from linkwright.kernel.units import COUNT, LENGTH, Angle, AnyQuantity, Length, Quantity, positive

PositiveLength = Annotated[float, positive(LENGTH)]
PositiveNumber = Annotated[float, positive(COUNT)]
Number = Annotated[float, Quantity(COUNT)]

# Sine of the angle between two directions below which they are parallel.
_PARALLEL = 1e-9


class FixedPoint(Description):
    """A point of the frame."""

    x: Length = Field(0.0, description="To the right of the origin.")
    y: Length = Field(0.0, description="Above the origin.")


class Guide(Description):
    """A straight guide, on the frame or on a link that moves."""

    shown_with_part: ClassVar[bool] = True

    through: str | None = Field(
        None,
        description="Point of the guide's body that it would pass through without offset. "
        "Default: the start of the link, or the origin.",
    )
    on: str | None = Field(None, description="Link that carries the guide. Default: the frame.")
    angle: Angle = Field(0.0, description="Direction of the guide, from the link's direction or from x.")
    offset: Length = Field(0.0, description="Of the guide to the left of its direction.")


# Numbers of a formula by name.
Constants = dict[str, Annotated[float, AnyQuantity()]]


def _law_faults(law: str | None, constants: Constants) -> Iterator[InitErrorDetails]:
    """A law that is no formula of the crank angle."""
    yield from constant_faults(constants, law or "")
    if law is None and constants:
        yield fault("law", expected="a law that asks for the constants")
    if law is not None:
        yield from text_faults("law", law, constants, ("phi",))


class Crank(CheckedDescription):
    """A crank; its angle is that of the crankshaft, or follows it by a law."""

    radius: PositiveLength = Field(description="From the pivot to the pin.")
    phase: Angle = Field(0.0, description="Angle of this crank when the crank angle is zero.")
    pivot: str | None = Field(None, description="Fixed point that it turns about. Default: the origin.")
    law: str | None = Field(
        None,
        description="Angle of the crank in rad as a formula in phi, to which the phase is added: "
        '"0.6*sin(phi)" swings back and forth. phi counts on beyond 2*pi: pi - atan2(sin(phi), -cos(phi)) '
        "begins anew in every revolution. Default: phi.",
    )
    constants: Constants = Field(
        default_factory=dict, description="Constants of the law by name, in any unit."
    )

    def follows(self) -> Any:
        """The cam that it follows; None where it is moved otherwise."""
        return None

    def _faults(self) -> Iterator[InitErrorDetails]:
        return _law_faults(self.law, self.constants)


class LinearDriver(CheckedDescription):
    """A point that the drive moves along a guide, in proportion to the crank angle or by a law."""

    guide: Guide = Field(default_factory=Guide, description="What it moves along.")
    start: Length = Field(0.0, description="Place along the guide when the crank angle is zero.")
    per_turn: Length | None = Field(None, description="Distance for a revolution of the crankshaft.")
    law: str | None = Field(None, description="Distance from the start in m as a formula in phi.")
    constants: Constants = Field(
        default_factory=dict, description="Constants of the law by name, in any unit."
    )

    def follows(self) -> Any:
        """The cam that it follows; None where it is moved otherwise."""
        return None

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from _law_faults(self.law, self.constants)
        if (self.law is None) == (self.per_turn is None):
            found = "neither" if self.law is None else "both"
            yield fault(found=found, expected="either per_turn or law")


class Slider(Description):
    """A slider on a straight guide, moved through a rod."""

    crank: str = Field(description="Moving point that drives it: the pin of a crank, or another.")
    rod: PositiveLength = Field(description="From the driving point to the slider.")
    offset: Length = Field(0.0, description="Of the guide to the left of its direction.")
    angle: Angle = Field(0.0, description="Direction of the guide, from x or from the link that carries it.")
    through: str | None = Field(
        None,
        description="Point that the guide would pass through without offset. "
        "Default: the pivot of the crank, or the origin; on a link, its start.",
    )
    on: str | None = Field(None, description="Link that carries the guide. Default: the frame.")
    assembly: Literal["positive", "negative"] = Field(
        "positive", description="Side of the slider, along the guide, from the driving point."
    )


class Rocker(Description):
    """A coupler and a rocker that meet in a joint."""

    crank: str = Field(description="Moving point that drives the coupler.")
    pivot: str = Field(description="Point that the rocker turns about; it may move.")
    coupler: PositiveLength = Field(description="From the driving point to the joint.")
    rocker: PositiveLength = Field(description="From the pivot to the joint.")
    assembly: Literal["left", "right"] = Field(
        "left",
        description="Side of the joint, seen from the driving point to the pivot; where the mechanism has "
        "change points, at small positive crank angles.",
    )


class SlottedLever(Description):
    """A lever whose slot is moved by a pin, or a cylinder whose rod ends at the pin."""

    pin: str = Field(description="Moving point that slides in the slot.")
    pivot: str = Field(description="Point that the lever turns about; it may move.")
    offset: Length = Field(0.0, description="Of the slot to the left of the pivot.")
    length: PositiveLength | None = Field(None, description="Of the lever, for its mass and its picture.")
    assembly: Literal["ahead", "behind"] = Field(
        "ahead", description="Whether the lever points to the pin or away from it."
    )


class Crossing(Description):
    """A pin that two guides hold."""

    first: Guide = Field(description="One guide.")
    second: Guide = Field(description="The other.")


class Yoke(CheckedDescription):
    """A body on a guide, moved by a pin in its slot."""

    pin: str = Field(description="Moving point in the slot.")
    guide: Guide = Field(default_factory=Guide, description="What the body moves along.")
    slot: Angle = Field(math.pi / 2, description="Direction of the slot, from the guide.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        if abs(math.sin(self.slot)) < _PARALLEL:
            expected = "an angle across the guide, such as 90°"
            yield fault("slot", found=f"{math.degrees(self.slot):.6g}°", expected=expected)


class RigidPoint(Description):
    """A point fixed to a link."""

    link: str = Field(description="Link that carries it.")
    along: Length = Field(description="From the start of the link along it.")
    across: Length = Field(0.0, description="To the left of the link.")


class Gear(CheckedDescription):
    """A gear, or a pulley, that turns in proportion to another."""

    kind: Literal["external", "internal", "belt", "crossed_belt"] = Field(
        "external",
        description="Teeth outside, one gear inside the other, or a belt or chain; external gears and a "
        "crossed belt reverse the sense.",
    )
    pivot: str = Field(description="Point that it turns about.")
    meshes: str | None = Field(None, description="Link of the other gear. Default: that is at rest.")
    carrier: str | None = Field(
        None,
        description="Link that carries both pivots, the arm of a planetary train. Default: the frame.",
    )
    size: PositiveNumber = Field(description="Teeth, or radius in any unit that both have.")
    size_other: PositiveNumber = Field(description="Teeth or radius of the other gear.")
    phase: Angle = Field(0.0, description="Angle of this gear where the others stand at zero.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.kind == "internal" and self.size == self.size_other:
            remedy = "one gear turns inside the other"
            yield fault("size", found=self.size, expected="another size than size_other", remedy=remedy)


class Rack(Description):
    """A rack moved along its guide by a gear."""

    gear: str = Field(description="Link of the gear.")
    radius: PositiveLength = Field(description="Pitch radius of the gear.")
    guide: Guide = Field(default_factory=Guide, description="What it moves along.")
    start: Length = Field(0.0, description="Place along the guide when the gear's angle is zero.")
    side: Literal["right", "left"] = Field(
        "right", description="Side of the rack's teeth line, seen from the gear along the guide."
    )


class Cable(Description):
    """The end of a cable or belt that runs off an arc about the start of a link."""

    link: str = Field(description="Link that carries the arc.")
    radius: PositiveLength = Field(description="Of the arc about the start of the link.")
    length: Length = Field(description="Free length when the link stands at the reference angle.")
    reference: Angle = Field(0.0, description="That angle of the link.")
    angle: Angle = Field(-math.pi / 2, description="Direction in which the cable runs off.")
    side: Literal["left", "right"] = Field(
        "left", description="Side of the link's start on which it runs off, seen in that direction."
    )


class Joint(Description):
    """A joint held by bars and at most one guide; its place follows from them."""

    x: Length = Field(description="Approximate position at `assembled_at`, to the right.")
    y: Length = Field(description="Approximate position at `assembled_at`, upwards.")
    guide: Guide | None = Field(None, description="Guide that it moves on.")


class Bar(CheckedDescription):
    """A link of given length between two points."""

    start: str = Field(description="Point that it starts at.")
    end: str = Field(description="Point that it ends at.")
    length: PositiveLength = Field(description="Between the two.")
    redundant: bool = Field(
        False,
        description="Whether the mechanism would move alike without it: its length is then checked, "
        "and not used.",
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.start == self.end:
            yield fault("end", found=self.end, expected="another point than the start")
