"""Why no knife of a topper keeps its limits, with by how much."""

from __future__ import annotations

import math
from dataclasses import dataclass

from linkwright.topping.best.knife_trial import Trial
from linkwright.topping.model.limits import TopperLimits
from linkwright.topping.roots import Roots


@dataclass(frozen=True)
class LimitFailure:
    """A limit that no knife within the bounds keeps, with all others kept.

    Attributes
    ----------
    limit : str
        Its key.
    wanted, reached : float
        What it asks for, and what comes closest to it.
    words : str
        The same in a sentence.
    """

    limit: str
    wanted: float
    reached: float
    words: str


def failing_limit(chosen: Trial, roots: Roots, limits: TopperLimits, length_max: float) -> LimitFailure:
    """The limit that the knife which comes closest does not keep.

    Parameters
    ----------
    chosen : Trial
        The knife.
    roots : Roots
        What it met.
    limits : TopperLimits
        What it should keep.
    length_max : float
        Maximum length of the edge [m].
    """
    place = (
        f"α = {math.degrees(chosen.edge_angle):.4g}°, v_h = {chosen.knife_speed:.4g} m/s, "
        f"v = {chosen.forward_speed:.4g} m/s"
    )
    if chosen.retreats:
        words = (
            "within the bounds of angle and knife speed all edges run backwards at times: lower angle_min or "
            "knife_speed_min"
        )
        return LimitFailure("angle_min", limits.angle_min, math.nan, words)
    wanted = limits.slicing_min or 0.0
    if chosen.slicing < wanted:
        words = (
            f"slicing_min = {wanted:.4g} asks for more than the bounds give: the draw-cut ratio comes to "
            f"{chosen.slicing:.4g}, {wanted - chosen.slicing:.4g} too little, at {place}; raise angle_max or "
            "knife_speed_max"
        )
        return LimitFailure("slicing_min", wanted, chosen.slicing, words)
    if math.isinf(chosen.length):
        return _missed(roots, limits)
    words = (
        f"length_max = {length_max:.4g} m is too short: the shortest edge that keeps the other limits has "
        f"{chosen.length:.4g} m, {chosen.length - length_max:.4g} m more, at {place}"
    )
    return LimitFailure("length_max", length_max, chosen.length, words)


def _missed(roots: Roots, limits: TopperLimits) -> LimitFailure:
    """Heads above which the knife passes let no length keep a limit."""
    missed = float(roots.is_missed.mean())
    because = f"the knife passes above {100 * missed:.3g} % of the heads: cut deeper"
    if 1 - missed < limits.complete_min:
        words = (
            f"complete_min = {100 * limits.complete_min:.4g} % cannot be kept with any edge: at most "
            f"{100 * (1 - missed):.4g} % of the heads can be cut right through, as {because}"
        )
        return LimitFailure("complete_min", limits.complete_min, 1 - missed, words)
    wanted = limits.haulm_max or 0.0
    words = (
        f"haulm_max = {100 * wanted:.4g} % cannot be kept with any edge: at least {100 * missed:.4g} % is "
        f"left, as {because}"
    )
    return LimitFailure("haulm_max", wanted, missed, words)
