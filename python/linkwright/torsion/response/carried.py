r"""What the shafts of a train carry as it vibrates: torque, its extremes over all orders, heat.

The torque in a shaft is :math:`(k(1 + i\eta) + i\omega c)\,\Delta_\nu`, of which kΔ twists the steel. In a
shaft as good as rigid the twist is rounding, and its torque that of all inertia, damping and torques on one
side of it. All orders are added up in phase before their extremes are taken.

References
----------
.. [1] Ker Wilson, Practical Solution of Torsional Vibration Problems, vol. 2, 1963, on phase-correct sums of
    orders.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.result import Result
from linkwright.torsion.core.response import respond, shaft_torques
from linkwright.torsion.modes.free import lead_speeds
from linkwright.torsion.response.excited import Excited
from linkwright.torsion.response.synthesis import Orders, orders_together, span

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]


@dataclass(frozen=True)
class Carried(Result):
    """Vibration of the discs, and what the shafts carry in it.

    Attributes
    ----------
    speeds : ndarray, shape (speeds,)
        Of the first disc [rad/s].
    orders : ndarray, shape (orders,)
        Waves a turn of the first disc.
    discs, shafts : tuple of str
        As in `FreeVibration`.
    amplitudes : ndarray of complex, shape (orders, discs, speeds)
        θ of each disc beside its steady turning [rad].
    shaft_torques : ndarray of complex, shape (orders, shafts, speeds)
        At the first end, elastic and damping part together [N m].
    mean_torques : ndarray, shape (shafts, speeds)
        What the shafts carry [N m].
    torque_greatest, torque_least : ndarray, shape (shafts, speeds)
        Of mean and vibration together [N m].
    shaft_heat : ndarray, shape (shafts, speeds)
        Mean power that each shaft, coupling or damper turns to heat [W].
    """

    speeds: Floats
    orders: Floats
    discs: tuple[str, ...]
    shafts: tuple[str, ...]
    amplitudes: Complexes
    shaft_torques: Complexes
    mean_torques: Floats
    torque_greatest: Floats
    torque_least: Floats
    shaft_heat: Floats

    @property
    def shaft_torque_max(self) -> Floats:
        """Largest torque either way, mean and vibration together, shape (shafts, speeds) [N m]."""
        return np.maximum(self.torque_greatest, -self.torque_least)

    @property
    def shaft_torque_vibratory(self) -> Floats:
        """Half of greatest less least torque, shape (shafts, speeds) [N m]."""
        return 0.5 * (self.torque_greatest - self.torque_least)

    @property
    def together(self) -> Orders:
        """How the orders add up."""
        return orders_together(self.orders)


def carried(at: Excited) -> Carried:
    """What the shafts of a train carry.

    Parameters
    ----------
    at : Excited
        The train, its torques, and what it is at each speed.

    Returns
    -------
    Carried
        Not finite at a resonance without any damping.
    """
    return carried_by(at, responses(at))


def responses(at: Excited) -> Complexes:
    """Amplitudes of the masses of a train.

    Parameters
    ----------
    at : Excited
        The train.

    Returns
    -------
    ndarray of complex, shape (orders, masses, speeds)
        q, referred to the first disc [rad].
    """
    return respond(at.referred, at.operating, at.torques.orders, at.referred_harmonics())


def carried_by(at: Excited, q: Complexes) -> Carried:
    """What the shafts carry where the masses swing by some amplitudes.

    Parameters
    ----------
    at : Excited
        The train.
    q : ndarray of complex, shape (orders, masses, speeds)
        As of `responses` [rad].

    Returns
    -------
    Carried
        As `carried`.
    """
    referred, orders, speeds = at.referred, at.torques.orders, at.torques.speeds
    omega = orders[:, None, None] * speeds
    k, c, loss = at.operating.stiffness, referred.damping[:, None], referred.loss_factor[:, None]
    lead = lead_speeds(referred)[:, None]
    # Stiffness and damping are referred, so that the torque is too.
    imaginary = loss * k + omega * c
    flow = _flow(at, q, k + 1j * imaginary)
    torques = flow / lead
    greatest, least = span(orders_together(orders), torques, at.mean_torques)
    return Carried(
        speeds=speeds,
        orders=orders,
        discs=referred.discs,
        shafts=referred.shafts,
        amplitudes=referred.speed[:, None] * q[:, referred.mass],
        shaft_torques=torques,
        mean_torques=at.mean_torques,
        torque_greatest=greatest,
        torque_least=least,
        shaft_heat=0.5 * (omega * imaginary * _twist(flow, k + 1j * imaginary) ** 2).sum(axis=0),
    )


def _flow(at: Excited, q: Complexes, stiffness: Complexes) -> Complexes:
    """Torque of each shaft, referred to the first disc, (orders, shafts, speeds)."""
    omega = at.torques.orders[:, None, None] * at.torques.speeds
    outside = at.referred_harmonics()
    inertia = omega**2 * at.referred.inertia[:, None] * q
    damping = 1j * omega * at.operating.disc_damping * q
    size = np.abs(outside) + np.abs(inertia) + np.abs(damping)
    return shaft_torques(at.referred, stiffness, q, outside + inertia - damping, size)


def _twist(flow: Complexes, stiffness: Complexes) -> Floats:
    """Twist of each shaft, (orders, shafts, speeds) [rad]; 0 where nothing holds its ends together."""
    size = np.abs(stiffness)
    return np.abs(flow) / np.where(size > 0, size, 1.0) * (size > 0)
