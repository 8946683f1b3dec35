"""Servo motors and gearboxes from files of comma-separated values: one for an axis, or all to choose from.

| column of a motor | |
| --- | --- |
| `inertia`, `brake_inertia` | of the rotor, of its holding brake |
| `torque_rated`, `speed_rated` | rated point in continuous operation (S1); `power_rated` in place of one |
| `torque_stall` | continuous torque at standstill; default: the rated torque |
| `torque_speed_max` | continuous torque at the maximum speed; default: not known above the rated speed |
| `torque_max` | peak torque |
| `speed_torque_max` | speed up to which it holds; default: the rated speed |
| `torque_max_speed_max` | peak torque at the maximum speed; default: not known above `speed_torque_max` |
| `speed_max` | maximum speed |
| `speed_continuous`, `torque_continuous` | the whole curve in place of the rated point: values with spaces |
| `speed_peak`, `torque_peak` | the whole curve of peak torque likewise |
| `cost` | in any currency |

A gearbox has `ratio`, `efficiency`, and what is known of `reverse`, `inertia`, `torque_max`, `torque_rated`,
`speed_max` and `cost`.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from linkwright.axes.model.axis_gearbox import AxisGearbox
from linkwright.axes.model.servo_motor import ServoMotor
from linkwright.drive.model.motor import with_rated_point
from linkwright.drive.model.motor_file import ENTRIES, SERVO, WORDS
from linkwright.kernel.description.problems import problems
from linkwright.kernel.errors import MachineFileError, show
from linkwright.kernel.files.catalogue_file import CatalogueFile, Columns
from linkwright.kernel.files.named_file import named_file
from linkwright.kernel.public import public
from linkwright.kernel.units.kinds import COUNT, INERTIA, RATIO, SPEED, TORQUE
from linkwright.kernel.units.marks import FRACTION, Quantity, not_negative, positive

_MOTORS = Columns(
    noun="servo motors",
    numbers={**ENTRIES, **SERVO},
    words=WORDS,
    example="type, inertia [kg cm^2], torque_rated [N m], speed_rated [rpm], torque_max [N m], "
    "speed_max [rpm]",
)

_GEARBOXES = Columns(
    noun="gearboxes",
    numbers={
        "ratio": positive(RATIO),
        "efficiency": Quantity(RATIO, FRACTION),
        "inertia": not_negative(INERTIA),
        "torque_max": positive(TORQUE),
        "torque_rated": positive(TORQUE),
        "speed_max": positive(SPEED),
        "cost": not_negative(COUNT),
    },
    words=("reverse", "series", "frame", "stages", "backlash", "mass", "remark"),
    example="type, ratio, efficiency, torque_max [N m], torque_rated [N m], speed_max [rpm]",
)


@dataclass(frozen=True)
class CatalogueServo:
    """A servo motor of a catalogue."""

    type: str
    motor: ServoMotor
    power_rated: float | None = None  # [W]
    cost: float | None = None


@dataclass(frozen=True)
class CatalogueGearbox:
    """A gearbox of a catalogue."""

    type: str
    gearbox: AxisGearbox
    cost: float | None = None


@public
def read_servo_motors(path: str | os.PathLike[str]) -> tuple[CatalogueServo, ...]:
    """Read servo motors from a CSV file, to choose from for an axis.

    Parameters
    ----------
    path : path
        File of comma-separated values with units in its head: ``type``, ``inertia``, the rated point, the
        peak torque, the maximum speed; or whole curves.

    Returns
    -------
    tuple of CatalogueServo
        In the order of the file, in SI.

    Raises
    ------
    MachineFileError
        The file cannot be read, has a wrong head or number, or a type lacks an entry; with its line.
    """
    rows = CatalogueFile(Path(path), "catalogue", _MOTORS)
    return tuple(_servo(rows, type) for type in rows.types)


@public
def read_gearboxes(path: str | os.PathLike[str]) -> tuple[CatalogueGearbox, ...]:
    """Read gearboxes from a CSV file, to choose from for an axis.

    Parameters
    ----------
    path : path
        File of comma-separated values with units in its head: ``type``, ``ratio``, ``efficiency``, and what
        is known besides.

    Returns
    -------
    tuple of CatalogueGearbox
        In the order of the file, in SI.

    Raises
    ------
    MachineFileError
        The file cannot be read, has a wrong head or number, or a type lacks an entry; with its line.
    """
    rows = CatalogueFile(Path(path), "gearboxes", _GEARBOXES)
    return tuple(_gearbox(rows, type) for type in rows.types)


def with_servo_motors_of_files(tables: dict[str, Any], folder: Path, *, allow_outside: bool = False) -> None:
    """Put the entries of motors from the files that axes name into their tables; changed in place.

    Entries that the machine file gives go first. Raises MachineFileError with file and line.
    """
    axes = tables.get("axes")
    for name, axis in axes.items() if isinstance(axes, dict) else ():
        motor = axis.get("motor") if isinstance(axis, dict) else None
        if not isinstance(motor, dict) or not isinstance(motor.get("file"), str):
            continue
        key = f"axes.{name}.motor.file"
        path = named_file(motor.pop("file"), folder, key, allow_outside=allow_outside)
        rows = CatalogueFile(path, key, _MOTORS)
        type = rows.known(motor.pop("catalogue", None))
        for entry, value in _servo_entries(rows, type).items():
            motor.setdefault(entry, value)


def _servo(rows: CatalogueFile, type: str) -> CatalogueServo:
    row = with_rated_point(rows.numbers(type))
    motor = _checked(rows, type, ServoMotor, _servo_entries(rows, type))
    return CatalogueServo(type, motor, row.get("power_rated"), row.get("cost"))


def _servo_entries(rows: CatalogueFile, type: str) -> dict[str, Any]:
    """A row as the table of a motor."""
    kind = rows.word(type, "kind")
    if kind not in ("", "servo"):
        raise rows.wrong(rows.types[type][0], show(kind), '"servo": only servo motors follow a law')
    row = with_rated_point(rows.numbers(type))
    for name in ("inertia", "speed_max") if "speed_peak" not in row else ("inertia",):
        if name not in row:
            raise rows.lacks(type, name)
    entries: dict[str, Any] = {name: row[name] for name in _AS_THEY_ARE if name in row}
    return {
        "type": type,
        **entries,
        "continuous": _continuous(rows, type, row),
        "peak": _peak(rows, type, row),
    }


# Columns that are entries of a motor.
_AS_THEY_ARE = ("inertia", "brake_inertia", "speed_max")


def _curve(rows: CatalogueFile, type: str, row: dict[str, Any], name: str) -> dict[str, Any] | None:
    """The whole curve of a row, if it has one."""
    speed, torque = (row.get(f"{word}_{name}") for word in ("speed", "torque"))
    for word, own, other in (("speed", speed, torque), ("torque", torque, speed)):
        if own is None and other is not None:
            raise rows.lacks(type, f"{word}_{name}", "a curve is of speeds and torques")
    return None if speed is None else {"speed": speed, "torque": torque}


def _continuous(rows: CatalogueFile, type: str, row: dict[str, Any]) -> dict[str, Any]:
    """Continuous torque: the whole curve, or through standstill, the rated point and the maximum speed."""
    if (curve := _curve(rows, type, row, "continuous")) is not None:
        return curve
    for name in ("torque_rated", "speed_rated"):
        if name not in row:
            raise rows.lacks(type, name, "or speed_continuous and torque_continuous, the whole curve")
    points = {0.0: row.get("torque_stall", row["torque_rated"]), row["speed_rated"]: row["torque_rated"]}
    if "torque_speed_max" in row and row.get("speed_max", 0.0) > row["speed_rated"]:
        points[row["speed_max"]] = row["torque_speed_max"]
    return {"speed": tuple(points), "torque": tuple(points.values())}


def _peak(rows: CatalogueFile, type: str, row: dict[str, Any]) -> dict[str, Any]:
    """Peak torque: the whole curve, or level up to its last speed and then straight to the maximum speed."""
    if (curve := _curve(rows, type, row, "peak")) is not None:
        return curve
    level = row.get("speed_torque_max", row.get("speed_rated"))
    for name, value in (("torque_max", row.get("torque_max")), ("speed_torque_max", level)):
        if value is None:
            raise rows.lacks(type, name, "or speed_peak and torque_peak, the whole curve")
    points = {0.0: row["torque_max"], level: row["torque_max"]}
    if "torque_max_speed_max" in row and row.get("speed_max", 0.0) > level:
        points[row["speed_max"]] = row["torque_max_speed_max"]
    return {"speed": tuple(points), "torque": tuple(points.values())}


def _gearbox(rows: CatalogueFile, type: str) -> CatalogueGearbox:
    row = rows.numbers(type)
    for name in ("ratio", "efficiency"):
        if name not in row:
            raise rows.lacks(type, name)
    cost, reverse = row.pop("cost", None), rows.word(type, "reverse")
    if reverse:
        row["reverse"] = reverse if reverse == "same" else _number(rows, type, reverse)
    return CatalogueGearbox(type, _checked(rows, type, AxisGearbox, row), cost)


def _number(rows: CatalogueFile, type: str, cell: str) -> float:
    try:
        return float(cell)
    except ValueError:
        expected = '"same" or a number in the column reverse'
        raise rows.wrong(rows.types[type][0], show(cell), expected) from None


Part = TypeVar("Part", bound=BaseModel)


def _checked(rows: CatalogueFile, type: str, model: type[Part], entries: dict[str, Any]) -> Part:
    """The part that a row describes; what contradicts itself there, with its line."""
    try:
        return model.model_validate(entries)
    except ValidationError as error:
        line = rows.types[type][0]
        found = [
            replace(problem, key=f"{rows.key}, {type}: {problem.key}", path=str(rows.path), line=line)
            for problem in problems(error, model, entries)
        ]
        raise MachineFileError(found) from None
