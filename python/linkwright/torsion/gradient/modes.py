r"""Derivatives of natural frequencies and mode shapes by entries of the machine.

With shapes q of :math:`q^T J q = 1`,

.. math:: d\omega_i^2 = q_i^T (dK - \omega_i^2\,dJ)\,q_i, \qquad
    dq_i = \sum_{j \ne i} \frac{q_j^T (dK - \omega_i^2\,dJ)\,q_i}{\omega_i^2 - \omega_j^2}\,q_j
    - \tfrac12 (q_i^T dJ\,q_i)\,q_i

where K and J are sums over shafts and masses, so that no matrix is formed. About a carrier the twist of a
mesh, Δ = Bq, has ratios in it, and k (dΔ_i Δ_j + Δ_i dΔ_j) comes to its term of the sum. A frequency that
stands r times has r derivatives in each direction, which no single entry can tell apart: what is a smooth
function is the mean of their squares. Each of them is given the derivative of the frequency of that mean, and
its shape has none [2]_.

Trains with distributed inertia have modes without end, over which no sum is taken: there the shape follows
from the dynamic stiffness (`distributed_modes`).

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
from linkwright.kernel.numerics.extreme import ALIKE_OF_SOLVED, TIE, differ
from linkwright.kernel.numerics.tangent import Tangent
from linkwright.machine.machine import Machine
from linkwright.machine.tangents import Derivatives
from linkwright.torsion.core.train import ReferredTrain
from linkwright.torsion.gradient.distributed_modes import DistributedModes, ModeAngles
from linkwright.torsion.gradient.train import TrainTangents, train_tangents
from linkwright.torsion.modes.free import modes_wanted

# Squares of frequencies that differ by a smaller share of the largest of a train are one: rounding of the
# modes leaves about 1e-14 of it, and a shape's derivative has lost all its digits.
_REPEATED = 1e-9

# Share of the largest angle below which a disc is at rest.
_AT_REST = 1e-9

_RESTING = (
    "all discs are at rest in this mode; which disc leads for neighbouring machines depends on the entry"
)


@dataclass(frozen=True)
class ModeTangents:
    """Natural frequencies [Hz] and mode shapes with derivatives by `variables`."""

    variables: tuple[str, ...]
    natural_frequencies: dict[
        int, Tangent
    ]  # by the number of the mode, from 0; none of the motion as a whole
    mode_shapes: dict[tuple[int, str], Tangent]  # by mode and disc, of frequencies that stand alone
    ties: dict[int, str]  # modes whose frequency stands more than once
    shape_ties: dict[int, str]  # modes whose largest amplitude is reached at several places
    missing: dict[tuple[int, str], str]  # mode shapes without derivatives
    refused: dict[str, str]


def mode_tangents(machine: Machine, variables: Sequence[str]) -> ModeTangents:
    """Natural frequencies and mode shapes along entries of a machine. Raises what `free_vibration` raises."""
    refused: dict[str, str] = {}
    train, referred, d = train_tangents(machine, variables, refused)
    modes = (
        DistributedModes(referred, d, modes_wanted(machine, train))
        if referred.rods
        else _LumpedModes(referred, d)
    )
    tangents = ModeTangents(d.variables, {}, {}, {}, {}, {}, refused)
    for group in _groups(modes.omega, alone=bool(referred.rods)):
        slope = modes.square(group)
        for i in group:
            omega = float(modes.omega[i])
            if omega > 0:
                tangents.natural_frequencies[i] = Tangent(
                    omega / (2 * math.pi), slope / (2 * omega) / (2 * math.pi)
                )
            if len(group) > 1 and omega > 0:
                others = " and ".join(str(j) for j in group if j != i)
                tangents.ties[i] = (
                    f"mode {others} has the same frequency; the derivative is that of their mean square"
                )
            elif len(group) == 1:
                _add_shape(tangents, i, referred.discs, modes.angles(i, slope))
    return tangents


def mode_derivatives(machine: Machine, variables: Sequence[str]) -> Derivatives:
    """The same as scalars, named ``natural_frequencies.MODE`` and ``mode_shapes.MODE.DISC``."""
    found = mode_tangents(machine, variables)
    frequencies = {f"natural_frequencies.{i}": tangent for i, tangent in found.natural_frequencies.items()}
    words = {name: f"natural frequency of mode {name.rsplit('.', 1)[-1]}" for name in frequencies}
    ties = {f"natural_frequencies.{i}": reason for i, reason in found.ties.items()}
    shapes = {}
    for (i, disc), tangent in found.mode_shapes.items():
        name = f"mode_shapes.{i}.{disc}"
        shapes[name], words[name] = tangent, f"amplitude of {disc} in mode {i}"
        if i in found.shape_ties:
            ties[name] = found.shape_ties[i]
    return Derivatives(
        *(found.variables, frequencies | shapes, ties),
        {f"mode_shapes.{i}.{disc}": reason for (i, disc), reason in found.missing.items()},
        found.refused,
        words=words,
        units=dict.fromkeys(frequencies, "Hz") | dict.fromkeys(shapes, ""),
        usual=tuple(frequencies),
    )


def _groups(omega: Floats, *, alone: bool) -> list[list[int]]:
    """Modes of equal frequency together; `alone`: each is known to its own size, not to the largest."""
    square, groups = omega**2, [[0]] if len(omega) else []
    for i in range(1, len(omega)):
        if square[i] - square[i - 1] <= _REPEATED * square[i if alone else -1]:
            groups[-1].append(i)
        else:
            groups.append([i])
    return groups


def _add_shape(tangents: ModeTangents, i: int, discs: Sequence[str], angles: ModeAngles) -> None:
    """Amplitudes of the discs in mode i, the largest of the train 1."""
    values, slopes = angles
    size = np.abs(values)
    if size[: len(discs)].max() < _AT_REST * size.max():
        tangents.missing.update({(i, name): _RESTING for name in discs})
        return
    # As `free_vibration` scales: of entries that are equal but for rounding the first counts.
    largest = np.flatnonzero(size > (1 - TIE) * size.max())
    growth = np.sign(values[largest])[:, None] * slopes[largest] / size[largest, None]
    top = size[largest[0]]
    scaled = values[: len(discs)] / top
    changes = slopes[: len(discs)] / top - scaled[:, None] * growth[0]
    for name, value, slope in zip(discs, scaled.tolist(), changes, strict=True):
        tangents.mode_shapes[i, name] = Tangent(value, slope)
    if differ(growth, np.abs(changes).max(initial=0.0), ALIKE_OF_SOLVED).any():
        tangents.shape_ties[i] = "the largest amplitude occurs at several positions"


class _LumpedModes:
    """Modes of a train with inertia in its discs alone, with derivatives by the variables of `d`."""

    def __init__(self, referred: ReferredTrain, d: TrainTangents) -> None:
        self._referred, self._d = referred, d
        self.omega, self._q = referred.modes()
        self._own = self._pencil()

    def _pencil(self) -> list[Floats]:
        """Row i: q_jᵀ(dK − ω_i² dJ)q_i of all j, (modes, variables)."""
        q, d, r = self._q, self._d, self._referred
        twist = q @ r.joins.T
        pencil = [
            np.einsum("js,sv->jv", twist * twist[i], d.stiffness)
            - omega**2 * np.einsum("jm,mv->jv", q * q[i], d.inertia)
            for i, omega in enumerate(self.omega.tolist())
        ]
        if len(d.joins):
            # Torques of the meshes in each mode, and how their twist follows the ratios.
            torque, moved = twist * r.stiffness, np.einsum("smv,jm->jsv", d.joins, q)
            for i, own in enumerate(pencil):
                own += np.einsum("jsv,s->jv", moved, torque[i]) + np.einsum("js,sv->jv", torque, moved[i])
        return pencil

    def square(self, group: list[int]) -> Floats:
        """Of the mean of ω² of modes of one frequency, smooth whatever vectors span them, (variables,)."""
        slope: Floats = np.mean([self._own[i][i] for i in group], axis=0)
        return slope

    def angles(self, i: int, square: Floats) -> ModeAngles:
        """Of a mode whose frequency stands alone, its first of the largest ahead."""
        omega, q, d, r = self.omega, self._q, self._d, self._referred
        gaps = omega[i] ** 2 - omega**2
        gaps[i] = np.inf
        dq = np.einsum("jm,jv->mv", q / gaps[:, None], self._own[i])
        dq -= 0.5 * q[i][:, None] * np.einsum("m,mv->v", q[i] ** 2, d.inertia)
        of_disc = q[i][r.mass]
        theta = r.scale * of_disc
        size = np.abs(theta)
        sense = np.sign(theta[np.argmax(size > (1 - TIE) * size.max())])
        slopes = r.scale[:, None] * dq[r.mass] + d.speed * of_disc[:, None]
        return ModeAngles(sense * theta, sense * slopes)
