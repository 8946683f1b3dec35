"""Shaking couples: free forces and couples of engines in line as printed, rotating masses in two planes."""

from __future__ import annotations

import numpy as np
import pytest

import linkwright as lw
from linkwright import InputError

RADIUS, ROD, MASS, SPACING, SPEED = 0.05, 0.2, 0.8, 0.1, 300.0
RATIO = RADIUS / ROD

# The second order of a piston's acceleration over λ r ω², 1 + λ²/4 + 15 λ⁴/128 + …: that of √(ℓ² − r² sin²φ).
_ROD_ALONG = np.sqrt(1 - (RATIO * np.sin(np.arange(64) * np.pi / 32)) ** 2)
SECOND = 4 * 2 * np.fft.rfft(_ROD_ALONG)[2].real / 64 / RATIO**2


def engine(angles: list[float]) -> lw.Machine:
    n = len(angles)
    places = (np.arange(n) - (n - 1) / 2) * SPACING
    return lw.Machine.model_validate(
        {
            "format": 1,
            "name": "in line",
            "drive": {"speed": SPEED},
            "mechanism": {
                "cranks": {f"A{i}": {"radius": RADIUS, "phase": np.radians(x)} for i, x in enumerate(angles)},
                "sliders": {f"P{i}": {"crank": f"A{i}", "rod": ROD, "angle": np.pi / 2} for i in range(n)},
            },
            "bodies": {f"P{i}": {"mass": MASS, "axial": z} for i, z in enumerate(places.tolist())},
        }
    )


# Bosch, Automotive Handbook, free forces and couples of engines in line: forces of the first and second order
# over F and λ F, couples over F a and λ F a. The sixth column is what the printed numbers are good for.
IN_LINE = [
    ([0, 180], 0, 2, 1, 0, 1e-9),
    ([0, 120, 240], 0, 0, 1.732, 1.732, 5e-4),
    ([0, 180, 180, 0], 0, 4, 0, 0, 1e-9),
    ([0, 144, 216, 288, 72], 0, 0, 0.449, 4.980, 5e-4),
    ([0, 120, 240, 240, 120, 0], 0, 0, 0, 0, 1e-9),
]


@pytest.mark.parametrize(("angles", "force_1", "force_2", "couple_1", "couple_2", "digits"), IN_LINE)
def test_free_forces_and_couples_of_engines_in_line(
    angles: list[float], force_1: float, force_2: float, couple_1: float, couple_2: float, digits: float
) -> None:
    found = lw.shaking_orders(engine(angles))
    F = MASS * RADIUS * SPEED**2
    forces = found.force_max[:2] / (F * np.array([1, RATIO * SECOND]))
    couples = found.couple_max[:2] / (F * SPACING * np.array([1, RATIO * SECOND]))
    np.testing.assert_allclose(forces, [force_1, force_2], atol=1e-7)
    np.testing.assert_allclose(couples, [couple_1, couple_2], atol=max(digits, 1e-7))


def test_the_orders_add_up_to_the_couple() -> None:
    machine = engine([0, 120, 240])
    forces, found = lw.forces(machine), lw.shaking_orders(machine, highest=30)
    angles = np.arange(31)[:, None] * forces.crank_angle
    couple = found.couple.cosine.T @ np.cos(angles) + found.couple.sine.T @ np.sin(angles)
    assert forces.shaking_couple is not None
    np.testing.assert_allclose(couple.T, forces.shaking_couple, atol=1e-9 * np.abs(couple).max())


def shaft(masses: list[tuple[float, float, float, float]]) -> lw.Machine:
    """A shaft with masses (mass, radius, angle, place along it)."""
    bodies = {
        f"m{i}": {"on": "S", "mass": m, "inertia": 0.0, "along": r * np.cos(a), "across": r * np.sin(a)}
        | {"axial": z}
        for i, (m, r, a, z) in enumerate(masses)
    }
    drive = {"speed": SPEED}
    mechanism = {"cranks": {"S": {"radius": 0.1}}}
    return lw.Machine.model_validate(
        {"format": 1, "name": "shaft", "drive": drive, "mechanism": mechanism, "bodies": bodies}
    )


def test_rotating_masses_are_balanced_in_two_planes() -> None:
    masses = [(200, 0.08, 0.0, 0.0), (300, 0.07, 0.7854, 0.3), (400, 0.06, 2.007, 0.4), (200, 0.08, 4.1, 0.7)]
    found = lw.balance(shaft(masses), ["S"], planes=(0.1, 0.5), radius=0.1)
    u = np.array([m * r * np.exp(1j * a) for m, r, a, _ in masses])
    z = np.array([z for *_, z in masses])
    second = -(u * (z - 0.1)).sum() / 0.4
    for weight, wanted in zip(found.counterweights, (-u.sum() - second, second), strict=True):
        assert weight.moment == pytest.approx(abs(wanted), rel=1e-9)
        assert weight.angle == pytest.approx(np.angle(wanted), rel=1e-9)
    force, couple = (found.measures()[name] for name in ("shaking_force", "shaking_couple"))
    assert force[1] < 1e-12 * force[0]
    assert couple[1] < 1e-12 * couple[0]


def test_one_plane_leaves_the_couple() -> None:
    masses = [(2.0, 0.05, 0.0, 0.2), (2.0, 0.05, np.pi, -0.2)]
    found = lw.balance(shaft([*masses, (1.0, 0.05, 1.0, 0.0)]), ["S"], planes=(0.1,))
    force, couple = (found.measures()[name] for name in ("shaking_force", "shaking_couple"))
    assert force[1] < 1e-12 * force[0]
    assert couple[1] > 0.5 * couple[0]


@pytest.mark.parametrize("planes", [(0.1, 0.1), (0.1, 0.2, 0.3)])
def test_other_planes_are_refused(planes: tuple[float, ...]) -> None:
    with pytest.raises(InputError, match="one plane, or two that are apart"):
        lw.balance(engine([0, 120, 240]), ["A0"], planes=planes)


def test_without_places_there_is_no_couple() -> None:
    machine = lw.read("four_bar_counterweights")
    assert lw.forces(machine, speed=1.0).shaking_couple is None
    assert lw.shaking_orders(machine, speed=1.0).couple_max.max() == 0.0
