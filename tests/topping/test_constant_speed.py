"""The knife that keeps its speed, the head, the lengths of paper 5: brute force, geometry, limits."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from knife_sweep import (
    Pass,
    is_cut,
    lattice,
    length_by_bisection,
    needed_length,
    one_direction,
    rim,
    uncut_share,
)
from numpy.typing import NDArray
from scipy.integrate import quad

from linkwright import Machine
from linkwright.topping import (
    Edge,
    Topper,
    cap_volume,
    constant_speed_lengths,
    head_diameter,
    knives,
    length_consistent,
    length_published,
    published_lengths,
)

Floats = NDArray[np.float64]

# A knife that does not turn back over a head.
TOPPER = Topper.model_validate(
    {
        "root_diameter": 0.11,
        "cut_height": 0.03,
        "edge_length": 0.28,
        "forward_speed": 1.9,
        "knife_speed": 0.55,
        "motion": {"kind": "constant"},
    }
)
MACHINE = Machine(format=1, name="Topper", topper=TOPPER)

# Rounding of a handful of operations.
EXACT = 1e-12
# Edges that advance, also knives with the other end ahead, at rest, straight across; the last two run
# backwards over the head while the knife moves towards the leading end.
KNIVES = {
    "usual": (20.0, 1.9, 0.55),
    "right end ahead": (-35.0, 1.6, 0.8),
    "straight": (0.0, 2.2, 0.8),
    "at rest": (28.0, 2.2, 0.0),
    "hardly advances": (60.0, 1.9, 1.0),
    "retreats": (70.0, 1.6, 1.4),
    "retreats, right end ahead": (-80.0, 2.0, 0.9),
}
DIAMETER, OFFSET = 0.098, 0.02

diameters, offsets = st.floats(0.02, 0.3), st.floats(0.0, 0.1)
angles, forward, across = st.floats(-1.4, 1.4), st.floats(0.3, 4.0), st.floats(0.0, 2.0)


def over(name: str, direction: int, offset: float = OFFSET) -> Pass:
    """The knife goes over a head in one direction all the time."""
    angle, v, v_h = KNIVES[name]
    knife = one_direction(direction * v_h, math.radians(angle), v, DIAMETER / 2 + OFFSET)
    return Pass(knife, DIAMETER, offset)


def both(name: str, offset: float = OFFSET) -> Floats:
    angle, v, v_h = KNIVES[name]
    return constant_speed_lengths(DIAMETER, offset, math.radians(angle), v, v_h)


def advance(alpha: float, v: float, v_h: float) -> float:
    return v * math.cos(alpha) - v_h * abs(math.sin(alpha))


# --- the length against brute force and against geometry ----------------------------------------------------


@pytest.mark.parametrize("name", KNIVES)
@pytest.mark.parametrize("direction", [1, -1])
def test_length_is_that_of_the_swept_points(name: str, direction: int) -> None:
    # The brute force closes in on the point that needs most to 1e-5 of the head; lengths are round there.
    passes = [over(name, direction, each) for each in (-OFFSET, 0.0, OFFSET)]
    swept = max(needed_length(each, n=12, rounds=16) for each in passes)
    assert both(name)[(1 - direction) // 2] == pytest.approx(swept, rel=1e-7)


@pytest.mark.parametrize("name", ["usual", "right end ahead", "retreats"])
@pytest.mark.parametrize("direction", [1, -1])
def test_length_is_that_of_the_swept_parallelograms(name: str, direction: int) -> None:
    # 80 points of the rim: the farthest is off by at most (π/80)²/2 of the radius.
    passes = [over(name, direction, each) for each in (-OFFSET, OFFSET)]
    swept = max(length_by_bisection(each, rim(each, 80)) for each in passes)
    found = float(both(name)[(1 - direction) // 2])
    assert found * (1 - 1e-3) <= swept <= found * (1 + 1e-5)


@given(diameters, offsets, angles, forward, across)
def test_band_holds_the_heads_seen_along_the_way(
    d: float, offset: float, alpha: float, v: float, v_h: float
) -> None:
    """Heads and edge projected onto the normal of the way: the farthest points of a fine circle."""
    found = constant_speed_lengths(d, offset, alpha, v, v_h)
    turn = np.linspace(0, 2 * np.pi, 2001)
    heads = [np.stack([d / 2 * np.cos(turn), d / 2 * np.sin(turn) + each]) for each in (-offset, offset)]
    for length, side in zip(found, (1, -1), strict=True):
        way = np.array([v, side * v_h]) / math.hypot(v, v_h)
        aside = np.array([-way[1], way[0]])
        half = length / 2 * abs(aside @ [math.sin(alpha), math.cos(alpha)])
        farthest = max(float((aside @ head).max()) for head in heads)
        if math.isfinite(length):
            # 2000 points of the circle: (π/2000)²/2 of the radius are missed.
            assert half == pytest.approx(farthest, rel=2e-6)


@pytest.mark.parametrize("name", KNIVES)
def test_a_little_more_cuts_all_and_a_little_less_does_not(name: str) -> None:
    lengths = both(name)
    for direction, length in zip((1, -1), lengths, strict=True):
        passes = [over(name, direction, each) for each in (-OFFSET, OFFSET)]
        assert all(is_cut(each, lattice(each, 40), length * 1.001).all() for each in passes)
        assert any(uncut_share(each, length * 0.9)[0] > 0 for each in passes)


def segment(height: float) -> float:
    """Share of a disc of diameter 1 that a chord cuts off at this distance from the circle."""
    u = 1 - 2 * min(max(height, 0.0), 1.0)
    return (math.acos(u) - u * math.sqrt(1 - u * u)) / math.pi


@pytest.mark.parametrize("name", ["usual", "right end ahead", "straight", "at rest", "retreats"])
@pytest.mark.parametrize("direction", [1, -1])
@pytest.mark.parametrize(("offset", "share"), [(0.0, 0.8), (OFFSET, 0.7), (-OFFSET, 0.25)])
def test_what_a_short_edge_leaves_are_two_segments(
    name: str, direction: int, offset: float, share: float
) -> None:
    """Calibrates the brute force: the band is straight, what lies beside it are segments of the disc."""
    angle, v, v_h = KNIVES[name]
    length = share * both(name)[(1 - direction) // 2]
    speed = math.hypot(v, v_h)
    band = length * abs(v * math.cos(math.radians(angle)) - direction * v_h * math.sin(math.radians(angle)))
    beside = [0.5 - (band / speed / 2 + side * offset * v / speed) / DIAMETER for side in (1, -1)]
    found, error = uncut_share(over(name, direction, offset), length)
    assert found == pytest.approx(sum(map(segment, beside)), abs=error)


# --- limits -------------------------------------------------------------------------------------------------


@given(diameters, offsets, angles, forward)
def test_knife_at_rest_has_to_span_the_band(d: float, offset: float, alpha: float, v: float) -> None:
    found = constant_speed_lengths(d, offset, alpha, v, 0.0)
    assert found == pytest.approx([(d + 2 * offset) / math.cos(alpha)] * 2, rel=EXACT)


@given(diameters, offsets, forward, across)
def test_straight_edge_is_the_same_both_ways(d: float, offset: float, v: float, v_h: float) -> None:
    found = constant_speed_lengths(d, offset, 0.0, v, v_h)
    expected = d * math.sqrt(1 + (v_h / v) ** 2) + 2 * offset
    assert found == pytest.approx([expected, expected], rel=EXACT)


@given(diameters, offsets, st.floats(0.05, 1.5), forward)
def test_no_length_does_for_an_edge_that_moves_along_itself(
    d: float, offset: float, alpha: float, v: float
) -> None:
    # v_h is rounded, and so are the tangent, sine and cosine: the edge advances by a few roundings of v.
    left, right = constant_speed_lengths(d, offset, alpha, v, v / math.tan(alpha))
    assert left > 1e14 * d
    assert right == pytest.approx((d / math.sin(alpha) + 2 * offset) / (2 * math.cos(alpha)), rel=EXACT)


def test_edge_that_moves_exactly_along_itself() -> None:
    assert constant_speed_lengths(0.1, 0.02, math.pi / 4, 1.5, 1.5)[0] == np.inf
    assert constant_speed_lengths(0.1, 0.02, -math.pi / 4, 1.5, 1.5)[1] == np.inf


@given(diameters, offsets, angles, forward, across)
def test_mirror_image_swaps_the_directions(
    d: float, offset: float, alpha: float, v: float, v_h: float
) -> None:
    found = constant_speed_lengths(d, offset, alpha, v, v_h)
    assert np.array_equal(found[::-1], constant_speed_lengths(d, offset, -alpha, v, v_h))


def test_right_triangle_by_hand() -> None:
    # sin α = 0.6, v = 4 and v_h = 3 m/s: speed 5, advance 4·0.8 ∓ 3·0.6; 80·5 + 2·10·4 = 480 mm of way.
    found = constant_speed_lengths(0.08, 0.01, math.asin(0.6), 4.0, 3.0)
    assert found == pytest.approx([0.48 / 1.4, 0.48 / 5.0], rel=EXACT)


def test_all_arguments_broadcast() -> None:
    d, v_h = np.array([0.05, 0.1])[:, None], np.array([0.3, 0.5, 0.8])
    found = constant_speed_lengths(d, 0.02, 0.4, 1.9, v_h)
    assert found.shape == (2, 2, 3)
    assert found[:, 1, 2] == pytest.approx(constant_speed_lengths(0.1, 0.02, 0.4, 1.9, 0.8), rel=EXACT)


# --- what holds for all -------------------------------------------------------------------------------------


@given(diameters, offsets, angles, forward, across, st.floats(1.0, 2.0))
def test_larger_heads_and_offsets_need_more(
    d: float, offset: float, alpha: float, v: float, v_h: float, factor: float
) -> None:
    least = constant_speed_lengths(d, offset, alpha, v, v_h)
    assert (constant_speed_lengths(d * factor, offset, alpha, v, v_h) >= least).all()
    assert (constant_speed_lengths(d, offset * factor, alpha, v, v_h) >= least).all()


@given(diameters, offsets, angles, forward, across)
def test_no_edge_is_shorter_than_the_head_is_wide(
    d: float, offset: float, alpha: float, v: float, v_h: float
) -> None:
    # The band is no wider than the edge is long, and holds the head.
    found = constant_speed_lengths(d, offset, alpha, v, v_h)
    assert (found >= (d + 2 * offset * v / math.hypot(v, v_h)) * (1 - EXACT)).all()


@given(diameters, offsets, angles, forward, across)
def test_edge_that_advances_needs_more_than_one_at_rest(
    d: float, offset: float, alpha: float, v: float, v_h: float
) -> None:
    worse = constant_speed_lengths(d, offset, alpha, v, v_h).max()
    if advance(alpha, v, v_h) > 0:
        assert worse >= (d + 2 * offset) / math.cos(alpha) * (1 - EXACT)


@given(diameters, offsets, angles, forward, across, st.floats(1.0, 2.0))
def test_faster_knife_that_still_advances_needs_more(
    d: float, offset: float, alpha: float, v: float, v_h: float, factor: float
) -> None:
    if advance(alpha, v, v_h * factor) > 0:
        slow = constant_speed_lengths(d, offset, alpha, v, v_h).max()
        assert constant_speed_lengths(d, offset, alpha, v, v_h * factor).max() >= slow * (1 - EXACT)


@given(diameters, offsets, angles, forward, across, st.sampled_from([0.25, 0.5, 2.0, 8.0]))
def test_lengths_scale_and_only_the_ratio_of_speeds_matters(
    d: float, offset: float, alpha: float, v: float, v_h: float, k: float
) -> None:
    # Powers of two leave no rounding.
    once = constant_speed_lengths(d, offset, alpha, v, v_h)
    assert np.array_equal(constant_speed_lengths(d * k, offset * k, alpha, v, v_h), once * k)
    assert np.array_equal(constant_speed_lengths(d, offset, alpha, v * k, v_h * k), once)


@given(st.floats(-1.5, 1.5), forward, across)
def test_retreats_where_the_edge_stands_still_or_runs_back(alpha: float, v: float, v_h: float) -> None:
    ways = knives(MACHINE, TOPPER.with_entries({"knife_speed": v_h}))
    edges = [Edge(knife, alpha, v) for knife in ways]
    forth = advance(alpha, v, v_h)
    assert min(edge.least_advance for edge in edges) == pytest.approx(forth, abs=1e-12)
    if abs(forth) > 1e-9:
        assert any(edge.retreats for edge in edges) == (forth < 0)


def test_edge_that_stands_still_counts_as_retreating() -> None:
    knife = knives(MACHINE, TOPPER.with_entries({"knife_speed": 2 * (1 + 1e-15)}))[0]
    assert Edge(knife, math.atan(0.5), 1.0).retreats
    assert not Edge(knife, math.atan(0.4999), 1.0).retreats


# --- the head -----------------------------------------------------------------------------------------------


@given(st.floats(0.02, 0.3), st.floats(0.0, 1.0))
def test_disc_is_the_sphere_at_the_height_of_the_cut(D: float, share: float) -> None:
    above_centre = D / 2 - share * D
    # The squares cancel near the poles: half the digits are left there.
    chord = 2 * math.sqrt(max(0.0, (D / 2) ** 2 - above_centre**2))
    assert float(head_diameter(D, share * D)) == pytest.approx(chord, abs=1e-7 * D)
    assert float(head_diameter(D, share * D)) == pytest.approx(head_diameter(D, D - share * D), abs=1e-7 * D)


@pytest.mark.parametrize(("D", "h"), [(0.11, 0.03), (0.11, 0.055), (0.09, 0.08), (0.1, 0.1), (0.1, 1e-3)])
def test_cap_is_the_discs_piled_up(D: float, h: float) -> None:
    def disc(height: float) -> float:
        return math.pi / 4 * float(head_diameter(D, height)) ** 2

    assert float(cap_volume(D, h)) == pytest.approx(quad(disc, 0.0, h)[0], rel=1e-10)


def test_cut_beside_the_root() -> None:
    D = 0.1
    assert np.array_equal(head_diameter(D, np.array([-0.01, 0.0, D, 0.12])), np.zeros(4))
    assert np.array_equal(cap_volume(D, np.array([-0.01, 0.0])), np.zeros(2))
    assert cap_volume(D, np.array([D, 0.2])) == pytest.approx([math.pi / 6 * D**3] * 2, rel=EXACT)


@given(st.floats(0.02, 0.3), st.floats(0.0, 1.0))
def test_cap_and_what_is_left_are_the_sphere(D: float, share: float) -> None:
    both_parts = float(cap_volume(D, share * D) + cap_volume(D, D - share * D))
    assert both_parts == pytest.approx(math.pi / 6 * D**3, rel=EXACT)


# --- the lengths of the paper -------------------------------------------------------------------------------


def test_published_lengths_by_hand() -> None:
    """D = 100, h_p = 20: d = 2 √(20·80) = 80 mm. Δ = 10, b = 100 mm; sin α = 0.6, v_h/v = 1/2.

    (10): 100 (0.5·0.8 + 0.6) = 100 mm. From (4): 100 (0.5 (1 + 0.75·0.6) + 0.6) = 132.5 mm.
    S_x = 100 (0.8 + 0.36) = 116 mm, at 2 m/s 58 ms. S_y = (200 − 60)·0.8 = 112 mm, at 1 m/s 112 ms.
    """
    d = float(head_diameter(0.1, 0.02))
    assert d == pytest.approx(0.08, rel=EXACT)
    found = published_lengths(d + 0.02, math.asin(0.6), 0.2, 2.0, 1.0)
    assert found.length_published == pytest.approx(0.1, rel=EXACT)
    assert found.length_consistent == pytest.approx(0.1325, rel=EXACT)
    assert (found.travel_along, found.travel_across) == pytest.approx((0.116, 0.112), rel=EXACT)
    assert (found.time_along, found.time_across) == pytest.approx((0.058, 0.112), rel=EXACT)
    assert found.holds


@given(st.floats(0.05, 0.4), angles, forward, st.floats(0.05, 2.0))
def test_consistent_length_is_where_both_travels_last_as_long(
    b: float, alpha: float, v: float, v_h: float
) -> None:
    least = float(length_consistent(b, alpha, v_h / v))
    found = published_lengths(b, alpha, least, v, v_h)
    # L − b sin α cancels where the knife is slow: roundings of b over v_h.
    assert found.time_across == pytest.approx(found.time_along, rel=1e-12, abs=1e-14 * b / v_h)
    assert published_lengths(b, alpha, least * 1.001, v, v_h).holds
    assert not published_lengths(b, alpha, least * 0.999, v, v_h).holds


@given(st.floats(0.05, 0.4), angles, st.floats(0.0, 3.0))
def test_printed_bound_asks_no_more_than_the_condition_it_comes_from(
    b: float, alpha: float, r: float
) -> None:
    # cos α ≤ 1 + tan α sin α, equal only straight across.
    printed, consistent = length_published(b, alpha, r), length_consistent(b, alpha, r)
    assert printed <= consistent * (1 + EXACT)
    assert consistent - printed == pytest.approx(
        b * r * (1 - math.cos(alpha) + abs(math.tan(alpha) * math.sin(alpha))), rel=1e-9, abs=1e-15
    )


@given(st.floats(0.05, 0.4), angles, forward)
def test_both_bounds_of_the_paper_forget_the_knife_at_rest(b: float, alpha: float, v: float) -> None:
    exact = constant_speed_lengths(b, 0.0, alpha, v, 0.0).max()
    for bound in (length_published, length_consistent):
        assert float(bound(b, alpha, 0.0)) == pytest.approx(b * abs(math.sin(alpha)), rel=EXACT)
        assert bound(b, alpha, 0.0) < exact
    assert float(length_published(b, 0.0, 0.0)) == 0.0


def test_condition_for_a_knife_at_rest() -> None:
    long, short = (published_lengths(0.1, 0.5, length, 2.0, 0.0) for length in (0.2, 0.04))
    assert (long.time_across, long.holds) == (np.inf, True)
    assert (short.time_across, short.holds) == (-np.inf, False)


@pytest.mark.parametrize("v", [1.6, 1.9, 2.2])
def test_paper_knows_no_sign_of_the_angle(v: float) -> None:
    left, right = (published_lengths(0.14, angle, 0.28, v, 0.5) for angle in (0.4, -0.4))
    assert left == right
