"""Contacts that a motion in time loses: by the equilibrium of the follower written by hand."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from command_line import invoke
from zoo import animal

import linkwright as lw
from linkwright import Machine, contact_losses, forces
from linkwright.drive import Drive, states
from linkwright.drive.model.drive import Flywheel
from linkwright.kinetostatics.motion import Motion

MASS, RATE, PRESSED, LIFT, RISE = 0.6, 4e3, 0.01, 0.009, np.radians(100)
SEAT = 0.038

FILE = """
format = 1
name = "F"
[drive.motor]
kind = "dc"
torque_stall = "{torque} N m"
speed_no_load = "{speed} rad/s"
inertia = "0.05 kg m^2"
{more}
[mechanism.points]
G = {{ x = 0.25, y = 0 }}
[mechanism.cams.F]
base_radius = 0.03
roller_radius = 0.008
closure = "{closure}"
sections = [
  {{ angle = "100 deg", lift = "9 mm", law = "cycloidal" }},
  {{ angle = "80 deg", lift = "-9 mm", law = "cycloidal" }},
  {{ angle = "180 deg" }},
]
[bodies]
F = {{ mass = {mass} }}
[loads]
spring = {{ kind = "spring", between = ["F", "G"], stiffness = {rate}, free_length = {free} }}
"""


def text_of(speed: float, closure: str = "spring", torque: float = 50, more: str = "") -> str:
    """A valve whose spring is 10 mm shorter than when it is free, driven up to a speed."""
    return FILE.format(
        speed=speed,
        closure=closure,
        torque=torque,
        more=more,
        mass=MASS,
        rate=RATE,
        free=0.25 - SEAT + PRESSED,
    )


def valve(speed: float, closure: str = "spring", torque: float = 50, more: str = "") -> Machine:
    return lw.loads(text_of(speed, closure, torque, more))


def force_along(phi: float, omega: float, epsilon: float) -> float:
    """m s̈ + c (s + s₀) by the cycloidal law, along the normal of the contact [N]."""
    angle = phi % (2 * np.pi)
    begin, length, start, h = (0.0, RISE, 0.0, LIFT) if angle < RISE else (RISE, np.pi - RISE, LIFT, -LIFT)
    z = min((angle - begin) / length, 1.0)
    s = start + h * (z - np.sin(2 * np.pi * z) / (2 * np.pi))
    s1 = h / length * (1 - np.cos(2 * np.pi * z))
    s2 = h / length**2 * 2 * np.pi * np.sin(2 * np.pi * z)
    along = MASS * (s2 * omega**2 + s1 * epsilon) + RATE * (s + PRESSED)
    return float(along / np.cos(np.arctan2(s1, SEAT + s)))


def test_a_follower_is_lost_where_its_own_equilibrium_says() -> None:
    machine = valve(85)
    motion = lw.transient(machine, turns=5.0)
    (loss,) = contact_losses(machine, motion)
    phi, omega, epsilon = (float(x[0]) for x in states(motion, np.array([loss.time])))
    assert (loss.crank_angle, loss.speed) == (phi, omega)
    # The force there is a difference of forces of some 100 N, known to the accuracy of the acceleration.
    assert force_along(phi, omega, epsilon) == pytest.approx(0.0, abs=1e-5)
    at = states(motion, np.array([loss.pull_time]))
    assert force_along(*(float(x[0]) for x in at)) == pytest.approx(-loss.pull, rel=1e-6)
    before = np.linspace(0.0, loss.time, 2000)[1:-1]
    assert min(force_along(*x) for x in np.array(states(motion, before)).T) > 0
    assert f"{np.degrees(phi):.4g}°" in loss.sentence()


@pytest.mark.parametrize(("speed", "closure"), [(50.0, "spring"), (85.0, "groove")])
def test_a_follower_that_stays_is_not_accused(speed: float, closure: str) -> None:
    machine = valve(speed, closure)
    assert contact_losses(machine, lw.transient(machine, turns=5.0)) == ()


def test_a_study_tells_what_its_run_up_loses() -> None:
    """Started above its speed, the cam throws its follower; in steady motion it holds it."""
    study = lw.study(valve(40, torque=5, more="[run_up]\nspeed_start = 85\nturns_max = 100"))
    told = [text for text in study.findings if "leaves cam F" in text]
    assert len(told) == 1
    assert told[0].startswith("Run-up: ")
    assert study.loaded_cams[0].force_min > 0


def test_a_cable_becomes_slack_where_its_body_falls_faster() -> None:
    """A weight on a cable: m (g + ẍ) is its tension."""
    light = lw.replace(animal("cable on an arc"), {"loads.dry.force": 0.0})
    machine = light.model_copy(update={"drive": Drive(flywheel=Flywheel(inertia=1e4))})
    assert contact_losses(machine, lw.transient(machine, speed=1.0, turns=1.0, motor=False)) == ()
    motion = lw.transient(machine, speed=20.0, turns=1.0, motor=False)
    (loss,) = contact_losses(machine, motion)
    assert (loss.kind, loss.name) == ("cable", "H")
    at = Motion(*states(motion, np.array([loss.time])), np.array([loss.time]))
    # Over the weight of 30 kg.
    assert forces(machine, at).pairs["H.cable"].normal[0] / (30 * 9.81) == pytest.approx(0.0, abs=1e-9)
    assert "becomes slack" in loss.sentence()


def test_the_command_finds_it(tmp_path: Path) -> None:
    (tmp_path / "valve.toml").write_text(text_of(85), encoding="utf-8")
    words = ["transient", str(tmp_path / "valve.toml"), "--revolutions", "5", "--json"]
    done = invoke(*words)
    assert done.exit_code == 1
    answer = json.loads(done.stdout)
    (loss,) = answer["results"]["transient"]["contact_losses"]
    assert loss["name"] == "F"
    assert f"{loss['time']:.4g} s" in answer["findings"][0]
