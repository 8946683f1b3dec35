"""Figures of pumping units and rod rotators over one revolution, with their captions."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from linkwright.kernel.figure.lines import Level, Line, Panel, dashed, line_figure
from linkwright.kernel.figure.style import BLUE, GREEN, PURPLE, RED, CaptionedFigure, styled
from linkwright.kernel.reader.numbers import degrees, number, quantity
from linkwright.pumping.rod_rotator import RodRotatorMotion
from linkwright.pumping.unit import PumpingUnitMotion

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from linkwright.pumping.gear_torque import GearTorque
    from linkwright.pumping.rod_rotator import RodRotatorMotion
    from linkwright.pumping.unit import PumpingUnitMotion


@styled
def polished_rod_figure(unit: PumpingUnitMotion) -> Figure:
    """Draw the rise of the polished rod and its torque factor; with a speed, velocity and acceleration."""
    curves = [
        Panel("rise $s$\n[m]", [Line(unit.rod_travel, GREEN)]),
        Panel("torque factor\n$dS/dθ$ [m]", [Line(unit.torque_factor, PURPLE)]),
    ]
    if unit.rod_velocity is not None and unit.rod_acceleration is not None:
        curves.append(Panel("velocity $v$\n[m/s]", [Line(unit.rod_velocity, BLUE)]))
        curves.append(Panel("acceleration $a$\n[m/s²]", [Line(unit.rod_acceleration, RED)]))
    return line_figure(np.degrees(unit.crank_angle), *curves, height=1.6 * len(curves) + 0.6)


@styled
def gear_torque_figure(gear: GearTorque, best: GearTorque | None = None) -> Figure:
    """Draw the load of the polished rod, and the torques at the crank; `best`: with the best
    counterbalance.
    """
    load = Line(gear.rod_load, RED)
    torques: list[Line | Level] = [
        Line(gear.torque_rod, RED, "polished rod"),
        Line(gear.torque_counterbalance, GREEN, "counterbalance"),
        Line(gear.torque_net, BLUE, "gearbox"),
        *([dashed(best.torque_net, "best counterbalance")] if best is not None else []),
        *([Level(gear.torque_rated, "rating")] if best is not None and gear.torque_rated else []),
    ]
    both = Panel("polished-rod load\n$W$ [N]", [load]), Panel("torque at the crank\n[N m]", torques)
    return line_figure(np.degrees(gear.crank_angle), *both, height=4.4)


@styled
def rotator_figure(rotator: RodRotatorMotion) -> Figure:
    """Draw the lever's angle and its first and second transfer functions, with the change points."""
    phi, at = np.degrees(rotator.crank_angle), np.degrees(rotator.change_points)
    drawn = []
    for values, label, colour in (
        (np.degrees(rotator.lever_angle), "lever $φ_5$ [°]", BLUE),
        (rotator.lever_transfer, "$φ_5′$", RED),
        (rotator.lever_transfer_d1, "$φ_5″$", PURPLE),
    ):
        marks = Line(np.interp(at, phi, values), colour, x=at, form="o", style={"markersize": 4})
        drawn.append(Panel(label, [Line(values, colour), marks]))
    return line_figure(phi, *drawn, height=5.4)


def unit_figures(
    unit: PumpingUnitMotion | None, rotator: RodRotatorMotion | None
) -> Iterator[CaptionedFigure]:
    """The figures of the polished rod, of the gearbox, and of the rotator."""
    if unit is not None:
        yield from _unit(unit)
    if rotator is not None:
        yield from _rotator(rotator)


def _unit(unit: PumpingUnitMotion) -> Iterator[CaptionedFigure]:
    gear = unit.gear
    caption = (
        f"The polished rod rises {quantity(unit.stroke, 'm')} while the crank turns "
        f"{degrees(unit.upstroke_angle)}. The torque factor runs from {number(unit.torque_factor_min)} to "
        f"{quantity(unit.torque_factor_max, 'm')}."
    )
    yield CaptionedFigure(
        "polished_rod", "Polished rod over one revolution", caption, polished_rod_figure(unit)
    )
    if gear is not None:
        caption = (
            "Torque at the crank by the polished rod and by its counterbalance; their sum peaks at "
            f"{quantity(max(gear.torque_net_up, gear.torque_net_down), 'N m')}."
        )
        yield CaptionedFigure("gear_torque", "Torque of the gearbox", caption, gear_torque_figure(gear))


def _rotator(rotator: RodRotatorMotion) -> Iterator[CaptionedFigure]:
    caption = f"The lever {rotator.verdict}."
    yield CaptionedFigure("rotator", "Lever of the rotator", caption, rotator_figure(rotator))
