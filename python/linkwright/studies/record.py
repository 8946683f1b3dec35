"""A measured record: columns of a file over time or crank angle."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError
from linkwright.kernel.files.points import columns_of, read_columns
from linkwright.kernel.public import public, public_type
from linkwright.kernel.units.kinds import ANGLE, CURRENT, SPEED, TIME, TORQUE, Kind
from linkwright.machine.machine import Machine

# What may be along the record, and what may have been measured of a drive.
PLACES = {"time": TIME, "angle": ANGLE}
CHANNELS = {"angle": ANGLE, "speed": SPEED, "motor_speed": SPEED, "torque": TORQUE, "current": CURRENT}

# SI units as they are printed.
UNITS = {
    "time": "s",
    "angle": "rad",
    "speed": "rad/s",
    "motor_speed": "rad/s",
    "torque": "N m",
    "current": "A",
}


@public_type
@dataclass(frozen=True)
class MeasuredRecord:
    """A measured record.

    Attributes
    ----------
    over : str
        ``"time"`` or ``"angle"``, of the crank.
    at : ndarray, shape (n,)
        Places of the samples, increasing [s or rad].
    channels : Mapping
        Name → values, (n,) each: ``speed`` of the crank, ``motor_speed`` [rad/s], ``torque`` of the motor
        [N m], ``current`` [A], over time also the crank ``angle`` [rad]; of the manoeuvre of a train its
        discs [rad/s] and shafts [N m] by name.
    units : Mapping
        SI unit of each channel as it is printed; those above are known.
    """

    over: str
    at: Floats
    channels: Mapping[str, Floats]
    units: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Refuse what is no record.

        Raises
        ------
        InputError
            Samples do not follow one another, are not finite, or no channel has as many.
        """
        if self.over not in PLACES:
            raise InputError(f'over: found "{self.over}", expected time or angle')
        if not self.channels:
            raise InputError(f"record: found no channel, expected one of {', '.join(CHANNELS)}")
        for name, values in {"at": self.at, **self.channels}.items():
            if np.shape(values) != np.shape(self.at) or not np.isfinite(values).all():
                raise InputError(
                    f"record: {name}: found {np.shape(values)} values, expected as many finite ones as `at`"
                )
        if len(self.at) < 2:
            raise InputError(f"record: found {len(self.at)} samples, expected two or more")
        if not (np.diff(self.at) > 0).all():
            place = int(np.argmax(np.diff(self.at) <= 0)) + 1
            raise InputError(f"record: sample {place}: its {self.over} does not come after the one before it")

    def unit(self, channel: str) -> str:
        """SI unit of a channel as it is printed."""
        return self.units.get(channel, UNITS.get(channel, ""))

    @property
    def size(self) -> int:
        """How many numbers were measured."""
        return len(self.at) * len(self.channels)

    @property
    def stacked(self) -> Floats:
        """All channels one after the other, (size,)."""
        return np.concatenate([np.asarray(values, dtype=float) for values in self.channels.values()])


@public
def read_record(path: str | os.PathLike[str], machine: Machine | None = None) -> MeasuredRecord:
    """Read a measured record from a CSV file.

    Parameters
    ----------
    path : path
        A file whose head names columns with their units: ``time [s], speed [rpm]``. Over ``time`` or
        ``angle``, of the crank; ``speed``, ``motor_speed``, ``torque`` of the motor, ``current`` [A] are
        read, others passed over.
    machine : Machine, optional
        Of a train; columns named as its discs are speeds, those named as its shafts torques.

    Returns
    -------
    MeasuredRecord
        In SI, in the order of the file; angles that begin anew after a revolution are counted on.

    Raises
    ------
    MachineFileError
        The file cannot be read, or holds something else; with file and line.
    InputError
        There is no column of time or angle, or none that was measured.
    """
    place = Path(path)
    columns, _ = columns_of(place, "", "record")
    known: dict[str, Kind] = {**CHANNELS, **_of_train(machine)}
    over = next((name for name in PLACES if name in columns), None)
    measured = [name for name in columns if name in known and name != over]
    if over is None or not measured:
        found, listed = ", ".join(columns), ", ".join(known)
        raise InputError(f"{place}: found columns {found}; expected time or angle, and one of {listed}")
    read = read_columns(place, {over: PLACES[over], **{name: known[name] for name in measured}})
    if "angle" in read:
        read["angle"] = np.unwrap(read["angle"])
    units = {name: "rad/s" if known[name] is SPEED else "N m" for name in _of_train(machine)}
    try:
        return MeasuredRecord(
            over, read.pop(over), read, {name: units[name] for name in read if name in units}
        )
    except InputError as error:
        raise InputError(f"{place}: {error}") from None


def _of_train(machine: Machine | None) -> dict[str, Any]:
    train = None if machine is None else machine.train
    if train is None:
        return {}
    return dict.fromkeys(train.shafts, TORQUE) | dict.fromkeys(train.discs, SPEED)
