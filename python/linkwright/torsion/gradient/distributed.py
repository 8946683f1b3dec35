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

from linkwright.kernel.arrays import Complexes, Floats, Integers
from linkwright.torsion.core.distributed import Dynamic, cut_up, dynamic
from linkwright.torsion.core.rod import Rod
from linkwright.torsion.core.train import HELD, ReferredTrain

# β below which u and v are their series: rounding of the closed forms grows by 1/β², the next term of the
# series is 1e-4 β⁸.
_SERIES = 0.05


class PartSlopes(NamedTuple):
    """Derivatives of the parts of a train at a frequency by its variables, the last axis."""

    masses: Complexes | Floats  # (masses, variables) of −ω²J + iωc without the inertia of rods [N m/rad]
    springs: (
        Complexes | Floats
    )  # (springs, variables) of k(1 + iη) + iωc of shafts that are no rods [N m/rad]
    stiffness: Complexes | Floats  # (pieces, variables) of ln k of the pieces of all rods, with their losses
    inertia: Floats  # (pieces, variables) of ln j
    joins: Floats  # (shafts, masses, variables) of the connections in a train with gears on a carrier


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
        at, n = self._at, len(self.cut.inertia)
        spring, (a, b) = at.stiffness[:, 0], self._ends
        if self.cut.twist is not None:
            about = (self.cut.joins.T * spring) @ self.cut.joins
            about[np.arange(n), np.arange(n)] -= self.omega**2 * at.inertia[:, 0]
            return about
        D = np.zeros((n + 1, n + 1), complex)
        np.add.at(D, (a, a), spring)
        np.add.at(D, (b, b), spring)
        np.add.at(D, (a, b), -spring)
        np.add.at(D, (b, a), -spring)
        D[np.arange(n), np.arange(n)] -= self.omega**2 * at.inertia[:, 0]
        return np.ascontiguousarray(D[:n, :n])

    @cached_property
    def _ends(self) -> Integers:
        """First and second nodes of all shafts, (2, shafts); the ground comes after the last node."""
        ends = self.cut.ends.T
        nodes: Integers = np.where(ends == HELD, len(self.cut.inertia), ends)
        return nodes

    def _angles(self, q: Complexes) -> Complexes:
        """Angles of both ends of all shafts, (2, shafts)."""
        angles: Complexes = np.append(q, 0.0)[self._ends]
        return angles

    def _twists(self, q: Complexes) -> Complexes:
        """Twists of all springs, (springs,) [rad]."""
        if self.cut.twist is not None:
            about: Complexes = self.cut.joins @ q
            return about
        first, second = self._angles(q)[:, : self.springs]
        twists: Complexes = first - second
        return twists

    def _onto_nodes(self, first: Complexes, second: Complexes) -> Complexes:
        """Sums over the nodes of what acts at both ends of all shafts, (nodes, ...)."""
        sums = np.zeros((len(self.cut.inertia) + 1, *first.shape[1:]), complex)
        np.add.at(sums, self._ends[0], first)
        np.add.at(sums, self._ends[1], second)
        return sums[:-1]

    @cached_property
    def _inertia(self) -> tuple[Complexes, Complexes]:
        """j u and j v of the pieces, (pieces,) each [kg m²]."""
        cut, pieces = self.cut, slice(self.springs, None)
        k = cut.stiffness[pieces] * (1 + 1j * cut.loss_factor[pieces]) + 1j * self.omega * cut.damping[pieces]
        j = np.array([rod.inertia[0] for rod in cut.rods])
        u, v = _energy_shares(self.omega * np.sqrt(j / k))
        return j * u, j * v

    @cached_property
    def _pieces(self) -> tuple[Complexes, Complexes]:
        """Own and mixed entry of D of each piece, (pieces,) each [N m/rad]."""
        spring = self._at.stiffness[self.springs :, 0]
        J = np.array([rod.first[0] for rod in self._at.rods], complex)
        return spring - self.omega**2 * J, -spring

    def _forces(self, q: Complexes, slopes: PartSlopes) -> tuple[Complexes, Complexes]:
        """What ∂D of each piece does at its two ends by the variables, (pieces, variables) each."""
        a, b = self._angles(q)[:, self.springs :]
        (own, mixed), (u, v) = self._pieces, self._inertia
        k, j = slopes.stiffness[self.of], slopes.inertia[self.of]

        def force(here: Complexes, there: Complexes) -> Complexes:
            by_inertia = -(self.omega**2) * (u * here + v * there)
            by_stiffness = own * here + mixed * there - by_inertia
            force: Complexes = by_stiffness[:, None] * k + by_inertia[:, None] * j
            return force

        return force(a, b), force(b, a)

    def moved(self, q: Complexes, slopes: PartSlopes) -> Complexes:
        """dD q by the variables, (nodes, variables) [N m]. `q`: (nodes,) [rad]."""
        spring = slopes.springs * self._twists(q)[:, None]
        if self.cut.twist is not None:
            # Torques of the meshes, by twists that follow the ratios, and at masses that do.
            k, moved = self._at.stiffness[:, 0], np.einsum("smv,m->sv", slopes.joins, q)
            torques: Complexes = self.cut.joins.T @ (spring + k[:, None] * moved)
            torques += np.einsum("smv,s->mv", slopes.joins, k * self._twists(q)) + slopes.masses * q[:, None]
            return torques
        first, second = self._forces(q, slopes)
        torques = self._onto_nodes(np.concatenate([spring, first]), np.concatenate([-spring, second]))
        masses = len(slopes.masses)
        torques[:masses] += slopes.masses * q[:masses, None]
        return torques

    def momenta(self, q: Complexes, masses: Floats) -> Complexes:
        """−∂D/∂ω² q, (nodes,) [kg m²]. `q`: (nodes,) [rad]; `masses`: without inertia of rods [kg m²]."""
        a, b = self._angles(q)[:, self.springs :]
        (u, v), none = self._inertia, np.zeros(self.springs)
        both = (np.concatenate([none, u * a + v * b]), np.concatenate([none, v * a + u * b]))
        momenta = self._onto_nodes(*both)
        momenta[: len(masses)] += masses * q[: len(masses)]
        return momenta

    def spring_torque(self, spring: int, q: Complexes, slopes: PartSlopes) -> Output:
        """Torque of a shaft that is no rod, from its first end to its second."""
        k, change = self._at.stiffness[spring, 0], slopes.springs[spring] * self._twists(q)[spring]
        if self.cut.twist is not None:
            return Output(k * self.cut.joins[spring], change + k * (q @ slopes.joins[spring]))
        return Output(self._row(spring, k, -k), change)

    def piece_torque(self, piece: int, end: int, q: Complexes, slopes: PartSlopes) -> Output:
        """Torque at an end, 0 or 1, of a piece, with which the part before drives the part after."""
        own, mixed = (entry[piece] for entry in self._pieces)
        row = (
            self._row(self.springs + piece, own, mixed)
            if end == 0
            else self._row(self.springs + piece, -mixed, -own)
        )
        return Output(row, (1 - 2 * end) * self._forces(q, slopes)[end][piece])

    def _row(self, shaft: int, first: complex, second: complex) -> Complexes:
        """A torque by the angles of both ends of a shaft, (nodes,) [N m/rad]."""
        row = np.zeros(len(self.cut.inertia) + 1, complex)
        np.add.at(row, self._ends[:, shaft], np.array([first, second]))
        return row[:-1]


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
