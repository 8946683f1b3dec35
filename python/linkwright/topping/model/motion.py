"""How the knife of a topper is moved back and forth across the row."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, Description, fault
from linkwright.kernel.units import Angle
from linkwright.linkages.model.element import PositiveLength


class KnifeMotion(Description):
    """What all motions have."""

    phase: Angle | None = Field(
        None,
        description="Phase of the motion when the middle of the edge is abreast of the head's centre. "
        "Without it, every phase is looked at.",
    )


class ConstantKnife(KnifeMotion, CheckedDescription):
    """The same speed across the row, back and forth."""

    kind: Literal["constant"] = Field(description="Constant speed.")
    stroke: PositiveLength | None = Field(
        None,
        description="Distance between the ends. Without it, the knife does not turn back over a head: the "
        "worse of the two directions is looked at.",
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.phase is not None and self.stroke is None:
            remedy = "a knife that does not turn back has no phase: give the stroke, or leave the phase out"
            yield fault("phase", found=self.phase, expected="nothing", remedy=remedy)


class HarmonicKnife(KnifeMotion):
    """A sine."""

    kind: Literal["harmonic"] = Field(description="A sine.")
    stroke: PositiveLength = Field(description="Distance between the ends.")


class MemberKnife(KnifeMotion):
    """The knife is a slide of the mechanism, moved by the crank at its design speed."""

    kind: Literal["member"] = Field(description="Moved by the mechanism.")
    of: str = Field(description="Coordinate along a guide: a slider, yoke, rack, linear driver or follower.")


AnyKnifeMotion = Annotated[ConstantKnife | HarmonicKnife | MemberKnife, Field(discriminator="kind")]
