r"""A closed curve as arcs or chords, cut so that few pieces keep a tolerance: all pieces err alike.

If the error of a piece of length h goes with hᵖ, then (e/tolerance)^(1/p) is how many pieces that piece
should have been. These shares add up to the number needed, and cutting at equal shares makes the errors
alike. As errors go with hᵖ only for short pieces, this is done over and over, each time with measured errors.

Source: de Boor, *A Practical Guide to Splines* (1978), chapter XII (NEWNOT).

A polygon has its corners on the curve: a chord of length s errs by κ s²/8. Circular arcs and lines that meet
without kinks are biarcs through places of the curve, with its tangents.

Between two places with unit tangents :math:`t_0, t_1`, the two arcs meet in the middle of the side between
:math:`p_0 + d\,t_0` and :math:`p_1 - d\,t_1`, with equal lengths d of the tangents:

.. math::

    d = \frac{v^2}{v\cdot t + \sqrt{(v\cdot t)^2 + 2(1 - t_0\cdot t_1)\,v^2}},
    \qquad v = p_1 - p_0,\ t = t_0 + t_1

Where the curvature grows evenly, a piece of length s errs by :math:`|\kappa'| s^3/324`, so the number of arcs
grows with the cube root of the tolerance.

Sources: Bolton, *Biarc curves*, Computer-Aided Design 7 (1975) 89–92; Meek and Walton, *Approximating smooth
planar curves by arc splines*, J. Comput. Appl. Math. 59 (1995) 221–231.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from linkwright.cam.manufacture.curve import Stretch, Track
from linkwright.cam.manufacture.outline import Outline, Sides, angle_between, dot
from linkwright.kernel.arrays import Bools, Floats
from linkwright.kernel.errors import ConvergenceError

# Rounds with one number of pieces before there is one more, and at most of pieces.
_ROUNDS, _MOST = 6, 200_000

# Share of an equal part that a piece keeps even if it errs by nothing, so that no piece grows without limit.
_FLOOR = 0.02


def equal_errors(
    errors: Callable[[Floats], Floats], low: float, high: float, order: float, tolerance: float
) -> Floats:
    """Cuts between which no piece errs by more than the tolerance, (n + 1,)."""
    cuts, enough = np.array([low, high]), False
    n = 1
    while not enough:
        cuts, error, enough = _alike(errors, cuts, n, order, tolerance)
        needed = math.ceil(min(((error / tolerance) ** (1 / order)).sum(), 2.0 * n + 8))
        n = max(needed, n + max(1, n // 50))
        if n > _MOST:
            raise ConvergenceError(
                f"{n} pieces between {low:g} and {high:g} rad do not meet the tolerance; use a wider one",
                method="cutting a curve into pieces",
                iterations=n,
                residual=float(error.max()),
            )
    return _fewer(errors, cuts, order, tolerance)


def _fewer(errors: Callable[[Floats], Floats], cuts: Floats, order: float, tolerance: float) -> Floats:
    """Cuts of fewer pieces that keep the tolerance, by bisection from the estimate by the errors."""
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
    error = errors(cuts)
    for _ in range(_ROUNDS):
        if len(error) == n and error.max() <= tolerance:
            break
        cuts = _cut_alike(cuts, (error / tolerance) ** (1 / order), n)
        error = errors(cuts)
    return cuts, error, len(error) == n and bool(error.max() <= tolerance)


def _cut_alike(cuts: Floats, share: Floats, n: int) -> Floats:
    """Cuts of n pieces with equal parts of the shares, spread evenly within each old piece."""
    width = np.diff(cuts) / (cuts[-1] - cuts[0])
    weight = share / max(share.sum(), 1e-300) + _FLOOR * width
    total = np.concatenate([[0.0], np.cumsum(weight)])
    new = np.interp(np.linspace(0, total[-1], n + 1), total, cuts)
    new[0], new[-1] = cuts[0], cuts[-1]
    return np.asarray(new)


# Error of a chord by its length.
_CHORD_ORDER = 2.0

# Shares of a chord at which it is compared with the curve; the largest distance is near the middle.
_CHORD_SHARES = np.linspace(0.05, 0.95, 19)


def polyline(track: Track, tolerance: float) -> Outline:
    """Approximate a curve by chords. ``tolerance``: largest distance from the curve [m]."""
    vertices = np.concatenate([_corners(part, tolerance) for part in track.parts])
    return Outline(vertices, np.zeros(len(vertices)))


def _corners(part: Stretch, tolerance: float) -> Floats:
    """Starts of the chords of a stretch, (n, 2)."""

    def errors(cuts: Floats) -> Floats:
        p = part.points(cuts)
        chords = Sides(p[:-1], np.diff(p, axis=0), np.zeros(len(p) - 1))
        places = part.points(cuts[:-1, None] + np.diff(cuts)[:, None] * _CHORD_SHARES)
        return np.asarray(chords.distances(places).max(axis=1))

    cuts = equal_errors(errors, part.low, part.high, _CHORD_ORDER, tolerance)
    return part.points(cuts[:-1])


# Error of a biarc by its length.
_ORDER = 3.0

# Maximum angle that a piece may turn [rad]: a quarter and a little, so that a circle becomes four arcs.
_TURN = 0.51 * np.pi

# Shares of a piece at which it is compared with the curve. Where the curvature grows evenly, the error
# has its peaks at 1/3 and 2/3 of the piece.
_SHARES = np.array([0.06, 0.11, 0.17, 0.23, 0.29, 0.34, 0.42, 0.5, 0.58, 0.66, 0.71, 0.77, 0.83, 0.89, 0.94])

# Tangents that stand symmetrically to the chord within this angle make one arc [rad]: rounding of directions.
_SINGLE = 1e-9

# A bulge below this is a line: its arc rises by less than rounding of its chord.
_STRAIGHT = 1e-15

# Samples by which the angle that a stretch turns is followed.
_SAMPLES = 257


def arcs(track: Track, tolerance: float) -> Outline:
    """Approximate a curve by arcs and lines. ``tolerance``: largest distance from the curve [m]."""
    sides = [_sides(part, tolerance) for part in track.parts]
    starts, bulges = (np.concatenate(part) for part in zip(*sides, strict=True))
    return Outline(starts, np.where(np.abs(bulges) < _STRAIGHT, 0.0, bulges))


def _sides(part: Stretch, tolerance: float) -> tuple[Floats, Floats]:
    """Starts and bulges of the sides of a stretch; what is one arc already stays one."""
    phi = np.linspace(part.low, part.high, _SAMPLES)
    directions = part.directions(phi)
    turned = np.concatenate([[0.0], np.cumsum(np.abs(angle_between(directions[:-1], directions[1:])))])

    def errors(cuts: Floats) -> Floats:
        """Distance over tolerance; a piece that turns too far errs as well."""
        turn = np.diff(np.interp(cuts, phi, turned)) / _TURN
        return np.asarray(np.maximum(_distances(part, cuts) / tolerance, turn**_ORDER))

    cuts = equal_errors(errors, part.low, part.high, _ORDER, 1.0)
    single, which = _single_arcs(part, cuts)
    first, second = _biarcs(part, cuts)
    starts = np.stack([np.where(which[:, None], single.starts, first.starts), second.starts], axis=1)
    bulges = np.stack([np.where(which, single.bulges, first.bulges), second.bulges], axis=1)
    kept = np.stack([np.ones_like(which), ~which], axis=1)
    return starts[kept], bulges[kept]


def _distances(part: Stretch, cuts: Floats) -> Floats:
    """Largest distance of the curve from each biarc, at samples, (n,) [m]."""
    places = part.points(cuts[:-1, None] + np.diff(cuts)[:, None] * _SHARES)
    first, second = _biarcs(part, cuts)
    return np.asarray(np.minimum(first.distances(places), second.distances(places)).max(axis=1))


def _biarcs(part: Stretch, cuts: Floats) -> tuple[Sides, Sides]:
    p, t = part.points(cuts), part.directions(cuts)
    v, t_0, t_1 = np.diff(p, axis=0), t[:-1], t[1:]
    vt, vv = dot(v, t_0 + t_1), dot(v, v)
    root = np.sqrt(vt**2 + 2 * (1 - dot(t_0, t_1)) * vv)
    # Of pieces that turn no more than they may, d is less than the chord; others only have to stay finite.
    d = np.minimum(vv / np.maximum(vt + root, np.finfo(float).tiny), np.sqrt(vv))[:, None]
    joint = 0.5 * (p[:-1] + d * t_0 + p[1:] - d * t_1)
    first, second = joint - p[:-1], p[1:] - joint
    return (
        Sides(p[:-1], first, np.tan(0.5 * angle_between(t_0, first))),
        Sides(joint, second, np.tan(0.5 * angle_between(second, t_1))),
    )


def _single_arcs(part: Stretch, cuts: Floats) -> tuple[Sides, Bools]:
    """The arc over each piece, and whether it has the tangents at both ends."""
    p, t = part.points(cuts), part.directions(cuts)
    v = np.diff(p, axis=0)
    left, right = angle_between(t[:-1], v), angle_between(v, t[1:])
    return Sides(p[:-1], v, np.tan(0.25 * (left + right))), np.abs(left - right) <= _SINGLE
