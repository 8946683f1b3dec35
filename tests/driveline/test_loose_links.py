"""Drives whose links have backlash or curves, against integrations with events."""

from __future__ import annotations

import numpy as np
from loose_drives import loose_cycle, random_loose_drive
from sizes import random_cases

import linkwright as lw


def test_random_drives_with_backlash_and_curves_repeat_by_equations_written_down_here() -> None:
    """Start, multipliers, period, losses and extremes of drives with up to three links."""
    refused = 0
    for number, rng in random_cases(4802, 8, 200):
        loose = random_loose_drive(rng)
        try:
            motion = lw.elastic_motion(loose.machine, angles=np.zeros(1))
        except lw.ConvergenceError:
            refused += 1
            continue
        lead, masses = loose.drive.ratio, _masses(motion)
        speed = motion.speed[masses, 0] / motion.ratio[masses]
        start = np.concatenate([motion.twist[:, 0] / lead, speed])
        scale = np.concatenate([np.maximum(abs(motion.twist_max), abs(motion.twist_min)) / lead, speed])
        found = loose_cycle(loose, start, motion.turns)
        correction = np.linalg.solve(np.eye(len(start)) - found.slopes, found.end - start)
        assert np.abs(correction / scale).max() < 1e-7, number
        largest = np.sort(np.abs(np.linalg.eigvals(found.slopes)))[::-1]
        scale_of_multipliers = max(1.0, largest[0])
        assert np.abs(np.abs(motion.multipliers) - largest).max() < 1e-5 * scale_of_multipliers, number
        assert abs(motion.period / found.period - 1) < 1e-8, number
        lost = motion.power_dissipated * motion.period
        assert np.abs(lost - found.loss).max() <= 1e-6 * max(found.loss.max(), 1e-9), number
        own = motion.ratio[masses]
        for low, high, values, factor in (
            (motion.speed_min[masses], motion.speed_max[masses], found.speed, own),
            (motion.acceleration_min[masses], motion.acceleration_max[masses], found.acceleration, own),
            (motion.torque_min, motion.torque_max, found.torque, 1 / lead),
        ):
            expected = values * factor[:, None]
            size = np.abs(expected).max(axis=1)
            assert np.abs((low - expected[:, 0]) / size).max() <= 1e-6, number
            assert np.abs((high - expected[:, 1]) / size).max() <= 1e-6, number
    assert refused <= number // 20


def _masses(motion: lw.ElasticMotion) -> list[int]:
    """The first station of each mass, from the motor on: stations of one mass have one speed at the crank."""
    referred = motion.speed[:, 0] / motion.ratio
    apart = np.abs(np.diff(referred)) > 1e-13 * referred[1:]
    return [0, *(np.flatnonzero(apart) + 1)]
