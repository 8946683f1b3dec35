"""The analyses of a topper: its knife over one head, and over a field."""

from __future__ import annotations

from linkwright.machine.analysis import Analysis, of
from linkwright.machine.machine import Machine


def _has_topper(machine: Machine) -> bool:
    return machine.topper is not None


TOPPER = Analysis(
    name="topper",
    words="Topper",
    function=of("topping.topper:topper"),
    applies=_has_topper,
    findings=of("topping.warnings:topper_findings", "machine.topper", "topper"),
    warnings=of("topping.warnings:topper_warnings", "machine.topper", "topper"),
    tangents=of("topping.gradient:topper_tangents"),
    check=of("topping.check:check_knife"),
    summary=of("topping.check:topper_summary"),
    tables=of("topping.tables.topper:topper_tables", "machine.topper", "topper"),
    figures=of("topping.figures.captions:topper_figures", "machine", "machine.topper", "topper"),
    headline=of("topping.tables.words:topper_headline", "machine.topper", "topper"),
    formulas=of("topping.tables.words:topper_formulas", "machine.topper", "topper"),
    papers=of("topping.tables.words:topper_papers", "machine.topper"),
    assumptions=of("topping.tables.words:topper_assumptions", "machine.topper"),
    scene=of("topping.scene:topper_scene", "machine", "machine.topper", "topper"),
)

FIELD = Analysis(
    name="topper_field", function=of("topping.field:topper_field"), applies=_has_topper, is_of_study=False
)
