"""Inertia of the mechanism at each driver, all others held.

The equilibrium of the members says what a driver has to give against a unit force on a mass; by virtual work
that is the velocity of the mass for a unit rate of that driver.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.numerics.tangent import moves, numbers, plain, primal
from linkwright.kinetostatics.applied import AppliedLoad
from linkwright.kinetostatics.forces import acting, solved
from linkwright.kinetostatics.motion import Motion
from linkwright.kinetostatics.pairs import PairModel
from linkwright.kinetostatics.places import Scene
from linkwright.kinetostatics.wrench import Wrenches, masses
from linkwright.machine.machine import Machine

# Angles of the master in a revolution at which the inertia is worked out.
_ANGLES = 180


def driver_inertias(machine: Machine, turns: int) -> dict[str, float]:
    """Mean inertia [kg m²], or mass [kg], at each driver over some revolutions of the master.

    Of a cam it is the inertia at its camshaft.
    """
    angle = inertia_angles(turns)
    still = np.zeros_like(angle)
    return inertias_in(Scene(machine, Motion(angle, still + 1.0, still, angle)), unknowns_of)


def inertia_angles(turns: int) -> Floats:
    """Angles of the master at which it is worked out, beside the ends of sections."""
    n = _ANGLES * turns
    return 2 * np.pi * turns * (np.arange(n) + 0.37) / n


def unknowns_of(scene: Scene, models: list[PairModel], columns: Mapping[str, AppliedLoad]) -> Any:
    """Forces of all pairs and drives under each of several loads, (n, unknowns, columns)."""
    return solved(scene, models, columns)[1].x


def inertias_in(
    scene: Scene, unknowns: Callable[[Scene, list[PairModel], Mapping[str, AppliedLoad]], Any]
) -> dict[str, Any]:
    """The same in a scene, in any number; `unknowns`: what solves for forces, as `unknowns_of` does."""
    n = scene.n
    models, _ = acting(scene, {})
    probes: dict[str, Wrenches] = {}
    weights: list[Any] = []
    for mass in masses(scene):
        for axis in (0, 1):
            unit = np.zeros((n, 2))
            unit[:, axis] = 1.0
            probes[f"{mass.name} {axis}"] = Wrenches(scene).force(mass.member, unit, mass.centre)
            weights.append(mass.mass)
        if moves(mass.inertia):
            probes[f"{mass.name} turning"] = Wrenches(scene).couple(mass.member, np.ones(n))
            weights.append(mass.inertia)
    if not probes:
        return {}
    columns = {name: AppliedLoad(wrenches, scene.zeros(n)) for name, wrenches in probes.items()}
    found = unknowns(scene, models, columns)
    inertias, at = {}, 0
    for model in models:
        if model.kind in ("torque", "force", "contact"):
            felt = np.sum(found[:, at, :] ** 2 * numbers(weights), axis=-1)
            if model.kind == "contact":
                felt = felt * model.unknowns[0].power() ** 2
            known = np.isfinite(primal(felt))
            inertias[model.name] = plain(np.sum(felt[known]) / known.sum())
        at += len(model.unknowns)
    return inertias
