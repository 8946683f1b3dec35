"""A linkage: transmission angles over the cycle, and the curves of its coupler points with the links."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from linkwright.kernel.figure.style import INK, LINES, SOFT, legend_above, level, named, panels, roomy, styled

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from linkwright.linkages.coupler_curve import CouplerCurve
    from linkwright.linkages.cycle import Linkage

# Transmission angle below which a linkage runs badly, a rule of thumb (VDI 2123) [°].
_POOR = 40.0


@styled
def transmission_figure(linkage: Linkage) -> Figure:
    """Draw the transmission angle of every dyad over the crank angle. Returns: one panel; dashed where a
    linkage begins to run badly, at 40° and 140°.
    """
    figure, (axes,) = panels(1, height=2.9)
    angles = np.degrees(linkage.crank_angle)
    for k, (name, mu) in enumerate(linkage.transmission_angles.items()):
        axes.plot(angles, np.degrees(mu), color=LINES[k % len(LINES)], label=named(name))
    drawn = [np.degrees(mu) for mu in linkage.transmission_angles.values()]
    roomy(axes, *drawn, np.array([_POOR, 180 - _POOR]))
    level(axes, _POOR, "40° and 140°")
    axes.axhline(180 - _POOR, color=SOFT, linewidth=1.1, linestyle=(0, (5, 3)))
    axes.set_xlim(angles[0], angles[-1])
    axes.set_xlabel("crank angle φ [°]")
    axes.set_ylabel("transmission angle μ [°]")
    legend_above(axes)
    return figure


@styled
def coupler_figure(curves: list[CouplerCurve], links: list[tuple[np.ndarray, bool]]) -> Figure:
    """Draw the paths of points with the links in one position.

    `links`: ends of each link, shape (2, 2) [m], and whether its start is at rest. Returns: one panel to
    scale; crosses mark double points, dots cusps.
    """
    figure, (axes,) = panels(1, height=5.0)
    for ends, is_ground in links:
        axes.plot(ends[:, 0], ends[:, 1], color=INK, linewidth=2.4, marker="o", markersize=3.5)
        if is_ground:
            axes.plot(*ends[0], marker="^", markersize=9, color=SOFT, zorder=0)
    for k, curve in enumerate(curves):
        colour = LINES[k % len(LINES)]
        axes.plot(curve.x, curve.y, color=colour, label=f"path of {curve.point}")
        for point in curve.double_points:
            axes.plot(point.x, point.y, marker="x", color=colour, markersize=7)
        for cusp in curve.cusps:
            axes.plot(cusp.x, cusp.y, marker="o", color=colour, markersize=5)
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    legend_above(axes)
    return figure
