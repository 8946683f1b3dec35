"""What a knife of a topper shall reach, and the bounds within which the best is sought."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, fault
from linkwright.kernel.units import (
    ANGLE,
    INSIDE_ONE,
    RATIO,
    VELOCITY,
    Bound,
    Quantity,
    not_negative,
    positive,
    worded,
)
from linkwright.linkages.model.element import PositiveLength

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

    complete_min: Share = Field(0.95, description="Share of heads that have to be cut right through.")
    haulm_max: Share | None = Field(
        None, description="Maximum mean share of the head that may be left. Without it, any."
    )
    slicing_min: Annotated[float, not_negative(RATIO)] | None = Field(
        None,
        description="Minimum mean draw-cut ratio: speed along the edge over that normal to it. Without it, "
        "the shortest edge rests across the row.",
    )
    length_max: PositiveLength | None = Field(
        None,
        description="Maximum length of the edge. Without it, any; for the fastest, edge_length.",
    )
    angle_min: Slant = Field(0.0, description="Minimum angle of the edge.")
    angle_max: Slant = Field(math.radians(60), description="Maximum angle of the edge.")
    knife_speed_min: Speed = Field(0.0, description="Minimum speed of the knife.")
    knife_speed_max: Speed = Field(1.0, description="Maximum speed of the knife.")
    forward_speed_min: Annotated[float, positive(VELOCITY)] = Field(
        0.5, description="Minimum speed along the row, where the fastest is sought."
    )
    forward_speed_max: Annotated[float, positive(VELOCITY)] = Field(
        4.0, description="Maximum speed along the row, likewise."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        for key, kind in (("angle", ANGLE), ("knife_speed", VELOCITY), ("forward_speed", VELOCITY)):
            least, greatest = getattr(self, f"{key}_min"), getattr(self, f"{key}_max")
            if least > greatest:
                expected = f"at least {key}_min, {worded(least, kind)}"
                yield fault(f"{key}_max", found=greatest, expected=expected)
