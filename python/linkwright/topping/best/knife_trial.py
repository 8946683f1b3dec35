"""One knife that may be the best: the minimum edge that does what is asked, how it slices, what fails."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from linkwright.machine.machine import Machine
from linkwright.topping.coverage import pass_over
from linkwright.topping.edge import Edge
from linkwright.topping.knife import Knife
from linkwright.topping.model.topper import Topper, TopperLimits
from linkwright.topping.roots import Roots
from linkwright.topping.slicing import slicing
from linkwright.topping.sweep import edges_with

# The haulm that an edge leaves falls with its length: halvings to 1e-4 of the maximum length.
_HALVINGS = 14


@dataclass(frozen=True)
class Trial:
    """A knife that was examined."""

    edge_angle: float  # α [rad]
    # knife_speed, forward_speed: v_h and v [m/s].
    knife_speed: float
    forward_speed: float
    # Minimum edge that keeps the limits of heads and haulm [m]; infinite if none does, NaN if it runs
    # backwards at times.
    length: float
    slicing: float  # mean draw-cut ratio [–]; NaN likewise

    @property
    def retreats(self) -> bool:
        """Whether the edge runs backwards at times."""
        return math.isnan(self.slicing)

    def lack(self, slicing_min: float | None) -> float:
        """How much the draw-cut ratio lacks."""
        return math.inf if self.retreats else max(0.0, (slicing_min or 0.0) - self.slicing)


class Trials:
    """Knives over the same roots."""

    def __init__(self, machine: Machine, topper: Topper, roots: Roots, count: int = 0) -> None:
        self.topper, self.roots, self.count = topper, roots, count
        self._machine = machine
        self._knives: dict[float, list[Knife]] = {}

    def edges(self, angle: float, knife_speed: float, forward_speed: float) -> list[Edge]:
        """An edge, in one or two directions; α [rad], v_h and v [m/s]."""
        if knife_speed not in self._knives:
            changed = self.topper.with_entries({"knife_speed": knife_speed})
            self._knives[knife_speed] = [
                edge.knife for edge in edges_with(self._machine, changed, knife_speed)
            ]
        return [Edge(knife, angle, forward_speed) for knife in self._knives[knife_speed]]

    def at(self, angle: float, knife_speed: float, forward_speed: float) -> Trial:
        """Look at a knife. ``angle``: α [rad]; ``knife_speed``, ``forward_speed``: v_h and v [m/s]."""
        self.count += 1
        edges = self.edges(angle, knife_speed, forward_speed)
        if any(edge.retreats for edge in edges):
            return Trial(angle, knife_speed, forward_speed, math.nan, math.nan)
        length = self.length(edges)
        return Trial(angle, knife_speed, forward_speed, length, slicing(edges).ratio_mean)

    def length(self, edges: list[Edge]) -> float:
        """Minimum edge for the share of heads, and for the haulm that may be left [m]."""
        limits = self.topper.limits
        needed = np.sort(pass_over(edges, self.roots).length_needed)
        enough = math.ceil(limits.complete_min * len(needed) - 1e-9) - 1
        least = float(needed[max(enough, 0)])
        if limits.haulm_max is None or not math.isfinite(least):
            return least
        return self._for_haulm(edges, least, float(needed[np.isfinite(needed)][-1]), limits.haulm_max)

    def _for_haulm(self, edges: list[Edge], least: float, most: float, haulm_max: float) -> float:
        """Minimum edge, from one that cuts enough heads on, that leaves no more haulm."""
        if float(self.roots.is_missed.mean()) > haulm_max:
            return math.inf
        if self._haulm(edges, least) <= haulm_max:
            return least
        if self._haulm(edges, most) > haulm_max:
            return math.inf
        for _ in range(_HALVINGS):
            middle = 0.5 * (least + most)
            least, most = (least, middle) if self._haulm(edges, middle) <= haulm_max else (middle, most)
        return most

    def _haulm(self, edges: list[Edge], length: float) -> float:
        return float(pass_over(edges, self.roots, length=length).left.mean())


def thinned(roots: Roots, most: int) -> Roots:
    """Some of the roots, evenly among all of them."""
    n = len(roots.start)
    if n <= most:
        return roots
    kept = np.arange(most) * n // most
    names = ("root_diameter", "cut_height", "offset", "distance", "start", "cluster")
    return replace(roots, **{name: getattr(roots, name)[kept] for name in names})


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
    """The limit that the closest knife does not keep; ``length_max``: of the edge [m]."""
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
            f"slicing_min = {wanted:.4g} exceeds what the bounds permit: the draw-cut ratio comes to "
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
            f"{100 * (1 - missed):.4g} % of the heads can be cut through, as {because}"
        )
        return LimitFailure("complete_min", limits.complete_min, 1 - missed, words)
    wanted = limits.haulm_max or 0.0
    words = (
        f"haulm_max = {100 * wanted:.4g} % cannot be kept with any edge: at least {100 * missed:.4g} % is "
        f"left, as {because}"
    )
    return LimitFailure("haulm_max", wanted, missed, words)
