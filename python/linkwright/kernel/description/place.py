"""Places in a description: addresses as text, and what stands there, in a checked model or in the raw tables.

``bodies."cart1.rod".mass`` is an address; a part with a point in it stands in quotes.

Names that refer to nothing should be reported together with wrong values, so the references of a file are
checked even where its tables could not be turned into models. Both are read through `keys` and `look`.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from functools import cache, lru_cache
from typing import Any

import numpy as np
from pydantic import AliasChoices, BaseModel

from linkwright.kernel.errors import InputError

_PART = re.compile(r"""\s*+(?:"([^"]*+)"\s*+|'([^']*+)'\s*+|([^."'\s][^."']*+))(\.|$)""")
# What TOML calls a bare key; every other key needs quotes.
_BARE = re.compile(r"[A-Za-z0-9_-]+")


@lru_cache(maxsize=1024)
def split(address: str) -> tuple[str, ...]:
    """The parts of an address, without quotes; an `InputError` if the text is none.

    >>> split('bodies."cart1.rod".mass')
    ('bodies', 'cart1.rod', 'mass')
    """
    parts, position, more = [], 0, True
    while more:
        match = _PART.match(address, position)
        if match is None:
            raise InputError(f'"{address}" is not an address: expected keys with points between them')
        parts.append(match[1] or match[2] or (match[3] or "").rstrip())
        position, more = match.end(), match[4] == "."
    return tuple(parts)


def join(parts: Iterable[str]) -> str:
    """The address of keys from the top down, with quotes where a key needs them; the inverse of `split`."""
    return ".".join(part if _BARE.fullmatch(part) else _quoted(part) for part in parts)


def _quoted(part: str) -> str:
    """A part in quotes; no name has both kinds, and a key that has is quoted with one."""
    if '"' in part and "'" in part:
        part = part.replace('"', "'")
    return f"'{part}'" if '"' in part else f'"{part}"'


@cache
def field_names(model: type[BaseModel]) -> dict[str, str]:
    """Key in a file → name of the field; they differ where a key is a word of Python. Shared: read only."""
    return {field.alias or name: name for name, field in model.model_fields.items()}


@cache
def former_keys(model: type[BaseModel]) -> dict[str, str]:
    """Key that older files have → the key that stands for it now. Shared: read only."""
    return {
        str(old): name
        for name, field in model.model_fields.items()
        if isinstance(field.validation_alias, AliasChoices)
        for old in field.validation_alias.choices[1:]
    }


def current_key(node: object, key: str) -> str:
    """The key of a model that a key of an older file means; any other key as it is."""
    kind: Any = type(node)
    return key if _names_of(kind) is None else former_keys(kind).get(key, key)


@cache
def _names_of(kind: type) -> dict[str, str] | None:
    """Names of the fields of a model; None for another type. Whether it is one takes long to find out."""
    return field_names(kind) if issubclass(kind, BaseModel) else None


def keys(node: object) -> Collection[str]:
    """The keys of a table, of a model, or the places of a list; nothing for a value."""
    kind: Any = type(node)
    names = _names_of(kind)
    if names is not None:
        return names.keys()
    if isinstance(node, Mapping):
        return tuple(key for key in node if isinstance(key, str))
    if isinstance(node, list | tuple):
        return tuple(str(place) for place in range(len(node)))
    return ()


def look(node: object, key: str) -> Any:
    """The entry under a key; None if there is none."""
    kind: Any = type(node)
    names = _names_of(kind)
    if names is not None:
        return getattr(node, names.get(key, ""), None)
    if isinstance(node, Mapping):
        return node.get(key)
    if isinstance(node, list | tuple):
        # A list may have very many entries: its places are not written out to look for one.
        place = int(key) if key.isdecimal() and len(key) <= len(str(len(node))) else len(node)
        return node[place] if place < len(node) and str(place) == key else None
    return None


def arrays(node: object, place: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], np.ndarray]]:
    """Arrays over many machines below a node, with their places."""
    if isinstance(node, np.ndarray):
        yield place, node
    for key in keys(node):
        below = look(node, key)
        # Nearly all entries are plain values.
        if type(below) not in _PLAIN:
            yield from arrays(below, (*place, key))


_PLAIN = frozenset((float, int, str, bool, type(None)))
