r"""Laws through points: splines, and polynomials that osculate a smooth function.

A spline of odd degree k with its knots in the points has k − 1 conditions to spare: value and derivatives up
to the order (k − 1)/2 at each end are the section's boundary values, those above the second zero. Degree 1
joins the points by straight lines.

A smooth function becomes polynomials that have its value and three derivatives at both ends of every piece.
This is Hermite's interpolation of degree 7; in n equal pieces of a length of one its error is at most

.. math:: \frac{h^8}{8!\,2^8} \max |f^{(8)}|, \quad h = 1/n

and its pieces meet with equal values up to the third derivative. The pieces are halved until the function
is met between their ends too.

Sources: de Boor, *A Practical Guide to Splines* (2001), chapters IX and XIII, SciPy has the collocation;
Davis, *Interpolation and Approximation* (1963), section 3.5.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

import numpy as np

from linkwright.cam.laws.boundary import Boundary, or_none
from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.cam.laws.piece import Piece
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import LawError, Problem
from linkwright.kernel.numerics.tangent import Tangent, primal, variables_of


def spline(places: Sequence[float], values: Sequence[float], task: Boundary, degree: int = 5) -> MotionLaw:
    """The spline through points that meets boundary values."""
    from scipy.interpolate import PPoly, make_interp_spline

    x = np.asarray(places, dtype=float)
    orders = range(1, (degree + 1) // 2)
    start = (task.velocity_start, or_none(task.acceleration_start), 0.0)
    end = (task.velocity_end, or_none(task.acceleration_end), 0.0)
    # Values, and behind them their derivatives by entries: the spline is linear in both.
    n = variables_of((*values, *start, *end)) or 0
    rows = [_with_derivatives(value, n) for value in values]
    ends = [[_with_derivatives(value, n) for value in side] for side in (start, end)]
    conditions: Any = tuple([*zip(orders, side, strict=False)] for side in ends) if orders else None
    knots = np.concatenate([np.zeros(degree), x, np.ones(degree)])
    curve: Any = make_interp_spline(x, np.array(rows), degree, knots, conditions)
    # Powers of the distance from the start of each piece, the highest first; a piece counts from 0 to 1.
    powers = [
        PPoly.from_spline((curve.t, column, degree)).c[:, degree : degree + len(x) - 1][::-1].T
        for column in curve.c.T
    ]
    table = np.stack(powers, axis=-1) * (np.diff(x)[:, None] ** np.arange(degree + 1))[..., None]
    pieces = [
        Piece(tuple(c[0] if not n else Tangent(c[0], np.array(c[1:])) for c in row))  # type: ignore[misc]
        for row in table.tolist()
    ]
    return MotionLaw(tuple(x.tolist()), tuple(pieces))


def _with_derivatives(value: Any, n: int) -> Floats:
    """A number and its derivatives by n variables, zero if it has none, (1 + n,)."""
    d = value.d if isinstance(value, Tangent) else np.zeros(n)
    return np.concatenate([[primal(value)], d])


# Share of the largest second derivative by which that of the polynomials may be off between the ends.
_ACCURACY = 1e-9

_PIECES = (8, 16, 32, 64, 128)


def hermite(places: Sequence[float] | Floats, derivatives: Sequence[Sequence[Any]] | Floats) -> MotionLaw:
    """Polynomials that meet value and derivatives at both ends of every piece.

    `places`: (n,), increasing; `derivatives`: value, first derivative, … at each place, (k, n), which gives
    the degree 2k − 1: straight lines by values alone, quintics by velocity and acceleration too. With
    derivatives by entries where they have some.
    """
    x = np.asarray(places, dtype=float)
    # Numbers with derivatives are objects, of which NumPy makes the same sums.
    rows = np.array(derivatives)
    orders, length = np.arange(len(rows))[:, None], np.diff(x)
    given = np.concatenate([rows[:, :-1] * length**orders, rows[:, 1:] * length**orders])
    powers = (_powers(len(rows)) @ given).T
    return MotionLaw(tuple(x.tolist()), tuple(Piece(tuple(row)) for row in powers.tolist()))


@cache
def _powers(k: int) -> Floats:
    """Powers 0 to 2k − 1 from value and derivatives at 0 and at 1."""
    rows = [
        [
            np.prod(np.arange(n, n - order, -1.0)) * (u ** (n - order) if n >= order else 0.0)
            for n in range(2 * k)
        ]
        for u in (0.0, 1.0)
        for order in range(k)
    ]
    return np.asarray(np.linalg.inv(np.array(rows)))


def osculating(function: Callable[[Floats], Floats], text: str) -> MotionLaw:
    """The law of a function over z from 0 to 1, beginning with 0.

    `function`: places (n,) → value and three derivatives, (4, n); `text`: of the formula, for messages.
    Raises LawError: it has no value somewhere, or a kink or a jump inside.
    """
    for n in _PIECES:
        law, off = _with_pieces(function, n, text)
        if off <= _ACCURACY:
            return law
    expected = "a formula that is smooth over its section"
    remedy = "end the section where it bends, and begin another one there"
    raise LawError(Problem("", text, expected, remedy))


def _with_pieces(function: Callable[[Floats], Floats], n: int, text: str) -> tuple[MotionLaw, float]:
    """The law in n pieces, and the largest relative error of its second derivative between their ends."""
    z = np.linspace(0.0, 1.0, n + 1)
    ends = function(z)
    if not np.isfinite(ends).all():
        at = float(z[int(np.argmin(np.isfinite(ends).all(axis=0)))])
        raise LawError(Problem("", text, f"a formula with value and derivatives, also at z = {at:.6g}"))
    own = np.array(ends)
    own[0] -= own[0, 0]
    law = hermite(z, own)
    between = (z[:-1, None] + np.array([0.21, 0.5, 0.83]) / n).ravel()
    exact = function(between)[2]
    size = max(
        float(np.abs(exact).max()), float(np.abs(ends[2]).max()), float(np.abs(ends[0] - ends[0, 0]).max())
    )
    off = np.abs(np.array([float(law.at(point, 2)) for point in between]) - exact).max() if size else 0.0
    return law, float(off / size) if size else 0.0
