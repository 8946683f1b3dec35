r"""What is wrong with a cam: undercut, pointed, crossed, too hollow, not of constant diameter; and what is
doubtful.

| fault | condition |
| --- | --- |
| undercut by the roller | 1 − r κ < 0: the roller is larger than the pitch curve's radius of curvature |
| undercut under a flat face | ρ < 0: the face does not touch the cam there |
| undercut in a groove | 1 + r κ < 0: the outer flank, where the pitch curve is concave |
| arm as fast as the cam | β′ changes its sign: the face turns over the cam |
| locked | d·n ≤ 0: pressure angle of 90° or more |
| crossed | the profile crosses itself where it is nowhere undercut |
| hollow | the cutter is larger than the minimum concave radius, or wider than the groove |
| diameter | two followers do not both touch |

Each is reported with the cam angle, the amount, and the smallest change that mends it. A profile whose radius
is smaller than allowed, or a pressure angle above its limit, is a warning: the cam can be made.

References
----------
.. [1] Norton, Cam Design and Manufacturing Handbook, 2nd ed., sections 7.3 and 7.4.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from linkwright.cam.core import crossings
from linkwright.cam.model.cam import Cam
from linkwright.cam.model.follower import start_of
from linkwright.cam.profile.least_sizes import (
    base_for_curvature,
    base_for_pressure_angle,
    base_without_crossing,
    least_sound_base,
)
from linkwright.cam.profile.profile import CamProfile, Flank
from linkwright.kernel.public import public

# Angles that are named of many.
_NAMED = 6

# A soundness below this is a sharp point, within rounding.
_SHARP = 1e-9


@public
def cam_faults(profile: CamProfile) -> tuple[str, ...]:
    """Faults of a cam that cannot be manufactured or driven, in sentences.

    Parameters
    ----------
    profile : CamProfile
        The cam.

    Returns
    -------
    tuple of str
        Empty for a sound cam.
    """
    faults: list[str] = [*_leaps(profile)]
    for flank in profile.flanks:
        local = [*_locked(profile, flank), *_undercut(profile, flank)]
        faults += local or [*_crossed(profile, flank), *_hollow(profile, flank)]
    return (*faults, *_diameter(profile))


@public
def cam_cautions(profile: CamProfile) -> tuple[str, ...]:
    """Warnings, in sentences.

    Parameters
    ----------
    profile : CamProfile
        The cam.

    Returns
    -------
    tuple of str
        Pressure angle and curvature against their limits; derivatives that jump.
    """
    return (*_steep(profile), *_tight(profile), *_jumps(profile), *_rubs(profile))


def _degrees(angle: float) -> str:
    return f"{np.degrees(angle) % 360:.4g}°"


def _theta(angle: float) -> str:
    """A cam angle θ, counted from the start of the programme, unlike the crank angle φ."""
    return f"cam angle θ = {_degrees(angle)}"


def _mm(length: float) -> str:
    return f"{1e3 * length:.5g} mm"


def _subject(profile: CamProfile, flank: Flank) -> str:
    several = len(profile.flanks) > 1 and flank.contact.name != "cam"
    return f"cam {profile.name}, {flank.contact.name}" if several else f"cam {profile.name}"


def _undercut_range(flank: Flank, worst: float) -> str:
    """Angles between which the soundness is negative; passes downwards begin it."""
    passes = flank.shape.passes[0]
    down, up = passes.angle[passes.sign < 0], passes.angle[passes.sign > 0]
    if not len(down) or not len(up):
        # None of the sampled angles shows it, or all do.
        return (
            "over the whole revolution"
            if (flank.shape.rows["soundness"] < 0).all()
            else f"at {_theta(worst)}"
        )
    ends = [up[np.argmax(up > a)] if (up > a).any() else up[0] for a in down]
    spans = [f"{_degrees(a)} to {_degrees(b)}" for a, b in zip(down, ends, strict=True)]
    return "from cam angle θ = " + ", ".join(spans[:4]) + (", …" if len(spans) > 4 else "")


def _undercut(profile: CamProfile, flank: Flank) -> Iterator[str]:
    shape, size = flank.shape, flank.contact.sizes
    is_roller = flank.contact.kernel.is_roller
    worst = shape.greatest["bend"] if is_roller else shape.least["bend"]
    soundness = 1.0 - size.roller_radius * worst.value if is_roller else worst.value
    if not is_roller and _turns_over(profile.cam, flank):
        yield (
            f"{_subject(profile, flank)}: the follower rotates as fast as the cam, so that its face rolls "
            "on it; use a longer section or a smaller swing"
        )
    elif soundness < _SHARP:
        base = least_sound_base(profile.cam, flank.contact)
        change = _size_for(profile, flank, base, "more than ") or "another law or a smaller lift"
        if is_roller:
            change = f"a roller of less than {_mm(1 / worst.value)} radius, or {change}"
            what = (
                f"the pitch curve's radius of curvature is {_mm(1 / worst.value)} at "
                f"{_theta(worst.angle)}, and the roller's radius {_mm(size.roller_radius)}"
            )
        else:
            what = (
                f"under the flat face its radius of curvature is {_mm(worst.value)} at {_theta(worst.angle)}"
            )
        where = _undercut_range(flank, worst.angle)
        yield f"{_subject(profile, flank)} is undercut {where}: {what}; use {change}"
    hollow = shape.least.get("bend")
    if profile.cam.closure == "groove" and hollow and hollow.value < 0:
        least = -1.0 / hollow.value
        if least <= size.roller_radius:
            yield (
                f"{_subject(profile, flank)}: the outer flank of the groove is undercut at "
                f"{_theta(hollow.angle)}, where the concave radius of the pitch curve is {_mm(least)} "
                f"and the roller radius {_mm(size.roller_radius)}; use a roller of less than {_mm(least)} "
                "radius, or a larger base radius"
            )


def _turns_over(cam: Cam, flank: Flank) -> bool:
    if not cam.is_oscillating:
        return False
    # Seen from the cam the normal turns by −σ − s′ for an arm to the left, by −σ + s′ for one to the right.
    least, greatest = flank.contact.law.extremes(1)
    with_lift = (cam.rotation == "same") == (cam.side == "left")
    return least.value <= -1.0 if with_lift else greatest.value >= 1.0


def _size_for(profile: CamProfile, flank: Flank, base: float | None, more: str = "") -> str:
    """Keys of the file by which a contact has a base radius; empty if there is no such radius."""
    cam, contact = profile.cam, flank.contact
    if base is None:
        return ""
    start = float(start_of(cam, contact.sizes._replace(base_radius=base)))
    if cam.breadth is not None:
        return f"a breadth of {more}{_mm(2 * start + profile.stroke)}"
    if cam.second is None or contact is profile.flanks[0].contact:
        return f"a base radius of {more}{_mm(base)}"
    if cam.is_oscillating:
        angle = (cam.second.angle or 0.0) + start - contact.start
        return f"an angle of {more}{_degrees(angle)} between the arms"
    return f"a distance of {more}{_mm((cam.second.distance or 0.0) + start - contact.start)} of the rollers"


def _locked(profile: CamProfile, flank: Flank) -> Iterator[str]:
    gamma = flank.shape.rows["pressure_angle"]
    worst = int(np.argmax(np.abs(gamma)))
    if not np.isfinite(gamma).all():
        where = _theta(float(flank.shape.angle[int(np.argmin(np.isfinite(gamma)))]))
        yield f"{_subject(profile, flank)}: at {where} the follower is beyond its reach"
    elif abs(gamma[worst]) >= np.pi / 2:
        base = base_for_pressure_angle(profile.cam, flank.contact, profile.cam.limit)
        limit = f" for {np.degrees(profile.cam.limit):.4g}°" if base else ""
        change = _size_for(profile, flank, base) or "a smaller swing"
        yield (
            f"{_subject(profile, flank)} cannot move its follower at "
            f"{_theta(float(flank.shape.angle[worst]))}: the pressure angle is "
            f"{np.degrees(abs(gamma[worst])):.4g}°; use {change}{limit}"
        )


def _crossed(profile: CamProfile, flank: Flank) -> Iterator[str]:
    # Joints stand twice among the angles: a side of no length crosses nothing.
    angle = flank.shape.angle
    keep = np.append(np.diff(angle) > 0, False)
    # A mask as an index takes eight times as long.
    points = flank.profile.compress(keep, axis=0)
    crossed = crossings(points)
    if len(crossed.x):
        sides, x, y = (crossed.first[0], crossed.second[0]), crossed.x[0], crossed.y[0]
        at = [_degrees(float(np.interp(side, np.arange(keep.sum()), angle[keep]))) for side in sides]
        base = base_without_crossing(flank.contact)
        change = _size_for(profile, flank, base) or "longer sections or a smaller lift"
        yield (
            f"the profile of {_subject(profile, flank)} crosses itself: at cam angles "
            f"θ = {at[0]} and {at[1]} it passes the same point, "
            f"({1e3 * x:.4g}, {1e3 * y:.4g}) mm; use {change}"
        )


def _hollow(profile: CamProfile, flank: Flank) -> Iterator[str]:
    cutter, concave = profile.cam.cutter_radius, flank.concave
    roller = flank.contact.sizes.roller_radius
    if profile.cam.closure == "groove":
        # Where the roller passes, a cutter that is no larger passes too.
        if cutter is not None and cutter > roller:
            yield (
                f"{_subject(profile, flank)} cannot be cut with a cutter of {_mm(cutter)} radius: its groove "
                f"is as wide as the roller of {_mm(roller)} radius; use a cutter of at most that radius"
            )
    elif cutter is not None and concave is not None and cutter >= concave.value:
        yield (
            f"{_subject(profile, flank)} cannot be cut with a cutter of {_mm(cutter)} radius: at "
            f"{_theta(concave.angle)} the concave radius of the profile is {_mm(concave.value)}; use a "
            "smaller cutter"
        )


def _diameter(profile: CamProfile) -> Iterator[str]:
    both = profile.opposite
    if both is None or both.is_constant:
        return
    worst = max((both.least, both.greatest), key=lambda extreme: abs(extreme.value - both.breadth))
    apart = worst.value - both.breadth
    what = "too thick" if apart > 0 else "too thin"
    yield (
        f"cam {profile.name} is not of constant {profile.cam.closure.removeprefix('constant_')}: at "
        f"{_theta(worst.angle)} it is {_mm(abs(apart))} {what} for followers "
        f"{_mm(both.breadth)} apart; the second half revolution of the motion must mirror the first, "
        "s(θ + 180°) = h − s(θ), or one follower held by a spring"
    )


def _steep(profile: CamProfile) -> Iterator[str]:
    limit = profile.cam.limit
    if profile.pressure_angle_max <= limit:
        return
    flank = max(profile.flanks, key=lambda extreme: abs(extreme.steepest.value))
    base = base_for_pressure_angle(profile.cam, flank.contact, limit)
    size = _size_for(profile, flank, base)
    remedy = f"use {size}" if size else "no base radius suffices"
    yield (
        f"the pressure angle of {_subject(profile, flank)} reaches "
        f"{np.degrees(profile.pressure_angle_max):.4g}° at {_theta(profile.pressure_angle_max_angle)}, "
        f"above {np.degrees(limit):.4g}°: {remedy}"
    )


def _tight(profile: CamProfile) -> Iterator[str]:
    limit = profile.cam.curvature_limit
    for flank in profile.flanks:
        convex = flank.convex
        if limit is None or convex is None or not 0 <= convex.value < limit:
            continue
        base = base_for_curvature(profile.cam, flank.contact, limit)
        yield (
            f"the profile of {_subject(profile, flank)} has a radius of curvature of {_mm(convex.value)} at "
            f"{_theta(convex.angle)}, below {_mm(limit)}: use "
            f"{_size_for(profile, flank, base) or 'another law or a smaller lift'}"
        )


def _places(angles: list[float]) -> str:
    more = f" and {len(angles) - _NAMED} more" if len(angles) > _NAMED else ""
    return "cam angle θ = " + ", ".join(_degrees(angle) for angle in angles[:_NAMED]) + more


def _jumps(profile: CamProfile) -> Iterator[str]:
    effects = {
        1: ("velocity", "an impact, which the forces here do not include"),
        2: ("acceleration", "a sudden force"),
        3: ("jerk", "by a finite step; acceleration is continuous"),
    }
    for order, (what, effect) in effects.items():
        angles = [joint.angle for joint in profile.cam.motion.joints if joint.order == order - 1]
        if angles:
            colon = " " if order == 3 else ": "
            yield f"the {what} of cam {profile.name} jumps at {_places(angles)}{colon}{effect}"


def _leaps(profile: CamProfile) -> Iterator[str]:
    angles = [joint.angle for joint in profile.cam.motion.joints if joint.order < 0]
    if angles:
        # A lift made for a mass on a spring has the acceleration of the wanted motion in it.
        wanted = "a law with continuous acceleration" if profile.cam.train else "a continuous law"
        yield f"the lift of cam {profile.name} jumps at {_places(angles)}; use {wanted}"


def _rubs(profile: CamProfile) -> Iterator[str]:
    if profile.cam.sliding_friction:
        yield (
            f"the friction of cam {profile.name} is included in the forces and the driving torque, not in "
            "steady motion and run-up"
        )
