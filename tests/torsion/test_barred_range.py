"""Barred speed ranges: bounds against closed forms and SciPy's root finder."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.optimize import brentq, minimize_scalar

import linkwright as lw
from linkwright import barred_ranges
from linkwright.torsion import excited_train
from linkwright.torsion.limits.barred_range import BarredRange, together
from linkwright.torsion.limits.criteria import exceedances
from linkwright.torsion.limits.survey import resonances

J_A, J_B, K, C, M, ORDER = 2.0, 3.0, 1e4, 4.0, 80.0, 2.0
W = math.pi / 16 * 0.05**3
REDUCED = J_A * J_B / (J_A + J_B)
CRITICAL = math.sqrt(K / REDUCED) / ORDER

TRAIN = """
format = 1
name = "Two discs"
[train.discs]
a = {{ inertia = 2 }}
b = {{ inertia = 3 }}
[train.shafts.s]
between = ["a", "b"]
stiffness = 1e4
damping = {damping}
limit = {{ diameter = 0.05, {limit} }}
[train.excitations.pulse]
on = "a"
harmonics = [{{ order = 2, torque = 80 }}]
[train.run]
speed_min = {low}
speed_max = {high}
points = {points}
speed_rated = {rated}
"""


def ranges(
    limit: str,
    damping: float = C,
    low: float = 20,
    high: float = 100,
    points: int = 60,
    rated: float = 100,
) -> tuple[BarredRange, ...]:
    entries = {"damping": damping, "low": low, "high": high, "points": points, "rated": rated}
    return barred_ranges(lw.loads(TRAIN.format(limit=limit, **entries)))


def stress(speed: float, damping: float = C) -> float:
    """Closed form: the shaft torque of two discs, one of which is excited."""
    omega = ORDER * speed
    s = K + 1j * omega * damping
    return abs(M * J_B / (J_A + J_B) * s / (s - omega**2 * REDUCED)) / W


def peak_speed(damping: float) -> float:
    found = minimize_scalar(
        lambda x: -stress(x, damping), bounds=(CRITICAL - 1, CRITICAL + 1), options={"xatol": 1e-9}
    )
    return float(found.x)


def bounds(permitted: Callable[[float], float], damping: float = C) -> tuple[float, float]:
    """Where the closed form passes a permitted stress on both sides of the critical speed."""
    low, high = (
        brentq(lambda x: stress(x, damping) - permitted(x), *pair, xtol=1e-13)
        for pair in ((20, CRITICAL), (CRITICAL, 100))
    )
    return low, high


def test_bounds_are_where_stress_and_permitted_stress_meet() -> None:
    (found,) = ranges('stress_permitted = "10 MPa", stress_transient = "60 MPa"')
    low, high = bounds(lambda x: 10e6)
    # The search stops at 10⁻¹⁰ in stress over permitted stress, whose slope here is about 1 s/rad.
    assert (found.speed_min, found.speed_max) == pytest.approx((low, high), rel=1e-8)
    assert (found.open_min, found.open_max) == (False, False)


def test_parts_that_may_not_be_passed() -> None:
    (found,) = ranges('stress_permitted = "10 MPa", stress_transient = "25 MPa"')
    low, high = bounds(lambda x: 25e6)
    assert found.not_passable == (pytest.approx((low, high), rel=1e-8),)
    assert found.is_passable is False


def test_worst_speed_is_where_stress_over_permitted_is_largest() -> None:
    (found,) = ranges('stress_permitted = "10 MPa", stress_transient = "60 MPa"')
    speeds = np.linspace(CRITICAL - 1, CRITICAL + 1, 200_001)
    values = np.array([stress(x) for x in speeds])
    assert found.worst_stress == pytest.approx(values.max(), rel=1e-6)
    assert found.worst_speed == pytest.approx(speeds[values.argmax()], abs=2e-3)
    assert found.is_passable is True
    assert found.may_be_barred


def test_peak_between_few_speeds_is_found() -> None:
    """Three speeds 40 rad/s apart, a peak that is 0.2 rad/s wide."""
    (found,) = ranges('stress_permitted = "40 MPa", stress_transient = "1 GPa"', damping=0.1, points=3)
    low, high = bounds(lambda x: 40e6, 0.1)
    assert high - low < 4
    assert (found.speed_min, found.speed_max) == pytest.approx((low, high), rel=1e-8)


def test_resonance_without_damping_has_bounds_and_no_end() -> None:
    (found,) = ranges('stress_permitted = "10 MPa", stress_transient = "60 MPa"', damping=0.0)
    static = M * J_B / (J_A + J_B) / W / 10e6
    wanted = CRITICAL * math.sqrt(1 - static), CRITICAL * math.sqrt(1 + static)
    assert (found.speed_min, found.speed_max) == pytest.approx(wanted, rel=1e-8)
    assert found.is_passable is False


def test_limit_of_m68_falls_with_the_speed() -> None:
    limit = 'kind = "iacs_m68", tensile_strength = "400 MPa", design_factor = 0.2'
    (found,) = ranges(limit, damping=2.0, rated=120)

    def permitted(x: float) -> float:
        return (560 / 18 * 0.2 * (0.35 + 0.93 * 50**-0.2) * (3 - 2 * (x / 120) ** 2)) * 1e6

    low, high = bounds(permitted, 2.0)
    assert (found.speed_min, found.speed_max) == pytest.approx((low, high), rel=1e-8)
    assert found.transient == pytest.approx(1.7 / math.sqrt(0.2) * found.continuous)
    # The peak of the stress, a little below the resonance, and the formula about it.
    peak = peak_speed(2.0)
    assert found.critical_speed == pytest.approx(peak, rel=1e-7)
    assert found.order == ORDER
    ratio = peak / 120
    wanted = 16 * peak / (18 - ratio), (18 - ratio) * peak / 16
    assert (found.class_min, found.class_max) == pytest.approx(wanted, rel=1e-7)
    assert found.barred == pytest.approx((min(low, wanted[0]), max(high, wanted[1])))


def test_critical_speed_is_that_of_the_order_that_stresses_most() -> None:
    """Order 2.05 has its resonance in the range too, and a hundredth of the torque."""
    text = TRAIN.format(
        limit='stress_permitted = "10 MPa"', damping=C, low=20, high=100, points=60, rated=100
    ).replace("{ order = 2, torque = 80 }", "{ order = 2, torque = 80 }, { order = 2.05, torque = 0.8 }")
    (found,) = barred_ranges(lw.loads(text))
    assert found.speed_min < CRITICAL * 2 / 2.05
    assert (found.order, found.critical_speed) == (2.0, pytest.approx(peak_speed(C), rel=1e-4))


@pytest.mark.parametrize(("rated", "may"), [(120, True), (60, False)])
def test_speeds_near_service_may_not_be_barred(rated: float, may: bool) -> None:
    limit = 'kind = "iacs_m68", tensile_strength = "400 MPa", design_factor = 0.2'
    (found,) = ranges(limit, damping=2.0, rated=rated, high=62)
    assert found.may_be_barred is may


def test_range_may_begin_below_the_lowest_and_end_above_the_highest_speed() -> None:
    (found,) = ranges('stress_permitted = "10 MPa"', low=45.5, high=46)
    assert (found.open_min, found.open_max) == (True, True)
    assert (found.speed_min, found.speed_max) == (45.5, 46)
    assert found.is_passable is None


def test_range_ends_where_the_rule_says_nothing() -> None:
    limit = 'kind = "iacs_m68", tensile_strength = "400 MPa", design_factor = 0.05'
    (found,) = ranges(limit, rated=44, high=60)
    assert found.speed_max == pytest.approx(1.05 * 44, rel=1e-8)


def test_shaft_that_bears_everything_bars_nothing() -> None:
    assert ranges('stress_permitted = "1 GPa"') == ()


def test_ranges_that_meet_are_one() -> None:
    (one,) = ranges('stress_permitted = "10 MPa"')
    (other,) = ranges('stress_permitted = "20 MPa"')
    # Both peak at the same speed, which is found to rounding of the stress: its root in the speed.
    assert together([other, one]) == [pytest.approx(one.barred, rel=1e-7)]
    assert together([]) == []


def test_exceedances_of_curves() -> None:
    """A parabola, a jump, a hole of numbers that are none, in one call for all rows."""
    calls = []

    def curves(x: np.ndarray) -> np.ndarray:
        calls.append(len(x))
        return np.array([5 - (x - 4) ** 2, np.where(x > math.e, 2.0, 0.0), np.where(x > 6, np.nan, x / 5)])

    speeds = np.linspace(0.5, 9.5, 10)
    parabola, jump, hole = exceedances(curves, speeds, curves(speeds))
    assert (parabola.low, parabola.high) == pytest.approx((2, 6), rel=1e-9)
    assert parabola.peak == pytest.approx(4, abs=1e-3)
    assert jump.low == pytest.approx(math.e, rel=1e-9)
    assert jump.open_high
    assert not jump.open_low
    assert (hole.low, hole.high) == pytest.approx((5, 6), rel=1e-9)
    # Work: halvings for the jump decide; peaks take 6 rounds.
    assert len(calls) < 100


def test_resonances_of_three_discs() -> None:
    text = TRAIN.format(limit="", damping=0, low=10, high=200, points=3, rated=100).replace(
        "limit = { diameter = 0.05,  }", ""
    )
    text = text.replace("b = { inertia = 3 }", "b = { inertia = 3 }\nc = { inertia = 1 }")
    text = text.replace(
        "[train.excitations", '[train.shafts.t]\nbetween = ["b", "c"]\nstiffness = 2e4\n[train.excitations'
    )
    text = text.replace(
        "{ order = 2, torque = 80 }", "{ order = 1, torque = 1 }, { order = 2.5, torque = 1 }"
    )
    machine = lw.loads(text)
    omega = 2 * math.pi * lw.free_vibration(machine).natural_frequencies[1:]
    found = resonances(excited_train(machine))
    wanted = sorted((w / order, order, n) for n, w in enumerate(omega) for order in (1.0, 2.5))
    inside = [each for each in wanted if 10 <= each[0] <= 200]
    assert len(inside) >= 3
    np.testing.assert_allclose(np.array(found), np.array(inside), rtol=1e-12)


def test_resonances_follow_a_coupling_that_stiffens_under_torque() -> None:
    """Natural frequency at the speed found, from the coupling's slope there."""
    text = """
format = 1
name = "A coupling of a curve"
[train.discs]
a = { inertia = 2 }
b = { inertia = 3 }
[train.couplings.c]
between = ["a", "b"]
twist = [0, 0.05, 0.1, 0.15]
torque = [0, 300, 900, 2000]
[train.loads.fan]
on = "b"
torque = 1500
speed = 100
[train.excitations.pulse]
on = "a"
harmonics = [{ order = 2, torque = 80 }]
[train.run]
speed_min = 20
speed_max = 100
points = 400
"""
    machine = lw.loads(text)
    found = resonances(excited_train(machine))
    assert found
    coupling = machine.train.couplings["c"]
    for each in found:
        k = float(coupling.slope(1500 * (each.speed / 100) ** 2))
        # Straight between speeds 0.2 rad/s apart.
        assert math.sqrt(k / REDUCED) / 2 == pytest.approx(each.speed, rel=1e-4)


def test_good_speeds_between_two_peaks_are_not_barred() -> None:
    """A chain of three discs at three speeds: between its peaks the stress falls far below the limit."""
    text = """
format = 1
name = "Three discs"
[train.discs]
a.inertia = 2
b.inertia = 3
c.inertia = 4
[train.shafts.s]
between = ["a", "b"]
stiffness = 1e4
damping = 4
limit = { diameter = 0.05, stress_permitted = "6 MPa", stress_transient = "1 GPa" }
[train.shafts.t]
between = ["b", "c"]
stiffness = 1e4
damping = 4
[train.excitations.pulse]
on = "a"
harmonics = [{ order = 2, torque = 80 }]
[train.run]
speed_min = 10
speed_max = 100
points = 3
speed_rated = 100
"""

    def stressed(speed: float) -> float:
        s, omega = 1e4 + 8j * speed, 2.0 * speed
        stiffness = np.array([[s, -s, 0], [-s, 2 * s, -s], [0, -s, s]])
        angles = np.linalg.solve(stiffness - omega**2 * np.diag([2.0, 3.0, 4.0]), [M, 0, 0])
        return float(abs(s * (angles[0] - angles[1])) / W)

    found = barred_ranges(lw.loads(text))
    speeds = np.linspace(10, 100, 4001)
    barred = np.any([(speeds >= one.speed_min) & (speeds <= one.speed_max) for one in found], axis=0)
    too_much = np.array([stressed(speed) > 6e6 for speed in speeds])
    assert len(found) == 2
    np.testing.assert_array_equal(barred, too_much)


HELD_RING = """
format = 1
name = "A stiff fluid holds the ring of a damper"
[train.discs]
hub = {{ inertia = 1 }}
end = {{ inertia = 2 }}
[train.shafts.s]
between = ["hub", "end"]
stiffness = 1e4
loss_factor = 0.02
limit = {{ diameter = 0.05, stress_permitted = "{permitted} Pa", stress_transient = "1 GPa" }}
[train.dampers.houde]
on = "hub"
kind = "viscous"
ring_inertia = 0.6
damping = {damping}
[train.excitations.pulse]
on = "end"
harmonics = [{{ order = 2, torque = 80 }}]
[train.run]
speed_min = 20
speed_max = 100
points = 4
"""


@pytest.mark.parametrize("damping", [1e3, 1e5])
def test_resonance_of_a_damper_whose_ring_is_held(damping: float) -> None:
    """It lies a tenth below that of the hub alone, between speeds 27 rad/s apart."""

    def stress(speed: float) -> float:
        omega = 2 * speed
        k, c = 1e4 * (1 + 0.02j), 1j * omega * damping
        matrix = np.array([[k + c, -k, -c], [-k, k, 0], [-c, 0, c]]) - omega**2 * np.diag([1, 2, 0.6])
        angle = np.linalg.solve(matrix, [0, 80, 0])
        return abs(k * (angle[0] - angle[1])) / W

    resonance = math.sqrt(1e4 * (1 / 1.6 + 1 / 2)) / 2
    found = minimize_scalar(
        lambda x: -stress(x), bounds=(resonance - 3, resonance + 3), options={"xatol": 1e-9}
    )
    peak = float(found.x)
    permitted = 0.5 * stress(peak)
    low, high = (
        brentq(lambda x: stress(x) - permitted, *pair, xtol=1e-13) for pair in ((30, peak), (peak, 100))
    )
    (barred,) = barred_ranges(lw.loads(HELD_RING.format(damping=damping, permitted=permitted)))
    assert (barred.speed_min, barred.speed_max) == pytest.approx((low, high), rel=1e-8)
    assert barred.critical_speed == pytest.approx(peak, rel=1e-6)
