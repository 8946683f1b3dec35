r"""Derivatives of what the knife of a topper does to heads, by entries of its machine.

Lengths in closed form, speeds and ratios follow from numbers with tangents. The head that needs most is the
one at which the end of the stroke meets the point that is reached last, or in a given phase the one whose
point has :math:`s\dot q = p\dot p/c`: those conditions move it, and the length at it has the derivative at a
fixed place (envelope theorem). So has the largest area that is left, whose head moves with the conditions

.. math:: \frac{\partial A}{\partial\theta} = \sum_s \frac{s v}{\omega}\,[y] = 0, \qquad
    \frac{\partial A}{\partial\delta} = -\sum_s s v\,[t] = 0,

the second where it lies inside the range of offsets. `topping.uncut_along` has the brackets and the areas.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from linkwright.kernel.numerics.tangent import Tangent, primal, total
from linkwright.machine.address import exchanged, get
from linkwright.machine.machine import Machine
from linkwright.machine.tangents import Derivatives, directions
from linkwright.topping.drive_along import drive_along, spread
from linkwright.topping.edge import Edge, edges_of, require_topper
from linkwright.topping.knife import knife_drive
from linkwright.topping.knife_along import knife_along, refused_of_law
from linkwright.topping.last_point import OTHER_END, PLACES, Needs, needs_along
from linkwright.topping.model.topper import MemberKnife
from linkwright.topping.slicing import mean_size
from linkwright.topping.topper import TopperStudy, leaves, topper
from linkwright.topping.uncut_along import EdgeAlong, slopes
from linkwright.topping.uncut_head import mean_left_along, worst_left_along

# Values that differ by less than this share are the same.
_SAME = 1e-10

_STATION = "it is one of fixed sample phases"
_NEVER_BACK = (
    "the edge runs backwards at times; the uncut area is then computed chord by chord, without derivatives"
)


def topper_tangents(machine: Machine, variables: Sequence[str]) -> Derivatives:
    """Scalars of the knife of a topper by some entries. Raises what `topper` raises."""
    described = require_topper(machine)
    study = topper(machine)
    edges = edges_of(machine, described)
    refused = refused_of_law(machine, variables, edges[0].knife)
    own = [name for name in variables if name not in refused and name.startswith(_OWN)]
    if isinstance(described.motion, MemberKnife):
        program = directions(machine, own)
        refused |= program.refused
        own = list(program.variables)
    drive = knife_drive(machine, edges[0].knife)
    asked = [name for name in variables if name not in refused]
    torques = None if drive is None else drive_along(machine, asked, drive)
    refused |= {} if torques is None else torques.program.refused
    listed = tuple(name for name in variables if name not in refused)
    # Numbers have tangents also where nothing of the knife is asked for: by an entry that is not listed.
    own = [name for name in own if name in listed] or ["topper.edge_length"]
    scalars, missing = _Scalars(machine, study, edges, own).all()
    numbers = {name: spread(number, own, listed) for name, number in scalars.items()}
    ties = dict.fromkeys(PLACES, OTHER_END) if edges[0].knife.rate and described.motion.phase is None else {}
    if torques is not None:
        ties, missing = ties | torques.ties, missing | torques.missing
        known = torques.program.variables
        numbers |= {name: spread(number, known, listed) for name, number in torques.numbers.items()}
        if "knife_acceleration_max" in numbers:
            numbers["inertia_force_max"] = numbers["knife_mass"] * numbers["knife_acceleration_max"]
        else:
            missing["inertia_force_max"] = missing["knife_acceleration_max"]
    tangents = {name: Tangent(float(getattr(study, name)), number.d) for name, number in numbers.items()}
    for name in tangents.keys() - ties.keys():
        by = [entry for entry, slope in zip(listed, tangents[name].d, strict=True) if np.isnan(slope)]
        if by:
            ties[name] = (
                f"two cases meet here: only one-sided derivatives exist with respect to {', '.join(by)}"
            )
    return Derivatives(
        listed, tangents, {name: why for name, why in ties.items() if name in tangents}, missing, refused
    )


# Entries that what the knife does depends on.
_OWN = ("topper.", "mechanism.", "drive.speed")


def _seeded(machine: Machine, names: Sequence[str]) -> Machine:
    """The machine with tangents by some of its entries, one of which follows from others by itself alone."""
    seeds: dict[str, Any] = {
        name: Tangent(float(get(machine, name)), unit)
        for name, unit in zip(names, np.eye(len(names)), strict=True)
    }
    return exchanged(machine, seeds)


class _Scalars:
    """Scalars of a topper with derivatives by some entries."""

    def __init__(
        self, machine: Machine, study: TopperStudy, edges: Sequence[Edge], names: Sequence[str]
    ) -> None:
        along = _seeded(machine, names)
        assert machine.topper is not None
        assert along.topper is not None
        self.machine, self.study, self.edges = machine, study, edges
        self.topper, self.described = along.topper, machine.topper
        depth = self.topper.cut_height * (self.topper.root_diameter - self.topper.cut_height)
        self.diameter: Any = 2 * depth**0.5
        half, radius = 0.5 * self.topper.edge_length, 0.5 * self.diameter
        self.along = [
            EdgeAlong(
                len(names),
                knife_along(machine, along, list(names), edge.knife),
                self.topper.edge_angle,
                self.topper.forward_speed,
                half,
                radius,
            )
            for edge in edges
        ]
        self.n = len(names)

    def all(self) -> tuple[dict[str, Any], dict[str, str]]:
        """Numbers by name, and names of those that have no derivatives, with the reason."""
        scalars = self._head() | self._motion() | self._closed() | self._slices()
        missing = {"best_phase": _STATION}
        for part in (self._needed, self._left):
            more, without = part()
            scalars |= more
            missing |= without
        study = self.study
        endless = [name for name in scalars if not np.isfinite(float(getattr(study, name)))]
        missing |= {name: f"it is {float(getattr(study, name)):g}" for name in endless}
        kept = {name: number for name, number in scalars.items() if name not in missing}
        return kept, {name: why for name, why in missing.items() if getattr(study, name) is not None}

    # -- closed forms ------------------------------------------------------------------------------------

    def _head(self) -> dict[str, Any]:
        height, root = self.topper.cut_height, self.topper.root_diameter
        volume = np.pi * height**2 * (1.5 * root - height) / 3
        return {"head_diameter": self.diameter, "cap_volume": volume}

    def _motion(self) -> dict[str, Any]:
        """How the knife moves."""
        knife, law = self.along[0].knife, self.along[0].knife.law
        least, greatest = law.extremes()
        frequency = knife.rate / (2 * np.pi)
        turns = sorted({*law.primal.breaks, *law.zeros(1)})
        places = [law.value(x, 0, "before") for x in turns]
        steps = [b - a for a, b in pairwise(places)]
        way = total([size(step) for step in steps if primal(step)])
        low, high = self._speeds(0)
        bends = [size(extreme.value) for extreme in law.extremes(2)]
        v, alpha = self.topper.forward_speed, self.topper.edge_angle
        return {
            "stroke": greatest.value - least.value,
            "frequency": frequency,
            "knife_speed": size(knife.drift) + way * frequency,
            "knife_speed_max": greatest_of(size(low), size(high)),
            "knife_acceleration_max": greatest_of(*bends) * knife.rate**2,
            "strokes_per_head": 2 * frequency * self.diameter / (v * np.cos(alpha)),
        }

    def _speeds(self, nth: int) -> tuple[Any, Any]:
        """Minimum and maximum velocity of the knife across the row."""
        knife = self.along[nth].knife
        least, greatest = (extreme.value * knife.rate + knife.drift for extreme in knife.law.extremes(1))
        return least, greatest

    def _closed(self) -> dict[str, Any]:
        """Lengths in closed form."""
        t, d = self.topper, self.diameter
        v, v_h = t.forward_speed, self._motion()["knife_speed"]
        band, alpha = d + 2 * t.offset, t.edge_angle
        sin, cos = size(np.sin(alpha)), np.cos(alpha)
        along, across = band * (cos + sin**2), (t.edge_length - band * sin) * cos
        ratio = v_h / v
        at_rest = (d + 2 * t.offset) / cos
        numbers = {
            "travel_along": along,
            "travel_across": across,
            "time_along": along / v,
            "length_published": band * (ratio * cos + sin),
            "length_consistent": band * (ratio * (1 + sin * sin / cos) + sin),
            "length_at_rest": at_rest,
        }
        finite = np.isfinite(self.study.time_across), np.isfinite(self.study.length_exact_constant_speed)
        numbers["time_across"] = across / v_h if finite[0] else 0.0
        numbers["length_exact_constant_speed"] = self._at_constant_speed(v_h) if finite[1] else 0.0
        return numbers

    def _at_constant_speed(self, v_h: Any) -> Any:
        """The worse of both directions."""
        t, v = self.topper, self.topper.forward_speed
        sin, cos = np.sin(t.edge_angle), np.cos(t.edge_angle)
        wanted = self.diameter * (v * v + v_h * v_h) ** 0.5 + 2 * t.offset * v
        return greatest_of(*(wanted / size(v * cos + way * v_h * sin) for way in (-1, 1)))

    def _slices(self) -> dict[str, Any]:
        """How the edge slices."""
        v, alpha = self.topper.forward_speed, self.topper.edge_angle
        speeds = [self._speeds(nth) for nth in range(len(self.edges))]
        leans = [[alpha + np.arctan2(w, v) for w in pair] for pair in speeds]
        least = [
            0.0 if primal(a) * primal(b) <= 0 else least_of(*map(size, map(np.tan, (a, b)))) for a, b in leans
        ]
        slow = [0.0 if primal(a) <= 0 <= primal(b) else least_of(size(a), size(b)) for a, b in speeds]
        fast = greatest_of(*(size(w) for pair in speeds for w in pair))
        worst = greatest_of(*(w * np.sin(alpha) for pair in speeds for w in pair))
        numbers = {
            "least_advance": v * np.cos(alpha) - worst,
            "slicing_ratio_min": least_of(*least),
            "slicing_ratio_max": 0.0
            if any(edge.retreats for edge in self.edges)
            else greatest_of(*(size(np.tan(lean)) for pair in leans for lean in pair)),
            "cutting_speed_min": (v * v + least_of(*slow) ** 2) ** 0.5,
            "cutting_speed_max": (v * v + fast**2) ** 0.5,
        }
        if np.isfinite(self.study.slicing_ratio_mean):
            numbers["slicing_ratio_mean"] = self._mean_ratio()
        return numbers

    def _mean_ratio(self) -> Any:
        v, alpha = self.topper.forward_speed, self.topper.edge_angle
        sin, cos = np.sin(alpha), np.cos(alpha)
        knives = [along.knife for along in self.along]
        along = total(mean_size(k.law, v * sin + k.drift * cos, k.rate * cos) for k in knives)
        normal = total(mean_size(k.law, v * cos - k.drift * sin, -k.rate * sin) for k in knives)
        return along / normal

    # -- heads -------------------------------------------------------------------------------------------

    def _needed(self) -> tuple[dict[str, Any], dict[str, str]]:
        """Length that the worst head needs, that head, and the length in the best phase."""
        if why := self._lost():
            return {}, dict.fromkeys((*_NEEDED, "length_best_phase"), why)
        needs = Needs(self.described, self.topper, self.edges, self.along, self.diameter, self.n)
        return needs_along(needs, self.study)

    def _left(self) -> tuple[dict[str, Any], dict[str, str]]:
        """What is left of the worst head, that head, and the mean."""
        if why := self._lost():
            return {}, dict.fromkeys((*_LEFT, *_LEFT_AT, "uncut_share_mean"), why)
        if not leaves(self.study):
            nothing = "no head has an uncut share"
            return dict.fromkeys((*_LEFT, "uncut_share_mean"), 0.0), dict.fromkeys(_LEFT_AT, nothing)
        worst, missing = worst_left_along(self.described, self.topper, self.edges, self.along, self.study)
        mean = mean_left_along(self.described, self.topper, self.edges, self.along)
        return worst | {"uncut_share_mean": mean}, missing

    def _lost(self) -> str:
        """Why heads are not followed with derivatives; empty if they are."""
        if self.study.obstacle is not None:
            return self.study.obstacle
        if any(edge.stands for edge in self.edges):
            return "the edge moves along itself and cuts nothing"
        return _NEVER_BACK if any(edge.retreats for edge in self.edges) else ""


_NEEDED = ("length_exact", "worst_phase", "worst_offset", "last_x", "last_y")
_LEFT = ("uncut_share", "uncut_right", "uncut_left", "uncut_between")
_LEFT_AT = ("uncut_phase", "uncut_offset")


def size(x: Any) -> Any:
    """The size of a number; at zero it has no derivative by what moves it."""
    if isinstance(x, Tangent) and x.value == 0.0:
        return Tangent(0.0, np.where(x.d == 0.0, 0.0, np.nan))
    return abs(x)


def greatest_of(*numbers: Any) -> Any:
    """The maximum; where two are as large, with the derivatives that they have in common."""
    first = max(numbers, key=primal)
    close = _SAME * abs(float(primal(first)))
    rivals = [x for x in numbers if primal(first) - primal(x) <= close]
    d: Any = [slopes(x) for x in rivals]
    n = next((len(x) for x in d if np.ndim(x)), 0)
    if not n or len(rivals) < 2:
        return first
    rows = np.array([np.broadcast_to(x, n) for x in d])
    apart = np.abs(rows - rows[0]).max(axis=0) > _SAME * np.abs(rows).max()
    return Tangent(float(primal(first)), np.where(apart, np.nan, rows[0]))


def least_of(*numbers: Any) -> Any:
    """The minimum, likewise."""
    return -greatest_of(*(-x for x in numbers))
