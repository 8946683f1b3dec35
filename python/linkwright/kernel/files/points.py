"""Columns of files of comma-separated values: points that a machine file names, and measurements.

A table of the machine file with the entry ``file`` gets the columns of that file as lists. The head names
each column, with its unit in brackets: ``angle [deg], lift [mm]``; without a unit the numbers are SI. Lines
that begin with ``#`` are comments.
"""

from __future__ import annotations

import csv
import math
import os
import re
from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from io import StringIO
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.place import join
from linkwright.kernel.errors import MachineFileError, Problem, UnitError, show
from linkwright.kernel.files.cam_tables import controller_table
from linkwright.kernel.files.named_file import named_file
from linkwright.kernel.files.text_file import TextError, text_of
from linkwright.kernel.limits import POINT_BYTES, ROWS
from linkwright.kernel.units.kinds import Kind
from linkwright.kernel.units.reading import NUMBER, parse

# Kinds of tables whose points may be in a file, and a head for each.
_EXAMPLES = {
    "spline": "angle [deg], lift [mm]",
    "table": "angle [deg], lift [mm]",
    "response": "speed [rpm], stress [MPa]",
    "measured": "root_diameter [mm], cut_height [mm], offset [mm]",
    "record": "time [s], speed [rpm]",
    "torque_course": "times [s], torque [N m]",
    "speed_course": "times [s], speed [rpm]",
    "card": "position [in], load [lbf]",
}

# Tables that are of one kind and do not say so.
_KINDS: dict[tuple[str, ...], str] = {("rod_string", "card"): "card"}

# Those that are laws: they may be written by a motion controller.
_LAWS = ("spline", "table")

# Columns that laws do without: a jerk may jump at a point, where it is then no one number.
_UNUSED = ("jerk", "swing_jerk")


# Number and cells of each line of a file.
Lines = list[tuple[int, list[str]]]

_HEAD = re.compile(r"\s*+(\w++)\s*+(?:\[([^\]]*+)\])?\s*+")


@dataclass(frozen=True, slots=True)
class Column:
    """Where the values of a list are from."""

    place: tuple[str, ...]  # keys down to the list
    path: Path  # the file of points
    head: int  # its line with the names of the columns
    lines: tuple[int, ...]  # the line of each value

    def line(self, key: tuple[str, ...]) -> int:
        """The line of an entry that is the list, or one of its values."""
        below = key[len(self.place) :]
        return self.lines[int(below[0])] if below and below[0].isdigit() else self.head


def with_points(tables: dict[str, Any], folder: Path, *, allow_outside: bool = False) -> list[Column]:
    """Put the points of all files that are named into the tables, in place; returns the lists that came from
    files.

    `folder`: that of the machine file, in or below which files lie unless `allow_outside`. Raises
    `MachineFileError` for a file that lies elsewhere, cannot be read or has no points.
    """
    columns: list[Column] = []
    for place, table in _tables(tables, ()):
        kind = _KINDS.get(place) or table.get("kind")
        if kind in list(_EXAMPLES) and isinstance(table.get("file"), str):
            name, key = table.pop("file"), join((*place, "file"))
            path = named_file(name, folder, key, allow_outside=allow_outside)
            heads = table.pop("columns", None) if kind in _LAWS else None
            own = _law_lines(path, key, heads) if kind in _LAWS else None
            lists, lines = columns_of(path, key, kind, lines=own)
            for name in _UNUSED if kind in _LAWS else ():
                lists.pop(name, None)
            table.update(lists)
            columns += [Column((*place, name), path, lines[0], tuple(lines[1:])) for name in lists]
    return columns


def _tables(node: Any, place: tuple[str, ...]) -> Iterator[tuple[tuple[str, ...], dict[str, Any]]]:
    if isinstance(node, dict):
        yield place, node
    entries = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
    for key, below in list(entries):
        yield from _tables(below, (*place, str(key)))


def columns_of(
    path: Path,
    key: str,
    kind: str = "table",
    numbers: Collection[str] | None = None,
    lines: Lines | None = None,
) -> tuple[dict[str, list[Any]], list[int]]:
    """Columns of a file of comma-separated values by name, entries with their units, and the number of each
    line.

    The line of the head is first. `key`, `kind`: entry and table that name it, for messages; `numbers`: names
    of columns that hold numbers, all without it, and others keep their texts; `lines`: those of the file,
    where they are known. Raises
    `MachineFileError` for what cannot be read, has no head or a row that does not fit it.
    """
    lines = lines_of(path, key) if lines is None else lines
    heads = [_HEAD.fullmatch(cell) for cell in lines[0][1]] if lines else []
    if len(lines) == 1 and all(heads):
        found, expected = "no rows below the header", "at least one row, its numbers separated by commas"
        raise MachineFileError([Problem(key, found, expected, path=str(path), line=lines[0][0])])
    if not lines or not all(heads):
        found = show(",".join(lines[0][1])) if lines else "an empty file"
        expected = f'a header such as "{_EXAMPLES[kind]}", and a row for each point, separated by commas'
        remedy = "write a comma between columns, and a point in decimals" if ";" in found else ""
        line = lines[0][0] if lines else 1
        raise MachineFileError([Problem(key, found, expected, remedy, str(path), line)])
    names = [head[1] for head in heads if head is not None]
    twice = next((name for name, n in Counter(names).items() if n > 1), None)
    if twice is not None:
        found, line = show(",".join(lines[0][1])), lines[0][0]
        remedy = f'"{twice}" occurs twice'
        raise MachineFileError([Problem(key, found, "each column once", remedy, str(path), line)])
    wanted = frozenset(names if numbers is None else numbers)
    for line, row in lines[1:]:
        for problem in _row_problems(key, names, row, wanted):
            raise MachineFileError([replace(problem, path=str(path), line=line)])
    columns = {
        head[1]: [
            _with_unit(row[i].strip(), head[2]) if numbers is None or head[1] in numbers else row[i].strip()
            for _, row in lines[1:]
        ]
        for i, head in enumerate(heads)
        if head is not None
    }
    return columns, [line for line, _ in lines]


def _law_lines(path: Path, key: str, heads: object) -> Lines:
    """Lines of a file of a law, perhaps that of a motion controller; `heads`: the entry ``columns``."""
    table = controller_table(_text(path, key))
    if table is None:
        lines = lines_of(path, key)
        return lines if heads is None else [(lines[0][0] if lines else 1, _heads(heads, key)), *lines]
    if table.announced is not None and table.announced != table.present:
        found, expected = f"{table.present} points", f"{table.announced}, as its head says"
        remedy = "the file may be cut off; else correct the number"
        raise MachineFileError([Problem(key, found, expected, remedy, str(path), 1)])
    own = table.heads if heads is None else _heads(heads, key)
    if own is None:
        found = f"a table of a motion controller without units, {len(table.rows)} points"
        remedy = 'beside file, say what its columns are: columns = "angle [deg], lift [mm]"'
        raise MachineFileError([Problem(key, found, "units of its columns", remedy, str(path), 1)])
    return [(1, own), *table.rows]


def _heads(entry: object, key: str) -> list[str]:
    """The heads that the entry ``columns`` names."""
    if not isinstance(entry, str) or not entry.strip():
        place = key.removesuffix("file") + "columns"
        raise MachineFileError([Problem(place, show(entry), f'names of columns: "{_EXAMPLES["table"]}"')])
    return entry.split(",")


def lines_of(path: Path, key: str) -> Lines:
    """Number and cells of each line that is neither empty nor a comment."""
    lines = StringIO(_text(path, key), newline="")
    reader = csv.reader("\n" if line.lstrip().startswith("#") else line for line in lines)
    rows: Lines = []
    try:
        for row in reader:
            if any(cell.strip() for cell in row):
                rows.append((reader.line_num, row))
            if len(rows) > ROWS.most + 1:
                problem = Problem(key, "more rows", ROWS.words, path=str(path), line=reader.line_num)
                raise MachineFileError([problem])
    except csv.Error:
        found, expected = "an unterminated cell", f"cells of at most {csv.field_size_limit()} characters"
        remedy = 'close the quotation mark (")'
        raise MachineFileError([Problem(key, found, expected, remedy, str(path), reader.line_num)]) from None
    return rows


def _text(path: Path, key: str) -> str:
    """The text of a file of points."""
    try:
        return text_of(path, POINT_BYTES)
    except TextError as error:
        expected = error.expected or "a file of comma-separated values"
        # Without an entry that names the file, the file itself is the place.
        found, place = (f"{path}, {error.found}", "") if key else (error.found, str(path))
        raise MachineFileError([Problem(key, found, expected, error.remedy, place)]) from None


def _row_problems(key: str, names: list[str], row: list[str], numbers: Collection[str]) -> Iterator[Problem]:
    if len(row) != len(names):
        yield Problem(key, show(",".join(row)), f"{len(names)} values, one for each column")
    for name, cell in zip(names, row, strict=False):
        if name in numbers and not _is_number(cell):
            found = show(cell.strip()) if cell.strip() else "an empty cell"
            yield Problem(f"{key}, column {name}".removeprefix(", "), found, "a finite number")


def _is_number(cell: str) -> bool:
    return NUMBER.fullmatch(cell.strip()) is not None and math.isfinite(float(cell))


def _with_unit(number: str, unit: str | None) -> Any:
    return f"{number} {unit}" if unit else float(number)


def read_columns(
    path: str | os.PathLike[str],
    kinds: Mapping[str, Kind],
    choices: Mapping[str, Sequence[str]] = MappingProxyType({}),
) -> dict[str, Floats]:
    """Columns of a file, (n,) each [SI], by name and kind; others in it are passed over.

    `choices`: columns by name that hold one of some names, or its place among them, which is what is read.
    Raises `MachineFileError`, with file and line, if it cannot be read, lacks a column, or holds something
    else.
    """
    place = Path(path)
    columns, lines = columns_of(place, "", numbers=kinds)
    missing = [name for name in (*kinds, *choices) if name not in columns]
    if missing:
        wanted = ", ".join([*(f"{name} [{kind.unit}]" for name, kind in kinds.items()), *choices])
        found = f"no column {missing[0]} among {show(', '.join(columns))}"
        remedy = f"begin the file with a header such as: {wanted}"
        raise MachineFileError([Problem("", found, "a column of each name", remedy, str(place), lines[0])])
    read = {name: _values(columns[name], kind, name, place, lines[1:]) for name, kind in kinds.items()}
    return read | {
        name: _places(columns[name], values, name, place, lines[1:]) for name, values in choices.items()
    }


def _places(
    cells: Sequence[str], names: Sequence[str], column: str, path: Path, lines: Sequence[int]
) -> Floats:
    """Places of names in a list; a number that is none of them is a place already."""
    places = []
    for cell, line in zip(cells, lines, strict=True):
        place = place_of(cell, names)
        if place is None:
            found = show(cell) if cell else "an empty cell"
            problem = Problem(f"column {column}", found, one_of(names), "", str(path), line)
            raise MachineFileError([problem])
        places.append(place)
    return np.array(places)


def place_of(cell: str, names: Sequence[str]) -> float | None:
    """The place of a name in a list, from 0, or a place itself; None if it is neither."""
    if cell in names:
        return float(names.index(cell))
    if not _is_number(cell):
        return None
    number = float(cell)
    for nth, name in enumerate(names):
        # A number among the names may be written otherwise: 1.0 for 1.
        if _is_number(name) and float(name) == number:
            return float(nth)
    return number if number.is_integer() and 0 <= number < len(names) else None


def one_of(names: Sequence[str]) -> str:
    """What belongs where one of some names does."""
    return f"one of {', '.join(map(show, names))}, or its place among them, 0 to {len(names) - 1}"


def _values(entries: Sequence[Any], kind: Kind, name: str, path: Path, lines: Sequence[int]) -> Floats:
    values = []
    for entry, line in zip(entries, lines, strict=True):
        try:
            values.append(parse(entry, kind))
        except UnitError as error:
            problem = replace(error.problem, key=f"column {name}", path=str(path), line=line)
            raise MachineFileError([problem]) from None
    return np.array(values)
