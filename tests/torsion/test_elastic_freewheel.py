"""Elastic freewheels: a one-way clutch in series with a spring, as in overrunning decouplers."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import linkwright as lw
from linkwright import MachineError, free_vibration, torsion_transient

J_A, J_RING, J_B, K = 0.8, 0.05, 1.5, 2e3


def machine(
    wheel: dict[str, Any] | None = None, transient: dict[str, Any] | None = None, **train: Any
) -> Any:
    """A disc that drives another through a freewheel and a spring."""
    entries: dict[str, Any] = {
        "discs": {"a": {"inertia": J_A}, "b": {"inertia": J_B}},
        "freewheels": {
            "decoupler": {"between": ["a", "b"], "stiffness": K, "ring_inertia": J_RING, **(wheel or {})}
        },
        **({"transient": transient} if transient else {}),
        **train,
    }
    return lw.Machine.model_validate({"format": 1, "name": "decoupler", "train": entries})


def test_locked_it_is_a_spring() -> None:
    """Locked, the natural frequency is that of two inertias on the spring, the ring on the driving side."""
    found = free_vibration(machine()).natural_frequencies
    omega = np.sqrt(K * (1 / (J_A + J_RING) + 1 / J_B))
    assert found == pytest.approx([0.0, omega / (2 * np.pi)], rel=1e-12)


def test_twisted_it_gives_its_impulse_and_lets_go() -> None:
    """A twisted spring drives both apart for a quarter of a period; then the driving disc keeps its speed."""
    fast = 16.0
    start = {"duration": 0.25, "speed": fast, "sample_time": 1e-4, "twists": {"decoupler_spring": 0.02}}
    moved = torsion_transient(machine(transient=start))
    driving = J_A + J_RING
    omega = np.sqrt(K * (1 / driving + 1 / J_B))
    t = moved.time[moved.time <= 0.5 * np.pi / omega]
    expected = 0.02 * K * np.cos(omega * t)
    assert moved.torque[0, : len(t)] == pytest.approx(expected, abs=1e-6 * 0.02 * K)
    after = moved.time > 0.5 * np.pi / omega
    impulse = 0.02 * K / omega
    assert moved.speed[0, after] == pytest.approx(fast - impulse / driving, rel=1e-8)
    assert moved.friction_torque[0].min() > -1e-9
    momentum = J_RING * moved.speed[2, after] + J_B * moved.speed[1, after]
    assert momentum == pytest.approx((J_RING + J_B) * fast + impulse * (1 - J_RING / driving), rel=1e-8)


def test_after_many_revolutions_of_overrun_it_locks_where_it_is() -> None:
    """The driven disc is braked to the speed of the driving one; the spring then takes the load as a step."""
    torque, ahead, speed = 30.0, 40.0, 50.0
    follows = J_RING * torque / (J_RING + J_B)
    moved = torsion_transient(
        machine(
            transient={
                "duration": 2.6,
                "speed": speed,
                "speeds": {"b": speed + ahead},
                "sample_time": 1e-4,
                "twists": {"decoupler_spring": follows / K},
            },
            loads={"brake": {"on": "b", "torque": torque, "speed": speed, "exponent": 0.0}},
        )
    )
    locks = ahead * (J_RING + J_B) / torque
    overrun = 0.5 * ahead * locks
    assert overrun > 6 * 2 * np.pi
    before, after = moved.time < locks, moved.time > locks
    assert moved.torque[0, before] == pytest.approx(follows, rel=1e-6)
    assert moved.speed[0, before] == pytest.approx(speed, rel=1e-9)
    driving = J_A + J_RING
    omega, mean = np.sqrt(K * (1 / driving + 1 / J_B)), torque * driving / (driving + J_B)
    t = moved.time[after] - locks
    expected = mean - (mean - follows) * np.cos(omega * t)
    assert moved.torque[0, after] == pytest.approx(expected, abs=1e-5 * torque)
    assert moved.torque_max[0] == pytest.approx(2 * mean - follows, rel=1e-6)
    assert moved.angle[1, -1] - moved.angle[0, -1] > 6 * 2 * np.pi


@pytest.mark.parametrize(
    ("wheel", "words"),
    [
        ({"ring_inertia": None}, "ring_inertia"),
        ({"stiffness": None}, "a stiffness beside ring_inertia"),
        ({"between": ["ground", "b"]}, "none of a backstop"),
    ],
)
def test_incomplete_ones_are_refused(wheel: dict[str, Any], words: str) -> None:
    """A spring needs its ring, a ring its spring; a backstop has none."""
    with pytest.raises(MachineError, match=words):
        machine(wheel)


def test_names_of_its_parts_are_taken() -> None:
    """A disc of the name of the ring is an error that says whose name it is."""
    discs = {"a": {"inertia": J_A}, "b": {"inertia": J_B}, "decoupler_ring": {"inertia": 1.0}}
    shaft = {"s": {"between": ["b", "decoupler_ring"], "stiffness": 1e4}}
    with pytest.raises(MachineError, match=r"\[train.freewheels\]"):
        machine(discs=discs, shafts=shaft)
