"""Laws by limits keep them and are the quickest in the shortest section; splines go through their points."""

from __future__ import annotations

from math import inf

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import make_interp_spline

from linkwright import LawError
from linkwright.cam import Boundary, spline
from linkwright.cam.laws.limited import Limits, limited_section

size = st.floats(0.2, 20.0)


@given(size, size, st.one_of(st.just(inf), size), size, st.floats(1.0, 3.0))
def test_limits_are_kept(v: float, a: float, j: float, lift: float, slack: float) -> None:
    limits = Limits(v, a, j)
    length = limits.shortest(lift) * slack
    jerk = None if j == inf else j
    law = limited_section(Boundary(-lift), length, v, a, jerk).placed(0.0, length)
    assert float(law.at(length)) == pytest.approx(-lift, rel=1e-12)
    for order, limit in ((1, v), (2, a), (3, j)):
        # What is promised: pieces below 1e-8 of the section are left out.
        assert abs(law.peak(order).value) <= limit * (1 + 1e-7)
    # A piece of 1e-8 of the section has its length to 8 digits.
    assert np.abs(law.jumps(1)).max() < 1e-7 * v + 1e-7 * a * length
    assert j == inf or np.abs(law.jumps(2)).max() < 1e-7 * j * length


@given(size, size, size)
def test_the_shortest_section_uses_a_limit_throughout(v: float, a: float, lift: float) -> None:
    limits = Limits(v, a)
    length = limits.shortest(lift)
    # Closed form without a limit of the jerk: triangle or trapezoid of the velocity.
    assert length == pytest.approx(
        lift / v + v / a if lift >= v * v / a else 2 * np.sqrt(lift / a), rel=1e-12
    )


def test_the_shortest_section_with_a_limit_of_jerk_alone() -> None:
    # Jerk ±J over quarters: lift = J (T/4)³ 2.
    assert Limits(inf, 1e9, 5.0).shortest(3.0) == pytest.approx(4 * (3.0 / (2 * 5.0)) ** (1 / 3), rel=1e-12)


def test_too_short_a_section() -> None:
    with pytest.raises(LawError, match="at least 162"):
        limited_section(Boundary(1.0), 2.0, None, 0.5, None)
    with pytest.raises(LawError, match="rest at both ends"):
        limited_section(Boundary(1.0, velocity_end=0.1), 2.0, None, 9.0, None)


@given(st.lists(st.tuples(st.floats(0.05, 1.0), st.floats(-1, 1)), min_size=2, max_size=9))
def test_splines_are_those_of_scipy(points: list[tuple[float, float]]) -> None:
    steps = np.cumsum([step for step, _ in points])
    x = np.concatenate([[0.0], steps / steps[-1]])
    x[-1] = 1.0
    y = np.array([0.0, *(value for _, value in points)])
    task = Boundary(float(y[-1]), 0.3, -0.2, 1.0, 0.5)
    z = np.linspace(0, 1, 57)
    for degree in (3, 5, 7):
        ends = ([(1, 0.3), (2, 1.0), (3, 0.0)], [(1, -0.2), (2, 0.5), (3, 0.0)])
        theirs = make_interp_spline(x, y, degree, bc_type=tuple(e[: (degree - 1) // 2] for e in ends))
        law = spline(x.tolist(), y.tolist(), task, degree)
        scale = 1 + np.abs(theirs(z)).max()
        # Both solve a collocation matrix that is conditioned by the ratio of the steps to the degree.
        np.testing.assert_allclose(law.at(z), theirs(z), atol=1e-8 * scale)
        np.testing.assert_allclose(law.at(x, side="before"), y, atol=1e-9 * scale)
        assert float(law.at(0.0, 1)) == pytest.approx(0.3, abs=1e-8)
        assert float(law.at(1.0, 1, "before")) == pytest.approx(-0.2, abs=1e-7 * scale)


def test_straight_lines_through_points() -> None:
    law = spline([0.0, 0.25, 1.0], [0.0, 1.0, 0.5], Boundary(0.5), 1)
    np.testing.assert_allclose(law.at([0.0, 0.125, 0.25, 0.625, 1.0]), [0.0, 0.5, 1.0, 0.75, 0.5], atol=1e-15)


def test_a_spline_gives_back_a_polynomial() -> None:
    """A quintic through seven of its own points, with its own ends."""
    f = np.polynomial.Polynomial([0.0, 0.4, 0.3, -2.0, 1.0, 0.8])
    x = [0.0, 0.1, 0.15, 0.4, 0.7, 0.95, 1.0]
    ends = [float(f.deriv(k)(z)) for k in (1, 2) for z in (0.0, 1.0)]
    law = spline(x, [float(f(z)) for z in x], Boundary(float(f(1.0)), *ends), 5)
    z = np.linspace(0, 1, 33)
    np.testing.assert_allclose(law.at(z, 3), f.deriv(3)(z), atol=1e-8)
