"""Damping ratios of modes: closed forms, and modal superposition by SciPy."""

import math
from typing import Any

import numpy as np
import pytest
from scipy.linalg import eigh

import linkwright as lw
from linkwright import MachineError, forced_vibration, mesh_torques


def machine(**train: Any) -> lw.Machine:
    run = {"speed_min": 5.0, "speed_max": 200.0, "points": 41}
    return lw.Machine.model_validate({"format": 1, "name": "train", "train": {"run": run, **train}})


def chain(**train: Any) -> lw.Machine:
    return machine(
        discs={name: {"inertia": J} for name, J in zip("abcd", (2.0, 3.0, 1.0, 4.0), strict=True)},
        shafts={
            pair: {"between": list(pair), "stiffness": k}
            for pair, k in zip(("ab", "bc", "cd"), (4e4, 2e4, 7e4), strict=True)
        },
        excitations={"e": {"on": "b", "harmonics": [{"order": 1.5, "torque": 10.0, "phase": 0.3}]}},
        **train,
    )


def test_modes_have_the_ratios_given() -> None:
    found = lw.damped_vibration(chain(modal_damping={"ratios": ["1 %", 0.3], "others": 0.02}))
    np.testing.assert_allclose(found.damping_ratios, [0.0, 0.01, 0.3, 0.02], atol=1e-13)


def test_response_is_that_of_modal_superposition() -> None:
    """The equations of the modes one by one, with SciPy's modes."""
    ratios = np.array([0.0, 0.01, 0.3, 0.02])
    found = forced_vibration(chain(modal_damping={"ratios": ["1 %", 0.3], "others": 0.02}))
    J, k = np.diag([2.0, 3.0, 1.0, 4.0]), np.array([4e4, 2e4, 7e4])
    B = np.eye(4)[:3] - np.eye(4)[1:]
    square, modes = eigh(B.T @ (k[:, None] * B), J)
    omega = np.sqrt(np.maximum(square, 0.0))
    omega[0] = 0.0
    w = 1.5 * found.speeds[:, None]
    p = modes[1] * 10.0 * np.exp(0.3j) / (omega**2 - w**2 + 2j * ratios * omega * w)
    theta = p @ modes.T
    np.testing.assert_allclose(found.amplitudes[0], theta.T, rtol=1e-9)
    np.testing.assert_allclose(found.shaft_torques[0], k[:, None] * (B @ theta.T), rtol=1e-9)
    np.testing.assert_allclose(found.modal_heat, found.power, rtol=1e-9)


def test_rigid_stage_carries_what_a_stiff_mesh_does() -> None:
    """The torque of a mesh by its twist, and by what the discs behind it ask for."""

    def geared(**mesh: Any) -> lw.Machine:
        return machine(
            discs={
                "a": {"inertia": 2.0},
                "g": {"inertia": 0.5},
                "w": {"inertia": 3.0},
                "p": {"inertia": 8.0},
            },
            shafts={
                "ag": {"between": ["a", "g"], "stiffness": 4e4},
                "wp": {"between": ["w", "p"], "stiffness": 6e4},
            },
            gears={"stage": {"between": ["g", "w"], "ratio": 2.5, **mesh}},
            excitations={"e": {"on": "a", "harmonics": [{"order": 1.0, "torque": 10.0}]}},
            modal_damping={"ratios": ["5 %", "3 %"]},
        )

    # A mesh of 1e9 N m/rad gives way by some 1e-5 of what the shafts do.
    rigid, stiff = mesh_torques(geared()), mesh_torques(geared(stiffness=1e9))
    np.testing.assert_allclose(rigid.torques, stiff.torques, rtol=2e-4)


@pytest.mark.parametrize("end", ["b", "ground"])
def test_step_of_torque_overshoots_by_the_closed_form(end: str) -> None:
    """First peak of the shaft torque over its static one is 1 + e^(−πζ/√(1 − ζ²)); free or held."""
    zeta, torque = 0.07, 100.0
    discs = {"a": {"inertia": 2.0}} | ({"b": {"inertia": 3.0}} if end == "b" else {})
    found = lw.torsion_transient(
        machine(
            discs=discs,
            shafts={"s": {"between": ["a", end], "stiffness": 4e4}},
            modal_damping={"others": zeta},
            transient={
                "duration": 0.2,
                "accuracy": 1e-11,
                "events": [{"kind": "torque", "time": 0.01, "on": "a", "torque": torque}],
            },
        )
    )
    static = torque * (0.6 if end == "b" else 1.0)
    overshoot = 1 + math.exp(-math.pi * zeta / math.sqrt(1 - zeta**2))
    assert found.torque_max[0] == pytest.approx(static * overshoot, rel=1e-8)
    assert found.shafts == ("s",)
    # Energy given is that of motion and twist, and what the modes lost.
    assert abs(found.energy_error) < 1e-9
    assert found.loss["modes"] > 0


def test_hysteresis_by_mode_is_right_at_each_frequency() -> None:
    """η of all shafts is ζ = η/2 of each mode: the same motion as with the ratios given."""
    step = {"duration": 0.3, "events": [{"kind": "torque", "time": 0.01, "on": "a", "torque": 50.0}]}
    given = lw.torsion_transient(chain(modal_damping={"others": 0.02}, transient=step))
    shafts = {f"train.shafts.{pair}.loss_factor": 0.04 for pair in ("ab", "bc", "cd")} | {
        "train.transient.loss_by": "mode"
    }
    by_mode = lw.torsion_transient(lw.replace(chain(transient=step), shafts))
    np.testing.assert_allclose(by_mode.torque, given.torque, atol=1e-6 * given.torque_max.max())
    assert "each mode" in by_mode.notes[0]


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"ratios": [0.1, 0.1, 0.1, 0.1]}, "at most 3"),
        ({"ratios": [1.0]}, "below 1"),
        ({"others": -0.1}, "below 1"),
        ({}, "ratios of some modes"),
    ],
)
def test_ratios_that_no_train_has_are_refused(given: dict[str, Any], words: str) -> None:
    with pytest.raises(MachineError, match=words):
        lw.free_vibration(chain(modal_damping=given))
