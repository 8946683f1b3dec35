"""A DC motor whose current is limited: its characteristic, and a start against the closed form."""

from __future__ import annotations

import numpy as np
import pytest

import linkwright as lw
from linkwright import InputError, MachineFileError, ShapeError
from linkwright.drive import DcMotor
from linkwright.machine import compile_machine
from linkwright.torsion import motor_curve

STALL, NO_LOAD, MOST, INERTIA = 200.0, 100.0, 50.0, 4.0

FILE = f"""
format = 1
name = "Wheel on a DC motor"

[drive.motor]
kind = "dc"
torque_stall = {STALL}
speed_no_load = {NO_LOAD}
inertia = {INERTIA}
torque_max = {MOST}

[mechanism.cranks.A]
radius = 0.1
"""


def test_torque_is_held_within_the_limit() -> None:
    speeds = np.array([0.0, 50.0, 75.0, 80.0, 100.0, 110.0, 125.0, 200.0])
    torque = compile_machine(lw.loads(FILE)).motor_torques(speeds).motor
    assert torque == pytest.approx(np.clip(STALL * (1 - speeds / NO_LOAD), -MOST, MOST), abs=1e-9)


def test_a_limit_above_the_stall_torque_changes_nothing_forward() -> None:
    machine = lw.loads(FILE, ["drive.motor.torque_max=300"])
    torque = compile_machine(machine).motor_torques(np.array([0.0, 50.0, 120.0])).motor
    assert torque == pytest.approx([200.0, 100.0, -40.0], abs=1e-9)


def test_a_limit_above_the_stall_torque_begins_backwards() -> None:
    """Driven backward the motor gives more than at standstill, up to the limit; so in a train."""
    machine = lw.loads(FILE, ["drive.motor.torque_max=300"])
    speeds, torques = np.array([-80.0, -50.0, -20.0, 0.0]), [300.0, 300.0, 240.0, 200.0]
    assert compile_machine(machine).motor_torques(speeds).motor == pytest.approx(torques, abs=1e-9)
    assert machine.drive is not None
    assert isinstance(machine.drive.motor, DcMotor)
    curve = motor_curve(machine.drive.motor)
    assert np.interp(speeds, curve.x, curve.y) == pytest.approx(torques, abs=1e-9)


def test_where_a_limit_begins_backwards_nothing_happens_forward() -> None:
    """The motion passes 50 rad/s, and the limit of 300 N m begins at −50 rad/s: all is as without it."""
    load = """
[loads.L]
kind = "formula"
on = "A"
torque = "-100 - 95*cos(phi)"
"""
    text = FILE.replace(f"inertia = {INERTIA}\n", "inertia = 0.2\n") + load
    limited = lw.loads(text, ["drive.motor.torque_max=300"])
    free = lw.loads(text.replace(f"torque_max = {MOST}\n", ""))
    motion, other = lw.steady_state(limited), lw.steady_state(free)
    assert motion.speed_min < 50.0 < motion.speed_max
    for name in ("speed_min", "speed_max", "multiplier", "acceleration_max", "torque_motor_max"):
        assert getattr(motion, name) == pytest.approx(getattr(other, name), rel=1e-8), name
    inertias = {"drive.motor.inertia": np.array([0.2, 0.3])}
    rows, others = lw.steady_states(limited, inertias), lw.steady_states(free, inertias)
    assert rows.speed_min == pytest.approx(others.speed_min, rel=1e-8)
    assert lw.transient(limited, duration=0.4).speed[-1] == pytest.approx(
        lw.transient(free, duration=0.4).speed[-1], rel=1e-8
    )


@pytest.mark.parametrize("at", [3.0, 6.0, 8.0, 10.0])
def test_start_follows_its_closed_form(at: float) -> None:
    """J ω' = M_max up to the knee; then the speed nears ω_0 with the time constant J ω_0/M_stall."""
    knee = NO_LOAD * (1 - MOST / STALL)
    time, constant = INERTIA * knee / MOST, INERTIA * NO_LOAD / STALL
    if at < time:
        expected = MOST / INERTIA * at
    else:
        expected = NO_LOAD - (NO_LOAD - knee) * np.exp(-(at - time) / constant)
    motion = lw.transient(lw.loads(FILE), duration=at, accuracy=1e-10)
    assert motion.speed[-1] == pytest.approx(expected, rel=1e-8)


def test_run_says_that_a_start_without_limit_is_too_short() -> None:
    rated = ["drive.motor.torque_rated=20", 'drive.motor.torque_max="60 N m"']
    free = FILE.replace(f"torque_max = {MOST}\n", "")
    said = lw.study(lw.loads(free, rated[:1])).warnings
    assert any("200 N m at standstill, 10 times its rated torque" in text for text in said)
    assert not any("at standstill" in text for text in lw.study(lw.loads(FILE, rated)).warnings)


def test_a_motor_without_rotor_inertia_is_said() -> None:
    bare = (
        FILE.replace(f"inertia = {INERTIA}\n", "torque_rated = 20\n")
        + "\n[bodies]\nA = { mass = 1, inertia = 2 }\n"
    )
    assert any("no rotor inertia" in text for text in lw.study(lw.loads(bare)).warnings)


def test_a_limit_below_the_rated_torque_is_refused() -> None:
    with pytest.raises((InputError, MachineFileError)) as error:
        lw.loads(FILE, ["drive.motor.torque_rated=80"])
    assert "at least the rated torque, 80 N m" in str(error.value)


def test_a_limit_does_not_vary_in_a_batch() -> None:
    with pytest.raises(ShapeError, match=r"^drive\.motor: .* cannot vary"):
        lw.steady_states(lw.loads(FILE), {"drive.motor.torque_max": np.array([50.0, 60.0])})
