"""An engine as part of a train: firing order, torques of its throws, the train it stands for."""

import math
from typing import Any

import numpy as np
import pytest

import linkwright as lw
from linkwright import MachineError, forced_vibration, torsion_study
from linkwright.torsion import (
    ReciprocatingEngine,
    between,
    cylinder_torques,
    excited_train,
    firing_angles,
    reduced_throw,
)
from linkwright.torsion.excitation.engine_torques import engine_sources
from linkwright.torsion.model.engine.engine_motion import mean_throw_inertia

DEG = math.pi / 180
ROD = {"length": 0.32, "mass": 5.0, "distribution": 0.3}
V12: dict[str, Any] = {
    "bore": 0.15,
    "crank_radius": 0.09,
    "throws": [a * DEG for a in (0, 240, 120, 120, 240, 0)],
    "banks": [-30 * DEG, 30 * DEG],
    "firing_order": [1, 12, 5, 8, 3, 10, 6, 7, 2, 11, 4, 9],
    "rod": ROD,
    "piston_mass": 3.5,
    "throw_inertia": 0.15,
    "stiffness": 2.5e6,
    "gas": {"kind": "wiebe", "compression_ratio": 15, "mean_effective_pressure": 8e5},
}
ARTICULATED = {
    "rods": "articulated",
    "articulated": {
        "length": 0.257,
        "mass": 3.0,
        "distribution": 0.3,
        "pin_radius": 0.063,
        "pin_angle": 67 * DEG,
    },
}
HELD = {
    "out": {"between": ["throw_6", "flywheel"], "stiffness": 4e6, "loss_factor": 0.02},
    "hold": {"between": ["flywheel", "ground"], "stiffness": 1e4},
}
SPEEDS = np.array([60.0, 120.0, 160.0])


def engine(**entries: Any) -> ReciprocatingEngine:
    return ReciprocatingEngine.model_validate({**V12, **entries})


def single(**entries: Any) -> ReciprocatingEngine:
    return engine(**{"throws": [0.0], "banks": [0.0], "firing_order": [1], **entries})


def machine(**train: Any) -> lw.Machine:
    whole = {
        "engine": V12,
        "discs": {"flywheel": {"inertia": 6.0}},
        "shafts": {"out": {"between": ["throw_6", "flywheel"], "stiffness": 4e6, "loss_factor": 0.02}},
        "loads": {"brake": {"on": "flywheel", "torque": 2000.0, "speed": 150.0}},
        "run": {"speed_min": 50.0, "speed_max": 170.0, "points": 13, "loads_follow": True},
    }
    return lw.Machine.model_validate({"format": 1, "name": "V", "train": {**whole, **train}})


def test_v12_fires_every_sixty_degrees() -> None:
    v12 = engine()
    angles, cycle = firing_angles(v12.places, v12.firing_order, v12.cycle)
    assert cycle == pytest.approx(4 * math.pi)
    in_order = [angles[number - 1] for number in v12.firing_order]
    np.testing.assert_allclose(np.diff(in_order), 60 * DEG, rtol=1e-12)


def test_flat_eight_of_uneven_intervals() -> None:
    # KamAZ-740: 90° between banks, cross-shaped crank, 1-5-4-2-6-3-7-8 at even intervals.
    v8 = engine(
        throws=[a * DEG for a in (0, 90, 270, 180)],
        banks=[-45 * DEG, 45 * DEG],
        firing_order=[1, 5, 4, 2, 6, 3, 7, 8],
    )
    angles, cycle = firing_angles(v8.places, v8.firing_order, v8.cycle)
    assert cycle == pytest.approx(4 * math.pi)
    assert sorted(angles)[1] - sorted(angles)[0] == pytest.approx(math.pi / 2)


@pytest.mark.parametrize(
    ("order", "found"),
    [
        ([1, 12, 5, 8, 3, 10, 6, 7, 2, 11, 4, 4], "4"),
        ([1, 12, 5, 8, 3, 10, 6, 7, 2, 11, 4], "without 9"),
        ([1, 12, 5, 8, 3, 10, 6, 7, 2, 11, 4, 13], "13"),
        ([1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12], "revolutions"),
    ],
)
def test_orders_that_are_none(order: list[int], found: str) -> None:
    with pytest.raises(MachineError, match=r"firing_order") as raised:
        machine(engine={**V12, "firing_order": order})
    assert found in str(raised.value)


def test_parallel_twin_fires_every_turn() -> None:
    twin = engine(throws=[0.0, 0.0], banks=[0.0], firing_order=[1, 2])
    assert firing_angles(twin.places, twin.firing_order, twin.cycle) == ([0.0, 2 * math.pi], 4 * math.pi)


def test_two_strokes_on_one_throw_angle_fire_together() -> None:
    twin = engine(
        strokes=2, throws=[0.0, 0.0], banks=[0.0], firing_order=[1, 2], gas={**V12["gas"], "valves": {}}
    )
    assert firing_angles(twin.places, twin.firing_order, twin.cycle) == ([0.0, 0.0], 2 * math.pi)
    # Which of the two comes first in the order has no meaning.
    alone, other = (source.harmonics for source in engine_sources(twin, SPEEDS))
    np.testing.assert_allclose(alone, other, rtol=1e-12)


def test_order_is_not_made_to_fit_by_turning_back() -> None:
    # Backwards through the dead centres takes two revolutions; the twins at 0° cannot take one of them back.
    with pytest.raises(MachineError, match=r"repeats after 2 revolutions"):
        machine(
            engine={
                **V12,
                "strokes": 2,
                "throws": [a * DEG for a in (0, 0, 120, 240)],
                "banks": [0.0],
                "firing_order": [1, 2, 3, 4],
                "gas": {**V12["gas"], "valves": {}},
            }
        )


def test_two_strokes_fire_every_turn() -> None:
    two = single(strokes=2, gas={**V12["gas"], "valves": {}})
    assert firing_angles(two.places, two.firing_order, two.cycle)[1] == pytest.approx(2 * math.pi)
    orders = engine_sources(two, SPEEDS)[0].orders
    assert orders[0] == 1.0


@pytest.mark.parametrize("made", [engine(), engine(**ARTICULATED)])
def test_mean_torque_is_the_indicated_work(made: ReciprocatingEngine) -> None:
    gas = cylinder_torques(made, SPEEDS)
    stroke = [each.mean_effective_pressure for each in gas.banks]
    np.testing.assert_allclose(stroke, 8e5, rtol=1e-6)
    of_throws = sum(each.mean for each in engine_sources(made, SPEEDS) if each.mean is not None)
    # M̄ = p_i V_h z/(4π) (Heywood, chapter 2); articulated pistons have a longer stroke.
    plain = 8e5 * math.pi / 4 * 0.15**2 * 0.18 * 12 / (4 * math.pi)
    if made.articulated is None:
        np.testing.assert_allclose(of_throws, plain, rtol=1e-6)
    else:
        assert (of_throws > 1.005 * plain).all()


def test_torque_of_one_cylinder_over_its_angle() -> None:
    one = single(bore=0.15)
    (source,) = engine_sources(one, SPEEDS, highest=48.0)
    phi = np.linspace(0, 4 * math.pi, 721)
    torque = source.mean + (np.exp(1j * np.outer(phi, source.orders)) @ source.harmonics).real  # type: ignore[operator]
    from linkwright.torsion import Cylinder, piston_positions

    cylinder = Cylinder(0.15, 4, piston_positions(one)[0])
    pressure = one.gas.cycle_pressure(cylinder, SPEEDS)
    trace = pressure.firing @ pressure.traces
    angle = np.remainder(pressure.angle, 4 * math.pi)
    order = np.argsort(angle)
    p = np.interp(phi, angle[order], trace[1][order], period=4 * math.pi)
    x_d1 = -0.09 * np.sin(phi) - 0.09**2 * np.sin(phi) * np.cos(phi) / np.sqrt(
        0.32**2 - (0.09 * np.sin(phi)) ** 2
    )
    throw = reduced_throw(one, phi)
    direct = (
        -(p - 101325.0) * math.pi / 4 * 0.15**2 * x_d1 + throw.inertia_torque(SPEEDS[1]) + throw.weight_torque
    )
    # 96 harmonics of a pressure that rises within a few degrees leave a hundredth of the peak.
    assert np.abs(torque[:, 1] - direct).max() < 1e-2 * np.abs(direct).max()


def test_throws_have_the_mean_of_their_inertia() -> None:
    free = lw.free_vibration(machine())
    assert free.discs[:6] == tuple(f"throw_{n}" for n in range(1, 7))
    # Paper 3, (7), with both rods and pistons: its bracket is good to λ⁴.
    lam = 0.09 / 0.32
    published = 0.15 + 2 * 0.09**2 * (0.3 * 5.0 + 0.5 * (0.7 * 5.0 + 3.5) * (1 + lam**2 / 4))
    assert mean_throw_inertia(engine()) == pytest.approx(published, rel=1e-3)


def test_misfire_brings_half_orders() -> None:
    sound = forced_vibration(machine())
    missing = forced_vibration(machine(engine={**V12, "factors": {"3": 0.0}}))
    # Twelve equal cylinders leave nothing of the half order but what twists the crankshaft.
    whole = [sum(s.harmonics[0] for s in engine_sources(engine(factors=f), SPEEDS)) for f in ({}, {"3": 0.0})]
    assert (np.abs(whole[0]) < 1e-9 * np.abs(whole[1])).all()
    assert (missing.unevenness[-1] > sound.unevenness[-1]).all()


def test_loads_take_what_the_engine_gives() -> None:
    found = forced_vibration(machine())
    mean = 8e5 * math.pi / 4 * 0.15**2 * 0.18 * 12 / (4 * math.pi)
    np.testing.assert_allclose(found.mean_torques[-1], mean, rtol=1e-6)
    # From throw to throw one twelfth after another.
    np.testing.assert_allclose(found.mean_torques[0], mean / 6, rtol=1e-6)


def test_engine_without_a_load_speeds_all_up_rings_too() -> None:
    ring = {"on": "flywheel", "ring_inertia": 0.8, "damping": 30.0}
    at = excited_train(machine(loads={}, dampers={"ring": ring}), SPEEDS)
    J = at.referred.inertia
    faster = at.torques.mean.sum(axis=0) / J.sum()
    of = dict(zip(at.referred.shafts, at.mean_torques, strict=True))
    # What each shaft speeds up: flywheel and ring, of which the fluid takes the ring.
    np.testing.assert_allclose(of["out"], (6.0 + 0.8) * faster, rtol=1e-9)
    np.testing.assert_allclose(of["ring"], 0.8 * faster, rtol=1e-9)


def test_ring_of_a_balanced_train_takes_nothing() -> None:
    ring = {"on": "flywheel", "ring_inertia": 0.8, "damping": 30.0}
    at = excited_train(machine(dampers={"ring": ring}), SPEEDS)
    assert not at.mean_torques[at.referred.shafts.index("ring")].any()


@pytest.mark.parametrize(
    ("entries", "word"),
    [
        ({}, None),
        ({"loads": {}}, "accelerates the train"),
        ({"engine": {**V12, "factors": {str(n): 0.0 for n in range(1, 13)}}}, "the loads drive the engine"),
        # What is held neither speeds up nor is driven.
        ({"loads": {}, "shafts": HELD}, None),
    ],
)
def test_loads_that_do_not_take_what_the_engine_gives_are_told(
    entries: dict[str, Any], word: str | None
) -> None:
    warnings = torsion_study(machine(**entries)).warnings
    assert [word in each for each in warnings] == [True] if word else warnings == []


def test_survey_of_few_speeds_computes_those_between() -> None:
    few = machine(run={"speed_min": 50.0, "speed_max": 170.0, "points": 3})
    here = np.array([93.0])
    found, exact = between(few, excited_train(few), here), excited_train(few, here)
    np.testing.assert_allclose(found.torques.harmonics, exact.torques.harmonics, rtol=1e-12)


@pytest.mark.parametrize(
    ("entries", "key"),
    [
        ({"throws": []}, "throws"),
        ({"throws": [0.1, 0, 0, 0, 0, 0]}, "throws.0"),
        ({"rods": "articulated"}, "articulated"),
        ({"articulated": ARTICULATED["articulated"]}, "articulated"),
        ({"throw_inertia": None}, "throw_inertia"),
        ({"stiffness": None}, "stiffness"),
        ({"limit": {"stress_permitted": 4e7}}, "limit.diameter"),
        ({"factors": {"13": 0.5}}, "factors.13"),
        ({"gas": {**V12["gas"], "valves": {"exhaust_opens": 0.1}}}, "gas"),
    ],
)
def test_what_contradicts_itself(entries: dict[str, Any], key: str) -> None:
    with pytest.raises(MachineError) as raised:
        machine(engine={**V12, **entries})
    assert f"train.engine.{key}" in str(raised.value)


def test_names_of_throws_are_taken() -> None:
    with pytest.raises(MachineError, match="throw_1"):
        machine(discs={"flywheel": {"inertia": 6.0}, "throw_1": {"inertia": 1.0}})
