"""The analyses of a drive: motion over the cycle, reduction, steady motion, run-up and run-down."""

from __future__ import annotations

from operator import attrgetter

from linkwright.machine.analysis import Analysis, of

MOTION = Analysis(
    name="motion",
    words="Motion",
    lane="fast",
    applies=attrgetter("has_crank"),
    make=of("drive.study:made_motion"),
    tables=of("drive.tables_of_cycle:cycle_tables", "motion", "linkage"),
    figures=of("drive.figures_of_cycle:cycle_figures", "motion", "linkage"),
    is_motion=True,
)

CYCLE = Analysis(
    name="cycle_motion",
    function=of("drive.cycle_motion:cycle_motion"),
    applies=attrgetter("has_crank"),
    is_of_study=False,
)

REDUCTION = Analysis(
    name="reduction",
    words="Reduced inertia",
    function=of("drive.reduction:reduction"),
    applies=attrgetter("has_crank"),
    obstacle=of("drive.obstacles:no_mass"),
    make=of("drive.study:made_reduction"),
    check=of("drive.study:check_drive"),
    summary=of("drive.study:drive_summary"),
    tables=of("drive.tables:drive_tables"),
    details=of("drive.tables:numerical_tables"),
    figures=of("drive.figures:drive_figures"),
    headline=of("drive.tables:drive_headline"),
    formulas=of("drive.words:drive_formulas"),
    papers=of("drive.words:drive_papers", "machine"),
    assumptions=of("drive.words:drive_assumptions"),
)

CONSTANT_ENERGY = Analysis(
    name="constant_energy",
    function=of("drive.evenness:constant_energy"),
    applies=attrgetter("has_crank"),
    make=of("drive.study:made_constant_energy"),
    tangents=of("drive.gradient_at_constant_energy:constant_energy_tangents"),
)

STEADY = Analysis(
    name="steady_state",
    words="Steady motion",
    lane="fast",
    function=of("drive.steady_state:steady_state"),
    applies=attrgetter("has_crank"),
    obstacle=of("drive.obstacles:no_motor"),
    make=of("drive.study:made_steady_state"),
    warnings=of("drive.warnings:drive_warnings", "machine", "reduction", "?steady_state"),
    tangents=of("drive.gradient:steady_derivatives"),
)

STEP_METHOD = Analysis(
    name="step_method", applies=attrgetter("has_crank"), make=of("drive.study:made_step_method")
)

RUN_UP = Analysis(
    name="run_up",
    words="Run-up",
    function=of("drive.run_up:run_up"),
    applies=attrgetter("has_crank"),
    obstacle=of("drive.obstacles:no_run_up"),
    make=of("drive.study:made_run_up"),
    tangents=of("drive.gradient_in_time:run_up_tangents"),
)

RUN_DOWN = Analysis(
    name="run_down",
    words="Run-down",
    function=of("drive.run_up:run_down"),
    applies=attrgetter("has_crank"),
    obstacle=of("drive.obstacles:no_run_down"),
    make=of("drive.study:made_run_down"),
    tangents=of("drive.gradient_in_time:run_down_tangents"),
)
