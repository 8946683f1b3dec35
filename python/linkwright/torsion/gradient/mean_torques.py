r"""Derivatives of the mean torques of shafts by what acts on a train and by its parts.

In a tree they follow from equilibrium alone, and shafts side by side share by stiffness, k/Σk. Shafts in
loops and meshes about a carrier carry, of all torques that balance, :math:`B^T T = M`, those of minimum
energy, :math:`T = k B \varphi`, so that

.. math:: B^T k B\,d\varphi = dM - dB^T T - B^T (dk\,B\varphi + k\,dB\,\varphi), \qquad
    dT = dk\,B\varphi + k\,dB\,\varphi + k B\,d\varphi

What is left over of the torques on a free train accelerates it as a whole.

References
----------
.. [1] Golub and Pereyra, The differentiation of pseudo-inverses and nonlinear least squares problems whose
   variables separate, SIAM J. Numer. Anal. 10 (1973) 413-432.
"""

from __future__ import annotations

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.torsion.core.response import tree_of
from linkwright.torsion.core.train import ReferredTrain
from linkwright.torsion.excitation.excited_train import carried_by_shafts, static_stiffness
from linkwright.torsion.gradient.train import TrainTangents


def mean_slopes(referred: ReferredTrain, d: TrainTangents, M: Floats, dM: Floats) -> Floats:
    """Derivatives of the mean torques of the shafts at their own speed, (shafts, variables) [N m].

    `M`: (masses,) torques on the masses; `dM`: (masses, variables) their derivatives, referred [N m].
    """
    if referred.is_free:
        rigid, J = referred.rigid, referred.rigid_inertia
        surplus, of_rigid = rigid @ M / J, (referred.inertia * rigid)[:, None]
        change = (rigid @ dM - surplus * (rigid @ d.inertia)) / J
        M, dM = M - of_rigid[:, 0] * surplus, dM - of_rigid * change - d.inertia * rigid[:, None] * surplus
    dk = np.where((referred.stiffness > 0)[:, None], d.stiffness, 0.0)
    in_tree = tree_of(referred) is not None
    slopes = _shared(referred, M, dM, dk) if in_tree else _balanced(referred, d, M, dM, dk)
    referred_slopes: Floats = slopes / referred.lead[:, None]
    return referred_slopes


def _shared(referred: ReferredTrain, M: Floats, dM: Floats, dk: Floats) -> Floats:
    """Of a tree: how shafts side by side share their torque anew by `dk`, (shafts, variables)."""
    pairs, k = np.sort(referred.ends, axis=1), static_stiffness(referred)
    beside = (pairs[:, None] == pairs).all(axis=2).astype(float)
    carried = carried_by_shafts(referred, np.column_stack([M, dM]))
    own = dk / k[:, None] - (beside @ dk) / (beside @ k)[:, None]
    slopes: Floats = carried[:, 1:] + carried[:, :1] * own
    return slopes


def _balanced(referred: ReferredTrain, d: TrainTangents, M: Floats, dM: Floats, dk: Floats) -> Floats:
    """Of loops and meshes about a carrier, by the equations above."""
    B, k = referred.joins, static_stiffness(referred)
    inverse = np.linalg.pinv(np.sqrt(k)[:, None] * B, rcond=1e-13)
    φ = inverse @ (inverse.T @ M)
    twisted = dk * (B @ φ)[:, None]
    if len(d.joins):
        twisted += k[:, None] * np.einsum("smv,m->sv", d.joins, φ)
        dM = dM - np.einsum("smv,s->mv", d.joins, k * (B @ φ))
    dφ = inverse @ (inverse.T @ (dM - B.T @ twisted))
    slopes: Floats = twisted + k[:, None] * (B @ dφ)
    return slopes
