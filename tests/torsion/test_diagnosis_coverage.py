"""What a diagnosis promises of engines with one cylinder that is off.

Intervals hold the truth, and the healthy cylinders are not accused.

Signals are those of the product itself, with the operating point that belongs to the sick engine.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from sizes import cases

import linkwright as lw
from linkwright.kernel.errors import ConvergenceError
from linkwright.kernel.numerics.confidence import chance_of_ratio
from linkwright.torsion.diagnosis.diagnosis import Diagnosis
from linkwright.torsion.diagnosis.engine_diagnosis import fitted
from linkwright.torsion.diagnosis.engine_speed import EngineSpeed
from linkwright.torsion.diagnosis.measured_speed import MeasuredSpeed

MACHINES = Path(__file__).parents[2] / "machines"
SPEED = 1500 * np.pi / 30
# Of each harmonic: 0.2 rpm of 720 samples.
NOISE = 0.2 * np.pi / 30 * np.sqrt(2 / 720)

COUPLINGS: dict[str, list[str]] = {
    "stiffening": [],
    # Steeper still: nine times as stiff at rated torque as at rest.
    "progressive": ['train.couplings.coupling.torque=["0 N m", "150 N m", "900 N m", "2500 N m"]'],
    # Stiff, with a steep middle: several factors fit better than all beside them.
    "resonant": [
        'train.couplings.coupling.torque=["0 N m", "193 N m", "698 N m", "1500 N m"]',
        'train.couplings.coupling.twist=["0 deg", "0.3365 deg", "0.4173 deg", "0.5385 deg"]',
    ],
}
# Combustion, delay and compression by which cylinder 3 is off a healthy one.
DEFECTS = {
    "misfire": (-1.0, 0.0, 0.0),
    "weak": (-0.3, 0.0, 0.0),
    "leaking": (-0.15, 0.0, -0.15),
    "late": (-0.05, np.radians(6.0), 0.0),
}
# Repetitions of each, with eight cylinders: some six hundred intervals a test, or more than two thousand. Of
# so many, the share that holds the truth scatters by a hundredth, or by half of it.
REPEATED = cases(6, 24)


@cache
def engine(coupling: str) -> EngineSpeed:
    """The V-8, its speed read at the flywheel."""
    machine = lw.read(MACHINES / "v8_diesel.toml", COUPLINGS.get(coupling, []))
    if coupling == "linear":
        assert machine.train is not None
        one = machine.train.couplings["coupling"]
        straight = one.model_copy(update={"twist": None, "torque": None, "stiffness": 14e3})
        train = machine.train.model_copy(update={"couplings": {"coupling": straight}})
        machine = machine.model_copy(update={"train": train})
    return EngineSpeed(machine, SPEED, "flywheel")


def state(defect: str) -> np.ndarray:
    """All cylinders, of which the third is off."""
    values = np.zeros(24)
    values[[2, 10, 18]] = DEFECTS[defect]
    return values


def measured(
    coupling: str, defect: str, noise: np.ndarray | None = None, *, is_known: bool = True
) -> MeasuredSpeed:
    """Its speed, with some noise."""
    orders, found = engine(coupling).harmonics(state(defect)[:, None])
    speed = found[0] if noise is None else found[0] + noise[0] + 1j * noise[1]
    return MeasuredSpeed("flywheel", orders, speed, np.full(len(orders), NOISE) if is_known else None)


@pytest.mark.parametrize("coupling", ["linear", *COUPLINGS])
@pytest.mark.parametrize("defect", DEFECTS)
def test_diagnosis_is_exact_without_noise(coupling: str, defect: str) -> None:
    """At the operating point of the sick engine, whatever is wrong with it."""
    found = fitted(engine(coupling), measured(coupling, defect))
    np.testing.assert_allclose(found.factor, 1 + state(defect)[:8], atol=1e-6)
    assert set(found.weak()) <= {"3"}
    if defect == "late":
        assert found.late() == ("3",)
        assert found.delay is not None
        assert found.delay[2] == pytest.approx(np.radians(6.0), abs=1e-6)
    if defect == "leaking":
        assert found.leaking() == ("3",)


@cache
def repeated(is_known: bool) -> list[tuple[np.ndarray, Diagnosis]]:
    """Factors as they are, and what is said of them, in many noisy repetitions."""
    generator = np.random.default_rng(11)
    found = []
    for coupling in ("linear", "stiffening", "progressive"):
        for defect in DEFECTS:
            for _ in range(REPEATED):
                noise = generator.normal(0, NOISE, (2, 48))
                seen = measured(coupling, defect, noise, is_known=is_known)
                found.append((1 + state(defect)[:8], fitted(engine(coupling), seen)))
    return found


@pytest.mark.deep
@pytest.mark.parametrize("is_known", [True, False])
def test_intervals_hold_the_truth(is_known: bool) -> None:
    hold = [np.abs(found.factor - truth) <= found.half_width() for truth, found in repeated(is_known)]
    assert 0.93 <= np.mean(hold) <= 0.97


@pytest.mark.deep
def test_healthy_cylinders_are_not_accused() -> None:
    """All seven of them together, in at most one engine of twenty; the sick one is always found."""
    every = [found for is_known in (True, False) for _, found in repeated(is_known)]
    assert np.mean([bool(set(found.weak()) - {"3"}) for found in every]) <= 0.05
    for found in every:
        assert "3" in {*found.weak(), *found.late(), *found.leaking()}


@pytest.mark.parametrize(("coupling", "defect"), [("stiffening", "weak"), ("resonant", "misfire")])
def test_factors_alone_where_they_explain_all(coupling: str, defect: str) -> None:
    """Delays and compression are not fitted into noise, nor into other factors that fit nearly as well."""
    found = fitted(engine(coupling), measured(coupling, defect))
    assert found.delay is None
    assert found.half_width().max() < 0.012


def test_what_nothing_explains_widens_the_intervals() -> None:
    """Speeds from elsewhere at many orders, thirty times the noise that is given."""
    seen = measured("stiffening", "weak", np.random.default_rng(2).normal(0, 30 * NOISE, (2, 48)))
    found = fitted(engine("stiffening"), seen)
    assert found.is_refuted
    assert "treat the residual as noise" in found.warnings[-1]
    np.testing.assert_array_less(np.abs(found.factor - 1 - state("weak")[:8]), 3.5 * found.deviation)


def test_factors_that_do_not_settle_are_a_finding(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("linkwright.torsion.diagnosis.engine_diagnosis._ROUNDS", 2)
    with pytest.raises(ConvergenceError, match="factors do not converge"):
        fitted(engine("progressive"), measured("progressive", "misfire"))


@pytest.mark.parametrize(("above", "below"), [(16, None), (16, 40), (24, 72)])
@pytest.mark.parametrize("chance", [0.5, 0.05, 0.01])
def test_ratio_of_variances(above: int, below: int | None, chance: float) -> None:
    from scipy import stats

    law = stats.f(above, 10**9 if below is None else below)
    assert chance_of_ratio(law.isf(chance), above, below) == pytest.approx(chance, rel=0.05)
