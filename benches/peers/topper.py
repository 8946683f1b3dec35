"""What heads of roots need of a knife, and what it leaves, with NumPy arrays.

The harmonic knife over each head at even stations of a pendulum's time between the ends of its pass, which
Newton finds; a head needs the most of its stations, what is left is added up by the midpoint rule. A station
is a row of arrays over the heads, some thousand at a time, so that they stay in the cache.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

# Newton's steps for the ends of a pass: from the mean speed it takes so many to rounding.
_STEPS = 5


def cover(
    radius: Floats,
    offset: Floats,
    phase: Floats,
    *,
    angle: float,
    forward: float,
    half_stroke: float,
    rate: float,
    length: float,
    stations: int,
    chunk: int = 4000,
) -> Floats:
    """Length needed [m] and area left [m²] of each head, (2, n)."""
    sin, cos = np.sin(angle), np.cos(angle)
    found = np.empty((2, len(radius)))
    for first in range(0, len(radius), chunk):
        here = slice(first, first + chunk)
        r, delta, theta = radius[here], offset[here], phase[here]

        def time(level: Floats, delta: Floats = delta, theta: Floats = theta) -> Floats:
            t = (level - delta * sin) / (forward * cos)
            for _ in range(_STEPS):
                turn = theta + rate * t
                miss = forward * t * cos - (half_stroke * np.sin(turn) - delta) * sin - level
                t = t - miss / (forward * cos - half_stroke * rate * np.cos(turn) * sin)
            return t

        start, end = time(-r), time(r)
        middle, width = 0.5 * (start + end), 0.5 * (end - start)
        need, area = np.zeros(len(r)), np.zeros(len(r))
        for u in (np.arange(stations) + 0.5) * (np.pi / stations) - 0.5 * np.pi:
            t = middle + width * np.sin(u)
            turn = theta + rate * t
            y = half_stroke * np.sin(turn) - delta
            p = forward * t * cos - y * sin
            q = np.abs(forward * t * sin + y * cos)
            chord = np.sqrt(np.maximum(r * r - p * p, 0.0))
            need = np.maximum(need, q + chord)
            left = np.clip(q + chord - 0.5 * length, 0.0, 2 * chord)
            left += np.clip(chord - q - 0.5 * length, 0.0, 2 * chord)
            pace = forward * cos - half_stroke * rate * np.cos(turn) * sin
            area += left * pace * width * (np.cos(u) * np.pi / stations)
        found[:, here] = 2 * need, area
    return found
