"""Speed fluctuation over the cylinders: closed forms, δ in the limit of one cylinder, dense sampling."""

from __future__ import annotations

from itertools import pairwise

import firing
import numpy as np
import pytest

import linkwright as lw
from linkwright import InputError
from linkwright.torsion import UnevennessAlong, excited_train, responded, unevenness_along

# Shafts as good as rigid.
STIFF = {"stiffness": 1e12, "coupling": 1e12}


def along(machine: lw.Machine, angles: dict[str, float], speed: float, turns: int = 2) -> UnevennessAlong:
    at = excited_train(machine, np.array([speed]))
    return unevenness_along(at, responded(at), angles, turns, speed)


def test_equal_cylinders_on_a_stiff_shaft_have_one_share() -> None:
    """Only order 3, 6 and 2 (inertia, which cancels out) are left of six even cylinders."""
    found = along(firing.engine(**STIFF), firing.firing_angles(), 60.0)
    # Torsion is left with some 10⁻⁷.
    np.testing.assert_allclose(found.share, found.share[0, 0], rtol=1e-6)
    np.testing.assert_allclose(found.unevenness, found.unevenness_rigid, rtol=1e-6)
    np.testing.assert_allclose(found.spread, 0, atol=1e-6)


def test_one_order_rises_and_falls_by_twice_its_amplitude() -> None:
    """Rigid: Σ M = 6 M₃, amplitude of the speed over the mean = 6 M₃/(ν Ω² ΣJ)."""
    machine = firing.engine(**STIFF, orders=np.array([3.0]), damping=0.0)
    inertia = 6 * 0.06 + 2.5 + 0.8
    found = along(machine, firing.firing_angles(), 60.0)
    wanted = 2 * 6 * abs(firing.gas(3.0)) / (3.0 * 60.0**2 * inertia)
    # The shafts twist by some 10⁻⁸ of it; the inertia torques of order 2 cancel out to rounding.
    np.testing.assert_allclose(found.unevenness, wanted, rtol=1e-6)
    np.testing.assert_allclose(found.unevenness_rigid, wanted, rtol=1e-9)


def test_one_cylinder_makes_n_the_coefficient_of_unevenness() -> None:
    machine = firing.engine(order=(1,))
    at = excited_train(machine, np.array([70.0]))
    forced = responded(at)
    found = unevenness_along(at, forced, {"1": 0.3}, 2, 70.0)
    # Extremes of δ are exact, of N refined by Newton to rounding.
    np.testing.assert_allclose(found.unevenness, forced.unevenness[:, 0], rtol=1e-9)
    np.testing.assert_allclose(found.unevenness_rigid, forced.unevenness_rigid[:, 0], rtol=1e-9)
    np.testing.assert_allclose(found.unevenness_torsional, forced.unevenness_torsional[:, 0], rtol=1e-9)


def test_shares_are_those_of_a_densely_sampled_speed() -> None:
    machine = firing.engine([1, 1, 0.4, 1, 0.9, 1])
    at = excited_train(machine, np.array([80.0]))
    forced = responded(at)
    angles = firing.firing_angles()
    found = unevenness_along(at, forced, angles, 2, 80.0)
    phi = np.linspace(0, 4 * np.pi, 120_001)
    waves = np.exp(1j * forced.orders[:, None] * phi)
    speed = np.einsum("od,op->dp", 1j * forced.orders[:, None] * forced.amplitudes[:, :, 0], waves).real
    listed = [*sorted(angles.values()), 4 * np.pi]
    for n, (start, end) in enumerate(pairwise(listed)):
        inside = (phi >= start - 1e-12) & (phi <= end + 1e-12)
        np.testing.assert_allclose(found.share[:, n], np.ptp(speed[:, inside], axis=1), rtol=1e-5)
    assert found.cylinders == ("1", "5", "3", "6", "2", "4")


def test_n_differs_along_an_elastic_shaft() -> None:
    """At the free end near a resonance it is far from that of the rigid train."""
    machine = firing.engine()
    omega = 2 * np.pi * lw.free_vibration(machine).natural_frequencies[2]
    found = along(machine, firing.firing_angles(), omega / 3)
    assert found.unevenness[0] > 2 * found.unevenness_rigid[0]
    np.testing.assert_allclose(found.unevenness_rigid, found.unevenness_rigid[0])


def test_a_weak_cylinder_shows_in_its_share_and_in_the_spread() -> None:
    healthy = along(firing.engine(**STIFF), firing.firing_angles(), 60.0)
    weak = along(firing.engine([1, 1, 0.2, 1, 1, 1], **STIFF), firing.firing_angles(), 60.0)
    assert weak.spread[0] > 0.2 * healthy.unevenness[0]
    # The speed rises by the smallest amount in the share of cylinder 3.
    assert weak.cylinders[int(np.argmin(weak.share[0]))] in ("3", "5", "6")


def test_disc_behind_a_gear_counts_at_its_own_speed() -> None:
    text = """
format = 1
name = "Geared"
[train.discs]
a = { inertia = 2 }
b = { inertia = 1 }
[train.gears]
g = { between = ["a", "b"], ratio = 3 }
[train.excitations.pulse]
on = "a"
harmonics = [{ order = 2, torque = 50 }]
"""
    found = along(lw.loads(text), {"1": 0.0, "2": np.pi}, 20.0, turns=1)
    np.testing.assert_allclose(found.share, found.share[0, 0], rtol=1e-12)


def test_orders_that_do_not_repeat_with_the_cycle_are_left_out() -> None:
    text = """
format = 1
name = "Two discs"
[train.discs]
a = { inertia = 2 }
b = { inertia = 1 }
[train.shafts]
s = { between = ["a", "b"], stiffness = 1e4 }
[train.excitations.pulse]
on = "a"
harmonics = [{ order = 2, torque = 50 }, { order = 1.3, torque = 50 }]
"""
    both = lw.loads(text)
    one = lw.loads(text.replace(", { order = 1.3, torque = 50 }", ""))
    angles = {"1": 0.0, "2": 1.5}
    np.testing.assert_allclose(along(both, angles, 20.0).share, along(one, angles, 20.0).share)


@pytest.mark.parametrize(
    ("angles", "word"), [({"1": 0.5, "2": 0.5 + 4 * np.pi}, "fire at once"), ({}, "no cylinder")]
)
def test_cylinders_that_have_no_interval(angles: dict[str, float], word: str) -> None:
    with pytest.raises(InputError, match=word):
        along(firing.engine(), angles, 60.0)
