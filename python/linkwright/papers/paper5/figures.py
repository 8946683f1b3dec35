"""Figures to paper 5: its figure 3, the step from (4) to (5), and where its result holds."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.figure.legends import legend_above
from linkwright.kernel.figure.style import (
    BLUE,
    GREEN,
    INK,
    MATH,
    ORANGE,
    PURPLE,
    level,
    panels,
    styled,
)
from linkwright.papers.paper5.steps import factors
from linkwright.papers.published_lengths import WAYS, bands_of, lengths_over
from linkwright.topping.figures.lengths import COLOURS
from linkwright.topping.required_length import constant_speed_lengths, length_consistent, length_published
from linkwright.topping.roots import head_diameter

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    from linkwright.papers.paper5.paper import Paper5
    from linkwright.papers.paper5.steps import Surface

# Steps of the lines of equal length [mm].
_STEP = 20

# Where along the diagonal a label has room.
_ROOM = 0.08, 0.92

_MILLI = 1e3


def figures(paper: Paper5) -> dict[str, Figure]:
    """All figures of paper 5, under names for files."""
    return {
        "figure3": _figure3(paper),
        "step": _step(paper),
        "bands": _bands(paper),
        "heads": _heads(paper),
    }


@styled
def _figure3(paper: Paper5) -> Figure:
    count = len(paper.surfaces)
    figure, axes = panels(2, height=5.0, columns=count)
    for column, surface in enumerate(paper.surfaces):
        above, below = axes[column], axes[column + count]
        _contours(above, surface, surface.published, ORANGE, paper)
        _contours(below, surface, surface.exact, BLUE, paper)
        above.set_title(f"v = {surface.forward_speed:g} m/s")
        below.set_xlabel("root diameter D [mm]")
        for axis in (above, below):
            axis.tick_params(labelleft=column == 0)
            axis.set_xticks(_MILLI * surface.root_diameters[:: len(surface.root_diameters) // 3])
    for axis in (axes[0], axes[count]):
        axis.set_ylabel("knife speed $v_h$ [m/s]", **MATH)
    low, high = (_MILLI * length for length in paper.verdict.claim.lengths)
    lines = [_line(ORANGE, "L by (10) [mm]"), _line(BLUE, "L exact, constant speed [mm]")]
    handles = [*lines, _patch(GREEN, f"{low:.0f}…{high:.0f} mm")]
    figure.legend(handles=handles, loc="outside upper center", ncols=3)
    return figure


def _contours(axes: Axes, surface: Surface, lengths: Floats, colour: str, paper: Paper5) -> None:
    D, v_h, L = _MILLI * surface.root_diameters, surface.knife_speeds, _MILLI * lengths
    low, high = (_MILLI * length for length in paper.verdict.claim.lengths)
    if L.max() > low:
        axes.contourf(D, v_h, L, levels=[low, high], colors=[GREEN], alpha=0.25)
    levels = np.arange(_STEP * np.ceil(L.min() / _STEP), L.max(), _STEP)
    lines = axes.contour(D, v_h, L, levels=levels, colors=[colour], linewidths=1.3)
    # Along the diagonal all lengths rise, so that each line has its label there; corners have no room.
    along = np.linspace(*_ROOM, 200)
    rising = L[(along * (len(v_h) - 1)).round().astype(int), (along * (len(D) - 1)).round().astype(int)]
    shown = levels[(levels > rising[0]) & (levels < rising[-1])]
    places = np.interp(shown, rising, along)
    spots = [(D[0] + u * (D[-1] - D[0]), v_h[0] + u * (v_h[-1] - v_h[0])) for u in places.tolist()]
    axes.clabel(lines, shown, manual=spots, fontsize=7.5, colors=INK, fmt="%d")


@styled
def _step(paper: Paper5) -> Figure:
    figure, (left, right) = panels(1, height=3.0, columns=2)
    degrees = np.linspace(0.0, 60.0, 241)
    alpha = np.radians(degrees)
    left.plot(degrees, factors(alpha), color=PURPLE)
    level(left, 1.0, "(4) = (5)")
    left.set_ylabel(r"$S_x/\cos α$ over $d\,\cos α$", **MATH)
    left.set_ylim(0, 5.2)
    left.legend(loc="upper left")
    ratio, (share, _) = paper.verdict.claim.ratios[1], paper.verdict.shares
    right.plot(degrees, length_published(1.0, alpha, ratio), color=ORANGE, label="printed (10)")
    right.plot(degrees, length_consistent(1.0, alpha, ratio), color=PURPLE, label="from (4)")
    exact = constant_speed_lengths(1 - share, share / 2, alpha, 1.0, ratio).max(axis=0)
    right.plot(degrees, exact, color=BLUE, label="exact")
    right.set_ylim(0, 4)
    right.set_ylabel(f"L/(d + 2Δ) at $v_h/v$ = {ratio:g}", **MATH)
    legend_above(right)
    for axes in (left, right):
        axes.set_xlim(0, 60)
        axes.set_xlabel("angle of the edge α [°]")
    return figure


@styled
def _bands(paper: Paper5) -> Figure:
    """Bands of heads over the angle for which each way gives a length within the result."""
    figure, (axes,) = panels(1, height=3.9)
    verdict, degrees = paper.verdict, np.linspace(0.0, 62.0, 621)
    for way, words in WAYS.items():
        low, high = _MILLI * bands_of(
            verdict.claim, way, np.radians(degrees), verdict.shares[0], verdict.stroke
        )
        there = high > 0
        axes.fill_between(
            degrees[there], low[there], high[there], color=COLOURS[way], alpha=0.3, linewidth=0, label=words
        )
        for edge in (low, high):
            axes.plot(degrees[there], edge[there], color=COLOURS[way], linewidth=1.1)
    level(axes, _MILLI * verdict.chosen.band, "roots chosen here, the largest", INK)
    axes.set_xlim(0, 62)
    axes.set_ylim(0, 620)
    axes.set_xlabel("angle of the edge α [°]")
    axes.set_ylabel("band d + 2Δ [mm]")
    axes.legend(loc="upper right")
    return figure


@styled
def _heads(paper: Paper5) -> Figure:
    """Cut heights and offsets of the largest root for which each way gives a length within the result."""
    data, verdict = paper.published, paper.verdict
    angles = data["verdict"]["map_angles"]
    figure, axes = panels(1, height=3.4, columns=len(angles))
    ends = (data["verdict"][f"map_{name}"] for name in ("cut_heights", "offsets"))
    h_p, delta = (np.linspace(low, high, 121) for low, high in ends)
    d = head_diameter(data["chosen"]["root_diameters"][1], h_p)
    for axis, angle in zip(axes, angles, strict=True):
        for way, colour in COLOURS.items():
            L = lengths_over(verdict.claim, way, np.radians(angle), d, delta[:, None], verdict.stroke)[1]
            axis.contourf(
                _MILLI * h_p, _MILLI * delta, L, levels=verdict.claim.lengths, colors=[colour], alpha=0.3
            )
            axis.contour(
                _MILLI * h_p, _MILLI * delta, L, levels=verdict.claim.lengths, colors=[colour], linewidths=1.1
            )
        axis.plot(
            _MILLI * data["chosen"]["cut_height"], _MILLI * verdict.offset, "o", color=INK, markersize=4
        )
        axis.set_title(f"α = {angle:g}°")
        axis.set_xlabel("cut height $h_p$ [mm]", **MATH)
        axis.tick_params(labelleft=axis is axes[0])
    axes[0].set_ylabel("offset Δ [mm]")
    handles = [_patch(COLOURS[way], words) for way, words in WAYS.items()]
    dot = _line(INK, "chosen here", marker="o", markersize=4, linestyle="none")
    figure.legend(handles=[*handles, dot], loc="outside upper center", ncols=3)
    return figure


def _line(colour: str, words: str, **how: Any) -> Line2D:
    from matplotlib.lines import Line2D

    return Line2D([], [], color=colour, label=words, **how)


def _patch(colour: str, words: str) -> Patch:
    from matplotlib.patches import Patch

    return Patch(color=colour, alpha=0.35, linewidth=0, label=words)
