"""Diagnosis of a measured surface card: the cards of every taper and of the pump.

Each harmonic of position and load goes down the string by its transfer matrices (Gibbs). Damping is
fitted: with the right one, the pump load is the same wherever the plunger lifts the fluid, and the same
wherever it sinks through it. How large the latter is does not count: an offset of the load cell or friction
of the plunger does not make damping.

References
----------
.. [1] Gibbs, Neely, Computer Diagnosis of Down-Hole Conditions in Sucker Rod Pumping Wells, J. Pet. Tech. 18
(1966) 91.
.. [2] Everitt, Jennings, An Improved Finite-Difference Calculation of Downhole Dynamometer Cards for
Sucker-Rod
Pumps,
   SPE Production Engineering 7 (1992) 121: fillage and net stroke.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Annotated, Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.machine.machine import Machine
from linkwright.rods.card import SurfaceCard, checked_card, timed_card
from linkwright.rods.core import cards_of, sample_counts
from linkwright.rods.model.rod_string import RodString
from linkwright.rods.plunger_load import (
    CardNumbers,
    against_barrel,
    card_numbers,
    no_pump_card,
    plunger_load,
    pump_of,
)
from linkwright.rods.prediction import BALANCE, DYNAMIC_LOAD, ROD_POSITION, station_names, string_of
from linkwright.rods.spectrum import Filtered, filtered, smoothed
from linkwright.rods.stress import RodStress, rod_stress

# Samples of the cards at least, and for each of the measured ones.
_LEAST, _FOR_EACH = 512, 4

# Largest damping factor that is sought, and how many are tried before the best is refined.
_DAMPED, _TRIED = 1.0, 26

# F beyond which a parameter is significant at 95 % of confidence, with many observations.
_SIGNIFICANT = 4.0

# Damping factor up to which a string is one.
_OVERDAMPED = 5.0

# Periods of strokes [s], and what a period may differ from that of the file.
_PERIODS, _PERIOD_AGREES = (1.0, 300.0), 1.5


_of = partial(Label, table="diagnosis")


@dataclass(frozen=True)
class CardDiagnosis(CardNumbers[float], Result):
    """A measured card along the rod string down to the pump."""

    time: Annotated[Floats, Label("time", "t", "s", "From the first sample.")]
    stations: Annotated[tuple[str, ...], About("The polished rod, the tapers, the pump.")]
    position: Annotated[Floats, Label("position", "u", "m", "Upward.", "(stations, n)")]
    load: Annotated[Floats, DYNAMIC_LOAD]
    rod_position: Annotated[Floats, ROD_POSITION]
    rod_load: Annotated[Floats, Label("load of the polished rod", "W", "N", "By its harmonics.")]
    fluid_load_file: Annotated[float, _of("fluid load by the machine file", "", "N", before="production")]
    intake_pressure: Annotated[
        float, _of("intake pressure by the pump card", "p_i", "Pa", before="production")
    ]
    power_damping: Annotated[float, _of("power lost to damping", "P_c", "W")]
    damping: Annotated[float, _of("damping", "c", "1/s")]
    damping_factor: Annotated[float, _of("damping factor", "ν", "", "2cL/(πa).")]
    is_fitted: Annotated[bool, About("Whether the damping was fitted to the card.")]
    harmonics: Annotated[int, _of("harmonics of the load", "", "", "Above its noise.")]
    harmonics_position: Annotated[int, _of("harmonics of the position", "", "", "Above its noise.")]
    noise: Annotated[float, _of("noise of the load", "", "N", "Standard deviation of a sample.")]
    noise_position: Annotated[float, _of("noise of the position", "", "m", "Standard deviation of a sample.")]
    balance: Annotated[float, BALANCE]
    stress: Annotated[RodStress, About("Loads and stresses of the sections.")]

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Scalars by name, and the stresses of the sections."""
        return super().to_dict(curves=curves) | {"stress": self.stress.to_dict(curves=True)}


@public
def diagnose_card(
    machine: Machine,
    position: Floats,
    load: Floats,
    *,
    period: float | None = None,
    damping: float | None = None,
    harmonics: int | None = None,
) -> CardDiagnosis:
    """Cards of every taper and of the pump by a measured surface card.

    Parameters
    ----------
    machine : Machine
        A machine with a rod string.
    position, load : ndarray, shape (n,)
        One stroke at equal steps of time: position of the polished rod, upward [m], and its load [N].
    period : float, optional
        Period of the stroke [s]. Default: that of the machine's speed.
    damping : float, optional
        Damping c of the string [1/s]. Default: fitted to the card.
    harmonics : int, optional
        Harmonics of position and load that count. Default: those above the noise of each.

    Returns
    -------
    CardDiagnosis
        Cards along the string, plunger stroke, fillage, fluid load, powers.

    Raises
    ------
    InputError
        The card does not close, runs backwards, has too few samples, or loads that rods and fluid cannot
        cause.
    FindingError
        The pump card has no upstroke with a load above that of the downstroke.
    """
    string = string_of(machine)
    unit = machine.pumping_unit
    stroke = string.stroke if unit is None else float(unit.stroke)
    card = checked_card(SurfaceCard(position, load, period), string, stroke)
    period = card_period(machine, string, card.period)
    n = len(card.load)
    if damping is not None and not 0 <= damping <= _OVERDAMPED * _damping_unit(string):
        highest = _OVERDAMPED * _damping_unit(string)
        raise InputError(f"damping: found {damping:.6g} 1/s, expected 0 to {highest:.4g} 1/s")
    if harmonics is not None and not 1 <= harmonics <= (n - 1) // 2:
        raise InputError(
            f"harmonics: found {harmonics}, expected 1 to {(n - 1) // 2}: {n} samples hold no more"
        )
    m = sample_counts(string, period, max(_LEAST, _FOR_EACH * n))[0]
    moved, own = records(string, card, m, harmonics)
    fitted = _fitted(string, period, moved, own) if damping is None else damping
    return _diagnosis(string, card, period, (moved, own), fitted, is_fitted=damping is None)


def records(
    string: RodString, card: SurfaceCard, m: int, harmonics: int | None = None
) -> tuple[Filtered, Filtered]:
    """Position and dynamic load of the polished rod by their harmonics, at m samples."""
    friction = string.stuffing_box * np.sign(np.roll(card.position, -1) - np.roll(card.position, 1))
    own = card.load - float(string.weight_fluid) - friction
    return filtered(card.position, m, harmonics), filtered(own, m, harmonics)


def card_period(machine: Machine, string: RodString, given: float | None) -> float:
    """Period of a card [s]: as given, or that of the machine's speed; the two must not contradict."""
    speed = string.speed if machine.drive is None else machine.drive.speed
    known = None if speed is None else 2 * np.pi / speed
    period = known if given is None else float(given)
    if period is None:
        raise InputError(
            f"{machine.name}: the period of the card is unknown; expected a column time, drive.speed or "
            "rod_string.speed"
        )
    low, high = _PERIODS
    if not low <= period <= high:
        raise InputError(
            f"period: found {period:.6g} s, expected {low:g} to {high:g} s; compare the unit of time"
        )
    if known is not None and not 1 / _PERIOD_AGREES <= period / known <= _PERIOD_AGREES:
        raise InputError(
            f"period: found {period:.4g} s, expected about that of the machine file, {known:.4g} s; compare "
            "the unit of time and the speed"
        )
    return period


def _damping_unit(string: RodString) -> float:
    """Damping [1/s] of a damping factor of one."""
    return float(np.pi * string.sound / (2 * string.length))


def _fitted(string: RodString, period: float, moved: Filtered, own: Filtered) -> float:
    """Damping at which the pump load is even while the plunger lifts, and while it sinks.

    It is none where the scatter without damping is not significantly larger: an F test of one parameter, each
    harmonic two observations.
    """
    from scipy.optimize import minimize_scalar

    unit = _damping_unit(string)
    position, load = (smoothed(each.samples, own.harmonics) for each in (moved, own))

    def unevenness(factor: float) -> float:
        cards = cards_of(string, period, position, load, factor * unit)
        found = plunger_load(against_barrel(string, cards.position[-1], cards.load[-1]), cards.load[-1])
        return np.inf if found is None else found.unevenness

    factors = np.linspace(0.0, _DAMPED, _TRIED)
    values = [unevenness(float(factor)) for factor in factors]
    best = int(np.argmin(values))
    if not np.isfinite(values[best]):
        raise no_pump_card()
    around = factors[max(best - 1, 0)], factors[min(best + 1, _TRIED - 1)]
    refined = minimize_scalar(unevenness, bounds=around, method="bounded", options={"xatol": 1e-4})
    factor, scatter = (
        (refined.x, refined.fun) if refined.fun <= values[best] else (factors[best], values[best])
    )
    if (values[0] - scatter) * 2 * own.harmonics < _SIGNIFICANT * scatter:
        return 0.0
    return float(factor) * unit


def _diagnosis(
    string: RodString,
    card: SurfaceCard,
    period: float,
    records: tuple[Filtered, Filtered],
    damping: float,
    *,
    is_fitted: bool,
) -> CardDiagnosis:
    moved, own = records
    cards = cards_of(string, period, moved.samples, own.samples, damping)
    pump = pump_of(string, cards.position[-1], cards.load[-1])
    numbers = card_numbers(string, card, period, pump, cards.work[[0, -1]])
    lost = float(cards.loss.sum())
    return CardDiagnosis(
        time=period * np.arange(len(own.samples)) / len(own.samples),
        stations=station_names(string),
        position=cards.position,
        load=cards.load,
        rod_position=moved.samples - moved.samples.min(),
        rod_load=own.samples + float(string.weight_fluid),
        **numbers,
        fluid_load_file=float(string.fluid_load),
        intake_pressure=float(string.discharge) - pump.fluid_load / float(string.pump.area),
        power_damping=lost / period,
        damping=damping,
        damping_factor=2 * damping * float(string.length) / (np.pi * float(string.sound)),
        is_fitted=is_fitted,
        harmonics=own.harmonics,
        harmonics_position=moved.harmonics,
        noise=own.noise,
        noise_position=moved.noise,
        balance=float((cards.work[0] - cards.work[-1] - lost) / cards.work[0]),
        stress=rod_stress(string, cards.load),
    )


def card_diagnosis(machine: Machine) -> CardDiagnosis:
    """Diagnosis of the measured card of a machine file; an `InputError` without one."""
    entries = machine.rod_string.card if machine.rod_string is not None else None
    if entries is None:
        raise InputError(f"{machine.name} has no [rod_string.card]: expected a measured card")
    times = None if entries.time is None else np.array(entries.time)
    card = timed_card(np.array(entries.position), np.array(entries.load), times, "rod_string.card")
    period = card.period if entries.period is None else entries.period
    how: Any = {"period": period, "damping": entries.damping, "harmonics": entries.harmonics}
    return diagnose_card(machine, card.position, card.load, **how)
