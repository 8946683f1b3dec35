"""Look into a description that may be a checked model or the raw tables of a file.

Names that refer to nothing should be reported together with wrong values, so the references of a file are
checked even where its tables could not be turned into models. Both are read through these two functions.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from typing import Any

import numpy as np
from pydantic import BaseModel


@cache
def field_names(model: type[BaseModel]) -> dict[str, str]:
    """Key in a file → name of the field; they differ where a key is a word of Python. Shared: read only."""
    return {field.alias or name: name for name, field in model.model_fields.items()}


def keys(node: object) -> tuple[str, ...]:
    """The keys of a table, of a model, or the places of a list; nothing for a value."""
    if isinstance(node, BaseModel):
        return tuple(field_names(type(node)))
    if isinstance(node, Mapping):
        return tuple(key for key in node if isinstance(key, str))
    if isinstance(node, list | tuple):
        return tuple(str(place) for place in range(len(node)))
    return ()


def look(node: object, key: str) -> Any:
    """The entry under a key; None if there is none."""
    if isinstance(node, BaseModel):
        return getattr(node, field_names(type(node)).get(key, ""), None)
    if isinstance(node, Mapping):
        return node.get(key)
    if isinstance(node, list | tuple):
        return node[int(key)] if key in keys(node) else None
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
