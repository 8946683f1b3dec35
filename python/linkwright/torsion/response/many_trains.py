"""Vibration of many trains of one structure at once: a study that varies inertias, stiffnesses and dampings.

What these entries act on is worked out for all trains together, torques once for all, and forced vibration
with the speeds of all trains in one row. Each result is that of its own train.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any, TypeVar

import numpy as np

from linkwright.kernel.arrays import Complexes, Floats
from linkwright.machine.address import exchanged, known_place
from linkwright.machine.machine import Machine
from linkwright.torsion.core.response import respond, tree_of
from linkwright.torsion.core.train import ReferredTrain, referred_rows
from linkwright.torsion.excitation.excited_train import excited_train, loaded
from linkwright.torsion.excitation.harmonics import Torques
from linkwright.torsion.model.train import Train
from linkwright.torsion.model.whole_train import whole_train
from linkwright.torsion.modes.damped import DampedVibration, at_rest, damped_trains
from linkwright.torsion.modes.free import FreeVibration, TrainModes, modes_table
from linkwright.torsion.response.forced import ForcedVibration, vibration_by_amplitudes

# Entries that change neither speeds nor torques, and that nothing checks against other entries: by table.
_VARIED = {
    "discs": ("inertia", "damping"),
    "shafts": ("stiffness", "damping", "loss_factor"),
    "couplings": ("stiffness", "damping", "loss_factor"),
    "gears": ("stiffness", "damping", "loss_factor"),
    "dampers": ("ring_inertia",),
    "planetaries": ("planet_inertia", "sun_stiffness", "ring_stiffness", "loss_factor"),
}

# Numbers of a referred train by masses or shafts.
_NUMBERS = ("inertia", "stiffness", "disc_damping", "damping", "loss_factor")

# Speeds of all trains, or their masses, that are computed together.
_TOGETHER = 4000

Vibration = TypeVar("Vibration", FreeVibration, ForcedVibration)


def free_vibrations(machine: Machine, entries: Mapping[str, Floats]) -> Iterator[FreeVibration] | None:
    """Free vibration of a machine with other numbers, one row after another, without nodes.

    None where other entries are varied, or the train is not made of lumped masses. `entries`: address →
    (n,) values.
    """
    many = _many_trains(machine, entries)
    return None if many is None else many.free()


def damped_vibrations(machine: Machine, entries: Mapping[str, Floats]) -> Iterator[DampedVibration] | None:
    """Damped vibration at rest likewise."""
    many = _many_trains(machine, entries)
    return None if many is None else many.damped()


def forced_vibrations(machine: Machine, entries: Mapping[str, Floats]) -> Iterator[ForcedVibration] | None:
    """Forced vibration likewise; None also of trains with loops or damping ratios."""
    many = _many_trains(machine, entries)
    if many is None or tree_of(many.first) is None or not many.is_plain:
        return None
    # Torques do not depend on what is varied.
    return many.forced(excited_train(machine).torques)


def _many_trains(machine: Machine, entries: Mapping[str, Floats]) -> _ManyTrains | None:
    """The trains of a machine with other numbers; None where they are not of one structure."""
    train = machine.train
    if train is None or train.pendulums or train.modal_damping is not None:
        return None
    for address, column in entries.items():
        place = known_place(machine, address)
        # Without damping or stiffness a part may be none.
        if len(place) != 4 or place[0] != "train" or not column.all():
            return None
        if place[3] not in _VARIED.get(place[1], ()):
            return None
    many = _ManyTrains(machine, dict(entries))
    return None if many.first.rods else many


@dataclass(frozen=True)
class _ManyTrains:
    """Trains of a machine with other numbers."""

    machine: Machine
    entries: dict[str, Floats]  # address → (trains,)

    @property
    def count(self) -> int:
        """How many."""
        return len(next(iter(self.entries.values())))

    @cached_property
    def train(self) -> Train:
        """Discs, shafts and gears, with arrays over all trains."""
        return _expanded(self.machine, self.entries)

    @cached_property
    def _structure(self) -> ReferredTrain:
        return referred_rows(self.train)

    @cached_property
    def rows(self) -> dict[str, Floats]:
        """Numbers of the referred trains, (trains, …) each."""
        numbers = {name: getattr(self._structure, name) for name in _NUMBERS}
        return {
            name: np.ascontiguousarray(np.broadcast_to(array, (self.count, array.shape[-1])))
            for name, array in numbers.items()
        }

    @cached_property
    def first(self) -> ReferredTrain:
        """The first of them."""
        return self.one(0)

    def one(self, n: int) -> ReferredTrain:
        """One of them, referred."""
        own: dict[str, Any] = {name: rows[n] for name, rows in self.rows.items()}
        return replace(self._structure, **own)

    @property
    def is_plain(self) -> bool:
        """Whether no stiffness follows the mean torque by a curve."""
        train = self.machine.train
        assert train is not None
        return all(coupling.twist is None for coupling in train.couplings.values())

    def free(self) -> Iterator[FreeVibration]:
        """Free vibration of each."""
        modes = [self.one(n).modes() for n in range(self.count)]
        omega, masses = (np.concatenate([mode[k] for mode in modes]) for k in (0, 1))
        each = len(self.first.inertia)
        inertia = self._of_discs("inertia")
        stiffness = self.rows["stiffness"] / self.first.lead**2
        table = modes_table(
            self.train,
            self.first,
            TrainModes(omega, masses, ()),
            np.repeat(inertia, each, axis=0),
            np.repeat(stiffness, each, axis=0),
        )
        return _parts(table, 0, each, self.count)

    def _of_discs(self, entry: str) -> Floats:
        """Numbers of the discs at their own speeds, (trains, discs)."""
        discs = (getattr(disc, entry) for disc in self.train.discs.values())
        return np.stack([np.broadcast_to(number, self.count) for number in discs], axis=-1)

    def damped(self) -> Iterator[DampedVibration]:
        """Damped vibration of each at rest."""
        damping, step = self._of_discs("damping"), max(1, _TOGETHER // len(self.first.inertia))
        for start in range(0, self.count, step):
            block = range(start, min(start + step, self.count))
            yield from damped_trains([at_rest(self.train, self.one(n), damping[n]) for n in block])

    def forced(self, torques: Torques) -> Iterator[ForcedVibration]:
        """Forced vibration of each under the torques on all, in blocks."""
        step = max(1, _TOGETHER // len(torques.speeds))
        for start in range(0, self.count, step):
            own = {address: column[start : start + step] for address, column in self.entries.items()}
            yield from _ManyTrains(self.machine, own).block(torques)

    def block(self, torques: Torques) -> Iterator[ForcedVibration]:
        """The same at all speeds of all trains together."""
        n, speeds = self.count, len(torques.speeds)
        repeated = {address: np.repeat(column, speeds) for address, column in self.entries.items()}
        train = _expanded(self.machine, repeated)
        columns: dict[str, Any] = {
            name: np.ascontiguousarray(np.repeat(rows, speeds, axis=0).T) for name, rows in self.rows.items()
        }
        at = loaded(self.machine, train, replace(self.first, **columns), _tiled(torques, n))
        q: Complexes = np.concatenate(
            [self._amplitudes(at, k, slice(k * speeds, (k + 1) * speeds)) for k in range(n)], axis=2
        )
        return _parts(vibration_by_amplitudes(at, q), -1, speeds, n)

    def _amplitudes(self, at: Any, k: int, part: slice) -> Complexes:
        """Amplitudes of the masses of a train, (orders, masses, speeds)."""
        operating = replace(
            at.operating,
            speeds=at.operating.speeds[part],
            stiffness=at.operating.stiffness[:, part],
            disc_damping=at.operating.disc_damping[:, part],
        )
        harmonics = np.ascontiguousarray(at.referred_harmonics[:, :, part])
        return respond(self.one(k), operating, at.torques.orders, harmonics, at.torques.fixed)


def _expanded(machine: Machine, entries: Mapping[str, Floats]) -> Train:
    """The train of a machine with arrays at some entries, as discs, shafts and gears."""
    train = exchanged(machine, entries).train
    assert train is not None
    return whole_train(train)


def _tiled(torques: Torques, times: int) -> Torques:
    """Torques at the same speeds as often."""
    over_speeds = ("speeds", "harmonics", "mean", "damping", "load_factor", "surplus")
    arrays = {name: getattr(torques, name) for name in over_speeds}
    return replace(
        torques,
        **{name: np.tile(array, (*(1,) * (array.ndim - 1), times)) for name, array in arrays.items()},
    )


def _parts(whole: Vibration, axis: int, size: int, count: int) -> Iterator[Vibration]:
    """Results of each train, of which arrays have `size` places of an axis of `count` times as many."""
    arrays: dict[str, Any] = {
        field.name: value
        for field in fields(whole)
        if isinstance(value := getattr(whole, field.name), np.ndarray)
        and value.ndim
        and value.shape[axis] == size * count
    }
    for n in range(count):
        part = slice(n * size, (n + 1) * size)
        place = (part,) if axis == 0 else (..., part)
        own: dict[str, Any] = {name: array[place] for name, array in arrays.items()}
        yield replace(whole, **own)
