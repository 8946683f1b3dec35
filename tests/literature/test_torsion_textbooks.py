"""Shafts with distributed inertia and trains with modal damping, of textbooks.

S. Timoshenko, D. H. Young, Vibration Problems in Engineering, torsional vibration of shafts; W. T. Thomson,
Theory of Vibration with Applications, chapter on continuous systems; D. J. Inman, Engineering Vibration,
section 4.5: from memory, as far as numbers are printed.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

import linkwright as lw

STEEL = "density = 7850.0\nshear_modulus = 79.3e9\n"
WAVE = math.sqrt(79.3e9 / 7850.0)


def rods(discs: dict[str, float], shafts: dict[str, str], modes: int = 6) -> lw.Machine:
    listed = "".join(f"{name} = {{ inertia = {J!r} }}\n" for name, J in discs.items())
    rows = "".join(f"[train.shafts.{name}]\n{text}\n" for name, text in shafts.items())
    return lw.loads(
        f'format = 1\nname = "Rods"\n[train]\ninertia = "distributed"\nmodes = {modes}\n'
        f"[train.discs]\n{listed}{rows}"
    )


@pytest.mark.parametrize(("m", "n"), [(0.5, 0.5), (2.0, 0.3), (10.0, 4.0)])
def test_a_shaft_with_a_disc_at_each_end(m: float, n: float) -> None:
    """Timoshenko: tan β = (m + n) β/(m n β² − 1), m and n the discs over the shaft, β = ω l/c."""
    stiffness, inertia = 4e4, 0.6
    machine = rods(
        {"a": m * inertia, "b": n * inertia},
        {"s": f'between = ["a", "b"]\nstiffness = {stiffness!r}\nown_inertia = {inertia!r}'},
    )
    omega = lw.free_vibration(machine).angular_frequencies
    beta = omega[omega > 0] * math.sqrt(inertia / stiffness)
    left = np.sin(beta) * (m * n * beta**2 - 1) - (m + n) * beta * np.cos(beta)
    # Over its slope, which grows as m n β².
    np.testing.assert_allclose(left / (m * n * beta**2 + m + n), 0.0, atol=1e-9)
    # One root between any two of sin β.
    assert (np.floor(beta / math.pi) == np.arange(len(beta))).all()


@pytest.mark.parametrize("step", [0.6, 1.0, 1.7])
def test_a_shaft_of_two_halves(step: float) -> None:
    """Held at the left: tan² (ω l/2c) = I_left/I_right, whatever the diameters themselves."""
    length, thick = 1.2, 0.08
    machine = rods(
        {"end": 1e-12},
        {
            "s": f'between = ["ground", "end"]\n{STEEL}sections = ['
            f"{{ length = {length / 2}, diameter = {thick} }}, "
            f"{{ length = {length / 2}, diameter = {step * thick} }}]"
        },
        4,
    )
    found = lw.free_vibration(machine).angular_frequencies * length / (2 * WAVE)
    first = math.atan(math.sqrt(1 / step**4))
    # The end has 1e-12 kg m², up to 1e-7 of the shaft's inertia.
    wanted = [first, math.pi - first, math.pi + first, 2 * math.pi - first]
    np.testing.assert_allclose(found, wanted, rtol=1e-6)


def test_drill_pipe_of_thomson() -> None:
    """5000 ft of pipe, 4.5 by 3.83 in, and 120 ft of collars, 7 5/8 by 2 in, as a disc: 2.41 rad/s, 0.384 Hz.

    β tan β is the inertia of the pipe over that of the collars, 2.44 in print, which has β = 1.135.
    """
    foot, inch, pound = 0.3048, 0.0254, 0.45359237
    density = 490 * pound / foot**3
    modulus = 12e6 * 4.4482216152605 / inch**2
    polar = [math.pi / 32 * (a**4 - b**4) * inch**4 for a, b in ((4.5, 3.83), (7.625, 2.0))]
    collars = density * polar[1] * 120 * foot
    machine = rods(
        {"bit": collars},
        {
            "pipe": f'between = ["ground", "bit"]\ndensity = {density}\nshear_modulus = {modulus}\n'
            f"sections = [{{ length = {5000 * foot}, "
            f"diameter = {4.5 * inch}, inner_diameter = {3.83 * inch} }}]"
        },
        3,
    )
    found = lw.free_vibration(machine).angular_frequencies[0]
    beta = found * 5000 * foot / math.sqrt(modulus / density)
    assert beta * math.tan(beta) == pytest.approx(polar[0] * 5000 / (polar[1] * 120), rel=1e-9)
    assert beta == pytest.approx(1.135, abs=0.005)
    assert found == pytest.approx(2.41, abs=0.005)
    assert found / (2 * math.pi) == pytest.approx(0.384, abs=0.0005)


# Masses 9 and 1, stiffnesses 24 to the ground and 3 between them: ω = √2 and 2. Discs of one size larger are
# no other train.
INMAN = """
format = 1
name = "Two degrees of freedom"
[train]
modal_damping = { ratios = [0.05, 0.1] }
[train.discs]
first = { inertia = 9.0 }
second = { inertia = 1.0 }
[train.shafts]
a = { between = ["ground", "first"], stiffness = 24.0 }
b = { between = ["first", "second"], stiffness = 3.0 }
[train.excitations.e]
on = "second"
harmonics = [{ order = 1, torque = 1.0 }]
"""


def test_modal_damping_of_inman() -> None:
    """Ratios of 0.05 and 0.1: e^{−0.0707 t}, ω_d = 1.4124 rad/s, e^{−0.2 t}, 1.9900 rad/s are printed."""
    machine = lw.loads(INMAN)
    np.testing.assert_allclose(lw.free_vibration(machine).angular_frequencies, [math.sqrt(2), 2], rtol=1e-12)
    found = lw.damped_vibration(machine).eigenvalues
    np.testing.assert_allclose(-found.real, [0.0707, 0.2], atol=5e-5)
    # √2 √(1 − 0.05²) is 1.41245, which the book cuts off.
    np.testing.assert_allclose(found.imag, [1.4124, 1.9900], atol=1e-4)
    np.testing.assert_allclose(found.imag, [math.sqrt(2 * 0.9975), 2 * math.sqrt(0.99)], rtol=1e-12)


def test_response_of_inman_by_his_modes() -> None:
    """Modes (1, 3)/√18 and (1, −3)/√18 of M⁻¹K, in his order, one equation of one degree of freedom each."""
    speeds = np.linspace(0.5, 3.0, 11)
    found = lw.forced_vibration(lw.loads(INMAN), speeds)
    theta = np.zeros((2, len(speeds)), complex)
    for omega, zeta, shape in ((math.sqrt(2), 0.05, (1.0, 3.0)), (2.0, 0.1, (1.0, -3.0))):
        mode = np.array(shape) / math.sqrt(18)
        theta += np.outer(mode, mode[1] / (omega**2 - speeds**2 + 2j * zeta * omega * speeds))
    np.testing.assert_allclose(found.amplitudes[0], theta, rtol=1e-10)
