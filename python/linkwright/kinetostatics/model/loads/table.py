"""Loads by tables: over the position of a slide, the angle of a link, the angle or the speed of the crank."""

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import Literal

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import fault
from linkwright.kernel.description.curve import curve_faults
from linkwright.kernel.units import Angles, Forces, Lengths, Speeds, Torques
from linkwright.kinetostatics.model.loads.force import Load

# A curve over one revolution may close exactly; printed degrees and π are rounded.
_ONE_TURN = 2 * math.pi * (1 + 1e-9)


class ForcePosition(Load):
    """A force on what moves along a guide, against its motion; it depends on the position and on the way.

    It acts on sliders, yokes, linear drivers, racks, joints on a guide and followers. The position counts
    along the guide from the foot of the point that the guide passes through. Between the given points the
    force is linear, and constant outside them.
    """

    kind: Literal["force_position"]
    on: str = Field(description="Point on a guide that it acts on.")
    position: Lengths = Field(description="Positions along the guide, increasing.")
    forward: Forces = Field(description="Force at each position while it moves forward.")
    return_: Forces | None = Field(
        None, alias="return", description="Force at each position on the way back. Default: none."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        return curve_faults(self, "position", ("forward", "return_"))


class TorqueSwing(Load):
    """A torque on a link that swings, against its motion; it depends on the angle of the link and on the way.

    Between the given angles the torque is linear, and constant outside them; angles count from the x
    axis and span at most a revolution.
    """

    kind: Literal["torque_swing"]
    on: str = Field(description="Link that it acts on.")
    angle: Angles = Field(description="Angles of the link, increasing.")
    forward: Torques = Field(description="Torque at each angle while the link turns counter-clockwise.")
    return_: Torques | None = Field(
        None, alias="return", description="Torque at each angle on the way back. Default: none."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from curve_faults(self, "angle", ("forward", "return_"))
        span = self.angle[-1] - self.angle[0] if self.angle else 0.0
        if span > _ONE_TURN:
            expected = "angles within one revolution"
            yield fault("angle", found=f"{math.degrees(span):.6g} deg", expected=expected)

    def as_formulas(self) -> Iterator[tuple[str, dict[str, float]]]:
        """Formulas with their constants whose sum is the torque, so that it enters the motion as these do.

        For each way the first torque, and for each piece of the table how much it changes it.
        """
        # Angles are known within half a revolution to both sides of the middle of the table.
        middle = 0.5 * (self.angle[0] + self.angle[-1])
        for torques, sense in ((self.forward, "-step(psi_dot)"), (self.return_, "step(-psi_dot)")):
            if torques is None:
                continue
            if torques[0]:
                yield f"{sense}*first", {"first": torques[0]}
            pieces = zip(pairwise(self.angle), pairwise(torques), strict=True)
            for (low, high), (before, after) in pieces:
                if after != before:
                    slope = (after - before) / (high - low)
                    ends = {"low": low - middle, "high": high - middle}
                    yield f"{sense}*{_PIECE}", {"slope": slope, "middle": middle, **ends}


# How much a piece of a table changes its value.
_PIECE = "slope*(min(max(atan2(sin(psi - middle), cos(psi - middle)), low), high) - low)"


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
    """A load torque on the crankshaft by its speed, linear between the given speeds, constant outside."""

    kind: Literal["torque_speed"]
    speed: Speeds = Field(description="Speeds of the crankshaft, increasing.")
    torque: Torques = Field(description="Torque at each speed.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        return curve_faults(self, "speed", ("torque",))
