r"""Closed polygons: area and its moments by Green's theorem, crossings, points inside.

With $c = x_j y_{j+1} - x_{j+1} y_j$ over all sides,

.. math:: A = \tfrac12 \sum c, \quad A x_S = \tfrac16 \sum c\,(x_j + x_{j+1}), \quad
    I_p = \tfrac1{12} \sum c\,(x_j^2 + x_j x_{j+1} + x_{j+1}^2 + y_j^2 + y_j y_{j+1} + y_{j+1}^2)

References
----------
.. [1] Steger, On the calculation of arbitrary moments of polygons, TU München, FGBV-96-05, 1996.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations
from typing import NamedTuple

from linkwright.kernel.numerics.tangent import total

Point = tuple[float, float]
Points = tuple[Point, ...]


class AreaMoments(NamedTuple):
    """What an area weighs."""

    area: float  # its size [m²]
    centroid: Point  # along and across [m]
    polar: float  # polar second moment about the centroid [m⁴]


def sides(corners: Points) -> Iterator[tuple[Point, Point]]:
    """The sides of a closed polygon, each with its two ends."""
    return zip(corners, (*corners[1:], corners[0]), strict=True)


def _cross(a: Point, b: Point) -> float:
    return a[0] * b[1] - b[0] * a[1]


def signed_area(corners: Points) -> float:
    """Area of a polygon [m²], positive if its corners go round counter-clockwise."""
    area: float = total(_cross(a, b) for a, b in sides(corners)) / 2
    return area


def area_moments(corners: Points) -> AreaMoments:
    """Area, centroid and polar second moment of a polygon that does not cross itself.

    About the centroid; the area is positive. `corners`: in order, either way round, along and across [m].
    """
    # Counted from a corner, so that a polygon far from the origin loses no digits.
    x_0, y_0 = corners[0]
    near = tuple((x - x_0, y - y_0) for x, y in corners)
    area = signed_area(near)
    weighed = [(_cross(a, b), a, b) for a, b in sides(near)]
    x = total(c * (a[0] + b[0]) for c, a, b in weighed) / (6 * area)
    y = total(c * (a[1] + b[1]) for c, a, b in weighed) / (6 * area)
    squares = (c * (a[n] ** 2 + a[n] * b[n] + b[n] ** 2) for c, a, b in weighed for n in (0, 1))
    polar = total(squares) / 12 - area * (x * x + y * y)
    return AreaMoments(abs(area), (x_0 + x, y_0 + y), abs(polar))


def _side_of(a: Point, b: Point, p: Point) -> float:
    """Twice the area of the triangle a, b, p: its sign says on which side of the line p lies."""
    return (b[0] - a[0]) * (p[1] - a[1]) - (p[0] - a[0]) * (b[1] - a[1])


def _between(a: Point, b: Point, p: Point) -> bool:
    """Whether a point on the line through a and b lies between them."""
    return min(a[0], b[0]) <= p[0] <= max(a[0], b[0]) and min(a[1], b[1]) <= p[1] <= max(a[1], b[1])


def _meet(a: Point, b: Point, c: Point, d: Point) -> bool:
    s, t = (_side_of(a, b, c), _side_of(a, b, d)), (_side_of(c, d, a), _side_of(c, d, b))
    if s[0] * s[1] < 0 and t[0] * t[1] < 0:
        return True
    on = ((a, b, c, s[0]), (a, b, d, s[1]), (c, d, a, t[0]), (c, d, b, t[1]))
    return any(side == 0 and _between(p, q, r) for p, q, r, side in on)


def _folds(before: Point, corner: Point, after: Point) -> bool:
    """Whether the side after a corner folds back onto the side before it, or one has no length."""
    ahead = (before[0] - corner[0]) * (after[0] - corner[0]) + (before[1] - corner[1]) * (
        after[1] - corner[1]
    )
    return _side_of(before, corner, after) == 0 and ahead >= 0


def first_crossing(corners: Points) -> tuple[int, int] | None:
    """The first two sides of a polygon that meet elsewhere than in the corner they share.

    Numbers of the sides from 0; None if the outline is simple. `corners`: in order, at least three [m].
    """
    listed, n = list(sides(corners)), len(corners)
    for i, j in combinations(range(n), 2):
        (a, b), (c, d) = listed[i], listed[j]
        if j == i + 1 and _folds(a, b, d):
            return i, j
        if (i, j) == (0, n - 1) and _folds(c, a, b):
            return i, j
        if j != i + 1 and (i, j) != (0, n - 1) and _meet(a, b, c, d):
            return i, j
    return None


def holds(corners: Points, point: Point) -> bool:
    """Whether a point [m] lies inside a polygon [m] that does not cross itself."""
    inside = False
    for a, b in sides(corners):
        if (a[1] > point[1]) != (b[1] > point[1]):
            left = (b[0] - a[0]) * (point[1] - a[1]) / (b[1] - a[1]) + a[0]
            inside ^= point[0] < left
    return inside
