"""Events and extremes of motions in time, against closed forms and the equation of motion itself."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import linkwright as lw
from linkwright import AssemblyError, InputError, LinkwrightError
from linkwright.drive import course
from linkwright.drive.figures import in_time_figure
from linkwright.machine import compile_machine

ROOT = Path(__file__).parents[2]
PRESS = ROOT / "examples" / "press_with_flywheel" / "machine.toml"

FLYWHEEL = """
format = 1
name = "Flywheel"
[drive.motor]
kind = "constant_torque"
torque = 20
[drive.flywheel]
inertia = 4
[mechanism.cranks.A]
radius = 0.1
"""


@pytest.fixture(scope="module")
def press() -> tuple[lw.Machine, lw.drive.transient.Transient]:
    machine = lw.read(PRESS)
    return machine, lw.transient(machine, angle=np.pi / 2, turns=3.0)


def test_a_flywheel_under_constant_torque() -> None:
    """ω = M t/J: the extremes are at the ends, and nothing happens on the way."""
    machine = lw.loads(FLYWHEEL)
    motion = lw.transient(machine, duration=2.0)
    slowest, fastest, least, most = lw.motion_extremes(motion)
    assert (slowest.value, slowest.time) == (0.0, 0.0)
    assert fastest.value == pytest.approx(10.0, rel=1e-9)
    assert fastest.time == pytest.approx(2.0)
    assert fastest.crank_angle == pytest.approx(10.0, rel=1e-9)
    assert (least.value, most.value) == pytest.approx((5.0, 5.0), rel=1e-9)
    assert [each.kind for each in lw.motion_events(machine, motion)] == ["start", "end of the time"]


def test_an_extreme_of_the_acceleration_satisfies_the_equation_of_motion(press) -> None:
    """ε = (M_d − M_r − ½ J′ω²)/J at the angle and speed that are reported, and no sample lies beyond."""
    machine, motion = press
    compiled = compile_machine(machine)
    sampled = course(motion, 20_000)
    for each in lw.motion_extremes(motion):
        values = sampled[2] if each.quantity == "speed" else sampled[3]
        sign = 1 if each.kind == "maximum" else -1
        # The margin is rounding of the largest value.
        assert (sign * values).max() <= sign * each.value + 1e-9 * np.abs(values).max()
        angle, speed = (float(x[0]) for x in motion.at([each.time]))
        assert angle == pytest.approx(each.crank_angle, abs=1e-12)
        if each.quantity == "acceleration":
            at = compiled.reductions(np.array([angle % (2 * np.pi)]))
            drive = compiled.motor_torques([speed]).crank
            resisting = at.load + at.dry + at.viscous * speed + 0.5 * at.inertia_slope * speed**2
            wanted = float(((drive - resisting) / at.inertia)[0])
            # The polynomial between the steps is as exact as these, 1e-8 of the speed in steps of 10 ms.
            assert each.value == pytest.approx(wanted, abs=1e-5)


def test_kinks_are_where_the_force_of_the_press_changes(press) -> None:
    machine, motion = press
    kinks = [each for each in lw.motion_events(machine, motion) if each.kind == "kink"]
    places = lw.kinematics(machine, [each.crank_angle for each in kinks]).slides["ram"].position
    ends = np.array([0.42, 0.56, 0.562, 0.578, 0.58])
    assert np.abs(places[:, None] - ends).min(axis=1).max() < 1e-8
    assert {int(np.abs(ends - place).argmin()) for place in places} == {0, 1, 2, 3, 4}


@pytest.mark.parametrize(
    "time", [-0.1, 2.1, 1e308, np.nan, None, "x", 1 + 2j, [1, [2, 3]], 10**400, [0.5, 2.5], object()]
)
def test_times_that_the_motion_does_not_have_are_refused(time: Any) -> None:
    """Beyond its ends the polynomial of a step is no motion."""
    motion = lw.transient(lw.loads(FLYWHEEL), duration=2.0)
    with pytest.raises(LinkwrightError, match="time"):
        motion.at(time)


def test_a_time_that_rounding_puts_beyond_the_end_is_the_end() -> None:
    motion = lw.transient(lw.loads(FLYWHEEL), duration=2.0)
    angle, speed = motion.at(np.nextafter(2.0, 3.0))
    assert (float(angle), float(speed)) == (motion.crank_angle[-1], motion.speed[-1])


def test_a_jump_of_the_acceleration() -> None:
    """A cam's parabolic law turns its acceleration about in the middle of the rise."""
    text = (ROOT / "machines" / "roller_cam.toml").read_text(encoding="utf-8")
    machine = lw.loads(re.sub(r"law = \{.*\}", 'law = { kind = "parabolic" }', text))
    motion = lw.transient(machine, speed=1.0, turns=1.0)
    jumps = [each for each in lw.motion_events(machine, motion) if each.kind.startswith("jump")]
    shares = sorted({round((each.crank_angle / np.pi) % 1, 6) for each in jumps})
    assert shares == [0.5]
    compiled = compile_machine(machine)
    for each in jumps:
        beside = np.array([each.crank_angle - 1e-6, each.crank_angle + 1e-6]) % (2 * np.pi)
        at = compiled.reductions(beside)
        drive = compiled.motor_torques([each.speed]).crank[0]
        resisting = at.load + at.dry + at.viscous * each.speed + 0.5 * at.inertia_slope * each.speed**2
        wanted = (drive - resisting) / at.inertia
        found = (each.acceleration_before, each.acceleration_after)
        # A millionth of a radian beside the jump; the acceleration changes by 13 rad/s² per radian.
        assert found == pytest.approx(tuple(wanted), abs=1e-3)


def test_a_stall_is_told_with_its_torques() -> None:
    machine = lw.read(PRESS)
    motion = lw.transient(machine, speed=3.0, turns=5.0, motor=False)
    end = lw.motion_events(machine, motion)[-1]
    assert end.kind == "stall"
    assert end.speed == 0.0
    assert end.torque_drive == 0.0
    assert end.torque_load > 0
    assert lw.motion_extremes(motion)[0].value == 0.0


def test_a_machine_that_does_not_start_has_two_events_and_no_extremes() -> None:
    machine = lw.replace(lw.loads(FLYWHEEL), {"drive.motor.torque": 0.0})
    motion = lw.transient(machine, duration=1.0)
    assert [each.kind for each in lw.motion_events(machine, motion)] == ["start", "does not start"]
    assert lw.motion_extremes(motion) == ()


def test_the_top_of_a_press_is_its_inner_dead_centre() -> None:
    machine = lw.read(PRESS)
    top = lw.zero_angle(machine, "top")
    assert top.angle == pytest.approx(np.pi / 2, abs=1e-9)
    assert top.words == "top dead centre of ram"
    assert lw.zero_angle(machine, "ram inner").angle == top.angle
    assert lw.zero_angle(machine, "bottom").angle == lw.zero_angle(machine, "outer").angle != top.angle


@pytest.mark.parametrize(
    ("where", "words"), [("left", "one of outer"), ("cart1 upper", "one of outer"), ("outer", "cart1")]
)
def test_a_dead_centre_that_is_not_told_apart(where: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        lw.zero_angle(lw.read(ROOT / "machines" / "roller_two_carts.toml"), where)


def test_what_moves_level_has_no_top() -> None:
    with pytest.raises(InputError, match="as high at both"):
        lw.zero_angle(lw.read(ROOT / "machines" / "roller_two_carts.toml"), "cart1 top")


def test_a_dead_centre_keeps_its_revolution() -> None:
    """The nut of a scissor lift passes below its top after 137.5 revolutions; where its screw ends, the
    platform does not rest.
    """
    lift = lw.read(ROOT / "examples" / "scissor_lift" / "machine.toml")
    top = lw.zero_angle(lift, "top")
    # The screw moves the nut by 4 mm a revolution, from 550 mm.
    assert top.angle == pytest.approx(2 * np.pi * 550 / 4, abs=1e-6)
    assert lw.pose(lift, top.angle).slides["post"].velocity == pytest.approx(0.0, abs=1e-9)
    with pytest.raises(InputError, match="a limit of its rotation"):
        lw.zero_angle(lift, "bottom")


def test_rates_without_limit_are_told() -> None:
    lift = lw.read(ROOT / "examples" / "scissor_lift" / "machine.toml")
    end = lw.closure(lift).ranges[0][0]
    for ask in (lw.pose, lambda machine, at: lw.kinematics(machine, [0.0, at])):
        with pytest.raises(AssemblyError, match=r"grow without limit|closes only"):
            ask(lift, float(np.nextafter(end, np.inf)))


def test_what_has_no_acceleration_is_drawn_all_the_same() -> None:
    """Without masses and torques nothing accelerates: 0/0."""
    machine = lw.loads("format = 1\nname = 'x'\n[mechanism.cranks.A]\nradius = 0.1\n")
    motion = lw.transient(machine, turns=1.0)
    assert not np.isfinite(motion.curves()["acceleration"]).any()
    assert in_time_figure(motion, ()).axes


def test_a_crank_at_the_limit_of_its_rotation_is_refused() -> None:
    """A rod half as long as its crank stops it where sin φ = l/r, at 30°; the motion is no rest there."""
    machine = lw.loads(
        """
        format = 1
        name = "Short rod"
        [drive]
        motor = { kind = "dc", torque_stall = "40 N m", speed_no_load = "1500 rpm" }
        gearbox = { ratio = 20 }
        [mechanism.cranks.A]
        radius = "100 mm"
        [mechanism.sliders.ram]
        crank = "A"
        rod = "50 mm"
        [bodies]
        ram = { mass = "80 kg" }
        A = { inertia = "2 kg m^2" }
        """
    )
    with pytest.raises(lw.AssemblyError, match=r"-30\.00° to 30\.00°"):
        lw.transient(machine, duration=2.0)
    before = lw.transient(machine, duration=0.05)
    assert 0 < before.crank_angle[-1] < np.pi / 6
