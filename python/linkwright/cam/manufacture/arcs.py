r"""A curve as circular arcs and lines that meet without kinks: biarcs through places of the curve, with its
tangents.

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

import numpy as np
from numpy.typing import NDArray

from linkwright.cam.manufacture.curve import Stretch
from linkwright.cam.manufacture.mesh import equal_errors
from linkwright.cam.manufacture.outline import Outline
from linkwright.cam.manufacture.sides import Sides, angle_between, dot
from linkwright.cam.manufacture.track import Track

Floats = NDArray[np.float64]

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
    """Approximate a curve by arcs and lines.

    Parameters
    ----------
    track : Track
        The curve.
    tolerance : float
        Largest distance from the curve [m].

    Returns
    -------
    Outline
        Tangent-continuous but at the corners of the curve; as few sides as equal errors give.

    Raises
    ------
    ConvergenceError
        The tolerance asks for too many arcs.
    """
    found = [_sides(part, tolerance) for part in track.parts]
    starts, bulges = (np.concatenate(each) for each in zip(*found, strict=True))
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
    """First and second arc of each piece."""
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


def _single_arcs(part: Stretch, cuts: Floats) -> tuple[Sides, NDArray[np.bool_]]:
    """The arc over each piece, and whether it has the tangents at both ends."""
    p, t = part.points(cuts), part.directions(cuts)
    v = np.diff(p, axis=0)
    left, right = angle_between(t[:-1], v), angle_between(v, t[1:])
    return Sides(p[:-1], v, np.tan(0.25 * (left + right))), np.abs(left - right) <= _SINGLE
