"""Figures of pumping units and rod rotators over one revolution, with their captions."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from linkwright.kernel.figure.style import (
    BLUE,
    GREEN,
    MATH,
    PURPLE,
    RED,
    CaptionedFigure,
    legend_above,
    panels,
    roomy,
    styled,
    turn_axis,
    zero_line,
)
from linkwright.kernel.page.numbers import degrees, number, quantity
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
        ("rise $s$\n[m]", unit.rod_travel, GREEN),
        ("torque factor\n$dS/dθ$ [m]", unit.torque_factor, PURPLE),
    ]
    if unit.rod_velocity is not None and unit.rod_acceleration is not None:
        curves.append(("velocity $v$\n[m/s]", unit.rod_velocity, BLUE))
        curves.append(("acceleration $a$\n[m/s²]", unit.rod_acceleration, RED))
    figure, axes = panels(len(curves), height=1.6 * len(curves) + 0.6)
    degrees = np.degrees(unit.crank_angle)
    for panel, (label, values, colour) in zip(axes, curves, strict=True):
        panel.plot(degrees, values, color=colour)
        panel.set_ylabel(label, **MATH)
        roomy(panel, values)
        zero_line(panel)
        turn_axis(panel, label=panel is axes[-1])
    return figure


@styled
def gear_torque_figure(gear: GearTorque) -> Figure:
    """Draw the load of the polished rod, and the torques at the crank."""
    figure, (load, torque) = panels(2, height=4.4)
    degrees = np.degrees(gear.crank_angle)
    load.plot(degrees, gear.rod_load, color=RED)
    load.set_ylabel("polished-rod load\n$W$ [N]", **MATH)
    roomy(load, gear.rod_load)
    for values, colour, label in (
        (gear.torque_rod, RED, "polished rod"),
        (gear.torque_counterbalance, GREEN, "counterbalance"),
        (gear.torque_net, BLUE, "gearbox"),
    ):
        torque.plot(degrees, values, color=colour, label=label)
    torque.set_ylabel("torque at the crank\n[N m]")
    roomy(torque, gear.torque_rod, gear.torque_counterbalance)
    zero_line(torque)
    legend_above(torque)
    turn_axis(load, label=False)
    turn_axis(torque)
    return figure


@styled
def rotator_figure(rotator: RodRotatorMotion) -> Figure:
    """Draw the lever's angle and its first and second transfer functions."""
    figure, axes = panels(3, height=5.4)
    degrees = np.degrees(rotator.crank_angle)
    for panel, values, label, colour in (
        (axes[0], np.degrees(rotator.lever_angle), "lever $φ_5$ [°]", BLUE),
        (axes[1], rotator.lever_transfer, "$φ_5′$", RED),
        (axes[2], rotator.lever_transfer_d1, "$φ_5″$", PURPLE),
    ):
        panel.plot(degrees, values, color=colour)
        at = np.degrees(rotator.change_points)
        panel.plot(at, np.interp(at, degrees, values), "o", color=colour, markersize=4)
        panel.set_ylabel(label, **MATH)
        roomy(panel, values)
        zero_line(panel)
        turn_axis(panel, label=panel is axes[-1])
    return figure


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
