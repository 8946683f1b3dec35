"""Motors of one's own from a file of comma-separated values that a machine file names.

The head names each column, with its unit in brackets: ``type, power_rated [kW], speed_rated [rpm]``; without
a unit the numbers are SI. A column ``torque_breakdown_ratio`` or ``torque_start_ratio`` is over the rated
torque. Lines that begin with ``#`` are comments.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from linkwright.drive.model.catalogue import CatalogueMotor
from linkwright.drive.model.motor import with_rated_point
from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import MachineFileError, show
from linkwright.kernel.files.catalogue_file import CatalogueFile, Columns
from linkwright.kernel.files.named_file import named_file
from linkwright.kernel.public import public
from linkwright.kernel.units.kinds import COUNT, INERTIA, POWER, RATIO, SPEED, TORQUE
from linkwright.kernel.units.marks import Quantity, QuantityList, not_negative, positive

_KEY = "drive.motor.file"

# Columns that are entries of a motor, and what is in them.
ENTRIES: dict[str, Quantity] = {
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

# Columns that describe a servo motor of an axis besides; a drive has no use for them.
SERVO: dict[str, Quantity | QuantityList] = {
    "brake_inertia": not_negative(INERTIA),
    "torque_speed_max": not_negative(TORQUE),
    "speed_torque_max": positive(SPEED),
    "torque_max_speed_max": not_negative(TORQUE),
    "speed_continuous": QuantityList(SPEED),
    "torque_continuous": QuantityList(TORQUE),
    "speed_peak": QuantityList(SPEED),
    "torque_peak": QuantityList(TORQUE),
    "cost": not_negative(COUNT),
}

# Columns for people.
WORDS = ("kind", "series", "frame", "poles", "efficiency", "mass", "current_rated", "remark")

_COLUMNS = Columns(
    noun="motors",
    numbers={**ENTRIES, **dict.fromkeys(_RATIOS, positive(RATIO))},
    words=(*WORDS, *SERVO),
    example="type, power_rated [kW], speed_rated [rpm]",
)


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
    rows = _MotorRows(named_file(name, folder, _KEY, allow_outside=allow_outside))
    row = rows.numbers(rows.known(wanted))
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
        rows = _MotorRows(Path(path))
        return tuple(rows.motor(type) for type in rows.types)
    except MachineFileError as error:
        # No machine file names this one.
        problems = [
            replace(problem, key=problem.key.replace(_KEY, "catalogue")) for problem in error.problems
        ]
        raise MachineFileError(problems) from None


class _MotorRows(CatalogueFile):
    """The motors of a file."""

    def __init__(self, path: Path) -> None:
        super().__init__(path, _KEY, _COLUMNS)

    def numbers(self, type: str) -> dict[str, Any]:
        """The entries of a type in SI, ratios as torques."""
        entries = super().numbers(type)
        rated = with_rated_point(entries).get("torque_rated")
        for ratio, entry in _RATIOS.items():
            if ratio in entries:
                if rated is None:
                    line, expected = self.types[type][0], "the rated torque, or power and speed, beside it"
                    raise self.wrong(line, ratio, expected)
                entries.setdefault(entry, entries[ratio] * rated)
                del entries[ratio]
        return entries

    def kind(self, type: str, row: Mapping[str, float]) -> str:
        given = self.word(type, "kind")
        if given and given not in KINDS:
            expected = f"a kind of motor: {', '.join(KINDS)}"
            raise self.wrong(self.types[type][0], show(given), expected, suggestion(given, KINDS))
        return given or ("dc" if "speed_no_load" in row else "servo" if "torque_max" in row else "induction")

    def motor(self, type: str) -> CatalogueMotor:
        """A type with all that sizing needs of its kind."""
        row = with_rated_point(self.numbers(type))
        kind = self.kind(type, row)
        lacking = [name for name in (*_RATED, *_NEEDED[kind]) if name not in row]
        if lacking:
            raise self.lacks(type, lacking[0], f'sizing a motor of the kind "{kind}" needs it')
        poles = self.word(type, "poles")
        if poles and not poles.isdecimal():
            raise self.wrong(self.types[type][0], show(poles), "a number of poles")
        known = {name: row[name] for name in row if name in CatalogueMotor.__slots__}
        known.setdefault("speed_synchronous", None)
        words: dict[str, Any] = {
            "series": self.word(type, "series") or self.path.name,
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
