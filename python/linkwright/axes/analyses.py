"""The analyses of servo axes: motion and torque of each, their DC bus, the timing of all cams and axes."""

from __future__ import annotations

from linkwright.axes.study import axis_names, has_axes, has_timing
from linkwright.machine.analysis import Analysis, of

AXIS = Analysis(
    name="axis",
    words="Servo axes",
    lane="fast",
    function=of("axes.axis:servo_axis"),
    applies=has_axes,
    parts=axis_names,
    part="axis",
    mark=of("axes.axis:mark_of"),
    obstacle=of("axes.study:no_axes"),
    make=of("axes.study:made_axes"),
    tangents=of("axes.gradient:axis_tangents"),
    findings=of("axes.study:axis_findings", "*axis"),
    warnings=of("axes.study:axis_warnings", "*axis"),
    check=of("axes.study:check_axes"),
    summary=of("axes.study:axes_summary"),
    tables=of("axes.tables:axis_tables", "*axis"),
    figures=of("axes.figures:axis_figures", "*axis"),
    headline=of("axes.tables:axes_headline", "*axis"),
    assumptions=of("axes.study:axis_assumptions", "machine"),
)

BUS = Analysis(
    name="dc_bus",
    words="DC bus",
    lane="fast",
    function=of("axes.bus:dc_bus"),
    applies=has_axes,
    obstacle=of("axes.study:no_axes"),
    make=of("axes.study:made_bus"),
    tangents=of("axes.gradient:bus_tangents"),
    tables=of("axes.tables:bus_tables", "dc_bus"),
    figures=of("axes.figures:bus_figures", "dc_bus"),
    headline=("power_max",),
)

TIMING = Analysis(
    name="timing",
    words="Timing diagram",
    lane="fast",
    applies=has_timing,
    make=of("axes.study:made_timing"),
    tables=of("axes.tables:timing_tables", "*timing"),
    figures=of("axes.figures:timing_figures", "*timing"),
)
