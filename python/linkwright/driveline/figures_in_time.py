"""Torques of the shafts and speeds of the stations of an elastic driveline over time."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from linkwright.driveline.in_time import ElasticTransient
from linkwright.driveline.run_up import ElasticRunUp
from linkwright.kernel.figure.lines import Level, Line, Panel, line_figure
from linkwright.kernel.figure.style import LINES, CaptionedFigure, styled
from linkwright.kernel.reader.numbers import number, quantity

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@styled
def elastic_transient_figure(motion: ElasticTransient) -> Figure:
    """Draw the torque of every shaft with what is permitted, and the speeds referred to the crank."""
    permitted = {each.part: each.permitted for each in motion.judgements}
    panels = []
    for name, torque, colour in zip(motion.shafts, motion.torque, LINES, strict=False):
        lines: list[Line | Level] = [Line(torque, colour)]
        if name in permitted:
            lines.append(Level(permitted[name], f"permitted {quantity(permitted[name], 'N m')}"))
        panels.append(Panel(f"torque of\n{name} [N m]", lines))
    # Stations of one mass have one speed, referred to the crank.
    referred = motion.speed / motion.ratio[:, None]
    _, first = np.unique(np.round(referred, 9), axis=0, return_index=True)
    speeds = [
        Line(referred[n], LINES[place % len(LINES)], motion.stations[n])
        for place, n in enumerate(sorted(first))
    ]
    panels.append(Panel("speed referred to\nthe crank [rad/s]", speeds, room=None))
    return line_figure(motion.time, *panels, height=1.2 + 1.6 * len(panels), over="time t [s]")


def run_up_figures(run_up: ElasticRunUp) -> Iterator[CaptionedFigure]:
    """The figure with its caption."""
    worst = int(np.argmax(run_up.torque_factor))
    caption = (
        f"Steady motion of the elastic driveline, to within {100 * run_up.settled:.3g} %, is reached after "
        f"{quantity(run_up.time, 's')} and {number(run_up.turns)} revolutions. The peak torque of "
        f"{run_up.shafts[worst]} is {quantity(float(run_up.torque_peak[worst]), 'N m')}, "
        f"{number(float(run_up.torque_factor[worst]))} times that of steady motion."
    )
    figure = elastic_transient_figure(run_up.motion)
    yield CaptionedFigure("elastic_run_up", "Run-up of the elastic driveline", caption, figure)
