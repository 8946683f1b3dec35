"""Trains with printed or exact answers: shafts with distributed inertia, damped modes of two and three discs.

Also the damper of Den Hartog, tuned by his rule, on a shaft that is held at one end.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

import linkwright as lw

# Carslaw and Jaeger, Conduction of Heat in Solids, 2nd ed. 1959, appendix IV, table I: the first roots of
# α tan α = C, four places. They are those of a shaft that is held at one end, with a disc at the other, C
# being the shaft's inertia over that of the disc.
CARSLAW_JAEGER = {
    0.1: (0.3111, 3.1731, 6.2991, 9.4354, 12.5743),
    1.0: (0.8603, 3.4256, 6.4373, 9.5293, 12.6453),
    5.0: (1.3138, 4.0336, 6.9096, 9.8928, 12.9352),
    10.0: (1.4289, 4.3058, 7.2281, 10.2003, 13.2142),
}


@pytest.mark.parametrize("ratio", CARSLAW_JAEGER)
def test_a_held_shaft_with_a_disc(ratio: float) -> None:
    stiffness, inertia = 5e4, 3.0
    machine = lw.loads(
        'format = 1\nname = "Shaft"\n[train]\ninertia = "distributed"\nmodes = 5\n'
        f"[train.discs]\nd = {{ inertia = {inertia / ratio!r} }}\n[train.shafts.s]\n"
        f'between = ["ground", "d"]\nstiffness = {stiffness!r}\nown_inertia = {inertia!r}'
    )
    alpha = lw.free_vibration(machine).angular_frequencies * math.sqrt(inertia / stiffness)
    # Half a unit of the last printed place.
    np.testing.assert_allclose(alpha, CARSLAW_JAEGER[ratio], atol=5e-5)


def test_a_uniform_steel_shaft_by_its_wave_speed() -> None:
    """Held at one end, free at the other: f_n = (2n − 1) √(G/ρ)/(4 L), whatever the diameter."""
    length, modulus, density = 1.5, 80e9, 7800.0
    for diameter in (0.02, 0.1):
        machine = lw.loads(
            'format = 1\nname = "Shaft"\n[train]\ninertia = "distributed"\nmodes = 4\n'
            "[train.discs]\nend = { inertia = 1e-12 }\n[train.shafts.s]\n"
            f'between = ["ground", "end"]\ndensity = {density}\nshear_modulus = {modulus}\n'
            f"sections = [{{ length = {length}, diameter = {diameter} }}]"
        )
        wanted = (2 * np.arange(1, 5) - 1) * math.sqrt(modulus / density) / (4 * length)
        # The end has 1e-12 kg m², up to 1e-6 of the shaft's inertia.
        np.testing.assert_allclose(lw.free_vibration(machine).natural_frequencies, wanted, rtol=1e-6)


def _train(inertias: tuple[float, ...], shafts: str) -> lw.Machine:
    discs = "".join(f"d{n} = {{ inertia = {J!r} }}\n" for n, J in enumerate(inertias))
    return lw.loads(f'format = 1\nname = "Train"\n[train.discs]\n{discs}[train.shafts]\n{shafts}')


def test_two_discs_with_a_dashpot_between_them() -> None:
    """s = −ζω₀ ± i ω₀ √(1 − ζ²): ω₀² = k/J, ζ = c/(2 J ω₀), J = J₀J₁/(J₀ + J₁)."""
    first, second, k, c = 0.8, 2.4, 3.2e4, 25.0
    shaft = f'a = {{ between = ["d0", "d1"], stiffness = {k}, damping = {c} }}'
    found = lw.damped_vibration(_train((first, second), shaft))
    joint = first * second / (first + second)
    omega = math.sqrt(k / joint)
    zeta = c / (2 * joint * omega)
    wanted = complex(-zeta * omega, omega * math.sqrt(1 - zeta**2))
    assert found.eigenvalues[-1] == pytest.approx(wanted, rel=1e-12)
    assert found.damping_ratios[-1] == pytest.approx(zeta, rel=1e-12)
    assert found.logarithmic_decrements[-1] == pytest.approx(
        2 * math.pi * zeta / math.sqrt(1 - zeta**2), rel=1e-12
    )


def test_damping_in_proportion_to_stiffness() -> None:
    """C = β K: ζ_n = β ω_n/2. Discs of Thomson, example 12.4-1."""
    beta, inertias, stiffnesses = 2e-4, (5.0, 11.0, 22.0), (0.10e6, 0.20e6)
    shafts = "\n".join(
        f's{n} = {{ between = ["d{n}", "d{n + 1}"], stiffness = {k}, damping = {beta * k!r} }}'
        for n, k in enumerate(stiffnesses)
    )
    machine = _train(inertias, shafts)
    omega = lw.free_vibration(machine).angular_frequencies[1:]
    # a ω⁴ − b ω² + c = 0 of three discs in a row.
    (J0, J1, J2), (k0, k1) = inertias, stiffnesses
    b = k0 / J0 + (k0 + k1) / J1 + k1 / J2
    c = k0 * k1 * (J0 + J1 + J2) / (J0 * J1 * J2)
    root = math.sqrt(b * b - 4 * c)
    np.testing.assert_allclose(omega, [math.sqrt((b - root) / 2), math.sqrt((b + root) / 2)], rtol=1e-12)
    np.testing.assert_allclose(lw.damped_vibration(machine).damping_ratios[1:], beta * omega / 2, rtol=1e-10)


def test_three_discs_of_which_the_middle_one_is_damped() -> None:
    """The outer ones against each other swing undamped, ω² = k/J; with each other by a cubic in s."""
    J, middle, k, c = 2.0, 5.0, 8e3, 90.0
    shafts = "\n".join(f'{name} = {{ between = ["d1", "{name}"], stiffness = {k} }}' for name in ("d0", "d2"))
    damped = _train((J, middle, J), shafts)
    machine = lw.replace(damped, {"train.discs.d1.damping": c})
    found = lw.damped_vibration(machine).eigenvalues
    # (J s² + k)(m s² + c s + 2k) − 2k² = s (J m s³ + J c s² + k (2J + m) s + k c).
    cubic = np.roots([J * middle, J * c, k * (2 * J + middle), k * c])
    swinging = cubic[cubic.imag > 0][0]
    undamped = 1j * math.sqrt(k / J)
    for wanted in (swinging, undamped):
        # An undamped mode has the real part of rounding.
        assert np.abs(found - wanted).min() < 1e-10 * abs(wanted)
    creeping = cubic[np.abs(cubic.imag) < 1e-9][0].real
    assert np.abs(found - creeping).min() < 1e-9 * abs(swinging)


@pytest.mark.parametrize("mass_ratio", [0.05, 0.25])
def test_damper_of_den_hartog(mass_ratio: float) -> None:
    """Den Hartog, Mechanical Vibrations, section 3.3: tuned to 1/(1 + μ) its peak is √(1 + 2/μ).

    Both fixed points have that height; with Brock's mean damping, ζ² = 3μ/(8(1 + μ)) by the frequency of the
    ring, the peaks are above it by less than 1 %.
    """
    J, k, torque = 10.0, 4e5, 100.0
    omega = math.sqrt(k / J)
    ring = mass_ratio * J
    tuned = omega / (1 + mass_ratio)
    damping = 2 * ring * tuned * math.sqrt(3 * mass_ratio / (8 * (1 + mass_ratio)))
    machine = lw.loads(
        f'format = 1\nname = "Damper"\n[train.discs]\nd0 = {{ inertia = {J} }}\n[train.shafts]\n'
        f'held = {{ between = ["ground", "d0"], stiffness = {k} }}\n[train.dampers.x]\non = "d0"\n'
        f'kind = "tuned"\nring_inertia = {ring}\nstiffness = {ring * tuned**2!r}\ndamping = {damping!r}\n'
        f'[train.excitations.e]\non = "d0"\nharmonics = [{{ order = 1, torque = {torque} }}]\n'
        f"[train.run]\nspeed_min = {0.5 * omega!r}\nspeed_max = {1.5 * omega!r}\npoints = 4001"
    )
    forced = lw.forced_vibration(machine)
    swing = np.abs(forced.amplitudes[:, forced.discs.index("d0")]).max()
    height = math.sqrt(1 + 2 / mass_ratio)
    assert 1.0 <= swing * k / torque / height < 1.01


@pytest.mark.parametrize("mass_ratio", [0.05, 0.25])
def test_fixed_points_of_den_hartog(mass_ratio: float) -> None:
    """At g² = [1 ± √(μ/(2 + μ))]/(1 + μ) the amplitude is √(1 + 2/μ), whatever damps the ring."""
    J, k = 10.0, 4e5
    omega, ring = math.sqrt(k / J), mass_ratio * J
    tuned = omega / (1 + mass_ratio)
    root = math.sqrt(mass_ratio / (2 + mass_ratio))
    speeds = omega * np.sqrt((1 + np.array([-root, root])) / (1 + mass_ratio))
    for damping in (20.0, 500.0):
        machine = lw.loads(
            f'format = 1\nname = "Damper"\n[train.discs]\nd0 = {{ inertia = {J} }}\n[train.shafts]\n'
            f'held = {{ between = ["ground", "d0"], stiffness = {k} }}\n[train.dampers.x]\non = "d0"\n'
            f'kind = "tuned"\nring_inertia = {ring}\nstiffness = {ring * tuned**2!r}\ndamping = {damping}\n'
            '[train.excitations.e]\non = "d0"\nharmonics = [{ order = 1, torque = 100 }]\n'
            "[train.run]\nspeed_min = 1\nspeed_max = 1000"
        )
        forced = lw.forced_vibration(machine, speeds)
        swing = np.abs(forced.amplitudes[0, forced.discs.index("d0")]).ravel()
        np.testing.assert_allclose(swing * k / 100, math.sqrt(1 + 2 / mass_ratio), rtol=1e-9)
