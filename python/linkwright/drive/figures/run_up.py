"""Speed from the start to steady motion, or to the stall."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from linkwright.kernel.figure.style import BLUE, INK, RED, SKY, SOFT, legend_above, panels, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from linkwright.drive.run_up import RunUp
    from linkwright.drive.steady_state import SteadyState
    from linkwright.drive.transient import Transient

# Points per revolution that show the solver's quintics as smooth lines.
_POINTS = 180

# Share of the motion after settling that is drawn: enough to see that it repeats.
_AFTER = 1.0


@styled
def run_up_figure(run_up: RunUp, steady: SteadyState | None = None) -> Figure:
    """Draw the speed during run-up over time and over turns.

    `steady`: steady motion, whose band of speeds is shaded.
    """
    figure, axes = panels(1, height=3.0, columns=2, shared=False)
    time, turns, speed = _fine(run_up.motion, run_up.turns + _AFTER)
    for panel, x in zip(axes, (time, turns), strict=True):
        panel.plot(x, speed, color=BLUE, label="speed")
        _band(panel, steady)
        panel.set_xlim(0, float(x[-1]))
    settled = f"settled to {100 * run_up.settled:.2g} %"
    for panel, at in zip(axes, (run_up.time, run_up.turns), strict=True):
        panel.axvline(at, color=INK, linewidth=1.1, linestyle=":", label=settled)
    _words(axes)
    _legend(figure, axes[0])
    return figure


@styled
def attempt_figure(motion: Transient) -> Figure:
    """Draw the speed of a run-up that fails, over time and over turns.

    `motion`: the motion from the start to the stall.
    """
    figure, axes = panels(1, height=3.0, columns=2, shared=False)
    time, turns, speed = _fine(motion, motion.turns)
    for panel, x in zip(axes, (time, turns), strict=True):
        panel.plot(x, speed, color=BLUE, label="speed")
        panel.plot(x[-1:], speed[-1:], "X", color=RED, markersize=8, label="end of the motion")
    _words(axes)
    legend_above(axes[0])
    return figure


def _fine(motion: Transient, turns: float) -> tuple[NDArray[np.float64], ...]:
    """Time, turns and speed at even times, through the solver's own interpolant."""
    travelled = (motion.crank_angle - motion.crank_angle[0]) / (2 * np.pi)
    end = float(np.interp(turns, travelled, motion.time))
    n = int(np.clip(_POINTS * turns, 200, 4000))
    time = np.linspace(float(motion.time[0]), end, n)
    angle, speed = motion.at(time)
    return time, (angle - motion.crank_angle[0]) / (2 * np.pi), speed


def _band(axes: Axes, steady: SteadyState | None) -> None:
    if steady is not None:
        label = "band of steady motion"
        axes.axhspan(steady.speed_min, steady.speed_max, color=SKY, alpha=0.3, linewidth=0, label=label)


def _words(axes: list[Axes]) -> None:
    for panel, word in zip(axes, ("time t [s]", "revolutions of the crank [–]"), strict=True):
        panel.set_xlabel(word)
        panel.set_ylim(bottom=0)
        panel.spines["left"].set_color(SOFT)
    axes[0].set_ylabel("speed ω [rad/s]")


def _legend(figure: Figure, axes: Axes) -> None:
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=3, handlelength=1.8)
