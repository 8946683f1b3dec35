"""What a topper does to a field of roots with the length, angle or speeds of its knife varied.

`linkwright.studies.knives` computes it, as a study of the machine.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated

from linkwright.kernel.arrays import Floats
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.kernel.units.kinds import ANGLE, LENGTH, VELOCITY, Kind
from linkwright.machine.machine import Machine
from linkwright.topping.edge import Edge, edges_of
from linkwright.topping.knife import knives
from linkwright.topping.model.topper import ConstantKnife, MemberKnife, Topper

# What may vary, and its quantity.
ENTRIES: dict[str, Kind] = {
    "edge_length": LENGTH,
    "edge_angle": ANGLE,
    "forward_speed": VELOCITY,
    "knife_speed": VELOCITY,
    "cut_height": LENGTH,
}


@dataclass(frozen=True)
class FieldSweep(Result):
    """Variants of a knife over the same roots; arrays (n,), of two entries the second varies first.

    What is found is NaN for an edge that runs over heads and back again and again, and hardly goes on.
    """

    entries: Annotated[dict[str, Floats], About("Varied entries by name; values of each variant.")]
    shape: Annotated[tuple[int, ...], About("How many values of each entry.")]
    share_complete: Annotated[
        Floats,
        Label(
            "share of heads cut through",
            "",
            "",
            "Of each variant.",
            shape="(n,)",
            over="share_complete",
        ),
    ]
    share_complete_low: Annotated[
        Floats,
        Label("minimum share of heads cut through", "", "", "End of its interval."),
    ]
    share_complete_high: Annotated[
        Floats,
        Label("maximum share of heads cut through", "", "", "End of its interval."),
    ]
    haulm_mean: Annotated[Floats, Label("mean uncut share of the head", "", "")]
    haulm_mean_low: Annotated[
        Floats,
        Label("minimum mean uncut share of the head", "", "", "End of its interval."),
    ]
    haulm_mean_high: Annotated[
        Floats,
        Label("maximum mean uncut share of the head", "", "", "End of its interval."),
    ]
    loss_mean: Annotated[Floats, Label("mean volume of a root above the cut", "", "m³")]
    length_for_95: Annotated[Floats, Label("length for 95 % of the heads", "", "m")]
    slicing_ratio_mean: Annotated[Floats, Label("mean draw-cut ratio", "", "")]
    level: Annotated[float, Label("confidence level", "", "")]

    def columns(self) -> dict[str, Floats]:
        """All that varied and all that was found, by name."""
        return {**self.entries, **{name: getattr(self, name) for name in FOUND}}


# What is found of each variant.
FOUND = (
    "share_complete",
    "share_complete_low",
    "share_complete_high",
    "haulm_mean",
    "haulm_mean_low",
    "haulm_mean_high",
    "loss_mean",
    "length_for_95",
    "slicing_ratio_mean",
)


def edges_with(machine: Machine, topper: Topper, knife_speed: float | None) -> list[Edge]:
    """The edge of a topper whose knife goes at another speed.

    ``knife_speed``: mean speed [m/s] of a knife that a mechanism moves, whose crank turns the faster; at zero
    it rests in mid-stroke. None for that of the drive.
    """
    if knife_speed is None or not isinstance(topper.motion, MemberKnife):
        return edges_of(machine, topper)
    if knife_speed == 0:
        still = topper.with_entries({"motion": ConstantKnife(kind="constant"), "knife_speed": 0.0})
        return edges_of(machine, still)
    (knife,) = knives(machine, topper)
    faster = replace(knife, rate=knife.rate * knife_speed / knife.mean_speed)
    return [Edge(faster, topper.edge_angle, topper.forward_speed)]
