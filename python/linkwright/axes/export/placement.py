r"""Where the points of a cam table stand, for a minimum deviation of the position.

The error of an interpolation of degree k over an interval h is proportional to :math:`h^p |s^{(p)}|`,
p = k + 1. It is the same over all intervals if each has the same share of

.. math:: \int |s^{(p)}|^{1/p} \, dx .

Points stand at the segment boundaries where a derivative up to the degree jumps, and between them by equal
shares. Splines pass an error on to their neighbours, the more the longer these are: a part of the points is
therefore placed at equal distances, the part with the minimum measured deviation. Where
velocity or acceleration jumps, a table with derivatives has two points close together, and changes from one
to the other between them.

Source: de Boor, *A Practical Guide to Splines* (2001), chapter XII.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from linkwright.axes.export.cam_data import CamData
from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.cam.laws.piece import Piece
from linkwright.cam.laws.spline import hermite
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import ExchangeError

# A jump below this share of the peak of its derivative is rounding.
_ROUNDING = 1e-9

# Half the distance of the two points at a jump, over the shorter of the neighbouring sections.
_RAMP = 1e-3

# Places per piece of a law where its derivative is looked at.
_LOOKED = 64

# Decimals of the master angle of a point that stands anywhere.
_DECIMALS = 9

# Share of the peak of a derivative within which a value is a shorter number.
_TIDY = 2e-15

# Degree of the polynomials that a controller takes.
_DEGREE_MAX = 7


def placed(law: MotionLaw, degree: int, n: int, even: float, *, ramps: bool) -> Floats:
    """Master angles of at most n points, (m,); fewer where they suffice for the law itself.

    `degree`: of the interpolation; `even`: share of the points that is placed at equal distances; `ramps`:
    whether there are two points at each jump of velocity or acceleration. Raises `ExchangeError` if n are too
    few for the segment boundaries.
    """
    ends = _boundaries(law, degree, n, ramps)
    blocks = [_Block(law, low, high, degree + 1) for low, high in pairwise(ends)]
    return _divided(blocks, n - 1, even)


class _Block:
    """A stretch of a law between two points, and how its points lie."""

    def __init__(self, law: MotionLaw, low: float, high: float, order: int) -> None:
        inner = [x for x in law.breaks if low < x < high]
        ends = np.array([low, *inner, high])
        u = (np.arange(_LOOKED) + 0.5) / _LOOKED
        middle = (ends[:-1, None] + np.diff(ends)[:, None] * u).ravel()
        size = np.abs(law.at(middle, order))
        # What rounding leaves of a derivative that a polynomial does not have.
        below = np.abs(law.at(middle, order - 1)).max(initial=0.0) / (high - low)
        size[size <= _ROUNDING * below] = 0.0
        self.low, self.high = low, high
        self.weights = np.repeat(np.diff(ends) / _LOOKED, _LOOKED) * size ** (1 / order)
        self.lengths = np.repeat(np.diff(ends) / _LOOKED, _LOOKED)

    @property
    def weight(self) -> float:
        """Its share of the error."""
        return float(self.weights.sum())

    def points(self, n: int, even: float, weight: float, length: float) -> Floats:
        """Its start and the places inside that make n intervals."""
        density = (1 - even) * self.weights / (weight or 1.0) + even * self.lengths / length
        if not density.any():
            density = self.lengths
        grown = np.concatenate([[0.0], np.cumsum(density)])
        place = np.concatenate([[self.low], self.low + np.cumsum(self.lengths)])
        x: Floats = np.interp(grown[-1] * np.arange(n) / n, grown, place)
        # Between the boundaries any place is as good as one that is short to write.
        x[1:] = np.round(x[1:], _DECIMALS)
        return x


def _divided(blocks: Sequence[_Block], most: int, even: float) -> Floats:
    """Places that divide blocks into at most so many intervals, each time the one with the largest share."""
    weight, length = sum(b.weight for b in blocks), sum(b.high - b.low for b in blocks)
    even = 0.0 if weight == 0.0 and even < 1.0 else even
    shares = [(1 - even) * b.weight / (weight or 1.0) + even * (b.high - b.low) / length for b in blocks]
    counts = [1] * len(blocks)
    queue = [(-share, i) for i, share in enumerate(shares) if share > 0.0]
    heapq.heapify(queue)
    for _ in range(most - len(blocks) if queue else 0):
        _, i = queue[0]
        counts[i] += 1
        heapq.heapreplace(queue, (-shares[i] / counts[i], i))
    parts = [b.points(k, even, weight, length) for b, k in zip(blocks, counts, strict=True)]
    return np.concatenate([*parts, [blocks[-1].high]])


def _boundaries(law: MotionLaw, degree: int, n: int, ramps: bool) -> list[float]:
    """Points that a table must have: both ends, and the segment boundaries.

    Boundaries at which no derivative below the fourth jumps are left out where they are too many.
    """
    for order in (degree, min(degree, 3)):
        ends = [law.start]
        for low, x, high, first in _jumps(law, order):
            beside = _RAMP * min(x - low, high - x)
            ends += [x - beside, x + beside] if ramps and first <= 2 else [x]
        ends.append(law.end)
        if len(ends) <= n:
            return ends
    raise ExchangeError(
        f"the segment boundaries of the law need {len(ends)} points, and {n} are permitted; take more "
        "points, or another format"
    )


def _jumps(law: MotionLaw, most: int) -> list[tuple[float, float, float, int]]:
    """Inner breaks where a derivative up to an order jumps: before it, itself, after it, and its order."""
    first = np.full(len(law.breaks) - 2, most + 1)
    u = np.linspace(0.0, 1.0, 9)
    for order in range(most, -1, -1):
        scale = max(float(np.abs(piece.at(u)).max()) for piece in law.derivative(order).pieces)
        first[np.abs(law.jumps(order)) > _ROUNDING * scale] = order
    kept = [0, *(np.flatnonzero(first <= most) + 1).tolist(), len(law.breaks) - 1]
    b = law.breaks
    return [(b[i], b[k], b[m], int(first[k - 1])) for i, k, m in zip(kept, kept[1:], kept[2:], strict=False)]


def sampled(law: MotionLaw, x: Floats, orders: int) -> list[Floats]:
    """Value and derivatives of a law at places, those at its end from inside."""
    rows = []
    for order in range(orders):
        row = law.at(x, order)
        row[-1] = law.value(float(x[-1]), order, "before")
        rows.append(_tidy(row))
    return rows


def _tidy(values: Floats) -> Floats:
    """Values without what rounding left of them: 20 for 20.000000000000018."""
    peak = float(np.abs(values).max(initial=0.0))
    if peak == 0.0:
        return values
    short = np.round(values, max(13 - math.ceil(math.log10(peak)), 0))
    return np.where(np.abs(short - values) <= _TIDY * peak, short, values) + 0.0


def as_polynomials(law: MotionLaw, n: int) -> CamData:
    """The law in polynomials of degree 7 or less: its own pieces, others with three equal derivatives.

    `n`: ends of the pieces, at most. Pieces of the law with harmonics, or of a higher degree, are divided.
    Raises `ExchangeError` if the law has more pieces.
    """
    if len(law.breaks) > n:
        raise ExchangeError(
            f"the law has {len(law.pieces)} pieces, and {n - 1} are permitted; take more points"
        )
    own = [not piece.harmonics and len(piece.polynomial) <= _DEGREE_MAX + 1 for piece in law.pieces]
    stretches = [
        (low, high) for (low, high), exact in zip(pairwise(law.breaks), own, strict=True) if not exact
    ]
    blocks = [_Block(law, low, high, _DEGREE_MAX + 1) for low, high in stretches]
    places = _divided(blocks, n - 1 - sum(own), 0.0) if blocks else np.array([])
    ends, powers = [law.start], list[tuple[float, ...]]()
    for (low, high), piece, exact in zip(pairwise(law.breaks), law.pieces, own, strict=True):
        if exact:
            pieces, x = [(high - low, piece)], np.array([low, high])
        else:
            x = np.concatenate([places[(places >= low) & (places < high)], [high]])
            within = MotionLaw((low, high), (piece,))
            made = hermite(x, np.array(sampled(within, x, 4)))
            pieces = list(zip(np.diff(x).tolist(), made.pieces, strict=True))
        ends += x[1:].tolist()
        powers += [_coefficients(part, length) for length, part in pieces]
    x = np.array(ends)
    return CamData(x, sampled(law, x, 1)[0], powers=tuple(powers))


def _coefficients(piece: Piece, length: float) -> tuple[float, ...]:
    """Coefficients of powers of the distance from the start of a piece."""
    return tuple(c / length**k for k, c in enumerate(piece.polynomial)) or (0.0,)
