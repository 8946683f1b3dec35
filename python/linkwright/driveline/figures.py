"""Torques of the shafts and speeds of the stations of an elastic driveline over the crank angle."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from linkwright.driveline.elastic_motion import ElasticMotion
from linkwright.kernel.figure.lines import Level, Line, Panel, line_figure
from linkwright.kernel.figure.style import LINES, CaptionedFigure, styled
from linkwright.kernel.reader.numbers import number, quantity

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@styled
def elastic_figure(motion: ElasticMotion) -> Figure:
    """Draw the torque of every shaft with its mean, and the speeds of the stations, referred to the crank."""
    shafts = zip(motion.shafts, motion.torque, motion.torque_mean, LINES, strict=False)
    panels = [
        Panel(
            f"torque of\n{name} [N m]", [Line(torque, colour), Level(mean, f"mean {quantity(mean, 'N m')}")]
        )
        for name, torque, mean, colour in shafts
    ]
    # Stations of one mass have one speed, referred to the crank.
    referred = motion.speed / motion.ratio[:, None]
    _, first = np.unique(np.round(referred, 9), axis=0, return_index=True)
    speeds = [
        Line(referred[n], LINES[place % len(LINES)], motion.stations[n])
        for place, n in enumerate(sorted(first))
    ]
    panels.append(Panel("speed referred to\nthe crank [rad/s]", speeds, room=None))
    return line_figure(np.degrees(motion.crank_angle), *panels, height=1.2 + 1.6 * len(panels))


def elastic_figures(motion: ElasticMotion) -> Iterator[CaptionedFigure]:
    """The figure with its caption."""
    worst = int(np.argmax(motion.torque_ratio))
    caption = (
        f"Torques of the flexible shafts and speeds of the stations in steady motion. The peak torque of "
        f"{motion.shafts[worst]} is {quantity(float(motion.torque_peak[worst]), 'N m')}, "
        f"{number(float(motion.torque_ratio[worst]))} times its mean."
    )
    yield CaptionedFigure("elastic_motion", "Elastic driveline", caption, elastic_figure(motion))
