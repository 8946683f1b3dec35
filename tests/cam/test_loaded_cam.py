"""Cams in their machines: the speed of losing contact against the follower alone, pressure by Hertz."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import linkwright as lw
from linkwright import FollowerLoad, Machine, Material, cam_profile, lift_off, line_contact, loaded_cam
from linkwright.app.feasibility import feasibility
from linkwright.cam import CamProfile
from linkwright.cam.dynamics.loaded import LoadedCam

MASS, RATE, FREE, PIN = 0.6, 4e3, 0.2, 0.25
BASE, ROLLER, WIDTH = 0.03, 0.008, 0.012

FILE = """
format = 1
name = "F"
[drive]
speed = {speed}
[mechanism.points]
G = {{ x = {pin}, y = 0 }}
[mechanism.cams.F]
base_radius = {base}
roller_radius = {roller}
width = {width}
closure = "{closure}"
sections = [
  {{ angle = "100 deg", lift = "9 mm", law = "{law}" }},
  {{ angle = "80 deg", lift = "-9 mm", law = "{law}" }},
  {{ angle = "180 deg" }},
]
[bodies]
F = {{ mass = {mass} }}
[loads]
spring = {{ kind = "spring", between = ["F", "G"], stiffness = {rate}, free_length = {free} }}
{more}
"""


def cam(more: str = "", closure: str = "spring", law: str = "cycloidal", speed: float = 20.0) -> Machine:
    """A roller follower in line, pressed on its cam by a spring that is shorter than when it is free."""
    text = FILE.format(
        speed=speed,
        pin=PIN,
        base=BASE,
        roller=ROLLER,
        width=WIDTH,
        closure=closure,
        law=law,
        mass=MASS,
        rate=RATE,
        free=PIN - BASE - ROLLER + 0.01,
        more=more,
    )
    return lw.loads(text)


# At no lift the spring is 1 cm shorter than when it is free.
FOLLOWER = FollowerLoad(MASS, RATE, RATE * 0.01)


@pytest.mark.parametrize("law", ["cycloidal", "modified_sine", "polynomial_4_5_6_7"])
@pytest.mark.parametrize("damping", [0.0, 30.0])
def test_contact_is_lost_as_the_follower_alone_says(law: str, damping: float) -> None:
    damper = 'air = { kind = "viscous", on = "F", damping = 30 }' if damping else ""
    found = loaded(cam(damper, law=law))
    alone = FollowerLoad(MASS, RATE, RATE * 0.01, damping)
    profile = cam_profile(cam(law=law))
    wanted = lift_off(profile.cam.lift, alone)
    assert found.speed_lost is not None
    assert found.speed_lost_angle is not None
    # Forces at 1 to 3 rad/s differ by a ten-thousandth of themselves through inertia.
    assert found.speed_lost == pytest.approx(wanted.speed, rel=1e-10)
    # The speed is flat at its smallest: the angle is good to the root of that.
    assert found.speed_lost_angle == pytest.approx(wanted.cam_angle, abs=1e-4)


def loaded(machine: Machine) -> LoadedCam:
    return loaded_cam(machine, cam_profile(machine))


def test_no_spring_loses_at_any_speed_and_a_groove_at_none() -> None:
    machine = lw.replace(cam(), {"loads.spring.stiffness": 1e-9})
    assert loaded(machine).speed_lost == pytest.approx(0, abs=0.01)
    assert loaded(cam(closure="groove")).speed_lost is None


def pressures(profile: CamProfile, force: np.ndarray, phi: np.ndarray) -> np.ndarray:
    """Hertz with the radius of the profile from differences of its outline, (n,)."""
    curve = profile.flanks[0].curve(0.0)
    d1, d2 = curve.tangents(phi), curve.seconds(phi)
    pitch = (d1**2).sum(axis=1) ** 1.5 / -(d1[:, 0] * d2[:, 1] - d1[:, 1] * d2[:, 0])
    steel = Material(210e9, 0.3)
    own, roller = (pitch - ROLLER, np.full_like(pitch, ROLLER))
    outer = force < 0
    own[outer], found = -(pitch[outer] + ROLLER), np.abs(force)
    return line_contact(found, own, roller, WIDTH, steel, steel).pressure


@pytest.mark.parametrize("closure", ["spring", "groove"])
def test_pressure_is_that_of_the_flank_that_carries(closure: str) -> None:
    """A groove carries with its outer flank where the follower would leave the cam."""
    machine = cam(closure=closure, speed=25.0 if closure == "spring" else 80.0)
    profile = cam_profile(machine)
    found = loaded_cam(machine, profile)
    assert (found.force_min < 0) == (closure == "groove")
    assert found.pressure is not None
    wanted = pressures(profile, found.force, np.mod(found.crank_angle, 2 * np.pi))
    np.testing.assert_allclose(found.pressure, wanted, rtol=1e-9, atol=1e-3)
    # The peak lies between two angles, less than their distance squared above them.
    highest = found.pressure.max()
    assert highest <= found.pressure_max <= highest * (1 + np.diff(found.crank_angle).max() ** 2)
    assert found.shear_max == pytest.approx(0.3 * found.pressure_max, rel=2e-3)


def test_a_follower_that_leaves_is_told_and_its_cam_still_judged() -> None:
    """Where the follower has left, no outer flank is asked for: the pressure there is zero."""
    found = loaded(cam(speed=80.0))
    assert found.force_min < 0
    assert len(found.findings) == 1
    assert "leaves cam F" in found.findings[0]
    assert found.pressure is not None
    np.testing.assert_array_equal(found.pressure[found.force < 0], 0.0)


# Motors that turn the cam at a speed: one that yields to nothing, and a stiff one with a large flywheel.
DRIVES = {
    "none": "",
    "constant speed": '[drive.motor]\nkind = "constant_speed"\nspeed = {speed}',
    "direct current": '[drive.motor]\nkind = "dc"\ntorque_stall = 1e6\nspeed_no_load = {speed}\ninertia = 9',
}


@pytest.mark.parametrize("drive", DRIVES)
@pytest.mark.parametrize("speed", [20.0, 80.0])
def test_a_floating_follower_is_a_finding_whatever_drives_the_cam(drive: str, speed: float) -> None:
    """The same motion has the same finding, and a follower that stays on its cam has none."""
    study = lw.study(cam(DRIVES[drive].format(speed=speed), speed=speed))
    (found,) = study.loaded_cams
    told = [text for text in study.findings if "leaves cam F" in text]
    assert len(told) == (speed == 80)
    assert found.speed == pytest.approx(speed, rel=1e-3)
    # The direct-current motor yields by a thousandth, and the force goes with the square of the speed.
    assert found.force_min == pytest.approx(loaded(cam(speed=speed)).force_min, rel=1e-2)


def test_forces_without_an_answer_are_said_of_the_cam_too(monkeypatch: pytest.MonkeyPatch) -> None:
    """What the forces say of themselves reaches whoever asks for the cam alone."""
    from linkwright.cam.dynamics import loaded as module

    def doubtful(*args: object, **options: object) -> object:
        return replace(lw.forces(*args, **options), findings=("nothing is known at 30°",))  # type: ignore[arg-type]

    monkeypatch.setattr(module, "forces", doubtful)
    assert "nothing is known at 30°" in loaded(cam()).findings


# A follower of 2 kg that 200 N press onto its cam: 30 mm by modified sine within 120°, whose maximum
# acceleration is 5.527957 h ω²/β².
FLOATING = """
format = 1
name = "Cam with a roller follower"
[drive]
{drive}
[mechanism.cams.follower]
follower = "translating"
contact = "roller"
closure = "spring"
base_radius = 0.06
roller_radius = 0.015
sections = [
    {{ angle = "60 deg", lift = 0 }},
    {{ angle = "120 deg", lift = 0.03, law = {{ kind = "modified_sine" }} }},
    {{ angle = "60 deg", lift = 0 }},
    {{ angle = "120 deg", lift = -0.03, law = {{ kind = "modified_sine" }} }},
]
[bodies]
follower = {{ mass = 2 }}
[loads]
work = {{ kind = "force", on = "follower", force = -200 }}
"""
FLOATS_FROM = 2 * np.pi / 3 * np.sqrt(200.0 / (2.0 * 5.527957 * 0.03))


@pytest.mark.parametrize(
    "drive",
    [
        "speed = {speed}",
        'motor = {{ kind = "constant_speed", speed = {speed} }}',
        'flywheel.inertia = 50\nmotor = {{ kind = "dc", speed_no_load = {speed}, torque_stall = 1e6 }}',
    ],
)
def test_a_follower_that_floats_is_told_by_every_analysis(drive: str) -> None:
    """Forces too hold for a follower that stays; a study says it once."""
    for share, floats in ((0.995, False), (1.005, True)):
        machine = lw.loads(FLOATING.format(drive=drive.format(speed=share * FLOATS_FROM)))
        analyses = [lw.forces(machine), lw.study(machine)]
        # A check solves for no motion.
        analyses += [] if '"dc"' in drive else [feasibility(machine)]
        for findings in (analysis.findings for analysis in analyses):
            told = [text for text in findings if "follower leaves cam" in text]
            assert len(told) == floats
