"""The outline of a plate with its joints and its centre, to scale."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from linkwright.kernel.figure.legends import legend_above
from linkwright.kernel.figure.style import BLUE, INK, PAPER, RED, panels, styled
from linkwright.outlines.plate import PlateProperties

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@styled
def outline_figure(plate: PlateProperties) -> Figure:
    """Draw the outline in the axes of the link [mm]."""
    figure, (axes,) = panels(1, height=3.4)
    for n, loop in enumerate(plate.section.region.loops):
        points = 1e3 * plate.section.in_link(np.vstack([loop.polygon, loop.polygon[:1]]))
        axes.fill(*points.T, facecolor=PAPER if n else "#eef2f5", edgecolor=INK, linewidth=1.2)
    ends = [0.0] if plate.distance is None else [0.0, 1e3 * plate.distance]
    axes.plot(ends, [0.0] * len(ends), "o-", color=BLUE, label="joints of the link", linewidth=0.8)
    axes.plot(1e3 * plate.along, 1e3 * plate.across, "P", color=RED, label="centre of mass", markersize=8)
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel("along the link [mm]")
    axes.set_ylabel("across the link [mm]")
    legend_above(axes)
    return figure
