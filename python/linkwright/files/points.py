"""Points from files of comma-separated values that a machine file names.

A table of the machine file with the entry ``file`` gets the columns of that file as lists. The head names
each column, with its unit in brackets: ``angle [deg], lift [mm]``; without a unit the numbers are SI. Lines
that begin with ``#`` are comments.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterator
from dataclasses import replace
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
    lines = _lines(path, key)
    heads = [_HEAD.fullmatch(cell) for cell in lines[0][1]] if lines else []
    if len(lines) < 2 or not all(heads):
        found = show(",".join(lines[0][1])) if lines else "an empty file"
        expected = 'a head such as "angle [deg], lift [mm]", and a row for each point'
        raise MachineFileError(
            [Problem(key, found, expected, path=str(path), line=lines[0][0] if lines else 1)]
        )
    names = [head[1] for head in heads if head is not None]
    for line, row in lines[1:]:
        for problem in _row_problems(key, names, row):
            raise MachineFileError([replace(problem, path=str(path), line=line)])
    return {
        head[1]: [_with_unit(row[i].strip(), head[2]) for _, row in lines[1:]]
        for i, head in enumerate(heads)
        if head is not None
    }


def _lines(path: Path, key: str) -> list[tuple[int, list[str]]]:
    """Number and cells of each line that is neither empty nor a comment."""
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            reader = csv.reader("\n" if line.lstrip().startswith("#") else line for line in file)
            return [(reader.line_num, row) for row in reader if any(cell.strip() for cell in row)]
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "no UTF-8 text"
        found = f"{path}, which cannot be read ({reason})"
        raise MachineFileError([Problem(key, found, "a file of comma-separated values")]) from None


def _row_problems(key: str, names: list[str], row: list[str]) -> Iterator[Problem]:
    """What is wrong with a row of points."""
    if len(row) != len(names):
        yield Problem(key, show(",".join(row)), f"{len(names)} values, one for each column")
    for name, cell in zip(names, row, strict=False):
        if not _is_number(cell):
            found = show(cell.strip()) if cell.strip() else "an empty cell"
            yield Problem(f"{key}, column {name}", found, "a finite number")


def _is_number(cell: str) -> bool:
    try:
        return math.isfinite(float(cell))
    except ValueError:
        return False


def _with_unit(number: str, unit: str | None) -> Any:
    """An entry as it would stand in the machine file."""
    return f"{number} {unit}" if unit else float(number)
