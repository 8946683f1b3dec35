"""Courses over time from CSV files: a start of 10 s, and files that do not fit."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import linkwright as lw
from linkwright import MachineFileError, torsion_transient

TRAIN = """
format = 1
name = "start"
[train.discs.motor]
inertia = 40.0
[train.discs.load]
inertia = 160.0
[train.shafts.s]
between = ["motor", "load"]
stiffness = 1e5
damping = 200.0
[train.transient]
duration = 10.0
accuracy = 1e-11
events = [{ kind = "torque_course", on = "motor", file = "start.csv" }]
"""


def write(folder: Path, points: str) -> Path:
    """A machine file beside its course."""
    (folder / "start.csv").write_text(points, encoding="utf-8")
    file = folder / "start.toml"
    file.write_text(TRAIN, encoding="utf-8")
    return file


def test_a_start_of_ten_seconds_by_a_course(tmp_path: Path) -> None:
    """The momentum after a start is the integral of the course, in the units of its head."""
    moved = torsion_transient(
        lw.read(write(tmp_path, "times [ms], torque [kN m]\n0, 0.5\n4000, 2.0\n9000, 1.0\n9500, 0\n"))
    )
    impulse = 0.5 * (500 + 2000) * 4 + 0.5 * 3000 * 5 + 0.5 * 1000 * 0.5
    momentum = np.array([40.0, 160.0]) @ moved.speed[:, -1]
    assert momentum == pytest.approx(impulse, rel=1e-9)
    assert abs(moved.energy_error) < 1e-9


def test_courses_that_do_not_fit(tmp_path: Path) -> None:
    """A column that is missing, a row that is too short: with the file and its line."""
    with pytest.raises(lw.MachineError, match="torque"):
        lw.read(write(tmp_path, "times [s], speed [rpm]\n0, 1\n1, 2\n"))
    with pytest.raises(MachineFileError, match="2 values, one for each column"):
        lw.read(write(tmp_path, "times [s], torque [N m]\n0, 1\n1\n"))
