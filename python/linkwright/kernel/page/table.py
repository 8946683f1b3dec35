"""A table of text, and the rows that attributes of results make."""

from __future__ import annotations

from typing import NamedTuple

from linkwright.kernel.page.quantities import SHOWN, number
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
    """Word, symbol, value, unit, and where it is."""
    shown = SHOWN[name]
    return shown.word, shown.symbol, with_unit(getattr(result, name), shown.unit), at


def with_unit(value: float | None, unit: str) -> str:
    """A value with its unit; a dash for none."""
    return "–" if value is None else f"{number(value)} {unit}".rstrip()


def rows_of(result: Result, *names: str) -> list[Row]:
    """A row for each attribute."""
    return [row(result, name) for name in names]
