"""Figures 1 and 3 of paper 2, computed anew, and what they do not show."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.figure.legends import legend_above
from linkwright.kernel.figure.style import (
    BLUE,
    GREEN,
    GRID,
    INK,
    MATH,
    ORANGE,
    PURPLE,
    RED,
    SOFT,
    level,
    panels,
    roomy,
    styled,
    turn_axis,
    zero_line,
)
from linkwright.papers.paper2.formulas import breadth_of, fraction

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from linkwright.papers.paper2.alternatives import Alternative
    from linkwright.papers.paper2.paper import Paper2

LINES_OF_MOTION = ("x [m]", "ẋ [m/s]", "ẍ [m/s²]", "jerk [m/s³]")

# Drives that the figure of alternatives shows, by their short names.
_SHOWN = {
    "as printed": BLUE,
    "crank": SOFT,
    "free at the reversal": GREEN,
    "continuous jerk": ORANGE,
    "polynomial 4-5-6-7": PURPLE,
}


def figures(paper: Paper2) -> dict[str, Figure]:
    """All figures of paper 2, under names for files."""
    return {
        "figure1": _motion(paper),
        "figure3": _cam(paper),
        "shape": _shape(paper),
        "start": _start(paper),
        "alternatives": _alternatives(paper),
        "course": _course(paper),
    }


@styled
def _motion(paper: Paper2) -> Figure:
    """x, ẋ, ẍ and jerk over both strokes: the law of the machine, and points by (1) to (3)."""
    formulas, law = paper.formulas, paper.profile.cam.lift
    omega = np.pi / formulas.time
    figure, every = panels(4, height=7.2)
    points = (np.arange(48) + 0.5) / 48 * formulas.time
    for order, axes in enumerate(every):
        for low, high in zip(law.breaks, law.breaks[1:], strict=False):
            phi = np.linspace(low, high, 101)
            values = law.at(phi, order) * omega**order
            values[-1] = law.at(high, order, "before") * omega**order
            axes.plot(phi / omega, values, color=BLUE, label="law of the machine" if not low else None)
        there = formulas.stroke_motion(points, order)
        back = (formulas.stroke if order == 0 else 0.0) - there
        axes.plot(
            np.concatenate((points, formulas.time + points)),
            np.concatenate((there, back)),
            ".",
            color=RED,
            markersize=3.5,
            label="(1) to (3), as printed",
        )
        _steady_sections(axes, paper)
        axes.set_ylabel(LINES_OF_MOTION[order])
        axes.set_xlim(0, 2 * formulas.time)
        zero_line(axes)
    every[-1].set_xlabel("time [s]")
    legend_above(every[0])
    return figure


def _steady_sections(axes: Axes, paper: Paper2) -> None:
    formulas = paper.formulas
    begin = formulas.times["start"]
    end = begin + formulas.times["steady"]
    for stroke in (0.0, formulas.time):
        axes.axvspan(stroke + begin, stroke + end, color=GRID, alpha=0.45, linewidth=0)


@styled
def _cam(paper: Paper2) -> Figure:
    """The profile at mid-stroke with its base circle and the two followers on the cart."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(5.6, 5.6), layout="constrained")
    axes = figure.add_subplot()
    profile, b = paper.profile, breadth_of(paper.profile)
    turned = np.pi / 3
    lift = float(profile.cam.lift.at(turned))
    cos, sin = np.cos(turned), np.sin(turned)
    x, y = profile.flanks[0].profile.T
    x, y = cos * x - sin * y, sin * x + cos * y
    axes.fill(x, y, color=BLUE, alpha=0.08)
    axes.plot(x, y, color=BLUE, label="profile")
    hollow = profile.curvature_radius < 0
    axes.plot(np.where(hollow, x, np.nan), np.where(hollow, y, np.nan), color=RED, label="hollow")
    low = float(y.min())
    angle = np.linspace(0, 2 * np.pi, 361)
    base = profile.base_radius
    axes.plot(
        base * np.cos(angle),
        base * np.sin(angle),
        color=SOFT,
        linestyle=(0, (5, 3)),
        linewidth=1.1,
        label="base circle",
    )
    axes.plot(0, 0, "+", color=INK, markersize=9)
    right = base + lift
    for place, side in ((right, 1), (right - b, -1)):
        axes.fill(place + side * np.array([0, 0.07, 0.07]), [0, 0.028, -0.028], color=INK)
    for place in (right, right - b):
        axes.plot([place, place], [0.0, low - 0.12], color=SOFT, linewidth=0.7)
    arrow = {"arrowstyle": "<->", "color": SOFT}
    axes.annotate("", (right - b, low - 0.1), (right, low - 0.1), arrowprops=arrow)
    axes.text(right - 0.5 * b, low - 0.09, f"b = {b:g} m, chosen", ha="center", va="bottom")
    axes.annotate(
        "",
        (0.14 * np.cos(2.2), 0.14 * np.sin(2.2)),
        (0.14 * np.cos(0.7), 0.14 * np.sin(0.7)),
        arrowprops={"arrowstyle": "->", "color": INK, "connectionstyle": "arc3,rad=0.35"},
    )
    axes.text(0, 0.18, f"φ = {np.degrees(turned):.0f}°", ha="center", va="bottom")
    axes.set_aspect("equal")
    axes.set_xlim(right - b - 0.12, right + 0.12)
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    axes.legend(loc="upper left")
    return figure


@styled
def _shape(paper: Paper2) -> Figure:
    profile = paper.profile
    figure, (steep, bent) = panels(2, height=4.6)
    degrees = np.degrees(profile.angle)
    steep.plot(degrees, np.degrees(profile.pressure_angle), color=BLUE)
    limit = float(np.degrees(profile.cam.limit))
    level(steep, limit, f"usual limit, {limit:.0f}°")
    level(steep, -limit, "")
    steep.lines[-1].set_label("_")
    steep.set_ylabel("pressure angle γ [°]")
    steep.set_ylim(-36, 36)
    bend = profile.flanks[0].shape.rows["bend"]
    bent.plot(degrees, bend, color=BLUE)
    hollow = profile.curvature_radius_concave_min
    assert hollow is not None
    level(bent, -1 / hollow, f"largest roller in the hollow, {1e3 * hollow:.0f} mm", RED)
    bent.set_ylabel("curvature [1/m]")
    roomy(bent, bend)
    zero_line(bent)
    turn_axis(steep, label=False)
    turn_axis(bent)
    bent.set_xlabel("cam angle φ [°]")
    for axes in (steep, bent):
        zero_line(axes)
        legend_above(axes)
    return figure


@styled
def _start(paper: Paper2) -> Figure:
    figure, every = panels(1, height=2.9, columns=3, shared=False)
    u = np.linspace(0, 1, 201)
    for start, colour, name in (
        (paper.starts["printed"], BLUE, "(1), as printed"),
        (paper.starts["free_travel"], ORANGE, "travel free"),
        (paper.starts["free_acceleration"], GREEN, "travel and ẍ at rest free"),
    ):
        for order, axes in enumerate(every, start=1):
            label = f"{name}: ∫ jerk² = {start.cost:.3g}"
            axes.plot(u, start.law.at(u, order), color=colour, label=label)
    for axes, title in zip(every, ("ẋ over $v$", "ẍ over $v/t_p$", "jerk over $v/t_p^2$"), strict=True):
        axes.set_title(title, loc="left", **MATH)
        axes.set_xlim(0, 1)
        axes.set_xlabel("$u = t/t_p$", **MATH)
        zero_line(axes)
    handles, labels = every[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=3)
    return figure


@styled
def _alternatives(paper: Paper2) -> Figure:
    figure, every = panels(3, height=6.6)
    for alternative in paper.alternatives:
        if alternative.short not in _SHOWN:
            continue
        phi, curves = _outwards(alternative)
        for axes, values in zip(every, curves, strict=True):
            width = 2.2 if alternative.short == "as printed" else 1.5
            axes.plot(phi, values, color=_SHOWN[alternative.short], label=alternative.short, linewidth=width)
    for axes, title in zip(
        every,
        (
            "velocity at the design speed [m/s]",
            "acceleration at the design speed [m/s²]",
            "torque of the cart on the shaft in steady motion [N m]",
        ),
        strict=True,
    ):
        axes.set_title(title, loc="left", **MATH)
        axes.set_xlim(0, 180)
        axes.set_xticks(range(0, 181, 30))
        zero_line(axes)
    every[-1].set_xlabel("crank angle from the start of a stroke [°]")
    handles, labels = every[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=len(labels))
    return figure


def _outwards(drive: Alternative) -> tuple[Floats, tuple[Floats, ...]]:
    ahead = drive.velocity > 0
    begin = int(np.flatnonzero(ahead & ~np.roll(ahead, 1))[0])
    order = np.roll(np.arange(len(ahead)), -begin)
    order = order[ahead[order]]
    phi = np.degrees((drive.crank_angle[order] - drive.crank_angle[begin]) % (2 * np.pi))
    return phi, tuple(curve[order] for curve in (drive.velocity, drive.acceleration, drive.torque))


@styled
def _course(paper: Paper2) -> Figure:
    """Speed of the shaft, velocity of the cart, and its deviation, over one revolution."""
    course = paper.course
    figure, (shaft, cart, off) = panels(3, height=6.0)
    shaft.plot(course.time, course.speed, color=BLUE, label="in steady motion")
    level(shaft, course.speed_mean, "mean over time")
    shaft.axhline(course.speed_design, color=RED, linestyle=":", linewidth=1.2, label="as designed")
    shaft.set_ylabel("shaft ω [rad/s]")
    cart.plot(
        course.time, course.intended, color=SOFT, linestyle=(0, (5, 3)), linewidth=1.3, label="intended"
    )
    cart.plot(course.time, course.velocity, color=BLUE, label="in steady motion")
    cart.set_ylabel("cart ẋ [m/s]")
    off.plot(course.time, 100 * course.deviation, color=RED)
    off.set_ylabel("deviation [% of v]")
    off.set_xlabel("time [s]")
    half = course.time[-1] / 2
    begin, end = (fraction(paper.published["given"][name]) for name in ("start", "stop"))
    for axes in (shaft, cart, off):
        axes.set_xlim(0, course.time[-1])
        for stroke in (0.0, half):
            axes.axvspan(
                stroke + begin * half, stroke + (1 - end) * half, color=GRID, alpha=0.45, linewidth=0
            )
        zero_line(axes)
    for axes in (shaft, cart):
        legend_above(axes)
    return figure
