"""Speed and acceleration of a motion in time, with their extremes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from linkwright.drive.motion_events import course, sides
from linkwright.kernel.figure.style import ACCELERATION, INK, SPEED, panels, roomy, styled, zero_line
from linkwright.kernel.page.out_units import OutUnits

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from linkwright.drive.motion_events import MotionExtreme
    from linkwright.drive.transient import Transient

# Points that show polynomials as smooth lines.
_POINTS = 2000


@styled
def in_time_figure(motion: Transient, extremes: Sequence[MotionExtreme], units: OutUnits) -> Figure:
    """Draw speed and acceleration of the crank over time.

    `extremes`: marked by dots; `units`: those of the axes.
    """
    figure, axes = panels(2, height=5.0)
    time, _, speed, acceleration = course(motion, _POINTS)
    time, acceleration = _with_jumps(motion, time, acceleration)
    speed = motion.at(time)[1]
    for panel, name, symbol, values, si, colour in (
        (axes[0], "speed", "ω", speed, "rad/s", SPEED),
        (axes[1], "acceleration", "ε", acceleration, "rad/s²", ACCELERATION),
    ):
        unit, factor = units.shown(si)
        panel.plot(time, values / factor, color=colour)
        for each in extremes:
            if each.quantity == name:
                panel.plot(each.time, each.value / factor, "o", color=INK, markersize=4, clip_on=False)
        panel.set_ylabel(f"{name} {symbol} [{unit}]")
        roomy(panel, values / factor)
        zero_line(panel)
    axes[-1].set_xlabel("time t [s]")
    if len(time) > 1:
        axes[-1].set_xlim(float(time[0]), float(time[-1]))
    return figure


def _with_jumps(
    motion: Transient, time: np.ndarray, acceleration: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Time and acceleration with both sides of every step's end, so that jumps are upright."""
    before, after = sides(motion)
    if not len(before):
        return time, acceleration
    inner = motion.time[1:-1]
    times = np.concatenate([time, inner, inner])
    values = np.concatenate([acceleration, before[:-1], after[1:]])
    order = np.argsort(times, kind="stable")
    return times[order], values[order]
