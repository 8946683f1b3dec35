"""A topper over a field of roots, with the length, angle or speeds of its knife varied.

All variants meet the same roots, in rows that begin in the same phases: what differs between them is due to
the knife, not to chance.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any

import numpy as np
from numpy.typing import ArrayLike

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import FindingError, InputError, require_within
from linkwright.kernel.limits import FIELD_VARIANTS
from linkwright.kernel.public import public
from linkwright.kernel.public.arguments import array
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.kernel.units import ANGLE, LENGTH, VELOCITY, Kind, worded
from linkwright.machine.machine import Machine
from linkwright.topping.coverage import COARSE, Watch, pass_over
from linkwright.topping.edge import Edge, edges_of, require_topper
from linkwright.topping.field import TopperField, field_result
from linkwright.topping.knife import knives
from linkwright.topping.model.topper import ConstantKnife, MemberKnife, Topper
from linkwright.topping.roots import Roots, draw_roots

# What may vary, and its quantity.
ENTRIES: dict[str, Kind] = {
    "edge_length": LENGTH,
    "edge_angle": ANGLE,
    "forward_speed": VELOCITY,
    "knife_speed": VELOCITY,
    "cut_height": LENGTH,
}

# Entries that may be zero, and that may have any sign.
_FROM_ZERO, _SIGNED = ("knife_speed",), ("edge_angle", "cut_height")


@dataclass(frozen=True)
class FieldSweep(Result):
    """Variants of a knife over the same roots; arrays (n,), of two entries the second varies first.

    What is found is NaN for an edge that runs over heads and back again and again, and hardly goes on.
    """

    entries: Annotated[dict[str, Floats], About("What was varied, by name; of each variant.")]
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
        Label(
            "minimum share of heads cut through",
            "",
            "",
            "End of its interval.",
            over="share_complete_low",
        ),
    ]
    share_complete_high: Annotated[
        Floats,
        Label(
            "maximum share of heads cut through",
            "",
            "",
            "End of its interval.",
            over="share_complete_high",
        ),
    ]
    haulm_mean: Annotated[Floats, Label("mean uncut share of the head", "", "", over="haulm_mean")]
    haulm_mean_low: Annotated[
        Floats,
        Label(
            "minimum mean uncut share of the head",
            "",
            "",
            "End of its interval.",
            over="haulm_mean_low",
        ),
    ]
    haulm_mean_high: Annotated[
        Floats,
        Label(
            "maximum mean uncut share of the head",
            "",
            "",
            "End of its interval.",
            over="haulm_mean_high",
        ),
    ]
    loss_mean: Annotated[Floats, Label("mean volume of a root above the cut", "", "m³", over="loss_mean")]
    length_for_95: Annotated[Floats, Label("length for 95 % of the heads", "", "m", over="length_for_95")]
    slicing_ratio_mean: Annotated[Floats, Label("mean draw-cut ratio", "", "", over="slicing_ratio_mean")]
    level: Annotated[float, Label("confidence level", "", "")]

    def columns(self) -> dict[str, Floats]:
        """All that varied and all that was found, by name."""
        return {**self.entries, **{name: getattr(self, name) for name in _FOUND}}


_FOUND = (
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


@public
def sweep_field(
    machine: Machine,
    over: Mapping[str, ArrayLike],
    *,
    seed: int | None = None,
    level: float = 0.95,
    fine: int = COARSE,
    watch: Watch | None = None,
) -> FieldSweep:
    """Vary one or two entries of a knife over a field of roots.

    Parameters
    ----------
    machine : Machine
        With a topper.
    over : mapping of str to array_like, shape (k,)
        Values of one or two entries of `ENTRIES`; heights of the cut are shifted so that their mean is
        the one asked for.
    seed : int, optional
        Seed of the random generator, in place of that of the field.
    level : float
        Confidence level of the intervals.
    fine : int
        Stations per revolution of the law.
    watch : callable, optional
        Told how much is done, from 0 to 1.

    Returns
    -------
    FieldSweep
        All combinations.

    Raises
    ------
    InputError
        No topper, no such entry, values that are none of it, too many of them.
    FindingError
        No variant can be computed.
    """
    topper = require_topper(machine)
    axes = {name: _axis(name, values) for name, values in over.items()}
    shape = tuple(len(axis) for axis in axes.values())
    _require(shape)
    grid = np.meshgrid(*axes.values(), indexing="ij")
    columns = {name: values.ravel() for name, values in zip(axes, grid, strict=True)}
    roots, n = draw_roots(topper, seed), int(np.prod(shape))
    results = []
    for i in range(n):
        part = None if watch is None else _part(watch, i, n)
        entries = {name: float(column[i]) for name, column in columns.items()}
        results.append(_tried(machine, topper, roots, entries, level, fine=fine, watch=part))
    refused = [result for result in results if isinstance(result, FindingError)]
    if len(refused) == n:
        raise refused[0]
    arrays: dict[str, Any] = {
        name: np.array([getattr(result, name, np.nan) for result in results]) for name in _FOUND
    }
    return FieldSweep(entries=columns, shape=shape, level=level, **arrays)


def _part(watch: Watch, i: int, n: int) -> Watch:
    """What watches one of the variants."""
    return lambda done: watch((i + done) / n)


def _tried(
    machine: Machine, topper: Topper, roots: Roots, entries: Mapping[str, float], level: float, **how: Any
) -> TopperField | FindingError:
    """One variant over the roots, or why it cannot be computed."""
    try:
        return _variant(machine, topper, roots, entries, level, **how)
    except FindingError as error:
        return error


def _variant(
    machine: Machine, topper: Topper, roots: Roots, entries: Mapping[str, float], level: float, **how: Any
) -> TopperField:
    """One variant over the roots."""
    height = entries.get("cut_height")
    if height is not None:
        roots = replace(roots, cut_height=roots.cut_height + (height - roots.cut_height.mean()))
    changed = topper.with_entries({key: x for key, x in entries.items() if key != "cut_height"})
    edges = edges_with(machine, changed, entries.get("knife_speed"))
    passed = pass_over(edges, roots, length=changed.edge_length, **how)
    return field_result(changed, edges, roots, passed, level)


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


def _axis(name: str, values: ArrayLike) -> Floats:
    """Values of an entry, or the fault."""
    if name not in ENTRIES:
        raise InputError(f'over: found "{name}", expected an entry of the knife; {suggestion(name, ENTRIES)}')
    axis = np.atleast_1d(array(f"over: {name}", values))
    if axis.ndim != 1 or not len(axis) or not np.isfinite(axis).all():
        raise InputError(f"over: found no list of finite numbers for {name}")
    wrong = _beyond(name, axis)
    if wrong is not None:
        raise InputError(f"over: found {name} {worded(wrong, ENTRIES[name])}, expected {_expected(name)}")
    return axis


def _beyond(name: str, axis: Floats) -> float | None:
    """A value that the entry cannot have."""
    if name == "edge_angle":
        off = np.abs(axis) >= np.pi / 2
    elif name in _SIGNED:
        off = np.zeros(len(axis), dtype=bool)
    else:
        off = axis < 0 if name in _FROM_ZERO else axis <= 0
    return float(axis[off][0]) if off.any() else None


def _expected(name: str) -> str:
    if name == "edge_angle":
        return "an angle between -90 and 90 deg"
    return "0 or more" if name in _FROM_ZERO else "more than 0"


def _require(shape: Sequence[int]) -> None:
    """Refuse what is no sweep."""
    if not 1 <= len(shape) <= 2:
        raise InputError(f"over: found {len(shape)} entries, expected one or two")
    require_within(FIELD_VARIANTS, float(np.prod(shape, dtype=float)), "over", "vary less, or more coarsely")
