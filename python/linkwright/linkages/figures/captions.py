"""The figures of a linkage: transmission angles, and coupler curves drawn with the links."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from linkwright.kernel.figure.captioned import Captioned
from linkwright.kernel.page.numbers import degrees, number
from linkwright.linkages.coupler_curve import CouplerCurve, coupler_curve
from linkwright.linkages.cycle import Linkage
from linkwright.linkages.figures.linkage import coupler_figure, transmission_figure
from linkwright.linkages.pose import pose
from linkwright.machine.machine import Machine

# More paths than this hide each other.
_PATHS_MAX = 6


def linkage_figures(machine: Machine, found: Linkage) -> Iterator[Captioned]:
    """The figures of a machine's linkage over its cycle."""
    worst = [each for each in found.elements if each.transmission_angle_worst is not None]
    if worst:
        least = min(worst, key=lambda each: each.transmission_angle_worst or 0.0)
        caption = (
            "90° is ideal. The poorest transmission is that of "
            f"{least.element}, {degrees(least.transmission_angle_worst or 0.0)} from being in line."
        )
        yield Captioned("transmission", "Transmission angles", caption, transmission_figure(found))
    mechanism = machine.linkage
    points = [name for name in mechanism.rigid_points if name not in _on_ground(machine)]
    if points and found.closure.change_point is None:
        curves = [coupler_curve(machine, name) for name in points[:_PATHS_MAX]]
        links = _links(machine, float(found.crank_angle[len(found.crank_angle) // 8]))
        yield Captioned("coupler_curves", "Paths of points", _words(curves), coupler_figure(curves, links))


def _on_ground(machine: Machine) -> set[str]:
    """Points of links that turn about a fixed point: their paths are circles."""
    links, fixed = machine.linkage.links(), machine.linkage.fixed_points()
    parts = machine.linkage.rigid_points.items()
    return {name for name, part in parts if links[part.link].start in fixed}


def _links(machine: Machine, angle: float) -> list[tuple[np.ndarray, bool]]:
    """Ends of the links at a crank angle, with the points that they carry."""
    places = {name: np.array(each.position) for name, each in pose(machine, angle).points.items()}
    fixed = machine.linkage.fixed_points()
    found = []
    for link in machine.linkage.links().values():
        if link.start != link.end and link.length:
            found.append((np.array([places[link.start], places[link.end]]), link.start in fixed))
    for name, part in machine.linkage.rigid_points.items():
        found.append((np.array([places[machine.linkage.links()[part.link].start], places[name]]), False))
    return found


def _words(curves: list[CouplerCurve]) -> str:
    """Length and what is special of each path."""
    parts = []
    for curve in curves:
        extras = [f"{len(each)} {word}" for each, word in _special(curve) if each]
        more = f", {' and '.join(extras)}" if extras else ""
        parts.append(
            f"{curve.point}: {number(curve.length)} m long, straight over "
            f"{number(curve.straight_length)} m{more}"
        )
    return "; ".join(parts) + ". Straight means nowhere farther from the chord than a thousandth of it."


def _special(curve: CouplerCurve) -> list[tuple[tuple[object, ...], str]]:
    return [
        (curve.double_points, "double point" if len(curve.double_points) == 1 else "double points"),
        (curve.cusps, "cusp" if len(curve.cusps) == 1 else "cusps"),
    ]
