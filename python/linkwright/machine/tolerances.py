"""Tolerances of the entries of a machine, behind their values or in the table ``tolerances``.

``radius = "0.2 m ± 0.2 mm"`` is the size 0.2 m, which every analysis computes with, and the tolerance
``± 0.2 mm`` of that address, which `linkwright tolerance` takes as a variable.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from typing import Any

from linkwright.kernel.description.place import join
from linkwright.kernel.errors import MachineError, Problem, show
from linkwright.machine.address import get, kind, known_place
from linkwright.machine.machine import Machine
from linkwright.machine.size_limits import size_and_limits, toleranced

# The table of a machine file: address → text.
TABLE = "tolerances"

# Entries that are words, and tables that are not of the machine.
_WORDS, _OTHERS = ("name", "description", "source", "type", "catalogue"), (TABLE, "study", "units")

Place = tuple[str, ...]


def with_tolerances(tables: dict[str, Any]) -> dict[str, Place]:
    """Move tolerances from behind values into their table; keys there → the entries that they come from."""
    given = tables.get(TABLE, {})
    if not isinstance(given, Mapping):
        return {}  # the description says what is wrong
    found = {join(place): (place, *parts) for place, parts in _behind_values(tables, ())}
    for address, (place, size, _) in found.items():
        if address in given:
            key = join((TABLE, address))
            raise MachineError([Problem(key, show(given[address]), f"nothing: {address} has a tolerance")])
        _set(tables, place, size)
    if found:
        tables[TABLE] = {**given, **{address: limits for address, (_, _, limits) in found.items()}}
    return {join((TABLE, address)): place for address, (place, _, _) in found.items()}


def _behind_values(node: Any, place: Place) -> Iterator[tuple[Place, tuple[str, str]]]:
    """Places of values with a tolerance: the size and the tolerance."""
    items: Iterator[tuple[Any, Any]] = iter(())
    if isinstance(node, Mapping):
        items = iter(node.items())
    elif isinstance(node, list):
        items = iter(enumerate(node))
    for key, entry in items:
        if isinstance(entry, str):
            parts = None if key in _WORDS else size_and_limits(entry)
            if parts is not None:
                yield (*place, str(key)), parts
        elif place or key not in _OTHERS:
            yield from _behind_values(entry, (*place, str(key)))


def _set(tables: Any, place: Place, size: str) -> None:
    node = tables
    for key in place[:-1]:
        node = node[int(key)] if isinstance(node, list) else node[key]
    node[int(place[-1]) if isinstance(node, list) else place[-1]] = size


def require_tolerances(machine: Machine) -> None:
    """Raise `MachineError` for tolerances of no entry, or that are none of its quantity."""
    problems: list[Problem] = []
    for address, text in machine.tolerances.items():
        key = join((TABLE, address))
        try:
            known_place(machine, address)
            quantity = kind(machine, address)
            if quantity is None:
                raise MachineError([Problem(key, show(text), "the tolerance of a number")])
            toleranced(key, get(machine, address), text, quantity)
        except MachineError as error:
            problems += [Problem(key, wrong.found, wrong.expected, wrong.remedy) for wrong in error.problems]
    if problems:
        raise MachineError(problems)


def tolerance_names(machine: Machine, taken: Collection[str] = ()) -> dict[str, str]:
    """Names → addresses of entries with a tolerance: the last keys of the address, as many as it takes.

    `taken`: names that none of them may have.
    """
    places = {address: known_place(machine, address) for address in machine.tolerances}
    names: dict[str, str] = {}
    for address, place in places.items():
        others = {
            _name(other, n) for other in places.values() if other != place for n in range(2, len(other) + 1)
        }
        lengths = range(min(2, len(place)), len(place) + 1)
        free = (_name(place, n) for n in lengths)
        name = next((name for name in free if name not in others and name not in taken), "")
        names[name or f"{_name(place, len(place))}_{len(names)}"] = address
    return names


def _name(place: Place, n: int) -> str:
    """The last keys of an address as a name that formulas can take."""
    return "".join(letter if letter.isalnum() else "_" for letter in "_".join(place[-n:]))
