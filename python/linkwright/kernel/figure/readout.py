"""What the cursor reads in a figure of a page: where its axes are, their scales, and their curves."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

# Points of a curve that a page reads, and steps across the axes in which they are told.
_POINTS, _STEPS = 241, 10_000


def readout(figure: Figure) -> list[dict[str, Any]]:
    """Axes of a figure that was drawn, ready for JSON.

    Parameters
    ----------
    figure : Figure
        After it was written as SVG, so that the places of its axes are known.

    Returns
    -------
    list of dict
        Of each axes with straight scales ``box``, left, top, right and bottom as shares of the figure; ``x``
        and ``y``, the values at its ends, and whether the scale is logarithmic; ``over``, the words along x;
        ``curves``, label, colour, and x and y of each curve in ten-thousandths of the axes.
    """
    width, height = figure.get_size_inches()
    return [_read(axes, float(width), float(height)) for axes in figure.axes if axes.name == "rectilinear"]


def _read(axes: Axes, width: float, height: float) -> dict[str, Any]:
    box = axes.get_position()
    below = axes.get_shared_x_axes().get_siblings(axes)
    over = next((label for each in (axes, *below) if (label := each.get_xlabel())), "")
    return {
        "box": [round(v, 5) for v in (box.x0, 1 - box.y1, box.x1, 1 - box.y0)],
        "x": [*map(float, axes.get_xlim()), axes.get_xscale() == "log"],
        "y": [*map(float, axes.get_ylim()), axes.get_yscale() == "log"],
        "over": over,
        "curves": list(_curves(axes)),
    }


def _curves(axes: Axes) -> Iterator[dict[str, Any]]:
    """Those over a rising x: the others are read by the coordinates alone."""
    for line in axes.get_lines():
        points = _points(axes, line)
        if points is None:
            continue
        label = str(line.get_label())
        words = label.strip() if not label.startswith("_") else axes.get_ylabel().replace("\n", " ")
        yield {"label": words, "colour": str(line.get_color()), "points": points}


def _points(axes: Axes, line: Line2D) -> list[list[int]] | None:
    """Places of a curve in the axes; None of a mark, a level, or a curve that turns back."""
    xy = np.asarray(line.get_xydata(), float)
    if len(xy) < 3 or line.get_transform() != axes.transData or not np.all(np.diff(xy[:, 0]) >= 0):
        return None
    xy = xy[np.isfinite(xy).all(axis=1)]
    chosen = np.unique(np.linspace(0, len(xy) - 1, min(len(xy), _POINTS)).round().astype(int))
    shares = axes.transAxes.inverted().transform(axes.transData.transform(xy[chosen]))
    # What a logarithm of zero leaves is outside.
    return [np.round(_STEPS * np.clip(shares[:, k], -9, 9)).astype(int).tolist() for k in (0, 1)]
