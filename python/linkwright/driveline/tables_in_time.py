"""Motion in time of an elastic driveline as tables and headline."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.driveline.in_time import ElasticTransient
from linkwright.driveline.run_up import ElasticRunUp
from linkwright.driveline.tables import limits_table
from linkwright.kernel.page.table import Table, part_table, parts_of, rows_in
from linkwright.kernel.reader.numbers import parted

_HEADS = ("quantity", "", "value", "")


def run_up_headline(run_up: ElasticRunUp) -> Iterator[tuple[str, str, str]]:
    """How long it takes, and the peak torque of every shaft."""
    yield "run-up time with the elastic driveline", *parted(run_up.time, "s")
    for name, peak in zip(run_up.shafts, run_up.torque_peak, strict=True):
        yield f"{name}: peak torque of the start-up", *parted(float(peak), "N m")


def run_up_tables(run_up: ElasticRunUp) -> Iterator[Table]:
    """Time, torques of the shafts against steady motion, energy, limits."""
    title = f"Run-up of the elastic driveline, until within {100 * run_up.settled:.3g} % of steady motion"
    yield Table("elastic_run_up", title, _HEADS, rows_in(run_up, "elastic_run_up"))
    heads = ("shaft", "", "peak torque", "at", "in steady motion", "factor")
    cells = ("name", "", "torque_peak", "torque_peak_time", "torque_steady", "torque_factor")
    title = "Run-up of the elastic driveline: torques of the shafts"
    yield part_table("elastic_run_up_shafts", title, parts_of(run_up, "shafts"), heads, *cells)
    yield _energy(run_up.motion, "Run-up of the elastic driveline: energy")
    if run_up.judgements:
        title = "Run-up of the elastic driveline: permitted torques"
        yield limits_table("elastic_run_up_limits", title, run_up.judgements)


def transient_tables(motion: ElasticTransient) -> Iterator[Table]:
    """Torques of the shafts, motion of the stations, energy, limits."""
    heads = ("shaft", "", "minimum", "at", "maximum", "at", "heat")
    cells = (
        "name",
        "",
        "torque_min",
        "torque_min_time",
        "torque_max",
        "torque_max_time",
        "energy_dissipated",
    )
    title = "Elastic driveline in time: torques of the shafts"
    yield part_table("elastic_shafts_in_time", title, parts_of(motion, "shafts"), heads, *cells)
    heads = ("station", "", "minimum speed", "at", "maximum speed", "at", "maximum acceleration")
    cells = (
        "name",
        "",
        "speed_min",
        "speed_min_time",
        "speed_max",
        "speed_max_time",
        "acceleration_max",
    )
    title = "Elastic driveline in time: motion of the stations"
    yield part_table("elastic_stations_in_time", title, parts_of(motion, "stations"), heads, *cells)
    yield _energy(motion, "Elastic driveline in time: energy")
    if motion.judgements:
        title = "Elastic driveline in time: permitted torques"
        yield limits_table("elastic_limits_in_time", title, motion.judgements)


def _energy(motion: ElasticTransient, title: str) -> Table:
    return Table("elastic_transient", title, _HEADS, rows_in(motion, "elastic_transient"))
