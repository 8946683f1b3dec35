"""The figures of toppers with their captions."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from linkwright.kernel.figure.style import CaptionedFigure
from linkwright.kernel.reader.numbers import degrees, number
from linkwright.machine.machine import Machine
from linkwright.papers.published_lengths import PAPER, WAYS, length_verdict
from linkwright.topping.charts import length_chart, verdict_chart
from linkwright.topping.edge import Edge, edges_of
from linkwright.topping.figures.lengths import (
    edge_use_figure,
    length_chart_figure,
    phase_figure,
    slicing_figure,
    verdict_figure,
)
from linkwright.topping.figures.view import top_view_figure
from linkwright.topping.head_pass import head_pass, worse_edge
from linkwright.topping.model.topper import Topper
from linkwright.topping.slicing import slicing_over_phase
from linkwright.topping.tables.topper import mm, percent, shown_head, stroke_of
from linkwright.topping.topper import TopperStudy, leaves

# Phases of a curve.
_PHASES = 361


@dataclass(frozen=True)
class _Cut:
    """A machine with its topper and what that cuts."""

    machine: Machine
    described: Topper
    study: TopperStudy

    @cached_property
    def edges(self) -> list[Edge]:
        return edges_of(self.machine, self.described)

    @property
    def leaves(self) -> bool:
        return leaves(self.study)

    @property
    def head(self) -> tuple[float, float]:
        return shown_head(self.study)


def topper_figures(machine: Machine, described: Topper, study: TopperStudy) -> Iterator[CaptionedFigure]:
    """The figures of the knife over heads."""
    cut = _Cut(machine, described, study)
    moves = cut.edges[0].knife.rate > 0
    if not cut.study.obstacle:
        yield _view(cut)
        yield from [_phases(cut)] if moves else []
    yield _chart(cut)
    yield _verdict(cut)
    # An edge that moves along itself has no use, and what cannot be followed none that is known.
    if math.isfinite(cut.study.length_exact) and not cut.study.obstacle:
        yield _use(cut)
    yield from [_slicing(cut)] if moves else []


def _view(cut: _Cut) -> CaptionedFigure:
    offset, phase = cut.head
    study, length = cut.study, cut.described.edge_length
    head = (study.head_diameter, offset, phase, length)
    seen = head_pass(worse_edge(cut.edges, *head), *head)
    figure = top_view_figure(seen, cut.described.offset, None if cut.leaves else (study.last_x, study.last_y))
    moves = f" in the phase {degrees(phase)}" if cut.edges[0].knife.rate else ""
    where = f"{_place(offset)}{moves}"
    if cut.leaves:
        words = f"The head with the maximum uncut share, {where}: {percent(study.uncut_share)}, hatched."
    else:
        words = (
            f"The head that requires the longest edge, {where}: {mm(study.length_exact)}. The edge of "
            f"{mm(length)} cuts it completely."
        )
    words += " Five positions of the edge, later ones darker; the machine travels to the right."
    return CaptionedFigure("topper_view", "The edge over the worst head, from above", words, figure)


def _place(offset: float) -> str:
    if offset == 0:
        return "on the row"
    return f"{mm(abs(offset))} to the {'left' if offset > 0 else 'right'} of the row"


def _phases(cut: _Cut) -> CaptionedFigure:
    study, length = cut.study, cut.described.edge_length
    if cut.described.motion.phase is None:
        words = (
            f"At the worst offset heads require {mm(study.length_best_phase)} to {mm(study.length_exact)}, "
            "depending on the phase."
        )
    else:
        words = f"Heads meet the knife only in the phase {degrees(cut.described.motion.phase)}, dotted."
    if cut.leaves:
        words += f" An edge of {mm(length)} leaves up to {percent(study.uncut_share)} of a head."
    figure = phase_figure(study, length, cut.described.motion.phase)
    return CaptionedFigure("topper_phase", "Required length over the phase of the knife", words, figure)


def _chart(cut: _Cut) -> CaptionedFigure:
    chart = length_chart(cut.described, cut.edges)
    slow, own, fast = (number(speed, 3) for speed in chart.forward_speeds)
    words = (
        f"The chart of paper 5 (its figure 3) for α = {degrees(cut.described.edge_angle)}, cut height "
        f"{mm(cut.described.cut_height)} and Δ = {mm(cut.described.offset)}, at v = {slow}, {own} and {fast} "
        f"m/s. Above: over the root diameter at the mean speed of this knife, {number(chart.knife_speed, 3)} "
        "m/s; below: over the knife speed at the root diameter of this machine. Solid: constant speed over "
        "the head"
    )
    words += "; dashed: true motion." if chart.over_roots.moved.size else "."
    words += " Dot: this machine."
    return CaptionedFigure(
        "topper_lengths", "Lengths printed, consistent and exact", words, length_chart_figure(chart)
    )


def _verdict(cut: _Cut) -> CaptionedFigure:
    described, stroke = cut.described, stroke_of(cut.study)
    chart = verdict_chart(described, stroke)
    low, high = PAPER.lengths
    (slow, fast), (least, most) = PAPER.forward_speeds, PAPER.knife_speeds
    judged = length_verdict(PAPER, described.edge_angle, cut.study.head_diameter, described.offset, stroke)
    ways = [WAYS[demand.way] for demand in judged.demands if demand.holds]
    words = (
        f"Paper 5 gives {low:.2f} to {high:.2f} m for v from {slow:g} to {fast:g} m/s and knife speeds from "
        f"{least:g} to {most:g} m/s, and does not state edge angle, cut height and offset. Shaded, for each "
        "method: their values for which the maximum length over these speeds lies in that range; on the "
        "left with the share of the offset in the band of this machine, on the right with its root diameter. "
        f"For its heads (dot), the range holds {'by the ' + ', the '.join(ways) if ways else 'by no method'}."
    )
    title = f"Where the published {low:.2f} to {high:.2f} m hold"
    return CaptionedFigure("topper_verdict", title, words, verdict_figure(chart))


def _use(cut: _Cut) -> CaptionedFigure:
    study, length = cut.study, cut.described.edge_length
    place, use = study.edge_place, study.edge_use
    total = float(np.trapezoid(use, place))
    inside = np.abs(place) <= 0.5 * length
    share = float(np.trapezoid(np.where(inside, use, 0.0), place)) / total if total else 0.0
    middle = float(np.interp(0.0, place, use))
    heads = "offsets and phases" if cut.edges[0].knife.rate else "offsets"
    words = (
        f"Path of each point of a sufficiently long edge through a head, mean over {heads}: a measure of "
        f"wear. The path of the middle of the edge is {mm(middle)}."
    )
    if share < 1 - 1e-4:
        words += f" About {percent(1 - share)} of the cut lies beyond the ends of this edge."
    figure = edge_use_figure(place, use, length, study.head_diameter)
    return CaptionedFigure("topper_use", "Use of the edge along its length", words, figure)


def _slicing(cut: _Cut) -> CaptionedFigure:
    phases = np.linspace(0.0, 2 * math.pi, _PHASES)
    ratio, speed = slicing_over_phase(cut.edges[0], phases)
    study = cut.study
    words = (
        "Draw-cut ratio: speed along the edge over speed normal to it; mean over the cut area "
        f"{number(study.slicing_ratio_mean, 3)}."
    )
    if study.edge_retreats:
        words += " Where it retreats, its back meets the head."
    return CaptionedFigure(
        "topper_slicing", "Slicing over the phase", words, slicing_figure(phases, ratio, speed)
    )
