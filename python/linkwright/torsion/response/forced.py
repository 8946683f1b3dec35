r"""Forced vibration of a train: amplitudes, shaft torques, heat and speed fluctuation at every speed.

At each speed Ω and order ν, with ω = νΩ,

.. math:: (-\omega^2 J + i\omega C + K)\,\theta_\nu = M_\nu

is solved directly, not by modes. The torque in a shaft is :math:`(k(1 + i\eta) + i\omega c)\,\Delta_\nu`, of
which kΔ twists the steel. All orders are added up in phase before their extremes are taken.

The speed fluctuation of a disc is :math:`\delta = (\omega_{max} - \omega_{min})/\omega_m`. Its motion has a
part in which the train rotates as a rigid body, :math:`q_r = \sum J q/\sum J`, and the torsional rest; both
have a δ of their own, and since they are not in phase the two do not add up.

In a shaft practically rigid the twist is rounding, and its torque that of all inertia, damping and torques on
one side of it.

References
----------
.. [1] Ker Wilson, Practical Solution of Torsional Vibration Problems, vol. 2, 1963, on phase-correct sums of
   orders.
.. [2] Den Hartog, Mechanical Vibrations, 4th ed. 1956, sections 5.4 to 5.6.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.arrays import Complexes, Floats
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.kernel.units.kinds import SPEED
from linkwright.kernel.units.marks import not_negative
from linkwright.machine.machine import Machine
from linkwright.torsion.core.response import by_columns, respond, shaft_torques
from linkwright.torsion.excitation.excited_train import ExcitedTrain, excited_train
from linkwright.torsion.excitation.harmonics import Orders, line_words, orders_together, span
from linkwright.torsion.response.along_shaft import worst_place

Places = NDArray[np.int64]


@dataclass(frozen=True)
class TorsionResponse(Result):
    """Vibration of the discs, and what the shafts carry in it."""

    speeds: Annotated[Floats, Label("speed of the first disc", "ω", "rad/s", shape="(speeds,)")]
    orders: Annotated[
        Floats, Label("excitation order of the first disc", "ν", "", shape="(orders,)", over="orders")
    ]
    discs: Annotated[tuple[str, ...], About("As in `FreeVibration`.")]
    shafts: Annotated[tuple[str, ...], About("As in `FreeVibration`.")]
    amplitudes: Annotated[
        Complexes,
        Label(
            "vibration angle of each disc",
            "θ",
            "rad",
            "Complex, by orders.",
            shape="(orders, discs, speeds)",
        ),
    ]
    shaft_torques: Annotated[
        Complexes,
        Label(
            "torque at the first end of each shaft",
            "",
            "N m",
            "Complex, by orders; elastic and damping part together.",
            shape="(orders, shafts, speeds)",
        ),
    ]
    mean_torques: Annotated[Floats, Label("mean torque of each shaft", "", "N m", shape="(shafts, speeds)")]
    torque_greatest: Annotated[
        Floats,
        Label(
            "maximum torque of each shaft",
            "",
            "N m",
            "Mean and vibration together.",
            shape="(shafts, speeds)",
        ),
    ]
    torque_least: Annotated[
        Floats,
        Label(
            "minimum torque of each shaft",
            "",
            "N m",
            "Mean and vibration together.",
            shape="(shafts, speeds)",
        ),
    ]
    shaft_heat: Annotated[
        Floats,
        Label("heat of each shaft, coupling or damper", "", "W", "Mean power.", shape="(shafts, speeds)"),
    ]

    places: Annotated[
        Mapping[str, Places],
        About(
            "Station of each shaft with distributed inertia at which its torque is given, as a piece of "
            "it at each speed: where the torque comes closest to the permitted torque of the section."
        ),
    ] = field(default_factory=dict, kw_only=True)

    @property
    def shaft_torque_max(
        self,
    ) -> Annotated[Floats, Label("largest torque of each shaft", "", "N m", shape="(shafts, speeds)")]:
        """Either way, mean and vibration together."""
        return np.maximum(self.torque_greatest, -self.torque_least)

    @property
    def shaft_torque_vibratory(
        self,
    ) -> Annotated[Floats, Label("vibratory torque of each shaft", "", "N m", shape="(shafts, speeds)")]:
        """Half the peak-to-peak torque."""
        return 0.5 * (self.torque_greatest - self.torque_least)

    fixed: Annotated[
        Floats,
        Label(
            "fixed frequency beside the order",
            "f",
            "rad/s",
            "Adds to that of the order; empty where all lines are orders.",
            shape="(orders,)",
        ),
    ] = field(default_factory=lambda: np.empty(0), kw_only=True)

    @property
    def offsets(
        self,
    ) -> Annotated[
        Floats, Label("fixed frequency beside each order, 0 for none", "", "rad/s", shape="(orders,)")
    ]:
        """Fixed frequency of every line, 0 of an order, (orders,) [rad/s]."""
        return self.fixed if len(self.fixed) else np.zeros(len(self.orders))

    @property
    def omega(
        self,
    ) -> Annotated[Floats, Label("angular frequency of each line", "", "rad/s", shape="(orders, 1, speeds)")]:
        """Angular frequency of every line, (orders, 1, speeds) [rad/s]."""
        return np.abs(np.outer(self.orders, self.speeds) + self.offsets[:, None])[:, None]

    @property
    def lines(self) -> tuple[str, ...]:
        """The orders in words, those of a fixed frequency with it."""
        return tuple(map(line_words, self.orders.tolist(), self.offsets.tolist()))

    @property
    def together(self) -> Orders:
        """How the orders add up."""
        return orders_together(self.orders, self.offsets)


def torsion_response(at: ExcitedTrain) -> TorsionResponse:
    """What the shafts of a train carry. Not finite at a resonance without any damping."""
    return response_by_amplitudes(at, responses(at))


def responses(at: ExcitedTrain) -> Complexes:
    """Amplitudes of the masses of a train, (orders, masses, speeds). q, referred to the first disc [rad]."""
    return respond(at.referred, at.operating, at.torques.orders, at.referred_harmonics, at.torques.fixed)


# At a resonance without damping amplitudes are not finite, nor are torques.
@np.errstate(invalid="ignore", over="ignore")
def response_by_amplitudes(at: ExcitedTrain, q: Complexes) -> TorsionResponse:
    """What the shafts carry where the masses swing by `q` (orders, masses, speeds) [rad]."""
    referred, orders, speeds = at.referred, at.torques.orders, at.torques.speeds
    omega = at.torques.omega[:, None]
    lead = referred.lead[:, None]
    # Stiffness and damping are referred, so that the torque is too.
    imaginary = _losses(at)
    stiffness = spring_stiffness(at, imaginary)
    flow = shaft_flow(at, q, stiffness)
    torques, heat = flow / lead, 0.5 * (omega * imaginary * _twist_squared(flow, stiffness)).sum(axis=0)
    places = {}
    for n, rod in enumerate(at.referred.rods):
        name = referred.shafts[rod.shaft]
        place = worst_place(at, q, flow[:, rod.shaft], n)
        places[name], torques[:, rod.shaft], heat[rod.shaft] = place.piece, place.torques, place.heat
    greatest, least = span(at.torques.together, torques, at.mean_torques)
    return TorsionResponse(
        speeds=speeds,
        orders=orders,
        discs=referred.discs,
        shafts=referred.shafts,
        amplitudes=referred.scale[:, None] * q[:, referred.mass],
        shaft_torques=torques,
        mean_torques=at.mean_torques,
        torque_greatest=greatest,
        torque_least=least,
        shaft_heat=heat,
        places=places,
        fixed=at.torques.fixed,
    )


def _losses(at: ExcitedTrain) -> Floats:
    """ηk + ωc of each shaft, (orders, shafts, speeds) [N m/rad]."""
    omega = at.torques.omega[:, None]
    c, loss = by_columns(at.referred.damping), by_columns(at.referred.loss_factor)
    losses: Floats = loss * at.operating.stiffness + omega * c
    return losses


def spring_stiffness(at: ExcitedTrain, losses: Floats | None = None) -> Complexes:
    """Torque per twist, (orders, shafts, speeds) [N m/rad]; `losses`: its imaginary part, if known."""
    if at.distributed is not None:
        return at.distributed.stiffness
    return _complex(at.operating.stiffness, _losses(at) if losses is None else losses)


@np.errstate(invalid="ignore", over="ignore")
def shaft_flow(at: ExcitedTrain, q: Complexes, stiffness: Complexes) -> Complexes:
    """Torque of each shaft at the first disc, (orders, shafts, speeds); of a rod that of its spring."""
    omega = at.torques.omega
    outside = at.referred_harmonics
    forces, size = outside.copy(), np.abs(outside)
    # Masses one by one stay in the cache.
    for m, J in enumerate(at.referred.inertia):
        inertia = omega**2 * (J if at.distributed is None else at.distributed.inertia[:, m])
        damping = omega * at.operating.disc_damping[m]
        forces[:, m] += _complex(inertia.real, inertia.imag - damping) * q[:, m]
        size[:, m] += (np.abs(inertia) + np.abs(damping)) * np.abs(q[:, m])
    if at.operating.disc_stiffness is not None:
        held = at.operating.disc_stiffness[:, None] * q
        forces, size = forces - held, size + np.abs(held)
    if at.operating.modal is not None:
        modal = at.operating.modal.torques(1j * omega[:, None] * q)
        forces, size = forces - modal, size + np.abs(modal)
    flow = shaft_torques(at.referred, stiffness, q, forces, size)
    if at.joint_twists is not None:
        flow = flow + stiffness * at.joint_twists / at.referred.lead[:, None]
    return flow


def _complex(real: Floats, imaginary: Floats) -> Complexes:
    made = np.empty(imaginary.shape, complex)
    made.real, made.imag = real, imaginary
    return made


def _squared(z: Complexes) -> Floats:
    """|z|², without its root."""
    size: Floats = z.real**2 + z.imag**2
    return size


def _twist_squared(flow: Complexes, stiffness: Complexes) -> Floats:
    """|Δ|² of each shaft, (orders, shafts, speeds) [rad²]; 0 where nothing holds its ends together."""
    size = _squared(stiffness)
    return np.divide(_squared(flow), size, out=np.zeros_like(size), where=size > 0)


@dataclass(frozen=True)
class ForcedVibration(TorsionResponse):
    """Forced vibration of a train over its speeds, with all that its shafts carry.

    Not finite at a resonance without any damping.
    """

    unevenness: Annotated[
        Floats, Label("coefficient of speed fluctuation of each disc", "δ", "", shape="(discs, speeds)")
    ]
    unevenness_rigid: Annotated[
        Floats,
        Label("coefficient of speed fluctuation of the rigid train", "", "", shape="(discs, speeds)"),
    ]
    unevenness_torsional: Annotated[
        Floats, Label("coefficient of speed fluctuation, torsional part", "", "", shape="(discs, speeds)")
    ]
    disc_heat: Annotated[
        Floats, Label("heat by the damping of each disc", "", "W", "Mean power.", shape="(discs, speeds)")
    ]
    modal_heat: Annotated[
        Floats, Label("heat by the damping ratios of the modes", "", "W", "Mean power of all modes.")
    ]
    power: Annotated[Floats, Label("mean power of the pulsating torques", "", "W", "The sum of all heat.")]

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
            **({"fixed": self.fixed.tolist()} if len(self.fixed) else {}),
            **{name: _by_name(self.shafts, rows) for name, rows in shafts.items()},
            **{name: _by_name(self.discs, rows) for name, rows in discs.items()},
        }


def _by_name(names: tuple[str, ...], rows: Floats) -> Mapping[str, list[float]]:
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
        Nothing excites the train, it has no speeds, or one is none of a machine.

    References
    ----------
    .. [1] Ker Wilson, Practical Solution of Torsional Vibration Problems, vol. 2, 1963.
    """
    in_range(speeds=(speeds, not_negative(SPEED)))
    return responded(excited_train(machine, speeds))


def responded(at: ExcitedTrain) -> ForcedVibration:
    """Steady vibration of a train that has been prepared."""
    return vibration_by_amplitudes(at, responses(at))


def vibration_by_amplitudes(at: ExcitedTrain, q: Complexes) -> ForcedVibration:
    """Steady vibration of a train whose masses swing by `q` (orders, masses, speeds) [rad]."""
    shafts = response_by_amplitudes(at, q)
    total, rigid, torsional = _unevenness(at, shafts.together, q)
    omega = shafts.omega
    theta, M = shafts.amplitudes, at.harmonics
    return ForcedVibration(
        **vars(shafts),
        unevenness=total,
        unevenness_rigid=rigid,
        unevenness_torsional=torsional,
        disc_heat=0.5 * (omega**2 * at.disc_damping * _squared(theta)).sum(axis=0),
        modal_heat=_modal_heat(at, omega, q),
        power=0.5 * (omega * (M.imag * theta.real - M.real * theta.imag)).sum(axis=(0, 1))
        + _joint_power(at, omega, shafts),
    )


def _joint_power(at: ExcitedTrain, omega: Floats, shafts: TorsionResponse) -> Floats | float:
    """Mean power that joints give to the shafts that they twist, (speeds,) [W]."""
    if at.joint_twists is None:
        return 0.0
    power: Floats = 0.5 * (shafts.shaft_torques * (1j * omega * at.joint_twists).conj()).real.sum(axis=(0, 1))
    return power


def _modal_heat(at: ExcitedTrain, omega: Floats, q: Complexes) -> Floats:
    """Mean power that given damping ratios take, (speeds,) [W]."""
    if at.operating.modal is None:
        return np.zeros(len(at.torques.speeds))
    velocity = 1j * omega * q
    heat: Floats = 0.5 * (at.operating.modal.torques(velocity) * velocity.conj()).real.sum(axis=(0, 1))
    return heat


def _unevenness(at: ExcitedTrain, orders: Orders, q: Complexes) -> tuple[Floats, Floats, Floats]:
    """δ of every disc: in all, as a whole, and torsional."""
    referred = at.referred
    J, rigid = referred.inertia, referred.rigid
    # Referred, δ of a mass is that of its discs: speed and mean speed both count n times.
    turned, offsets = at.torques.speeds, at.torques.offsets[:, None]
    ratio = np.divide(offsets, turned, out=np.zeros(at.torques.omega.shape), where=turned > 0)
    speed = 1j * np.abs(orders.values[:, None] + ratio)[:, None] * q
    of_rigid = by_columns(J) * rigid[:, None]
    common = np.einsum("mw,omw->ow", np.broadcast_to(of_rigid, q.shape[1:]), speed)[:, None] / of_rigid.sum(
        axis=0
    )
    if not referred.is_free:
        common = np.zeros_like(common)
    deltas = []
    for part in (speed, common, speed - common * rigid[:, None]):
        greatest, least = span(orders, part)
        deltas.append(greatest - least)
    total, whole, torsional = deltas
    mass = referred.mass
    return total[mass], (whole * rigid[:, None])[mass], torsional[mass]


def angular_deflection(forced: ForcedVibration, disc: str) -> tuple[Floats, Floats]:
    """Vibration of a disc at every speed, each order and all together.

    Gives `single`: (orders, speeds) amplitude of each order [rad]; `total`: (speeds,) half the peak-to-peak
    angle of all orders [rad].
    """
    theta = forced.amplitudes[:, forced.discs.index(disc)]
    greatest, least = span(forced.together, theta)
    return np.abs(theta), 0.5 * (greatest - least)
