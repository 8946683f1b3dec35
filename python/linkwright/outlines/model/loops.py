r"""Closed outlines from the curves of a drawing, and their integrals by Green's theorem.

.. math:: A = \tfrac12 \oint (x\,dy - y\,dx), \quad
    S_x = \tfrac12 \oint x^2\,dy, \quad S_y = -\tfrac12 \oint y^2\,dx, \quad
    I_p = \tfrac13 \oint (x^3\,dy - y^3\,dx)

Source: Green's theorem; Bronshtein et al., *Handbook of Mathematics*, section 8.3.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.files.dxf import DrawingError
from linkwright.outlines.model.curves import Arc, Curve, Line

# Ends within this share of the size of a drawing are one.
SAME = 1e-6

# Relative difference of the integrals over spans and over their halves at which no more halves are taken, and
# how often spans are halved.
_SETTLED, _HALVINGS = 1e-13, 6

# Points by which a curve is drawn and compared with others, for each span of it.
_DRAWN = 24

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)


@dataclass(frozen=True)
class Loop:
    """Curves one after the other and back to the start; those marked run from their end to their start."""

    sides: tuple[tuple[Curve, bool], ...]  # each with whether it is reversed

    @cached_property
    def polygon(self) -> Floats:
        """Points along it, (n, 2)."""
        parts = []
        for curve, is_reversed in self.sides:
            steps = 1 if isinstance(curve, Line) else _DRAWN
            u = _between(curve.cuts, np.arange(steps) / steps)
            points = curve.at(1.0 - u if is_reversed else u)[0]
            parts.append(points)
        return np.concatenate(parts)

    @cached_property
    def gap(self) -> float:
        """Sum of the distances between the ends of sides and the starts of the next ones."""
        ends = [(curve.end, curve.start) if back else (curve.start, curve.end) for curve, back in self.sides]
        starts = [start for start, _ in ends]
        return sum(
            math.dist(end, start) for (_, end), start in zip(ends, starts[1:] + starts[:1], strict=True)
        )

    @cached_property
    def circle(self) -> tuple[Floats, float] | None:
        """Centre and radius, if it is one circle."""
        (first, _), *more = self.sides
        if not isinstance(first, Arc) or first.radius is None:
            return None
        arcs = [curve for curve, _ in more if isinstance(curve, Arc)]
        alike = (
            math.dist(arc.centre, first.centre) <= SAME * first.radius
            and abs((arc.radius or 0.0) - first.radius) <= SAME * first.radius
            for arc in arcs
        )
        return (first.centre, first.radius) if len(arcs) == len(more) and all(alike) else None

    def integrals(self, origin: Floats) -> tuple[Floats, float]:
        """Area, its moments by x and y and its polar moment about an origin, (4,); their relative accuracy.

        Positive if the loop runs counter-clockwise. The accuracy is the difference from half as fine spans.
        """
        before = self._integrals(origin, 1)
        for halving in range(1, _HALVINGS + 1):
            values = self._integrals(origin, 2**halving)
            # All by the size of the loop, so that a moment of zero has an accuracy too.
            reach = math.sqrt(abs(values[3] / values[0])) if values[0] and values[3] / values[0] > 0 else 1.0
            scale = abs(values[0]) * np.array([1.0, reach, reach, reach**2])
            error = float(np.max(np.abs(values - before) / np.where(scale > 0, scale, 1.0)))
            if error <= _SETTLED:
                break
            before = values
        return values, error

    def _integrals(self, origin: Floats, parts: int) -> Floats:
        total = np.zeros(4)
        for curve, is_reversed in self.sides:
            u = _between(curve.cuts, np.arange(parts + 1) / parts, ends=True)
            half = 0.5 * np.diff(u)[:, None]
            nodes = (u[:-1, None] + half * (1 + _NODES)).ravel()
            place, slope = curve.at(nodes)
            (x, y), (dx, dy) = (place - origin).T, slope.T * (half * _WEIGHTS).ravel()
            own = (0.5 * (x * dy - y * dx), 0.5 * x**2 * dy, -0.5 * y**2 * dx, (x**3 * dy - y**3 * dx) / 3)
            total += (-1.0 if is_reversed else 1.0) * np.array([part.sum() for part in own])
        return total

    def encloses(self, point: Floats) -> bool:
        """Whether a point lies inside, by the number of sides that a ray from it crosses."""
        (x, y), (px, py) = self.polygon.T, point
        x2, y2 = np.roll(x, -1), np.roll(y, -1)
        crosses = (y > py) != (y2 > py)
        step = np.where(crosses, y2 - y, 1.0)
        right = px < x + (py - y) / step * (x2 - x)
        return bool((crosses & right).sum() % 2)


def _between(cuts: Floats, shares: Floats, *, ends: bool = False) -> Floats:
    """Parameters at shares of every span of a curve; with `ends`, shares from 0 to 1 share their ends."""
    widths = np.diff(cuts)[:, None]
    inner = cuts[:-1, None] + widths * (shares[:-1] if ends else shares)
    return np.append(inner.ravel(), cuts[-1]) if ends else inner.ravel()


def closed_loops(curves: Sequence[Curve]) -> list[Loop]:
    """The closed outlines that curves form, by their ends. Raises DrawingError: one is open or branches."""
    points = np.concatenate([curve.at(np.linspace(0.0, 1.0, 9))[0] for curve in curves])
    size = float(np.max(np.ptp(points, axis=0))) or 1.0
    if not math.isfinite(size):
        raise DrawingError("a curve with a coordinate that is no finite number", "a plane drawing")
    whole = [curve for curve in curves if _closes(curve, SAME * size)]
    parts = [
        curve
        for curve in curves
        if not _closes(curve, SAME * size) and math.dist(curve.start, curve.end) > SAME * size
    ]
    loops = [Loop(((curve, False),)) for curve in whole]
    return loops + (_joined(parts, SAME * size) if parts else [])


def _closes(curve: Curve, same: float) -> bool:
    if isinstance(curve, Arc):
        return curve.is_closed
    u = np.linspace(0.0, 1.0, 9)
    return math.dist(curve.start, curve.end) <= same and float(np.max(np.ptp(curve.at(u)[0], axis=0))) > same


def _joined(curves: list[Curve], same: float) -> list[Loop]:
    """Loops of curves that meet end to end."""
    from scipy.spatial import cKDTree

    ends = np.array([end for curve in curves for end in (curve.start, curve.end)])
    tree = cKDTree(ends)
    partners: list[list[int]] = [[] for _ in ends]
    for one, other in tree.query_pairs(same):
        partners[one].append(other)
        partners[other].append(one)
    _require_closed(ends, partners, tree)
    loops, left = [], set(range(len(curves)))
    while left:
        first = min(left)
        sides, at = [], 2 * first
        while at // 2 in left:
            left.discard(at // 2)
            # It runs from this end of the curve to the other one.
            sides.append((curves[at // 2], bool(at % 2)))
            at = partners[at ^ 1][0]
        loops.append(Loop(tuple(sides)))
    return loops


def _require_closed(ends: Floats, partners: list[list[int]], tree: object) -> None:
    """Every end meets exactly one other."""
    for end, met in enumerate(partners):
        if len(met) > 1:
            where = place_words(ends[end])
            found = f"{len(met) + 1} curves that meet at {where}"
            raise DrawingError(found, "outlines that do not branch or overlap", "remove the surplus curve")
    open_ends = [end for end, met in enumerate(partners) if not met]
    if not open_ends:
        return
    gaps = [
        (math.dist(ends[one], ends[other]), one, other)
        for n, one in enumerate(open_ends)
        for other in open_ends[n + 1 :]
    ]
    gap, one, other = min(gaps)
    words = f"a gap of {gap:.4g} between {place_words(ends[one])} and {place_words(ends[other])}"
    more = f" and {len(open_ends) - 2} more open ends" if len(open_ends) > 2 else ""
    raise DrawingError(
        f"an open outline: {words}, in units of the drawing{more}",
        "closed outlines",
        "join the curves there, or name the layers of the outline",
    )


def place_words(place: Floats) -> str:
    """Coordinates in the drawing, for messages."""
    x, y = (float(value) for value in place)
    return f"({x:.6g}, {y:.6g})"
