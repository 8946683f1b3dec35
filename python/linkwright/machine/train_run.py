"""Speeds and orders at which the forced vibration of a train is looked at."""

from __future__ import annotations

from collections.abc import Iterator

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.machine.base import Checked, fault
from linkwright.machine.element import PositiveNumber
from linkwright.machine.train_base import PositiveSpeed


class TrainRun(Checked):
    """The range of speeds of the first disc, and how far orders count."""

    speed_min: PositiveSpeed = Field(description="Lowest speed of the first disc.")
    speed_max: PositiveSpeed = Field(description="Highest speed of the first disc.")
    points: int = Field(200, ge=2, le=100_000, description="How many speeds, evenly spaced.")
    speed_rated: PositiveSpeed | None = Field(
        None, description="Speed of service, at which waveforms are shown. Without it, the highest."
    )
    orders_max: PositiveNumber = Field(24.0, le=48, description="Highest order of gas and inertia torques.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.speed_max <= self.speed_min:
            expected = f"more than speed_min, {self.speed_min:.6g} rad/s"
            yield fault("speed_max", found=self.speed_max, expected=expected)

    @property
    def service(self) -> float:
        """Speed of service [rad/s]."""
        return self.speed_max if self.speed_rated is None else self.speed_rated
