"""A table of text, the rows that attributes of results make, and tables and curves as CSV.

Comma-separated values (RFC 4180) are such that a spreadsheet takes them as they are, with the unit of each
column in its head.

A spreadsheet runs a cell that begins with ``=``, ``+``, ``-`` or ``@`` as a formula, and names of a machine
file may begin so: such a text gets an apostrophe in front, by which a spreadsheet knows a text. Numbers are
written as they are and read back exactly.

Source: OWASP, *CSV Injection*.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from io import StringIO
from typing import Any, NamedTuple

from linkwright.kernel.arrays import Floats
from linkwright.kernel.quantities import Label, in_table, shown
from linkwright.kernel.reader.angle_zero import counted_columns
from linkwright.kernel.reader.numbers import NOISE, degrees, measured, number, parted
from linkwright.kernel.reader.out_units import reader, shown_columns
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
    is_whole: bool = False  # whether a terminal shows all rows, however many
    is_drawing: bool = False  # whether it draws with letters, for a terminal: pages have the figure


def row(result: Result, name: str, at: str = "", *, length: str = "") -> Row:
    """Word, symbol, value with its unit (`length` of a length, degrees of an angle), and where it is."""
    mark, value = shown(type(result), name), getattr(result, name)
    usual = (length if mark.unit == "m" else "") or mark.usual
    return mark.word, mark.symbol, measured(value, mark.unit, _scale(result, mark), usual=usual), at


def _scale(result: Result, mark: Label) -> float:
    """Peak absolute value of the quantities of one unit in a table; without a unit, what is declared."""
    if mark.scale:
        return mark.scale
    beside = in_table(type(result), mark.table) if mark.table and mark.unit else ()
    same = (getattr(result, name) for name in beside if shown(type(result), name).unit == mark.unit)
    return max((abs(value) for value in same if value is not None and math.isfinite(value)), default=0.0)


def few(result: Result, names: Iterable[str], before: str = "") -> Iterator[tuple[str, str, str]]:
    """Word, value and unit of what is known of some attributes; `before`: what stands before each word."""
    for name in names:
        mark, value = shown(type(result), name), getattr(result, name)
        if value is not None and math.isfinite(value):
            unit = result.unit_of(name)
            of = _scale(result, mark)
            text = (degrees(value), "") if unit == "rad" else parted(value, unit, None, of, mark.usual)
            yield f"{before}{mark.word}", *text


def rows_of(result: Result, *names: str) -> list[Row]:
    """A row for each attribute."""
    return [row(result, name) for name in names]


def rows_in(
    result: Result,
    table: str,
    beside: Mapping[str, str] | None = None,
    *,
    at: Callable[[float], str] = lambda _: "",
    without: Collection[str] = (),
    length: str = "",
) -> list[Row]:
    """Rows for the attributes of a result that are declared with a table.

    `beside`: what the last column says, by attribute; `at`: makes what it says of other extremes, from the
    angle where they are, an attribute such as `speed_max_angle`; `without`: attributes that this result has
    no use for; `length`: usual unit of lengths.
    """
    names = [name for name in in_table(type(result), table) if name not in without]
    angles = {name: getattr(result, f"{name}_angle", None) for name in names}
    places = {name: at(angle) for name, angle in angles.items() if angle is not None} | dict(beside or {})
    return [row(result, name, places.get(name, ""), length=length) for name in names]


def known_rows(
    result: Result, table: str, *beside: Mapping[str, str], without: Collection[str] = (), **how: Any
) -> list[Row]:
    """`rows_in`, without attributes that are None."""
    unknown = [name for name in in_table(type(result), table) if getattr(result, name) is None]
    return rows_in(result, table, *beside, without=[*unknown, *without], **how)


class NamedPart:
    """A shaft, a disc, a mode of a result: its name, and the numbers of the arrays that have one for it."""

    def __init__(self, result: Result, name: str, *place: int) -> None:
        self.result, self.name, self.place = result, name, place

    def __getattr__(self, attribute: str) -> Any:
        array = getattr(self.result, attribute)
        return array[self.place[: array.ndim]].item()

    def unit_of(self, attribute: str) -> str:
        """SI unit of a number of the part."""
        return self.result.unit_of(attribute)


def parts_of(result: Result, axis: str, *at: int) -> list[NamedPart]:
    """The parts that an attribute names, for `part_table`; `at`: place in arrays that run over more."""
    return [NamedPart(result, name, n, *at) for n, name in enumerate(getattr(result, axis))]


# Of a column of parts: an attribute, with its SI unit in brackets where no result declares it, or what makes
# a text of a part.
Cell = str | Callable[[Any], str]


def part_table(
    name: str, title: str, parts: Iterable[Any], heads: Row, *cells: Cell, digits: int | None = None
) -> Table:
    """A table with one row per part and a column per quantity.

    A number has its declared unit, and is zero if it is rounding beside the largest of its column. A unit in
    braces in a head, such as ``at {rpm}``, stands there for all numbers of the column, unless the reader
    wants another one. A column without head and attribute is empty.
    """
    rows = list(parts)
    columns = [_part_column(rows, digits, *column) for column in zip(heads, cells, strict=True)]
    return Table(
        name, title, tuple(head for head, _ in columns), list(zip(*(c for _, c in columns), strict=True))
    )


_HEAD_UNIT = re.compile(r"\{(.*)\}")


def _part_column(parts: Sequence[Any], digits: int | None, head: str, cell: Cell) -> tuple[str, list[str]]:
    if not cell or callable(cell):
        return head, [cell(part) if callable(cell) else "" for part in parts]
    attribute, _, unit = cell.removesuffix("]").partition(" [")
    values = [getattr(part, attribute) for part in parts]
    if not values or isinstance(values[0], str):
        return head, values
    if not unit and hasattr(parts[0], "unit_of"):
        unit = parts[0].unit_of(attribute)
    scale = max((abs(value) for value in values if value is not None and math.isfinite(value)), default=0.0)
    usual = _HEAD_UNIT.search(head)
    if usual is None:
        return head, [measured(value, unit, scale, digits) for value in values]
    unit, factor = reader().shown(unit, usual[1])
    numbers = [number(None if value is None else value / factor, digits, scale / factor) for value in values]
    return head.replace(usual[0], unit), numbers


# Also in the wide forms of East Asian writing, which some spreadsheets take for the same.
_FORMULA = ("=", "+", "-", "@", "\t", "\r", "＝", "＋", "－", "＠")


def csv_text(heads: Sequence[str], rows: Iterable[Sequence[str | float]]) -> str:
    """A table as CSV: a line for the heads and one for each row; NaN is an empty cell."""
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([_cell(head) for head in heads])
    writer.writerows([_cell(entry) for entry in row] for row in rows)
    return text.getvalue()


def _cell(entry: str | float) -> str | float:
    if isinstance(entry, str):
        return f"'{entry}" if entry.startswith(_FORMULA) else entry
    return "" if entry != entry else entry


def curves_csv(result: Result) -> str:
    """Curves as CSV, heads such as ``speed [rad/s]``, numbers exact, gaps empty; empty without curves."""
    columns = {head(result, name): curve for name, curve in result.curves().items()} | result.columns()
    return columns_csv(columns) if columns else ""


def columns_csv(columns: Mapping[str, Floats]) -> str:
    """Columns as CSV in the units, and from the zero of crank angles, that the reader wants: head with the
    unit → values, (n,).

    Numbers read back exactly; one that is rounding beside the largest of its unit is 0. NaN is an empty cell.
    """
    shown = _known(shown_columns(counted_columns(columns)))
    rows = zip(*(column.tolist() for column in shown.values()), strict=True)
    return csv_text(list(shown), rows)


def _known(columns: Mapping[str, Floats]) -> dict[str, Floats]:
    """Zero for rounding beside the largest value of its unit, or of its column without a unit."""
    import numpy as np

    unit_of = {name: unit if (unit := name.rpartition("[")[2]) != "-]" else name for name in columns}
    sizes: dict[str, float] = {}
    for name, values in columns.items():
        size = np.abs(values[np.isfinite(values)]).max(initial=0.0)
        sizes[unit_of[name]] = max(sizes.get(unit_of[name], 0.0), float(size))
    return {
        name: np.where(np.abs(values) <= NOISE * sizes[unit_of[name]], 0.0, values)
        for name, values in columns.items()
    }


def head(result: Result, name: str) -> str:
    """Head of a column: the curve's name with its unit."""
    return f"{name} [{result.unit_of(name) or '-'}]"
