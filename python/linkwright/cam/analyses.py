"""The analyses of cams: profile, smallest sizes, force, vibration of the follower."""

from __future__ import annotations

from linkwright.machine.analysis import Analysis, of
from linkwright.machine.machine import Machine


def _cams(machine: Machine) -> tuple[str, ...]:
    return tuple(machine.mechanism.cams)


def _has_cams(machine: Machine) -> bool:
    return bool(machine.mechanism.cams)


CAM = Analysis(
    name="cam",
    words="Cams",
    function=of("cam.profile.profile:cam_profile"),
    applies=_has_cams,
    parts=_cams,
    part="cam",
    make=of("cam.study:made_cams"),
    warnings=of("cam.study:cam_warnings", "*cam"),
    tangents=of("cam.gradient:cam_tangents"),
    check=of("cam.study:check_cams"),
    tables=of("cam.tables:cam_tables", "*cam", "*cam_sizes", "*cam_force"),
    figures=of("cam.figures.captions:cam_figures", "*cam", "*cam_force"),
    headline=("stroke", "acceleration_max", "pressure_angle_max", "curvature_radius_min"),
)

SIZES = Analysis(name="cam_sizes", applies=_has_cams, parts=_cams, make=of("cam.study:made_sizes"))

CHECK = Analysis(
    name="cam_check", function=of("cam.profile.check:cam_check"), applies=_has_cams, is_of_study=False
)

FORCE = Analysis(
    name="cam_force",
    function=of("cam.dynamics.loaded:cam_force"),
    applies=_has_cams,
    parts=_cams,
    part="cam",
    make=of("cam.study:made_forces"),
    headline=("force_min", "force_max", "speed_lost"),
    tangents=of("cam.dynamics.gradient:cam_force_tangents"),
)

VIBRATION = Analysis(
    name="cam_vibration", applies=_has_cams, parts=_cams, make=of("cam.study:made_vibrations")
)
