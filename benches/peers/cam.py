"""A cam with a translating roller by hand in NumPy: the textbook's formulas over arrays of angles and cams.

Source: Norton, *Cam Design and Manufacturing Handbook*, 2nd ed., chapter 7.
"""

from __future__ import annotations

from typing import Any

import numpy as np


def cycloidal_cam(phi: Any, h: float) -> tuple[Any, Any, Any]:
    """Rise over 120°, dwell 60°, return 120°, dwell 60°: lift, first and second derivative."""
    beta = np.radians(120.0)

    def rise(z: Any) -> tuple[Any, Any, Any]:
        turn = 2 * np.pi * z
        return (
            h * (z - np.sin(turn) / (2 * np.pi)),
            h / beta * (1 - np.cos(turn)),
            2 * np.pi * h / beta**2 * np.sin(turn),
        )

    up = rise(np.clip(phi / beta, 0, 1))
    down = rise(np.clip((phi - np.pi) / beta, 0, 1))
    return up[0] - down[0], up[1] - down[1], up[2] - down[2]


def synthesis(n: int, h: float, base: float, roller: float, offset: float) -> tuple[Any, ...]:
    """Profile, pressure angle and curvature at n angles; extremes at the samples."""
    phi = np.linspace(0, 2 * np.pi, n, endpoint=False)
    s, s1, s2 = cycloidal_cam(phi, h)
    x, y, tangent, bend = contact(s, s1, s2, base, roller, offset)
    speed = np.hypot(*tangent)
    normal = -tangent[1] / speed, tangent[0] / speed
    px, py = x - roller * normal[0], y - roller * normal[1]
    cos, sin = np.cos(phi), np.sin(phi)
    profile = np.column_stack((px * cos + py * sin, py * cos - px * sin))
    gamma = np.arctan2(normal[1], normal[0])
    return profile, gamma, bend, np.abs(gamma).max(), bend.max(), (1 - roller * bend).min()


def contact(s: Any, s1: Any, s2: Any, base: Any, roller: Any, offset: Any) -> tuple[Any, ...]:
    """Roller centre, tangent of the pitch curve seen from the cam, and its curvature."""
    x = np.sqrt((base + roller) ** 2 - offset**2) + s
    tangent = s1 + offset, -x
    bent = s2 - x, -2 * s1 - offset
    bend = -(tangent[0] * bent[1] - tangent[1] * bent[0]) / (tangent[0] ** 2 + tangent[1] ** 2) ** 1.5
    return x, offset + 0 * x, tangent, bend


def search(law: tuple[Any, Any, Any], base: Any, roller: float, offset: Any, at_once: int = 2000) -> Any:
    """Largest tangent of the pressure angle, and maximum curvature, of many cams, some at a time."""
    found = np.empty((len(base), 2))
    for first in range(0, len(base), at_once):
        part = slice(first, first + at_once)
        x, _, tangent, bend = contact(*law, base[part, None], roller, offset[part, None])
        found[part, 0] = np.abs(tangent[0] / x).max(axis=1)
        found[part, 1] = bend.max(axis=1)
    return found
