"""What a user would write for a rod string: a march in time by characteristics with NumPy, well by well."""

from __future__ import annotations

from typing import Any

import numpy as np

# Nodes of the string, and revolutions until the motion repeats.
NODES, STROKES = 60, 25


def peak_loads(
    length: float,
    rigidity: float,
    mass: float,
    damping: float,
    fluid_load: float,
    stroke: float,
    period: float,
) -> tuple[float, float]:
    """Maximum and minimum dynamic load of the polished rod [N]: one section, full pump, anchored tubing."""
    Z = np.sqrt(rigidity * mass)
    h = length * np.sqrt(mass / rigidity) / NODES
    q = damping * h / 4
    down, up = np.zeros(NODES + 1), np.zeros(NODES + 1)
    steps = round(period / h)
    loads: Any = np.zeros(steps)
    for i in range(STROKES * steps):
        at_end_down = down[:-1] - q * (down - up)[:-1]
        at_end_up = up[1:] + q * (down - up)[1:]
        apart = (at_end_down[:-1] - at_end_up[1:]) / (1 + 2 * q)
        down[1:-1], up[1:-1] = at_end_down[:-1] - q * apart, at_end_up[1:] + q * apart
        v = np.pi * stroke / period * np.sin(2 * np.pi * i * h / period)
        up[0] = at_end_up[0] + 2 * q * Z * v
        down[0] = up[0] + 2 * Z * v
        wave = at_end_down[-1]
        load = min(max(wave, 0.0), fluid_load)
        down[-1], up[-1] = wave, 2 * load - wave
        loads[i % steps] = up[0] + Z * v
    return float(loads.max()), float(loads.min())
