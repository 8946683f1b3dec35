"""Line contact by Hertz against closed forms, the half-plane under line loads, and scaling laws."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import minimize

from linkwright import FindingError, InputError, Material, ShapeError, line_contact
from linkwright.cam.dynamics.hertz import SHEAR_DEPTH, SHEAR_MAX, STEEL, von_mises_largest

BRONZE = Material(110e9, 0.34)


def flamant(x: float, z: float) -> tuple[float, float, float]:
    """Stresses of a half-plane under the pressure √(1 − s²), from Flamant's line load (Johnson, 2.23)."""

    def pressed(kernel: object) -> float:
        # s = sin θ takes the root of the pressure away.
        value, _ = quad(lambda t: np.cos(t) ** 2 * kernel(np.sin(t)), -np.pi / 2, np.pi / 2, epsabs=1e-10)
        return value

    r2 = lambda s: ((x - s) ** 2 + z**2) ** 2  # noqa: E731
    along = -2 * z / np.pi * pressed(lambda s: (x - s) ** 2 / r2(s))
    down = -2 * z**3 / np.pi * pressed(lambda s: 1 / r2(s))
    shear = -2 * z**2 / np.pi * pressed(lambda s: (x - s) / r2(s))
    return along, down, shear


def axis_stress(zeta: float | np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Stress along and down below the middle, over the largest pressure (Johnson, 4.46a, b)."""
    w = np.hypot(1.0, zeta)
    # (1 + 2ζ²)/w − 2ζ = (w − ζ)²/w, and w − ζ = 1/(w + ζ) without cancellation.
    return -1 / ((w + zeta) ** 2 * w), -1 / w


def test_formula_of_the_handbooks() -> None:
    """p₀ = 0.418 √(F E/(l r)) for ν = 0.3 and one material (Niemann, Maschinenelemente; three digits)."""
    found = line_contact(1000.0, 0.02, 0.03, 0.01, STEEL, STEEL)
    radius = 0.02 * 0.03 / 0.05
    assert found.pressure_max == pytest.approx(0.418 * np.sqrt(1000 * 206e9 / (0.01 * radius)), rel=1e-3)


def test_pressure_carries_the_force_and_bends_the_surfaces_together() -> None:
    """∫p = P, and the slopes of both surfaces under p add up to x/R (Johnson, 2.25a with 4.33)."""
    found = line_contact(500.0, 0.02, -0.05, 0.008, STEEL, BRONZE)
    b, p0, radius = (float(x[0]) for x in (found.half_width, found.pressure, found.radius))
    total, _ = quad(lambda x: p0 * np.sqrt(1 - (x / b) ** 2), -b, b)
    assert total * 0.008 == pytest.approx(500, rel=1e-9)
    compliance = (1 - 0.3**2) / 206e9 + (1 - 0.34**2) / 110e9
    for x in (0.0, 0.3, 0.8):
        # Principal value of ∫√(1 − s²)/(s − x): its singular part is √(1 − x²) ln((1 − x)/(1 + x)).
        root = np.sqrt(1 - x * x)
        smooth = lambda t, x=x, root=root: (np.cos(t) - root) / (np.sin(t) - x) * np.cos(t)  # noqa: E731
        inner, _ = quad(smooth, -np.pi / 2, np.pi / 2, points=[np.arcsin(x)])
        value = p0 * (inner + root * np.log((1 - x) / (1 + x)))
        assert -2 / np.pi * compliance * value == pytest.approx(x * b / radius, rel=1e-6, abs=1e-12)


@pytest.mark.parametrize("depth", [0.1, 0.5, SHEAR_DEPTH, 2.0, 10.0])
def test_stress_on_the_axis_is_that_of_line_loads(depth: float) -> None:
    along, down, _ = flamant(0.0, depth)
    found = axis_stress(depth)
    assert float(found[0]) == pytest.approx(along, abs=1e-10)
    assert float(found[1]) == pytest.approx(down, abs=1e-10)


def test_largest_shear_of_the_whole_half_plane() -> None:
    """The largest shear lies on the axis (Johnson: 0.30 p₀ at 0.78 a), found by search in x and z."""

    def shear(place: np.ndarray) -> float:
        along, down, tau = flamant(*place)
        return -float(np.hypot(0.5 * (along - down), tau))

    found = minimize(shear, [0.2, 0.6], method="Nelder-Mead", options={"xatol": 1e-6, "fatol": 1e-12})
    # Nelder and Mead stop within the root of the change that they still see.
    assert found.x == pytest.approx([0.0, SHEAR_DEPTH], abs=1e-5)
    assert -found.fun == pytest.approx(SHEAR_MAX, abs=1e-10)
    assert pytest.approx(0.30028, abs=5e-6) == SHEAR_MAX
    assert pytest.approx(0.786, abs=5e-4) == SHEAR_DEPTH


@pytest.mark.parametrize("poisson", [0.0, 0.1, 0.2, 0.3, 0.5])
def test_von_mises_against_a_fine_scan(poisson: float) -> None:
    zeta = np.linspace(0, 4, 400_001)
    x, z = axis_stress(zeta)
    y = poisson * (x + z)
    scanned = np.sqrt(0.5 * ((x - y) ** 2 + (y - z) ** 2 + (z - x) ** 2))
    stress, depth = von_mises_largest(poisson)
    # Steps of 1e-5 miss the top by their square, its place by a step.
    assert stress == pytest.approx(scanned.max(), abs=1e-9)
    assert depth == pytest.approx(zeta[scanned.argmax()], abs=2e-5)


def test_scaling() -> None:
    """p₀ and b grow with the root of the force, p₀ falls with the root of R."""
    first, second = line_contact([100.0, 400.0], 0.02, np.inf, 0.01).pressure
    assert second / first == pytest.approx(2, rel=1e-14)
    narrow, wide = line_contact(100.0, [0.02, 0.08], np.inf, 0.01).half_width
    assert wide / narrow == pytest.approx(2, rel=1e-14)


def test_flat_face_is_the_limit_of_a_large_radius() -> None:
    flat = line_contact(100.0, 0.02, np.inf, 0.01)
    for radius in (1e9, -1e9):
        near = line_contact(100.0, 0.02, radius, 0.01)
        # R differs by 0.02/1e9.
        assert near.pressure_max == pytest.approx(flat.pressure_max, rel=1e-10)
    assert float(flat.radius[0]) == 0.02


def test_where_nothing_presses_there_is_no_stress() -> None:
    found = line_contact([-5.0, 0.0, 5.0], 0.02, 0.03, 0.01)
    assert (found.pressure[:2] == 0).all()
    assert (found.half_width[:2] == 0).all()
    assert found.pressure[2] > 0
    assert found.slenderness[2] == pytest.approx(found.half_width[2] / 0.02)


def test_roller_larger_than_the_hollow_is_told() -> None:
    with pytest.raises(FindingError, match=r"index 1 .* convex radius 0\.03 m .* 0\.025 m"):
        line_contact(100.0, [-0.05, -0.025], 0.03, 0.01)


def test_inputs_without_sense_are_told() -> None:
    with pytest.raises(InputError, match="length: found 0"):
        line_contact(1.0, 1.0, 1.0, 0.0)
    with pytest.raises(InputError, match="radius_other: found 0 at index 0"):
        line_contact(1.0, 1.0, 0.0, 1.0)
    with pytest.raises(InputError, match="force: found nan at index 1"):
        line_contact([1.0, np.nan], 1.0, 1.0, 1.0)
    with pytest.raises(InputError, match="poisson"):
        Material(1e9, 0.6)
    with pytest.raises(ShapeError, match="one length"):
        line_contact([1.0, 2.0], [1.0, 2.0, 3.0], 1.0, 1.0)
