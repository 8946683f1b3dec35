"""What the knife cuts of a head, for any law: against points swept one by one, and what must hold for all."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from knife_sweep import Knife as Swept
from knife_sweep import (
    Law,
    Pass,
    dwell_rise_dwell_return,
    is_cut,
    lattice,
    length_by_bisection,
    lengths_of_points,
    needed_length,
    rim,
    slider_crank,
    to_and_fro,
    triangular,
    uncut_by_slices,
    uncut_share,
    worst,
)
from sizes import cases

import linkwright as lw
from linkwright import InputError
from linkwright.kernel.numerics.zeros import zero
from linkwright.topping import Coverage, Edge, Knife, constant_speed_lengths, knives
from linkwright.topping.coverage import COARSE, coverage
from linkwright.topping.worst_head import worst_head

LAWS: dict[str, Law] = {
    "harmonic": np.sin,
    "triangular": triangular,
    "slider-crank": slider_crank(3.0),
    "short rod": slider_crank(1.6),
    "dwells": dwell_rise_dwell_return(0.12, 0.25),
}

TOPPER = """format = 1
name = "Topper"
[topper]
root_diameter = "110 mm"
cut_height = "30 mm"
edge_length = "0.28 m"
forward_speed = "1.9 m/s"
"""
MOVED = """[topper.motion]
kind = "member"
of = "K"
[drive]
speed = {rate!r}
"""
MOTIONS = {
    "harmonic": "knife_speed = {speed!r}\n[topper.motion]\nkind = 'harmonic'\nstroke = {stroke!r}\n",
    "triangular": "knife_speed = {speed!r}\n[topper.motion]\nkind = 'constant'\nstroke = {stroke!r}\n",
    "slider-crank": MOVED
    + "[mechanism]\ncranks.C.radius = {r!r}\nsliders.K = {{ crank = 'C', rod = {l3!r} }}\n",
    "short rod": MOVED
    + "[mechanism]\ncranks.C.radius = {r!r}\nsliders.K = {{ crank = 'C', rod = {l16!r} }}\n",
    "dwells": MOVED
    + """[mechanism.cams.K]
follower = "translating"
contact = "point"
base_radius = 0.3
sections = [
    {{ angle = "43.2 deg", lift = 0 }},
    {{ angle = "90 deg", lift = {stroke!r}, law = "cycloidal" }},
    {{ angle = "43.2 deg", lift = 0 }},
    {{ angle = "183.6 deg", lift = -{stroke!r}, law = "cycloidal" }},
]
""",
}


@cache
def knife_of(law: str, stroke: float, speed: float) -> Knife:
    numbers = {"rate": math.pi * speed / stroke, "r": stroke / 2, "l3": 1.5 * stroke, "l16": 0.8 * stroke}
    machine = lw.loads(TOPPER + MOTIONS[law].format(speed=speed, stroke=stroke, **numbers))
    assert machine.topper is not None
    (knife,) = knives(machine, machine.topper)
    return knife


@dataclass(frozen=True)
class Case:
    """One knife over one head, in mm, degrees and m/s; the phase in degrees."""

    law: str = "harmonic"
    stroke: float = 60.0
    knife_speed: float = 0.55
    angle: float = 20.0
    forward: float = 1.9
    diameter: float = 98.0
    offset: float = 20.0
    phase: float = 40.0

    def swept(self) -> Swept:
        law, angle = LAWS[self.law], math.radians(self.angle)
        return to_and_fro(law, self.stroke / 1000, self.knife_speed, angle, self.forward)

    def over(self) -> Pass:
        return Pass(self.swept(), self.diameter / 1000, self.offset / 1000, math.radians(self.phase))

    def all_phases(self) -> float:
        """(S + d + 2Δ)/cos α: the edge is long enough wherever the knife stands."""
        return (
            (self.stroke + self.diameter + 2 * abs(self.offset)) / 1000 / math.cos(math.radians(self.angle))
        )

    def edge(self) -> Edge:
        knife = knife_of(self.law, self.stroke / 1000, self.knife_speed)
        return Edge(knife, math.radians(self.angle), self.forward)

    def cover(self, length: float | None = None, **more: int) -> Coverage:
        over = self.over()
        return coverage(self.edge(), over.diameter, over.offset, over.phase, length=length, **more)

    def needed(self) -> float:
        return float(self.cover().length_needed[0])

    def shares(self, length: float, **more: int) -> np.ndarray:
        found = self.cover(length, **more)
        areas = [found.uncut_right[0], found.uncut_left[0], found.uncut_between[0]]
        return np.array(areas) / (math.pi / 4 * (self.diameter / 1000) ** 2)


ADVANCING = {
    "usual": Case(),
    "back and forth": Case("triangular", phase=75.0),
    "slider-crank": Case("slider-crank", angle=-30.0, offset=-15.0, phase=200.0),
    "dwells": Case("dwells", angle=35.0, phase=150.0),
    "straight": Case(angle=0.0, offset=0.0, phase=300.0),
    "ten strokes": Case("slider-crank", 12.0, 0.9, 25.0, 1.6, 120.0, -10.0, 10.0),
    "long stroke": Case("short rod", 200.0, 0.7, -15.0, 1.7, 80.0, 30.0, 260.0),
}
RETREATING = {
    "steep": Case(angle=70.0, knife_speed=0.8, phase=220.0),
    "steep, right end ahead": Case("slider-crank", angle=-72.0, knife_speed=0.8, offset=-20.0, phase=120.0),
    "quick": Case("triangular", 40.0, 1.8, 55.0, 1.2, 110.0, 0.0, 15.0),
    "quick, dwells": Case("dwells", 40.0, 1.0, 50.0, 1.2, 110.0, 12.0, 85.0),
    "hums": Case("harmonic", 8.0, 1.5, -60.0, 0.8, 70.0, 10.0, 90.0),
    "sways": Case("short rod", 250.0, 2.0, 60.0, 1.5, 60.0, 40.0, 330.0),
}
CASES = ADVANCING | RETREATING


# --- the brute force is sound -------------------------------------------------------------------------------


@pytest.mark.parametrize("name", CASES)
def test_both_ways_of_sweeping_agree_point_by_point(name: str) -> None:
    over = CASES[name].over()
    points = lattice(over, 30)
    lengths = lengths_of_points(over, points)
    for length in np.quantile(lengths, [0.2, 0.6, 0.9]):
        # Where the straightened path is off by less than this, the parallelograms decide as the lengths do.
        clear = np.abs(lengths - length) > 2e-3 * length
        assert clear.mean() > 0.9
        wrong = is_cut(over, points, length) != (lengths <= length)
        assert (wrong & clear).sum() <= 1


@pytest.mark.parametrize("name", ["usual", "dwells", "steep", "sways"])
def test_both_ways_find_the_same_least_length(name: str) -> None:
    over = CASES[name].over()
    points = np.concatenate([lattice(over, 30), rim(over, 60)])
    expected = lengths_of_points(over, points).max()
    assert length_by_bisection(over, points) == pytest.approx(expected, rel=1e-3)


# --- one head -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", CASES)
def test_knife_of_the_machine_is_the_law(name: str) -> None:
    case = CASES[name]
    over, t = case.over(), np.linspace(-0.4, 0.4, 2001)
    # Of a cam: polynomials between quarters of a degree.
    found = knife_of(case.law, case.stroke / 1000, case.knife_speed).at(t, over.phase)
    assert found == pytest.approx(over.across(t), abs=1e-10 * case.stroke / 1000)


@pytest.mark.parametrize("name", CASES)
def test_retreating_edges_are_known(name: str) -> None:
    over = CASES[name].over()
    t = np.linspace(0, 2 * np.pi / over.knife.rate, 20001)
    way = over.knife.speed * t - over.across(t) * math.tan(over.knife.angle)
    assert CASES[name].edge().retreats == (np.diff(way).min() < 0) == (name in RETREATING)


@pytest.mark.parametrize("name", CASES)
def test_length_is_that_of_the_swept_points(name: str) -> None:
    # The brute force halves its cloud of points 24 times: what is left of it counts less than 1e-6.
    case = CASES[name]
    assert case.needed() == pytest.approx(needed_length(case.over()), rel=1e-6)


@pytest.mark.parametrize("name", CASES)
def test_last_point_needs_that_length(name: str) -> None:
    case = CASES[name]
    over, found = case.over(), case.cover()
    last = np.array([found.last_x[0], found.last_y[0] + over.offset])
    assert math.hypot(found.last_x[0], found.last_y[0]) <= over.diameter / 2 * (1 + 1e-9)
    # It may lie where the line turns back, with crossings to one side of it only.
    near = last + 1e-7 * over.diameter * np.array([[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1]])
    assert lengths_of_points(over, near).max() == pytest.approx(found.length_needed[0], rel=1e-5)


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("part", [0.3, 0.8])
def test_uncut_share_is_that_of_the_swept_points(name: str, part: float) -> None:
    case = CASES[name]
    length = part * case.needed()
    found, error = uncut_share(case.over(), length, n=60)
    assert case.shares(length).sum() == pytest.approx(found, abs=error)


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("part", [0.35, 0.7, 0.95])
def test_what_is_left_on_each_side_is_that_of_the_slices(name: str, part: float) -> None:
    case = CASES[name]
    length = part * case.needed()
    expected, error = uncut_by_slices(case.over(), length, slices=6000)
    # The kernel's own word for an edge that retreats: 1e-5 of the head.
    assert case.shares(length) == pytest.approx(expected, abs=3 * error + (1e-7, 1e-5)[case.edge().retreats])


@pytest.mark.parametrize("name", ["usual", "ten strokes", "steep", "sways"])
def test_enough_leaves_nothing_and_a_hair_less_leaves_something(name: str) -> None:
    case = CASES[name]
    length = case.needed()
    assert case.shares(length * (1 + 1e-9)).sum() == pytest.approx(0.0, abs=1e-12)
    assert case.shares(length * 0.999).sum() > 0


@pytest.mark.parametrize(("strokes", "part"), [(3.0, 0.3), (12.0, 0.6), (40.0, 0.3)])
@pytest.mark.parametrize("angle", [0.0, 12.0])
def test_many_strokes_over_a_head(strokes: float, angle: float, part: float) -> None:
    """Knife speed such that the stroke is made so many times while the edge goes on by the diameter."""
    stroke = 100.0 * 0.8 / (strokes * 1.9)
    case = Case("harmonic", stroke, 0.8, angle, 1.9, 100.0, 10.0, 25.0)
    length = part * case.needed()
    expected, error = uncut_by_slices(case.over(), length)
    assert case.shares(length) == pytest.approx(expected, abs=3 * error + 1e-7)


@pytest.mark.parametrize(
    ("law", "beyond"),
    [*(("harmonic", each) for each in (1e-2, 1e-4, 1e-6, -1e-6, -1e-4, -1e-2)), ("triangular", 1e-4)],
)
def test_edge_that_all_but_stands_still_at_times(law: str, beyond: float) -> None:
    """v = (1 − beyond) v_max tan α: the edge hardly advances, or runs back for a moment."""
    fastest = 0.9 * (math.pi / 2 if law == "harmonic" else 1.0)
    forward = fastest * math.tan(math.radians(40.0)) * (1 - beyond)
    case = Case(law, 45.0, 0.9, 40.0, forward, 98.0, 12.0, 190.0)
    assert case.edge().retreats == (beyond > 0)
    assert case.needed() == pytest.approx(needed_length(case.over(), n=40), rel=1e-6)
    length = 0.6 * case.needed()
    expected, error = uncut_by_slices(case.over(), length)
    assert case.shares(length) == pytest.approx(expected, abs=3 * error + 1e-5)


@given(
    st.sampled_from(["harmonic", "triangular"]),
    st.floats(10, 200),
    st.floats(0.1, 1.5),
    st.floats(-75, 75),
    st.floats(0.8, 3.0),
    st.floats(20, 200),
    st.floats(-80, 80),
    st.floats(0, 360),
)
@settings(max_examples=cases(25, 250))
def test_any_knife_over_any_head(
    law: str, stroke: float, speed: float, angle: float, v: float, d: float, offset: float, phase: float
) -> None:
    case = Case(law, stroke, speed, angle, v, d, offset, phase)
    # Points of a lattice need no more, and not much less: their distance is a twentieth of the diameter.
    over, length = case.over(), case.needed()
    points = np.concatenate([lattice(over, 20), rim(over, 120)])
    lengths = lengths_of_points(over, points, 96)
    assert lengths.max() <= length * (1 + 1e-3)
    assert case.shares(float(np.median(lengths))).sum() == pytest.approx(0.5, abs=0.15)


# --- the worst head -----------------------------------------------------------------------------------------


def worst_by_product(case: Case) -> float:
    def needed(edge: Edge, offsets: np.ndarray, phases: np.ndarray) -> np.ndarray:
        return coverage(edge, case.diameter / 1000, offsets, phases).length_needed

    found = worst_head([case.edge()], abs(case.offset) / 1000, None, needed)
    again = needed(found.edge, np.array([found.offset]), np.array([found.phase]))
    assert again == pytest.approx(found.value, rel=1e-9)
    assert abs(found.offset) <= abs(case.offset) / 1000
    return found.value


@pytest.mark.parametrize("name", [name for name in ADVANCING if ADVANCING[name].law != "dwells"])
def test_worst_phase_of_an_advancing_edge_is_the_closed_form(name: str) -> None:
    case = ADVANCING[name]
    assert worst_by_product(case) == pytest.approx(case.all_phases(), rel=1e-9)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_rounding_does_not_choose_between_mirror_images(sign: float) -> None:
    """A head and its mirror image half a revolution later ask the same: the first is taken."""

    def asks(_: Edge, offsets: np.ndarray, phases: np.ndarray) -> np.ndarray:
        there = 1 + np.cos(phases - 0.7) * offsets / 0.02
        # What rounding might add to either image.
        return there * (1 + sign * 1e-15 * np.sign(offsets))

    found = worst_head([ADVANCING["slider-crank"].edge()], 0.02, None, asks)
    assert (found.offset, found.phase) == pytest.approx((0.02, 0.7), abs=1e-4)


@pytest.mark.parametrize("name", ["slider-crank"])
def test_worst_phase_is_that_of_the_swept_points(name: str) -> None:
    case = CASES[name]
    swept, _ = worst(case.swept(), case.diameter / 1000, abs(case.offset) / 1000)
    # Eight times the step of the phase is halved: the top is round.
    assert swept == pytest.approx(case.all_phases(), rel=1e-4)


@pytest.mark.parametrize("name", ["steep"])
def test_worst_phase_of_an_edge_that_retreats(name: str) -> None:
    case = RETREATING[name]
    swept, _ = worst(case.swept(), case.diameter / 1000, abs(case.offset) / 1000)
    found = worst_by_product(case)
    # The scan by brute force may miss the very top; it never goes above it by more than its steps.
    assert found * (1 - 5e-3) <= swept <= found * (1 + 1e-4)
    assert case.diameter / 1000 < found <= case.all_phases() * (1 + 1e-9)


@pytest.mark.parametrize("name", RETREATING)
def test_an_edge_that_retreats_needs_no_more_than_one_that_may_stand_anywhere(name: str) -> None:
    case = RETREATING[name]
    phases, offsets = np.meshgrid(np.linspace(0, 2 * np.pi, 40), np.array([-1, 0, 1]) * case.offset / 1000)
    found = coverage(case.edge(), case.diameter / 1000, offsets.ravel(), phases.ravel(), fine=COARSE)
    assert found.length_needed.max() <= case.all_phases() * (1 + 1e-9)


@pytest.mark.parametrize("angle", [20.0, -35.0, 70.0])
def test_knife_that_does_not_turn_back(angle: float) -> None:
    text = TOPPER + "knife_speed = 0.8\n[topper.motion]\nkind = 'constant'\n"
    machine = lw.loads(text)
    assert machine.topper is not None
    exact = constant_speed_lengths(0.098, 0.02, math.radians(angle), 1.9, 0.8)
    for knife, expected in zip(knives(machine, machine.topper), exact, strict=True):
        edge = Edge(knife, math.radians(angle), 1.9)
        found = coverage(edge, 0.098, [-0.02, 0.02]).length_needed
        assert found == pytest.approx([expected, expected], rel=1e-12)


# --- what holds for all -------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", [name for name in CASES if CASES[name].law in ("harmonic", "triangular")])
def test_mirror_image(name: str) -> None:
    """Left and right swapped: these laws are their own mirror image half a revolution later."""
    case = CASES[name]
    image = replace(case, angle=-case.angle, offset=-case.offset, phase=case.phase + 180.0)
    assert image.needed() == pytest.approx(case.needed(), rel=1e-10)
    length = 0.7 * case.needed()
    right, left, between = case.shares(length)
    assert image.shares(length) == pytest.approx([left, right, between], abs=1e-10)


@pytest.mark.parametrize("name", [name for name in CASES if CASES[name].law != "dwells"])
def test_film_run_backwards(name: str) -> None:
    """The time reversed, and x with it: the same points are crossed by an edge inclined the other way."""
    case = CASES[name]
    phase = -case.phase if "rod" in case.law or "crank" in case.law else 180.0 - case.phase
    back = replace(case, angle=-case.angle, phase=phase)
    assert back.needed() == pytest.approx(case.needed(), rel=1e-10)
    length = 0.7 * case.needed()
    assert back.shares(length) == pytest.approx(case.shares(length), abs=1e-9)


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("k", [0.125, 4.0])
def test_larger_machine_of_the_same_shape(name: str, k: float) -> None:
    case = CASES[name]
    large = replace(
        case,
        stroke=case.stroke * k,
        diameter=case.diameter * k,
        offset=case.offset * k,
        knife_speed=case.knife_speed * k,
        forward=case.forward * k,
    )
    assert large.needed() == pytest.approx(k * case.needed(), rel=1e-10)
    length = 0.7 * case.needed()
    assert large.shares(k * length) == pytest.approx(case.shares(length), abs=1e-9)


@pytest.mark.parametrize("name", ["usual", "back and forth", "steep", "quick, dwells"])
def test_only_the_ratio_of_speeds_counts(name: str) -> None:
    case = CASES[name]
    quick = replace(case, knife_speed=case.knife_speed * 3, forward=case.forward * 3)
    assert quick.needed() == pytest.approx(case.needed(), rel=1e-10)
    assert quick.shares(0.1) == pytest.approx(case.shares(0.1), abs=1e-9)


@pytest.mark.parametrize("name", CASES)
def test_longer_edges_leave_less(name: str) -> None:
    case = CASES[name]
    shares = [case.shares(part * case.needed()).sum() for part in (0.01, 0.2, 0.5, 0.8, 0.99, 1.2)]
    assert (np.diff(shares) <= 1e-9).all()
    assert 0.9 < shares[0] <= 1 + 1e-12
    assert shares[-1] == 0.0


@pytest.mark.parametrize("name", ["usual", "back and forth", "slider-crank", "steep", "quick, dwells"])
def test_heads_together_are_the_heads_one_by_one(name: str) -> None:
    """37 heads fill lanes and leave some empty; the number of stations is that of the largest."""
    case, rng = CASES[name], np.random.default_rng(6)
    d, offset = rng.uniform(0.03, 0.12, 37), rng.uniform(-0.05, 0.05, 37)
    phase = rng.uniform(-10, 10, 37)
    together = coverage(case.edge(), d, offset, phase, length=0.1)
    for k in (0, 5, 17, 36):
        alone = coverage(case.edge(), d[k], offset[k], phase[k], length=0.1)
        assert together.length_needed[k] == pytest.approx(alone.length_needed[0], rel=1e-9)
        assert together.uncut[k] == pytest.approx(alone.uncut[0], abs=1e-9 * d[k] ** 2)
    whole = coverage(case.edge(), d, offset, phase + 2 * np.pi, length=0.1)
    assert whole.length_needed == pytest.approx(together.length_needed, rel=1e-9)


@pytest.mark.parametrize("name", CASES)
def test_coarse_stations_do(name: str) -> None:
    """To 1e-6 of the head, as they are said to do."""
    case = CASES[name]
    rng = np.random.default_rng(7)
    phase, offset = rng.uniform(0, 2 * np.pi, 12), rng.uniform(-0.03, 0.03, 12)
    fine, coarse = (
        coverage(case.edge(), case.diameter / 1000, offset, phase, length=0.12, fine=each)
        for each in (128, COARSE)
    )
    assert coarse.length_needed == pytest.approx(fine.length_needed, abs=1e-6 * case.diameter / 1000)
    area = math.pi / 4 * (case.diameter / 1000) ** 2
    assert coarse.uncut / area == pytest.approx(fine.uncut / area, abs=2e-6)


def left_by_trapezia(case: Case, length: float, phase: float) -> float:
    """Share of a head that is left, by trapezia over u, t = m + w sin u, from corner to corner of the law."""
    edge, radius, offset = case.edge(), case.diameter / 2000, case.offset / 1000

    def place(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return edge.place(t, np.full(t.shape, phase), np.full(t.shape, offset))

    reach = 4 * radius / edge.mean_advance + 0.1 / case.forward

    def comes_to(level: float) -> float:
        return zero(lambda t: float(place(np.array([t]))[1][0]) - level, -reach, reach)

    start, end = comes_to(-radius), comes_to(radius)
    middle, width = 0.5 * (start + end), 0.5 * (end - start)
    turns = 2 * np.pi * np.arange(-3, 4)
    corners = ((np.array(edge.knife.corners)[:, None] + turns - phase) / edge.knife.rate - middle) / width
    kinks = np.arcsin(np.concatenate([[-1.0], np.sort(corners[np.abs(corners) < 1]), [1.0]]))
    area = 0.0
    for start, end in pairwise(kinks.tolist()):
        u = np.linspace(start, end, 100_001)
        # Speeds are those of this side of a corner.
        t = middle + width * np.clip(np.sin(u), np.sin(start) + 1e-13, np.sin(end) - 1e-13)
        q, p = place(t)
        chord = np.sqrt(np.clip(radius**2 - p**2, 0.0, None))
        beyond = sum(np.clip(side * q + chord - 0.5 * length, 0.0, 2 * chord) for side in (1, -1))
        rate = edge.velocity(t, np.full(t.shape, phase))[1]
        area += float(np.trapezoid(beyond * rate * width * np.cos(u), u))
    return area / (math.pi * radius**2)


@pytest.mark.parametrize("law", ["triangular", "dwells", "slider-crank"])
def test_areas_are_exact_where_a_corner_of_the_law_is_close_to_the_rim(law: str) -> None:
    """The edge has hardly come over the head when its law changes: up to 2e-8 of it were missed."""
    case = Case(law)
    phases = np.linspace(0.0, 2 * np.pi, cases(80, 4_000), endpoint=False)
    length = 0.6 * case.needed()
    over = case.over()
    found = coverage(case.edge(), over.diameter, over.offset, phases, length=length)
    shares = found.uncut / (math.pi / 4 * over.diameter**2)
    expected = [left_by_trapezia(case, length, phase) for phase in phases]
    # Trapezia are good to h², where an end of the edge crosses the rim.
    assert shares == pytest.approx(expected, abs=3e-10)


# --- limits -------------------------------------------------------------------------------------------------


def test_head_without_a_disc_needs_nothing() -> None:
    found = coverage(CASES["usual"].edge(), [0.0, 0.1, 0.0], 0.01, length=0.05)
    assert found.length_needed[[0, 2]].tolist() == [0.0, 0.0]
    assert found.uncut[[0, 2]].tolist() == [0.0, 0.0]
    assert found.length_needed[1] > 0.1


def test_small_head_needs_what_its_centre_does() -> None:
    case = replace(CASES["usual"], diameter=1e-6)
    centre = float(lengths_of_points(case.over(), np.array([[0.0, case.offset / 1000]]))[0])
    assert case.needed() == pytest.approx(centre, abs=5e-6)


@pytest.mark.parametrize(
    ("diameter", "offset", "phase"), [(-0.1, 0, 0), (math.nan, 0, 0), (0.1, math.inf, 0)]
)
def test_heads_that_are_none(diameter: float, offset: float, phase: float) -> None:
    with pytest.raises(InputError, match="negative diameter or a number that is not finite"):
        coverage(CASES["usual"].edge(), diameter, offset, phase)
