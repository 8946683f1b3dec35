r"""Forced vibration of a train: amplitudes, shaft torques and unevenness at every speed.

At each speed Ω and order ν, with ω = νΩ,

.. math:: (-\omega^2 J + i\omega C + K)\,\theta_\nu = M_\nu

is solved directly, not by modes. The torque in a shaft is :math:`(k(1 + i\eta) + i\omega c)\,\Delta_\nu`, of
which kΔ twists the steel. All orders are added up in phase before their extremes are taken.

The unevenness of rotation of a disc is :math:`\delta = (\omega_{max} - \omega_{min})/\omega_m`. Its motion
has a part in which the train turns as a whole, :math:`q_r = \sum J q/\sum J`, and the torsional rest; both
have a δ of their own, and since they are not in phase the two do not add up.

References
----------
.. [1] Ker Wilson, Practical Solution of Torsional Vibration Problems, vol. 2, 1963, on phase-correct sums of
orders. .. [2] Den Hartog, Mechanical Vibrations, 4th ed. 1956, sections 5.4 to 5.6.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.analysis.result import Result
from linkwright.analysis.torsion.excited import Excited, excited
from linkwright.analysis.torsion.free import lead_speeds
from linkwright.analysis.torsion.synthesis import Orders, orders_together, span
from linkwright.engine.train_response import respond
from linkwright.machine import Machine

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]


@dataclass(frozen=True)
class ForcedVibration(Result):
    """Forced vibration of a train over its speeds.

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
    unevenness, unevenness_rigid, unevenness_torsional : ndarray, shape (discs, speeds)
        δ; of the train as a whole; of the rest.
    shaft_heat : ndarray, shape (shafts, speeds)
        Mean power that each shaft, coupling or damper turns to heat [W].
    disc_heat : ndarray, shape (discs, speeds)
        Mean power that damping of the discs takes [W].
    power : ndarray, shape (speeds,)
        Mean power of the pulsating torques, which is the sum of all heat [W].
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
    unevenness: Floats
    unevenness_rigid: Floats
    unevenness_torsional: Floats
    shaft_heat: Floats
    disc_heat: Floats
    power: Floats

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

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Curves over the speeds by name of shaft and disc.

        Parameters
        ----------
        curves : bool
            Whether heat, and the parts of the unevenness, are included.

        Returns
        -------
        dict
            Plain numbers, texts and lists, ready for JSON.
        """
        shafts: dict[str, Floats] = {
            "shaft_torque_max": self.shaft_torque_max,
            "shaft_torque_vibratory": self.shaft_torque_vibratory,
        }
        discs: dict[str, Floats] = {"unevenness": self.unevenness}
        if curves:
            shafts |= {"shaft_torque_mean": self.mean_torques, "shaft_heat": self.shaft_heat}
            discs |= {
                "unevenness_rigid": self.unevenness_rigid,
                "unevenness_torsional": self.unevenness_torsional,
            }
        return {
            "speeds": self.speeds.tolist(),
            "orders": self.orders.tolist(),
            **{name: _by_name(self.shafts, rows) for name, rows in shafts.items()},
            **{name: _by_name(self.discs, rows) for name, rows in discs.items()},
        }


def _by_name(names: tuple[str, ...], rows: Floats) -> Mapping[str, list[float]]:
    """A list for every name."""
    return dict(zip(names, rows.tolist(), strict=True))


def forced_vibration(machine: Machine, speeds: Floats | None = None) -> ForcedVibration:
    """Steady vibration of a train under its pulsating torques.

    Parameters
    ----------
    machine : Machine
        With a [train] that something excites.
    speeds : ndarray, shape (speeds,), optional
        Of the first disc; without them those of [train.run] [rad/s].

    Returns
    -------
    ForcedVibration
        Amplitudes are infinite or NaN at a resonance without any damping.

    Raises
    ------
    InputError
        Nothing excites the train, or it has no speeds.

    References
    ----------
    .. [1] Ker Wilson, Practical Solution of Torsional Vibration Problems, vol. 2, 1963.
    """
    return responded(excited(machine, speeds))


def responded(at: Excited) -> ForcedVibration:
    """Steady vibration of a train that has been prepared.

    Parameters
    ----------
    at : Excited
        The train, its torques, and what it is at each speed.

    Returns
    -------
    ForcedVibration
        As `forced_vibration`.
    """
    referred, torques = at.referred, at.torques
    orders = torques.orders
    q = respond(referred, at.operating, orders, at.referred_harmonics())
    theta = referred.speed[:, None] * q[:, referred.mass]
    omega = orders[:, None, None] * torques.speeds
    elastic, damping = _twisting(at, q, omega)
    shaft_torques = elastic + damping
    mean = at.mean_torques
    together = orders_together(orders)
    greatest, least = span(together, shaft_torques, mean)
    total, rigid, torsional = _unevenness(at, together, q)
    shaft_heat, disc_heat = _heat(at, q, omega)
    power = 0.5 * (torques.harmonics * (1j * omega * theta).conj()).real.sum(axis=(0, 1))
    return ForcedVibration(
        speeds=torques.speeds,
        orders=orders,
        discs=referred.discs,
        shafts=referred.shafts,
        amplitudes=theta,
        shaft_torques=shaft_torques,
        mean_torques=mean,
        torque_greatest=greatest,
        torque_least=least,
        unevenness=total,
        unevenness_rigid=rigid,
        unevenness_torsional=torsional,
        shaft_heat=shaft_heat,
        disc_heat=disc_heat,
        power=power,
    )


def _differences(at: Excited, q: Complexes) -> Complexes:
    """q of the first less that of the second end of each shaft, (orders, shafts, speeds)."""
    # The ground is a last mass that stands still, HELD = −1.
    held = np.concatenate([q, np.zeros_like(q[:, :1])], axis=1)
    first, second = at.referred.ends.T
    found: Complexes = held[:, first] - held[:, second]
    return found


def _twisting(at: Excited, q: Complexes, omega: Floats) -> tuple[Complexes, Complexes]:
    """Elastic and damping torque of each shaft at its own speed."""
    referred = at.referred
    lead = lead_speeds(referred)[:, None]
    twist = _differences(at, q) / lead
    k = at.operating.stiffness
    elastic = k * twist
    damping = 1j * (referred.loss_factor[:, None] * k + omega * referred.damping[:, None]) * twist
    return elastic, damping


def _unevenness(at: Excited, orders: Orders, q: Complexes) -> tuple[Floats, Floats, Floats]:
    """δ of every disc: in all, as a whole, and torsional."""
    referred = at.referred
    J = referred.inertia
    # Referred, δ of a mass is that of its discs: speed and mean speed both count n times.
    speed = 1j * orders.values[:, None, None] * q
    whole = np.einsum("m,omw->ow", J, speed)[:, None] / J.sum()
    if not referred.is_free:
        whole = np.zeros_like(whole)
    found = []
    for part in (speed, np.broadcast_to(whole, speed[:, :1].shape), speed - whole):
        greatest, least = span(orders, part)
        found.append(greatest - least)
    total, rigid, torsional = found
    mass = referred.mass
    return total[mass], np.repeat(rigid, len(mass), axis=0), torsional[mass]


def _heat(at: Excited, q: Complexes, omega: Floats) -> tuple[Floats, Floats]:
    """Mean power that shafts and discs turn to heat."""
    referred = at.referred
    twist = np.abs(_differences(at, q)) ** 2
    k, c = at.operating.stiffness, referred.damping[:, None]
    shafts = 0.5 * ((omega**2 * c + omega * referred.loss_factor[:, None] * k) * twist).sum(axis=0)
    swing = np.abs(q[:, referred.mass] * referred.speed[:, None]) ** 2
    discs = 0.5 * (omega**2 * at.disc_damping * swing).sum(axis=0)
    return shafts, discs


def angular_deflection(found: ForcedVibration, disc: str) -> tuple[Floats, Floats]:
    """Vibration of a disc at every speed, each order and all together.

    Parameters
    ----------
    found : ForcedVibration
        The result.
    disc : str
        Name of the disc.

    Returns
    -------
    single : ndarray, shape (orders, speeds)
        Amplitude of each order [rad].
    total : ndarray, shape (speeds,)
        Half of greatest less least angle of all orders [rad].
    """
    theta = found.amplitudes[:, found.discs.index(disc)]
    greatest, least = span(found.together, theta)
    return np.abs(theta), 0.5 * (greatest - least)
