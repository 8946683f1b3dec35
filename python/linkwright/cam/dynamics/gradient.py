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

from linkwright.cam.dynamics.hertz import SHEAR_MAX, compliance, peak_pressure
from linkwright.cam.dynamics.loaded import LoadedCam, loaded_cam, outer_radii, radii
from linkwright.cam.profile.contact import contacts
from linkwright.cam.profile.profile import CamProfile, cam_profile
from linkwright.kernel.arrays import Floats
from linkwright.kernel.numerics.tangent import Tangent, lifted
from linkwright.kinetostatics.gradient import drives_along, tied
from linkwright.machine.machine import Machine
from linkwright.machine.tangents import Derivatives, followed, spread

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
    program, _, drives, _, lost, kinks = drives_along(machine, variables, angles)
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
        moving, value = kinks.moved_at(places[key], _NEAR), float(getattr(loaded, key))
        tangents[key], why = kinks.extreme(value, slope, places[key], moving)
        if words := "; ".join(filter(None, (_tied(loaded, key), why))):
            ties[key] = words
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
    pushes, is_groove = load.value >= 0 or profile.cam.closure == "spring", len(profile.flanks) == 1
    radii_of = outer_radii if is_groove and not pushes else radii

    def numbers(along: Machine) -> list[Any]:
        """1/R₁ + 1/R₂, width and compliance of the contact that carries the largest pressure."""
        cam: Any = along.mechanism.cams[profile.name]
        contact = contacts(cam, along.mechanism.fixed_points(), profile.name)[not (pushes or is_groove)]
        rows = contact.kernel.rows(np.mod(loaded.pressure_max_angle - cam.phase, 2 * np.pi))
        curvature = sum(1.0 / radius for radius in radii_of(contact, rows))
        return [curvature[0], cam.width, 2 * compliance(cam.elastic_modulus, cam.poisson_ratio)]

    own = [entry for entry in variables if entry.startswith("mechanism.")]
    known, of_contact = followed(machine, own, numbers, refused)
    curvature, width, both = (spread(number, known, variables) for number in of_contact)
    pressure: Any = peak_pressure(abs(load) / width, curvature, both)
    return np.asarray(pressure.d)


def _tied(loaded: LoadedCam, key: str) -> str:
    """Where the force or pressure is as large as at its extreme; empty if nowhere."""
    curve = {"force_max": loaded.force, "force_min": -loaded.force}.get(key, loaded.pressure)
    assert curve is not None
    return tied(curve, int(np.nanargmax(curve)), loaded.crank_angle)
