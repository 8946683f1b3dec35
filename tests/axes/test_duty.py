"""What an axis asks of its motor: closed forms of torque, power and energy, and the checks."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from axis_cycles import ACCELERATION_RMS, PERIOD, RISE, SPEED_MEAN, SPEED_PEAK, inertia_cycle, motion

import linkwright as lw
from linkwright.axes.axis import servo_axis
from linkwright.axes.driver_cycle import DriverCycle, integration_weights
from linkwright.axes.duty import motor_duty
from linkwright.axes.model.axis_gearbox import AxisGearbox
from linkwright.axes.model.servo_motor import ServoMotor
from linkwright.kernel.check import Check

MOTOR: dict[str, Any] = {
    "inertia": "0.9 kg cm^2",
    "continuous": {"speed": "0, 3000, 6000 rpm", "torque": "2.4, 2.3, 1.2 N m"},
    "peak": {"speed": "0, 3000, 6000 rpm", "torque": "7.1, 7.1, 3 N m"},
}


def motor(**entries: Any) -> ServoMotor:
    return ServoMotor.model_validate(MOTOR | entries)


def check(checks: tuple[Check, ...], name: str) -> Check:
    return next(check for check in checks if check.name == name)


def test_a_pure_inertia_at_its_best_ratio() -> None:
    """M_rms = 2 √(J_M J_L) ω̇_rms at i = √(J_L/J_M), over the whole cycle with its dwells."""
    load, rotor = 0.02, 0.9e-4
    duty = motor_duty(inertia_cycle(load), motor(), AxisGearbox(ratio=math.sqrt(load / rotor)))
    assert duty.torque_rms == pytest.approx(2 * math.sqrt(load * rotor) * ACCELERATION_RMS, rel=1e-9)
    assert duty.inertia_ratio == pytest.approx(1, rel=1e-12)
    assert duty.speed_mean == pytest.approx(SPEED_MEAN * math.sqrt(load / rotor), rel=1e-9)
    assert duty.passes


def test_energy_that_an_inertia_gives_back_is_that_of_its_motion() -> None:
    """Each of two rises gives ½ J ω² back."""
    ratio = 10.0
    duty = motor_duty(inertia_cycle(0.02), motor(), AxisGearbox(ratio=ratio))
    energy = 2 * 0.5 * (0.02 + 0.9e-4 * ratio**2) * SPEED_PEAK**2
    assert duty.energy_regenerated == pytest.approx(energy, rel=1e-8)
    assert duty.power_braking_mean == pytest.approx(energy / PERIOD, rel=1e-8)


@pytest.mark.parametrize(
    ("reverse", "back"), [(None, 0.8), ("same", 1 / 0.8), (0.5, 2.0), (0, 0.0), (1e9, 1e-9)]
)
def test_losses_go_the_way_of_the_power(reverse: object, back: float) -> None:
    """A weight of constant torque: lifted by 1/η, lowered by the factor of the way back, held at rest.

    A self-locking gearbox holds it.
    """
    weight, ratio = 3.0, 5.0
    time, speed, acceleration = motion()
    cycle = DriverCycle(time, speed, acceleration, np.full_like(time, weight))
    gearbox = AxisGearbox.model_validate({"ratio": ratio, "efficiency": 0.8, "reverse": reverse})
    duty = motor_duty(cycle, motor(inertia=0.0), gearbox)
    held = 0.0 if reverse == 0 else 1.0
    squares = RISE * (1 / 0.8**2 + back**2) + (PERIOD - 2 * RISE) * held**2
    assert duty.torque_rms == pytest.approx(weight / ratio * math.sqrt(squares / PERIOD), rel=1e-12)


def test_where_the_power_changes_its_sign_between_samples_the_piece_is_divided() -> None:
    """An inertia behind lossy gears: losses jump where the deceleration begins, wherever samples lie."""
    values = []
    for n in (360, 361, 400):
        time, speed, acceleration = motion(n)
        cycle = DriverCycle(time, speed, acceleration, 0.02 * acceleration)
        values.append(motor_duty(cycle, motor(inertia=0.0), AxisGearbox(efficiency=0.5)).torque_rms)
    exact = 0.02 * ACCELERATION_RMS * math.sqrt((1 / 0.5**2 + 0.5**2) / 2)
    assert values == pytest.approx([exact] * 3, rel=3e-6)


def test_weights_integrate_cubics_of_each_piece_exactly() -> None:
    """Jumps between pieces and uneven samples do not matter."""
    time = np.array([0, 0.1, 0.15, 0.4, 0.5, 0.5, 0.7, 1.0, 1.0, 1.3, 1.3, 1.35, 1.4, 1.9])
    cubic = np.polynomial.Polynomial([1.0, -2.0, 0.5, 3.0])
    whole = integration_weights(time)
    first, last = time[:5], time[10:]
    assert whole[:5] @ cubic(first) == pytest.approx(cubic.integ()(0.5) - cubic.integ()(0), rel=1e-13)
    assert whole[10:] @ cubic(last) == pytest.approx(cubic.integ()(1.9) - cubic.integ()(1.3), rel=1e-13)
    assert whole[5:8] @ time[5:8] ** 2 == pytest.approx((1 - 0.5**3) / 3, rel=1e-13)
    assert whole.sum() == pytest.approx(1.9, rel=1e-14)


def test_a_belt_drive_referred_to_its_motor() -> None:
    """50 kg on a pulley of 120 mm, i = 20: 4.5 kg cm² at the motor; friction 0.882, start 0.375 N m."""
    mass, friction, rate = 50.0, 0.6 * 50 * 9.8, 0.5 / 0.2
    time, velocity = np.array([0, 0.1, 0.2]), np.array([0, 0.25, 0.5])
    pulley = math.pi * 0.12
    for force, torque in ((friction, 0.882), (mass * rate, 0.375)):
        cycle = DriverCycle.of_line(time, velocity, np.full(3, rate), np.full(3, force), pulley, mass)
        duty = motor_duty(cycle, motor(inertia=0.0), AxisGearbox(ratio=20))
        assert duty.torque_peak == pytest.approx(torque, rel=1e-9)
        assert duty.speed_peak == pytest.approx(20 * 0.5 / 0.06, rel=1e-12)
    assert cycle.inertia == pytest.approx(4.5e-4 * 20**2, rel=1e-12)
    ratio = motor_duty(cycle, motor(inertia=1.5e-4), AxisGearbox(ratio=20)).inertia_ratio
    assert ratio == pytest.approx(3.0, rel=1e-12)


def test_the_whole_loop_stands_against_the_peak_curve() -> None:
    """A motor whose peak torque falls fails at speed while its largest torque, lower down, would do."""
    cycle = inertia_cycle(0.02)
    gearbox = AxisGearbox(ratio=15)
    peak = motor_duty(cycle, motor(), gearbox).torque_peak
    falling = {"speed": "0, 1000, 6000 rpm", "torque": [1.01 * peak, 1.01 * peak, 0.02 * peak]}
    continuous = {"speed": "0, 6000 rpm", "torque": [0.02 * peak, 0.02 * peak]}
    found = check(
        motor_duty(cycle, motor(peak=falling, continuous=continuous), gearbox).checks, "torque_peak"
    )
    assert found.passed is False
    level = {"speed": "0, 6000 rpm", "torque": [1.01 * peak, 1.01 * peak]}
    found = check(motor_duty(cycle, motor(peak=level, continuous=continuous), gearbox).checks, "torque_peak")
    assert found.passed
    assert found.utilisation == pytest.approx(1 / 1.01, rel=1e-9)


@pytest.mark.parametrize("name", ["torque_rms", "torque_peak", "inertia_ratio"])
def test_what_is_not_known_does_not_pass(name: str) -> None:
    """A curve that ends below the speeds, or an unknown inertia, is reported; the motor does not pass."""
    cycle, short = inertia_cycle(0.02), {"speed": "0, 300 rpm", "torque": "2, 2 N m"}
    parts = {"torque_rms": {"continuous": short}, "torque_peak": {"peak": short | {"torque": "7, 7 N m"}}}
    if name == "inertia_ratio":
        cycle = replace(cycle, inertia=None)
    duty = motor_duty(cycle, motor(**parts.get(name, {}), speed_max="6000 rpm"), AxisGearbox(ratio=15))
    found = check(duty.checks, name)
    assert found.passed is None
    assert "not determined" in found.words
    assert not duty.passes
    assert [each.name for each in duty.failed] == [name]


def test_limits_of_gearbox_and_resistor() -> None:
    """Torques at the output, speed at the input, and what a resistor converts to heat."""
    cycle = inertia_cycle(0.02)
    bare = motor_duty(cycle, motor(), AxisGearbox(ratio=15))
    resistor = (0.5 * bare.power_braking_mean, 2 * bare.power_braking_peak)
    gearbox = AxisGearbox.model_validate({"ratio": 15, "torque_max": 1, "torque_rated": 0.5, "speed_max": 1})
    duty = motor_duty(cycle, motor(), gearbox, resistor=resistor)
    values = {each.name: each.value for each in duty.checks}
    assert values["gearbox_torque_rms"] == pytest.approx(0.02 * ACCELERATION_RMS, rel=1e-9)
    assert values["gearbox_speed"] == pytest.approx(15 * SPEED_PEAK, rel=1e-6)
    failed = {each.name for each in duty.failed}
    assert failed == {"gearbox_torque_peak", "gearbox_torque_rms", "gearbox_speed", "resistor_power_mean"}


CARRIAGE = """
format = 1
name = "carriage by a servo"
[master]
cycle_time = "1 s"
[axes.A]
gearbox = { ratio = 10, efficiency = "92 %", inertia = "5e-5 kg m^2" }
motor = { file = "motors.csv", catalogue = "SV 750" }
[mechanism.cranks.A]
radius = "120 mm"
law = "where(phi < pi, h*(phi/pi - sin(2*phi)/(2*pi)), h*(1 - (phi - pi)/pi + sin(2*(phi - pi))/(2*pi)))"
constants = { h = "180 deg" }
[mechanism.sliders.carriage]
crank = "A"
rod = "400 mm"
[bodies]
carriage = { mass = "12 kg" }
"carriage.rod" = { mass = "1.5 kg" }
A = { mass = "2 kg" }
[loads]
guide = { kind = "dry", on = "carriage", force = "40 N" }
"""


def test_a_carriage_by_a_servo_is_what_energy_says() -> None:
    """The motor's torque from the change of kinetic energy by central differences, losses by the power."""
    folder = Path(__file__).parents[1] / "found" / "use"
    machine = lw.loads(CARRIAGE, path=str(folder / "axis.toml"))
    duty = servo_axis(machine).motor
    t = np.linspace(0, 1, 100001)
    phi, h, r, rod = 2 * np.pi * t, np.pi, 0.12, 0.4
    out = h * (phi / np.pi - np.sin(2 * phi) / (2 * np.pi))
    psi = np.where(phi < np.pi, out, 2 * h - out)

    def rate(values: np.ndarray) -> np.ndarray:
        return np.gradient(values, t[1], edge_order=2)

    x, y = r * np.cos(psi), r * np.sin(psi)
    slide = x + np.sqrt(rod**2 - y**2)
    omega = rate(psi)
    energy = 0.5 * 12 * rate(slide) ** 2
    energy += 0.5 * 1.5 * (rate(0.5 * (x + slide)) ** 2 + rate(0.5 * y) ** 2)
    energy += 0.5 * 1.5 * rod**2 / 12 * rate(np.arcsin(y / rod)) ** 2 + 0.5 * 2 * r**2 / 3 * omega**2
    moves = np.abs(omega) > 1e-3
    torque = (rate(energy) + 40 * np.abs(rate(slide)))[moves] / omega[moves]
    losses = np.where(torque * omega[moves] > 0, 1 / 0.92, 0.92)
    motor = 10 * (9e-5 + 5e-5) * rate(omega)[moves] + torque / 10 * losses
    assert duty.torque_peak == pytest.approx(np.max(np.abs(motor)), rel=1e-4)
    assert duty.torque_rms == pytest.approx(np.sqrt(np.sum(motor**2) / len(t)), rel=1e-4)
    assert duty.speed_peak == pytest.approx(10 * 2 * 2 * np.pi, rel=1e-6)
    assert duty.torque_peak == pytest.approx(2.904, abs=1e-3)
