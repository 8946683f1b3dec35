"""Figures of rod strings: cards, torque of the gearbox, Goodman diagram, loads by depth."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.figure.legends import legend_above
from linkwright.kernel.figure.style import (
    BLUE,
    INK,
    LINES,
    MATH,
    RED,
    SOFT,
    CaptionedFigure,
    level,
    panels,
    styled,
    zero_line,
)
from linkwright.kernel.reader.numbers import number, quantity
from linkwright.machine.machine import Machine
from linkwright.pumping.figures import gear_torque_figure
from linkwright.pumping.gear_torque import GearTorque
from linkwright.rods.along import AlongRods, along_rods, cards
from linkwright.rods.diagnosis import CardDiagnosis
from linkwright.rods.model.rod_string import RodString
from linkwright.rods.prediction import RodStringMotion, string_of
from linkwright.rods.scalars import permissible
from linkwright.rods.scene import string_shown
from linkwright.rods.stress import RodStress

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Strung = RodStringMotion | CardDiagnosis

# Loads of the permissible load diagram that are drawn, over the range of the card beyond its ends.
_BEYOND = 0.6

# Load over the highest that is no compression, but the samples of a load that falls at once.
_ROUNDING = 1e-4

# Stresses are drawn in MPa.
_MEGA = 1e6


def string_figures(string: RodString, motion: RodStringMotion) -> Iterator[CaptionedFigure]:
    """The figures of a prediction."""
    caption = (
        f"The polished rod carries {quantity(motion.load_min, 'N')} to {quantity(motion.load_max, 'N')} over "
        f"{quantity(motion.stroke, 'm')}; the plunger moves {quantity(motion.plunger_stroke, 'm')}."
    )
    yield CaptionedFigure("rod_cards", "Surface and pump card", caption, cards_figure(string, motion))
    if motion.gear is not None:
        best = None if motion.gear is motion.gear_best else motion.gear_best
        caption = (
            "Torque at the crank by the polished rod and by its counterbalance; their sum peaks at "
            f"{quantity(max(motion.gear.torque_net_up, motion.gear.torque_net_down), 'N m')}."
        )
        drawn = gear_torque_figure(motion.gear, best)
        yield CaptionedFigure("rod_gear", "Torque of the gearbox under the rod string", caption, drawn)
    yield from _stresses(string, motion)


def diagnosis_figures(
    string: RodString, found: CardDiagnosis, motion: RodStringMotion | None
) -> Iterator[CaptionedFigure]:
    """The figures of a diagnosed card; `motion`: a prediction to compare with."""
    caption = (
        f"The pump card has a stroke of {quantity(found.plunger_stroke, 'm')}, a fluid load of "
        f"{quantity(found.fluid_load, 'N')} and a fillage of {number(100 * found.fillage)} %."
    )
    drawn = cards_figure(string, found, motion)
    yield CaptionedFigure("measured_cards", "Measured surface card and pump card", caption, drawn)
    yield from _stresses(string, found, "measured_", ", measured card")


def compared_figures(machine: Machine, found: CardDiagnosis) -> Iterator[CaptionedFigure]:
    """The figures of a diagnosed card, with the predicted one where the machine has a motion."""
    return diagnosis_figures(string_of(machine), found, string_shown(machine))


def _stresses(
    string: RodString, result: Strung, before: str = "", behind: str = ""
) -> Iterator[CaptionedFigure]:
    """Goodman diagram and loads by depth; `before`, `behind`: what makes name and title their own."""
    stress, along = result.stress, along_rods(string, result)
    if stress.loading_max is not None:
        caption = (
            "Minimum and maximum stress at the top of each section, below the permissible stress of its "
            f"grade; the largest range is {number(100 * stress.loading_max)} % of the permissible one."
        )
        drawn = goodman_figure(string, stress)
        yield CaptionedFigure(f"{before}goodman", f"Modified Goodman diagram{behind}", caption, drawn)
    low = float(along.load.min())
    low = low if abs(low) > _ROUNDING * along.load.max() else 0.0
    caption = (
        "Minimum and maximum of effective tension and stress along the rods; the tension falls to "
        f"{quantity(low, 'N')}."
    )
    title, drawn = f"Loads and stresses by depth{behind}", depth_figure(string, along, stress)
    yield CaptionedFigure(f"{before}rod_depth", title, caption, drawn)


@styled
def cards_figure(string: RodString, result: Strung, compared: RodStringMotion | None = None) -> Figure:
    """Draw the cards of the polished rod, the tapers and the pump; `compared`: a prediction beside them."""
    figure, (axes,) = panels(1, height=4.2)
    for card, colour in zip(cards(string, result), _colours(len(result.stations)), strict=True):
        _closed(axes, *card[1:], color=colour, label=card[0])
    if compared is not None:
        for n, card in enumerate((*cards(string, compared),)[:: len(compared.stations) - 1]):
            look: Any = {"color": SOFT, "linewidth": 1.1, "linestyle": (0, (5, 3))}
            _closed(axes, *card[1:], label="" if n else "predicted", **look)
    if isinstance(result, RodStringMotion) and result.gear is not None:
        _limits(axes, result, result.gear)
    axes.set_xlabel("position $u$ [m]", **MATH)
    axes.set_ylabel("load $F$ [N]", **MATH)
    zero_line(axes)
    legend_above(axes)
    return figure


def _colours(count: int) -> list[str]:
    return [RED, *[LINES[2 + n % 3] for n in range(count - 2)], BLUE]


def _closed(axes: Axes, position: Floats, load: Floats, **look: Any) -> None:
    axes.plot(np.append(position, position[0]), np.append(load, load[0]), **look)


def _limits(axes: Axes, motion: RodStringMotion, gear: GearTorque) -> None:
    """Limits of the load by gearbox and structure."""
    if gear.load_permissible is not None and motion.crank_angle is not None:
        span = _BEYOND * float(np.ptp(motion.rod_load))
        low, high = motion.rod_load.min() - span, motion.rod_load.max() + span
        order = np.argsort(motion.crank_angle)
        own = motion.crank_angle[order], motion.rod_position[order]
        place = np.interp(gear.crank_angle, *own, period=2 * np.pi)
        is_near = (gear.load_permissible > low) & (gear.load_permissible < high)
        limit = np.where(is_near, gear.load_permissible, np.nan)
        axes.plot(place, limit, color=INK, linewidth=1.1, label="gearbox rating", linestyle=(0, (2, 2)))
    if gear.load_rated is not None:
        level(axes, gear.load_rated, "structure rating")


@styled
def goodman_figure(string: RodString, stress: RodStress) -> Figure:
    """Draw minimum and maximum stress of the sections in the modified Goodman diagram."""
    figure, (axes,) = panels(1, height=3.6)
    low = min(0.0, float(stress.stress_min.min()))
    high = 1.2 * float(stress.stress_max.max())
    ends = np.array([low, high])
    axes.plot(ends / _MEGA, ends / _MEGA, color=SOFT, linewidth=0.8)
    for strength in np.unique(stress.tensile[np.isfinite(stress.tensile)]):
        label = f"permissible, T = {quantity(float(strength) / _MEGA, 'MPa')}"
        limit = permissible(string, strength, ends)
        axes.plot(ends / _MEGA, limit / _MEGA, color=INK, linewidth=1.1, label=label)
    for n, name in enumerate(stress.sections):
        at, top, colour = stress.stress_min[n] / _MEGA, stress.stress_max[n] / _MEGA, LINES[n % len(LINES)]
        axes.plot([at, at], [at, top], color=colour, linewidth=1.1)
        axes.plot(at, top, "o", color=colour, label=f"{n + 1}: {name}")
    axes.set_xlim(low / _MEGA, (float(stress.stress_min.max()) + 0.25 * (high - low)) / _MEGA)
    axes.set_xlabel("minimum stress $S_{min}$ [MPa]", **MATH)
    axes.set_ylabel("maximum stress $S_{max}$ [MPa]", **MATH)
    legend_above(axes)
    return figure


@styled
def depth_figure(string: RodString, along: AlongRods, stress: RodStress) -> Figure:
    """Draw the extremes of tension and stress over the depth, with the permissible stress."""
    figure, axes = panels(1, height=4.4, columns=2, shared=False)
    for one, values in zip(axes, (along.load, along.stress / _MEGA), strict=True):
        one.plot(values.max(axis=1), along.depth, color=RED, label="maximum")
        one.plot(values.min(axis=1), along.depth, color=BLUE, label="minimum")
        one.set_ylim(along.depth[-1], 0.0)
    limit = permissible(string, stress.tensile[along.section], along.stress.min(axis=1))
    if np.isfinite(limit).any():
        axes[1].plot(limit / _MEGA, along.depth, "--", color=INK, label="permissible")
    axes[0].set_ylabel("depth [m]")
    axes[0].set_xlabel("load $F$ [N]", **MATH)
    axes[1].set_xlabel("stress $S$ [MPa]", **MATH)
    for one in axes:
        one.locator_params(axis="x", nbins=5)
        legend_above(one)
    return figure
