"""Gear stages that lose power: balanced starts, torques at the first disc, an elastic mesh by SciPy."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

import linkwright as lw
from linkwright import MachineError, torsion_transient

ETA = 0.9
STEP = {"kind": "load_step", "load": "pump", "time": 0.1, "factor": 0.1}


def machine(gear: dict[str, Any], **transient: Any) -> lw.Machine:
    stage = {"between": ["motor", "wheel"], "ratio": 2.0, "efficiency": ETA, "torque_permitted": 54.0}
    train = {
        "discs": {"motor": {"inertia": 1.0}, "wheel": {"inertia": 2.0}, "load": {"inertia": 0.7}},
        "shafts": {"shaft": {"between": ["wheel", "load"], "stiffness": 1e4, "damping": 3.0}},
        "gears": {"stage": {**stage, **gear}},
        "loads": {"pump": {"on": "load", "torque": 100.0, "speed": 50.0, "exponent": 1.0}},
        "transient": {"duration": 0.4, "speed": 100.0, "accuracy": 1e-12, "sample_time": 1e-3, **transient},
    }
    return lw.Machine.model_validate({"format": 1, "name": "stage", "train": train})


@pytest.mark.parametrize(
    "gear", [{}, {"stiffness": 1e5}, {"stiffness": 1e5, "backlash": 1e-3, "damping": 9.0}]
)
def test_a_balanced_start_gives_what_the_stage_loses(gear: dict[str, Any]) -> None:
    """The driver gives M/(iη), the teeth carry M/i, nothing swings; the first disc is judged."""
    # Twists within a backlash are found to a millionth.
    near = 2e-6 if "backlash" in gear else 1e-8
    moved = torsion_transient(machine(gear, settle=0.0))
    assert "55.556 N m" in moved.balance
    assert moved.torque[moved.shafts.index("stage")] == pytest.approx(50.0, rel=near)
    assert moved.stage_torque[0] == pytest.approx(50.0 / ETA, rel=near)
    assert moved.speed[0] == pytest.approx(100.0, rel=0.1 * near)
    assert moved.loss["stage"] == pytest.approx((1 / ETA - 1) * 50.0 * 100.0 * 0.4, rel=near)
    assert [one.part for one in moved.judgements if not one.is_kept] == ["stage"]


def test_an_elastic_mesh_with_losses() -> None:
    """After a load step the torque of the teeth swings through zero: the loss is that of its sign."""
    k, reverse = 2e4, 0.6
    moved = torsion_transient(
        machine({"stiffness": k, "damping": 4.0, "efficiency_reverse": reverse}, settle=0.0, events=[STEP])
    )
    drive = 50.0 / ETA

    def rates(t: float, y: NDArray[np.float64]) -> list[float]:
        T = k * (y[0] - 2 * y[1]) + 4.0 * (y[3] - 2 * y[4])
        S = 1e4 * (y[1] - y[2]) + 3.0 * (y[4] - y[5])
        load = 2.0 * y[5] * (1.0 if t < 0.1 else 0.1)
        X = T / ETA if T > 0 else reverse * T
        return [y[3], y[4], y[5], drive - X, (2 * T - S) / 2.0, (S - load) / 0.7]

    start = [0.0, -50.0 / k / 2, -50.0 / k / 2 - 0.01, 100.0, 50.0, 50.0]
    tight = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-13, "max_step": 2e-4}
    before = solve_ivp(rates, (0, 0.1), start, **tight)
    times = moved.time[moved.time > 0.1]
    after = solve_ivp(rates, (0.1 + 1e-15, 0.4), before.y[:, -1], t_eval=times, **tight).y
    assert moved.speed[:, moved.time > 0.1] == pytest.approx(after[3:], abs=1e-7)
    assert moved.torque_min[moved.shafts.index("stage")] < -1
    assert abs(moved.energy_error) < 1e-9


def test_what_is_wrong_is_told() -> None:
    """Efficiencies out of range, and damping ratios of modes beside a rigid stage that loses power."""
    with pytest.raises(MachineError, match="above 0 and up to 1"):
        machine({"efficiency": 1.2})
    with pytest.raises(MachineError, match="from 0 to 1"):
        machine({"efficiency_reverse": -0.1})
    train = machine({}).model_dump(exclude_unset=True)
    train["train"]["modal_damping"] = {"others": 0.01}
    with pytest.raises(MachineError, match="give the stiffness of its mesh"):
        torsion_transient(lw.Machine.model_validate(train))
