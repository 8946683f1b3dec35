"""An axis that drives a cylinder, an electric one: the same numbers as a linear driver along its line."""

from __future__ import annotations

import numpy as np
import pytest

import linkwright as lw

MOTOR = """
[master]
cycle_time = "1 s"
[axes.Z]
phase = "30 deg"
sections = [
  { angle = "120 deg", lift = "100 mm", law = "LAW" },
  { angle = "60 deg" },
  { angle = "90 deg", lift = "-100 mm" },
]
[axes.Z.gearbox]
ratio = 2
efficiency = 0.85
per_turn = "10 mm"
[axes.Z.motor]
inertia = "0.9 kg cm^2"
continuous = { speed = "0, 6000 rpm", torque = "2.4, 1.2 N m" }
peak = { speed = "0, 6000 rpm", torque = "7.1, 3 N m" }
[loads]
weight = { kind = "gravity", direction = "180 deg" }
friction = { kind = "dry", on = "S", force = "30 N" }
"""

# A carriage on a guide through the trunnion, pushed by the rod.
CYLINDER = """
format = 1
name = "Carriage by a cylinder"
[mechanism.joints]
S = { x = "0.4 m", y = "0 m", guide = { angle = "0 deg" } }
[mechanism.cylinders.Z]
start = "O"
end = "S"
start_length = "0.4 m"
[bodies]
S = { mass = "20 kg" }
"""

DRIVER = """
format = 1
name = "Carriage by a screw"
[mechanism.linear_drivers.S]
start = "0.4 m"
[bodies]
S = { mass = "20 kg" }
"""


def both(law: str = "cycloidal") -> tuple[lw.Machine, lw.Machine]:
    entries = MOTOR.replace("LAW", law)
    screw = entries.replace("[axes.Z]", '[axes.Z]\ndriver = "S"')
    return lw.loads(CYLINDER + entries), lw.loads(DRIVER + screw)


def test_a_cylinder_asks_of_its_motor_what_a_linear_driver_does() -> None:
    """Motion, force, mass and motor of an electric cylinder are those of a screw along the same line."""
    one, other = (lw.servo_axis(machine) for machine in both())
    assert not one.turns
    assert one.unit_of("torque") == "N"
    assert one.inertia_mean == pytest.approx(20, rel=1e-9)
    for name in ("position", "velocity", "acceleration", "torque"):
        size = np.abs(getattr(other, name)).max()
        assert getattr(one, name) == pytest.approx(getattr(other, name), abs=1e-9 * size), name
    for name in ("torque_rms", "torque_peak", "speed_peak", "energy_regenerated", "inertia_ratio"):
        assert getattr(one.motor, name) == pytest.approx(getattr(other.motor, name), rel=1e-8), name
    # Newton: inertia, weight and friction; where the carriage rests, friction is zero.
    moves = np.abs(one.velocity) > 1e-6
    force = 20 * (one.acceleration + 9.81) + 30 * np.sign(one.velocity)
    assert one.torque[moves] == pytest.approx(force[moves], rel=1e-9)


def test_a_cylinder_of_an_axis_stands_in_the_timing_diagram() -> None:
    """Its track has the length, 0.4 m to 0.5 m."""
    (track,) = lw.timing(both()[0])
    assert (track.name, track.unit_of("position")) == ("Z", "m")
    assert (track.position.min(), track.position.max()) == pytest.approx((0.4, 0.5))


def test_jumps_of_its_law_are_warned_of_and_met_by_samples() -> None:
    """A parabolic law jumps at both ends of its section and amid it, and the root mean square is exact."""
    one, other = both("parabolic")
    jumps = [text for text in lw.study(one).warnings if "acceleration of the law of Z jumps" in text]
    assert len(jumps) == 3
    assert lw.servo_axis(one).torque_rms == pytest.approx(lw.servo_axis(other).torque_rms, rel=1e-10)


def test_the_rod_of_a_cylinder_returns() -> None:
    text = (CYLINDER + MOTOR.replace("LAW", "cycloidal")).replace('lift = "-100 mm"', 'lift = "-80 mm"')
    with pytest.raises(lw.MachineError, match="expected: nothing for a cylinder"):
        lw.loads(text.replace('phase = "30 deg"', 'phase = "30 deg"\ntravel = "20 mm"'))
