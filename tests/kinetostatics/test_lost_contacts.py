"""Derivatives, sizing and studies tell of a follower that leaves its cam."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from command_line import invoke

import linkwright as lw
from linkwright import Machine
from linkwright.machine import dumps

VALVE = "examples/cam_oscillating_valve/machine.toml"
# A shaft that is driven so fast that no spring holds the finger.
FAST = {
    "drive.motor": {"kind": "dc", "speed_no_load": 910.0, "torque_stall": 300.0, "inertia": 0.01},
    "loads.brake": {"kind": "torque_angle", "angle": [0.0, 2 * np.pi], "torque": [20.0, 20.0]},
}
LEAVES = "The follower leaves cam finger"


@pytest.fixture
def fast() -> Machine:
    return lw.read(VALVE, FAST)


def test_derivatives(tmp_path: Path, fast: Machine) -> None:
    (tmp_path / "fast.toml").write_text(dumps(fast))
    for of in ("steady_state.speed_mean_time", "forces.torque_drive_max"):
        done = invoke("sensitivity", tmp_path / "fast.toml", "--of", of)
        assert done.exit_code == 1, done.output
        assert LEAVES in done.output
    slow = ["--set", "drive.motor.speed_no_load=100"]
    done = invoke("sensitivity", tmp_path / "fast.toml", "--of", "forces.torque_drive_max", *slow)
    assert LEAVES not in done.output


def test_sizing(tmp_path: Path, fast: Machine) -> None:
    (tmp_path / "fast.toml").write_text(dumps(fast))
    words = ["size", str(tmp_path / "fast.toml"), "--keep-motor", "--unevenness", "0.01"]
    done = invoke(*words)
    assert done.exit_code == 1, done.output
    assert LEAVES in done.output


STUDY = {
    "variables": {"n": {"address": "drive.motor.speed_no_load", "range": [200.0, 950.0], "steps": 3}},
    "responses": {"u": "steady_state.unevenness"},
}


def test_studies(fast: Machine) -> None:
    best = lw.optimise(lw.new_study(fast, STUDY | {"goals": {"u": "minimise"}}), 60)
    assert best.variables["n"] == pytest.approx(950.0)
    assert best.findings[0].startswith(LEAVES)
    forced = STUDY | {"responses": {"u": "steady_state.unevenness", "f": "forces.torque_drive_max"}}
    rows = lw.evaluate(lw.new_study(fast, forced), {"n": np.array([200.0, 950.0])})
    assert rows.status.tolist() == [0, 1]
    assert LEAVES in rows.why(1)
