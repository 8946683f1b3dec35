"""Steady motion of an elastic driveline as tables and headline."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np

from linkwright.driveline.elastic_motion import ElasticMotion
from linkwright.driveline.permitted import TorqueJudgement
from linkwright.kernel.page.table import NamedPart, Row, Table, part_table, parts_of, rows_in
from linkwright.kernel.reader.numbers import crank_angle, cycle_of_angles, number, parted


def elastic_headline(motion: ElasticMotion) -> Iterator[tuple[str, str, str]]:
    """Peak torque of every shaft, and how many times the mean it is."""
    for name, peak, ratio in zip(motion.shafts, motion.torque_peak, motion.torque_ratio, strict=True):
        yield f"{name}: peak torque", *parted(float(peak), "N m")
        if np.isfinite(ratio):
            yield f"{name}: peak over mean torque", number(float(ratio)), ""


def elastic_tables(motion: ElasticMotion) -> Iterator[Table]:
    """Torques of the shafts, motion of the stations, energy and stability, limits."""
    yield _shafts(motion)
    yield _stations(motion)
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
