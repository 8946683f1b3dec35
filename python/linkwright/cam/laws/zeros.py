"""All zeros of a smooth function between 0 and 1, from its Chebyshev series.

The function is interpolated in so many Chebyshev points that nothing but rounding is left over; the zeros of
the series are eigenvalues of its colleague matrix.

Source: Trefethen, *Approximation Theory and Approximation Practice* (2013), chapter 18.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

Floats = NDArray[np.float64]

# Points beyond the degree of the polynomial, and for each radian of the fastest harmonic: its series falls
# like Bessel functions J_n(k/2), which are below rounding from n = k/2 + 20 on for the frequencies of motion
# laws.
_MORE = 24

# A zero this far outside is one at the end, moved by rounding.
_OUTSIDE = 1e-12

# Of a series, what is below this share of its largest coefficient is rounding.
_ROUNDING = 4e-15

# An eigenvalue farther from the real line than this is no zero; a double zero splits by the root of rounding.
_REAL = 1e-7


def zeros(function: Callable[[Floats], Floats], degree: int, frequency: float = 0.0) -> list[float]:
    """Zeros between 0 and 1, increasing.

    Parameters
    ----------
    function : callable
        Takes and gives arrays of shape (k,).
    degree : int
        Of the polynomial in it.
    frequency : float
        Of the fastest harmonic in it [rad].

    Returns
    -------
    list of float
        The zeros; good to rounding over the slope, and a zero that is also an extreme to the root of that.
    """
    n = degree + (int(frequency) + _MORE if frequency else 1)
    series = _series(function, n)
    series = series[: _last(series) + 1]
    if len(series) < 2:
        return []
    roots = chebyshev.chebroots(series)
    real = roots.real[np.abs(roots.imag) < _REAL]
    u = 0.5 * (real + 1)
    return sorted(np.clip(u[(u > -_OUTSIDE) & (u < 1 + _OUTSIDE)], 0.0, 1.0).tolist())


def _series(function: Callable[[Floats], Floats], n: int) -> Floats:
    """Chebyshev coefficients of the interpolant of degree n, from its values in the n + 1 points."""
    x = np.cos(np.pi * (np.arange(n + 1) + 0.5) / (n + 1))
    coefficients = chebyshev.chebvander(x, n).T @ function(0.5 * (x + 1)) * 2 / (n + 1)
    coefficients[0] *= 0.5
    series: Floats = coefficients
    return series


def _last(series: Floats) -> int:
    """Place of the last coefficient that is more than rounding; -1 if none is."""
    kept = np.flatnonzero(np.abs(series) > _ROUNDING * float(np.abs(series).max()))
    return int(kept[-1]) if len(kept) else -1
