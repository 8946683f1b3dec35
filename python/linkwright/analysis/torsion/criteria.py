"""What is asked of the parts of a train: found against permitted, at any speeds.

| part | what | permitted by |
| --- | --- | --- |
| shaft | vibratory stress, greatest stress, torque, vibratory torque | its `limit` |
| coupling | torque, vibratory torque, heat | its own entries |
| damper | heat | `heat_permitted` |
| gear stage | drop of the torque below its mean | the mean: beyond it teeth part |
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from linkwright.analysis.torsion.excited import excited
from linkwright.analysis.torsion.forced import ForcedVibration, responded
from linkwright.analysis.torsion.mesh_torque import meshed
from linkwright.analysis.torsion.stress import shaft_stress
from linkwright.machine import Machine, Shaft, Train
from linkwright.machine.coupling import Coupling
from linkwright.machine.damper import Damper
from linkwright.machine.shaft_limit import ShaftLimit
from linkwright.units import POWER, PRESSURE, TORQUE, Kind

Floats = NDArray[np.float64]

VIBRATORY_STRESS = "vibratory stress"
CONTACT = "drop of torque below its mean"


class Criterion(NamedTuple):
    """One thing that a part bears, over the speeds.

    Attributes
    ----------
    part : str
        Name of the shaft, coupling, damper or gear stage.
    what : str
        In words.
    kind : Kind
        The quantity.
    found : ndarray, shape (speeds,)
        SI.
    permitted : ndarray, shape (speeds,)
        SI; NaN where nothing is said.
    """

    part: str
    what: str
    kind: Kind
    found: Floats
    permitted: Floats

    @property
    def ratio(self) -> Floats:
        """Found over permitted, (speeds,): infinite at resonance without damping, 0 where nothing is said."""
        size = np.where(np.isfinite(self.found), self.found, np.inf)
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = np.where(size > 0, size / self.permitted, 0.0)
        return np.where(np.isnan(self.permitted), 0.0, ratio)


def criteria(machine: Machine, speeds: Floats | None = None) -> list[Criterion]:
    """All that limits of a train ask for.

    Parameters
    ----------
    machine : Machine
        With a [train] that something excites, or a drive line that twists.
    speeds : ndarray, shape (speeds,), optional
        Of the first disc; without them those of [train.run] [rad/s].

    Returns
    -------
    list of Criterion
        Shafts, couplings, dampers, gear stages; the same in number and order at any speeds.

    Raises
    ------
    InputError
        Nothing excites the train, or it has no speeds.
    """
    at = excited(machine, speeds)
    found = responded(at)
    # A drive line has no couplings and dampers of its own.
    described = Train() if machine.train is None else machine.train
    shafts = at.train.shafts
    listed = [*_stresses(machine, shafts, found), *_torques(described, shafts, found)]
    listed += _heats(described, found)
    gears = meshed(at, found)
    for g, name in enumerate(gears.stages):
        if gears.toothed[g]:
            # No mean torque holds teeth together that carry none but by rounding.
            mean = np.abs(gears.mean[g])
            mean = np.where(mean > 1e-12 * np.abs(gears.greatest[g]), mean, 0.0)
            # A stage of a loop has no torque that statics knows.
            mean = np.where(np.isnan(gears.drop[g]), np.nan, mean)
            listed.append(Criterion(name, CONTACT, TORQUE, gears.drop[g], mean))
    return listed


def _stresses(machine: Machine, shafts: dict[str, Shaft], found: ForcedVibration) -> Iterator[Criterion]:
    """Of shafts with a limit."""
    stress = shaft_stress(machine, found)
    for row, name in enumerate(stress.shafts):
        limit = shafts[name].limit
        if limit is None:
            continue
        if limit.kind != "given" or limit.stress_permitted is not None:
            yield Criterion(name, VIBRATORY_STRESS, PRESSURE, stress.vibratory[row], stress.continuous[row])
        if limit.stress_greatest is not None:
            permitted = np.full(len(stress.speeds), limit.stress_greatest)
            yield Criterion(name, "greatest stress", PRESSURE, stress.greatest[row], permitted)


def _torques(train: Train, shafts: dict[str, Shaft], found: ForcedVibration) -> Iterator[Criterion]:
    """Of shafts and couplings."""
    limits = {name: shaft.limit for name, shaft in shafts.items() if shaft.limit is not None}
    bearing: dict[str, ShaftLimit | Coupling] = {**limits, **train.couplings}
    for name, limit in bearing.items():
        row = found.shafts.index(name)
        for what, permitted, torque in (
            ("torque", limit.torque_permitted, found.shaft_torque_max),
            ("vibratory torque", limit.vibratory_torque_permitted, found.shaft_torque_vibratory),
        ):
            if permitted is not None:
                yield Criterion(name, what, TORQUE, torque[row], np.full(len(found.speeds), permitted))


def _heats(train: Train, found: ForcedVibration) -> Iterator[Criterion]:
    """Of couplings and dampers."""
    heated: dict[str, Coupling | Damper] = {**train.couplings, **train.dampers}
    for name, each in heated.items():
        if each.heat_permitted is not None:
            heat = found.shaft_heat[found.shafts.index(name)]
            yield Criterion(name, "heat", POWER, heat, np.full(len(heat), each.heat_permitted))
