"""Extremes of cams that lie close to a joint of the law, or at one side of it."""

from __future__ import annotations

import numpy as np
import pytest

import linkwright as lw
from linkwright import MachineError

ROLLER = """
format = 1
name = "cam"
[drive]
speed = "900 rpm"
[mechanism.cams.c]
{size}
sections = [
  {{ angle = {rise}, lift = {lift}, law = {law} }},
  {{ angle = "60 deg" }},
  {{ angle = "120 deg", lift = -{lift}, law = {law} }},
  {{ angle = {rest} }},
]
"""


def machine(size: str, law: str, rise: float = 120.0, lift: float = 0.02, more: str = "") -> lw.Machine:
    rest = 360.0 - 60 - 120 - rise
    text = ROLLER.format(size=size, law=law, rise=f'"{rise} deg"', rest=f'"{rest} deg"', lift=lift)
    return lw.loads(text + more)


def test_undercut_in_the_last_interval_of_a_piece_is_told() -> None:
    """ρ = r₀ + s + s″ under a flat face: smallest where s′ + s‴ = 0, half a degree before the joint."""
    size = 'contact = "flat"\nbase_radius = 0.074098'
    profile = lw.cam_profile(machine(size, '{ kind = "modified_sine", share = 0.05 }', rise=60.0))
    law = profile.cam.lift
    phi = np.radians(np.linspace(55.0, 59.9, 200_001))
    rho = 0.074098 + law.at(phi) + law.at(phi, 2)
    assert rho.min() < 0
    # Samples 4e-7 rad apart miss the minimum by the square of that.
    assert profile.curvature_radius_convex_min == pytest.approx(rho.min(), abs=1e-12)
    assert "undercut" in lw.cam_faults(profile)[0]


@pytest.mark.parametrize(("share", "base", "lift"), [(0.01, 0.3, 0.4), (0.02, 1.3, 0.4), (0.1, 4.95, 0.1)])
def test_pressure_angle_beside_a_joint(share: float, base: float, lift: float) -> None:
    """tan γ = s′/(r₀ + s) of an edge in line, against samples 1e-7 of the ramp apart."""
    law = f'{{ kind = "combined", start = {share}, stop = {share} }}'
    profile = lw.cam_profile(machine(f'contact = "point"\nbase_radius = {base}', law, lift=lift))
    lift_law = profile.cam.lift
    phi = np.unique(
        np.concatenate(
            [np.linspace(a, b, 100_001) for a, b in zip(lift_law.breaks, lift_law.breaks[1:], strict=False)]
        )
    )
    gamma = np.arctan(np.abs(lift_law.at(phi, 1)) / (base + lift_law.at(phi)))
    assert profile.pressure_angle_max == pytest.approx(gamma.max(), abs=1e-9)
    assert profile.pressure_angle_max >= gamma.max() - 1e-15


def test_forces_on_both_sides_of_a_jump() -> None:
    """Parabolas: the acceleration jumps from +a to −a in the middle, and N cos γ = m s̈ + c s + F there."""
    more = """
[mechanism.points]
F = { x = 0.3, y = 0 }
[bodies]
c = { mass = 2 }
[loads]
s = { kind = "spring", between = ["F", "c"], stiffness = 10000, free_length = 0.34 }
"""
    found = machine("base_radius = 0.04\nroller_radius = 0.01", '"parabolic"', more=more)
    profile = lw.cam_profile(found)
    loaded = lw.loaded_cam(found, profile)
    omega, beta = 900 * 2 * np.pi / 60, np.radians(120.0)
    a = 4 * 0.02 * omega**2 / beta**2
    steep = np.arctan(2 * 0.02 / beta / 0.06)
    both = [(10_000 * (0.09 + 0.01) + 2 * sign * a) / np.cos(steep) for sign in (1, -1)]
    assert loaded.force_max == pytest.approx(both[0], rel=1e-7)
    assert loaded.force_max_angle == pytest.approx(np.radians(60.0), abs=1e-8)
    # Not the smallest of all, but there: on the later side of the jump.
    after = np.searchsorted(loaded.crank_angle, np.radians(60.0))
    assert loaded.force[after] == pytest.approx(both[1], rel=1e-7)
    assert loaded.force_min <= both[1] * (1 + 1e-8)


def test_a_short_section_presses_as_it_should() -> None:
    """A rise of 0.6° falls between whole degrees."""
    more = """
[bodies]
c = { mass = 1 }
[loads]
f = { kind = "force", on = "c", force = 1000, direction = "180 deg" }
"""
    found = machine("base_radius = 0.04\nroller_radius = 0.01", '"cycloidal"', rise=0.6, lift=2e-5, more=more)
    loaded = lw.loaded_cam(found, lw.cam_profile(found))
    assert loaded.speed_lost is not None
    assert (loaded.force_min < 0) == (loaded.speed_lost < loaded.speed)
    assert any("leaves cam" in text for text in loaded.findings) == (loaded.force_min < 0)


@pytest.mark.parametrize(
    ("size", "said"),
    [
        ("base_radius = 0.04\nroller_radius = 0.01\noffset = 0.05", "less than base_radius"),
        ("base_radius = 1e300\nroller_radius = 0.01", "between 1e-9 and 1e6 m"),
        ("base_radius = 0.04\nroller_radius = 0.01\nfriction = 0.1", "a roller, which rolls"),
        ('base_radius = 0.04\nfollower = "oscillating"\narm_pivot = "O"', "another place"),
    ],
)
def test_sizes_that_no_cam_has(size: str, said: str) -> None:
    if "oscillating" in size:
        text = ROLLER.replace("lift =", "swing =").format(
            size=size + '\ncontact = "flat"', rise='"120 deg"', rest='"60 deg"', lift=0.2, law='"cycloidal"'
        )
    else:
        text = ROLLER.format(size=size, rise='"120 deg"', rest='"60 deg"', lift=0.02, law='"cycloidal"')
    with pytest.raises(MachineError, match=said):
        lw.loads(text)
