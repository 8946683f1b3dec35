"""Paper 5 computed anew: the working length of the knife of a topper.

The paper prints formulas, ranges of the speeds and a range of the length, but neither the angle of the knife
nor cut height and offset of its figure 3. What is chosen for them here stands in ``paper5.toml``; the result
is judged for all of them: for which angles, bands of heads and offsets the published 0.25 to 0.30 m hold.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.result import finite
from linkwright.papers.claim import tolerance
from linkwright.papers.page import shown
from linkwright.papers.paper import Paper, printed_values
from linkwright.papers.paper5.steps import (
    Surface,
    condition_suffices,
    head_difference,
    short_checks,
    step_checks,
    surfaces,
)
from linkwright.papers.published_lengths import (
    WAYS,
    Claim,
    Demand,
    LengthVerdict,
    Stroke,
    bands_of,
    length_verdict,
    lengths_over,
)
from linkwright.topping.required_length import length_published
from linkwright.topping.roots import head_diameter

# Angles of the scans: hundredths of a degree.
_ANGLES = np.radians(np.arange(0.0, 85.0, 0.01))


@dataclass(frozen=True)
class ClaimVerdict:
    """For which angles and heads the published lengths hold."""

    claim: Claim  # as printed
    stroke: Stroke  # chosen
    diameters: tuple[float, float]  # d of the minimum and the largest head chosen [m]
    offset: float  # Δ chosen [m]
    angles: tuple[LengthVerdict, ...]  # one for each angle of the table
    # Way → offsets Δ of that head, one row for each angle, whose maximum lengths are those of the claim [m];
    # negative where the head alone needs more, NaN where no edge does.
    offsets: dict[str, Floats]
    chosen: LengthVerdict  # at the angle chosen
    least_band: float  # minimum band for which (10) gives the shorter length of the claim at any angle [m]
    # Way → minimum and maximum angle at which one band of heads has all its lengths within the claim [rad].
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
            "offsets": finite({way: ranges.tolist() for way, ranges in self.offsets.items()}),
            "chosen": self.chosen.to_dict(),
            "least_band_published": self.least_band,
            "throughout": {way: list(ranges) for way, ranges in self.throughout.items()},
        }


def claim_verdict(data: dict[str, Any]) -> ClaimVerdict:
    """Judge the published lengths, from printed and chosen values."""
    claim, chosen = printed_claim(data), data["chosen"]
    # A knife that moves harmonically is π/2 times as fast at mid-stroke as in the mean.
    stroke = Stroke(chosen["stroke"], np.pi / 2)
    small, large = head_diameter(np.array(chosen["root_diameters"]), chosen["cut_height"]).tolist()
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
    none, one = (lengths_over(claim, way, angles, diameter, share, stroke)[1] for share in (0.0, 1.0))
    does = np.isfinite(none)
    per_offset = np.where(does, one, np.nan) - np.where(does, none, 0.0)
    return np.stack([(length - none) / per_offset for length in claim.lengths], axis=-1)


def _throughout(claim: Claim, diameter: float, offset: float) -> Iterator[tuple[str, tuple[float, float]]]:
    """Angles at which the minimum length over the maximum is at least the claimed one; the edge advances."""
    low, high = claim.lengths
    angles = _ANGLES[claim.ratios[1] * np.tan(_ANGLES) < 1]
    for way in ("published", "consistent", "constant_speed"):
        least, greatest = lengths_over(claim, way, angles, diameter, offset)
        kept = angles[least >= greatest * low / high]
        if kept.size:
            yield way, (float(kept[0]), float(kept[-1]))


# Ways → names in sentences.
_NAMES = {"published": "(10)", "consistent": "(4)", "constant_speed": "the exact length"}


@dataclass(frozen=True)
class Paper5(Paper):
    """Paper 5, published against computed."""

    head: float  # discs of the printed diameter against the cap that they fill [–]
    # From (4) to (5), and the exact length over those of the paper.
    step: dict[str, Any]
    short: dict[str, Any]
    surfaces: tuple[Surface, ...]  # figure 3
    verdict: ClaimVerdict  # on the result

    def quantities(self) -> dict[str, Any]:
        """Numbers of the step, of the result, and what the statements of the paper come to."""
        roots = tuple(self.published["chosen"]["root_diameters"])
        return {"roots": roots, "ways": WAYS} | self._of_step() | self._of_lengths() | self._of_result()

    def _of_step(self) -> dict[str, Any]:
        step, same = self.step, tolerance("rounding").reproduced
        at = int(np.abs(step["angles"] - np.radians(self.published["chosen"]["edge_angle"])).argmin())
        suffices = condition_suffices(step["angles"])
        exact = np.abs(step["travels"] - 1) <= same
        follows = np.abs(step["factors"] - 1) <= same
        return {
            "condition_suffices": suffices,
            "condition_fails": not suffices and self.short["across_published"] < self.short["across"],
            "least_travel": (float(step["travels"].min()), float(step["angles"][step["travels"].argmin()])),
            "travel_is_exact": bool(exact.all()),
            "travel_is_exact_across": bool(exact[step["angles"] == 0].all()),
            "at": {
                "angle": float(step["angles"][at]),
                "factor": float(step["factors"][at]),
                "longer": float(step["longer"][at]),
                "time": float(step["times"][at]),
            },
            "factors": [
                (f, a) for f, a in zip(step["factors"].tolist(), step["angles"].tolist(), strict=True) if a
            ],
            "longest": float(step["longer"].max()),
            "steepest": float(step["angles"][-1]),
            "five_follows": bool(follows.all()),
            "five_fails": bool((follows == (step["angles"] == 0)).all()) and step["identity"] <= same,
            "five_keeps_condition": bool((step["times"] >= 1).all()),
        }

    def _of_lengths(self) -> dict[str, Any]:
        short, given = self.short, self.published["chosen"]
        D, h_p, delta, alpha = (
            np.max(given[name]) for name in ("root_diameters", "cut_height", "offset", "edge_angle")
        )
        rho, a = self.verdict.claim.ratios[1], np.radians(alpha)
        ten = 2 * (np.sqrt(D * h_p - h_p**2) + delta) * (rho * np.cos(a) + np.sin(a))
        nine = length_published(self.verdict.diameters[1] + 2 * delta, a, rho)
        lengths = [length for surface in self.surfaces for length in (surface.published, surface.exact)]
        grows = all((np.diff(length, axis=axis) > 0).all() for length in lengths for axis in (0, 1))
        falls = all(
            (slow.published > fast.published).all() and (slow.exact > fast.exact).all()
            for slow, fast in zip(self.surfaces, self.surfaces[1:], strict=False)
        )
        return {
            "ten_is_enough": short["least"] <= 1,
            "ten_fails": min(short["bound"], short["least_consistent"]) > 1
            and short["least"] >= short["bound"],
            "ten_follows": bool(abs(nine / ten - 1) <= tolerance("rounding").reproduced),
            "ten_has_limit": short["across_published"] >= short["across"],
            "lengths_grow": grows and falls,
        }

    def _of_result(self) -> dict[str, Any]:
        judged = self.verdict
        angles = [angle.edge_angle for angle in judged.angles]
        bands = [{demand.way: _band(demand) for demand in verdict.demands} for verdict in judged.angles]
        offsets = {way: [_heads(*pair) for pair in ranges.tolist()] for way, ranges in judged.offsets.items()}
        nearest = int(np.abs(np.array(angles) - judged.chosen.edge_angle).argmin())
        demands = {demand.way: _demand(demand) for demand in judged.chosen.demands}
        return {
            "bands": {
                # Every other angle of the table is enough in a sentence.
                way: [{"band": row[way], "angle": a} for row, a in zip(bands, angles, strict=True)][::2]
                for way in WAYS
            },
            "band_rows": [{"angle": a} | row for row, a in zip(bands, angles, strict=True)],
            "offset_rows": [
                {"angle": a} | {way: offsets[way][n] for way in WAYS} for n, a in enumerate(angles)
            ],
            "offsets": {way: ranges[nearest] for way, ranges in offsets.items()},
            "offsets_angle": angles[nearest],
            "demands": demands,
            "half_width": 0.5 * judged.diameters[1],
            "result_fails_by_ten": not demands["published"]["holds"],
            "throughout": [
                {"name": name, "angles": _angles(judged.throughout.get(way))} for way, name in _NAMES.items()
            ],
            "holds_somewhere": bool(judged.throughout),
            "retreats": float(np.arctan(1 / judged.claim.ratios[1])),
        }

    def entries(self) -> dict[str, Any]:
        """Computed values, ready for JSON."""
        return {
            "chosen": self.published["chosen"],
            "step": {
                key: entry.tolist() if isinstance(entry, np.ndarray) else entry
                for key, entry in self.step.items()
            },
            "exact_over_published": self.short,
            "figure3": [surface.to_dict() for surface in self.surfaces],
            "verdict": self.verdict.to_dict(),
        }


def _heads(low: float, high: float) -> tuple[float, ...]:
    """A range of lengths of heads [m], what is negative left out; empty if all is."""
    return (max(low, 0.0), high) if high > 0 else ()


def _band(demand: Demand) -> tuple[float, ...]:
    return _heads(demand.band_low, demand.band_high)


def _demand(demand: Demand) -> dict[str, Any]:
    return {
        "length": demand.length_greatest,
        "band": _band(demand),
        "holds": demand.holds,
        "throughout": demand.holds_throughout,
    }


def _angles(ends: tuple[float, float] | None) -> str:
    return "at no angle" if ends is None else "for α = " + "…".join(shown(end, ".1f °") for end in ends)


def paper5() -> Paper5:
    """Compute paper 5 anew. Source: Paper 5, (1) to (10), figure 3 and the result."""
    data = printed_values(5)
    chosen, verdict = data["chosen"], claim_verdict(data)
    return Paper5(
        data,
        head=head_difference(chosen["root_diameters"][1]),
        step=step_checks(np.radians(data["verdict"]["angles"]), verdict.claim.ratios[1]),
        short=short_checks(verdict.claim, float(np.radians(chosen["edge_angle"])), verdict.shares),
        surfaces=surfaces(data),
        verdict=verdict,
    )
