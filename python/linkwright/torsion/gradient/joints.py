r"""Derivatives of what Hooke's joints do in a train, by their angles and by all that their shafts are.

A joint drives its shaft ahead by the angle :math:`e_\nu`, which acts as the torque :math:`S e_\nu` against
both ends, with the stiffness :math:`S = k(1 + i\eta) + i\omega c`, and its mean torque T acts as
:math:`-i\nu e_\nu T` on the disc before it (`ExcitedTrain`):

.. math:: d(S e_\nu) = dS\,e_\nu + S\,de_\nu, \qquad d(-i\nu e_\nu T) = -i\nu\,(de_\nu\,T + e_\nu\,dT)
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Complexes, Floats
from linkwright.kernel.numerics.tangent import lifted
from linkwright.machine.machine import Machine
from linkwright.machine.tangents import followed
from linkwright.torsion.excitation.excited_train import ExcitedTrain
from linkwright.torsion.model.whole_train import whole_train


def joint_slopes(
    machine: Machine, at: ExcitedTrain, variables: Sequence[str], refused: dict[str, str]
) -> Complexes | None:
    """Of the angles by which joints drive their shafts ahead, (orders, shafts, variables) [rad]."""
    if at.joint_twists is None:
        return None
    names = [name for name in variables if name.rsplit(".", 1)[-1].startswith("joint_")]
    known, twists = followed(machine, names, partial(_twists, at=at), refused)
    slopes = np.zeros((*at.joint_twists.shape[:2], len(variables)), complex)
    slopes[..., [variables.index(name) for name in known]] = lifted(twists, len(known)).d
    return slopes


def _twists(machine: Machine, at: ExcitedTrain) -> Any:
    """The angles themselves, (orders, shafts) [rad]."""
    assert machine.train is not None
    return at.twists_of(whole_train(machine.train))


class JointTorques:
    """What joints do in a train at a line and speed, with derivatives."""

    def __init__(self, at: ExcitedTrain, slopes: Complexes) -> None:
        self._at, self._slopes = at, slopes
        assert at.joint_twists is not None
        self._twists = at.joint_twists[:, :, 0]

    def of_shaft(self, shaft: int, line: int, stiffness: complex, slope: Complexes) -> Complexes:
        """Derivatives of S e, referred, (variables,) [N m]. `stiffness`, `slope`: S and its derivatives."""
        twists = slope * self._twists[line, shaft] + stiffness * self._slopes[line, shaft]
        change: Complexes = twists / self._at.referred.lead[shaft]
        return change

    def on_masses(
        self, line: int, stiffness: Complexes, slopes: Complexes, mean: Floats, dmean: Floats
    ) -> Any:
        """Derivatives of what joints do to the masses, (masses, variables) [N m].

        `stiffness`, `slopes`: (shafts,), (shafts, variables) S of all shafts and its derivatives; `mean`,
        `dmean`: likewise, their mean torques.
        """
        referred, order = self._at.referred, self._at.torques.orders[line]
        torques = np.zeros((len(referred.inertia), slopes.shape[1]), complex)
        for s, first, _ in self._at.joints():
            twisted = self.of_shaft(s, line, complex(stiffness[s]), slopes[s])
            uneven = self._slopes[line, s] * mean[s] + self._twists[line, s] * dmean[s]
            torques[referred.mass[first]] -= twisted + 1j * order * uneven
            torques[referred.ends[s, 1]] += twisted
        return torques
