"""One pass over a head, the chart of lengths, slicing over the phase: against closed forms and points."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad

from linkwright import Machine, read, topper
from linkwright.topping import Edge, HeadPass, edges_of, length_chart
from linkwright.topping.coverage import coverage
from linkwright.topping.head_pass import head_pass, worse_edge
from linkwright.topping.slicing import edge_use, slicing_over_phase

MACHINES = Path(__file__).parents[2] / "machines"
D = 0.098
DISC = 0.25 * np.pi * D**2
TO_AND_FRO = 'topper.motion={kind="constant", stroke="50 mm"}'
ONE_WAY = 'topper.motion={kind="constant"}'


def machine(*overrides: str, name: str = "topper") -> Machine:
    return read(MACHINES / f"{name}.toml", list(overrides))


def edges(*overrides: str, name: str = "topper") -> list[Edge]:
    read_in = machine(*overrides, name=name)
    assert read_in.topper is not None
    return edges_of(read_in, read_in.topper)


CASES = {
    "sine": ((), "topper"),
    "crank": ((), "topper_crank"),
    "aslant": (("topper.edge_angle=-55 deg",), "topper"),
    "one way": ((ONE_WAY,), "topper"),
    "at rest": (("topper.knife_speed=0",), "topper"),
    "retreats": (("topper.edge_angle=-50 deg", TO_AND_FRO, "topper.knife_speed=2"), "topper"),
    "runs backwards": (("topper.edge_angle=75 deg", ONE_WAY, "topper.knife_speed=1.5"), "topper"),
}


@pytest.mark.parametrize("case", CASES)
def test_outlines_have_the_area_that_is_left(case: str) -> None:
    """Chords are π/720 apart: a kink of a boundary costs its slope times (r π/720)², 2e-5 of the disc."""
    overrides, name = CASES[case]
    rng = np.random.default_rng(6)
    kinks = 20 if case == "retreats" else 2
    for edge in edges(*overrides, name=name):
        for length, offset, phase in rng.uniform([0.01, -0.03, 0], [0.15, 0.03, 6.28], (4, 3)).tolist():
            found = head_pass(edge, D, offset, phase, length)
            exact = coverage(edge, D, offset, phase, length=length).uncut[0]
            assert abs(found.uncut_area - exact) < kinks * 2e-5 * DISC


@pytest.mark.parametrize("case", ["sine", "retreats", "runs backwards"])
def test_points_inside_the_outlines_are_those_that_no_edge_crosses(case: str) -> None:
    from matplotlib.path import Path as Outline

    overrides, name = CASES[case]
    edge = edges(*overrides, name=name)[0]
    offset, length = 0.015, 0.06
    found = head_pass(edge, D, offset, 1.0, length)
    rng = np.random.default_rng(7)
    turn, radius = rng.uniform(0, 2 * np.pi, 800), 0.5 * D * np.sqrt(rng.uniform(0, 1, 800))
    x, y = radius * np.cos(turn), offset + radius * np.sin(turn)
    inside = np.zeros(800, dtype=bool)
    for outline in found.outlines:
        inside |= Outline(outline).contains_points(np.stack([x, y], axis=1))
    left = ~crossed(found, x, y)
    assert 20 < left.sum() < 780
    # Points as near to a boundary as the edge goes between two instants may fall to either side.
    assert np.count_nonzero(inside != left) <= 3


def crossed(found: HeadPass, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Whether points change the side of the edge while they are beside it."""
    sin, cos = np.sin(found.edge_angle), np.cos(found.edge_angle)
    dx, dy = x[:, None] - found.middle_x, y[:, None] - found.middle_y
    ahead, beside = dx * cos - dy * sin, np.abs(dx * sin + dy * cos) < 0.5 * found.length
    return np.asarray((((ahead[:, 1:] > 0) != (ahead[:, :-1] > 0)) & beside[:, 1:]).any(axis=1))


def segment(height: float) -> float:
    """Area of a circular segment (Bronshtein)."""
    r, h = 0.5 * D, float(np.clip(height, 0, D))
    return float(r**2 * np.arccos(1 - h / r) - (r - h) * np.sqrt(max(0.0, h * (2 * r - h))))


def test_a_knife_at_rest_leaves_two_segments() -> None:
    edge = edges("topper.knife_speed=0", "topper.edge_angle=0")[0]
    length, offset = 0.07, 0.008
    found = head_pass(edge, D, offset, 0.0, length)
    assert len(found.outlines) == 2
    parts = [segment(0.5 * D + side * offset - 0.5 * length) for side in (1, -1)]
    assert found.uncut_area == pytest.approx(sum(parts), rel=1e-4)
    # The edge is at y = ±L/2, its end: all that is left lies beyond.
    assert min(np.abs(outline[:, 1]).min() for outline in found.outlines) == pytest.approx(0.5 * length)


def test_mean_is_that_of_even_offsets() -> None:
    """All offsets count alike: against the integral over offsets of two segments."""
    given = machine("topper.knife_speed=0", "topper.edge_angle=0", "topper.edge_length=0.07")
    found = topper(given)
    d, delta = found.head_diameter, 0.02
    assert d == pytest.approx(D, rel=1e-3)

    def left(offset: float) -> float:
        r = 0.5 * d
        heights = [np.clip(r + side * offset - 0.035, 0, d) for side in (1, -1)]
        return sum(r**2 * np.arccos(1 - h / r) - (r - h) * np.sqrt(h * (d - h)) for h in heights)

    mean = quad(left, -delta, delta, points=[-0.014, 0.014])[0] / (2 * delta)
    # 41 offsets amid even steps.
    assert found.uncut_share_mean == pytest.approx(mean / (0.25 * np.pi * d**2), rel=1e-3)


def test_an_edge_that_moves_along_itself_leaves_the_disc() -> None:
    edge = edges(ONE_WAY, "topper.edge_angle=45 deg", "topper.knife_speed=1.9")[0]
    assert head_pass(edge, D, 0.01, 0.0, 0.2).uncut_area == pytest.approx(DISC, rel=1e-4)


def test_ends_are_half_an_edge_from_the_middle() -> None:
    found = head_pass(edges()[0], D, 0.01, 0.4, 0.2)
    right, left = found.ends
    assert np.hypot(*(left - right).T) == pytest.approx(0.2)
    # α > 0: the left end leads.
    assert (left[:, 0] > right[:, 0]).all()
    assert (left[:, 1] > right[:, 1]).all()
    there = int(np.argmin(np.abs(found.time)))
    assert found.middle_x[there] == 0
    assert found.middle_y[there] == pytest.approx(0.03 * np.sin(0.4))


def test_worse_direction_is_the_knife_towards_its_leading_end() -> None:
    both = edges(ONE_WAY)
    # α > 0: its left end leads.
    assert worse_edge(both, D, 0.02, 0.0, 0.28).knife.drift > 0


def test_chart_goes_through_the_machine() -> None:
    given = machine()
    assert given.topper is not None
    found = topper(given)
    chart = length_chart(given.topper, edges())
    lines = chart.over_roots
    own = int(np.argmin(np.abs(lines.along - 0.11)))
    assert lines.along[own] == pytest.approx(0.11)
    assert lines.published[1, own] == pytest.approx(found.length_published)
    assert lines.consistent[1, own] == pytest.approx(found.length_consistent)
    assert lines.constant_speed[1, own] == pytest.approx(found.length_exact_constant_speed)
    # Lines are straight to 1e-3 between points; the search of the worst head is good to 1e-9.
    moved = np.interp(0.11, lines.moved_along, lines.moved)
    assert moved == pytest.approx(found.length_exact, rel=1e-6)
    speeds = chart.over_speeds
    at = np.interp(0.55, speeds.along, speeds.constant_speed[1])
    assert at == pytest.approx(found.length_exact_constant_speed, rel=1e-3)
    # Faster or slower: some head always meets the knife at the end of its stroke.
    assert speeds.moved == pytest.approx(found.length_exact)


def test_chart_has_no_motion_where_the_edge_retreats() -> None:
    given = machine("topper.edge_angle=60 deg")
    assert given.topper is not None
    speeds = length_chart(given.topper, edges("topper.edge_angle=60 deg")).over_speeds
    # A sine is π/2 times as fast in the middle as in the mean: it retreats from tan 60° · π/2 · v_h = v on.
    limit = 1.9 / (np.sqrt(3) * np.pi / 2)
    assert np.isnan(speeds.moved).tolist() == (speeds.moved_along > limit).tolist()
    assert 0 < np.isnan(speeds.moved).sum() < len(speeds.moved)


def test_chart_keeps_to_a_given_phase() -> None:
    given = machine("topper.motion.phase=180 deg")
    assert given.topper is not None
    chart = length_chart(given.topper, edges_of(given, given.topper))
    own = float(np.interp(0.11, chart.over_roots.moved_along, chart.over_roots.moved))
    assert own == pytest.approx(topper(given).length_exact, rel=1e-6)


def test_slicing_over_the_phase() -> None:
    """|tan(α + β)| with tan β = ẏ/v, ẏ = π v_h/2 · cos φ."""
    phases = np.linspace(0, 2 * np.pi, 37)
    ratio, speed = slicing_over_phase(edges()[0], phases)
    across = 0.5 * np.pi * 0.55 * np.cos(phases)
    assert ratio == pytest.approx(np.abs(np.tan(np.radians(20) + np.arctan2(across, 1.9))))
    assert speed == pytest.approx(np.hypot(1.9, across))
    retreating = edges("topper.edge_angle=70 deg", "topper.knife_speed=1.4")[0]
    assert np.isnan(slicing_over_phase(retreating, phases)[0]).any()


@pytest.mark.parametrize("case", ["sine", "one way", "at rest"])
def test_use_of_the_edge_adds_up_to_the_head(case: str) -> None:
    overrides, name = CASES[case]
    place, use = edge_use(edges(*overrides, name=name), D, 0.02)
    # Ends of chords fall between the 201 places.
    assert np.trapezoid(use, place) == pytest.approx(DISC, rel=2e-3)
