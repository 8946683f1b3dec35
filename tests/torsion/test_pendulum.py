"""Centrifugal pendulum absorbers: Den Hartog's equation, at every speed of the survey."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import linkwright as lw
from linkwright import MachineError, campbell, forced_vibration, free_vibration, torsion_study

MASS, RADIUS, LENGTH = 0.8, 0.12, 0.03


def machine(order: float = 2.0, damping: float = 0.0, ratio: float = 1.0, **train: Any) -> lw.Machine:
    """A crank behind a stage, with pendulums tuned to order 2, and a flywheel on a soft shaft."""
    entries = {
        "discs": {"motor": {"inertia": 0.3}, "crank": {"inertia": 0.15}, "wheel": {"inertia": 1.2}},
        "shafts": {"soft": {"between": ["crank", "wheel"], "stiffness": 900.0, "loss_factor": 0.01}},
        "gears": {"stage": {"between": ["motor", "crank"], "ratio": ratio, "stiffness": 3e4}},
        "pendulums": {
            "bob": {"on": "crank", "mass": MASS, "radius": RADIUS, "length": LENGTH, "damping": damping}
        },
        "excitations": {
            "gas": {"on": "crank", "harmonics": [{"order": order, "torque": 25.0, "phase": 0.2}]}
        },
        "run": {"speed_min": 40.0, "speed_max": 400.0, "points": 60},
    }
    return lw.Machine.model_validate({"format": 1, "name": "pendulum", "train": {**entries, **train}})


@pytest.mark.parametrize("ratio", [1.0, 2.5])
def test_den_hartog_at_order_two(ratio: float) -> None:
    """A pendulum with R/l = n² holds its disc still under the order n at every speed, with its torque."""
    forced, bare = (
        forced_vibration(machine(ratio=ratio)),
        forced_vibration(machine(ratio=ratio, pendulums={})),
    )
    crank = forced.discs.index("crank")
    still, swinging = (np.abs(one.amplitudes[0, crank]) for one in (forced, bare))
    assert len(forced.speeds) == 60
    assert (still < 1e-7 * swinging).all()
    assert np.abs(forced.shaft_torques[0, forced.shafts.index("bob")]) == pytest.approx(25.0, rel=1e-6)


@pytest.mark.parametrize("order", [1.5, 3.0])
def test_equation_of_the_pendulum(order: float) -> None:
    """Away from its order: the equations of disc and pendulum in θ and ψ, with damping, speed by speed."""
    c = 0.05
    forced = forced_vibration(machine(order, c))
    names = ["motor", "crank", "wheel", "bob"]
    J = np.diag([0.3, 0.15 + MASS * (RADIUS + LENGTH) ** 2, 1.2, MASS * LENGTH**2])
    J[1, 3] = J[3, 1] = MASS * LENGTH * (RADIUS + LENGTH)
    stage, soft = np.array([1.0, -1, 0, 0]), np.array([0.0, 1, -1, 0])
    # The velocity of the mass about the axis, relative to the disc, is ψ̇ l/(R + l).
    share = LENGTH / (RADIUS + LENGTH)
    for n, speed in enumerate(forced.speeds.tolist()):
        omega = order * speed
        K = 3e4 * np.outer(stage, stage) + 900.0 * (1 + 0.01j) * np.outer(soft, soft)
        K[3, 3] += MASS * RADIUS * LENGTH * speed**2 + 1j * omega * c * share**2
        theta = np.linalg.solve(K - omega**2 * J, [0, 25 * np.exp(0.2j), 0, 0])
        at = {name: forced.amplitudes[0, forced.discs.index(name), n] for name in names}
        assert [at[name] for name in names[:3]] == pytest.approx(theta[:3].tolist(), rel=1e-9)
        assert (at["bob"] - at["crank"]) / share == pytest.approx(theta[3], rel=1e-8)


def test_frequencies_follow_the_speed() -> None:
    """The Campbell diagram has its frequency in proportion to the speed; free vibration that at service."""
    alone = machine(
        discs={"crank": {"inertia": 0.15}},
        shafts={},
        gears={},
        excitations=machine().model_dump()["train"]["excitations"],
    )
    diagram = campbell(alone, [2.0])
    J = MASS * (RADIUS + LENGTH) ** 2
    expected = 2 * np.sqrt(1 + J / 0.15) * diagram.speeds / (2 * np.pi)
    assert diagram.frequencies[-1] == pytest.approx(expected, rel=1e-12)
    assert not diagram.critical
    assert free_vibration(alone).natural_frequencies[-1] == pytest.approx(expected[-1], rel=1e-12)


def test_swing_is_judged() -> None:
    """The amplitude of the swing is (R + l)/l of the lead of the mass, and has its limit."""
    pendulums = {
        "bob": {
            **machine().model_dump(exclude_unset=True)["train"]["pendulums"]["bob"],
            "swing_permitted": 0.1,
        }
    }
    study = torsion_study(machine(pendulums=pendulums))
    assert study.verdict is not None
    (swing,) = [one for one in study.verdict.judgements if one.what == "swing"]
    # All of the torque is that of the pendulum, M = m R (R + l) Ω² ψ, largest at the lowest speed.
    assert swing.found == pytest.approx(25.0 / (MASS * RADIUS * (RADIUS + LENGTH) * 40.0**2), rel=1e-6)
    assert study.findings


@pytest.mark.parametrize("scale", [0.9, 1.1])
def test_a_swing_that_is_not_small_is_a_warning(scale: float) -> None:
    """M = m R (R + l) Ω² ψ at the lowest speed: a warning beyond ψ = 0.5 rad, where no limit is given."""
    torque = scale * 0.5 * MASS * RADIUS * (RADIUS + LENGTH) * 40.0**2
    excitations = machine().model_dump(exclude_unset=True)["train"]["excitations"]
    (one,) = excitations.values()
    one["harmonics"] = [{"order": one["harmonics"][0]["order"], "torque": torque}]
    warned = [text for text in torsion_study(machine(excitations=excitations)).warnings if "swing" in text]
    assert bool(warned) == (scale > 1)


def test_what_pendulums_need() -> None:
    """Speeds set their stiffness in linear vibration."""
    with pytest.raises(MachineError, match="speeds, which set the stiffness"):
        machine(run=None)
