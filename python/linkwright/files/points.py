"""Points from files of comma-separated values that a machine file names.

A table of the machine file with the entry ``file`` gets the columns of that file as lists. The head names
each column, with its unit in brackets: ``angle [deg], lift [mm]``; without a unit the numbers are SI.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from linkwright.errors import MachineFileError, Problem
from linkwright.units import show

# Kinds of tables whose points may be in a file.
_KINDS = ("spline", "table")

_HEAD = re.compile(r"\s*(\w+)\s*(?:\[([^\]]*)\])?\s*")


def with_points(tables: dict[str, Any], folder: Path) -> None:
    """Put the points of all files that are named into the tables.

    Parameters
    ----------
    tables : dict
        Tables of a machine file; changed in place.
    folder : Path
        Where the machine file is.

    Raises
    ------
    MachineFileError
        A file cannot be read or has no points.
    """
    for place, table in _tables(tables, ()):
        if table.get("kind") in _KINDS and isinstance(table.get("file"), str):
            path = folder / table.pop("file")
            table.update(_columns(path, ".".join((*place, "file"))))


def _tables(node: Any, place: tuple[str, ...]) -> Iterator[tuple[tuple[str, ...], dict[str, Any]]]:
    """All tables of a file with their keys."""
    if isinstance(node, dict):
        yield place, node
    entries = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
    for key, below in list(entries):
        yield from _tables(below, (*place, str(key)))


def _columns(path: Path, key: str) -> dict[str, list[str]]:
    """The columns of a file by name, each entry with its unit."""
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            rows = [row for row in csv.reader(file) if any(cell.strip() for cell in row)]
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "no UTF-8 text"
        found = f"{path}, which cannot be read ({reason})"
        raise MachineFileError([Problem(key, found, "a file of comma-separated values")]) from None
    heads = [_HEAD.fullmatch(cell) for cell in rows[0]] if rows else []
    if len(rows) < 2 or not all(heads):
        found = show(",".join(rows[0])) if rows else "an empty file"
        expected = 'a head such as "angle [deg], lift [mm]", and a row for each point'
        raise MachineFileError([Problem(key, found, expected, path=str(path), line=1)])
    for line, row in enumerate(rows, start=1):
        if len(row) != len(heads):
            expected = f"{len(heads)} values, one for each column"
            raise MachineFileError([Problem(key, show(",".join(row)), expected, path=str(path), line=line)])
    return {
        head[1]: [_with_unit(row[i].strip(), head[2]) for row in rows[1:]]
        for i, head in enumerate(heads)
        if head is not None
    }


def _with_unit(number: str, unit: str | None) -> Any:
    """An entry as it would stand in the machine file."""
    if unit:
        return f"{number} {unit}"
    try:
        return float(number)
    except ValueError:
        return number
