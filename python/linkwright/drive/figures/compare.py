"""Steady motion of several machines in one picture."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from linkwright.kernel.figure.style import LINES, legend_above, named, panels, styled, turn_axis, zero_line

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from linkwright.drive.steady_state import SteadyState

# Where the colours begin again, the lines look different.
_DASHES = ("-", "--", "-.", ":")


@styled
def compare_figure(motions: Mapping[str, SteadyState]) -> Figure:
    """Draw the speed over its mean, and the acceleration, of several machines.

    `motions`: name of the machine → its steady motion. Returns: two panels, one above the other; speeds as
    shares of each machine's mean over time.
    """
    figure, (speed, acceleration) = panels(2, height=4.6)
    for n, (name, steady) in enumerate(motions.items()):
        colour, dash = LINES[n % len(LINES)], _DASHES[n // len(LINES) % len(_DASHES)]
        degrees = np.degrees(steady.crank_angle)
        speed.plot(degrees, steady.speed / steady.speed_mean_time, dash, color=colour, label=named(name))
        acceleration.plot(degrees, steady.acceleration, dash, color=colour)
    speed.set_ylabel("speed over its mean\n[–]")
    acceleration.set_ylabel("acceleration ε\n[rad/s²]")
    zero_line(acceleration)
    legend_above(speed)
    turn_axis(speed, label=False)
    turn_axis(acceleration)
    return figure
