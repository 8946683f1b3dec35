"""Figures that are curves over one axis, in panels one above the other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.figure.legends import legend_above
from linkwright.kernel.figure.style import (
    MATH,
    SOFT,
    level,
    panels,
    roomy,
    turn_axis,
    zero_line,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


class Line(NamedTuple):
    """A curve, or marks."""

    y: Floats
    colour: str
    label: str = ""  # in the legend of its panel
    x: Floats | None = None  # its own places along x
    form: str = ""  # of lines and marks, as matplotlib writes it
    style: Mapping[str, Any] = {}


class Level(NamedTuple):
    """A dashed line at a height."""

    height: float
    label: str
    colour: str = SOFT


class Panel(NamedTuple):
    """Curves of one quantity."""

    label: str  # words along y; symbols between dollar signs are formulas
    lines: Sequence[Line | Level]
    # Heights that are in view too; None for matplotlib's own limits.
    room: Floats | Sequence[float] | None = ()


CRANK_ANGLE = "crank angle φ [°]"


def line_figure(x: Floats, *drawn: Panel, height: float, over: str = CRANK_ANGLE) -> Figure:
    """Draw panels over `x` (angles in degrees); `height` [inch]; `over`: the words along x."""
    figure, axes = panels(len(drawn), height=height)
    for one, panel in zip(axes, drawn, strict=True):
        _draw(one, x, panel)
        if over.endswith("[°]"):
            turn_axis(one, x, label=False)
    if not over.endswith("[°]") and x[-1] > x[0]:
        axes[-1].set_xlim(float(x[0]), float(x[-1]))
    axes[-1].set_xlabel(over, **(MATH if "$" in over else {}))
    return figure


def _draw(axes: Axes, x: Floats, panel: Panel) -> None:
    for line in panel.lines:
        if isinstance(line, Level):
            level(axes, *line)
        else:
            at = x if line.x is None else line.x
            form = (line.form,) if line.form else ()
            axes.plot(at, line.y, *form, color=line.colour, label=line.label or None, **line.style)
    axes.set_ylabel(panel.label, **(MATH if "$" in panel.label else {}))
    if panel.room is not None:
        curves = (line.y for line in panel.lines if isinstance(line, Line))
        roomy(axes, *curves, np.asarray(panel.room, float))
        zero_line(axes)
    if axes.get_legend_handles_labels()[1]:
        legend_above(axes)


def dashed(y: Floats, label: str, dashes: tuple[float, float] = (5, 3), **style: Any) -> Line:
    """A curve that is compared with."""
    return Line(y, SOFT, label, style={"linestyle": (0, dashes), **style})
