"""The reproduction of paper 2: what it concludes follows from numbers that are checked here."""

from __future__ import annotations

import json
from copy import deepcopy
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import brentq

from linkwright import cam_profile, forces, read
from linkwright.kernel.files.library import library_path
from linkwright.machine import drive_inertia
from linkwright.papers.page import page
from linkwright.papers.paper import printed_values
from linkwright.papers.paper2 import formulas
from linkwright.papers.paper2.alternatives import Alternative
from linkwright.papers.paper2.cam_motion import centre_distance
from linkwright.papers.paper2.formulas import Formulas
from linkwright.papers.paper2.paper import Paper2, paper2

STROKE, TIME = 0.4, 3.0


@pytest.fixture(scope="module")
def paper() -> Paper2:
    return paper2()


def named(paper: Paper2, short: str) -> Alternative:
    """A drive by its short name."""
    return next(each for each in paper.alternatives if each.short == short)


def test_numbers_of_the_worked_case(paper: Paper2) -> None:
    v, t_p = 0.1538461538461538, 0.5
    assert paper.formulas.speed == pytest.approx(v, rel=1e-14)
    assert paper.profile.speed_constant == pytest.approx(v, rel=1e-14)
    assert paper.profile.acceleration_max == pytest.approx(16 / 9 * v / t_p, rel=1e-13)
    assert paper.profile.jerk_max == pytest.approx(12 * v / t_p**2, rel=1e-13)
    assert sum(paper.formulas.travels.values()) == pytest.approx(STROKE, rel=1e-14)


def test_printed_profile_is_typed_as_printed() -> None:
    """(17) to (22) written out once more."""
    formulas, b, dx, pi = Formulas(printed_values(2)), 1.0, STROKE, np.pi

    def by_hand(phi: float) -> float:
        if phi <= pi / 6:
            bracket = 1 - 6 * phi / pi + 10.8 * phi**2 / pi**2
            return b / 2 + 1080 / 13 * dx * bracket * (phi / pi) ** 3 - dx / 2
        if phi <= 5 * pi / 6:
            return b / 2 + 3 / 26 * dx * (1 + 10 * (phi - pi / 6) / pi) - dx / 2
        w = (phi - 5 * pi / 6) / pi
        return b / 2 + dx / 2 - 15 / 13 * dx * (0.1 - w + 216 * w**4 - 777.6 * w**5)

    phi = np.linspace(0.01, 3.1, 50)
    there = np.array([by_hand(each) for each in phi])
    np.testing.assert_allclose(formulas.radius(phi, b), there, rtol=1e-14)
    np.testing.assert_allclose(formulas.radius(phi + pi, b), b - there, rtol=1e-14)


@pytest.mark.parametrize(
    ("place", "value", "row"),
    [
        (("stop", "motion", 0, "terms", 5), 0.5, "(3) by itself"),
        (("start", "motion", 3, "factor"), 11, "(1)–(3), jerk"),
        (("stop", "motion", 2, "terms", 2), -1.1, "(1)–(3), ẍ"),
        (("profile", 0, "terms", 5), 10.7, "(17)–(22), ρ(φ)"),
        (("profile", 2, "terms", 4), 215, "(17)–(22) at their joints"),
        (("travel", "stop", 0), 3.1, "S_g = 3/5 v t_g"),
    ],
)
def test_a_misprint_would_be_found(paper: Paper2, place: tuple[str, ...], value: float, row: str) -> None:
    printed = deepcopy(paper.published)
    node = printed
    for key in place[:-1]:
        node = node[key]
    node[place[-1]] = value
    typed = replace(paper, published=printed, formulas=Formulas(printed))
    rows = {each.name: each for each in typed.rows}
    assert rows[row].kind in ("near", "far")


def test_synthesis_agrees_with_the_printed_formulas(paper: Paper2) -> None:
    # Sums of a dozen terms of size 1 round to some 1e-15.
    assert formulas.radius_difference(paper.formulas, paper.profile) < 4e-15
    assert formulas.diameter_difference(paper.formulas, paper.profile) < 4e-15
    assert paper.profile.diameter_min == pytest.approx(1.0, abs=1e-12)
    assert paper.profile.diameter_max == pytest.approx(1.0, abs=1e-12)
    kinds = {row.kind for row in paper.rows}
    assert kinds == {"reproduced", "near", "none"}


def _least(degree: int, *, jerk_ends_in_zero: bool) -> tuple[float, float]:
    """∫ jerk² and travel of the best polynomial velocity of a degree, by its normal equations.

    The velocity is Σ c_k u^k with c_0 = c_1 = 0, Σ c_k = 1, Σ k c_k = 0, and perhaps Σ k (k − 1) c_k = 0.
    """
    k = np.arange(2, degree + 1)
    second = np.outer(k * (k - 1), k * (k - 1)) / (k[:, None] + k - 3.0)
    rows = [np.ones(len(k)), k, k * (k - 1)][: 3 if jerk_ends_in_zero else 2]
    A = np.array(rows, dtype=float)
    n, m = len(k), len(A)
    system = np.block([[2 * second, A.T], [A, np.zeros((m, m))]])
    solved = np.linalg.solve(system, np.concatenate((np.zeros(n), [1.0], np.zeros(m - 1))))[:n]
    return float(solved @ second @ solved), float(np.sum(solved / (k + 1)))


def test_minimum_by_the_normal_equations(paper: Paper2) -> None:
    free, printed = paper.starts["free_travel"], paper.starts["printed"]
    for degree in (3, 4, 5, 7):
        assert _least(degree, jerk_ends_in_zero=False) == pytest.approx((12.0, 0.5), rel=1e-7)
    assert (free.cost, free.travel) == pytest.approx((12.0, 0.5), rel=1e-13)
    # ∫ 144 (1 − 4u + 3u²)² du = 144 (1 − 4 + 22/3 − 6 + 9/5)
    assert printed.cost == pytest.approx(144 * (1 - 4 + 22 / 3 - 6 + 9 / 5), rel=1e-13)
    assert paper.starts["fixed_travel"].cost == pytest.approx(printed.cost, rel=1e-13)


def test_jerk_at_an_end_is_no_condition(paper: Paper2) -> None:
    """With it the printed law is the only one of degree 4 in the velocity; higher ones come down to 12."""
    costs = [_least(degree, jerk_ends_in_zero=True)[0] for degree in (4, 5, 6, 8, 10)]
    assert costs[0] == pytest.approx(paper.starts["printed"].cost, rel=1e-9)
    assert all(b < a for a, b in pairwise(costs))
    assert 12.0 < costs[-1] < 13.0


def test_minimum_with_free_acceleration(paper: Paper2) -> None:
    """ẋ = (3u − u³)/2: jerk −3u, so ∫ jerk² = 3 and the travel 5/8."""
    free, u = paper.starts["free_acceleration"], np.linspace(0, 1, 11)
    np.testing.assert_allclose(free.law.at(u, 1), (3 * u - u**3) / 2, atol=1e-14)
    assert (free.cost, free.travel) == pytest.approx((3.0, 0.625), rel=1e-13)


# Short name → peaks of velocity, acceleration and jerk over Δx/t_3 and its powers, and step of the jerk.
_V = 1 / (0.5 / 3 + 2 / 3)
PEAKS = {
    "as printed": (15 / 13, 16 / 9 * 6 * 15 / 13, 12 * 36 * 15 / 13, 24 * 36 * 15 / 13),
    "1/2 each": (5 / 3, 16 / 9 * 2 * 5 / 3, 12 * 4 * 5 / 3, 24 * 4 * 5 / 3),
    "free travel": (_V, 1.5 * 6 * _V, 6 * 36 * _V, 12 * 36 * _V),
    # Velocity 10u³ − 15u⁴ + 6u⁵ over a sixth.
    "continuous jerk": (_V, 15 / 8 * 6 * _V, 10 / np.sqrt(3) * 36 * _V, 0.0),
    "free at the reversal": (8 / 7, 1.5 * 6 * 8 / 7, 3 * 36 * 8 / 7, 3 * 36 * 8 / 7),
    "polynomial 4-5-6-7": (35 / 16, 84 * np.sqrt(5) / 25, 52.5, 0.0),
    "cycloidal": (2.0, 2 * np.pi, 4 * np.pi**2, 8 * np.pi**2),
    "harmonic": (np.pi / 2, np.pi**2 / 2, np.pi**3 / 2, 0.0),
}


@pytest.mark.parametrize("short", PEAKS)
def test_peaks_of_the_laws(paper: Paper2, short: str) -> None:
    each = named(paper, short)
    found = each.velocity_max * TIME, each.acceleration_max * TIME**2, each.jerk_max * TIME**3
    assert np.array(found) / STROKE == pytest.approx(PEAKS[short][:3], rel=1e-12)
    # The curves are taken every tenth of a degree.
    assert np.abs(each.velocity).max() == pytest.approx(each.velocity_max, rel=1e-4)
    assert np.abs(each.acceleration).max() == pytest.approx(each.acceleration_max, rel=1e-4)
    assert each.jerk_step * TIME**3 / STROKE == pytest.approx(PEAKS[short][3], abs=1e-9)


def test_crank_at_its_dead_centre(paper: Paper2) -> None:
    """At the outer dead centre the cart has rω² (1 + r/l)."""
    assert named(paper, "crank").acceleration_max == pytest.approx(0.2 * (np.pi / 3) ** 2 * 1.25, rel=1e-6)


@pytest.mark.parametrize("short", ["as printed", "crank", "cycloidal"])
def test_force_and_torque_by_the_equilibrium_of_all_members(paper: Paper2, short: str) -> None:
    each = named(paper, short)
    acting = forces(each.machine, each.steady)
    middle = slice(1, None, 2)
    assert each.machine.drive is not None
    turned = acting.torque_drive - float(drive_inertia(each.machine.drive)) * acting.acceleration
    # The two add the same forces of some 4 kN in another order.
    np.testing.assert_allclose(each.torque, turned[middle], atol=1e-8)
    if each.machine.mechanism.cams:
        normal = np.abs(acting.drives["cart"][middle])
        assert (normal > np.abs(each.force) - 1e-8).all()
        assert normal.max() == pytest.approx(np.abs(each.force / np.cos(_gamma(each))).max(), rel=1e-9)


def _gamma(each: Alternative) -> np.ndarray:
    """Pressure angle of the follower that carries, tan γ = s'/ρ."""
    cam = cam_profile(each.machine).cam
    s, slope = (cam.lift.at(each.crank_angle, order) for order in (0, 1))
    rho = np.where(each.force > 0, cam.base + s, cam.base + cam.stroke - s)
    return np.arctan(slope / rho)


def test_torque_at_constant_speed(paper: Paper2) -> None:
    """Where the cart rolls evenly the torque is F v/ω."""
    each = paper.alternatives[0]
    middle = np.abs(each.crank_angle - np.pi / 2).argmin()
    # The shaft still settles there by 1e-7.
    assert each.torque[middle] == pytest.approx(3562 * 15 / 13 * STROKE / np.pi, rel=1e-6)


def test_same_drive_for_all(paper: Paper2) -> None:
    first = paper.alternatives[0].machine
    for each in paper.alternatives:
        assert each.machine.drive == first.drive
        assert each.machine.loads == first.loads
        assert each.machine.bodies == first.bodies
        assert each.velocity.max() > 0
        # 4 F Δx/2 of work a revolution, whatever the law.
        assert each.steady.energy_load == pytest.approx(2 * 3562 * STROKE, rel=1e-9)


def test_what_is_said_of_the_alternatives(paper: Paper2) -> None:
    printed, free, crank = (named(paper, name) for name in ("as printed", "free at the reversal", "crank"))
    for name in ("velocity_max", "acceleration_max", "jerk_max", "torque_max"):
        assert getattr(free, name) < getattr(printed, name)
    assert free.steady.unevenness < printed.steady.unevenness < crank.steady.unevenness
    assert printed.steady.dynamism > crank.steady.dynamism
    assert printed.steady_share == pytest.approx(10 / 13, rel=1e-12)
    smooth = named(paper, "continuous jerk")
    assert smooth.jerk_max / printed.jerk_max == pytest.approx(0.5, abs=0.01)


def test_hollow_by_the_polar_formula(paper: Paper2) -> None:
    """κ = (ρ² + 2ρ′² − ρρ″)/(ρ² + ρ′²)^1.5 of (17), by differences."""
    phi, h = np.linspace(0.05, 0.4, 2001), 1e-4
    low, mid, high = (paper.formulas.radius(phi + step, 1.0) for step in (-h, 0.0, h))
    d1, d2 = (high - low) / (2 * h), (high - 2 * mid + low) / h**2
    bend = (mid**2 + 2 * d1**2 - mid * d2) / (mid**2 + d1**2) ** 1.5
    # Second differences keep six digits.
    assert paper.rollers.largest_in_hollow == pytest.approx(-1 / bend.min(), rel=1e-5)


def test_roller_on_the_profile_by_distance(paper: Paper2) -> None:
    """The centre lies where its smallest distance from the profile is the radius."""
    radius = paper.rollers.radius
    found = centre_distance(paper.profile, radius)
    x, y = paper.profile.flanks[0].curve().points(np.linspace(0, 2 * np.pi, 200_001)).T
    for n in (500, 3000, 12_000, 30_000, 38_000):
        phi = n * 2 * np.pi / len(found)
        cos, sin = np.cos(phi), -np.sin(phi)

        def spare(reach: float, cos: float = cos, sin: float = sin) -> float:
            return float(np.hypot(x - reach * cos, y - reach * sin).min()) - radius

        # Points 3e-5 m apart see the smallest distance to 1e-8.
        assert found[n] == pytest.approx(brentq(spare, found[n] - 0.01, found[n] + 0.01), abs=1e-7)


def test_rollers_with_the_printed_curve_as_centres(paper: Paper2) -> None:
    offset = paper.rollers.offset
    assert offset.diameter_min == pytest.approx(offset.diameter_max, abs=1e-12)
    assert offset.base_radius == pytest.approx(0.3 - paper.rollers.radius, rel=1e-12)
    assert paper.rollers.play > 1e-3


def test_pressure_angle_by_the_printed_formulas(paper: Paper2) -> None:
    """tan γ = ẋ/(ω ρ) of (1) to (3) and (17), at points every 3e-5 s."""
    time = np.linspace(0.0, TIME, 100_001)
    rho = paper.formulas.radius(np.pi * time / TIME, 1.0)
    lead = paper.formulas.stroke_motion(time, 1) * TIME / np.pi / rho
    assert paper.profile.pressure_angle_max == pytest.approx(np.arctan(lead.max()), rel=1e-8)


def test_breadth_that_reaches_the_limit(paper: Paper2) -> None:
    entries = {"mechanism.cams.cart.breadth": paper.rollers.breadth_for_limit}
    found = cam_profile(read(library_path("roller_cam"), entries))
    assert found.pressure_angle_max == pytest.approx(np.pi / 6, rel=1e-9)


def test_two_cams_leave_no_side_force(paper: Paper2) -> None:
    """One cam presses with F tan γ across the travel; that of its mirror image is the opposite."""
    each = paper.alternatives[0]
    # At the design speed instead of the steady motion: within some percent.
    assert paper.pair["side_force"] == pytest.approx(
        np.abs(each.force * np.tan(_gamma(each))).max(), rel=0.02
    )
    assert paper.pair["left_over"] < 1e-12 * paper.pair["side_force"]


def test_course_of_the_cart(paper: Paper2) -> None:
    found = paper.course
    law = paper.profile.cam.lift
    # The place of the cart, by the angle of the shaft over time, differentiated.
    slope = np.gradient(law.at(paper.alternatives[0].steady.crank_angle), found.time)
    np.testing.assert_allclose(found.velocity[1:-1], slope[1:-1], atol=1e-5)
    assert np.trapezoid(np.abs(found.intended), found.time) == pytest.approx(2 * STROKE, rel=1e-6)
    low, high = found.steady_range
    assert high - low < 1e-4
    assert 0.98 < low < high < 1.0
    assert found.deviation_max == pytest.approx(0.0484, abs=5e-4)


def test_everything_is_told(paper: Paper2) -> None:
    told = json.loads(json.dumps(paper.to_dict(), allow_nan=False))
    assert told["conclusions"] == paper.conclusions
    assert len(told["alternatives"]) == len(paper.alternatives)
    drawn = paper.figures()
    text = page(paper, drawn)
    assert text.count("<svg") == len(drawn)
    for row in paper.rows:
        assert row.verdict.split(",")[0] in text
    for each in paper.alternatives:
        assert each.name in text
