"""Weak cylinders from a measured speed: exact without noise, as uncertain as stated with it."""

from __future__ import annotations

import firing
import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import stats

from linkwright import InputError, ShapeError, forced_vibration, measured_speed
from linkwright.kernel.numerics.confidence import coverage_factor
from linkwright.torsion import Diagnosis, ExcitedTrain, MeasuredSpeed, excited_train
from linkwright.torsion.diagnosis.diagnosis import diagnosis
from linkwright.torsion.diagnosis.engine_speed import cylinder_response

Complexes = NDArray[np.complex128]

SPEED = 95.0
WEAK = [1.0, 0.97, 0.55, 1.02, 1.0, 0.93]
# Standard deviation of each harmonic [rad/s]: a tenth of a percent of the speed's own swing.
NOISE = 2e-4


def healthy(**entries: object) -> ExcitedTrain:
    return excited_train(firing.engine(**entries), np.array([SPEED]))  # type: ignore[arg-type]


def speed_of(factors: list[float], disc: str, **entries: object) -> Complexes:
    found = forced_vibration(firing.engine(factors, **entries), np.array([SPEED]))  # type: ignore[arg-type]
    theta = found.amplitudes[:, found.discs.index(disc), 0]
    return 1j * found.orders * SPEED * theta


def seen(disc: str = "flywheel", noise: float | None = NOISE, factors: list[float] = WEAK) -> MeasuredSpeed:
    spread = None if noise is None else np.full(len(firing.ORDERS), noise)
    return MeasuredSpeed(disc, firing.ORDERS, speed_of(factors, disc), spread)


def noisy(measured: MeasuredSpeed, generator: np.random.Generator, noise: float = NOISE) -> MeasuredSpeed:
    more = generator.normal(0, noise, (2, len(measured.orders)))
    return MeasuredSpeed(
        measured.disc, measured.orders, measured.harmonics + more[0] + 1j * more[1], measured.noise
    )


@pytest.mark.parametrize("disc", ["throw_1", "throw_4", "flywheel", "brake"])
def test_factors_are_exact_without_noise(disc: str) -> None:
    found = diagnosis(healthy(), firing.sources(), seen(disc))
    # Rounding, times how unlike the cylinders act.
    np.testing.assert_allclose(found.factor, WEAK, atol=1e-9 * found.condition)
    assert found.weak()[0] == "3"


def test_healthy_engine_is_told_healthy() -> None:
    found = diagnosis(healthy(), firing.sources(), seen(factors=[1.0] * 6))
    np.testing.assert_allclose(found.factor, 1, atol=1e-9)
    assert found.weak() == ()


def test_unit_responses_are_those_of_the_train_under_one_cylinder() -> None:
    at, each = healthy(), firing.sources()
    found = cylinder_response(at, each, "throw_1")
    wanted = speed_of([1, 0, 0, 0, 0, 0], "throw_1") - speed_of([0] * 6, "throw_1")
    np.testing.assert_allclose(found[0], wanted, rtol=1e-9, atol=1e-13)


@pytest.mark.parametrize("known", [True, False])
def test_intervals_hold_the_truth_as_often_as_stated(known: bool) -> None:
    """95 % intervals of 6 factors in 400 trials."""
    generator = np.random.default_rng(5)
    at, each, exact = healthy(), firing.sources(), seen(noise=NOISE if known else None)
    found = [diagnosis(at, each, noisy(exact, generator)) for _ in range(400)]
    errors = np.array([one.factor for one in found]) - WEAK
    held = np.abs(errors) <= np.array([one.half_width(0.95) for one in found])
    # Each factor: binomial of 400 at 0.95, deviation 0.011; four of them.
    np.testing.assert_allclose(held.mean(axis=0), 0.95, atol=0.045)
    if known:
        # Deviations themselves: relative error 1/√800 = 3.5 %, four of them.
        np.testing.assert_allclose(errors.std(axis=0), found[0].deviation, rtol=0.15)
    # The weak cylinder is named each time.
    assert all(one.weak()[0] == "3" for one in found)


def test_few_degrees_of_freedom_widen_the_intervals() -> None:
    """Four orders for six cylinders leave two, whose interval is 4.3 deviations wide, not 1.96."""
    generator = np.random.default_rng(7)
    at, each, exact = healthy(), firing.sources(), seen(noise=None)
    few = MeasuredSpeed(exact.disc, exact.orders[:4], exact.harmonics[:4])
    found = [diagnosis(at, each, noisy(few, generator)) for _ in range(400)]
    assert found[0].freedom == 2
    held = [np.abs(one.factor - WEAK) <= one.half_width(0.95) for one in found]
    # As above; with 1.96 the share would be 81 %.
    np.testing.assert_allclose(np.mean(held, axis=0), 0.95, atol=0.045)


def test_healthy_cylinders_are_seldom_called_weak() -> None:
    """A healthy engine in at most 5 % of the cases: 400 trials, deviation 1.1 %, four of them."""
    generator = np.random.default_rng(11)
    at, each, exact = healthy(), firing.sources(), seen(factors=[1.0] * 6)
    false = sum(bool(diagnosis(at, each, noisy(exact, generator)).weak()) for _ in range(400))
    assert 0.005 < false / 400 < 0.05 + 0.045


def test_rigid_train_gives_other_factors_and_tells_that_it_does_not_fit() -> None:
    measured = seen("throw_1")
    at, each = healthy(), firing.sources()
    elastic, rigid = (diagnosis(at, each, measured, rigid=way) for way in (False, True))
    assert np.abs(elastic.factor - WEAK).max() < 1e-6
    assert np.abs(rigid.factor - WEAK).max() > 0.2
    assert any("times the noise" in each for each in rigid.warnings)
    assert not any("times the noise" in each for each in elastic.warnings)


def test_stiff_train_is_the_rigid_one() -> None:
    at = healthy(stiffness=1e12, coupling=1e12)
    for disc in ("throw_2", "brake"):
        found = cylinder_response(at, firing.sources(), disc)
        rigid = cylinder_response(at, firing.sources(), disc, rigid=True)
        np.testing.assert_allclose(found, rigid, rtol=1e-5)


def test_rigid_response_is_torque_over_inertia_and_damping() -> None:
    at = healthy(damping=3.0)
    found = cylinder_response(at, firing.sources(), "throw_2", rigid=True)
    omega = firing.ORDERS * SPEED
    J, c = 6 * 0.06 + 2.5 + 0.8, 6 * 3.0 + 1.0
    wanted = firing.sources()[1, :, 1] / (1j * omega * J + c)
    np.testing.assert_allclose(found[1], wanted, rtol=1e-12)


def test_cylinders_a_turn_apart_cannot_be_told_apart_by_whole_orders() -> None:
    """On a rigid train 1 and 6, 5 and 2, 3 and 4 act alike at whole orders."""
    whole = firing.ORDERS % 1 == 0
    measured = seen()
    part = MeasuredSpeed("flywheel", measured.orders[whole], measured.harmonics[whole], np.full(6, NOISE))
    found = diagnosis(healthy(), firing.sources(), part, rigid=True)
    assert found.condition == np.inf
    assert np.isinf(found.deviation).all()
    np.testing.assert_array_equal(found.factor, 1)
    assert found.weak() == ()
    assert "cannot be distinguished" in found.warnings[0]


def test_cylinders_that_act_alike_are_told() -> None:
    """Stiff crank, whole orders: the soft shaft alone tells neighbours apart, hardly."""
    whole = firing.ORDERS % 1 == 0
    at = healthy(stiffness=3e7)
    harmonics = speed_of(WEAK, "flywheel", stiffness=3e7)[whole]
    part = MeasuredSpeed("flywheel", firing.ORDERS[whole], harmonics, np.full(6, NOISE))
    found = diagnosis(at, firing.sources(), part)
    alike = [each for each in found.warnings if "parallel responses" in each]
    assert {each.split(" (")[0] for each in alike} >= {
        "cylinders 1 and 6 have parallel responses",
        "cylinders 2 and 5 have parallel responses",
    }
    # What is the sum of two is known much better than each.
    both = np.array([1, 0, 0, 0, 0, 1])
    assert np.sqrt(both @ found.covariance @ both) < 0.05 * found.deviation[0]


def test_noise_that_hides_a_misfire_is_told() -> None:
    found = diagnosis(healthy(), firing.sources(), seen(noise=5.0))
    assert any("even a misfire would be hidden" in each for each in found.warnings)
    assert found.weak() == ()


def test_fewer_orders_than_needed() -> None:
    exact = seen(noise=None)
    few = MeasuredSpeed("flywheel", exact.orders[:3], exact.harmonics[:3])
    with pytest.raises(InputError, match="measure more than 3 orders"):
        diagnosis(healthy(), firing.sources(), few)
    # With the noise known three orders do for six cylinders, without any degree of freedom.
    found = diagnosis(
        healthy(), firing.sources(), MeasuredSpeed("flywheel", few.orders, few.harmonics, np.full(3, NOISE))
    )
    np.testing.assert_allclose(found.factor, WEAK, atol=1e-6)
    assert np.isnan(found.misfit)


def test_a_cylinder_that_adds_nothing_is_left_open() -> None:
    each = firing.sources()
    each[4] = 0
    at = healthy()
    rest = cylinder_response(at, (at.torques.harmonics[:, :, 0])[None], "flywheel")[0]
    found = diagnosis(at, each, MeasuredSpeed("flywheel", firing.ORDERS, rest, np.full(12, NOISE)))
    assert np.isinf(found.deviation[4])
    assert np.isfinite(np.delete(found.deviation, 4)).all()


def test_factors_over_their_mean_tell_the_load_apart() -> None:
    """An engine at 80 % load, one cylinder at half of that."""
    found = diagnosis(healthy(), firing.sources(), seen(factors=[0.8, 0.8, 0.4, 0.8, 0.8, 0.8]))
    np.testing.assert_allclose(
        found.relative, np.array([0.8, 0.8, 0.4, 0.8, 0.8, 0.8]) / (4.4 / 6), rtol=1e-6
    )


def wrong(at: ExcitedTrain, each: Complexes, measured: MeasuredSpeed, **entries: object) -> Diagnosis:
    return diagnosis(at, each, measured, **entries)  # type: ignore[arg-type]


def test_inputs_that_do_not_fit() -> None:
    at, each, measured = healthy(), firing.sources(), seen()
    with pytest.raises(ShapeError, match="expected \\(cylinders, 12, 8\\)"):
        wrong(at, each[:, :5], measured)
    with pytest.raises(ShapeError, match="2 names for 6"):
        wrong(at, each, measured, cylinders=["a", "b"])
    with pytest.raises(InputError, match="at one speed"):
        wrong(excited_train(firing.engine(), np.array([90.0, 95.0])), each, measured)
    with pytest.raises(InputError, match=r'no disc "flywheal".*flywheel'):
        wrong(at, each, MeasuredSpeed("flywheal", measured.orders, measured.harmonics))
    with pytest.raises(InputError, match=r"order 7\.5"):
        wrong(at, each, MeasuredSpeed("flywheel", np.array([7.5]), np.array([0j])))


def test_harmonics_of_samples() -> None:
    angle = 4 * np.pi * np.arange(360) / 360
    samples = 95 + 0.3 * np.cos(0.5 * angle + 0.2) + 0.1 * np.cos(3 * angle - 1)
    found = measured_speed("flywheel", samples, 2, [0.5, 1, 3], noise=0.01)
    np.testing.assert_allclose(found.harmonics, [0.3 * np.exp(0.2j), 0, 0.1 * np.exp(-1j)], atol=1e-13)
    assert found.noise is not None
    # σ √(2/360).
    np.testing.assert_allclose(found.noise, 0.01 * np.sqrt(2 / 360))


def test_noise_of_harmonics_is_that_of_white_samples() -> None:
    generator = np.random.default_rng(3)
    found = [measured_speed("d", generator.normal(0, 0.2, 120), 2, [2.5], 0.2) for _ in range(2000)]
    values = np.array([one.harmonics[0] for one in found])
    assert found[0].noise is not None
    # 2000 values: the deviation of a deviation is 1.6 %, four of them.
    assert values.real.std() == pytest.approx(found[0].noise[0], rel=0.065)
    assert values.imag.std() == pytest.approx(found[0].noise[0], rel=0.065)


def test_samples_that_do_not_do() -> None:
    with pytest.raises(ShapeError, match="order 6 needs 25"):
        measured_speed("d", np.zeros(24), 2, [6.0])
    with pytest.raises(InputError, match=r"order 0\.25 does not repeat in 2 revolutions"):
        measured_speed("d", np.zeros(100), 2, [0.25])
    with pytest.raises(InputError, match="samples: found nan at index 1"):
        measured_speed("d", [1.0, np.nan, 1.0, 1.0], 1, [1.0])


@pytest.mark.parametrize("freedom", [1, 2, 3, 4, 5, 6, 18, 31])
@pytest.mark.parametrize("level", [0.5, 0.95, 0.999])
def test_student_quantiles(freedom: int, level: float) -> None:
    assert coverage_factor(level, freedom) == pytest.approx(stats.t.ppf(0.5 + level / 2, freedom), rel=1e-9)


def test_normal_quantile_and_levels_that_are_none() -> None:
    assert coverage_factor(0.95) == pytest.approx(stats.norm.ppf(0.975), rel=1e-12)
    with pytest.raises(InputError, match="level of confidence"):
        coverage_factor(1.0)


def test_all_that_is_estimated_accuses_at_the_level_together() -> None:
    """Strength, delay and compression of eight healthy cylinders with known noise: 95 of 100 engines pass.

    Of 24 intervals with two ends each, those above 1 of strength and compression accuse nobody: four of six
    twentieths of 4000 engines are 133 ± 11; each of the three by itself at that level would be 10 %.
    """
    draws = np.random.default_rng(3).normal(size=(4000, 3, 8))
    one = np.ones(8)
    names = tuple("12345678")
    named = 0
    for strength, delay, compression in draws:
        found = Diagnosis(
            names, 1 + strength, one, np.eye(8), 1.0, 1.0, 72, True, (), delay, one, 1 + compression, one
        )
        named += bool({*found.weak(), *found.late(), *found.early(), *found.leaking()})
    assert 100 < named < 170
