"""Servo motors and gearboxes of files: curves from rated points, errors with file and line."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import linkwright as lw
from linkwright.axes.model.axis_catalogue import read_gearboxes, read_servo_motors
from linkwright.kernel.errors import MachineFileError

RPM = np.pi / 30
USE = Path(__file__).parents[1] / "found" / "use"

HEAD = "type, inertia [kg cm^2], torque_rated [N m], speed_rated [rpm], torque_max [N m], speed_max [rpm]"
ROW = "A, 0.9, 2.4, 3000, 7.1, 6000"
CURVES = (
    "type, inertia [kg cm^2], speed_continuous [rpm], torque_continuous [N m], speed_peak [rpm], torque_peak"
)
CURVE = "A, 0.9, 0 3000 6000, 2.4; 2.3; 1.2, 0 3000 6000, 7.1 7.1 3"
GEARS = "type, ratio, efficiency [%], reverse, torque_max [N m], inertia [kg cm^2], cost"
GEAR = "P10, 10, 95, same, 60, 0.2, 340"


def stock(folder: Path, *lines: str) -> Path:
    path = folder / "stock.csv"
    path.write_text("\n".join(["# Prices of spring.", *lines]) + "\n", encoding="utf-8")
    return path


def test_a_catalogue_of_drives_has_servo_motors_too() -> None:
    """Level torques up to the rated speed; beyond it nothing is known."""
    motors = {each.type: each for each in read_servo_motors(USE / "motors.csv")}
    motor = motors["SV 750"].motor
    assert motors["SV 750"].power_rated == 750
    assert motor.peak is not None
    assert motor.continuous is not None
    assert motor.peak.speed == pytest.approx((0, 3000 * RPM))
    assert motor.peak.torque == pytest.approx((7.1, 7.1))
    assert motor.continuous.torque == pytest.approx((750 / (3000 * RPM),) * 2)
    assert motor.top_speed == pytest.approx(6000 * RPM)


def test_curves_from_points_of_a_data_sheet(tmp_path: Path) -> None:
    """Standstill, rated point and maximum speed; peak torque level up to its own speed."""
    more = ", torque_stall [N m], torque_speed_max [N m], speed_torque_max [rpm], torque_max_speed_max [N m]"
    path = stock(tmp_path, HEAD + more, ROW + ", 2.8, 1.1, 3500, 3")
    motor = read_servo_motors(path)[0].motor
    assert motor.continuous is not None
    assert motor.peak is not None
    assert motor.continuous.speed == pytest.approx([0, 3000 * RPM, 6000 * RPM])
    assert motor.continuous.torque == pytest.approx([2.8, 2.4, 1.1])
    assert motor.peak.speed == pytest.approx([0, 3500 * RPM, 6000 * RPM])
    assert motor.peak.torque == pytest.approx([7.1, 7.1, 3])
    whole = read_servo_motors(stock(tmp_path, CURVES + " [N m]", CURVE))[0].motor
    assert whole.continuous is not None
    assert whole.continuous.torque == pytest.approx([2.4, 2.3, 1.2])
    assert whole.top_speed == pytest.approx(6000 * RPM)


def test_gearboxes(tmp_path: Path) -> None:
    found = read_gearboxes(stock(tmp_path, GEARS, GEAR, "P20, 20, 92, , , ,"))
    assert [each.cost for each in found] == [340, None]
    first, second = (each.gearbox for each in found)
    assert (first.efficiency, first.reverse, first.torque_max) == (pytest.approx(0.95), "same", 60)
    assert first.inertia == pytest.approx(2e-5)
    assert (second.ratio, second.reverse, second.torque_max, second.inertia) == (20, None, None, 0)


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        ((HEAD, ROW.replace("7.1", "2.0")), r"stock.csv:3: catalogue, A: peak[^:]*found:[^:]*2 N m at 0"),
        ((HEAD.replace("inertia [kg cm^2]", "inertia [N m]"), ROW), r"stock.csv:3: [^\n]*column inertia"),
        ((HEAD.replace("[rpm], torque_max", "[1/min], torque_max"), ROW), "column speed_rated"),
        ((HEAD, ROW.replace("7.1", "7.1 N m")), r"the unit belongs in the header, \[N m\]"),
        ((HEAD.replace(", torque_max [N m]", ""), ROW.replace(", 7.1", "")), "A without torque_max"),
        ((HEAD.replace(", speed_max [rpm]", ""), ROW.replace(", 6000", "")), "A without speed_max"),
        ((HEAD.replace("torque_rated", "torque_rate"), ROW), 'did you mean "torque_rated"'),
        ((HEAD + ", torque_max [kg m]", ROW + ", 7"), "each column once"),
        ((HEAD, ROW, ROW), r"stock.csv:4: [^\n]*\n[^\n]*\n[^\n]*each type once"),
        ((HEAD, "A, 0.9"), "6 values"),
        ((HEAD + ", kind", ROW + ", induction"), "only servo motors follow a law"),
        ((CURVES + " [N m]", CURVE.replace("7.1 7.1 3", "7.1 7.1")), "peak.torque"),
        (
            (CURVES + " [N m]", CURVE.replace("7.1 7.1 3", "7.1 x 3")),
            r"stock.csv:3: [^:]*:[^:]*: a number in the column torque_peak",
        ),
        ((CURVES, CURVE.replace("7.1 7.1 3", "7.1 x 3")), "give the unit in the header"),
        ((CURVES + " [N m]", CURVE.replace("7.1 7.1 3", "3 7.1 7.1")), "at most 3 N m, the torque before it"),
        ((CURVES + " [N m]", CURVE.replace("0 3000 6000, 2.4", "0 6000 3000, 2.4")), "the value before it"),
        (
            (CURVES.replace("torque_continuous [N m], ", ""), CURVE.replace("2.4; 2.3; 1.2, ", "")),
            "a curve is",
        ),
    ],
)
def test_what_is_wrong_with_motors_is_told_with_its_line(
    lines: tuple[str, ...], said: str, tmp_path: Path
) -> None:
    with pytest.raises(MachineFileError, match=said):
        read_servo_motors(stock(tmp_path, *lines))


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        ((GEARS.replace(", efficiency [%]", ""), GEAR.replace(", 95", "")), "P10 without efficiency"),
        ((GEARS, GEAR.replace("same", "none")), '"same" or a number'),
        ((GEARS, GEAR.replace("same", "-1")), r"stock.csv:3: gearboxes, P10: reverse"),
        ((GEARS, GEAR.replace("95", "195")), "efficiency"),
        (
            (GEARS.replace("torque_max", "torque_rated") + ", torque_max [N m]", GEAR + ", 5"),
            "at least the rated",
        ),
    ],
)
def test_what_is_wrong_with_gearboxes_is_told_with_its_line(
    lines: tuple[str, ...], said: str, tmp_path: Path
) -> None:
    with pytest.raises(MachineFileError, match=said):
        read_gearboxes(stock(tmp_path, *lines))


MACHINE = """
format = 1
name = "axis"
[master]
cycle_time = "1 s"
[mechanism.cranks.A]
radius = 0.1
[axes.A]
sections = [{ swing = "90 deg", angle = "90 deg" }, { swing = "-90 deg", angle = "90 deg" }]
[axes.A.motor]
file = "stock.csv"
catalogue = "A"
"""


def test_an_axis_names_a_type_of_a_file(tmp_path: Path) -> None:
    """What the machine file says goes first."""
    stock(tmp_path, HEAD, ROW)
    (tmp_path / "machine.toml").write_text(MACHINE.replace('"A"\n', '"A"\nbrake_inertia = 1e-5\n'))
    motor = lw.read(tmp_path / "machine.toml").axes["A"].motor
    assert motor is not None
    assert (motor.type, motor.file) == ("A", None)
    assert motor.rotor == pytest.approx(0.9e-4 + 1e-5)
    (tmp_path / "machine.toml").write_text(MACHINE.replace('"A"\n', '"B"\n'))
    with pytest.raises(MachineFileError, match=r"machine.toml:\d+: axes.A.motor.catalogue"):
        lw.read(tmp_path / "machine.toml")


def test_a_motor_without_curves_is_refused(tmp_path: Path) -> None:
    """Each curve that is missing is named, with a line to write."""
    text = MACHINE.replace('file = "stock.csv"\ncatalogue = "A"', "inertia = 1e-4")
    (tmp_path / "machine.toml").write_text(text)
    with pytest.raises(MachineFileError) as caught:
        lw.read(tmp_path / "machine.toml")
    keys = [problem.key for problem in caught.value.problems]
    assert keys == ["axes.A.motor.continuous", "axes.A.motor.peak"]
    assert "torque = " in caught.value.problems[0].remedy
