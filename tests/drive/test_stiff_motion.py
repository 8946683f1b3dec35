"""Motion in time where the drive holds its speed fast, against SciPy's Radau on its own equations."""

from __future__ import annotations

import re
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from found_machines import found_machine
from scipy.integrate import solve_ivp

import linkwright as lw
from linkwright.drive.tables_in_time import methods_sentence
from linkwright.machine import exchanged

MACHINES = Path(__file__).parents[2] / "machines"

# A DC motor on a flywheel under loads over the angle and over both angle and speed.
INERTIA, NO_LOAD, LIFT, DRAG = 1.9, 12.0, 59.0, 60.0


def flywheel(stall: float) -> lw.Machine:
    return lw.loads(f"""
    format = 1
    name = "flywheel on a steep motor"
    [drive.motor]
    kind = "dc"
    speed_no_load = {NO_LOAD}
    torque_stall = {stall}
    [drive.flywheel]
    inertia = {INERTIA}
    [mechanism.cranks.A]
    radius = 0.2
    [loads]
    lift = {{ kind = "formula", on = "A", torque = "-{LIFT} * cos(phi)" }}
    oil = {{ kind = "formula", on = "A", torque = "-{DRAG} * (1 + sin(phi)^2) * omega^2 / 10" }}
    """)


def own_motion(stall: float, times: np.ndarray) -> np.ndarray:

    def rate(_t: float, y: np.ndarray) -> list[float]:
        phi, omega = y
        torque = stall * (1 - omega / NO_LOAD) - LIFT * np.cos(phi)
        return [omega, (torque - DRAG * (1 + np.sin(phi) ** 2) * omega**2 / 10) / INERTIA]

    def jacobian(_t: float, y: np.ndarray) -> list[list[float]]:
        phi, omega = y
        by_angle = LIFT * np.sin(phi) - DRAG * np.sin(2 * phi) * omega**2 / 10
        by_speed = -stall / NO_LOAD - DRAG * (1 + np.sin(phi) ** 2) * omega / 5
        return [[0.0, 1.0], [by_angle / INERTIA, by_speed / INERTIA]]

    found = solve_ivp(
        rate, (0, times[-1]), [0.0, 0.0], "Radau", times, jac=jacobian, rtol=1e-11, atol=1e-12, max_step=0.02
    )
    return np.asarray(found.y)


@pytest.mark.parametrize("stall", [1e4, 1e6, 1e8])
def test_a_steep_motor_against_radau(stall: float) -> None:
    path = lw.transient(flywheel(stall), duration=2.0, accuracy=1e-9)
    times = np.linspace(0.0, 2.0, 101)
    angle, speed = own_motion(stall, times)
    found = path.at(times)
    # SciPy's Radau is of order 5 and keeps 1e-11 a step, over hundreds of steps.
    np.testing.assert_allclose(found[1], speed, rtol=0, atol=3e-8 * NO_LOAD)
    np.testing.assert_allclose(found[0], angle, rtol=0, atol=3e-8 * angle[-1])
    # Four revolutions; by an explicit method at 1e8 a million steps.
    assert len(path.time) < 1500
    check_parts(path, is_stiff=stall > 1e5)


def check_parts(path: lw.Transient, *, is_stiff: bool) -> None:
    """The parts tile the motion, are of the methods of their steps, and take turns."""
    assert path.implicit.shape == (path.steps,)
    assert path.implicit.any() == is_stiff
    parts = path.methods
    assert sum(each.steps for each in parts) == path.steps
    assert [each.time_start for each in parts] == [0.0, *(each.time_end for each in parts[:-1])]
    assert parts[-1].time_end == path.time[-1]
    for one, other in pairwise(parts):
        assert {one.method, other.method} == {"explicit", "implicit"}
    inside = [
        path.implicit[(path.time[:-1] >= each.time_start) & (path.time[1:] <= each.time_end)]
        for each in parts
    ]
    assert [{"explicit": False, "implicit": True}[each.method] for each in parts] == [
        bool(all(of)) for of in inside
    ]
    assert path.to_dict()["methods"][0]["method"] == parts[0].method


@pytest.mark.parametrize(
    ("entry", "value"),
    [
        ("drive.motor.torque_breakdown", 2.154e6),
        ("drive.gearbox.efficiency", 9000.0),
        ("drive.gearbox.ratio", 98000),
    ],
)
def test_a_run_up_at_the_end_of_a_range_takes_few_steps(entry: str, value: float) -> None:
    """381 554, 381 545 and 316 983 steps by an explicit method."""
    machine = lw.read(MACHINES / "roller_one_cart.toml")
    # An efficiency of 9000 is none; the core takes it all the same.
    machine = exchanged(machine, {entry: value})
    result = lw.run_up(machine)
    assert len(result.crank_time) < 3000
    # It settles at the steady motion, which another solver finds.
    steady = lw.steady_state(machine)
    last = float(result.motion.speed[-1])
    there = np.interp(result.motion.crank_angle[-1] % (2 * np.pi), steady.crank_angle, steady.speed)
    assert last == pytest.approx(there, rel=1e-6)


@pytest.mark.parametrize("accuracy", [1e-5, 1e-6, 1e-7, 1e-9])
@pytest.mark.parametrize("ratio", [1e6, 1e9])
def test_the_implicit_method_goes_on_until_disturbances_have_died(accuracy: float, ratio: float) -> None:
    """What the last explicit step left calls for short steps, which are no reason to go back to it."""
    machine = lw.replace(lw.read(MACHINES / "roller_two_carts.toml"), {"drive.gearbox.ratio": ratio})
    found = lw.transient(machine, turns=0.01, accuracy=accuracy)
    assert [part.method for part in found.methods] == ["explicit", "implicit"]
    assert found.steps < 100


@pytest.mark.parametrize("stall", [1e4, 1e6])
def test_a_motion_ends_at_any_time(stall: float) -> None:
    """The halves of implicit steps add up to the duration but for rounding, which is not time left."""
    machine = flywheel(stall)
    for duration in np.linspace(0.1, 0.5, 25):
        motion = lw.transient(machine, speed=10.0, duration=float(duration))
        assert motion.time[-1] == duration
        assert motion.steps < 400


def test_json_and_report_tell_the_methods() -> None:
    machine = lw.replace(lw.read(MACHINES / "roller_one_cart.toml"), {"drive.gearbox.ratio": 98000})
    result = lw.run_up(machine)
    parts = result.to_dict()["methods"]
    assert [each["method"] for each in parts] == ["explicit", "implicit"]
    assert sum(each["steps"] for each in parts) == result.motion.steps
    told = methods_sentence(result.motion)
    assert "Radau IIA" in told
    assert sum(int(each) for each in re.findall(r"(\d+) steps", told)) == result.motion.steps


@pytest.mark.parametrize("stall", [1e2, 1e3, 1e4, 1e5, 1e6])
def test_a_load_that_jumps_over_time_acts_from_its_instant_on(stall: float) -> None:
    """J ω̇ = M₀ (1 − ω/ω₀) − L from t₁ on: ω/ω₀ = 1 − L/M₀ (1 − e^(−kτ)), wherever t₁ lies in a step."""
    steepness = stall / (INERTIA * NO_LOAD)
    for jump in np.linspace(0.003, 1.95, 40):
        machine = lw.loads(f"""
        format = 1
        name = "flywheel under a load that begins"
        drive.motor = {{ kind = "dc", speed_no_load = {NO_LOAD}, torque_stall = {stall} }}
        drive.flywheel.inertia = {INERTIA}
        mechanism.cranks.A.radius = 0.2
        loads.lift = {{ kind = "formula", on = "A", torque = "-where(t > {float(jump)!r}, {LIFT}, 0)" }}
        """)
        motion = lw.transient(machine, speed=NO_LOAD, duration=2.0, accuracy=1e-9)
        passed = 2.0 - jump
        lost = NO_LOAD * LIFT / stall
        grown = 1.0 - np.exp(-steepness * passed)
        assert motion.speed[-1] == pytest.approx(NO_LOAD - lost * grown, rel=1e-8)
        turned = NO_LOAD * 2.0 - lost * (passed - grown / steepness)
        assert motion.crank_angle[-1] == pytest.approx(turned, rel=1e-8)


def test_time_runs_on_over_steps_of_no_length() -> None:
    """Where rounding lets two ends of steps fall on each other, the time between the steps is not shifted."""
    steady = lw.steady_state(found_machine("slow_crank"), accuracy=1e-8)
    assert steady.time[-1] == pytest.approx(steady.period, rel=1e-12)
    # The speed is even to 1e-6, so that time is angle over speed.
    assert steady.time == pytest.approx(steady.crank_angle / steady.speed.mean(), rel=2e-6)
