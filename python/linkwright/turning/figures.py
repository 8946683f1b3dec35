"""The turning-moment diagram, the energy and the speed over a cycle."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from linkwright.kernel.figure.style import (
    DRIVE,
    GRID,
    INERTIA,
    LOAD,
    SPEED,
    CaptionedFigure,
    legend_above,
    level,
    panels,
    roomy,
    styled,
    turn_axis,
    zero_line,
)
from linkwright.kernel.page.numbers import degrees, number, quantity

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from linkwright.turning.diagram import TurningMomentDiagram


def turning_figures(diagram: TurningMomentDiagram) -> Iterator[CaptionedFigure]:
    """The diagram with its energy, and the speed; nothing where areas alone are given."""
    if not len(diagram.crank_angle):
        return
    coefficient = ""
    if diagram.energy_coefficient is not None:
        coefficient = f", {number(diagram.energy_coefficient)} of the work per cycle"
    caption = (
        f"Driver against load over a cycle. The energy of the shaft changes by "
        f"{quantity(diagram.energy_fluctuation, 'J')}{coefficient}."
    )
    yield CaptionedFigure("turning_moment", "Turning-moment diagram", caption, diagram_figure(diagram))
    if (
        diagram.inertia is not None
        and diagram.speed_max_angle is not None
        and diagram.speed_min_angle is not None
    ):
        caption = (
            f"With {quantity(diagram.inertia, 'kg m²')} the shaft turns at "
            f"{quantity(diagram.speed_min, 'rad/s')} to "
            f"{quantity(diagram.speed_max, 'rad/s')}: fastest at "
            f"{degrees(diagram.speed_max_angle)}, slowest at "
            f"{degrees(diagram.speed_min_angle)}."
        )
        yield CaptionedFigure("turning_speed", "Speed over the cycle", caption, speed_figure(diagram))


@styled
def diagram_figure(diagram: TurningMomentDiagram) -> Figure:
    """Torques of driver and load, and the energy that the shaft takes up between them."""
    figure, (torque, energy) = panels(2, height=4.6)
    angle = np.degrees(diagram.crank_angle)
    torque.fill_between(angle, diagram.torque_driver, diagram.torque_load, color=GRID, linewidth=0)
    torque.plot(angle, diagram.torque_driver, color=DRIVE, label="driver")
    torque.plot(angle, diagram.torque_load, color=LOAD, label="load")
    torque.set_ylabel("torque\n[N m]")
    roomy(torque, diagram.torque_driver, diagram.torque_load)
    zero_line(torque)
    legend_above(torque)
    energy.plot(angle, diagram.energy, color=INERTIA)
    energy.set_ylabel("excess energy E\n[J]")
    roomy(energy, diagram.energy)
    zero_line(energy)
    _angle_axis(torque, angle, label=False)
    _angle_axis(energy, angle)
    return figure


@styled
def speed_figure(diagram: TurningMomentDiagram) -> Figure:
    """Speed of the shaft over the cycle."""
    figure, (speed,) = panels(1, height=2.4)
    angle = np.degrees(diagram.crank_angle)
    speed.plot(angle, diagram.speed, color=SPEED, label="speed")
    level(speed, diagram.speed_mean, f"mean of the extremes {quantity(diagram.speed_mean, 'rad/s')}")
    speed.set_ylabel("speed ω\n[rad/s]")
    roomy(speed, diagram.speed)
    legend_above(speed)
    _angle_axis(speed, angle)
    return figure


def _angle_axis(axes: Axes, angle: np.ndarray, *, label: bool = True) -> None:
    """Degrees over one cycle."""
    turn_axis(axes, angle, label=False)
    axes.tick_params(labelbottom=label)
    if label:
        axes.set_xlabel("shaft angle φ [°]")
