"""Optimal polynomials: the minimum by perturbation, and by quadratic programming in another basis."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.polynomial import legendre
from numpy.typing import NDArray

from linkwright import LawError
from linkwright.cam import LAWS, Boundary, MotionLaw, optimal, ramp_of
from linkwright.cam.laws.optimal import optimal_section

Floats = NDArray[np.float64]
VALUES_START, VALUES_END = (0.0, 0.3, -1.0, 2.0, 0.5), (1.0, -0.2, 0.7, 1.0, -3.0)


def numeric_minimum(order: int, start: dict[int, float], end: dict[int, float], size: int = 14) -> float:
    """Smallest ∫ (dⁿx/dzⁿ)² over Legendre series under the same conditions, by quadratic programming.

    The conditions are met by a pseudo-inverse; in their null space the quadratic is minimised, which is the
    KKT system with its multipliers eliminated.
    """
    basis = [legendre.Legendre.basis(i, domain=[0, 1]) for i in range(size)]
    nodes, weights = legendre.leggauss(size + 2)
    at = 0.5 * (nodes + 1)
    bends = np.array([each.deriv(order)(at) for each in basis]).T * np.sqrt(0.5 * weights)[:, None]
    rows = [[each.deriv(k)(x) if k else each(x) for each in basis] for x, k in _places(start, end)]
    A = np.array(rows)
    scale = np.abs(A).max(axis=1)
    right = np.array([*start.values(), *end.values()])
    some = np.linalg.lstsq(A / scale[:, None], right / scale, rcond=None)[0]
    null = np.linalg.svd(A / scale[:, None])[2][len(A) :].T
    step = np.linalg.lstsq(bends @ null, -bends @ some, rcond=None)[0]
    found: Floats = bends @ (some + null @ step)
    return float(found @ found)


def _places(start: dict[int, float], end: dict[int, float]) -> list[tuple[float, int]]:
    """Where, and which derivative."""
    return [(0.0, k) for k in start] + [(1.0, k) for k in end]


def given_sets(order: int) -> list[tuple[dict[int, float], dict[int, float]]]:
    """Conditions with every derivative given, with the highest free, and with all but the lift free."""
    sides = []
    for kept in (range(order), range(max(order - 1, 1)), (0,)):
        sides.append(({k: VALUES_START[k] for k in range(order)}, {k: VALUES_END[k] for k in kept}))
    sides.append(({k: VALUES_START[k] for k in range(order)}, {k: VALUES_END[k] for k in range(1, order)}))
    return sides


CASES = [(order, *sides) for order in range(1, 6) for sides in given_sets(order)]


@pytest.mark.parametrize(("order", "start", "end"), CASES)
def test_no_other_law_has_less(order: int, start: dict[int, float], end: dict[int, float]) -> None:
    law = optimal(order, start, end)
    assert len(law.pieces[0].polynomial) <= 2 * order
    for k, value in start.items():
        assert float(law.at(0.0, k)) == pytest.approx(value, abs=1e-11)
    for k, value in end.items():
        # Coefficients up to 10⁴ in the ninth degree.
        assert float(law.at(1.0, k)) == pytest.approx(value, abs=1e-9)
    found = law.integral_of_square(order)
    # Fifth derivatives of Legendre series of degree 13 are conditioned like 10⁷.
    assert found == pytest.approx(numeric_minimum(order, start, end), rel=1e-8, abs=1e-10)


@pytest.mark.parametrize(("order", "start", "end"), CASES)
@given(st.lists(st.floats(-1, 1), min_size=1, max_size=4))
def test_perturbations_add_their_own_integral(
    order: int, start: dict[int, float], end: dict[int, float], wave: list[float]
) -> None:
    """δ that vanishes where a value is given: ∫ (x + δ)² = ∫ x² + ∫ δ², as the minimum is stationary."""
    law = optimal(order, start, end)
    u = np.polynomial.Polynomial([0.0, 1.0])
    free_end = [k for k in range(order) if k not in end]
    bend = u**order * (1 - u) ** (free_end[0] if free_end else order) * np.polynomial.Polynomial(wave)
    # As a share of the wave: a small one is no smaller a breach.
    least = 1e-12 * max(map(abs, wave))
    if any(abs(bend.deriv(k)(1.0) if k else bend(1.0)) > least for k in end):
        return
    nodes, weights = legendre.leggauss(20)
    z, weight = 0.5 * (nodes + 1), 0.5 * weights
    x, d = law.at(z, order), bend.deriv(order)(z)
    size = np.sqrt((weight @ x**2) * (weight @ d**2))
    assert weight @ (x * d) == pytest.approx(0.0, abs=1e-11 * size + 1e-12)


def test_known_optima() -> None:
    z = np.linspace(0, 1, 21)
    for order, name in ((1, "constant_velocity"), (3, "polynomial_3_4_5"), (4, "polynomial_4_5_6_7")):
        law = optimal_section(Boundary(1.0), order)
        np.testing.assert_allclose(law.at(z), LAWS[name].normalised().at(z), atol=1e-14)
    assert [optimal_section(Boundary(1.0), n).integral_of_square(n) for n in (1, 2, 3, 4)] == pytest.approx(
        [1.0, 12.0, 720.0, 100800.0], rel=1e-12
    )


def test_the_start_of_paper_2_is_optimal_for_its_travel_only() -> None:
    """With free travel the smallest ∫ jerk² is 12, at a travel of 1/2; the paper's has 19.2 at 3/5."""
    start = {0: 0.0, 1: 0.0, 2: 0.0}
    free = optimal(3, start, {1: 1.0, 2: 0.0})
    z = np.linspace(0, 1, 21)
    np.testing.assert_allclose(free.at(z), ramp_of("optimal_jerk_free").at(z), atol=1e-15)
    assert float(free.at(1.0)) == pytest.approx(0.5, rel=1e-14)
    assert free.integral_of_square(3) == pytest.approx(12.0, rel=1e-13)
    fixed = optimal(3, start, {0: 0.6, 1: 1.0, 2: 0.0})
    np.testing.assert_allclose(fixed.at(z), ramp_of("optimal_jerk").at(z), atol=1e-14)
    assert fixed.integral_of_square(3) == pytest.approx(19.2, rel=1e-13)
    assert float(fixed.at(1.0, 3)) == pytest.approx(0.0, abs=1e-13)


def test_free_ends_of_a_section() -> None:
    law: MotionLaw = optimal_section(Boundary(1.0), 3, free_start=[2], free_end=[2])
    natural = [float(law.at(x, 3)) for x in (0.0, 1.0)]
    assert natural == pytest.approx([0.0, 0.0], abs=1e-12)
    assert law.integral_of_square(3) < 720


def test_what_cannot_be_asked() -> None:
    with pytest.raises(LawError, match="up to order 1"):
        optimal(2, {0: 0.0, 2: 0.0}, {0: 1.0})
    with pytest.raises(LawError, match="2 or more values"):
        optimal(2, {0: 0.0}, {})
    for boundary, free in product((Boundary(1.0, velocity_end=0.1),), ([1], [1, 2])):
        with pytest.raises(LawError, match="order 1"):
            optimal_section(boundary, 3, free_end=free)
    with pytest.raises(LawError, match="order 2"):
        optimal_section(Boundary(1.0, acceleration_start=1.0), 2)
