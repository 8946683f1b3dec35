"""A section of a rod string: rods of one size and grade."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, fault
from linkwright.kernel.units.kinds import LENGTH, MASS_PER_LENGTH, PRESSURE
from linkwright.kernel.units.marks import Quantity, positive
from linkwright.rods.model.rod_sizes import GRADES, RODS, STEEL, STEEL_DENSITY, within

# Weight of steel rods with couplings over that of the rod body: sucker rods 1.09, sinker bars and continuous
# rods 1. Pounds taken for kilograms, or feet for metres, are beyond.
_WEIGHS = (0.9, 1.4)

# Speed of sound of any rod [m/s].
_SOUND = 2500.0, 6500.0


class RodSection(CheckedDescription):
    """Rods of one size and grade."""

    length: Annotated[float, positive(LENGTH)] = Field(description="Length of the section.")
    rod: Literal["1/2", "5/8", "3/4", "7/8", "1", "1 1/8"] | None = Field(
        None, description="Nominal size in inches: diameter and weight by API RP 11L."
    )
    diameter: Annotated[float, positive(LENGTH)] | None = Field(
        None, description="Diameter of the rod body. Default: that of the size."
    )
    weight: Annotated[float, positive(MASS_PER_LENGTH)] | None = Field(
        None,
        description='Mass per length in air, couplings included, such as "1.63 lb/ft". Default: that of the '
        "size.",
    )
    modulus: Annotated[float, positive(PRESSURE)] = Field(
        STEEL, description="Modulus of elasticity E of the rods."
    )
    grade: Literal["C", "K", "D"] | None = Field(
        None, description="Grade of API Spec 11B, which gives the minimum tensile strength."
    )
    tensile: Annotated[float, Quantity(PRESSURE, within(1e8, 3e9, "Pa"))] | None = Field(
        None, description="Minimum tensile strength T. Default: that of the grade."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        for key in ("diameter", "weight"):
            if self.rod is None and getattr(self, key) is None:
                yield fault(key, expected=f"a value, or rod, a nominal size: {', '.join(RODS)}")
        if self.diameter is not None and self.weight is not None and self.rod is not None:
            yield fault("rod", found=self.rod, expected="nothing beside diameter and weight")
        if self.body is not None and self.mass is not None:
            yield from self._material_faults()
        if self.grade is not None and self.tensile is not None:
            yield fault("tensile", found=self.tensile, expected="nothing beside the grade")

    def _material_faults(self) -> Iterator[InitErrorDetails]:
        low, high = _WEIGHS
        ratio = float(self.mass / (STEEL_DENSITY * self.area))
        if self.modulus >= 0.8 * STEEL and not low < ratio < high:
            remedy = "check diameter and weight, and their units"
            found = f"{ratio:.3g} times that of a steel rod of {self.body:.4g} m diameter"
            yield fault("weight", found=found, expected="about the weight of the rod", remedy=remedy)
            return
        low, high = _SOUND
        sound = float(np.sqrt(self.modulus * self.area / self.mass))
        if not low < sound < high:
            found = f"{self.modulus:.4g} Pa, a speed of sound of {sound:.4g} m/s"
            expected = f"a speed of sound of {low:g} to {high:g} m/s"
            remedy = "check modulus, diameter and weight, and their units"
            yield fault("modulus", found=found, expected=expected, remedy=remedy)

    @property
    def body(self) -> Any:
        """Diameter of the rod body [m]."""
        return RODS[self.rod][0] if self.diameter is None and self.rod else self.diameter

    @property
    def mass(self) -> Any:
        """Mass per length, couplings included [kg/m]."""
        return RODS[self.rod][1] if self.weight is None and self.rod else self.weight

    @property
    def area(self) -> Any:
        """Cross-section of the rod body [m²]."""
        return np.pi / 4 * self.body**2

    @property
    def strength(self) -> float | None:
        """Minimum tensile strength [Pa]; None where neither it nor a grade is given."""
        return GRADES[self.grade] if self.grade is not None else self.tensile
