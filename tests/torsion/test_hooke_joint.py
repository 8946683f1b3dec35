"""Hooke's joints by their angle: the uneven ratio, its excitation, and the motion that it makes."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import linkwright as lw
from linkwright import MachineError, campbell, forced_vibration, torsion_study
from linkwright.torsion.model.train import Shaft

J1, J2, J3, K, C, FIXED = 0.8, 0.3, 1.5, 9000.0, 2.0, 4e4


def machine(angle: float, phase: float = 0.0, **train: Any) -> lw.Machine:
    entries = {
        "discs": {"motor": {"inertia": J1}, "tube": {"inertia": J2}, "axle": {"inertia": J3}},
        "shafts": {
            "cardan": {
                "between": ["motor", "tube"],
                "stiffness": K,
                "damping": C,
                "joint_angle": angle,
                "joint_phase": phase,
            },
            "rear": {"between": ["tube", "axle"], "stiffness": FIXED, "damping": 1.0},
        },
        "loads": {"road": {"on": "axle", "torque": 300.0, "speed": 100.0, "exponent": 0.0}},
        "run": {"speed_min": 30.0, "speed_max": 150.0, "points": 13},
    }
    return lw.Machine.model_validate({"format": 1, "name": "cardan", "train": {**entries, **train}})


@pytest.mark.parametrize("degrees", [3.0, 15.0, 40.0])
def test_series_of_the_joint(degrees: float) -> None:
    """The harmonics of a joint add up to arctan(tan φ/cos α) − φ."""
    angle = math.radians(degrees)
    sizes = Shaft(between=("a", "b"), stiffness=1.0, joint_angle=angle).joint_harmonics
    phi = np.linspace(0.0, 2 * np.pi, 101)
    ahead = sum(size * np.sin(2 * k * phi) for k, size in enumerate(sizes, start=1))
    exact = np.angle(np.exp(1j * (np.arctan2(np.sin(phi), np.cos(phi) * math.cos(angle)) - phi)))
    assert ahead == pytest.approx(exact, abs=2e-6)


def test_joint_shakes_both_discs() -> None:
    """Three discs with a shaft that is driven ahead by e(φ): M = k(Δ + e), and M(1 + e′) before the joint."""
    angle, phase = math.radians(12.0), 0.4
    forced = forced_vibration(machine(angle, phase))
    t = math.tan(angle / 2) ** 2
    assert forced.orders[:2] == pytest.approx([2.0, 4.0])
    for n, speed in enumerate(forced.speeds.tolist()):
        for k in (1, 2):
            omega = 2 * k * speed
            e = -1j * t**k / k * np.exp(2j * k * phase)
            k1, k2 = K + 1j * omega * C, FIXED + 1j * omega
            A = np.array([[k1, -k1, 0], [-k1, k1 + k2, -k2], [0, -k2, k2]]) - omega**2 * np.diag([J1, J2, J3])
            theta = np.linalg.solve(A, [-k1 * e - 300.0 * 2j * k * e, k1 * e, 0])
            assert forced.amplitudes[k - 1, :, n] == pytest.approx(theta, rel=1e-9)
            torque = k1 * (theta[0] - theta[1] + e)
            assert forced.shaft_torques[k - 1, 0, n] == pytest.approx(torque, rel=1e-8)
    assert forced.power == pytest.approx(forced.shaft_heat.sum(axis=0), rel=1e-8)


def test_motion_with_the_true_joint() -> None:
    """A small angle: the steady vibration of the joint's own equations, integrated, is the linear one."""
    angle, speed, torque = math.radians(4.0), 70.0, 300.0

    def rates(_: float, y: Any) -> list[float]:
        a, b, c, u, v, w = y
        cos = math.cos(angle)
        wave = np.angle(np.exp(1j * (math.atan2(math.sin(a), math.cos(a) * cos) - a)))
        ratio = cos / (cos**2 * math.cos(a) ** 2 + math.sin(a) ** 2)
        M = K * (a + wave - b) + C * (ratio * u - v)
        N = FIXED * (b - c) + (v - w)
        # A weak governor holds the mean speed.
        drive = torque - 0.02 * (u - speed)
        return [u, v, w, (drive - M * ratio) / J1, (M - N) / J2, (N - torque) / J3]

    start = [0.0, -torque / K, -torque / K - torque / FIXED, speed, speed, speed]
    period = 2 * np.pi / speed
    until = 4.0 + 12 * period
    solved = solve_ivp(rates, (0, until), start, method="DOP853", rtol=1e-9, atol=1e-10, dense_output=True)
    assert solved.sol is not None
    time = np.linspace(until - 10 * period, until, 4001)
    a, b, *_ = solved.sol(time)
    forced = forced_vibration(machine(angle), np.array([speed]))
    twist = a - b
    # By the angle of the motor, whose mean speed is that of the run.
    basis = np.column_stack([np.ones_like(a), np.cos(2 * a), np.sin(2 * a), np.cos(4 * a), np.sin(4 * a)])
    found = np.linalg.lstsq(basis, twist, rcond=None)[0]
    linear = forced.amplitudes[0, 0, 0] - forced.amplitudes[0, 1, 0]
    assert complex(found[1], -found[2]) == pytest.approx(linear, rel=1e-2)


def test_critical_speed_is_half_the_natural_frequency() -> None:
    """Order 2 meets the natural frequencies at ω/2, and the study with all tables is made."""
    train = machine(math.radians(10.0), run={"speed_min": 20.0, "speed_max": 200.0})
    free = lw.free_vibration(train).angular_frequencies
    critical = [one for one in campbell(train).critical if one.order == 2.0]
    expected = [omega / 2 for omega in free if 20.0 < omega / 2 < 200.0]
    assert [one.speed for one in critical] == pytest.approx(expected, rel=1e-12)
    assert all(one.vector_sum for one in critical)
    assert torsion_study(train).forced is not None


def test_what_is_wrong_is_told() -> None:
    """A joint at the ground, and a phase without a joint."""
    shaft = {"between": ["motor", "ground"], "stiffness": 1e4, "joint_angle": 0.1}
    with pytest.raises(MachineError, match="two discs, with a joint"):
        machine(0.1, shafts={"s": shaft})
    with pytest.raises(MachineError, match="the angle of the joint"):
        machine(0.1, shafts={"s": {"between": ["motor", "tube"], "stiffness": 1.0, "joint_phase": 0.1}})
