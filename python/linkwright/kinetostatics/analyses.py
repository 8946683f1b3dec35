"""The analyses of forces in a machine."""

from __future__ import annotations

from operator import attrgetter

from linkwright.machine.analysis import Analysis, of
from linkwright.machine.machine import Machine

FORCES = Analysis(
    name="forces",
    words="Forces",
    lane="fast",
    function=of("kinetostatics.forces:forces"),
    applies=attrgetter("has_crank"),
    obstacle=of("drive.obstacles:no_forces"),
    make=of("kinetostatics.study:made_forces"),
    tangents=of("kinetostatics.gradient:force_tangents"),
    summary=of("kinetostatics.study:loads_summary"),
    tables=of("kinetostatics.tables:envelope_tables", "forces"),
    figures=of("kinetostatics.figures:captioned_forces", "forces"),
    headline=of("kinetostatics.tables:forces_headline", "forces"),
    assumptions=of("kinetostatics.words:load_assumptions", "machine"),
)


def _cylinders(machine: Machine) -> tuple[str, ...]:
    return tuple(machine.mechanism.cylinders)


def _has_cylinders(machine: Machine) -> bool:
    return bool(machine.mechanism.cylinders)


CYLINDER = Analysis(
    name="cylinder",
    words="Cylinders",
    function=of("kinetostatics.cylinder:cylinder_force"),
    applies=_has_cylinders,
    parts=_cylinders,
    part="cylinder",
    make=of("kinetostatics.cylinder:made_cylinders"),
    warnings=of("kinetostatics.cylinder:cylinder_warnings", "machine"),
    tangents=of("kinetostatics.cylinder_gradient:cylinder_tangents"),
    check=of("kinetostatics.cylinder:check_cylinders"),
    tables=of("kinetostatics.cylinder_report:cylinder_tables", "*cylinder"),
    figures=of("kinetostatics.cylinder_report:cylinder_figures", "*cylinder"),
    headline=of("kinetostatics.cylinder_report:cylinder_headline", "*cylinder"),
)

CONTACT_LOSSES = Analysis(
    name="contact_losses",
    applies=attrgetter("has_crank"),
    make=of("kinetostatics.study:look_for_losses"),
)
