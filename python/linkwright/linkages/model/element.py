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

Cylinders are in `linkages/model/cylinder.py`.
"""

import math
from collections.abc import Iterator
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, Description, fault
from linkwright.kernel.description.formula import NUMBERS, parse
from linkwright.kernel.description.formula_faults import constant_faults, text_faults
from linkwright.kernel.numerics.formula_value import value as formula_value
from linkwright.kernel.units.kinds import ANGLE, COUNT, LENGTH, Kind
from linkwright.kernel.units.marks import Angle, AnyQuantity, Length, positive
from linkwright.kernel.units.reading import worded

PositiveLength = Annotated[float, positive(LENGTH)]
PositiveNumber = Annotated[float, positive(COUNT)]

# One revolution of the crankshaft.
TURN = 2 * math.pi

# Sine of the angle between two directions below which they are parallel.
_PARALLEL = 1e-9


class FixedPoint(Description):
    """A point of the frame."""

    x: Length = Field(0.0, description="x coordinate, positive to the right of the origin.")
    y: Length = Field(0.0, description="y coordinate, positive above the origin.")


class Guide(Description):
    """A straight guide, on the frame or on a link that moves."""

    shown_with_part: ClassVar[bool] = True

    through: str | None = Field(
        None,
        description="Point on the guide at zero offset, on the body of the guide. Default: the start of "
        "the link, or the origin.",
    )
    on: str | None = Field(None, description="Link that carries the guide. Default: the frame.")
    angle: Angle = Field(
        0.0, description="Direction of the guide, measured from the direction of the link or from the x axis."
    )
    offset: Length = Field(0.0, description="Offset of the guide, positive to the left of its direction.")


# Numbers of a formula by name.
Constants = dict[str, Annotated[float, AnyQuantity()]]


# Share of the peak absolute value of a law by which its advance may differ from `advance`.
_CLOSES = 1e-6


def law_faults(
    law: str | None, constants: Constants, advance: float | None, kind: Kind
) -> Iterator[InitErrorDetails]:
    """Faults of a formula of the crank angle, and of what it says that it advances per cycle."""
    yield from constant_faults(constants, law or "")
    if law is None:
        if constants:
            yield fault("law", expected="a law that asks for the constants")
        if advance is not None:
            yield fault("advance", found=advance, expected="a law that advances, or nothing")
        return
    wrong = list(text_faults("law", law, constants, ("phi",)))
    yield from wrong
    if advance is not None and not wrong:
        names = {**NUMBERS, **constants, "phi": np.array([0.0, TURN])}
        with np.errstate(all="ignore"):
            ends = np.asarray(formula_value(parse(law), names) * np.ones(2), dtype=float)
        advances = float(ends[1] - ends[0])
        rounding = _CLOSES * max(1e-3, *np.abs(ends))
        advances = 0.0 if abs(advances) <= rounding else advances
        if not abs(advances - advance) <= rounding:
            said, done = worded(advance, kind), worded(advances, kind)
            remedy = f'advance = "{done}", or a law that ends {said} above its start'
            yield fault("advance", found=said, expected=f"{done}, from phi = 0 to 2*pi", remedy=remedy)


class Crank(CheckedDescription):
    """A crank; its angle is that of the crankshaft, or follows it by a law."""

    radius: PositiveLength = Field(description="Distance from pivot to pin.")
    phase: Angle = Field(0.0, description="Angle of this crank at crank angle zero.")
    pivot: str | None = Field(None, description="Fixed pivot. Default: the origin.")
    law: str | None = Field(
        None,
        description='Angle of the crank in rad as a formula in phi; the phase is added. "0.6*sin(phi)" '
        "oscillates. phi continues beyond 2*pi; pi - atan2(sin(phi), -cos(phi)) restarts in every "
        "revolution. Default: phi.",
    )
    constants: Constants = Field(
        default_factory=dict, description="Constants of the law by name, in any unit."
    )
    advance: Angle | None = Field(
        None,
        description="Advance of the law per cycle: it then restarts in every revolution, and the "
        "steps add up; 0 for a law that repeats. Default: phi continues beyond 2*pi.",
    )
    pushed: ClassVar[bool] = False  # whether the contact with a cam moves it

    def follows(self) -> Any:
        """Cam or axis whose `lift`, `phase` and `advance` it follows; None where it is moved otherwise."""
        return None

    def _faults(self) -> Iterator[InitErrorDetails]:
        return law_faults(self.law, self.constants, self.advance, ANGLE)


class LinearDriver(CheckedDescription):
    """A point that the drive moves along a guide, in proportion to the crank angle or by a law."""

    guide: Guide = Field(default_factory=Guide, description="Guide of the motion.")
    start: Length = Field(0.0, description="Position along the guide at crank angle zero.")
    per_turn: Length | None = Field(None, description="Travel per revolution of the crankshaft.")
    law: str | None = Field(None, description="Travel from the start in m as a formula in phi.")
    constants: Constants = Field(
        default_factory=dict, description="Constants of the law by name, in any unit."
    )
    advance: Length | None = Field(None, description="Advance of the law per cycle, as that of a crank.")
    pushed: ClassVar[bool] = False  # whether the contact with a cam moves it

    def follows(self) -> Any:
        """Cam or axis whose `lift`, `phase` and `advance` it follows; None where it is moved otherwise."""
        return None

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from law_faults(self.law, self.constants, self.advance, LENGTH)
        if self.law is not None and self.per_turn is not None:
            yield fault(found="both", expected="either per_turn or law")


class Slider(Description):
    """A slider on a straight guide, moved through a rod."""

    crank: str = Field(description="Driving point: a crank pin or another moving point.")
    rod: PositiveLength = Field(
        description="Length of the connecting rod, from the driving point to the slider."
    )
    offset: Length = Field(0.0, description="Offset of the guide, positive to the left of its direction.")
    angle: Angle = Field(
        0.0, description="Direction of the guide, measured from the x axis or from the link that carries it."
    )
    through: str | None = Field(
        None,
        description="Point on the guide at zero offset. Default: the pivot of the crank, or the origin; "
        "on a link, its start.",
    )
    on: str | None = Field(None, description="Link that carries the guide. Default: the frame.")
    assembly: Literal["positive", "negative"] = Field(
        "positive",
        description="Assembly mode: side of the driving point on which the slider lies, along the guide.",
    )


class Rocker(Description):
    """A coupler and a rocker that meet in a joint."""

    crank: str = Field(description="Driving point of the coupler.")
    pivot: str = Field(description="Pivot of the rocker; it may move.")
    coupler: PositiveLength = Field(description="Length of the coupler, from the driving point to the joint.")
    rocker: PositiveLength = Field(description="Length of the rocker, from the pivot to the joint.")
    assembly: Literal["left", "right"] = Field(
        "left",
        description="Assembly mode: side of the joint, looking from the driving point to the pivot; with "
        "change points, at small positive crank angles.",
    )


class SlottedLever(Description):
    """A lever whose slot is moved by a pin, or a cylinder whose rod ends at the pin."""

    pin: str = Field(description="Moving point that slides in the slot.")
    pivot: str = Field(description="Pivot of the lever; it may move.")
    offset: Length = Field(0.0, description="Offset of the slot, positive to the left of the pivot.")
    length: PositiveLength | None = Field(
        None, description="Length of the lever, for its mass and the drawing."
    )
    assembly: Literal["ahead", "behind"] = Field(
        "ahead", description='Assembly mode: lever towards the pin ("ahead") or away from it ("behind").'
    )


class Crossing(Description):
    """A pin that two guides hold."""

    first: Guide = Field(description="First guide of the pin.")
    second: Guide = Field(description="Second guide of the pin.")


class Yoke(CheckedDescription):
    """A body on a guide, moved by a pin in its slot."""

    pin: str = Field(description="Moving point in the slot.")
    guide: Guide = Field(default_factory=Guide, description="Guide of the body.")
    slot: Angle = Field(math.pi / 2, description="Direction of the slot, measured from the guide.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        if abs(math.sin(self.slot)) < _PARALLEL:
            expected = "an angle across the guide, such as 90°"
            yield fault("slot", found=f"{math.degrees(self.slot):.6g}°", expected=expected)


class RigidPoint(Description):
    """A point fixed to a link."""

    link: str = Field(description="Link that carries it.")
    along: Length = Field(description="Distance along the link from its start.")
    across: Length = Field(0.0, description="Distance from the line of the link, positive to the left.")


class Gear(CheckedDescription):
    """A gear, or a pulley, that turns in proportion to another."""

    kind: Literal["external", "internal", "belt", "crossed_belt"] = Field(
        "external",
        description="External gears, internal gears, belt or chain, or crossed belt; external gears and a "
        "crossed belt reverse the sense of rotation.",
    )
    pivot: str = Field(description="Pivot of the gear.")
    meshes: str | None = Field(None, description="Link of the other gear. Default: the other gear is fixed.")
    carrier: str | None = Field(
        None,
        description="Link that carries both pivots: the arm of a planetary gear train. Default: the frame.",
    )
    size: PositiveNumber = Field(description="Number of teeth, or radius in the unit of `size_other`.")
    size_other: PositiveNumber = Field(description="Number of teeth or radius of the other gear.")
    phase: Angle = Field(
        0.0, description="Angle of this gear when the angles of the other gear and the carrier are zero."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.kind == "internal" and self.size == self.size_other:
            remedy = "one gear turns inside the other"
            yield fault("size", found=self.size, expected="another size than size_other", remedy=remedy)


class Rack(Description):
    """A rack moved along its guide by a gear."""

    gear: str = Field(description="Link that carries the gear.")
    radius: PositiveLength = Field(description="Pitch radius of the gear.")
    guide: Guide = Field(default_factory=Guide, description="Guide of the motion.")
    start: Length = Field(0.0, description="Position along the guide at gear angle zero.")
    side: Literal["right", "left"] = Field(
        "right",
        description="Side of the gear on which the pitch line of the rack lies, looking along the guide.",
    )


class Cable(Description):
    """The end of a cable or belt that runs off an arc about the start of a link."""

    link: str = Field(description="Link that carries the arc.")
    radius: PositiveLength = Field(description="Radius of the arc, centred at the start of the link.")
    length: Length = Field(description="Free length of the cable at the reference angle of the link.")
    reference: Angle = Field(0.0, description="Reference angle of the link.")
    angle: Angle = Field(-math.pi / 2, description="Direction in which the cable leaves the arc.")
    side: Literal["left", "right"] = Field(
        "left",
        description="Side of the link's start on which the cable leaves the arc, looking in that direction.",
    )


class Joint(Description):
    """A joint held by bars and at most one guide; its place follows from them."""

    x: Length = Field(description="Approximate x coordinate at `assembled_at`.")
    y: Length = Field(description="Approximate y coordinate at `assembled_at`.")
    guide: Guide | None = Field(None, description="Guide of the joint.")


class Bar(CheckedDescription):
    """A link of given length between two points."""

    start: str = Field(description="Point at the start of the bar.")
    end: str = Field(description="Point at the end of the bar.")
    length: PositiveLength = Field(description="Distance between the two points.")
    redundant: bool = Field(
        False,
        description="Redundant bar: its length is checked but not used.",
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.start == self.end:
            yield fault("end", found=self.end, expected="another point than the start")
