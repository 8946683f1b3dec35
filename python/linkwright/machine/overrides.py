"""Overrides: entries given beside the file, ``PATH=VALUE``, that replace its own or add to them."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from pydantic import BaseModel

from linkwright.kernel.description.place import keys, split
from linkwright.kernel.description.schema_walk import key_as_written
from linkwright.kernel.errors import InputError, show
from linkwright.kernel.files.text_file import deep_line
from linkwright.machine.address import resolve
from linkwright.machine.machine import Machine


@dataclass(frozen=True, slots=True)
class Override:
    """One entry given beside the file."""

    address: str
    value: Any
    text: str

    def __str__(self) -> str:
        """As it was given."""
        return f"--set {self.text}"


def parse_all(overrides: Sequence[str | Override] | Mapping[str, Any]) -> list[Override]:
    """Overrides by texts ``PATH=VALUE``, else an `InputError`, or by path → value, taken as they are."""
    if isinstance(overrides, Mapping):
        return [_of(address, value) for address, value in overrides.items()]
    if isinstance(overrides, str):
        return [parse(overrides)]
    return [each if isinstance(each, Override) else parse(each) for each in overrides]


def parse(text: str) -> Override:
    """Read one override.

    `text`: ``PATH=VALUE``. The value is TOML if it can be read so, else a text: ``80 deg`` needs no quotes.
    Raises InputError: the text is no ``PATH=VALUE``.

    >>> parse("drive.gearbox.ratio=10").value
    10
    """
    try:
        text.encode()
    except UnicodeEncodeError:
        shown = show(text.encode("utf-8", "backslashreplace").decode())
        raise InputError(f"--set\n  found:    {shown}\n  expected: UTF-8 text") from None
    address, equals, value = text.partition("=")
    if not equals or not address.strip():
        expected = 'PATH=VALUE, such as mechanism.cranks.A2.phase="80 deg"'
        raise InputError(f"--set {text}\n  found:    {show(text)}\n  expected: {expected}")
    return _of(address.strip(), _value(value.strip()), text)


def apply(tables: dict[str, Any], change: Override, model: type[BaseModel] = Machine) -> tuple[str, ...]:
    """Write one override into the tables of a file.

    `tables`: tables of the file, which `model` describes; changed in place. Returns: keys from the top down
    to what is new: the entry, or the first table that was made for it. Raises InputError: the way to the
    entry leads through something that is no table.
    """
    place = key_as_written(resolve(tables, change.address), tables, model)
    new = place
    node: Any = tables
    for n, key in enumerate(place[:-1], start=1):
        new = place[:n] if new == place and key not in keys(node) else new
        node = _below(node, key, change, place[:n])
    _put(node, place[-1], change, place)
    return new


def _of(address: str, value: Any, text: str = "") -> Override:
    try:
        split(address)
    except InputError as error:
        raise InputError(f"--set {text or address}\n  {error}") from None
    return Override(address, value, text or f"{address}={show(value)}")


def _value(text: str) -> Any:
    if deep_line(f"value = {text}") is not None:
        return text
    try:
        tables = tomllib.loads(f"value = {text}")
    except (ValueError, RecursionError):
        return text
    return tables["value"] if tables.keys() == {"value"} else text


def _below(node: Any, key: str, change: Override, place: tuple[str, ...]) -> Any:
    """The table under a key, made if there is none."""
    below = node.setdefault(key, {}) if isinstance(node, dict) else _entry(node, key, change, place)
    if not isinstance(below, dict | list):
        raise _no_table(change, place, below)
    return below


def _put(node: Any, key: str, change: Override, place: tuple[str, ...]) -> None:
    if isinstance(node, list):
        _entry(node, key, change, place)
        node[int(key)] = change.value
    else:
        node[key] = change.value


def _entry(node: list[Any], key: str, change: Override, place: tuple[str, ...]) -> Any:
    if key.isdecimal() and int(key) < len(node):
        return node[int(key)]
    expected = f"a place in the list, 0 to {len(node) - 1}"
    raise InputError(f"{change}: {'.'.join(place)}\n  found:    {show(key)}\n  expected: {expected}")


def _no_table(change: Override, place: tuple[str, ...], found: object) -> InputError:
    key = ".".join(place)
    return InputError(f"{change}: {key}\n  found:    {show(found)}\n  expected: a table or a list")
