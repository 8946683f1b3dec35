"""The analysis of a rod string."""

from __future__ import annotations

from linkwright.machine.analysis import Analysis, of

STRING = Analysis(
    name="rod_string",
    words="Rod string",
    function=of("rods.prediction:rod_string"),
    applies=lambda machine: machine.rod_string is not None,
    obstacle=of("rods.check:no_motion"),
    findings=of("rods.warnings:string_findings", "rod_string"),
    warnings=of("rods.warnings:string_warnings", "machine.rod_string", "rod_string"),
    tangents=of("rods.gradient:string_tangents"),
    check=of("rods.check:check_string"),
    summary=of("rods.check:string_summary"),
    tables=of("rods.tables:string_tables", "rod_string"),
    headline=("load_max", "load_min", "plunger_stroke", "production"),
)
