"""Descriptions and results that stay as they are: tables that cannot be written to, and arrays likewise."""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from typing import Any, NoReturn, TypeVar

import numpy as np

K = TypeVar("K")
V = TypeVar("V")


class Table(dict[K, V]):
    """A dictionary that is not changed; ``dict(table)`` is one that may be."""

    __slots__ = ()

    def _refuse(self, *_: Any, **__: Any) -> NoReturn:
        """Refuse the change."""
        raise TypeError("this table is part of a description or a result, which do not change: make a copy")

    __setitem__ = __delitem__ = __ior__ = _refuse
    clear = pop = popitem = setdefault = update = _refuse

    def __reduce__(self) -> tuple[type[Table[K, V]], tuple[dict[K, V]]]:
        """Pickled and copied as a whole."""
        return Table, (dict(self),)


def held(value: Any) -> Any:
    """A value that a frozen object may hold.

    Parameters
    ----------
    value : object
        An array is copied, so that whoever gave it may go on writing to it.

    Returns
    -------
    object
        A read-only array, a `Table`, or the value.
    """
    if type(value) is dict:
        return Table(value)
    if isinstance(value, np.ndarray):
        value = np.array(value)
        value.flags.writeable = False
    return value


def freeze(result: Any) -> None:
    """Make the arrays and tables that a result holds read-only.

    Parameters
    ----------
    result : object
        A dataclass, or a tuple or dictionary of such; anything else is left alone.
    """
    if isinstance(result, tuple):
        for each in result:
            _inside(each)
    elif isinstance(result, dict):
        for each in result.values():
            _inside(each)
    elif is_dataclass(result) and not isinstance(result, type):
        _fields(result)


def _inside(value: Any) -> Any:
    """The value with what it holds read-only."""
    if isinstance(value, np.ndarray):
        value.flags.writeable = False
    elif type(value) is dict:
        return Table({key: _inside(each) for key, each in value.items()})
    else:
        freeze(value)
    return value


def _fields(result: Any) -> None:
    """The fields of a frozen dataclass, once."""
    for field in fields(result):
        value = getattr(result, field.name, None)
        frozen = _inside(value)
        if frozen is not value:
            object.__setattr__(result, field.name, frozen)
