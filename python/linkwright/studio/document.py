"""The text of a machine file and changes to it: comments, order and units stay as they were written."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Iterator, Mapping
from typing import Any

import tomlkit
from tomlkit.exceptions import TOMLKitError
from tomlkit.items import InlineTable, Item, Table

from linkwright.kernel.description.place import join
from linkwright.kernel.description.schema_walk import annotation_at, mark_of
from linkwright.kernel.errors import InputError
from linkwright.kernel.units.marks import Quantity
from linkwright.kernel.units.reading import is_number, to_text
from linkwright.kernel.units.spellings import factor_of
from linkwright.linkages.model.topology import Topology
from linkwright.machine.address import resolve
from linkwright.machine.machine import Machine
from linkwright.machine.read import loads
from linkwright.machine.size_limits import size_and_limits

# A number and what stands behind it.
_WRITTEN = re.compile(r"\s*+[+-]?(?:\d++(?:\.\d*+)?|\.\d++)(?:[eE][+-]?\d++)?\s*+(.*)", re.DOTALL)

# Digits of a number that a slider or a drag gives: far below any tolerance, and short to read.
_DIGITS = 7


def changed(text: str, entries: Mapping[str, Any]) -> str:
    """A text of sound TOML with entries exchanged, added or, with None, removed.

    `entries`: address → SI number, written in the unit that stands there; or text, table or None. Raises
    `InputError` if the text is no TOML, or an address leads nowhere.
    """
    raw = tables_of(text)
    try:
        document = tomlkit.parse(text)
    except (TOMLKitError, ValueError, RecursionError) as error:
        raise InputError(f"the file is not valid TOML: {error}") from None
    for address, value in entries.items():
        place = resolve(raw, address)
        if value is None:
            _remove(document, place)
        else:
            _put(document, place, written(raw, place, value))
    return tomlkit.dumps(document)


def tables_of(text: str) -> dict[str, Any]:
    """The tables of a file; an `InputError` if it is no TOML."""
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise InputError(f"the file is no TOML: {error}") from None


def written(raw: Mapping[str, Any], place: tuple[str, ...], value: Any) -> Any:
    """A new value at a place of the file, a number in the unit, and with the tolerance, of the old one."""
    if not is_number(value):
        return value
    mark = mark_of(annotation_at(Machine, place, raw))
    if not isinstance(mark, Quantity):
        return value
    old, tolerance = _at(raw, place), ""
    if isinstance(old, str) and (parts := size_and_limits(old)) is not None:
        old, tolerance = parts
    if isinstance(old, str) and (match := _WRITTEN.fullmatch(old)):
        known = factor_of(match[1].strip())
        if known is not None:
            return " ".join(filter(None, (short(value / known[0]), match[1].strip(), tolerance)))
    if isinstance(old, int | float) or not mark.kind.unit:
        return float(short(value))
    return to_text(float(short(value)), mark.kind)


def rounded(raw: Mapping[str, Any], address: str, value: float, worth: float, start: float) -> float:
    """A value with as many digits in the unit of the file as a pixel is worth, rounded towards `start`."""
    place = resolve(raw, address)
    mark, old = mark_of(annotation_at(Machine, place, raw)), _at(raw, place)
    size = (size_and_limits(old) or (old,))[0] if isinstance(old, str) else old
    match = _WRITTEN.fullmatch(size) if isinstance(size, str) else None
    known = factor_of(match[1].strip()) if match and isinstance(mark, Quantity) else None
    factor = known[0] if known else 1.0
    step = 10.0 ** math.floor(math.log10(worth / factor))
    steps = value / factor / step
    # Beyond the value the linkage may not close: at most as far as the pointer has gone.
    rounded_steps = math.floor(steps) if value > start else math.ceil(steps)
    return float(f"{rounded_steps * step:.12g}") * factor


def short(value: float) -> str:
    """A finite number with as many digits as a file needs."""
    return f"{value:.{_DIGITS}g}"


def merged(text: str, joint: str, other: str, path: str = "") -> str:
    """A sound machine file in which what hangs on a joint hangs on another; the element of the first goes.

    Raises a `LinkwrightError` that says why, if the machine cannot be so.
    """
    raw = tables_of(text)
    topology = Topology.of(raw.get("mechanism", {}))
    element = next((one for one in topology.elements if one.name == joint), None)
    if element is None or other not in topology.candidates("point") or joint == other:
        raise InputError(f"{joint} and {other}: expected two joints")
    gone = [("mechanism", element.kind.table, joint)]
    for bar in topology.elements:
        # A bar between the two has no length any more.
        if bar.kind.table == "bars" and set(bar.references.values()) <= {joint, other}:
            gone.append(("mechanism", "bars", bar.name))
    entries: dict[str, Any] = {
        join(place): other
        for table in ("mechanism", "bodies", "loads")
        for place in _naming(raw.get(table), joint, (table,))
        if place[:3] not in gone
    }
    if "on" not in raw.get("bodies", {}).get(joint, {"on": joint}):
        entries[join(("bodies", joint, "on"))] = other
    new = changed(text, entries | dict.fromkeys(map(join, gone)))
    loads(new, path=path)
    return new


def _naming(node: Any, name: str, place: tuple[str, ...]) -> Iterator[tuple[str, ...]]:
    if isinstance(node, Mapping):
        for key, value in node.items():
            yield from _naming(value, name, (*place, key))
    elif node == name and place[-1] not in ("kind", "assembly", "law"):
        yield place


def _at(raw: Any, place: tuple[str, ...]) -> Any:
    """What the file has at a place; None if nothing."""
    for key in place:
        if isinstance(raw, list):
            raw = raw[int(key)] if key.isdecimal() and int(key) < len(raw) else None
        else:
            raw = raw.get(key) if isinstance(raw, Mapping) else None
    return raw


def _below(node: Any, key: str) -> Any:
    """What stands under a key of a table or a list of the document."""
    if isinstance(node, list):
        if not key.isdecimal() or int(key) >= len(node):
            raise InputError(f"{key}: no such place in the list")
        return node[int(key)]
    if not isinstance(node, dict):
        raise InputError(f"{key}: expected a table")
    if key not in node:
        node[key] = tomlkit.inline_table() if isinstance(node, InlineTable) else tomlkit.table()
    return node[key]


def _put(document: Any, place: tuple[str, ...], value: Any) -> None:
    node = document
    for key in place[:-1]:
        node = _below(node, key)
    key = place[-1]
    item = tomlkit.item(value)
    if isinstance(node, list):
        if not key.isdecimal() or int(key) >= len(node):
            raise InputError(f"{key}: no such place in the list")
        node[int(key)] = item
        return
    if not isinstance(node, dict):
        raise InputError(f"{'.'.join(place)}: expected a table above it")
    if isinstance(node, Table) and key in node and isinstance(node[key], Item):
        item.trivia.comment_ws = node[key].trivia.comment_ws
        item.trivia.comment = node[key].trivia.comment
        item.trivia.trail = node[key].trivia.trail
    node[key] = item


def _remove(document: Any, place: tuple[str, ...]) -> None:
    node = document
    for key in place[:-1]:
        if isinstance(node, list) and key.isdecimal() and int(key) < len(node):
            node = node[int(key)]
        elif isinstance(node, dict) and key in node:
            node = node[key]
        else:
            return
    if isinstance(node, dict) and place[-1] in node:
        del node[place[-1]]
    elif isinstance(node, list) and place[-1].isdecimal() and int(place[-1]) < len(node):
        del node[int(place[-1])]
