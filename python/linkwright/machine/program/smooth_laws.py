"""Laws that formulas give are looked at before a mechanism follows them: values everywhere, no jumps."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import AssemblyError

# Intervals of the revolution that are looked at.
LOOK = 720

# Share of a law's range by which its rise over an interval may differ from its slopes without being looked
# into: a smooth law differs by its third derivative times h³/12, some 1e-7 of its range.
_DIFFERS = 1e-4

# Beyond this a sine has no digits left that mean anything [rad, m, and their slopes].
LARGEST = 1e6

# Halvings of an interval after which what is left of a rise is a jump: half a degree is then 1e-11 rad.
_HALVINGS = 30


def gap_in_law(name: str, text: str, law: Callable[[Floats], Floats]) -> AssemblyError | None:
    """What is wrong with a law that has no value at some crank angles; None if it has one at all.

    `law`: crank angles (n,) [rad] → the law and its slope, (2, n). Raises `AssemblyError` if it has no value
    at any angle, or jumps.
    """
    phi = np.linspace(0.0, 2 * np.pi, LOOK + 1)
    value, slope = law(phi)
    known = (np.abs(value) < LARGEST) & (np.abs(slope) < LARGEST)
    if not known.all():
        at = float(phi[int(np.argmin(known))])
        remedy = "look for a division by zero, a root or a logarithm"
        gap = _error(name, text, at, "has no usable value or slope", remedy)
        if not known.any():
            raise gap
    else:
        gap = None
    value, slope = np.where(known, (value, slope), np.nan)
    rise = np.diff(value) - 0.5 * (slope[1:] + slope[:-1]) * np.diff(phi)
    size = float(np.nanmax(value) - np.nanmin(value))
    for interval in np.flatnonzero(np.abs(rise) > _DIFFERS * size):
        jump = _jump(law, float(phi[interval]), float(phi[interval + 1]), _DIFFERS * size)
        if jump is not None:
            raise _error(
                name, text, jump, "jumps", "nothing can follow a jump: write a law that is continuous"
            )
    return gap


def _jump(law: Callable[[Floats], Floats], low: float, high: float, least: float) -> float | None:
    """Where a law rises by more than ``least`` within rounding; None if it does so gradually."""
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        a, b, c = law(np.array([low, middle, high]))[0]
        low, high = (low, middle) if abs(b - a) > abs(c - b) else (middle, high)
    a, c = law(np.array([low, high]))[0]
    return low if abs(c - a) > 0.1 * least else None


def _error(name: str, text: str, at: float, what: str, remedy: str) -> AssemblyError:
    return AssemblyError(
        f'the law of {name}, "{text}", {what} at crank angle {np.degrees(at):.4g}°: {remedy}',
        element=name,
        crank_angle=at,
    )
