"""Cam lift by a formula: the catalogue's laws again, other functions, what is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest
from command_line import invoke

import linkwright as lw
from linkwright import LawError, LinkwrightError
from linkwright.cam import LAWS
from linkwright.cam.laws.spline import osculating

HEAD = """
format = 1
name = "cam"
[drive]
speed = "60 rpm"
[mechanism.cams.C]
follower = "translating"
contact = "roller"
roller_radius = "10 mm"
base_radius = "60 mm"
sections = [
  { angle = "120 deg", %s },
  { angle = "60 deg" },
  { angle = "120 deg", lift = "-20 mm" },
  { angle = "60 deg" },
]
"""

FORMULAS = {
    "cycloidal": "h*(z - sin(2*pi*z)/(2*pi))",
    "harmonic": "h*(1 - cos(pi*z))/2",
    "polynomial_3_4_5": "h*(10*z^3 - 15*z^4 + 6*z^5)",
}


def cam(law: str) -> lw.Machine:
    return lw.loads(HEAD % law)


@pytest.mark.parametrize("name", FORMULAS)
def test_formula_of_a_law_is_the_law(name: str) -> None:
    by_name = lw.cam_profile(cam(f'lift = "20 mm", law = "{name}"'))
    text = f'law = {{ kind = "formula", lift = "{FORMULAS[name]}", constants = {{ h = "20 mm" }} }}'
    by_formula = lw.cam_profile(cam(text))
    assert by_formula.stroke == pytest.approx(by_name.stroke, rel=1e-14)
    # Second derivatives agree to 1e-9 of the largest, which is what the polynomials promise.
    for extreme in ("velocity_max", "acceleration_max", "pressure_angle_max", "base_radius"):
        assert getattr(by_formula, extreme) == pytest.approx(getattr(by_name, extreme), rel=2e-9), extreme


def test_angle_of_the_cam_and_share_of_the_section_are_both_known() -> None:
    one = lw.cam_profile(cam('law = { kind = "formula", lift = "0.02*z^3*(10 - 15*z + 6*z^2)" }'))
    theta = "(theta/(2*pi/3))"
    text = f"0.02*{theta}^3*(10 - 15*{theta} + 6*{theta}^2)"
    other = lw.cam_profile(cam(f'law = {{ kind = "formula", lift = "{text}" }}'))
    assert other.acceleration_max == pytest.approx(one.acceleration_max, rel=1e-12)


def test_derivatives_are_those_of_the_function() -> None:
    k = 9.0

    def exact(z: np.ndarray) -> np.ndarray:
        return np.array(
            [np.exp(z) * np.sin(k * z) + z for z in [z]] + [_d(z, k, order) for order in (1, 2, 3)]
        )

    law = osculating(exact, "e^z sin 9z")
    z = np.linspace(0.003, 0.997, 101)
    for order, share in ((0, 1e-12), (1, 1e-11), (2, 1e-9), (3, 1e-6)):
        wanted = exact(z)[order] - (exact(np.zeros(1))[0] if order == 0 else 0.0)
        found = np.array([float(law.at(each, order)) for each in z])
        np.testing.assert_allclose(found, wanted, atol=share * np.abs(wanted).max())


def _d(z: np.ndarray, k: float, order: int) -> np.ndarray:
    """Derivative of e^z sin kz + z: the imaginary part of (1 + ik)^n e^{(1 + ik)z}."""
    root = complex(1.0, k)
    return (root**order * np.exp(root * z)).imag + (1.0 if order == 1 else 0.0)


@pytest.mark.parametrize(
    ("formula", "said"),
    [
        ("0.02*(z - sin(2*pi*z)/(2*pi)) + 0.001*max(0, z - 0.5)^2*(1-z)^2", "smooth"),
        ("0.02*z", "velocity"),
        ("0.02*log(z)", "value"),
        # Infinite at both ends: their difference is none.
        ("9^9^9^9", "value and derivatives"),
        ("0.02*q", '"q"'),
        ("0.02*(z", "z"),
    ],
)
def test_what_is_no_lift_is_refused(formula: str, said: str) -> None:
    with pytest.raises(LinkwrightError, match=said):
        lw.cam_profile(cam(f'law = {{ kind = "formula", lift = "{formula}" }}'))


def test_a_lift_of_the_section_beside_that_of_the_formula_is_refused() -> None:
    law = 'law = { kind = "formula", lift = "0.02*z^3*(10 - 15*z + 6*z^2)" }'
    assert lw.cam_profile(cam(f'lift = "20 mm", {law}')).stroke == pytest.approx(0.02)
    with pytest.raises(LinkwrightError, match="remove it"):
        lw.cam_profile(lw.loads((HEAD % f'lift = "10 mm", {law}').replace("-20 mm", "-10 mm")))


def test_a_kink_inside_is_told() -> None:
    def bent(z: np.ndarray) -> np.ndarray:
        return np.array([np.abs(z - 0.4), np.sign(z - 0.4), 0 * z, 0 * z])

    with pytest.raises(LawError, match="smooth"):
        osculating(bent, "abs(z - 0.4)")


def test_factors_of_laws_with_parameters(tmp_path) -> None:  # type: ignore[no-untyped-def]
    import json

    result = invoke("cam", "laws", "--law", "modified_sine: share=0.25", "--law", "cycloidal", "--json")
    laws = json.loads(result.stdout)["results"]["cam_laws"]
    named = laws["modified_sine: share=0.25"]
    assert named["parameters"] == {"share": 0.25}
    assert named["C_v"] == lw.law_factors(LAWS["modified_sine"].normalised(share=0.25)).C_v
    assert laws["cycloidal"]["C_a"] == pytest.approx(2 * math.pi)
    for words, said in (
        ("modified_sine: share=2", "0.5"),
        ("modified_sine: part=1", "share"),
        ("sine", "name"),
    ):
        result = invoke("cam", "laws", "--law", words)
        assert (result.exit_code, said in result.stderr) == (2, True), result.output
