"""Studies of trains whose mechanisms have machine files of their own."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from test_mounted_trains import PRESS, line_shaft

import linkwright as lw

RAM = "train.mechanisms.press1.machine.bodies.S.mass"
PEAK = "elastic_motion.torque_max.left"


def test_a_sweep_over_an_entry_of_a_mounted_machine_is_that_of_machine_files(tmp_path: Path) -> None:
    """Every row is the motion of a train whose press file states that mass; a mass below zero fails."""
    plan = lw.new_study(
        line_shaft(tmp_path),
        {
            "variables": {"ram": {"address": RAM, "range": ["20 kg", "100 kg"], "steps": 3}},
            "responses": {"peak": PEAK, "f": "free_vibration.natural_frequencies.1"},
        },
    )
    masses = np.array([20.0, 60.0, 100.0, -5.0])
    rows = lw.evaluate(plan, {"ram": masses})
    assert rows.status.astype(bool).tolist() == [False, False, False, True]
    for n, mass in enumerate(masses[:3].tolist()):
        file = tmp_path / "press1.toml"
        file.write_text(PRESS.replace("mass = 60", f"mass = {mass}"))
        machine = lw.read(tmp_path / "line.toml")
        motion = lw.elastic_motion(machine)
        peak = motion.torque_max[motion.shafts.index("left")]
        assert rows.columns["peak"][n] == pytest.approx(peak, rel=1e-7)
        assert rows.columns["f"][n] == pytest.approx(
            lw.free_vibration(machine).natural_frequencies[1], rel=1e-10
        )
