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
from linkwright.linkages.kinematics import rows_along
from linkwright.machine.machine import Machine
from linkwright.machine.tangents import Derivatives, directions, followed, scalars_of
from linkwright.pumping.gear_gradient import gear_scalars, without_derivatives
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
    along = RodAlong.of_unit(rod, unit, program.values[:, at])
    scalars = _scalars(rod, along, result)
    listed = tuple(name for name in variables if name not in refused)
    tangents = scalars_of(result, scalars, known, listed)
    gear, ties = gear_scalars(rod, along, result.gear)
    tangents |= {f"gear.{name}": x for name, x in scalars_of(result.gear, gear, known, listed).items()}
    missing = {f"gear.{name}": why for name, why in without_derivatives(result.gear).items()}
    return Derivatives(listed, tangents | _at_speed(result, tangents, listed), ties, missing, refused)


def _ends_known(machine: Machine) -> PumpingUnit:
    """The unit with tangents; raises where an entry cannot be followed to the ends of the stroke."""
    unit = machine.pumping_unit
    assert unit is not None
    end_angles(unit)
    return unit


@dataclass(frozen=True)
class RodAlong(PolishedRod):
    """The polished rod with derivatives by directions of the program's numbers."""

    values: Floats  # (parameters, k)

    @classmethod
    def of_unit(cls, rod: PolishedRod, unit: PumpingUnit, values: Floats) -> RodAlong:
        """The polished rod of a unit with tangents."""
        return cls(rod.machine, rod.compiled, unit, rod.stroke, rod.bottom, rod.top, values)

    def beam(self, angles: Floats) -> Any:
        """The motion of the beam at fixed crank angles."""
        rows = rows_along(self.compiled, angles, [("links", BEAM_LINK)], self.values)
        return Tangent(super().beam(angles), rows)


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
