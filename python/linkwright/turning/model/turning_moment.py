r"""The turning-moment diagram of a machine file: driving and load torques, required speed fluctuation.

Both torques act on one shaft and depend on its angle φ alone, over a cycle of one or two revolutions. Who
knows one of them leaves the other out: it is then constant, at the mean of the one that is given. Who has
the areas of a diagram between its crossings gives these instead.

References
----------
.. [1] S. S. Rattan, Theory of Machines, 4th edition, chapter 13: turning-moment diagrams, flywheels.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, fault
from linkwright.kernel.units import (
    ANGLE,
    COUNT,
    ENERGY,
    FRACTION,
    INERTIA,
    LENGTH,
    RATIO,
    SPEED,
    Quantity,
    QuantityList,
    positive,
)
from linkwright.turning.model.torque import AnyShaftTorque

# Revolutions that a cycle may take: two of a four-stroke engine, more where several machines share a shaft.
_TURNS_MAX = 24

# A cycle given in degrees is a whole number of revolutions to rounding.
_WHOLE = 1e-9


class TurningMoment(CheckedDescription):
    """Torques on a shaft over a cycle, and the speed fluctuation that a flywheel is to keep."""

    speed: Annotated[float, positive(SPEED)] = Field(
        description="Mean speed of the shaft, the mean of its extremes."
    )
    cycle: Annotated[float, positive(ANGLE)] = Field(
        2 * math.pi, description="Angle of a cycle: 360 deg, or 720 deg for a four-stroke engine."
    )
    driver: AnyShaftTorque | None = Field(
        None, description="Torque of what drives; without it constant, the mean of the load."
    )
    load: AnyShaftTorque | None = Field(
        None, description="Torque of what resists; without it constant, the mean of the driver."
    )
    areas: Annotated[tuple[float, ...], QuantityList(COUNT)] = Field(
        (),
        description="In place of driver and load: areas of the diagram between its crossings with the mean, "
        "in order, positive where the driver is above.",
    )
    area_scale: Annotated[float, positive(ENERGY)] = Field(
        1.0, description="Energy that one unit of area stands for."
    )
    unevenness: Annotated[float, Quantity(RATIO, FRACTION)] | None = Field(
        None, description="Coefficient of speed fluctuation δ that is asked for; gives the flywheel."
    )
    inertia: Annotated[float, positive(INERTIA)] | None = Field(
        None, description="Moment of inertia that the shaft has, without the flywheel that is sought."
    )
    radius_of_gyration: Annotated[float, positive(LENGTH)] | None = Field(
        None, description="Of the flywheel, for its mass."
    )

    @property
    def turns(self) -> int:
        """Revolutions of a cycle."""
        return round(self.cycle / (2 * math.pi))

    def _faults(self) -> Iterator[InitErrorDetails]:
        turns = self.cycle / (2 * math.pi)
        if not 1 <= round(turns) <= _TURNS_MAX or abs(turns - round(turns)) > _WHOLE * turns:
            expected = f"1 to {_TURNS_MAX} whole revolutions, such as 360 deg or 720 deg"
            yield fault("cycle", found=f"{math.degrees(self.cycle):.6g} deg", expected=expected)
        torques = {"driver": self.driver, "load": self.load}
        if self.areas:
            yield from self._area_faults()
        elif self.driver is None and self.load is None:
            yield fault("driver", expected="a table; or load, or areas")
        for key, torque in torques.items():
            if torque is None:
                continue
            for each in torque.cycle_faults(self.cycle):
                yield {**each, "loc": (key, torque.kind, *each["loc"])}
            if self.areas:
                yield fault(key, found="a table", expected="nothing beside areas")
        if self.radius_of_gyration is not None and self.unevenness is None:
            remedy = "give unevenness, or leave the radius out"
            found = f"{self.radius_of_gyration:.6g} m"
            yield fault(
                "radius_of_gyration", found=found, expected="nothing without unevenness", remedy=remedy
            )

    def _area_faults(self) -> Iterator[InitErrorDetails]:
        if len(self.areas) < 2:
            yield fault("areas", found="1 value", expected="at least 2 values")
        for place, area in enumerate(self.areas):
            if area == 0:
                yield fault("areas", place, found=area, expected="an area above or below the mean, not 0")
