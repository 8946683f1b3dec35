r"""Derivatives of the torques that act on a train, and of what its couplings are under their mean.

Torques of the file and of its loads follow from the entries by plain arithmetic, which tangents go through,
and so does the stiffness of pendulums at each speed; mean torques of shafts follow by `mean_torques`. Torques
of an engine come out of a working cycle that is solved for, and couplings with a curve take the slope at
their mean torque: in such trains the derivatives of torques and stiffnesses, and of nothing else, are
extrapolated differences (`linkwright.kernel.numerics.differences`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Complexes, Floats
from linkwright.kernel.errors import InputError, LinkwrightError
from linkwright.kernel.numerics.differences import Numbers, slopes, step_at
from linkwright.kernel.numerics.tangent import lifted
from linkwright.machine.address import entry_of, outside, replace
from linkwright.machine.machine import Machine
from linkwright.machine.tangents import followed
from linkwright.torsion.core.train import ReferredTrain
from linkwright.torsion.excitation.excited_train import excited_train
from linkwright.torsion.excitation.harmonics import Torques, torques_of
from linkwright.torsion.gradient.mean_torques import mean_slopes
from linkwright.torsion.gradient.train import TrainTangents
from linkwright.torsion.model.train import Train
from linkwright.torsion.model.whole_train import whole_train

_Arrays = tuple[Numbers, ...]


@dataclass(frozen=True)
class TorqueTangents:
    """Derivatives of the torques of a train at a speed by its variables, the last axis."""

    pulsating: Complexes  # (orders, masses, variables) referred [N m]
    mean: Floats  # (shafts, variables) in the shafts at their own speed [N m]
    damping: Floats  # (masses, variables) of the loads, referred [N m s/rad]
    stiffness: Floats  # (shafts, variables) under the mean torque, referred [N m/rad]
    control: Floats  # (masses, variables) stiffness of speed controllers, referred [N m/rad]

    def only(self, variables: Sequence[str], known: Sequence[str]) -> TorqueTangents:
        """Those by some of the variables."""
        at = [variables.index(name) for name in known]
        return TorqueTangents(*(array[..., at] for array in _arrays(self)))


def _arrays(tangents: TorqueTangents) -> tuple[Any, ...]:
    return tangents.pulsating, tangents.mean, tangents.damping, tangents.stiffness, tangents.control


def torque_tangents(
    machine: Machine,
    train: Train,
    referred: ReferredTrain,
    speeds: Floats,
    d: TrainTangents,
    refused: dict[str, str],
) -> list[TorqueTangents]:
    """Derivatives of the torques at each speed; entries without any go into `refused`.

    `train`, `referred`, `d`: that of the machine, referred, and its derivatives; `speeds`: (speeds,) [rad/s].
    """
    assert machine.train is not None
    if machine.train.installed or _curved(machine):
        return _by_differences(machine, referred, speeds, d, refused)
    at = excited_train(machine, speeds)
    acting = [name for name in d.variables if name.startswith(_ACTING)]
    work = partial(_torques, referred=referred, speeds=speeds)
    known, (torques, swinging) = followed(machine, acting, work, refused)
    places = [d.variables.index(name) for name in known]

    def spread(torques: Any) -> Any:
        """Derivatives of torques by all variables."""
        of_known = lifted(torques, len(known)).d
        table = np.zeros((*of_known.shape[:-1], len(d.variables)), of_known.dtype)
        table[..., places] = of_known
        return table

    onto = np.zeros((len(referred.inertia), len(train.discs)))
    onto[referred.mass, np.arange(len(train.discs))] = referred.scale
    waves = np.einsum("md,odsv->somv", onto, spread(torques.harmonics))
    damping = np.einsum("md,dsv->smv", onto * referred.scale, spread(torques.damping))
    means = zip(
        np.einsum("md,ds->sm", onto, at.torques.mean),
        np.einsum("md,dsv->smv", onto, spread(torques.mean)),
        strict=True,
    )
    stiffness = np.repeat(d.stiffness[None], len(speeds), axis=0)
    if rings := machine.train.pendulums:
        stiffness[:, [referred.shafts.index(name) for name in rings]] = np.moveaxis(spread(swinging), 1, 0)
    control = np.einsum("md,dv->mv", onto * referred.scale, spread(torques.control))
    return [
        TorqueTangents(wave, mean_slopes(referred, d, *mean), rate, of_shafts, control)
        for wave, mean, rate, of_shafts in zip(waves, means, damping, stiffness, strict=True)
    ]


# What acts on a train besides an engine, and what pendulums are at a speed.
_ACTING = ("train.excitations.", "train.loads.", "train.drivers.", "train.shares.", "train.pendulums.")


def _by_differences(
    machine: Machine, referred: ReferredTrain, speeds: Floats, d: TrainTangents, refused: dict[str, str]
) -> list[TorqueTangents]:
    """The same by extrapolated differences."""
    here = _acting(machine, speeds)
    tables = [np.zeros((*array.shape, len(d.variables)), array.dtype) for array in here]
    for place, name in enumerate(d.variables):
        try:
            for table, column in zip(tables, _columns(machine, name, speeds, here), strict=True):
                table[..., place] = column
        except LinkwrightError as error:
            refused[name] = " ".join(str(error).split())
    waves, mean, damping, curved, control = tables
    # But for couplings with a curve and pendulums, stiffnesses are those of the train: exact derivatives.
    stiffness = np.repeat(d.stiffness[:, None], len(speeds), axis=1)
    assert machine.train is not None
    following = (*_curved(machine), *machine.train.pendulums)
    stiffness[[referred.shafts.index(name) for name in following]] = curved
    return [
        TorqueTangents(waves[:, :, k], mean[:, k], damping[:, k], stiffness[:, k], control)
        for k in range(len(speeds))
    ]


def _columns(machine: Machine, name: str, speeds: Floats, here: _Arrays) -> _Arrays:
    """Derivatives of what acts on a train by one entry; an `InputError` where it has none."""
    x = entry_of(machine, name)
    if isinstance(x, int):
        raise InputError("a count has no derivative")

    def acting(value: float) -> _Arrays:
        return _acting(replace(machine, {name: value}), speeds)

    h = step_at(x)
    less, more = (~outside(machine, name, np.array([x - h, x + h]))[0]).tolist()
    if not (less and more):
        # At the end of its range an entry may still be one that nothing here depends on.
        moved = acting(x + h if more else x - h)
        if all(np.array_equal(a, b) for a, b in zip(here, moved, strict=True)):
            return tuple(np.zeros_like(array) for array in here)
        raise InputError(f"it is at the limit of its range, {x:.6g}")
    derivatives = slopes(acting, x, here)
    if derivatives is None:
        raise InputError("the torques on the train have a kink there")
    return derivatives


def _acting(machine: Machine, speeds: Floats) -> _Arrays:
    """Torques on masses, means in shafts, damping of loads, stiffness of couplings with a curve, control."""
    at = excited_train(machine, speeds)
    damping = at.operating.disc_damping - at.referred.disc_damping[:, None]
    assert machine.train is not None
    following = (*_curved(machine), *machine.train.pendulums)
    curved = [at.referred.shafts.index(name) for name in following]
    held = at.operating.disc_stiffness
    control = np.zeros(len(damping)) if held is None else held
    return at.referred_harmonics, at.mean_torques, damping, at.operating.stiffness[curved], control


def _curved(machine: Machine) -> list[str]:
    """Couplings whose stiffness is that of a curve."""
    couplings = {} if machine.train is None else machine.train.couplings
    return [name for name, coupling in couplings.items() if coupling.twist is not None]


def _torques(machine: Machine, referred: ReferredTrain, speeds: Floats) -> tuple[Torques, Any]:
    """Those of file and loads at each speed, and the stiffness of pendulums, (pendulums, speeds)."""
    assert machine.train is not None
    train = whole_train(machine.train)
    torques = torques_of(train, referred.speed, speeds, is_free=referred.is_free)
    lead = dict(zip(referred.shafts, referred.lead.tolist(), strict=True))
    swinging = [
        lead[name] ** 2 * pendulum.stiffness(lead[name] * speeds)
        for name, pendulum in machine.train.pendulums.items()
    ]
    return torques, np.stack(swinging) if swinging else np.empty((0, len(speeds)))
