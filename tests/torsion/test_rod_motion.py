"""Motion of rods and pistons: another geometry, complex steps, Fourier series, closed dead centres."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize_scalar
from sizes import cases

from linkwright import AssemblyError, InputError
from linkwright.torsion import ArticulatedRod, Rod, RunningGear, dead_centres, slider_crank, throw_motion

# A V of 60 degrees with a master rod on the left: sizes of a large high-speed diesel, an example.
RADIUS = 0.09
MASTER = RunningGear(Rod(length=0.32, mass=5.4, centre=0.1, inertia=0.08), 4.1, -math.pi / 6)
SLAVE_ROD = ArticulatedRod(
    length=0.2556, mass=2.4, distribution=0.6, pin_radius=0.0644, pin_angle=math.radians(67)
)
SLAVE = RunningGear(SLAVE_ROD, 4.1, math.pi / 6)
VEE = (MASTER, SLAVE)


def turned(vector: np.ndarray, angle: Any) -> np.ndarray:
    """Plane vector(s) (2, n) turned by an angle; real arithmetic, also of complex steps."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]])


def places(gears: tuple[RunningGear, ...], phi: Any) -> list[tuple[np.ndarray, np.ndarray, Any]]:
    """Big end, small end (2, n) and piston's place of each gear, by circles and lines in the fixed frame."""
    found = []
    crank = RADIUS * np.array([np.cos(phi), np.sin(phi)])
    for gear in gears:
        pin = crank
        if isinstance(gear.rod, ArticulatedRod):
            big, small, _ = found[gear.master]
            along = (small - big) / gears[gear.master].rod.length
            pin = big + gear.rod.pin_radius * turned(along, gear.rod.pin_angle)
        axis = np.array([math.cos(gear.bank_angle), math.sin(gear.bank_angle)])
        foot = gear.offset * np.array([-axis[1], axis[0]])
        # |foot + x axis − pin|² = l², the larger root.
        away = [foot[0] - pin[0], foot[1] - pin[1]]
        half = axis[0] * away[0] + axis[1] * away[1]
        x = -half + np.sqrt(half**2 - away[0] ** 2 - away[1] ** 2 + gear.rod.length**2)
        small = np.array([foot[0] + x * axis[0], foot[1] + x * axis[1]])
        found.append((pin, small, x))
    return found


gears = st.tuples(
    st.floats(0.2, 0.6),
    st.floats(-3.0, 3.0),
    st.floats(-0.02, 0.02),
    st.floats(0.2, 0.5),
    st.floats(0.0, 0.07),
    st.floats(-3.0, 3.0),
    st.floats(-0.02, 0.02),
).map(
    lambda x: (
        RunningGear(Rod(length=x[0], mass=1, distribution=0.6), 1.0, x[1], x[2]),
        RunningGear(
            ArticulatedRod(length=x[3], mass=1, distribution=0.6, pin_radius=x[4], pin_angle=x[5] / 2),
            1.0,
            x[1] + x[5] / 2,
            x[6],
        ),
    )
)


@settings(deadline=None)
@given(gears, st.floats(-10, 10))
def test_positions_and_first_derivatives_by_complex_steps(throw: tuple[RunningGear, ...], phi: float) -> None:
    """A step of i·1e-30 gives derivatives without differences (Squire and Trapp 1998)."""
    h = 1e-30
    motion = throw_motion(RADIUS, throw, np.array([phi]))
    for (big, small, x), found in zip(places(throw, np.array([phi + 1j * h])), motion, strict=True):
        # Rods come to 25 degrees of a right angle, where rounding grows by 1/cos.
        assert found.piston == pytest.approx(x.real, rel=1e-13, abs=1e-14)
        assert found.piston_d1 == pytest.approx(x.imag / h, rel=1e-12, abs=1e-13)
        assert found.pin.position == pytest.approx(big[0].real + 1j * big[1].real, rel=1e-13, abs=1e-14)
        assert found.pin.d1 == pytest.approx((big[0].imag + 1j * big[1].imag) / h, rel=1e-12, abs=1e-13)
        rod = small - big
        at = np.arctan2(rod[1].real, rod[0].real) - found.bank_angle
        assert np.sin(found.angle - at) == pytest.approx([0.0], abs=1e-13)
        turning = (rod[0].real * rod[1].imag - rod[1].real * rod[0].imag) / h
        turning /= rod[0].real ** 2 + rod[1].real ** 2
        assert found.angle_d1 == pytest.approx(turning, rel=1e-12, abs=1e-13)


@pytest.mark.parametrize("gear", [0, 1])
def test_second_derivatives_by_fourier_series(gear: int) -> None:
    """Coefficients fall by a factor of about 14 each; 64 angles leave rounding times the order squared."""
    n = 64
    phi = 2 * np.pi * np.arange(n) / n
    found = throw_motion(RADIUS, VEE, phi)[gear]
    k = np.fft.fftfreq(n, 1 / n)
    big, small, x = places(VEE, phi)[gear]
    angle = np.arctan2(*(small - big)[::-1]) - VEE[gear].bank_angle
    for value, d1, d2 in (
        (x, found.piston_d1, found.piston_d2),
        (angle, found.angle_d1, found.angle_d2),
        (big[0] + 1j * big[1], found.pin.d1, found.pin.d2),
    ):
        c = np.fft.fft(value)
        first, second = np.fft.ifft(1j * k * c), np.fft.ifft(-(k**2) * c)
        assert np.abs(first - d1).max() < 1e-14 * n
        assert np.abs(second - d2).max() < 1e-14 * n**2


def test_exact_position_of_the_slider_crank() -> None:
    """x = r cos φ + √(l² − r² sin² φ) (Norton, Design of Machinery, 13.1)."""
    phi = np.linspace(-4, 9, 101)
    found = slider_crank(0.05, 0.2, phi)
    assert found.piston == pytest.approx(
        0.05 * np.cos(phi) + np.sqrt(0.04 - (0.05 * np.sin(phi)) ** 2), rel=1e-14
    )
    assert np.sin(found.angle) == pytest.approx(-0.25 * np.sin(phi), abs=1e-15)


@pytest.mark.parametrize("shape", [(), (3,), (2, 5), (0,)])
def test_any_shape_of_crank_angles(shape: tuple[int, ...]) -> None:
    phi = np.linspace(0, 1, math.prod(shape)).reshape(shape)
    for found in throw_motion(RADIUS, VEE, phi):
        for each in (found.piston, found.piston_d2, found.angle, found.pin.position, found.direction):
            assert np.shape(each) == shape


def test_points_of_a_rod() -> None:
    phi = np.linspace(0, 6, 7)
    for gear, (big, small, _), found in zip(
        VEE, places(VEE, phi), throw_motion(RADIUS, VEE, phi), strict=True
    ):
        end = found.point(gear.rod.length)
        assert end.position == pytest.approx(small[0] + 1j * small[1], abs=1e-15)
        # The small end moves as the piston, along the cylinder.
        axis = np.exp(1j * gear.bank_angle)
        assert end.d1 == pytest.approx(found.piston_d1 * axis, abs=1e-14)
        assert end.d2 == pytest.approx(found.piston_d2 * axis, abs=1e-14)
        across = found.point(0.0, 0.01).position - (big[0] + 1j * big[1])
        assert across == pytest.approx(0.01j * found.direction, abs=1e-15)


@settings(deadline=None, max_examples=cases(50, 500))
@given(st.floats(0.12, 0.5), st.floats(-0.02, 0.02), st.floats(-3, 3))
def test_dead_centres_on_the_crank_pin(length: float, offset: float, bank: float) -> None:
    """Crank and rod in line: closed form of stroke and angles."""
    gear = RunningGear(Rod(length=length, mass=1, distribution=0.6), 1.0, bank, offset)
    (found,) = dead_centres(RADIUS, (gear,))
    r, e = RADIUS, offset
    highest = math.sqrt((length + r) ** 2 - e**2)
    lowest = math.sqrt((length - r) ** 2 - e**2)
    # The angle of the lower dead centre is as good as rounding of e/(l − r), here up to 0.67, lets it.
    assert found.top == pytest.approx(bank + math.asin(e / (length + r)), abs=1e-14)
    assert found.bottom == pytest.approx(bank + math.pi + math.asin(e / (length - r)), abs=1e-13)
    assert (found.highest, found.lowest) == pytest.approx((highest, lowest), abs=1e-15)
    assert found.stroke == pytest.approx(highest - lowest, rel=1e-13)


@settings(deadline=None, max_examples=cases(30, 300))
@given(gears)
def test_dead_centres_of_articulated_rods_against_a_search(throw: tuple[RunningGear, ...]) -> None:
    """Golden sections over the other geometry; they see a flat top to the root of rounding."""
    _, found = dead_centres(RADIUS, throw)
    scan = np.linspace(0, 2 * np.pi, 2000)
    x = places(throw, scan)[1][2]
    for sign, angle, value in ((-1, found.top, found.highest), (1, found.bottom, found.lowest)):
        about = scan[np.argmin(sign * x)]
        best = minimize_scalar(
            lambda phi, sign=sign: sign * float(places(throw, phi)[1][2]),
            bounds=(about - 0.01, about + 0.01),
            method="bounded",
            options={"xatol": 1e-10},
        )
        assert value == pytest.approx(sign * best.fun, abs=1e-14)
        assert math.remainder(angle - best.x, 2 * math.pi) == pytest.approx(0, abs=1e-6)
        motion = throw_motion(RADIUS, throw, angle)[1]
        assert abs(float(motion.piston_d1)) < 1e-15
    assert abs(found.top - throw[1].bank_angle) <= math.pi
    assert 0 < found.bottom - found.top < 2 * math.pi


def test_pin_on_the_axis_of_the_crank_pin_is_fork_and_blade() -> None:
    phi = np.linspace(0, 6.2, 91)
    rod = {"length": 0.27, "mass": 2.0, "distribution": 0.6}
    on_master = RunningGear(ArticulatedRod(**rod, pin_radius=0.0, pin_angle=1.1), 4.0, 0.5)
    on_crank = RunningGear(Rod(**rod), 4.0, 0.5)
    articulated = throw_motion(RADIUS, (MASTER, on_master), phi)[1]
    blade = throw_motion(RADIUS, (MASTER, on_crank), phi)[1]
    for name in ("piston", "piston_d1", "piston_d2", "angle", "angle_d1", "angle_d2"):
        assert np.array_equal(getattr(articulated, name), getattr(blade, name))


def test_order_of_the_gears_does_not_matter() -> None:
    phi = np.linspace(0, 6.2, 7)
    slave = RunningGear(SLAVE.rod, 4.1, SLAVE.bank_angle, master=1)
    master_first, slave_first = throw_motion(RADIUS, VEE, phi), throw_motion(RADIUS, (slave, MASTER), phi)
    assert np.array_equal(master_first[1].piston, slave_first[0].piston)
    assert np.array_equal(master_first[0].piston, slave_first[1].piston)


def test_rod_that_does_not_reach_is_told_with_the_angle() -> None:
    phi = np.radians([0.0, 30.0, 60.0, 90.0])
    with pytest.raises(AssemblyError, match=r"at crank angle 60 deg: its pin stands 0\.0779423 m") as error:
        slider_crank(0.09, 0.07, phi)
    assert error.value.crank_angle == pytest.approx(math.pi / 3)
    assert error.value.gap == pytest.approx(0.09 * math.sin(math.pi / 3) - 0.07)
    short = ArticulatedRod(length=0.06, mass=1, distribution=0.6, pin_radius=0.08, pin_angle=1.2)
    with pytest.raises(AssemblyError, match="rod of cylinder 7 does not reach"):
        dead_centres(RADIUS, (MASTER, RunningGear(short, 1.0, 0.5, name="cylinder 7")))


def test_master_that_is_none_is_told() -> None:
    with pytest.raises(InputError, match="master: found 3 for slave, where none stands"):
        throw_motion(RADIUS, (MASTER, RunningGear(SLAVE_ROD, 1.0, master=3, name="slave")), 0.0)
    with pytest.raises(InputError, match="where an articulated rod stands"):
        throw_motion(RADIUS, (RunningGear(SLAVE_ROD, 1.0), MASTER), 0.0)
    with pytest.raises(InputError, match="piston_mass: found -1"):
        RunningGear(SLAVE_ROD, -1.0)
    assert dead_centres(RADIUS, ()) == ()
