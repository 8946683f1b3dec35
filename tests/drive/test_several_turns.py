"""Loads and mechanisms that repeat after several revolutions: steady motion over their cycle."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import linkwright as lw
from linkwright import AssemblyError, MachineError

FOUR_PI = 4 * np.pi


def machine(loads: dict[str, Any], **more: Any) -> lw.Machine:
    tables: dict[str, Any] = {
        "format": 1,
        "name": "shaft",
        "drive": {
            "speed": 20.0,
            "motor": {"kind": "dc", "speed_no_load": 40.0, "torque_stall": 80.0},
            "flywheel": {"inertia": 0.4},
        },
        "mechanism": {"cranks": {"A": {"radius": 0.1}}},
        "loads": loads,
    }
    return lw.Machine.model_validate(tables | more)


# Six points over two revolutions, one of them beyond the first.
TABLE = {
    "kind": "torque_angle",
    "cycle": "720 deg",
    "angle": "30, 100, 200, 380, 500, 650 deg",
    "torque": [10.0, 60.0, 5.0, 20.0, 90.0, 15.0],
}


def torque(phi: np.ndarray) -> np.ndarray:
    angles = np.radians([30, 100, 200, 380, 500, 650])
    return np.interp(phi, angles, [10.0, 60.0, 5.0, 20.0, 90.0, 15.0], period=FOUR_PI)


def integrated(resist: Any, cycle: float, kinks: np.ndarray) -> Any:
    """u = ½ω² over the angle by SciPy, cycle after cycle from kink to kink until it repeats."""
    u, ends = 0.5 * 20.0**2, np.unique(np.concatenate([[0.0], kinks, [cycle]]))

    def slope(phi: float, u: np.ndarray) -> np.ndarray:
        omega = np.sqrt(2 * u)
        return (80.0 * (1 - omega / 40.0) - resist(phi)) / 0.4

    for _ in range(60):
        start, pieces = u, []
        for low, high in pairwise(ends):
            piece = solve_ivp(
                slope, (low, high), [u], method="DOP853", rtol=1e-11, atol=1e-11, dense_output=True
            )
            pieces.append(piece)
            u = float(piece.y[0, -1])
        if abs(u / start - 1) < 1e-13:
            break
    return pieces


def test_torque_over_two_revolutions_against_an_independent_integration() -> None:
    steady = lw.steady_state(machine({"T": TABLE}))
    assert steady.turns == 2
    assert steady.crank_angle[-1] == pytest.approx(FOUR_PI, rel=1e-15)
    pieces = integrated(torque, FOUR_PI, np.radians([30, 100, 200, 380, 500, 650]))
    speed = np.concatenate(
        [
            np.sqrt(2 * piece.sol(steady.crank_angle[inside])[0])
            for piece in pieces
            if (inside := (steady.crank_angle >= piece.t[0]) & (steady.crank_angle < piece.t[-1])).any()
        ]
    )
    # SciPy's 1e-11 a step, over some hundred steps.
    assert np.abs(steady.speed[: len(speed)] / speed - 1).max() < 1e-8
    assert steady.speed[0] == pytest.approx(steady.speed[-1], rel=1e-10)
    # The balance of work, per revolution.
    angles = np.radians([30, 100, 200, 380, 500, 650, 750])
    work = np.trapezoid(torque(angles), angles)
    assert steady.energy_load == pytest.approx(work / 2, rel=1e-10)
    assert steady.energy_drive == pytest.approx(work / 2, rel=1e-9)
    assert steady.power_motor_mean == pytest.approx(work / steady.period, rel=1e-9)
    assert steady.speed_mean_time == pytest.approx(FOUR_PI / steady.period, rel=1e-14)


def test_a_torque_given_over_one_revolution_or_twice_over_two_is_the_same() -> None:
    once = {"kind": "torque_angle", "angle": "0, 90, 250 deg", "torque": [10.0, 70.0, 20.0]}
    twice = {
        "kind": "torque_angle",
        "cycle": "720 deg",
        "angle": "0, 90, 250, 360, 450, 610 deg",
        "torque": [10.0, 70.0, 20.0] * 2,
    }
    one, two = (lw.steady_state(machine({"T": load}), n=90) for load in (once, twice))
    assert (one.turns, two.turns) == (1, 2)
    assert two.unevenness == pytest.approx(one.unevenness, rel=1e-9)
    assert two.period == pytest.approx(2 * one.period, rel=1e-9)
    assert two.energy_load == pytest.approx(one.energy_load, rel=1e-9)
    assert two.power_motor_mean == pytest.approx(one.power_motor_mean, rel=1e-9)
    assert two.multiplier == pytest.approx(one.multiplier**2, rel=1e-8)
    assert two.speed[:91] == pytest.approx(two.speed[90:], rel=1e-9)
    assert two.torque_motor_rms == pytest.approx(one.torque_motor_rms, rel=1e-9)


def test_a_force_over_the_angle_is_that_of_a_formula() -> None:
    """A triangle over two revolutions on a slide: as a table, and by a formula whose phi runs to 4π."""
    mechanism = {"cranks": {"A": {"radius": 0.1}}, "sliders": {"ram": {"crank": "A", "rod": 0.4}}}
    bodies = {"ram": {"mass": 5.0}}
    table = {
        "kind": "force_angle",
        "on": "ram",
        "cycle": "720 deg",
        "angle": "0, 360, 720 deg",
        "force": [0.0, -500.0, 0.0],
    }
    formula = {
        "kind": "formula",
        "on": "ram",
        "cycle": "720 deg",
        "force": "-500*(1 - abs(phi/(2*pi) - 1))",
    }
    by_table, by_formula = (
        lw.steady_state(machine({"F": load}, mechanism=mechanism, bodies=bodies)) for load in (table, formula)
    )
    assert by_table.turns == by_formula.turns == 2
    assert by_table.speed == pytest.approx(by_formula.speed, rel=1e-9)
    # Joint forces take the same torque from the crank as the reduction does.
    loaded = machine({"F": table}, mechanism=mechanism, bodies=bodies)
    forces = lw.forces(loaded, by_table)
    assert forces.torque_drive == pytest.approx(
        by_table.torque_drive, abs=1e-6 * np.abs(by_table.torque_drive).max()
    )


def test_motion_in_time_settles_on_the_motion_of_two_revolutions() -> None:
    loaded = machine({"T": TABLE})
    steady = lw.steady_state(loaded)
    motion = lw.transient(loaded, speed=20.0, turns=60, accuracy=1e-10)
    late = motion.crank_angle > 2 * np.pi * 50
    within = np.mod(motion.crank_angle[late], FOUR_PI)
    curve = lw.steady_state(loaded, angles=np.unique(within))
    expected = np.interp(within, curve.crank_angle, curve.speed)
    assert motion.speed[late] == pytest.approx(expected, rel=1e-7)
    assert steady.multiplier < 1


def test_many_machines_over_two_revolutions_are_the_single_ones() -> None:
    loaded = machine({"T": TABLE})
    stalls = np.array([70.0, 80.0, 95.0])
    rows = lw.steady_states(loaded, {"drive.motor.torque_stall": stalls})
    assert (rows.turns == 2).all()
    for k, stall in enumerate(stalls):
        one = lw.steady_state(lw.replace(loaded, {"drive.motor.torque_stall": stall}))
        for name in ("speed_min", "speed_max", "period", "energy_load", "speed_mean_time"):
            assert getattr(rows, name)[k] == pytest.approx(getattr(one, name), rel=1e-6), name


def test_derivatives_over_two_revolutions_are_those_of_differences() -> None:
    loaded, address, step = machine({"T": TABLE}), "drive.flywheel.inertia", 1e-4
    found = lw.gradient(loaded, ["steady_state.unevenness", "steady_state.energy_load"], [address])
    sides = [lw.steady_state(lw.replace(loaded, {address: 0.4 + s})) for s in (-step, step)]
    slope = (sides[1].unevenness - sides[0].unevenness) / (2 * step)
    # Central differences lose (step/J)².
    assert found.derivatives[0, 0] == pytest.approx(slope, rel=1e-5)
    # The work that the load takes does not depend on the flywheel.
    assert abs(found.derivatives[1, 0]) < 1e-6


def test_a_mechanism_that_repeats_after_two_revolutions_has_a_cycle_of_two() -> None:
    """A second crank, geared to half the speed, carries the only mass: g r cos of half the angle."""
    mechanism = {
        "points": {"O2": {"x": 0.5, "y": 0.0}},
        "cranks": {"A": {"radius": 0.1}},
        "gears": {"B": {"pivot": "O2", "meshes": "A", "size": 40, "size_other": 20}},
        "rigid_points": {"W": {"link": "B", "along": 0.2, "across": 0.0}},
    }
    geared = machine(
        {"weight": {"kind": "gravity"}},
        mechanism=mechanism,
        bodies={"W": {"mass": 6.0}},
    )
    steady = lw.steady_state(geared)
    assert steady.turns == 2
    assert steady.speed[0] == pytest.approx(steady.speed[-1], rel=1e-9)
    # Energy: ½ J ω² + the motor's work balance the weight; J is constant here, 0.4 + 6·0.2²/4.
    J = 0.4 + 6 * 0.04 / 4
    drive = 80 * (1 - steady.speed / 40)
    slope = np.gradient(0.5 * J * steady.speed**2, steady.crank_angle)
    inner = slice(2, -2)
    lift = drive[inner] - slope[inner]
    # The weight turns backwards at half the angle, from its own start.
    phase = np.arctan2(
        *reversed(
            np.linalg.lstsq(
                np.stack(
                    [np.cos(steady.crank_angle[inner] / 2), np.sin(steady.crank_angle[inner] / 2)], axis=1
                ),
                lift,
                rcond=None,
            )[0]
        )
    )
    size = 6 * 9.81 * 0.2 / 2
    assert lift == pytest.approx(size * np.cos(steady.crank_angle[inner] / 2 - phase), abs=1e-3 * size)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"cycle": "500 deg"}, "whole revolutions"),
        ({"cycle": "360 deg"}, "angles within one cycle"),
        ({"angle": "0, 100, 200, 380, 500, 720 deg"}, "one cycle before"),
    ],
)
def test_tables_that_do_not_fit_their_cycle_are_refused(change: dict[str, Any], words: str) -> None:
    with pytest.raises(MachineError, match=words):
        machine({"T": TABLE | change})


def test_loads_that_hardly_ever_repeat_together_are_refused() -> None:
    with pytest.raises(MachineError, match="24 revolutions or fewer"):
        machine({"T": TABLE | {"cycle": "1800 deg"}, "U": TABLE | {"cycle": "2520 deg"}})


def test_a_geared_mechanism_that_takes_many_revolutions_is_refused() -> None:
    mechanism = {
        "points": {"O2": {"x": 0.5, "y": 0.0}},
        "cranks": {"A": {"radius": 0.1}},
        "gears": {"B": {"pivot": "O2", "meshes": "A", "size": 31, "size_other": 20}},
        "rigid_points": {"W": {"link": "B", "along": 0.2, "across": 0.0}},
    }
    geared = machine({"weight": {"kind": "gravity"}}, mechanism=mechanism, bodies={"W": {"mass": 6.0}})
    with pytest.raises(AssemblyError, match="only after 31 revolutions"):
        lw.steady_state(geared)
