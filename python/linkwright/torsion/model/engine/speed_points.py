r"""A few speeds for many: polynomials through Chebyshev's points, between the corners of a load map.

Through values f_j at points x_j of a piece goes the polynomial

.. math:: f(x) = \frac{\sum_j \frac{w_j}{x - x_j} f_j}{\sum_j \frac{w_j}{x - x_j}}, \qquad w_j = (-1)^j,
    \text{ half at both ends}

References
----------
.. [1] Berrut, Trefethen, Barycentric Lagrange interpolation, SIAM Review 46 (2004) 501-517, section 5.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Points of the only piece, and of one among several. Seven meet the harmonics of a propeller's load map with
# Woschni's loss within 1e-5 of the largest over a range of speeds of 1 to 3, within 5e-4 over 1 to 10;
# pieces of a table are shorter.
_ALONE = 7
_AMONG = 4


def speed_points(speeds: Array, kinks: tuple[float, ...]) -> tuple[Array, Array]:
    """Speeds to compute at, and how the others follow from them.

    Speeds, shape (k,), and the share of each in what is asked for, shape (n, k); rows sum to one. `speeds`:
    (n,) what is asked for [rad/s]; `kinks`: where the load map has corners [rad/s].
    """
    ends = np.unique([speeds.min(), *(x for x in kinks if speeds.min() < x < speeds.max()), speeds.max()])
    each = _ALONE if len(ends) == 2 else _AMONG
    asked, place = np.unique(speeds, return_inverse=True)
    if len(asked) <= (len(ends) - 1) * (each - 1) + 1:
        return asked, np.eye(len(asked))[place]
    unit = -np.cos(np.pi * np.arange(each) / (each - 1))
    points = np.unique(np.concatenate([_between(a, b, unit) for a, b in pairwise(ends)]))
    share = np.zeros((len(speeds), len(points)))
    piece = np.clip(np.searchsorted(ends, speeds, side="right") - 1, 0, len(ends) - 2)
    for i in range(len(ends) - 1):
        first = i * (each - 1)
        share[piece == i, first : first + each] = _shares(speeds[piece == i], points[first : first + each])
    return points, share


def _between(start: float, end: float, unit: Array) -> Array:
    """Chebyshev's points of a piece, with its very ends."""
    return np.asarray(np.r_[start, (start + end) / 2 + (end - start) / 2 * unit[1:-1], end])


def _shares(x: Array, points: Array) -> Array:
    """Share of the value at each point in the polynomial at x, shape (n, k)."""
    w = np.where(np.arange(len(points)) % 2, -1.0, 1.0)
    w[[0, -1]] *= 0.5
    gap = x[:, None] - points
    hit = gap == 0
    terms = w / np.where(hit, 1.0, gap)
    terms = np.where(hit.any(axis=1, keepdims=True), hit, terms)
    return np.asarray(terms / terms.sum(axis=1, keepdims=True))
