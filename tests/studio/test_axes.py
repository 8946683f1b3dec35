"""Servo axes in the studio: a chip with the results of every axis, of their bus, and of the timing."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.axes.test_servo_axes import CARRIAGE, PACKAGING

import linkwright as lw
from linkwright.studio.building import End, added, drawn
from linkwright.studio.controls import controls
from linkwright.studio.document import tables_of
from linkwright.studio.drawing import entries_of

from .conftest import Tab

EMPTY = 'format = 1\nname = "drawn"\n'
MOTORS = "type, inertia [kg cm^2], torque_rated [N m], speed_rated [rpm], torque_max [N m], speed_max [rpm]\n"
MOTORS += "S1, 0.9, 2.4, 3000, 7.1, 6000\nS2, 1.8, 4.8, 3000, 14, 6000\n"


def test_axes_have_their_chip_and_results(tab: Tab) -> None:
    """Every axis answers with its torque; without a cycle time the chip says what is missing."""
    answer = tab.ask(ask="compute", text=PACKAGING)
    chips = {chip["name"]: chip for chip in answer["chips"]}
    assert "obstacle" not in chips["axis"]
    without = tab.ask(ask="compute", text=PACKAGING.replace('speed = "120 rpm"', ""))
    (chip,) = (chip for chip in without["chips"] if chip["name"] == "axis")
    assert chip["obstacle"] == "The cycle time is unknown."


def test_the_timing_diagram_has_every_section_with_its_entry(tab: Tab) -> None:
    """Sections of an axis over time count in angles of the master; those of a cam are at its own address."""
    timed = PACKAGING.replace('angle = "120 deg", swing', 'time = "0.2 s", swing')
    answer = tab.ask(ask="compute", text=timed)
    (view,) = (view for view in answer["views"] if view["kind"] == "timing")
    dial, shaft = view["tracks"]
    (step,) = dial["sections"]
    assert (step["address"], step["unit"]) == ("axes.dial.sections.0.time", "s")
    # 0.2 s of 0.5 s.
    assert step["angle"] == pytest.approx(0.4 * 6.283185307)
    assert [section["dwells"] for section in shaft["sections"]] == [False, True, False, True]
    assert shaft["sections"][2]["address"] == "mechanism.cams.pusher.sections.2.angle"
    assert shaft["address"] == "mechanism.cams.pusher.phase"


def test_motor_and_bus_follow_while_a_section_is_held(tab: Tab) -> None:
    """Rms torque of the motor and peak of the bus in the answer to what is held are those of servo_axis."""
    tab.ask(ask="compute", text=CARRIAGE)
    held = {"axes.A.sections.0.angle": 2.6, "axes.A.sections.1.angle": 2 * 3.141592653589793 - 2.6}
    answer = tab.ask(ask="compute", held=True, set=held)
    found = {
        f"{result['name']}.{each['name']}": each["value"]
        for result in answer["results"]
        for each in result["scalars"]
    }
    machine = lw.loads(CARRIAGE, held)
    assert found["axis.motor.torque_rms"] == pytest.approx(lw.servo_axis(machine).motor.torque_rms, rel=1e-12)
    assert found["dc_bus.power_max"] == pytest.approx(lw.dc_bus(machine).power_max, rel=1e-12)


def test_an_axis_is_added_to_a_crank_and_gets_its_motor(tmp_path: Path) -> None:
    """An axis brings its cycle time; motors are typical, or the first of a catalogue in the folder."""
    text = added(EMPTY, "cranks", 1.0, "")
    text = added(text, "axes", 1.0, "")
    machine = lw.loads(text)
    assert list(machine.axes) == ["A1"]
    assert machine.design_speed == pytest.approx(6.283185307)
    assert lw.servo_axis(lw.loads(added(text, "servo motor", 1.0, ""))).axis.motor is not None
    with pytest.raises(lw.InputError, match="CSV file of servo motors"):
        added(text, "catalogue servo", 1.0, "", str(tmp_path / "m.toml"))
    (tmp_path / "list.csv").write_text("x, y\n1, 2\n")
    (tmp_path / "motors.csv").write_text(MOTORS)
    path = str(tmp_path / "m.toml")
    chosen = added(text, "catalogue servo", 1.0, "", path)
    motor = lw.loads(chosen, path=path).axes["A1"].motor
    assert motor is not None
    assert motor.type == "S1"
    # All types of the file can be chosen from.
    parts = [controls(tables_of(chosen), path)]
    entries = []
    for part in parts:
        parts += part["groups"]
        entries += part["entries"]
    (entry,) = (entry for entry in entries if entry["address"] == "axes.A1.motor.catalogue")
    assert (entry["holds"], entry["choices"]) == ("choice", ["S1", "S2"])
    with pytest.raises(lw.InputError, match="without an axis"):
        added(text, "axes", 1.0, "")


def test_a_driving_cylinder_is_drawn_with_its_boom() -> None:
    """A cylinder as long as it was drawn, and a bar from its eye: a boom that the cylinder lifts."""
    trunnion, eye, pivot = End(0.5, 0.0), End(0.8, 0.6), End(0.0, 0.0, "O")
    text, waits = drawn(EMPTY, [(trunnion, eye, "driving")], 0.0, 1e-3)
    assert "has one link" in waits
    text, waits = drawn(EMPTY, [(trunnion, eye, "driving"), (pivot, eye, "link")], 0.0, 1e-3)
    assert not waits
    machine = lw.loads(text)
    (cylinder,) = machine.mechanism.cylinders.values()
    assert cylinder.start_length == pytest.approx(0.671, abs=1e-3)
    assert lw.closure(machine).turns_fully
    (joint,) = machine.mechanism.joints
    assert {entry.split(".")[1] for entry in entries_of(machine, joint)} == {"bars", "cylinders"}


def test_a_passive_cylinder_is_drawn_between_two_points() -> None:
    """It holds no joint: where it begins in the plane is a point of the frame."""
    crank = [(End(0.0, 0.0, "O"), End(0.1, 0.0), "link"), (End(0.1, 0.0), End(0.4, 0.2), "link")]
    text, _ = drawn(EMPTY, [*crank, (End(0.4, 0.2), End(0.5, 0.0), "link")], 0.0, 1e-3)
    (joint,) = lw.loads(text).mechanism.joints
    text, waits = drawn(text, [(End(0.0, 0.5), End(0.4, 0.2, joint), "passive")], 0.0, 1e-3)
    assert not waits
    (cylinder,) = lw.loads(text).mechanism.cylinders.values()
    assert not cylinder.drives
    assert cylinder.end == joint


def test_a_boom_on_a_cylinder_is_added_and_moves() -> None:
    """The menu gives a cylinder that drives something at once."""
    machine = lw.loads(added(EMPTY, "driving cylinders", 1.0, ""))
    assert lw.closure(machine).turns_fully
