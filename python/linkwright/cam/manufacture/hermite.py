r"""The B-spline of a curve, from Hermite pieces over the cam angle.

A quintic piece has the curve's place, first and second derivative at both ends, a cubic one place and first
derivative. So the spline is as smooth as the curve, up to curvature (degree 5) or tangent (degree 3), and
errs by :math:`h^6 \lVert p^{(6)}\rVert / 46080` or :math:`h^4 \lVert p^{(4)}\rVert / 384`. A knot is repeated
as often as the smoothness there leaves over; the control points are the pieces' blossoms at neighbouring
knots.

The errors are the remainder of Hermite interpolation with k values at either end, h²ᵏ p⁽²ᵏ⁾/(4ᵏ (2k)!).

Source: Ramshaw, *Blossoms are polar forms*, Computer Aided Geometric Design 6 (1989) 323–358.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from linkwright.cam.manufacture.curve import Stretch
from linkwright.cam.manufacture.mesh import equal_errors
from linkwright.cam.manufacture.sides import cross
from linkwright.cam.manufacture.spline import Spline
from linkwright.cam.manufacture.track import Track
from linkwright.kernel.errors import InputError

Floats = NDArray[np.float64]

# Shares of a piece at which it is compared with the curve.
_SHARES = np.linspace(0.05, 0.95, 19)

# No piece is longer, so that none steps over what samples do not see [rad].
_LONGEST = np.pi / 8

# What jumps by less, over the first derivative, is continuous: rounding.
_SMOOTH = 1e-9


def spline(track: Track, tolerance: float, degree: int = 5) -> Spline:
    """Approximate a curve by a B-spline.

    Parameters
    ----------
    track : Track
        The curve.
    tolerance : float
        Largest distance from the curve [m].
    degree : int
        5, with the curvature of the curve at the knots, or 3, with its tangents.

    Returns
    -------
    Spline
        With the cam angle as parameter; as few pieces as equal errors give.

    Raises
    ------
    InputError
        Another degree.
    ConvergenceError
        The tolerance asks for too many pieces.
    """
    if degree not in (3, 5):
        raise InputError(f"degree {degree} of a spline: expected 3 or 5")
    cuts = [_cuts(part, tolerance, degree) for part in track.parts]
    pieces = np.concatenate([_pieces(part, x, degree) for part, x in zip(track.parts, cuts, strict=True)])
    starts = [x - part.low + low for x, part, low in zip(cuts, track.parts, track.ends, strict=False)]
    ends = np.concatenate([*(x[:-1] for x in starts), [track.period]])
    smooth = [_smoothness(a, b) for a, b in zip(track.parts, track.parts[1:], strict=False)]
    inner = np.full(len(ends) - 2, degree // 2)
    inner[np.cumsum([len(x) - 1 for x in cuts])[:-1] - 1] = np.minimum(smooth, degree // 2)
    return _joined(ends, pieces, degree - inner, degree)


def _cuts(part: Stretch, tolerance: float, degree: int) -> Floats:
    """Where to cut a stretch."""
    order = degree + 1.0

    def errors(cuts: Floats) -> Floats:
        """Distance over tolerance; too long a piece errs as well."""
        return np.maximum(_distances(part, cuts, degree) / tolerance, (np.diff(cuts) / _LONGEST) ** order)

    return equal_errors(errors, part.low, part.high, order, 1.0)


def _distances(part: Stretch, cuts: Floats, degree: int) -> Floats:
    """Largest distance of the pieces across the curve, at samples, (n,) [m]."""
    pieces = _pieces(part, cuts, degree)
    low, width = cuts[:-1, None], np.diff(cuts)[:, None]
    phi = low + width * _SHARES
    own = _blossom(pieces[:, :, None], [np.broadcast_to(_SHARES, phi.shape)] * degree)
    return np.asarray(np.abs(cross(part.directions(phi), own - part.points(phi))).max(axis=1))


def _pieces(part: Stretch, cuts: Floats, degree: int) -> Floats:
    """Bézier points of the Hermite pieces, (n, degree + 1, 2) [m]."""
    h = np.diff(cuts)[:, None]
    p, d1 = part.points(cuts), part.tangents(cuts)
    (p_0, p_1), (v_0, v_1) = (p[:-1], p[1:]), (h * d1[:-1] / degree, h * d1[1:] / degree)
    if degree == 3:
        return np.stack([p_0, p_0 + v_0, p_1 - v_1, p_1], axis=1)
    d2 = part.seconds(cuts)
    a_0, a_1 = h**2 * d2[:-1] / 20, h**2 * d2[1:] / 20
    return np.stack([p_0, p_0 + v_0, p_0 + 2 * v_0 + a_0, p_1 - 2 * v_1 + a_1, p_1 - v_1, p_1], axis=1)


def _blossom(points: Floats, shares: list[Floats]) -> Floats:
    """De Casteljau's recursion with another share at each level; points (n, degree + 1, …, 2)."""
    rows = list(np.moveaxis(points, 1, 0))
    for share in shares:
        rows = [a + share[..., None] * (b - a) for a, b in pairwise(rows)]
    return np.asarray(rows[0])


def _smoothness(before: Stretch, after: Stretch) -> int:
    """How many derivatives by the cam angle go on where one stretch meets the next: 0, 1 or 2 and more."""
    end, start = np.array([before.high]), np.array([after.low])
    speed = np.linalg.norm(before.tangents(end))
    for order, (left, right) in enumerate(
        [(before.tangents(end), after.tangents(start)), (before.seconds(end), after.seconds(start))]
    ):
        if not np.linalg.norm(right - left) <= _SMOOTH * speed:
            return order
    return 2


def _joined(ends: Floats, pieces: Floats, multiplicity: NDArray[np.intp], degree: int) -> Spline:
    """One spline of pieces between ends, with so many knots at each inner end."""
    knots = np.concatenate(
        [
            np.repeat(ends[:1], degree + 1),
            np.repeat(ends[1:-1], multiplicity),
            np.repeat(ends[-1:], degree + 1),
        ]
    )
    arguments = np.lib.stride_tricks.sliding_window_view(knots[1:-1], degree)
    # The piece taken is the longest between the arguments: that goes least beyond its own ends.
    first = np.searchsorted(ends, arguments[:, 0], "right") - 1
    last = np.searchsorted(ends, arguments[:, -1], "left")
    first = np.minimum(first, len(pieces) - 1)
    widths = np.diff(ends)
    which = [a + int(widths[a:b].argmax()) if b > a else a for a, b in zip(first, last, strict=True)]
    shares = (arguments - ends[which][:, None]) / widths[which][:, None]
    controls = _blossom(pieces[which], list(shares.T))
    controls[-1] = controls[0]
    return Spline(degree, knots, controls)
