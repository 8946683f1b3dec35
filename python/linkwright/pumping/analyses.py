"""The analyses of a beam pumping unit and of the rotator of its rod string."""

from __future__ import annotations

from linkwright.machine.analysis import Analysis, of

UNIT = Analysis(
    name="pumping_unit",
    words="Pumping unit",
    function=of("pumping.unit:pumping_unit"),
    options={"n": 1440},
    applies=lambda machine: machine.pumping_unit is not None,
    findings=of("pumping.warnings:unit_findings", "pumping_unit"),
    warnings=of("pumping.warnings:unit_warnings", "pumping_unit"),
    tangents=of("pumping.gradient:pumping_tangents"),
    check=of("pumping.check:check_unit"),
    tables=of("pumping.tables:unit_tables", "?pumping_unit", "?rod_rotator"),
    figures=of("pumping.figures:unit_figures", "?pumping_unit", "?rod_rotator"),
)

GEARBOX = Analysis(
    name="gear_torque",
    within="pumping_unit.gear",
    applies=lambda machine: machine.pumping_unit is not None,
    headline=("gear_load",),
)

ROTATOR = Analysis(
    name="rod_rotator",
    formerly="rotator",
    function=of("pumping.rod_rotator:rod_rotator"),
    options={"n": 1440},
    applies=lambda machine: machine.rod_rotator is not None,
    warnings=of("pumping.warnings:rotator_warnings", "machine", "rod_rotator"),
    tangents=of("pumping.rotator_gradient:rotator_tangents"),
    check=of("pumping.check:check_rotator"),
)
