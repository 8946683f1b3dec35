"""Tables of studies."""

from __future__ import annotations

from linkwright.kernel.page.numbers import number
from linkwright.kernel.page.table import Row, Table
from linkwright.studies.sweep import Sweep

# Reasons of failed rows in a table.
_REASONS = 8


def sweep_tables(found: Sweep, units: dict[str, str]) -> list[Table]:
    """Extremes of the responses, and why rows have no answer."""
    rows: list[Row] = [
        (
            name,
            "",
            with_unit(each["min"], units[name]),
            str(each["min_row"]),
            with_unit(each["max"], units[name]),
            str(each["max_row"]),
        )
        for name, each in found.extremes.items()
    ]
    heads = ("response", "", "minimum", "in row", "maximum", "in row")
    tables = [Table("sweep", "Responses", heads, rows)] if rows else []
    if found.reasons:
        listed: list[Row] = [(text, "", str(count)) for text, count in list(found.reasons.items())[:_REASONS]]
        if len(found.reasons) > _REASONS:
            rest = sum(list(found.reasons.values())[_REASONS:])
            listed.append((f"{len(found.reasons) - _REASONS} further reasons", "", str(rest)))
        tables.append(Table("failed", "Rows without an answer", ("reason", "", "rows"), listed))
    return tables


def with_unit(value: float, unit: str) -> str:
    """A value with its unit; an angle in degrees."""
    if unit == "rad":
        return f"{number(value * 57.29577951308232)}°"
    return f"{number(value)} {unit}".rstrip()
