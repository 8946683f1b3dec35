"""Speeds and orders at which the forced vibration of a train is looked at."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, fault
from linkwright.kernel.units import COUNT, Bound, Quantity
from linkwright.torsion.model.train_base import PositiveSpeed

# As far as gas torques are computed.
_HIGHEST = 48.0
_ORDER = Bound(
    f" from 1 to {_HIGHEST:.0f},",
    {"minimum": 1, "maximum": _HIGHEST},
    lambda value: 1 <= value <= _HIGHEST,
)

Floats = NDArray[np.float64]


class TrainRun(CheckedDescription):
    """The range of speeds of the first disc, and how far orders count."""

    speed_min: PositiveSpeed = Field(description="Lowest speed of the first disc.")
    speed_max: PositiveSpeed = Field(description="Highest speed of the first disc.")
    points: int = Field(200, ge=2, le=100_000, description="How many speeds, evenly spaced.")
    speed_rated: PositiveSpeed | None = Field(
        None, description="Speed of service, at which waveforms are shown. Without it, the highest."
    )
    orders_max: Annotated[float, Quantity(COUNT, _ORDER)] = Field(
        24.0, description="Highest order of gas and inertia torques."
    )
    loads_follow: bool = Field(
        False,
        description="Whether loads are scaled at each speed so that they take off what the engine gives in "
        "the mean. Otherwise they are as given, and what is left over accelerates the train.",
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.speed_max <= self.speed_min:
            least = f"{self.speed_min:.6g} rad/s or {self.speed_min * 30 / math.pi:.6g} rpm"
            expected = f"more than speed_min, {least}"
            yield fault("speed_max", found=self.speed_max, expected=expected)

    @property
    def speeds(self) -> Floats:
        """All speeds, (n,) [rad/s]; even, but that of service stands in the place of the nearest."""
        even = np.linspace(self.speed_min, self.speed_max, self.points)
        if self.speed_min < self.service < self.speed_max:
            even[np.abs(even - self.service).argmin()] = self.service
        return even

    @property
    def service(self) -> float:
        """Speed of service [rad/s]."""
        return self.speed_max if self.speed_rated is None else self.speed_rated
