r"""The best knife of a topper: shortest edge, or fastest along the row, that keeps its limits.

At an angle α, a speed v_h of the knife and a speed v along the row, one pass over the heads gives the length
that each needs, and so the minimum edge for the share of heads that has to be cut through; where the
haulm has a limit, the edge is made longer until it is kept. The draw-cut ratio does not depend on the length.
So only α and v_h are sought, on a grid, and then on ever finer ones about the best:

* robust against the steps of a sample, against locked phases, and against limits on whose edge the best lies;
* the search examines a part of the roots, the last rounds all of them, and the verification others,
  drawn with another seed, with a finer look at each pass.

Edges that run backwards at times are passed over: they push the head instead of cutting it. Without
`slicing_min` nothing speaks for moving the knife: the shortest edge then rests across the row.

For the fastest, the shortest edge is sought at several speeds; between the maximum speed at which it is
short enough and the next one, halving goes on.

References
----------
.. [1] Derived here.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.machine.machine import Machine
from linkwright.topping.best.knife_search import MAP, KnifeGrid
from linkwright.topping.best.knife_trial import LimitFailure, Trial, Trials, failing_limit, thinned
from linkwright.topping.coverage import FINE, Watch, pass_over
from linkwright.topping.edge import require_topper
from linkwright.topping.field import TopperField, field_result
from linkwright.topping.model.topper import MemberKnife, TopperLimits
from linkwright.topping.roots import draw_roots, field_of

Objective = Literal["shortest", "fastest"]

# Roots that the search examines.
_ROOTS = 4000

# Verification draws its roots with a seed that far from the own.
_OTHER_SEED = 1_000_003

# Nearer to a bound than this share of the range is on it.
_ON = 1e-4


_IS_VERIFIED = "Whether the other roots keep the limits within the confidence intervals."


@dataclass(frozen=True)
class BestKnife(Result):
    """The best knife."""

    edge_angle: Annotated[float, Label("edge angle", "α", "rad")]
    edge_length: Annotated[float, Label("length of the edge", "L", "m")]
    knife_speed: Annotated[float, Label("mean speed across the row", "v_h", "m/s")]
    forward_speed: Annotated[float, Label("speed along the row", "v", "m/s")]
    crank_speed: Annotated[
        float | None,
        Label("speed of the crank that moves the knife", "ω", "rad/s", "None where it moves by a law."),
    ]
    slicing_ratio_mean: Annotated[float, Label("mean draw-cut ratio", "", "")]
    share_complete: Annotated[
        float,
        Label("share of heads cut through", "", "", "Over the roots that it was sought with."),
    ]
    share_complete_low: Annotated[
        float, Label("minimum share of heads cut through", "", "", "End of its interval.")
    ]
    share_complete_high: Annotated[
        float, Label("maximum share of heads cut through", "", "", "End of its interval.")
    ]
    haulm_mean: Annotated[
        float, Label("mean uncut share of the head", "", "", "Over the roots that it was sought with.")
    ]
    haulm_mean_low: Annotated[
        float, Label("minimum mean uncut share of the head", "", "", "End of its interval.")
    ]
    haulm_mean_high: Annotated[
        float, Label("maximum mean uncut share of the head", "", "", "End of its interval.")
    ]
    share_verified: Annotated[
        float,
        Label(
            "share of heads cut through, verified",
            "",
            "",
            "Over other roots, with a finer evaluation.",
        ),
    ]
    share_verified_low: Annotated[
        float,
        Label("minimum share of heads cut through, verified", "", "", "End of its interval."),
    ]
    share_verified_high: Annotated[
        float,
        Label("maximum share of heads cut through, verified", "", "", "End of its interval."),
    ]
    haulm_verified: Annotated[
        float,
        Label(
            "mean uncut share of the head, verified",
            "",
            "",
            "Over other roots, with a finer evaluation.",
        ),
    ]
    haulm_verified_low: Annotated[
        float, Label("minimum mean uncut share of the head, verified", "", "", "End of its interval.")
    ]
    haulm_verified_high: Annotated[
        float, Label("maximum mean uncut share of the head, verified", "", "", "End of its interval.")
    ]
    seed_verified: Annotated[int, Label("seed of the other roots", "", "")]
    is_verified: Annotated[bool, About(_IS_VERIFIED)]
    at_bounds: Annotated[tuple[str, ...], About("Bounds of the search on which it lies.")]


@dataclass(frozen=True)
class KnifeSearch(Result):
    """A search for the best knife."""

    map_angle: Annotated[Floats, Label("angle of the map", "", "rad", shape="(a,)", over="map_angle")]
    map_speed: Annotated[Floats, Label("knife speed of the map", "", "m/s", shape="(b,)", over="map_speed")]
    map_length: Annotated[
        Floats,
        Label(
            "minimum edge length for the required shares",
            "",
            "m",
            "At the forward speed of the best; NaN where the edge runs backwards, infinite where none does.",
            shape="(a, b)",
        ),
    ]
    map_slicing: Annotated[Floats, Label("mean draw-cut ratio", "", "–", shape="(a, b)")]
    objective: Annotated[Objective, About('``"shortest"`` or ``"fastest"``.')]
    limits: Annotated[TopperLimits, About("Limits of the search.")]
    length_max: Annotated[float, Label("maximum length of the edge", "", "m", "Infinite without a limit.")]
    tried: Annotated[int, About("Number of knives evaluated.")]
    best: Annotated[BestKnife | None, About("The best one; None if no knife keeps the limits.")]
    failing: Annotated[LimitFailure | None, About("Limit that cannot be kept in that case.")]


@public
def best_knife(
    machine: Machine,
    *,
    objective: Objective = "shortest",
    seed: int | None = None,
    watch: Watch | None = None,
) -> KnifeSearch:
    """Find the best knife within its limits.

    Parameters
    ----------
    machine : Machine
        With a topper, its limits, and a field of roots.
    objective : {"shortest", "fastest"}
        The shortest edge at the forward speed of the file; or the maximum forward speed, with an edge of
        at most ``length_max``, without it that of the file.
    seed : int, optional
        Seed of the random generator, in place of that of the field.
    watch : callable, optional
        Progress callback, 0 to 1.

    Returns
    -------
    KnifeSearch
        The best knife and a map about it, or the limit that cannot be kept.

    Raises
    ------
    InputError
        No topper.
    AssemblyError
        The mechanism of the knife does not close all round.
    """
    topper = require_topper(machine)
    limits = topper.limits
    roots = draw_roots(topper, seed)
    length_max = limits.length_max or (math.inf if objective == "shortest" else topper.edge_length)
    trials = Trials(machine, topper, thinned(roots, _ROOTS))
    search = KnifeGrid(trials, length_max, objective, watch)
    chosen = search.fastest() if objective == "fastest" else None
    speed = topper.forward_speed if chosen is None else chosen.forward_speed
    table = search.grid(speed, MAP, search.low, search.high)
    if chosen is None:
        chosen = search.shortest(speed, [value for row in table for value in row])
    if trials.roots is not roots:
        trials = Trials(machine, topper, roots, trials.count)
        search = KnifeGrid(trials, length_max, objective, watch)
        chosen = search.refined(chosen)
    keeps = search.keeps(chosen)
    return KnifeSearch(
        map_angle=np.array([row[0].edge_angle for row in table]),
        map_speed=np.array([row.knife_speed for row in table[0]]),
        map_length=np.array([[value.length for value in row] for row in table]),
        map_slicing=np.array([[value.slicing for value in row] for row in table]),
        objective=objective,
        limits=limits,
        length_max=length_max,
        tried=trials.count,
        best=_verified(trials, chosen, search, seed) if keeps else None,
        failing=None if keeps else failing_limit(chosen, roots, limits, length_max),
    )


def _verified(trials: Trials, chosen: Trial, search: KnifeGrid, seed: int | None) -> BestKnife:
    topper, roots, length = trials.topper, trials.roots, chosen.length
    at = (chosen.edge_angle, chosen.knife_speed, chosen.forward_speed)
    edges = trials.edges(*at)
    entries = {"edge_angle": at[0], "edge_length": length, "forward_speed": at[2]}
    best = topper.with_entries(entries)
    own = field_result(best, edges, roots, pass_over(edges, roots, length=length))
    other = (field_of(topper).seed if seed is None else seed) + _OTHER_SEED
    fresh = draw_roots(topper, other)
    check = field_result(best, edges, fresh, pass_over(edges, fresh, length=length, fine=FINE))
    rate = edges[0].knife.rate
    return BestKnife(
        edge_angle=at[0],
        edge_length=length,
        knife_speed=at[1],
        forward_speed=at[2],
        crank_speed=rate if isinstance(topper.motion, MemberKnife) else None,
        slicing_ratio_mean=own.slicing_ratio_mean,
        share_complete=own.share_complete,
        share_complete_low=own.share_complete_low,
        share_complete_high=own.share_complete_high,
        haulm_mean=own.haulm_mean,
        haulm_mean_low=own.haulm_mean_low,
        haulm_mean_high=own.haulm_mean_high,
        share_verified=check.share_complete,
        share_verified_low=check.share_complete_low,
        share_verified_high=check.share_complete_high,
        haulm_verified=check.haulm_mean,
        haulm_verified_low=check.haulm_mean_low,
        haulm_verified_high=check.haulm_mean_high,
        seed_verified=other,
        is_verified=_holds(own, check, topper.limits),
        at_bounds=_at_bounds(chosen, search),
    )


def _holds(own: TopperField, check: TopperField, limits: TopperLimits) -> bool:
    """Whether other roots keep the limits within the sampling errors of both samples."""
    most = math.inf if limits.haulm_max is None else max(limits.haulm_max, own.haulm_mean_high)
    least = min(limits.complete_min, own.share_complete_low)
    return check.haulm_mean_low <= most and check.share_complete_high >= least


def _at_bounds(chosen: Trial, search: KnifeGrid) -> tuple[str, ...]:
    ranges = {
        "angle": (chosen.edge_angle, search.low[0], search.high[0]),
        "knife_speed": (chosen.knife_speed, search.low[1], search.high[1]),
    }
    if search.is_fastest:
        ranges["forward_speed"] = (chosen.forward_speed, *search.speeds)
    bounds = []
    for key, (value, low, high) in ranges.items():
        near = _ON * (high - low)
        if high > low and min(value - low, high - value) <= near:
            bounds.append(f"{key}_min" if value - low <= near else f"{key}_max")
    return tuple(bounds)
