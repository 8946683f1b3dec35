r"""Derivatives of the dynamic stiffness of a train, its shafts of distributed inertia cut into pieces.

At a frequency a uniform piece of stiffness k and inertia j is, between the angles of its ends, the matrix of
`linkwright.torsion.core.rod`, :math:`D = k\,g(\beta)` with :math:`\beta^2 = \omega^2 j/k`. By its inertia it
changes as the kinetic energy of its motion does,

.. math:: \frac{\partial D}{\partial\ln j} = -\omega^2 j \begin{pmatrix} u & v \\ v & u \end{pmatrix}, \qquad
    u = \frac{2\beta - \sin 2\beta}{4\beta\sin^2\beta}, \quad v = \frac{\sin\beta - \beta\cos\beta}
    {2\beta\sin^2\beta}

and since D is homogeneous in k and j, :math:`\partial D/\partial\ln k = D - \partial D/\partial\ln j` [1]_.
By ω² it changes as by j. Pieces are so short that none can swing between its ends, where D would be infinite:
with the stations between them all angles of the train are known, also where every disc is at rest. Shafts
without inertia of their own are springs; a train of these alone is its own cut.

References
----------
.. [1] Wittrick and Williams, A general algorithm for computing natural frequencies of elastic structures,
   Quarterly Journal of Mechanics and Applied Mathematics 24 (1971) 263-284: ∂D/∂ω and the kinetic energy.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.arrays import Complexes, Floats
from linkwright.torsion.core.distributed import Dynamic, cut_up, dynamic
from linkwright.torsion.core.rod import Rod
from linkwright.torsion.core.train import HELD, ReferredTrain

# β below which u and v are their series: rounding of the closed forms grows by 1/β², the next term of the
# series is 1e-4 β⁸.
_SERIES = 0.05


class PartSlopes(NamedTuple):
    """Derivatives of the parts of a train at a frequency by its variables, the last axis."""

    masses: Complexes  # (masses, variables) of −ω²J + iωc without the inertia of rods [N m/rad]
    springs: Complexes  # (springs, variables) of k(1 + iη) + iωc of shafts that are no rods [N m/rad]
    stiffness: Complexes  # (pieces, variables) of ln k of the pieces of all rods, with their losses
    inertia: Complexes  # (pieces, variables) of ln j


class Output(NamedTuple):
    """A torque in a train, and how it follows the parts beside the angles."""

    row: Complexes  # (nodes,) torque per angle [N m/rad]
    slopes: Complexes  # (variables,) [N m]


@dataclass(frozen=True)
class CutTrain:
    """A train at a frequency, its rods cut into uniform pieces: nodes are its masses, then the stations."""

    cut: ReferredTrain  # springs, then pieces that are rods each
    of: NDArray[np.int64]  # (pieces,) place of each among the pieces of all rods
    omega: float  # [rad/s]

    @property
    def springs(self) -> int:
        """How many shafts are no rods."""
        return len(self.cut.shafts) - len(self.of)

    @cached_property
    def _at(self) -> Dynamic:
        return dynamic(self.cut, self.cut.stiffness[:, None], np.array([self.omega]))

    @property
    def inertia(self) -> Floats:
        """What nodes count at the frequency, without losses, (nodes,) [kg m²]."""
        inertia: Floats = self._at.inertia[:, 0].real
        return inertia

    @cached_property
    def stiffness(self) -> Complexes:
        """K − ω²J of the nodes with the losses of shafts, (nodes, nodes) [N m/rad]."""
        at, joins = self._at, self.cut.joins
        D: Complexes = (joins.T * at.stiffness[:, 0]) @ joins
        D[np.diag_indices_from(D)] -= self.omega**2 * at.inertia[:, 0]
        return D

    @cached_property
    def _ends(self) -> tuple[Floats, Floats]:
        """First and second end of each piece among the nodes, (pieces, nodes) each; the ground is none."""
        nodes = np.arange(len(self.cut.inertia))
        first, second = self.cut.ends[self.springs :].T
        assert HELD == -1
        return (first[:, None] == nodes) * 1.0, (second[:, None] == nodes) * 1.0

    @cached_property
    def _of_pieces(self) -> tuple[Complexes, Complexes]:
        """D of each piece, and ∂D/∂ln j, each as its own and its mixed entry, (2, pieces)."""
        at = self._at
        spring = at.stiffness[self.springs :, 0]
        j = np.array([rod.inertia[0] for rod in self.cut.rods])
        first = np.array([rod.first[0] for rod in at.rods], complex).reshape(len(j))
        D = np.stack([spring - self.omega**2 * first, -spring])
        return D, -(self.omega**2) * j * np.stack(_energy_shares(self.omega * np.sqrt(j / self._lossy)))

    @cached_property
    def _lossy(self) -> Complexes:
        """Stiffness of each piece with its losses, (pieces,) [N m/rad]."""
        cut, pieces = self.cut, slice(self.springs, None)
        k: Complexes = cut.stiffness[pieces] * (1 + 1j * cut.loss_factor[pieces])
        return k + 1j * self.omega * cut.damping[pieces]

    def _forces(self, q: Complexes, slopes: PartSlopes) -> tuple[Complexes, Complexes]:
        """What ∂D of each piece does at its two ends by the variables, (pieces, variables) each."""
        first, second = self._ends
        a, b = first @ q, second @ q
        (own, mixed), (own_j, mixed_j) = self._of_pieces
        by_inertia = own_j * a + mixed_j * b, mixed_j * a + own_j * b
        whole = own * a + mixed * b, mixed * a + own * b
        k, j = slopes.stiffness[self.of], slopes.inertia[self.of]
        one, other = (
            (total - part)[:, None] * k + part[:, None] * j
            for total, part in zip(whole, by_inertia, strict=True)
        )
        return one, other

    def moved(self, q: Complexes, slopes: PartSlopes) -> Complexes:
        """dD q by the variables, (nodes, variables) [N m]. `q`: (nodes,) [rad]."""
        joins, (first, second) = self.cut.joins[: self.springs], self._ends
        one, other = self._forces(q, slopes)
        torques: Complexes = joins.T @ (slopes.springs * (joins @ q)[:, None])
        torques = torques + first.T @ one + second.T @ other
        torques[: len(slopes.masses)] += slopes.masses * q[: len(slopes.masses), None]
        return torques

    def momenta(self, q: Complexes, masses: Floats) -> Complexes:
        """−∂D/∂ω² q, (nodes,) [kg m²]. `q`: (nodes,) [rad]; `masses`: without inertia of rods [kg m²]."""
        first, second = self._ends
        a, b = first @ q, second @ q
        j = np.array([rod.inertia[0] for rod in self.cut.rods])
        u, v = _energy_shares(self.omega * np.sqrt(j / self._lossy))
        momenta: Complexes = first.T @ (j * (u * a + v * b)) + second.T @ (j * (v * a + u * b))
        momenta[: len(masses)] += masses * q[: len(masses)]
        return momenta

    def spring_torque(self, spring: int, q: Complexes, slopes: PartSlopes) -> Output:
        """Torque of a shaft that is no rod, from its first end to its second."""
        joins = self.cut.joins[spring]
        return Output(self._at.stiffness[spring, 0] * joins, slopes.springs[spring] * (joins @ q))

    def piece_torque(self, piece: int, end: int, q: Complexes, slopes: PartSlopes) -> Output:
        """Torque at an end, 0 or 1, of a piece, with which the part before drives the part after."""
        (own, mixed), _ = self._of_pieces
        here, there = (ends[piece] for ends in self._ends[:: 1 - 2 * end])
        sign = 1 - 2 * end
        row: Complexes = sign * (own[piece] * here + mixed[piece] * there)
        return Output(row, sign * self._forces(q, slopes)[end][piece])


def _energy_shares(beta: Complexes) -> tuple[Complexes, Complexes]:
    """u and v of pieces at rest against neither end: ∫ θ² = u(θ₁² + θ₂²) + 2v θ₁θ₂."""
    small = np.abs(beta) < _SERIES
    β = np.where(small, 1.0, beta)
    square, sine = beta * beta, np.sin(β)
    u = (2 * β - np.sin(2 * β)) / (4 * β * sine**2)
    v = (sine - β * np.cos(β)) / (2 * β * sine**2)
    near_u = 1 / 3 + square * (2 / 45 + square * (2 / 315 + square * 4 / 4725))
    near_v = 1 / 6 + square * (7 / 180 + square * (31 / 5040 + square * 127 / 151200))
    return np.where(small, near_u, u), np.where(small, near_v, v)


def cut_train(referred: ReferredTrain, omega: float, rods: Sequence[Rod]) -> CutTrain:
    """A train cut into the pieces of `rods`, which are its own in finer pieces, in their order.

    `omega`: [rad/s].
    """
    before, of = 0, [np.empty(0, np.int64)]
    for rod, fine in zip(referred.rods, rods, strict=True):
        of.append(before + piece_of(rod, fine))
        before += len(rod.stiffness)
    return CutTrain(cut_up(referred, [fine.parts() for fine in rods]), np.concatenate(of), omega)


class RodNumbers(NamedTuple):
    """Pieces of all rods, one behind the other."""

    stiffness: Floats  # (pieces,) [N m/rad]
    inertia: Floats  # (pieces,) [kg m²]


def rod_numbers(referred: ReferredTrain) -> RodNumbers:
    """Stiffness and inertia of the pieces of all rods."""
    nothing = np.empty(0)
    return RodNumbers(
        np.concatenate([nothing, *(rod.stiffness for rod in referred.rods)]),
        np.concatenate([nothing, *(rod.inertia for rod in referred.rods)]),
    )


def piece_of(rod: Rod, fine: Rod) -> NDArray[np.int64]:
    """The piece of a rod that each finer piece is a part of, (pieces,)."""
    middle = np.cumsum(fine.inertia) - fine.inertia / 2
    return np.asarray(np.searchsorted(np.cumsum(rod.inertia), middle), np.int64)


def at_stiffness(referred: ReferredTrain, stiffness: Floats) -> ReferredTrain:
    """A train with the stiffnesses of its shafts under their mean torque, (shafts,) [N m/rad]."""
    return replace(referred, stiffness=np.ascontiguousarray(stiffness))


def lossless(referred: ReferredTrain) -> ReferredTrain:
    """A train without the losses of its shafts."""
    nothing = np.zeros(len(referred.shafts))
    return replace(referred, damping=nothing, loss_factor=nothing)
