"""Motors of one's own from a file of comma-separated values that a machine file names.

The head names each column, with its unit in brackets: ``type, power_rated [kW], speed_rated [rpm]``; without
a unit the numbers are SI. A column ``torque_breakdown_ratio`` or ``torque_start_ratio`` is over the rated
torque. Lines that begin with ``#`` are comments.
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from linkwright.drive.model.catalogue import CatalogueMotor
from linkwright.drive.model.motor import with_rated_point
from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import MachineFileError, Problem, UnitError, show
from linkwright.kernel.files.named_file import named_file
from linkwright.kernel.files.points import lines_of
from linkwright.kernel.public import public
from linkwright.kernel.units.kinds import INERTIA, POWER, RATIO, SPEED, TORQUE
from linkwright.kernel.units.marks import Quantity, not_negative, positive
from linkwright.kernel.units.reading import parse

_KEY = "drive.motor.file"

# Columns that are entries of a motor, and what is in them.
_ENTRIES: dict[str, Quantity] = {
    "power_rated": positive(POWER),
    "speed_rated": positive(SPEED),
    "torque_rated": positive(TORQUE),
    "inertia": not_negative(INERTIA),
    "speed_synchronous": positive(SPEED),
    "torque_breakdown": positive(TORQUE),
    "speed_breakdown": positive(SPEED),
    "torque_start": positive(TORQUE),
    "torque_pull_up": positive(TORQUE),
    "speed_pull_up": positive(SPEED),
    "resistance_ratio": not_negative(RATIO),
    "speed_no_load": positive(SPEED),
    "torque_stall": positive(TORQUE),
    "torque_max": positive(TORQUE),
    "speed_max": positive(SPEED),
}

# Those that size a motor; the maximum torque of a DC motor alone is an entry of a machine file too.
_SIZING = ("torque_max", "speed_max")

KINDS = ("induction", "dc", "servo")

# Over the rated torque.
_RATIOS = {"torque_breakdown_ratio": "torque_breakdown", "torque_start_ratio": "torque_start"}

# Columns for people.
_WORDS = ("kind", "series", "frame", "poles", "efficiency", "mass", "current_rated", "remark")

# A number with a unit behind it, no power of ten.
_WITH_UNIT = re.compile(r"[-+.,\d]*+(?<=\d)\s*+(?![eE][-+\d])[A-Za-z%°].*")
_HEAD = re.compile(r"\s*+(\w++)\s*+(?:\[([^\]]*+)\])?\s*+")


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
    rows = _Rows(named_file(name, folder, _KEY, allow_outside=allow_outside))
    row = rows.entries(rows.known(wanted))
    kind = rows.kind(str(wanted), row)
    for key, value in row.items():
        if key not in _SIZING or (kind == "dc" and key == "torque_max"):
            motor.setdefault(key, value)
    motor.setdefault("kind", "constant_speed" if kind == "servo" else kind)


@public
def read_motors(path: str | os.PathLike[str]) -> tuple[CatalogueMotor, ...]:
    """Read motors from a CSV file, for sizing.

    Parameters
    ----------
    path : path
        File of comma-separated values: ``type``, ``power_rated`` or ``torque_rated``, ``speed_rated``, and
        what is known besides. ``kind`` is ``induction``, ``dc`` or ``servo``; without it a type with
        ``speed_no_load`` is a DC motor, one with ``torque_max`` a servo motor, others are induction motors.

    Returns
    -------
    tuple of CatalogueMotor
        In the order of the file, in SI.

    Raises
    ------
    MachineFileError
        The file cannot be read, has a wrong head or number, or a type lacks what its kind needs; with its
        line.
    """
    try:
        rows = _Rows(Path(path))
        return tuple(rows.motor(type) for type in rows.types)
    except MachineFileError as error:
        # No machine file names this one.
        problems = [
            replace(problem, key=problem.key.replace(_KEY, "catalogue")) for problem in error.problems
        ]
        raise MachineFileError(problems) from None


class _Rows:
    """The rows of a file by type, with their lines."""

    def __init__(self, path: Path) -> None:
        self.path = path
        lines = lines_of(path, _KEY)
        if not lines:
            raise _wrong(
                path, 1, "an empty file", 'a header such as "type, power_rated [kW], speed_rated [rpm]"'
            )
        self.heads = _heads(path, *lines[0])
        self.types: dict[str, tuple[int, dict[str, str]]] = {}
        for line, row in lines[1:]:
            if len(row) != len(self.heads):
                expected = f"{len(self.heads)} values, one for each column"
                raise _wrong(path, line, show(",".join(row)), expected)
            cells = {head[0]: cell.strip() for head, cell in zip(self.heads, row, strict=True)}
            if cells["type"] in self.types:
                raise _wrong(path, line, show(cells["type"]), "each type once")
            self.types[cells["type"]] = (line, cells)

    def known(self, wanted: object) -> str:
        if isinstance(wanted, str) and wanted in self.types:
            return wanted
        remedy = suggestion(wanted if isinstance(wanted, str) else "", self.types)
        found = None if wanted is None else show(wanted)
        problem = Problem("drive.motor.catalogue", found or "nothing", f"a type of {self.path.name}", remedy)
        raise MachineFileError([problem])

    def entries(self, type: str) -> dict[str, float]:
        line, cells = self.types[type]
        return _entries(self.path, line, self.heads, cells)

    def kind(self, type: str, row: Mapping[str, float]) -> str:
        line, cells = self.types[type]
        given = cells.get("kind", "")
        if given and given not in KINDS:
            raise _wrong(
                self.path, line, show(given), f"a kind of motor: {', '.join(KINDS)}", suggestion(given, KINDS)
            )
        return given or ("dc" if "speed_no_load" in row else "servo" if "torque_max" in row else "induction")

    def motor(self, type: str) -> CatalogueMotor:
        line, cells = self.types[type]
        row = with_rated_point(self.entries(type))
        kind = self.kind(type, row)
        lacking = [name for name in (*_RATED, *_NEEDED[kind]) if name not in row]
        if lacking:
            remedy = f'sizing a motor of the kind "{kind}" needs it'
            raise _wrong(self.path, line, f"{type} without {lacking[0]}", f"a column {lacking[0]}", remedy)
        poles = cells.get("poles", "")
        if poles and not poles.isdecimal():
            raise _wrong(self.path, line, show(poles), "a number of poles")
        known = {name: row[name] for name in row if name in CatalogueMotor.__slots__}
        known.setdefault("speed_synchronous", None)
        words: dict[str, Any] = {
            "series": cells.get("series") or self.path.name,
            "poles": int(poles or 0),
            "kind": kind,
        }
        return CatalogueMotor(type=type, **words, **known)


# What sizing needs of every motor, and of each kind.
_RATED = ("power_rated", "speed_rated", "torque_rated")
_NEEDED = {
    "induction": ("speed_synchronous", "torque_breakdown"),
    "dc": ("speed_no_load",),
    "servo": ("torque_max",),
}


def _heads(path: Path, line: int, row: list[str]) -> list[tuple[str, str]]:
    matches = [_HEAD.fullmatch(cell) for cell in row]
    heads = [(match[1], match[2] or "") for match in matches if match is not None]
    names = [name for name, _ in heads]
    known = ("type", *_ENTRIES, *_RATIOS, *_WORDS)
    if len(heads) < len(row) or "type" not in names:
        expected = 'a header such as "type, power_rated [kW], speed_rated [rpm]"'
        raise _wrong(path, line, show(",".join(row)), expected)
    for name in names:
        if name not in known:
            raise _wrong(path, line, show(name), "a column of motors", suggestion(name, known))
        if names.count(name) > 1:
            raise _wrong(path, line, show(name), "each column once")
    return heads


def _entries(path: Path, line: int, heads: list[tuple[str, str]], cells: dict[str, str]) -> dict[str, float]:
    quantities = {**_ENTRIES, **dict.fromkeys(_RATIOS, positive(RATIO))}
    entries: dict[str, float] = {}
    for name, unit in heads:
        if name not in quantities or not cells[name]:
            continue
        if _WITH_UNIT.fullmatch(cells[name]):
            remedy = (
                f"the unit belongs in the header, [{unit}]"
                if unit
                else "give the unit in the header, in brackets"
            )
            raise _wrong(path, line, show(cells[name]), f"a number in the column {name}", remedy)
        try:
            number = f"{cells[name]} {unit}".strip() if unit else float(cells[name])
            entries[name] = parse(number, quantities[name].kind)
        except ValueError:
            raise _wrong(path, line, show(cells[name]), f"a number in the column {name}") from None
        except UnitError as error:
            problem = replace(error.problem, key=f"{_KEY}, column {name}", path=str(path), line=line)
            raise MachineFileError([problem]) from None
        quantity = quantities[name]
        if not quantity.holds(entries[name]):
            expected = f"in the column {name} {quantity.expected}"
            raise _wrong(path, line, show(cells[name]), expected, quantity.remedy(entries[name]))
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
