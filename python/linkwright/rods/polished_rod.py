"""Motion of the polished rod in time: harmonic, by a pumping unit at constant speed, or at that of its motor.

With a motor the load of the string and the motion of the drive decide each other: the gearbox's torque under
that load is a load of the crankshaft, the steady motion under it gives the crank angle over time.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.drive.steady_state import SteadyState, steady_state
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError
from linkwright.kinetostatics.model.loads import TorqueAngle
from linkwright.machine.machine import Machine
from linkwright.pumping.gear_torque import StrokeLoad, equal_peaks
from linkwright.pumping.model.polished_rod_load import PolishedRodLoad
from linkwright.pumping.model.unit import PumpingUnit
from linkwright.pumping.unit import PolishedRod
from linkwright.rods.model.rod_string import RodString

# Crank angles of the table by which the drive knows the torque of the gearbox.
_ANGLES = 360

# Intervals of the revolution over which the crank angle is a function of time.
_INTERVALS = 1440

# Steps of Newton's method for the time at the bottom of the stroke.
_NEWTON = 5

# Rounds before that the next load is extrapolated from.
_ROUNDS = 6

# Name of the load of the crankshaft.
_LOAD = "rod_string"


@dataclass(frozen=True)
class RodMotion:
    """The polished rod over a period, from the bottom of its stroke."""

    period: float  # [s]
    stroke: float  # [m]
    position: Floats  # (n,) upward from the middle of the stroke or above its bottom [m]
    crank_angle: Floats | None  # (n,) [rad]; None without a unit


class HarmonicRod:
    """A polished rod that moves harmonically."""

    def __init__(self, stroke: float, speed: float) -> None:
        self.stroke, self.period = stroke, 2 * np.pi / speed
        self.rounds: list[tuple[Floats, Floats]] = []

    def motion(self, n: int) -> RodMotion:
        """Its position at n samples."""
        position = 0.5 * self.stroke * (1 - np.cos(2 * np.pi * np.arange(n) / n))
        return RodMotion(self.period, self.stroke, position, None)

    def take(self, load: Floats) -> float:
        """No load changes the motion."""
        return 0.0


class UnitRod:
    """A polished rod on a pumping unit, at constant speed or at that of its motor."""

    def __init__(self, machine: Machine, string: RodString) -> None:
        unit = machine.pumping_unit
        assert unit is not None
        self.machine, self.unit = machine, unit
        self.rod = PolishedRod.of(machine, unit)
        self.ends = self.rod.bottom, self.rod.top
        self.has_motor = machine.drive is not None and machine.drive.motor is not None
        self.steady: SteadyState | None = None
        self.rounds: list[tuple[Floats, Floats]] = []
        speed = crank_speed(machine, string)
        if self.has_motor:
            angles = table_angles()
            rises = self.rod.motion(angles)[1] > 0
            self.load = np.where(rises, string.weight_fluid + string.fluid_load, string.weight_fluid)
            self._drive(self.load)
        elif speed is None:
            raise InputError(
                f"{machine.name}: the rod string has no pumping speed; expected drive.speed, a motor or "
                "rod_string.speed"
            )
        else:
            self.period = 2 * np.pi / speed

    def motion(self, n: int) -> RodMotion:
        """Its position at n samples."""
        angles = self._angles(np.arange(n) / n)
        return RodMotion(self.period, self.rod.stroke, self.rod.motion(angles)[0], angles)

    def _angles(self, times: Floats) -> Floats:
        """Crank angles at times over the period."""
        start = self.ends[0]
        if self.steady is None:
            return np.asarray((start + 2 * np.pi * times) % (2 * np.pi))
        from scipy.interpolate import CubicHermiteSpline

        steady = self.steady
        angle_of = CubicHermiteSpline(steady.time, steady.crank_angle, steady.speed)
        at_start = float(np.interp(start, steady.crank_angle, steady.time))
        for _ in range(_NEWTON):
            at_start -= float((angle_of(at_start) - start) / angle_of(at_start, 1))
        return np.asarray(angle_of((at_start + times * self.period) % self.period))

    def take(self, load: Floats) -> float:
        """The motion of the drive under samples (n,) of the load over the period.

        Returns by how much that moves the rod at most, over its stroke.
        """
        if not self.has_motor:
            return 0.0
        before = self.motion(len(load))
        assert before.crank_angle is not None
        self.load = self._extrapolated(over_angle(before.crank_angle, load))
        self._drive(self.load)
        after = self.motion(len(load))
        moved = float(np.abs(after.position - before.position).max()) / before.stroke
        return max(moved, abs(after.period / before.period - 1))

    def _extrapolated(self, target: Floats) -> Floats:
        """The load that answers itself, by those of the last rounds and what they were answered with.

        Method: Anderson, Iterative Procedures for Nonlinear Integral Equations, J. ACM 12 (1965) 547.
        """
        self.rounds = [*self.rounds[-_ROUNDS:], (self.load, target - self.load)]
        loads, changes = (np.array(each) for each in zip(*self.rounds, strict=True))
        if len(loads) == 1:
            return target
        steps = np.diff(changes, axis=0)
        weights = np.linalg.lstsq(steps.T, changes[-1], rcond=1e-2)[0]
        return np.asarray(target - weights @ (np.diff(loads, axis=0) + steps))

    def _drive(self, load: Floats) -> None:
        """The steady motion of the drive under loads at the angles of the table."""
        turn, given = gear_load(self.unit, self.rod.motion(table_angles())[1], load)
        size = equal_peaks(turn, turn.factor >= 0) if given is None else given
        self.torque: list[float] = turn.net(size).tolist()
        self.steady = steady_state(self.driven(self.torque), n=_INTERVALS)
        self.period = self.steady.period

    def driven(self, torque: Sequence[Any]) -> Machine:
        """The machine whose crankshaft has torques of the gearbox at the angles of the table as a load."""
        table = TorqueAngle.model_construct(
            kind="torque_angle", angle=tuple(table_angles().tolist()), torque=tuple(torque)
        )
        return self.machine.with_entries(
            {
                "loads": {**self.machine.loads, _LOAD: table},
                "rod_string": None,
                "pumping_unit": self.unit.with_entries({"load": None}),
            }
        )


def table_angles() -> Floats:
    """Crank angles at which the drive knows the load of the polished rod [rad]."""
    return np.linspace(0.0, 2 * np.pi, _ANGLES, endpoint=False)


def over_angle(angles: Any, load: Any) -> Any:
    """Loads at crank angles as those at the angles of the table."""
    return np.interp(table_angles(), angles, load, period=2 * np.pi)


def gear_load(unit: PumpingUnit, factor: Any, load: Any) -> tuple[StrokeLoad, Any]:
    """Torques at the angles of the table under loads there, and the counterbalance if it is given."""
    unit = with_load(unit, load)
    entries = unit.load
    assert entries is not None
    turn = StrokeLoad(unit, load, factor, np.sin(table_angles() + entries.phase))
    return turn, given_counterbalance(unit)


def given_counterbalance(unit: PumpingUnit) -> Any:
    """The counterbalance that is given in place of the best one; None where it is not."""
    if unit.load is None:
        return None
    is_air = unit.geometry == "air_balanced"
    given = unit.load.counterbalance_effect if is_air else unit.load.counterbalance
    return None if isinstance(given, str) else given


def with_load(unit: PumpingUnit, load: Any, *, is_best: bool = False) -> PumpingUnit:
    """The unit with loads of the polished rod at the angles of the table; `is_best`: with the best
    counterbalance.
    """
    entries: Mapping[str, Any] = {
        "angle": tuple(table_angles().tolist()),
        "force": tuple(load),
        **({"counterbalance": "optimal", "counterbalance_effect": None} if is_best else {}),
    }
    given = PolishedRodLoad() if unit.load is None else unit.load
    return unit.with_entries({"load": given.with_entries(entries)})


def crank_speed(machine: Machine, string: RodString) -> Any:
    """The pumping speed as an angular one, where it is given [rad/s]."""
    return string.speed if machine.drive is None else machine.drive.speed


def polished_rod_of(machine: Machine, string: RodString) -> HarmonicRod | UnitRod:
    """What moves the polished rod of a string."""
    if machine.pumping_unit is not None:
        return UnitRod(machine, string)
    lacking = next((key for key in ("stroke", "speed") if getattr(string, key) is None), None)
    speed = crank_speed(machine, string)
    if string.stroke is None or speed is None:
        raise InputError(
            f"{machine.name}: found no rod_string.{lacking}, expected it, or a [pumping_unit] that moves the "
            "polished rod"
        )
    return HarmonicRod(string.stroke, speed)
