"""Inertia of the mechanism at each driver, all others held.

The equilibrium of the members says what a driver has to give against a unit force on a mass; by virtual work
that is the velocity of the mass for a unit rate of that driver.
"""

from __future__ import annotations

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kinetostatics.applied import AppliedLoad
from linkwright.kinetostatics.forces import acting, solved
from linkwright.kinetostatics.motion import Motion
from linkwright.kinetostatics.places import Scene
from linkwright.kinetostatics.wrench import Wrenches, masses
from linkwright.machine.machine import Machine

# Angles of the master in a revolution at which the inertia is worked out.
_ANGLES = 180


def driver_inertias(machine: Machine, turns: int) -> dict[str, float]:
    """Mean inertia [kg m²], or mass [kg], at each driver over some revolutions of the master.

    Of a cam it is the inertia at its camshaft.
    """
    # Beside the ends of sections, where nothing is special.
    n = _ANGLES * turns
    angle = 2 * np.pi * turns * (np.arange(n) + 0.37) / n
    scene = Scene(machine, Motion(angle, np.ones(n), np.zeros(n), angle))
    models, _ = acting(scene, {})
    probes: dict[str, Wrenches] = {}
    weights: list[float] = []
    for mass in masses(scene):
        for axis in (0, 1):
            unit = np.zeros((n, 2))
            unit[:, axis] = 1.0
            probes[f"{mass.name} {axis}"] = Wrenches(scene).force(mass.member, unit, mass.centre)
            weights.append(float(mass.mass))
        if mass.inertia:
            probes[f"{mass.name} turning"] = Wrenches(scene).couple(mass.member, np.ones(n))
            weights.append(float(mass.inertia))
    if not probes:
        return {}
    columns = {name: AppliedLoad(wrenches, scene.zeros(n)) for name, wrenches in probes.items()}
    _, solution = solved(scene, models, columns)
    inertias, at = {}, 0
    for model in models:
        if model.kind in ("torque", "force", "contact"):
            rates = solution.x[:, at, :]
            felt: Floats = (rates**2 * np.array(weights)).sum(axis=-1)
            if model.kind == "contact":
                felt = felt * model.unknowns[0].power() ** 2
            inertias[model.name] = float(np.nanmean(felt))
        at += len(model.unknowns)
    return inertias
