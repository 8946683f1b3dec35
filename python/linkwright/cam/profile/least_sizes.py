"""How small a cam might be: the smallest base circle for each of its limits, and the largest roller.

Sound profiles, pressure angles and radii of curvature get better as the base circle grows, but for
oscillating followers, whose arm starts from another angle then; so base radii are scanned from small to
large, all at once, and the first that will do is located between its neighbours with exact extremes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Annotated, Any

import numpy as np

from linkwright.cam.core import CamSearch, crossings
from linkwright.cam.model.cam import Cam
from linkwright.cam.model.follower import Sizes, start_of
from linkwright.cam.profile.contact import CamCurve, Contact
from linkwright.cam.profile.profile import CamProfile
from linkwright.kernel.arrays import Floats
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result

# Base radii that are scanned, each some 3 % larger than the one before: from a fiftieth of the size to twenty
# times.
_SCANNED = 240
_FROM, _TO = 0.02, 20.0

# Cam angles per revolution of the scan, and of the exact search.
_COARSE, _FINE = 360, 720

_TURN: Floats = 2 * np.pi / _FINE * np.arange(float(_FINE))

# Halvings that take 3 % to rounding.
_HALVINGS = 46


def base_for_pressure_angle(cam: Cam, contact: Contact, limit: float) -> float | None:
    """The smallest base radius [m] whose pressure angle keeps a limit [rad]; None if there is none."""
    tangent = float(np.tan(limit))

    def spare(contact: Contact) -> float:
        shape = contact.kernel.shape(_FINE)
        both = (shape.greatest["pressure_angle"], shape.least["pressure_angle"])
        return limit - max(abs(side.value) for side in both)

    return _first(cam, contact, lambda cams: tangent - cams.tan_pressure_angle, spare)


def base_for_curvature(cam: Cam, contact: Contact, limit: float) -> float | None:
    """The smallest base radius whose convex parts have at least a radius of curvature.

    ``limit``: minimum radius of curvature of the profile [m] → [m]; None if no base radius will do.
    """
    if not contact.kernel.is_roller:
        return _first(
            cam,
            contact,
            lambda cams: cams.bend_min - limit,
            lambda contact: contact.kernel.shape(_FINE).least["bend"].value - limit,
        )
    size = contact.sizes.roller_radius + limit
    return _first(
        cam,
        contact,
        lambda cams: 1.0 - size * cams.bend_max,
        lambda contact: 1.0 - size * contact.kernel.shape(_FINE).greatest["bend"].value,
    )


def least_sound_base(cam: Cam, contact: Contact) -> float | None:
    """The smallest base radius without undercut [m]."""
    return base_for_curvature(cam, contact, 0.0)


def base_without_crossing(contact: Contact) -> float | None:
    """The smallest base radius from the present one on whose profile does not cross itself [m]."""
    low = high = contact.sizes.base_radius
    while _crosses(contact, high):
        low, high = high, 1.05 * high
        if high > _TO * contact.sizes.base_radius:
            return None
    while high - low > 1e-3 * low:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _crosses(contact, middle) else (low, middle)
    return float(high)


def _crosses(contact: Contact, base: float) -> bool:
    kernel = contact.kernel.with_sizes(contact.sizes._replace(base_radius=base))
    points = CamCurve(replace(contact, kernel=kernel), -contact.sizes.roller_radius).points(_TURN)
    return bool(np.isnan(points).any()) or len(crossings(points).x) > 0


def largest_roller(contact: Contact) -> float | None:
    """Radius of the largest roller without undercut on the pitch curve [m]; None where it is never convex."""
    bend = contact.kernel.shape(_FINE).greatest["bend"].value
    return 1.0 / bend if bend > 0 else None


def _first(
    cam: Cam,
    contact: Contact,
    coarse: Callable[[CamSearch], Floats],
    exact: Callable[[Contact], float],
) -> float | None:
    """Smallest base radius with a margin that is not negative, by a scan and bisection."""
    size = contact.sizes
    scale = max(
        size.base_radius,
        cam.stroke * (size.arm or size.distance or 1.0) if cam.is_oscillating else cam.stroke,
    )
    radii = np.geomspace(_FROM * scale, _TO * scale, _SCANNED)
    with np.errstate(invalid="ignore"):
        margin = coarse(contact.kernel.search(size._replace(base_radius=radii), 1.0, _COARSE))
    sound = np.flatnonzero((margin >= 0) & _is_reached(cam, size._replace(base_radius=radii)))
    if not len(sound):
        return None
    high = float(radii[sound[0]])
    low = float(radii[sound[0] - 1]) if sound[0] else 0.0

    def is_sound(base: float) -> bool:
        if not _is_reached(cam, size._replace(base_radius=base)):
            return False
        kernel = contact.kernel.with_sizes(size._replace(base_radius=base))
        return exact(Contact(contact.name, contact.law, size, kernel, contact.start)) >= 0

    # The scan sees extremes a little too small: the true radius may lie just above.
    while not is_sound(high):
        low, high = high, high * 1.001
        if high > 2 * _TO * scale:
            return None
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if is_sound(middle) else (middle, high)
    # Where any will do, halving ends some 2⁻⁴⁶ above nothing.
    return high if high > 2.0 ** (2 - _HALVINGS) * scale else 0.0


def _is_reached(cam: Cam, size: Sizes) -> Any:
    """Whether the follower has a place on the base circle: a small enough offset, an arm that fits."""
    start = start_of(cam, size)
    # An oscillating follower may start on either side of its zero; NaN is no place.
    return np.isfinite(start) if cam.is_oscillating else start > 0


@dataclass(frozen=True)
class LeastSizes(Result):
    """Sizes of the first contact of a cam, all else being as it is; None where nothing will do."""

    name: Annotated[str, About("The cam's.")]
    base_radius_sound: Annotated[float | None, Label("smallest base radius without undercut", "", "m")]
    base_radius_pressure_angle: Annotated[
        float | None,
        Label("smallest base radius for the pressure angle", "", "m", "That keeps it within its limit."),
    ]
    base_radius_curvature: Annotated[
        float | None,
        Label(
            "smallest base radius for the curvature",
            "",
            "m",
            "That keeps the minimum convex radius of curvature; None without such a limit.",
        ),
    ]
    base_radius_least: Annotated[
        float | None, Label("smallest base radius that keeps all limits", "r₀", "m", "The largest of these.")
    ]
    prime_radius_least: Annotated[
        float | None,
        Label("smallest prime radius that keeps all limits", "", "m", "With the roller's radius."),
    ]
    roller_radius_max: Annotated[
        float | None,
        Label(
            "radius of the largest roller without undercut",
            "",
            "m",
            "On the same pitch curve; None under a flat face.",
        ),
    ]
    pressure_angle_limit: Annotated[float, Label("limit of the pressure angle", "", "rad")]
    curvature_limit: Annotated[float | None, Label("minimum convex radius of curvature allowed", "", "m")]


@public
def least_sizes(profile: CamProfile) -> LeastSizes:
    """Minimum dimensions of a cam.

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
    sizes = [size for size in wanted if size is not None]
    least = max(sizes) if len(sizes) == len(wanted) else None
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
