"""Steady motion of trains with several motors and mechanisms, against integrations in time and limits."""

from __future__ import annotations

import numpy as np
from mounted_trains import DISCS, SHAFTS, cycle, random_train
from sizes import random_cases

import linkwright as lw


def test_random_trains_repeat_by_equations_written_down_here() -> None:
    """Start, multipliers and extremes of trains with two motors and two cranks at ratios of 1, 2 and ½."""
    for n, (number, rng) in enumerate(random_cases(4810, 6, 100)):
        train = random_train(rng, (1.0, 2.0, 0.5)[n % 3])
        motion = lw.elastic_motion(train.machine, angles=np.zeros(1))
        discs = [motion.stations.index(name) for name in DISCS]
        shafts = [motion.shafts.index(name) for name in SHAFTS]
        assert motion.turns == train.turns, number
        start = np.concatenate([motion.twist[shafts, 0], motion.speed[discs, 0]])
        scale = np.concatenate([np.abs(motion.twist_max[shafts]), motion.speed[discs, 0]])
        found = cycle(train, start, 1e-4 * scale)
        correction = np.linalg.solve(np.eye(len(start)) - found.slopes, found.end - start)
        assert np.abs(correction / scale).max() < 1e-7, number
        largest = np.sort(np.abs(np.linalg.eigvals(found.slopes)))[::-1]
        assert np.abs(np.abs(motion.multipliers) - largest).max() < 1e-5, number
        assert abs(motion.period / found.period - 1) < 1e-8, number
        for low, high, expected in (
            (motion.speed_min[discs], motion.speed_max[discs], found.speed),
            (motion.acceleration_min[discs], motion.acceleration_max[discs], found.acceleration),
            (motion.torque_min[shafts], motion.torque_max[shafts], found.torque),
        ):
            size = np.abs(expected).max(axis=1)
            assert np.abs((low - expected[:, 0]) / size).max() <= 1e-6, number
            assert np.abs((high - expected[:, 1]) / size).max() <= 1e-6, number
        lost = motion.power_dissipated.sum() * motion.period
        work = motion.energy_drive * motion.turns
        assert abs(motion.energy_load * motion.turns + lost - work) <= 1e-10 * work, number
