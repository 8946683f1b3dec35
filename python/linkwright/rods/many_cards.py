"""Measured cards of a field day at once.

The damping is the well's: it is fitted to some of the cards and held for all.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import FindingError, InputError
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.machine.machine import Machine
from linkwright.rods.card import SurfaceCard, checked_card
from linkwright.rods.core import cards_in_rows, sample_counts
from linkwright.rods.diagnosis import card_period, diagnose_card
from linkwright.rods.model.rod_string import RodString
from linkwright.rods.plunger_load import plunger_load
from linkwright.rods.prediction import string_of
from linkwright.rods.spectrum import filtered

# Samples of the cards at least, cards at a time, and cards to which the damping is fitted.
_SAMPLES, _AT_ONCE, _FITTED = 512, 512, 9

_NO_PUMP_CARD = "the pump card has no upstroke whose load is above that of the downstroke"


@dataclass(frozen=True)
class CardDiagnoses(Result):
    """Diagnoses of many cards of one well; NaN for a card with a fault."""

    faults: Annotated[tuple[str, ...], About("Why a card was not diagnosed, empty where it was.")]
    period: Annotated[Floats, Label("period of a stroke", "T", "s", shape="(cards,)")]
    stroke: Annotated[Floats, Label("stroke of the polished rod", "S", "m", shape="(cards,)")]
    load_max: Annotated[Floats, Label("peak polished-rod load", "PPRL", "N", "Measured.", "(cards,)")]
    load_min: Annotated[Floats, Label("minimum polished-rod load", "MPRL", "N", "Measured.", "(cards,)")]
    plunger_stroke: Annotated[Floats, Label("plunger stroke", "S_p", "m", shape="(cards,)")]
    fillage: Annotated[Floats, Label("fillage", "f", "", shape="(cards,)")]
    fluid_load: Annotated[Floats, Label("fluid load on the plunger", "F_o", "N", shape="(cards,)")]
    production: Annotated[Floats, Label("production", "Q", "m³/s", shape="(cards,)")]
    power_rod: Annotated[Floats, Label("power of the polished rod", "P_PR", "W", shape="(cards,)")]
    power_pump: Annotated[Floats, Label("power of the pump", "P_p", "W", shape="(cards,)")]
    damping: Annotated[float, Label("damping", "c", "1/s", "Of all cards.")]


# Quantities of a card, in the order of the columns.
_QUANTITIES = (
    *("period", "stroke", "load_max", "load_min", "plunger_stroke"),
    *("fillage", "fluid_load", "production", "power_rod", "power_pump"),
)


@public
def diagnose_cards(
    machine: Machine, cards: Sequence[SurfaceCard], *, damping: float | None = None
) -> CardDiagnoses:
    """Pumps of many surface cards of one well, such as those of a day.

    Parameters
    ----------
    machine : Machine
        A machine with a rod string.
    cards : sequence of SurfaceCard
        Measured cards, as `read_card` gives them.
    damping : float, optional
        Damping c of the string [1/s]. Default: the median of fits to some of the cards.

    Returns
    -------
    CardDiagnoses
        Plunger stroke, fillage, fluid load, production and powers of every card; a card that cannot be one of
        the well has its reason in `faults`.

    Raises
    ------
    InputError
        There are no cards, or none can be fitted.

    See Also
    --------
    diagnose_card : one card, with the cards along its string.
    """
    string = string_of(machine)
    if not len(cards):
        raise InputError("cards: found none, expected one or more")
    held = _fitted(machine, cards) if damping is None else float(damping)
    parts = [
        _diagnosed(machine, string, cards[at : at + _AT_ONCE], held) for at in range(0, len(cards), _AT_ONCE)
    ]
    table = np.concatenate([part[0] for part in parts])
    return CardDiagnoses(
        faults=tuple(fault for part in parts for fault in part[1]),
        damping=held,
        **dict(zip(_QUANTITIES, np.ascontiguousarray(table.T), strict=True)),
    )


def _fitted(machine: Machine, cards: Sequence[SurfaceCard]) -> float:
    """The median of the dampings that fit some of the cards."""
    found, why = [], ""
    for at in np.unique(np.linspace(0, len(cards) - 1, _FITTED).astype(int)):
        card = cards[at]
        try:
            found.append(diagnose_card(machine, card.position, card.load, period=card.period).damping)
        except (InputError, FindingError) as error:
            why = str(error)
    if not found:
        raise InputError(f"cards: none of some could be fitted, expected cards of this well; {why}")
    return float(np.median(found))


def _diagnosed(
    machine: Machine, string: RodString, cards: Sequence[SurfaceCard], damping: float
) -> tuple[Floats, list[str]]:
    """Quantities of cards, (cards, quantities), and their faults."""
    unit = machine.pumping_unit
    stroke = string.stroke if unit is None else float(unit.stroke)
    weight, box = float(string.weight_fluid), string.stuffing_box
    faults = [""] * len(cards)
    rows, periods, moved, own = [], [], [], []
    for row, given in enumerate(cards):
        try:
            card = checked_card(given, string, stroke)
            period = card_period(machine, string, card.period)
        except InputError as error:
            faults[row] = str(error)
            continue
        m = (
            _SAMPLES
            if len(card.load) <= _SAMPLES // 2
            else sample_counts(string, period, 2 * len(card.load))[0]
        )
        friction = box * np.sign(np.roll(card.position, -1) - np.roll(card.position, 1)) if box else 0.0
        rows.append((row, card))
        periods.append(period)
        moved.append(filtered(card.position, m, None).samples)
        own.append(filtered(card.load - weight - friction, m, None).samples)
    table = np.full((len(cards), len(_QUANTITIES)), np.nan)
    compliance, area = float(string.pump.tubing_compliance(string.length)), float(string.pump.area)
    # Records of one length go down the string together.
    for m in {len(samples) for samples in own}:
        at = [i for i, samples in enumerate(own) if len(samples) == m]
        records = [np.array([curves[i] for i in at]) for curves in (moved, own)]
        position, load, work = cards_in_rows(
            string, [periods[i] for i in at], records[0], records[1], damping
        )
        for k, i in enumerate(at):
            (row, card), period = rows[i], periods[i]
            pump = plunger_load(position[k] - compliance * load[k], load[k])
            if pump is None:
                faults[row] = _NO_PUMP_CARD
                continue
            reach = float(np.ptp(card.position))
            production = area * pump.fillage * pump.stroke / period
            table[row] = (
                *(period, reach, card.load.max(), card.load.min(), pump.stroke, pump.fillage),
                *(pump.fluid_load, production, (work[k, 0] + 2 * box * reach) / period, work[k, 1] / period),
            )
    return table, faults
