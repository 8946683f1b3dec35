"""Axes over the crank angle, counted from the dead centre that the reader wants.

Over a whole cycle the curves begin there; over a part of it they stay as they are and the angles move.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from linkwright.kernel.page.angle_zero import Zero, zero_shown

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

# Beginning of the labels of such axes; with the words of a zero behind it, they are counted from it already.
_LABEL = "crank angle"


def from_zero_of_reader(figure: Figure) -> None:
    """Count crank angles along the axes of a figure from the zero that is shown."""
    zero = zero_shown()
    if not zero.words:
        return
    for axes in figure.axes:
        group = [axes, *axes.get_shared_x_axes().get_siblings(axes)]
        labels = [one.get_xlabel() for one in group]
        label = next((text for text in labels if text.startswith(_LABEL)), "")
        if not label or zero.words in label:
            continue
        # Those that share the angles change together; the label comes last, since it tells what was done.
        for one in dict.fromkeys(group):
            _move(one, zero)
        for one, text in zip(group, labels, strict=True):
            if text.startswith(_LABEL):
                words, _, unit = text.rpartition(" [")
                one.set_xlabel(f"{words} from the {zero.words} [{unit}")


def _move(axes: Axes, zero: Zero) -> None:
    """The curves and the ends of one of the axes."""
    is_polar = axes.name == "polar"
    size = 1.0 if is_polar else 180 / np.pi
    low, high = axes.get_xlim()
    turns = 1 if is_polar else round((high - low) / 360)
    is_cycle = is_polar or (zero.cycle > 0 and turns > 0 and abs(high - low - 360 * turns) < _WHOLE)
    own = zero._replace(cycle=2 * np.pi * turns if is_cycle else 0.0)
    for line in axes.get_lines():
        if line.get_transform().contains_branch_seperately(axes.transData)[0]:
            _move_line(line, own, size)
    if is_polar:
        return
    if is_cycle:
        axes.set_xlim(0, 360 * turns)
        axes.set_xticks(range(0, 360 * turns + 1, 45 * turns))
    else:
        axes.set_xlim(low - size * zero.angle, high - size * zero.angle)


# How far the ends of axes are from whole revolutions at most [°].
_WHOLE = 1e-3


def _move_line(line: Line2D, zero: Zero, size: float) -> None:
    """A curve, dots, or a line across."""
    x, y = (np.asarray(values, float) for values in line.get_data(orig=True))
    if np.all(np.diff(x) >= 0) and zero.cycle_of(x / size):
        moved, curves = zero.rolled(x / size, {"": y})
        line.set_data(*_closed(size * moved, curves[""], size * zero.cycle))
    else:
        line.set_data([size * zero.counted(float(at) / size) for at in x], y)


def _closed(x: Any, y: Any, cycle: float) -> tuple[Any, Any]:
    """A curve over a cycle with its value at the zero, between two samples, at both ends."""
    if not 0 < x[0] < cycle or x[-1] < cycle:
        return x, y
    share = (cycle - x[-2]) / (x[-1] - x[-2])
    end = y[-2] + share * (y[-1] - y[-2])
    return np.concatenate([[0.0], x[:-1], [cycle]]), np.concatenate([[end], y[:-1], [end]])
