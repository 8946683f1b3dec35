"""Running trains with engaged clutches and brakes: they start in steady running, and slip from there."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import linkwright as lw
from linkwright import MachineError, torsion_transient

J = {"motor": 2.0, "inner": 0.3, "outer": 0.4, "fan": 5.0}
K_IN, K_OUT, LOAD, SPEED = 9e3, 4e3, 120.0, 90.0


def machine(transient: dict[str, Any], clutch: dict[str, Any] | None = None, **train: Any) -> lw.Machine:
    """A motor, an overload clutch and a fan of constant torque."""
    entries: dict[str, Any] = {
        "discs": {name: {"inertia": inertia} for name, inertia in J.items()},
        "shafts": {
            "input": {"between": ["motor", "inner"], "stiffness": K_IN},
            "output": {"between": ["outer", "fan"], "stiffness": K_OUT},
        },
        "clutches": {"overload": {"between": ["inner", "outer"], "sliding": 300.0, **(clutch or {})}},
        "loads": {"fan": {"on": "fan", "torque": LOAD, "speed": SPEED, "exponent": 0.0}},
        "transient": {"speed": SPEED, "balanced": True, "sample_time": 1e-3, **transient},
        **train,
    }
    return lw.Machine.model_validate({"format": 1, "name": "overload", "train": entries})


def test_clutch_opens_out_of_steady_running() -> None:
    """Shafts carry the load until the clutch opens; then the fan slows down by its momentum and its shaft
    rings about what its inertias share.
    """
    opens = 0.25
    moved = torsion_transient(
        machine(
            {"duration": 0.6, "events": [{"kind": "clutch_off", "time": opens, "clutch": "overload"}]},
        )
    )
    steady = moved.time < opens
    assert moved.torque[:, steady] == pytest.approx(LOAD, rel=1e-8)
    assert moved.friction_torque[0, steady] == pytest.approx(LOAD, rel=1e-8)
    assert moved.speed[:, steady] == pytest.approx(SPEED, rel=1e-9)
    t = moved.time[~steady] - opens
    momentum = J["outer"] * moved.speed[2, ~steady] + J["fan"] * moved.speed[3, ~steady]
    both = J["outer"] + J["fan"]
    assert momentum == pytest.approx(both * SPEED - LOAD * t, rel=1e-9)
    share, omega = LOAD * J["outer"] / both, np.sqrt(K_OUT * both / (J["outer"] * J["fan"]))
    expected = share + (LOAD - share) * np.cos(omega * t)
    assert moved.torque[1, ~steady] == pytest.approx(expected, abs=1e-5 * LOAD)
    assert "constant 120 N m" in moved.balance


@pytest.mark.parametrize("stribeck", [True, False])
def test_motor_balances_load_and_friction(stribeck: bool) -> None:
    """The start is at the speed at which the motor drives the fan and the friction of its bearing."""
    friction = {
        "on": "fan",
        "sliding": 40.0,
        **({"static": 70.0, "stribeck_speed": 60.0} if stribeck else {}),
    }
    motor = {"on": "motor", "motor": {"kind": "dc", "speed_no_load": 110.0, "torque_stall": 900.0}}
    described = machine({"duration": 0.3}, brakes={"bearing": friction}, motors={"drive": motor})
    moved = torsion_transient(described)

    def left(speed: float) -> float:
        falling = 30.0 * np.exp(-speed / 60.0) if stribeck else 0.0
        return 900.0 * (1 - speed / 110.0) - LOAD - 40.0 - falling

    speed = brentq(left, 50.0, 109.0, xtol=1e-13)
    assert moved.speed == pytest.approx(speed, rel=1e-7)
    drives = 900.0 * (1 - speed / 110.0)
    assert moved.torque == pytest.approx(drives, rel=1e-5)
    assert not moved.notes


def test_clutch_too_weak_slips_and_is_noted() -> None:
    """A clutch of less than the load slips from the start: with its sliding torque, as a note says."""
    moved = torsion_transient(machine({"duration": 0.2, "settle": 0.0}, {"sliding": 90.0}))
    assert moved.friction_torque[0, 1:] == pytest.approx(90.0)
    assert any("overload cannot carry" in note for note in moved.notes)


def test_without_the_key_nothing_is_balanced() -> None:
    """The start without `balanced = true` has untwisted shafts and no torque that drives."""
    described = machine({"duration": 0.2})
    entries = described.train.transient.model_dump(exclude_unset=True)  # type: ignore[union-attr]
    del entries["balanced"]
    moved = torsion_transient(machine(entries | {"balanced": False}))
    assert moved.torque[:, 0] == pytest.approx(0.0, abs=1e-9)
    assert not moved.balance


@pytest.mark.parametrize(
    ("transient", "clutch", "words"),
    [
        ({}, {"closed": False}, "open clutch overload"),
        ({"speeds": {"fan": 50.0}}, {}, "train.transient.speeds.fan"),
    ],
)
def test_separate_parts_are_refused(transient: dict[str, Any], clutch: dict[str, Any], words: str) -> None:
    """Parts that an open clutch or speeds of their own separate have no common balance: an error says so."""
    with pytest.raises(MachineError, match=words):
        torsion_transient(machine({"duration": 0.2, **transient}, clutch))
