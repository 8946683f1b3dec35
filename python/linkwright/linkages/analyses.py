"""The analyses of a linkage: extreme positions, and its motion over the cycle."""

from __future__ import annotations

from operator import attrgetter

from linkwright.machine.analysis import Analysis, of

LINKAGE = Analysis(
    name="linkage",
    words="Extreme positions",
    function=of("linkages.cycle:linkage"),
    applies=attrgetter("has_crank"),
    make=of("linkages.study:made_linkage"),
    tangents=of("linkages.gradient:linkage_tangents"),
    summary=of("linkages.study:mechanism_summary"),
    tables=of("linkages.tables:motion_tables", "linkage"),
    details=of("linkages.tables:loop_tables", "linkage"),
    figures=of("linkages.figures:linkage_figures", "machine", "linkage"),
    headline=of("linkages.tables:linkage_headline", "linkage"),
    is_motion=True,
)
