r"""What a controller makes of a cam table: a law between its points.

| interpolation | between two points |
| --- | --- |
| `polynomials` | the polynomial of the table |
| `quintic` | degree 5 by position, velocity and acceleration at both ends |
| `spline` | cubic with continuous acceleration |
| `cubic` | cubic with continuous velocity, that of the parabola through a point and its neighbours |
| `linear` | a straight line |

A spline ends with the slopes of the table where the maker takes them; else it is periodic where the velocity
of the law is, and natural (without acceleration at its ends) where it is not.

Source: de Boor, *A Practical Guide to Splines* (2001), chapter IV.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal

import numpy as np

from linkwright.axes.export.cam_data import CamData
from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.cam.laws.piece import Piece
from linkwright.cam.laws.spline import hermite
from linkwright.kernel.arrays import Floats

Interpolation = Literal["polynomials", "quintic", "spline", "cubic", "linear"]

# Degree of the polynomials of each interpolation, and the order of the derivative that its error contains.
DEGREES: dict[Interpolation, int] = {"polynomials": 7, "quintic": 5, "spline": 3, "cubic": 3, "linear": 1}


def interpolated(data: CamData, how: Interpolation, *, periodic: bool) -> MotionLaw:
    """The law that a controller makes of a table, over the master angle [deg].

    `periodic`: whether velocities at both ends are equal.
    """
    return _MAKERS[how](data, periodic)


def _polynomials(data: CamData, periodic: bool) -> MotionLaw:
    length = np.diff(data.x).tolist()
    pieces = tuple(
        Piece(tuple(c * h**k for k, c in enumerate(powers)))
        for h, powers in zip(length, data.powers, strict=True)
    )
    return MotionLaw(tuple(data.x.tolist()), pieces)


def _quintic(data: CamData, periodic: bool) -> MotionLaw:
    assert data.v is not None
    assert data.a is not None
    return hermite(data.x, np.array([data.y, data.v, data.a]))


def _spline(data: CamData, periodic: bool) -> MotionLaw:
    from scipy.interpolate import CubicSpline

    # What advances is periodic above its mean velocity.
    mean = (data.y[-1] - data.y[0]) / (data.x[-1] - data.x[0])
    above = data.y - mean * (data.x - data.x[0])
    ends: Any = "periodic" if periodic else "natural"
    if data.slopes is not None:
        ends = tuple((1, slope - mean) for slope in data.slopes)
    elif periodic:
        above[-1] = above[0]
    if len(data.x) == 2 and data.slopes is None:
        return _linear(data, periodic)
    curve = CubicSpline(data.x, above, bc_type=ends)
    powers = curve.c[::-1].T.copy()
    powers[:, 0] += mean * (data.x[:-1] - data.x[0])
    powers[:, 1] += mean
    return _polynomials(CamData(data.x, data.y, powers=tuple(map(tuple, powers.tolist()))), periodic)


def _cubic(data: CamData, periodic: bool) -> MotionLaw:
    h, slope = np.diff(data.x), np.diff(data.y) / np.diff(data.x)
    # Beyond both ends: the intervals of the next cycle, or those at the end once more.
    before, after = (
        ((h[-1], slope[-1]), (h[0], slope[0])) if periodic else ((h[0], slope[0]), (h[-1], slope[-1]))
    )
    h = np.concatenate([before[:1], h, after[:1]])
    slope = np.concatenate([before[1:], slope, after[1:]])
    v = (h[1:] * slope[:-1] + h[:-1] * slope[1:]) / (h[1:] + h[:-1])
    return hermite(data.x, np.array([data.y, v]))


def _linear(data: CamData, periodic: bool) -> MotionLaw:
    return hermite(data.x, np.array([data.y]))


_MAKERS: dict[Interpolation, Callable[[CamData, bool], MotionLaw]] = {
    "polynomials": _polynomials,
    "quintic": _quintic,
    "spline": _spline,
    "cubic": _cubic,
    "linear": _linear,
}


def deviation(wanted: MotionLaw, found: MotionLaw, order: int) -> tuple[float, float]:
    """Largest difference of a derivative of two laws over the same stretch, and where it is.

    Looked at between all ends of the pieces of both, at both sides of each, and closer around the largest
    difference in each interval.
    """
    low, high = _stretches(wanted, found)
    row = np.arange(len(low))
    for _ in range(_ROUNDS):
        x = low[:, None] + (high - low)[:, None] * _BETWEEN
        apart = np.abs(found.at(x, order) - wanted.at(x, order))
        most = apart.argmax(axis=1)
        low, high = x[row, np.maximum(most - 1, 0)], x[row, np.minimum(most + 1, _BETWEEN.size - 1)]
    place = int(apart.max(axis=1).argmax())
    return float(apart[place, most[place]]), float(x[place, most[place]])


# Places between two ends of pieces, dense towards both as the extremes of polynomials are.
_BETWEEN = 0.5 - 0.5 * np.cos(np.pi * np.arange(17) / 16)

# Rounds of looking, each closer than the one before.
_ROUNDS = 4

# Share of a whole law below which an interval is rounding, and by which its ends are moved inwards, so that
# they count to the piece on this side.
_NOTHING = 1e-10
_INSIDE = 2e-15


def _stretches(wanted: MotionLaw, found: MotionLaw) -> tuple[Floats, Floats]:
    """Ends of the intervals, moved inside, between the ends of the pieces of both laws."""
    ends = np.unique(np.clip([*wanted.breaks, *found.breaks], wanted.start, wanted.end))
    low, high = ends[:-1], ends[1:]
    kept = high - low > _NOTHING * wanted.length
    return low[kept] + _INSIDE * wanted.length, high[kept] - _INSIDE * wanted.length
