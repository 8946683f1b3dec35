r"""Ratio of the specific heats of air and of what burns in it, by temperature.

Air is O₂ + 3.727 N₂ + 0.044 Ar. Fuel CH_1.85 burns completely to CO₂ and H₂O; with the share b of the oxygen
used a mole of oxygen becomes

.. math:: (1 - b) \mathrm{O_2} + b (0.684 \mathrm{CO_2} + 0.632 \mathrm{H_2O}) + 3.727 \mathrm{N_2} +
    0.044 \mathrm{Ar}

and γ = c/(c - 1) with c the mean of c_p/R over the moles. Dissociation is left out: below 2200 K it changes
γ by less than a hundredth.

References
----------
.. [1] GRI-Mech 3.0, thermodynamic data (NASA polynomials, 200 to 3500 K): O₂, CO₂, H₂O.
.. [2] Goos, Burcat, Ruscic, Extended third millennium ideal gas thermochemical database: N₂, for which
it is the better.
.. [3] Heywood, Internal Combustion Engine Fundamentals, 1988, section 3.4: stoichiometry and heating values.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Range of the polynomials, and where their halves meet [K].
_COLD, _MIDDLE, _HOT = 200.0, 1000.0, 3500.0

# c_p/R = a_0 + a_1 T + … + a_4 T⁴ below and above 1000 K.
_NITROGEN = (
    (3.53100528, -1.23660987e-4, -5.02999437e-7, 2.43530612e-9, -1.40881235e-12),
    (2.95257626, 1.39690057e-3, -4.92631691e-7, 7.86010367e-11, -4.60755321e-15),
)
_OXYGEN = (
    (3.78245636, -2.99673416e-3, 9.84730201e-6, -9.68129509e-9, 3.24372837e-12),
    (3.28253784, 1.48308754e-3, -7.57966669e-7, 2.09470555e-10, -2.16717794e-14),
)
_CARBON_DIOXIDE = (
    (2.35677352, 8.98459677e-3, -7.12356269e-6, 2.45919022e-9, -1.43699548e-13),
    (3.85746029, 4.41437026e-3, -2.21481404e-6, 5.23490188e-10, -4.72084164e-14),
)
_WATER = (
    (4.19864056, -2.0364341e-3, 6.52040211e-6, -5.48797062e-9, 1.77197817e-12),
    (3.03399249, 2.17691804e-3, -1.64072518e-7, -9.7041987e-11, 1.68200992e-14),
)

# Hydrogen per carbon: 1.85 is usual for Diesel fuel and petrol alike.
_HYDROGEN = 1.85
_OXYGEN_PER_CARBON = 1.0 + _HYDROGEN / 4
# Dry air has 20.95 % of oxygen, 78.08 % of nitrogen and 0.93 % of argon by volume; CO₂ is counted as argon.
_NITROGEN_PER_OXYGEN = 78.08 / 20.95
_ARGON_PER_OXYGEN = 0.97 / 20.95
# Of a mole of oxygen: air, and what its combustion adds to that.
_ARGON = ((2.5, 0.0, 0.0, 0.0, 0.0),) * 2
_AIR = np.array(_OXYGEN) + _NITROGEN_PER_OXYGEN * np.array(_NITROGEN) + _ARGON_PER_OXYGEN * np.array(_ARGON)
_CHANGE = (np.array(_CARBON_DIOXIDE) + _HYDROGEN / 2 * np.array(_WATER)) / _OXYGEN_PER_CARBON - np.array(
    _OXYGEN
)
_MOLES = 1.0 + _NITROGEN_PER_OXYGEN + _ARGON_PER_OXYGEN
_MOLES_CHANGE = (1.0 + _HYDROGEN / 2) / _OXYGEN_PER_CARBON - 1.0

# Masses of the atoms [g/mol] give the air that a mass of fuel needs.
_FUEL_MASS = 12.011 + 1.008 * _HYDROGEN
_AIR_MASS = 2 * (15.999 + 14.007 * _NITROGEN_PER_OXYGEN) + 39.948 * _ARGON_PER_OXYGEN
STOICHIOMETRIC = _OXYGEN_PER_CARBON * _AIR_MASS / _FUEL_MASS
# Lower heating value of the fuel [J/kg], and gas constant of air [J/(kg K)].
HEATING_VALUE = 42.7e6
GAS_CONSTANT = 8314.462618 / (_AIR_MASS / _MOLES)


def burnable(mass_times_constant: Array) -> Array:
    """Heat that the oxygen of a charge of air can release, of the shape given [J], (n, 1).

    Heating value of the fuel for which the air just suffices. `mass_times_constant`: (n, 1) mR = pV/T of the
    charge [J/K].
    """
    return np.asarray(mass_times_constant / GAS_CONSTANT / STOICHIOMETRIC * HEATING_VALUE)


def heat_ratio(temperature: Array, used: Array) -> Array:
    """Ratio of the specific heats γ, shape (n, m).

    γ = c_p/c_v. `temperature`: (n, m) [K]; `used`: (n, m) share b of the oxygen that is used, 0 to 1.
    """
    T = np.clip(temperature, _COLD, _HOT)
    hot = T > _MIDDLE
    air = np.where(hot, _polynomial(_AIR[1], T), _polynomial(_AIR[0], T))
    change = np.where(hot, _polynomial(_CHANGE[1], T), _polynomial(_CHANGE[0], T))
    c = (air + used * change) / (_MOLES + used * _MOLES_CHANGE)
    return np.asarray(c / (c - 1))


def _polynomial(a: Array, T: Array) -> Array:
    """Horner's scheme."""
    return np.asarray(a[0] + T * (a[1] + T * (a[2] + T * (a[3] + T * a[4]))))
