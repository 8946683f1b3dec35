"""The rotator: the engine against the closed forms of paper 4, change points, swing, forces, days."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from sizes import generator

import linkwright as lw
from linkwright import AssemblyError, InputError, rod_rotator
from linkwright.papers.paper4.formulas import LeverFormula, Unit
from linkwright.pumping.model.rod_rotator import diagonal_extremes
from linkwright.pumping.model.rotator_lengths import lengths
from linkwright.pumping.rod_rotator import RodRotatorMotion

CONTINUOUS = lw.read("machines/rod_rotator_continuous.toml")
INTERMITTENT = lw.read("machines/rod_rotator_intermittent.toml")


@pytest.fixture(scope="module")
def turning() -> RodRotatorMotion:
    return rod_rotator(CONTINUOUS, n=1440)


@pytest.fixture(scope="module")
def rocking() -> RodRotatorMotion:
    return rod_rotator(INTERMITTENT, n=1440)


def formula(machine: lw.Machine) -> LeverFormula:
    """The same rotator in the letters of the paper; its φ_1 is the crank angle and 90°."""
    unit, rotator = machine.pumping_unit, machine.rod_rotator
    x, y = (-float(each) for each in unit.saddle)
    letters = Unit(unit.R, unit.P, unit.C, unit.A, x, y, unit.cable, rotator.pin_distance)
    return LeverFormula(letters, *map(float, lengths(unit, rotator)))


def away_from(angles: np.ndarray, points: tuple[float, ...], reach: float) -> np.ndarray:
    off = np.abs((angles[:, None] - np.array(points) + np.pi) % (2 * np.pi) - np.pi)
    return off.min(axis=1) > reach


def test_lever_turns_once_and_never_back(turning: RodRotatorMotion) -> None:
    assert turning.lever_turns_per_cycle == 1
    assert 0 < turning.transfer_min < turning.transfer_max
    assert turning.transfer_min <= turning.lever_transfer.min()
    assert np.diff(turning.lever_angle).min() > 0
    assert turning.lever_angle[-1] - turning.lever_angle[0] == pytest.approx(2 * np.pi, abs=1e-9)
    assert turning.extremes_coincide
    assert len(turning.change_points) == 2
    assert "rotates fully" in turning.verdict


def test_turning_by_the_closed_form(turning: RodRotatorMotion) -> None:
    """(19) to (28), the side changing at the ends of the stroke.

    By rounding of the arc cosine near ±1 the closed form errs by 1e-15 over the distance from a change point.
    """
    angle, rate = formula(CONTINUOUS).turning(turning.crank_angle + np.pi / 2)
    far = away_from(turning.crank_angle, turning.change_points, 0.002)
    offset = np.round((turning.lever_angle[0] - angle[0]) / (2 * np.pi)) * 2 * np.pi
    np.testing.assert_allclose(turning.lever_angle[far], angle[far] + offset, rtol=0, atol=1e-11)
    np.testing.assert_allclose(turning.lever_transfer[far], rate[far], rtol=0, atol=1e-8)


def test_limits_at_the_change_points() -> None:
    """The rates at the change points themselves and around them, and a loop that closes there."""
    found = formula(CONTINUOUS)
    (top, _), (bottom, _) = found.unit.ends()
    at_top, at_bottom = found.change_point_rates()
    for crank, limit in ((top, at_top), (bottom, at_bottom)):
        theta = crank - np.pi / 2
        for off in (0.0, 1e-9, -1e-9, 1e-7, -1e-7, 1e-5, -1e-5, 1e-3, -1e-3):
            angle = np.array([(theta + off) % (2 * np.pi)])
            moved = lw.kinematics(CONTINUOUS, angle)
            pin, hanger = moved.points["rotator_pin"].position[0], moved.points["polished_rod"].position[0]
            link, lever = moved.links["rotator.coupler"], moved.links["rotator.rocker"]
            ends = [
                np.array([np.cos(each.angle[0]), np.sin(each.angle[0])]) * length
                for each, length in ((link, found.l_4), (lever, found.l_5))
            ]
            assert np.hypot(*(pin + ends[0] - hanger - ends[1])) < 1e-12 * found.l_4
            # The rate itself changes by about one in a radian.
            assert lever.d1[0] == pytest.approx(limit, abs=2e-6 + 3 * abs(off))


def test_loop_closes_all_round(turning: RodRotatorMotion, rocking: RodRotatorMotion) -> None:
    assert turning.loop_residual < 1e-12
    assert rocking.loop_residual < 1e-12


def test_second_transfer_function_is_the_derivative_of_the_first(
    turning: RodRotatorMotion, rocking: RodRotatorMotion
) -> None:
    for found in (turning, rocking):
        step = found.crank_angle[1]
        for rate, second in (
            (found.lever_transfer, found.lever_transfer_d1),
            (found.link_transfer, found.link_transfer_d1),
        ):
            slope = (rate[2:] - rate[:-2]) / (2 * step)
            np.testing.assert_allclose(slope, second[1:-1], rtol=0, atol=2e-3)


def test_rocking_by_the_closed_form(rocking: RodRotatorMotion) -> None:
    angle, rate = formula(INTERMITTENT).rocking(rocking.crank_angle + np.pi / 2, -1.0)
    offset = np.round((rocking.lever_angle[0] - angle[0]) / (2 * np.pi)) * 2 * np.pi
    np.testing.assert_allclose(rocking.lever_angle, angle + offset, rtol=0, atol=1e-12)
    np.testing.assert_allclose(rocking.lever_transfer, rate, rtol=0, atol=1e-12)


@pytest.mark.parametrize("assembly", ["left", "right"])
@pytest.mark.parametrize("swing", [20, 60, 90, 120])
def test_swing_comes_out_as_wanted(swing: float, assembly: str) -> None:
    entries = {"rod_rotator.swing": np.radians(swing).item(), "rod_rotator.assembly": assembly}
    found = rod_rotator(lw.replace(INTERMITTENT, entries))
    assert np.degrees(found.lever_swing) == pytest.approx(swing, abs=1e-9)
    assert found.transfer_min < 0 < found.transfer_max
    assert found.lever_turns_per_cycle == 0
    assert "oscillates" in found.verdict
    # The angle between lever and diagonal swings evenly about 90°.
    l_4, l_5 = found.link_length, found.lever_length
    ends = [(d**2 + l_5**2 - l_4**2) / (2 * d * l_5) for d in (found.diagonal_min, found.diagonal_max)]
    assert sum(ends) == pytest.approx(0, abs=1e-12)


def rotators(seed: int, many: int) -> Iterator[dict[str, Any]]:
    """Swings over all that can be written, densely near the ends; all else at random."""
    rng = generator(seed)
    for k in range(many):
        low, high = ((0.01, 180), (0.01, 20), (170, 180))[k % 3]
        yield {
            "rod_rotator.swing": float(np.radians(rng.uniform(low, high))),
            "rod_rotator.assembly": str(rng.choice(["left", "right"])),
            "rod_rotator.pin_distance": 2.5 if k % 2 else float(rng.uniform(0.3, 4.5)),
            "pumping_unit.cable": 2.2 if k % 2 else float(rng.uniform(0.0, 4.0)),
            "pumping_unit.rotation": str(rng.choice(["clockwise", "counter_clockwise"])),
        }


@pytest.mark.parametrize("seed", range(3))
def test_a_lever_swings_as_wanted_or_it_is_a_finding(seed: int) -> None:
    """Lengths above zero, no longer than the diagonal, and the swing found again in the motion."""
    made = 0
    for entries in rotators(seed, 40):
        machine = lw.replace(INTERMITTENT, entries)
        try:
            found = rod_rotator(machine)
        except AssemblyError:
            continue
        made += 1
        assert not found.findings, entries
        assert found.lever_swing == pytest.approx(entries["rod_rotator.swing"], abs=1e-7), entries
        assert 0 < found.lever_length <= found.diagonal_max * (1 + 1e-9), entries
        assert found.lever_length < found.link_length, entries
    assert 15 < made < 35


@pytest.mark.parametrize("assembly", ["left", "right"])
def test_the_range_of_swings_that_is_told_can_be_had(assembly: str) -> None:
    entries = {"rod_rotator.assembly": assembly, "rod_rotator.swing": 1e-3}
    with pytest.raises(AssemblyError, match="swing through") as told:
        rod_rotator(lw.replace(INTERMITTENT, entries))
    low, high = map(float, re.findall(r"([\d.]+)° to ([\d.]+)°", str(told.value))[0])
    for swing in (low, high):
        found = rod_rotator(
            lw.replace(INTERMITTENT, entries | {"rod_rotator.swing": np.radians(swing).item()})
        )
        assert np.degrees(found.lever_swing) == pytest.approx(swing, abs=1e-6)
    # 180° and more cannot be written.
    for swing in (low - 0.02, high + 0.08 if assembly == "left" else low - 0.1):
        with pytest.raises(AssemblyError):
            rod_rotator(lw.replace(INTERMITTENT, entries | {"rod_rotator.swing": np.radians(swing).item()}))


def test_lengths_of_the_continuous_regime_turn_or_it_is_a_finding() -> None:
    """Pins all along the arm, short cables too."""
    made = 0
    for entries in rotators(7, 60):
        entries.pop("rod_rotator.swing")
        entries["rod_rotator.pin_distance"] = min(entries["rod_rotator.pin_distance"], 2.98)
        try:
            found = rod_rotator(lw.replace(CONTINUOUS, entries))
        except AssemblyError:
            continue
        made += 1
        assert found.lever_turns_per_cycle == 1
        assert found.lever_length > 0
    assert made > 40


def test_given_lengths_that_do_not_turn_are_a_finding() -> None:
    given = {"rod_rotator.link_length": 3.7, "rod_rotator.lever_length": 0.5}
    study = lw.study(lw.replace(CONTINUOUS, given))
    assert any("does not rotate fully" in text for text in study.findings)


def test_a_swing_that_cannot_be_had_leaves_the_rest_of_the_study() -> None:
    study = lw.study(lw.replace(INTERMITTENT, {"rod_rotator.swing": np.radians(179.9).item()}))
    assert study.pumping_unit is not None
    assert study.rod_rotator is None
    assert len(study.findings) == 1
    assert 'choose assembly = "right"' in study.findings[0]


def test_rows_of_a_batch_without_lengths_are_nan() -> None:
    swings = np.radians([60.0, 179.9, 1.0, 90.0])
    link, lever = lengths(
        INTERMITTENT.pumping_unit, lw.replace(INTERMITTENT, {"rod_rotator.swing": swings}).rod_rotator
    )
    np.testing.assert_array_equal(np.isfinite(lever), [True, False, False, True])
    np.testing.assert_array_equal(np.isfinite(link), np.isfinite(lever))
    many = lw.replace(INTERMITTENT, {"rod_rotator.swing": swings})
    rates = lw.kinematics(many, np.linspace(0, 6, 7)).links["rotator.rocker"].d1
    np.testing.assert_array_equal(np.isfinite(rates).all(axis=1), np.isfinite(lever))


def test_batch_over_swing_and_unit() -> None:
    """Lengths are made for each row."""
    swings, radii = np.radians([15.0, 60.0, 120.0]), np.array([1.0, 1.05, 1.1])
    many = lw.replace(INTERMITTENT, {"rod_rotator.swing": swings, "pumping_unit.R": radii})
    phi = np.linspace(0, 2 * np.pi, 91)
    found = lw.kinematics(many, phi).links["rotator.rocker"].d1
    for n, (swing, radius) in enumerate(zip(swings, radii, strict=True)):
        one = lw.replace(INTERMITTENT, {"rod_rotator.swing": float(swing), "pumping_unit.R": float(radius)})
        np.testing.assert_allclose(found[n], lw.kinematics(one, phi).links["rotator.rocker"].d1, atol=1e-11)
        assert rod_rotator(one).lever_swing == pytest.approx(swing, abs=1e-10)


def test_lengths_of_the_paper() -> None:
    """The printed lengths of the continuous regime, 3.704 m and 0.3 m, to their last digit."""
    link, lever = lengths(CONTINUOUS.pumping_unit, CONTINUOUS.rod_rotator)
    assert link == pytest.approx(3.704, abs=5e-4)
    assert lever == pytest.approx(0.3, abs=5e-4)
    assert float(CONTINUOUS.pumping_unit.stroke) == pytest.approx(3.0, abs=5e-4)


def test_extremes_of_the_diagonal_are_those_of_the_beam(turning: RodRotatorMotion) -> None:
    m, M = diagonal_extremes(CONTINUOUS.pumping_unit, CONTINUOUS.rod_rotator)
    assert turning.diagonal_min == pytest.approx(m, rel=1e-14)
    assert turning.diagonal_max == pytest.approx(M, rel=1e-14)


def test_printed_intermittent_lengths_do_not_close() -> None:
    printed = lw.read(
        "machines/rod_rotator_intermittent.toml",
        {
            "rod_rotator": {
                "regime": "intermittent",
                "pin_distance": 2.5,
                "link_length": 3.5,
                "lever_length": 0.3,
            }
        },
    )
    with pytest.raises(AssemblyError, match="rotator"):
        rod_rotator(printed)


def test_given_lengths_that_rock() -> None:
    rotator = {"regime": "intermittent", "pin_distance": 2.5, "link_length": 3.7, "lever_length": 0.5}
    machine = lw.read("machines/rod_rotator_intermittent.toml", {"rod_rotator": rotator})
    found = rod_rotator(machine, n=1440)
    angle, _ = formula(machine).rocking(found.crank_angle + np.pi / 2, -1.0)
    assert found.lever_swing == pytest.approx(np.ptp(angle), rel=1e-5)
    assert found.string_turn_days is None
    assert found.link_force is None


def test_days_of_a_turn(turning: RodRotatorMotion, rocking: RodRotatorMotion) -> None:
    """Six strokes a minute, a worm of 40."""
    strokes = 6 * 60 * 24
    assert turning.string_turns_per_day == pytest.approx(strokes / 40)
    assert rocking.string_turns_per_day == pytest.approx(strokes / 40 / 4, rel=1e-9)
    for found in (turning, rocking):
        # The same by integrating the string's speed over a cycle.
        time = found.crank_angle / found.speed
        turned = np.trapezoid(np.abs(found.string_speed), time) / (2 * np.pi)
        assert turned * strokes == pytest.approx(found.string_turns_per_day, rel=1e-4)


def test_clutch_slips_one_way() -> None:
    for clutch, stroke in (("upstroke", 1), ("downstroke", -1)):
        machine = lw.replace(INTERMITTENT, {"rod_rotator.clutch": clutch})
        found = rod_rotator(machine, n=720)
        factor = lw.pumping_unit(machine, n=720).torque_factor
        moves = np.abs(factor) > 1e-3
        assert (found.string_speed[moves & (np.sign(factor) == -stroke)] == 0).all()
        assert (found.string_speed[moves & (np.sign(factor) == stroke)] != 0).all()


def test_force_in_the_link_by_power(rocking: RodRotatorMotion) -> None:
    """What the link gives the lever is what the worm takes: power of the link's force on the joint."""
    speed = rocking.speed
    moved = lw.kinematics(INTERMITTENT, rocking.crank_angle)
    joint = (moved.points["rotator"].d1 - moved.points["polished_rod"].d1) * speed
    pull = -np.stack((np.cos(rocking.link_angle), np.sin(rocking.link_angle)), axis=1)
    given = rocking.link_force * (joint * pull).sum(axis=1)
    taken = np.where(rocking.string_speed != 0, rocking.worm_torque * np.abs(rocking.lever_speed), 0)
    np.testing.assert_allclose(given, taken, rtol=0, atol=1e-10)
    assert rocking.worm_torque == pytest.approx(200 / (40 * 0.4))
    # Samples at 0.002° fall short of a smooth peak by 1e-9 of it.
    fine = rod_rotator(INTERMITTENT, n=200_000).link_force
    assert rocking.link_force_max == pytest.approx(np.abs(fine).max(), rel=1e-8)
    assert rocking.link_force_max >= np.abs(fine).max() * (1 - 1e-12)


@pytest.mark.parametrize("seed", range(2))
def test_maximum_force_and_turns_of_the_worm_by_samples(seed: int) -> None:
    """Where the clutch begins to slip at the largest force, and where the lever reverses within a stroke."""
    made = reversing = 0
    for entries in rotators(seed, 40):
        entries |= {"rod_rotator.clutch": ("upstroke", "downstroke")[made % 2]}
        try:
            found = rod_rotator(lw.replace(INTERMITTENT, entries), n=20_000)
        except AssemblyError:
            continue
        made += 1
        reversing += found.worm_turns_per_cycle > found.lever_swing / (2 * np.pi) + 1e-6
        forward = np.maximum(np.diff(found.lever_angle), 0).sum() / (2 * np.pi)
        assert found.worm_turns_per_cycle == pytest.approx(forward, abs=1e-6), entries
        if found.link_force_max is not None:
            most = np.abs(found.link_force).max()
            assert most * (1 - 1e-12) <= found.link_force_max, entries
            assert found.link_force_max == pytest.approx(most, rel=2e-3), entries
    assert made > 10
    assert reversing > 0


def test_no_arm_at_change_points(turning: RodRotatorMotion) -> None:
    assert turning.link_force_max is None
    assert any("in line twice" in each for each in lw.study(CONTINUOUS).warnings)


def test_unit_that_turns_the_other_way() -> None:
    """Clockwise, drawn with the well to the left: the mirror image, run through backwards."""
    other = lw.replace(INTERMITTENT, {"pumping_unit.rotation": "clockwise", "rod_rotator.assembly": "right"})
    here, there = rod_rotator(INTERMITTENT), rod_rotator(other)
    assert there.link_length == pytest.approx(here.link_length, rel=1e-14)
    mirrored = np.pi - here.lever_angle[::-1]
    turns = np.round((there.lever_angle[0] - mirrored[0]) / (2 * np.pi)) * 2 * np.pi
    np.testing.assert_allclose(there.lever_angle, mirrored + turns, rtol=0, atol=1e-12)
    np.testing.assert_allclose(there.lever_transfer, here.lever_transfer[::-1], rtol=0, atol=1e-12)


def test_class_3_unit_with_a_rotator() -> None:
    unit = {
        "A": 5.2,
        "C": 3.9,
        "I": 3.2,
        "P": 3.5,
        "H": 4.4,
        "G": 0.8,
        "R": 0.9,
        "geometry": "mark_ii",
        "cable": 2.0,
    }
    for rotator, turns in (({"regime": "continuous"}, 1), ({"regime": "intermittent"}, 0)):
        machine = lw.Machine(
            format=1, name="x", pumping_unit=unit, rod_rotator={"pin_distance": 4.5, **rotator}
        )
        found = rod_rotator(machine)
        assert found.lever_turns_per_cycle == turns
        assert found.loop_residual < 1e-12


def test_no_rotator() -> None:
    with pytest.raises(InputError, match="rod_rotator"):
        rod_rotator(lw.read("machines/roller_one_cart.toml"))
