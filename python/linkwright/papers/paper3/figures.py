"""Figures to paper 3: the train and its modes, discs and what formulas make of them, vibration."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from linkwright.kernel.figure.legends import legend_above
from linkwright.kernel.figure.style import (
    BLUE,
    GREEN,
    INK,
    LINES,
    MATH,
    ORANGE,
    RED,
    SKY,
    SOFT,
    level,
    log_height,
    panels,
    styled,
    turn_axis,
    zero_line,
)
from linkwright.papers.paper3.crank_train import MODES
from linkwright.torsion.figures.scheme import scheme_figure
from linkwright.torsion.model.engine.engine_motion import reduced_throw
from linkwright.torsion.modes.scheme import scheme

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from linkwright.papers.paper3.paper import Paper3


def figures(paper: Paper3) -> dict[str, Figure]:
    """All figures to paper 3, under names for files."""
    return {
        "scheme": scheme_figure(scheme(paper.trial.machine)),
        "modes": _modes(paper),
        "disc": _disc(paper),
        "formulas": _formulas(paper),
        "amplitude": _amplitude(paper),
        "unevenness": _unevenness(paper),
        "cylinders": _cylinders(paper),
        "delta": _delta(paper),
        "weak": _weak(paper),
    }


def _shaft_axis(axes: Axes, discs: tuple[str, ...]) -> None:
    axes.set_xticks(range(len(discs)), [name.replace("_", " ") for name in discs])
    axes.set_xlim(-0.4, len(discs) - 0.5)


@styled
def _modes(paper: Paper3) -> Figure:
    free, discs = paper.trial.free, paper.uneven.discs
    places = [free.discs.index(name) for name in discs]
    figure, (axes,) = panels(1, height=2.9)
    for mode, colour in zip(MODES, LINES, strict=False):
        label = f"{free.natural_frequencies[mode]:.1f} Hz"
        axes.plot(free.mode_shapes[mode, places], "o-", color=colour, markersize=4, label=label)
    axes.set_ylabel("amplitude of the disc")
    zero_line(axes)
    _shaft_axis(axes, discs)
    legend_above(axes)
    return figure


@styled
def _disc(paper: Paper3) -> Figure:
    trial = paper.trial
    phi = np.linspace(0, 2 * np.pi, 721)
    figure, (axes,) = panels(1, height=2.9)
    exact = reduced_throw(trial.engine, phi).inertia_reduced
    axes.plot(np.degrees(phi), exact, color=BLUE, label="exact J(φ)")
    level(axes, trial.inertia, "its mean", INK)
    for shift, colour in zip(paper.inertia["shifts"][:2], (RED, GREEN), strict=True):
        axes.axhline(shift.value, color=colour, linewidth=1.2, label=shift.name)
    axes.set_ylim(0, None)
    axes.set_ylabel("inertia of a throw [kg m²]")
    turn_axis(axes)
    axes.legend(loc="lower left", ncols=2)
    return figure


@styled
def _formulas(paper: Paper3) -> Figure:
    trial, shifts = paper.trial, paper.shifts
    names = ["exact, (17) with k by Castigliano", *(shift.name for shift in shifts)]
    exact = trial.critical(float(trial.frequencies[1]))
    speeds = [speed * 30 / math.pi for speed in (exact, *(shift.critical for shift in shifts))]
    colours = [INK, *(BLUE if shift.what == "J" else ORANGE for shift in shifts)]
    figure, (axes,) = panels(1, height=3.6)
    rows = range(len(names))
    axes.hlines(rows, speeds[0], speeds, color=colours, linewidth=1.2)
    axes.scatter(speeds, rows, color=colours, s=22, zorder=3)
    axes.axvline(paper.uneven.speed * 30 / math.pi, color=RED, linewidth=1.2, label="speed of service")
    axes.axvline(speeds[0], color=SOFT, linewidth=0.8)
    axes.set_yticks(rows, names)
    axes.invert_yaxis()
    axes.set_xlabel(f"speed at which order {trial.order:g} meets the first mode of the crankshaft [rpm]")
    legend_above(axes)
    return figure


@styled
def _amplitude(paper: Paper3) -> Figure:
    uneven = paper.uneven
    figure, (axes,) = panels(1, height=2.9)
    axes.plot(np.degrees(uneven.swing), "o-", color=INK, markersize=4, label="all orders in phase")
    for order, swing, colour in zip(uneven.orders, uneven.by_order, LINES, strict=False):
        axes.plot(np.degrees(swing), "o-", color=colour, markersize=4, label=f"order {order:g}")
    axes.set_ylim(0, None)
    axes.set_ylabel("amplitude [°]")
    _shaft_axis(axes, uneven.discs)
    legend_above(axes)
    return figure


@styled
def _unevenness(paper: Paper3) -> Figure:
    uneven, x = paper.uneven, np.arange(len(paper.uneven.discs))
    figure, (axes,) = panels(1, height=3.1)
    least, most = uneven.weak.min(axis=0), uneven.weak.max(axis=0)
    axes.fill_between(x, least, most, color=SKY, alpha=0.4, label=f"δ, {_weakness(paper)}")
    for torsional, rigid, colour, name in (
        (uneven.delta, uneven.delta_rigid, BLUE, "δ"),
        (uneven.N, uneven.N_rigid, RED, "N"),
    ):
        axes.plot(x, torsional, "o-", color=colour, markersize=4, label=name)
        axes.plot(x, np.full(len(x), rigid), "--", color=colour, label=f"{name}, rigid")
    log_height(axes)
    axes.set_ylabel("unevenness")
    _shaft_axis(axes, uneven.discs)
    axes.legend(loc="lower left", ncols=2)
    return figure


def _weakness(paper: Paper3) -> str:
    return f"one cylinder at {100 * paper.published['chosen']['weak']:.0f} %"


def _cylinder_axis(axes: Axes, numbers: Sequence[str]) -> None:
    axes.set_xticks(range(len(numbers)), numbers)
    axes.set_xlabel("cylinder")


@styled
def _cylinders(paper: Paper3) -> Figure:
    uneven = paper.uneven
    along = uneven.sound
    figure, (axes,) = panels(1, height=2.9)
    for values, colour, mark, label in (
        (along.share_rigid[0], RED, "s--", "rigid, everywhere"),
        (along.share[uneven.places[0]], BLUE, "o-", "free end, with torsion"),
        (along.share[uneven.places[uneven.flywheel]], GREEN, "^-", "flywheel, with torsion"),
    ):
        axes.plot(values / values.mean(), mark, color=colour, markersize=5, linewidth=1.0, label=label)
    axes.set_ylim(0, None)
    axes.set_ylabel("$N_i/N$ of the sound engine", **MATH)
    _cylinder_axis(axes, along.cylinders)
    axes.set_xlabel("cylinder, in the order of firing")
    legend_above(axes)
    return figure


@styled
def _delta(paper: Paper3) -> Figure:
    uneven = paper.uneven
    figure, (axes,) = panels(1, height=2.9)
    for values, colour, mark, label in (
        (uneven.rise_rigid, RED, "s", "rigid, everywhere"),
        (uneven.rise[:, 0], BLUE, "o", "free end, with torsion"),
        (uneven.rise[:, uneven.flywheel], GREEN, "^", "flywheel, with torsion"),
    ):
        axes.plot(100 * (values - 1), mark, color=colour, markersize=5, label=label)
    axes.axhline(0, color=SOFT, linewidth=0.8)
    _cylinder_axis(axes, [str(n + 1) for n in range(len(uneven.weak))])
    axes.set_xlabel(f"the weak cylinder, {_weakness(paper).removeprefix('one cylinder ')}")
    axes.set_ylabel("change of δ [%]")
    legend_above(axes)
    return figure


@styled
def _weak(paper: Paper3) -> Figure:
    """Shares of the combustion that come out where one is weak; rigid ones against the sound engine."""
    weak = paper.weak
    figure, (axes,) = panels(1, height=2.9)
    for values, colour, mark, label in (
        (weak.elastic[0], INK, "o", "elastic"),
        (weak.against_sound[0], BLUE, "x", "rigid, free end"),
        (weak.against_sound[1], GREEN, "+", "rigid, flywheel"),
        (weak.against_sound[2], RED, "1", "rigid, behind the coupling"),
    ):
        axes.plot(values, mark, color=colour, markersize=6, label=label)
    axes.axhline(1, color=SOFT, linewidth=0.8)
    _cylinder_axis(axes, [str(n + 1) for n in range(len(weak.elastic[0]))])
    axes.set_ylabel("share of the combustion")
    legend_above(axes)
    return figure
