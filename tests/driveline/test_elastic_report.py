"""What `linkwright elastic` and its report say of an elastic driveline."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from command_line import invoke
from scipy.integrate import solve_ivp

import linkwright as lw
from linkwright.machine import machine_parts

# A punch behind a coupling with backlash; a motor of 120 N m at standstill and 1000 rpm without load.
_FILE = """
format = 1
name = "Punch"
[drive]
speed = "90 rpm"
motor = { kind = "dc", speed_no_load = "1000 rpm", torque_stall = "120 N m", inertia = "0.05 kg m^2" }
gearbox = { ratio = 11, inertia = "0.03 kg m^2" }
crankshaft = { stiffness = "25 kN m/rad", damping = "60 N m s/rad", backlash = "1.2 deg" }
[mechanism.cranks.A]
radius = "60 mm"
[mechanism.sliders.ram]
crank = "A"
rod = "300 mm"
[bodies]
A = { inertia = "3 kg m^2" }
ram = { mass = "120 kg" }
[loads]
guide = { kind = "dry", on = "ram", force = "400 N" }
shaft = { kind = "viscous", on = "A", damping_torsional = 0 }
"""
_INERTIA, _RADIUS, _ROD, _MASS, _DRY = 0.08 * 11**2, 0.06, 0.3, 120.0, 400.0
_STIFFNESS, _DAMPING, _GAP = 25e3, 60.0, np.radians(1.2)


def _torque(twist: float, rate: float) -> float:
    spring = _STIFFNESS * max(abs(twist) - _GAP / 2, 0.0)
    return float(np.sign(twist) * (spring + np.clip(_DAMPING * rate * np.sign(twist), -spring, spring)))


def _rates(_: float, y: np.ndarray, drag: float) -> list[float]:
    """Of crank angle, its speed, twist of the coupling and its rate."""
    angle, speed, twist, rate = y
    s, c = np.sin(angle), np.cos(angle)
    root = np.sqrt(_ROD**2 - (_RADIUS * s) ** 2)
    x1 = -_RADIUS * s * (1 + _RADIUS * c / root)
    x2 = -_RADIUS * (c + _RADIUS * (c * c - s * s) / root + _RADIUS**3 * (s * c) ** 2 / root**3)
    torque = _torque(twist, rate)
    load = _DRY * abs(x1) + drag * speed + _MASS * x1 * x2 * speed**2
    crank = (torque - load) / (3.0 + _MASS * x1**2)
    motor = 120 * 11 * (1 - 11 * (speed + rate) * 30 / (np.pi * 1000))
    return [speed, crank, rate, (motor - torque) / _INERTIA - crank]


@pytest.mark.parametrize("drag", [0.0, 30.0])
def test_it_warns_that_flanks_part_where_an_integration_of_the_coupling_parts(
    tmp_path: Path, drag: float
) -> None:
    """The torque of DOP853 falls to zero in a cycle exactly where the command warns that flanks part."""
    course = solve_ivp(
        *(_rates, (0, 8), [0, 9.4, 0.012, 0], "DOP853"), rtol=1e-7, atol=1e-9, max_step=2e-3, args=(drag,)
    )
    late = course.t > 7
    lowest = min(_torque(twist, rate) for twist, rate in course.y[2:, late].T)
    (tmp_path / "punch.toml").write_text(_FILE)
    answer = invoke(
        "elastic", str(tmp_path / "punch.toml"), "--json", "--set", f"loads.shaft.damping_torsional={drag}"
    )
    found = json.loads(answer.stdout)
    warned = [text for text in found["warnings"] if "flanks of crankshaft part" in text]
    assert (lowest == 0) == bool(warned) == (drag == 0)
    assert found["results"]["elastic_motion"]["torque_min"]["crankshaft"] == pytest.approx(lowest, abs=0.2)


def test_a_report_has_the_data_of_the_flexible_shaft_and_calls_it_not_rigid(tmp_path: Path) -> None:
    """Stiffness and backlash of the file are among the data; a rigid driveline has rigid shafts."""
    machine = lw.loads(_FILE)
    (shaft,) = (part for part in machine_parts(machine) if part.name == "crankshaft")
    data = {entry.word: entry.value for entry in shaft.entries}
    assert (data["stiffness"], data["backlash"]) == ("25000 N m/rad", "1.2°")
    (tmp_path / "punch.toml").write_text(_FILE)
    said = {}
    for language in ("en", "uk"):
        page = tmp_path / f"{language}.html"
        invoke("report", "--to", str(page), "--lang", language, "elastic", str(tmp_path / "punch.toml"))
        said[language] = page.read_text()
    assert "Links are rigid" in said["en"]
    assert "shafts are rigid" not in said["en"]
    assert "Elastic driveline" in said["en"]
    assert "Elastic driveline" not in said["uk"]
