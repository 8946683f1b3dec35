"""Measured cards of a field day at once.

The damping is the well's: it is fitted to some of the cards and held for all.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import FindingError, InputError
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label, declared
from linkwright.kernel.result import Result
from linkwright.machine.machine import Machine
from linkwright.rods.card import SurfaceCard, checked_card, read_card
from linkwright.rods.core import cards_in_rows, sample_counts
from linkwright.rods.diagnosis import card_period, diagnose_card, records
from linkwright.rods.model.rod_string import RodString
from linkwright.rods.plunger_load import CardNumbers, card_numbers, pump_of
from linkwright.rods.prediction import string_of
from linkwright.rods.scalars import goodman_loadings

# Samples of the cards at least, cards at a time, and cards to which the damping is fitted.
_SAMPLES, _AT_ONCE, _FITTED = 512, 256, 9

# Fillage from which on a barrel counts as full: the levels of a card scatter by some hundredths.
FULL = 0.95

# A card, or a file with one.
CardOrFile = SurfaceCard | str | os.PathLike[str]


@dataclass(frozen=True)
class CardDiagnoses(CardNumbers[Floats], Result):
    """Diagnoses of many cards of one well; NaN for a card with a fault."""

    loading_max: Annotated[
        Floats,
        Label("maximum Goodman loading", "", "", "NaN without a tensile strength.", "(names,)"),
    ]
    names: Annotated[tuple[str, ...], About("Files of the cards, or their numbers from 1.")]
    faults: Annotated[tuple[str, ...], About("Why a card was not diagnosed, empty where it was.")]
    damping: Annotated[float, Label("damping", "c", "1/s", "Of all cards.")]

    @property
    def verdicts(self) -> Annotated[tuple[str, ...], About("What each card shows, in some words.")]:
        """Not diagnosed; or rods overloaded by the Goodman diagram, else whether the barrel is full."""
        words = np.where(self.fillage >= FULL, "full pump", "partial fillage")
        words = np.where(self.loading_max > 1, "rods overloaded", words)
        return tuple(np.where([*map(bool, self.faults)], "not diagnosed", words).tolist())

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Damping, faults and verdicts, and the numbers of the cards by name."""
        return super().to_dict() | self.parts_by_name()


class _Ready(NamedTuple):
    """A card that was checked, at the samples that go down the string."""

    row: int
    card: SurfaceCard
    period: float
    moved: Floats
    own: Floats


@public
def diagnose_cards(
    machine: Machine,
    cards: Sequence[CardOrFile],
    *,
    damping: float | None = None,
    period: float | None = None,
    watch: Callable[[float], None] = lambda _: None,
) -> CardDiagnoses:
    """Pumps of many surface cards of one well, such as those of a day.

    Parameters
    ----------
    machine : Machine
        A machine with a rod string.
    cards : sequence of SurfaceCard or path
        Measured cards, as `read_card` gives them, or their files.
    damping : float, optional
        Damping c of the string [1/s]. Default: the median of fits to some of the cards.
    period : float, optional
        Period of the strokes [s]. Default: that of each card, or that of the machine's speed.
    watch : callable, optional
        Progress callback, 0 to 1.

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
    held = _fitted(machine, cards, period) if damping is None else float(damping)
    faults, numbers = [""] * len(cards), {name: np.full(len(cards), np.nan) for name in _QUANTITIES}
    for at in range(0, len(cards), _AT_ONCE):
        ready = _ready(machine, string, cards, range(at, min(at + _AT_ONCE, len(cards))), period, faults)
        # Records of one length go down the string together.
        for m in {len(each.own) for each in ready}:
            _diagnose(string, [each for each in ready if len(each.own) == m], held, numbers, faults)
        watch(min(at + _AT_ONCE, len(cards)) / len(cards))
    return CardDiagnoses(**numbers, names=_names(cards), faults=tuple(faults), damping=held)


# Names of the numbers of a card.
_QUANTITIES = tuple(
    name for name, mark in declared(CardDiagnoses).items() if getattr(mark[1], "shape", "") == "(names,)"
)


def _names(cards: Sequence[CardOrFile]) -> tuple[str, ...]:
    """Names of files, with their folders where two have one name; numbers of cards without a file."""
    files = [None if isinstance(card, SurfaceCard) else Path(card) for card in cards]
    short = [str(n) if file is None else file.name for n, file in enumerate(files, start=1)]
    if len(set(short)) == len(short):
        return tuple(short)
    return tuple(str(n) if file is None else str(file) for n, file in enumerate(files, start=1))


def _read(card: CardOrFile) -> SurfaceCard:
    return card if isinstance(card, SurfaceCard) else read_card(card)


def _fitted(machine: Machine, cards: Sequence[CardOrFile], period: float | None) -> float:
    """The median of the dampings that fit some of the cards, those evenly over the day first."""
    spread = np.linspace(0, len(cards) - 1, _FITTED).astype(int)
    found: list[float] = []
    why = ""
    for at in dict.fromkeys([*spread.tolist(), *range(len(cards))]):
        try:
            card = _read(cards[at])
            own = card.period if period is None else period
            found.append(diagnose_card(machine, card.position, card.load, period=own).damping)
        except (InputError, FindingError) as error:
            why = why or str(error)
        if len(found) == _FITTED:
            break
    if not found:
        raise InputError(f"cards: none of {len(cards)} could be fitted, expected cards of this well; {why}")
    return float(np.median(found))


def _ready(
    machine: Machine,
    string: RodString,
    cards: Sequence[CardOrFile],
    rows: range,
    period: float | None,
    faults: list[str],
) -> list[_Ready]:
    """Cards that can be those of the string; of the others the faults."""
    unit, ready = machine.pumping_unit, []
    stroke = string.stroke if unit is None else float(unit.stroke)
    for row in rows:
        try:
            card = checked_card(_read(cards[row]), string, stroke)
            own = card_period(machine, string, card.period if period is None else period)
        except InputError as error:
            faults[row] = _line(error)
            continue
        n = len(card.load)
        m = _SAMPLES if n <= _SAMPLES // 2 else sample_counts(string, own, 2 * n)[0]
        ready.append(_Ready(row, card, own, *(each.samples for each in records(string, card, m))))
    return ready


def _line(error: Exception) -> str:
    """The message of an error in one line."""
    return "; ".join(" ".join(line.split()) for line in str(error).splitlines() if line.strip())


def _diagnose(
    string: RodString, ready: list[_Ready], damping: float, numbers: dict[str, Floats], faults: list[str]
) -> None:
    """Put the numbers of cards of one length in their rows, or what is wrong with a pump card."""
    moved, own = (np.array([getattr(each, name) for each in ready]) for name in ("moved", "own"))
    found = cards_in_rows(string, [each.period for each in ready], moved, own, damping)
    loadings = list(goodman_loadings(string, found.load).values())
    worst = np.max(loadings, axis=0) if loadings else np.full(len(ready), np.nan)
    for n, (row, card, period, *_) in enumerate(ready):
        try:
            pump = pump_of(string, found.position[n, -1], found.load[n, -1])
        except (InputError, FindingError) as error:
            faults[row] = _line(error)
            continue
        own_numbers = card_numbers(string, card, period, pump, found.work[n, [0, -1]])
        for name, value in (own_numbers | {"loading_max": worst[n]}).items():
            numbers[name][row] = value
