"""Several drivers of one train: mean torques by statics, engines by symmetry and by an engine alone."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import linkwright as lw
from linkwright import MachineError, forced_vibration
from linkwright.torsion import Train, excited_train
from linkwright.torsion.core.train import refer
from linkwright.torsion.excitation.drive_line import train_of

SHIP = Path(__file__).parents[2] / "examples" / "twin_engine_ship" / "machine.toml"


def ship(**entries: Any) -> lw.Machine:
    run = {"train.run.points": 4, "train.run.orders_max": 6.0}
    return lw.replace(lw.read(SHIP), run | {name.replace("__", "."): each for name, each in entries.items()})


def turbines(**train: Any) -> lw.Machine:
    """Two turbines, a wheel, a propeller; the pinions turn five and eight times as fast as the wheel."""
    return lw.Machine.model_validate(
        {
            "format": 1,
            "name": "turbines",
            "train": {
                "discs": {name: {"inertia": 1.0} for name in ("a", "b", "pa", "pb", "wheel", "screw")},
                "shafts": {
                    "of_a": {"between": ["a", "pa"], "stiffness": 1e5},
                    "of_b": {"between": ["b", "pb"], "stiffness": 1e5},
                    "line": {"between": ["wheel", "screw"], "stiffness": 1e6},
                },
                "gears": {
                    "ga": {"between": ["pa", "wheel"], "ratio": 5},
                    "gb": {"between": ["pb", "wheel"], "ratio": 8},
                },
                "loads": {"water": {"on": "screw", "torque": 4000.0, "speed": 20.0, "exponent": 2}},
                "excitations": {"e": {"on": "screw", "harmonics": [{"order": 5, "torque": 10.0}]}},
                "run": {"speed_min": 50.0, "speed_max": 100.0, "points": 3},
                **train,
            },
        }
    )


@pytest.mark.parametrize(
    ("drivers", "of_a", "of_b"),
    [
        # 4000 N m at the wheel are 800 N m at a and 500 N m at b.
        ({"a": {"on": "a", "share": "30 %"}, "b": {"on": "b", "share": "70 %"}}, 240.0, 350.0),
        ({"a": {"on": "a"}, "b": {"on": "b"}}, 400.0, 250.0),
        # 100 N m as given take 800 of the 4000 N m; at constant power 50 N m at 80 rad/s are 25 N m at 160.
        ({"a": {"on": "a"}, "b": {"on": "b", "torque": 100.0}}, 640.0, 100.0),
        ({"a": {"on": "a"}, "b": {"on": "b", "torque": 50.0, "speed": 80.0, "exponent": -1}}, 760.0, 25.0),
    ],
)
def test_mean_torques_balance_over_the_branches(drivers: dict[str, Any], of_a: float, of_b: float) -> None:
    found = forced_vibration(turbines(drivers=drivers), np.array([100.0]))
    mean = dict(zip(found.shafts, found.mean_torques[:, 0], strict=True))
    assert mean == pytest.approx({"of_a": of_a, "of_b": of_b, "line": 4000.0}, rel=1e-12)


def test_drivers_hold_a_motion_in_time() -> None:
    """Constant torques by the shares: nothing moves beyond the steady twist."""
    drivers = {"a": {"on": "a", "share": 1}, "b": {"on": "b", "share": 3}}
    moved = lw.torsion_transient(
        turbines(drivers=drivers, excitations={}, transient={"duration": 0.1, "speed": 100.0, "settle": 0})
    )
    mean = dict(zip(moved.shafts, moved.torque_max, strict=True))
    assert mean == pytest.approx({"of_a": 200.0, "of_b": 375.0, "line": 4000.0}, rel=1e-6)
    assert "a is driven by a constant 200 N m and b by a constant 375 N m" in moved.balance


def test_engines_in_phase_are_symmetric_and_lead_by_their_phase() -> None:
    at = excited_train(ship(train__engines__starboard__phase=0.0))
    led = excited_train(ship())
    n = 6
    port, starboard = at.torques.harmonics[:, :n], at.torques.harmonics[:, n : 2 * n]
    np.testing.assert_array_equal(port, starboard)
    turned = np.exp(1j * at.torques.orders * np.radians(40))[:, None, None]
    np.testing.assert_allclose(led.torques.harmonics[:, n : 2 * n], turned * port, rtol=1e-9, atol=1e-6)
    # In phase nothing swings against its twin.
    found = lw.forced_vibration(ship(train__engines__starboard__phase=0.0))
    a, b = (found.shaft_torques[:, found.shafts.index(f"{side}_crank_3")] for side in ("port", "starboard"))
    np.testing.assert_allclose(a, b, atol=1e-9 * np.abs(a).max())


def test_geared_engine_is_that_engine_at_its_own_speed() -> None:
    """An engine behind a stage of ratio 1 : 2 against one alone at twice the speed."""
    machine = lw.read("v8_diesel")
    engine = machine.train.engine
    slow, fast = "slow_throw_1", "fast_throw_1"
    geared = machine.model_copy(
        update={
            "train": Train.model_validate(
                {
                    "engine": engine,
                    "engines": {"slow": {}, "fast": {"factors": {"2": 0.5}}},
                    "gears": {"stage": {"between": [slow, fast], "ratio": 0.5}},
                    "run": {"speed_min": 60.0, "speed_max": 70.0, "points": 2, "orders_max": 4},
                }
            )
        }
    )
    alone = lw.replace(machine, {"train.engine.factors": {"2": 0.5}, "train.run.orders_max": 4.0})
    at, by_itself = excited_train(geared), excited_train(alone, 2 * np.array([60.0, 70.0]))
    place = at.referred.discs.index(fast)
    assert at.referred.speed[place] == pytest.approx(2.0)
    for k, order in enumerate(by_itself.torques.orders):
        row = np.abs(at.torques.orders - 2 * order).argmin()
        expected = by_itself.torques.harmonics[k, :4]
        np.testing.assert_allclose(at.torques.harmonics[row, place : place + 4], expected, rtol=1e-9)


def test_discs_and_shafts_carry_the_names_of_their_engines() -> None:
    train = train_of(ship())
    assert list(train.discs)[:2] == ["port_throw_1", "port_throw_2"]
    assert "starboard_crank_5" in train.shafts
    assert len(refer(train).discs) == 22


@pytest.mark.parametrize(
    ("train", "words"),
    [
        ({"driver": "a", "drivers": {"b": {"on": "b"}}}, "none beside"),
        ({"drivers": {"b": {"on": "c"}}}, "name of a disc"),
        ({"drivers": {"b": {"on": "b", "speed": 3.0}}}, "none without a torque"),
        ({"engines": {"port": {}}}, "the engine itself"),
    ],
)
def test_contradictions_are_told(train: dict[str, Any], words: str) -> None:
    with pytest.raises(MachineError, match=words):
        turbines(**train)


def test_misfire_names_its_engine() -> None:
    event = {"kind": "misfire", "time": 0.1, "cylinders": [2]}
    transient = {"duration": 1.0, "speed": "600 rpm", "events": [event]}
    with pytest.raises(MachineError, match="the engine whose cylinders"):
        lw.torsion_transient(ship(train__transient=transient))
