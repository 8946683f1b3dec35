"""Every motor with every gearbox: what is judged at once is what each pair is judged by itself."""

from __future__ import annotations

import numpy as np
import pytest
from axis_cycles import inertia_cycle, motion

from linkwright.axes.choice import CHECKS, choose_servo
from linkwright.axes.driver_cycle import DriverCycle
from linkwright.axes.model.axis_catalogue import CatalogueGearbox, CatalogueServo
from linkwright.axes.model.axis_gearbox import AxisGearbox
from linkwright.axes.model.servo_motor import ServoMotor
from linkwright.kernel.errors import InputError


def servos(n: int, seed: int = 1) -> tuple[CatalogueServo, ...]:
    """Random motors of half to fifty newton metres, with curves of different lengths."""
    rng, found = np.random.default_rng(seed), []
    for nth in range(n):
        torque, top = 10 ** rng.uniform(-0.5, 1.7), rng.choice([300.0, 450.0, 600.0])
        knees = np.sort(rng.uniform(0.3, 0.9, rng.integers(1, 4)))
        peaks = np.append(3.0, np.sort(rng.uniform(1.3, 3.0, len(knees) + 1))[::-1])
        entries = {
            "inertia": 1e-5 * torque**1.4 * 10 ** rng.uniform(-0.3, 0.3),
            "continuous": {"speed": (0, 0.5 * top, top), "torque": (1.1 * torque, torque, 0.4 * torque)},
            "peak": {"speed": (0, *knees * top, top), "torque": tuple(peaks * torque)},
            "speed_max": top * rng.choice([1.0, 1.2]),
        }
        motor = ServoMotor.model_validate(entries)
        found.append(CatalogueServo(f"M{nth}", motor, torque * top, 100 + 10 * torque))
    return tuple(found)


def gearboxes(n: int) -> tuple[CatalogueGearbox, ...]:
    return tuple(
        CatalogueGearbox(
            f"G{nth}",
            AxisGearbox.model_validate(
                {
                    "ratio": ratio,
                    "efficiency": 0.95,
                    "inertia": 2e-5,
                    "torque_max": 45 + ratio,
                    "speed_max": 500,
                }
            ),
            10.0 * ratio,
        )
        for nth, ratio in enumerate(np.geomspace(1, 100, n))
    )


def lively_cycle() -> DriverCycle:
    """An inertia with a load that has its own ups and downs."""
    time, speed, acceleration = motion(121)
    torque = 0.02 * acceleration + 1.0 + 3 * np.sin(40 * time)
    return DriverCycle(time, speed, acceleration, torque, 0.02)


def test_all_pairs_at_once_are_judged_as_each_by_itself() -> None:
    """Every check of every pair: its utilisation, and what cannot be known."""
    choice = choose_servo(lively_cycle(), servos(40), gearboxes(12), goal="cost")
    for m in range(40):
        for g in range(12):
            duty = choice.duty(m, g)
            for check in duty.checks:
                used = choice.utilisation[CHECKS.index(check.name), m, g]
                assert np.isnan(used) if check.passed is None else used == pytest.approx(check.utilisation)
            assert choice.passes[m, g] == duty.passes
            assert bool(choice.reasons(m, g)) != duty.passes
    assert 0 < len(choice.order) < 40 * 12
    assert set(choice.refused) >= {"speed", "torque_rms", "torque_peak", "inertia_ratio"}


@pytest.mark.parametrize("goal", ["cost", "power", "inertia", "rms"])
def test_pairs_are_sorted_by_the_goal(goal: str) -> None:
    choice = choose_servo(lively_cycle(), servos(60), gearboxes(10), goal=goal)  # type: ignore[arg-type]
    pairs = choice.order.tolist()
    values = {
        "cost": [choice.motors[m].cost + choice.gearboxes[g].cost for m, g in pairs],  # type: ignore[operator]
        "power": [choice.motors[m].power_rated for m, g in pairs],
        "inertia": [choice.motors[m].motor.rotor for m, g in pairs],
        "rms": [choice.utilisation[1, m, g] for m, g in pairs],
    }[goal]
    assert values == sorted(values)  # type: ignore[type-var]
    assert len(pairs) == np.sum(choice.passes)
    shown = choice.to_dict(most=3)
    assert [entry["motor"] for entry in shown["chosen"]] == [choice.motors[m].type for m, _ in pairs[:3]]
    assert shown["chosen"][0]["passes"]


def test_where_none_passes_the_nearest_is_told_with_its_reasons() -> None:
    """A load beyond all motors: the nearest pair, and how many pairs each check refuses."""
    heavy = inertia_cycle(500.0)
    choice = choose_servo(heavy, servos(10), gearboxes(5))
    assert len(choice.order) == 0
    shown = choice.to_dict()
    assert not shown["nearest"][0]["passes"]
    assert choice.reasons(*choice.nearest)
    worst = np.nan_to_num(choice.utilisation, nan=np.inf).max(axis=0)
    assert worst[choice.nearest] == worst.min()
    assert sum(shown["refused"].values()) >= 50
    best = dict(choice.best_gearboxes())
    assert list(best) == list(range(10))


def test_a_goal_needs_its_column() -> None:
    motors = (*servos(2), CatalogueServo("bare", servos(1)[0].motor))
    with pytest.raises(InputError, match="motors: bare has no cost; add a column cost"):
        choose_servo(lively_cycle(), motors, gearboxes(2), goal="cost")
    with pytest.raises(InputError, match="coupling"):
        choose_servo(lively_cycle(), motors, gearboxes(2), coupling=-1.0)
    with pytest.raises(InputError, match="gearboxes: found none"):
        choose_servo(lively_cycle(), motors, ())
    with pytest.raises(InputError, match='expected one of "cost", "power"'):
        choose_servo(lively_cycle(), motors, gearboxes(2), goal="price")  # type: ignore[arg-type]
