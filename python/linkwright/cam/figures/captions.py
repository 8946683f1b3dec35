"""The figures of cams with their captions."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from linkwright.cam.dynamics.loaded import LoadedCam
from linkwright.cam.figures.cam import (
    cam_figure,
    cam_force_figure,
    curvature_figure,
    lift_figure,
    pressure_angle_figure,
)
from linkwright.cam.profile.profile import CamProfile
from linkwright.kernel.figure.style import CaptionedFigure
from linkwright.kernel.reader.numbers import degrees, quantity


def cam_figures(cams: Sequence[CamProfile], loaded: Sequence[LoadedCam] = ()) -> Iterator[CaptionedFigure]:
    """The figures of all cams."""
    loads = {cam.name: cam for cam in loaded}
    for profile in cams:
        name = profile.name
        yield CaptionedFigure(f"cam_{name}", f"Cam {name}", _cam_words(profile), cam_figure(profile))
        yield CaptionedFigure(
            f"cam_{name}_lift", f"Motion by cam {name}", _lift_words(profile), lift_figure(profile)
        )
        words = (
            f"The maximum pressure angle is {degrees(profile.pressure_angle_max)}; the limit is "
            f"{degrees(profile.cam.limit)}. Dotted: segment boundaries."
        )
        figure = pressure_angle_figure(profile)
        yield CaptionedFigure(f"cam_{name}_pressure_angle", f"Pressure angle of cam {name}", words, figure)
        figure, words = curvature_figure(profile), _curvature_words(profile)
        yield CaptionedFigure(f"cam_{name}_curvature", f"Curvature of cam {name}", words, figure)
        if name in loads:
            words = f"The peak contact force is {quantity(loads[name].force_size, 'N')}."
            if loads[name].side_changes:
                words += " Where the force is negative, the other side is in contact."
            figure = cam_force_figure(loads[name])
            yield CaptionedFigure(f"cam_{name}_force", f"Contact force of cam {name}", words, figure)


def _cam_words(profile: CamProfile) -> str:
    words = "Position at the start of the programme, θ = 0, seen along the line to the follower's guide "
    words += "or pivot. "
    words += f"Base circle {_mm(profile.base_radius)}"
    if profile.prime_radius > profile.base_radius:
        words += f", prime circle {_mm(profile.prime_radius)}"
    if profile.diameter_min is not None and profile.diameter_max is not None:
        words += f"; its diameter lies between {_mm(profile.diameter_min)} and {_mm(profile.diameter_max)}"
    return words + "."


def _lift_words(profile: CamProfile) -> str:
    swings = profile.cam.is_oscillating
    reach = degrees(profile.stroke) if swings else _mm(profile.stroke)
    names = ("lift", "velocity", "acceleration", "jerk")
    jumps = {
        name: [
            joint.angle
            for joint in profile.cam.programme.joints
            if order < len(joint.jumps) and joint.order == order - 1
        ]
        for order, name in enumerate(names)
    }
    sentences = [
        f"the {name} jumps at θ = {', '.join(degrees(angle) for angle in angles)}"
        for name, angles in jumps.items()
        if angles
    ]
    verb = "swings" if swings else "rises"
    return f"The follower {verb} by {reach}; derivatives are by the cam angle θ. " + (
        f"At segment boundaries (dotted), {'; '.join(sentences)}."
        if sentences
        else "It is continuous up to the jerk."
    )


def _curvature_words(profile: CamProfile) -> str:
    parts = [
        f"{word} parts {_mm(value)}"
        for word, value in (
            ("convex", profile.curvature_radius_convex_min),
            ("concave", profile.curvature_radius_concave_min),
        )
        if value is not None and math.isfinite(value)
    ]
    words = f"Minimum radius of curvature of the profile: {', '.join(parts)}. Positive where convex."
    if profile.cam.curvature_limit is not None:
        words += f" The limit of the convex radius is {_mm(profile.cam.curvature_limit)}."
    if profile.cam.cutter_radius is not None:
        words += f" The cutter has a radius of {_mm(profile.cam.cutter_radius)}."
    return words


def _mm(value: float) -> str:
    return quantity(value, "m", usual="mm")
