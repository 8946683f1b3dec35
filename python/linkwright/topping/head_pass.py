r"""One pass of the edge over a head, to be drawn: where the edge is, and the outline of what it leaves.

Chords of the head lie at :math:`p = \tfrac{d}{2}\sin u` with even steps of u, where their length is smooth.
Each is crossed at one place q of the middle of the edge, or at several if the edge retreats; what lies beyond
L/2 from all of them is left. Areas that are left on neighbouring chords are joined to one outline. Where an
edge turns back, the crossings change at once: there are chords on both sides of these places.

References
----------
.. [1] Derived here; areas are those of `coverage` to some 1e-4 of the head.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.topping.coverage import coverage
from linkwright.topping.edge import Edge

# A part of a chord that is left: number of the chord, its place p, and its ends along the edge.
Part = tuple[int, float, float, float]

# Chords, and instants of the pass.
_CHORDS, _TIMES = 721, 2401

# Distance of two chords about a place where the edge turns back, over the radius.
_BESIDE = 1e-9

# An edge that stands is drawn while the machine goes so many head diameters.
_STANDING = 2.0


@dataclass(frozen=True)
class HeadPass(Result):
    """A pass."""

    time: Annotated[
        Floats, Label("time", "t", "s", "Zero when the middle of the edge is abreast of the head's centre.")
    ]
    middle_x: Annotated[
        Floats, Label("middle of the edge along the row", "x", "m", "From the head's centre.")
    ]
    middle_y: Annotated[
        Floats, Label("middle of the edge across the row", "y", "m", "To the left of the row's axis.")
    ]
    along: Annotated[Floats, Label("middle of the edge along the edge", "q", "m", "From the head's centre.")]
    normal: Annotated[
        Floats, Label("middle of the edge normal to the edge", "p", "m", "From the head's centre.")
    ]
    edge_angle: Annotated[float, Label("edge angle", "α", "rad")]
    length: Annotated[float, Label("length of the edge", "L", "m")]
    diameter: Annotated[float, Label("diameter of the head", "d", "m")]
    offset: Annotated[float, Label("offset of the head", "δ", "m")]
    phase: Annotated[float, Label("phase of the knife", "φ", "rad")]
    outlines: Annotated[
        tuple[Floats, ...],
        About("Corners of the areas that are left, as x and y of the middle, each (k, 2) [m]."),
    ]

    @property
    def ends(
        self,
    ) -> Annotated[Floats, Label("right and left end of the edge", "", "m", shape="(2, n, 2)")]:
        """Right and left end of the edge over the time, (2, n, 2)."""
        half = 0.5 * self.length * np.array([np.sin(self.edge_angle), np.cos(self.edge_angle)])
        middle = np.stack([self.middle_x, self.middle_y], axis=-1)
        return np.stack([middle - half, middle + half])

    @property
    def uncut_area(self) -> Annotated[float, Label("area inside the outlines", "", "m²")]:
        """Area inside the outlines."""
        return float(sum(_area(outline) for outline in self.outlines))


def head_pass(edge: Edge, diameter: float, offset: float, phase: float, length: float) -> HeadPass:
    """Follow the edge over a head.

    ``diameter``, ``offset``: d > 0, and place of the head's centre to the left of the row [m]; ``phase``: of
    the knife when the middle of the edge is abreast of the centre [rad]; ``length``: of the edge [m].
    """
    sin, cos = float(np.sin(edge.angle)), float(np.cos(edge.angle))
    end = _end(edge, 0.5 * diameter, abs(offset))
    time = np.linspace(-end, end, _TIMES)
    x, y = edge.forward_speed * time, edge.knife.at(time, phase)
    q, p = edge.place(time, phase, offset)
    parts = _left(p, q, 0.5 * diameter, 0.5 * length, stands=edge.stands)
    shapes = [_outline(chain) for parts_of in parts for chain in _chains(parts_of)]
    turn = np.array([[cos, -sin], [sin, cos]])
    outlines = tuple(shape @ turn + np.array([0.0, offset]) for shape in shapes)
    return HeadPass(time, x, y, q, p, edge.angle, length, diameter, offset, float(phase), outlines)


def worse_edge(edges: Sequence[Edge], diameter: float, offset: float, phase: float, length: float) -> Edge:
    """The worse of the two directions of an edge over a head: it leaves more, or else needs more.

    ``diameter``, ``offset``: d, and place of the head's centre to the left of the row [m]; ``phase``: of the
    knife when the middle of the edge is abreast of the centre [rad]; ``length``: of the edge [m].
    """

    def badness(edge: Edge) -> tuple[float, float]:
        covered = coverage(edge, diameter, offset, phase, length=length)
        return float(covered.uncut[0]), float(covered.length_needed[0])

    return max(edges, key=badness)


def _end(edge: Edge, radius: float, offset: float) -> float:
    """Time after which the edge is surely beyond the head."""
    if edge.stands:
        return 2 * _STANDING * radius / edge.forward_speed
    return edge.half_pass(2.1 * radius, offset)


def _left(p: Floats, q: Floats, radius: float, half: float, *, stands: bool) -> list[list[Part]]:
    """Parts of chords on the right of the edge, on its left, and between passes."""
    levels = _levels(p, radius)
    chords = np.sqrt(np.clip(radius**2 - levels**2, 0.0, None)).tolist()
    right: list[Part] = []
    left: list[Part] = []
    between: list[Part] = []
    crossed = zip(levels.tolist(), chords, _crossings(p, q, levels, stands), strict=True)
    for i, (level, chord, places) in enumerate(crossed):
        if not places:
            right.append((i, level, -chord, chord))
            continue
        right.append((i, level, -chord, min(chord, places[0] - half)))
        left.append((i, level, max(-chord, places[-1] + half), chord))
        for low, high in pairwise(places):
            between.append((i, level, max(-chord, low + half), min(chord, high - half)))
    return [[part for part in parts if part[3] > part[2]] for parts in (right, left, between)]


def _levels(p: Floats, radius: float) -> Floats:
    even = radius * np.sin(np.linspace(-0.5 * np.pi, 0.5 * np.pi, _CHORDS))
    rise = np.diff(p)
    turns = p[1:-1][rise[1:] * rise[:-1] <= 0]
    beside = (turns[:, None] + radius * _BESIDE * np.array([-1, 1])).ravel()
    return np.unique(np.concatenate([even, beside[np.abs(beside) < radius]]))


def _crossings(p: Floats, q: Floats, levels: Floats, stands: bool) -> list[list[float]]:
    if stands:
        return [[] for _ in levels]
    ahead = p[None, :] > levels[:, None]
    rows, before = np.nonzero(ahead[:, 1:] != ahead[:, :-1])
    share = (levels[rows] - p[before]) / (p[before + 1] - p[before])
    places = q[before] + share * (q[before + 1] - q[before])
    return [sorted(places[rows == row].tolist()) for row in range(len(levels))]


def _chains(parts: Sequence[Part]) -> list[list[Part]]:
    chains: list[list[Part]] = []
    for part in parts:
        chain = next((chain for chain in chains if _touch(chain[-1], part)), None)
        if chain is None:
            chains.append([part])
        else:
            chain.append(part)
    return chains


def _touch(one: Part, other: Part) -> bool:
    return other[0] == one[0] + 1 and other[2] <= one[3] and one[2] <= other[3]


def _outline(chain: Sequence[Part]) -> Floats:
    """Corners round a chain: p and q, (2n, 2) [m]."""
    low, high = [(p, low) for _, p, low, _ in chain], [(p, high) for _, p, _, high in chain]
    return np.array([*low, *high[::-1]])


def _area(corners: Floats) -> float:
    """Area of a polygon [m²]."""
    x, y = corners.T
    return 0.5 * abs(float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))))
