"""Studies of trains: all rows together give the numbers of each train by itself."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import linkwright as lw
from linkwright.studies.engine import numbers, sound_variant
from linkwright.torsion.response.many_trains import forced_vibrations, free_vibrations

JOINT = {"joint_angle": "12 deg", "joint_phase": "15 deg"}


def machine(**parts: Any) -> lw.Machine:
    """A motor with speed control, a stage, a damper, a coupling and a fan."""
    train: dict[str, Any] = {
        "discs": {
            "motor": {"inertia": 0.5, "damping": 0.1},
            "pinion": {"inertia": 0.08},
            "wheel": {"inertia": 0.6},
            "fan": {"inertia": 2.0, "damping": 0.3},
        },
        "shafts": {
            "input": {"between": ["motor", "pinion"], "stiffness": 9e3, "loss_factor": 0.02, **JOINT},
            "output": {"between": ["wheel", "fan"], "stiffness": 2e4, "damping": 2.0},
            "output_2": {"between": ["fan", "wheel"], "stiffness": 5e3, "damping": 1.0},
        },
        "gears": {"stage": {"between": ["pinion", "wheel"], "teeth": [21, 55]}},
        "dampers": {"ring": {"on": "fan", "ring_inertia": 0.4, "damping": 6.0}},
        "drivers": {"drive": {"on": "motor", "control": {"proportional": 3.0, "integral": 150.0}}},
        "loads": {"fan": {"on": "fan", "torque": 200.0, "speed": 40.0}},
        "excitations": {"pulse": {"on": "motor", "harmonics": [{"order": 2, "torque": 12.0}]}},
        "run": {"speed_min": 40.0, "speed_max": 120.0, "points": 6},
    }
    return lw.Machine.model_validate({"format": 1, "name": "many", "train": train | parts})


PLANETARY: dict[str, Any] = {
    "discs": {name: {"inertia": J} for name, J in {"sun": 0.02, "ring": 0.4, "carrier": 0.9}.items()},
    "shafts": {"seat": {"between": ["ring", "ground"], "stiffness": 8e5, "damping": 9.0}},
    "planetaries": {
        "stage": {
            "sun": "sun",
            "ring": "ring",
            "carrier": "carrier",
            "teeth": [24, 84],
            "planet_inertia": 0.002,
            "sun_stiffness": 4e5,
            "ring_stiffness": 5e6,
        }
    },
}
CURVE = {"rubber": {"between": ["wheel", "fan"], "twist": [0.0, 0.1, 0.2], "torque": [0.0, 900.0, 2500.0]}}
RESPONSES = {
    "f": "free_vibration.natural_frequencies.2",
    "shape": "free_vibration.mode_shapes.1.{disc}",
    "share": {"curve": "free_vibration.{disc}.kinetic_shares", "extreme": "max"},
    "zeta": {"curve": "damped_vibration.damping_ratios", "index": 1},
    "held": {"curve": "damped_vibration.{disc}.disc_shares", "extreme": "max"},
    "torque": "forced_vibration.shaft_torque_max.{shaft}",
    "delta": {"curve": "forced_vibration.{disc}.unevenness", "extreme": "max"},
    "heat": {"curve": "forced_vibration.{shaft}.shaft_heat", "extreme": "mean"},
    "power": {"curve": "forced_vibration.power", "extreme": "max"},
}


def study(one: lw.Machine, addresses: dict[str, tuple[float, float]], names: list[str]) -> Any:
    disc, shaft = [*one.train.discs][-1], next(iter(one.train.shafts))  # type: ignore[union-attr]
    variables = {
        f"x{n}": {"address": at, "range": list(ends)} for n, (at, ends) in enumerate(addresses.items())
    }

    def filled(text: Any) -> Any:
        named = text if isinstance(text, dict) else {"": text}
        full = {
            key: value.format(disc=disc, shaft=shaft) if isinstance(value, str) else value
            for key, value in named.items()
        }
        return full if isinstance(text, dict) else full[""]

    responses = {name: filled(RESPONSES[name]) for name in names}
    return lw.new_study(one, {"variables": variables, "responses": responses})


LUMPED = {
    "train.discs.fan.inertia": (1.0, 3.0),
    "train.discs.motor.damping": (0.05, 0.4),
    "train.shafts.input.stiffness": (5e3, 2e4),
    "train.shafts.output.stiffness": (1e4, 3e4),
    "train.shafts.output.damping": (1.0, 4.0),
    "train.shafts.input.loss_factor": (0.01, 0.05),
    "train.dampers.ring.ring_inertia": (0.2, 0.6),
}
CARRIED = {
    "train.planetaries.stage.sun_stiffness": (3e5, 5e5),
    "train.planetaries.stage.planet_inertia": (0.001, 0.003),
    "train.discs.carrier.inertia": (0.5, 1.5),
}
ALL = [*RESPONSES]
CASES: dict[str, tuple[lw.Machine, dict[str, tuple[float, float]], list[str], tuple[bool, bool]]] = {
    "tree": (machine(), LUMPED, ALL, (True, True)),
    "carrier": (
        lw.Machine.model_validate({"format": 1, "name": "carried", "train": PLANETARY}),
        CARRIED,
        ALL[:5],
        (True, False),
    ),
    "curve of a coupling": (
        machine(couplings=CURVE),
        {"train.discs.fan.inertia": (1.0, 3.0)},
        ALL,
        (True, False),
    ),
    "torque": (machine(), {"train.loads.fan.torque": (100.0, 300.0)}, ALL[5:], (False, False)),
    "without damping": (machine(), {"train.discs.motor.damping": (0.0, 0.4)}, ALL, (False, False)),
}


@pytest.mark.parametrize("case", CASES)
def test_rows_are_those_of_single_trains(case: str) -> None:
    """Row by row the numbers of the machine by itself, whether trains are computed together or not."""
    one, addresses, names, together = CASES[case]
    plan = study(one, addresses, names)
    rng = np.random.default_rng(3)
    values = {f"x{n}": rng.uniform(*ends, 40) for n, ends in enumerate(addresses.values())}
    for column, (low, _) in zip(values.values(), addresses.values(), strict=True):
        column[7] = low
    rows = lw.evaluate(plan, values)
    assert not rows.status.any(), rows.reasons
    for n in range(40):
        entries = {at: float(values[f"x{k}"][n]) for k, at in enumerate(addresses)}
        own = numbers(sound_variant(one, entries), plan.asked)
        assert [rows.columns[asked.name][n] for asked in plan.asked] == pytest.approx(
            own, rel=1e-11, abs=1e-14
        )
    columns = {at: values[f"x{k}"] for k, at in enumerate(addresses)}
    many = [free_vibrations(one, columns) is not None]
    if "power" in names:
        many.append(forced_vibrations(one, columns) is not None)
    assert many == [*together][: len(many)]


def test_rows_out_of_range_and_undamped_resonances() -> None:
    """A row with an inertia that none can have fails alone, and so does one without a finite answer."""
    train = {
        "discs": {"a": {"inertia": 1.0}, "b": {"inertia": 1.0}},
        "shafts": {"s": {"between": ["a", "b"], "stiffness": 800.0}},
        "excitations": {"pulse": {"on": "a", "harmonics": [{"order": 1, "torque": 5.0}]}},
        "run": {"speed_min": 40.0, "speed_max": 80.0, "points": 3},
    }
    one = lw.Machine.model_validate({"format": 1, "name": "bare", "train": train})
    plan = study(one, {"train.discs.b.inertia": (0.5, 2.0)}, ["torque"])
    rows = lw.evaluate(plan, {"x0": np.array([1.0, -1.0, 1.5])})
    # Between equal discs the frequency is 40 rad/s, the first speed.
    assert rows.status.astype(bool).tolist() == [True, True, False]
    assert np.isnan(rows.columns["torque"][:2]).all()
    assert rows.columns["torque"][2] > 0
