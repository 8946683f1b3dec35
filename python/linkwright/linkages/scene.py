"""Sketch of a mechanism: points, links, slides, gears, bodies, springs over the crank angle.

A part names points and links; their places and angles over the motion are in the scene. Lengths are metres,
angles radians. ``at`` is a point, ``link`` the link that a part turns with; without it the part keeps its
direction.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kinetostatics.model.body import Body
from linkwright.kinetostatics.model.loads.between import BetweenPoints
from linkwright.linkages.kinematics import Kinematics
from linkwright.linkages.model.element import Gear, Guide
from linkwright.linkages.model.mechanism import Link, Mechanism
from linkwright.linkages.model.topology import ORIGIN, Topology
from linkwright.machine.machine import Machine

Scene = dict[str, Any]


def parts(machine: Machine, motion: Kinematics) -> Iterator[Scene]:
    """What to draw of a motion, from behind to the front; points and links by name."""
    mechanism = machine.linkage
    series = _series(mechanism)
    yield from _guides(mechanism, motion, series)
    yield from _grounds(machine)
    yield from _traces(mechanism)
    yield from gear_parts(mechanism, motion, series)
    if machine.mechanism.cams:
        from linkwright.cam.scene import cam_parts

        yield from cam_parts(machine, series)
    yield from _links(mechanism, series)
    yield from _levers(mechanism, motion, series)
    yield from _barrels(mechanism, motion, series)
    yield from _cables(mechanism, motion, series)
    yield from _plates(mechanism, series)
    yield from _springs(machine)
    yield from _blocks(machine, series)
    yield from _bodies(machine)
    on_blocks = {
        *mechanism.sliders,
        *mechanism.yokes,
        *mechanism.racks,
        *mechanism.cables,
        *mechanism.linear_drivers,
    }
    for name in mechanism.moving_points():
        yield {"kind": "point", "name": name, "slides": name in on_blocks, "series": series[name]}


# How far an arc goes on beyond where its cable leaves it [rad].
_BEYOND = 0.1


def arc_end(cable: str) -> str:
    """Name of the point where a cable leaves its arc."""
    return f"{cable}, end of the arc"


def _series(mechanism: Mechanism) -> dict[str, int]:
    """Number of the driver of each element, so that what moves together has one colour."""
    topology = Topology.of(mechanism)
    makers = {name: name for name in topology.moving_points} | topology.links
    references = {element.name: element.references.values() for element in topology.elements}
    number = {name: n for n, name in enumerate(topology.drivers)}
    for name in mechanism.build_order():
        movers = [makers[reference] for reference in references[name] if makers.get(reference) in number]
        number.setdefault(name, number[movers[0]] if movers else 0)
    return number


# -- guides --------------------------------------------------------------------------------------------------


def _all_guides(mechanism: Mechanism) -> Iterator[tuple[str, str, Guide]]:
    for name, slider in mechanism.sliders.items():
        yield (
            name,
            name,
            Guide(through=slider.through, on=slider.on, angle=slider.angle, offset=slider.offset),
        )
    for table in ("yokes", "racks", "linear_drivers", "joints"):
        for name, element in getattr(mechanism, table).items():
            if element.guide is not None:
                yield name, name, element.guide
    for name, crossing in mechanism.crossings.items():
        yield name, f"{name}.first", crossing.first
        yield name, f"{name}.second", crossing.second


def _guides(mechanism: Mechanism, motion: Kinematics, series: dict[str, int]) -> Iterator[Scene]:
    """Straight lines that points move on: on the frame, or as a rail on a link."""
    links, moving = mechanism.links(), mechanism.moving_points()
    for point, slide, guide in _all_guides(mechanism):
        carrier = guide.through if guide.through in moving else None
        if guide.on is not None or carrier is not None:
            yield {
                "kind": "rail",
                "name": slide,
                "at": guide.through or links[guide.on or ""].start,
                "link": guide.on,
                "angle": float(guide.angle),
                "offset": float(guide.offset),
                "span": _span(motion.slides[slide].position),
                "series": series[links[guide.on].element if guide.on else carrier or point],
            }
            continue
        path = motion.points[point].position
        along = path @ np.array([np.cos(guide.angle), np.sin(guide.angle)])
        ends = [path[int(pick(along))] for pick in (np.argmin, np.argmax)]
        ends_listed = [[float(x) for x in end] for end in ends]
        yield {"kind": "guide", "name": point, "angle": float(guide.angle), "ends": ends_listed}


def _span(values: Floats) -> list[float]:
    return [float(values.min()), float(values.max())]


def _blocks(machine: Machine, series: dict[str, int]) -> Iterator[Scene]:
    mechanism = machine.linkage
    loaded = {body.on or name for name, body in machine.bodies.items()}
    for point, slide, guide in _all_guides(mechanism):
        # A rack is drawn as a bar, the follower of a cam as a stem.
        if point not in mechanism.racks and point not in machine.mechanism.cams:
            yield _block(point, guide.on, guide.angle, heavy=slide in loaded, series=series[point])
    for name, lever in mechanism.slotted_levers.items():
        yield _block(lever.pin, name, 0.0, heavy=False, series=series[name])
    for name, yoke in mechanism.yokes.items():
        yield _block(yoke.pin, yoke.guide.on, yoke.guide.angle + yoke.slot, heavy=False, series=series[name])


def _block(point: str, link: str | None, angle: float, *, heavy: bool, series: int) -> Scene:
    look = {"at": point, "link": link, "angle": float(angle), "heavy": heavy, "series": series}
    return {"kind": "slider", "name": point, **look}


# -- links ---------------------------------------------------------------------------------------------------


def _links(mechanism: Mechanism, series: dict[str, int]) -> Iterator[Scene]:
    links = mechanism.links()
    for name, link in links.items():
        if link.start != link.end and link.role not in ("lever", "barrel"):
            yield _line(name, link.role, series[link.element], link.start, link.end)
    for name, part in mechanism.rigid_points.items():
        link = links[part.link]
        if link.start == link.end or link.role == "lever":
            yield _line(part.link, "arm", series[name], link.start, name)
        elif part.across == 0 and not 0 <= part.along <= link.length:
            yield _line(part.link, "arm", series[name], link.start if part.along < 0 else link.end, name)


def _line(name: str, role: str, series: int, start: str, end: str) -> Scene:
    return {"kind": "link", "role": role, "name": name, "series": series, "from": start, "to": end}


def _levers(mechanism: Mechanism, motion: Kinematics, series: dict[str, int]) -> Iterator[Scene]:
    """Slotted levers, and the slots of yokes: a bar with its slot, along which a block moves."""
    for name, lever in mechanism.slotted_levers.items():
        span = _span(motion.slides[name].position)
        bar = [min(span[0], 0.0), max(span[1], lever.length or 0.0)]
        look = {"angle": 0.0, "offset": float(lever.offset), "series": series[name]}
        yield {
            "kind": "slot",
            "name": name,
            "at": lever.pivot,
            "link": name,
            "span": span,
            "bar": bar,
            **look,
        }
    for name, yoke in mechanism.yokes.items():
        # The slide counts from the pin to the guide; the pin lies the other way.
        span = _span(-motion.slides[f"{name}.slot"].position)
        bar = [min(span[0], 0.0), max(span[1], 0.0)]
        look = {"angle": float(yoke.guide.angle + yoke.slot), "offset": 0.0, "series": series[name]}
        on = yoke.guide.on
        yield {"kind": "slot", "name": name, "at": name, "link": on, "span": span, "bar": bar, **look}


# Length of a barrel over the minimum distance of trunnion and eye, where it is not given.
_BARREL = 0.85


def _barrels(mechanism: Mechanism, motion: Kinematics, series: dict[str, int]) -> Iterator[Scene]:
    """Barrels of cylinders, hollow, in front of their rods."""
    for name, cylinder in mechanism.cylinders.items():
        length = float(cylinder.barrel_length or _BARREL * motion.slides[name].position.min())
        look = {"at": cylinder.start, "link": name, "angle": 0.0, "offset": 0.0, "series": series[name]}
        hollow = [0.04 * length, 0.96 * length]
        yield {"kind": "slot", "name": name, "span": hollow, "bar": [0.0, length], **look}


def _cables(mechanism: Mechanism, motion: Kinematics, series: dict[str, int]) -> Iterator[Scene]:
    links = mechanism.links()
    for name, cable in mechanism.cables.items():
        side = cable.angle + (np.pi / 2 if cable.side == "left" else -np.pi / 2)
        # Where the cable leaves the arc, seen from the link.
        low, high = _span(side - motion.links[cable.link].angle)
        yield {
            "kind": "arc",
            "name": name,
            "at": links[cable.link].start,
            "link": cable.link,
            "radius": float(cable.radius),
            "span": [low - _BEYOND, high + _BEYOND],
            "series": series[name],
        }
        yield _line(name, "cable", series[name], arc_end(name), name)


def _plates(mechanism: Mechanism, series: dict[str, int]) -> Iterator[Scene]:
    links = mechanism.links()
    for name, part in mechanism.rigid_points.items():
        link = links[part.link]
        if link.start != link.end and link.role not in ("lever", "barrel"):
            corners = [link.start, link.end, name]
            yield {"kind": "plate", "name": name, "corners": corners, "series": series[name]}


# -- the rest ------------------------------------------------------------------------------------------------


def _grounds(machine: Machine) -> Iterator[Scene]:
    mechanism = machine.linkage
    pivots = [crank.pivot or ORIGIN for crank in mechanism.cranks.values()]
    pivots += [cam.pivot or ORIGIN for cam in machine.mechanism.cams.values()]
    for table in ("rockers", "slotted_levers", "gears"):
        pivots += [element.pivot for element in getattr(mechanism, table).values()]
    pivots += [end for bar in mechanism.bars.values() for end in (bar.start, bar.end)]
    pivots += [end for cylinder in mechanism.cylinders.values() for end in (cylinder.start, cylinder.end)]
    fixed = mechanism.fixed_points()
    joined = [load for load in machine.loads.values() if isinstance(load, BetweenPoints)]
    sprung = [end for load in joined for end in load.between]
    for name in dict.fromkeys(name for name in (*pivots, *sprung) if name in fixed):
        yield {"kind": "ground", "name": name}


def _traces(mechanism: Mechanism) -> Iterator[Scene]:
    """Paths of points on links, and of joints that neither a fixed pivot nor a guide leads."""
    fixed = mechanism.fixed_points()
    led = {
        end
        for bar in mechanism.bars.values()
        if {bar.start, bar.end} & set(fixed)
        for end in (bar.start, bar.end)
    }
    free = [name for name, joint in mechanism.joints.items() if joint.guide is None and name not in led]
    for name in (*mechanism.rigid_points, *free):
        yield {"kind": "trace", "name": name}


def _springs(machine: Machine) -> Iterator[Scene]:
    for name, load in machine.loads.items():
        if isinstance(load, BetweenPoints):
            yield {"kind": "spring", "name": name, "from": load.between[0], "to": load.between[1]}


def _bodies(machine: Machine) -> Iterator[Scene]:
    """Centres of mass: along and across their link from its start, or on a point."""
    links = machine.linkage.links()
    for name, body in machine.bodies.items():
        carrier = body.on or name
        if carrier in links:
            yield {"kind": "mass", "name": name, "link": carrier, **_place(body, links[carrier])}
        elif carrier not in machine.linkage.sliders:
            yield {"kind": "mass", "name": name, "at": carrier}


def _place(body: Body, link: Link) -> Scene:
    along = 0.5 * link.length if body.along is None else body.along
    return {"at": link.start, "place": [float(along), float(body.across)]}


# Radius of the larger pulley of a belt over the distance of their axes, where only a ratio is known, and of a
# gear on the same axis as its mate.
_PULLEY = 0.3


class _Circle(NamedTuple):
    """A pitch circle: the point it turns about, its link (none if it is at rest), its radius [m]."""

    at: str
    link: str | None
    radius: float


def gear_parts(mechanism: Mechanism, motion: Kinematics, series: dict[str, int]) -> Iterator[Scene]:
    """Circles, belts and racks. `series`: number of the driver that moves each element."""
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
