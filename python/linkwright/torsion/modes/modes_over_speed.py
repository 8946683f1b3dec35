"""Modes of a train at any speed: those of a machine, whose couplings stiffen under torque, or given ones."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from linkwright.kernel.arrays import Complexes, Floats, Indices
from linkwright.kernel.errors import InputError
from linkwright.machine.machine import Machine
from linkwright.torsion.core.distributed import RodShape
from linkwright.torsion.core.rod import energies
from linkwright.torsion.core.train import ReferredTrain
from linkwright.torsion.excitation.drive_line import train_of
from linkwright.torsion.excitation.excited_train import ExcitedTrain, prepared
from linkwright.torsion.modes.free import FreeVibration, modes_wanted, train_modes

# Orders that differ by a smaller share are one within rounding of ratios.
_EQUAL = 1e-9


@dataclass(frozen=True)
class Shapes:
    """Modes, each at a speed of its own."""

    omega: Floats  # (n,) ω [rad/s]
    shapes: Floats  # (n, discs) θ, the largest 1 or −1
    stiffness: Floats  # (n,) ω² Σ J θ² [N m/rad]
    damping_ratios: Floats | None  # (n,) ζ of light damping; None where damping is not known


class ModesAt(ABC):
    """Modes of a train at any speed."""

    @property
    @abstractmethod
    def discs(self) -> tuple[str, ...]:
        """In the order of the file."""

    @abstractmethod
    def grid(self, ends: tuple[float, float] | None) -> Floats:
        """Speeds between which frequencies are nearly straight, in a range or that of the file [rad/s]."""

    @abstractmethod
    def frequencies(self, speeds: Floats) -> Floats:
        """ω of all modes, (speeds, modes) [rad/s]."""

    @abstractmethod
    def shapes(self, speeds: Floats, modes: Indices) -> Shapes:
        """A mode at each speed."""

    @abstractmethod
    def orders(self, speeds: Floats) -> Floats:
        """Orders of the torques, (orders,)."""

    @abstractmethod
    def fixed(self, speeds: Floats) -> Floats:
        """Fixed frequency beside each order, (orders,) [rad/s]; empty for none."""

    @abstractmethod
    def torques(self, speeds: Floats, orders: Floats, fixed: Floats) -> Complexes | None:
        """M of a line at each speed, (speeds, discs) [N m]; None where they are not known."""


def constant(free: FreeVibration) -> ModesAt:
    """The same modes at all speeds."""
    return _Constant(free)


def over_speed(machine: Machine) -> ModesAt:
    """Modes of a machine."""
    return _OfMachine(machine)


@dataclass(frozen=True)
class _Constant(ModesAt):
    free: FreeVibration

    @property
    def discs(self) -> tuple[str, ...]:
        return self.free.discs

    def grid(self, ends: tuple[float, float] | None) -> Floats:
        if ends is None:
            raise InputError(
                "speed_range: expected the lowest and the highest speed of the first disc, in rad/s"
            )
        return np.array(ends)

    def frequencies(self, speeds: Floats) -> Floats:
        return np.tile(self.free.angular_frequencies, (len(speeds), 1))

    def shapes(self, speeds: Floats, modes: Indices) -> Shapes:
        free = self.free
        return Shapes(
            free.angular_frequencies[modes], free.mode_shapes[modes], free.modal_stiffness[modes], None
        )

    def orders(self, speeds: Floats) -> Floats:
        raise InputError("orders: expected a list of orders, cycles per revolution of the first disc")

    def fixed(self, speeds: Floats) -> Floats:
        return np.empty(0)

    def torques(self, speeds: Floats, orders: Floats, fixed: Floats) -> Complexes | None:
        return None


class _OfMachine(ModesAt):
    def __init__(self, machine: Machine) -> None:
        self.machine = machine
        # At the speeds that were asked for last: frequencies, shapes and torques of the same follow.
        self._last: ExcitedTrain | None = None

    @cached_property
    def _curved(self) -> bool:
        train = self.machine.train
        if train is None:
            return False
        waves = (wave for excitation in train.excitations.values() for wave in excitation.harmonics)
        if train.pendulums or any(wave.frequency for wave in waves):
            return True
        return any(coupling.twist is not None for coupling in train.couplings.values())

    @cached_property
    def discs(self) -> tuple[str, ...]:
        return tuple(train_of(self.machine).discs)

    def grid(self, ends: tuple[float, float] | None) -> Floats:
        every = prepared(self.machine).torques.speeds if ends is None else np.linspace(*ends, 200)
        every = np.sort(every)
        return every if self._curved else every[[0, -1]]

    def frequencies(self, speeds: Floats) -> Floats:
        at = self._at(speeds)
        columns, place = np.unique(at.operating.stiffness, axis=1, return_inverse=True)
        wanted = modes_wanted(self.machine, at.train)
        omega = [train_modes(_train(at, column), wanted).omega for column in columns.T]
        return np.array(omega)[place.ravel()]

    def shapes(self, speeds: Floats, modes: Indices) -> Shapes:
        at = self._at(speeds)
        rows = [self._shape(at, n, mode) for n, mode in enumerate(modes.tolist())]
        omega, shapes, stiffness, ratios = (np.array(column) for column in zip(*rows, strict=True))
        return Shapes(omega, shapes, stiffness, ratios)

    def _shape(self, at: ExcitedTrain, n: int, mode: int) -> tuple[float, Floats, float, float]:
        """ω, θ, modal stiffness and ζ of a mode at a speed."""
        train = _train(at, at.operating.stiffness[:, n], at.operating.disc_damping[:, n])
        modes = train_modes(train, modes_wanted(self.machine, at.train))
        q, ω = modes.masses[mode], float(modes.omega[mode])
        # Σ J q² = 1, with the inertia of shafts.
        ratio = (ω * (q @ train.damping_matrix @ q) + q @ train.loss_matrix @ q) / (2 * ω**2)
        ratio += sum(_of_rod(train, rod, ω) for rod in (modes.exact[mode].rods if modes.exact else ()))
        θ = train.scale * q[train.mass]
        size = np.abs(θ).max()
        return ω, θ / size, float(ω**2 / size**2), float(ratio)

    def orders(self, speeds: Floats) -> Floats:
        orders = self._at(speeds).torques.orders
        if not len(orders):
            remedy = "give orders, or [train.excitations], harmonics of [train.loads], or a [train.engine]"
            raise InputError(f"nothing excites the train of {self.machine.name}: {remedy}")
        return orders

    def fixed(self, speeds: Floats) -> Floats:
        return self._at(speeds).torques.fixed

    def torques(self, speeds: Floats, orders: Floats, fixed: Floats) -> Complexes | None:
        at = self._at(speeds)
        torques = at.torques
        if not len(torques.orders):
            return None
        on_discs = np.zeros((len(speeds), torques.harmonics.shape[1]), complex)
        for n, (order, offset) in enumerate(zip(orders.tolist(), fixed.tolist(), strict=True)):
            same = (np.abs(torques.orders - order) <= _EQUAL * order) & (torques.offsets == offset)
            on_discs[n] = at.exciting[same, :, n].sum(axis=0)
        return on_discs

    def _at(self, speeds: Floats) -> ExcitedTrain:
        if self._last is None or not np.array_equal(self._last.torques.speeds, speeds):
            self._last = prepared(self.machine, speeds)
        return self._last


def _of_rod(train: ReferredTrain, shape: RodShape, ω: float) -> float:
    """What a shaft with distributed inertia adds to ζ beyond what the twist between its ends gives."""
    s, twist = shape.rod.shaft, shape.angles[0] - shape.angles[-1]
    lossy = ω * train.damping[s] / train.stiffness[s] + train.loss_factor[s]
    potential = energies(shape.rod, ω, shape.angles).potential.sum()
    return float(lossy * (potential - train.stiffness[s] * twist**2) / (2 * ω**2))


def _train(at: ExcitedTrain, stiffness: Floats, damping: Floats | None = None) -> ReferredTrain:
    damping = at.referred.disc_damping if damping is None else damping
    train = replace(at.referred, stiffness=np.ascontiguousarray(stiffness), disc_damping=damping)
    return train.on_springs(at.operating.disc_stiffness)
