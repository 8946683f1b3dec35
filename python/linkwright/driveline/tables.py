"""Motion of an elastic driveline, steady and in time, as tables and headline."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np

from linkwright.driveline.elastic_motion import ElasticMotion
from linkwright.driveline.in_time import ElasticTransient
from linkwright.driveline.permitted import TorqueJudgement
from linkwright.driveline.run_up import ElasticRunUp
from linkwright.kernel.page.table import NamedPart, Row, Table, part_table, parts_of, rows_in
from linkwright.kernel.reader.numbers import crank_angle, cycle_of_angles, number, parted


def elastic_headline(motion: ElasticMotion) -> Iterator[tuple[str, str, str]]:
    """Peak torque of every shaft, and how many times the mean it is."""
    for name, peak, ratio in zip(motion.shafts, motion.torque_peak, motion.torque_ratio, strict=True):
        yield f"{name}: peak torque", *parted(float(peak), "N m")
        if np.isfinite(ratio):
            yield f"{name}: peak over mean torque", number(float(ratio)), ""


def elastic_tables(motion: ElasticMotion) -> Iterator[Table]:
    """Torques of the shafts, motion of the stations, motors, energy and stability, limits."""
    yield _shafts(motion)
    yield _stations(motion)
    yield _motors(motion)
    heads = ("quantity", "", "value", "")
    yield Table(
        "elastic_motion", "Elastic driveline: cycle and stability", heads, rows_in(motion, "elastic_motion")
    )
    if motion.judgements:
        title = "Elastic driveline: permitted torques"
        yield limits_table("elastic_limits", title, motion.judgements)


def _shafts(motion: ElasticMotion) -> Table:
    heads = (
        "shaft",
        "",
        "minimum",
        "at",
        "maximum",
        "at",
        "mean",
        "peak/mean",
        "vibratory",
        "loss",
    )
    cells = (
        "name",
        "",
        "torque_min",
        _at(motion, "torque_min_angle"),
        "torque_max",
        _at(motion, "torque_max_angle"),
    )
    rest = ("torque_mean", "torque_ratio", "torque_vibratory", "power_dissipated")
    title = "Elastic driveline: torques of the shafts in steady motion"
    return part_table("elastic_shafts", title, parts_of(motion, "shafts"), heads, *cells, *rest)


def _stations(motion: ElasticMotion) -> Table:
    heads = (
        "station",
        "",
        "minimum speed",
        "maximum speed",
        "δ",
        "minimum acceleration",
        "maximum acceleration",
    )
    cells = ("name", "", "speed_min", "speed_max", "unevenness", "acceleration_min", "acceleration_max")
    title = "Elastic driveline: motion of the stations"
    return part_table("elastic_stations", title, parts_of(motion, "stations"), heads, *cells)


def _motors(motion: ElasticMotion) -> Table:
    heads = ("motor", "", "minimum torque", "maximum torque", "mean torque", "mean power")
    cells = ("name", "", "torque_motor_min", "torque_motor_max", "torque_motor_mean", "power_motor")
    title = "Elastic driveline: torques of the motors, less gear losses"
    return part_table("elastic_motors", title, parts_of(motion, "motors"), heads, *cells)


def limits_table(name: str, title: str, judgements: Sequence[TorqueJudgement]) -> Table:
    """Torques of the shafts against what is permitted."""
    rows: list[Row] = []
    for judgement in judgements:
        found, permitted = (
            " ".join(parted(value, "N m")) for value in (judgement.found, judgement.permitted)
        )
        verdict = "within limit" if judgement.is_kept else "limit exceeded"
        rows.append((f"{judgement.part}: {judgement.what}", "", found, permitted, verdict))
    heads = ("limit", "", "found", "permitted", "verdict")
    return Table(name, title, heads, rows)


def _at(motion: ElasticMotion, name: str) -> Callable[[NamedPart], str]:
    """What makes the crank angle of a part's extreme."""
    cycle = cycle_of_angles(motion.crank_angle)
    return lambda part: crank_angle(getattr(part, name), "φ = ", cycle)


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
