"""Splines through points.

A spline of odd degree k with its knots in the points has k − 1 conditions to spare: value and derivatives up
to the order (k − 1)/2 at each end are the section's boundary values, those above the second zero. Degree 1
joins the points by straight lines.

The spline is a sum of B-splines; each piece follows from the derivatives at its start.

Source: de Boor, *A Practical Guide to Splines* (2001), chapters IX, X and XIII.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from linkwright.cam.laws.boundary import Boundary
from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.cam.laws.piece import Piece

Floats = NDArray[np.float64]


def spline(places: Sequence[float], values: Sequence[float], task: Boundary, degree: int = 5) -> MotionLaw:
    """The spline through points that meets boundary values."""
    x = np.asarray(places, dtype=float)
    knots = np.concatenate([np.zeros(degree), x, np.ones(degree)])
    start = (task.velocity_start, task.acceleration_start or 0.0, 0.0)
    end = (task.velocity_end, task.acceleration_end or 0.0, 0.0)
    orders = (degree - 1) // 2
    rows = [_collocation(knots, degree, x), *_end_rows(knots, degree, orders)]
    right = [*values, *start[:orders], *end[:orders]]
    weights = np.linalg.solve(np.vstack(rows), np.array(right, dtype=float))
    return MotionLaw(tuple(x.tolist()), _pieces(knots, degree, weights, x))


def _pieces(knots: Floats, degree: int, weights: Floats, x: Floats) -> tuple[Piece, ...]:
    """The polynomial from each knot on, from the derivatives there."""
    lengths, columns = np.diff(x), []
    for order in range(degree + 1):
        span, basis = _basis(knots, degree - order, x[:-1])
        places = span[:, None] + np.arange(order - degree, 1)
        columns.append((basis * weights[places]).sum(axis=1) * lengths**order / math.factorial(order))
        knots, weights = knots[1:-1], _derived(knots, degree - order, weights)
    return tuple(Piece(tuple(row)) for row in np.array(columns).T.tolist())


def _collocation(knots: Floats, degree: int, x: Floats) -> Floats:
    """Values of all B-splines at some places, (places, splines)."""
    span, basis = _basis(knots, degree, x)
    matrix = np.zeros((len(x), len(knots) - degree - 1))
    np.put_along_axis(matrix, span[:, None] + np.arange(-degree, 1), basis, axis=1)
    return matrix


def _end_rows(knots: Floats, degree: int, orders: int) -> list[Floats]:
    """Derivatives at the start, by increasing order, then at the end, of each B-spline.

    At its ends a spline has the value of its first and its last weight.
    """
    each, first, last = np.eye(len(knots) - degree - 1), [], []
    for order in range(orders):
        each = _derived(knots[order : len(knots) - order], degree - order, each)
        first.append(each[0])
        last.append(each[-1])
    return [*first, *last]


def _basis(knots: Floats, degree: int, x: Floats) -> tuple[NDArray[np.intp], Floats]:
    """Number of the last B-spline that is not zero at each place; values of it and those before it."""
    span = np.clip(np.searchsorted(knots, x, side="right") - 1, degree, len(knots) - degree - 2)
    basis = np.ones((len(x), 1))
    for d in range(1, degree + 1):
        wider = np.zeros((len(x), d + 1))
        for i in range(d):
            low, high = knots[span - d + 1 + i], knots[span + 1 + i]
            share = basis[:, i] / (high - low)
            wider[:, i] += (high - x) * share
            wider[:, i + 1] += (x - low) * share
        basis = wider
    return span, basis


def _derived(knots: Floats, degree: int, weights: Floats) -> Floats:
    """Weights of the derivative, on the knots without the first and the last; along the first axis."""
    if degree == 0:
        return weights[:0]
    widths = knots[degree + 1 : -1] - knots[1 : -degree - 1]
    derived: Floats = degree * np.diff(weights, axis=0) / widths.reshape(-1, *[1] * (weights.ndim - 1))
    return derived
