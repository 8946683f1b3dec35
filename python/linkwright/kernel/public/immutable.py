"""Descriptions and results that stay as they are: attributes, tables and arrays that cannot be written to."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from typing import Any, NoReturn, TypeVar

import numpy as np

from linkwright.kernel.errors import FrozenError

K = TypeVar("K")
V = TypeVar("V")


class Table(dict[K, V]):
    """A dictionary that is not changed; ``dict(table)`` is one that may be."""

    __slots__ = ()

    def _refuse(self, *_: Any, **__: Any) -> NoReturn:
        """Refuse the change."""
        raise TypeError("this table is part of an immutable description or result: make a copy")

    __setitem__ = __delitem__ = __ior__ = _refuse
    clear = pop = popitem = setdefault = update = _refuse

    def __reduce__(self) -> tuple[type[Table[K, V]], tuple[dict[K, V]]]:
        """Pickled and copied as a whole."""
        return Table, (dict(self),)


class LazyTable(Mapping[K, V]):
    """A table whose entries are made when they are read, and kept.

    Parameters
    ----------
    makers : dict of str to callable
        What makes each entry.
    """

    __slots__ = ("_made", "_makers")

    def __init__(self, makers: dict[K, Callable[[], V]]) -> None:
        self._makers = makers
        self._made: dict[K, V] = {}

    def __getitem__(self, key: K) -> V:
        if key not in self._made:
            made = self._makers[key]()
            freeze(made)
            self._made[key] = made
        return self._made[key]

    def __iter__(self) -> Iterator[K]:
        return iter(self._makers)

    def __len__(self) -> int:
        return len(self._makers)

    def __repr__(self) -> str:
        return repr(dict(self))

    def __reduce__(self) -> tuple[type[Table[K, V]], tuple[dict[K, V]]]:
        """Pickled and copied as a whole."""
        return Table, (dict(self),)


def held(value: Any) -> Any:
    """A value that a frozen object may hold: a read-only copy of an array, a `Table`, or the value."""
    if type(value) is dict:
        return Table(value)
    if isinstance(value, np.ndarray):
        value = np.array(value)
        value.flags.writeable = False
    return value


def freeze(result: Any) -> None:
    """Make the arrays and tables that a dataclass, a tuple or a dictionary of such holds read-only."""
    if isinstance(result, tuple):
        for member in result:
            if type(member) not in _PLAIN:
                _inside(member)
    elif isinstance(result, dict):
        for member in result.values():
            if type(member) not in _PLAIN:
                _inside(member)
    elif is_dataclass(result) and not isinstance(result, type):
        _fields(result)


def _inside(value: Any) -> Any:
    kind = type(value)
    if isinstance(value, np.ndarray):
        value.flags.writeable = False
    elif kind is dict:
        return Table(
            {key: entry if type(entry) in _PLAIN else _inside(entry) for key, entry in value.items()}
        )
    else:
        freeze(value)
    return value


def _fields(result: Any) -> None:
    names = _names(type(result))
    changed: list[tuple[str, Any]] = []
    for name, value in _entries(result, names):
        kind = type(value)
        if kind in _PLAIN or name not in names:
            continue
        if kind is np.ndarray:
            # By position: by name, or by `flags`, it takes several times as long.
            value.setflags(False)
            continue
        frozen = _inside(value)
        if frozen is not value:
            changed.append((name, frozen))
    for name, frozen in changed:
        object.__setattr__(result, name, frozen)


def _entries(result: Any, names: frozenset[str]) -> Iterable[tuple[str, Any]]:
    """What a dataclass has, by name; one with slots has fields alone."""
    if hasattr(result, "__dict__"):
        known: dict[str, Any] = vars(result)
        return known.items()
    return ((name, getattr(result, name, None)) for name in names)


# Kinds of values that hold nothing.
_PLAIN = frozenset((float, int, str, bool, type(None), np.float64, np.int64, np.bool_))


def _names(kind: type) -> frozenset[str]:
    """Names of the fields of a dataclass; looking them up once takes as long as a small call."""
    if kind not in _known_names:
        _known_names[kind] = frozenset(field.name for field in fields(kind))
        keep(kind)
    return _known_names[kind]


def keep(kind: type) -> None:
    """Let a frozen dataclass refuse a change of its attributes in words that tell what to do."""
    if kind.__dataclass_params__.frozen:  # type: ignore[attr-defined]
        kind.__setattr__ = kind.__delattr__ = _refuse  # type: ignore[assignment, method-assign]


def _refuse(self: Any, name: str, *_: object) -> NoReturn:
    is_field = any(field.name == name and field.init for field in fields(self))
    refuse(self, name, f"dataclasses.replace(…, {name}=value)" if is_field else "")


def refuse(of: object, name: str, copied: str) -> NoReturn:
    """Refuse to change an attribute; `copied`: what makes a changed copy, empty if it has no such entry."""
    remedies = [f"{copied} returns a changed copy"] if copied else []
    remedies.append("lw.replace(machine, {address: value}) returns a changed machine")
    raise FrozenError(
        f"{type(of).__name__}.{name}: descriptions and results do not change; {', '.join(remedies)}"
    )


_known_names: dict[type, frozenset[str]] = {}
