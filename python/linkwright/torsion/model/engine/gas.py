"""What all descriptions of the gas in a cylinder share."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription
from linkwright.kernel.errors import MachineError, Problem
from linkwright.kernel.units import PRESSURE, RATIO, Bound, Quantity, not_negative
from linkwright.torsion.model.engine.cycle_pressure import CyclePressure
from linkwright.torsion.model.engine.cylinder import Cylinder
from linkwright.torsion.model.engine.gas_load import AnyGasLoad

Array = NDArray[np.float64]

ABOVE_ONE = Bound(" greater than 1,", {"exclusiveMinimum": 1}, lambda value: value > 1)
CompressionRatio = Annotated[float, Quantity(RATIO, ABOVE_ONE)]
Exponent = Annotated[float, Quantity(RATIO, ABOVE_ONE)]


class Gas(CheckedDescription):
    """Pressure in a cylinder over its working cycle, at any speed."""

    compression_ratio: CompressionRatio = Field(description="Maximum over minimum volume above the piston.")
    crankcase_pressure: Annotated[float, not_negative(PRESSURE)] = Field(
        101325.0, description="Absolute pressure under the pistons."
    )
    load: AnyGasLoad | None = Field(
        None, description="Mean effective pressure against speed. Without it, the same diagram at any speed."
    )

    @abstractmethod
    def cycle_faults(self, strokes: int) -> Iterator[InitErrorDetails]:
        """What does not go with the strokes of the engine."""

    @abstractmethod
    def cycle_pressure(self, cylinder: Cylinder, speeds: Array) -> CyclePressure:
        """Pressure in a cylinder over the cycle. `speeds`: (n,) [rad/s]."""


def below(found: InitErrorDetails, *place: str | int) -> InitErrorDetails:
    """The same fault, told by a description further up."""
    return InitErrorDetails(type=found["type"], loc=(*place, *found.get("loc", ())), input=found["input"])


def check_reach(wanted: Array, motored: Array, speeds: Array) -> None:
    """Refuse mean effective pressures below that of the motored cylinder.

    `wanted`, `motored`: (n,) mean effective pressures [Pa]; `speeds`: (n,) [rad/s].
    """
    short = np.flatnonzero(wanted < motored - 1e-9 * np.abs(motored))
    if len(short):
        i = int(short[0])
        found = f"a mean effective pressure of {wanted[i]:.6g} Pa at {speeds[i]:.6g} rad/s"
        expected = f"at least that of the motored cylinder, {motored[i]:.6g} Pa"
        raise MachineError(
            [Problem("train.engine.gas.load", found, expected, "raise the load, or end it at this speed")]
        )
