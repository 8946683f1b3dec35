"""Loads over position on what moves along a guide, and over the angle of links, against virtual work."""

from __future__ import annotations

import numpy as np
import pytest

import linkwright as lw
from linkwright import MachineError

HEAD = """
format = 1
name = "position"
[drive]
speed = "60 rpm"
[mechanism.cranks.A]
radius = 0.1
phase = 0.3
"""

# Of each kind of slide: the mechanism, and the point on the guide.
SLIDES = {
    "slider": ('[mechanism.sliders.S]\ncrank = "A"\nrod = 0.4\noffset = 0.03\n', "S"),
    "yoke": ('[mechanism.yokes.Y]\npin = "A"\nguide = { angle = "10 deg", offset = 0.02 }\n', "Y"),
    "linear driver": ('[mechanism.linear_drivers.D]\nlaw = "0.1*sin(phi)"\n', "D"),
    "rack": (
        '[mechanism.points.P]\nx = 0.3\n[mechanism.rockers.R]\ncrank = "A"\npivot = "P"\n'
        "coupler = 0.35\nrocker = 0.25\n"
        '[mechanism.racks.T]\ngear = "R.rocker"\nradius = 0.1\nguide = { through = "P", angle = "30 deg" }\n',
        "T",
    ),
    "joint": (
        '[mechanism.joints.J]\nx = 0.45\ny = 0\nguide = { angle = "0 deg" }\n'
        '[mechanism.bars.B]\nstart = "A"\nend = "J"\nlength = 0.4\n',
        "J",
    ),
}

POSITIONS, FORWARD, BACK = [-0.1, 0.0, 0.02, 0.5], [20.0, 90.0, 10.0, 60.0], [5.0, 5.0, 30.0, 5.0]
LOAD = (
    f'[loads.work]\nkind = "force_position"\nposition = {POSITIONS}\nforward = {FORWARD}\nreturn = {BACK}\n'
)

# Between kinks and dead centres.
ANGLES = np.linspace(0.05, 2 * np.pi + 0.05, 60, endpoint=False)


def against(value: np.ndarray, rate: np.ndarray, places: list[float]) -> np.ndarray:
    """Force against the motion by the table, and its torque against the crank."""
    ahead, behind = np.interp(value, places, FORWARD), np.interp(value, places, BACK)
    return np.where(rate > 0, ahead * rate, -behind * rate)


@pytest.mark.parametrize("what", SLIDES)
def test_force_over_position_acts_on_every_slide(what: str) -> None:
    mechanism, on = SLIDES[what]
    machine = lw.loads(HEAD + mechanism + LOAD + f'on = "{on}"\n')
    slide = lw.kinematics(machine, ANGLES).slides[on]
    expected = against(slide.position, slide.d1, POSITIONS)
    found = lw.reduction(machine, n=720)
    at = np.interp(ANGLES % (2 * np.pi), found.crank_angle, found.torque_load, period=2 * np.pi)
    forces = lw.forces(machine, angles=ANGLES, speed=6.0)
    # Virtual work of the one load; the machine has no masses.
    np.testing.assert_allclose(forces.torque_drive, expected, atol=1e-12 * np.abs(expected).max())
    # The reduction is read between its 720 angles, straight: a kink in an interval of half a degree.
    np.testing.assert_allclose(at, expected, atol=0.03 * np.abs(expected).max())


@pytest.mark.parametrize("what", SLIDES)
def test_formulas_know_the_position_on_every_slide(what: str) -> None:
    mechanism, on = SLIDES[what]
    text = f'[loads.work]\nkind = "formula"\non = "{on}"\nforce = "-300*s - 40*v"\n'
    machine = lw.loads(HEAD + mechanism + text)
    slide = lw.kinematics(machine, ANGLES).slides[on]
    expected = (300 * slide.position + 40 * slide.d1 * 6.0) * slide.d1
    forces = lw.forces(machine, angles=ANGLES, speed=6.0)
    np.testing.assert_allclose(forces.torque_drive, expected, atol=1e-12 * np.abs(expected).max())


SWING = """
[mechanism.points.P]
x = 0.45
[mechanism.rockers.R]
crank = "A"
pivot = "P"
coupler = 0.35
rocker = 0.25
assembly = "right"
[loads.pump]
kind = "torque_swing"
on = "R.rocker"
angle = "150, 190, 215, 260 deg"
forward = [20, 90, 10, 60]
return = [5, 5, 30, 5]
"""


def test_torque_over_the_angle_of_a_rocker() -> None:
    machine = lw.loads(HEAD + SWING)
    places = list(np.radians([150.0, 190.0, 215.0, 260.0]))
    turned = lw.kinematics(machine, ANGLES).links["R.rocker"]
    angle = turned.angle % (2 * np.pi)
    # The core knows angles within ±180°; the table goes on beyond.
    assert angle.min() > np.pi
    expected = against(angle, turned.d1, places)
    forces = lw.forces(machine, angles=ANGLES, speed=6.0)
    np.testing.assert_allclose(forces.torque_drive, expected, atol=1e-12 * np.abs(expected).max())
    found = lw.reduction(machine, n=720)
    at = np.interp(ANGLES % (2 * np.pi), found.crank_angle, found.torque_load, period=2 * np.pi)
    np.testing.assert_allclose(at, expected, atol=0.03 * np.abs(expected).max())


def test_work_of_a_swing_is_the_area_of_its_table() -> None:
    machine = lw.loads(
        HEAD + SWING + '[drive.motor]\nkind = "dc"\nspeed_no_load = 10\ntorque_stall = 300\ninertia = 2\n'
    )
    steady = lw.steady_state(machine, accuracy=1e-11)
    rocker = next(each for each in lw.linkage(machine).elements if each.output == "R.rocker")
    ends = np.array([rocker.low, rocker.high]) % (2 * np.pi)
    angle = np.linspace(*np.sort(ends), 200_001)
    places = np.radians([150.0, 190.0, 215.0, 260.0])
    both = np.interp(angle, places, FORWARD) + np.interp(angle, places, BACK)
    # Once forward and once back; the trapezoidal rule errs at kinks by the square of its step.
    assert steady.energy_load == pytest.approx(np.trapezoid(both, angle), rel=1e-9)


def test_what_has_no_guide_is_refused() -> None:
    with pytest.raises(MachineError, match="point on a guide"):
        lw.loads(HEAD + SLIDES["slider"][0] + LOAD + 'on = "A"\n')
    with pytest.raises(MachineError, match="name of a link"):
        lw.loads(HEAD + SWING.replace('on = "R.rocker"', 'on = "R"'))
