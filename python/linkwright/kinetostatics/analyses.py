"""The analyses of forces in a machine."""

from __future__ import annotations

from operator import attrgetter

from linkwright.machine.analysis import Analysis, of

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

CONTACT_LOSSES = Analysis(
    name="contact_losses",
    applies=attrgetter("has_crank"),
    make=of("kinetostatics.study:look_for_losses"),
)
