"""Clutches, brakes and freewheels over time: slip, friction torque, and when they stick."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from linkwright.kernel.arrays import Floats, Integers
from linkwright.kernel.figure.legends import legend_above
from linkwright.kernel.figure.style import INK, LINES, SOFT, panels, styled, zero_line
from linkwright.kernel.reader.numbers import quantity

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from linkwright.torsion.in_time.transient import TorsionTransient

_RPM = 30 / np.pi

# Number of a state in which an element sticks or is locked.
_STUCK = 1

# Darkness of the bands in which it does.
_SHADE = 0.18


@styled
def friction_figure(motion: TorsionTransient) -> Figure:
    """Draw the slip of all elements, and the torque of each with bands where it sticks."""
    count = len(motion.frictions)
    figure, axes = panels(1 + count, height=1.9 + 1.35 * count)
    colours = [LINES[n % len(LINES)] for n in range(count)]
    for name, slip, colour in zip(motion.frictions, motion.slip, colours, strict=True):
        axes[0].plot(motion.time, _RPM * slip, color=colour, linewidth=1.1, label=name)
    axes[0].set_ylabel("slip [rpm]")
    zero_line(axes[0])
    legend_above(axes[0])
    for n, (panel, colour) in enumerate(zip(axes[1:], colours, strict=True)):
        panel.plot(motion.time, motion.friction_torque[n], color=colour, linewidth=1.1)
        for start, end in stuck_spans(motion.time, motion.friction_state[n]):
            panel.axvspan(start, end, color=SOFT, alpha=_SHADE, linewidth=0)
        panel.set_ylabel(f"{motion.frictions[n]}\n[N m]")
        numbers = ((motion.friction_torque_max, "N m"), (motion.friction_heat, "J"))
        peak = ", ".join(quantity(float(of[n]), unit) for of, unit in numbers)
        panel.annotate(
            peak,
            (1, 1),
            xycoords="axes fraction",
            xytext=(0, 2),
            textcoords="offset points",
            ha="right",
            fontsize=8,
            color=INK,
        )
        zero_line(panel)
    axes[-1].set_xlim(float(motion.time[0]), float(motion.time[-1]))
    axes[-1].set_xlabel("time t [s]")
    return figure


def stuck_spans(time: Floats, state: Integers) -> list[tuple[float, float]]:
    """Spans of samples in which an element sticks [s]."""
    stuck = np.concatenate([[False], state == _STUCK, [False]])
    starts = np.flatnonzero(stuck[1:] & ~stuck[:-1])
    ends = np.minimum(np.flatnonzero(stuck[:-1] & ~stuck[1:]), len(time) - 1)
    return list(zip(time[starts].tolist(), time[ends].tolist(), strict=True))
