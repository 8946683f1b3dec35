r"""Derivatives of the largest normal force and contact pressure of a cam by entries of its machine.

The force is that of the equilibrium (`linkwright.kinetostatics.gradient`), the pressure by Hertz

.. math:: p_0 = \sqrt{\frac{|N|\,\kappa\,E^*}{\pi b}}, \qquad \kappa = \frac1{R_1} + \frac1{R_2}

with N, the curvature of the profile and the material in arrays with derivatives, at the angle of the extreme
(envelope theorem).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from linkwright.cam.dynamics.hertz import SHEAR_MAX
from linkwright.cam.dynamics.loaded import LoadedCam, loaded_cam
from linkwright.cam.profile.contact import contacts
from linkwright.cam.profile.profile import CamProfile, cam_profile
from linkwright.kernel.arrays import Floats
from linkwright.kernel.numerics.tangent import Tangent
from linkwright.kernel.numerics.tangent_array import lifted, primal, variables_of
from linkwright.kinetostatics.gradient import drives_along, tied
from linkwright.machine.machine import Machine
from linkwright.machine.tangents import Derivatives, columns

# How far beside a joint the place of an extreme may be found that is reached on a side of it [rad].
_NEAR = 1e-5

_PLACES = {
    "force_max": "force_max_angle",
    "force_min": "force_min_angle",
    "pressure_max": "pressure_max_angle",
}


def cam_force_tangents(machine: Machine, name: str, variables: Sequence[str]) -> Derivatives:
    """Scalars of a loaded cam by some entries. Raises what `loaded_cam` raises."""
    profile = cam_profile(machine, name)
    loaded = loaded_cam(machine, profile)
    places = {key: at for key, of in _PLACES.items() if (at := getattr(loaded, of)) is not None}
    angles = np.unique(list(places.values()))
    program, _, drives, lost, kinks = drives_along(machine, variables, angles)
    force = lifted(drives[name], len(program.variables))
    at = {key: int(np.searchsorted(angles, x)) for key, x in places.items()}
    slopes = {key: force.d[row] for key, row in at.items()}
    refused = dict(program.refused)
    if "pressure_max" in at:
        load = Tangent(float(force.value[at["pressure_max"]]), slopes["pressure_max"])
        slopes["pressure_max"] = _of_pressure(machine, profile, loaded, program.variables, load, refused)
        slopes["shear_max"] = SHEAR_MAX * slopes["pressure_max"]
        places["shear_max"] = places["pressure_max"]
    tangents, ties = {}, {}
    for key, slope in slopes.items():
        moving = kinks.moved_at(places[key], _NEAR)
        tangents[key] = Tangent(float(getattr(loaded, key)), np.where(moving, np.nan, slope))
        words = [_tied(loaded, key), kinks.words(places[key], moving) if moving.any() else ""]
        if any(words):
            ties[key] = "; ".join(filter(None, words))
    derivatives = Derivatives(program.variables, tangents, ties, {}, refused, lost)
    return derivatives.only([entry for entry in program.variables if entry not in refused])


def _of_pressure(
    machine: Machine,
    profile: CamProfile,
    loaded: LoadedCam,
    variables: Sequence[str],
    load: Tangent,
    refused: dict[str, str],
) -> Floats:
    """Derivatives of the largest pressure, where the force is `load`; zero by entries that are refused."""
    assert loaded.pressure_max is not None
    pushes = load.value >= 0 or profile.cam.closure == "spring"
    contact = (0, 1.0) if pushes else (0, -1.0) if len(profile.flanks) == 1 else (1, 1.0)
    own = [entry for entry in variables if entry.startswith("mechanism.")]

    def numbers(along: Machine) -> list[Any]:
        cam = along.mechanism.cams[profile.name]
        return [*_curvatures(along, loaded, *contact), cam.width, cam.elastic_modulus, cam.poisson_ratio]

    by_entry = columns(machine, own, numbers, refused)
    values = [float(primal(number)) for number in numbers(machine)]
    still = np.zeros(len(values))
    table = np.array([by_entry.get(entry, still) for entry in variables]).reshape(len(variables), len(values))
    kappa, width, modulus, poisson = (Tangent(x, d) for x, d in zip(values, table.T, strict=True))
    pressure = (abs(load) * kappa * modulus / (2 * np.pi * width * (1 - poisson * poisson))) ** 0.5
    return np.asarray(pressure.d)


def _curvatures(along: Machine, loaded: LoadedCam, nth: int, flank: float) -> list[Any]:
    """1/R₁ + 1/R₂ of a contact where the pressure is largest; `flank`: −1 of the outer one of a groove."""
    cam = along.mechanism.cams[loaded.name]
    contact = contacts(cam, along.mechanism.fixed_points(), loaded.name)[nth]
    assert loaded.pressure_max_angle is not None
    cam_angle: Any = np.mod(loaded.pressure_max_angle - cam.phase, 2 * np.pi)
    place = np.array([cam_angle], dtype=object)
    n = variables_of((*place, *contact.sizes)) or contact.law.variables
    bend: Any = contact.kernel.rows(lifted(place, n) if n else place.astype(float))["bend"][0]
    bend = bend.number() if n else float(bend)
    if not contact.kernel.is_roller:
        return [1.0 / bend]
    roller = contact.sizes.roller_radius
    return [flank * (1.0 / (1.0 / bend - flank * roller) + flank / roller)]


def _tied(loaded: LoadedCam, key: str) -> str:
    """Where the force or pressure is as large as at its extreme; empty if nowhere."""
    curve = {"force_max": loaded.force, "force_min": -loaded.force}.get(key, loaded.pressure)
    assert curve is not None
    return tied(curve, int(np.nanargmax(curve)), loaded.crank_angle)
