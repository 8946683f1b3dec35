"""How small a cam might be: the smallest base circle for each of its limits, and the largest roller."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from linkwright.cam.profile.least_base import (
    base_for_curvature,
    base_for_pressure_angle,
    largest_roller,
    least_sound_base,
)
from linkwright.cam.profile.profile import CamProfile
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Shown
from linkwright.kernel.result import Result


@dataclass(frozen=True)
class LeastSizes(Result):
    """Sizes of the first contact of a cam, all else being as it is; None where nothing will do."""

    name: Annotated[str, About("The cam's.")]
    base_radius_sound: Annotated[float | None, Shown("smallest base radius without undercut", "", "m")]
    base_radius_pressure_angle: Annotated[
        float | None,
        Shown("smallest base radius for the pressure angle", "", "m", "That keeps it within its limit."),
    ]
    base_radius_curvature: Annotated[
        float | None,
        Shown(
            "smallest base radius for the curvature",
            "",
            "m",
            "That keeps the minimum convex radius of curvature; None without such a limit.",
        ),
    ]
    base_radius_least: Annotated[
        float | None, Shown("smallest base radius that keeps all limits", "r₀", "m", "The largest of these.")
    ]
    prime_radius_least: Annotated[
        float | None,
        Shown("smallest prime radius that keeps all limits", "", "m", "With the roller's radius."),
    ]
    roller_radius_max: Annotated[
        float | None,
        Shown(
            "radius of the largest roller without undercut",
            "",
            "m",
            "On the same pitch curve; None under a flat face.",
        ),
    ]
    pressure_angle_limit: Annotated[float, Shown("limit of the pressure angle", "", "rad")]
    curvature_limit: Annotated[float | None, Shown("minimum convex radius of curvature allowed", "", "m")]


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
