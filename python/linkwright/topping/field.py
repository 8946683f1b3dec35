r"""A field of roots under the knife: how many heads are cut through, what is left, what is lost.

Of a root, D, h_p and δ are drawn or measured, and the phase of the knife in which it is met
(`roots`). `coverage` gives the length L that its head needs; then

* the share of heads that an edge cuts through is the distribution function of the lengths needed, for
  all lengths of the edge at once, and its quantiles are the lengths for 50, 90, 95, 99 and 99.9 % of heads;
* the haulm that remains is the mean share of the head's area that is not crossed: haulm grows from the disc;
* the loss is the cap of the root above the cut, whether all of it comes off or not.

A root whose h_p is 0 or less is missed: no length cuts it, and all its haulm remains. A root whose h_p comes
to D or more is lost as a whole; no haulm remains, so that it counts as cut.

References
----------
.. [1] Derived here; `intervals` and `share_curve` for the intervals.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.machine.machine import Machine
from linkwright.topping.coverage import COARSE, Pass, Watch, pass_over
from linkwright.topping.edge import Edge, edges_of, require_topper
from linkwright.topping.intervals import QUANTILES, Clusters, Interval, ShareCurve
from linkwright.topping.model.topper import Topper
from linkwright.topping.roots import Roots, draw_roots, field_of
from linkwright.topping.slicing import slicing

# Lengths of the curve, from zero to the maximum that a head needs.
_LENGTHS = 201


@dataclass(frozen=True)
class TopperField(Result):
    """What an edge does to a field of roots."""

    length: Annotated[
        Floats,
        Label(
            "length of the edge",
            "L",
            "m",
            "From zero to that which cuts all heads that can be cut.",
            shape="(k,)",
        ),
    ]
    share: Annotated[Floats, Label("share of heads that a length cuts through", "", "")]
    share_low: Annotated[
        Floats,
        Label(
            "minimum share of heads that a length cuts through",
            "",
            "",
            "End of its interval, each length by itself.",
        ),
    ]
    share_high: Annotated[
        Floats,
        Label(
            "maximum share of heads that a length cuts through",
            "",
            "",
            "End of its interval, each length by itself.",
        ),
    ]
    length_needed: Annotated[
        Floats,
        Label(
            "required length of each head",
            "",
            "m",
            "Infinite for a missed head.",
            shape="(n,)",
            over="length_needed",
        ),
    ]
    root_loss: Annotated[
        Floats, Label("volume of each root above the cut", "", "m³", shape="(n,)", over="root_loss")
    ]
    n_roots: Annotated[int, Label("roots evaluated", "", "", "Of measured ones each in all its phases.")]
    n_clusters: Annotated[int, Label("rows, or measured roots", "", "")]
    clusters: Annotated[str, About('``"rows"`` or ``"roots"``.')]
    n_missed: Annotated[int, Label("roots that the knife passes above", "", "")]
    n_lost: Annotated[int, Label("roots that the knife passes below", "", "")]
    level: Annotated[float, Label("confidence level", "", "")]
    edge_length: Annotated[float, Label("length of the edge", "L", "m", "That it has.")]
    share_complete: Annotated[float, Label("share of heads cut through", "", "")]
    share_complete_low: Annotated[
        float, Label("minimum share of heads cut through", "", "", "End of its interval.")
    ]
    share_complete_high: Annotated[
        float, Label("maximum share of heads cut through", "", "", "End of its interval.")
    ]
    haulm_mean: Annotated[float, Label("mean uncut share of the head", "", "")]
    haulm_mean_low: Annotated[
        float, Label("minimum mean uncut share of the head", "", "", "End of its interval.")
    ]
    haulm_mean_high: Annotated[
        float, Label("maximum mean uncut share of the head", "", "", "End of its interval.")
    ]
    loss_mean: Annotated[float, Label("mean volume of a root above the cut", "", "m³")]
    loss_mean_low: Annotated[
        float, Label("minimum mean volume of a root above the cut", "", "m³", "End of its interval.")
    ]
    loss_mean_high: Annotated[
        float, Label("maximum mean volume of a root above the cut", "", "m³", "End of its interval.")
    ]
    loss_share: Annotated[float, Label("share of all roots that is above the cut", "", "")]
    loss_share_low: Annotated[
        float, Label("minimum share of all roots that is above the cut", "", "", "End of its interval.")
    ]
    loss_share_high: Annotated[
        float, Label("maximum share of all roots that is above the cut", "", "", "End of its interval.")
    ]
    loss_mass_mean: Annotated[
        float | None, Label("mean mass of a root above the cut", "", "kg", "With a density.")
    ]
    slicing_ratio_mean: Annotated[float, Label("mean draw-cut ratio", "", "", "Of the edge, in all phases.")]
    quantile: Annotated[tuple[float, ...], About("Shares of heads.")]
    quantile_length: Annotated[
        tuple[float, ...], About("Length for each of them [m]; infinite where so many cannot be cut.")
    ]
    quantile_length_low: Annotated[
        tuple[float, ...], About("Minimum length for each of them [m]: end of its interval.")
    ]
    quantile_length_high: Annotated[
        tuple[float, ...], About("Maximum length for each of them [m]: end of its interval.")
    ]

    @public
    def length_at(self, share: float) -> float:
        """Minimum length that cuts through a share, from 0 to 1, of the heads [m]."""
        if not 0 <= share <= 1:
            raise InputError(f"share: found {share:g}, expected a share of the heads from 0 to 1")
        place = int(np.ceil(share * self.n_roots - 1e-9)) - 1
        return float(np.sort(self.length_needed)[max(place, 0)])

    @property
    def length_for_50(self) -> Annotated[float, Label("length for half of the heads", "", "m")]:
        """Length for half of the heads."""
        return self.quantile_length[0]

    @property
    def length_for_90(self) -> Annotated[float, Label("length for 90 % of the heads", "", "m")]:
        """Length for 90 % of the heads."""
        return self.quantile_length[1]

    @property
    def length_for_95(self) -> Annotated[float, Label("length for 95 % of the heads", "", "m")]:
        """Length for 95 % of the heads."""
        return self.quantile_length[2]

    @property
    def length_for_99(self) -> Annotated[float, Label("length for 99 % of the heads", "", "m")]:
        """Length for 99 % of the heads."""
        return self.quantile_length[3]

    @property
    def length_for_99_9(self) -> Annotated[float, Label("length for 99.9 % of the heads", "", "m")]:
        """Length for 99.9 % of the heads."""
        return self.quantile_length[4]


@public
def topper_field(
    machine: Machine,
    *,
    seed: int | None = None,
    level: float = 0.95,
    fine: int = COARSE,
    watch: Watch | None = None,
) -> TopperField:
    """Study a topper over a field of roots.

    Parameters
    ----------
    machine : Machine
        With a topper; without a field, its roots are all alike and stand evenly within the offset.
    seed : int, optional
        Seed of the random generator, in place of that of the field.
    level : float
        Confidence level of the intervals.
    fine : int
        Stations per revolution of the law.
    watch : callable, optional
        Progress callback, 0 to 1.

    Returns
    -------
    TopperField
        The same for the same seed, with any number of threads.

    Raises
    ------
    InputError
        No topper, a seed below 0, a level that is no probability.
    AssemblyError
        The mechanism of the knife does not close all round.
    FindingError
        The edge runs over heads and back again and again, and barely advances.
    """
    topper = require_topper(machine)
    roots = draw_roots(topper, seed)
    edges = edges_of(machine, topper)
    passed = pass_over(edges, roots, length=topper.edge_length, fine=fine, watch=watch)
    return field_result(topper, edges, roots, passed, level)


def field_result(
    topper: Topper, edges: Sequence[Edge], roots: Roots, passed: Pass, level: float = 0.95
) -> TopperField:
    """Sum up a pass of an edge over roots."""
    is_random = topper.field is None or topper.field.kind == "random"
    # Phases mean nothing to a knife that rests.
    are_free = roots.are_free or (is_random and not edges[0].knife.rate)
    clusters = Clusters(roots.cluster, roots.n_clusters, are_free, level)
    clusters = replace(clusters, worth=ShareCurve(passed.length_needed, clusters).worth())
    curve = ShareCurve(passed.length_needed, clusters)
    top = float(passed.length_needed[np.isfinite(passed.length_needed)].max(initial=topper.edge_length))
    length = np.linspace(0.0, top, _LENGTHS)
    share = curve.at(length)
    density = field_of(topper).root_density
    loss = clusters.mean(roots.cap)
    return TopperField(
        length=length,
        share=share.value,
        share_low=share.low,
        share_high=share.high,
        length_needed=passed.length_needed,
        root_loss=roots.cap,
        n_roots=len(passed.length_needed),
        n_clusters=roots.n_clusters,
        clusters="rows" if is_random else "roots",
        n_missed=int(roots.is_missed.sum()),
        n_lost=int(roots.is_lost.sum()),
        level=level,
        edge_length=topper.edge_length,
        **_named("share_complete", curve.at(np.array([topper.edge_length]))),
        **_named("haulm_mean", clusters.share(passed.left)),
        **_named("loss_mean", loss),
        **_named("loss_share", clusters.ratio(roots.cap, roots.volume)),
        loss_mass_mean=None if density is None else density * float(loss.value),
        slicing_ratio_mean=slicing(edges).ratio_mean,
        **_quantiles(curve),
    )


def _named(name: str, interval: Interval) -> dict[str, Any]:
    keys = (name, f"{name}_low", f"{name}_high")
    return {key: float(np.squeeze(value)) for key, value in zip(keys, interval, strict=True)}


def _quantiles(curve: ShareCurve) -> dict[str, Any]:
    keys = ("quantile_length", "quantile_length_low", "quantile_length_high")
    lengths = (tuple(length.tolist()) for length in curve.lengths(QUANTILES))
    return {"quantile": QUANTILES, **dict(zip(keys, lengths, strict=True))}
