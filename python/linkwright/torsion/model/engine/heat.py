r"""Heat in the cylinder: its release by Wiebe's function, its loss to the walls.

Wiebe's function is

.. math:: x = \frac{1 - e^{-a y^{m+1}}}{1 - e^{-a}}, \qquad y = \frac{φ - φ_0}{Δφ}

The denominator, 0.999 for the usual a = 6.908, makes the release complete at the end.

| kind | heat transfer coefficient [W/(m² K)] |
| --- | --- |
| `woschni` | 3.26 B^-0.2 p^0.8 T^-0.55 w^0.8, p in kPa, w = 2.28 c_m + 0.00324 V_h T_r/(p_r V_r) (p - p_0) |
| `hohenberg` | 130 V^-0.06 p^0.8 T^-0.4 (c_m + 1.4)^0.8, p in bar |
| `share` | none: a given share of the heat is lost as it is released |

B bore [m], V volume [m³], T temperature of the gas [K], c_m mean speed of the piston [m/s], p_0 pressure of
the motored cylinder; p_r, V_r, T_r where the cylinder closes. The walls are piston, head and the liner that
is bare,

.. math:: S = \frac{π}{2} B^2 + \frac{4V}{B}

References
----------
.. [1] Wiebe, Brennverlauf und Kreisprozess von Verbrennungsmotoren, 1970.
.. [2] Heywood, Internal Combustion Engine Fundamentals, 1988, equation (9.30): a efficiency factor, m form
   factor.
.. [3] Miyamoto et al., SAE 850107: two functions for Diesel engines.
.. [4] Woschni, SAE 670931 (1967); in SI by Heywood, Internal Combustion Engine Fundamentals, 1988, equations
   (12.18), (12.19), with the constants of the closed cycle.
.. [5] Hohenberg, SAE 790825 (1979).
"""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import Description
from linkwright.kernel.units.kinds import ANGLE, RATIO, TEMPERATURE
from linkwright.kernel.units.marks import FRACTION, INSIDE_ONE, Angle, Quantity, not_negative, positive

# Of the heat, 99.9 % is released within the duration: -ln 0.001.
_COMPLETE = -math.log(0.001)


class Wiebe(Description):
    """One release of heat."""

    start: Angle = Field(description="Crank angle from the top dead centre of firing; negative before it.")
    duration: Annotated[float, positive(ANGLE)] = Field(
        description="Duration of the heat release, as crank angle."
    )
    form_factor: Annotated[float, not_negative(RATIO)] = Field(
        2.0,
        description="Form factor m: 2 for spark ignition, 0.5 to 1 for Diesel engines, 0 for an "
        "abrupt start.",
    )
    efficiency_factor: Annotated[float, positive(RATIO)] = Field(
        _COMPLETE,
        description="Factor a: with the usual 6.908, 0.1 % of the heat remains unreleased at the end.",
    )
    share: Annotated[float, Quantity(RATIO, FRACTION)] = Field(
        1.0, description="Share of the heat; the shares of all functions add up to 1."
    )

    @property
    def end(self) -> float:
        """Crank angle at which all is released [rad]."""
        return self.start + self.duration

    def released(self, angle: Floats) -> Floats:
        """Share of the whole heat that is released, shape (m,). `angle`: (m,) crank angles [rad]."""
        a, y = self.efficiency_factor, self._progress(angle)
        return np.asarray(self.share * np.expm1(-a * y ** (self.form_factor + 1)) / math.expm1(-a))

    def rate(self, angle: Floats) -> Floats:
        """Its derivative by the crank angle, shape (m,) [1/rad]. `angle`: (m,) crank angles [rad]."""
        a, m, y = self.efficiency_factor, self.form_factor, self._progress(angle)
        inside = (angle >= self.start) & (angle <= self.end)
        scale = self.share * a * (m + 1) / (-math.expm1(-a) * self.duration)
        return np.asarray(inside * scale * y**m * np.exp(-a * y ** (m + 1)))

    def _progress(self, angle: Floats) -> Floats:
        """y, constant before the start and after the end."""
        return np.clip((angle - self.start) / self.duration, 0.0, 1.0)


@dataclass(frozen=True, eq=False)
class GasState:
    """The gas between closing and opening at n loads and m crank angles."""

    # `bore`, `swept_volume`: of the cylinder [m, m³].
    bore: float
    swept_volume: float
    volume: Floats  # (m,) V [m³]
    # `pressure`, `temperature`: (n, m) p [Pa], T [K].
    pressure: Floats
    temperature: Floats
    motored: Floats  # (n, m) pressure of the motored cylinder [Pa]
    closing: Floats  # (n, 1) T_r/(p_r V_r) where the cylinder closes [K/J]
    piston_speed: Floats  # (n, 1) mean speed of the piston [m/s]


class WallHeat(Description):
    """Loss of heat by convection to walls of one temperature."""

    wall_temperature: Annotated[float, positive(TEMPERATURE)] = Field(
        450.0, description="Mean wall temperature of piston, head and liner."
    )
    factor: Annotated[float, positive(RATIO)] = Field(
        1.0, description="Factor on the heat transfer coefficient, to fit a measurement."
    )

    @abstractmethod
    def coefficient(self, gas: GasState) -> Floats:
        """Heat transfer coefficient without the factor, shape (n, m) [W/(m² K)]."""

    def conductance(self, gas: GasState) -> Floats:
        """Heat flow per temperature difference, shape (n, m) [W/K]."""
        walls = math.pi / 2 * gas.bore**2 + 4 / gas.bore * gas.volume
        return self.factor * walls * self.coefficient(gas)


class Woschni(WallHeat):
    """Woschni's coefficient of heat transfer."""

    kind: Literal["woschni"]

    def coefficient(self, gas: GasState) -> Floats:
        combustion = 3.24e-3 * gas.swept_volume * gas.closing * (gas.pressure - gas.motored)
        # Below the motored pressure, late in the expansion, nothing is left that stirs the gas.
        w = 2.28 * gas.piston_speed + np.maximum(combustion, 0.0)
        p = gas.pressure / 1e3
        return np.asarray(3.26 * gas.bore**-0.2 * (p * w) ** 0.8 * gas.temperature**-0.55)


class Hohenberg(WallHeat):
    """Hohenberg's coefficient of heat transfer."""

    kind: Literal["hohenberg"]

    def coefficient(self, gas: GasState) -> Floats:
        p = gas.pressure / 1e5
        w = gas.piston_speed + 1.4
        return np.asarray(130.0 * gas.volume**-0.06 * (p * w) ** 0.8 * gas.temperature**-0.4)


class HeatShare(Description):
    """A given share of the heat is lost."""

    kind: Literal["share"]
    share: Annotated[float, Quantity(RATIO, INSIDE_ONE)] = Field(
        description="Share of the heat released that is lost to the walls."
    )


AnyWallHeat = Annotated[Woschni | Hohenberg | HeatShare, Field(discriminator="kind")]
