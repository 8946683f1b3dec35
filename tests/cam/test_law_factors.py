"""Factors of motion laws: closed forms, an independent computation, and bounds that nothing goes below."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.integrate import quad
from scipy.optimize import minimize_scalar

from linkwright import cam_laws, law_factors
from linkwright.cam import LAWS, Boundary, MotionLaw, modified_sine, modified_trapezoid, polynomial, spline
from linkwright.cam.laws.catalogue import BOUNDS

pi, sin, cos, sqrt = math.pi, math.sin, math.cos, math.sqrt
FACTORS = cam_laws()
# Rounding of sums of ten terms.
EXACT = 1e-12

# v = 15/13 of the law of paper 2; a = 12 v/t_p (u − 2u² + u³) is largest at u = 1/3.
COMBINED = {"C_v": 15 / 13, "C_a": 12 * 15 / 13 * 6 * 4 / 27, "C_j": 12 * 15 / 13 * 36}

CLOSED_FORMS = {
    "constant_velocity": {"C_v": 1.0, "C_a_inside": 0.0},
    "parabolic": {"C_v": 2.0, "C_a": 4.0, "C_M": 8.0, "acceleration_squared": 16.0, "C_j_inside": 0.0},
    "harmonic": {
        "C_v": pi / 2,
        "C_a": pi**2 / 2,
        "C_M": pi**3 / 8,
        "acceleration_squared": pi**4 / 8,
        "C_j_inside": pi**3 / 2,
    },
    "double_harmonic": {"acceleration_max": 9 * pi**2 / 16, "acceleration_min": -(pi**2)},
    "cycloidal": {
        "C_v": 2.0,
        "C_a": 2 * pi,
        "C_j": 4 * pi**2,
        "C_M": 3 * sqrt(3) / 2 * pi,
        "acceleration_squared": 2 * pi**2,
        "jerk_squared": 8 * pi**4,
    },
    "modified_trapezoid": {"C_v": 2.0, "C_a": 8 * pi / (pi + 2), "C_j": 32 * pi**2 / (pi + 2)},
    "modified_sine": {
        "C_v": 2 * pi / (4 + pi) * 2,
        "C_a": 4 * pi**2 / (pi + 4),
        "C_j": 16 * pi**3 / (pi + 4),
    },
    "gutman_1_3": {"C_v": 2.0, "acceleration_squared": (pi / 8) ** 2 * (15**2 + 3**2) / 2},
    "freudenstein_1_3_5": {"C_v": 1 + 1125 / 1192 * (1 + 1 / 18 + 1 / 250)},
    "polynomial_3_4_5": {
        "C_v": 15 / 8,
        "C_a": 10 / sqrt(3),
        "C_j": 60.0,
        "acceleration_squared": 120 / 7,
        "jerk_squared": 720.0,
    },
    "polynomial_4_5_6_7": {
        "C_v": 35 / 16,
        "C_a": 84 * sqrt(5) / 25,
        "C_j": 52.5,
        "acceleration_squared": 280 / 11,
        "jerk_squared": 1120.0,
    },
    "optimal": {"C_v": 1.5, "C_a": 6.0, "C_M": 2 * sqrt(3), "acceleration_squared": 12.0, "C_j_inside": 12.0},
    "minimum_acceleration": {"C_v": 2.0, "C_a": 4.0},
    "minimum_jerk": {"C_v": 2.0, "C_a": 8.0, "C_j": 32.0, "jerk_squared": 1024.0},
    "combined": COMBINED,
    "trapezoidal_velocity": {"C_v": 1.5, "C_a": 4.5, "acceleration_squared": 13.5},
    "s_curve": {"C_v": 1.5, "C_a": 6.0, "C_j": 72.0},
}


@pytest.mark.parametrize("name", CLOSED_FORMS)
def test_closed_forms(name: str) -> None:
    for factor, value in CLOSED_FORMS[name].items():
        assert getattr(FACTORS[name], factor) == pytest.approx(value, rel=EXACT, abs=EXACT), factor


def test_every_law_has_a_closed_form_here_or_a_computation_below() -> None:
    assert set(LAWS) <= set(CLOSED_FORMS) | set(ACCELERATIONS)


def sines(*terms: tuple[int, float]) -> Callable[[float], float]:
    """Acceleration 2π Σ n² b_n sin 2πnz."""
    return lambda z: 2 * pi * sum(n * n * b * sin(2 * pi * n * z) for n, b in terms)


def trapezoid(z: float, b: float = 0.125) -> float:
    if z > 0.5:
        return -trapezoid(1 - z, b)
    return sin(pi / 2 * z / b) if z < b else 1.0 if z < 0.5 - b else sin(pi / 2 * (0.5 - z) / b)


def modified(z: float, b: float = 0.125) -> float:
    if z > 0.5:
        return -modified(1 - z, b)
    return sin(pi / 2 * z / b) if z < b else cos(pi * (z - b) / (1 - 2 * b))


m = 1125 / 1192
# The acceleration as a formula, and where its pieces end.
ACCELERATIONS: dict[str, tuple[Callable[[float], float], list[float]]] = {
    "double_harmonic": (lambda z: pi**2 / 2 * (cos(pi * z) - cos(2 * pi * z)), []),
    "cycloidal": (sines((1, 1.0)), []),
    "gutman_1_3": (sines((1, 15 / 16), (3, 1 / 48)), []),
    "freudenstein_1_3": (sines((1, 27 / 28), (3, 1 / 84)), []),
    "freudenstein_1_3_5": (sines((1, m), (3, m / 54), (5, m / 1250)), []),
    "modified_trapezoid": (trapezoid, [0.125, 0.375, 0.5, 0.625, 0.875]),
    "modified_sine": (modified, [0.125, 0.5, 0.875]),
}


def greatest(function: Callable[[float], float], ends: list[float]) -> float:
    """Largest absolute value of a function: a grid, then Brent's method around its best point."""
    z = np.linspace(0, 1, 2001)
    best = float(z[np.argmax([abs(function(x)) for x in z])])
    around = (max(best - 1e-3, 0.0), min(best + 1e-3, 1.0))
    found = minimize_scalar(lambda x: -abs(function(x)), bounds=around, options={"xatol": 1e-12})
    return max(-float(found.fun), *(abs(function(x)) for x in (*ends, best)))


@pytest.mark.parametrize("name", ACCELERATIONS)
def test_independent_computation(name: str) -> None:
    """The acceleration alone, integrated by adaptive quadrature and searched by Brent's method."""
    shape, breaks = ACCELERATIONS[name]

    def integral(function: Callable[[float], float], high: float = 1.0) -> float:
        ends = [0.0, *(x for x in breaks if x < high), high]
        return math.fsum(quad(function, a, b, epsabs=1e-13, epsrel=1e-12)[0] for a, b in pairwise(ends))

    lift = integral(lambda z: (1 - z) * shape(z))
    found = FACTORS[name]

    def product(z: float) -> float:
        return integral(shape, z) * shape(z) / lift**2 if z else 0.0

    # Quadrature is good to 1e-13; Brent finds the place to 1e-8, and the peak to its square.
    assert found.C_v == pytest.approx(
        greatest(lambda z: integral(shape, z) / lift if z else 0.0, breaks), rel=1e-11
    )
    assert found.C_a == pytest.approx(greatest(lambda z: shape(z) / lift, [0.0, 1.0]), rel=1e-11)
    assert pytest.approx(greatest(product, breaks), rel=1e-11) == found.C_M
    assert found.acceleration_squared == pytest.approx(integral(lambda z: shape(z) ** 2) / lift**2, rel=1e-11)


def test_what_jumps_is_infinite_and_said() -> None:
    assert FACTORS["constant_velocity"].C_a is None
    assert FACTORS["constant_velocity"].C_M is None
    assert FACTORS["constant_velocity"].remarks == ("velocity jumps at the start and at the end",)
    assert FACTORS["harmonic"].C_j is None
    assert FACTORS["harmonic"].jerk_squared is None
    assert FACTORS["harmonic"].C_M is not None
    assert FACTORS["double_harmonic"].remarks == ("acceleration jumps at the end",)
    assert "inside" in FACTORS["parabolic"].remarks[0]
    assert all(bool(each.remarks) == (each.C_j is None) for each in FACTORS.values())


def test_lift_length_and_sign_do_not_count() -> None:
    law = modified_sine(0.2)
    moved = law.scaled(-0.03, 0.7).placed(1.2, 2.5)
    first, second = law_factors(law).to_dict(), law_factors(moved).to_dict()
    for name, value in first.items():
        assert second[name] == (pytest.approx(value, rel=1e-9) if isinstance(value, float) else value), name


@given(st.floats(0.01, 0.25), st.floats(0.01, 0.49))
def test_factors_of_variable_shares(b: float, c: float) -> None:
    """Closed forms of the modified trapezoid and sine over their share."""
    # Velocity change over half the law: A (1/2 − 2b + 4b/π); the mean velocity is one.
    peak = 2 / (0.5 - 2 * b + 4 * b / pi)
    found = law_factors(modified_trapezoid(b))
    assert found.C_v == pytest.approx(2.0, rel=EXACT)
    assert found.C_a == pytest.approx(peak, rel=EXACT)
    assert found.C_j == pytest.approx(peak * pi / (2 * b), rel=EXACT)
    sine = law_factors(modified_sine(c))
    ratio = pi * max(1 / (2 * c), 1 / (1 - 2 * c))
    assert sine.C_j == pytest.approx(sine.C_a_inside * ratio, rel=EXACT)


# -- bounds --------------------------------------------------------------------------------------------------


def test_bounds_are_reached() -> None:
    for bound in BOUNDS:
        assert getattr(FACTORS[bound.reached_by], bound.name) == pytest.approx(bound.value, rel=EXACT)


def never_below(law: MotionLaw) -> None:
    """No factor is below its bound, unless it is infinite."""
    found = law_factors(law)
    for bound in BOUNDS:
        value = getattr(found, bound.name)
        # Rounding of random polynomials with coefficients up to 10⁴.
        assert value is None or value >= bound.value * (1 - 1e-9), bound


@pytest.mark.parametrize("name", LAWS)
def test_no_law_of_the_catalogue_is_below(name: str) -> None:
    never_below(LAWS[name].normalised())


bends = st.lists(st.floats(-30, 30), min_size=1, max_size=5)


@given(bends, st.integers(1, 3))
def test_no_polynomial_is_below(terms: list[float], order: int) -> None:
    """A law of rest to rest, and any polynomial that vanishes to some order at both ends."""
    rest = {0: 0.0} | dict.fromkeys(range(1, order), 0.0)
    base = polynomial(rest, {**rest, 0: 1.0}).pieces[0].polynomial
    u = np.polynomial.Polynomial([0.0, 1.0])
    law = np.polynomial.Polynomial(base) + (u * (1 - u)) ** order * np.polynomial.Polynomial(terms)
    piece = LAWS["cycloidal"].normalised().pieces[0]._replace(polynomial=tuple(law.coef), harmonics=())
    never_below(MotionLaw((0.0, 1.0), (piece,)))


@given(
    st.lists(st.tuples(st.floats(0.1, 1.0), st.floats(-2, 2)), min_size=2, max_size=6),
    st.sampled_from([3, 5, 7]),
)
def test_no_spline_is_below(points: list[tuple[float, float]], degree: int) -> None:
    steps: NDArray[np.float64] = np.cumsum([step for step, _ in points])
    places = [0.0, *(steps / steps[-1])[:-1].tolist(), 1.0]
    values = [0.0, *(value for _, value in points[:-1]), 1.0]
    never_below(spline(places, values, Boundary(1.0), degree))
