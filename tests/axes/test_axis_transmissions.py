"""Axes behind a Scotch yoke and behind a parallelogram, against virtual work."""

from __future__ import annotations

import numpy as np
import pytest

import linkwright as lw

INCH, POUND = 0.0254, 4.4482216  # [m], [N]

# A bar of 150 lb, 34 × 2.5 in, ±45° in 450 ms, then 50 ms at rest, and back: pin of the slide at 30.57 in.
YOKE = """
format = 1
name = "Bar on a yoke"
[master]
cycle_time = "1 s"
[axes.slide]
[mechanism.points]
O = { y = "30.57 in" }
[mechanism.linear_drivers.slide]
law = """

# Parabolic from −1 to 1 over 0.9 π, at rest over 0.1 π, and back: v (2 − |v|).
RISE = "max(-1, min(1, (0.95*pi - abs(phi - 0.95*pi))/(0.45*pi) - 1))"


def test_a_bar_by_a_scotch_yoke() -> None:
    """J = 37.63 lb in s²; F = J α cos²θ/d is 38.2 lb at mid-stroke and half of that at 45°."""
    angle = f"pi/4*{RISE}*(2 - abs({RISE}))"
    inertia = 150 * 0.45359237 * (34**2 + 2.5**2) * INCH**2 / 12
    assert inertia == pytest.approx(37.63 * POUND * INCH, rel=2e-4)
    text = (
        f'{YOKE}"30.57*0.0254*tan({angle})"\n'
        + f"""
[mechanism.slotted_levers.bar]
pin = "slide"
pivot = "O"
[bodies.bar]
mass = "150 lb"
along = 0
inertia = {inertia}
"""
    )
    slide = lw.servo_axis(lw.loads(text))
    theta = np.arctan(slide.position / (30.57 * INCH))
    force = np.abs(slide.torque) / POUND
    moving = slide.time < 0.45 - 1e-6
    wanted = inertia * 4 * (np.pi / 2) / 0.45**2 * np.cos(theta) ** 2 / (30.57 * INCH) / POUND
    np.testing.assert_allclose(force[moving], wanted[moving], rtol=1e-5)
    assert force.max() == pytest.approx(38.2, abs=0.05)
    assert force[0] == pytest.approx(19.1, abs=0.03)
    still = (slide.time > 0.4501) & (slide.time < 0.4999)
    assert force[still].max() < 1e-9


# The motor of the second joint of an arm stands at the base and acts through a parallelogram.
ARM = """
format = 1
name = "Arm with a parallelogram"
[master]
cycle_time = "1 s"
[axes.A]
sections = [{ angle = "120 deg", swing = "40 deg" }, { angle = "120 deg", swing = "-40 deg" }]
[axes.B]
phase = "60 deg"
sections = [{ angle = "150 deg", swing = "-30 deg" }, { angle = "150 deg", swing = "30 deg" }]
[mechanism.cranks.A]
radius = "300 mm"
phase = "20 deg"
[mechanism.cranks.B]
radius = "100 mm"
phase = "120 deg"
[mechanism.joints.C]
x = "232 mm"
y = "189 mm"
[mechanism.bars]
forearm = { start = "A", end = "C", length = "100 mm" }
rod = { start = "B", end = "C", length = "300 mm" }
[loads.tool]
kind = "formula"
on = "forearm"
torque = "-1"
"""


def test_two_motors_through_a_parallelogram() -> None:
    """A torque of 1 at the forearm: joints τ₁ = τ_a1 + τ_a2 = 1 and τ₂ = τ_a2 = 1, motors 0 and 1."""
    machine = lw.loads(ARM)
    arm, base = (lw.servo_axis(machine, name) for name in "AB")
    np.testing.assert_allclose(arm.torque, 0.0, atol=1e-12)
    np.testing.assert_allclose(base.torque, 1.0, atol=1e-12)
    # Power by the joints: θ₁ is that of the arm, θ₂ that of the forearm beyond it.
    first, second = arm.velocity, base.velocity - arm.velocity
    power = (arm.torque + base.torque) * first + base.torque * second
    np.testing.assert_allclose(power, arm.power + base.power, atol=1e-12)
    assert lw.dc_bus(machine).power_residual < 1e-10
