"""Figures 3 to 6 of paper 4, computed anew: angle and transfer function of the lever in both regimes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from linkwright.kernel.figure.style import BLUE, MATH, ORANGE, RED, SOFT, panels, styled, turn_axis, zero_line

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from linkwright.kernel.arrays import Floats
    from linkwright.papers.paper4.paper import Paper4


def figures(paper: Paper4) -> dict[str, Figure]:
    """All figures of paper 4, under names for files."""
    return {
        "figure3": _angle(paper, continuous=True),
        "figure4": _rate(paper, continuous=True),
        "figure5": _angle(paper, continuous=False),
        "figure6": _rate(paper, continuous=False),
    }


@styled
def _angle(paper: Paper4, *, continuous: bool) -> Figure:
    motion = paper.continuous if continuous else paper.intermittent
    figure, (axes,) = panels(1, height=2.9)
    degrees = np.degrees(motion.crank_angle)
    label = (
        "turning, lengths of (3) to (7)"
        if continuous
        else f"lengths for a swing of {np.degrees(motion.lever_swing):.0f}°"
    )
    axes.plot(degrees, np.degrees(motion.lever_angle), color=BLUE, label=label)
    if continuous:
        start = np.degrees(motion.lever_angle[0])
        axes.plot(
            [0, 360],
            [start, start + 360],
            color=SOFT,
            linestyle=(0, (5, 3)),
            linewidth=1.1,
            label="straight line",
        )
    else:
        axes.plot(
            degrees, np.degrees(_printed(paper)[0]), color=ORANGE, label="printed lengths, where they close"
        )
    axes.set_ylabel("lever $φ_5$ [°]", **MATH)
    axes.legend(loc="best")
    turn_axis(axes)
    return figure


@styled
def _rate(paper: Paper4, *, continuous: bool) -> Figure:
    motion = paper.continuous if continuous else paper.intermittent
    figure, (axes,) = panels(1, height=2.9)
    degrees = np.degrees(motion.crank_angle)
    axes.plot(degrees, motion.lever_transfer, color=RED)
    if continuous:
        at = np.degrees(motion.change_points)
        axes.plot(at, np.interp(at, degrees, motion.lever_transfer), "o", color=SOFT, label="change points")
        axes.set_ylim(0, 1.1 * motion.transfer_max)
        axes.legend(loc="best")
    else:
        axes.plot(degrees, _shown(_printed(paper)[1], motion.lever_transfer), color=ORANGE)
        zero_line(axes)
    axes.set_ylabel("$dφ_5/dφ_1$", **MATH)
    turn_axis(axes)
    return figure


def _printed(paper: Paper4) -> tuple[Floats, Floats]:
    """φ_5 and its derivative with the printed lengths; the crank of the paper stands at 90° at 12 o'clock."""
    angle, rate = paper.printed_intermittent.rocking(paper.intermittent.crank_angle + np.pi / 2, -1.0)
    turns = np.round((paper.intermittent.lever_angle.mean() - np.nanmean(angle)) / (2 * np.pi))
    return angle + 2 * np.pi * turns, rate


def _shown(rate: Floats, beside: Floats) -> Floats:
    """The rate as far as it fits beside another: it grows beyond bounds where the lengths cease to close."""
    limit = 3 * np.abs(beside).max()
    return np.where(np.abs(rate) > limit, np.nan, rate)
