"""Extremes with derivatives: ties, kinks that move, what sentences list."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.kernel.numerics.extreme import Kinks, common, differ, greatest, least, occurs_at, size
from linkwright.kernel.numerics.tangent import Tangent


def test_the_larger_of_two_numbers_has_its_derivatives() -> None:
    """The maximum has the derivatives of the larger number, the minimum those of the smaller."""
    one, other = Tangent(2.0, np.array([1.0, 0.0])), Tangent(3.0, np.array([5.0, 7.0]))
    assert greatest(one, other).d.tolist() == [5.0, 7.0]
    assert least(one, other).d.tolist() == [1.0, 0.0]
    assert greatest(2.0, 3.0) == 3.0


def test_a_tie_keeps_what_both_have_in_common() -> None:
    """Equal numbers have a derivative by an entry that both follow alike, none by one that parts them."""
    one, other = Tangent(3.0, np.array([1.0, 2.0])), Tangent(3.0 + 1e-13, np.array([1.0, -2.0]))
    for tied in (greatest(one, other), least(one, other)):
        assert tied.d[0] == pytest.approx(1.0)
        assert np.isnan(tied.d[1])


def test_a_number_without_derivatives_is_a_rival_too() -> None:
    """A number that nothing moves ties with one that an entry moves."""
    assert np.isnan(greatest(3.0, Tangent(3.0, np.array([1.0]))).d).all()


def test_size_has_no_derivative_at_zero() -> None:
    """|x| has the derivative of −x below zero, and none at zero by an entry that moves x."""
    assert size(Tangent(-2.0, np.array([3.0]))).d.tolist() == [-3.0]
    at_zero = size(Tangent(0.0, np.array([3.0, 0.0]))).d
    assert np.isnan(at_zero[0])
    assert at_zero[1] == 0.0


def test_a_lost_derivative_stays_lost() -> None:
    """A rival without a derivative by one entry leaves those by the others."""
    slopes = np.array([[1.0, 2.0], [np.nan, 2.0]])
    assert differ(slopes).tolist() == [True, False]
    assert np.isnan(common(slopes)[0])
    assert common(slopes)[1] == 2.0


def test_a_kink_is_found_across_the_end_of_the_cycle() -> None:
    """A kink at 360° is at 0°, too; only entries that move it count there."""
    moves = np.array([[True, False], [False, True]])
    kinks = Kinks(("A", "B"), np.array([1.0, 2 * np.pi]), 2 * np.pi, moves)
    assert kinks.moved_at(0.0, 1e-9).tolist() == [False, True]
    assert kinks.moved_at(1.0, 1e-9).tolist() == [True, False]
    assert not kinks.moved_at(2.0, 1e-9).any()
    assert kinks.moved_near(np.array([0.0, 2.0]), 1e-9) == [2 * np.pi]


def test_sentences_list_four_places_once() -> None:
    """Angles that print alike are named once; of more than five the rest is counted."""
    assert occurs_at([1.0, 1.0 + 1e-9, np.pi]) == "the extreme occurs at 57.3° and 180°"
    six = np.radians([10, 20, 30, 40, 50, 60])
    assert occurs_at(six).endswith("10° and 20° and 30° and 40° and 2 angles more")
    assert occurs_at(six[:2], ["A"]) == (
        "the extreme occurs at 10° and 20°; the derivatives with respect to A differ"
    )
