"""A self-locking gearbox, `reverse = 0`: no load drives the motor through it."""

from __future__ import annotations

import numpy as np
import pytest

import linkwright as lw
from linkwright import MachineError, StartError, SteadyStateError, loads
from linkwright.drive import End
from linkwright.drive.warnings import drive_warnings

HOIST = """
format = 1
name = "Weight on a worm"
[drive.motor]
kind = "dc"
torque_stall = "{stall} N m"
speed_no_load = "100 rad/s"
inertia = "0.001 kg m^2"
[drive.gearbox]
ratio = 10
efficiency = 0.5
reverse = {reverse}
[drive.flywheel]
inertia = "1 kg m^2"
[drive.brake]
torque = "1 N m"
[mechanism.cranks.A]
radius = "0.5 m"
[bodies]
A = {{ mass = "{mass} kg" }}
[loads.weight]
kind = "gravity"
[loads.friction]
kind = "dry"
on = "A"
force = "4 N"
[run_up]
angle_start = "{start} deg"
"""


def hoist(reverse: object = 0, stall: float = 40, mass: float = 10, start: float = 0) -> lw.Machine:
    return loads(HOIST.format(reverse=reverse, stall=stall, mass=mass, start=start))


def test_the_load_does_not_drive_the_motor() -> None:
    """While the weight goes down the crank keeps the motor's no-load speed, and the motor has no torque."""
    locked, geared = lw.steady_state(hoist()), lw.steady_state(hoist(reverse=2))
    assert geared.speed_max > 10.2
    assert locked.speed_max == pytest.approx(10.0, rel=1e-5)
    assert abs(locked.torque_motor_min) < 1e-4 * locked.torque_motor_max
    # The weight is held by the gearbox: 10 kg amid the crank of 0.5 m, less the friction at its pin.
    assert -locked.torque_drive.min() == pytest.approx(10 * 9.80665 * 0.25 - 4 * 0.5, rel=1e-3)
    (words,) = [text for text in warnings_of(locked) if "self-locking" in text]
    assert f"{-locked.torque_drive.min():.4g} N m at the crank" in words
    assert not [text for text in warnings_of(locked) if "generator" in text]


def warnings_of(steady: lw.SteadyState) -> tuple[str, ...]:
    machine = hoist()
    return drive_warnings(machine, lw.reduction(machine, n=360), steady)


def test_a_weight_does_not_turn_the_crank_back() -> None:
    """Where a weight is too heavy for the motor the gearbox holds it: no start backwards, a stall."""
    geared = lw.transient(hoist(2, stall=5, mass=30), turns=1)
    locked = lw.transient(hoist(0, stall=5, mass=30), turns=1)
    assert (geared.end, locked.end) == (End.STARTS_BACKWARDS, End.DOES_NOT_START)
    geared, locked = (
        lw.transient(hoist(r, stall=5, mass=30), angle=-1.0, speed=1.0, turns=2) for r in (2, 0)
    )
    assert (geared.end, locked.end) == (End.REVERSAL, End.STALL)


def test_with_the_motor_off_nothing_moves_the_crank() -> None:
    """At rest no weight moves the crank; motion is computed where the load slows it all the way."""
    above = np.radians(100)
    assert lw.transient(hoist(2), angle=above, turns=0.1, motor=False).turns > 0
    with pytest.raises(StartError, match=r"drive\.gearbox\.reverse = 0.*no load moves the crank"):
        lw.transient(hoist(), angle=above, turns=0.1, motor=False)
    with pytest.raises(SteadyStateError, match="the load or the changing inertia would drive the motor"):
        lw.transient(hoist(), angle=above, speed=5.0, turns=0.2, motor=False)
    rising = {"angle": -1.0, "speed": 2.0, "turns": 0.5, "motor": False}
    locked, geared = lw.transient(hoist(), **rising), lw.transient(hoist(2), **rising)
    assert locked.end == End.STALL
    assert np.array_equal(locked.time, geared.time)


def test_other_signs_are_refused() -> None:
    with pytest.raises(MachineError, match="0 for a self-locking gearbox"):
        hoist(reverse=-0.5)
