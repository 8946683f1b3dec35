r"""Derivatives of natural frequencies and mode shapes by entries of the machine.

With shapes q of :math:`q^T J q = 1`,

.. math:: d\omega_i^2 = q_i^T (dK - \omega_i^2\,dJ)\,q_i, \qquad
    dq_i = \sum_{j \ne i} \frac{q_j^T (dK - \omega_i^2\,dJ)\,q_i}{\omega_i^2 - \omega_j^2}\,q_j
    - \tfrac12 (q_i^T dJ\,q_i)\,q_i

where K and J are sums over shafts and masses, so that no matrix is formed. A frequency that stands r times
has r derivatives in each direction, which no single entry can tell apart: what is a smooth function is the
mean of their squares. Each of them is given the derivative of the frequency of that mean, and its shape has
none [2]_.

References
----------
.. [1] Fox and Kapoor, Rates of change of eigenvalues and eigenvectors, AIAA J. 6 (1968) 2426-2429.
.. [2] Lancaster, On eigenvalues of matrices dependent on a parameter, Numer. Math. 6 (1964) 377-387.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.numerics.tangent import Tangent
from linkwright.machine.machine import Machine
from linkwright.torsion.core.train import HELD, ReferredTrain
from linkwright.torsion.gradient.train import TrainTangents, train_tangents

# Squares of frequencies that differ by a smaller share of the largest of a train are one: rounding of the
# modes leaves about 1e-14 of it, and a shape's derivative has lost all its digits.
_REPEATED = 1e-9


@dataclass(frozen=True)
class ModeTangents:
    """Natural frequencies [Hz] and mode shapes with derivatives by `variables`."""

    variables: tuple[str, ...]
    natural_frequencies: dict[
        int, Tangent
    ]  # by the number of the mode, from 0; none of the motion as a whole
    mode_shapes: dict[tuple[int, str], Tangent]  # by mode and disc, of frequencies that stand alone
    ties: dict[int, str]  # modes whose frequency stands more than once
    refused: dict[str, str]


def mode_tangents(machine: Machine, variables: Sequence[str]) -> ModeTangents:
    """Natural frequencies and mode shapes along entries of a machine. Raises what `free_vibration` raises."""
    refused: dict[str, str] = {}
    _, referred, d = train_tangents(machine, variables, refused)
    omega, q = referred.modes()
    groups = _groups(omega)
    own = _pencil(referred, d, q, omega)
    frequencies: dict[int, Tangent] = {}
    shapes: dict[tuple[int, str], Tangent] = {}
    ties: dict[int, str] = {}
    for group in groups:
        # The mean of the squares of a group is smooth whatever vectors span it.
        slope = np.mean([own[i][i] for i in group], axis=0)
        for i in group:
            if omega[i] > 0:
                frequencies[i] = Tangent(omega[i] / (2 * math.pi), slope / (2 * omega[i]) / (2 * math.pi))
            if len(group) > 1 and omega[i] > 0:
                others = " and ".join(str(j) for j in group if j != i)
                ties[i] = f"it is that of mode {others} too; the derivative is that of their mean square"
            elif len(group) == 1:
                shapes |= _shape(referred, d, omega, q, own[i], i)
    return ModeTangents(d.variables, frequencies, shapes, ties, refused)


def _groups(omega: Floats) -> list[list[int]]:
    """Modes of equal frequency together."""
    square, groups = omega**2, [[0]] if len(omega) else []
    for i in range(1, len(omega)):
        if square[i] - square[i - 1] <= _REPEATED * square[-1]:
            groups[-1].append(i)
        else:
            groups.append([i])
    return groups


def _pencil(referred: ReferredTrain, d: TrainTangents, q: Floats, omega: Floats) -> list[Floats]:
    """Row i: q_jᵀ(dK − ω_i² dJ)q_i of all j, (modes, variables)."""
    held = np.concatenate([q, np.zeros((len(q), 1))], axis=1)
    first, second = referred.ends.T
    twist = held[:, first] - held[:, second]
    assert HELD == -1
    return [
        np.einsum("js,sv->jv", twist * twist[i], d.stiffness)
        - omega[i] ** 2 * np.einsum("jm,mv->jv", q * q[i], d.inertia)
        for i in range(len(omega))
    ]


def _shape(
    referred: ReferredTrain, d: TrainTangents, omega: Floats, q: Floats, row: Floats, i: int
) -> dict[tuple[int, str], Tangent]:
    """Amplitudes of the discs in mode i, the largest 1, with derivatives; `row` as of `_pencil`."""
    gaps = omega[i] ** 2 - omega**2
    gaps[i] = np.inf
    dq = np.einsum("jm,jv->mv", q / gaps[:, None], row)
    dq -= 0.5 * q[i][:, None] * np.einsum("m,mv->v", q[i] ** 2, d.inertia)
    of_disc = q[i][referred.mass]
    theta = referred.speed * of_disc
    dtheta = referred.speed[:, None] * dq[referred.mass] + d.speed * of_disc[:, None]
    size = np.abs(theta)
    # As `free_vibration` scales: of entries that are equal but for rounding the first counts.
    top = int(np.argmax(size > (1 - 1e-9) * size.max()))
    scaled = theta / theta[top]
    slopes = (dtheta - scaled[:, None] * dtheta[top]) / theta[top]
    return {
        (i, name): Tangent(float(value), slope)
        for name, value, slope in zip(referred.discs, scaled, slopes, strict=True)
    }
