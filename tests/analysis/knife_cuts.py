"""Coverage of a head by brute force: the edge at many times, chord by chord and point by point."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


class Head(NamedTuple):
    """Diameter of a head, its place across the row; speed of the machine, angle of the edge."""

    d: float
    delta: float
    v: float
    alpha: float


def way(y: Callable[[Floats], Floats], head: Head, n: int, reach: float) -> tuple[Floats, Floats]:
    """p and q of the edge at n even times, from before the head to beyond it; |y| stays below the reach."""
    sin, cos = np.sin(head.alpha), np.cos(head.alpha)
    end = (0.5 * head.d + (reach + abs(head.delta)) * abs(sin)) / (head.v * cos) * 1.01
    t = np.linspace(-end, end, n)
    x, across = head.v * t, y(t) - head.delta
    return x * cos - across * sin, x * sin + across * cos


def needed(p: Floats, q: Floats, d: float) -> float:
    """Length that the head needs if p rises all the time."""
    inside = np.abs(p) < 0.5 * d
    assert (np.diff(p) > 0).all()
    return float(2 * (np.abs(q) + np.sqrt(np.clip(0.25 * d**2 - p**2, 0, None)))[inside].max())


def left(p: Floats, q: Floats, d: float, length: float) -> float:
    """Area left if p rises all the time: what chords have beyond the edge, by the trapezoidal rule."""
    c = np.sqrt(np.clip(0.25 * d**2 - p**2, 0, None))
    cut = np.clip(np.minimum(c, q + 0.5 * length) - np.maximum(-c, q - 0.5 * length), 0, None)
    return float(np.trapezoid(2 * c - cut, p))


def crossed(p: Floats, q: Floats, d: float, length: float, n: int = 400) -> tuple[float, float]:
    """Length needed and area left, whichever way the edge goes, on n chords of n points each."""
    u = (np.arange(n) + 0.5) * np.pi / n - 0.5 * np.pi
    needs, area = 0.0, 0.0
    for level, weight in zip(0.5 * d * np.sin(u), 0.5 * d * np.cos(u) * np.pi / n, strict=True):
        c = np.sqrt(0.25 * d**2 - level**2)
        k = np.flatnonzero((p[:-1] < level) != (p[1:] < level))
        at = q[k] + (level - p[k]) / (p[k + 1] - p[k]) * (q[k + 1] - q[k])
        s = np.linspace(-c, c, n)
        nearest = np.abs(s[:, None] - at).min(axis=1)
        needs = max(needs, 2 * float(nearest.max()))
        area += weight * 2 * c * float((nearest > 0.5 * length).mean())
    return needs, area
