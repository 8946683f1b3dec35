"""Weak cylinders of an engine described in a machine file, and a survey of its train."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import linkwright as lw
from linkwright import InputError, engine_diagnosis, forced_vibration, read
from linkwright.kernel.files.library import template
from linkwright.torsion import EngineSpeed, MeasuredSpeed, between, excited_train, survey
from linkwright.torsion.limits.survey import _about

SPEED = 1500 * np.pi / 30
NOISE = 2e-3


@pytest.fixture(scope="module")
def v12() -> lw.Machine:
    return read(Path(__file__).parents[2] / "machines" / "v_diesel.toml", [])


def with_factors(machine: lw.Machine, factors: dict[str, float]) -> lw.Machine:
    assert machine.train is not None
    assert machine.train.engine is not None
    engine = machine.train.engine.model_copy(update={"factors": factors})
    return machine.model_copy(update={"train": machine.train.model_copy(update={"engine": engine})})


def measured(machine: lw.Machine, disc: str, seed: int | None = None) -> MeasuredSpeed:
    found = forced_vibration(machine, np.array([SPEED]))
    speed = 1j * found.orders * SPEED * found.amplitudes[:, found.discs.index(disc), 0]
    if seed is not None:
        noise = np.random.default_rng(seed).normal(0, NOISE, (2, len(speed)))
        speed = speed + noise[0] + 1j * noise[1]
    return MeasuredSpeed(disc, found.orders, speed, np.full(len(found.orders), NOISE))


def test_weak_cylinders_of_a_v12_are_found_at_both_ends(v12: lw.Machine) -> None:
    sick = with_factors(v12, {"7": 0.5, "2": 0.8})
    wanted = np.ones(12)
    wanted[[6, 1]] = 0.5, 0.8
    for disc in ("front", "flywheel"):
        found = engine_diagnosis(v12, measured(sick, disc), SPEED)
        # Its loads take less, and pulsate and damp by that share less.
        np.testing.assert_allclose(found.factor, wanted, atol=1e-8)
        noisy = engine_diagnosis(v12, measured(sick, disc, seed=1), SPEED)
        assert noisy.weak()[:2] == (("7", "2") if disc == "front" else ("7",))
        assert (np.abs(noisy.factor - wanted) < 5 * noisy.deviation).all()


def test_a_file_that_calls_cylinders_weak_is_judged_against_a_sound_engine(v12: lw.Machine) -> None:
    sick = with_factors(v12, {"4": 0.0})
    found = engine_diagnosis(sick, measured(sick, "flywheel"), SPEED)
    assert found.factor[3] == pytest.approx(0.0, abs=1e-8)


def test_rigid_train_names_other_cylinders(v12: lw.Machine) -> None:
    found = engine_diagnosis(v12, measured(with_factors(v12, {"7": 0.5}), "front"), SPEED, rigid=True)
    assert np.argmin(found.relative) != 6
    assert "times the noise" in found.warnings[-1]


def test_behind_a_soft_coupling_cylinders_can_hardly_be_told(v12: lw.Machine) -> None:
    near, far = (engine_diagnosis(v12, measured(v12, disc), SPEED) for disc in ("flywheel", "generator"))
    assert far.deviation.min() > 50 * near.deviation.max()


def test_states_of_an_engine_are_those_of_its_file(v12: lw.Machine) -> None:
    """Torques, loads and damping with cylinder 8 dead and 3 strong, from the file and as a state."""
    x = np.zeros((12, 1))
    x[[7, 2], 0] = -1.0, 0.2
    at = EngineSpeed(v12, SPEED, "flywheel").states(x)
    of_file = excited_train(with_factors(v12, {"8": 0.0, "3": 1.2}), np.array([SPEED]))
    np.testing.assert_allclose(at.torques.harmonics, of_file.torques.harmonics, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(at.mean_torques, of_file.mean_torques, rtol=1e-9)
    np.testing.assert_allclose(at.operating.disc_damping, of_file.operating.disc_damping, rtol=1e-9)


def test_machine_without_an_engine() -> None:
    with pytest.raises(InputError, match=r"no \[train.engine\]"):
        engine_diagnosis(
            lw.loads(template("slider-crank")), MeasuredSpeed("a", np.ones(1), np.ones(1, complex)), 1.0
        )


def test_torques_between_speeds_are_close_to_those_of_the_engine(v12: lw.Machine) -> None:
    at = excited_train(v12)
    speeds = 0.5 * (at.torques.speeds[:-1] + at.torques.speeds[1:])[::20]
    near, exact = between(v12, at, speeds), excited_train(v12, speeds)
    size = np.abs(exact.torques.harmonics).max()
    # Cubics through speeds 0.6 rad/s apart; the gas itself is followed to some 10⁻⁶.
    np.testing.assert_allclose(near.torques.harmonics, exact.torques.harmonics, atol=1e-5 * size)
    np.testing.assert_allclose(near.mean_torques, exact.mean_torques, rtol=1e-4, atol=1e-2)


def test_cubics_pass_through_cubics() -> None:
    """Torques that grow with Ω³ and speeds at and between four known ones, first and last too."""
    text = """
format = 1
name = "Two discs"
[train.discs]
a = { inertia = 2 }
b = { inertia = 3 }
[train.shafts]
s = { between = ["a", "b"], stiffness = 1e4 }
[train.excitations.pulse]
on = "a"
harmonics = [{ order = 2, torque = 80 }]
speed = 10
exponent = 3
[train.run]
speed_min = 10
speed_max = 50
points = 6
"""
    at = excited_train(lw.loads(text))
    speeds = np.array([10.0, 11.0, 26.0, 49.0, 50.0])
    places, weights = _about(at.torques.speeds, speeds)
    found = sum(w * at.torques.harmonics[0, 0, n] for n, w in zip(places, weights, strict=True))
    np.testing.assert_allclose(found, 80 * (speeds / 10) ** 3, rtol=1e-12)


def test_survey_looks_at_the_run_and_at_every_resonance(v12: lw.Machine) -> None:
    seen = survey(v12)
    assert (np.diff(seen.speeds) > 0).all()
    run = seen.at.torques.speeds
    listed = np.array([each.speed for each in seen.resonances])
    assert np.isin(run, seen.speeds).all()
    assert np.abs(seen.speeds[:, None] - listed).min(axis=0).max() < 1e-6
    # Rows are those of the speeds one by one.
    direct = seen.criteria_at(seen.speeds[[3, 40]])
    for one, other in zip(seen.criteria, direct, strict=True):
        np.testing.assert_allclose(one.found[[3, 40]], other.found, rtol=1e-5)


@pytest.mark.parametrize(
    ("disc", "factor", "deviation", "misfit", "weakest"),
    [("front", -34, 0.002, 245, "1"), ("flywheel", 10.0, 0.012, 72, None)],
)
def test_numbers_of_the_page_on_diagnosis(
    v12: lw.Machine, disc: str, factor: float, deviation: float, misfit: float, weakest: str | None
) -> None:
    """Its table, to its printed digits."""
    exact = measured(with_factors(v12, {"7": 0.5}), disc)
    seen = MeasuredSpeed(disc, exact.orders, exact.harmonics, np.full(len(exact.orders), 1e-3))
    elastic, rigid = (engine_diagnosis(v12, seen, SPEED, rigid=way) for way in (False, True))
    assert elastic.factor[6] == pytest.approx(0.5, abs=5e-4)
    assert elastic.deviation[6] == pytest.approx(deviation, abs=5e-4)
    assert rigid.factor[6] == pytest.approx(factor, rel=0.02)
    assert rigid.misfit == pytest.approx(misfit, rel=0.01)
    assert next(iter(rigid.weak()), None) == weakest
