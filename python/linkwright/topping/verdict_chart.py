"""Where lengths that are said to do for ranges of speeds lie, about a machine's own angle, cut and offset."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.result import Result
from linkwright.topping.head import head_diameter
from linkwright.topping.model.topper import Topper
from linkwright.topping.verdict import PAPER, WAYS, Claim, Stroke, bands_of, lengths_over

Floats = NDArray[np.float64]

# Angles of the chart [deg]: beyond, bands are all but zero.
_ANGLES = np.linspace(0.0, 62.0, 311)

# Cut heights and offsets, as many as make smooth lines.
_POINTS = 121

# Cut heights up to this share of the root: no head is larger than that at its middle.
_DEEPEST = 0.5

# Offsets at least so far [m]; and cut heights and offsets so far beyond the machine's own.
_WIDEST, _BEYOND = 0.14, 1.3


@dataclass(frozen=True)
class VerdictChart(Result):
    """The chart.

    Attributes
    ----------
    angles : ndarray, shape (n,)
        Sizes of α [rad].
    cut_heights : ndarray, shape (k,)
        h_p [m].
    offsets : ndarray, shape (m,)
        Δ [m].
    lengths : tuple of float
        Minimum and maximum length that is claimed [m].
    edge_angle, band, cut_height, offset : float
        Of the machine: size of α [rad], d + 2Δ, h_p and Δ [m].
    bands : dict of str to ndarray, shape (2, n)
        Way → bands d + 2Δ with the machine's share of Δ whose longest edge is as claimed [m]; zero where
        there is none.
    longest : dict of str to ndarray, shape (m, k)
        Way → longest edge over the speeds, a row for each offset [m].
    """

    angles: Floats
    cut_heights: Floats
    offsets: Floats
    lengths: tuple[float, float]
    edge_angle: float
    band: float
    cut_height: float
    offset: float
    bands: dict[str, Floats]
    longest: dict[str, Floats]


def verdict_chart(described: Topper, stroke: Stroke | None = None, claim: Claim = PAPER) -> VerdictChart:
    """Chart a claim about a machine.

    Parameters
    ----------
    described : Topper
        The topper.
    stroke : Stroke, optional
        Of its knife; without it there is no length for every phase.
    claim : Claim
        Ranges of speeds, and of the length.

    Returns
    -------
    VerdictChart
        Over angles, and over cut heights and offsets.
    """
    root, delta = described.root_diameter, described.offset
    band = float(head_diameter(root, described.cut_height)) + 2 * delta
    ways = [way for way in WAYS if stroke or way != "every_phase"]
    deepest = min(root, max(_DEEPEST * root, _BEYOND * described.cut_height))
    heights = np.linspace(deepest / _POINTS, deepest, _POINTS)
    offsets = np.linspace(0.0, max(_WIDEST, _BEYOND * delta), _POINTS)
    d, angles = head_diameter(root, heights), np.radians(_ANGLES)
    alpha = described.edge_angle
    return VerdictChart(
        angles,
        heights,
        offsets,
        claim.lengths,
        abs(alpha),
        band,
        described.cut_height,
        delta,
        {way: bands_of(claim, way, angles, 2 * delta / band, stroke) for way in ways},
        {way: lengths_over(claim, way, alpha, d, offsets[:, None], stroke)[1] for way in ways},
    )
