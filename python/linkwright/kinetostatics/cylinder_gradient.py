"""Derivatives of the largest forces, pressures, lengths and powers of a cylinder by entries of its machine.

They are those at the angle of each extreme (envelope theorem), of the equilibrium and of the motion.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from linkwright.kernel.numerics.tangent import Tangent, lifted
from linkwright.kinetostatics.cylinder import cylinder_force, force_of, pressures_of
from linkwright.kinetostatics.gradient import drives_along, tied
from linkwright.machine.machine import Machine
from linkwright.machine.tangents import Derivatives

# How far beside a kink the place of an extreme may be found [rad].
_NEAR = 1e-5


def cylinder_tangents(machine: Machine, name: str, variables: Sequence[str]) -> Derivatives:
    """Scalars of a cylinder by some entries. Raises what `cylinder_force` raises."""
    known = cylinder_force(machine, name)
    curves: dict[str, Any] = {"length_max": known.length, "length_min": -known.length}
    curves |= {"force_max": known.force, "force_min": -known.force}
    curves |= {"velocity_max": np.abs(known.velocity), "power_max": np.abs(known.power)}
    if known.pressure_bore is not None and known.pressure_rod is not None:
        curves["pressure_max"] = np.maximum(known.pressure_bore, known.pressure_rod)
    places = {key: int(np.nanargmax(curve)) for key, curve in curves.items()}
    angles = np.unique(known.crank_angle[list(places.values())])
    program, scene, drives, _, lost, kinks = drives_along(machine, variables, angles)
    cylinder, slide = scene.machine.mechanism.cylinders[name], scene.kinematics.slides[name]
    velocity = slide.d1 * scene.motion.speed
    force = drives[name] if cylinder.drives else force_of(cylinder, slide.position, velocity)
    followed = {"length": slide.position, "velocity": velocity, "force": force, "power": force * velocity}
    tangents, ties, missing = {}, {}, {}
    for key, place in places.items():
        angle, row = float(known.crank_angle[place]), int(np.searchsorted(angles, known.crank_angle[place]))
        quantity = key.rsplit("_", 1)[0]
        if not np.any(curves[key]):
            missing[key] = "it is zero within rounding error"
            continue
        if quantity == "pressure":
            bore, rod = pressures_of(cylinder, lifted(force, len(program.variables))[row : row + 1])
            assert known.pressure_bore is not None
            side = bore if known.pressure_bore[place] == curves[key][place] else rod
            slope = lifted(side, len(program.variables)).d[0]
        else:
            slope = lifted(followed[quantity], len(program.variables)).d[row]
        moving = kinks.moved_at(angle, _NEAR)
        tangents[key] = Tangent(float(getattr(known, key)), np.where(moving, np.nan, slope))
        words = [
            tied(curves[key], place, known.crank_angle),
            kinks.words(angle, moving) if moving.any() else "",
        ]
        if any(words):
            ties[key] = "; ".join(filter(None, words))
    if {"length_min", "length_max"} <= set(tangents):
        tangents["stroke"] = tangents["length_max"] - tangents["length_min"]
    return Derivatives(program.variables, tangents, ties, missing, program.refused, lost)
