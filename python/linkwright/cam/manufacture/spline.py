r"""A closed curve as a B-spline, by degree, knots and control points, from Hermite pieces over the cam angle.

A quintic piece has the curve's place, first and second derivative at both ends, a cubic one place and first
derivative. So the spline is as smooth as the curve, up to curvature (degree 5) or tangent (degree 3), and
errs by :math:`h^6 \lVert p^{(6)}\rVert / 46080` or :math:`h^4 \lVert p^{(4)}\rVert / 384`. A knot is repeated
as often as the smoothness there leaves over; the control points are the pieces' blossoms at neighbouring
knots.

The errors are the remainder of Hermite interpolation with k values at either end, h²ᵏ p⁽²ᵏ⁾/(4ᵏ (2k)!).

Source: de Boor, *A Practical Guide to Splines* (1978), chapter X; Ramshaw, *Blossoms are polar forms*,
Computer Aided Geometric Design 6 (1989) 323–358.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from linkwright.cam.manufacture.arcs import equal_errors
from linkwright.cam.manufacture.curve import Stretch, Track
from linkwright.cam.manufacture.outline import cross
from linkwright.kernel.arrays import Floats, Indices
from linkwright.kernel.errors import InputError

# Samples of a piece from which a place finds the nearest, and rounds of Gauss–Newton from there.
_SAMPLES, _ROUNDS = 9, 4


@dataclass(frozen=True)
class Spline:
    """A closed B-spline with equal weights."""

    degree: int  # 3 or 5
    knots: Floats  # (n + degree + 1,): [rad]
    controls: Floats  # (n, 2): control points; the last is the first again [m]

    @cached_property
    def cuts(self) -> Floats:
        """The different knots, (k + 1,) [rad]."""
        return np.unique(self.knots)

    @cached_property
    def vertices(self) -> Floats:
        """Where the pieces begin, (k, 2) [m]."""
        return self.values(self.cuts[:-1])[0]

    def values(self, x: Floats) -> tuple[Floats, Floats]:
        """Places and first derivatives. ``x`` (…): values of the parameter [rad] → [m], [m/rad], (…, 2)."""
        curve, slope = self._curves
        return curve(x), slope(x)

    @cached_property
    def _curves(self) -> tuple[Any, Any]:
        from scipy.interpolate import BSpline

        curve = BSpline(self.knots, self.controls, self.degree)
        return curve, curve.derivative()

    def at(self, which: Indices, u: Floats) -> Floats:
        """Places on pieces (k,) at shares (k, m) of them, (k, m, 2) [m]."""
        return self.evaluated.at(which, u)

    def distances(self, which: Indices, places: Floats) -> Floats:
        """Distance of places (k, m, 2) from pieces (k,), (k, m) [m]."""
        return self.evaluated.distances(which, places)

    @property
    def evaluated(self) -> EvaluatedSpline:
        """The spline as a path in pieces."""
        return EvaluatedSpline(self.cuts, self.values)


@dataclass(frozen=True)
class EvaluatedSpline:
    """A closed path in pieces, by whatever evaluates it."""

    cuts: Floats  # (n + 1,): ends of the pieces, in the parameter of the path
    # From parameters of any shape to places [m] and first derivatives, (…, 2) each.
    values: Callable[[Floats], tuple[Floats, Floats]]

    @cached_property
    def vertices(self) -> Floats:
        """Where the pieces begin, (n, 2) [m]."""
        return self.values(self.cuts[:-1])[0]

    def at(self, which: Indices, u: Floats) -> Floats:
        """Places on pieces (k,) at shares (k, m) of them, (k, m, 2) [m]."""
        low = self.cuts[which][:, None]
        return self.values(low + u * (self.cuts[which + 1][:, None] - low))[0]

    def distances(self, which: Indices, places: Floats) -> Floats:
        """Distance of places from pieces, by Gauss–Newton from the nearest of samples.

        ``which`` (k,): numbers of pieces; ``places`` (k, m, 2): for each its places [m] → never too small
        [m], (k, m).
        """
        low, high = self.cuts[which][:, None], self.cuts[which + 1][:, None]
        samples = low + (high - low) * np.linspace(0, 1, _SAMPLES)
        gaps = np.linalg.norm(places[:, :, None] - self.values(samples)[0][:, None], axis=-1)
        x = np.take_along_axis(samples, gaps.argmin(axis=-1), axis=1)
        least = gaps.min(axis=-1)
        for _ in range(_ROUNDS):
            place, slope = self.values(x)
            off = places - place
            least = np.minimum(least, np.linalg.norm(off, axis=-1))
            square = np.maximum((slope**2).sum(axis=-1), np.finfo(float).tiny)
            x = np.clip(x + (off * slope).sum(axis=-1) / square, low, high)
        return np.asarray(least)


# Shares of a piece at which it is compared with the curve.
_SHARES = np.linspace(0.05, 0.95, 19)

# No piece is longer, so that none steps over what samples do not see [rad].
_LONGEST = np.pi / 8

# What jumps by less, over the first derivative, is continuous: rounding.
_SMOOTH = 1e-9


def spline(track: Track, tolerance: float, degree: int = 5) -> Spline:
    """Approximate a curve by a B-spline. ``tolerance``: largest distance from the curve [m]."""
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
    order = degree + 1.0

    def errors(cuts: Floats) -> Floats:
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
    """Derivatives by the cam angle that are continuous where stretches meet: 0, 1, or 2 and more."""
    end, start = np.array([before.high]), np.array([after.low])
    speed = np.linalg.norm(before.tangents(end))
    for order, (left, right) in enumerate(
        [(before.tangents(end), after.tangents(start)), (before.seconds(end), after.seconds(start))]
    ):
        if not np.linalg.norm(right - left) <= _SMOOTH * speed:
            return order
    return 2


def _joined(ends: Floats, pieces: Floats, multiplicity: Indices, degree: int) -> Spline:
    """One spline of pieces between ends, with so many knots at each inner end."""
    knots = np.concatenate(
        [
            np.repeat(ends[:1], degree + 1),
            np.repeat(ends[1:-1], multiplicity),
            np.repeat(ends[-1:], degree + 1),
        ]
    )
    arguments = np.lib.stride_tricks.sliding_window_view(knots[1:-1], degree)
    # The piece taken is the longest between the arguments: its extrapolation is smallest.
    first = np.searchsorted(ends, arguments[:, 0], "right") - 1
    last = np.searchsorted(ends, arguments[:, -1], "left")
    first = np.minimum(first, len(pieces) - 1)
    widths = np.diff(ends)
    which = [a + int(widths[a:b].argmax()) if b > a else a for a, b in zip(first, last, strict=True)]
    shares = (arguments - ends[which][:, None]) / widths[which][:, None]
    controls = _blossom(pieces[which], list(shares.T))
    controls[-1] = controls[0]
    return Spline(degree, knots, controls)
