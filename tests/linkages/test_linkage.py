"""Linkages over their cycle: closed forms of transmission angle, stroke, time ratio; Grashof; closure."""

from __future__ import annotations

import dataclasses
import itertools
import time
from pathlib import Path

import numpy as np
import pytest
from sizes import generator

import linkwright as lw
from linkwright import AssemblyError, InputError, MachineError, ShapeError, closure, kinematics
from linkwright.kernel.numerics.zeros import minima, zeros
from linkwright.linkages.circuits import Branch, _slots
from linkwright.linkages.closure import limiter_at
from linkwright.linkages.cycle import LIMIT, PASSED, REVERSAL
from linkwright.linkages.grashof import FourBar, four_bars
from linkwright.linkages.tables import loop_tables
from linkwright.machine import compile_machine

# Zeros are located to some units of rounding of the crank angle; what is computed from them keeps nine digits
# and more.
EXACT = 1e-12


def four_bar(crank: float, coupler: float, rocker: float, ground: float, more: str = "") -> lw.Machine:
    return lw.loads(f"""
        format = 1
        name = "four-bar"
        [mechanism.points]
        D = {{ x = {ground!r}, y = 0 }}
        [mechanism.cranks.A]
        radius = {crank!r}
        [mechanism.rockers.R]
        crank = "A"
        pivot = "D"
        coupler = {coupler!r}
        rocker = {rocker!r}
        {more}
        """)


def bars(crank: float, coupler: float, rocker: float, ground: float) -> lw.Machine:
    """The same from a joint and two bars, the second drawn towards the joint's start."""
    return lw.loads(f"""
        format = 1
        name = "four-bar of joints and bars"
        [mechanism.points]
        D = {{ x = {ground!r}, y = 0 }}
        [mechanism.cranks.A]
        radius = {crank!r}
        [mechanism.joints.C]
        x = {ground!r}
        y = {rocker!r}
        [mechanism.bars.a]
        start = "A"
        end = "C"
        length = {coupler!r}
        [mechanism.bars.b]
        start = "C"
        end = "D"
        length = {rocker!r}
        """)


def slider_crank(crank: float, rod: float, offset: float) -> lw.Machine:
    return lw.loads(f"""
        format = 1
        name = "slider-crank"
        [mechanism.cranks.A]
        radius = {crank}
        [mechanism.sliders.S]
        crank = "A"
        rod = {rod}
        offset = {offset}
        """)


def angle_in_triangle(a: float, b: float, opposite: float) -> float:
    return float(np.arccos((a * a + b * b - opposite * opposite) / (2 * a * b)))


# -- transmission angles and travel --------------------------------------------------------------------------


@pytest.mark.parametrize("make", [four_bar, bars])
def test_crank_rocker_in_closed_form(make) -> None:
    r, a, b, d = 0.1, 0.35, 0.3, 0.4
    found = lw.linkage(make(r, a, b, d)).elements[0]
    # The crank in line with the ground (Norton, section on transmission angle).
    assert found.transmission_angle_min == pytest.approx(angle_in_triangle(a, b, d - r), abs=EXACT)
    assert found.transmission_angle_max == pytest.approx(angle_in_triangle(a, b, d + r), abs=EXACT)
    assert np.sin(found.transmission_angle_min_angle) == pytest.approx(0, abs=EXACT)
    assert np.cos(found.transmission_angle_max_angle) == pytest.approx(-1, abs=EXACT)
    # Crank and coupler in line, stretched and folded: cosine theorem.
    swing = angle_in_triangle(b, d, a + r) - angle_in_triangle(b, d, a - r)
    assert found.swing == pytest.approx(swing, abs=EXACT)
    stretched, folded = angle_in_triangle(d, a + r, b), np.pi + angle_in_triangle(d, a - r, b)
    assert sorted((found.low_angle, found.high_angle)) == pytest.approx([stretched, folded], abs=1e-11)
    slow = max(folded - stretched, 2 * np.pi - (folded - stretched))
    assert found.time_ratio == pytest.approx(slow / (2 * np.pi - slow), rel=1e-11)
    assert found.grashof == "crank-rocker"
    assert found.output == ("R.rocker" if make is four_bar else "b")


def test_slider_crank_with_offset_in_closed_form() -> None:
    r, rod, e = 0.2, 0.7, 0.15
    found = lw.linkage(slider_crank(r, rod, e)).element("S")
    stroke = np.sqrt((rod + r) ** 2 - e**2) - np.sqrt((rod - r) ** 2 - e**2)
    assert found.stroke == pytest.approx(stroke, abs=EXACT)
    # cos μ is the pin's distance from the guide over the rod.
    assert found.transmission_angle_worst == pytest.approx(np.arccos((r + e) / rod), abs=EXACT)
    way = np.pi + np.arcsin(e / (rod - r)) - np.arcsin(e / (rod + r))
    assert found.time_ratio == pytest.approx(max(way, 2 * np.pi - way) / min(way, 2 * np.pi - way), rel=1e-11)


def test_crank_shaper_time_ratio() -> None:
    """A slotted lever about a point below the crank: at its ends the crank is at right angles to it."""
    r, h = 0.1, 0.3
    machine = lw.loads(f"""
        format = 1
        name = "crank shaper"
        [mechanism.points]
        P = {{ x = 0, y = -{h} }}
        [mechanism.cranks.A]
        radius = {r}
        [mechanism.slotted_levers.L]
        pin = "A"
        pivot = "P"
        """)
    found = lw.linkage(machine)
    lever = found.element("L")
    half = np.arcsin(r / h)
    assert lever.swing == pytest.approx(2 * half, abs=EXACT)
    assert lever.time_ratio == pytest.approx((np.pi + 2 * half) / (np.pi - 2 * half), rel=1e-11)
    # A slot through its pivot always pushes at right angles.
    assert lever.transmission_angle_min == lever.transmission_angle_max == pytest.approx(np.pi / 2)
    # The extremes of the ratio of rates: r/(h + r) forward and r/(h − r) back.
    assert lever.velocity_ratio_max == pytest.approx(r / (h + r), rel=1e-11)
    assert lever.velocity_ratio_min == pytest.approx(-r / (h - r), rel=1e-11)
    assert lever.mechanical_advantage_min == pytest.approx((h - r) / r, rel=1e-11)
    assert [each.output for each in found.elements] == ["L", "L"]
    assert found.elements[1].stroke == pytest.approx(2 * r, abs=EXACT)


def test_whitworth_lever_turns() -> None:
    """The pivot inside the crank's circle: the lever turns with the crank."""
    machine = lw.loads("""
        format = 1
        name = "Whitworth"
        [mechanism.points]
        P = { x = 0, y = -0.05 }
        [mechanism.cranks.A]
        radius = 0.1
        [mechanism.slotted_levers.L]
        pin = "A"
        pivot = "P"
        """)
    lever = lw.linkage(machine).element("L")
    assert lever.turns == pytest.approx(1)
    assert lever.swing is None
    assert lever.velocity_ratio_max == pytest.approx(0.1 / 0.05, rel=1e-11)
    assert lever.velocity_ratio_min == pytest.approx(0.1 / 0.15, rel=1e-11)


def test_extremes_are_those_of_a_fine_grid() -> None:
    """Nothing on a grid of 200 000 angles lies beyond the located extremes."""
    machine = four_bar(0.12, 0.31, 0.33, 0.36)
    found = lw.linkage(machine).element("R")
    motion = kinematics(machine, np.linspace(0, 2 * np.pi, 200_001))
    rocker = motion.links["R.rocker"]
    assert found.velocity_ratio_max >= rocker.d1.max() - EXACT
    assert found.velocity_ratio_min <= rocker.d1.min() + EXACT
    assert found.velocity_ratio_max == pytest.approx(rocker.d1.max(), rel=1e-9)
    mu = np.abs(
        (motion.links["R.rocker"].angle - motion.links["R.coupler"].angle + np.pi) % (2 * np.pi) - np.pi
    )
    assert found.transmission_angle_min == pytest.approx(mu.min(), abs=1e-9)
    assert found.transmission_angle_max == pytest.approx(mu.max(), abs=1e-9)


def test_power_of_an_ideal_linkage() -> None:
    """Mechanical advantage times velocity ratio is one: the power that goes in comes out.

    The reduced torque of a constant force on the slider is the core's own principle of virtual work.
    """
    force = 100.0
    plain = slider_crank(0.1, 0.4, 0.0)
    found = lw.linkage(plain)
    torque = compile_machine(lw.loads(_with_force(force))).reductions(found.crank_angle).load
    np.testing.assert_allclose(torque, -force * found.velocity_ratios["S"], atol=1e-12)
    greatest = np.abs(torque / force).max()
    assert found.element("S").mechanical_advantage_min == pytest.approx(1 / greatest, rel=1e-4)


def _with_force(force: float) -> str:
    return f"""
        format = 1
        name = "loaded"
        [mechanism.cranks.A]
        radius = 0.1
        [mechanism.sliders.S]
        crank = "A"
        rod = 0.4
        [loads]
        F = {{ kind = "force", on = "S", force = {force} }}
        """


# -- Grashof -------------------------------------------------------------------------------------------------


def test_grashof_against_full_assembly() -> None:
    """Of random four-bars, the crank rotates fully exactly in those whose class says so."""
    random = np.random.default_rng(7)
    turning = ("crank-rocker", "double-crank (drag link)")
    seen = set()
    for lengths in random.uniform(0.1, 1.0, (300, 4)):
        machine = four_bar(*(float(x) for x in lengths))
        (loop,) = four_bars(compile_machine(machine))
        assert closure(machine).turns_fully == (loop.grashof in turning), (lengths, loop.grashof)
        seen.add(loop.grashof)
    assert seen == {*turning, "rocker-crank", "double-rocker", "triple-rocker"}


@pytest.mark.parametrize(
    ("lengths", "words"),
    [
        ((1, 2, 1, 2), "change-point: parallelogram or antiparallelogram"),
        ((1, 1, 1, 1), "change-point: parallelogram or antiparallelogram"),
        ((1, 1, 2, 2), "change-point: kite"),
        ((1, 2, 2, 1), "change-point: kite"),
        ((1, 3, 2.5, 1.5), "change-point: links in line once per revolution"),
        ((2, 3, 1, 3.5), "rocker-crank"),
        ((3, 1, 2, 3.5), "double-rocker"),
    ],
)
def test_grashof_in_words(lengths: tuple[float, ...], words: str) -> None:
    assert FourBar("R", *lengths).grashof == words


def test_four_bar_behind_a_rocker() -> None:
    """A second loop driven by a point of the first rocker, its pivot on the frame."""
    machine = lw.loads("""
        format = 1
        name = "Watt II"
        [mechanism.points]
        D = { x = 0.4, y = 0 }
        F = { x = 0.9, y = 0 }
        [mechanism.cranks.A]
        radius = 0.1
        [mechanism.rockers.R]
        crank = "A"
        pivot = "D"
        coupler = 0.35
        rocker = 0.3
        [mechanism.rigid_points.E]
        link = "R.rocker"
        along = 0.12
        across = 0.05
        [mechanism.rockers.G]
        crank = "E"
        pivot = "F"
        coupler = 0.5
        rocker = 0.2
        """)
    first, second = four_bars(compile_machine(machine))
    assert (first.driver, first.ground) == pytest.approx((0.1, 0.4), abs=1e-14)
    assert second.driver == pytest.approx(0.13, abs=1e-14)
    assert (second.coupler, second.follower, second.ground) == (0.5, 0.2, pytest.approx(0.5))


# -- change points -------------------------------------------------------------------------------------------


def test_parallelogram_through_its_change_points() -> None:
    machine = four_bar(0.1, 0.4, 0.1, 0.4)
    near = np.array([-1e-3, -1e-6, 0.0, 1e-6, 1e-3])
    angles = np.concatenate([np.linspace(0, 2 * np.pi, 721), near + np.pi, near + 2 * np.pi])
    motion = kinematics(machine, angles)
    np.testing.assert_allclose(motion.links["R.rocker"].d1, 1.0, atol=1e-11)
    joint, pin = motion.points["R"].position, motion.points["A"].position
    assert np.abs(np.hypot(*(joint - pin).T) - 0.4).max() <= 1e-12
    assert np.abs(np.hypot(*(joint - [0.4, 0.0]).T) - 0.1).max() <= 1e-12
    found = lw.linkage(machine)
    assert found.element("R").grashof == "change-point: parallelogram"
    assert [(each.kind, each.multiplicity) for each in found.dead_points] == [(PASSED, 2)] * 2
    assert [each.angle for each in found.dead_points] == pytest.approx([0, np.pi], abs=1e-12)
    assert found.element("R").transmission_angle_min == pytest.approx(0, abs=1e-9)


# -- closure -------------------------------------------------------------------------------------------------


def test_limits_in_closed_form() -> None:
    """The crank of a triple-rocker stops where coupler and rocker are stretched or folded."""
    r, a, b, d = 0.3, 0.2, 0.25, 0.4
    found = lw.linkage(four_bar(r, a, b, d))
    limit = angle_in_triangle(r, d, a + b)
    ((low, high),) = found.closure.ranges
    assert (low - 2 * np.pi, high - 2 * np.pi) == pytest.approx((-limit, limit), abs=1e-11)
    kinds = {each.kind for each in found.dead_points}
    assert kinds == {LIMIT, REVERSAL}
    assert [each.element for each in found.dead_points if each.kind == LIMIT] == ["R", "R"]
    assert found.element("R").transmission_angle_max == pytest.approx(np.pi, abs=1e-7)
    assert found.element("R").velocity_ratio_max is None


@pytest.mark.parametrize("short", [1e-3, 1e-5, 1e-7, 1e-8])
def test_narrow_gaps_are_seen(short: float) -> None:
    """Coupler and rocker too short by a little leave a gap that no grid of quarter degrees meets."""
    r, a, b, d = 0.1, 0.2, 0.2, 0.3
    # The phase puts the gap between two angles of any grid of simple shares of the revolution.
    phase = 0.00123
    machine = lw.replace(four_bar(r, a, b, d + short), {"mechanism.cranks.A.phase": phase})
    ((low, high),) = closure(machine).ranges
    half = np.pi - angle_in_triangle(r, d + short, a + b)
    assert (low, high) == pytest.approx((np.pi + half - phase, 3 * np.pi - half - phase), abs=1e-7)


def test_narrow_openings_are_seen() -> None:
    """A linkage that closes only within some hundredths of a degree."""
    r, a, b, d = 0.1, 0.1, 0.1, 0.3 - 1e-9
    phase = 0.00123
    machine = lw.replace(four_bar(r, a, b, d), {"mechanism.cranks.A.phase": phase})
    ((low, high),) = closure(machine).ranges
    reach = angle_in_triangle(r, d, a + b)
    assert high - low == pytest.approx(2 * reach, abs=1e-8)
    assert np.sin(0.5 * (low + high) + phase) == pytest.approx(0, abs=1e-8)
    assert np.degrees(2 * reach) < 0.05


def test_nothing_closes() -> None:
    with pytest.raises(AssemblyError, match="R"):
        lw.linkage(four_bar(0.1, 0.1, 0.1, 0.5))


# -- circuits ------------------------------------------------------------------------------------------------


def test_circuits_of_four_bars() -> None:
    """A crank-rocker has a circuit for each assembly; a triple-rocker one, its branches meet at limits."""
    apart = lw.circuits(four_bar(0.1, 0.35, 0.3, 0.4))
    assert [circuit.turns_fully for circuit in apart] == [True, True]
    assert [circuit.branches[0].assembly for circuit in apart] == [{"R": "given"}, {"R": "other"}]
    (joined,) = lw.circuits(four_bar(0.3, 0.2, 0.25, 0.4))
    assert not joined.turns_fully
    assert [branch.assembly["R"] for branch in joined.branches] == ["given", "other"]
    # Two ranges, mirrored: the crank reaches neither side from the other.
    assert len(lw.circuits(four_bar(0.4, 0.1, 0.2, 0.45))) == 2


def test_circuits_need_dyads_that_are_free() -> None:
    with pytest.raises(InputError, match="change point of R at 0°, 180°"):
        lw.circuits(four_bar(0.1, 0.4, 0.1, 0.4))


# -- coupler curves ------------------------------------------------------------------------------------------


def test_path_of_a_crank_is_a_circle() -> None:
    curve = lw.coupler_curve(four_bar(0.1, 0.35, 0.3, 0.4), "A")
    assert curve.length == pytest.approx(2 * np.pi * 0.1, rel=1e-13)
    assert (curve.x_min, curve.x_max, curve.y_min, curve.y_max) == pytest.approx(
        (-0.1, 0.1, -0.1, 0.1), abs=1e-14
    )
    np.testing.assert_allclose(curve.curvature, 10.0, rtol=1e-12)
    # A chord of a circle of radius r is straight to a thousandth of itself while r (1 − cos α) ≤ 2 r sin
    # α/1000.
    alpha = 2 * np.arctan(2e-3)
    assert curve.straight_length == pytest.approx(0.2 * np.sin(alpha), rel=1e-2)
    assert not curve.double_points
    assert not curve.cusps


def test_straightest_portion_against_all_portions() -> None:
    """Hoeken's linkage: no portion between multiples of 3° has a longer straight chord than the one found."""
    more = '[mechanism.rigid_points.K]\nlink = "R.coupler"\nalong = 0.5\nacross = 0.0'
    hoeken = four_bar(0.1, 0.25, 0.25, 0.2, more)
    curve = lw.coupler_curve(hoeken, "K")
    assert curve.straight_error <= 1e-3 * curve.straight_length
    assert curve.is_closed
    place = kinematics(hoeken, np.radians(np.arange(0, 720, 3.0))).points["K"].position
    longest = 0.0
    for start, count in itertools.product(range(120), range(2, 120)):
        part = place[start : start + count + 1] - place[start]
        chord = np.hypot(*part[-1])
        across = np.abs(part @ [-part[-1, 1], part[-1, 0]]) / chord
        longest = max(longest, chord) if across.max() <= 1e-3 * chord else longest
    assert longest > 0.1
    assert curve.straight_length >= 0.999 * longest


def test_double_point_and_its_two_angles() -> None:
    """A coupler curve that crosses itself: at both crank angles the point is at the same place."""
    more = '[mechanism.rigid_points.K]\nlink = "R.coupler"\nalong = 0.5\nacross = -0.15'
    machine = four_bar(0.1, 0.25, 0.25, 0.2, more)
    curve = lw.coupler_curve(machine, "K")
    found = [each for k in np.linspace(0.05, 0.5, 10) for each in _double_points(float(k))]
    assert found, "none of the curves crosses itself"
    assert curve.length > 0


def _double_points(along: float) -> list[object]:
    more = f'[mechanism.rigid_points.K]\nlink = "R.coupler"\nalong = {along}\nacross = -0.2'
    machine = four_bar(0.1, 0.25, 0.25, 0.2, more)
    curve = lw.coupler_curve(machine, "K")
    for point in curve.double_points:
        places = kinematics(machine, [point.first_angle, point.second_angle]).points["K"].position
        np.testing.assert_allclose(places, [[point.x, point.y]] * 2, atol=1e-12)
        assert point.second_angle - point.first_angle > 1e-3
    return list(curve.double_points)


def test_cusps_of_a_point_that_goes_to_and_fro() -> None:
    """The joint of a crank-rocker stands still at both ends of its arc."""
    machine = four_bar(0.1, 0.35, 0.3, 0.4)
    curve, rocker = lw.coupler_curve(machine, "R"), lw.linkage(machine).element("R")
    assert sorted(cusp.angle for cusp in curve.cusps) == pytest.approx(
        sorted((rocker.low_angle, rocker.high_angle)), abs=1e-7
    )
    assert curve.length == pytest.approx(2 * 0.3 * rocker.swing, rel=1e-7)


def test_coupler_curve_of_nothing() -> None:
    machine = four_bar(0.1, 0.35, 0.3, 0.4)
    with pytest.raises(MachineError, match="one of O, D, A, R"):
        lw.coupler_curve(machine, "K")
    with pytest.raises(ShapeError, match="between 0 and 1"):
        lw.coupler_curve(machine, "R", straight=2.0)


# -- results and roots ---------------------------------------------------------------------------------------


def test_to_dict_and_curves() -> None:
    found = lw.linkage(four_bar(0.1, 0.35, 0.3, 0.4))
    entries = found.to_dict()["elements"]["R"]
    assert entries["grashof"] == "crank-rocker"
    assert entries["grashof_sum_extremes"] == pytest.approx(0.5)
    assert entries["grashof_sum_others"] == pytest.approx(0.65)
    assert {"swing", "time_ratio", "transmission_angle_min", "transmission_angle_max"} <= entries.keys()
    assert set(found.curves()) == {"crank_angle", "R.transmission_angle", "R.rocker.velocity_ratio"}
    with pytest.raises(InputError, match=r"^name: found 'Q', expected an element, a link or a slide"):
        found.element("Q")
    assert found.unit_of("R.nothing") == ""


def test_zeros_of_hard_functions() -> None:
    """Flat, steep and jumping functions keep their bracket and end within rounding."""
    powers = np.array([1.0, 3.0, 7.0, 15.0])
    at = np.array([0.3, 0.1, 0.7, 0.45])
    near, far = zeros(lambda x: np.sign(x - at) * np.abs(x - at) ** powers, np.zeros(4), np.ones(4))
    # A zero of order p is blurred to the p-th root of the smallest number there is; none is that large here.
    np.testing.assert_allclose(near, at, atol=1e-13)
    near, far = zeros(lambda x: np.where(x < 1 / 3, -1.0, 2.0), np.zeros(1), np.ones(1))
    assert abs(near[0] - far[0]) < 1e-15
    assert min(near[0], far[0]) < 1 / 3 <= max(near[0], far[0])


def test_minima() -> None:
    centre = np.array([0.2, 0.5])
    at, least = minima(lambda x: (x - centre) ** 2 - 1, centre - 0.011, centre + 0.017)
    np.testing.assert_allclose(at, centre, atol=1e-8)
    np.testing.assert_allclose(least, -1.0, atol=1e-15)


def test_velocity_ratio_by_the_instant_centre() -> None:
    """Velocity ratio against the instant centre: ω_rocker/ω_crank by the lever rule on the ground line."""
    r, a, b, d = 0.1, 0.35, 0.3, 0.4
    machine = four_bar(r, a, b, d)
    motion = kinematics(machine, [0.7, 2.0, 4.0])
    for k in range(3):
        pin, joint = motion.points["A"].position[k], motion.points["R"].position[k]
        share = pin[1] / (pin[1] - joint[1])
        x = pin[0] + share * (joint[0] - pin[0])
        # The coupler's line meets the ground at the common instant centre of crank and rocker (Kennedy).
        assert motion.links["R.rocker"].d1[k] == pytest.approx(x / (x - d), rel=1e-11)


def test_angles_lie_in_the_range_in_which_the_mechanism_moves() -> None:
    """A lift on a screw, whose crank goes from some revolutions back to many revolutions forward."""
    found = lw.linkage(lw.read(Path(__file__).parents[2] / "examples" / "scissor_lift" / "machine.toml"))
    low, high = found.closure.ranges[0]
    assert low < 0 < high
    at = [angle for each in found.elements for angle in (each.low_angle, each.high_angle)]
    at += [each.angle for each in found.dead_points]
    assert at
    assert all(low <= angle <= high for angle in at)


def test_a_mechanism_that_closes_at_single_angles_does_not_move() -> None:
    """A rocker of next to nothing, that a crank which turns many times passes at one angle a revolution."""
    gears = Path(__file__).parents[2] / "examples" / "gears_and_guides" / "machine.toml"
    with pytest.raises(AssemblyError, match="closes only"):
        lw.linkage(lw.read(gears, ["mechanism.rockers.C.rocker=1e-9"]))


def test_dead_points_of_link_and_slide_of_one_name_are_told_apart() -> None:
    found = lw.linkage(lw.read("examples/quick_returns/machine.toml"))
    rows = next(table for table in loop_tables(found) if table.name == "dead_points").rows
    names = [row[0].partition(":")[0] for row in rows]
    assert names.count("shaper, position") == 2
    assert "shaper, angle" in names
    assert "shaper" not in names
    assert {point.turns_back for point in found.dead_points if point.element == "shaper"} == {
        "angle",
        "position",
    }


def test_a_slotted_lever_has_numbers_of_the_lever_and_of_its_slot() -> None:
    """Link and slide have the lever's name: a table by names holds both."""
    machine = lw.read(Path(__file__).parents[2] / "examples" / "quick_returns" / "machine.toml")
    found = lw.linkage(machine)
    elements = found.to_dict()["elements"]
    assert len(elements) == len(found.elements)
    assert elements["shaper"]["swing"] == found.element("shaper").swing
    assert elements["shaper.slot"]["stroke"] == found.element("shaper.slot").stroke
    # The crank of the lever turns 2 arcsin(r/d) less on the way back: the swing of the lever.
    swing = elements["shaper"]["swing"]
    assert elements["shaper"]["time_ratio"] == pytest.approx((np.pi + swing) / (np.pi - swing), rel=1e-12)
    curves = found.curves()
    assert {"shaper.velocity_ratio", "shaper.slot.stroke_ratio"} <= {*curves}
    assert np.ptp(curves["shaper.velocity_ratio"]) > 0


@pytest.mark.parametrize("seed", range(6))
def test_circuits_are_branches_that_meet_at_limits(seed: int) -> None:
    """Against all pairs of branches: the same limit, the same dyad, and no other dyad differs."""
    rng = generator(seed)
    sizes = rng.uniform(0.15, 0.5, 6).tolist()
    machine = lw.loads(
        'format = 1\nname = "six-bar"\nmechanism.cranks.A.radius = 0.3\n'
        "mechanism.points = { D = { x = 0.4 }, E = { x = 0.2, y = 0.4 } }\n"
        f'mechanism.rockers.R = {{ crank = "A", pivot = "D", coupler = {sizes[0]}, rocker = {sizes[1]} }}\n'
        f'mechanism.rockers.S = {{ crank = "R", pivot = "E", coupler = {sizes[2]}, rocker = {sizes[3]} }}\n'
    )
    found = lw.circuits(machine)
    branches = [branch for circuit in found for branch in circuit.branches]

    compiled = compile_machine(machine).first()
    slots = _slots(compiled, machine)

    def limits(branch: Branch) -> list[tuple[float, str]]:
        q = compiled.parameters.copy()
        for name, side in branch.assembly.items():
            q[slots[name]] *= 1 if side == "given" else -1
        other = dataclasses.replace(compiled, parameters=q)
        return [(end, limiter_at(other, end)) for end in (branch.low, branch.high) if not branch.turns_fully]

    def meet(first: Branch, second: Branch) -> bool:
        differ = [name for name in first.assembly if first.assembly[name] != second.assembly[name]]
        return any(
            [dyad] == [limiting] == differ and abs((a - b + np.pi) % (2 * np.pi) - np.pi) < 1e-6
            for a, dyad in limits(first)
            for b, limiting in limits(second)
        )

    of = {id(branch): n for n, circuit in enumerate(found) for branch in circuit.branches}
    for circuit in found:
        reached = [circuit.branches[0]]
        for branch in reached:
            reached += [other for other in branches if meet(branch, other) and other not in reached]
        assert {of[id(branch)] for branch in reached} == {of[id(circuit.branches[0])]}
        assert len(reached) == len(circuit.branches)
    assert all(circuit.complete for circuit in found)


def test_circuits_end_in_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """An assembly in which corners coincide has hundreds of ranges; a search that is cut says so."""
    machine = lw.read("peaucellier_straight_line")
    began = time.perf_counter()
    found = lw.circuits(machine)
    # Comparing all pairs of branches took half a minute.
    assert time.perf_counter() - began < 8
    assert len(found) == 6
    assert max(len(circuit.branches) for circuit in found) > 500
    monkeypatch.setattr("linkwright.linkages.circuits._BRANCHES_MAX", 10)
    cut = lw.circuits(machine)
    assert not cut[0].complete
    assert sum(len(circuit.branches) for circuit in cut) > 10
