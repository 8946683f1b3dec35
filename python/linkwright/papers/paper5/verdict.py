"""The published 0.25 to 0.30 m of paper 5: for which angles, bands of heads and offsets they hold."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.result import finite
from linkwright.topping.roots import head_diameter
from linkwright.topping.verdict import (
    WAYS,
    Claim,
    LengthVerdict,
    Stroke,
    bands_of,
    length_verdict,
    lengths_over,
)

Floats = NDArray[np.float64]

# Angles of the scans: hundredths of a degree.
_ANGLES = np.radians(np.arange(0.0, 85.0, 0.01))


@dataclass(frozen=True)
class ClaimVerdict:
    """For which angles and heads the published lengths hold.

    Attributes
    ----------
    claim : Claim
        As printed.
    stroke : Stroke
        Chosen.
    diameters : tuple of float
        d of the minimum and the largest head chosen [m].
    offset : float
        Δ chosen [m].
    angles : tuple of LengthVerdict
        One for each angle of the table.
    offsets : dict of str to ndarray
        Way → offsets Δ of that head, one row for each angle, whose maximum lengths are those of the claim
        [m]; negative where the head alone needs more, NaN where no edge does.
    chosen : LengthVerdict
        At the angle chosen.
    least_band : float
        Minimum band for which (10) gives the shorter length of the claim at any angle [m].
    throughout : dict of str to tuple of float
        Way → minimum and maximum angle at which one band of heads has all its lengths within the claim [rad].
    """

    claim: Claim
    stroke: Stroke
    diameters: tuple[float, float]
    offset: float
    angles: tuple[LengthVerdict, ...]
    offsets: dict[str, Floats]
    chosen: LengthVerdict
    least_band: float
    throughout: dict[str, tuple[float, float]]

    @property
    def shares(self) -> tuple[float, float]:
        """2Δ/(d + 2Δ) of the largest and the minimum head chosen [–]."""
        least, largest = (2 * self.offset / (d + 2 * self.offset) for d in self.diameters)
        return largest, least

    def to_dict(self) -> dict[str, Any]:
        """Everything, ready for JSON."""
        return {
            "forward_speeds": list(self.claim.forward_speeds),
            "knife_speeds": list(self.claim.knife_speeds),
            "lengths": list(self.claim.lengths),
            "stroke": vars(self.stroke),
            "head_diameters": list(self.diameters),
            "offset": self.offset,
            "angles": [angle.to_dict() for angle in self.angles],
            "offsets": finite({way: each.tolist() for way, each in self.offsets.items()}),
            "chosen": self.chosen.to_dict(),
            "least_band_published": self.least_band,
            "throughout": {way: list(each) for way, each in self.throughout.items()},
        }


def claim_verdict(data: dict[str, Any]) -> ClaimVerdict:
    """Judge the published lengths, from printed and chosen values."""
    claim, chosen = printed_claim(data), data["chosen"]
    # A knife that moves harmonically is π/2 times as fast at mid-stroke as in the mean.
    stroke = Stroke(chosen["stroke"], np.pi / 2)
    small, large = head_diameter(chosen["root_diameters"], chosen["cut_height"]).tolist()
    offset, angles = chosen["offset"], np.radians(data["verdict"]["angles"])
    of_large = partial(length_verdict, claim, diameter=large, offset=offset, stroke=stroke)
    return ClaimVerdict(
        claim,
        stroke,
        (small, large),
        offset,
        tuple(of_large(angle) for angle in angles.tolist()),
        {way: _offsets(claim, way, angles, large, stroke) for way in WAYS},
        of_large(float(np.radians(chosen["edge_angle"]))),
        float(bands_of(claim, "published", _ANGLES, 0.0)[0].min()),
        dict(_throughout(claim, large, offset)),
    )


def printed_claim(data: dict[str, Any]) -> Claim:
    """The printed result and its ranges."""
    speeds = data["given"]["forward_speeds"]
    return Claim(
        (min(speeds), max(speeds)), tuple(data["given"]["knife_speeds"]), tuple(data["result"]["lengths"])
    )


def _offsets(claim: Claim, way: str, angles: Floats, diameter: float, stroke: Stroke) -> Floats:
    """Offsets of a head whose lengths are those of the claim: all lengths are straight lines over Δ."""
    none, one = (lengths_over(claim, way, angles, diameter, each, stroke)[1] for each in (0.0, 1.0))
    does = np.isfinite(none)
    per_offset = np.where(does, one, np.nan) - np.where(does, none, 0.0)
    return np.stack([(length - none) / per_offset for length in claim.lengths], axis=-1)


def _throughout(claim: Claim, diameter: float, offset: float) -> Iterator[tuple[str, tuple[float, float]]]:
    """Angles at which the minimum length over the maximum is at least the claimed one; the edge advances."""
    low, high = claim.lengths
    angles = _ANGLES[claim.ratios[1] * np.tan(_ANGLES) < 1]
    for way in ("published", "consistent", "constant_speed"):
        least, greatest = lengths_over(claim, way, angles, diameter, offset)
        found = angles[least >= greatest * low / high]
        if found.size:
            yield way, (float(found[0]), float(found[-1]))
