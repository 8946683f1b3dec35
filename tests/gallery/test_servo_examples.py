"""Examples of servo axes against closed forms, Newton and Euler, and virtual work."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import linkwright as lw
from linkwright.kernel.arrays import Floats

EXAMPLES = Path(__file__).parents[2] / "examples"


def machine_of(name: str) -> lw.Machine:
    return lw.read(EXAMPLES / name / "machine.toml")


def dot(a: np.ndarray, b: np.ndarray) -> Floats:
    """Scalar product of vectors as complex numbers."""
    product: Floats = (np.conj(a) * b).real
    return product


def test_a_five_bar_has_its_inverse_kinematics_and_virtual_work() -> None:
    """Crank angles from the place of the tool; torque m (a + g) · ∂r/∂q, with bars of constant length."""
    machine = machine_of("five_bar_two_motors")
    crank, bar, base, mass, gravity = 0.2, 0.35, 0.3, 4.0, 9.81j
    one, other = (lw.servo_axis(machine, name) for name in "AB")
    tool = lw.kinematics(machine, one.crank_angle).points["J"].position @ [1, 1j]
    reach = (tool, tool - base)
    elbows = [np.arccos((crank**2 + abs(r) ** 2 - bar**2) / (2 * crank * abs(r))) for r in reach]
    np.testing.assert_allclose(one.position, np.angle(reach[0]) + elbows[0], atol=1e-11)
    np.testing.assert_allclose(other.position, np.angle(reach[1]) - elbows[1], atol=1e-11)

    arms = [1j * crank * np.exp(1j * axis.position) for axis in (one, other)]
    left, right = reach[0] + 1j * arms[0], reach[1] + 1j * arms[1]

    def with_products(s: object, t: object) -> np.ndarray:
        """The vector whose products with both bars are given."""
        vector: np.ndarray = 1j * (t * left - s * right) / (left.conj() * right).imag
        return vector

    slopes = with_products(dot(left, arms[0]), 0.0), with_products(0.0, dot(right, arms[1]))
    velocity = slopes[0] * one.velocity + slopes[1] * other.velocity
    bends = []
    for link, arm, axis in ((left, arms[0], one), (right, arms[1], other)):
        pin = arm * axis.acceleration + 1j * arm * axis.velocity**2
        bends.append(dot(link, pin) - abs(velocity - arm * axis.velocity) ** 2)
    acceleration = with_products(*bends)
    for axis, slope in zip((one, other), slopes, strict=True):
        work = mass * dot(acceleration + gravity, slope)
        np.testing.assert_allclose(axis.torque, work, atol=1e-7)
    # The power of the master's own torque is that of both motors.
    summed = lw.forces(machine, speed=2 * np.pi / 0.8, angles=one.crank_angle[100:101])
    both = sum(axis.torque[100] * axis.velocity[100] for axis in (one, other))
    assert summed.torque_drive[0] * 2 * np.pi / 0.8 == pytest.approx(both, rel=1e-9)


def test_a_dial_indexes_by_a_cycloidal_law() -> None:
    """J 2π h/t² at the dial; at the motor by ratio, losses and rotor; mean power is what the gears lose."""
    machine = machine_of("indexing_dial")
    inertia, step, time, rotor, ratio, efficiency = 0.8, np.pi / 3, 0.5 / 3, 9.5e-4, 20, 0.94
    dial, peak = lw.servo_axis(machine, "dial"), 2 * np.pi * step / time**2
    assert dial.torque_max == pytest.approx(inertia * peak, rel=1e-9)
    driving = inertia / (ratio * efficiency) + rotor * ratio
    braking = inertia * efficiency / ratio + rotor * ratio
    assert dial.motor.torque_peak == pytest.approx(driving * peak, rel=1e-9)
    # A sine, half of it driving, in a third of the cycle.
    square = peak**2 / 2 * (driving**2 + braking**2) / 2 / 3
    assert dial.motor.torque_rms == pytest.approx(np.sqrt(square), rel=1e-6)
    bus = lw.dc_bus(machine)
    lost = 0.5 * inertia * (2 * step / time) ** 2 * (1 / efficiency - efficiency)
    assert bus.power_mean == pytest.approx(lost / 0.5, rel=1e-4)
    assert bus.power_residual < 1e-10


def test_pusher_and_jaw_follow_their_laws_after_the_dial() -> None:
    """v = C_v h/β ω and a = C_a h/β² ω² of modified sine and trapezoid; both stand while the dial moves."""
    machine, omega = machine_of("indexing_dial"), 4 * np.pi
    tracks = {track.driver: track for track in lw.timing(machine)}
    for name, lift, angle, law in (("pusher", 0.07, 80, (1.7596, 5.528)), ("jaw", 0.025, 60, (2.0, 4.888))):
        track, width = tracks[name], np.radians(angle)
        assert np.ptp(track.position) == pytest.approx(lift, rel=1e-9)
        assert track.velocity.max() == pytest.approx(law[0] * lift / width * omega, rel=1e-3)
        assert track.acceleration.max() == pytest.approx(law[1] * lift / width**2 * omega**2, rel=1e-3)
        still = tracks["dial"].velocity > 1e-9
        assert not np.abs(track.velocity[still]).max() > 1e-9
    assert tracks["pusher"].unit_of("torque") == "N m"


def _rise(u: Floats) -> Floats:
    """The polynomial 3-4-5 with two derivatives by u, (3, n)."""
    return np.array(
        [u**3 * (10 - 15 * u + 6 * u**2), 30 * u**2 * (1 - u) ** 2, 60 * u * (1 - u) * (1 - 2 * u)]
    )


def test_a_flying_shear_by_virtual_work() -> None:
    """Polynomials 3-4-5 over the motion of the strip; F = m a + M (a_K + g) · ∂r_K/∂x for each carriage."""
    machine = machine_of("flying_shear")
    rear, front = lw.servo_axis(machine, "rear"), lw.servo_axis(machine, "front")
    # Along with the strip: x = v t ± h p, both carriages.
    inside = (rear.time > 0.25 + 1e-6) & (rear.time < 0.5 - 1e-6)
    time = rear.time[inside] - 0.25
    down = time < 0.125
    u = np.where(down, time, time - 0.125) / 0.125
    part = np.where(down, 1.0, -1.0) * 0.04 * _rise(u) / (0.125 ** np.arange(3))[:, None]
    part[0] += np.where(down, 0.0, 0.04)
    run = np.array([0.125 + time, np.ones_like(time), np.zeros_like(time)])
    for axis, sense in ((rear, 1.0), (front, -1.0)):
        moved = np.array([axis.position - axis.position[0], axis.velocity, axis.acceleration])[:, inside]
        wanted = run + sense * part
        size = np.abs(wanted).max(axis=1)[:, None]
        np.testing.assert_allclose(moved / size, wanted / size, atol=1e-8)
    # Half the distance of the carriages and the height of the knife, which the bars keep on a circle.
    half, half_1, half_2 = 0.2 - part[0], -part[1], -part[2]
    height = -np.sqrt(0.25**2 - half**2)
    rate = -half * half_1 / height
    bend = -(half_1**2 + half * half_2 + rate**2) / height
    phi = 2 * np.pi * rear.time[inside]
    a, b = np.radians([110.0, 135.0])
    cut = np.where((phi > a) & (phi < b), 800 * np.sin(np.pi * (phi - a) / (b - a)), 0.0)
    lift = 6 * (bend + 9.81) - cut
    # ∂half/∂x is −½ of the rear and ½ of the front carriage.
    for axis, sense in ((rear, -0.5), (front, 0.5)):
        force = 12 * axis.acceleration[inside] - lift * half / height * sense
        np.testing.assert_allclose(axis.torque[inside], force, atol=1e-5 * np.abs(force).max())
    strip = lw.servo_axis(machine, "strip")
    np.testing.assert_allclose(strip.torque, 60.0, atol=1e-9)
    assert strip.motor.torque_peak == pytest.approx(60 * 0.4 / (2 * np.pi) / 8 / 0.95, rel=1e-9)
    assert lw.dc_bus(machine).power_residual < 1e-10


def test_a_servo_press_by_virtual_work() -> None:
    """M = (m (a − g) + F) ds/dψ with the slider-crank in closed form, and its law over the sheet."""
    machine = machine_of("servo_press")
    axis = lw.servo_axis(machine)
    psi, omega, epsilon = axis.position - np.pi / 2, axis.velocity, axis.acceleration
    r, rod = 0.08, 0.5
    # Down from the crankshaft: s = −r cos ψ + √(l² − r² sin² ψ), ψ from the top dead centre.
    root = np.sqrt(rod**2 - r**2 * np.sin(psi) ** 2)
    place = -r * np.cos(psi) + root
    slope = r * np.sin(psi) - r**2 * np.sin(psi) * np.cos(psi) / root
    bend = r * np.cos(psi) - r**2 * np.cos(2 * psi) / root - (r**2 * np.sin(2 * psi)) ** 2 / (4 * root**3)
    work = np.interp(place, [0.42, 0.56, 0.562, 0.578, 0.58], [0, 0, 60e3, 60e3, 0])
    work = np.where(slope * omega > 0, work, 0.0)
    torque = (300 * (slope * epsilon + bend * omega**2 - 9.81) + work) * slope
    np.testing.assert_allclose(axis.torque, torque, atol=1e-6 * np.abs(torque).max())
    slow = (axis.time > 0.3501) & (axis.time < 0.8499)
    np.testing.assert_allclose(omega[slow], np.radians(100.0), rtol=1e-9)
    # The peak lies between two samples.
    assert axis.motor.speed_peak == pytest.approx(20 * np.abs(omega).max(), rel=2e-5)
    assert axis.passes


def test_a_servo_carriage_by_the_change_of_its_energy() -> None:
    """The power of the crank is the change of kinetic energy and friction, by central differences."""
    axis = lw.servo_axis(machine_of("servo_carriage"))
    forward = (axis.time > 0.01) & (axis.time < 0.49)
    time, r, rod, step = axis.time[forward], 0.12, 0.4, 1e-6

    def state(t: Floats) -> tuple[Floats, Floats, Floats]:
        """Speed of the crank, velocity of the carriage and kinetic energy."""
        psi = np.pi * (2 * t - np.sin(4 * np.pi * t) / (2 * np.pi))
        speed = 2 * np.pi * (1 - np.cos(4 * np.pi * t))
        beta = np.arcsin(r * np.sin(psi) / rod)
        turn = r * np.cos(psi) * speed / (rod * np.cos(beta))
        across, along = r * np.cos(psi) * speed, -r * np.sin(psi) * speed
        ahead = along - rod * np.sin(beta) * turn
        middle = (along - rod / 2 * np.sin(beta) * turn) ** 2 + (across / 2) ** 2
        energy = 12 * ahead**2 + 1.5 * (middle + rod**2 / 12 * turn**2) + 2 * r**2 / 3 * speed**2
        return speed, ahead, energy / 2

    speed, ahead, _ = state(time)
    change = (state(time + step)[2] - state(time - step)[2]) / (2 * step)
    torque = (change + 40 * np.abs(ahead)) / speed
    np.testing.assert_allclose(axis.torque[forward], torque, atol=1e-5 * np.abs(torque).max())
    assert axis.motor.speed_peak == pytest.approx(40 * np.pi, rel=1e-9)
