"""A table of text, and the rows that attributes of results make."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import NamedTuple

from linkwright.kernel.page.numbers import degrees, number
from linkwright.kernel.quantities import in_table, shown
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
    is_angle = mark.unit == "rad" and value is not None
    return mark.word, mark.symbol, degrees(value) if is_angle else with_unit(value, mark.unit), at


def with_unit(value: float | None, unit: str) -> str:
    """A value with its unit; a dash for none."""
    return "–" if value is None else f"{number(value)} {unit}".rstrip()


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
