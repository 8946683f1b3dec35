"""Paper 5: its formulas as printed, worked by hand, against the analyses of toppers."""

from __future__ import annotations

import math

import pytest

from linkwright.papers.paper import printed_values
from linkwright.papers.paper5.paper import printed_claim
from linkwright.papers.published_lengths import PAPER
from linkwright.topping import head_diameter, published_lengths

# D, h_p, Δ [m], α [°], v, v_h [m/s], L [m].
CASES = [
    (0.11, 0.03, 0.02, 20.0, 1.9, 0.55, 0.28),
    (0.16, 0.025, 0.0, 35.0, 1.6, 0.8, 0.2),
    (0.09, 0.045, 0.05, 0.0, 2.2, 0.3, 0.12),
]


@pytest.mark.parametrize("case", CASES)
def test_formulas_as_printed(case: tuple[float, ...]) -> None:
    """S_x with l_1 = d tan α as in (2), S_y of (8), times, (10) with the root of its own: all to rounding."""
    D, h_p, delta, degrees, v, v_h, L = case
    a = math.radians(degrees)
    d = 2 * math.sqrt(h_p * (D - h_p))
    assert float(head_diameter(D, h_p)) == pytest.approx(d, rel=1e-14)
    band = d + 2 * delta
    found = published_lengths(band, a, L, v, v_h)
    l_1 = band * math.tan(a)
    S_x, S_y = math.cos(a) * (band + l_1 * math.sin(a)), (L - band * math.sin(a)) * math.cos(a)
    assert found.travel_along == pytest.approx(S_x, rel=1e-14)
    assert found.travel_across == pytest.approx(S_y, rel=1e-14)
    assert (found.time_along, found.time_across) == pytest.approx((S_x / v, S_y / v_h), rel=1e-14)
    assert found.holds == (S_y / v_h >= S_x / v)
    L_h = 2 * (math.sqrt(D * h_p - h_p**2) + delta) * (v_h / v * math.cos(a) + math.sin(a))
    assert found.length_published == pytest.approx(L_h, rel=1e-14)
    # (4) solved for L, with the travels as printed.
    from_4 = v_h * S_x / (v * math.cos(a)) + band * math.sin(a)
    assert found.length_consistent == pytest.approx(from_4, rel=1e-14)


def test_ranges_of_the_result_are_those_of_the_paper() -> None:
    """The ranges that machines are judged by are those of the paper's file of data."""
    assert printed_claim(printed_values(5)) == PAPER
    assert PAPER.forward_speeds == (1.6, 2.2)
    assert PAPER.knife_speeds == (0.3, 0.8)
    assert PAPER.lengths == (0.25, 0.30)
