"""The gearbox of a servo axis: ratio and losses, and what it bears."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.drive.model.drive import Gears
from linkwright.kernel.description.base import CheckedDescription, fault
from linkwright.kernel.units.kinds import LENGTH, SPEED, TORQUE
from linkwright.kernel.units.marks import positive


class AxisGearbox(Gears, CheckedDescription):
    """Gears between a servo motor and the driver of a mechanism."""

    per_turn: Annotated[float, positive(LENGTH)] | None = Field(
        None,
        description="Travel of a linear driver or cylinder per revolution of the gearbox output: lead of the "
        "screw, circumference of the pinion or pulley.",
    )
    torque_max: Annotated[float, positive(TORQUE)] | None = Field(
        None, description="Peak torque permitted at the output. Default: not limited."
    )
    torque_rated: Annotated[float, positive(TORQUE)] | None = Field(
        None, description="Root mean square torque permitted at the output. Default: not limited."
    )
    speed_max: Annotated[float, positive(SPEED)] | None = Field(
        None, description="Maximum speed permitted at the input. Default: not limited."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        if (
            self.torque_max is not None
            and self.torque_rated is not None
            and self.torque_max < self.torque_rated
        ):
            expected = f"at least the rated torque, {self.torque_rated:.6g} N m"
            yield fault("torque_max", found=f"{self.torque_max:.6g} N m", expected=expected)
