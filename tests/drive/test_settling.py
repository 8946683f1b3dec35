"""When a run-up has settled, of a machine whose speed changes sharply within a degree."""

from __future__ import annotations

import numpy as np
import pytest

import linkwright as lw

# The rocker nearly stands once a revolution: from 14 to 0.5 rad/s, at a mean of 1.3 rad/s.
MACHINE = """
format = 1
name = "Peaked"
[drive.motor]
kind = "table"
inertia = 0.0128
speed = [0.0, 0.7343, 1.4686, 2.2029]
torque = [4.2074, 5.2592, 2.1037, -4.2074]
[drive.gearbox]
ratio = 1.0
efficiency = 0.7
[drive.flywheel]
inertia = 0.0144
[mechanism.points]
P0 = { x = 0.0, y = -1.1954 }
P1 = { x = 0.9964, y = 0.0 }
[mechanism.cranks.A]
radius = 0.45584
phase = 1.4906
[mechanism.rockers.R1]
crank = "A"
pivot = "P1"
coupler = 1.90134
rocker = 1.67414
assembly = "right"
[mechanism.slotted_levers.L0]
pin = "A"
pivot = "P0"
length = 0.49056
[bodies]
A = { mass = 0.83143, inertia = 0.00119 }
R1 = { mass = 0.99569 }
"R1.rocker" = { mass = 75.577 }
[run_up]
angle_start = 4.0561
"""


def test_a_peaked_speed_settles_when_it_does() -> None:
    machine = lw.loads(MACHINE)
    state, up = lw.steady_state(machine), lw.run_up(machine)
    # A disturbance dies out within a few revolutions.
    assert state.multiplier < 0.2
    assert up.turns < 4.0
    band = up.settled * state.speed_mean_time

    def apart(times: np.ndarray) -> np.ndarray:
        angle, speed = up.motion.at(times)
        phi, place = np.unique(angle % (2 * np.pi), return_inverse=True)
        return np.abs(speed - lw.steady_state(machine, angles=phi).speed[place])

    later = apart(np.linspace(up.time * (1 + 1e-6), up.motion.time[-1], 20_000))
    assert later.max() <= band
    assert apart(np.array([up.time]))[0] == pytest.approx(band, rel=1e-4)
    assert apart(np.array([up.time * (1 - 1e-6)]))[0] > band
