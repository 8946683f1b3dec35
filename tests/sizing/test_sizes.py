"""Sizing by studies: drive for the minimum cost, the smallest cam, the smallest damper; refusals."""

from __future__ import annotations

import json
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner, Result

import linkwright as lw
from linkwright import FindingError, InputError
from linkwright.app.application import application
from linkwright.kernel.command.answer import Answer
from linkwright.studies import cam_study, damper_study, drive_study

EXAMPLES = Path(__file__).parents[2] / "examples"

CAM = EXAMPLES / "cam_oscillating_valve" / "machine.toml"
THROWS = EXAMPLES / "damper_over_speeds" / "machine.toml"
DAMPER = EXAMPLES / "viscous_damper" / "machine.toml"


def size(*words: str) -> Result:
    return CliRunner().invoke(application(), ["size", *words])


def test_the_smallest_cam_within_a_pressure_angle() -> None:
    """The limit is active, and the cam of the file is larger: it passes by less."""
    machine = lw.read(CAM)
    plan = cam_study(machine, pressure_angle=np.radians(30))
    best = lw.optimise(plan, method="gradient", starts=2)
    assert best.responses["pressure_angle"] == pytest.approx(np.radians(30), rel=1e-6)
    profile = lw.cam_profile(best.machine)
    assert profile.pressure_angle_max == pytest.approx(np.radians(30), rel=1e-6)
    smaller = lw.replace(best.machine, {"mechanism.cams.finger.base_radius": 0.98 * profile.base_radius})
    assert lw.cam_profile(smaller).pressure_angle_max > np.radians(30)


def test_contact_pressure_asks_for_width_and_speed(tmp_path: Path) -> None:
    """Before the search: without them no machine has an answer."""
    limits = ("--pressure-angle", "30 deg", "--contact-stress", "600 MPa")
    without_width = size(str(CAM), *limits)
    assert without_width.exit_code == 2
    assert "mechanism.cams.finger: found no width" in without_width.output
    text = CAM.read_text("utf-8").replace('side = "right"', 'side = "right"\nwidth = "10 mm"')
    without_speed = tmp_path / "cam.toml"
    without_speed.write_text(text.replace('speed = "200 rad/s"', ""), "utf-8")
    found = size(str(without_speed), *limits)
    assert found.exit_code == 2
    assert "drive.speed: found none, and no drive.motor" in found.output


def test_the_smallest_damper_that_keeps_a_shaft() -> None:
    """At the damping that is best for a ring the limit is just met: Den Hartog's optimum of that ring."""
    machine = lw.read(DAMPER)
    plan = damper_study(machine, shaft="shaft", torque=2500.0)
    best = lw.optimise(plan, method="both", evaluations=300)
    assert best.responses["vibratory"] == pytest.approx(2500.0, rel=1e-4)
    ring, damping = best.variables["ring"], best.variables["damping"]
    design = lw.design_damper(machine, "engine", ring)
    # The peak is flat over the damping, and the speeds of the run are samples of it.
    assert damping == pytest.approx(design.damping_best, rel=0.05)


def test_a_stress_is_a_torque_over_the_section() -> None:
    sections = [{"length": "0.5 m", "diameter": "100 mm"}]
    tables = lw.read(DAMPER).model_dump(by_alias=True, exclude_unset=True)
    tables["train"]["shafts"]["shaft"] = {"between": ["engine", "generator"], "sections": sections}
    machine = lw.Machine.model_validate(tables)
    plan = damper_study(machine, shaft="shaft", stress=30e6)
    found = lw.evaluate(
        plan, {axis.name: np.array([lw.get(machine, axis.addresses[0])]) for axis in plan.axes}
    )
    # W = π d³/16 of a full circle.
    forced = lw.forced_vibration(machine)
    torque = forced.shaft_torque_vibratory[forced.shafts.index("shaft")].max()
    ratio = torque / found.columns["stress"][0]
    assert ratio == pytest.approx(np.pi * 0.1**3 / 16, rel=1e-12)


def test_the_stress_of_a_throw_is_that_of_its_crankshaft() -> None:
    """Throws twist the shafts between them, which stand in no table of shafts."""
    machine = lw.read(THROWS)
    plan = damper_study(machine, shaft="crank_2", stress=14e6)
    found = lw.evaluate(
        plan, {axis.name: np.array([lw.get(machine, axis.addresses[0])]) for axis in plan.axes}
    )
    stress = lw.shaft_stress(machine)
    assert found.columns["stress"][0] == stress.vibratory[stress.shafts.index("crank_2")].max()


def test_a_drive_for_the_minimum_cost() -> None:
    """One motor, for time: ratio and flywheel are on their limits, and δ and the start are kept."""
    machine = lw.read("roller_two_carts")
    plan = drive_study(machine, unevenness=0.06, run_up_time=2.0)
    powers = [lw.read("roller_two_carts", {"drive.motor": motor}).drive for motor in plan.axes[0].choices]
    rated = [drive.motor.power_rated for drive in powers]
    # One motor of each power, upwards: what its run-up asks for may be far more than its work.
    assert len(rated) == 6
    assert all(large > 1.1 * small for small, large in pairwise(rated))
    one = {"motor": np.array([1.0]), "ratio": np.array([9.8]), "flywheel": np.array([120.0])}
    row = lw.evaluate(plan, one)
    mass = 2 * 120.0 / 0.6**2
    power = row.columns["power"][0]
    assert row.columns["cost"][0] == pytest.approx(0.15 * power + 1.5 * mass, rel=1e-12)
    assert set(plan.limits) == {"delta", "speed", "load", "overload", "start"}


def test_motors_that_do_not_serve_are_named(monkeypatch: pytest.MonkeyPatch) -> None:
    def nothing(*_: Any, **__: Any) -> None:
        raise FindingError("none of all machines keeps all constraints")

    monkeypatch.setattr("linkwright.studies.optimise.optimise", nothing)
    answer = size("roller_one_cart", "--minimum-cost", "--run-up-time", "0.01 s", "--json")
    assert answer.exit_code == 1
    (finding,) = json.loads(answer.output)["findings"]
    assert "4A132S6U3, 4A132M6U3, 4A160S6U3" in finding
    assert "larger ones may suffice" in finding


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("roller_two_carts", "--run-up-time", "2 s"), "--minimum-cost"),
        (("roller_two_carts", "--per-kilowatt", "90"), "--minimum-cost"),
        (("roller_two_carts", "--minimum-cost", "--per-kilogram", "0"), "--per-kilogram"),
        (("roller_two_carts", "--minimum-cost", "--flywheel-radius", "0 m"), "--flywheel-radius"),
        (("roller_two_carts", "--minimum-cost", "--pressure-angle", "30 deg"), "one of them"),
        (("roller_two_carts", "--pressure-angle", "30 mm"), "length"),
        (("roller_two_carts", "--pressure-angle", "30 deg"), "cam"),
        ((str(DAMPER), "--shaft", "shaft"), "one of them"),
        ((str(DAMPER), "--shaft", "rod", "--torque", "1 kN m"), "expected one of shaft"),
        ((str(DAMPER), "--shaft", "shaft", "--stress", "30 MPa"), "no section"),
    ],
)
def test_questions_that_make_no_sense(words: tuple[str, ...], message: str) -> None:
    answer = size(*words)
    assert answer.exit_code == 2
    assert message in answer.output


def test_prices_of_the_command(monkeypatch: pytest.MonkeyPatch) -> None:
    """They are those of the study: the flywheel of a disc of 0.4 m has 2.25 times the mass."""
    seen = []
    monkeypatch.setattr(
        "linkwright.studies.commands.optimise.optimum_answer",
        lambda plan, *_: seen.append(plan) or Answer(machine=None),
    )
    words = ("--per-kilowatt", "90", "--per-kilogram", "4", "--flywheel-radius", "400 mm")
    assert size("roller_two_carts", "--minimum-cost", *words).exit_code == 0
    one = {"motor": np.array([1.0]), "ratio": np.array([9.8]), "flywheel": np.array([120.0])}
    row = lw.evaluate(seen[0], one)
    cost = 0.09 * row.columns["power"][0] + 4 * 2 * 120.0 / 0.4**2
    assert row.columns["cost"][0] == pytest.approx(cost, rel=1e-12)


def test_the_command(tmp_path: Path) -> None:
    words = [str(CAM), "--pressure-angle", "30 deg", "--json", "--out", str(tmp_path / "cam.toml")]
    answer = size(*words)
    assert answer.exit_code == 0
    optimum = json.loads(answer.stdout)["results"]["optimum"]
    found = lw.read(tmp_path / "cam.toml")
    assert optimum["variables"]["base"] == lw.get(found, "mechanism.cams.finger.base_radius")
    with pytest.raises(InputError, match="pressure_angle"):
        cam_study(found, pressure_angle=-1.0)
