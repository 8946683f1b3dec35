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
from dataclasses import dataclass, replace
from io import StringIO
from pathlib import Path
from typing import Any

from linkwright.kernel.description.text import join
from linkwright.kernel.errors import MachineFileError, Problem
from linkwright.kernel.files.text_file import TextError, text_of
from linkwright.kernel.limits import POINT_BYTES, ROWS
from linkwright.kernel.units import NUMBER, show

# Kinds of tables whose points may be in a file, and a head for each.
_EXAMPLES = {
    "spline": "angle [deg], lift [mm]",
    "table": "angle [deg], lift [mm]",
    "response": "speed [rpm], stress [MPa]",
    "measured": "root_diameter [mm], cut_height [mm], offset [mm]",
}


_HEAD = re.compile(r"\s*(\w+)\s*(?:\[([^\]]*)\])?\s*")


@dataclass(frozen=True, slots=True)
class Column:
    """Where the values of a list are from.

    Attributes
    ----------
    place : tuple of str
        Keys down to the list.
    path : Path
        The file of points.
    head : int
        Its line with the names of the columns.
    lines : tuple of int
        The line of each value.
    """

    place: tuple[str, ...]
    path: Path
    head: int
    lines: tuple[int, ...]

    def holds(self, key: tuple[str, ...]) -> bool:
        """Whether an entry is the list, or one of its values."""
        return key[: len(self.place)] == self.place

    def line(self, key: tuple[str, ...]) -> int:
        """The line of an entry that it holds."""
        below = key[len(self.place) :]
        return self.lines[int(below[0])] if below and below[0].isdigit() else self.head


def with_points(tables: dict[str, Any], folder: Path, *, allow_outside: bool = False) -> list[Column]:
    """Put the points of all files that are named into the tables.

    Parameters
    ----------
    tables : dict
        Tables of a machine file; changed in place.
    folder : Path
        Where the machine file is.
    allow_outside : bool
        Whether a file may lie elsewhere than in this folder, or in one below it.

    Returns
    -------
    list of Column
        All lists that came from a file.

    Raises
    ------
    MachineFileError
        A file lies outside or cannot be read, which is a problem of the machine file; or it has no points.
    """
    columns: list[Column] = []
    for place, table in _tables(tables, ()):
        if table.get("kind") in list(_EXAMPLES) and isinstance(table.get("file"), str):
            name, key = table.pop("file"), join((*place, "file"))
            path = folder / name
            require_below(path, folder, name, key, allow_outside=allow_outside)
            lists, lines = columns_of(path, key, table["kind"])
            table.update(lists)
            columns += [Column((*place, name), path, lines[0], tuple(lines[1:])) for name in lists]
    return columns


def require_below(path: Path, folder: Path, name: str, key: str, *, allow_outside: bool) -> None:
    """Raise MachineFileError for a file that an entry names and that lies outside of a folder."""
    if not (allow_outside or _is_below(path, folder)):
        raise MachineFileError([_outside(name, key)])


def _is_below(path: Path, folder: Path) -> bool:
    """Whether a file lies in a folder or below it, links followed."""
    try:
        return path.resolve().is_relative_to(folder.resolve())
    except (OSError, ValueError, RuntimeError):
        # A name that no file has, or links in a circle: reading it tells what is wrong.
        return True


def _outside(name: str, key: str) -> Problem:
    """A machine file from somebody else shall not read whatever it likes."""
    expected = "a file in the folder of the machine file, or below it"
    remedy = "move it there, or allow it: --allow-outside, or allow_outside=True in Python"
    return Problem(key, show(name), expected, remedy)


def _tables(node: Any, place: tuple[str, ...]) -> Iterator[tuple[tuple[str, ...], dict[str, Any]]]:
    """All tables of a file with their keys."""
    if isinstance(node, dict):
        yield place, node
    entries = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
    for key, below in list(entries):
        yield from _tables(below, (*place, str(key)))


def columns_of(path: Path, key: str, kind: str = "table") -> tuple[dict[str, list[Any]], list[int]]:
    """The columns of a file of comma-separated values.

    Parameters
    ----------
    path : Path
        The file.
    key : str
        Entry that names it, for messages; empty if none does.
    kind : str
        Of the table that names it, for the example of a head.

    Returns
    -------
    columns : dict
        By name, each entry with its unit, as it would stand in a machine file.
    lines : list of int
        Number of each line, head first.

    Raises
    ------
    MachineFileError
        The file cannot be read, has no head or a row that does not fit it.
    """
    lines = lines_of(path, key)
    heads = [_HEAD.fullmatch(cell) for cell in lines[0][1]] if lines else []
    if len(lines) < 2 or not all(heads):
        found = show(",".join(lines[0][1])) if lines else "an empty file"
        expected = f'a head such as "{_EXAMPLES[kind]}", and a row for each point, separated by commas'
        raise MachineFileError(
            [Problem(key, found, expected, path=str(path), line=lines[0][0] if lines else 1)]
        )
    names = [head[1] for head in heads if head is not None]
    twice = next((name for i, name in enumerate(names) if name in names[:i]), None)
    if twice is not None:
        found, line = show(",".join(lines[0][1])), lines[0][0]
        remedy = f'"{twice}" stands there twice'
        raise MachineFileError([Problem(key, found, "each column once", remedy, str(path), line)])
    for line, row in lines[1:]:
        for problem in _row_problems(key, names, row):
            raise MachineFileError([replace(problem, path=str(path), line=line)])
    columns = {
        head[1]: [_with_unit(row[i].strip(), head[2]) for _, row in lines[1:]]
        for i, head in enumerate(heads)
        if head is not None
    }
    return columns, [line for line, _ in lines]


def lines_of(path: Path, key: str) -> list[tuple[int, list[str]]]:
    """Number and cells of each line that is neither empty nor a comment."""
    try:
        text = text_of(path, POINT_BYTES)
    except TextError as error:
        found, expected = f"{path}, {error.found}", error.expected or "a file of comma-separated values"
        raise MachineFileError([Problem(key, found, expected, error.remedy)]) from None
    lines = StringIO(text, newline="")
    reader = csv.reader("\n" if line.lstrip().startswith("#") else line for line in lines)
    rows: list[tuple[int, list[str]]] = []
    try:
        for row in reader:
            if any(cell.strip() for cell in row):
                rows.append((reader.line_num, row))
            if len(rows) > ROWS.most + 1:
                problem = Problem(key, "more rows", ROWS.words, path=str(path), line=reader.line_num)
                raise MachineFileError([problem])
    except csv.Error:
        found, expected = "a cell that does not end", f"cells of at most {csv.field_size_limit()} characters"
        remedy = 'close the quotation mark (")'
        raise MachineFileError([Problem(key, found, expected, remedy, str(path), reader.line_num)]) from None
    return rows


def _row_problems(key: str, names: list[str], row: list[str]) -> Iterator[Problem]:
    """What is wrong with a row of points."""
    if len(row) != len(names):
        yield Problem(key, show(",".join(row)), f"{len(names)} values, one for each column")
    for name, cell in zip(names, row, strict=False):
        if not _is_number(cell):
            found = show(cell.strip()) if cell.strip() else "an empty cell"
            yield Problem(f"{key}, column {name}".removeprefix(", "), found, "a finite number")


def _is_number(cell: str) -> bool:
    return NUMBER.fullmatch(cell.strip()) is not None and math.isfinite(float(cell))


def _with_unit(number: str, unit: str | None) -> Any:
    """An entry as it would stand in the machine file."""
    return f"{number} {unit}" if unit else float(number)
