"""The machine reduced to its crank: inertia and load torque over one revolution."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from linkwright.kernel.figure.style import (
    INERTIA,
    LOAD,
    MATH,
    legend_above,
    level,
    panels,
    roomy,
    styled,
    turn_axis,
    zero_line,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from linkwright.drive.reduction import Reduction


@styled
def reduction_figure(reduction: Reduction) -> Figure:
    """Draw reduced inertia and reduced torque over the crank angle."""
    figure, (inertia, torque) = panels(2, height=4.2)
    degrees = np.degrees(reduction.crank_angle)
    inertia.plot(degrees, reduction.inertia_reduced, color=INERTIA)
    inertia.set_ylabel("reduced inertia $J$\n[kg m²]", **MATH)
    roomy(inertia, reduction.inertia_reduced)
    torque.plot(degrees, reduction.torque_load, color=LOAD, label="load torque")
    level(torque, reduction.torque_load_mean, f"mean {reduction.torque_load_mean:.4g} N m")
    torque.set_ylabel("reduced torque $M_r$\n[N m]", **MATH)
    roomy(torque, reduction.torque_load, np.array([0.0]))
    zero_line(torque)
    legend_above(torque)
    turn_axis(inertia, label=False)
    turn_axis(torque)
    return figure
