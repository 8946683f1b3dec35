r"""Entries of a machine that stay adjustable in its FMU.

The library has the numbers of the program and no machine file. It exchanges an entry p by

.. math:: q_k = q_{k,0} + c_k\,(p^{n_k} - p_0^{n_k})

so that only entries are offered by whose powers the numbers of the program change, and whose exchange leaves
its structure as it is: masses, inertias, forces, torques, stiffnesses. Lengths of the mechanism are not among
them: its assembly mode and its dead centres follow from them. To see whether the law holds, the machine is
translated anew with other values of the entry.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from linkwright.fmi.program import Program
from linkwright.kernel.arrays import Floats, Integers
from linkwright.kernel.description.base import Description
from linkwright.kernel.description.place import field_names
from linkwright.kernel.description.schema_walk import annotation_at, mark_of
from linkwright.kernel.errors import LinkwrightError
from linkwright.kernel.units.kinds import COUNT, Kind
from linkwright.kernel.units.marks import Quantity
from linkwright.machine.address import addresses, entry_at, exchanged, known_place
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import Translation

# Values of an entry with which the machine is translated, over its own; of an entry that is zero, in SI.
_TRIALS = (2.0, 0.5, 1.25)

# Powers that numbers of the program have: inertias go with the square of a ratio, slopes of a motor with one
# over its speed.
_POWERS = (1, -1, 2, -2)

# Share of a number that rounding may leave between two translations.
_ROUNDING = 1e-12

# What an entry raises that cannot have another value.
_FAILURES = (LinkwrightError, TypeError, ValueError, ArithmeticError)


class Move(NamedTuple):
    """A number of the program that follows an entry p: it changes with factor · pⁿ."""

    slot: int
    factor: float
    power: int


class Adjustable(NamedTuple):
    """An entry that the importing tool may change."""

    address: str
    value: float  # in the file [SI]
    kind: Kind
    about: str  # what it is
    bounds: tuple[float, float]  # minimum and maximum
    moves: tuple[Move, ...]

    def change(self, value: float) -> dict[int, float]:
        """By how much the numbers of the program change where the entry has another value."""
        return {move.slot: move.factor * (value**move.power - self.value**move.power) for move in self.moves}


def adjustable(program: Program, *, rigid: bool) -> list[Adjustable]:
    """Entries that may be changed in an FMU, in the order of the file."""
    trials = _Trials(program, rigid=rigid)
    kept: list[Adjustable] = []
    for name, value in addresses(program.machine).items():
        mark = _mark(program.machine, name)
        if mark is not None and mark.kind is not COUNT:
            entry = trials.entry(name, float(value), mark)
            if entry is not None and trials.is_independent(entry, kept):
                kept.append(entry)
    return kept


def _mark(machine: Machine, name: str) -> Quantity | None:
    """The quantity that an entry is."""
    mark = mark_of(annotation_at(type(machine), known_place(machine, name), machine))
    return mark if isinstance(mark, Quantity) else None


def _about(machine: Machine, name: str) -> str:
    """What the file format says of an entry, without the marks of code."""
    *above, key = known_place(machine, name)
    owner = entry_at(machine, above)
    if not isinstance(owner, Description):
        return ""
    return (type(owner).model_fields[field_names(type(owner))[key]].description or "").replace("`", "")


def bounds_of(mark: Quantity) -> tuple[float, float]:
    """The smallest and the largest number of a quantity: the range of its kind, within its bound.

    FMI has no bounds that are excluded, so that a size above zero has the smallest one of its kind.
    """
    limits, most = mark.bound.schema, mark.kind.most
    above, below = limits.get("exclusiveMinimum", -math.inf), limits.get("exclusiveMaximum", math.inf)
    smallest = mark.kind.least if above == 0 else math.nextafter(above, math.inf)
    return (
        max(limits.get("minimum", -most), smallest, -most),
        min(limits.get("maximum", most), math.nextafter(below, -math.inf), most),
    )


class _Trials:
    """Translates a machine with other values of its entries."""

    def __init__(self, program: Program, *, rigid: bool) -> None:
        self.program, self.rigid = program, rigid
        # Numbers of the mechanism itself come first.
        own = program.chain is None or not program.machine.has_mounted_mechanisms
        self.n_own = Translation(program.machine, motor=True, brake=False).program.n_own if own else 0

    def numbers(self, values: Mapping[str, float]) -> Floats | None:
        """Numbers of the program with other entries; None where they do not have them."""
        try:
            found = Program(exchanged(self.program.machine, values), rigid=self.rigid)
            is_same = found.has_structure_of(self.program)
        except _FAILURES:
            # silent: an entry that cannot have another value is not offered
            return None
        return found.numbers if is_same else None

    def entry(self, name: str, value: float, mark: Quantity) -> Adjustable | None:
        """An entry that moves some numbers by its powers; None if it does not."""
        others = [share * (value or 1.0) for share in _TRIALS]
        first = self.numbers({name: others[0]})
        if first is None:
            return None
        slots = np.flatnonzero(first != self.program.numbers).astype(np.int32)
        if not len(slots) or slots[0] < self.n_own:
            return None
        rows = [first, *(self.numbers({name: other}) for other in others[1:])]
        known = [row for row in rows if row is not None]
        if len(known) < len(rows):
            return None
        moves = self._moves(slots, value, others, known)
        entry = Adjustable(
            name, value, mark.kind, _about(self.program.machine, name), bounds_of(mark), tuple(moves)
        )
        agree = all(self._agrees(row, [(entry, other)]) for row, other in zip(known, others, strict=True))
        return entry if agree else None

    def _moves(
        self, slots: Integers, value: float, others: list[float], rows: list[Floats]
    ) -> Sequence[Move]:
        """How numbers follow an entry, of those that follow by a power of it."""
        powers = _POWERS if value else _POWERS[:1]
        moves = (self._move(int(slot), value, others, rows, powers) for slot in slots)
        return [move for move in moves if move is not None]

    def _move(
        self, slot: int, value: float, others: list[float], rows: list[Floats], powers: tuple[int, ...]
    ) -> Move | None:
        """The power by which a number follows an entry; None if it follows by none."""
        at = self.program.numbers[slot]
        changes = [row[slot] - at for row in rows]
        size = _ROUNDING * max(abs(at), *map(abs, changes))
        for power in powers:
            basis = [other**power - value**power for other in others]
            factor = changes[0] / basis[0]
            if all(abs(factor * b - c) <= size for b, c in zip(basis, changes, strict=True)):
                return Move(slot, float(factor), power)
        return None

    def _agrees(self, found: Floats | None, values: list[tuple[Adjustable, float]]) -> bool:
        """Whether a machine with other entries has the numbers that its FMU will take."""
        own = self.program.numbers
        expected = own.copy()
        for entry, value in values:
            for slot, change in entry.change(value).items():
                expected[slot] += change
        if found is None or found.shape != expected.shape:
            return False
        sizes = np.maximum(np.abs(expected), np.abs(own))
        return bool((np.abs(found - expected) <= 4 * _ROUNDING * sizes).all())

    def is_independent(self, entry: Adjustable, kept: list[Adjustable]) -> bool:
        """Whether an entry and those that move the same numbers may change together."""
        slots = {move.slot for move in entry.moves}
        beside = [other for other in kept if slots & {move.slot for move in other.moves}]
        values = [(each, _TRIALS[0] * (each.value or 1.0)) for each in (*beside, entry)]
        together = {each.address: value for each, value in values}
        return not beside or self._agrees(self.numbers(together), values)
