"""Every kind of load against the virtual work of its own definition, on an offset, inclined slider-crank."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

import linkwright as lw

R, L, OFFSET, ANGLE = 0.15, 0.55, 0.06, 0.4
PHI = np.linspace(0, 2 * np.pi, 73)

BASE = f"""
format = 1
name = "offset slider-crank"
[mechanism.points.P]
x = 0.3
y = -0.2
[mechanism.cranks.A]
radius = {R}
phase = 0.2
[mechanism.sliders.S]
crank = "A"
rod = {L}
offset = {OFFSET}
angle = {ANGLE}
[bodies]
S = {{ mass = 8.0 }}
"S.rod" = {{ mass_per_length = 6.0 }}
A = {{ mass = 2.0, inertia = 0.01, along = 0.05, across = 0.02 }}
"""

Points = NDArray[np.float64]


def slider(phi: Points) -> tuple[Points, Points, Points]:
    """Slider coordinate, slider point and pin by plain trigonometry."""
    pin = R * np.stack([np.cos(phi + 0.2), np.sin(phi + 0.2)], axis=-1)
    t = np.array([np.cos(ANGLE), np.sin(ANGLE)])
    n = np.array([-t[1], t[0]])
    h = pin @ n - OFFSET
    s = pin @ t + np.sqrt(L**2 - h**2)
    return s, s[:, None] * t + OFFSET * n, pin


def slope(f, phi: Points) -> Points:
    """Derivative by φ: central difference of order 6, good to about 1e-10 of the function."""
    h = 1e-2
    weights = {1: 45, 2: -9, 3: 1}
    return sum(w * (f(phi + k * h) - f(phi - k * h)) for k, w in weights.items()) / (60 * h)


def torque(load: str) -> tuple[Points, lw.Machine]:
    machine = lw.loads(BASE + f"[loads]\nit = {load}\n")
    reduced = lw.reduction(machine, n=72)
    return reduced.torque_load, machine


# The differences limit the comparison, at 1e-10 of some hundred N m.
CLOSE = {"rtol": 1e-8, "atol": 1e-7}


def test_gravity_is_the_slope_of_the_height() -> None:
    def height(phi: Points) -> Points:
        _, point, pin = slider(phi)
        own = np.stack([np.cos(phi + 0.2), np.sin(phi + 0.2)], axis=-1)
        crank = 0.05 * own + 0.02 * np.stack([-own[:, 1], own[:, 0]], axis=-1)
        return 9.81 * (8.0 * point[:, 1] + 6.0 * L * 0.5 * (point + pin)[:, 1] + 2.0 * crank[:, 1])

    found, _ = torque('{ kind = "gravity" }')
    np.testing.assert_allclose(found, slope(height, PHI), **CLOSE)


def test_spring_is_the_slope_of_its_energy() -> None:
    def energy(phi: Points) -> Points:
        length = np.linalg.norm(slider(phi)[1] - np.array([0.3, -0.2]), axis=-1)
        return 0.5 * 2000.0 * (length - 0.25) ** 2

    found, _ = torque('{ kind = "spring", between = ["S", "P"], stiffness = 2000, free_length = 0.25 }')
    np.testing.assert_allclose(found, slope(energy, PHI), **CLOSE)


def test_constant_force_is_the_slope_of_its_potential() -> None:
    found, _ = torque('{ kind = "force", on = "S", force = "300 N", direction = "70 deg" }')
    way = np.array([np.cos(np.radians(70)), np.sin(np.radians(70))])
    np.testing.assert_allclose(found, -300 * slope(lambda phi: slider(phi)[1] @ way, PHI), **CLOSE)


def test_dry_resistance_takes_force_times_way() -> None:
    found, _ = torque('{ kind = "dry", on = "S", force = 400 }')
    np.testing.assert_allclose(found, 400 * np.abs(slope(lambda phi: slider(phi)[0], PHI)), **CLOSE)


def test_dry_torque_on_the_rod() -> None:
    def angle(phi: Points) -> Points:
        _, point, pin = slider(phi)
        u = point - pin
        return np.unwrap(np.arctan2(u[:, 1], u[:, 0]))

    found, _ = torque('{ kind = "dry", on = "S.rod", torque = 30 }')
    np.testing.assert_allclose(found, 30 * np.abs(slope(angle, PHI)), **CLOSE)


def test_torque_on_the_crank_drives_when_positive() -> None:
    found, _ = torque('{ kind = "torque", on = "A", torque = 12 }')
    np.testing.assert_allclose(found, -12.0, rtol=1e-12)


def test_viscous_coefficient_is_damping_times_slope_squared() -> None:
    machine = lw.loads(BASE + '[loads]\nit = { kind = "viscous", on = "S", damping = 50 }\n')
    slopes = slope(lambda phi: slider(phi)[0], PHI)
    np.testing.assert_allclose(lw.reduction(machine, n=72).viscous, 50 * slopes**2, **CLOSE)


def test_force_over_position_tells_the_directions_apart() -> None:
    found, _ = torque(
        '{ kind = "force_position", on = "S", position = [0.4, 0.5, 0.7], '
        "forward = [0, 100, 900], return = [50, 40, 30] }"
    )
    s = slider(PHI)[0]
    slopes = slope(lambda phi: slider(phi)[0], PHI)
    force = np.where(
        slopes > 0,
        np.interp(s, [0.4, 0.5, 0.7], [0, 100, 900]),
        np.interp(s, [0.4, 0.5, 0.7], [50, 40, 30]),
    )
    np.testing.assert_allclose(found, force * np.abs(slopes), **CLOSE)


def test_torque_over_angle_repeats_every_turn() -> None:
    found, _ = torque(
        '{ kind = "torque_angle", angle = ["90 deg", "180 deg", "300 deg"], torque = [10, 40, 0] }'
    )
    knots = np.radians([-60, 90, 180, 300, 450])
    np.testing.assert_allclose(found, np.interp(PHI, knots, [0, 10, 40, 0, 10]), atol=1e-12)


def test_torque_over_speed_enters_steady_motion() -> None:
    """A fan on the crank alone: the motor's line meets the load's line where algebra says."""
    text = """
    format = 1
    name = "fan"
    [drive.motor]
    kind = "dc"
    speed_no_load = 100
    torque_stall = 50
    inertia = 0.1
    [drive.gearbox]
    ratio = 4
    efficiency = 0.8
    [mechanism.cranks.A]
    radius = 0.1
    [loads]
    fan = { kind = "torque_speed", speed = [0, 10, 20, 30], torque = [0, 20, 60, 200] }
    """
    motion = lw.steady_state(lw.loads(text))
    # Between 20 and 30 rad/s: 4·0.8·50 (1 − 4ω/100) = 60 + 14 (ω − 20)  →  160 − 6.4 ω = 14 ω − 220,
    # ω = 380/20.4 = 18.6 lies below; between 10 and 20: 160 − 6.4 ω = 20 + 4 (ω − 10), ω = 180/10.4.
    assert motion.speed_min == pytest.approx(180 / 10.4, rel=1e-12)
    assert motion.unevenness == pytest.approx(0.0, abs=1e-12)
    assert motion.efficiency == pytest.approx(0.8, rel=1e-12)


def test_inertia_has_its_definition() -> None:
    """J by difference of the positions of all masses."""
    machine = lw.loads(BASE)

    def squared(f) -> Points:
        d = slope(f, PHI)
        return d**2 if d.ndim == 1 else (d**2).sum(axis=-1)

    def own(phi: Points) -> Points:
        return np.stack([np.cos(phi + 0.2), np.sin(phi + 0.2)], axis=-1)

    def rod_angle(phi: Points) -> Points:
        _, point, pin = slider(phi)
        return np.unwrap(np.arctan2(*(point - pin).T[::-1]))

    rod = 6.0 * L
    exact = (
        8.0 * squared(lambda phi: slider(phi)[0])
        + rod * squared(lambda phi: 0.5 * (slider(phi)[1] + slider(phi)[2]))
        + rod * L**2 / 12 * squared(rod_angle)
        + 2.0 * squared(lambda phi: 0.05 * own(phi) + 0.02 * np.stack([-own(phi)[:, 1], own(phi)[:, 0]], -1))
        + 0.01
    )
    np.testing.assert_allclose(lw.reduction(machine, n=72).inertia_reduced, exact, rtol=1e-8)
