r"""Derivatives of the torque of a shaft at each order, by the adjoint of the dynamic stiffness.

With :math:`H_\nu q_\nu = M_\nu` the torque is :math:`t_\nu = r_\nu^T q_\nu`, that of a spring
:math:`s(q_a - q_b)`, :math:`s = k(1 + i\eta) + i\omega c`, that of a rod what a piece of it asks for at its
end at a station. With

.. math:: H_\nu \lambda_\nu = r_\nu, \qquad
    dt_\nu = dr_\nu^T q_\nu + \lambda_\nu^T (dM_\nu - dH_\nu q_\nu)

one solution a shaft and order serves all entries. The rods of the train are cut into pieces
(`linkwright.torsion.gradient.distributed`), that of the torque at its station too, which stays at its share
of a section where the section changes.

References
----------
.. [1] Haftka and Gürdal, Elements of Structural Optimization, 3rd ed. 1992, chapter 7: adjoint method.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from linkwright.kernel.arrays import Complexes
from linkwright.torsion.core.distributed import solved
from linkwright.torsion.core.rod import Rod
from linkwright.torsion.excitation.excited_train import ExcitedTrain
from linkwright.torsion.gradient.distributed import (
    CutTrain,
    Output,
    PartSlopes,
    at_stiffness,
    cut_train,
    rod_numbers,
)
from linkwright.torsion.gradient.joints import JointTorques
from linkwright.torsion.gradient.torques import TorqueTangents
from linkwright.torsion.gradient.train import TrainTangents
from linkwright.torsion.response.along_shaft import StationTorques, station_torques
from linkwright.torsion.response.forced import shaft_flow, spring_stiffness

# Largest β of a piece, a third of that at which it could swing between its ends.
_PIECE = 1.0


class _State(NamedTuple):
    """A train at an order and speed, its rods cut."""

    train: CutTrain
    stiffness: Complexes  # (nodes, nodes) H [N m/rad]
    q: Complexes  # (nodes,) [rad]
    slopes: PartSlopes
    right: Complexes  # (nodes, variables) dM − dH q [N m]


class _Split(NamedTuple):
    """A rod cut at a station."""

    rod: Rod
    piece: int  # that has the station
    end: int  # of the piece, 0 or 1


class CarriedTorques(NamedTuple):
    """What shafts carry, referred to the first disc, and their stiffness; (orders, shafts, speeds) each."""

    stiffness: Complexes  # [N m/rad]
    flow: Complexes  # [N m]

    @classmethod
    def of(cls, at: ExcitedTrain, q: Complexes) -> CarriedTorques:
        """Those of a train whose masses swing by `q`, (orders, masses, speeds) [rad]."""
        stiffness = spring_stiffness(at)
        return cls(stiffness, shaft_flow(at, q, stiffness))


class ShaftTorques:
    """Torques of shafts at each order, with derivatives by the variables of `d`."""

    def __init__(
        self,
        at: ExcitedTrain,
        q: Complexes,
        d: TrainTangents,
        torques: dict[int, TorqueTangents],
        shafts: CarriedTorques,
        joints: Complexes | None = None,
    ) -> None:
        self._at, self._q, self._d, self._torques = at, q, d, torques
        self._joints = None if joints is None else JointTorques(at, joints)
        self._rods = {rod.shaft: n for n, rod in enumerate(at.referred.rods)}
        self._springs = [s for s in range(len(at.referred.shafts)) if s not in self._rods]
        self._stiffness, self._flow = shafts
        self._slopes: dict[tuple[int, int, int], Complexes] = {}
        self._states: dict[tuple[int, int], _State] = {}
        self._along: dict[int, StationTorques] = {}

    def along(self, shaft: int) -> StationTorques | None:
        """Torques along a shaft with distributed inertia; None of another."""
        if shaft in self._rods and shaft not in self._along:
            n = self._rods[shaft]
            self._along[shaft] = station_torques(self._at, self._q, self._flow[:, shaft], n)
        return self._along.get(shaft)

    def orders(self, shaft: int, place: int, station: int) -> Complexes:
        """Torque of a shaft at its speed, (orders,) [N m].

        `place`: of the speeds; `station`: of `StationTorques`, of a rod.
        """
        along = self.along(shaft)
        if along is not None:
            torques: Complexes = along.torques[:, station, place]
            return torques
        twist, lead = self._q[:, :, place] @ self._at.referred.joins[shaft], self._at.referred.lead[shaft]
        if self._at.joint_twists is not None:
            twist = twist + self._at.joint_twists[:, shaft, place] / lead
        spring: Complexes = self._stiffness[:, shaft, place] * twist / lead
        return spring

    def slopes(self, shaft: int, place: int, station: int) -> Complexes:
        """Its derivatives, (orders, variables) [N m]."""
        at = shaft, place, station
        if at not in self._slopes:
            rows = [self._slope(*at, m) for m in range(len(self._at.torques.orders))]
            self._slopes[at] = np.array(rows) / self._at.referred.lead[shaft]
        return self._slopes[at]

    def _slope(self, shaft: int, place: int, station: int, m: int) -> Complexes:
        """The derivatives at one order, referred, (variables,)."""
        along = self.along(shaft)
        state, torque = (
            self._of_spring(shaft, place, m)
            if along is None
            else self._of_rod(self._rods[shaft], along, station, place, m)
        )
        adjoint = solved(state.stiffness, torque.row[:, None])[:, 0]
        slope: Complexes = torque.slopes + adjoint @ state.right
        return slope

    def _of_spring(self, shaft: int, place: int, m: int) -> tuple[_State, Output]:
        """The train, and the torque of a shaft that is no rod."""
        if (place, m) not in self._states:
            omega = self._omega(place, m)
            fine = [rod.refined(omega, _PIECE)[0] for rod in self._at.referred.rods]
            self._states[place, m] = self._state(fine, place, m)
        state, spring = self._states[place, m], self._springs.index(shaft)
        torque = state.train.spring_torque(spring, state.q, state.slopes)
        if self._joints is not None:
            stiffness, slope = complex(self._stiffness[m, shaft, place]), state.slopes.springs[spring]
            ahead = self._joints.of_shaft(shaft, m, stiffness, slope)
            torque = torque._replace(slopes=torque.slopes + ahead)
        return state, torque

    def _of_rod(
        self, n: int, along: StationTorques, station: int, place: int, m: int
    ) -> tuple[_State, Output]:
        """The train with a rod cut at a station too, and the torque there."""
        rods, omega = list(self._at.referred.rods), self._omega(place, m)
        rods[n], piece, end = _split(rods[n], along, station)
        refined = [rod.refined(omega, _PIECE) for rod in rods]
        state = self._state([fine for fine, _ in refined], place, m)
        # The first of the parts of a piece has its first end, the last its second.
        part = int(np.flatnonzero(refined[n][1] == piece)[-end])
        before = sum(len(fine.stiffness) for fine, _ in refined[:n])
        return state, state.train.piece_torque(before + part, end, state.q, state.slopes)

    def _omega(self, place: int, m: int) -> float:
        """Angular frequency of an order at a speed [rad/s]."""
        return float(self._at.torques.omega[m, place])

    def _state(self, rods: Sequence[Rod], place: int, m: int) -> _State:
        """The train cut into the pieces of `rods` at an order and speed."""
        at, torques, omega = self._at, self._torques[place], self._omega(place, m)
        train = cut_train(at_stiffness(at.referred, at.operating.stiffness[:, place]), omega, rods)
        n = len(at.referred.inertia)
        H = train.stiffness.copy()
        H[np.arange(n), np.arange(n)] += 1j * omega * at.operating.disc_damping[:, place]
        if at.operating.disc_stiffness is not None:
            H[np.arange(n), np.arange(n)] += at.operating.disc_stiffness
        # Stations follow the masses, of which the twist of stiff shafts is known better than H tells.
        masses = self._q[:, :, place][m]
        q = np.concatenate([masses, solved(H[n:, n:], -(H[n:, :n] @ masses)[:, None])[:, 0]])
        slopes = self._part_slopes(omega, place)
        right = -train.moved(q, slopes)
        right[:n] += torques.pulsating[m]
        if self._joints is not None:
            right[:n] += self._ahead(omega, place, m)
        return _State(train, H, q, slopes, right)

    def _ahead(self, omega: float, place: int, m: int) -> Complexes:
        """Derivatives of what joints do to the masses, (masses, variables) [N m]."""
        assert self._joints is not None
        mean, dmean = self._at.mean_torques[:, place], self._torques[place].mean
        stiffness, slopes = self._stiffness[m, :, place], self._spring_slopes(omega, place)
        ahead: Complexes = self._joints.on_masses(m, stiffness, slopes, mean, dmean)
        return ahead

    def _spring_slopes(self, omega: float, place: int) -> Complexes:
        """Derivatives of k(1 + iη) + iωc of all shafts, (shafts, variables)."""
        r, d = self._at.referred, self._d
        k, η = self._at.operating.stiffness[:, place], r.loss_factor
        dk, dη, dc = self._torques[place].stiffness, d.loss_factor, d.damping
        slopes: Complexes = (1 + 1j * η)[:, None] * dk + 1j * k[:, None] * dη + 1j * omega * dc
        return slopes

    def _part_slopes(self, omega: float, place: int) -> PartSlopes:
        """Derivatives of the parts of the train at a frequency [rad/s] and speed."""
        r, d, torques = self._at.referred, self._d, self._torques[place]
        k, η, c = self._at.operating.stiffness[:, place], r.loss_factor, r.damping
        dk, dη, dc = torques.stiffness, d.loss_factor, d.damping
        springs = self._spring_slopes(omega, place)
        pieces = [np.zeros((0, len(d.variables)), complex)]
        for rod in r.rods:
            # Losses of a piece are to its stiffness as those of the shaft are.
            s = rod.shaft
            lossy = 1 + 1j * (η[s] + omega * c[s] / k[s])
            change = 1j * (dη[s] + omega * (dc[s] / k[s] - c[s] / k[s] ** 2 * dk[s]))
            pieces.append(np.tile(change / lossy, (len(rod.stiffness), 1)))
        of_rods = rod_numbers(r)
        return PartSlopes(
            masses=-(omega**2) * d.bare_inertia
            + 1j * omega * (d.disc_damping + torques.damping)
            + torques.control,
            springs=springs[self._springs],
            stiffness=d.rod_stiffness / of_rods.stiffness[:, None] + np.concatenate(pieces),
            inertia=d.rod_inertia / of_rods.inertia[:, None],
            joins=d.joins,
        )


def _split(rod: Rod, along: StationTorques, station: int) -> _Split:
    """Cut the piece in which a station lies there, into parts of their shares of the flexibility."""
    end, part = divmod(station, len(along.rod.stiffness))
    piece = int(along.piece[part])
    parts = np.flatnonzero(along.piece[: len(along.rod.stiffness)] == piece)
    share = (part - int(parts[0]) + end) / len(parts)
    if share in (0.0, 1.0):
        return _Split(rod, piece, end)
    both = np.array([share, 1 - share])
    k, j = rod.stiffness, rod.inertia
    stiffness = np.concatenate([k[:piece], k[piece] / both, k[piece + 1 :]])
    inertia = np.concatenate([j[:piece], j[piece] * both, j[piece + 1 :]])
    return _Split(Rod(rod.shaft, stiffness, inertia, rod.ends), piece + 1, 0)
