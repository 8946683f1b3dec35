"""What is asked of the parts of a train: found against permitted, at any speeds.

| part | what | permitted by |
| --- | --- | --- |
| shaft | vibratory stress, continuous and in transient passage, maximum stress, torques | its `limit` |
| coupling | torque, vibratory torque, heat | its own entries |
| damper | heat | `heat_permitted` |
| gear stage | drop of the torque below its mean | the mean: beyond it teeth part |
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.units import POWER, PRESSURE, TORQUE, Kind
from linkwright.machine.machine import Machine
from linkwright.torsion.model.coupling import Coupling
from linkwright.torsion.model.damper import Damper
from linkwright.torsion.model.shaft_limit import ShaftLimit
from linkwright.torsion.model.train import Shaft, Train
from linkwright.torsion.response.excited_train import ExcitedTrain
from linkwright.torsion.response.mesh_torque import MeshTorque, meshed
from linkwright.torsion.response.stress import ShaftStress, shaft_stress
from linkwright.torsion.response.torsion_response import TorsionResponse

Floats = NDArray[np.float64]

VIBRATORY_STRESS = "vibratory stress"
PASSING_STRESS = "vibratory stress in transient passage"
CONTACT = "drop of torque below its mean"


class Criterion(NamedTuple):
    """One thing that a part bears, over the speeds."""

    part: str  # name of the shaft, coupling, damper or gear stage
    what: str  # in words
    kind: Kind  # the quantity
    found: Floats  # (speeds,) SI
    permitted: Floats  # (speeds,) SI; NaN where nothing is said

    @property
    def ratio(self) -> Floats:
        """Found over permitted, (speeds,): infinite at resonance without damping, 0 where nothing is said."""
        size = np.where(np.isfinite(self.found), self.found, np.inf)
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = np.where(size > 0, size / self.permitted, 0.0)
        return np.where(np.isnan(self.permitted), 0.0, ratio)


def criteria(
    machine: Machine, at: ExcitedTrain, found: TorsionResponse, service: float | None = None
) -> list[Criterion]:
    """All that limits of a train ask for.

    Shafts, couplings, dampers, gear stages; the same in number and order at any speeds. `service`: [rad/s].
    """
    shafts = at.train.shafts
    stress = shaft_stress(machine, found, service)
    listed = [*_stresses(stress, shafts), *_torques(machine.train, shafts, found)]
    listed += _heats(machine.train, found)
    return [*listed, *_contacts(meshed(at, found))] if at.train.gears else listed


def _stresses(stress: ShaftStress, shafts: dict[str, Shaft]) -> Iterator[Criterion]:
    """Of shafts with a limit."""
    for row, name in enumerate(stress.shafts):
        limit, vibratory = shafts[name].limit, stress.vibratory[row]
        if limit is None:
            continue
        if limit.kind != "given" or limit.stress_permitted is not None:
            yield Criterion(name, VIBRATORY_STRESS, PRESSURE, vibratory, stress.continuous[row])
            yield Criterion(name, PASSING_STRESS, PRESSURE, vibratory, stress.transient[row])
        if limit.stress_greatest is not None:
            permitted = np.full(len(stress.speeds), limit.stress_greatest)
            yield Criterion(name, "maximum stress", PRESSURE, stress.greatest[row], permitted)


def _torques(train: Train | None, shafts: dict[str, Shaft], found: TorsionResponse) -> Iterator[Criterion]:
    """Of shafts and couplings."""
    limits = {name: shaft.limit for name, shaft in shafts.items() if shaft.limit is not None}
    bearing: dict[str, ShaftLimit | Coupling] = {**limits, **(train.couplings if train else {})}
    for name, limit in bearing.items():
        row = found.shafts.index(name)
        for what, permitted, torque in (
            ("torque", limit.torque_permitted, found.shaft_torque_max),
            ("vibratory torque", limit.vibratory_torque_permitted, found.shaft_torque_vibratory),
        ):
            if permitted is not None:
                yield Criterion(name, what, TORQUE, torque[row], np.full(len(found.speeds), permitted))


def _heats(train: Train | None, found: TorsionResponse) -> Iterator[Criterion]:
    """Of couplings and dampers."""
    heated: dict[str, Coupling | Damper] = {**train.couplings, **train.dampers} if train else {}
    for name, each in heated.items():
        if each.heat_permitted is not None:
            heat = found.shaft_heat[found.shafts.index(name)]
            yield Criterion(name, "heat", POWER, heat, np.full(len(heat), each.heat_permitted))


def _contacts(gears: MeshTorque) -> Iterator[Criterion]:
    """Of toothed gear stages."""
    for g, name in enumerate(gears.stages):
        if gears.toothed[g]:
            # No mean torque holds teeth together that carry none but by rounding.
            mean = np.abs(gears.mean[g])
            mean = np.where(mean > 1e-12 * np.abs(gears.greatest[g]), mean, 0.0)
            # A stage of a loop has no torque that statics knows.
            mean = np.where(np.isnan(gears.drop[g]), np.nan, mean)
            yield Criterion(name, CONTACT, TORQUE, gears.drop[g], mean)
