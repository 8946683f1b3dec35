"""How small a cam might be: the smallest base circle for each of its limits, and the largest roller."""

from __future__ import annotations

from dataclasses import dataclass

from linkwright.cam.profile.least_base import (
    base_for_curvature,
    base_for_pressure_angle,
    largest_roller,
    least_sound_base,
)
from linkwright.cam.profile.profile import CamProfile
from linkwright.kernel.public import public
from linkwright.kernel.result import Result


@dataclass(frozen=True)
class LeastSizes(Result):
    """Sizes of the first contact of a cam, all else being as it is; None where nothing will do.

    Attributes
    ----------
    name : str
        The cam's.
    base_radius_sound : float
        Smallest base radius without undercut [m].
    base_radius_pressure_angle : float
        Smallest base radius that keeps the pressure angle within its limit [m].
    base_radius_curvature : float
        Smallest base radius that keeps the least convex radius of curvature [m]; None without such a limit.
    base_radius_least : float
        The largest of these: the smallest base radius that keeps all limits [m].
    prime_radius_least : float
        With the roller's radius [m].
    roller_radius_max : float
        Radius of the largest roller on the same pitch curve without undercut [m]; None under a flat face.
    pressure_angle_limit : float
        The limit [rad].
    curvature_limit : float or None
        Least convex radius of curvature allowed [m].
    """

    name: str
    base_radius_sound: float | None
    base_radius_pressure_angle: float | None
    base_radius_curvature: float | None
    base_radius_least: float | None
    prime_radius_least: float | None
    roller_radius_max: float | None
    pressure_angle_limit: float
    curvature_limit: float | None


@public
def least_sizes(profile: CamProfile) -> LeastSizes:
    """The smallest sizes of a cam.

    Parameters
    ----------
    profile : CamProfile
        The cam as it is.

    Returns
    -------
    LeastSizes
        For its first contact.
    """
    cam, contact = profile.cam, profile.flanks[0].contact
    sound = least_sound_base(cam, contact)
    gentle = base_for_pressure_angle(cam, contact, cam.limit)
    smooth = None if cam.curvature_limit is None else base_for_curvature(cam, contact, cam.curvature_limit)
    wanted = [sound, gentle, *(() if cam.curvature_limit is None else (smooth,))]
    found = [each for each in wanted if each is not None]
    least = max(found) if len(found) == len(wanted) else None
    return LeastSizes(
        profile.name,
        sound,
        gentle,
        smooth,
        least,
        None if least is None else least + contact.sizes.roller_radius,
        largest_roller(contact) if cam.is_roller else None,
        cam.limit,
        cam.curvature_limit,
    )
