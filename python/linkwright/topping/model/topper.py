r"""The topper of a root-crop harvester: a knife that reciprocates across the row and slices heads off.

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
from typing import Annotated

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, fault, suggestion
from linkwright.kernel.description.plain import look
from linkwright.kernel.units import ANGLE, LENGTH, VELOCITY, Bound, Quantity, not_negative, positive
from linkwright.linkages.model.element import PositiveLength
from linkwright.topping.model.field import AnyField, field_faults
from linkwright.topping.model.limits import TopperLimits
from linkwright.topping.model.motion import AnyKnifeMotion, ConstantKnife, MemberKnife

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
        description="Height h_p of the slice, from the top of the root down to the plane of the cut."
    )
    offset: Annotated[float, not_negative(LENGTH)] = Field(
        0.0, description="Maximum distance Δ of a root's axis from the axis of the row, on either side."
    )
    edge_angle: Annotated[float, Quantity(ANGLE, _ACROSS)] = Field(
        0.0, description="Angle α of the edge to the transverse axis; positive where its left end leads."
    )
    edge_length: PositiveLength = Field(description="Working length L of the edge.")
    forward_speed: Annotated[float, positive(VELOCITY)] = Field(description="Speed v along the row.")
    knife_speed: Annotated[float, not_negative(VELOCITY)] | None = Field(
        None,
        description="Mean speed v_h of the knife across the row; at 0 it stands at mid-stroke, or where "
        "a given phase puts it. A mechanism gives it itself.",
    )
    motion: AnyKnifeMotion = Field(description="How the knife moves across the row.")
    field: AnyField | None = Field(None, description="Roots that are not all alike.")
    limits: TopperLimits = Field(default_factory=TopperLimits, description="What the best knife has to keep.")

    @property
    def has_cycle(self) -> bool:
        """Whether the knife goes back and forth, or rests."""
        is_one_way = isinstance(self.motion, ConstantKnife) and self.motion.stroke is None
        return not (is_one_way and self.knife_speed)

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.cut_height >= self.root_diameter:
            expected = f"less than root_diameter, {self.root_diameter:.6g} m"
            remedy = "so deep a cut passes below the root"
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
    """What is wrong between a topper and the mechanism that moves its knife.

    Parameters
    ----------
    machine : object
        The machine, checked or raw.
    slides : sequence of str
        Names of the coordinates along guides.

    Yields
    ------
    InitErrorDetails
        The knife follows no slide of the mechanism, or the crank has no speed.
    """
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
