"""A rod string marched in time: masses and springs, valves by what holds the plunger; no harmonics.

Explicit differences as in Gibbs, J. Pet. Tech. 15 (1963) 769: rods are nodes at equal times of travel, at
which steps in time are exact without damping.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np


class March(NamedTuple):
    """The last stroke of a march."""

    position: np.ndarray  # of the polished rod, upward [m]
    load: np.ndarray  # dynamic, of the polished rod [N]
    plunger: np.ndarray  # position [m]
    pump_load: np.ndarray  # [N]


def march(string, motion, period, strokes=16, fillage=1.0):
    """A string under samples (n,) of the polished rod's position over a period, after some strokes."""
    n, step = len(motion), period / len(motion)
    columns, rate = string.columns, float(string.damping_rate)
    travel = columns.length * np.sqrt(columns.mass / columns.rigidity)
    # At least a step for a wave through a cell: the limit of stability.
    cells = np.floor(travel / step).astype(int)
    stiffness = np.repeat(columns.rigidity * cells / columns.length, cells)
    half = np.repeat(columns.mass * columns.length / cells / 2, cells)
    masses = np.append(0.0, half) + np.append(half, 0.0)
    full = float(string.fluid_load)
    now = np.full(len(masses), motion[0]) - np.append(0.0, np.cumsum(0.5 * full / stiffness))
    before = now.copy()
    gas, history = 0.0, np.zeros((4, n))
    grow, keep = 1 + rate * step / 2, 1 - rate * step / 2
    for i in range(strokes * n):
        tension = stiffness * (now[:-1] - now[1:])
        force = np.append(0.0, tension) - np.append(tension, 0.0)
        after = (2 * now - keep * before + step**2 * force / masses) / grow
        after[0] = motion[(i + 1) % n]
        # Load that holds the plunger where it is: valves open where it is not between none and the fluid's.
        hold = (after[-1] - now[-1]) * grow * masses[-1] / step**2
        # Gas without pressure keeps the fluid load on the plunger until it meets the liquid.
        load = full if gas > 0 else min(max(hold, 0.0), full)
        after[-1] -= step**2 * load / masses[-1] / grow
        rise = after[-1] - now[-1]
        gas = max(gas + ((1 - fillage) * rise if rise > 0 else rise), 0.0) if load == full else 0.0
        acceleration = (after[0] - 2 * now[0] + before[0]) / step**2
        speed = (after[0] - before[0]) / (2 * step)
        rod_load = tension[0] + masses[0] * (acceleration + rate * speed)
        history[:, i % n] = now[0], rod_load, now[-1], load
        before, now = now, after
    return March(*history)
