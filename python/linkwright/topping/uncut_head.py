r"""The head of which an edge leaves most, and the mean that it leaves, with derivatives.

Where the phase is free the largest area has :math:`\partial A/\partial\theta = 0`, inside the range of
offsets :math:`\partial A/\partial\delta = 0`, too (`topping.gradient`). With the times of the ends known with
their derivatives, both conditions are, and their zero moves by what they change over their slopes.

References
----------
.. [1] Derived here.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.numerics.extreme import ALIKE_OF_SOLVED, common
from linkwright.kernel.numerics.implicit import solution_along
from linkwright.kernel.numerics.tangent import Tangent, lifted, primal
from linkwright.topping.coverage import coverage
from linkwright.topping.edge import Edge
from linkwright.topping.model.topper import Topper
from linkwright.topping.topper import NOTHING, TopperStudy
from linkwright.topping.uncut_along import (
    EdgeAlong,
    Ends,
    Heads,
    end_times,
    exposed,
    slopes,
    uncut_slopes,
)
from linkwright.topping.worst_head import heads_as_bad, mean_heads

# An offset this near to the largest one, as a share, is that.
_AT_END = 1e-9

# Share of the largest slope below which a condition does not move: the head is not the only one.
_LEVEL = 1e-9

_NOT_ALONE = "several heads have the same uncut share; the one shown is arbitrary"
_ALL = "the whole head is uncut"


def worst_left_along(
    described: Topper, topper: Topper, edges: Sequence[Edge], along: Sequence[EdgeAlong], study: TopperStudy
) -> tuple[dict[str, Any], dict[str, str]]:
    """What is left of the worst head and where it is; names without derivatives, with the reason."""
    area, d = 0.25 * np.pi * study.head_diameter**2, study.head_diameter

    def left(edge: Edge, offset: Floats, phase: Floats) -> Floats:
        return coverage(edge, d, offset, phase, length=described.edge_length).uncut / area

    worst = [float(left(edge, *_place(study))[0]) for edge in edges]
    nth = int(np.argmin(np.abs(np.array(worst) - study.uncut_share)))
    numbers, missing = _Worst(described, topper, edges[nth], along[nth], study).numbers()
    if study.uncut_share >= 1 - NOTHING:
        missing = dict.fromkeys(("uncut_phase", "uncut_offset"), _ALL)
    elif study.uncut_share > 0:
        for head in heads_as_bad(edges, described.offset, described.motion.phase, left, worst[nth]):
            at = next(i for i, edge in enumerate(edges) if edge is head.edge)
            there = replace(study, uncut_phase=head.phase, uncut_offset=head.offset)
            other = _Worst(described, topper, edges[at], along[at], there).numbers()[0]
            both = np.stack([numbers["uncut_share"].d, other["uncut_share"].d])
            # Heads that are mirror images, whose places are looked for.
            of_both = common(both, alike=ALIKE_OF_SOLVED)
            numbers["uncut_share"] = Tangent(numbers["uncut_share"].value, of_both)
    return numbers, missing


def _place(study: TopperStudy) -> tuple[Floats, Floats]:
    return np.array([study.uncut_offset]), np.array([study.uncut_phase])


class _Worst:
    """The worst head: conditions of its place, and what is left of it."""

    def __init__(
        self, described: Topper, topper: Topper, edge: Edge, along: EdgeAlong, study: TopperStudy
    ) -> None:
        self.described, self.topper, self.edge, self.along = described, topper, edge, along
        self.n = along.n
        self.half = 0.5 * described.edge_length
        self.radius = 0.5 * study.head_diameter
        self.phase, self.offset = study.uncut_phase, study.uncut_offset
        self.turns = bool(edge.knife.rate) and described.motion.phase is None
        self.inside = described.offset > 0 and abs(self.offset) < described.offset * (1 - _AT_END)

    def numbers(self) -> tuple[dict[str, Any], dict[str, str]]:
        """What is left and where; names without derivatives, with the reason."""
        n, radius_d = self.n, slopes(self.along.radius)
        phase_d, offset_d, missing = self._moves()
        at_place = self._areas(
            np.zeros(n) if self.turns else phase_d, np.zeros(n) if self.inside else offset_d
        )
        values, sides = self._values(), self._areas(phase_d, offset_d)
        disc = np.pi * self.radius**2
        numbers = {
            # The largest area moves as at a fixed place; the part on a side moves with it.
            "uncut_share": _share(values.sum(), at_place.sum(axis=0), disc, self.radius, radius_d),
            "uncut_right": _share(values[0], sides[0], disc, self.radius, radius_d),
            "uncut_left": _share(values[1], sides[1], disc, self.radius, radius_d),
            "uncut_between": 0.0,
            "uncut_phase": Tangent(self.phase, phase_d),
            "uncut_offset": Tangent(self.offset, offset_d),
        }
        return numbers, missing

    def _moves(self) -> tuple[Floats, Floats, dict[str, str]]:
        """How phase and offset of the head move, by both conditions; names without derivatives."""
        n, free = self.n, np.array([self.turns, self.inside])
        at_end = np.sign(self.offset) * np.broadcast_to(slopes(self.topper.offset), n)
        moved = np.stack(
            [np.broadcast_to(slopes(self.topper.motion.phase), n), np.zeros(n) if self.inside else at_end]
        )
        if not free.any():
            return moved[0], moved[1], {}
        # By the variables at a held place, and by phase and offset.
        held = np.zeros_like(moved[0]) if self.turns else moved[0]
        changes = self._conditions(self.along, held, moved[1])[free]
        still = EdgeAlong(2, self.edge, self.half, self.radius)
        matrix = self._conditions(still, *np.eye(2)).d[free][:, free]
        most = max(np.abs(changes.d).max(initial=0.0), np.abs(matrix).max())
        if np.linalg.matrix_rank(matrix, tol=_LEVEL * most) < free.sum():
            moved[free] = np.nan
            return moved[0], moved[1], dict.fromkeys(_SIDES, _NOT_ALONE)
        moved[free] = solution_along(np.array([self.phase, self.offset])[free], changes, matrix).d
        return moved[0], moved[1], {}

    def _exposed(self, phase_d: Floats, offset_d: Floats) -> tuple[Heads, Ends, Heads]:
        """The head, the ends of what it has uncut, and the head with derivatives."""
        offset, phase = np.array([self.offset]), np.array([self.phase])
        heads = Heads(self.radius, offset, phase)
        moved = Heads(self.radius, Tangent(offset, offset_d[None]), Tangent(phase, phase_d[None]))
        return heads, exposed(self.edge, heads, self.half), moved

    def _areas(self, phase_d: Floats, offset_d: Floats) -> Floats:
        """Derivatives of the areas on the right and on the left."""
        areas: Floats = uncut_slopes(self.edge, self.along, *self._exposed(phase_d, offset_d))[0]
        return areas

    def _values(self) -> Floats:
        cut = coverage(self.edge, 2 * self.radius, self.offset, self.phase, length=2 * self.half)
        return np.array([cut.uncut_right[0], cut.uncut_left[0]])

    def _conditions(self, along: EdgeAlong, phase_d: Floats, offset_d: Floats) -> Any:
        """Both conditions of the place with derivatives, (2,)."""
        heads, ends, moved = self._exposed(phase_d, offset_d)
        times = end_times(self.edge, along, heads, ends, moved)
        weight = ends.sign * ends.chord * ends.side
        y = replace(along.edge.knife, drift=0.0).at(times, moved.phase[ends.head])
        return np.stack([(y * weight).sum(), (times * weight).sum()])


_SIDES = ("uncut_phase", "uncut_offset", "uncut_right", "uncut_left")


def _share(value: float, d: Floats, disc: float, radius: float, radius_d: Any) -> Tangent:
    return Tangent(value / disc, d / disc - 2 * value / (disc * radius) * radius_d)


def mean_left_along(
    described: Topper, topper: Topper, edges: Sequence[Edge], along: Sequence[EdgeAlong]
) -> Tangent:
    """Mean share that is left, over the heads of `topping.worst_head`."""
    shares, phases = mean_heads(described, edges)
    n = along[0].n
    radius, radius_d = float(primal(along[0].radius)), slopes(along[0].radius)
    disc, half = np.pi * radius**2, 0.5 * described.edge_length
    value, d = 0.0, np.zeros(n)
    heads = Heads(radius, shares * described.offset, phases)
    phase_d = np.broadcast_to(slopes(topper.motion.phase), (len(phases), n))
    moved = Heads(radius, lifted(shares * topper.offset, n), Tangent(phases, phase_d))
    for edge, with_d in zip(edges, along, strict=True):
        value += float(coverage(edge, 2 * radius, heads.offset, phases, length=2 * half).uncut.mean())
        ends = exposed(edge, heads, half)
        d = d + uncut_slopes(edge, with_d, heads, ends, moved).sum(axis=1).mean(axis=0)
    return _share(value / len(edges), d / len(edges), disc, radius, radius_d)
