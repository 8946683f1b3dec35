"""Derivatives of a referred train by entries of its machine: inertias, stiffnesses, dampings, speeds.

They follow from the entries by plain arithmetic, which tangents go through. The mechanism behind a
driveline counts with the mean of its inertia, which does not: of its entries there are none.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from functools import partial
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.numerics.tangent import lifted, numbers
from linkwright.machine.machine import Machine
from linkwright.machine.tangents import followed
from linkwright.torsion.core.train import HELD, ReferredTrain, refer
from linkwright.torsion.excitation.drive_line import drive_line, mean_inertia
from linkwright.torsion.model.drive_train import drive_train
from linkwright.torsion.model.train import Train
from linkwright.torsion.model.whole_train import whole_train

_MECHANISM = (
    "the mean inertia of a mechanism is not differentiated here; it is the inertia of the disc `crank`"
)


_MOUNTED = "derivatives of trains with mechanisms are not available"

_START = "the curve of a coupling starts at zero"


@dataclass(frozen=True)
class TrainTangents:
    """Derivatives of the arrays of a `ReferredTrain` by `variables`, the last axis of each.

    Of shafts with distributed inertia, `inertia` counts it at the ends, `bare_inertia` does not.
    """

    variables: tuple[str, ...]
    speed: Floats  # (discs, variables)
    inertia: Floats  # (masses, variables)
    stiffness: Floats  # (shafts, variables)
    disc_damping: Floats  # (masses, variables)
    damping: Floats  # (shafts, variables)
    loss_factor: Floats  # (shafts, variables)
    bare_inertia: Floats  # (masses, variables)
    rod_stiffness: Floats  # (pieces, variables) of all rods, one behind the other
    rod_inertia: Floats  # (pieces, variables) likewise
    # (shafts, masses, variables) of `joins`, which ratios about a carrier move; (0, masses, variables) of a
    # train without one, whose connections are ±1.
    joins: Floats

    def only(self, variables: Sequence[str]) -> TrainTangents:
        """Those by some of the variables."""
        at = [self.variables.index(name) for name in variables]
        return TrainTangents(tuple(variables), *(getattr(self, name)[..., at] for name in _NUMBERS))


_NUMBERS = tuple(field.name for field in fields(TrainTangents))[1:]


def _listed(referred: ReferredTrain) -> list[Any]:
    """The numbers of a referred train by the names of `_NUMBERS`; they may be tangents."""
    bare = list(referred.inertia)
    for rod in referred.rods:
        for mass, lumped in zip(referred.ends[rod.shaft].tolist(), rod.ends, strict=True):
            if mass != HELD:
                bare[mass] = bare[mass] - lumped
    of_rods = ([x for rod in referred.rods for x in getattr(rod, name)] for name in ("stiffness", "inertia"))
    own = (getattr(referred, name) for name in _NUMBERS[: _NUMBERS.index("bare_inertia")])
    joins = np.empty((0, len(bare))) if referred.twist is None else referred.joins
    return [*own, *map(numbers, (bare, *of_rods)), joins]


def train_tangents(
    machine: Machine, variables: Sequence[str], refused: dict[str, str]
) -> tuple[Train, ReferredTrain, TrainTangents]:
    """A train, also referred to its first disc, and its derivatives; what has none goes into `refused`."""
    train = whole_train(_described(machine))
    referred = refer(train)
    J = mean_inertia(machine) if machine.train is None else 0.0
    if machine.train is None:
        moving = ("mechanism.", "bodies.", "pumping_unit.", "rod_rotator.")
        refused.update({name: _MECHANISM for name in variables if name.startswith(moving)})
    if machine.has_mounted_mechanisms:
        refused.update(dict.fromkeys(variables, _MOUNTED))
    refused.update({name: _START for name in variables if name in _starts_of_curves(machine)})
    free = [name for name in variables if name not in refused]
    known, listed = followed(machine, free, partial(_numbers, inertia=J), refused)
    return train, referred, TrainTangents(known, *(lifted(x, len(known)).d for x in listed))


def _starts_of_curves(machine: Machine) -> set[str]:
    """First points of the curves of couplings."""
    couplings = {} if machine.train is None else machine.train.couplings
    return {f"train.couplings.{name}.{key}.0" for name in couplings for key in ("twist", "torque")}


def _described(machine: Machine) -> Train:
    """The train of a machine as it is described, or that of its driveline."""
    return drive_line(machine) if machine.train is None else machine.train


def _numbers(machine: Machine, inertia: float) -> list[Any]:
    """The numbers of the referred train."""
    train = machine.train
    if train is None:
        assert machine.drive is not None
        train = drive_train(machine.drive, inertia)
    # Ratios of damping belong to modes, and change none of these numbers.
    return _listed(refer(train.model_copy(update={"modal_damping": None})))
