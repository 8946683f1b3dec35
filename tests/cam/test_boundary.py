"""Any law between any boundary values: the tasks of VDI 2143, each value met exactly."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright import LawError
from linkwright.cam import LAWS, Boundary, MotionLaw
from linkwright.cam.laws.boundary import by_conditions, half_law
from linkwright.cam.laws.ramps import SYMMETRIC

# Velocity and acceleration of each letter.
ENDS = {"R": (0.0, 0.0), "G": (0.7, 0.0), "U": (0.0, -1.3), "B": (-0.4, 2.1)}
TASKS = {
    f"{a}-{b}": Boundary(1.5, ENDS[a][0], ENDS[b][0], ENDS[a][1], ENDS[b][1]) for a, b in product(ENDS, ENDS)
}


def rounding(law: MotionLaw, order: int) -> float:
    """What rounding of the coefficients leaves of a derivative at an end: their sum, times 1e-15."""
    return 1e-15 + max(
        1e-15 * (sum(map(abs, piece.polynomial)) + sum(abs(x) for each in piece.harmonics for x in each[1:]))
        for piece in law.derivative(order).pieces
    )


def assert_ends(law: MotionLaw, task: Boundary) -> None:
    """Every boundary value is met to rounding."""
    for i, (found, value) in enumerate(zip(ends_of(law), wanted(task), strict=True)):
        assert found == pytest.approx(value, abs=rounding(law, i % 3))


def ends_of(law: MotionLaw) -> list[float]:
    """Value, velocity, acceleration at the start and at the end."""
    start = [float(law.at(0.0, i)) for i in range(3)]
    return start + [float(law.at(1.0, i, "before")) for i in range(3)]


def wanted(task: Boundary) -> list[float]:
    a = (task.acceleration_start or 0.0, task.acceleration_end or 0.0)
    return [0.0, task.velocity_start, a[0], task.lift, task.velocity_end, a[1]]


def is_smooth(law: MotionLaw, order: int) -> bool:
    """Whether no derivative up to an order jumps inside."""
    return all(np.abs(law.jumps(i)).max(initial=0.0) < 1e-11 for i in range(order + 1))


@pytest.mark.parametrize("letters", TASKS)
@pytest.mark.parametrize("name", SYMMETRIC)
def test_every_boundary_value_is_met(name: str, letters: str) -> None:
    task = TASKS[letters]
    assert task.letters == letters
    law = LAWS[name].section(task)
    assert_ends(law, task)
    assert is_smooth(law, 1)
    assert name in ("parabolic", "harmonic") or is_smooth(law, 2)


@pytest.mark.parametrize("letters", TASKS)
def test_polynomials_meet_them_with_any_continuity(letters: str) -> None:
    task = TASKS[letters]
    for start, end in product((2, 3, 5), (2, 4)):
        law = by_conditions(task, start, end)
        assert_ends(law, task)
        for place, order, own in ((0.0, start, wanted(task)[2]), (1.0, end, wanted(task)[5])):
            expected = 0.0 if order > 2 else own
            assert float(law.at(place, order)) == pytest.approx(expected, abs=rounding(law, order))


def test_a_half_law_is_the_first_half() -> None:
    for name, make in SYMMETRIC.items():
        law, G = make(), half_law(make())
        z = np.linspace(0.0, 0.99, 34)
        ratio = law.at(z / 2, 1) / float(law.at(0.5, 1))
        np.testing.assert_allclose(G.at(z, 1), ratio, atol=1e-14, err_msg=name)


def test_start_to_constant_velocity_without_anything_left_is_the_half_law() -> None:
    G = half_law(SYMMETRIC["cycloidal"]())
    task = Boundary(0.8 * float(G.at(1.0)), 0.0, 0.8)
    z = np.linspace(0, 1, 21)
    np.testing.assert_allclose(LAWS["cycloidal"].section(task).at(z), 0.8 * G.at(z), atol=1e-15)


def test_a_harmonic_keeps_its_own_acceleration_unless_told() -> None:
    own = LAWS["harmonic"].section(Boundary(2.0))
    assert float(own.at(0.0, 2)) == pytest.approx(np.pi**2, rel=1e-14)
    told = LAWS["harmonic"].section(Boundary(2.0, acceleration_start=0.0))
    assert float(told.at(0.0, 2)) == pytest.approx(0.0, abs=1e-14)
    assert float(told.at(1.0, 2)) == pytest.approx(-(np.pi**2), rel=1e-14)


def test_what_a_law_cannot_do_is_told() -> None:
    for task in (Boundary(1.0, 0.1), Boundary(1.0, acceleration_end=0.0)):
        with pytest.raises(LawError, match="symmetric laws"):
            LAWS["double_harmonic"].section(task)
    with pytest.raises(LawError, match="1 or more"):
        by_conditions(Boundary(1.0, velocity_start=0.2), 0, 2)
    with pytest.raises(LawError, match="begins and ends with its peak"):
        LAWS["minimum_acceleration"].section(Boundary(1.0, acceleration_start=0.0))
    with pytest.raises(LawError, match="closed form"):
        LAWS["minimum_jerk"].section(Boundary(1.0, acceleration_start=1.0))


small = st.floats(-2.0, 2.0).filter(lambda x: x == 0 or abs(x) > 1e-6)


@given(small, small, small)
def test_least_peaks_meet_lift_and_velocities(lift: float, v_0: float, v_1: float) -> None:
    task = Boundary(lift, v_0, v_1)
    for name in ("minimum_acceleration", "minimum_jerk"):
        law = LAWS[name].section(task)
        found = [ends_of(law)[i] for i in (0, 1, 3, 4)]
        assert found == pytest.approx([0.0, v_0, lift, v_1], abs=1e-13)
    assert ends_of(law)[2] == pytest.approx(0, abs=1e-12)
    assert ends_of(law)[5] == pytest.approx(0, abs=1e-12)


@given(small, small, small, st.lists(st.floats(-3, 3), min_size=1, max_size=4))
def test_no_law_with_the_same_ends_has_a_lower_peak(
    lift: float, v_0: float, v_1: float, bends: list[float]
) -> None:
    """Against polynomials of the same boundary values with anything added that vanishes at the ends."""
    task = Boundary(lift, v_0, v_1)
    for name, order in (("minimum_acceleration", 2), ("minimum_jerk", 3)):
        least = np.abs(LAWS[name].section(task).at(np.linspace(0.01, 0.99, 33), order)).max()
        base = np.polynomial.Polynomial(by_conditions(task).pieces[0].polynomial)
        u = np.polynomial.Polynomial([0.0, 1.0])
        other = base + (u * (1 - u)) ** 3 * np.polynomial.Polynomial(bends)
        peak = np.abs(other.deriv(order)(np.linspace(0, 1, 2001))).max()
        # The grid misses the other law's peak by less than 1e-5 of it.
        assert peak > least * (1 - 1e-4) - 1e-9
