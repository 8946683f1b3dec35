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
from typing import Any

import numpy as np

from linkwright.kernel.numerics.tangent import Tangent
from linkwright.machine.machine import Machine
from linkwright.machine.tangents import Derivatives, directions, seeded, spread
from linkwright.topping.drive_along import drive_along
from linkwright.topping.edge import Edge, edges_of, require_topper
from linkwright.topping.knife import knife_drive
from linkwright.topping.knife_along import knife_along, refused_of_law
from linkwright.topping.last_point import OTHER_END, PLACES, Needs, needs_along
from linkwright.topping.model.topper import MemberKnife
from linkwright.topping.topper import TopperStudy, closed_forms, leaves, topper
from linkwright.topping.uncut_along import EdgeAlong
from linkwright.topping.uncut_head import mean_left_along, worst_left_along

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


class _Scalars:
    """Scalars of a topper with derivatives by some entries."""

    def __init__(
        self, machine: Machine, study: TopperStudy, edges: Sequence[Edge], names: Sequence[str]
    ) -> None:
        along = seeded(machine, names)
        assert machine.topper is not None
        assert along.topper is not None
        self.machine, self.study, self.edges = machine, study, edges
        self.topper, self.described = along.topper, machine.topper
        angle, speed = self.topper.edge_angle, self.topper.forward_speed
        moving = [Edge(knife_along(machine, along, list(names), edge.knife), angle, speed) for edge in edges]
        self.closed = closed_forms(self.topper, moving)
        self.n, self.diameter = len(names), self.closed["head_diameter"]
        half, radius = 0.5 * self.topper.edge_length, 0.5 * self.diameter
        self.along = [EdgeAlong(self.n, edge, half, radius) for edge in moving]

    def all(self) -> tuple[dict[str, Any], dict[str, str]]:
        """Numbers by name, and names of those that have no derivatives, with the reason."""
        scalars = dict(self.closed)
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
