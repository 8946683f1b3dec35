"""Zeros and extremes of smooth functions of the crank angle, many at once, to rounding.

A function takes a list of angles and gives a value for each; the k-th angle belongs to the k-th problem, so
that one call of the core serves all of them.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from linkwright.kernel.arrays import Floats, Indices

Function = Callable[[Floats], Floats]

# Rounds at most: bisection alone, from 0.02 rad to rounding, needs 50.
_ROUNDS = 100

# Golden section, and rounds that take a bracket of a degree to 1e-9 rad: beyond that a minimum is flat to
# rounding.
_GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)
_GOLDEN_ROUNDS = 38


def zeros(function: Function, low: Floats, high: Floats) -> tuple[Floats, Floats]:
    """Zeros of a function, (k,) to (k,), between angles at which it has different signs, by Chandrupatla
    [1]_.

    Returns where the function is nearest to zero, and the other end of what is left of the bracket; the sign
    differs between them, and they are a few units of rounding apart.

    .. [1] Chandrupatla, A new hybrid quadratic/bisection algorithm for finding the zero of a nonlinear
       function without using derivatives, Advances in Engineering Software 28 (1997) 145–149.
    """
    a, b = np.array(high, dtype=float), np.array(low, dtype=float)
    fa, fb = function(a), function(b)
    c, fc = a.copy(), fa.copy()
    share = np.full_like(a, 0.5)
    for _ in range(_ROUNDS):
        x = a + share * (b - a)
        fx = function(x)
        same = np.sign(fx) == np.sign(fa)
        c, fc = np.where(same, a, b), np.where(same, fa, fb)
        b, fb = np.where(same, b, a), np.where(same, fb, fa)
        a, fa = x, fx
        near = np.where(np.abs(fa) < np.abs(fb), a, b)
        tolerance = 2 * np.finfo(float).eps * np.abs(near) + 1e-16
        least = tolerance / np.maximum(np.abs(b - c), 1e-300)
        if ((least > 0.5) | (fa == 0) | (fb == 0)).all():
            break
        share = np.clip(_share(a, b, c, fa, fb, fc), least, 1 - least)
        share = np.where(least > 0.5, 0.5, share)
    better = np.abs(fa) < np.abs(fb)
    return np.where(better, a, b), np.where(better, b, a)


def zero(function: Callable[[float], float], low: float, high: float) -> float:
    """The zero of a function of one number between two at which it has different signs."""
    near, _ = zeros(lambda x: np.array([function(float(x[0]))]), np.array([low]), np.array([high]))
    return float(near[0])


def _share(a: Floats, b: Floats, c: Floats, fa: Floats, fb: Floats, fc: Floats) -> Floats:
    """Where the next look is between a and b: inverse quadratic if that is safe, else the middle."""
    with np.errstate(divide="ignore", invalid="ignore"):
        xi, phi = (a - b) / (c - b), (fa - fb) / (fc - fb)
        safe = (phi**2 < xi) & ((1 - phi) ** 2 < 1 - xi)
        step = fa / (fb - fa) * fc / (fb - fc)
        step = step + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
    return np.where(safe & np.isfinite(step), step, 0.5)


def minima(function: Function, low: Floats, high: Floats) -> tuple[Floats, Floats]:
    """Minima of a function, (k,) to (k,), in brackets that hold one each, by golden section.

    Returns angles, good to the root of rounding, and values, good to rounding.
    """
    a, b = np.array(low, dtype=float), np.array(high, dtype=float)
    x, y = b - _GOLDEN * (b - a), a + _GOLDEN * (b - a)
    fx, fy = function(x), function(y)
    for _ in range(_GOLDEN_ROUNDS):
        left = fx < fy
        a, b = np.where(left, a, x), np.where(left, y, b)
        new = np.where(left, b - _GOLDEN * (b - a), a + _GOLDEN * (b - a))
        fnew = function(new)
        x, y = np.where(left, new, y), np.where(left, x, new)
        fx, fy = np.where(left, fnew, fy), np.where(left, fx, fnew)
    return np.where(fx < fy, x, y), np.minimum(fx, fy)


def brackets(values: Floats) -> tuple[Indices, Indices]:
    """Where functions sampled at n angles, (k, n), change their sign: function and sample before it, (m,)
    each.

    A sample that is zero counts as positive.
    """
    finite = np.isfinite(values)
    negative = values < 0
    changes = (negative[:, 1:] != negative[:, :-1]) & finite[:, 1:] & finite[:, :-1]
    row, column = np.nonzero(changes)
    return row, column
