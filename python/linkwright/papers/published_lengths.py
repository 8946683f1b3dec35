r"""Lengths of the edge that are said to do for ranges of speeds: for which heads they do.

The longest edge is needed at one end of the range of :math:`\rho = v_h/v`: all lengths grow with ρ as long as
the edge advances, and beyond that fall again. In between lies :math:`\rho\tan|\alpha| = 1`, where no edge
does. At a given angle, and a given share :math:`2\Delta/b` of the offsets in the band b = d + 2Δ of the
heads, each length is :math:`f b + a`, so that lengths are turned into bands by :math:`b = (L - a)/f`.

References
----------
.. [1] Paper 5, its result for L_h.
.. [2] The rest is derived here.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from numpy.typing import ArrayLike

from linkwright.kernel.arrays import Floats
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result, finite
from linkwright.kernel.units.kinds import ANGLE, LENGTH
from linkwright.kernel.units.marks import ACUTE, Quantity, positive
from linkwright.topping.required_length import (
    constant_speed_lengths,
    every_phase_length,
    length_consistent,
    length_published,
)

# Ways to a length, and what they are called.
WAYS = {
    "published": "printed bound (10)",
    "consistent": "bound that follows from (4)",
    "constant_speed": "exact, constant speed",
    "every_phase": "exact, every phase of the stroke",
}


@dataclass(frozen=True)
class Claim:
    """Lengths that are said to do for ranges of speeds.

    Attributes
    ----------
    forward_speeds, knife_speeds : tuple of float
        Minimum and maximum v and v_h [m/s].
    lengths : tuple of float
        Minimum and maximum L [m].
    """

    forward_speeds: tuple[float, float]
    knife_speeds: tuple[float, float]
    lengths: tuple[float, float]

    @property
    def ratios(self) -> tuple[float, float]:
        """Minimum and maximum v_h/v [–]."""
        slow, fast = self.forward_speeds
        return self.knife_speeds[0] / fast, self.knife_speeds[1] / slow


# Paper 5, its result.
PAPER = Claim(forward_speeds=(1.6, 2.2), knife_speeds=(0.3, 0.8), lengths=(0.25, 0.30))


@dataclass(frozen=True)
class Stroke:
    """The knife's stroke, as far as lengths for every phase ask for it.

    Attributes
    ----------
    length : float
        S [m].
    peak : float
        Maximum over mean speed of the knife [–]: 1 for constant speed, π/2 for harmonic motion.
    """

    length: float
    peak: float = 1.0


@dataclass(frozen=True)
class Demand(Result):
    """What one way of computing the length makes of a claim."""

    way: Annotated[str, About("A key of `WAYS`.")]
    length_least: Annotated[
        float,
        Label("minimum length over the speeds", "", "m", "For the heads given; infinite where no edge does."),
    ]
    length_greatest: Annotated[float, Label("maximum length over the speeds", "", "m", "Likewise.")]
    band_low: Annotated[
        float,
        Label(
            "lower band whose maximum length lies at an end of the claim",
            "d + 2Δ",
            "m",
            "With the share of Δ of the heads given; zero where no band does.",
        ),
    ]
    band_high: Annotated[
        float,
        Label("upper band whose maximum length lies at an end of the claim", "d + 2Δ", "m", "Likewise."),
    ]
    holds: Annotated[
        bool, About("Whether the maximum length lies within the claim: what an edge must be made for.")
    ]
    holds_throughout: Annotated[bool, About("Whether the minimum does as well.")]


@dataclass(frozen=True)
class LengthVerdict(Result):
    """For which heads a claim holds, in several ways."""

    edge_angle: Annotated[float, Label("edge angle", "α", "rad")]
    band: Annotated[float, Label("band of the heads given", "d + 2Δ", "m")]
    demands: Annotated[tuple[Demand, ...], About("One for each way.")]

    @property
    def ways(self) -> tuple[dict[str, Any], ...]:
        """The demands, ready for JSON; None for a length without bounds."""
        return tuple(finite(demand.to_dict()) for demand in self.demands)


@public
def length_verdict(
    claim: Claim, edge_angle: float, diameter: float, offset: float, stroke: Stroke | None = None
) -> LengthVerdict:
    """Heads for which a published length holds.

    Parameters
    ----------
    claim : Claim
        Ranges of speeds, and of the length.
    edge_angle : float
        α [rad], between −π/2 and π/2.
    diameter, offset : float
        d of the largest head and maximum offset Δ [m].
    stroke : Stroke, optional
        Of the knife; without it there is no length for every phase.

    Returns
    -------
    LengthVerdict
        A demand for each way.

    Raises
    ------
    InputError
        An angle or a length that makes no sense.
    """
    in_range(
        edge_angle=(edge_angle, Quantity(ANGLE, ACUTE)),
        diameter=(diameter, positive(LENGTH)),
        offset=(offset, Quantity(LENGTH)),
    )
    ways = [way for way in WAYS if stroke or way != "every_phase"]
    demands = (_demand(claim, way, edge_angle, diameter, offset, stroke) for way in ways)
    return LengthVerdict(edge_angle, diameter + 2 * offset, tuple(demands))


def _demand(
    claim: Claim, way: str, edge_angle: float, diameter: float, offset: float, stroke: Stroke | None
) -> Demand:
    band = diameter + 2 * offset
    share = 2 * offset / band if band > 0 else 0.0
    least, greatest = lengths_over(claim, way, edge_angle, diameter, offset, stroke).tolist()
    low, high = bands_of(claim, way, edge_angle, share, stroke).tolist()
    holds = claim.lengths[0] <= greatest <= claim.lengths[1]
    throughout = holds and least >= claim.lengths[0]
    return Demand(way, least, greatest, low, high, holds, throughout)


def lengths_over(
    claim: Claim,
    way: str,
    edge_angle: ArrayLike,
    diameter: ArrayLike,
    offset: ArrayLike,
    stroke: Stroke | None = None,
) -> Floats:
    """Minimum and maximum length over the speeds of a claim, (2, ...) [m]; infinite where no edge does.

    `way`: a key of `WAYS`; α [rad], d and Δ [m] of any shapes broadcast; `stroke` is needed for
    ``"every_phase"``, whose length is infinite where the edge retreats.
    """
    ends = np.stack([_length(way, ratio, edge_angle, diameter, offset, stroke) for ratio in claim.ratios])
    greatest = ends.max(axis=0)
    if way == "constant_speed":
        low, high = (ratio * np.abs(np.tan(edge_angle)) for ratio in claim.ratios)
        greatest = np.where((low <= 1) & (high >= 1), np.inf, greatest)
    return np.stack([ends.min(axis=0), greatest])


def bands_of(
    claim: Claim, way: str, edge_angle: ArrayLike, offset_share: ArrayLike, stroke: Stroke | None = None
) -> Floats:
    """Bands d + 2Δ of heads whose maximum length over the speeds lies at the ends of a claim, (2, ...) [m].

    `way`: a key of `WAYS`; α [rad], 2Δ/(d + 2Δ) [–] of any shapes broadcast; `stroke` is needed for
    ``"every_phase"``. Zero where no band does.
    """
    share = np.asarray(offset_share, dtype=float)
    none, unit = (
        lengths_over(claim, way, edge_angle, bound * (1 - share), bound * share / 2, stroke)[1]
        for bound in (0.0, 1.0)
    )
    does = np.isfinite(unit)
    start = np.where(does, none, 0.0)
    per_band = np.where(does, unit, np.inf) - start
    return np.stack([np.clip((length - start) / per_band, 0.0, None) for length in claim.lengths])


def _length(
    way: str,
    ratio: float,
    edge_angle: ArrayLike,
    diameter: ArrayLike,
    offset: ArrayLike,
    stroke: Stroke | None,
) -> Floats:
    d, delta = np.asarray(diameter, dtype=float), np.asarray(offset, dtype=float)
    if way == "published":
        return np.asarray(length_published(d + 2 * delta, edge_angle, ratio))
    if way == "consistent":
        return np.asarray(length_consistent(d + 2 * delta, edge_angle, ratio))
    if way == "constant_speed":
        return np.asarray(constant_speed_lengths(d, delta, edge_angle, 1.0, ratio).max(axis=0))
    if stroke is None:
        raise ValueError("a length for every phase needs the stroke")
    advances = stroke.peak * ratio * np.abs(np.tan(edge_angle)) < 1
    return np.where(advances, every_phase_length(d, delta, edge_angle, stroke.length), np.inf)
