"""Motion in time clockwise: that of the mirrored machine counter-clockwise, and closed forms."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import linkwright as lw
from linkwright import ConvergenceError, SteadyStateError
from linkwright.drive import course

MOTORS: dict[str, dict[str, Any]] = {
    "induction": {
        "kind": "induction",
        "speed_synchronous": "1500 rpm",
        "speed_rated": "1430 rpm",
        "torque_rated": "30 N m",
        "torque_breakdown": "75 N m",
        "torque_start": "60 N m",
    },
    "dc": {"kind": "dc", "speed_no_load": "1500 rpm", "torque_stall": "90 N m", "torque_max": "60 N m"},
    "table": {"kind": "table", "speed": [-50.0, 0.0, 60.0, 150.0], "torque": [30.0, 60.0, 50.0, -5.0]},
    "constant_torque": {"kind": "constant_torque", "torque": "25 N m"},
}


def press(motor: str, side: int) -> lw.Machine:
    """An offset slider-crank with loads of every kind; side −1 is its mirror image about the x axis."""
    pull = "-40*max(0, sin(SIDE*phi)) - 3*v - 2*v*abs(v) + 5*t - 60*max(0, s - 0.4)"
    tables = {
        "format": 1,
        "name": "Offset press",
        "drive": {
            "motor": MOTORS[motor],
            "gearbox": {"ratio": 12, "efficiency": 0.85, "inertia": 0.02},
            "flywheel": {"inertia": 1.5, "on": "crank"},
            "brake": {"torque": "20 N m", "on": "motor"},
        },
        "mechanism": {
            "cranks": {"A": {"radius": 0.1, "phase": side * 0.4}},
            "sliders": {"ram": {"crank": "A", "rod": 0.35, "offset": side * 0.04, "angle": side * 0.3}},
        },
        "bodies": {
            "A": {"mass": 8.0, "along": 0.03, "across": side * 0.01, "inertia": 0.05},
            "ram": {"mass": 40.0},
            "ram.rod": {"mass_per_length": 20.0},
        },
        "loads": {
            "gravity": {"kind": "gravity", "direction": side * -np.pi / 2},
            "guide": {"kind": "dry", "on": "ram", "force": 90.0},
            "oil": {"kind": "viscous", "on": "ram", "damping": 60.0},
            "work": {
                "kind": "force_position",
                "on": "ram",
                "position": [0.26, 0.33, 0.4],
                "forward": [0.0, 900.0, 400.0],
                "return": [20.0, 60.0, 0.0],
            },
            "hand": {"kind": "formula", "on": "ram", "force": pull.replace("SIDE", str(side))},
            "fan": {"kind": "torque_speed", "speed": [0.0, 5.0, 20.0], "torque": [2.0, 9.0, 60.0]},
        },
    }
    return lw.Machine.model_validate(tables)


@pytest.mark.parametrize("motor", MOTORS)
@pytest.mark.parametrize("against", [False, True])
def test_a_clockwise_motion_is_that_of_the_mirrored_machine(motor: str, against: bool) -> None:
    """From rest with the motor; at speed against it, where the motor brakes to standstill."""
    start = {"speed": -9.0, "clockwise": False} if against else {"speed": 0.0, "clockwise": True}
    back = lw.transient(press(motor, 1), angle=-0.7, turns=4.0, **start)
    if against:
        # Of the mirrored machine a motor that turns clockwise against a counter-clockwise motion.
        there = lw.transient(press(motor, -1), angle=0.7, turns=4.0, speed=9.0, clockwise=True)
        assert back.end == there.end == lw.drive.transient.End.REVERSAL
    else:
        there = lw.transient(press(motor, -1), angle=0.7, turns=4.0)
        assert back.end == there.end == lw.drive.transient.End.TURNS
        assert back.turns == pytest.approx(4.0)
        assert (back.speed[1:] < 0).all()
    # The kinks of both are found by scans from their own zero, so that steps may differ; the motion does not.
    assert back.time[-1] == pytest.approx(there.time[-1], rel=1e-7)
    times = np.linspace(0, min(back.time[-1], there.time[-1]), 400)
    angle, speed = back.at(times)
    same, fast = there.at(times)
    # The errors of steps of 1e-8 add up over four revolutions.
    assert -angle == pytest.approx(same, abs=2e-6)
    assert -speed == pytest.approx(fast, abs=2e-6 * abs(fast).max())
    assert back.torque_drive_end == pytest.approx(-there.torque_drive_end, rel=1e-5, abs=1e-5)
    assert back.torque_load_end == pytest.approx(-there.torque_load_end, rel=1e-4, abs=1e-3)


def test_events_and_extremes_are_those_of_the_mirrored_machine() -> None:
    here, there = press("dc", 1), press("dc", -1)
    back = lw.transient(here, turns=2.0, clockwise=True)
    forth = lw.transient(there, turns=2.0)
    events, same = lw.motion_events(here, back), lw.motion_events(there, forth)
    assert [event.kind for event in events] == [event.kind for event in same]
    assert [-event.crank_angle for event in events] == pytest.approx([e.crank_angle for e in same], abs=1e-4)
    least, most = (lw.motion_extremes(motion)[:2] for motion in (back, forth))
    assert [-extreme.value for extreme in least[::-1]] == pytest.approx([e.value for e in most], abs=1e-5)


def test_the_equation_of_motion_holds_on_the_way() -> None:
    """Forces find the same driving torque from momentum and loads as the motor gives: M_d(ω) at ω < 0."""
    machine = press("dc", 1)
    motion = lw.transient(machine, turns=1.5, clockwise=True, brake=False)
    # At rest dry friction has no direction.
    torque = lw.forces(machine, motion).torque_drive[1:]
    ratio, stall, limit, top = 12.0, 90.0, 60.0, 1500 * np.pi / 30
    motor = np.minimum(stall * (1 - ratio * -motion.speed[1:] / top), limit)
    drive = -ratio * np.where(motor > 0, 0.85 * motor, motor / 0.85)
    assert torque == pytest.approx(drive, abs=1e-4 * abs(drive).max())


FLYWHEEL = """
format = 1
name = "Flywheel"
[drive.motor]
kind = "constant_torque"
torque = {torque}
[drive.flywheel]
inertia = 4
[mechanism.cranks.A]
radius = 0.1
"""


@pytest.mark.parametrize(("torque", "clockwise", "sign"), [(20, True, -1), (-20, False, -1), (-20, True, 1)])
def test_a_flywheel_under_constant_torque(torque: float, clockwise: bool, sign: int) -> None:
    """ω = M t/J, whichever way the torque acts."""
    motion = lw.transient(lw.loads(FLYWHEEL.format(torque=torque)), duration=2.0, clockwise=clockwise)
    assert motion.speed[-1] == pytest.approx(sign * 10.0, rel=1e-9)
    assert motion.crank_angle[-1] == pytest.approx(sign * 10.0, rel=1e-9)
    assert motion.acceleration == pytest.approx(sign * 5.0, rel=1e-9)
    assert course(motion, 4)[2] == pytest.approx(sign * np.array([0, 2.5, 5, 7.5, 10]), rel=1e-9)


def test_a_motor_that_is_opposed_brings_the_machine_to_rest() -> None:
    """Turned at −10 rad/s against 20 N m, 4 kg m² stand after J ω/M = 2 s and half that angle."""
    motion = lw.transient(lw.loads(FLYWHEEL.format(torque=20)), speed=-10.0, duration=9.0)
    assert motion.end == lw.drive.transient.End.REVERSAL
    assert motion.time[-1] == pytest.approx(2.0, rel=1e-9)
    assert motion.crank_angle[-1] == pytest.approx(-10.0, rel=1e-9)
    assert motion.turns == pytest.approx(10.0 / (2 * np.pi), rel=1e-9)


def test_a_jump_over_negative_speed_is_no_silent_answer() -> None:
    """A load that holds the speed at a jump ends in an error clockwise too."""
    held = (
        FLYWHEEL.format(torque=20)
        + """
[loads.band]
kind = "formula"
on = "A"
torque = "where(abs(omega) > 5, -40*sign(omega), 0)"
"""
    )
    with pytest.raises((SteadyStateError, ConvergenceError)):
        lw.transient(lw.loads(held), duration=5.0, clockwise=True)
