"""A topper over a field of roots: share of heads and what is left against the length, what roots lose."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.figure.style import BLUE, GREEN, INK, ORANGE, RED, legend_above, panels, styled
from linkwright.topping.figures.sweep import AXES

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from linkwright.topping.field import TopperField
    from linkwright.topping.sweep import FieldSweep

Floats = NDArray[np.float64]

# Shares whose lengths are marked: more would not stand apart.
_MARKED = (0.5, 0.9, 0.95, 0.99)

_BINS = 60


@styled
def field_share_figure(found: TopperField) -> Figure:
    """Draw the share of heads that are cut right through against the length of the edge.

    Parameters
    ----------
    found : TopperField
        What to draw.

    Returns
    -------
    Figure
        The share with its interval, the edge, and the lengths for some shares.
    """
    figure, (axes,) = panels(1, height=3.8)
    length = 1e3 * found.length
    axes.fill_between(
        length, 100 * found.share_low, 100 * found.share_high, color=BLUE, alpha=0.25, linewidth=0
    )
    axes.plot(length, 100 * found.share, color=BLUE, label=f"share, {100 * found.level:.3g} % interval")
    _edge(axes, found.edge_length)
    for share, value in zip(found.quantile, found.quantile_length, strict=True):
        if share in _MARKED and np.isfinite(value):
            axes.plot(1e3 * value, 100 * share, "o", color=INK, markersize=3.5)
            text = f"{100 * share:.3g} %: {1e3 * value:.0f} mm"
            place = (1e3 * value, 100 * share)
            axes.annotate(text, place, (6, -2), textcoords="offset points", va="top", fontsize=8)
    axes.set_xlim(_start(found), 1.06 * length[-1])
    axes.set_ylim(0, 103)
    axes.set_xlabel(AXES["edge_length"][0])
    axes.set_ylabel("heads cut right through [%]")
    legend_above(axes)
    return figure


def _start(found: TopperField) -> float:
    """Where the share begins to rise, with room for the words beside the marks [mm]."""
    finite = found.length_needed[np.isfinite(found.length_needed)]
    least, span = float(finite.min(initial=found.length[-1])), float(found.length[-1])
    return 1e3 * max(0.0, least - 0.35 * (span - least) - 0.02 * span)


def _edge(axes: Axes, length: float) -> None:
    """The edge of the file."""
    axes.axvline(1e3 * length, color=RED, linewidth=1.2, linestyle=(0, (5, 3)), label="edge")


@styled
def field_length_figure(found: TopperField) -> Figure:
    """Draw how the lengths that heads need are distributed.

    Parameters
    ----------
    found : TopperField
        What to draw.

    Returns
    -------
    Figure
        A histogram of those that can be cut.
    """
    figure, (axes,) = panels(1, height=3.0)
    finite = 1e3 * found.length_needed[np.isfinite(found.length_needed)]
    _histogram(axes, finite, found.n_roots)
    _edge(axes, found.edge_length)
    axes.set_xlabel("length that a head needs [mm]")
    legend_above(axes)
    return figure


def _histogram(axes: Axes, values: Floats, total: int) -> None:
    """Shares of all heads; of equal values one bar."""
    spread = float(np.ptp(values)) if len(values) else 0.0
    if spread > 1e-9:
        axes.hist(values, bins=_BINS, weights=np.full(len(values), 100 / total), color=BLUE, alpha=0.8)
    elif len(values):
        size = float(values[0]) or 1.0
        axes.bar(values[:1], [100 * len(values) / total], width=0.06 * size, color=BLUE, alpha=0.8)
        axes.set_xlim(0, 2 * size)
    axes.set_ylabel("share of heads [%]")


@styled
def field_haulm_figure(found: TopperField, over: FieldSweep) -> Figure:
    """Draw what is left of the heads against the length, and what the roots lose.

    Parameters
    ----------
    found : TopperField
        The field.
    over : FieldSweep
        The same over the length of the edge.

    Returns
    -------
    Figure
        Two panels.
    """
    figure, (left, lost) = panels(1, height=3.0, columns=2, shared=False)
    length = 1e3 * over.entries["edge_length"]
    left.fill_between(
        length, 100 * over.haulm_mean_low, 100 * over.haulm_mean_high, color=GREEN, alpha=0.25, linewidth=0
    )
    left.plot(length, 100 * over.haulm_mean, color=GREEN, label="haulm left")
    _edge(left, found.edge_length)
    left.set_ylim(bottom=0)
    left.set_xlabel(AXES["edge_length"][0])
    left.set_ylabel("left of the head, mean [%]")
    legend_above(left)
    _histogram(lost, 1e6 * found.root_loss, found.n_roots)
    lost.axvline(1e6 * found.loss_mean, color=ORANGE, linewidth=1.4, label="mean")
    lost.set_xlabel("root above the cut [cm³]")
    legend_above(lost)
    return figure
