r"""Forced vibration of a train: amplitudes, shaft torques and speed fluctuation at every speed.

At each speed Ω and order ν, with ω = νΩ,

.. math:: (-\omega^2 J + i\omega C + K)\,\theta_\nu = M_\nu

is solved directly, not by modes. The torque in a shaft is :math:`(k(1 + i\eta) + i\omega c)\,\Delta_\nu`, of
which kΔ twists the steel. All orders are added up in phase before their extremes are taken.

The speed fluctuation of a disc is :math:`\delta = (\omega_{max} - \omega_{min})/\omega_m`. Its motion
has a part in which the train rotates as a rigid body, :math:`q_r = \sum J q/\sum J`, and the torsional rest;
both have a δ of their own, and since they are not in phase the two do not add up.

References
----------
.. [1] Ker Wilson, Practical Solution of Torsional Vibration Problems, vol. 2, 1963, on phase-correct sums of
orders. .. [2] Den Hartog, Mechanical Vibrations, 4th ed. 1956, sections 5.4 to 5.6.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.public import public
from linkwright.kernel.quantities import Shown
from linkwright.machine.machine import Machine
from linkwright.torsion.response.excited_train import ExcitedTrain, excited_train
from linkwright.torsion.response.synthesis import Orders, span
from linkwright.torsion.response.torsion_response import TorsionResponse, response_by_amplitudes, responses

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]


@dataclass(frozen=True)
class ForcedVibration(TorsionResponse):
    """Forced vibration of a train over its speeds, with all that its shafts carry."""

    unevenness: Annotated[
        Floats, Shown("coefficient of speed fluctuation of each disc", "δ", "", shape="(discs, speeds)")
    ]
    unevenness_rigid: Annotated[
        Floats,
        Shown("coefficient of speed fluctuation of the train as a whole", "", "", shape="(discs, speeds)"),
    ]
    unevenness_torsional: Annotated[
        Floats, Shown("coefficient of speed fluctuation of the rest", "", "", shape="(discs, speeds)")
    ]
    disc_heat: Annotated[
        Floats, Shown("heat by the damping of each disc", "", "W", "Mean power.", shape="(discs, speeds)")
    ]
    power: Annotated[Floats, Shown("mean power of the pulsating torques", "", "W", "The sum of all heat.")]

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Curves over the speeds by name of shaft and disc."""
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


@public
def forced_vibration(machine: Machine, speeds: Floats | None = None) -> ForcedVibration:
    """Steady vibration of a train under its pulsating torques.

    Parameters
    ----------
    machine : Machine
        With a [train] that something excites.
    speeds : ndarray, shape (speeds,), optional
        Of the first disc; without them those of `[train.run]` [rad/s].

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
    return responded(excited_train(machine, speeds))


def responded(at: ExcitedTrain) -> ForcedVibration:
    """Steady vibration of a train that has been prepared."""
    q = responses(at)
    shafts = response_by_amplitudes(at, q)
    total, rigid, torsional = _unevenness(at, shafts.together, q)
    omega = shafts.orders[:, None, None] * shafts.speeds
    theta = shafts.amplitudes
    return ForcedVibration(
        **vars(shafts),
        unevenness=total,
        unevenness_rigid=rigid,
        unevenness_torsional=torsional,
        disc_heat=0.5 * (omega**2 * at.disc_damping * np.abs(theta) ** 2).sum(axis=0),
        power=0.5 * (at.torques.harmonics * (1j * omega * theta).conj()).real.sum(axis=(0, 1)),
    )


def _unevenness(at: ExcitedTrain, orders: Orders, q: Complexes) -> tuple[Floats, Floats, Floats]:
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


def angular_deflection(found: ForcedVibration, disc: str) -> tuple[Floats, Floats]:
    """Vibration of a disc at every speed, each order and all together.

    Gives `single`: (orders, speeds) amplitude of each order [rad]; `total`: (speeds,) half the peak-to-peak
    angle of all orders [rad].
    """
    theta = found.amplitudes[:, found.discs.index(disc)]
    greatest, least = span(found.together, theta)
    return np.abs(theta), 0.5 * (greatest - least)
