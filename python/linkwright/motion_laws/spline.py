r"""Splines through points.

A spline of odd degree k with its knots in the points has k − 1 conditions to spare: value and derivatives up
to the order (k − 1)/2 at each end are the section's boundary values, those above the second zero. Degree 1
joins the points by straight lines.

The spline is a sum of B-splines; each piece follows from the derivatives at its start.

Source: de Boor, *A Practical Guide to Splines* (2001), chapters IX, X and XIII.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from linkwright.motion_laws.boundary import Boundary
from linkwright.motion_laws.motion_law import MotionLaw
from linkwright.motion_laws.piece import Piece

Floats = NDArray[np.float64]


def spline(places: Sequence[float], values: Sequence[float], task: Boundary, degree: int = 5) -> MotionLaw:
    """The spline through points that meets boundary values.

    Parameters
    ----------
    places : sequence of float
        z of the n points, increasing from 0 to 1.
    values : sequence of float
        x of the n points; the first is 0, the last the lift.
    task : Boundary
        Velocities and accelerations at the ends.
    degree : int
        1, 3, 5 or 7.

    Returns
    -------
    MotionLaw
        From 0 to 1, a piece between each two points.
    """
    x = np.asarray(places, dtype=float)
    knots = np.concatenate([np.zeros(degree), x, np.ones(degree)])
    orders = range(1, (degree - 1) // 2 + 1)
    start = (task.velocity_start, task.acceleration_start or 0.0, 0.0)
    end = (task.velocity_end, task.acceleration_end or 0.0, 0.0)
    rows = [_row(knots, degree, at, 0) for at in x]
    rows += [_row(knots, degree, at, order) for order in orders for at in (0.0, 1.0)]
    right = [*values, *(side[order - 1] for order in orders for side in (start, end))]
    weights = np.linalg.solve(np.array(rows), np.array(right, dtype=float))
    pieces = [_piece(knots, degree, weights, low, high - low) for low, high in pairwise(x.tolist())]
    return MotionLaw(tuple(x.tolist()), tuple(pieces))


def _piece(knots: Floats, degree: int, weights: Floats, low: float, length: float) -> Piece:
    """The polynomial that begins at a knot, from the derivatives there."""
    derivatives = [float(_row(knots, degree, low, order) @ weights) for order in range(degree + 1)]
    return Piece(tuple(d * length**i / math.factorial(i) for i, d in enumerate(derivatives)))


def _row(knots: Floats, degree: int, x: float, order: int) -> Floats:
    """A derivative of each B-spline at a place."""
    if order > 0:
        return degree * _differences(knots, degree, _row(knots, degree - 1, x, order - 1))
    if degree == 0:
        last = x >= knots[-1]
        inside = (knots[:-1] < x) & (x <= knots[1:]) if last else (knots[:-1] <= x) & (x < knots[1:])
        return inside.astype(float)
    below = _row(knots, degree - 1, x, 0)
    n = len(knots) - degree - 1
    up, down = x - knots[:n], knots[degree + 1 :] - x
    rise = _over(below[:n], knots[degree : degree + n] - knots[:n])
    fall = _over(below[1:], knots[degree + 1 :] - knots[1 : n + 1])
    row: Floats = up * rise + down * fall
    return row


def _differences(knots: Floats, degree: int, below: Floats) -> Floats:
    """B-splines of the degree below over their widths, each less the one after it."""
    n = len(knots) - degree - 1
    first = _over(below[:n], knots[degree : degree + n] - knots[:n])
    second = _over(below[1:], knots[degree + 1 :] - knots[1 : n + 1])
    return first - second


def _over(values: Floats, widths: Floats) -> Floats:
    """A quotient that is zero where both are, as at knots that coincide."""
    quotient: Floats = np.divide(values, widths, out=np.zeros_like(values), where=widths > 0)
    return quotient
