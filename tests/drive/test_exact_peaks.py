"""Peaks that are exact: no dense look finds more, and one comes as near as its spacing squared."""

from __future__ import annotations

import numpy as np
import pytest
from found_machines import found_machine

import linkwright as lw
from linkwright.drive import constant_energy_of
from linkwright.machine import compile_machine


@pytest.mark.parametrize("name", ["roller_one_cart", "roller_cam", "topper_crank"])
def test_dynamic_factor_at_constant_energy(name: str) -> None:
    machine = lw.read(f"machines/{name}.toml")
    angles = np.linspace(0, 2 * np.pi, 200_001)
    at = compile_machine(machine).reductions(angles)
    slow, fast = np.sqrt(2 / at.inertia.max()), np.sqrt(2 / at.inertia.min())
    dense = np.abs(at.inertia_slope / at.inertia**2).max() / (0.5 * (slow + fast)) ** 2
    found = lw.constant_energy(machine)
    # A look every 3e-5 rad misses a peak by that squared times its curvature.
    assert found.dynamism == pytest.approx(dense, rel=1e-8)
    assert found.dynamism >= dense * (1 - 1e-9)
    assert lw.study(machine).constant_energy == found
    # Of curves alone, by a parabola.
    assert constant_energy_of(lw.reduction(machine, n=1440)).dynamism == pytest.approx(dense, rel=1e-6)


@pytest.mark.parametrize(("name", "peaks"), [("roller_one_cart", 1e-2), ("topper_crank", 1e-4)])
def test_envelopes_of_samples_err_by_what_is_told(name: str, peaks: float) -> None:
    machine = lw.read(f"machines/{name}.toml")
    coarse, fine = (lw.envelope(lw.forces(machine, n=n)) for n in (360, 14_400))
    for a, b in zip(coarse, fine, strict=True):
        assert abs(a.peak) == pytest.approx(abs(b.peak), rel=peaks)
        assert a.rms == pytest.approx(b.rms, rel=2e-4)
        assert a.mean == pytest.approx(b.mean, abs=1e-5 * b.rms)


def test_peak_of_a_run_up() -> None:
    run = lw.run_up(lw.read("machines/roller_two_carts.toml"))
    speeds = run.motion.at(np.linspace(0.0, run.time, 300_001))[1]
    assert run.speed_peak >= speeds.max()
    assert run.speed_peak == pytest.approx(speeds.max(), rel=1e-8)


def test_peak_of_a_motor_in_a_narrow_corner() -> None:
    """A tooth of 40 N m on a straight characteristic, a hundredth of the range of speed wide."""
    made = lw.read("machines/roller_two_carts.toml")
    plain = lw.steady_state(made)
    assert made.drive is not None
    ratio = made.drive.gearbox.ratio
    low, high = (ratio * speed for speed in (plain.speed_min, plain.speed_max))
    # Near the smallest speed, where the straight line has its largest torque in the revolution: 235 N m.
    tip, half = low + 0.05 * (high - low), 0.005 * (high - low)
    speed = np.array([0.0, tip - half, tip, tip + half, 2 * high])
    torque = 215.0 - 265.0 * (speed - low) / (high - low) + [0.0, 0.0, 40.0, 0.0, 0.0]
    motor = {"kind": "table", "speed": speed.tolist(), "torque": torque.tolist(), "inertia": 0.138}
    found = lw.steady_state(lw.replace(made, {"drive.motor": motor}))
    assert ratio * found.speed_min < tip < ratio * found.speed_max
    # The tip is a point of the table: rounding of the speed there counts by the steepness of the tooth.
    assert found.torque_motor_max == pytest.approx(torque[2], rel=1e-12)
    assert found.power_motor_max == pytest.approx(torque[2] * tip, rel=1e-12)


def test_peaks_of_rows_of_like_cranks() -> None:
    """Four like peaks, each beside an end of a step, so that eight steps promise one."""
    machine, entry = lw.read("machines/roller_four_carts.toml"), "drive.motor.speed_synchronous"
    speeds = np.linspace(112.0, 112.1, 6)
    rows = lw.steady_states(machine, {entry: speeds})
    alone = [lw.steady_state(lw.replace(machine, {entry: float(speed)}), n=8) for speed in speeds]
    assert rows.acceleration_max == pytest.approx([each.acceleration_max for each in alone], rel=1e-6)


@pytest.mark.parametrize("accuracy", [1e-6, 1e-9])
def test_curves_between_the_steps_are_as_exact_as_asked_for(accuracy: float) -> None:
    machine = lw.read("machines/roller_two_carts.toml")
    # Some ten angles a step, none of them at its end.
    angles = np.linspace(0.001, 2 * np.pi - 0.001, 400)
    rough, fine = (lw.steady_state(machine, accuracy=a, angles=angles) for a in (accuracy, 1e-13))
    assert rough.steps < fine.steps
    for name in ("time", "speed", "acceleration", "torque_motor", "inertia_reduced"):
        curve, exact = getattr(rough, name), getattr(fine, name)
        assert np.abs(curve - exact).max() <= accuracy * np.abs(exact).max(), name
    for name in ("speed_min", "speed_max", "acceleration_min", "acceleration_max"):
        assert getattr(rough, name) == pytest.approx(getattr(fine, name), rel=accuracy), name


def test_acceleration_has_its_peak_in_a_corner_inside_a_step() -> None:
    """A gearbox changes sides where the drive's torque changes its sign; ends of steps only lie near it.

    The peak is known: at the corner the drive has no torque and the crank turns at the synchronous speed, so
    that the acceleration is that of the load alone.
    """
    made = found_machine("four_bar_that_changes_sides")
    speed = made.drive.motor.speed_synchronous  # type: ignore[union-attr]
    for accuracy in (1e-9, 1e-11):
        found = lw.steady_state(made, accuracy=accuracy)
        near = found.acceleration_max_angle + np.linspace(-1e-6, 1e-6, 2001)
        at = compile_machine(made).reductions(near)
        rolling = -(at.load + 0.5 * at.inertia_slope * speed**2) / at.inertia
        curve = lw.steady_state(made, accuracy=accuracy, angles=near)
        order = np.argsort(curve.speed)
        corner = np.interp(speed, curve.speed[order], near[order])
        assert found.acceleration_max == pytest.approx(np.interp(corner, near, rolling), rel=3 * accuracy)


def test_corners_of_the_acceleration_in_a_batch() -> None:
    """A motor whose characteristic bends from −4 to −89 N m/(rad/s) at a speed that rows pass: their
    acceleration has its maximum in the corner."""
    speed = [0.0, 73.304, 103.149, 115.192]
    motor = {"kind": "table", "speed": speed, "torque": [300.0, 280.0, 170.0, -900.0], "inertia": 0.138}
    machine = lw.replace(lw.read("machines/roller_two_carts.toml"), {"drive.motor": motor})
    masses = np.linspace(700.0, 1400.0, 24)
    batch = lw.steady_states(machine, {"bodies.cart1.mass": masses})
    for row, mass in enumerate(masses):
        alone = lw.steady_state(lw.replace(machine, {"bodies.cart1.mass": mass}), accuracy=1e-11)
        peak = max(-alone.acceleration_min, alone.acceleration_max)
        for name in ("acceleration_min", "acceleration_max"):
            # What a batch promises, of the peak.
            assert abs(getattr(batch, name)[row] - getattr(alone, name)) < 1e-7 * peak, (row, name)


def test_rows_whose_peaks_rounding_forbids_have_a_status() -> None:
    """A drive so steep that the load alone makes the speed: ω = ω₀ (1 − M/M₀), and ε = ω dω/dφ.

    Rounding of the speed, times the steepness, is more and more of the acceleration: a row is as exact as
    promised, or has no numbers.
    """
    machine = lw.loads("""
    format = 1
    name = "steep"
    mechanism.cranks.A.radius = "1 m"
    bodies.A = { on = "A", inertia = 0.3 }
    drive.motor = { kind = "dc", speed_no_load = 36, torque_stall = 1e7, inertia = 0 }
    loads.L = { kind = "formula", on = "A", torque = "-(15 + 7*cos(phi))" }
    """)
    stall = np.logspace(6, 12, 61)
    rows = lw.steady_states(machine, {"drive.motor.torque_stall": stall})
    peak = 36.0**2 * 7.0 / stall
    solved = rows.status == 0
    # Peaks of acceleration count against at least 1e-4 ω², and are promised to 1e-6 of that. The formula
    # neglects twice the load, at most 22 N m, over the stall torque.
    counts = np.maximum(peak, 1e-4 * 36.0**2)
    off = np.abs(rows.acceleration_max - peak)
    assert (off <= 1e-6 * counts + 50.0 * peak / stall)[solved].all()
    assert solved[:10].all()
    assert set(rows.status[~solved]) == {3}
    assert np.isnan(rows.speed_max[~solved]).all()


def test_a_corner_under_a_steep_drive_is_the_same_at_every_accuracy() -> None:
    machine = found_machine("braked_by_its_motor")
    states = [lw.steady_state(machine, accuracy=accuracy) for accuracy in (1e-8, 1e-9, 1e-10, 1e-11, 1e-12)]
    size = max(abs(states[0].acceleration_max), 1e-4 * states[0].speed_max ** 2)
    for state in states:
        assert state.accuracy < 2e-8
        for other in states:
            # Each is off by what it says.
            room = (state.accuracy + other.accuracy) * size
            assert abs(state.acceleration_max - other.acceleration_max) < room
