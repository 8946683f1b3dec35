r"""What all descriptions of the gas in a cylinder share, and the load map of an engine.

| kind | mean effective pressure |
| --- | --- |
| `constant` | the same at any speed |
| `table` | linear between given points, constant outside |
| `propeller` | rises from the friction with a power of the speed through a rated point |

.. math:: p_i = p_f + (p_{i,n} - p_f) \left(\frac{ω}{ω_n}\right)^2
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import CheckedDescription, fault
from linkwright.kernel.description.curve import curve_faults, unread_file
from linkwright.kernel.errors import MachineError, Problem
from linkwright.kernel.units.kinds import PRESSURE, RATIO, SPEED
from linkwright.kernel.units.marks import Bound, Pressures, Quantity, Speeds, not_negative, positive
from linkwright.torsion.model.engine.cycle_pressure import CyclePressure
from linkwright.torsion.model.engine.cylinder import Cylinder

PositivePressure = Annotated[float, positive(PRESSURE)]


class GasLoad(CheckedDescription):
    """Indicated mean effective pressure of all cylinders against the speed."""

    @abstractmethod
    def mean_effective(self, speeds: Floats, rated: float) -> Floats:
        """Mean effective pressure p_i [Pa], (n,), at `speeds` (n,) [rad/s]; `rated`: as described [Pa]."""

    @property
    @abstractmethod
    def rated(self) -> float | None:
        """Maximum mean effective pressure of the map [Pa]; None where it is that of the gas as described."""

    @property
    def rated_speed(self) -> float:
        """Speed at which the gas is as described [rad/s]."""
        raise NotImplementedError

    def charge(self, speeds: Floats) -> Floats | None:
        """Charge pressure [Pa], (n,), at `speeds` (n,) [rad/s]; None where the map does not say."""
        return None

    def kinks(self) -> tuple[float, ...]:
        """Speeds at which the map has a corner [rad/s]."""
        return ()


class ConstantGasLoad(GasLoad):
    """The same mean effective pressure at any speed."""

    kind: Literal["constant"]
    mean_effective_pressure: PositivePressure = Field(
        description="Indicated mean effective pressure, at any speed."
    )

    @property
    def rated(self) -> float:
        return self.mean_effective_pressure

    def mean_effective(self, speeds: Floats, rated: float) -> Floats:
        return np.full(len(speeds), self.mean_effective_pressure)


class TableGasLoad(GasLoad):
    """Mean effective pressure at given speeds, linear between them, held beyond them."""

    kind: Literal["table"]
    file: str | None = Field(
        None,
        description="CSV file beside the machine file, instead of the lists, with units in the header: "
        '"speed [rpm], mean_effective_pressure [bar]".',
    )
    speed: Speeds = Field((), description="Speeds of the crankshaft, increasing.")
    mean_effective_pressure: Pressures = Field(
        (), description="Indicated mean effective pressure at each speed."
    )
    charge_pressure: Pressures | None = Field(
        None, description="Charge pressure at each speed. Default: that of the model."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.file is not None:
            yield unread_file(self.file)
            return
        yield from curve_faults(self, "speed", ("mean_effective_pressure", "charge_pressure"))
        for place, pressure in enumerate(self.charge_pressure or ()):
            if pressure <= 0:
                yield fault("charge_pressure", place, found=pressure, expected="an absolute pressure above 0")

    @property
    def rated(self) -> float:
        return max(self.mean_effective_pressure)

    def mean_effective(self, speeds: Floats, rated: float) -> Floats:
        return np.asarray(np.interp(speeds, self.speed, self.mean_effective_pressure))

    def charge(self, speeds: Floats) -> Floats | None:
        if self.charge_pressure is None:
            return None
        return np.asarray(np.interp(speeds, self.speed, self.charge_pressure))

    def kinks(self) -> tuple[float, ...]:
        return self.speed


class PropellerGasLoad(GasLoad):
    """Mean effective pressure that rises with a power of the speed."""

    kind: Literal["propeller"]
    speed: Annotated[float, positive(SPEED)] = Field(
        description="Speed of the crankshaft at the rated point."
    )
    mean_effective_pressure: PositivePressure | None = Field(
        None, description="Indicated mean effective pressure at the rated point. Default: that of the gas."
    )
    friction_pressure: Annotated[float, not_negative(PRESSURE)] = Field(
        0.0, description="Friction mean effective pressure of the engine, at any speed."
    )
    exponent: Annotated[float, positive(RATIO)] = Field(
        2.0, description="Exponent of the speed; 2 for a propeller."
    )

    @property
    def rated(self) -> float | None:
        return self.mean_effective_pressure

    @property
    def rated_speed(self) -> float:
        return self.speed

    def mean_effective(self, speeds: Floats, rated: float) -> Floats:
        top = rated if self.mean_effective_pressure is None else self.mean_effective_pressure
        rise: Any = (speeds / self.speed) ** self.exponent
        return np.asarray(self.friction_pressure + (top - self.friction_pressure) * rise)


AnyGasLoad = Annotated[ConstantGasLoad | TableGasLoad | PropellerGasLoad, Field(discriminator="kind")]


ABOVE_ONE = Bound(" greater than 1,", {"exclusiveMinimum": 1}, lambda value: value > 1)
CompressionRatio = Annotated[float, Quantity(RATIO, ABOVE_ONE)]
Exponent = Annotated[float, Quantity(RATIO, ABOVE_ONE)]


class Gas(CheckedDescription):
    """Pressure in a cylinder over its working cycle, at any speed."""

    compression_ratio: CompressionRatio = Field(
        description="Ratio of maximum to minimum volume above the piston."
    )
    crankcase_pressure: Annotated[float, not_negative(PRESSURE)] = Field(
        101325.0, description="Absolute pressure under the pistons."
    )
    load: AnyGasLoad | None = Field(
        None, description="Mean effective pressure against speed. Default: the same diagram at any speed."
    )

    @abstractmethod
    def cycle_faults(self, strokes: int) -> Iterator[InitErrorDetails]:
        """What does not go with the strokes of the engine."""

    @abstractmethod
    def cycle_pressure(self, cylinder: Cylinder, speeds: Floats) -> CyclePressure:
        """Pressure in a cylinder over the cycle. `speeds`: (n,) [rad/s]."""


def below(wrong: InitErrorDetails, *place: str | int) -> InitErrorDetails:
    """The same fault, told by a description further up."""
    return InitErrorDetails(type=wrong["type"], loc=(*place, *wrong.get("loc", ())), input=wrong["input"])


def check_reach(wanted: Floats, motored: Floats, speeds: Floats) -> None:
    """Refuse mean effective pressures (n,) [Pa] below those of the motored cylinder; speeds (n,) [rad/s]."""
    short = np.flatnonzero(wanted < motored - 1e-9 * np.abs(motored))
    if len(short):
        i = int(short[0])
        found = f"a mean effective pressure of {wanted[i]:.6g} Pa at {speeds[i]:.6g} rad/s"
        expected = f"at least that of the motored cylinder, {motored[i]:.6g} Pa"
        raise MachineError(
            [Problem("train.engine.gas.load", found, expected, "raise the load, or end it at this speed")]
        )
