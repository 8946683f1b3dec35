"""Derivatives of the geometry of a pumping unit: stroke, torque factors, speed and acceleration of the rod.

The core differentiates the motion of the beam at fixed crank angles, and the formulas of the unit follow in
arrays with derivatives. An extreme has the derivative of the curve at its angle (envelope theorem). The
counterbalance of equal peaks moves so that both stay equal.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.numerics.tangent import Tangent
from linkwright.kernel.numerics.tangent_array import TangentArray, lifted, numbers, primal
from linkwright.linkages.kinematics import rows_along
from linkwright.machine.machine import Machine
from linkwright.machine.tangents import Derivatives, directions, followed
from linkwright.pumping.gear_torque import StrokeLoad, Strokes, stroke_load
from linkwright.pumping.model.unit import BEAM_LINK, PumpingUnit
from linkwright.pumping.unit import PolishedRod, PumpingUnitMotion, end_angles, pumping_unit, turn_extreme

_OWN = "pumping_unit."


def pumping_tangents(machine: Machine, variables: Sequence[str]) -> Derivatives:
    """Scalars of the motion of a pumping unit by some entries. Raises what `pumping_unit` raises."""
    result = pumping_unit(machine, n=8)
    assert machine.pumping_unit is not None
    rod = PolishedRod.of(machine, machine.pumping_unit)
    refused: dict[str, str] = {}
    own = [name for name in variables if name.startswith(_OWN)]
    # The motion of the beam is that of the unit alone, which has no other entries.
    program = directions(rod.machine, own)
    refused.update(program.refused)
    known, unit = followed(machine, program.variables, lambda along: _ends_known(along), refused)
    at = [program.variables.index(name) for name in known]
    scalars = _scalars(rod, _along(rod, unit, program.values[:, at]), result)
    listed = tuple(name for name in variables if name not in refused)

    def tangent(value: float, number: Any) -> Tangent:
        d = dict(zip(known, lifted(number, len(known)).d, strict=True))
        return Tangent(value, np.array([d.get(v, 0.0) for v in listed]))

    tangents = {name: tangent(float(getattr(result, name)), x) for name, x in scalars.items()}
    gear, ties = _gear(rod, _along(rod, unit, program.values[:, at]), result)
    tangents |= {f"gear.{name}": tangent(float(getattr(result.gear, name)), x) for name, x in gear.items()}
    missing = dict.fromkeys(_INTEGRALS, "it is an integral over the revolution") if gear else {}
    return Derivatives(listed, tangents | _at_speed(result, tangents, listed), ties, missing, refused)


# Numbers of the gearbox that are not followed.
_INTEGRALS = (
    *("gear.torque_net_mean", "gear.torque_net_rms", "gear.cyclic_load_factor", "gear.work"),
    *("gear.gear_load", "gear.torque_rated", "gear.load_rated"),
)

# A place this near to a corner of the table of the load, as a share of the stroke, is on it.
_ON_CORNER = 1e-6


def _gear(rod: PolishedRod, along: Any, result: PumpingUnitMotion) -> tuple[dict[str, Any], dict[str, str]]:
    """Peaks of torque and load of the gearbox and its counterbalance; ties by name of the response."""
    load, gear = rod.unit.load, result.gear
    if load is None or gear is None:
        return {}, {}
    is_air = rod.unit.geometry == "air_balanced"
    name = "counterbalance_effect" if is_air else "counterbalance"
    size = float(getattr(gear, name))
    up, down = Strokes(rod.unit, load, rod.motion, (rod.bottom, rod.top)).curves(size)
    places = {
        "torque_net_up": up.extreme(+1)[1],
        "torque_net_down": down.extreme(+1)[1],
        "torque_net_min": min(up.extreme(-1), down.extreme(-1))[1],
        "load_max": max(up.extreme(+1, 1), down.extreme(+1, 1))[1],
    }
    at = {name: _at_place(rod, along, angle) for name, angle in places.items()}
    given = getattr(along.unit.load, name)
    is_sought = given is None or isinstance(given, str)
    balanced = _balanced(at, size) if is_sought else given
    scalars = {name: stroke.net(balanced)[0] for name, stroke in at.items() if name != "load_max"}
    scalars |= {"load_max": at["load_max"].load[0], name: balanced}
    still = "a peak is reached at an end of the stroke, where the table of the load has a corner"
    return scalars, {
        f"gear.{name}": still for name, number in scalars.items() if np.isnan(lifted(number, 1).d).any()
    }


def _at_place(rod: PolishedRod, along: Any, angle: float) -> StrokeLoad:
    """Load and torques at a crank angle, with derivatives; at a corner of the table along with it."""
    place, load = np.array([angle % (2 * np.pi)]), along.unit.load
    motion = along.motion(place)
    corner = _corner(rod, float(place[0]))
    if corner is None:
        return stroke_load(along.unit, load, motion, place)
    travel, factor, bend = motion
    position = travel / along.unit.stroke
    rate = factor.value / rod.stroke
    # The rod is at the same position at another angle; at an end of the stroke it comes there at none.
    is_end = bool(np.abs(rate[0]) < _ON_CORNER)
    moved = TangentArray(place, np.full_like(position.d, np.nan) if is_end else -position.d / rate[:, None])
    heights = load.up if rate[0] > 0 else load.down
    force: Any = lifted(numbers((heights[corner],)), position.d.shape[-1])
    factor = factor + bend.value * (moved - place)
    moment: Any = np.sin(moved + load.phase)
    return StrokeLoad(along.unit, force, factor, moment)


def _balanced(at: dict[str, StrokeLoad], size: float) -> Any:
    """The counterbalance that keeps both peaks equal, on which each torque depends in proportion."""
    up, down = at["torque_net_up"], at["torque_net_down"]
    excess = up.net(size)[0] - down.net(size)[0]
    step = abs(size) or 1.0
    more = up.net(size + step)[0] - down.net(size + step)[0]
    slope = (float(primal(more)) - float(primal(excess))) / step
    return TangentArray(np.float64(size), -np.asarray(excess.d) / slope)


def _corner(rod: PolishedRod, angle: float) -> int | None:
    """The corner of the table over the position that a crank angle is on; angles of a table do not move."""
    load = rod.unit.load
    if load is None or load.position is None:
        return None
    position = float(rod.motion(np.array([angle]))[0][0]) / rod.stroke
    apart = np.abs(np.array(load.position) - position)
    return int(apart.argmin()) if apart.min() < _ON_CORNER else None


def _ends_known(machine: Machine) -> PumpingUnit:
    """The unit with tangents; raises where an entry cannot be followed to the ends of the stroke."""
    unit = machine.pumping_unit
    assert unit is not None
    end_angles(unit)
    return unit


@dataclass(frozen=True)
class _RodAlong(PolishedRod):
    """The polished rod with derivatives by directions of the program's numbers."""

    values: Floats  # (parameters, k)

    def beam(self, angles: Floats) -> Any:
        """The motion of the beam at fixed crank angles."""
        rows = rows_along(self.compiled, angles, [("links", BEAM_LINK)], self.values)
        return TangentArray(super().beam(angles), rows)


def _along(rod: PolishedRod, unit: PumpingUnit, values: Floats) -> _RodAlong:
    """A rod of a unit with tangents."""
    return _RodAlong(rod.machine, rod.compiled, unit, rod.stroke, rod.bottom, rod.top, values)


def _scalars(rod: PolishedRod, along: Any, result: PumpingUnitMotion) -> dict[str, Any]:
    """What depends on the dimensions of the unit alone."""
    bottom, top = end_angles(along.unit)
    up = np.mod(top - bottom, 2 * np.pi)
    scalars = {
        "stroke": along.unit.stroke,
        "bottom_angle": bottom,
        "top_angle": top,
        "upstroke_angle": up,
        "stroke_ratio": up / (2 * np.pi - up),
    }
    places = {
        "torque_factor_max": (1, result.torque_factor_max_angle),
        "torque_factor_min": (1, result.torque_factor_min_angle),
    }
    if result.speed is not None:
        for end, sign in (("max", 1), ("min", -1)):
            places[f"rod_acceleration_{end}"] = (2, turn_extreme(lambda phi: rod.motion(phi)[2], sign)[1])
    for name, (order, angle) in places.items():
        scalars[name] = along.motion(np.array([angle]))[order][0]
    return scalars


def _at_speed(
    result: PumpingUnitMotion, tangents: dict[str, Tangent], listed: Sequence[str]
) -> dict[str, Tangent]:
    """Velocity and acceleration of the rod at the design speed, dS/dθ ω and d²S/dθ² ω²."""
    if result.speed is None:
        return {}
    speed = Tangent(result.speed, np.array([float(name == "drive.speed") for name in listed]))
    at_speed = {}
    for end in ("max", "min"):
        factor, bend = tangents[f"torque_factor_{end}"], tangents[f"rod_acceleration_{end}"]
        at_speed[f"rod_velocity_{end}"] = factor * speed
        at_speed[f"rod_acceleration_{end}"] = Tangent(bend.value / result.speed**2, bend.d) * speed * speed
    return at_speed
