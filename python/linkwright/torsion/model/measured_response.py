"""A measured response of a train over the speed, to be laid over the computed one."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Annotated, Literal

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, fault
from linkwright.kernel.units.kinds import ANGLE, PRESSURE, TORQUE
from linkwright.kernel.units.marks import not_negative
from linkwright.linkages.model.element import PositiveNumber
from linkwright.torsion.model.train_base import PositiveSpeed

# What may be measured, one of them.
MEASURED = ("stress", "torque", "angle")


class MeasuredResponse(CheckedDescription):
    """Amplitudes measured at some speeds: of all orders together half the peak-to-peak value."""

    kind: Literal["response"] = Field("response", description="Kind of the table.")
    on: str = Field(description="Shaft (stress, torque) or disc (angle) that was measured.")
    order: PositiveNumber | None = Field(
        None,
        description="Order of the first disc, if a single order was measured. Default: all orders together.",
    )
    speed: tuple[PositiveSpeed, ...] = Field(description="Speeds of the first disc, increasing.")
    stress: tuple[Annotated[float, not_negative(PRESSURE)], ...] | None = Field(
        None, description="Vibratory shear stress at these speeds."
    )
    torque: tuple[Annotated[float, not_negative(TORQUE)], ...] | None = Field(
        None, description="Vibratory torque at these speeds."
    )
    angle: tuple[Annotated[float, not_negative(ANGLE)], ...] | None = Field(
        None, description="Torsional vibration angle at these speeds."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        given = [name for name in MEASURED if getattr(self, name) is not None]
        if len(given) != 1:
            found = " and ".join(given) or "none"
            yield fault(found=found, expected="one of stress, torque and angle")
            return
        if len(self.speed) < 2:
            yield fault("speed", found=f"{len(self.speed)} of them", expected="at least two speeds")
        if len(self.values) != len(self.speed):
            found, expected = f"{len(self.values)} of them", f"as many as speeds, {len(self.speed)}"
            yield fault(given[0], found=found, expected=expected)
        for n, (before, here) in enumerate(pairwise(self.speed), start=1):
            if here <= before:
                expected = f"more than the speed before, {before:.6g} rad/s"
                yield fault("speed", n, found=here, expected=expected)
                return

    @property
    def what(self) -> str:
        """Stress, torque or angle."""
        return next(name for name in MEASURED if getattr(self, name) is not None)

    @property
    def values(self) -> tuple[float, ...]:
        """What was measured, one for each speed; SI."""
        values: tuple[float, ...] = getattr(self, self.what)
        return values
