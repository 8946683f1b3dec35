"""Motion in time of drivelines with backlash and torque curves, and of trains with mechanisms."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from loose_drives import loose_cycle, random_loose_drive
from mounted_trains import DISCS, SHAFTS, cycle, random_train
from sizes import random_cases
from test_mounted_trains import line_shaft, one_press

import linkwright as lw
from linkwright.machine.write import dumps


def _distinct(motion: lw.ElasticTransient) -> list[int]:
    """Stations of different masses, from the motor on."""
    referred = motion.speed / motion.ratio[:, None]
    return [
        0,
        *(k for k in range(1, len(referred)) if np.abs(referred[k] - referred[k - 1]).max() > 1e-12),
    ]


def test_random_loose_drives_turn_once_as_equations_written_down_here() -> None:
    """State, time, torques and heat of a revolution across flanks and points of curves."""
    met = 0
    for number, rng in random_cases(4821, 3, 60):
        loose = random_loose_drive(rng)
        n = len(loose.drive.inertia)
        omega = lw.elastic_motion(loose.drive.machine, n=8).speed_mean_time
        # From 20° before φ = 0, where twists and slips are no longer zero.
        lead = np.radians(20.0)
        begun = lw.elastic_transient(
            loose.machine, angle=-lead, speed=omega, turns=lead / (2 * np.pi), accuracy=1e-11
        )
        motion = lw.elastic_transient(loose.machine, start=begun, turns=1, accuracy=1e-11)
        at = _distinct(motion)
        states = np.concatenate(
            [motion.twist / loose.drive.ratio[:, None], (motion.speed / motion.ratio[:, None])[at]]
        )
        expected, end = loose_cycle(loose, states[:, 0]), states[:, -1]
        size = np.concatenate([np.abs(motion.twist).max(axis=1) / loose.drive.ratio, np.full(n, omega)])
        assert np.abs((end - expected.end) / size).max() < 1e-7, number
        assert motion.duration == pytest.approx(expected.period, rel=1e-8), number
        torque = expected.torque / loose.drive.ratio[:, None]
        largest = np.abs(torque).max(axis=1)
        assert np.abs((motion.torque_max - torque[:, 1]) / largest).max() < 1e-6, number
        assert np.abs((motion.torque_min - torque[:, 0]) / largest).max() < 1e-6, number
        assert motion.energy_dissipated == pytest.approx(expected.loss, abs=1e-7 * motion.energy_motor), (
            number
        )
        assert motion.energy_error <= 1e-9, number
        met += any(law.gap > 0 for law in loose.laws)
    assert met > 0


def test_a_rattling_motion_goes_on_in_time() -> None:
    """From the steady motion of parting teeth a cycle repeats its extremes; T is zero in the gap."""
    machine = lw.read("rattling_backlash")
    steady = lw.elastic_motion(machine, accuracy=1e-11)
    motion = lw.elastic_transient(machine, start=steady, turns=steady.turns, accuracy=1e-11)
    assert motion.torque_max == pytest.approx(steady.torque_max, rel=1e-7)
    assert motion.torque_min == pytest.approx(steady.torque_min, rel=1e-7, abs=1e-7 * steady.torque_max.max())
    assert motion.duration == pytest.approx(steady.period, rel=1e-9)
    loose = np.abs(motion.twist) < 0.4999 * steady.backlash[:, None]
    assert loose.any()
    assert np.all(motion.torque[loose] == 0.0)


def test_random_trains_turn_as_equations_written_down_here() -> None:
    """Two motors and two cranks at ratios of 1, 2 and ½: a cycle from even speeds, to 1e-7."""
    for n, (number, rng) in enumerate(random_cases(4822, 2, 60)):
        train = random_train(rng, (1.0, 2.0, 0.5)[n % 3])
        steady = lw.elastic_motion(train.machine, angles=np.zeros(1))
        motion = lw.elastic_transient(
            train.machine, speed=steady.speed_mean_time, turns=train.turns, accuracy=1e-11
        )
        discs = [motion.stations.index(name) for name in DISCS]
        shafts = [motion.shafts.index(name) for name in SHAFTS]
        start = np.concatenate([motion.twist[shafts, 0], motion.speed[discs, 0]])
        expected = cycle(train, start, 1e-4 * np.maximum(np.abs(start), 1e-3))
        end = np.concatenate([motion.twist[shafts, -1], motion.speed[discs, -1]])
        size = np.concatenate([np.abs(motion.twist[shafts]).max(axis=1), motion.speed[discs, 0]])
        assert np.abs((end - expected.end) / size).max() < 1e-7, number
        assert motion.duration == pytest.approx(expected.period, rel=1e-8), number
        assert motion.torque_max[shafts] == pytest.approx(expected.torque[:, 1], rel=1e-6), number
        assert motion.energy_error <= 1e-9, number


def test_a_driveline_starts_the_same_as_drive_and_as_train() -> None:
    """Motor, elastic coupling and press from rest: states, peaks and works agree."""
    times = np.linspace(0, 1.0, 11)
    one, other = (
        lw.elastic_transient(one_press(as_train=is_train), angle=1.0, duration=1.0, times=times)
        for is_train in (False, True)
    )
    assert other.crank_angle == pytest.approx(one.crank_angle, rel=1e-9)
    assert other.torque_max == pytest.approx(one.torque_max, rel=1e-8)
    assert other.energy_motor == pytest.approx(one.energy_motor, rel=1e-8)
    assert other.heat_motor == pytest.approx(one.heat_motor, rel=1e-8)


def test_the_run_up_of_a_train_ends_in_its_steady_motion(tmp_path: Path) -> None:
    """Two presses on a line shaft settle; their peak torque at the start exceeds that of steady motion."""
    machine = line_shaft(tmp_path)
    run_up = lw.elastic_run_up(machine)
    steady = lw.elastic_motion(machine)
    assert run_up.torque_steady == pytest.approx(steady.torque_peak, rel=1e-6)
    assert np.all(run_up.torque_peak >= steady.torque_peak * (1 - 1e-6))
    late = lw.elastic_transient(machine, turns=40, accuracy=1e-11)
    angle = late.state_end[-1] % (2 * np.pi)
    at = lw.elastic_motion(machine, accuracy=1e-11, angles=np.array([angle]))
    assert late.speed[:, -1] == pytest.approx(at.speed[:, 0], rel=1e-8)


def test_dry_friction_of_both_presses_holds_a_train_at_rest(tmp_path: Path) -> None:
    """Switched off, it comes to rest with a shaft wound up by no more than the friction of each press."""
    text = dumps(line_shaft(tmp_path))
    for k in (1, 2):
        text += f'\n[train.mechanisms.press{k}.machine.loads.dry]\nkind = "dry"\non = "S"\nforce = "200 N"\n'
    machine = lw.loads(text)
    stopped = lw.elastic_transient(machine, speed=20.0, duration=100.0, motor=False)
    assert stopped.came_to_rest
    # The friction of a press is at most F r at its crank, about.
    assert np.all(np.abs(stopped.torque[:, -1]) <= 200.0 * 0.21)
    assert stopped.energy_motor == 0.0
    assert stopped.energy_error <= 1e-9


def test_a_train_whose_motor_keeps_its_speed_has_no_motion_in_time(tmp_path: Path) -> None:
    """The motor is named."""
    motor = {"kind": "constant_speed", "speed": 20.0}
    machine = lw.replace(line_shaft(tmp_path), {"train.motors.motor.motor": motor})
    with pytest.raises(lw.InputError, match=r"train\.motors\.motor\.motor\.kind: found constant_speed"):
        lw.elastic_transient(machine, duration=1.0)
