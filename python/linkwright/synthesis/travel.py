"""Whether a linkage can be driven through given crank angles, one after another, without being taken apart.

A linkage that meets some positions need not move from one to the next: they may lie on different sides of the
joint (branches), in ranges of the crank with a gap between them (circuits), or be met in another order.

Source: Erdman, Sandor, Mechanism Design: Analysis and Synthesis: branch, circuit and order defects.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

# Angles looked at between the first position and the last; a gap narrower than a quarter of a degree is found
# by the analysis that meets it.
_STEPS = 1441

# A radicand above this share of its maximum, and negative, is rounding at a position with the links in line.
_ZERO = 1e-10


def travel(
    gap: Callable[[Floats], Floats], angles: Sequence[float], turn: float | None = None
) -> Floats | None:
    """The crank angles, counted on in the direction in which the linkage can be driven through them.

    `gap`: radicand of the closure at crank angles [rad]; negative where the linkage does not close; `angles`:
    crank angles of the positions in their order [rad], each up to whole revolutions; `turn`: an angle with
    the sign of the direction that is wanted; without it the shorter way is tried first. Returns: (n,)
    increasing or decreasing within one revolution [rad]; None if neither direction passes all positions.
    """
    ways = [_unrolled(np.asarray(angles, dtype=float), sign) for sign in (1.0, -1.0)]
    if turn is not None:
        ways = ways[:1] if turn > 0 else ways[1:]
    for unrolled in sorted(ways, key=lambda each: abs(each[-1] - each[0])):
        if abs(unrolled[-1] - unrolled[0]) > 2 * np.pi:
            continue
        spare = gap(np.linspace(unrolled[0], unrolled[-1], _STEPS))
        if (spare >= -_ZERO * np.abs(spare).max()).all():
            return unrolled
    return None


def _unrolled(angles: Floats, sign: float) -> Floats:
    """The angles counted on in one direction, each step less than a revolution."""
    steps = np.mod(sign * np.diff(angles), 2 * np.pi)
    return np.asarray(angles[0] + sign * np.concatenate([[0.0], np.cumsum(steps)]))


def way(angles: Floats) -> str:
    """In which direction the crank turns through the angles."""
    return "counter-clockwise" if angles[-1] >= angles[0] else "clockwise"


def listed(angles: Sequence[float] | Floats) -> str:
    """Angles in degrees, for messages."""
    return ", ".join(f"{float(np.degrees(angle)):.2f}°" for angle in angles)
