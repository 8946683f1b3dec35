"""Loads by tables: force over a slider's position, torque over the angle or the speed of the crank."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Literal

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import fault
from linkwright.kernel.description.curve import curve_faults
from linkwright.kernel.units import Angles, Forces, Lengths, Speeds, Torques
from linkwright.kinetostatics.model.loads.base import Load

# A curve over one revolution may close exactly; printed degrees and π are rounded.
_ONE_TURN = 2 * math.pi * (1 + 1e-9)


class ForcePosition(Load):
    """A force on a slider against its motion, which depends on the position and on the way.

    The position counts along the guide from the foot of the point that the guide passes through. Between the
    given points the force is linear, outside them the end values hold.
    """

    kind: Literal["force_position"]
    on: str = Field(description="Slider that it acts on.")
    position: Lengths = Field(description="Positions along the guide, increasing.")
    forward: Forces = Field(description="Force at each position while the slider moves forward.")
    return_: Forces | None = Field(
        None, alias="return", description="Force at each position on the way back. Without it, none."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        return curve_faults(self, "position", ("forward", "return_"))


class TorqueAngle(Load):
    """A load torque on the crankshaft over one revolution, linear between the given angles."""

    kind: Literal["torque_angle"]
    angle: Angles = Field(description="Crank angles, increasing, within one revolution.")
    torque: Torques = Field(description="Torque at each angle.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from curve_faults(self, "angle", ("torque",))
        span = self.angle[-1] - self.angle[0] if self.angle else 0.0
        if span > _ONE_TURN:
            yield fault(
                "angle", found=f"{math.degrees(span):.6g} deg", expected="angles within one revolution"
            )
        elif span >= 2 * math.pi * (1 - 1e-9) and self.torque and self.torque[0] != self.torque[-1]:
            expected = f"{self.torque[0]:.6g} N m, as at the first angle, one revolution before"
            yield fault("torque", len(self.torque) - 1, found=self.torque[-1], expected=expected)


class TorqueSpeed(Load):
    """A load torque on the crankshaft by its speed, linear between the given speeds, end values held."""

    kind: Literal["torque_speed"]
    speed: Speeds = Field(description="Speeds of the crankshaft, increasing.")
    torque: Torques = Field(description="Torque at each speed.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        return curve_faults(self, "speed", ("torque",))
