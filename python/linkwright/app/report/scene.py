"""The moving sketch: where each point and link is over the motion, and how long that takes.

Positions come from `kinematics` at even crank angles. The time at each angle is that of steady motion, so the
sketch moves as unevenly as the machine does; without steady motion its speed is constant. A mechanism that
does not close all round swings within the range where it does; one that repeats after several revolutions is
drawn over all of them. What is drawn at these places is said in `scene_parts`.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from linkwright.drive.steady_state import SteadyState
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import AssemblyError
from linkwright.kernel.reader.angle_zero import zero_shown
from linkwright.kernel.reader.out_units import reader
from linkwright.linkages.closure import Closure, closure
from linkwright.linkages.kinematics import Kinematics, kinematics
from linkwright.linkages.model.topology import Topology
from linkwright.linkages.scene import arc_end, parts
from linkwright.machine.machine import Machine

Scene = dict[str, Any]

# Every second degree; the page draws straight between them. Of a longer motion, so many revolutions as
# finely.
_INTERVALS = 180
_TURNS_FINE = 8

# Part of its range at each end that a swinging mechanism keeps clear of [rad].
_MARGIN = 1e-5

# Seconds for a revolution, or a swing, that nothing is known of.
_DURATION = 4.0

# Share of the mechanism's size that is the last digit of a position, and last digit of an angle [rad].
_FINENESS = 1e-5


def scene(machine: Machine, steady: SteadyState | None = None, string: Any = None) -> Scene | None:
    """`moving_scene` as lists for JSON, without the motion, with no more digits than can be seen."""
    moving = moving_scene(machine, steady, string=string)
    return None if moving is None else listed(moving)


def listed(moving: Scene) -> Scene:
    """A moving scene as lists for JSON."""
    box = moving["box"]
    fineness = _FINENESS * max(box[2] - box[0], box[3] - box[1])
    times, speeds = moving["times"], moving["speeds"]
    return {
        "angles": _rounded(moving["angles"], 1e-5),
        "times": _rounded(times, 1e-6 * float(times[-1])),
        "speeds": _rounded(speeds, 1e-5 * float(np.max(np.abs(speeds)))),
        "points": {
            name: [_rounded(xy[:, 0], fineness), _rounded(xy[:, 1], fineness)]
            for name, xy in moving["points"].items()
        },
        "headings": {name: _rounded(angle, _FINENESS) for name, angle in moving["headings"].items()},
        "rods": {
            name: _rounded(values.ravel(), 1e-3 if name == "shares" else fineness)
            for name, values in moving.get("rods", {}).items()
        },
        # Units of speed and stress that are printed, and their sizes.
        "speed_unit": reader().shown("rad/s"),
        "stress_unit": reader().shown("Pa", "MPa"),
        # Crank angle from which the printed one counts.
        "angle_zero": zero_shown().angle,
        **{key: moving[key] for key in ("parts", "box", "swings", "true_speed")},
    }


def moving_scene(
    machine: Machine, steady: SteadyState | None, through: float | None = None, string: Any = None
) -> Scene | None:
    """All that is drawn of a mechanism in motion, with the crank angle `through` [rad] among those drawn.

    ``angles`` [rad], ``times`` [s], ``speeds`` [rad/s], ``points``, x and y [m] by name, ``headings``, angles
    of links [rad] by name, all arrays at the same instants; ``parts`` to draw; ``box``, minimum and maximum x
    and y; ``swings``, whether the motion goes back and forth; ``true_speed``, whether the times are those of
    steady motion; ``motion``, the `Kinematics`; ``rods``, places and stresses of a rod string. None if the
    mechanism closes nowhere, or nothing moves. ``string``: motion of the rod string, where it is known.
    """
    if machine.rod_string is not None:
        from linkwright.rods.diagnosis import CardDiagnosis
        from linkwright.rods.scene import string_scene, string_shown, with_string

        string = string_shown(machine) if string is None else string
        if string is not None and (machine.is_rod_string_alone or isinstance(string, CardDiagnosis)):
            return string_scene(machine.rod_string, string)
        if machine.pumping_unit is not None and string is not None:
            unit = _mechanism_scene(machine, string.drive or steady, through)
            return None if unit is None else with_string(unit, machine.rod_string, string)
    return _mechanism_scene(machine, steady, through)


def _mechanism_scene(machine: Machine, steady: SteadyState | None, through: float | None) -> Scene | None:
    if not _closes(machine):
        return None
    closed = closure(machine)
    angles = _angles(closed, steady.turns if steady else 1)
    if through is not None:
        angles = np.union1d(angles, [through])
    motion = kinematics(machine, angles)
    drawn = _points(machine, motion)
    listed = list(parts(machine, motion))
    times, speeds = _times(machine, steady, motion.angles)
    headings = {name: link.angle for name, link in motion.links.items()} | _cam_headings(
        machine, motion.angles
    )
    turning = {part["link"] for part in listed if part.get("link")}
    return {
        "angles": motion.angles,
        "times": times,
        "speeds": speeds,
        "points": drawn,
        "headings": {name: headings[name] for name in sorted(turning)},
        "parts": listed,
        "box": _box(machine, drawn, listed, motion),
        "swings": not closed.turns_fully,
        "true_speed": steady is not None,
        "motion": motion,
    }


def _cam_headings(machine: Machine, angles: Floats) -> dict[str, Floats]:
    """Direction of each cam at each crank angle, (n,) [rad]."""
    if not machine.mechanism.cams:
        return {}
    from linkwright.cam.scene import cam_headings

    return cam_headings(machine, angles)


def _cam_reach(machine: Machine) -> Iterable[tuple[str, float]]:
    if not machine.mechanism.cams:
        return ()
    from linkwright.cam.scene import reach

    return reach(machine)


def _closes(machine: Machine) -> bool:
    """Whether something moves and closes at some crank angle; where not, the study says why."""
    try:
        moves = bool(Topology.of(machine.linkage).drivers)
        return moves and bool(closure(machine).ranges)
    except AssemblyError:
        # silent: the same, and a mechanism that does not move is not drawn
        # No lengths for a rotator.
        return False


def _angles(closed: Closure, cycle: int) -> Floats:
    """Crank angles of the motion that is drawn, over the revolutions of a cycle of the motion [rad]."""
    if not closed.turns_fully:
        # Without its very ends, where a radicand may round to below zero.
        low, high = closed.ranges[0]
        return np.linspace(low + _MARGIN, high - _MARGIN, _INTERVALS + 1)
    turns = math.lcm(closed.turns or 1, cycle)
    return np.linspace(0.0, 2 * np.pi * turns, _INTERVALS * min(turns, _TURNS_FINE) + 1)


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
        drawn[arc_end(name)] = drawn[links[cable.link].start] + off
    return drawn


def _box(machine: Machine, drawn: dict[str, Floats], listed: list[Scene], motion: Kinematics) -> list[float]:
    """Minimum x, minimum y, maximum x, maximum y of all points, pitch circles, arcs, levers and cams."""
    every = list(drawn.values())
    for part in listed:
        if part["kind"] == "gear":
            every += [drawn[part["at"]] + part["radius"], drawn[part["at"]] - part["radius"]]
        if part["kind"] == "slot":
            angle = part["angle"] + (
                motion.links[part["link"]].angle if part["link"] else 0.0 * motion.angles
            )
            along = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
            every += [drawn[part["at"]] + end * along for end in part["bar"]]
        if part["kind"] == "arc":
            low, high = part["span"]
            for beside in np.linspace(low, high, 9):
                angle = motion.links[part["link"]].angle + beside
                every.append(
                    drawn[part["at"]] + part["radius"] * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
                )
        if part["kind"] in ("roller", "face") and part["rod"] and not part["link"]:
            cos, sin = np.cos(part["angle"]), np.sin(part["angle"])
            every.append(drawn[part["at"]] + np.array([[cos, -sin], [sin, cos]]) @ part["rod"])
    for centre, radius in _cam_reach(machine):
        every += [drawn[centre] + radius, drawn[centre] - radius]
    together = np.concatenate(every)
    return [float(value) for value in (*together.min(axis=0), *together.max(axis=0))]


def _times(machine: Machine, steady: SteadyState | None, angles: Floats) -> tuple[Floats, Floats]:
    if steady is not None:
        # The last angle of a revolution is not the first of the next, which would be back at its time zero.
        cycle = 2 * np.pi * steady.turns
        turn = np.ceil(angles / cycle - 1e-9) - 1
        within = angles - cycle * turn
        time = turn * steady.period + np.interp(within, steady.crank_angle, steady.time)
        return time - time[0], np.interp(within, steady.crank_angle, steady.speed)
    even = np.linspace(0.0, 1.0, len(angles))
    span = float(angles[-1] - angles[0])
    speed = machine.design_speed or span / _DURATION
    return even * span / speed, np.full_like(angles, speed)


def _rounded(values: Floats, fineness: float) -> list[float]:
    """Values rounded to the digits that can be seen."""
    digits = max(0, int(np.ceil(-np.log10(fineness)))) if fineness > 0 else 0
    return [round(float(value), digits) for value in values]
