"""At which speed of the crank a command computes, and where that speed comes from: said with every answer."""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING, Any, NamedTuple

from linkwright.kernel.reader.numbers import number

if TYPE_CHECKING:
    from linkwright.kernel.arrays import Floats
    from linkwright.machine.machine import Machine

_OPTION = "--speed"


class CrankSpeed(NamedTuple):
    """A speed of the crank [rad/s], and where it comes from."""

    value: float
    source: str

    def __str__(self) -> str:
        """In both units that people think in."""
        return self.words("crank")

    def words(self, driver: str) -> str:
        """The same of what rotates."""
        return f"{driver} speed {_both(self.value)} ({self.source})"


def crank_speed(machine: Machine, asked: float | None) -> CrankSpeed:
    """The speed for a motion at constant speed: that of the option, else the machine's own."""
    from linkwright.drive.model.motor import ConstantSpeedMotor

    if asked is not None:
        return CrankSpeed(asked, _OPTION)
    drive = machine.drive
    if machine.design_speed is not None:
        return CrankSpeed(machine.design_speed, _design(machine))
    if drive is not None and isinstance(drive.motor, ConstantSpeedMotor):
        speed = drive.motor.speed / drive.gearbox.ratio
        return CrankSpeed(speed, "drive.motor.speed over drive.gearbox.ratio")
    # Then velocities are transfer functions.
    return CrankSpeed(1.0, "the file has no drive.speed: rates are those for a radian per second")


def _design(machine: Machine) -> str:
    """Where the file gives the design speed."""
    master = machine.master
    is_cycle = master is not None and (master.speed is not None or master.cycle_time is not None)
    return "master" if is_cycle else "design speed, drive.speed"


def speeds_of(
    speeds: Floats, machine: Machine, asked: float | None, *, is_pose: bool = False
) -> dict[str, Any]:
    """Speeds (n,) [rad/s] along a motion, or in one pose, for JSON; `asked`: that of ``--speed``."""
    has_motor = machine.drive is not None and machine.drive.motor is not None
    source = (
        _OPTION if asked is not None else "steady motion" if has_motor and not is_pose else _design(machine)
    )
    low, high = float(speeds.min()), float(speeds.max())
    return {"speed_min": low, "speed_max": high, "speed_source": source}


def speed_words(speeds: dict[str, Any]) -> str:
    """The same in words, for people."""
    low, high = speeds["speed_min"], speeds["speed_max"]
    at = _both(low) if low == high else f"{_both(low)} to {_both(high)}"
    return f"Crank speed {at} ({speeds['speed_source']})"


def _both(speed: float) -> str:
    return f"{number(speed)} rad/s = {number(speed * 30 / pi)} rpm"
