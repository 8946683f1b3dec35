"""The analyses of a torsionally flexible driveline with its mechanism."""

from __future__ import annotations

from linkwright.driveline.study import has_elastic_drive
from linkwright.machine.analysis import Analysis, of

ELASTIC = Analysis(
    name="elastic_motion",
    words="Elastic driveline",
    function=of("driveline.elastic_motion:elastic_motion"),
    applies=has_elastic_drive,
    obstacle=of("driveline.study:no_elastic_motion"),
    make=of("driveline.study:made_elastic_motion"),
    warnings=of("driveline.study:elastic_warnings"),
    tangents=of("driveline.tangents:elastic_tangents"),
    check=of("driveline.study:check_driveline"),
    summary=of("driveline.study:driveline_summary"),
    tables=of("driveline.tables:elastic_tables", "elastic_motion"),
    figures=of("driveline.figures:elastic_figures", "elastic_motion"),
    headline=of("driveline.tables:elastic_headline", "elastic_motion"),
    formulas=of("driveline.words:elastic_formulas", "elastic_motion"),
    papers=of("driveline.words:elastic_papers", "elastic_motion"),
    assumptions=of("driveline.words:elastic_assumptions", "machine", "elastic_motion"),
)

RUN_UP = Analysis(
    name="elastic_run_up",
    words="Run-up of the elastic driveline",
    function=of("driveline.run_up:elastic_run_up"),
    applies=has_elastic_drive,
    obstacle=of("driveline.study:no_elastic_run_up"),
    make=of("driveline.study:made_elastic_run_up"),
    tables=of("driveline.tables:run_up_tables", "elastic_run_up"),
    figures=of("driveline.figures_in_time:run_up_figures", "elastic_run_up"),
    headline=of("driveline.tables:run_up_headline", "elastic_run_up"),
    assumptions=of("driveline.words:run_up_assumptions", "elastic_run_up"),
)
