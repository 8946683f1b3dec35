"""How long does a row of a study of a small train take: modes, damped modes, forced vibration?"""

from __future__ import annotations

import time
from typing import Any

import numpy as np
from common import Row

import linkwright as lw

# Longest time of a row of modes or forced vibration [ms].
PERMITTED = 0.3

N, N_QUICK = 4000, 500

RESPONSES: dict[str, Any] = {
    "modes": "free_vibration.natural_frequencies.1",
    "damped modes": {"curve": "damped_vibration.damping_ratios", "index": 1},
    "forced vibration": "forced_vibration.shaft_torque_max.s0",
}


def rows(quick: bool) -> list[Row]:
    """Trains of 3 and 6 discs, the stiffness of a shaft varied."""
    return [row(discs, name, N_QUICK if quick else N) for discs in (3, 6) for name in RESPONSES]


def row(discs: int, name: str, n: int) -> Row:
    """Milliseconds a row."""
    stiffness = {"address": "train.shafts.s0.stiffness", "range": ["5 kN m/rad", "20 kN m/rad"]}
    plan = lw.new_study(chain(discs), {"variables": {"k": stiffness}, "responses": {"y": RESPONSES[name]}})
    values = np.random.default_rng(0).uniform(5e3, 2e4, n)
    lw.evaluate(plan, {"k": values[:10]})
    start = time.perf_counter()
    found = lw.evaluate(plan, {"k": values})
    taken = 1e3 * (time.perf_counter() - start) / n
    assert not found.status.any()
    case = f"study of a train of {discs} discs, {name}"
    return Row(case, "ms/row", taken, "permitted", PERMITTED, PERMITTED / taken, 1.0)


def chain(discs: int) -> lw.Machine:
    """Discs on shafts in a row, with two orders at five speeds."""
    names = [f"d{n}" for n in range(discs)]
    harmonics = [{"order": 1, "torque": 10.0}, {"order": 2, "torque": 5.0}]
    train = {
        "discs": {name: {"inertia": 0.5 + 0.1 * n, "damping": 0.2} for n, name in enumerate(names)},
        "shafts": {
            f"s{n}": {"between": [names[n], names[n + 1]], "stiffness": 1e4 * (1 + n), "loss_factor": 0.02}
            for n in range(discs - 1)
        },
        "excitations": {"pulse": {"on": "d0", "harmonics": harmonics}},
        "run": {"speed_min": 50.0, "speed_max": 150.0, "points": 5},
    }
    return lw.Machine.model_validate({"format": 1, "name": "chain", "train": train})
