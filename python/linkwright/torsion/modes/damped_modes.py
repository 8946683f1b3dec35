r"""The quadratic eigenvalue problem of a train with damping, in the modes that it has without.

With the shapes Q and frequencies Ω of the train without damping, :math:`\theta = Q p`, the states
:math:`y = \Omega p` and :math:`v = \dot p` go on as

.. math:: \dot y = \Omega v, \qquad \dot v = -(\Omega + i\tilde H\Omega^{-1})\,y - \tilde C v

which without damping is a rotation: nothing is lost to differences of size between inertias and stiffnesses.
A motion without stiffness has a velocity but no y; one that nothing damps either has none of both, and its
s = 0 is known.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from linkwright.torsion.core.train import ReferredTrain

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]

# Share of the damping of its parts below which a motion as a whole is not damped but for rounding.
_UNDAMPED = 1e-12


def damped_modes(referred: ReferredTrain) -> tuple[Complexes, Complexes]:
    """Eigenvalues and shapes of a train with damping.

    Gives `eigenvalues`: (modes,) by their size; of pairs the one with a positive imaginary part [1/s];
    `shapes`: (modes, masses) of the masses, of no particular size.
    """
    omega, undamped = referred.modes()
    # The motions without stiffness, those come first: damped ones apart from the others.
    free = int(np.count_nonzero(omega == 0))
    Q = np.concatenate([_apart(undamped[:free], referred.damping_matrix), undamped[free:]])
    C = Q @ referred.damping_matrix @ Q.T
    damped = np.abs(C[:free]).max(axis=1, initial=0.0) > _undamped(Q[:free], referred.damping_matrix)
    kept = np.concatenate([np.flatnonzero(damped), np.arange(free, len(omega))])
    H = Q[free:] @ referred.loss_matrix @ Q[free:].T
    s, p = _solved(omega[free:], C[np.ix_(kept, kept)], H)
    s, shapes = np.concatenate([np.zeros(free), s]), np.concatenate([undamped[:free], p @ Q[kept]])
    order = np.argsort(np.abs(s), kind="stable")
    return s[order], shapes[order].astype(complex)


def _undamped(Q: Floats, C: Floats) -> float:
    """What rounding leaves where damping cancels."""
    return _UNDAMPED * float((np.abs(Q) @ np.abs(C) @ np.abs(Q).T).max(initial=0.0))


def _apart(Q: Floats, C: Floats) -> Floats:
    """Motions without stiffness, turned so that none damps another."""
    turned: Floats = np.linalg.eigh(Q @ C @ Q.T)[1].T @ Q
    return turned if len(Q) > 1 else Q


def _solved(omega: Floats, C: Floats, H: Floats) -> tuple[Complexes, Complexes]:
    """Eigenvalues with ω_d of zero or more, and p of their modes."""
    s, p = _pairs(omega, C, np.zeros_like(H))
    if not H.any():
        return s, p
    vibrating = s.imag > 0
    lossy, shapes = _pairs(omega, C, H)
    # What creeps has no hysteresis, and of what vibrates there are as many as without.
    vibrates = lossy.imag > 0
    ratio = np.divide(-lossy.real, np.abs(lossy), out=np.full(len(lossy), np.inf), where=vibrates)
    least = np.argsort(ratio, kind="stable")[: np.count_nonzero(vibrating)]
    return np.concatenate([s[~vibrating], lossy[least]]), np.concatenate([p[~vibrating], shapes[least]])


def _pairs(omega: Floats, C: Floats, H: Floats) -> tuple[Complexes, Complexes]:
    """Eigenvalues with an imaginary part of zero or more; p, a row each."""
    n, m = len(omega), len(C)
    stiff = np.diag(omega) + 1j * H / omega if H.any() else np.diag(omega)
    A = np.zeros((n + m, n + m), stiff.dtype)
    elastic = slice(m, n + m)
    A[:n, elastic] = np.diag(omega)
    A[elastic, :n] = -stiff
    A[n:, n:] -= C
    s, vectors = np.linalg.eig(A)
    kept = s.imag >= 0
    s, vectors = s[kept].astype(complex), vectors[:, kept]
    # Nothing drives a train that is left to itself: a growth as small as this is rounding.
    growth = (s.real > 0) & (s.real < 1e-14 * len(A) * np.abs(A).max(initial=0.0))
    s.real[growth] = 0.0
    return s, np.where(s == 0, _at_rest(omega, C, vectors), vectors[n:] / np.where(s == 0, 1.0, s)).T


def _at_rest(omega: Floats, C: Floats, vectors: Complexes) -> Complexes:
    """p of eigenvalues that rounding left at zero: stiffness gives the elastic part, damping the free one.

    Where s is zero, so are the velocities s p, and p = y/ω of the elastic motions; those without stiffness
    follow in the limit of (s + C_ff) p_f = -C_fe p_e, since each of them is damped and none damps another.
    """
    n, m = len(omega), len(C)
    elastic = vectors[:n] / omega[:, None]
    free = m - n
    following = -(C[:free, free:] @ elastic) / np.diag(C)[:free, None]
    found: Complexes = np.concatenate([following, elastic])
    return found
