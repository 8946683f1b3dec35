r"""A train in the core's terms: referred to one speed, discs behind rigid gears taken together.

Each disc turns n times as fast as the first, θ = n q. With that, inertias and stiffnesses count by n²,

.. math:: J_q = \sum n^2 J, \qquad k_q = n^2 k

and a shaft carries k_q (q_a − q_b) whatever gears lie elsewhere. Discs behind rigid gears share one q: they
are one *mass*. Shafts in parallel add up. What is left is a tree, which is the core's, or has loops, as a
shaft held at both ends has; then the matrices are solved as a whole.

A mesh between gears on a carrier c twists by the motion relative to it,

.. math:: \Delta = (\theta_a - \theta_c) - i\,(\theta_b - \theta_c)

and joins three masses. What rests while the train runs, such as a held ring or a housing on its seat, is
referred with n = 1.

References
----------
.. [1] Lin and Parker, Analytical characterization of the unique properties of planetary gear free vibration,
   J. Vib. Acoust. 121 (1999) 316-321.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from numbers import Real
from typing import Any

import numpy as np

from linkwright import _core
from linkwright.kernel.arrays import Floats, Integers
from linkwright.kernel.errors import MachineError, Problem
from linkwright.kernel.numerics.tangent import numbers, primal, zeros_for
from linkwright.torsion.core.rod import Rod
from linkwright.torsion.model.train import GROUND, ModalDamping, Shaft, Train, TrainGear
from linkwright.torsion.model.whole_train import RodShaft, parts_of, speeds, whole_train

# The mass that is held, in `ReferredTrain.ends`.
HELD = -1

# Share of the largest frequency below which one is zero but for rounding; share of a twist likewise.
_ROUNDING = 1e-10
_EQUAL = 1e-9


@dataclass(frozen=True)
class ReferredTrain:
    """A train referred to the speed of its first disc."""

    discs: tuple[str, ...]  # in the order of the file
    shafts: tuple[str, ...]  # what twists: shafts, then elastic meshes, in the order of the file
    speed: Floats  # (discs,) n, speed of each disc over that of the first, without its sense
    mass: Integers  # (discs,) mass that each disc belongs to
    ends: Integers  # (shafts, 2) masses that each shaft joins; `HELD` for the ground
    tip: Integers  # (shafts, 2) discs that each shaft joins, likewise
    inertia: Floats  # (masses,) referred [kg m²]
    stiffness: Floats  # (shafts,) Referred; zero for a fluid [N m/rad]
    disc_damping: Floats  # (masses,) Viscous, against the ground, referred [N m s/rad]
    damping: Floats  # (shafts,) Viscous, referred [N m s/rad]
    loss_factor: Floats  # (shafts,) η of the complex stiffness k (1 + iη)
    # (masses,) ζ of the modes of vibration by frequency, beyond what damps the parts; empty for none.
    ratios: Floats = field(default_factory=lambda: np.empty(0))
    # Shafts whose inertia is distributed; the inertias of the masses count it at the ends.
    rods: tuple[Rod, ...] = ()
    # (shafts, discs) twist of each shaft at its first end, by the angles of the discs in their own senses;
    # None where no mesh is on a carrier, so that each joins two masses.
    twist: Floats | None = None

    @property
    def is_free(self) -> bool:
        """Whether it can rotate as a rigid body."""
        if self.twist is None:
            return not bool((self.ends == HELD).any())
        apart = np.abs(self.joins) @ self.rigid
        return bool((np.abs(self.joins @ self.rigid) <= _EQUAL * apart).all())

    @property
    def scale(self) -> Floats:
        """Angle of each disc over that of its mass, (discs,): its speed, 1 of one at rest."""
        return self.speed if self.twist is None else np.where(self.speed == 0, 1.0, self.speed)

    @cached_property
    def rigid(self) -> Floats:
        """Motion of the masses when it rotates as a rigid body, (masses,): 1, or 0 of what rests."""
        rigid = np.ones(len(self.inertia))
        if self.twist is not None:
            rigid[self.mass[self.speed == 0]] = 0.0
        return rigid

    @property
    def rigid_inertia(self) -> float:
        """Inertia of the train as a rigid body, referred to the first disc [kg m²]."""
        return float(self.inertia @ self.rigid)

    @property
    def lead(self) -> Floats:
        """Speed of the end of each shaft where its twist counts, over that of the first disc, (shafts,)."""
        return lead_speeds(self.tip, self.scale)

    @cached_property
    def joins(self) -> Floats:
        """Connections, shape (shafts, masses): +1 at the first end of each shaft, −1 at the second.

        Of a mesh on a carrier with the share of the carrier.
        """
        if self.twist is not None:
            onto = (self.mass[:, None] == np.arange(len(self.inertia))).astype(float)
            shares: Floats = np.einsum("sd,dm->sm", self.twist * self.scale / self.lead[:, None], onto)
            return shares
        joins = np.zeros((len(self.ends), len(self.inertia) + 1))
        # The last column is that of the ground.
        for end, sign in zip(self.ends.T, (1.0, -1.0), strict=True):
            np.add.at(joins, (np.arange(len(joins)), end), sign)
        return joins[:, :-1]

    @cached_property
    def stiffness_matrix(self) -> Floats:
        """K of the masses, shape (masses, masses) [N m/rad]."""
        return self._matrix(self.stiffness)

    @cached_property
    def loss_matrix(self) -> Floats:
        """Hysteresis, the imaginary part of K, shape (masses, masses) [N m/rad]."""
        return self._matrix(self.loss_factor * self.stiffness)

    @cached_property
    def damping_matrix(self) -> Floats:
        """C of the masses, viscous, shape (masses, masses) [N m s/rad]."""
        return self._matrix(self.damping) + np.diag(self.disc_damping) + self.modal_damping

    @cached_property
    def modal_damping(self) -> Floats:
        """J Φ diag(2ζω) Φᵀ J of the modes of given damping ratios, shape (masses, masses) [N m s/rad]."""
        omega, shapes = self.modes() if len(self.ratios) else (np.empty(0), np.empty((0, len(self.inertia))))
        vibrating = omega > 0
        momenta = shapes[vibrating] * self.inertia
        rates = 2 * self.ratios[: len(momenta)] * omega[vibrating]
        damping: Floats = (momenta.T * rates) @ momenta
        return damping

    def on_springs(self, stiffness: Floats | None) -> ReferredTrain:
        """The train with a spring from each mass to the ground, (masses,) [N m/rad]; 0 or None for none."""
        held = np.empty(0, np.int64) if stiffness is None else np.flatnonzero(stiffness)
        if stiffness is None or not len(held):
            return self
        discs = [int(np.flatnonzero(self.mass == mass)[0]) for mass in held]
        ground, nothing = np.full(len(held), HELD), np.zeros(len(held))
        rows = np.eye(len(self.discs))[discs]
        return replace(
            self,
            shafts=(*self.shafts, *(self.discs[disc] for disc in discs)),
            ends=np.concatenate([self.ends, np.stack([held, ground], 1)]).astype(np.int32),
            tip=np.concatenate([self.tip, np.stack([discs, ground], 1)]).astype(np.int32),
            stiffness=np.concatenate([self.stiffness, stiffness[held]]),
            damping=np.concatenate([self.damping, nothing]),
            loss_factor=np.concatenate([self.loss_factor, nothing]),
            twist=None if self.twist is None else np.concatenate([self.twist, rows]),
        )

    def _matrix(self, between: Floats) -> Floats:
        if self.twist is not None:
            of_meshes: Floats = (self.joins.T * between) @ self.joins
            return of_meshes
        n = len(self.inertia)
        matrix = np.zeros((n + 1, n + 1))
        # The last row and column are those of the ground.
        a, b = self.ends.T
        np.add.at(matrix, (a, a), between)
        np.add.at(matrix, (b, b), between)
        np.add.at(matrix, (a, b), -between)
        np.add.at(matrix, (b, a), -between)
        return matrix[:n, :n]

    def modes(self) -> tuple[Floats, Floats]:
        """Natural frequencies [rad/s], increasing, and shapes of the masses, a row each, with Σ J q² = 1."""
        if self.twist is not None:
            return self._about_carriers()
        core_modes = _core.torsion_modes(self.inertia, self.ends, self.stiffness)
        return self._whole() if core_modes is None else (core_modes.omega, core_modes.shapes)

    def _whole(self) -> tuple[Floats, Floats]:
        """Modes from the matrices, for trains with loops: each part by itself, then put in order."""
        n = len(self.inertia)
        pairs = self.ends[self.stiffness > 0].tolist()
        parts = parts_of(range(n), ((a, b) for a, b in pairs if HELD not in (a, b)))
        held = {end for pair in pairs if HELD in pair for end in pair}
        omega, shapes, row = np.empty(n), np.zeros((n, n)), 0
        for part in parts:
            rows = slice(row, row + len(part))
            omega[rows], shapes[rows, part] = self._part(part, held.isdisjoint(part))
            row += len(part)
        order = np.argsort(omega, kind="stable")
        return omega[order], shapes[order]

    def _about_carriers(self) -> tuple[Floats, Floats]:
        """Modes of a train with meshes on carriers: ω are the singular values of √k B/√J."""
        root = np.sqrt(self.inertia)
        strain = np.sqrt(self.stiffness)[:, None] * self.joins / root
        _, omega, shapes = np.linalg.svd(np.vstack([strain, np.zeros((len(root), len(root)))]))
        omega[omega <= _ROUNDING * omega[0]] = 0.0
        return omega[::-1], shapes[::-1] / root

    def _part(self, masses: list[int], is_free: bool) -> tuple[Floats, Floats]:
        """Modes of one connected part."""
        J = self.inertia[masses]
        scale = 1.0 / np.sqrt(J)
        K = self.stiffness_matrix[np.ix_(masses, masses)]
        square, vectors = np.linalg.eigh(scale[:, None] * K * scale)
        omega, shapes = np.sqrt(np.maximum(square, 0.0)), (scale[:, None] * vectors).T
        if is_free:
            omega[0], shapes[0] = 0.0, 1.0 / np.sqrt(J.sum())
        return omega, shapes


def lead_speeds(tip: Integers, speed: Floats) -> Floats:
    """Speed of the first end of each shaft; of its second, where the first is held, (shafts,)."""
    first, second = tip.T
    lead: Floats = speed[np.where(first == HELD, second, first)]
    return lead


def refer(train: Train, *, slips: bool = False) -> ReferredTrain:
    """A train referred to the speed of its first disc.

    Engaged clutches and freewheels are rigid; with `slips` they connect nothing.
    """
    _require_numbers(train)
    return referred_rows(whole_train(train), slips=slips)


def referred_rows(train: Train, *, slips: bool = False) -> ReferredTrain:
    """The same of discs, shafts and gears, of which some numbers may be arrays over many trains, (n,).

    Inertias, stiffnesses and dampings on which these act have a row for each train, (n, …).
    """
    signed = speeds(train).discs
    n = {name: abs(speed) for name, speed in signed.items()}
    # What rests swings as it is.
    scale = {name: speed if primal(speed) else 1.0 for name, speed in n.items()}
    rigid = [gear.between for gear in train.gears.values() if gear.stiffness is None]
    rigid += [] if slips else train.engaged
    masses = parts_of(train.discs, rigid)
    place = {name: k for k, part in enumerate(masses) for name in part}
    elastic = {name: gear for name, gear in train.gears.items() if gear.stiffness is not None}
    twisting: dict[str, Shaft | TrainGear] = {**train.shafts, **elastic}
    pairs = [part.between for part in twisting.values()]
    # What counts is the end of a shaft that turns, and the first disc of a mesh.
    factor = numbers([scale[a if a != GROUND else b] ** 2 for a, b in pairs])

    def summed(entry: str) -> Any:
        return _row([sum(scale[a] ** 2 * getattr(train.discs[a], entry) for a in part) for part in masses])

    referred = ReferredTrain(
        discs=tuple(train.discs),
        shafts=tuple(twisting),
        speed=numbers(list(n.values())),
        mass=np.array([place[name] for name in train.discs], np.int32),
        ends=_indices(pairs, place),
        tip=_indices(pairs, {name: k for k, name in enumerate(train.discs)}),
        inertia=summed("inertia"),
        stiffness=factor * _row([_rate(part) for part in twisting.values()]),
        disc_damping=summed("damping"),
        damping=factor * _row([part.damping for part in twisting.values()]),
        loss_factor=_row([part.loss_factor for part in twisting.values()]),
        rods=tuple(_rods(list(twisting.values()), factor)),
        twist=_twist(twisting, signed),
    )
    return referred if train.modal_damping is None else _with_ratios(referred, train.modal_damping)


def _row(listed: list[Any]) -> Any:
    """Numbers as an array; if some are those of many trains, (trains, numbers)."""
    if any(isinstance(number, np.ndarray) for number in listed):
        return np.stack(np.broadcast_arrays(*listed), axis=-1)
    return numbers(listed)


def _twist(twisting: Mapping[str, Shaft | TrainGear], signed: Mapping[str, float]) -> Floats | None:
    """Twist of each shaft and mesh by the angles of the discs; None where no mesh is on a carrier."""
    if not any(isinstance(part, TrainGear) and part.carrier for part in twisting.values()):
        return None
    place = {name: n for n, name in enumerate(signed)}
    ratios = [part.speed_ratio if isinstance(part, TrainGear) else 1.0 for part in twisting.values()]
    twist: Floats = zeros_for(ratios, (len(twisting), len(place)))
    for row, (part, ratio) in enumerate(zip(twisting.values(), ratios, strict=True)):
        carrier = (isinstance(part, TrainGear) and part.carrier) or GROUND
        ends = zip((*part.between, carrier), (1.0, -ratio, ratio - 1.0), strict=True)
        counted = [(end, factor if signed[end] >= 0 else -factor) for end, factor in ends if end != GROUND]
        # Counted in the sense of its first end.
        sense = math.copysign(1.0, primal(counted[0][1]))
        for end, factor in counted:
            twist[row, place[end]] += sense * factor
    return twist


def _rods(twisting: list[Shaft | TrainGear], factor: Floats) -> Iterator[Rod]:
    for n, part in enumerate(twisting):
        if isinstance(part, RodShaft):
            k = numbers([piece.stiffness for piece in part.pieces])
            j = numbers([piece.inertia for piece in part.pieces])
            first, second = (factor[n] * end for end in part.end_inertias)
            yield Rod(n, factor[n] * k, factor[n] * j, (first, second))


def _with_ratios(referred: ReferredTrain, given: ModalDamping) -> ReferredTrain:
    modes = int(np.count_nonzero(referred.modes()[0]))
    if len(given.ratios) > modes:
        found, expected = f"{len(given.ratios)} of them", f"at most {modes}, as many as modes of vibration"
        raise MachineError([Problem("train.modal_damping.ratios", found, expected)])
    ratios = np.full(len(referred.inertia), given.others)
    ratios[: len(given.ratios)] = given.ratios
    return replace(referred, ratios=ratios)


def _rate(part: Shaft | TrainGear) -> float:
    """Stiffness of a shaft or of an elastic mesh."""
    if isinstance(part, Shaft):
        return part.rate
    assert part.stiffness is not None
    return part.stiffness


def _require_numbers(train: Train) -> None:
    entries = {f"train.discs.{name}.inertia": disc.inertia for name, disc in train.discs.items()}
    entries |= {f"train.shafts.{name}": shaft.rate for name, shaft in train.shafts.items()}
    for name, gear in train.gears.items():
        ratio = gear.ratio if gear.ratio is not None else abs(gear.speed_ratio)
        entries |= {f"train.gears.{name}.ratio": ratio}
        entries |= {f"train.gears.{name}.stiffness": 1.0 if gear.stiffness is None else gear.stiffness}
    # A fluid alone, of a damper, has no stiffness.
    fluids = {f"train.shafts.{name}" for name, shaft in train.shafts.items() if shaft.damping}
    wrong = [
        Problem(key, f"{value!r}", "one finite number above zero")
        for key, value in entries.items()
        if not isinstance(primal(value), Real) or not (0 < value < np.inf or (value == 0 and key in fluids))
    ]
    if wrong:
        raise MachineError(wrong)


def _indices(pairs: list[tuple[str, str]], place: Mapping[str, int]) -> Integers:
    return np.array([[place.get(end, HELD) for end in pair] for pair in pairs], np.int32).reshape(-1, 2)
