"""Loads by tables: over the position of a slide, the angle of a link, the angle or the speed of the crank."""

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Literal

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import fault
from linkwright.kernel.description.curve import curve_faults
from linkwright.kernel.description.cycle import ONE_TURN, CycleAngle, cycle_faults, cycle_turns
from linkwright.kernel.errors import InputError
from linkwright.kernel.numerics.tangent import moves, variables_of
from linkwright.kernel.units.marks import Angles, Forces, Lengths, Speeds, Torques
from linkwright.kinetostatics.model.loads.force import Load

# A table over the whole cycle may close exactly; printed degrees and π are rounded.
_ROUNDED = 1e-9


class ForcePosition(Load):
    """A force on what moves along a guide, against its motion; it depends on the position and on the way.

    It acts on sliders, yokes, linear drivers, racks, joints on a guide and followers. The position counts
    along the guide from the foot of the point that the guide passes through. Between the given points the
    force is linear, and constant outside them.
    """

    kind: Literal["force_position"]
    on: str = Field(description="Point on a guide on which it acts.")
    position: Lengths = Field(description="Positions along the guide, increasing.")
    forward: Forces = Field(description="Force at each position during forward motion.")
    return_: Forces | None = Field(
        None, alias="return", description="Force at each position during return. Default: none."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        return curve_faults(self, "position", ("forward", "return_"))


class TorqueSwing(Load):
    """A torque on a link that swings, against its motion; it depends on the angle of the link and on the way.

    Between the given angles the torque is linear, and constant outside them; angles count from the x
    axis and span at most a revolution.
    """

    kind: Literal["torque_swing"]
    on: str = Field(description="Link on which it acts.")
    angle: Angles = Field(description="Angles of the link, increasing.")
    forward: Torques = Field(description="Torque at each angle during counter-clockwise rotation.")
    return_: Torques | None = Field(
        None, alias="return", description="Torque at each angle during clockwise rotation. Default: none."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from curve_faults(self, "angle", ("forward", "return_"))
        span = self.angle[-1] - self.angle[0] if self.angle else 0.0
        if span > ONE_TURN * (1 + _ROUNDED):
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
            if moves(torques[0]):
                yield f"{sense}*first", {"first": torques[0]}
            pieces = zip(pairwise(self.angle), pairwise(torques), strict=True)
            for (low, high), (before, after) in pieces:
                if moves(after - before):
                    slope = (after - before) / (high - low)
                    ends = {"low": low - middle, "high": high - middle}
                    yield f"{sense}*{_PIECE}", {"slope": slope, "middle": middle, **ends}


# How much a piece of a table changes its value.
_PIECE = "slope*(min(max(atan2(sin(psi - middle), cos(psi - middle)), low), high) - low)"


class OverCrankAngle(Load):
    """A load by a table over the crank angle that repeats after its cycle; linear between the angles."""

    angle: Angles = Field(description="Crank angles, increasing, within one cycle.")
    cycle: CycleAngle = Field(
        ONE_TURN, description="Angle after which the table repeats: 720 deg for a four-stroke engine."
    )

    @property
    def turns(self) -> int:
        """Revolutions after which it repeats."""
        return cycle_turns(self.cycle)

    def points(self, values: Sequence[float]) -> tuple[Sequence[float], Sequence[float]]:
        """Angles [rad] and values without the repetition of the first point at the end of the cycle."""
        ends = self.angle[0], self.angle[-1]
        closes = ends[1] - ends[0] >= self.cycle * (1 - _ROUNDED)
        if closes and variables_of(ends) is not None:
            raise InputError(
                "the table closes: its first and its last angle are one cycle apart, and neither can move "
                "without the other"
            )
        return (self.angle[:-1], values[:-1]) if closes else (self.angle, values)

    def _table_faults(self, key: str, unit: str) -> Iterator[InitErrorDetails]:
        yield from curve_faults(self, "angle", (key,))
        yield from cycle_faults(self.cycle)
        values: tuple[float, ...] = getattr(self, key)
        span = self.angle[-1] - self.angle[0] if self.angle else 0.0
        if span > self.cycle * (1 + _ROUNDED):
            remedy = 'set cycle = "720 deg" if it takes two revolutions'
            found = f"{math.degrees(span):.6g} deg"
            yield fault("angle", found=found, expected="angles within one cycle", remedy=remedy)
        elif span >= self.cycle * (1 - _ROUNDED) and values and values[0] != values[-1]:
            expected = f"{values[0]:.6g} {unit}, as at the first angle, one cycle before"
            yield fault(key, len(values) - 1, found=values[-1], expected=expected)


class TorqueAngle(OverCrankAngle):
    """A load torque on the crankshaft over the crank angle, linear between the given angles."""

    kind: Literal["torque_angle"]
    torque: Torques = Field(description="Torque at each angle.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        return self._table_faults("torque", "N m")


class ForceAngle(OverCrankAngle):
    """A force along a guide over the crank angle, such as that of the gas on a piston.

    It acts on sliders, yokes, linear drivers, racks, joints on a guide and followers, in the direction in
    which the position along the guide increases.
    """

    kind: Literal["force_angle"]
    on: str = Field(description="Point on a guide on which it acts.")
    force: Forces = Field(description="Force at each angle, positive along the guide.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        return self._table_faults("force", "N")


class TorqueSpeed(Load):
    """A load torque on the crankshaft by its speed, linear between the given speeds, constant outside."""

    kind: Literal["torque_speed"]
    speed: Speeds = Field(description="Speeds of the crankshaft, increasing.")
    torque: Torques = Field(description="Torque at each speed.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        return curve_faults(self, "speed", ("torque",))
