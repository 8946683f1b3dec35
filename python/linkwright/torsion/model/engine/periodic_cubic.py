r"""The periodic monotone cubic through points of a cycle.

On each interval of width h with secant s it is Hermite's cubic; the slope at a point between secants of the
same sign is their weighted harmonic mean, at an extreme zero,

.. math:: \frac{w_1 + w_2}{d} = \frac{w_1}{s_-} + \frac{w_2}{s_+}, \qquad w_1 = 2 h_+ + h_-, \quad
    w_2 = h_+ + 2 h_-

References
----------
.. [1] Fritsch, Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300-304.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def periodic_cubic(knots: Array, values: Array, period: float, at: Array) -> Array:
    """Value of the monotone cubic through points of one period, (m,).

    Values there. `knots`: (k,); `values`: (k,) value at each; `at`: (m,) arguments of any size.
    """
    x, y = _one_period(knots, values, period)
    h = np.diff(x)
    s = np.diff(y) / h
    d = _slopes(h, s)
    t = x[0] + np.mod(at - x[0], period)
    i = np.clip(np.searchsorted(x, t, side="right") - 1, 0, len(h) - 1)
    u = t - x[i]
    # Newton's form of Hermite's cubic.
    square = (3 * s - 2 * d[:-1] - d[1:]) / h
    cube = (d[:-1] + d[1:] - 2 * s) / h**2
    return np.asarray(y[i] + u * (d[:-1][i] + u * (square[i] + u * cube[i])))


def _one_period(knots: Array, values: Array, period: float) -> tuple[Array, Array]:
    """The points with the first repeated at the end of the period."""
    # Knots closer than a millionth of the period are the same.
    if abs(knots[-1] - knots[0] - period) < 1e-6 * period:
        knots, values = knots[:-1], np.r_[(values[0] + values[-1]) / 2, values[1:-1]]
    return np.r_[knots, knots[0] + period], np.r_[values, values[0]]


def _slopes(h: Array, s: Array) -> Array:
    """Slopes at all points, the last the same as the first."""
    before, after = np.roll(h, 1), h
    left, right = np.roll(s, 1), s
    w_1, w_2 = 2 * after + before, after + 2 * before
    same = left * right > 0
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = (w_1 + w_2) / (w_1 / left + w_2 / right)
    d = np.where(same, mean, 0.0)
    return np.asarray(np.r_[d, d[0]])
