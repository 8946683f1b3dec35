"""The turning-moment diagram, the energy and the speed over a cycle."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from linkwright.kernel.figure.lines import Level, Line, Panel, line_figure
from linkwright.kernel.figure.style import DRIVE, GRID, INERTIA, LOAD, SPEED, CaptionedFigure, styled
from linkwright.kernel.reader.numbers import degrees, number, quantity

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from linkwright.turning.diagram import TurningMomentDiagram

_ANGLE = "shaft angle φ [°]"


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
    angle, driver, load = np.degrees(diagram.crank_angle), diagram.torque_driver, diagram.torque_load
    torques = Panel("torque\n[N m]", [Line(driver, DRIVE, "driver"), Line(load, LOAD, "load")])
    energy = Panel("excess energy E\n[J]", [Line(diagram.energy, INERTIA)])
    figure = line_figure(angle, torques, energy, height=4.6, over=_ANGLE)
    figure.axes[0].fill_between(angle, driver, load, color=GRID, linewidth=0)
    return figure


@styled
def speed_figure(diagram: TurningMomentDiagram) -> Figure:
    """Speed of the shaft over the cycle."""
    mean = Level(diagram.speed_mean, f"mean of the extremes {quantity(diagram.speed_mean, 'rad/s')}")
    speed = Panel("speed ω\n[rad/s]", [Line(diagram.speed, SPEED, "speed"), mean])
    return line_figure(np.degrees(diagram.crank_angle), speed, height=2.4, over=_ANGLE)
