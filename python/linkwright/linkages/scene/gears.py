"""Gears, pulleys and racks in the moving sketch: pitch circles with a mark, belts between them, racks."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from linkwright.linkages.kinematics import Kinematics
from linkwright.linkages.model.element import Gear
from linkwright.linkages.model.mechanism import Mechanism

Scene = dict[str, Any]

# Radius of the larger pulley of a belt over the distance of their axes, where only a ratio is known, and of a
# gear on the same axis as its mate.
_PULLEY = 0.3


class _Circle(NamedTuple):
    """A pitch circle: the point it turns about, its link (none if it is at rest), its radius [m]."""

    at: str
    link: str | None
    radius: float


def gear_parts(mechanism: Mechanism, motion: Kinematics, series: dict[str, int]) -> Iterator[Scene]:
    """Circles, belts and racks.

    `series`: number of the driver that moves each element.
    """
    drawn: set[_Circle] = set()
    links = mechanism.links()
    for name, gear in mechanism.gears.items():
        own, other = _circles(name, gear, mechanism, motion)
        for circle in (other, own):
            if circle not in drawn:
                drawn.add(circle)
                element = links[circle.link].element if circle.link else name
                yield _part(circle, series[element])
        if gear.kind in ("belt", "crossed_belt"):
            belt = {"radii": [other.radius, own.radius], "crossed": gear.kind == "crossed_belt"}
            yield {"kind": "belt", "name": name, "from": other.at, "to": own.at, **belt}
    for name, rack in mechanism.racks.items():
        circle = _Circle(links[rack.gear].start, rack.gear, float(rack.radius))
        if circle not in drawn:
            yield _part(circle, series[links[rack.gear].element])
        yield _rack(name, mechanism, motion, series)


def _part(circle: _Circle, series: int) -> Scene:
    return {
        "kind": "gear",
        "name": circle.link or "ring",
        "at": circle.at,
        "link": circle.link,
        "radius": circle.radius,
        "series": series,
    }


def _circles(name: str, gear: Gear, mechanism: Mechanism, motion: Kinematics) -> tuple[_Circle, _Circle]:
    """Pitch circles of a gear and of its mate; that of a mate at rest is about the axis of the carrier."""
    links = mechanism.links()
    mate = gear.meshes or gear.carrier
    axis = links[mate].start if mate else gear.pivot
    distance = float(np.hypot(*(_first(gear.pivot, motion) - _first(axis, motion))))
    radius = distance * _share(gear)
    return (
        _Circle(gear.pivot, name, radius),
        _Circle(axis, gear.meshes, radius * float(gear.size_other) / float(gear.size)),
    )


def _share(gear: Gear) -> float:
    """Radius over the distance of the axes."""
    size, other = float(gear.size), float(gear.size_other)
    if gear.kind == "external":
        return size / (size + other)
    if gear.kind == "internal" and size != other:
        return size / abs(other - size)
    return _PULLEY * size / max(size, other)


def _first(name: str, motion: Kinematics) -> Any:
    """Place of a point at the first angle; the origin if the mechanism has no point of this name."""
    return motion.points[name].position[0] if name in motion.points else np.zeros(2)


def _rack(name: str, mechanism: Mechanism, motion: Kinematics, series: dict[str, int]) -> Scene:
    """The toothed bar: from the rack's point, along its guide, as far as the gear touches it."""
    rack = mechanism.racks[name]
    guide = rack.guide
    link = motion.links[guide.on].angle if guide.on else 0.0
    angle = guide.angle + link
    along = np.stack([np.cos(angle) + 0 * motion.angles, np.sin(angle) + 0 * motion.angles], axis=-1)
    axis = mechanism.links()[rack.gear].start
    touch = ((motion.points[axis].position - motion.points[name].position) * along).sum(axis=-1)
    look = {"at": name, "link": guide.on, "angle": float(guide.angle), "side": rack.side}
    span = [float(min(touch.min(), 0.0)), float(max(touch.max(), 0.0))]
    return {"kind": "rack", "name": name, "span": span, "series": series[name], **look}
