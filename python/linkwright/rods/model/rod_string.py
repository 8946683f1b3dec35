r"""A string of sucker rods: sections from the polished rod down, the fluid around them, the pump below.

Rods are catalogued by diameter and weight per length with couplings, not by a density: the speed of sound is
:math:`a = \sqrt{EA/\mu}` with that weight. Displacements and dynamic forces are counted from the string at
rest in the fluid without a load of the pump; the load of the polished rod has its weight in the
fluid besides:

.. math::

    W_r = g\sum \mu_i L_i, \qquad W_{rf} = W_r\,(1 - \rho/\rho_s)

with ρ of the fluid and 490 lb/ft³ of steel: API's factor 1 − 0.128 G.

References
----------
.. [1] API RP 11L, Recommended Practice for Design Calculations for Sucker Rod Pumping Systems (Conventional
Units),
   4th ed. 1988, 2.
.. [2] Gibbs, Predicting the Behavior of Sucker-Rod Pumping Systems, J. Pet. Tech. 15 (1963) 769.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any, NamedTuple

import numpy as np
from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, fault
from linkwright.kernel.units.kinds import (
    ANGLE,
    DENSITY,
    FORCE,
    FREQUENCY,
    LENGTH,
    RATIO,
    SPEED,
)
from linkwright.kernel.units.marks import FRACTION, Bound, Quantity, not_negative, positive
from linkwright.rods.model.measured_card import MeasuredCard
from linkwright.rods.model.pump import SuckerRodPump
from linkwright.rods.model.rod_section import RodSection
from linkwright.rods.model.rod_sizes import STEEL_DENSITY, within

# Standard gravity, by which weights in pounds are masses [m/s²].
GRAVITY = 9.80665

# Density of water [kg/m³].
WATER = 1000.0

# Shares of the pump's depth by which the sections may be longer, and shorter: records leave pony rods out.
_LONGER, _SHORTER = 0.005, 0.05

# Damping factor of any string.
_DAMPED = 5.0

# The equation of motion is that of a vertical string: the friction of rods on the tubing is none.
_VERTICAL = Bound(
    " from 0 to 10 deg,",
    {"minimum": 0, "maximum": np.radians(10)},
    lambda value: 0 <= value <= np.radians(10) * (1 + 1e-12),
)


class Columns(NamedTuple):
    """Sections of a string as arrays."""

    length: Any  # [m]
    area: Any  # [m²]
    rigidity: Any  # EA [N]
    mass: Any  # μ [kg/m]
    damping: Any  # c [1/s]


class RodString(CheckedDescription):
    """A string of sucker rods between the polished rod and the pump."""

    sections: tuple[RodSection, ...] = Field(description="Sections from the polished rod down.")
    pump: SuckerRodPump = Field(description="Pump at the lower end.")
    depth: Annotated[float, positive(LENGTH)] | None = Field(
        None, description="Depth of the pump. Default: length of all sections."
    )
    specific_gravity: Annotated[float, positive(RATIO)] | None = Field(
        None, description="Specific gravity G of the fluid in the tubing, water 1."
    )
    density: Annotated[float, positive(DENSITY)] | None = Field(
        None, description="Density of the fluid in the tubing, in place of specific_gravity."
    )
    damping: Annotated[float, not_negative(FREQUENCY)] | None = Field(
        None,
        description="Viscous damping c of the equation u_tt = a² u_xx − c u_t [1/s]. "
        "Default: that of damping_factor.",
    )
    damping_factor: Annotated[float, not_negative(RATIO)] = Field(
        0.1, description="Dimensionless damping ν = 2cL/(πa)."
    )
    stuffing_box: Annotated[float, not_negative(FORCE)] = Field(
        0.0, description="Friction of the stuffing box on the polished rod."
    )
    service_factor: Annotated[float, Quantity(RATIO, FRACTION)] = Field(
        1.0, description="Service factor SF of the permissible stress."
    )
    stroke: Annotated[float, Quantity(LENGTH, within(0.1, 15, "m"))] | None = Field(
        None, description="Stroke of a polished rod that moves harmonically, without a pumping unit."
    )
    speed: Annotated[float, positive(SPEED)] | None = Field(
        None, description='Pumping speed, such as "8 rpm" for 8 strokes per minute, without a [drive].'
    )
    card: MeasuredCard | None = Field(None, description="Surface card that was measured on the well.")
    inclination: Annotated[float, Quantity(ANGLE, _VERTICAL)] = Field(
        0.0, description="Maximum inclination of the well from the vertical: vertical wells only."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        if not self.sections:
            yield fault("sections", found="none", expected="one section or more")
            return
        total = sum(section.length for section in self.sections)
        if self.depth is not None and not 1 - _SHORTER <= total / self.depth <= 1 + _LONGER:
            way = "deeper than" if total > self.depth else "short of"
            remedy = f"their lengths add up to {total:.6g} m, {way} the pump"
            expected = f"sections down to the pump at {self.depth:.6g} m"
            yield fault("sections", found=f"{total:.6g} m", expected=expected, remedy=remedy)
        if (self.specific_gravity is None) == (self.density is None):
            found = None if self.density is None else "both"
            yield fault("specific_gravity", found=found, expected="either specific_gravity or density")
            return
        if not 0.3 * WATER < self.fluid_density < 2 * WATER:
            key = "density" if self.specific_gravity is None else "specific_gravity"
            expected = "a liquid of 300 to 2000 kg/m³"
            yield fault(key, found=f"{self.fluid_density:.6g} kg/m³", expected=expected)
            return
        yield from self._friction_faults()
        yield from self._pump_faults()

    def _friction_faults(self) -> Iterator[InitErrorDetails]:
        if self.damping is not None and "damping_factor" in self.model_fields_set:
            yield fault("damping", found=self.damping, expected="either damping or damping_factor")
        factor = 2 * self.damping_rate * self.length / (np.pi * self.sound)
        if factor > _DAMPED:
            key = "damping_factor" if self.damping is None else "damping"
            yield fault(
                key, found=f"a damping factor of {factor:.4g}", expected=f"a factor up to {_DAMPED:g}"
            )
        if self.stuffing_box > self.weight_fluid:
            expected = f"less than the weight of the rods in the fluid, {self.weight_fluid:.4g} N"
            yield fault("stuffing_box", found=f"{self.stuffing_box:.4g} N", expected=expected)

    def _pump_faults(self) -> Iterator[InitErrorDetails]:
        level, depth = self.pump.fluid_level, self.pump_depth
        if level is not None and level > depth * (1 + _LONGER):
            expected = f"a level above the pump at {depth:.6g} m"
            yield fault("pump", "fluid_level", found=level, expected=expected)
        elif not self.fluid_load > 0:
            found = f"{self.intake:.6g} Pa, discharge {self.discharge:.6g} Pa"
            expected = "an intake pressure below the discharge pressure"
            key = "intake_pressure" if level is None else "fluid_level"
            remedy = "the well flows by itself, or pressures are in the wrong unit"
            yield fault("pump", key, found=found, expected=expected, remedy=remedy)

    @property
    def length(self) -> Any:
        """Length of all sections [m]."""
        return sum(section.length for section in self.sections)

    @property
    def pump_depth(self) -> Any:
        """Depth of the pump [m]."""
        return self.length if self.depth is None else self.depth

    @property
    def fluid_density(self) -> Any:
        """Density of the fluid [kg/m³]."""
        return self.density if self.specific_gravity is None else WATER * self.specific_gravity

    @property
    def columns(self) -> Columns:
        """Sections as arrays."""
        length, area, modulus, mass = (
            np.array([getattr(section, name) for section in self.sections])
            for name in ("length", "area", "modulus", "mass")
        )
        return Columns(length, area, modulus * area, mass, np.full(len(mass), self.damping_rate))

    @property
    def sound(self) -> Any:
        """Speed of sound a by the time that a wave takes to the pump [m/s]."""
        time = sum(s.length * np.sqrt(s.mass / (s.modulus * s.area)) for s in self.sections)
        return self.length / time

    @property
    def damping_rate(self) -> Any:
        """Damping c [1/s]."""
        if self.damping is not None:
            return self.damping
        return self.damping_factor * np.pi * self.sound / (2 * self.length)

    @property
    def stiffness(self) -> Any:
        """Spring rate of the string k_r [N/m]."""
        return 1 / sum(s.length / (s.modulus * s.area) for s in self.sections)

    @property
    def weight_air(self) -> Any:
        """Weight of the rods in air W_r [N]."""
        return GRAVITY * sum(s.length * s.mass for s in self.sections)

    @property
    def buoyancy_factor(self) -> Any:
        """Weight in the fluid over that in air."""
        return 1 - self.fluid_density / STEEL_DENSITY

    @property
    def weight_fluid(self) -> Any:
        """Weight of the rods in the fluid W_rf [N]."""
        return self.weight_air * self.buoyancy_factor

    @property
    def discharge(self) -> Any:
        """Pressure above the plunger [Pa]."""
        return self.fluid_density * GRAVITY * self.pump_depth + self.pump.tubing_pressure

    @property
    def intake(self) -> Any:
        """Pressure at the pump intake [Pa]."""
        pump = self.pump
        if pump.intake_pressure is not None:
            return pump.intake_pressure
        # A level at the pump leaves no column above it.
        column = max(self.pump_depth - (pump.fluid_level or 0.0), 0.0)
        return self.fluid_density * GRAVITY * column + pump.casing_pressure

    @property
    def fluid_load(self) -> Any:
        """Load of the fluid on the plunger F_o [N]."""
        return (self.discharge - self.intake) * self.pump.area
