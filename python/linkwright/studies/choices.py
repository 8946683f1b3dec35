"""Names of the values of a list, by which people tell them apart."""

from __future__ import annotations

from collections.abc import Mapping, Sequence


def choice_names(values: Sequence[object]) -> tuple[str, ...]:
    """A name of each value: of tables a text that only one of them has, such as a type, or all of it."""
    tables = [value for value in values if isinstance(value, Mapping)]
    if len(tables) == len(values) > 1:
        for key in tables[0]:
            texts = {text for table in tables if isinstance(text := table.get(key), str)}
            if len(texts) == len(tables):
                return tuple(table[key] for table in tables)
        own = [_own_text(table, tables) for table in tables]
        if all(own):
            return tuple(own)
    return tuple(map(_written, values))


def _own_text(table: Mapping[str, object], tables: Sequence[Mapping[str, object]]) -> str:
    others = [text for other in tables if other is not table for text in other.values()]
    return next((text for text in table.values() if isinstance(text, str) and text not in others), "")


def _written(value: object) -> str:
    if isinstance(value, Mapping):
        return ", ".join(f"{key} = {_written(entry)}" for key, entry in value.items())
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_written, value))}]"
    return str(value).lower() if isinstance(value, bool) else str(value)
