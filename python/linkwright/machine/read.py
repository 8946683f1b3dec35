"""Read a machine file: TOML in, a checked machine in SI out, or all problems with file, line and key."""

from __future__ import annotations

import os
import re
import tomllib
from collections.abc import Mapping, Sequence
from copy import deepcopy
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeVar, cast

from pydantic import BaseModel

from linkwright.drive.model.motor_file import with_motor_of_file
from linkwright.kernel.description.place import split
from linkwright.kernel.errors import MachineError, MachineFileError, Problem, show
from linkwright.kernel.files.library import library, library_path
from linkwright.kernel.files.lines import key_lines, line_of
from linkwright.kernel.files.points import Column, with_points
from linkwright.kernel.files.text_file import TextError, deep_line, long_number_line, size_problems, text_of
from linkwright.kernel.limits import DEPTH, FILE_BYTES
from linkwright.kernel.public import public
from linkwright.linkages.model.dxf_points import with_dxf_points
from linkwright.machine.machine import FORMAT, Machine
from linkwright.machine.overrides import Override, apply, parse_all
from linkwright.machine.tolerances import with_known_tolerances, with_tolerances
from linkwright.machine.train_machines import of_mounted_file, with_machines_of_train

Model = TypeVar("Model", bound=BaseModel)

Overrides = Sequence[str | Override] | Mapping[str, Any]

# What each override brought in.
Places = Sequence[tuple[tuple[str, ...], Override]]

# What tomllib says of a key or a table that is written twice.
_TWICE = re.compile("Cannot (overwrite a value|declare .* twice)|Duplicate")

_LINE_IN_MESSAGE = re.compile(r" \(at (?:line (\d+), column (\d+)|end of document)\)$")


@public
def read(path: str | os.PathLike[str], overrides: Overrides = (), *, allow_outside: bool = False) -> Machine:
    """Read a machine file.

    Parameters
    ----------
    path : path
        A TOML file, or the name of a machine of the library, such as ``"roller_two_carts"``.
    overrides : sequence of str or Mapping
        Entries that replace or add to those of the file: texts ``PATH=VALUE``, or path → value.
    allow_outside : bool
        Whether an entry `file` may lead out of the folder of the machine file.

    Returns
    -------
    Machine
        Checked, in SI.

    Raises
    ------
    MachineFileError
        The file cannot be read or describes no machine; all problems are listed.
    InputError
        An override is malformed.
    """
    return read_as(Machine, _of_library(Path(path)), overrides, allow_outside=allow_outside)


def text_of_machine(path: Path) -> str:
    """The text of a machine file, or of a machine of the library; a `MachineFileError` if there is none."""
    return _text(_of_library(path), "a machine file")


def _of_library(path: Path) -> Path:
    is_known = _is_bare_name(path) and path.name in library()
    return library_path(path.name) if is_known and not path.exists() else path


def _is_bare_name(path: Path) -> bool:
    return not path.suffix and len(path.parts) == 1


def read_as(
    model: type[Model],
    path: str | os.PathLike[str],
    overrides: Overrides = (),
    *,
    allow_outside: bool = False,
) -> Model:
    """Read a description of some kind, such as the task of a synthesis, from a TOML file; checked, in SI.

    `overrides`, `allow_outside` as for `read`. Raises `MachineFileError` with all problems if the file cannot
    be read or describes no such thing, `InputError` if an override is malformed.
    """
    expected = "a machine file" if model is Machine else "a task file"
    text = _text(Path(path), expected)
    return loads_as(model, text, overrides, path=str(path), allow_outside=allow_outside)


@public
def loads(text: str, overrides: Overrides = (), *, path: str = "", allow_outside: bool = False) -> Machine:
    """Read a machine from a TOML text.

    Parameters
    ----------
    text : str
        What a machine file holds.
    overrides : sequence of str or Mapping
        As for `read`.
    path : str
        Name of the text in messages.
    allow_outside : bool
        Whether an entry `file` may lead out of the folder of the machine file.

    Returns
    -------
    Machine
        Checked, in SI.

    Raises
    ------
    MachineFileError
        The text describes no machine; all problems are listed.
    InputError
        An override is malformed.
    """
    return loads_as(Machine, text, overrides, path=path, allow_outside=allow_outside)


def loads_as(
    model: type[Model],
    text: str,
    overrides: Overrides = (),
    *,
    path: str = "",
    allow_outside: bool = False,
) -> Model:
    """Read a description of some kind from a TOML text.

    `model`: the description; raises `MachineError` with all problems when it is validated; `text`: what such
    a file holds; `path`: name of the text in messages; `allow_outside`: whether an entry `file` may lead out
    of the folder of the machine file. Raises MachineFileError: the text describes no such thing; all problems
    are listed; InputError: an override is malformed.
    """
    tables = tables_of(text, path)
    _check_format(tables, path, text)
    places: list[tuple[tuple[str, ...], Override]] = []
    mounted: dict[str, list[Override]] = {}
    for change in parse_all(overrides):
        if of_mechanism := of_mounted_file(tables, change):
            mounted.setdefault(of_mechanism[0], []).append(of_mechanism[1])
        else:
            places.append((apply(tables, change, model), change))
    if too_large := size_problems(tables):
        raise MachineFileError(_located(too_large, text, path, places, ()))
    given = deepcopy(tables)
    columns: list[Column] = []
    behind: dict[str, str] = {}
    try:
        if model is Machine:
            behind = with_tolerances(tables)
        with_motor_of_file(tables, Path(path).parent, allow_outside=allow_outside)
        if "pumping_unit" in tables:
            from linkwright.pumping.model.unit_file import with_unit_of_file

            with_unit_of_file(tables, Path(path).parent, allow_outside=allow_outside)
        if "axes" in tables:
            from linkwright.axes.model.axis_catalogue import with_servo_motors_of_files

            with_servo_motors_of_files(tables, Path(path).parent, allow_outside=allow_outside)
        if "train" in tables:
            with_machines_of_train(
                tables,
                Path(path).parent,
                lambda file: tables_of(_text(file, "a machine file"), str(file)),
                lambda file, changes: read_as(Machine, file, changes, allow_outside=allow_outside),
                mounted,
                allow_outside=allow_outside,
            )
        if _has_plates(tables):
            from linkwright.outlines.model.section import with_plates

            with_plates(tables, Path(path).parent, allow_outside=allow_outside)
        with_dxf_points(tables, Path(path).parent, allow_outside=allow_outside)
        columns = with_points(tables, Path(path).parent, allow_outside=allow_outside)
        described = model.model_validate(tables)
        if isinstance(described, Machine):
            described = cast("Model", with_known_tolerances(described))
            # As a cached property is kept: beside the fields, by which machines are equal.
            described.__dict__["as_given"] = given
        return described
    except MachineError as error:
        # A tolerance behind a value stands where the value does.
        problems = [replace(problem, key=behind.get(problem.key, problem.key)) for problem in error.problems]
        raise MachineFileError(_located(problems, text, path, places, columns)) from None


def _has_plates(tables: dict[str, Any]) -> bool:
    """Whether a body is cut from a plate, whose drawing is read then alone."""
    bodies = tables.get("bodies")
    entries = bodies.values() if isinstance(bodies, dict) else ()
    return any(isinstance(body, dict) and "plate" in body for body in entries)


def _text(path: Path, expected: str) -> str:
    try:
        text = text_of(path, FILE_BYTES)
    except TextError as error:
        remedy = error.remedy or _similar(path)
        raise _unreadable(path, error.found, remedy, error.expected or expected) from None
    if not text.strip():
        remedy = 'start from a template: "linkwright new --list" names them'
        raise _unreadable(path, "an empty file", remedy if expected == "a machine file" else "", expected)
    return text


def _unreadable(
    path: Path, found: str, remedy: str = "", expected: str = "a machine file"
) -> MachineFileError:
    return MachineFileError([Problem(found=found, expected=expected, remedy=remedy, path=str(path))])


def _similar(path: Path) -> str:
    from linkwright.kernel.description.base import close_match

    try:
        if path.exists():
            return ""
        names = [file.name for file in path.parent.glob("*.toml")]
    except OSError:
        return ""
    return close_match(path.name, [*names, *(library() if _is_bare_name(path) else ())])


def tables_of(text: str, path: str) -> dict[str, Any]:
    """The tables of a TOML text as they stand there; else a `MachineFileError` with the name `path`."""
    if (line := deep_line(text)) is not None:
        found, remedy = "keys or brackets inside one another", "remove what is inside"
        raise MachineFileError([Problem("", found, DEPTH.words, remedy, path, line)])
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise MachineFileError([_syntax(str(error), text, path)]) from None
    except RecursionError:
        problem = Problem("", "keys or brackets inside one another", DEPTH.words, path=path)
        raise MachineFileError([problem]) from None
    except ValueError:
        # A number of more digits than Python reads.
        found, line = "a number of thousands of digits", long_number_line(text)
        raise MachineFileError([Problem("", found, "a number below 9.2e18", "", path, line)]) from None


def _syntax(message: str, text: str, path: str) -> Problem:
    match = _LINE_IN_MESSAGE.search(message)
    words = _LINE_IN_MESSAGE.sub("", message)
    line = int(match[1]) if match and match[1] else text.rstrip().count("\n") + 1
    column = f" (column {match[2]})" if match and match[2] else " (end of the file)"
    lines = text.splitlines()
    found = show(lines[line - 1].strip()) if line <= len(lines) else "the end of the file"
    remedy = "this name or key is there already; give each its own" if _TWICE.search(words) else ""
    return Problem(found=found, expected=f"TOML; {words}{column}", remedy=remedy, path=path, line=line)


def _check_format(tables: dict[str, Any], path: str, text: str) -> None:
    version = tables.get("format", FORMAT)
    if isinstance(version, int) and not isinstance(version, bool) and version == FORMAT:
        return
    line = line_of(key_lines(text), ("format",))
    remedy = "a newer Linkwright may read it" if isinstance(version, int) and version > FORMAT else ""
    expected = f"{FORMAT}, the format that this version reads"
    raise MachineFileError([Problem("format", show(version), expected, remedy, path, line)])


def _located(
    problems: Sequence[Problem], text: str, path: str, places: Places, columns: Sequence[Column]
) -> list[Problem]:
    """The problems in the order of the file, each with its line or with the override that brought it in."""
    lines = key_lines(text)
    in_columns, others = _of_columns(problems, columns)
    # A file of points that is no such file has its place already.
    placed = [other if other.path else _placed(other, lines, path, places) for other in others]
    return [*sorted(placed, key=lambda problem: (problem.line is None, problem.line or 0)), *in_columns]


def _of_columns(
    problems: Sequence[Problem], columns: Sequence[Column]
) -> tuple[list[Problem], list[Problem]]:
    """Problems of lists from files of points, each kind of them once a column; and all others."""
    others: list[Problem] = []
    first: dict[tuple[object, ...], Problem] = {}
    known = {column.place: column for column in columns}
    for problem in problems:
        key = split(problem.key) if problem.key else ()
        column = next((known[key[:n]] for n in range(len(key) + 1) if key[:n] in known), None)
        if column is None:
            others.append(problem)
        else:
            placed = replace(problem, path=str(column.path), line=column.line(key))
            first.setdefault((column.place, problem.expected, problem.remedy), placed)
    return list(first.values()), others


def _placed(
    problem: Problem,
    lines: dict[tuple[str, ...], int],
    path: str,
    places: Places,
) -> Problem:
    key = split(problem.key) if problem.key else ()
    change = next((column for place, column in places if _touches(place, key, lines)), None)
    if change is not None:
        return replace(problem, path=str(change))
    return replace(problem, path=path, line=line_of(lines, key))


def _touches(place: tuple[str, ...], key: tuple[str, ...], lines: dict[tuple[str, ...], int]) -> bool:
    return key[: len(place)] == place or (place[: len(key)] == key and key not in lines)
