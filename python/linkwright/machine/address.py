"""Addresses of entries: read, list and exchange the numbers of a machine by address.

An exchanged number is not checked against the rest of the machine, and it may be an array: that is how a
batch describes many machines at once. A table that is exchanged is checked by itself.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from numbers import Number
from typing import TYPE_CHECKING, Any

import numpy as np
from pydantic import TypeAdapter, ValidationError

from linkwright.kernel.arrays import Bools, Floats
from linkwright.kernel.description.base import Description, suggestion
from linkwright.kernel.description.place import current_key, field_names, join, keys, look, split
from linkwright.kernel.description.problems import problems
from linkwright.kernel.description.schema_walk import annotation_at, mark_of, words_of
from linkwright.kernel.errors import InputError, MachineError, Problem
from linkwright.kernel.public import public
from linkwright.kernel.public.arguments import array, number, shown
from linkwright.kernel.public.immutable import held
from linkwright.kernel.units.kinds import COUNT, Kind
from linkwright.kernel.units.marks import Quantity, QuantityList
from linkwright.kernel.units.reading import is_number

if TYPE_CHECKING:
    from linkwright.machine.machine import Machine


@public
def addresses(machine: Machine) -> dict[str, float]:
    """Addresses of all numbers of a machine.

    Parameters
    ----------
    machine : Machine

    Returns
    -------
    dict of str to float
        Address → value in SI. The values of a list have addresses of their own, ``loads.press.forward.0``.
    """
    listed = {join(place): (place, value) for place, value in _numbers(machine, ()) if place != ("format",)}
    _known_places(machine).update((address, place) for address, (place, _) in listed.items())
    return {address: value for address, (_, value) in listed.items()}


@public
def get(machine: Machine, address: str) -> Any:
    """The entry at an address.

    Parameters
    ----------
    machine : Machine
    address : str
        Such as ``mechanism.cranks.A2.phase``.

    Returns
    -------
    object
        The value in SI, or the part of the description that has this address.

    Raises
    ------
    MachineError
        There is no such entry.
    """
    return entry_of(machine, address)


def entry_of(machine: Machine, address: str) -> Any:
    """The same for whoever has checked what it asks for."""
    return entry_at(machine, known_place(machine, address))


def entry_at(machine: Machine, place: Sequence[str]) -> Any:
    """What stands below some keys."""
    node: Any = machine
    for key in place:
        node = look(node, key)
    return node


def kind(machine: Machine, address: str) -> Kind | None:
    """The quantity that stands at an address. Returns: its kind with unit; None if the entry is no quantity.
    Raises MachineError: there is no such entry.
    """
    place = known_place(machine, address)
    owner = entry_at(machine, place[:-1])
    # A description that has been read is of one class, whatever its table may be.
    if isinstance(owner, Description):
        return _kind_of(type(owner), place[-1])
    mark = mark_of(annotation_at(type(machine), place, machine))
    return mark.kind if mark else None


@cache
def _kind_of(model: type[Description], key: str) -> Kind | None:
    mark = mark_of(annotation_at(model, (key,)))
    return mark.kind if mark else None


@public
def replace(machine: Machine, entries: Mapping[str, Any]) -> Machine:
    """Copy of a machine with some entries replaced, each checked separately.

    Parameters
    ----------
    machine : Machine
        The machine; it stays as it is.
    entries : Mapping
        Address → new value in SI, a number or an array over many machines; or a table, as in a machine file.

    Returns
    -------
    Machine
        The copy. What a motor derives from its given entries is derived anew.

    Raises
    ------
    MachineError
        An address does not exist; the remedy names close ones. A table has no such entries, a value is no
        number where a number belongs, or a number, also one of an array, is out of the range of its entry.
    """
    places = {address: known_place(machine, address) for address in entries}
    return exchanged_at(
        machine, {place: _checked(machine, place, entries[address]) for address, place in places.items()}
    )


def exchanged(machine: Machine, entries: Mapping[str, Any]) -> Machine:
    """Copy of a machine with numbers of any kind at some addresses, unchecked."""
    return exchanged_at(machine, {known_place(machine, address): value for address, value in entries.items()})


def exchanged_at(machine: Machine, entries: Mapping[tuple[str, ...], Any]) -> Machine:
    """The same at known places."""
    tree: dict[str, Any] = {}
    for place, value in entries.items():
        branch = tree
        for key in place[:-1]:
            branch = branch.setdefault(key, {})
        branch[place[-1]] = _Leaf(value)
    changed: Machine = _rebuilt(machine, tree)
    return changed


def is_given(machine: Machine, address: str) -> bool:
    """Whether an entry stands in the file or has its default, and does not follow from others."""
    *above, last = known_place(machine, address)
    owner = entry_at(machine, above)
    if not isinstance(owner, Description):
        return True
    name = field_names(type(owner))[last]
    return name in owner.model_fields_set or getattr(owner, name) == type(owner).model_fields[name].default


def resolve(node: object, address: str) -> tuple[str, ...]:
    """The keys that an address means, where a key with points in it need not stand in quotes.

    `address`: ``bodies.cart1.rod.mass`` finds the key ``cart1.rod``, if there is one. Returns: keys from the
    top down; keys that do not exist are taken as they are written.
    """
    parts = split(address)
    addresses: list[str] = []
    while parts:
        # Keys with points are names, which only tables have.
        known = node if isinstance(node, Mapping) else ()
        n = next((n for n in range(len(parts), 1, -1) if ".".join(parts[:n]) in known), 1)
        key = current_key(node, ".".join(parts[:n]))
        addresses.append(key)
        node, parts = look(node, key), parts[n:]
    return tuple(addresses)


# The machine that was asked for places last, and what they were: derivatives ask for each a dozen times.
_asked: tuple[Machine | None, dict[str, tuple[str, ...]]] = (None, {})


def known_place(machine: Machine, address: str) -> tuple[str, ...]:
    """The keys that an address means; an error if there is no such entry."""
    places = _known_places(machine)
    if address not in places:
        places[address] = _found_place(machine, address)
    return places[address]


def _known_places(machine: Machine) -> dict[str, tuple[str, ...]]:
    global _asked
    asked = _asked
    # Read once: another thread may ask for another machine.
    if asked[0] is not machine:
        _asked = asked = machine, {}
    return asked[1]


def _found_place(machine: Machine, address: str) -> tuple[str, ...]:
    place = resolve(machine, address)
    node: Any = machine
    for nth, key in enumerate(place):
        below = look(node, key)
        if below is None and key not in keys(node):
            # A table that is left out stands in the machine without a value.
            table = join(place[:nth])
            remedy = (
                f"the machine has no table [{table}]; write it first"
                if node is None
                else suggestion(join(place), addresses(machine))
            )
            raise MachineError([Problem(address, "no such entry", "the address of an entry", remedy)])
        node = below
    return place


def _checked(machine: Machine, place: tuple[str, ...], value: Any) -> Any:
    if isinstance(value, Description):
        return value
    address, annotation = join(place), annotation_at(type(machine), place, machine)
    mark, old = mark_of(annotation), entry_at(machine, place)
    holds_number = isinstance(mark, Quantity) or is_number(old)
    if value is not None and holds_number:
        numbers = _numbers_of(address, value, mark.kind if isinstance(mark, Quantity) else COUNT)
        if isinstance(mark, Quantity):
            _require_range(address, numbers, mark)
        return numbers
    if isinstance(value, np.ndarray) and not isinstance(mark, QuantityList):
        raise MachineError([Problem(address, shown(value), words_of(annotation))])
    # What is no number is a table, a list, a word or a choice: each as in a machine file.
    try:
        return TypeAdapter(annotation).validate_python(value)
    except ValidationError as error:
        data: Any = value
        for key in reversed(place):
            data = {key: data}
        raise MachineError(problems(error, type(machine), data, place)) from None


def _require_range(address: str, numbers: Any, mark: Quantity) -> None:
    """Refuse a number out of the range of its entry; a NaN among many is a machine without that number."""
    given = np.atleast_1d(numbers)
    given = given[~np.isnan(given)]
    # A range holds all numbers between two that it holds.
    for end in (float(given.min()), float(given.max())) if len(given) else ():
        if not mark.holds(end):
            raise MachineError([Problem(address, f"{end:g}", mark.expected, mark.remedy(end))])


def _numbers_of(address: str, value: Any, kind: Kind) -> Any:
    """A number of usual size, or numbers over many machines, each of which may have none."""
    is_single = isinstance(value, Number) or (isinstance(value, np.ndarray) and value.ndim == 0)
    try:
        if not is_single:
            many = array(address, value, finite=False)
            real = float(np.abs(many[~np.isnan(many)]).max(initial=0.0))
        else:
            real = number(address, value)
    except InputError:
        expected = f"{kind.word} as a finite number in SI, or an array of numbers"
        raise MachineError([Problem(address, shown(value), expected)]) from None
    if abs(real) > kind.most:
        expected = f"{kind.word} of at most {kind.most:g} {kind.unit}".rstrip()
        raise MachineError([Problem(address, f"{real:g}", expected)])
    if not is_single:
        return many
    # A whole number stays one.
    return value if isinstance(value, int) else real


def outside(machine: Machine, address: str, values: Floats) -> tuple[Bools, str]:
    """Which numbers (n,) an entry cannot have by itself, and the range that it can have."""
    mark = mark_of(annotation_at(type(machine), known_place(machine, address), machine))
    if not isinstance(mark, Quantity) or not len(values):
        return np.zeros(len(values), dtype=bool), ""
    if mark.holds(float(values.min())) and mark.holds(float(values.max())):
        return np.zeros(len(values), dtype=bool), ""
    listed, place = np.unique(values, return_inverse=True)
    holds = np.array([mark.holds(value) for value in listed.tolist()])
    wrong = float(listed[~holds][0])
    return ~holds[place], ", ".join(filter(None, [mark.expected, mark.remedy(wrong)]))


class _Leaf:
    """A new value, which may itself be a dictionary or an array."""

    def __init__(self, value: Any) -> None:
        self.value = value


def _rebuilt(node: Any, tree: dict[str, Any] | _Leaf) -> Any:
    """The node with new values in it; the parts between are copied, the others shared."""
    if isinstance(tree, _Leaf):
        return held(tree.value)
    new = {
        key: _rebuilt(None if isinstance(below, _Leaf) else look(node, key), below)
        for key, below in tree.items()
    }
    if isinstance(node, Description):
        names = field_names(type(node))
        return node.with_entries({names[key]: value for key, value in new.items()})
    if isinstance(node, tuple):
        return tuple(new.get(str(place), value) for place, value in enumerate(node))
    return held({**node, **new})


def _numbers(node: object, place: tuple[str, ...]) -> Iterator[tuple[tuple[str, ...], float]]:
    if is_number(node):
        yield place, node
    for key in keys(node):
        yield from _numbers(look(node, key), (*place, key))
