"""Harmonics of the speed of one disc: under all torques, or under each by itself; elastic train, or rigid."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import InputError
from linkwright.torsion.core.response import Operating, respond
from linkwright.torsion.core.train import ReferredTrain
from linkwright.torsion.response.excited_train import ExcitedTrain
from linkwright.torsion.response.torsion_response import responses

Complexes = NDArray[np.complex128]


def disc_speed(at: ExcitedTrain, disc: str, *, rigid: bool = False) -> Complexes:
    """Harmonics of the speed of a disc under the torques of its train, (speeds, orders) [rad/s]."""
    place = _place(at.referred, disc)
    if rigid:
        torques = at.referred_harmonics()
        q = _rigid(at.referred, at.operating, at.torques.orders, torques)
    else:
        q = responses(at)[:, at.referred.mass[place]]
    omega = at.torques.orders[:, None] * at.torques.speeds
    found: Complexes = (1j * omega * at.referred.speed[place] * q).T
    return found


def cylinder_response(at: ExcitedTrain, sources: Complexes, disc: str, *, rigid: bool = False) -> Complexes:
    """Harmonics of the speed of a disc under torques one by one, (sources, orders) [rad/s].

    `sources`: (sources, orders, discs) [N m].
    """
    referred, many, orders = at.referred, len(sources), at.torques.orders
    place = _place(referred, disc)
    onto = np.zeros((len(referred.discs), len(referred.inertia)))
    onto[np.arange(len(onto)), referred.mass] = referred.speed
    torques = np.ascontiguousarray(np.einsum("sod,dm->oms", sources, onto))
    same = Operating(
        np.repeat(at.operating.speeds, many),
        np.repeat(at.operating.stiffness, many, axis=1),
        np.repeat(at.operating.disc_damping, many, axis=1),
    )
    if rigid:
        q = _rigid(referred, same, orders, torques)
    else:
        q = respond(referred, same, orders, torques)[:, referred.mass[place]]
    found: Complexes = (1j * orders[:, None] * same.speeds * referred.speed[place] * q).T
    return found


def _place(referred: ReferredTrain, disc: str) -> int:
    """Place of a disc."""
    if disc not in referred.discs:
        remedy = suggestion(disc, referred.discs)
        raise InputError(f'the train has no disc "{disc}"' + (f": {remedy}" if remedy else ""))
    return referred.discs.index(disc)


def _rigid(
    referred: ReferredTrain, operating: Operating, orders: NDArray[np.float64], torques: Complexes
) -> Complexes:
    """Amplitude of a train that does not twist, (orders, speeds)."""
    if not referred.is_free:
        raise InputError("a train held by the ground has no rigid-body mode: it cannot be taken as rigid")
    omega = orders[:, None] * operating.speeds
    damping = operating.disc_damping.sum(axis=0)
    q: Complexes = torques.sum(axis=1) / (-(omega**2) * referred.inertia.sum() + 1j * omega * damping)
    return q
