"""Curves of a figure that coincide: both are seen, and the legend tells it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from linkwright.kernel.arrays import Floats

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

# Dashes of the upper one of two curves, between which the lower one is seen.
_DASHES = (0, (4.0, 4.0))


def tell_coinciding(figure: Figure) -> None:
    """Dash each curve that lies on an earlier one of its axes, and name that in the legend."""
    for axes in figure.axes:
        legend = axes.get_legend()
        if legend is None:
            continue
        for line, other in _coinciding(axes, figure):
            label = str(line.get_label())
            line.set_linestyle(_DASHES)
            for text in legend.get_texts():
                if text.get_text() == label:
                    text.set_text(f"{label} (coincides with {other.get_label()})")


def _coinciding(axes: Axes, figure: Figure) -> Iterator[tuple[Line2D, Line2D]]:
    """Each curve with the first one that it coincides with, within the width of their lines."""
    alone: list[tuple[Line2D, Floats]] = []
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


# Points of a curve at least: fewer are marks.
_POINTS = 3
