r"""Laws by conditions at their ends, and splines through points.

Linear equations in exact fractions, for the few unknowns of a motion law.

A float is a fraction, so the coefficients of a polynomial come out as they are, rounded once: 10, −15, 6.

Polynomials by their boundary conditions, of any degree.

.. math:: x(z) = \sum_p c_p z^p

with as many powers p as derivatives are given at the two ends. Without a choice the powers are 0, 1, 2, … .

Source: VDI 2143 Blatt 1 (1980); Rothbart (ed.), *Cam Design Handbook* (2004), chapter 4.

Splines through points.

A spline of odd degree k with its knots in the points has k − 1 conditions to spare: value and derivatives up
to the order (k − 1)/2 at each end are the section's boundary values, those above the second zero. Degree 1
joins the points by straight lines.

The spline is a sum of B-splines; each piece follows from the derivatives at its start.

Source: de Boor, *A Practical Guide to Splines* (2001), chapters IX, X and XIII.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from fractions import Fraction
from math import perm

import numpy as np
from numpy.typing import NDArray

from linkwright.cam.laws.boundary import Boundary
from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.cam.laws.piece import Piece
from linkwright.kernel.errors import LawError, Problem

Number = Fraction | int | float
Row = list[Fraction]


def solve(
    rows: Sequence[Sequence[Fraction | int]], right: Sequence[float | Fraction]
) -> list[Fraction] | None:
    """The solution by elimination.

    Parameters
    ----------
    rows : sequence of sequence
        Coefficients, n rows of n.
    right : sequence
        Right sides, n.

    Returns
    -------
    list of Fraction or None
        The n unknowns; None if the rows depend on each other.
    """
    table = [[*map(Fraction, row), Fraction(value)] for row, value in zip(rows, right, strict=True)]
    for i in range(len(table)):
        pivot = next((j for j in range(i, len(table)) if table[j][i]), None)
        if pivot is None:
            return None
        table[i], table[pivot] = table[pivot], table[i]
        table[i] = [each / table[i][i] for each in table[i]]
        table = [row if j == i else _without(row, table[i], i) for j, row in enumerate(table)]
    return [row[-1] for row in table]


def _without(row: Row, other: Row, i: int) -> Row:
    """The row less so much of the other that its entry i vanishes."""
    return [a - row[i] * b for a, b in zip(row, other, strict=True)] if row[i] else row


# Order of the derivative → its value.
Conditions = Mapping[int, float]


def polynomial(start: Conditions, end: Conditions, powers: Sequence[int] | None = None) -> MotionLaw:
    """The polynomial that meets given values and derivatives at z = 0 and z = 1.

    Parameters
    ----------
    start, end : Mapping of int to float
        Order of the derivative → its value there.
    powers : sequence of int, optional
        Powers to be used, as many as there are conditions.

    Returns
    -------
    MotionLaw
        From 0 to 1.

    Raises
    ------
    LawError
        The powers are not as many as the conditions, or cannot meet them.
    """
    n = len(start) + len(end)
    used = sorted(set(range(n) if powers is None else powers))
    if len(used) != n:
        expected = f"{n} powers, as many as there are conditions at the two ends"
        raise LawError(Problem("powers", _listed(used), expected))
    rows = [*(_at_start(order, used) for order in start), *(_at_end(order, used) for order in end)]
    found = solve(rows, [*start.values(), *end.values()])
    if found is None:
        expected = "powers that can meet every condition: each order that is given at the start is one"
        raise LawError(Problem("powers", _listed(used), expected))
    by_power = dict(zip(used, found, strict=True))
    return MotionLaw((0.0, 1.0), (Piece(coefficients(by_power)),))


def coefficients(by_power: Mapping[int, Fraction]) -> tuple[float, ...]:
    """All coefficients from the constant on, of power → coefficient."""
    return tuple(float(by_power.get(p, 0)) for p in range(max(by_power) + 1))


def polynomial_3_4_5() -> MotionLaw:
    """f = 10 z³ − 15 z⁴ + 6 z⁵: velocity and acceleration vanish at both ends."""
    return polynomial({0: 0, 1: 0, 2: 0}, {0: 1, 1: 0, 2: 0})


def polynomial_4_5_6_7() -> MotionLaw:
    """f = 35 z⁴ − 84 z⁵ + 70 z⁶ − 20 z⁷: the jerk vanishes at both ends too."""
    return polynomial({0: 0, 1: 0, 2: 0, 3: 0}, {0: 1, 1: 0, 2: 0, 3: 0})


def _at_start(order: int, powers: Sequence[int]) -> list[int]:
    """A derivative of each power at z = 0."""
    return [perm(p, order) if p == order else 0 for p in powers]


def _at_end(order: int, powers: Sequence[int]) -> list[int]:
    """A derivative of each power at z = 1."""
    return [perm(p, order) for p in powers]


def _listed(powers: Sequence[int]) -> str:
    return ", ".join(map(str, powers))


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
