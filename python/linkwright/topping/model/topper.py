r"""The topper of a root-crop harvester: a knife that reciprocates across the row and slices heads off.

It has the heads, the way in which the knife is moved, what the knife shall reach, and bounds of the best one.

| letter of paper 5 | is | key |
| --- | --- | --- |
| D | diameter of the root | `root_diameter` |
| h_p | height of the slice, from the top of the root to the plane of the cut | `cut_height` |
| Δ | maximum distance of a root's axis from the axis of the row | `offset` |
| α | angle of the edge to the transverse axis | `edge_angle` |
| L_h | working length of the edge | `edge_length` |
| v, v_h | speed of the machine along, of the knife across the row | `forward_speed`, `knife_speed` |

The root is a sphere; the plane of the cut meets it in the disc of the head, of diameter

.. math:: d = 2\sqrt{h_p (D - h_p)}.

References
----------
.. [1] Paper 5.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Annotated, Literal

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, Description, fault, suggestion
from linkwright.kernel.description.place import look
from linkwright.kernel.units.kinds import ANGLE, LENGTH, RATIO, VELOCITY
from linkwright.kernel.units.marks import INSIDE_ONE, Angle, Bound, Quantity, not_negative, positive
from linkwright.kernel.units.reading import worded
from linkwright.linkages.model.element import PositiveLength
from linkwright.topping.model.field import AnyField, field_faults

# An edge along the row crosses nothing ahead of it; beyond 80° it would be six times as long as across.
_STEEPEST = math.radians(80)
_SLANT = Bound(
    " between -80 and 80 deg,",
    {"minimum": -_STEEPEST, "maximum": _STEEPEST},
    lambda value: abs(value) <= _STEEPEST + 1e-12,
)
Slant = Annotated[float, Quantity(ANGLE, _SLANT)]
Share = Annotated[float, Quantity(RATIO, INSIDE_ONE)]
Speed = Annotated[float, not_negative(VELOCITY)]


class TopperLimits(CheckedDescription):
    """Limits of the best knife, and where it is sought."""

    complete_min: Share = Field(0.95, description="Minimum share of heads cut through.")
    haulm_max: Share | None = Field(
        None, description="Maximum mean uncut share of the head. Default: no limit."
    )
    slicing_min: Annotated[float, not_negative(RATIO)] | None = Field(
        None,
        description="Minimum mean draw-cut ratio: speed along the edge over speed normal to it. Default: "
        "none; the shortest edge then stands still, square to the row.",
    )
    length_max: PositiveLength | None = Field(
        None,
        description="Maximum length of the edge. Default: no limit; for the maximum forward speed, "
        "edge_length.",
    )
    angle_min: Slant = Field(0.0, description="Minimum angle of the edge.")
    angle_max: Slant = Field(math.radians(60), description="Maximum angle of the edge.")
    knife_speed_min: Speed = Field(0.0, description="Minimum speed of the knife.")
    knife_speed_max: Speed = Field(1.0, description="Maximum speed of the knife.")
    forward_speed_min: Annotated[float, positive(VELOCITY)] = Field(
        0.5, description="Minimum forward speed, in a search for the maximum forward speed."
    )
    forward_speed_max: Annotated[float, positive(VELOCITY)] = Field(
        4.0, description="Maximum forward speed, likewise."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        for key, kind in (("angle", ANGLE), ("knife_speed", VELOCITY), ("forward_speed", VELOCITY)):
            least, greatest = getattr(self, f"{key}_min"), getattr(self, f"{key}_max")
            if least > greatest:
                expected = f"at least {key}_min, {worded(least, kind)}"
                yield fault(f"{key}_max", found=greatest, expected=expected)


class KnifeMotion(Description):
    """What all motions have."""

    phase: Angle | None = Field(
        None,
        description="Phase of the motion when the middle of the edge is abreast of the head's centre. "
        "Default: all phases.",
    )


class ConstantKnife(KnifeMotion, CheckedDescription):
    """The same speed across the row, back and forth."""

    kind: Literal["constant"] = Field(description="Constant speed.")
    stroke: PositiveLength | None = Field(
        None,
        description="Stroke of the knife. Default: no reversal over a head; the less favourable direction "
        "counts.",
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.phase is not None and self.stroke is None:
            remedy = "a knife that does not turn back has no phase: give the stroke, or leave the phase out"
            yield fault("phase", found=self.phase, expected="nothing", remedy=remedy)


class HarmonicKnife(KnifeMotion):
    """A sine."""

    kind: Literal["harmonic"] = Field(description="Harmonic motion.")
    stroke: PositiveLength = Field(description="Stroke of the knife.")


class MemberKnife(KnifeMotion):
    """The knife is a slide of the mechanism, moved by the crank at its design speed."""

    kind: Literal["member"] = Field(description="Motion of a member of the mechanism.")
    of: str = Field(description="Coordinate along a guide: a slider, yoke, rack, linear driver or follower.")


AnyKnifeMotion = Annotated[ConstantKnife | HarmonicKnife | MemberKnife, Field(discriminator="kind")]


# An edge along the row crosses nothing ahead of it.
_ACROSS = Bound(
    " between -90 and 90 deg,",
    {"exclusiveMinimum": -math.pi / 2, "exclusiveMaximum": math.pi / 2},
    lambda value: abs(math.sin(value)) < 1 and abs(value) < math.pi / 2,
)


class Topper(CheckedDescription):
    """Heads of roots in a row, and the knife that tops them."""

    root_diameter: PositiveLength = Field(description="Diameter D of the root.")
    cut_height: PositiveLength = Field(
        description="Cut height h_p: distance from the top of the root down to the plane of the cut."
    )
    offset: Annotated[float, not_negative(LENGTH)] = Field(
        0.0, description="Maximum distance Δ of the root's axis from the axis of the row, to either side."
    )
    edge_angle: Annotated[float, Quantity(ANGLE, _ACROSS)] = Field(
        0.0, description="Angle α of the edge to the transverse axis; positive where its left end leads."
    )
    edge_length: PositiveLength = Field(description="Working length L of the edge.")
    forward_speed: Annotated[float, positive(VELOCITY)] = Field(description="Speed v along the row.")
    knife_speed: Annotated[float, not_negative(VELOCITY)] | None = Field(
        None,
        description="Mean speed v_h of the knife across the row; at 0 it stands at mid-stroke, or at the "
        "given phase. With a mechanism, the speed follows from it.",
    )
    motion: AnyKnifeMotion = Field(description="Motion of the knife across the row.")
    field: AnyField | None = Field(None, description="Scatter of the roots.")
    limits: TopperLimits = Field(default_factory=TopperLimits, description="Limits of the best knife.")

    @property
    def has_cycle(self) -> bool:
        """Whether the knife goes back and forth, or rests."""
        is_one_way = isinstance(self.motion, ConstantKnife) and self.motion.stroke is None
        return not (is_one_way and self.knife_speed)

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.cut_height >= self.root_diameter:
            expected = f"less than root_diameter, {self.root_diameter:.6g} m"
            remedy = "such a deep cut passes below the root"
            yield fault("cut_height", found=self.cut_height, expected=expected, remedy=remedy)
        is_moved = isinstance(self.motion, MemberKnife)
        if is_moved and self.knife_speed is not None:
            remedy = "the mechanism and drive.speed give the speed of the knife"
            yield fault("knife_speed", found=self.knife_speed, expected="nothing", remedy=remedy)
        if not is_moved and self.knife_speed is None:
            remedy = "the mean over the time, 2 · stroke · frequency"
            yield fault("knife_speed", expected="a velocity (m/s) of 0 or more", remedy=remedy)
        if self.field is not None:
            yield from field_faults(self.field, has_cycle=self.has_cycle, phase=self.motion.phase)


def topper_faults(machine: object, slides: Sequence[str]) -> Iterator[InitErrorDetails]:
    """What is wrong with a topper: its knife follows no slide of the mechanism, or no speed is known."""
    motion = look(look(machine, "topper"), "motion")
    if look(motion, "kind") != "member":
        return
    name = look(motion, "of")
    if isinstance(name, str) and name not in slides:
        remedy = suggestion(name, slides) or "give the mechanism a slider"
        expected = "a coordinate along a guide of the mechanism"
        yield fault("topper", "motion", "of", found=name, expected=expected, remedy=remedy)
    if look(look(machine, "drive"), "speed") is None:
        remedy = "the speed of the knife follows from it"
        yield fault("drive", "speed", expected="an angular speed (rad/s)", remedy=remedy)
