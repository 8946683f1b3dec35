"""Lengths of the edge of a topper over root and knife speed, and for which heads published ones do."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.figure.style import (
    BLUE,
    GREEN,
    INK,
    LINES,
    MATH,
    ORANGE,
    PURPLE,
    RED,
    level,
    panels,
    styled,
)
from linkwright.topping.verdict import WAYS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from linkwright.topping.length_chart import LengthChart, Lines
    from linkwright.topping.verdict_chart import VerdictChart

Floats = NDArray[np.float64]

_MILLI = 1e3

# One way to a length, one colour, here and in the figures to paper 5.
COLOURS = {"published": ORANGE, "consistent": PURPLE, "constant_speed": BLUE, "every_phase": GREEN}

_TITLES = {"published": "printed (10)", "consistent": "from (4)", "constant_speed": "exact"}

# Lengths beyond so many times the longest of the others are not drawn.
_FAR = 2.2


@styled
def length_chart_figure(chart: LengthChart) -> Figure:
    """Draw lengths over root diameter and over knife speed: printed, consistent and exact side by side.

    Parameters
    ----------
    chart : LengthChart
        What to draw.

    Returns
    -------
    Figure
        Two rows of three panels with one scale; a line for each forward speed.
    """
    figure, axes = panels(2, height=5.4, columns=3, shared=False)
    top = _top(chart)
    rows = (
        (axes[:3], chart.over_roots, _MILLI, "root diameter D [mm]", chart.root_diameter),
        (axes[3:], chart.over_speeds, 1.0, "knife speed $v_h$ [m/s]", chart.knife_speed),
    )
    for row, lines, scale, words, own in rows:
        for each, way in zip(row, _TITLES, strict=True):
            _way(each, chart, lines, way, scale)
            each.plot(scale * own, _MILLI * chart.edge_length, "o", color=INK, markersize=4.5)
            each.set_xlabel(words, **MATH)
            each.set_xlim(scale * lines.along[0], scale * lines.along[-1])
            each.set_ylim(0, _MILLI * top)
            each.tick_params(labelleft=each is row[0])
        row[0].set_ylabel("L [mm]")
    for each, words in zip(axes[:3], _TITLES.values(), strict=True):
        each.set_title(words)
    handles, labels = axes[2].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper left", ncols=5, handlelength=1.6, columnspacing=1.4)
    return figure


def _way(axes: Axes, chart: LengthChart, lines: Lines, way: str, scale: float) -> None:
    """One panel."""
    for speed, values, colour in zip(chart.forward_speeds, getattr(lines, way), LINES, strict=False):
        # A line that leaves the panel indefinitely ends there.
        axes.plot(scale * lines.along, _MILLI * values, color=colour, label=f"v = {speed:.3g} m/s")
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
    """Draw for which heads each way of computing gives lengths within the range that is claimed.

    Parameters
    ----------
    chart : VerdictChart
        What to draw.

    Returns
    -------
    Figure
        Bands over the angle, and offsets over the cut height at the machine's angle; dots for the machine.
    """
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
