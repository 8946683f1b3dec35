"""Derivatives of trains with carriers, Hooke's joints, pendulums, fixed frequencies and speed control."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import linkwright as lw
from linkwright.kernel.arrays import Floats

DISCS = {"motor": 0.8, "sun": 0.02, "carrier": 0.9, "ring": 0.5, "fan": 2.5}
STAGE = {
    "sun": "sun",
    "ring": "ring",
    "carrier": "carrier",
    "teeth": [24, 84],
    "planet_inertia": 0.002,
    "sun_stiffness": 4e5,
    "ring_stiffness": 5e6,
    "loss_factor": 0.02,
}
SHAFTS: dict[str, Any] = {
    "input": {"between": ["motor", "sun"], "stiffness": 3e4, "loss_factor": 0.03, "damping": 1.5},
    "seat": {"between": ["ring", "ground"], "stiffness": 8e5, "damping": 20.0},
    "output": {"between": ["carrier", "fan"], "stiffness": 2e4, "loss_factor": 0.02, "damping": 2.0},
}
RUN = {"speed_min": "600 rpm", "speed_max": "1500 rpm", "points": 7}
FAN = {"fan": {"on": "fan", "torque": 300.0, "speed": "300 rpm", "exponent": 2.0}}
PULSE = {"pulse": {"on": "motor", "harmonics": [{"order": 1, "torque": 20.0}, {"order": 3, "torque": 7.0}]}}
JOINT = {"joint_angle": "14 deg", "joint_phase": "20 deg"}
LINES = {
    "inverter": {
        "on": "motor",
        "harmonics": [
            {"frequency": "100 Hz", "torque": 12.0, "phase": "40 deg"},
            {"frequency": "50 Hz", "torque": 5.0},
            {"order": 6, "frequency": "-300 Hz", "torque": 9.0, "phase": "25 deg"},
        ],
    }
}
PENDULUM = {
    "absorber": {"on": "fan", "mass": 3.0, "radius": 0.2, "length": 0.06, "damping": 0.4},
}


def machine(**parts: Any) -> lw.Machine:
    train = {
        "discs": {name: {"inertia": J, "damping": 0.3} for name, J in DISCS.items()},
        "shafts": SHAFTS,
        "planetaries": {"stage": STAGE},
        "loads": FAN,
        "excitations": PULSE,
        "run": RUN,
    } | parts
    return lw.Machine.model_validate({"format": 1, "name": "parts", "train": train})


def _with_joint() -> dict[str, Any]:
    return SHAFTS | {"output": SHAFTS["output"] | JOINT}


def _loop() -> dict[str, Any]:
    """A second way from motor to fan, past the stage."""
    return SHAFTS | {
        "input_2": {"between": ["motor", "sun"], "stiffness": 1e4},
        "seat_2": {"between": ["ring", "ground"], "stiffness": 1e5},
    }


CASES: dict[str, dict[str, Any]] = {
    "carrier": {},
    "joint": {"shafts": _with_joint()},
    "pendulum": {"pendulums": PENDULUM},
    "fixed frequencies": {"excitations": PULSE | LINES},
    "shafts side by side": {"shafts": _loop()},
    "speed control": {
        "drivers": {"motor": {"on": "motor", "control": {"proportional": 6.0, "integral": 900.0}}},
        "shafts": _with_joint(),
    },
    "all": {"shafts": _with_joint(), "pendulums": PENDULUM, "excitations": LINES},
}


def slope(found: Any, one: lw.Machine, values: Any, direction: Floats) -> Floats:
    """By a central difference of fourth order along a direction of all entries."""

    def at(t: float) -> Floats:
        entries = (found.at + t * direction).tolist()
        result: Floats = values(lw.replace(one, dict(zip(found.variables, entries, strict=True))))
        return result

    h = 2e-4
    difference: Floats = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h)
    return difference


def directions(found: Any, seed: int) -> list[Floats]:
    rng = np.random.default_rng(seed)
    return [rng.normal(size=len(found.at)) * np.abs(found.at) for _ in range(3)]


@pytest.mark.parametrize("case", CASES)
def test_forced_vibration_along_directions(case: str) -> None:
    """Vibratory and maximum torques of all shafts at the speed of their peaks, against differences."""
    one = machine(**CASES[case])
    found = lw.gradient(one, ["forced_vibration"])
    response = lw.forced_vibration(one)
    rows = [name.split(".")[1:] for name in found.responses]
    places = [int(getattr(response, kind)[response.shafts.index(shaft)].argmax()) for kind, shaft in rows]

    def values(changed: lw.Machine) -> Floats:
        at = lw.forced_vibration(changed, response.speeds)
        pairs = zip(rows, places, strict=True)
        return np.array([getattr(at, kind)[at.shafts.index(shaft), n] for (kind, shaft), n in pairs])

    assert values(one) == pytest.approx(found.values, rel=1e-12)
    assert {kind for kind, _ in rows} == {"shaft_torque_max", "shaft_torque_vibratory"}
    scale = np.abs(found.derivatives * found.at).max(axis=1)
    for direction in directions(found, 5):
        error = np.abs(found.derivatives @ direction - slope(found, one, values, direction))
        assert np.all(error <= 2e-8 * scale)


@pytest.mark.parametrize("case", ["carrier", "pendulum"])
def test_natural_frequencies_along_directions(case: str) -> None:
    """Frequencies and mode shapes follow teeth, inertias and stiffnesses about a carrier."""
    one = machine(**CASES[case], planetaries={"stage": STAGE | {"planets": 1}})
    found = lw.gradient(one, ["free_vibration"])
    assert {"train.planetaries.stage.teeth.0", "train.planetaries.stage.teeth.1"} <= {*found.variables}

    def values(changed: lw.Machine) -> Floats:
        free = lw.free_vibration(changed)
        return np.array([_free(free, name) for name in found.responses])

    assert values(one) == pytest.approx(found.values, rel=1e-9, abs=1e-9)
    scale = np.abs(found.derivatives * found.at).max(axis=1)
    for direction in directions(found, 6):
        error = np.abs(found.derivatives @ direction - slope(found, one, values, direction))
        assert np.all(error <= 1e-7 * scale + 1e-9 * np.abs(found.values))


def _free(free: lw.FreeVibration, response: str) -> float:
    _, kind, mode, *disc = response.split(".")
    row = getattr(free, kind)[int(mode)]
    return float(row[free.discs.index(disc[0])] if disc else row)


def test_what_is_discrete_has_no_derivative() -> None:
    """Frequencies of lines, orders and teeth determine which torques coincide."""
    one = machine(excitations=LINES)
    found = lw.gradient(one, ["forced_vibration"])
    assert "discrete" in found.refused["train.excitations.inverter.harmonics.0.frequency"]
    assert "coincide" in found.refused["train.planetaries.stage.teeth.0"]
