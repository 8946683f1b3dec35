"""The α–β chart: accelerating factors of motors against the load factor of an axis."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from linkwright.axes.choice import ServoChoice
from linkwright.axes.feasibility import load_factor, ratio_ranges
from linkwright.kernel.figure.lines import Level, Line, Panel, line_figure
from linkwright.kernel.figure.style import GREEN, INK, SOFT, CaptionedFigure, log_height, log_width, styled
from linkwright.kernel.reader.numbers import number

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def ratio_chart(name: str, choice: ServoChoice) -> CaptionedFigure:
    """The chart with its words."""
    load = load_factor(choice.cycle)
    # Nothing of the gears' efficiency is known before one is chosen.
    words = (
        "Motors of the catalogue by continuous torque squared over inertia. Only above the load factor β = "
        f"{number(load.load_factor)} W/s can a motor bear the torque of the axis in continuous operation; "
        "losses of the gears raise it, and limits of speed and peak torque apply besides. Filled: a pair "
        "with a gearbox of the catalogue passes all checks."
    )
    return CaptionedFigure(f"ratios_{name}", f"Axis {name}: accelerating factors", words, _chart(choice))


@styled
def _chart(choice: ServoChoice) -> Figure:
    """Draw every motor as a point."""
    load = load_factor(choice.cycle)
    ranges = ratio_ranges(load, choice.motors, extra=choice.coupling)
    factor = np.array(
        [np.nan if one.accelerating_factor is None else one.accelerating_factor for one in ranges]
    )
    inertia = np.array([one.inertia for one in ranges])
    passes = choice.passes.any(axis=1)
    marks = {"linestyle": "none", "markersize": 4}
    lines = [
        Line(factor[group], colour, label, inertia[group], "o", marks | {"fillstyle": fill})
        for group, colour, label, fill in (
            (passes, GREEN, "passes with a gearbox", "full"),
            (~passes, SOFT, "refused", "none"),
        )
        if group.any()
    ]
    ends = np.array([inertia.min() / 1.5, inertia.max() * 1.5])
    panel = Panel(
        "accelerating factor α\n[W/s]", [*lines, Level(load.load_factor, "load factor β", INK)], room=None
    )
    figure = line_figure(ends, panel, height=3.4, over="inertia at the motor shaft [kg m²]")
    log_height(figure.axes[0])
    log_width(figure.axes[0])
    return figure
