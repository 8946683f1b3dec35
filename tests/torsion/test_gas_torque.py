"""Gas torque: closed forms of its harmonics, work, signs, phases, other mechanisms, weak cylinders."""

from __future__ import annotations

import math

import numpy as np
import pytest
from cylinders import BORE, CRANK, ROD, crank_position, cylinder, diesel
from scipy.integrate import quad

from linkwright import MachineError, ShapeError
from linkwright.torsion import Cylinder, gas_torque
from linkwright.torsion.model.engine.cycle_pressure import CyclePressure
from linkwright.torsion.model.engine.cylinder import torque_orders

AREA = math.pi / 4 * BORE**2
SPEEDS = np.array([100.0, 150.0])


def pressure_of(values: np.ndarray, cycle: float, under: float = 0.0) -> CyclePressure:
    """A pressure at even angles of a cycle, at one speed, the same without combustion."""
    n = len(values)
    angle, weight = np.arange(n) * cycle / n, np.full(n, cycle / n)
    one = np.ones((1, 1))
    return CyclePressure(np.array([100.0]), angle, weight, values[None], one, one, under)


@pytest.mark.parametrize("strokes", [2, 4])
def test_constant_pressure_on_a_harmonic_piston(strokes: int) -> None:
    """x = r cos φ gives M = (p − p_c) A r sin φ: M₁ = −i (p − p_c) A r, all others zero."""
    found = gas_torque(
        pressure_of(np.full(64, 9e5), math.pi * strokes, 1e5), cylinder(strokes, rod=np.inf), 8.0
    )
    wanted = np.where(found.orders == 1, -1j * 8e5 * AREA * CRANK, 0.0)
    assert found.firing[0] == pytest.approx(wanted, abs=1e-12 * 8e5 * AREA * CRANK)


def test_half_orders_of_a_harmonic_pressure() -> None:
    """p = P cos(3φ/2) on x = r cos φ: M = ½PAr [sin(5φ/2) − sin(φ/2)]."""
    angle = 4 * np.pi * np.arange(128) / 128
    found = gas_torque(pressure_of(5e6 * np.cos(1.5 * angle), 4 * np.pi), cylinder(rod=np.inf), 6.0)
    half = 0.5 * 5e6 * AREA * CRANK
    wanted = np.zeros(len(found.orders), complex)
    wanted[5], wanted[1] = -1j * half, 1j * half
    assert found.firing[0] == pytest.approx(wanted, abs=1e-12 * half)


def test_harmonics_of_a_slider_crank() -> None:
    """Constant pressure on a rod of finite length: the Fourier integrals of x′ by SciPy."""
    found = gas_torque(pressure_of(np.full(256, 1e6), 4 * np.pi), cylinder(), 8.0)

    def torque(phi: float) -> float:
        s, c = math.sin(phi), math.cos(phi)
        return 1e6 * AREA * (CRANK * s + CRANK**2 * s * c / math.sqrt(ROD**2 - (CRANK * s) ** 2))

    for k in range(1, 9):
        sine = quad(lambda phi, k=k: torque(phi) * math.sin(k * phi), 0, 2 * np.pi)[0] / np.pi
        assert found.firing[0, 2 * k] == pytest.approx(-1j * sine, abs=1e-9 * 1e6 * AREA * CRANK)


def test_pressure_drives_a_piston_that_descends() -> None:
    """A pulse after the dead centre has positive torque, the same before it negative."""
    for at, sign in ((0.5, 1), (-0.5, -1)):
        angle = 4 * np.pi * np.arange(512) / 512
        pulse = 1e6 * np.exp(-(((np.mod(angle - at + 6, 4 * np.pi) - 6) / 0.1) ** 2))
        found = gas_torque(pressure_of(pulse, 4 * np.pi), cylinder())
        assert sign * found.firing[0, 0].real > 0


@pytest.mark.parametrize("strokes", [2, 4])
def test_mean_torque_is_the_work_of_the_cycle(strokes: int) -> None:
    """2π·(strokes/2)·M₀ = ∮ p dV = p_i V_h; what is under the piston does no work."""
    place = cylinder(strokes)
    pressure = diesel().cycle_pressure(place, SPEEDS)
    found = gas_torque(pressure, place)
    assert found.mean_effective_pressure == pytest.approx(np.full(2, 16e5), rel=1e-12)
    angle = np.linspace(0, place.cycle, 20001)
    V, _ = place.volume(angle, 15.0)
    p, _ = pressure.at(angle)
    # The trapezoids of a curve with corners, a thousand a radian.
    assert np.trapezoid(p[0], V) == pytest.approx(found.firing[0, 0].real * place.cycle, rel=1e-4)


def test_harmonics_are_those_of_the_torque() -> None:
    """Beside a transform of twenty thousand torques over the cycle."""
    place = cylinder()
    pressure = diesel(walls={"kind": "woschni"}).cycle_pressure(place, SPEEDS)
    found = gas_torque(pressure, place)
    n = 20000
    phi = 4 * np.pi * np.arange(n) / n
    p, _ = pressure.at(phi - place.top)
    transform = np.fft.rfft(-(p - 101325.0) * AREA * place.motion(phi)[1], axis=1)[:, :49] * 2 / n
    transform[:, 0] /= 2
    # The interpolation between the points, a degree apart.
    assert np.abs(found.firing - transform).max() < 5e-5 * np.abs(found.firing).max()


def test_waveform_sums_up_to_the_torque() -> None:
    """Its series up to order 48 is the torque itself, but for what the release of heat has beyond."""
    place = cylinder()
    pressure = diesel().cycle_pressure(place, SPEEDS[:1])
    found = gas_torque(pressure, place, 48.0)
    phi = np.linspace(0, 4 * np.pi, 721)
    p, _ = pressure.at(phi)
    torque = -(p - 101325.0) * AREA * place.motion(phi)[1]
    assert np.abs(found.waveform(phi) - torque).max() < 2e-3 * np.abs(torque).max()


def test_a_dead_centre_elsewhere_turns_the_harmonics() -> None:
    """A piston that is δ late fires δ later: M_ν e^{−iνδ}."""
    delta = 0.11
    gas = diesel(walls={"kind": "hohenberg"})
    here, there = (
        gas_torque(gas.cycle_pressure(place, SPEEDS), place) for place in (cylinder(), cylinder(shift=delta))
    )
    assert there.firing == pytest.approx(here.firing * np.exp(-1j * here.orders * delta), abs=1e-7)


def test_a_piston_on_an_articulated_rod() -> None:
    """Its stroke, its dead centre and its work are those of its own motion."""
    link, length, lead, bank = 0.06, 0.26, math.radians(67.0), math.radians(60.0)
    # Master rod along the vertical; the other rod's pin lies at an angle on its big end, its cylinder at 60°.
    phi = 2 * np.pi * np.arange(180) / 180 + bank
    tilt = np.arcsin(-CRANK * np.sin(phi) / ROD)
    pin = CRANK * np.exp(1j * (phi - bank)) + link * np.exp(1j * (lead + tilt - bank))
    place = Cylinder(BORE, 4, pin.real + np.sqrt(length**2 - pin.imag**2))
    fine = place.motion(np.linspace(0, 2 * np.pi, 100001))[0]
    assert place.stroke == pytest.approx(np.ptp(fine), rel=1e-9)
    assert place.motion(np.array([place.top, place.bottom]))[1] == pytest.approx([0, 0], abs=1e-12)
    assert abs(place.stroke - 2 * CRANK) > 0.03 * CRANK
    assert abs(place.top) > 0.01
    found = gas_torque(diesel().cycle_pressure(place, SPEEDS), place)
    assert found.firing[0, 0].real * 4 * np.pi == pytest.approx(16e5 * AREA * place.stroke, rel=1e-12)


def test_weak_and_missing_combustion() -> None:
    place = cylinder()
    found = gas_torque(diesel().cycle_pressure(place, SPEEDS), place)
    assert np.array_equal(found.of(0.0), found.motored)
    assert found.of(1.0) == pytest.approx(found.firing, rel=1e-14)
    assert found.of(0.5) == pytest.approx((found.firing + found.motored) / 2, rel=1e-14)
    # Compression and expansion stay: they give little work, but much of the torque of low orders.
    assert abs(found.motored[0, 0]) < 0.05 * found.firing[0, 0].real
    assert abs(found.motored[0, 4]) > 0.3 * abs(found.firing[0, 4])


def test_orders() -> None:
    with pytest.raises(MachineError, match="from 0 to 48"):
        torque_orders(4, 60.0)
    assert np.array_equal(torque_orders(4), np.arange(49) / 2)
    assert np.array_equal(torque_orders(2), np.arange(25))


def test_motion_of_the_piston_from_its_values() -> None:
    """The series through 72 values is the slider-crank and its derivative."""
    place, phi = cylinder(shift=0.3), np.linspace(-7, 9, 57)
    x, x_d1 = place.motion(phi)
    s, c = np.sin(phi - 0.3), np.cos(phi - 0.3)
    assert x == pytest.approx(crank_position(phi - 0.3), rel=1e-13)
    wanted = -CRANK * s - CRANK**2 * s * c / np.sqrt(ROD**2 - (CRANK * s) ** 2)
    assert x_d1 == pytest.approx(wanted, abs=1e-13)
    assert place.top == pytest.approx(0.3, abs=1e-14)
    assert place.bottom == pytest.approx(0.3 + math.pi, abs=1e-13)
    assert place.stroke == pytest.approx(2 * CRANK, rel=1e-14)


def test_too_few_positions_are_refused() -> None:
    with pytest.raises(ShapeError, match="6 positions"):
        cylinder(n=6)
    with pytest.raises(ShapeError, match="highest harmonics"):
        Cylinder(BORE, 4, np.where(np.arange(64) < 32, 0.1, 0.2))
