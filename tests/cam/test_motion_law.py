"""Laws in pieces: derivatives, integrals, extremes and zeros are exact; laws from laws are what they say."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.cam import Harmonic, MotionLaw, Piece, joined
from linkwright.cam.laws.motion_law import combined
from linkwright.cam.laws.piece import zeros

LAW = MotionLaw(
    (0.5, 1.0, 3.0),
    (
        Piece((1.0, -2.0, 0.5, 3.0), (Harmonic(4.0, 0.3, -0.7),)),
        Piece((2.0, 0.0, -1.0), (Harmonic(7.0, -0.2, 0.1), Harmonic(1.5, 0.4, 0.0))),
    ),
)
X = np.linspace(0.5, 3.0, 41)


@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_derivatives_agree_with_differences(order: int) -> None:
    x, h = X[(abs(X - 1.0) > 0.01) & (X > 0.51) & (X < 2.99)], 1e-3
    # Central differences of fourth order: the error is h⁴/30 of a derivative of size 7⁵·… of the law.
    f = [LAW.at(x + i * h, order - 1) for i in (-2, -1, 1, 2)]
    slope = (f[0] - 8 * f[1] + 8 * f[2] - f[3]) / (12 * h)
    np.testing.assert_allclose(LAW.at(x, order), slope, rtol=0, atol=1e-5)


def test_integral_undoes_the_derivative() -> None:
    smooth = LAW.derivative(1).integral(float(LAW.at(0.5)))
    x = X[X <= 1.0]
    np.testing.assert_allclose(smooth.at(x, side="before"), LAW.at(x, side="before"), atol=1e-15)
    np.testing.assert_allclose(smooth.at(X, 1), LAW.at(X, 1), atol=1e-13)
    assert abs(smooth.jumps(0)).max() < 1e-15


def test_sides_and_jumps() -> None:
    jump = float(LAW.at(1.0, 1, "after") - LAW.at(1.0, 1, "before"))
    assert LAW.jumps(1) == pytest.approx([jump], rel=1e-15)
    assert jump != 0


def test_laws_from_laws() -> None:
    np.testing.assert_allclose(LAW.reversed().at(3.5 - X, side="before"), LAW.at(X), atol=1e-13)
    np.testing.assert_allclose(LAW.placed(0.0, 5.0).at(2 * (X - 0.5)), LAW.at(X), atol=1e-14)
    np.testing.assert_allclose(LAW.placed(0.0, 5.0).at(2 * (X - 0.5), 2), LAW.at(X, 2) / 4, atol=1e-12)
    np.testing.assert_allclose(LAW.scaled(-2.0, 3.0).at(X), 3 - 2 * LAW.at(X), atol=1e-14)
    part = LAW.stretch(0.7, 2.2)
    inside = X[(X > 0.7) & (X < 2.2)]
    assert part.breaks == (0.7, 1.0, 2.2)
    np.testing.assert_allclose(part.at(inside), LAW.at(inside), atol=1e-13)
    other = MotionLaw((0.5, 2.0, 3.0), (Piece((1.0,)), Piece((0.0, 1.0))))
    np.testing.assert_allclose(
        combined((2.0, LAW), (3.0, other)).at(X), 2 * LAW.at(X) + 3 * other.at(X), atol=1e-13
    )
    np.testing.assert_allclose(
        joined([LAW.stretch(0.5, 1.7), LAW.stretch(1.7, 3.0)]).at(X), LAW.at(X), atol=1e-13
    )


@given(st.floats(-9.0, 9.0))
def test_a_periodic_law_is_shifted_round(by: float) -> None:
    wave = MotionLaw((0.0, 2 * math.pi), (Piece((), (Harmonic(2 * math.pi, 1.0, 0.5),)),))
    x = np.linspace(0.0, 2 * math.pi, 33)[:-1]
    expected = np.cos(x - by) + 0.5 * np.sin(x - by)
    np.testing.assert_allclose(wave.shifted(by).at(x), expected, atol=1e-13)


def test_a_shift_that_cuts_at_a_break_makes_no_piece_of_rounding() -> None:
    """A third of a revolution has no exact number: the cut beside a break is at the break."""
    third = 2 * math.pi / 3
    law = MotionLaw((0.0, third, 2 * third, 2 * math.pi), (Piece((1.0,)), Piece((0.0, 1.0)), Piece((1.0,))))
    for by in (math.radians(120), math.radians(240)):
        shifted = law.shifted(by)
        assert min(np.diff(shifted.breaks)) > 2
        assert len(shifted.pieces) == 3
        np.testing.assert_allclose(shifted.at(by + 0.5), law.at(0.5), atol=1e-12)


def test_extremes_against_a_fine_grid() -> None:
    x = np.linspace(0.5, 3.0, 400_001)
    for order in range(4):
        low, high = LAW.extremes(order)
        values = np.concatenate([LAW.at(x, order, "after"), LAW.at(x, order, "before")])
        # The grid misses a peak by f″ Δ²/8, with f″ up to 7⁵ and Δ = 6e-6.
        assert high.value == pytest.approx(values.max(), abs=1e-7)
        assert high.value >= values.max() - 1e-12
        assert low.value <= values.min() + 1e-12
        assert float(LAW.at(high.at, order, high.side)) == pytest.approx(high.value, abs=1e-12)


def test_integral_of_square_against_a_closed_form() -> None:
    wave = MotionLaw((0.0, 3.0), (Piece((1.0,), (Harmonic(2 * math.pi, 0.0, 2.0),)),))
    # ∫ (1 + 2 sin)² = 3 (1 + 2); of the derivative, (4π/3)² · 3/2.
    assert wave.integral_of_square() == pytest.approx(9.0, rel=1e-14)
    assert wave.integral_of_square(1) == pytest.approx((4 * math.pi / 3) ** 2 * 1.5, rel=1e-14)


@given(st.lists(st.floats(0.02, 0.98), min_size=1, max_size=6, unique=True))
def test_zeros_of_polynomials(roots: list[float]) -> None:
    roots = sorted(roots)
    if min(np.diff([0, *roots, 1])) < 0.02:
        return
    found = zeros(lambda u: np.prod([u - r for r in roots], axis=0), len(roots))
    # Rounding of the values, 1e-16, over the slope at the root, at least 0.02⁵.
    np.testing.assert_allclose(found, roots, atol=1e-7)


def test_zeros_of_waves() -> None:
    for k in (1.0, 20.0, 63.0):
        expected = np.arange(0.5, k / math.pi, 1) * math.pi / k
        np.testing.assert_allclose(zeros(lambda u, k=k: np.cos(k * u), 0, k), expected, atol=1e-13)
    assert zeros(lambda u: np.zeros_like(u), 3) == []
    assert zeros(lambda u: 1.0 + u, 1) == []
