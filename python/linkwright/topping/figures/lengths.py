"""Figures of required lengths over root, knife speed and phase, of slicing, and of the use of the edge."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from linkwright.kernel.arrays import Bools, Floats
from linkwright.kernel.figure.legends import legend_above
from linkwright.kernel.figure.style import (
    BLUE,
    GREEN,
    INK,
    LINES,
    MATH,
    ORANGE,
    PURPLE,
    RED,
    SKY,
    level,
    panels,
    roomy,
    styled,
    turn_axis,
)
from linkwright.kernel.reader.numbers import quantity
from linkwright.papers.published_lengths import WAYS
from linkwright.topping.topper import NOTHING

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from linkwright.topping.charts import LengthChart, Lines, VerdictChart
    from linkwright.topping.topper import TopperStudy

_MILLI = 1e3

# One way to a length, one colour, here and in the figures to paper 5.
COLOURS = {"published": ORANGE, "consistent": PURPLE, "constant_speed": BLUE, "every_phase": GREEN}

_TITLES = {"published": "printed (10)", "consistent": "from (4)", "constant_speed": "exact"}

# Lengths beyond so many times the longest of the others are not drawn.
_FAR = 2.2


@styled
def length_chart_figure(chart: LengthChart) -> Figure:
    """Draw lengths over root diameter and over knife speed: printed, consistent and exact side by side."""
    figure, axes = panels(2, height=5.4, columns=3, shared=False)
    top = _top(chart)
    rows = (
        (axes[:3], chart.over_roots, _MILLI, "root diameter D [mm]", chart.root_diameter),
        (axes[3:], chart.over_speeds, 1.0, "knife speed $v_h$ [m/s]", chart.knife_speed),
    )
    for row, lines, scale, words, own in rows:
        for axis, way in zip(row, _TITLES, strict=True):
            _way(axis, chart, lines, way, scale)
            axis.plot(scale * own, _MILLI * chart.edge_length, "o", color=INK, markersize=4.5)
            axis.set_xlabel(words, **MATH)
            axis.set_xlim(scale * lines.along[0], scale * lines.along[-1])
            axis.set_ylim(0, _MILLI * top)
            axis.tick_params(labelleft=axis is row[0])
        row[0].set_ylabel("L [mm]")
    for axis, words in zip(axes[:3], _TITLES.values(), strict=True):
        axis.set_title(words)
    handles, labels = axes[2].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper left", ncols=5, handlelength=1.6, columnspacing=1.4)
    return figure


def _way(axes: Axes, chart: LengthChart, lines: Lines, way: str, scale: float) -> None:
    for speed, values, colour in zip(chart.forward_speeds, getattr(lines, way), LINES, strict=False):
        # A line that leaves the panel indefinitely ends there.
        axes.plot(
            scale * lines.along, _MILLI * values, color=colour, label=f"v = {quantity(speed, 'm/s', 3)}"
        )
    if way == "constant_speed" and lines.moved.size:
        style: dict[str, Any] = {"color": PURPLE, "linestyle": (0, (4, 2))}
        axes.plot(scale * lines.moved_along, _MILLI * lines.moved, label="motion of this knife", **style)
    level(axes, _MILLI * chart.edge_length, "the edge", INK)


def _top(chart: LengthChart) -> float:
    """Upper end of the scale [m]."""
    own = [chart.edge_length]
    for lines in (chart.over_roots, chart.over_speeds):
        own += [float(values.max()) for values in (lines.published, lines.consistent)]
        own += [float(np.nanmax(lines.moved))] if np.isfinite(lines.moved).any() else []
    exact = np.concatenate([lines.constant_speed.ravel() for lines in (chart.over_roots, chart.over_speeds)])
    return 1.08 * max(*own, min(_FAR * max(own), float(exact.max())))


@styled
def verdict_figure(chart: VerdictChart) -> Figure:
    """Draw for which heads each way of computing gives lengths within the range that is claimed."""
    figure, (bands, heads) = panels(1, height=3.9, columns=2)
    _bands(bands, chart)
    _heads(heads, chart)
    figure.legend(*bands.get_legend_handles_labels(), loc="outside upper left", ncols=3, handlelength=1.8)
    return figure


def _bands(axes: Axes, chart: VerdictChart) -> None:
    degrees = np.degrees(chart.angles)
    for way, (low, high) in chart.bands.items():
        there = high > 0
        shade: dict[str, Any] = {"color": COLOURS[way], "alpha": 0.3, "linewidth": 0, "label": WAYS[way]}
        axes.fill_between(degrees[there], _MILLI * low[there], _MILLI * high[there], **shade)
        for edge in (low, high):
            axes.plot(degrees[there], _MILLI * edge[there], color=COLOURS[way], linewidth=1.1)
    own = np.degrees(chart.edge_angle), _MILLI * chart.band
    axes.plot(*own, "o", color=RED, markersize=7, label="this machine")
    axes.set_xlim(degrees[0], max(degrees[-1], 1.02 * own[0]))
    # Bands of the printed bound grow without limit near α = 0; the scale keeps to the machine and the rest.
    axes.set_ylim(0, max(400, 1.6 * own[1]))
    axes.set_xlabel("angle of the edge |α| [°]")
    axes.set_ylabel("band of the heads d + 2Δ [mm]")


def _heads(axes: Axes, chart: VerdictChart) -> None:
    x, y = _MILLI * chart.cut_heights, _MILLI * chart.offsets
    for way, longest in chart.longest.items():
        # Lengths without bounds lie beyond all levels.
        drawn = np.where(np.isfinite(longest), longest, 1e3)
        if drawn.max() > chart.lengths[0] and drawn.min() < chart.lengths[1]:
            levels = list(chart.lengths)
            axes.contourf(x, y, drawn, levels=levels, colors=[COLOURS[way]], alpha=0.3)
            axes.contour(x, y, drawn, levels=levels, colors=[COLOURS[way]], linewidths=1.1)
    axes.plot(_MILLI * chart.cut_height, _MILLI * chart.offset, "o", color=RED, markersize=7)
    axes.set_xlim(x[0], x[-1])
    axes.set_ylim(y[0], y[-1])
    axes.set_xlabel("cut height $h_p$ [mm]", **MATH)
    axes.set_ylabel("offset Δ [mm]")
    axes.set_title(f"at α = {np.degrees(chart.edge_angle):.4g}°")


_PHASE = "phase of the knife at the head [°]"

# Lengths beyond so many times those of heads and edge are not drawn.
_FAR_BEHIND = 1.8

# A draw-cut ratio beyond this says no more than that the edge hardly advances.
_RATIO = 10.0


@styled
def phase_figure(study: TopperStudy, edge_length: float, phase: float | None = None) -> Figure:
    """Draw the length that heads need over the phase of the knife; if the edge is short, what it leaves too.

    ``edge_length``: of the edge [m]; ``phase``: the only phase in which heads come [rad].
    """
    leaves = float(study.uncut_by_phase.max()) > NOTHING
    figure, axes = panels(2 if leaves else 1, height=5.2 if leaves else 3.4)
    degrees, needed = np.degrees(study.phase), _MILLI * study.length_by_phase
    axes[0].plot(degrees, needed, color=GREEN, label="required")
    lines = [
        (edge_length, "the edge", INK),
        (study.length_exact_constant_speed, "exact, constant speed", BLUE),
        (study.length_consistent, "from (4)", PURPLE),
        (study.length_published, "printed (10)", ORANGE),
    ]
    far = _FAR_BEHIND * max(edge_length, float(needed[np.isfinite(needed)].max(initial=0.0)) / _MILLI)
    shown = [line for line in lines if line[0] <= far]
    for value, words, colour in shown:
        level(axes[0], _MILLI * value, words, colour)
    finite = needed[np.isfinite(needed)]
    roomy(axes[0], np.append(finite, [_MILLI * value for value, _, _ in shown]))
    axes[0].set_ylabel("length of the edge L [mm]")
    axes[0].legend(loc="lower left", bbox_to_anchor=(0, 1.0), ncols=5, borderaxespad=0.2, handlelength=1.8)
    if leaves:
        _share(axes[1], degrees, 100 * study.uncut_by_phase)
    for axis in axes:
        _only(axis, phase)
        turn_axis(axis, label=False)
    axes[-1].set_xlabel(_PHASE)
    figure.align_ylabels()
    return figure


def _share(axes: Axes, degrees: Floats, share: Floats) -> None:
    axes.fill_between(degrees, 0, share, color=RED, alpha=0.2, linewidth=0)
    axes.plot(degrees, share, color=RED)
    axes.set_ylim(0, 1.1 * share.max())
    axes.set_ylabel("uncut share of the head [%]")


def _only(axes: Axes, phase: float | None) -> None:
    if phase is not None:
        axes.axvline(np.degrees(phase) % 360, color=INK, linewidth=1.1, linestyle=(0, (1, 2)))


@styled
def slicing_figure(phases: Floats, ratio: Floats, speed: Floats) -> Figure:
    """Draw the draw-cut ratio and the cutting speed over the phase.

    ``phases`` (n,): of the knife [rad]; ``ratio``, ``speed`` (n,): draw-cut ratio [–], NaN where the edge
    retreats, and speed against the head [m/s].
    """
    figure, axes = panels(2, height=4.0)
    degrees, drawn = np.degrees(phases), np.where(ratio < _RATIO, ratio, np.nan)
    for axis, values, colour, label in (
        (axes[0], drawn, BLUE, "draw-cut ratio [–]"),
        (axes[1], speed, GREEN, "cutting speed [m/s]"),
    ):
        axis.plot(degrees, values, color=colour)
        axis.set_ylabel(label)
        turn_axis(axis, label=False)
    retreats = np.isnan(ratio)
    if retreats.any():
        top = axes[0].get_xaxis_transform()
        axes[0].fill_between(
            degrees, 0, 1, where=retreats, transform=top, color=RED, alpha=0.15, linewidth=0, label="retreats"
        )
        legend_above(axes[0])
    if np.isfinite(drawn).any():
        axes[0].set_ylim(0, 1.1 * float(np.nanmax(drawn)) or 1.0)
    roomy(axes[1], speed)
    axes[1].set_xlabel("phase of the knife [°]")
    figure.align_ylabels()
    return figure


@styled
def edge_use_figure(place: Floats, use: Floats, edge_length: float, diameter: float) -> Figure:
    """Draw how much of a head each place of a long edge cuts.

    ``place`` (n,): from the middle of the edge to its left end [m]; ``use`` (n,): way through a head on
    average [m]; ``edge_length``, ``diameter``: L and d [m].
    """
    figure, (axes,) = panels(1, height=3.0)
    x, y, half = _MILLI * place, _MILLI * use, 0.5 * _MILLI * edge_length
    inside = np.abs(x) <= half
    _shade(axes, x, y, [inside], SKY, "cut by the edge")
    _shade(axes, x, y, [(x > half), (x < -half)], RED, "beyond its ends")
    axes.plot(x, y, color=BLUE)
    for end in (-half, half):
        axes.axvline(end, color=INK, linewidth=1.4)
    level(axes, _MILLI * diameter, "head diameter d")
    reach = 1.04 * max(half, float(x[-1]))
    axes.set_xlim(-reach, reach)
    axes.set_ylim(0, 1.12 * max(float(y.max()), _MILLI * diameter))
    axes.set_xlabel("position along the edge from its middle [mm], its left end on the right")
    axes.set_ylabel("mean path through a head\n[mm]")
    legend_above(axes)
    return figure


def _shade(axes: Axes, x: Floats, y: Floats, parts: Sequence[Bools], colour: str, words: str) -> None:
    for part in parts:
        if part.any() and y[part].any():
            label = None if words in axes.get_legend_handles_labels()[1] else words
            axes.fill_between(x, 0, y, where=part, color=colour, alpha=0.3, linewidth=0, label=label)
