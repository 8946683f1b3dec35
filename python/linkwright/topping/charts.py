"""Lengths of the edge over the diameter of roots and over the speed of the knife, for some forward speeds.

The chart of paper 5, its figure 3, for the angle, cut height and offset of any topper, with the exact lengths
beside the printed bound; where lengths that are said to do for ranges of speeds lie.

References
----------
.. [1] Paper 5, figure 3 and (10).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.papers.published_lengths import PAPER, WAYS, Stroke, bands_of, lengths_over
from linkwright.topping.coverage import coverage
from linkwright.topping.edge import Edge
from linkwright.topping.model.topper import Topper
from linkwright.topping.required_length import (
    constant_speed_lengths,
    every_phase_length,
    length_consistent,
    length_published,
)
from linkwright.topping.roots import head_diameter
from linkwright.topping.worst_head import worst_head

# Forward speeds of the chart over that of the machine; its ends along both axes likewise.
_FORWARD = 0.85, 1.0, 1.15
_ROOTS, _SPEEDS = (0.6, 1.4), (0.0, 1.6)

# Points of a line in closed form, and of one for the motion of the knife.
_POINTS, _FEW = 81, 17


@dataclass(frozen=True)
class Lines(Result):
    """Minimum lengths of the edge along one axis."""

    along: Annotated[Floats, About("Root diameters [m], or mean knife speeds [m/s].", "(n,)")]
    published: Annotated[
        Floats, Label("minimum length by (10)", "", "m", "A row for each forward speed.", shape="(3, n)")
    ]
    consistent: Annotated[Floats, Label("minimum length by (4)", "", "m", "Likewise.", shape="(3, n)")]
    constant_speed: Annotated[
        Floats, Label("exact minimum length at constant speed", "", "m", "Likewise.", shape="(3, n)")
    ]
    moved_along: Annotated[
        Floats,
        About(
            "The like axis for the motion of the knife; empty if it does not turn back over a head.", "(k,)"
        ),
    ]
    moved: Annotated[
        Floats,
        Label(
            "exact minimum length for the motion of the knife",
            "",
            "m",
            "At the machine's own forward speed; NaN where the edge retreats.",
            shape="(k,)",
            over="moved",
        ),
    ]


@dataclass(frozen=True)
class LengthChart(Result):
    """The chart."""

    forward_speeds: Annotated[tuple[float, ...], About("Speeds along the row, v [m/s].")]
    root_diameter: Annotated[float, Label("diameter of a root", "D", "m")]
    knife_speed: Annotated[float, Label("mean speed across the row", "v_h", "m/s")]
    edge_length: Annotated[float, Label("length of the edge", "L", "m")]
    over_roots: Annotated[Lines, About("Over root diameters at the machine's mean knife speed.")]
    over_speeds: Annotated[Lines, About("Over mean knife speeds at the machine's root diameter.")]


def length_chart(described: Topper, edges: Sequence[Edge]) -> LengthChart:
    """Lengths about a topper's own numbers."""
    D, v_h = described.root_diameter, edges[0].knife.mean_speed
    forward = tuple(share * described.forward_speed for share in _FORWARD)
    # Roots that the cut leaves whole have no head.
    least = max(_ROOTS[0] * D, 1.02 * described.cut_height)
    roots, few = (np.linspace(least, max(_ROOTS[1] * D, least), n) for n in (_POINTS, _FEW))
    over_roots = _lines(described, forward, roots, np.full(_POINTS, v_h))
    # A knife at rest has no speed of its own to go about.
    greatest = _SPEEDS[1] * (v_h or described.forward_speed / 4)
    speeds = np.linspace(_SPEEDS[0], greatest, _POINTS)
    over_speeds = _lines(described, forward, np.full(_POINTS, D), speeds)
    if edges[0].knife.rate:
        d = head_diameter(few, described.cut_height).tolist()
        moved = np.array([_moved(described, edges, diameter) for diameter in d])
        over_roots = replace(over_roots, moved_along=few, moved=moved)
        some = np.linspace(greatest / _FEW, greatest, _FEW)
        own = float(head_diameter(D, described.cut_height))
        moved = np.array([_moved(described, edges, own, value / v_h) for value in some.tolist()])
        over_speeds = replace(over_speeds, moved_along=some, moved=moved)
    over_speeds = replace(over_speeds, along=speeds)
    return LengthChart(forward, D, v_h, described.edge_length, over_roots, over_speeds)


def _lines(described: Topper, forward: Sequence[float], roots: Floats, speeds: Floats) -> Lines:
    alpha, delta, v = described.edge_angle, described.offset, np.array(forward)[:, None]
    d = head_diameter(roots, described.cut_height)
    band = d + 2 * delta
    none = np.zeros(0)
    return Lines(
        roots,
        length_published(band, alpha, speeds / v),
        length_consistent(band, alpha, speeds / v),
        constant_speed_lengths(d, delta, alpha, v, speeds).max(axis=0),
        none,
        none,
    )


def _moved(described: Topper, edges: Sequence[Edge], diameter: float, pace: float = 1.0) -> float:
    """Exact length for a knife that goes through its motion at another speed; NaN if the edge retreats."""
    paced = [replace(edge, knife=replace(edge.knife, rate=pace * edge.knife.rate)) for edge in edges]
    if any(edge.retreats for edge in paced):
        return float("nan")
    phase, offset = described.motion.phase, described.offset
    if phase is None:
        return float(every_phase_length(diameter, offset, described.edge_angle, paced[0].knife.stroke))

    def needs(edge: Edge, beside: Floats, angle: Floats) -> Floats:
        return coverage(edge, diameter, beside, angle).length_needed

    return worst_head(paced, offset, phase, needs).value


# Angles of the chart [deg]: beyond, bands are all but zero.
_ANGLES = np.linspace(0.0, 62.0, 311)

# Cut heights and offsets, as many as make smooth lines.
_VERDICT_POINTS = 121

# Cut heights up to this share of the root: no head is larger than that at its middle.
_DEEPEST = 0.5

# Offsets at least so far [m]; and cut heights and offsets so far beyond the machine's own.
_WIDEST, _BEYOND = 0.14, 1.3


@dataclass(frozen=True)
class VerdictChart(Result):
    """The chart."""

    angles: Annotated[Floats, Label("edge angle in size", "α", "rad")]
    cut_heights: Annotated[Floats, Label("height of the cut", "h_p", "m", shape="(k,)", over="cut_heights")]
    offsets: Annotated[Floats, Label("offset of the head", "Δ", "m", shape="(m,)", over="offsets")]
    lengths: Annotated[tuple[float, float], About("Minimum and maximum length that is claimed [m].")]
    edge_angle: Annotated[float, Label("edge angle of the machine, magnitude", "α", "rad")]
    band: Annotated[float, Label("band of the machine", "d + 2Δ", "m")]
    cut_height: Annotated[float, Label("height of the cut of the machine", "h_p", "m")]
    offset: Annotated[float, Label("offset of the machine", "Δ", "m")]
    bands: Annotated[
        dict[str, Floats],
        About(
            "Way → bands d + 2Δ with the machine's share of Δ whose longest edge is as claimed, shape (2, n) "
            "[m]; zero where there is none."
        ),
    ]
    longest: Annotated[
        dict[str, Floats],
        About("Way → longest edge over the speeds, a row for each offset, shape (m, k) [m]."),
    ]


def verdict_chart(described: Topper, stroke: Stroke | None = None) -> VerdictChart:
    """Chart the published claim about a machine."""
    root, delta = described.root_diameter, described.offset
    band = float(head_diameter(root, described.cut_height)) + 2 * delta
    ways = [way for way in WAYS if stroke or way != "every_phase"]
    deepest = min(root, max(_DEEPEST * root, _BEYOND * described.cut_height))
    heights = np.linspace(deepest / _VERDICT_POINTS, deepest, _VERDICT_POINTS)
    offsets = np.linspace(0.0, max(_WIDEST, _BEYOND * delta), _VERDICT_POINTS)
    d, angles = head_diameter(root, heights), np.radians(_ANGLES)
    alpha = described.edge_angle
    return VerdictChart(
        angles,
        heights,
        offsets,
        PAPER.lengths,
        abs(alpha),
        band,
        described.cut_height,
        delta,
        {way: bands_of(PAPER, way, angles, 2 * delta / band, stroke) for way in ways},
        {way: lengths_over(PAPER, way, alpha, d, offsets[:, None], stroke)[1] for way in ways},
    )
