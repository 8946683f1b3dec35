r"""The worm-type rotator of a sucker-rod string: a lever on the hanger, pulled by a link from the beam.

| letter of paper 4 | is | key |
| --- | --- | --- |
| r, L, k, k_1 | crank, pitman, arms of the beam | `R`, `P`, `C`, `A` of the pumping unit |
| l_K | free cable at the top of the stroke | `cable` of the pumping unit |
| l_3 | saddle bearing to the link's pin on the beam | `pin_distance` |
| l_4 | link | `link_length` |
| l_5 | lever | `lever_length` |

With Y the depth of the hanger below the saddle and φ_3 the angle of the front arm above the horizontal, the
distance l_d from the pin to the hanger is

.. math::

    l_d^2 = (Y + l_3\sin\varphi_3)^2 + (k_1 - l_3\cos\varphi_3)^2, \qquad
    \frac{d\,l_d^2}{d\varphi_3} = -2\,(k_1 - l_3\cos\varphi_3)\,Y,

so for :math:`l_3 < k_1` it falls steadily while the beam rises: its extremes are those of the beam, m at the
top and M at the bottom. Lengths that are not given are made for these (`rotator_lengths`).

References
----------
.. [1] Paper 4, equations (3) to (7); the derivative of l_d is derived here.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import Field, model_validator
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import Description, fault, raise_faults
from linkwright.kernel.units.kinds import ANGLE, RATIO, TORQUE
from linkwright.kernel.units.marks import FRACTION, Bound, Quantity, not_negative, positive
from linkwright.linkages.model.element import PositiveLength
from linkwright.pumping.model.unit import PumpingUnit

# Names of the parts that a rotator expands into.
PIN, ROTATOR = "rotator_pin", "rotator"
LINK, LEVER = f"{ROTATOR}.coupler", f"{ROTATOR}.rocker"

# A lever that swings through half a revolution comes into line with its link.
_SWING = Bound(
    " between 0 and 180 deg,",
    {"exclusiveMinimum": 0, "exclusiveMaximum": np.pi},
    lambda value: 0 < value < np.pi,
)


class RodRotator(Description):
    """A rotator of the rod string on the hanger of a pumping unit."""

    regime: Literal["continuous", "intermittent"] = Field(
        description='"continuous": the lever rotates fully in each stroke; "intermittent": it oscillates '
        "and drives through a clutch."
    )
    pin_distance: PositiveLength = Field(
        description="Distance l_3 from saddle bearing to the pin of the link on the front arm."
    )
    link_length: PositiveLength | None = Field(
        None, description="Length l_4 of the link. Default: suited to the regime."
    )
    lever_length: PositiveLength | None = Field(
        None, description="Length l_5 of the lever. Default: suited to the regime."
    )
    swing: Annotated[float, Quantity(ANGLE, _SWING)] | None = Field(
        None, description="Required swing of the lever in the intermittent regime. Default: 90 deg."
    )
    assembly: Literal["left", "right"] = Field(
        "left",
        description="Assembly mode: side of the joint of link and lever, looking from the pin to the hanger.",
    )
    worm_ratio: Annotated[float, positive(RATIO)] | None = Field(
        None, description="Revolutions of the worm per revolution of the rod string."
    )
    worm_efficiency: Annotated[float, Quantity(RATIO, FRACTION)] = Field(
        1.0, description="Efficiency of the worm gear, worm driving."
    )
    string_torque: Annotated[float, not_negative(TORQUE)] | None = Field(
        None, description="Torque required to turn the rod string."
    )
    clutch: Literal["upstroke", "downstroke"] = Field(
        "downstroke",
        description="Stroke in which the lever drives the worm, in the intermittent regime.",
    )

    @model_validator(mode="after")
    def _entries_fit(self) -> Self:
        raise_faults("RodRotator", self._faults())
        return self

    def _faults(self) -> Iterator[InitErrorDetails]:
        given = [self.link_length is not None, self.lever_length is not None]
        if self.swing is not None and (self.regime == "continuous" or any(given)):
            remedy = "a swing is wanted of an intermittent rotator without given lengths"
            yield fault("swing", found=self.swing, expected="nothing", remedy=remedy)
        if given[0] != given[1]:
            key = "lever_length" if given[0] else "link_length"
            yield fault(key, expected="a length: link_length and lever_length are given together")


def diagonal(unit: PumpingUnit, rotator: RodRotator, front: Any) -> tuple[Any, Any]:
    """Distance from the pin to the hanger along x, and the hanger below the pin.

    ``front`` (n,): angle of the front arm above the horizontal [rad] → l_dx and l_dy of paper 4 [m]; x points
    to the well.
    """
    top = unit.front_angle(unit.psi_top)
    l_3 = rotator.pin_distance
    depth = unit.cable + unit.A * (top - front)
    return unit.A - l_3 * np.cos(front), depth + l_3 * np.sin(front)


def diagonal_extremes(unit: PumpingUnit, rotator: RodRotator) -> tuple[Any, Any]:
    """Minimum and maximum distance from the pin to the hanger, m at the top and M at the bottom [m]."""
    ends = (unit.front_angle(psi) for psi in (unit.psi_top, unit.psi_bottom))
    top, bottom = (np.hypot(*diagonal(unit, rotator, end)) for end in ends)
    return top, bottom
