"""One outline with holes: which loops are holes, that none crosses another, and the region's integrals."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.files.dxf import DrawingError
from linkwright.outlines.model.loops import SAME, Loop, place_words

# Sides of polygons that are compared at once.
_BLOCK = 512

# Share of the area that gaps between ends that count as one point may leave out.
_MISSED_MOST = 1e-3


@dataclass(frozen=True)
class Region:
    """What an outline encloses, without its holes."""

    outline: Loop
    holes: tuple[Loop, ...]

    @property
    def loops(self) -> tuple[Loop, ...]:
        """The outline and its holes."""
        return (self.outline, *self.holes)

    def integrals(self) -> tuple[float, Floats, float, float]:
        """Area, centre (2,), polar second moment of area about the centre, and their relative accuracy.

        Raises DrawingError: there is no area, or gaps are as wide as the outline.
        """
        origin = 0.5 * (self.outline.polygon.min(axis=0) + self.outline.polygon.max(axis=0))
        total, error = np.zeros(4), 0.0
        for sign, loop in ((1.0, self.outline), *((-1.0, hole) for hole in self.holes)):
            values, own = loop.integrals(origin)
            # A loop counts as positive whichever way it is drawn.
            total += sign * math.copysign(1.0, values[0]) * values
            error = max(error, own)
        area = float(total[0])
        if not 0 < area < math.inf:
            where = place_words(self.outline.polygon[0])
            raise DrawingError(f"an outline without area at {where}", "an outline that encloses an area")
        # A gap encloses with any point of the outline a triangle that is counted or left out.
        gap = sum(loop.gap for loop in self.loops)
        missed = gap * float(np.linalg.norm(np.ptp(self.outline.polygon, axis=0))) / area
        if missed > _MISSED_MOST:
            found = f"ends that are {gap:.3g} apart in an outline as narrow, at {place_words(origin)}"
            raise DrawingError(found, "ends that meet", "join the curves there")
        error = max(error, missed)
        shift = total[1:3] / area
        return area, origin + shift, float(total[3] - area * (shift @ shift)), error


def region_of(loops: Sequence[Loop]) -> Region:
    """The outline and its holes. Raises DrawingError: loops cross, or there are several outlines."""
    for loop in loops:
        if not np.ptp(loop.polygon, axis=0).max() > 0:
            found = f"an outline without size at {place_words(loop.polygon[0])}"
            raise DrawingError(found, "outlines that enclose an area")
    _require_single(loops)
    _require_apart(loops)
    depths = [sum(other.encloses(loop.polygon[0]) for other in loops if other is not loop) for loop in loops]
    outer = [loop for loop, depth in zip(loops, depths, strict=True) if depth == 0]
    if len(outer) > 1:
        places = " and ".join(place_words(loop.polygon.mean(axis=0)) for loop in outer[:3])
        found = f"{len(outer)} separate outlines, about {places}"
        raise DrawingError(found, "one outline with its holes", "name the layers of the link")
    for loop, depth in zip(loops, depths, strict=True):
        if depth > 1:
            where = place_words(loop.polygon.mean(axis=0))
            raise DrawingError(f"an outline within a hole, about {where}", "holes without anything in them")
    return Region(outer[0], tuple(loop for loop, depth in zip(loops, depths, strict=True) if depth))


def _require_single(loops: Sequence[Loop]) -> None:
    """No outline is drawn twice."""
    for n, loop in enumerate(loops):
        size = float(np.max(np.ptp(loop.polygon, axis=0)))
        for other in loops[:n]:
            apart = max(
                float(np.abs(edge(loop.polygon, axis=0) - edge(other.polygon, axis=0)).max())
                for edge in (np.min, np.max, np.mean)
            )
            if apart <= SAME * size:
                found = f"an outline that is drawn twice, about {place_words(loop.polygon.mean(axis=0))}"
                raise DrawingError(found, "every outline once", "remove one of them")


def _require_apart(loops: Sequence[Loop]) -> None:
    """No outline crosses or touches itself or another, by the points by which they are drawn."""
    starts = np.concatenate([loop.polygon for loop in loops])
    ends = np.concatenate([np.roll(loop.polygon, -1, axis=0) for loop in loops])
    sizes = [len(loop.polygon) for loop in loops]
    whose = np.repeat(np.arange(len(loops)), sizes)
    for first, second in _meetings(starts, ends):
        is_same = whose[first] == whose[second]
        # Sides that follow each other share their ends.
        if is_same and second - first in (1, sizes[whose[first]] - 1):
            continue
        found = "an outline that crosses itself" if is_same else "outlines that cross or touch"
        where = place_words(0.5 * (starts[first] + ends[first]))
        raise DrawingError(f"{found} near {where}", "outlines that neither cross nor touch")


def _meetings(starts: Floats, ends: Floats) -> Iterator[tuple[int, int]]:
    """Pairs of sides that have a point in common, the lower number first."""
    low, high = np.minimum(starts, ends), np.maximum(starts, ends)
    # From left to right a side can meet those alone that begin before it ends.
    order = np.argsort(low[:, 0])
    last = np.searchsorted(low[order, 0], high[order, 0], side="right")
    for block in range(0, len(starts), _BLOCK):
        own = np.arange(block, min(block + _BLOCK, len(starts)))
        counts = last[own] - own - 1
        left = np.repeat(own, counts)
        right = left + 1 + np.arange(len(left)) - np.repeat(np.cumsum(counts) - counts, counts)
        first, second = order[left], order[right]
        near = (low[first, 1] <= high[second, 1]) & (high[first, 1] >= low[second, 1])
        first, second = first[near], second[near]
        a, b, c, d = starts[first], ends[first], starts[second], ends[second]
        meets = (_side(a, b, c) * _side(a, b, d) <= 0) & (_side(c, d, a) * _side(c, d, b) <= 0)
        for one, other in zip(first[meets].tolist(), second[meets].tolist(), strict=True):
            yield min(one, other), max(one, other)


def _side(a: Floats, b: Floats, c: Floats) -> Floats:
    """On which side of the line from a to b the point c lies: −1, 1, or 0 within rounding."""
    u, v = b - a, c - a
    value = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    size = np.linalg.norm(u, axis=1) * np.linalg.norm(v, axis=1)
    return np.where(np.abs(value) > 1e-9 * size, np.sign(value), 0.0)
