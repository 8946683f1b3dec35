"""Lengths of the edge over the diameter of roots and over the speed of the knife, for some forward speeds.

The chart of paper 5, its figure 3, for the angle, cut height and offset of any topper, with the exact lengths
beside the printed bound.

References
----------
.. [1] Paper 5, figure 3 and (10).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.quantities import About, Shown
from linkwright.kernel.result import Result
from linkwright.topping.constant_speed import constant_speed_lengths
from linkwright.topping.coverage import coverage
from linkwright.topping.edge import Edge
from linkwright.topping.every_phase import every_phase_length
from linkwright.topping.head import head_diameter
from linkwright.topping.model.topper import Topper
from linkwright.topping.published import length_consistent, length_published
from linkwright.topping.worst_head import worst_head

Floats = NDArray[np.float64]

# Forward speeds of the chart over that of the machine; its ends along both axes likewise.
_FORWARD = 0.85, 1.0, 1.15
_ROOTS, _SPEEDS = (0.6, 1.4), (0.0, 1.6)

# Points of a line in closed form, and of one for the motion of the knife.
_POINTS, _FEW = 81, 17


@dataclass(frozen=True)
class Lines(Result):
    """Minimum lengths of the edge along one axis.

    Attributes
    ----------
    along : ndarray, shape (n,)
        Root diameters [m], or mean knife speeds [m/s].
    published, consistent, constant_speed : ndarray, shape (3, n)
        By (10), by (4), exact at constant speed [m], a row for each forward speed.
    moved_along, moved : ndarray, shape (k,)
        The like axis, and exact lengths for the motion of the knife at the machine's own forward speed [m],
        NaN where the edge retreats; empty if it does not turn back over a head.
    """

    along: Floats
    published: Floats
    consistent: Floats
    constant_speed: Floats
    moved_along: Floats
    moved: Floats


@dataclass(frozen=True)
class LengthChart(Result):
    """The chart."""

    forward_speeds: Annotated[tuple[float, ...], About("Speeds along the row, v [m/s].")]
    root_diameter: Annotated[float, Shown("diameter of a root", "D", "m")]
    knife_speed: Annotated[float, Shown("mean speed across the row", "v_h", "m/s")]
    edge_length: Annotated[float, Shown("length of the edge", "L", "m")]
    over_roots: Annotated[Lines, About("Over root diameters at the machine's mean knife speed.")]
    over_speeds: Annotated[Lines, About("Over mean knife speeds at the machine's root diameter.")]


def length_chart(described: Topper, edges: Sequence[Edge]) -> LengthChart:
    """Lengths about a topper's own numbers.

    Parameters
    ----------
    described : Topper
        The topper.
    edges : sequence of Edge
        Its edge, or the two directions of it.

    Returns
    -------
    LengthChart
        Lines over both axes.
    """
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
        moved = np.array([_moved(described, edges, each) for each in d])
        over_roots = replace(over_roots, moved_along=few, moved=moved)
        some = np.linspace(greatest / _FEW, greatest, _FEW)
        own = float(head_diameter(D, described.cut_height))
        moved = np.array([_moved(described, edges, own, each / v_h) for each in some.tolist()])
        over_speeds = replace(over_speeds, moved_along=some, moved=moved)
    over_speeds = replace(over_speeds, along=speeds)
    return LengthChart(forward, D, v_h, described.edge_length, over_roots, over_speeds)


def _lines(described: Topper, forward: Sequence[float], roots: Floats, speeds: Floats) -> Lines:
    """All closed forms."""
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
