"""Tables of synthesis: what was found of one linkage, and the catalogue of straight-line linkages."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from linkwright.kernel.page.table import Row, Table
from linkwright.kernel.quantities import Label, declared
from linkwright.kernel.reader.numbers import degrees, measured, number
from linkwright.kernel.units.reading import is_number

if TYPE_CHECKING:
    from linkwright.kernel.result import Result
    from linkwright.synthesis.straight_line import StraightLine


def linkage_table(result: Result, entries: dict[str, Any]) -> Table:
    """A row for each entry of a result, by name; lengths that are rounding beside the linkage are zero."""
    marks = declared(type(result))
    lengths = [entries[name] for name in entries if result.unit_of(name) == "m" and entries[name] is not None]
    size = max(map(abs, lengths), default=0.0)
    rows: list[Row] = []
    for name, value in entries.items():
        _, mark = marks.get(name, (None, None))
        if value is None or value == ():
            continue
        if isinstance(mark, Label) and is_number(value):
            # Ratios that are rounding beside 1 are zero, too.
            scale = {"m": size, "": 1.0}.get(mark.unit, 0.0)
            rows.append((mark.word, mark.symbol, measured(value, mark.unit, scale, 6)))
        else:
            word = mark.word if isinstance(mark, Label) else name.replace("_", " ")
            rows.append((word, "", _words(value)))
    return Table("linkage", "Linkage", ("quantity", "", "value"), rows)


def _words(value: Any) -> str:
    if isinstance(value, tuple | list):
        return ", ".join(map(str, value))
    if isinstance(value, bool):
        return "yes" if value else "no"
    return number(value) if isinstance(value, float) else str(value)


def catalogue_table(lines: Sequence[StraightLine]) -> Table:
    """The straight-line linkages with what their lines are like."""
    heads = ("kind", "", "exact", "links", "deviation", "crank range", "longest link", "rotates")
    rows: list[Row] = [
        (
            line.kind,
            "",
            _words(line.exact),
            str(line.links),
            measured(line.deviation, "m", line.length, 3),
            f"{degrees(line.crank_angle_start)} to {degrees(line.crank_angle_end)}",
            measured(line.size, "m", 0.0, 3),
            _words(line.turns_fully),
        )
        for line in lines
    ]
    return Table("straight_lines", "Straight-line linkages", heads, rows, is_whole=True)
