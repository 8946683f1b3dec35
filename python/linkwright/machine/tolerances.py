"""Tolerances of the entries of a machine, behind their values or in the table ``tolerances``.

``radius = "0.2 m ± 0.2 mm"`` is the size 0.2 m, which every analysis computes with, and the tolerance
``± 0.2 mm`` of that address, which `linkwright tolerance` takes as a variable.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from linkwright.kernel.description.place import join
from linkwright.kernel.description.schema_walk import annotation_at, mark_of
from linkwright.kernel.errors import MachineError, Problem, show
from linkwright.kernel.units.kinds import LENGTH, Kind
from linkwright.kernel.units.marks import Quantity
from linkwright.kernel.units.reading import worded
from linkwright.machine.address import get, kind, known_place, outside
from linkwright.machine.machine import Machine
from linkwright.machine.overrides import Override, apply
from linkwright.machine.size_limits import is_bare, problem, size_and_limits, toleranced

# The table of a machine file: address → text.
TABLE = "tolerances"

Place = tuple[str, ...]


def with_tolerances(tables: dict[str, Any]) -> dict[str, str]:
    """Move tolerances from behind values to their table, key → address; in a formula the text is a sum."""
    given = tables.get(TABLE, {})
    if not isinstance(given, Mapping):
        return {}  # the description says what is wrong
    behind = {join(place): text for place, text in _behind_values(tables, tables, ())}
    for address, text in behind.items():
        parts = size_and_limits(text)
        assert parts is not None
        if address in given:
            key = join((TABLE, address))
            raise problem(key, show(given[address]), f"nothing: {address} has a tolerance")
        if is_bare(text):
            expected = 'a tolerance with its unit, such as "0.2 m ± 0.2 mm"'
            raise problem(address, show(text), expected)
        apply(tables, Override(address, parts[0], ""))
    if behind:
        tables[TABLE] = {**given, **behind}
    return {join((TABLE, address)): address for address in behind}


def _behind_values(tables: Mapping[str, Any], node: Any, place: Place) -> Iterator[tuple[Place, str]]:
    entries: list[tuple[Any, Any]] = []
    if isinstance(node, Mapping):
        entries = list(node.items())
    elif isinstance(node, list):
        entries = list(enumerate(node))
    for key, entry in entries:
        at = (*place, str(key))
        if not isinstance(entry, str):
            yield from _behind_values(tables, entry, at)
        elif (parts := size_and_limits(entry)) is not None:
            mark = mark_of(annotation_at(Machine, at, tables))
            # Classes of ISO 286 are of lengths: behind another size they are no unit.
            is_class = parts[1].isalnum()
            if isinstance(mark, Quantity) and not (is_class and mark.kind.unit != LENGTH.unit):
                yield at, entry


def with_known_tolerances(machine: Machine) -> Machine:
    """The machine with tolerances as they count: without the size, one for each entry.

    Raises `MachineError` for those of no entry, that are none of its quantity, or that it cannot have.
    """
    problems: list[Problem] = []
    known: dict[str, str] = {}
    for address, text in machine.tolerances.items():
        key = join((TABLE, address))
        try:
            place = join(known_place(machine, address))
            if place in known:
                raise problem(key, show(text), f"nothing: {place} has a tolerance")
            _require_possible(machine, key, address, text)
            known[place] = (size_and_limits(text) or ("", text))[1]
        except MachineError as error:
            problems += [Problem(key, wrong.found, wrong.expected, wrong.remedy) for wrong in error.problems]
    if problems:
        raise MachineError(problems)
    return machine.with_entries({TABLE: known}) if known != dict(machine.tolerances) else machine


def _require_possible(machine: Machine, key: str, address: str, text: str) -> None:
    quantity = kind(machine, address)
    if quantity is None:
        raise problem(key, show(text), "the tolerance of a number")
    limits = toleranced(key, get(machine, address), text, quantity)
    require_limits(machine, (address,), key, text, limits, quantity)


def require_limits(
    machine: Machine,
    addresses: Sequence[str],
    key: str,
    given: object,
    limits: tuple[float, float],
    quantity: Kind,
) -> None:
    """Raise `MachineError` for limits that an entry cannot have; `key`, `given`: what has them."""
    for address in addresses:
        wrong, expected = outside(machine, address, np.array(limits))
        if wrong.any():
            ends = " to ".join(worded(end, quantity) for end in limits)
            raise problem(
                key, f"{show(given)}, which is {ends}", f"limits that are each {expected}", "make it narrower"
            )


def tolerance_names(machine: Machine, taken: Collection[str] = ()) -> dict[str, str]:
    """Names → addresses of entries with a tolerance: as many last keys as it takes, none of `taken`."""
    places = {address: known_place(machine, address) for address in machine.tolerances}
    names: dict[str, str] = {}
    for address, place in places.items():
        rest = [other for other in places.values() if other != place]
        others = {_name(other, n) for other in rest for n in range(2, len(other) + 1)}
        lengths = range(min(2, len(place)), len(place) + 1)
        free = (_name(place, n) for n in lengths)
        name = next((name for name in free if name not in others and name not in taken), "")
        names[name or f"{_name(place, len(place))}_{len(names)}"] = address
    return names


def _name(place: Place, n: int) -> str:
    return "".join(letter if letter.isalnum() else "_" for letter in "_".join(place[-n:]))
