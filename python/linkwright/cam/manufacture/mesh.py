"""Where to cut a smooth stretch so that few pieces keep a tolerance: all pieces err alike.

If the error of a piece of length h goes with hᵖ, then (e/tolerance)^(1/p) is how many pieces that piece
should have been. These shares add up to the number needed, and cutting at equal shares makes the errors
alike. As errors go with hᵖ only for short pieces, this is done over and over, each time with measured errors.

Source: de Boor, *A Practical Guide to Splines* (1978), chapter XII (NEWNOT).
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.errors import ConvergenceError

Floats = NDArray[np.float64]

# Rounds with one number of pieces before there is one more, and at most of pieces.
_ROUNDS, _MOST = 6, 200_000

# Share of an equal part that a piece keeps even if it errs by nothing, so that no piece grows without limit.
_FLOOR = 0.02


def equal_errors(
    errors: Callable[[Floats], Floats], low: float, high: float, order: float, tolerance: float
) -> Floats:
    """Cuts between which no piece errs by more than the tolerance.

    Parameters
    ----------
    errors : callable
        From cuts (n + 1,) to the error of each piece, (n,), in the unit of the tolerance; not negative.
    low, high : float
        Ends of the stretch.
    order : float
        p: with which power of its length a short piece errs.
    tolerance : float
        How much a piece may err.

    Returns
    -------
    ndarray, shape (n + 1,)
        The cuts, with both ends.

    Raises
    ------
    ConvergenceError
        Even 200 000 pieces do not keep the tolerance.
    """
    cuts, enough = np.array([low, high]), False
    n = 1
    while not enough:
        cuts, found, enough = _alike(errors, cuts, n, order, tolerance)
        needed = math.ceil(min(((found / tolerance) ** (1 / order)).sum(), 2.0 * n + 8))
        n = max(needed, n + max(1, n // 50))
        if n > _MOST:
            raise ConvergenceError(
                f"{n} pieces between {low:g} and {high:g} rad do not keep the tolerance; ask for a wider one",
                method="cutting a curve into pieces",
                iterations=n,
                residual=float(found.max()),
            )
    return _fewer(errors, cuts, order, tolerance)


def _fewer(errors: Callable[[Floats], Floats], cuts: Floats, order: float, tolerance: float) -> Floats:
    """Cuts of fewer pieces that keep the tolerance too, by bisection from what the errors say is needed."""
    least = max(math.ceil(((errors(cuts) / tolerance) ** (1 / order)).sum()), 1)
    while least < len(cuts) - 1:
        middle = (least + len(cuts) - 1) // 2
        tried, _, enough = _alike(errors, cuts, middle, order, tolerance)
        if enough:
            cuts = tried
        else:
            least = middle + 1
    return cuts


def _alike(
    errors: Callable[[Floats], Floats], cuts: Floats, n: int, order: float, tolerance: float
) -> tuple[Floats, Floats, bool]:
    """Cuts of n pieces that err alike as far as a few rounds go; their errors; whether that is enough."""
    found = errors(cuts)
    for _ in range(_ROUNDS):
        if len(found) == n and found.max() <= tolerance:
            break
        cuts = _cut_alike(cuts, (found / tolerance) ** (1 / order), n)
        found = errors(cuts)
    return cuts, found, len(found) == n and bool(found.max() <= tolerance)


def _cut_alike(cuts: Floats, share: Floats, n: int) -> Floats:
    """Cuts of n pieces with equal parts of the shares, spread evenly within each old piece."""
    width = np.diff(cuts) / (cuts[-1] - cuts[0])
    weight = share / max(share.sum(), 1e-300) + _FLOOR * width
    total = np.concatenate([[0.0], np.cumsum(weight)])
    new = np.interp(np.linspace(0, total[-1], n + 1), total, cuts)
    new[0], new[-1] = cuts[0], cuts[-1]
    return np.asarray(new)
