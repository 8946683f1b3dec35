"""Servo motors: torque in continuous operation, S1, and peak torque, over the speed.

Both curves hold in all four quadrants: for either sense of rotation, driving and braking.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

import numpy as np
from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, fault
from linkwright.kernel.description.curve import curve_faults, unread_file
from linkwright.kernel.units.kinds import INERTIA, SPEED
from linkwright.kernel.units.marks import Speeds, Torques, not_negative, positive

# Curves are read off data sheets: what they differ by less than is no contradiction.
_READ_OFF = 1e-6


class TorqueCurve(CheckedDescription):
    """Torque that a motor may give, over its speed from standstill on; linear between the points."""

    speed: Speeds = Field(description="Speeds of the motor shaft, increasing, from 0 on.")
    torque: Torques = Field(description="Torque at each speed.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from curve_faults(self, "speed", ("torque",))
        if self.speed and self.speed[0] != 0:
            remedy = "begin with the torque at standstill"
            yield fault("speed", 0, found=f"{self.speed[0]:.6g} rad/s", expected="0", remedy=remedy)
        for nth, torque in enumerate(self.torque):
            if torque < 0:
                yield fault("torque", nth, found=f"{torque:.6g} N m", expected="a torque of 0 or more")

    def at(self, speed: float) -> float:
        """The torque at a speed within the curve [N m]."""
        return float(np.interp(speed, self.speed, self.torque))


class ServoMotor(CheckedDescription):
    """A servo motor, which follows a law."""

    type: str | None = Field(None, description="Name of the type, for tables.")
    inertia: Annotated[float, not_negative(INERTIA)] | None = Field(
        None, description="Moment of inertia of the rotor, at its shaft."
    )
    brake_inertia: Annotated[float, not_negative(INERTIA)] = Field(
        0.0, description="Moment of inertia of a holding brake on the rotor."
    )
    continuous: TorqueCurve | None = Field(
        None, description="Torque in continuous operation (S1) over the speed."
    )
    peak: TorqueCurve | None = Field(
        None, description="Peak torque over the speed; it does not rise with the speed."
    )
    speed_max: Annotated[float, positive(SPEED)] | None = Field(
        None, description="Maximum speed. Default: the last speed of the peak curve."
    )
    file: str | None = Field(
        None,
        description="CSV file of servo motors, in which `catalogue` names the type; units in the header: "
        '"type, inertia [kg cm^2], torque_rated [N m], speed_rated [rpm], torque_max [N m]".',
    )
    catalogue: str | None = Field(None, description="Type in `file`; its data supply missing entries.")

    @property
    def rotor(self) -> float:
        """Moment of inertia of the rotor with its brake [kg m²]."""
        return (self.inertia or 0.0) + self.brake_inertia

    @property
    def top_speed(self) -> float | None:
        """Maximum speed [rad/s]; None if neither it nor the peak curve is known."""
        return self.speed_max if self.speed_max is not None or self.peak is None else self.peak.speed[-1]

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.file is not None:
            yield unread_file(self.file)
            return
        if self.catalogue is not None:
            remedy = 'give file = "motors.csv" beside it, or the curves themselves'
            yield fault("catalogue", found=self.catalogue, expected="a type of a file", remedy=remedy)
            return
        if self.inertia is None:
            yield fault("inertia", expected="the moment of inertia of the rotor")
        for name, word in (("continuous", "continuous torque (S1)"), ("peak", "peak torque")):
            if getattr(self, name) is None:
                remedy = f'{name} = {{ speed = "0, 3000, 6000 rpm", torque = "2.4, 2.3, 1.2 N m" }}'
                yield fault(name, expected=f"the {word} over the speed", remedy=remedy)
        if self.continuous is not None and self.peak is not None:
            yield from self._curve_faults(self.continuous, self.peak)

    def _curve_faults(self, continuous: TorqueCurve, peak: TorqueCurve) -> Iterator[InitErrorDetails]:
        """Curves that contradict each other or the maximum speed."""
        for nth in range(1, len(peak.torque)):
            if peak.torque[nth] > peak.torque[nth - 1] * (1 + _READ_OFF):
                expected = f"at most {peak.torque[nth - 1]:.6g} N m, the torque before it"
                found = f"{peak.torque[nth]:.6g} N m"
                yield fault("peak", "torque", nth, found=found, expected=expected)
        end = min(continuous.speed[-1], peak.speed[-1])
        for speed in sorted({*continuous.speed, *peak.speed}):
            least = continuous.at(speed)
            if speed <= end and peak.at(speed) < least * (1 - _READ_OFF):
                found = f"{peak.at(speed):.6g} N m at {speed:.6g} rad/s"
                expected = f"at least the continuous torque there, {least:.6g} N m"
                yield fault("peak", found=found, expected=expected)
                break
