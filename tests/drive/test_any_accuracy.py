"""One machine, one motion: the accuracy that is asked for does not decide whether there is an answer."""

from __future__ import annotations

import re

import numpy as np
import pytest
from found_machines import found_machine

import linkwright as lw
from linkwright import ConvergenceError


def test_every_accuracy_has_the_motion_and_a_batch_too() -> None:
    machine = found_machine("shaper_with_limited_motor")
    finest = lw.steady_state(machine, accuracy=1e-12).speed_max
    for accuracy in (1e-6, 1e-7, 1e-8, 1e-9, 1e-10):
        assert lw.steady_state(machine, accuracy=accuracy).speed_max == pytest.approx(finest, rel=1e-6)
    rows = lw.steady_states(machine, {"bodies.E.mass": np.full(2, lw.get(machine, "bodies.E.mass"))})
    assert (rows.status == 0).all()
    assert rows.speed_max == pytest.approx(finest, rel=1e-7)


def test_a_peak_within_a_soft_sign_is_the_same_in_a_batch() -> None:
    """To the 1e-6 that batches promise of peaks: read where the series has its top, it was 4.4e-6 low."""
    machine = found_machine("yoke_with_soft_friction")
    alone = lw.steady_state(machine, accuracy=1e-12)
    rows = lw.steady_states(machine, {"bodies.E.mass": np.full(2, lw.get(machine, "bodies.E.mass"))})
    assert rows.acceleration_max == pytest.approx(alone.acceleration_max, rel=1e-6)
    assert rows.acceleration_min == pytest.approx(alone.acceleration_min, rel=1e-6)


# A crank that idles under a motor with a table: it passes the kink of its table, and of the gearbox, where
# the torque changes its sign.
IDLE = """
format = 1
name = "Idling yoke"
[drive.motor]
kind = "table"
speed = [0.0, {low}, {peak}, {idle}, {fast}]
torque = [{torque}, {torque}, {most}, 0.0, {brake}]
inertia = {inertia}
[drive.gearbox]
ratio = 30.0
efficiency = 0.95
[mechanism.cranks.A]
radius = 0.129
[mechanism.yokes.E]
pin = "A"
[bodies]
E = {{ mass = {mass} }}
A = {{ mass = 0.438, inertia = 0.00744 }}
"""


def idling(random: np.random.Generator) -> lw.Machine:
    """One whose motor changes ε by up to 1e6 per rad²/s² of ½ω²."""
    idle, torque = 10 ** random.uniform(1, 2.5), 10 ** random.uniform(1, 5)
    speeds = {"low": 0.7 * idle, "peak": 0.9 * idle, "idle": idle, "fast": 1.2 * idle}
    torques = {"torque": torque, "most": 1.4 * torque, "brake": -torque}
    masses = {"inertia": 10 ** random.uniform(-4, 1), "mass": 10 ** random.uniform(0, 3)}
    return lw.loads(IDLE.format(**speeds, **torques, **masses))


def test_extremes_beside_a_kink_of_a_steep_motor() -> None:
    """A step ends on the kink: on which side its last stage lies to rounding counts for the acceleration."""
    random, names = np.random.default_rng(1), ("acceleration_min", "acceleration_max")
    for number in range(150):
        machine = idling(random)
        best = lw.steady_state(machine, accuracy=1e-12)
        size = max(*(abs(getattr(best, name)) for name in names), 1e-4 * best.speed_max**2)
        for accuracy in (1e-7, 1e-9, 1e-10, 1e-11):
            motion = lw.steady_state(machine, accuracy=accuracy)
            # Each is off by no more than it says; the factor allows for what both say being an estimate.
            told = 2.5 * (max(motion.accuracy, accuracy) + best.accuracy) * size
            for name in names:
                assert abs(getattr(motion, name) - getattr(best, name)) <= told, (number, name, accuracy)


def controlled(band: float) -> lw.Machine:
    machine = found_machine("rocker_under_speed_controller")
    idle = lw.get(machine, "drive.motor.speed")[2]
    return lw.replace(machine, {"drive.motor.speed": [0.0, idle * (1 - band), idle, idle * (1 + band)]})


def test_a_controller_with_a_narrow_band_is_no_refusal() -> None:
    """The narrower, the nearer to the motion of the narrowest; to that comes the motion in time too."""
    bands = np.geomspace(1e-2, 1e-4, 41)
    speeds = np.array([lw.steady_state(controlled(band)).speed[0] for band in bands])
    followed = lw.transient(controlled(bands[-1]), speed=34.0, turns=30, accuracy=1e-9)
    assert followed.speed[-1] == pytest.approx(speeds[-1], rel=1e-6)
    assert (np.abs(speeds / speeds[-1] - 1) <= bands).all()


def test_what_is_not_found_is_looked_at_in_time() -> None:
    """A band of a millionth is too narrow for some: what is said then is the motion of a wider one."""
    wide = lw.steady_state(controlled(1e-3))
    told = 0
    for band in np.geomspace(1e-5, 1e-8, 13):
        try:
            steady = lw.steady_state(controlled(band))
        except ConvergenceError as error:
            told += 1
            low, high = re.findall(r"settles between ([\d.]+) and ([\d.]+) rad/s", str(error))[0]
        else:
            low, high = steady.speed_min, steady.speed_max
        assert [float(low), float(high)] == pytest.approx([wide.speed_min, wide.speed_max], rel=2e-4)
    assert told
