"""The pump at the lower end of a rod string, and what it lifts."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any

import numpy as np
from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, fault
from linkwright.kernel.units.kinds import LENGTH, PRESSURE, RATIO, VOLUME_FLOW
from linkwright.kernel.units.marks import FRACTION, Bound, Quantity, not_negative, positive
from linkwright.rods.model.rod_sizes import PSI, within

# Less is a mixture with gas, of which fillage and gas_exponent tell.
_LIQUID = Bound(" of 1e8 Pa or more,", {"minimum": 1e8}, lambda value: value >= 1e8)

_FROM_ONE = Bound(" of 1 or more,", {"minimum": 1}, lambda value: value >= 1)


class SuckerRodPump(CheckedDescription):
    """A sucker-rod pump: plunger, fillage, tubing."""

    plunger: Annotated[float, Quantity(LENGTH, within(0.01, 0.2, "m"))] = Field(
        description="Diameter of the plunger."
    )
    fluid_level: Annotated[float, not_negative(LENGTH)] | None = Field(
        None, description="Depth of the dynamic fluid level, from which the pump lifts (net lift H of API)."
    )
    intake_pressure: Annotated[float, not_negative(PRESSURE)] | None = Field(
        None, description="Pressure at the pump intake, in place of fluid_level."
    )
    tubing_pressure: Annotated[float, not_negative(PRESSURE)] = Field(
        0.0, description="Pressure in the tubing at the wellhead."
    )
    casing_pressure: Annotated[float, not_negative(PRESSURE)] = Field(
        0.0, description="Pressure in the casing at the fluid level."
    )
    fillage: Annotated[float, Quantity(RATIO, FRACTION)] = Field(
        1.0, description="Share of the volume taken in by the barrel that is liquid."
    )
    gas_exponent: Annotated[float, Quantity(RATIO, _FROM_ONE)] | None = Field(
        None,
        description="Polytropic exponent of the gas that fills the rest of the barrel, compressed from "
        "the intake pressure. Default: gas without pressure; the load falls where the plunger meets the "
        "liquid.",
    )
    bulk_modulus: Annotated[float, Quantity(PRESSURE, _LIQUID)] = Field(
        1.5e9,
        description="Bulk modulus of the liquid, which the plunger compresses in the barrel before the "
        "travelling valve opens.",
    )
    leak: Annotated[float, not_negative(VOLUME_FLOW)] = Field(
        0.0, description="Slippage past plunger and travelling valve under the full fluid load."
    )
    tubing_diameter: Annotated[float, positive(LENGTH)] | None = Field(
        None, description="Outside diameter of tubing that is not anchored. Default: anchored tubing."
    )
    tubing_bore: Annotated[float, positive(LENGTH)] | None = Field(
        None, description="Inside diameter of tubing that is not anchored."
    )
    tubing_modulus: Annotated[float, positive(PRESSURE)] = Field(
        30.0e6 * PSI, description="Modulus of elasticity of the tubing."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        if (self.fluid_level is None) == (self.intake_pressure is None):
            found = None if self.fluid_level is None else "both"
            yield fault(found=found, expected="either fluid_level or intake_pressure")
        outside, bore = self.tubing_diameter, self.tubing_bore
        if (outside is None) != (bore is None):
            key = "tubing_bore" if bore is None else "tubing_diameter"
            yield fault(key, expected="a length: tubing_diameter and tubing_bore are given together")
        if outside is not None and bore is not None and bore >= outside:
            yield fault("tubing_bore", found=bore, expected=f"less than tubing_diameter, {outside:.6g} m")
        if self.gas_exponent is not None and self.fillage == 1:
            remedy = "write the fillage, or leave gas_exponent out"
            yield fault("gas_exponent", found=self.gas_exponent, expected="a fillage below 1", remedy=remedy)

    @property
    def area(self) -> Any:
        """Area of the plunger [m²]."""
        return np.pi / 4 * self.plunger**2

    def tubing_compliance(self, length: Any) -> Any:
        """Stretch of the tubing down to the pump under a force [m/N]; 0 where it is anchored."""
        if self.tubing_diameter is None or self.tubing_bore is None:
            return 0.0
        area = np.pi / 4 * (self.tubing_diameter**2 - self.tubing_bore**2)
        return length / (self.tubing_modulus * area)
