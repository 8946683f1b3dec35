"""Figures of a linkage over its cycle, with their captions."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from linkwright.kernel.figure.legends import legend_above
from linkwright.kernel.figure.lines import Level, Line, Panel, line_figure
from linkwright.kernel.figure.style import (
    INK,
    LINES,
    SOFT,
    CaptionedFigure,
    named,
    panels,
    styled,
)
from linkwright.kernel.reader.numbers import degrees, quantity
from linkwright.linkages.coupler_curve import CouplerCurve, coupler_curve
from linkwright.linkages.cycle import Linkage
from linkwright.linkages.pose import pose
from linkwright.machine.machine import Machine

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from linkwright.linkages.coupler_curve import CouplerCurve
    from linkwright.linkages.cycle import Linkage

# Transmission angle below which a linkage runs badly, a rule of thumb (VDI 2123) [°].
POOR = 40.0


@styled
def transmission_figure(linkage: Linkage) -> Figure:
    """Draw the transmission angle of every dyad over the crank angle, with limits at 40° and 140°."""
    angles = linkage.transmission_angles
    lines = [
        Line(np.degrees(mu), LINES[k % len(LINES)], named(name))
        for k, (name, mu) in enumerate(angles.items())
    ]
    limits = [Level(POOR, "40° and 140°"), Level(180 - POOR, "")]
    panel = Panel("transmission angle μ [°]", [*lines, *limits], room=(POOR, 180 - POOR))
    return line_figure(np.degrees(linkage.crank_angle), panel, height=2.9)


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


# More paths than this hide each other.
_PATHS_MAX = 6


def linkage_figures(machine: Machine, linkage: Linkage) -> Iterator[CaptionedFigure]:
    """The figures of a machine's linkage over its cycle."""
    worst = [element for element in linkage.elements if element.transmission_angle_worst is not None]
    if worst:
        least = min(worst, key=lambda curve: curve.transmission_angle_worst or 0.0)
        caption = (
            "90° is ideal. The worst transmission angle is "
            f"{degrees(least.transmission_angle_worst or 0.0)}, at {least.element}."
        )
        yield CaptionedFigure("transmission", "Transmission angles", caption, transmission_figure(linkage))
    mechanism = machine.linkage
    points = [name for name in mechanism.rigid_points if name not in _on_ground(machine)]
    if points and linkage.closure.change_point is None:
        curves = [coupler_curve(machine, name) for name in points[:_PATHS_MAX]]
        links = _links(machine, float(linkage.crank_angle[len(linkage.crank_angle) // 8]))
        yield CaptionedFigure(
            "coupler_curves", "Paths of points", _words(curves), coupler_figure(curves, links)
        )


def _on_ground(machine: Machine) -> set[str]:
    links, fixed = machine.linkage.links(), machine.linkage.fixed_points()
    parts = machine.linkage.rigid_points.items()
    return {name for name, part in parts if links[part.link].start in fixed}


def _links(machine: Machine, angle: float) -> list[tuple[np.ndarray, bool]]:
    places = {name: np.array(point.position) for name, point in pose(machine, angle).points.items()}
    fixed = machine.linkage.fixed_points()
    links = []
    for link in machine.linkage.links().values():
        if link.start != link.end and link.length:
            links.append((np.array([places[link.start], places[link.end]]), link.start in fixed))
    for name, part in machine.linkage.rigid_points.items():
        links.append((np.array([places[machine.linkage.links()[part.link].start], places[name]]), False))
    return links


def _words(curves: list[CouplerCurve]) -> str:
    parts = []
    for curve in curves:
        extras = [f"{len(point)} {word}" for point, word in _special(curve) if point]
        more = f", {' and '.join(extras)}" if extras else ""
        parts.append(
            f"{curve.point}: {quantity(curve.length, 'm')} long, straight over "
            f"{quantity(curve.straight_length, 'm')}{more}"
        )
    return "; ".join(parts) + ". Straight means nowhere farther from the chord than a thousandth of it."


def _special(curve: CouplerCurve) -> list[tuple[tuple[object, ...], str]]:
    return [
        (curve.double_points, "double point" if len(curve.double_points) == 1 else "double points"),
        (curve.cusps, "cusp" if len(curve.cusps) == 1 else "cusps"),
    ]
