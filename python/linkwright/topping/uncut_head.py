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
from linkwright.kernel.numerics.tangent import Tangent, lifted, primal, variables_of
from linkwright.topping.coverage import coverage
from linkwright.topping.edge import Edge
from linkwright.topping.model.topper import Topper
from linkwright.topping.topper import NOTHING, TopperStudy
from linkwright.topping.uncut_along import (
    EdgeAlong,
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
    """Offset and phase of the worst head, (1,) each."""
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
        conditions = self._conditions(moved[1], moved[0])[free]
        matrix = conditions[:, n:][:, free]
        if np.linalg.matrix_rank(matrix, tol=_LEVEL * np.abs(conditions).max()) < free.sum():
            moved[free] = np.nan
            return moved[0], moved[1], dict.fromkeys(_SIDES, _NOT_ALONE)
        moved[free] = -np.linalg.solve(matrix, conditions[:, :n])
        return moved[0], moved[1], {}

    def _heads(self) -> Heads:
        return Heads(self.radius, np.array([self.offset]), np.array([self.phase]))

    def _areas(self, phase_d: Floats, offset_d: Floats) -> Floats:
        """Derivatives of the areas on the right and on the left."""
        heads = self._heads()
        ends = exposed(self.edge, heads, self.half)
        moved = {"offset": offset_d[None], "phase": phase_d[None]}
        areas: Floats = uncut_slopes(self.edge, self.along, heads, ends, moved)[0]
        return areas

    def _values(self) -> Floats:
        """Areas on the right and on the left."""
        cut = coverage(self.edge, 2 * self.radius, self.offset, self.phase, length=2 * self.half)
        return np.array([cut.uncut_right[0], cut.uncut_left[0]])

    def _conditions(self, offset_d: Floats, phase_d: Floats) -> Floats:
        """Derivatives of both conditions by the variables, and by phase and offset, (2, variables + 2)."""
        heads = self._heads()
        ends = exposed(self.edge, heads, self.half)
        wide = widened(self.along, self.n)
        moved = {
            "offset": np.append(offset_d, [0.0, 1.0])[None],
            "phase": np.append(phase_d if not self.turns else np.zeros(self.n), [1.0, 0.0])[None],
        }
        times = end_times(self.edge, wide, heads, ends, moved)
        weight = ends.sign * ends.chord * ends.side
        phase = lifted(np.full(len(ends.time), self.phase), wide.n)
        phase.d[:] = moved["phase"]
        y = replace(wide.edge.knife, drift=0.0).at(times, phase)
        return np.stack([(y * weight).sum().d, (times * weight).sum().d])


_SIDES = ("uncut_phase", "uncut_offset", "uncut_right", "uncut_left")


def widened(along: EdgeAlong, n: int) -> EdgeAlong:
    """An edge with two variables more, which none of its numbers depends on."""

    def wider(x: Any) -> Any:
        return type(x)(x.value, np.append(x.d, [0.0, 0.0])) if variables_of((x,)) else x

    edge, knife, law = along.edge, along.edge.knife, along.edge.knife.law
    pieces = tuple(
        piece._replace(
            polynomial=tuple(map(wider, piece.polynomial)),
            harmonics=tuple(type(wave)(*map(wider, wave)) for wave in piece.harmonics),
        )
        for piece in law.pieces
    )
    law = type(law)(tuple(map(wider, law.breaks)), pieces)
    wide = replace(knife, law=law, rate=wider(knife.rate), drift=wider(knife.drift))
    moving = Edge(wide, wider(edge.angle), wider(edge.forward_speed))
    return EdgeAlong(n + 2, moving, wider(along.half), wider(along.radius))


def _share(value: float, d: Floats, disc: float, radius: float, radius_d: Any) -> Tangent:
    """An area as a share of the disc."""
    return Tangent(value / disc, d / disc - 2 * value / (disc * radius) * radius_d)


def mean_left_along(
    described: Topper, topper: Topper, edges: Sequence[Edge], along: Sequence[EdgeAlong]
) -> Tangent:
    """Mean share that is left, over the heads of `topping.worst_head`."""
    shares, phases = mean_heads(described, edges)
    n = along[0].n
    radius_d = np.broadcast_to(slopes(along[0].radius), n)
    radius = float(primal(along[0].radius))
    disc, half = np.pi * radius**2, 0.5 * described.edge_length
    offset_d = shares[:, None] * np.broadcast_to(slopes(topper.offset), n)
    phase_d = np.broadcast_to(slopes(topper.motion.phase), (len(phases), n))
    value, d = 0.0, np.zeros(n)
    heads = Heads(radius, shares * described.offset, phases)
    for edge, with_d in zip(edges, along, strict=True):
        value += float(coverage(edge, 2 * radius, heads.offset, phases, length=2 * half).uncut.mean())
        ends = exposed(edge, heads, half)
        moved = {"offset": offset_d, "phase": phase_d}
        d = d + uncut_slopes(edge, with_d, heads, ends, moved).sum(axis=1).mean(axis=0)
    return _share(value / len(edges), d / len(edges), disc, radius, radius_d)
