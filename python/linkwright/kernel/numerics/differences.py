r"""Derivatives of what has no rules for them, by extrapolated differences, smoothness measured.

A smooth function's central difference has an error in even powers of the step, so that of two steps

.. math:: f' = \tfrac13 \left(4 D_{h/2} - D_h\right) + O(h^4), \qquad D_h = \frac{f(x + h) - f(x - h)}{2h}

Where its bend jumps at x the error grows with the step itself, :math:`f' = 2 D_{h/2} - D_h`, which a third
step tells. At a kink the slopes of both sides differ however small the step is, and there is no derivative.

References
----------
.. [1] Richardson and Gaunt, The deferred approach to the limit, Phil. Trans. A 226 (1927) 299-361.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from linkwright.kernel.arrays import Complexes, Floats

Numbers = Floats | Complexes

# Step, as a share of the number: small against what bends in a working cycle, such as a valve's flow that
# turns back; rounding over it is some 1e-9.
_STEP = 2.0**-14

# Shares of the largest derivative: by which two steps may differ with their error in even powers whatever the
# function is; and by which they may differ at all, as at a kink they do by as much as they are.
_EVEN, _SMOOTH = 1e-8, 1e-3

# An error falls to a fourth with half of the step, or to a half: between them is this.
_FALLS = 3.0

# Rounding of a function, as a share of its largest value.
_ROUNDING = 1e-12


def step_at(x: float) -> float:
    """How far a number is varied."""
    return _STEP * (abs(x) or 1.0)


def slopes(
    function: Callable[[float], tuple[Numbers, ...]], x: float, here: tuple[Numbers, ...]
) -> tuple[Numbers, ...] | None:
    """Derivatives of arrays by their variable at x, each judged by its own size; None where one has none.

    `here`: the arrays at x.
    """
    h, known = step_at(x), {0.0: here}

    def array(part: int, share: float) -> Numbers:
        """One array at x and so many steps."""
        if share not in known:
            known[share] = function(x + share * h)
        return known[share][part]

    derivatives = []
    for part in range(len(here)):
        derivative = _slope(partial(array, part), h)
        if derivative is None:
            return None
        derivatives.append(derivative)
    return tuple(derivatives)


def _slope(at: Callable[[float], Numbers], h: float) -> Numbers | None:
    """The derivative of one array that is known at shares of the step; None where it has none."""
    here, less, more = at(0.0), at(-1.0), at(1.0)
    if np.array_equal(less, more) and np.array_equal(less, here):
        return np.zeros_like(here)
    far, near = _central(at, 1.0, h), _central(at, 0.5, h)
    if not (np.isfinite(far).all() and np.isfinite(near).all()):
        return None
    # By how much the slopes on both sides differ: of a smooth function as much as the step is long.
    sides = [(at(-share) - 2.0 * here + at(share)) / (share * h) for share in (1.0, 0.5)]
    change, size = _largest(near - far), _largest(near)
    rounding = _ROUNDING * _largest(here) / h
    if max(change, _largest(2.0 * sides[1] - sides[0])) > max(_SMOOTH * size, rounding):
        return None
    if change <= max(_EVEN * size, rounding):
        return _extrapolated(far, near, 4.0)
    nearest = _central(at, 0.25, h)
    return _extrapolated(near, nearest, 4.0 if change > _FALLS * _largest(nearest - near) else 2.0)


def _central(at: Callable[[float], Numbers], share: float, h: float) -> Numbers:
    """Central difference over so many steps."""
    difference: Numbers = (at(share) - at(-share)) / (2.0 * share * h)
    return difference


def _extrapolated(far: Numbers, near: Numbers, falls: float) -> Numbers:
    """The derivative of two differences, of which the second has so many times less error."""
    derivative: Numbers = (falls * near - far) / (falls - 1.0)
    return derivative


def _largest(numbers: Numbers) -> float:
    """Largest absolute value."""
    return float(np.abs(numbers).max(initial=0.0))
