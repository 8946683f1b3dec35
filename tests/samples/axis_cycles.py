"""Cycles of a driver in closed form: a cycloidal turn, a dwell, and the way back."""

from __future__ import annotations

import numpy as np

from linkwright.axes.driver_cycle import DriverCycle
from linkwright.kernel.arrays import Floats

# Time of a rise, of a dwell, of the cycle [s]; turn of a rise [rad].
RISE, DWELL, PERIOD, TURN = 0.2, 0.1, 0.6, 1.5

# Mean square of the acceleration over the cycle: two sines of amplitude 2π h/T² [rad²/s⁴].
ACCELERATION_RMS = 2 * np.pi * TURN / RISE**2 * np.sqrt(0.5 * 2 * RISE / PERIOD)
SPEED_PEAK, SPEED_MEAN = 2 * TURN / RISE, 2 * TURN / PERIOD


def motion(n: int = 361) -> tuple[Floats, Floats, Floats]:
    """Time, speed and acceleration, each section for itself."""

    def section(start: float, sense: float) -> tuple[Floats, Floats, Floats]:
        share = np.linspace(0, 1, n)
        turn = 2 * np.pi * share
        speed = sense * TURN / RISE * (1 - np.cos(turn))
        acceleration = sense * 2 * np.pi * TURN / RISE**2 * np.sin(turn)
        return start + RISE * share, speed, acceleration

    def rest(start: float) -> tuple[Floats, Floats, Floats]:
        return np.array([start, start + DWELL]), np.zeros(2), np.zeros(2)

    parts = (section(0.0, 1.0), rest(RISE), section(RISE + DWELL, -1.0), rest(2 * RISE + DWELL))
    time, speed, acceleration = (np.concatenate(columns) for columns in zip(*parts, strict=True))
    return time, speed, acceleration


def inertia_cycle(inertia: float, load: float = 0.0) -> DriverCycle:
    """A pure inertia [kg m²], with a constant torque in one sense such as a weight's [N m]."""
    time, speed, acceleration = motion()
    return DriverCycle(time, speed, acceleration, inertia * acceleration + load, inertia)
