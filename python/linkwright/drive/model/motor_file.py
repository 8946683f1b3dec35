"""Motors of one's own from a file of comma-separated values that a machine file names.

The head names each column, with its unit in brackets: ``type, power_rated [kW], speed_rated [rpm]``; without
a unit the numbers are SI. A column ``torque_breakdown_ratio`` or ``torque_start_ratio`` is over the rated
torque. Lines that begin with ``#`` are comments.
"""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import MachineFileError, Problem, UnitError, show
from linkwright.kernel.files.points import lines_of, require_below
from linkwright.kernel.units import INERTIA, POWER, RATIO, SPEED, TORQUE, Kind, parse

_KEY = "drive.motor.file"

# Columns that are entries of a motor, and what is in them.
_ENTRIES: dict[str, Kind] = {
    "power_rated": POWER,
    "speed_rated": SPEED,
    "torque_rated": TORQUE,
    "inertia": INERTIA,
    "speed_synchronous": SPEED,
    "torque_breakdown": TORQUE,
    "speed_breakdown": SPEED,
    "torque_start": TORQUE,
    "torque_pull_up": TORQUE,
    "speed_pull_up": SPEED,
    "resistance_ratio": RATIO,
    "speed_no_load": SPEED,
    "torque_stall": TORQUE,
}

# Over the rated torque.
_RATIOS = {"torque_breakdown_ratio": "torque_breakdown", "torque_start_ratio": "torque_start"}

# Columns for people.
_WORDS = ("series", "frame", "poles", "efficiency", "mass", "current_rated", "remark")

_HEAD = re.compile(r"\s*(\w+)\s*(?:\[([^\]]*)\])?\s*")


def with_motor_of_file(tables: dict[str, Any], folder: Path, *, allow_outside: bool = False) -> None:
    """Put the entries of a motor from the file that it names into its table; `tables` is changed in place.

    Entries that the machine file gives go first. Raises MachineFileError: the file lies outside, cannot be
    read, has no such type, or a wrong head or number, with its line.
    """
    drive = tables.get("drive")
    motor = drive.get("motor") if isinstance(drive, dict) else None
    if not isinstance(motor, dict) or not isinstance(motor.get("file"), str):
        return
    name, wanted = motor.pop("file"), motor.pop("catalogue", None)
    path = folder / name
    require_below(path, folder, name, _KEY, allow_outside=allow_outside)
    row = _row(path, wanted)
    for key, value in row.items():
        motor.setdefault(key, value)
    motor.setdefault("kind", "dc" if "speed_no_load" in row else "induction")


def _row(path: Path, wanted: object) -> dict[str, float]:
    """The entries of one type in SI."""
    lines = lines_of(path, _KEY)
    if not lines:
        raise _wrong(path, 1, "an empty file", 'a head such as "type, power_rated [kW], speed_rated [rpm]"')
    heads = _heads(path, *lines[0])
    types: dict[str, tuple[int, dict[str, str]]] = {}
    for line, row in lines[1:]:
        if len(row) != len(heads):
            raise _wrong(path, line, show(",".join(row)), f"{len(heads)} values, one for each column")
        cells = {head[0]: cell.strip() for head, cell in zip(heads, row, strict=True)}
        if cells["type"] in types:
            raise _wrong(path, line, show(cells["type"]), "each type once")
        types[cells["type"]] = (line, cells)
    if not isinstance(wanted, str) or wanted not in types:
        remedy = suggestion(wanted, types) if isinstance(wanted, str) else suggestion("", types)
        expected = f"a type of {path.name}"
        found = None if wanted is None else show(wanted)
        raise MachineFileError([Problem("drive.motor.catalogue", found or "nothing", expected, remedy)])
    line, cells = types[wanted]
    return _entries(path, line, heads, cells)


def _heads(path: Path, line: int, row: list[str]) -> list[tuple[str, str]]:
    """Name and unit of each column."""
    matches = [_HEAD.fullmatch(cell) for cell in row]
    heads = [(match[1], match[2] or "") for match in matches if match is not None]
    names = [name for name, _ in heads]
    known = ("type", *_ENTRIES, *_RATIOS, *_WORDS)
    if len(heads) < len(row) or "type" not in names:
        expected = 'a head such as "type, power_rated [kW], speed_rated [rpm]"'
        raise _wrong(path, line, show(",".join(row)), expected)
    for name in names:
        if name not in known:
            raise _wrong(path, line, show(name), "a column of motors", suggestion(name, known))
        if names.count(name) > 1:
            raise _wrong(path, line, show(name), "each column once")
    return heads


def _entries(path: Path, line: int, heads: list[tuple[str, str]], cells: dict[str, str]) -> dict[str, float]:
    """The numbers of a row in SI; an empty cell is none."""
    kinds = {**_ENTRIES, **dict.fromkeys(_RATIOS, RATIO)}
    entries: dict[str, float] = {}
    for name, unit in heads:
        if name not in kinds or not cells[name]:
            continue
        try:
            number = f"{cells[name]} {unit}".strip() if unit else float(cells[name])
            entries[name] = parse(number, kinds[name])
        except ValueError:
            raise _wrong(path, line, show(cells[name]), f"a number in the column {name}") from None
        except UnitError as error:
            problem = replace(error.problem, key=f"{_KEY}, column {name}", path=str(path), line=line)
            raise MachineFileError([problem]) from None
    rated = entries.get("torque_rated")
    if rated is None and "power_rated" in entries and "speed_rated" in entries:
        rated = entries["power_rated"] / entries["speed_rated"]
    for ratio, entry in _RATIOS.items():
        if ratio in entries:
            if rated is None:
                raise _wrong(path, line, ratio, "the rated torque, or power and speed, beside it")
            entries.setdefault(entry, entries[ratio] * rated)
            del entries[ratio]
    return entries


def _wrong(path: Path, line: int, found: str, expected: str, remedy: str = "") -> MachineFileError:
    return MachineFileError([Problem(_KEY, found, expected, remedy, str(path), line)])
