"""Torques in shafts from soft to as good as rigid: equilibrium of every part, the limit of rigid shafts."""

from __future__ import annotations

import numpy as np
import pytest

import linkwright as lw
from linkwright.torsion import ExcitedTrain, ForcedVibration, excited_train, responded

SPEEDS = np.array([17.0, 40.0, 63.0])

TRAIN = """
format = 1
name = "Five discs, branched, with a gear and two shafts in parallel"
[train.discs]
a = {{ inertia = 2, damping = 3 }}
b = {{ inertia = 3 }}
c = {{ inertia = 5 }}
d = {{ inertia = 0.7 }}
e = {{ inertia = 1.3, damping = 0.4 }}
[train.gears]
g = {{ between = ["b", "d"], ratio = 2.5 }}
[train.shafts]
stiff = {{ between = ["b", "a"], stiffness = {k!r}, loss_factor = 0.01 }}
beside = {{ between = ["a", "b"], stiffness = {third!r}, loss_factor = 0.01 }}
soft = {{ between = ["b", "c"], stiffness = 1e4, damping = 5 }}
branch = {{ between = ["d", "e"], stiffness = {k!r} }}
[train.excitations.pulse]
on = "a"
harmonics = [{{ order = 2, torque = 80 }}, {{ order = 3, torque = 20, phase = 1 }}]
[train.loads.l]
on = "e"
torque = 300
speed = 50
"""


def vibration(k: float) -> tuple[ForcedVibration, ExcitedTrain]:
    at = excited_train(lw.loads(TRAIN.format(k=k, third=k / 3)), SPEEDS)
    return responded(at), at


@pytest.mark.parametrize("k", [10.0**n for n in range(3, 19)])
def test_every_part_is_in_equilibrium(k: float) -> None:
    found, at = vibration(k)
    stiff, beside, soft, branch = (found.shaft_torques[:, n] for n in range(4))
    theta, omega = found.amplitudes, found.orders[:, None] * found.speeds
    pulse = np.array([80.0, 20.0 * np.exp(1j)])[:, None]

    def inertia(disc: int, J: float, c: float | np.ndarray) -> np.ndarray:
        return (-(omega**2) * J + 1j * omega * c) * theta[:, disc]

    # What drives disc a: the pulse, less what both shafts take on to b, of which one is drawn the other way.
    left = pulse + stiff - beside - inertia(0, 2.0, 3.0)
    np.testing.assert_allclose(left, 0, atol=1e-12 * 80)
    # The damping of the disc, and the slope of its load over the speed.
    left = at.torques.harmonics[:, 4] + branch - inertia(4, 1.3, at.disc_damping[4])
    np.testing.assert_allclose(left, 0, atol=1e-12 * 80)
    np.testing.assert_allclose(soft, inertia(2, 5.0, 0.0), rtol=1e-11)
    np.testing.assert_allclose(-stiff, 3 * beside, rtol=1e-12)


@pytest.mark.parametrize("k", [1e12, 1e14, 1e16, 1e18])
def test_limit_of_rigid_shafts(k: float) -> None:
    """The change from one stiffness to the next falls with 1/k: 1e11 N m/rad tells all that is left of it."""
    (near, _), (far, _) = vibration(1e11), vibration(k)
    for name in ("shaft_torques", "mean_torques", "amplitudes", "torque_greatest"):
        wanted = getattr(near, name)
        np.testing.assert_allclose(getattr(far, name), wanted, rtol=2e-6, atol=1e-9 * np.abs(wanted).max())
    # Heat of hysteresis, η T²/k, has the torque's digits.
    np.testing.assert_allclose(k * far.shaft_heat[0], 1e11 * near.shaft_heat[0], rtol=1e-5)


def test_mean_torques_are_those_of_statics() -> None:
    """The driver's torque goes through both shafts, as 3 to 1, and on through the gear to a slower disc."""
    for k in (1e3, 1e9, 1e18):
        found, _ = vibration(k)
        load = 300 * (SPEEDS / 2.5 / 50) ** 2
        np.testing.assert_allclose(found.mean_torques[3], load, rtol=1e-14)
        np.testing.assert_allclose(found.mean_torques[0], -0.75 * load / 2.5, rtol=1e-14)
        np.testing.assert_allclose(found.mean_torques[1], 0.25 * load / 2.5, rtol=1e-14)
