"""Speed of one disc under torques of several origins, each by itself: elastic train, or taken as rigid."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from linkwright.analysis.torsion.excited import Excited
from linkwright.engine.train_response import Operating, respond
from linkwright.errors import InputError
from linkwright.machine.base import suggestion

Complexes = NDArray[np.complex128]


def cylinder_response(at: Excited, sources: Complexes, disc: str, *, rigid: bool = False) -> Complexes:
    """Harmonics of the speed of a disc under torques one by one.

    Parameters
    ----------
    at : Excited
        The train, at one speed.
    sources : ndarray of complex, shape (sources, orders, discs)
        Torques at the orders of the train's torques [N m].
    disc : str
        The disc.
    rigid : bool
        Whether the train is taken as rigid.

    Returns
    -------
    ndarray of complex, shape (sources, orders)
        [rad/s].

    Raises
    ------
    InputError
        There is no such disc, or the train is held and cannot turn as a whole.
    """
    referred = at.referred
    if disc not in referred.discs:
        remedy = suggestion(disc, referred.discs)
        raise InputError(f'the train has no disc "{disc}"' + (f": {remedy}" if remedy else ""))
    place = referred.discs.index(disc)
    onto = np.zeros((len(referred.discs), len(referred.inertia)))
    onto[np.arange(len(onto)), referred.mass] = referred.speed
    torques = np.ascontiguousarray(np.einsum("sod,dm->oms", sources, onto))
    omega = at.torques.orders * at.torques.speeds[0]
    if rigid:
        if not referred.is_free:
            raise InputError(
                "a train held by the ground does not turn as a whole: it cannot be taken as rigid"
            )
        damping = at.operating.disc_damping[:, 0].sum()
        q = torques.sum(axis=1) / (-(omega**2) * referred.inertia.sum() + 1j * omega * damping)[:, None]
    else:
        many = len(sources)
        same = Operating(
            np.repeat(at.operating.speeds, many),
            np.repeat(at.operating.stiffness, many, axis=1),
            np.repeat(at.operating.disc_damping, many, axis=1),
        )
        q = respond(referred, same, at.torques.orders, torques)[:, referred.mass[place]]
    found: Complexes = (1j * omega[:, None] * referred.speed[place] * q).T
    return found
