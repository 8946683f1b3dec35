r"""The gas between closing and opening: compression, release of heat, expansion.

For a mass of ideal gas of one temperature the first law is

.. math:: \frac{dp}{dφ} = -γ \frac{V'}{V} p + \frac{γ - 1}{V} \left(Q x' - \frac{h S (T - T_w)}{ω}\right),
    \qquad T = \frac{p V}{m R}, \qquad m R = \frac{p_r V_r}{T_r}

(Heywood, Internal Combustion Engine Fundamentals, 1988, section 9.2.2). With γ(T) and the conductance hS of
the last iterate it is linear in p and in the heat Q, p = p_a + Q p_b, and both follow from integrating
factors over the panels of the mesh for all loads at once; Q then follows from what is asked for without a
search. A few iterates settle it to rounding.

Where no exponent is given, γ is that of air and of what burns in it. The mass of the fuel and the change of
the moles by combustion are left out of mR: together some three per cent at full load.

Air is O₂ + 3.727 N₂ + 0.044 Ar. Fuel CH_1.85 burns completely to CO₂ and H₂O; with the share b of the oxygen
used a mole of oxygen becomes

.. math:: (1 - b) \mathrm{O_2} + b (0.684 \mathrm{CO_2} + 0.632 \mathrm{H_2O}) + 3.727 \mathrm{N_2} +
    0.044 \mathrm{Ar}

and γ = c/(c - 1) with c the mean of c_p/R over the moles. Dissociation is left out: below 2200 K it changes γ
by less than a hundredth.

References
----------
.. [1] GRI-Mech 3.0, thermodynamic data (NASA polynomials, 200 to 3500 K): O₂, CO₂, H₂O.
.. [2] Goos, Burcat, Ruscic, Extended third millennium ideal gas thermochemical database: N₂, for which it is
   the better.
.. [3] Heywood, Internal Combustion Engine Fundamentals, 1988, section 3.4: stoichiometry and heating values.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import ConvergenceError, FindingError, MachineError, Problem
from linkwright.torsion.model.engine.cycle_pressure import CycleMesh
from linkwright.torsion.model.engine.heat import GasState, WallHeat

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


def burnable(mass_times_constant: Floats) -> Floats:
    """Heat that the oxygen of a charge of air can release, of the shape given [J], (n, 1).

    Heating value of the fuel for which the air just suffices. `mass_times_constant`: (n, 1) mR = pV/T of the
    charge [J/K].
    """
    return np.asarray(mass_times_constant / GAS_CONSTANT / STOICHIOMETRIC * HEATING_VALUE)


def heat_ratio(temperature: Floats, used: Floats) -> Floats:
    """γ = c_p/c_v, (n, m), at temperatures (n, m) [K] and shares b of the oxygen used (n, m)."""
    T = np.clip(temperature, _COLD, _HOT)
    hot = T > _MIDDLE
    air = np.where(hot, _polynomial(_AIR[1], T), _polynomial(_AIR[0], T))
    change = np.where(hot, _polynomial(_CHANGE[1], T), _polynomial(_CHANGE[0], T))
    c = (air + used * change) / (_MOLES + used * _MOLES_CHANGE)
    return np.asarray(c / (c - 1))


def _polynomial(a: Floats, T: Floats) -> Floats:
    """Horner's scheme."""
    return np.asarray(a[0] + T * (a[1] + T * (a[2] + T * (a[3] + T * a[4]))))


# The iterates contract by an order of magnitude each, so what is left is ten times less: far below what
# differences between two machines look at.
_TOLERANCE = 1e-12
_ITERATIONS = 60
# Rich mixtures burn with up to a quarter more fuel than the air suffices for.
_RICHEST = 1.25
# Exponent of the first iterate.
_FIRST = 1.35


@dataclass(frozen=True, eq=False)
class ClosedGas:
    """The task: the closed gas at n loads and m crank angles."""

    mesh: CycleMesh  # crank angles from closing to opening
    # `volume`, `volume_d1`: (m,) V [m³], V′ [m³/rad].
    volume: Floats
    volume_d1: Floats
    # `released`, `release`: (m,) share x of the fuel that is burnt, and its derivative x′ [1/rad].
    released: Floats
    release: Floats
    kept: float  # share of the heat that stays in the gas as it is released
    # `bore`, `swept_volume`, `volume_closing`: of the cylinder [m], [m³], and its volume at closing [m³].
    bore: float
    swept_volume: float
    volume_closing: float
    pressure_closing: Floats  # (n, 1) p_r [Pa]
    temperature_closing: float  # T_r [K]
    # `speed`, `piston_speed`: (n, 1) ω [rad/s], and mean speed of the piston [m/s].
    speed: Floats
    piston_speed: Floats
    exponent: float | None  # γ; None for that of air and burnt gas
    wall: WallHeat | None  # loss by convection

    @property
    def charge(self) -> Floats:
        """mR of the gas, shape (n, 1) [J/K]."""
        return np.asarray(self.pressure_closing * self.volume_closing / self.temperature_closing)


@dataclass(frozen=True, eq=False)
class ClosedTrace:
    """The closed gas, as it follows from a rule for the heat."""

    # `pressure`, `temperature`: (n, m) p [Pa], T [K].
    pressure: Floats
    temperature: Floats
    opening: Floats  # (n, 1) pressure as the exhaust opens [Pa]
    # `heat`, `wall_heat`: (n, 1) heat Q of a cycle, and what of it goes to the walls [J].
    heat: Floats
    wall_heat: Floats


@dataclass(frozen=True, eq=False)
class Split:
    """Pressure as a linear function of the heat, p_a + Q p_b."""

    # `without`, `per_heat`: (n, m) p_a [Pa], p_b [Pa/J].
    without: Floats
    per_heat: Floats
    # `opening_without`, `opening_per_heat`: (n, 1) the same as the exhaust opens.
    opening_without: Floats
    opening_per_heat: Floats
    last: Floats  # (n, m) pressure of the last iterate [Pa]


Rule = Callable[[Split], Floats]


def no_heat(split: Split) -> Floats:
    """The motored cylinder: no heat at any load, shape (n, 1) [J]."""
    return np.zeros_like(split.opening_without)


def closed_trace(gas: ClosedGas, rule: Rule, motored: Floats | None = None) -> ClosedTrace:
    """Pressure from closing to opening. `rule`: [J]; `motored`: (n, m) [Pa]."""
    p = gas.pressure_closing * (gas.volume_closing / gas.volume) ** _FIRST
    change, Q = np.inf, np.zeros_like(gas.pressure_closing)
    for _ in range(_ITERATIONS):
        T = p * gas.volume / gas.charge
        C = _conductance(gas, p, T, p if motored is None else motored)
        split = _split(gas, p, _exponent(gas, T, Q), C)
        Q = rule(split)
        new = split.without + Q * split.per_heat
        _check_positive(gas, new)
        change, p = float(np.abs(new / p - 1).max()), new
        if change < _TOLERANCE:
            _check_air(gas, Q)
            return _trace(gas, split, Q, C)
    raise ConvergenceError(
        f"the pressure of the gas does not settle within {_ITERATIONS} iterates (last change {change:.2g} of "
        "it); check heat, walls and speeds",
        method="closed cycle",
        iterations=_ITERATIONS,
        residual=change,
    )


def _check_positive(gas: ClosedGas, p: Floats) -> None:
    if not (p > 0).all():
        load, place = np.unravel_index(int(np.argmin(np.where(p > 0, np.inf, p))), p.shape)
        angle = math.degrees(float(gas.mesh.angle[place]))
        raise FindingError(
            f"the pressure in the cylinder would be {p[load, place]:.4g} Pa at {angle:.4g}° after the top "
            "dead centre of firing, less than none; check releases of heat, load and charge pressure"
        )


def _exponent(gas: ClosedGas, T: Floats, Q: Floats) -> Floats:
    """γ, given or of air and burnt gas."""
    if gas.exponent is not None:
        return np.full_like(T, gas.exponent)
    return heat_ratio(T, np.clip(gas.released * (Q / burnable(gas.charge)), 0.0, 1.0))


def _check_air(gas: ClosedGas, Q: Floats) -> None:
    share = Q / burnable(gas.charge)
    if gas.exponent is None and share.max() > _RICHEST:
        i = int(share.argmax())
        found = f"{Q[i, 0]:.6g} J a cycle, for which {share[i, 0]:.3g} times the air would be needed"
        expected = f"at most {burnable(gas.charge)[i, 0]:.6g} J from the air at the charge pressure"
        remedy = "raise charge_pressure, lower the load, or give isentropic_exponent for an idealised gas"
        raise MachineError([Problem("train.engine.gas", found, expected, remedy)])


def _conductance(gas: ClosedGas, p: Floats, T: Floats, motored: Floats) -> Floats | None:
    """Conductance of the walls per speed [J/(K rad)]; None without walls."""
    if gas.wall is None:
        return None
    state = GasState(gas.bore, gas.swept_volume, gas.volume, p, T, motored, 1 / gas.charge, gas.piston_speed)
    return gas.wall.conductance(state) / gas.speed


# ln of a change of pressure. Compression alone gives 5; walls that do so much more leave no gas to compute,
# and twice as much is no number any more.
_FASTEST = 300.0


def _split(gas: ClosedGas, p: Floats, gamma: Floats, C: Floats | None) -> Split:
    """Pressure as a linear function of the heat, with γ and conductance of an iterate."""
    V, w = gas.volume, gas.mesh.weight
    decay = gamma * (gas.volume_d1 / V)
    source = None
    if C is not None:
        assert gas.wall is not None
        loss = (gamma - 1) * C
        decay += loss / gas.charge
        source = loss * gas.wall.wall_temperature / V
    course, total = gas.mesh.integrals(decay), (decay @ w)[:, None]
    if not (np.abs(course) <= _FASTEST).all():
        raise FindingError(
            "the walls change the gas pressure by a factor of more than e^300 within a cycle; check "
            "speed, bore, charge pressure and the factor of [train.engine.gas.walls]"
        )
    E, E_end = np.exp(course), np.exp(total)
    released = (gamma - 1) * (gas.kept * gas.release / V) * E
    a, a_end = gas.pressure_closing + np.zeros_like(E), gas.pressure_closing
    if source is not None:
        a, a_end = a + gas.mesh.integrals(source * E), a_end + ((source * E) @ w)[:, None]
    return Split(a / E, gas.mesh.integrals(released) / E, a_end / E_end, (released @ w)[:, None] / E_end, p)


def _trace(gas: ClosedGas, split: Split, Q: Floats, C: Floats | None) -> ClosedTrace:
    p = split.without + Q * split.per_heat
    T = p * gas.volume / gas.charge
    lost = (1.0 - gas.kept) * Q
    if C is not None:
        assert gas.wall is not None
        lost += ((C * (T - gas.wall.wall_temperature)) @ gas.mesh.weight)[:, None]
    return ClosedTrace(p, T, split.opening_without + Q * split.opening_per_heat, Q, lost)
