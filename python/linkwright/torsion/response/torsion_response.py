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
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.quantities import About, Shown
from linkwright.kernel.result import Result
from linkwright.torsion.core.response import respond, shaft_torques
from linkwright.torsion.modes.free import lead_speeds
from linkwright.torsion.response.excited_train import ExcitedTrain
from linkwright.torsion.response.synthesis import Orders, orders_together, span

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]


@dataclass(frozen=True)
class TorsionResponse(Result):
    """Vibration of the discs, and what the shafts carry in it."""

    speeds: Annotated[Floats, Shown("speed of the first disc", "ω", "rad/s", shape="(speeds,)")]
    orders: Annotated[
        Floats, Shown("excitation order of the first disc", "ν", "", shape="(orders,)", over="orders")
    ]
    discs: Annotated[tuple[str, ...], About("As in `FreeVibration`.")]
    shafts: Annotated[tuple[str, ...], About("As in `FreeVibration`.")]
    amplitudes: Annotated[
        Complexes,
        Shown(
            "angle of each disc beside its steady turning",
            "θ",
            "rad",
            "Complex, by orders.",
            shape="(orders, discs, speeds)",
        ),
    ]
    shaft_torques: Annotated[
        Complexes,
        Shown(
            "torque at the first end of each shaft",
            "",
            "N m",
            "Complex, by orders; elastic and damping part together.",
            shape="(orders, shafts, speeds)",
        ),
    ]
    mean_torques: Annotated[Floats, Shown("mean torque of each shaft", "", "N m", shape="(shafts, speeds)")]
    torque_greatest: Annotated[
        Floats,
        Shown(
            "maximum torque of each shaft",
            "",
            "N m",
            "Mean and vibration together.",
            shape="(shafts, speeds)",
        ),
    ]
    torque_least: Annotated[
        Floats,
        Shown(
            "minimum torque of each shaft",
            "",
            "N m",
            "Mean and vibration together.",
            shape="(shafts, speeds)",
        ),
    ]
    shaft_heat: Annotated[
        Floats,
        Shown("heat of each shaft, coupling or damper", "", "W", "Mean power.", shape="(shafts, speeds)"),
    ]

    @property
    def shaft_torque_max(
        self,
    ) -> Annotated[Floats, Shown("largest torque of each shaft", "", "N m", shape="(shafts, speeds)")]:
        """Either way, mean and vibration together."""
        return np.maximum(self.torque_greatest, -self.torque_least)

    @property
    def shaft_torque_vibratory(
        self,
    ) -> Annotated[Floats, Shown("vibratory torque of each shaft", "", "N m", shape="(shafts, speeds)")]:
        """Half the peak-to-peak torque."""
        return 0.5 * (self.torque_greatest - self.torque_least)

    @property
    def together(self) -> Orders:
        """How the orders add up."""
        return orders_together(self.orders)


def torsion_response(at: ExcitedTrain) -> TorsionResponse:
    """What the shafts of a train carry. Not finite at a resonance without any damping."""
    return response_by_amplitudes(at, responses(at))


def responses(at: ExcitedTrain) -> Complexes:
    """Amplitudes of the masses of a train, (orders, masses, speeds). q, referred to the first disc [rad]."""
    return respond(at.referred, at.operating, at.torques.orders, at.referred_harmonics())


def response_by_amplitudes(at: ExcitedTrain, q: Complexes) -> TorsionResponse:
    """What the shafts carry where the masses swing by some amplitudes.

    `q`: (orders, masses, speeds) as of `responses` [rad].
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
    return TorsionResponse(
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


def _flow(at: ExcitedTrain, q: Complexes, stiffness: Complexes) -> Complexes:
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
