"""What rollers do on the printed profile, which is made for points, and what two cams do for one.

The centre of a roller runs on the curve at its radius from the profile. Two rollers at a fixed distance need
a curve of centres of constant diameter; the printed profile has the constant diameter itself. So the printed
curve has to be the curve of centres, and the profile that is cut lies a radius inside it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.cam.profile.least_sizes import base_for_pressure_angle, largest_roller
from linkwright.cam.profile.profile import CamProfile, cam_profile
from linkwright.kernel.files.library import library_path
from linkwright.kinetostatics.forces import forces
from linkwright.machine.read import read
from linkwright.papers.paper2.alternatives import design_speed

Floats = NDArray[np.float64]

# Points of the curve of centres, an even number: between them straight lines err by 1e-9 of the radius.
_POINTS = 40_000

# Angles of the revolution at which forces are compared, every quarter of a degree, off the joints of the law.
_ANGLES = 1440


@dataclass(frozen=True)
class Rollers:
    """Rollers on the printed profile, and on a profile inside of it.

    Attributes
    ----------
    radius, largest_in_hollow, largest_inside : float
        Of the rollers looked at; what a roller must stay below that runs on the printed profile, its minimum
        concave radius, and whose centre runs on it, its minimum convex radius [m].
    play, lift_error : float
        By how much the distance of two rollers on the printed profile changes over one revolution, and the
        place of a roller's centre differs from ρ + r at most [m].
    offset : CamProfile
        The cam whose rollers' centres run on the printed curve.
    breadth_for_limit : float
        Minimum b at which the pressure angle keeps the limit of the cam [m].
    """

    radius: float
    largest_in_hollow: float | None
    largest_inside: float | None
    play: float
    lift_error: float
    offset: CamProfile
    breadth_for_limit: float


def rollers(profile: CamProfile, machine: str, radius: float) -> Rollers:
    """Look at rollers of a radius [m] on the cam with points of a machine of the library."""
    cam, contact = profile.cam, profile.flanks[0].contact
    centres = centre_distance(profile, radius)
    half = _POINTS // 2
    apart = centres[:half] + centres[half:]
    printed = np.hypot(*profile.flanks[0].curve().points(_angles()).T)
    place = f"mechanism.cams.{profile.name}"
    offset = read(library_path(machine), {f"{place}.contact": "roller", f"{place}.roller_radius": radius})
    base = base_for_pressure_angle(cam, contact, cam.limit)
    assert base is not None
    return Rollers(
        radius=radius,
        largest_in_hollow=profile.curvature_radius_concave_min,
        largest_inside=largest_roller(contact),
        play=float(np.ptp(apart)),
        lift_error=float(np.abs(centres - printed - radius).max()),
        offset=cam_profile(offset),
        breadth_for_limit=2 * base + cam.stroke,
    )


def centre_distance(profile: CamProfile, radius: float) -> Floats:
    """Distance of a roller's centre from the cam's at equal angles of a revolution [m], on the profile.

    Its radius [m] is below the minimum concave radius of the profile.
    """
    x, y = profile.flanks[0].curve(radius).points(_angles()).T
    # The cam is seen as it stands at the start: the place of contact goes round it backwards.
    polar = np.unwrap(-np.arctan2(y, x))
    distance: Floats = np.interp(_angles(), polar, np.hypot(x, y), period=2 * np.pi)
    return distance


def _angles() -> Floats:
    """Equal angles of a revolution [rad]."""
    return np.linspace(0.0, 2 * np.pi, _POINTS, endpoint=False)


def two_cams(machine: str, cam: str) -> dict[str, float]:
    """Two cams that turn in opposite directions, one on each side of the cart, against one alone.

    Both move the cart in the same way, so each may be computed by itself, and their mean is what two cams
    with half the force each do. Largest forces at the design speed [N]: ``side_force`` of one cam on the
    guide, ``left_over`` of two, ``contact_force`` of one along the normal.
    """
    sides, angles = [], (np.arange(_ANGLES) + 0.5) * (2 * np.pi / _ANGLES)
    for rotation in ("same", "opposite"):
        found = read(library_path(machine), {f"mechanism.cams.{cam}.rotation": rotation})
        acting = forces(found, speed=design_speed(found), angles=angles)
        sides.append(acting.pairs[f"{cam}.guide"].normal)
    return {
        "side_force": float(np.abs(sides[0]).max()),
        "left_over": float(np.abs(0.5 * (sides[0] + sides[1])).max()),
        "contact_force": float(np.abs(acting.drives[cam]).max()),
    }
