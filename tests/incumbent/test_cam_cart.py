"""A cart driven by a cam, with an induction motor, against SciPy's DOP853 on a model written by hand.

The model shares nothing with the package: the law of the cart from its formulas, speed as the state over time
for the run-up and energy over the angle for steady motion, from one joint of the law to the next. The cart is
closed by two followers on a cam of constant diameter, so that it is pushed both ways.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import linkwright as lw

TURN = 2 * np.pi
H, MASS, ROLL, GRAVITY, TILT = 0.15, 400.0, 900.0, 9.81, 0.1
RATIO, INERTIA = 20.0, 0.4
SYNCHRONOUS, AT_BREAKDOWN, BREAKDOWN = 104.72, 90.0, 60.0

# DOP853 at 1e-11 a step leaves about 1e-9 in the speed.
RTOL, AGREES = 1e-11, 1e-7

MACHINE = f"""
format = 1
name = "Cart driven by a cam"
[drive.motor]
kind = "induction"
speed_synchronous = {SYNCHRONOUS}
speed_breakdown = {AT_BREAKDOWN}
torque_breakdown = {BREAKDOWN}
inertia = {INERTIA}
[drive.gearbox]
ratio = {RATIO}
efficiency = 0.9
[mechanism.cams.cart]
contact = "roller"
closure = "constant_diameter"
base_radius = 0.2
roller_radius = 0.03
direction = {TILT}
sections = [
  {{ angle = "180 deg", lift = {H}, law = "modified_sine" }},
  {{ angle = "180 deg", lift = {-H}, law = "modified_sine" }},
]
[bodies]
cart = {{ mass = {MASS} }}
[loads]
roll = {{ kind = "dry", on = "cart", force = {ROLL} }}
gravity = {{ kind = "gravity", acceleration = {GRAVITY} }}
"""

JOINTS = [k * np.pi / 8 for k in (0, 1, 7, 8, 9, 15, 16)]


def modified_sine(z: float) -> tuple[float, float]:
    """s′ and s″ of the law over z from 0 to 1; Norton, section 3.4."""
    c = np.pi / (4 + np.pi)
    if 1 / 8 <= z <= 7 / 8:
        x = 4 * np.pi * z / 3 + np.pi / 3
        return c * (1 - 3 * np.cos(x)), 4 * np.pi * c * np.sin(x)
    x = 4 * np.pi * z
    return c * (1 - np.cos(x)), 4 * np.pi * c * np.sin(x)


def slopes(phi: float) -> tuple[float, float]:
    there = phi % TURN
    sign = 1.0 if there < np.pi else -1.0
    v, a = modified_sine((there % np.pi) / np.pi)
    return sign * H / np.pi * v, sign * H / np.pi**2 * a


def resisting(s1: float) -> float:
    return ROLL * abs(s1) + MASS * GRAVITY * np.sin(TILT) * s1


def drive(omega: float) -> float:
    s, s_k = 1 - RATIO * omega / SYNCHRONOUS, 1 - AT_BREAKDOWN / SYNCHRONOUS
    M = 2 * BREAKDOWN * s * s_k / (s * s + s_k * s_k)
    return M * RATIO * (0.9 if M >= 0 else 1 / 0.9)


def inertia(s1: float) -> float:
    return INERTIA * RATIO**2 + MASS * s1**2


def over_angle(phi: float, y: np.ndarray) -> list[float]:
    """dE/dφ and dt/dφ."""
    s1, _ = slopes(phi)
    omega = np.sqrt(2 * y[0] / inertia(s1))
    return [drive(omega) - resisting(s1), 1 / omega]


def turn(start: float) -> tuple[np.ndarray, list]:
    """Energy and time after a revolution, and its pieces."""
    y, pieces = np.array([start, 0.0]), []
    for low, high in pairwise(JOINTS):
        # The law's own formula must be taken inside the piece, also at its end.
        done = solve_ivp(over_angle, (low, high), y, "DOP853", rtol=RTOL, atol=1e-12, dense_output=True)
        y = done.y[:, -1]
        pieces.append((low, high, done.sol))
    return y, pieces


def test_steady_motion_of_a_cart_driven_by_a_cam() -> None:
    J0 = inertia(0.0)
    top = SYNCHRONOUS / RATIO
    low, high = (np.log(0.5 * J0 * (share * top) ** 2) for share in (0.9, 1.02))
    E = np.exp(brentq(lambda e: np.log(turn(np.exp(e))[0][0]) - e, low, high, xtol=1e-13, rtol=1e-14))
    end, pieces = turn(E)
    found = lw.steady_state(lw.loads(MACHINE), accuracy=1e-11)
    assert found.period == pytest.approx(end[1], rel=AGREES)
    speeds = [
        np.sqrt(2 * sol(phi)[0] / inertia(slopes(phi)[0]))
        for a, b, sol in pieces
        for phi in np.linspace(a, b, 2001)
    ]
    # Samples 1e-3 rad apart miss a flat extreme by some 1e-8 of it.
    assert found.speed_max == pytest.approx(max(speeds), rel=2e-7)
    assert found.speed_min == pytest.approx(min(speeds), rel=2e-7)
    # Work of friction and weight in a revolution: the weight gives back what it takes.
    assert found.energy_load == pytest.approx(2 * H * ROLL, rel=1e-9)
    assert found.energy_drive == pytest.approx(found.energy_load, rel=1e-9)


def test_run_up_of_a_cart_driven_by_a_cam() -> None:
    """Speed over time from rest, as J ε + ½ J′ ω² = M_d − M_r says."""

    def rates(_: float, y: np.ndarray) -> list[float]:
        phi, omega = y
        s1, s2 = slopes(phi)
        torque = drive(omega) - resisting(s1) - MASS * s1 * s2 * omega**2
        return [omega, torque / inertia(s1)]

    span = 3.0
    # Steps must not pass the joints unseen: jumps of s‴ cost accuracy, not more.
    done = solve_ivp(rates, (0, span), [0.0, 1e-9], "DOP853", rtol=1e-11, atol=1e-12, max_step=5e-3)
    found = lw.transient(lw.loads(MACHINE), duration=span, accuracy=1e-11)
    assert found.time[-1] == pytest.approx(span, rel=1e-12)
    assert found.crank_angle[-1] == pytest.approx(done.y[0, -1], rel=1e-7)
    assert found.speed[-1] == pytest.approx(done.y[1, -1], rel=1e-7)
    half = lw.transient(lw.loads(MACHINE), duration=0.4, accuracy=1e-11)
    early = solve_ivp(rates, (0, 0.4), [0.0, 1e-9], "DOP853", rtol=1e-11, atol=1e-12, max_step=5e-3)
    assert half.crank_angle[-1] == pytest.approx(early.y[0, -1], rel=1e-6)
    assert half.speed[-1] == pytest.approx(early.y[1, -1], rel=1e-6)


def test_energy_balance_of_the_run_up() -> None:
    """Work of the motor less that of the loads is the kinetic energy, at each instant."""
    m = lw.loads(MACHINE)
    found = lw.transient(m, duration=2.0, accuracy=1e-11)
    phi, omega, epsilon, h = found.crank_angle, found.speed, found.acceleration, np.diff(found.time)
    s1 = np.array([slopes(x)[0] for x in phi])
    kinetic = 0.5 * (INERTIA * RATIO**2 + MASS * s1**2) * omega**2

    def power(angles: np.ndarray, speeds: np.ndarray) -> np.ndarray:
        both = zip(angles, speeds, strict=True)
        return np.array([(drive(w) - resisting(slopes(x)[0])) * w for x, w in both])

    # Simpson's rule, in the middle of steps by Hermite's cubics.
    middle = (
        0.5 * (phi[1:] + phi[:-1]) - h / 8 * np.diff(omega),
        0.5 * (omega[1:] + omega[:-1]) - h / 8 * np.diff(epsilon),
    )
    ends = power(phi, omega)
    gained = h / 6 * (ends[1:] + ends[:-1] + 4 * power(*middle))
    work = np.concatenate(([0.0], np.cumsum(gained)))
    # Steps of some 0.05 s: their fourth power over that of the time in which the motion changes, 0.3 s.
    assert np.abs(work - kinetic).max() < 2e-4 * kinetic.max()


def test_forces_in_steady_motion_balance() -> None:
    m = lw.loads(MACHINE)
    steady = lw.steady_state(m, accuracy=1e-11)
    found = lw.forces(m, steady)
    assert np.abs(found.power_residual).max() < 1e-9 * np.abs(found.power_drive).max()
    phi = np.mod(found.crank_angle, TURN)
    s1, s2 = np.array([slopes(x) for x in phi]).T
    way = MASS * (s2 * found.speed**2 + s1 * found.acceleration) + MASS * GRAVITY * np.sin(TILT)
    way = way + ROLL * np.sign(s1)
    # Of constant diameter: the roller that pushes is the one that the force says.
    moving = np.abs(s1) > 1e-3
    assert (np.sign(found.drives["cart"][moving]) == np.sign(way[moving])).all()
    torque = way * s1
    drive_torque = found.torque_drive - INERTIA * RATIO**2 * found.acceleration
    np.testing.assert_allclose(drive_torque, torque, atol=1e-8 * np.abs(torque).max())
