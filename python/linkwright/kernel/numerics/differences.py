r"""Derivatives of what has no rules for them, by extrapolated differences, smoothness measured.

A smooth function's central difference has an error in even powers of the step, so that of two steps

.. math:: f' = \tfrac13 \left(4 D_{h/2} - D_h\right) + O(h^4), \qquad D_h = \frac{f(x + h) - f(x - h)}{2h}

Where its bend jumps at x the error grows with the step itself, :math:`f' = 2 D_{h/2} - D_h`, which a third
step tells. At a kink the slopes of both sides differ however small the step is, and there is no derivative.

References
----------
.. [1] Richardson, The deferred approach to the limit, Phil. Trans. A 226 (1927) 299-361.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from linkwright.kernel.arrays import Floats

# Step, as a share of the number: small against what bends in a working cycle, such as a valve's flow that
# turns back; rounding over it is some 1e-9.
_STEP = 2.0**-14

# Shares of the largest derivative: by which two steps may differ with their error in even powers whatever the
# function is; and by which they may differ at all, as at a kink they do by as much as they are.
_EVEN, _SMOOTH = 1e-6, 1e-3

# An error falls to a fourth with half of the step, or to a half: between them is this.
_FALLS = 3.0

# Rounding of a function, as a share of its largest value.
_ROUNDING = 1e-12


def step_at(x: float) -> float:
    """How far a number is varied."""
    return _STEP * (abs(x) or 1.0)


def slope(
    function: Callable[[float], Floats], x: float, ends: tuple[bool, bool] = (True, True)
) -> Floats | None:
    """Derivatives of a function's numbers by its variable at x; None where it has none.

    `ends`: whether the variable may be less, and whether it may be more. Where it may not be both, there is
    a derivative if nothing depends on it.
    """
    h = step_at(x)
    if not all(ends):
        same, moved = function(x), function(x + h if ends[1] else x - h)
        return np.zeros_like(same) if np.array_equal(same, moved) else None
    here, less, more = function(x), function(x - h), function(x + h)
    if np.array_equal(less, more) and np.array_equal(less, here):
        return np.zeros_like(here)
    within = function(x - 0.5 * h), function(x + 0.5 * h)
    far, near = (more - less) / (2.0 * h), (within[1] - within[0]) / h
    # By how much the slopes on both sides differ: of a smooth function as much as the step is long.
    sides = [
        (left - 2.0 * here + right) / step for left, right, step in ((less, more, h), (*within, 0.5 * h))
    ]
    change, size = _largest(near - far), _largest(near)
    rounding = _ROUNDING * _largest(here) / h
    if max(change, _largest(2.0 * sides[1] - sides[0])) > max(_SMOOTH * size, rounding):
        return None
    if change <= max(_EVEN * size, rounding):
        return _extrapolated(far, near, 4.0)
    nearest = _central(function, x, 0.25 * h)
    return _extrapolated(near, nearest, 4.0 if change > _FALLS * _largest(nearest - near) else 2.0)


def _central(function: Callable[[float], Floats], x: float, h: float) -> Floats:
    """Central difference over ±h."""
    difference: Floats = (function(x + h) - function(x - h)) / (2.0 * h)
    return difference


def _extrapolated(far: Floats, near: Floats, falls: float) -> Floats:
    """The derivative of two differences, of which the second has so many times less error."""
    derivative: Floats = (falls * near - far) / (falls - 1.0)
    return derivative


def _largest(numbers: Floats) -> float:
    """Largest absolute value."""
    return float(np.abs(numbers).max(initial=0.0))
