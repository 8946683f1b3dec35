"""The analysis of a turning-moment diagram."""

from __future__ import annotations

from linkwright.machine.analysis import Analysis, of

DIAGRAM = Analysis(
    name="turning_moment",
    words="Turning moments",
    function=of("turning.diagram:turning_moment"),
    applies=lambda machine: machine.turning_moment is not None,
    tangents=of("turning.gradient:turning_tangents"),
    check=of("turning.check:check_diagram"),
    summary=of("turning.check:diagram_summary"),
    tables=of("turning.tables:turning_tables", "turning_moment"),
    figures=of("turning.figures:turning_figures", "turning_moment"),
    headline=of("turning.tables:turning_headline", "turning_moment"),
    formulas=of("turning.tables:turning_formulas", "turning_moment"),
    assumptions=of("turning.tables:turning_assumptions", "machine.turning_moment"),
)
