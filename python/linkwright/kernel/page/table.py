"""A table of text, and the rows that attributes of results make."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from typing import NamedTuple

from linkwright.kernel.page.measured import measured
from linkwright.kernel.quantities import Shown, in_table, shown
from linkwright.kernel.result import Result

Row = tuple[str, ...]


class Table(NamedTuple):
    """A table: its name, its title, the heads of its columns, and its rows.

    The first two columns hold words and symbols, all others numbers with their units.
    """

    name: str
    title: str
    heads: Row
    rows: list[Row]


def row(result: Result, name: str, at: str = "") -> Row:
    """Word, symbol, value with its unit (of an angle, degrees), and where it is."""
    mark, value = shown(type(result), name), getattr(result, name)
    return mark.word, mark.symbol, with_unit(value, mark.unit, _scale(result, mark)), at


def with_unit(value: float | None, unit: str, scale: float = 0.0) -> str:
    """A value with its unit; a dash for none, and zero for what is rounding beside a scale."""
    return measured(value, unit, scale)


def _scale(result: Result, mark: Shown) -> float:
    """Peak absolute value of the quantities of one unit in a table; those without a unit have none."""
    beside = in_table(type(result), mark.table) if mark.table and mark.unit else ()
    same = (getattr(result, name) for name in beside if shown(type(result), name).unit == mark.unit)
    return max((abs(value) for value in same if value is not None and math.isfinite(value)), default=0.0)


def rows_of(result: Result, *names: str) -> list[Row]:
    """A row for each attribute."""
    return [row(result, name) for name in names]


def rows_in(
    result: Result, table: str, beside: Mapping[str, str] | None = None, *, without: Collection[str] = ()
) -> list[Row]:
    """The rows of a table by the declarations of a result.

    Parameters
    ----------
    result : Result
        The result.
    table : str
        Name of the table in the declarations.
    beside : mapping of str to str, optional
        What the last column says, by attribute.
    without : collection of str
        Attributes that this result has no use for.

    Returns
    -------
    list of tuple of str
        A row for each attribute that is declared with this table.
    """
    names = (name for name in in_table(type(result), table) if name not in without)
    return [row(result, name, (beside or {}).get(name, "")) for name in names]


def known_rows(
    result: Result, table: str, beside: Mapping[str, str] | None = None, *, without: Collection[str] = ()
) -> list[Row]:
    """`rows_in`, without attributes that are None."""
    unknown = [name for name in in_table(type(result), table) if getattr(result, name) is None]
    return rows_in(result, table, beside, without=[*unknown, *without])
