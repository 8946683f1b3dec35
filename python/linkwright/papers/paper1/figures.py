"""The figures of paper 1, computed anew: each drive's load and inertia, run-up and steady motion."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from linkwright.kernel.figure.style import (
    GREEN,
    LINES,
    MATH,
    ORANGE,
    SOFT,
    level,
    roomy,
    styled,
    turn_axis,
    zero_line,
)
from linkwright.papers.paper1.scheme import limit_curves

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from linkwright.papers.paper1.drive import Drive
    from linkwright.papers.paper1.paper import Paper1

SOLUTION, SCHEME, LIMIT = LINES[0], LINES[1], GREEN

# Limits of the paper's own figures of M_0 [N m] and I [kg m²]; ours reach as far as the drive needs.
_TORQUE_SHOWN, _INERTIA_SHOWN = 1400.0, 120.0


def figures(paper: Paper1) -> dict[str, Figure]:
    """Speed fluctuation of all drives, then figures 5 to 12 of the paper by machine, by names of files."""
    drawn = {drive.published.machine: _drive(drive) for drive in paper.drives}
    return {"evenness": _evenness(paper)} | drawn


@styled
def _drive(drive: Drive) -> Figure:
    """One drive: M_0 and I over the revolution, run-up, ω and ε over one revolution of steady motion."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.1, 8.4), layout="constrained")
    grid = figure.add_gridspec(3, 2)
    _reduced(figure.add_subplot(grid[0, 0]), figure.add_subplot(grid[0, 1]), drive)
    run_up = figure.add_subplot(grid[1, :])
    _run_up(run_up, drive)
    _steady(figure.add_subplot(grid[2, 0]), figure.add_subplot(grid[2, 1]), drive)
    handles, labels = run_up.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4)
    return figure


def _reduced(torque: Axes, inertia: Axes, drive: Drive) -> None:
    """Load torque and reduced inertia over the revolution, from zero as the paper draws them."""
    reduced = drive.reduced
    degrees = np.degrees(reduced.crank_angle)
    torque.plot(degrees, reduced.torque_load, color=ORANGE)
    level(torque, reduced.torque_load_mean, "mean")
    torque.set_title("load torque referred to the crank $M_0$ [N m]", loc="left", **MATH)
    torque.set_ylim(
        min(0.0, 1.1 * reduced.torque_load.min()), max(_TORQUE_SHOWN, 1.1 * reduced.torque_load_max)
    )
    zero_line(torque)
    inertia.plot(degrees, reduced.inertia_reduced, color=ORANGE)
    inertia.set_title("reduced inertia $I$ [kg m²]", loc="left", **MATH)
    inertia.set_ylim(0, max(_INERTIA_SHOWN, 1.1 * reduced.inertia_max))
    for axes in (torque, inertia):
        turn_axis(axes)


def _run_up(axes: Axes, drive: Drive) -> None:
    """Speed over the revolutions from rest: the solution of (1) and the published scheme."""
    row, up, scheme = drive.published.values, drive.up, drive.scheme
    turns = min(row["turns"] + 4, scheme.crank_angle[-1] / (2 * np.pi))
    for angle, speed, colour, name in (
        (scheme.crank_angle, scheme.speed, SCHEME, "published scheme"),
        (*_dense(drive), SOLUTION, "solution of (1)"),
    ):
        shown = angle <= 2 * np.pi * turns
        axes.plot(angle[shown] / (2 * np.pi), speed[shown], color=colour, linewidth=1.3, label=name)
    # Drawn in the panels below only; the legend is one for all.
    axes.plot([], [], color=LIMIT, linewidth=1.3, label="constant energy")
    axes.axvline(
        row["turns"],
        color=SOFT,
        linestyle=(0, (5, 3)),
        linewidth=1.1,
        label="published; mean torque",
    )
    axes.text(row["turns"], 0.3, " steady, as published", color=SOFT, fontsize=8.5)
    axes.set_title("run-up: speed of the crank ω [rad/s]", loc="left")
    axes.set_xlabel("revolutions from the start")
    axes.set_xlim(0, turns)
    axes.set_ylim(0, 1.1 * max(row["speed_max"], up.speed_peak))


def _dense(drive: Drive) -> tuple[np.ndarray, np.ndarray]:
    """The run-up at 200 points per revolution, followed by steady turns."""
    motion, steady = drive.up.motion, drive.steady
    time = np.linspace(0.0, motion.time[-1], int(200 * motion.turns))
    angle, speed = motion.at(time)
    end = int(angle[-1] // (2 * np.pi))
    kept = angle < 2 * np.pi * end
    repeats = np.arange(end, end + 20)[:, None] * 2 * np.pi
    more = (repeats + steady.crank_angle[:-1]).ravel()
    return np.append(angle[kept], more), np.append(speed[kept], np.tile(steady.speed[:-1], 20))


def _steady(speed: Axes, acceleration: Axes, drive: Drive) -> None:
    row, steady = drive.published.values, drive.steady
    n = round(2 * np.pi / drive.scheme.step)
    degrees = np.degrees(steady.crank_angle)
    by_step = np.arange(n) * 360 / n
    omega, epsilon = limit_curves(drive.reduced, row["speed_mean"])
    # The last revolution of the scheme: the speed at its angles, the acceleration of the steps that begin
    # there.
    last = slice(-n - 1, -1)
    for axes, exact, limit, scheme in (
        (speed, steady.speed, omega, drive.scheme.speed[last]),
        (acceleration, steady.acceleration, epsilon, drive.scheme.acceleration[last]),
    ):
        axes.plot(degrees, limit, color=LIMIT, linewidth=1.3)
        axes.plot(by_step, scheme, color=SCHEME, linewidth=1.3)
        axes.plot(degrees, exact, color=SOLUTION, linewidth=1.3)
        turn_axis(axes)
    for axes, name, title in (
        (speed, "speed", "steady motion: speed ω [rad/s]"),
        (acceleration, "acceleration", "steady motion: acceleration ε [rad/s²]"),
    ):
        ends = (row[f"{name}_min"], row[f"{name}_max"])
        for end in ends:
            level(axes, end, "published extremes")
        roomy(axes, *[np.asarray(line.get_ydata(), dtype=np.float64) for line in axes.lines])
        axes.set_title(title, loc="left")
    zero_line(acceleration)


@styled
def _evenness(paper: Paper1) -> Figure:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.1, 3.0), layout="constrained")
    axes = figure.add_subplot()
    places = np.arange(len(paper.drives))
    groups = {
        "published": (SOFT, [drive.published.values["motion_coefficient"] for drive in paper.drives]),
        "solution of (1)": (SOLUTION, _coefficients(paper, "solution")),
        "published scheme": (SCHEME, _coefficients(paper, "scheme")),
        "constant energy": (LIMIT, _coefficients(paper, "limit")),
    }
    for n, (name, (colour, values)) in enumerate(groups.items()):
        bars = axes.bar(places + 0.2 * (n - 1.5), values, 0.18, color=colour, label=name)
        axes.bar_label(bars, fmt="%.2f", fontsize=7.5, padding=1.5)
    axes.set_xticks(places, [_carts(drive.published.carts) for drive in paper.drives])
    axes.set_title(
        "combined non-uniformity index $k_p = δ^2 + H$; smaller is more uniform", loc="left", **MATH
    )
    axes.grid(visible=False, axis="x")
    axes.legend(ncols=2, loc="upper right")
    return figure


def _coefficients(paper: Paper1, way: str) -> list[float]:
    return [drive.values[way]["motion_coefficient"] for drive in paper.drives]


def _carts(count: int) -> str:
    return "one cart" if count == 1 else f"{('two', 'three', 'four')[count - 2]} carts"
