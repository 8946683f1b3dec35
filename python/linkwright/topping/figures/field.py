"""Figures of a topper over a field of roots: shares and losses, its knife varied, and the best knife."""

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
    RED,
    SOFT,
    panels,
    styled,
)
from linkwright.kernel.reader.numbers import quantity

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from linkwright.topping.best.best_knife import KnifeSearch
    from linkwright.topping.field import TopperField
    from linkwright.topping.sweep import FieldSweep

# Shares whose lengths are marked: more would not stand apart.
_MARKED = (0.5, 0.9, 0.95, 0.99)

_BINS = 60


@styled
def field_share_figure(field: TopperField) -> Figure:
    """Draw the share of heads cut through against the length of the edge."""
    figure, (axes,) = panels(1, height=3.8)
    length = 1e3 * field.length
    axes.fill_between(
        length, 100 * field.share_low, 100 * field.share_high, color=BLUE, alpha=0.25, linewidth=0
    )
    axes.plot(length, 100 * field.share, color=BLUE, label=f"share, {100 * field.level:.3g} % interval")
    _edge(axes, field.edge_length)
    for share, value in zip(field.quantile, field.quantile_length, strict=True):
        if share in _MARKED and np.isfinite(value):
            axes.plot(1e3 * value, 100 * share, "o", color=INK, markersize=3.5)
            text = f"{100 * share:.3g} %: {quantity(round(value, 3), 'm', usual='mm')}"
            place = (1e3 * value, 100 * share)
            axes.annotate(text, place, (6, -2), textcoords="offset points", va="top", fontsize=8)
    axes.set_xlim(_start(field), 1.06 * length[-1])
    axes.set_ylim(0, 103)
    axes.set_xlabel(AXES["edge_length"][0])
    axes.set_ylabel("heads cut through [%]")
    legend_above(axes)
    return figure


def _start(field: TopperField) -> float:
    """Where the share begins to rise, with room for the words beside the marks [mm]."""
    finite = field.length_needed[np.isfinite(field.length_needed)]
    least, span = float(finite.min(initial=field.length[-1])), float(field.length[-1])
    return 1e3 * max(0.0, least - 0.35 * (span - least) - 0.02 * span)


def _edge(axes: Axes, length: float) -> None:
    axes.axvline(1e3 * length, color=RED, linewidth=1.2, linestyle=(0, (5, 3)), label="edge")


@styled
def field_length_figure(field: TopperField) -> Figure:
    """Draw how the lengths that heads need are distributed."""
    figure, (axes,) = panels(1, height=3.0)
    finite = 1e3 * field.length_needed[np.isfinite(field.length_needed)]
    _histogram(axes, finite, field.n_roots)
    _edge(axes, field.edge_length)
    axes.set_xlabel("required length of a head [mm]")
    legend_above(axes)
    return figure


def _histogram(axes: Axes, values: Floats, total: int) -> None:
    spread = float(np.ptp(values)) if len(values) else 0.0
    if spread > 1e-9:
        axes.hist(values, bins=_BINS, weights=np.full(len(values), 100 / total), color=BLUE, alpha=0.8)
    elif len(values):
        size = float(values[0]) or 1.0
        axes.bar(values[:1], [100 * len(values) / total], width=0.06 * size, color=BLUE, alpha=0.8)
        axes.set_xlim(0, 2 * size)
    axes.set_ylabel("share of heads [%]")


@styled
def field_haulm_figure(field: TopperField, over: FieldSweep) -> Figure:
    """Draw the uncut share of the heads over the length, and what the roots lose."""
    figure, (left, lost) = panels(1, height=3.0, columns=2, shared=False)
    length = 1e3 * over.entries["edge_length"]
    left.fill_between(
        length, 100 * over.haulm_mean_low, 100 * over.haulm_mean_high, color=GREEN, alpha=0.25, linewidth=0
    )
    left.plot(length, 100 * over.haulm_mean, color=GREEN, label="haulm left")
    _edge(left, field.edge_length)
    left.set_ylim(bottom=0)
    left.set_xlabel(AXES["edge_length"][0])
    left.set_ylabel("uncut share of the head, mean [%]")
    legend_above(left)
    _histogram(lost, 1e6 * field.root_loss, field.n_roots)
    lost.axvline(1e6 * field.loss_mean, color=ORANGE, linewidth=1.4, label="mean")
    lost.set_xlabel("root above the cut [cm³]")
    legend_above(lost)
    return figure


# Label and factor to what is written at an axis.
AXES = {
    "edge_length": ("length of the edge L [mm]", 1e3),
    "edge_angle": ("angle of the edge α [°]", 180 / np.pi),
    "forward_speed": ("speed along the row v [m/s]", 1.0),
    "knife_speed": ("speed of the knife $v_h$ [m/s]", 1.0),
    "cut_height": ("mean height of the slice $h_p$ [mm]", 1e3),
}

# Numbers nearer to the rim of a map than this share of it are left out.
_RIM = 0.05


@styled
def sweep_figure(swept: FieldSweep) -> Figure:
    """Draw shares, haulm and lengths over one entry that varies."""
    (name,) = swept.entries
    label, factor = AXES[name]
    x = factor * swept.entries[name]
    rows = 1 if name == "edge_length" else 2
    figure, axes = panels(rows, height=2.5 * rows + 0.3, columns=2)
    _banded(axes[0], x, "share_complete", swept, (BLUE, "heads cut through [%]"))
    _banded(axes[1], x, "haulm_mean", swept, (GREEN, "uncut share of the head, mean [%]"))
    if rows > 1:
        axes[2].plot(x, 1e3 * _drawable(swept.length_for_95), color=PURPLE)
        axes[2].set_ylabel("length for 95 % of heads [mm]")
        _other(axes[3], x, swept, is_cut=name == "cut_height")
    for axis in axes[-2:]:
        axis.set_xlabel(label, **MATH)
    for panel in axes[1:]:
        panel.set_ylim(bottom=0)
    return figure


def _other(axes: Axes, x: Floats, swept: FieldSweep, *, is_cut: bool) -> None:
    values = 1e6 * swept.loss_mean if is_cut else swept.slicing_ratio_mean
    axes.plot(x, values, color=ORANGE if is_cut else RED)
    axes.set_ylabel("loss of a root [cm³]" if is_cut else "mean draw-cut ratio [–]")


def _banded(axes: Axes, x: Floats, key: str, swept: FieldSweep, look: tuple[str, str]) -> None:
    value, low, high = (100 * getattr(swept, f"{key}{end}") for end in ("", "_low", "_high"))
    axes.fill_between(x, low, high, color=look[0], alpha=0.25, linewidth=0)
    axes.plot(x, value, color=look[0])
    axes.set_ylabel(look[1])


def _drawable(values: Floats) -> Floats:
    """Gaps in place of what is infinite."""
    return np.where(np.isfinite(values), values, np.nan)


@styled
def sweep_map(swept: FieldSweep) -> Figure:
    """Draw the share of heads and the length for 95 % of them over two entries that vary."""
    figure, axes = panels(1, height=3.3, columns=2, shared=False)
    maps = (
        (100 * swept.share_complete, "heads cut through [%]"),
        (1e3 * swept.length_for_95, "length for 95 % of heads [mm]"),
    )
    for axis, (values, title) in zip(axes, maps, strict=True):
        first, second = (factor * np.unique(swept.entries[name]) for name, factor in _scales(swept))
        _map(axis, (first, second), _drawable(values).reshape(swept.shape), title)
        across, up = swept.entries
        axis.set_xlabel(AXES[across][0], **MATH)
        axis.set_ylabel(AXES[up][0], **MATH)
    return figure


def _scales(swept: FieldSweep) -> list[tuple[str, float]]:
    return [(name, AXES[name][1]) for name in swept.entries]


def _map(axes: Axes, at: tuple[Floats, Floats], values: Floats, title: str) -> None:
    axes.grid(False)
    axes.set_title(title, loc="left")
    finite = values[np.isfinite(values)]
    if len(finite) and np.ptp(finite) > 1e-9 * abs(finite).max():
        axes.contourf(*at, values.T, 12, cmap="Blues", alpha=0.75)
        lines = axes.contour(*at, values.T, 6, colors=INK, linewidths=0.7)
        for word in axes.clabel(lines, fontsize=7.5):
            _drop_at_rim(axes, word, at)
    else:
        text = f"{finite[0]:.4g} everywhere" if len(finite) else "none anywhere"
        axes.text(0.5, 0.5, text, transform=axes.transAxes, ha="center", color=SOFT)
        axes.set_xlim(at[0][0], at[0][-1])
        axes.set_ylim(at[1][0], at[1][-1])


def _drop_at_rim(axes: Axes, word: Any, at: tuple[Floats, Floats]) -> None:
    for place, ends in zip(word.get_position(), at, strict=True):
        if min(place - ends[0], ends[-1] - place) < _RIM * (ends[-1] - ends[0]):
            word.set_visible(False)


def sweep_figures(swept: FieldSweep) -> dict[str, Figure]:
    """Figures of a sweep by name: curves over one entry, maps over two."""
    if len(swept.shape) == 1 and swept.shape[0] > 1:
        return {"sweep": sweep_figure(swept)}
    return {"sweep": sweep_map(swept)} if len(swept.shape) == 2 and min(swept.shape) > 1 else {}


@styled
def best_knife_figure(search: KnifeSearch) -> Figure:
    """Draw the minimum length over angle and speed of the knife, with the limits and the best."""
    figure, (axes,) = panels(1, height=4.0)
    at = (np.degrees(search.map_angle), search.map_speed)
    share = 100 * search.limits.complete_min
    _map(axes, at, 1e3 * _drawable(search.map_length), f"minimum edge [mm] for {share:.4g} % of the heads")
    lines = [
        (search.map_slicing, search.limits.slicing_min, RED, "minimum draw-cut ratio"),
        (search.map_length, search.length_max, PURPLE, "maximum length"),
    ]
    for values, limit, colour, label in lines:
        finite = values[np.isfinite(values)]
        if limit is not None and len(finite) and finite.min() < limit < finite.max():
            axes.contour(*at, _drawable(values).T, [limit], colors=colour, linewidths=1.8)
            axes.plot([], [], color=colour, label=label)
    if search.best is not None:
        x, y = np.degrees(search.best.edge_angle), search.best.knife_speed
        axes.plot(x, y, "o", color=ORANGE, markeredgecolor=INK, markersize=8, clip_on=False, label="best")
    if axes.get_legend_handles_labels()[0]:
        axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=3, borderaxespad=0.2)
    axes.set_xlabel(AXES["edge_angle"][0], **MATH)
    axes.set_ylabel(AXES["knife_speed"][0], **MATH)
    return figure
