"""Derivatives of run-up and run-down: closed forms and jumps."""

from __future__ import annotations

import numpy as np
import pytest

import linkwright as lw
from linkwright import steady_state
from linkwright.drive import accurate_run_up
from linkwright.machine import exchanged

# A crank with a DC motor on its shaft against constant friction: the speed is ω₀ (1 − exp(−t/τ)) with
# ω₀ = ω_n (1 − M/M_s) and τ = J ω_n/M_s; without the motor it falls by (M + B)/J.
PLAIN = """
format = 1
name = "Disc"
[drive.motor]
kind = "dc"
speed_no_load = "20 rad/s"
torque_stall = "100 N m"
[drive.brake]
torque = "30 N m"
[mechanism.cranks.A]
radius = "0.1 m"
[bodies]
A = { inertia = "5 kg m^2" }
[loads]
friction = { kind = "dry", on = "A", torque = "10 N m" }
[run_up]
settled = 0.01
"""

J, NO_LOAD, STALL, FRICTION, BRAKE, SETTLED = 5.0, 20.0, 100.0, 10.0, 30.0, 0.01
ENTRIES = (
    *("bodies.A.inertia", "drive.motor.speed_no_load", "drive.motor.torque_stall"),
    *("loads.friction.torque", "drive.brake.torque", "run_up.settled"),
)


def _of(response: str) -> np.ndarray:
    found = lw.gradient(lw.loads(PLAIN), [response], ENTRIES)
    return np.array([found.of(response)[entry] for entry in ENTRIES])


def test_run_down_of_a_disc() -> None:
    speed, resisting = NO_LOAD * (1 - FRICTION / STALL), FRICTION + BRAKE
    by_speed = J / resisting
    wanted = [
        speed / resisting,
        by_speed * (1 - FRICTION / STALL),
        by_speed * NO_LOAD * FRICTION / STALL**2,
        -by_speed * NO_LOAD / STALL - J * speed / resisting**2,
        -J * speed / resisting**2,
        0.0,
    ]
    # What steps of a relative accuracy of 1e-11 leave.
    np.testing.assert_allclose(_of("run_down.time"), wanted, rtol=1e-9, atol=1e-12)
    # The disc turns by ½ ω₀ T.
    turns = _of("run_down.turns") * 4 * np.pi
    time = J * speed / resisting
    by_entry = np.array(
        [0.0, 1 - FRICTION / STALL, NO_LOAD * FRICTION / STALL**2, -NO_LOAD / STALL, 0.0, 0.0]
    )
    np.testing.assert_allclose(turns, by_entry * time + speed * np.array(wanted), rtol=1e-9, atol=1e-11)


def test_run_up_of_a_disc() -> None:
    tau, wait = J * NO_LOAD / STALL, -np.log(SETTLED)
    wanted = [wait * tau / J, wait * tau / NO_LOAD, -wait * tau / STALL, 0.0, 0.0, -tau / SETTLED]
    np.testing.assert_allclose(_of("run_up.time"), wanted, rtol=1e-8, atol=1e-9)
    speed = NO_LOAD * (1 - FRICTION / STALL)
    by_speed = np.array([0.0, speed / NO_LOAD, NO_LOAD * FRICTION / STALL**2, -NO_LOAD / STALL, 0.0, 0.0])
    peak = (1 - SETTLED) * by_speed - speed * np.eye(6)[5]
    np.testing.assert_allclose(_of("run_up.speed_peak"), peak, rtol=1e-8, atol=1e-9)
    # φ = ω₀ (T − τ (1 − s))
    length = tau * (wait - (1 - SETTLED))
    turned = by_speed * length + speed * np.array(wanted)
    turned -= speed * (1 - SETTLED) * np.array([tau / J, tau / NO_LOAD, -tau / STALL, 0.0, 0.0, 0.0])
    turned += speed * tau * np.eye(6)[5]
    np.testing.assert_allclose(2 * np.pi * _of("run_up.turns"), turned, rtol=1e-8, atol=1e-8)


def test_a_load_that_jumps_on_the_way() -> None:
    """Below ω_j the load is smaller by D: T = τ [ln(ω_a/(ω_a − ω_j)) + ln((ω_0 − ω_j)/(s ω_0))]."""
    jump = '\njump = { kind = "formula", on = "A", torque = "-where(omega > 8, 40, 0)" }\n[run_up]'
    machine = lw.loads(PLAIN.replace("\n[run_up]", jump))
    found = lw.gradient(
        machine, ["run_up.time", "run_up.turns"], ["bodies.A.inertia", "drive.motor.torque_stall"]
    )

    def time(inertia: float, stall: float) -> float:
        tau = inertia * NO_LOAD / stall
        first, last = (NO_LOAD * (1 - load / stall) for load in (FRICTION, FRICTION + 40.0))
        return float(tau * (np.log(first / (first - 8.0)) + np.log((last - 8.0) / (SETTLED * last))))

    h = 1e-4
    by_inertia = time(J, STALL) / J
    by_stall = (
        8 * (time(J, STALL + h) - time(J, STALL - h)) - time(J, STALL + 2 * h) + time(J, STALL - 2 * h)
    ) / (12 * h)
    values = found.of("run_up.time")
    assert values["bodies.A.inertia"] == pytest.approx(by_inertia, rel=1e-8)
    # Differences of a closed form: rounding over the step.
    assert values["drive.motor.torque_stall"] == pytest.approx(by_stall, rel=1e-7)


# A motor that is far too strong: it is at its speed within 1e-4 rad, and passes its breakdown speed before.
AT_ONCE = """format = 1
name = "At once"
[drive]
gearbox = { ratio = 40, efficiency = 0.7 }
[drive.motor]
kind = "induction"
inertia = 0.0001643
speed_synchronous = 6.645327
speed_rated = 6.586107
torque_rated = 3.4025663
torque_breakdown = 8.0708923
torque_start = 4.4166437
[mechanism]
points.P0.y = -0.8557
cranks.A = { radius = 0.42917, phase = 2.12644 }
slotted_levers.L0 = { pin = "A", pivot = "P0", length = 0.466294 }
[bodies]
A.mass = 28.174
[run_up]
angle_start = 0.999293
"""


@pytest.mark.parametrize("address", ["bodies.A.mass", "drive.motor.speed_breakdown"])
def test_a_run_up_within_no_angle_has_the_derivatives_of_any(address: str) -> None:
    machine, step = lw.loads(AT_ONCE), 1e-5
    found = lw.gradient(machine, ["run_up.time"], variables=[address])
    at = lw.get(machine, address)
    beside = [exchanged(machine, {address: at * (1 + n * step)}) for n in (-1, 1)]
    steady = [steady_state(nearby, accuracy=1e-13) for nearby in beside]
    times = [accurate_run_up(*pair, 1e-13).time for pair in zip(beside, steady, strict=True)]
    difference = (times[1] - times[0]) / (2 * step * at)
    # The motion is known to 1e-12 of its time: 1e-7 of what the step changes.
    assert abs(found.derivatives[0, 0] - difference) < 3e-7 * abs(difference)


def test_a_run_down_that_starts_on_a_joint_of_a_cam_starts_where_it_did() -> None:
    """At 0 deg, where the law begins: by the phase of the cam the joint moves, and the start does not."""
    machine, phase, step = lw.read("roller_cam"), "mechanism.cams.cart.phase", 1e-5
    names = ["time", "turns", "angle_end"]
    found = lw.gradient(machine, [f"run_down.{name}" for name in names], [phase])
    at = lw.get(machine, phase)
    ahead, behind = (lw.run_down(lw.replace(machine, {phase: at + side * step})) for side in (1, -1))
    wanted = [(getattr(ahead, name) - getattr(behind, name)) / (2 * step) for name in names]
    # Run-downs are computed to 1e-9, which the step divides.
    assert found.derivatives[:, 0] == pytest.approx(wanted, rel=3e-4)
