"""The moving sketch: what is drawn, and where each point is over a turn.

Positions come from `kinematics` at even crank angles. The time at each angle is that of steady motion, so the
sketch moves as unevenly as the machine does; without steady motion it turns evenly. A mechanism that does not
close all round swings within the range where it does.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.analysis.closure import closure
from linkwright.analysis.kinematics import Kinematics, kinematics
from linkwright.analysis.study import Study
from linkwright.machine import Machine
from linkwright.machine.loads import BetweenPoints
from linkwright.machine.outline import ORIGIN, Outline

Floats = NDArray[np.float64]
Scene = dict[str, Any]

# Every second degree; the page draws straight between them.
_INTERVALS = 180

# Part of its range at each end that a swinging mechanism keeps clear of [rad].
_MARGIN = 1e-5

# Seconds for a turn, or a swing, that nothing is known of.
_DURATION = 4.0

# Share of the mechanism's size that is the last digit of a position.
_FINENESS = 1e-5


def scene(study: Study) -> Scene | None:
    """All that the sketch needs, ready for JSON.

    Parameters
    ----------
    study : Study
        The study.

    Returns
    -------
    dict or None
        ``angles`` [rad], ``times`` [s], ``speeds`` [rad/s] and ``points``, x and y [m] by name, at the same
        instants; ``parts`` to draw; ``box``, least and greatest x and y; ``swings``, whether the motion goes
        to and fro; ``true_speed``, whether the times are those of steady motion. None if the mechanism
        closes nowhere, or nothing moves.
    """
    machine = study.machine
    found = closure(machine)
    if not machine.linkage.cranks or not found.ranges:
        return None
    low, high = (0.0, 2 * np.pi) if found.turns_fully else _clear(found.ranges[0])
    motion = kinematics(machine, np.linspace(low, high, _INTERVALS + 1))
    drawn = _points(machine, motion)
    box = _box(drawn)
    fineness = _FINENESS * max(box[2] - box[0], box[3] - box[1])
    times, speeds = _times(study, motion.angles)
    return {
        "angles": _rounded(motion.angles, 1e-5),
        "times": _rounded(times, 1e-6 * float(times[-1])),
        "speeds": _rounded(speeds, 1e-5 * float(np.max(np.abs(speeds)))),
        "points": {
            name: [_rounded(xy[:, 0], fineness), _rounded(xy[:, 1], fineness)] for name, xy in drawn.items()
        },
        "parts": list(_parts(machine, motion)),
        "box": box,
        "swings": not found.turns_fully,
        "true_speed": study.steady_state is not None,
    }


def _clear(limits: tuple[float, float]) -> tuple[float, float]:
    """A range without its very ends, where a radicand may round to below zero."""
    return limits[0] + _MARGIN, limits[1] - _MARGIN


def _points(machine: Machine, motion: Kinematics) -> dict[str, Floats]:
    """Position of each point at each angle, (n, 2) [m], with the origin if cranks turn about it."""
    drawn = {name: point.position for name, point in motion.points.items()}
    still = np.zeros((len(motion.angles), 2))
    for name, point in machine.linkage.fixed_points().items():
        drawn.setdefault(name, still + np.array([point.x, point.y]))
    links = machine.linkage.links()
    for name, cable in machine.linkage.cables.items():
        # Where the cable leaves its arc, to the left or right of its direction.
        side = cable.angle + (np.pi / 2 if cable.side == "left" else -np.pi / 2)
        off = cable.radius * np.array([np.cos(side), np.sin(side)])
        drawn[_arc_end(name)] = drawn[links[cable.link].start] + off
    return drawn


def _arc_end(cable: str) -> str:
    """Name of the point where a cable leaves its arc."""
    return f"{cable}, end of the arc"


def _box(drawn: dict[str, Floats]) -> list[float]:
    """Least x, least y, greatest x, greatest y of all points."""
    every = np.concatenate(list(drawn.values()))
    return [float(value) for value in (*every.min(axis=0), *every.max(axis=0))]


def _times(study: Study, angles: Floats) -> tuple[Floats, Floats]:
    """Time and speed at each angle."""
    steady = study.steady_state
    if steady is not None:
        time = np.interp(angles, steady.crank_angle, steady.time)
        return time, np.interp(angles, steady.crank_angle, steady.speed)
    drive = study.machine.drive
    even = np.linspace(0.0, 1.0, len(angles))
    span = float(angles[-1] - angles[0])
    speed = drive.speed if drive and drive.speed else span / _DURATION
    return even * span / speed, np.full_like(angles, speed)


def _rounded(values: Floats, fineness: float) -> list[float]:
    """Values with no more digits than can be seen."""
    digits = max(0, int(np.ceil(-np.log10(fineness)))) if fineness > 0 else 0
    return [round(float(value), digits) for value in values]


# -- parts ---------------------------------------------------------------------------------------------------


def _parts(machine: Machine, motion: Kinematics) -> Iterator[Scene]:
    """What to draw, from behind to the front; points by name."""
    series = _series(machine)
    yield from _guides(machine, motion)
    yield from _grounds(machine)
    yield from _traces(machine)
    for name, link in machine.linkage.links().items():
        ends = {"from": link.start, "to": link.end}
        yield {"kind": "link", "role": link.role, "name": name, "series": series[link.element], **ends}
    for name in machine.linkage.cables:
        ends = {"from": _arc_end(name), "to": name}
        yield {"kind": "link", "role": "rod", "name": name, "series": series[name], **ends}
    yield from _plates(machine, series)
    yield from _springs(machine)
    yield from _sliders(machine, series)
    yield from _bodies(machine)
    for name in machine.linkage.moving_points():
        slides = name in machine.linkage.sliders
        yield {"kind": "point", "name": name, "slides": slides, "series": series[name]}


def _series(machine: Machine) -> dict[str, int]:
    """Number of the crank that moves each element, so that what moves together looks alike."""
    mechanism = machine.linkage
    outline = Outline.of(mechanism)
    makers = {name: name for name in outline.moving_points} | outline.links
    references = {each.name: each.references.values() for each in outline.elements}
    number = {name: n for n, name in enumerate(mechanism.cranks)}
    for name in mechanism.build_order():
        movers = [makers[each] for each in references[name] if makers.get(each) in number]
        number.setdefault(name, number[movers[0]] if movers else 0)
    return number


def _guides(machine: Machine, motion: Kinematics) -> Iterator[Scene]:
    """The straight line that each slider moves on."""
    for name, slider in machine.linkage.sliders.items():
        path = motion.points[name].position
        along = np.array([np.cos(slider.angle), np.sin(slider.angle)])
        reach = path @ along
        ends = [path[int(pick(reach))] for pick in (np.argmin, np.argmax)]
        yield {
            "kind": "guide",
            "name": name,
            "angle": slider.angle,
            "ends": [[float(x) for x in end] for end in ends],
        }


def _grounds(machine: Machine) -> Iterator[Scene]:
    """Fixed points that something turns about."""
    mechanism = machine.linkage
    pivots = [crank.pivot or ORIGIN for crank in mechanism.cranks.values()]
    pivots += [rocker.pivot for rocker in mechanism.rockers.values()]
    fixed = mechanism.fixed_points()
    used = [name for name in dict.fromkeys(pivots) if name in fixed]
    joined = [load for load in machine.loads.values() if isinstance(load, BetweenPoints)]
    sprung = [end for load in joined for end in load.between]
    for name in dict.fromkeys([*used, *(end for end in sprung if end in fixed)]):
        yield {"kind": "ground", "name": name}


def _traces(machine: Machine) -> Iterator[Scene]:
    """Paths of the points on links."""
    for name in machine.linkage.rigid_points:
        yield {"kind": "trace", "name": name}


def _plates(machine: Machine, series: dict[str, int]) -> Iterator[Scene]:
    """A point beside its link makes the link a plate."""
    links = machine.linkage.links()
    for name, part in machine.linkage.rigid_points.items():
        link = links[part.link]
        yield {"kind": "plate", "name": name, "corners": [link.start, link.end, name], "series": series[name]}


def _springs(machine: Machine) -> Iterator[Scene]:
    for name, load in machine.loads.items():
        if isinstance(load, BetweenPoints):
            yield {"kind": "spring", "name": name, "from": load.between[0], "to": load.between[1]}


def _sliders(machine: Machine, series: dict[str, int]) -> Iterator[Scene]:
    """Blocks on their guides; those that carry a body are larger."""
    loaded = {body.on or name for name, body in machine.bodies.items()}
    for name, slider in machine.linkage.sliders.items():
        look = {"angle": slider.angle, "heavy": name in loaded, "series": series[name]}
        yield {"kind": "slider", "name": name, **look}


def _bodies(machine: Machine) -> Iterator[Scene]:
    """Centres of mass: along and across their link from its start, or on a point."""
    links = machine.linkage.links()
    for name, body in machine.bodies.items():
        carrier = body.on or name
        if carrier in machine.linkage.sliders:
            continue
        if carrier not in links:
            yield {"kind": "mass", "name": name, "at": carrier}
            continue
        link = links[carrier]
        along = 0.5 * link.length if body.along is None else body.along
        place = [float(along / link.length), float(body.across / link.length)]
        yield {"kind": "mass", "name": name, "from": link.start, "to": link.end, "place": place}
