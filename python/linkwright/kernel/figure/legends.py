"""Legends of a figure: they tell of curves that coincide, and are no wider than their axes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from linkwright.kernel.arrays import Floats

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.legend import Legend
    from matplotlib.lines import Line2D

# Label of a legend above its axes, and its columns at most.
ABOVE, COLUMNS = "above", 4

# Dashes of the upper one of two curves, between which the lower one is seen.
_DASHES = (0, (4.0, 4.0))

# Points of a curve at least: fewer are marks.
_POINTS = 3


# Of a legend above axes, in heights of its letters: a letter in the mean, and what stands beside a label.
_LETTER, _BESIDE = 0.6, 4.6


def legend_above(axes: Axes, gap: float = 0.2, columns: int = COLUMNS, **entries: Any) -> None:
    """A legend above the axes, where no line runs through it; `gap` in heights of its letters, `entries` of
    its own.
    """
    legend = axes.legend(
        loc="lower left",
        bbox_to_anchor=(0, 1.0),
        ncols=columns,
        borderaxespad=gap,
        handlelength=1.8,
        **entries,
    )
    legend.set_label(ABOVE)


def finish_legends(figure: Figure) -> None:
    """Name the curves that lie on others, and let each legend above axes have the columns that fit."""
    for axes in figure.axes:
        legend = axes.get_legend()
        if legend is not None:
            _tell_coinciding(axes, legend, figure)
            if legend.get_label() == ABOVE:
                _fit(axes, legend, figure)


def _tell_coinciding(axes: Axes, legend: Legend, figure: Figure) -> None:
    """Dash each curve that coincides with an earlier one, and say so in the legend."""
    for line, other in _coinciding(axes, figure):
        label = str(line.get_label())
        line.set_linestyle(_DASHES)
        for text in legend.get_texts():
            if text.get_text() == label:
                text.set_text(f"{label} (coincides with {other.get_label()})")


def _coinciding(axes: Axes, figure: Figure) -> Iterator[tuple[Line2D, Line2D]]:
    """Each curve with the first one that it coincides with, within the width of their lines."""
    alone: list[tuple[Line2D, Floats]] = []
    axes.get_ylim()  # which brings the limits up to the curves
    size = np.multiply(figure.get_size_inches(), 72) * axes.get_position().size
    for line in axes.get_lines():
        if str(line.get_label()).startswith("_") or line.get_linestyle() == "None":
            continue
        if line.get_transform() != axes.transData:
            continue
        points = size * axes.transAxes.inverted().transform(axes.transData.transform(line.get_xydata()))
        other = next((one for one, path in alone if _are_near(points, path, line.get_linewidth())), None)
        if other is None:
            alone.append((line, points))
        else:
            yield line, other


def _are_near(path: Floats, other: Floats, width: float) -> bool:
    """Whether two curves of as many points are nowhere farther apart than a line is wide."""
    if path.shape != other.shape or len(path) < _POINTS:
        return False
    known = np.isfinite(path).all(axis=1)
    if not known.any() or (known != np.isfinite(other).all(axis=1)).any():
        return False
    return bool(np.abs(path - other)[known].max() <= width)


def _fit(axes: Axes, legend: Legend, figure: Figure) -> None:
    labels = [text.get_text() for text in legend.get_texts()]
    size = max((float(text.get_fontsize()) for text in legend.get_texts()), default=1.0)
    room = 72 * float(figure.get_size_inches()[0]) * axes.get_position().width / size
    columns = next((n for n in range(COLUMNS, 1, -1) if _width(labels, n) <= room), 1)
    handles, _ = axes.get_legend_handles_labels()
    legend_above(axes, legend.borderaxespad, columns, handles=handles, labels=labels)


def _width(labels: Sequence[str], columns: int) -> float:
    """Width of a legend in heights of its letters; labels go down its columns, the first of them full."""
    full, more = divmod(len(labels), columns)
    ends = np.cumsum([full + (n < more) for n in range(columns)]).tolist()
    parts = (labels[start:end] for start, end in zip([0, *ends], ends, strict=False))
    return sum(_LETTER * max(map(len, part)) + _BESIDE for part in parts if part)
