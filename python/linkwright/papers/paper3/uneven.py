"""Speed fluctuation along the shaft of the V-12: rigid, with torsion, with weak cylinders."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.machine.address import replace
from linkwright.machine.machine import Machine
from linkwright.papers.paper3.engine import TrialEngine
from linkwright.torsion.model.engine.engine import firing_angles
from linkwright.torsion.model.whole_train import throw_names
from linkwright.torsion.response.excited_train import excited_train
from linkwright.torsion.response.forced import ForcedVibration, forced_vibration, responded
from linkwright.torsion.response.harmonics import span
from linkwright.torsion.response.unevenness_along import UnevennessAlong, unevenness_along

Floats = NDArray[np.float64]

# Orders whose swing is reported one by one.
_TOLD = 3


@dataclass(frozen=True)
class UnevennessChecks:
    """Speed fluctuation of the discs at the speed of service.

    Attributes
    ----------
    speed : float
        Of service [rad/s].
    discs, places : tuple of str, list of int
        Along the shaft, from its free end, and where they stand in results.
    sound : UnevennessAlong
        N of the sound engine, cylinder by cylinder.
    delta, delta_rigid : ndarray, shape (discs,), and float
        δ of the sound engine, with torsion, and if nothing twisted.
    swing : ndarray, shape (discs,)
        Half the peak-to-peak angle of vibration, all orders in phase [rad].
    orders, by_order : tuple of float, ndarray, shape (orders, discs)
        Those that swing most, and their amplitudes [rad].
    weak, weak_rigid : ndarray, shape (cylinders, discs) and (cylinders,)
        δ with each cylinder weak in turn, with torsion, and if nothing twisted.
    """

    speed: float
    discs: tuple[str, ...]
    places: list[int]
    sound: UnevennessAlong
    delta: Floats
    delta_rigid: float
    swing: Floats
    orders: tuple[float, ...]
    by_order: Floats
    weak: Floats
    weak_rigid: Floats

    @property
    def flywheel(self) -> int:
        """Place of the flywheel along the shaft."""
        return self.discs.index("flywheel")

    @property
    def N(self) -> Floats:
        """N of the sound engine with torsion, shape (discs,)."""
        return self.sound.unevenness[self.places]

    @property
    def N_rigid(self) -> float:
        """N of the sound engine if nothing twisted."""
        return float(self.sound.unevenness_rigid[0])

    @property
    def rise(self) -> Floats:
        """δ with a weak cylinder over that of the sound engine, with torsion, shape (cylinders, discs)."""
        return self.weak / self.delta

    @property
    def rise_rigid(self) -> Floats:
        """The same if nothing twisted, shape (cylinders,)."""
        return self.weak_rigid / self.delta_rigid


def unevenness_checks(trial: TrialEngine, factor: float) -> UnevennessChecks:
    """Speed fluctuation along the shaft at the speed of service, sound and with each cylinder weak in turn.

    A weak cylinder has the share ``factor`` of its combustion.
    """
    machine, engine, speed = trial.machine, trial.engine, trial.service
    at = excited_train(machine, np.array([speed]))
    found = responded(at)
    discs = _along(found, throw_names(len(engine.throws)))
    places = [found.discs.index(name) for name in discs]
    theta = found.amplitudes[:, places, 0]
    most = np.argsort(np.abs(theta).max(axis=1))[::-1][:_TOLD]
    greatest, least = span(found.together, theta)
    angles, _ = firing_angles(engine.places, engine.firing_order, engine.cycle)
    firing = {str(n + 1): float(angle) for n, angle in enumerate(angles)}
    weak = [weakened(machine, speed, n + 1, factor) for n in range(engine.n_cylinders)]
    return UnevennessChecks(
        speed=speed,
        discs=discs,
        places=places,
        sound=unevenness_along(at, found, firing, engine.strokes // 2, speed),
        delta=found.unevenness[places, 0],
        delta_rigid=float(found.unevenness_rigid[0, 0]),
        swing=0.5 * (greatest - least),
        orders=tuple(found.orders[most].tolist()),
        by_order=np.abs(theta[most]),
        weak=np.array([each.unevenness[places, 0] for each in weak]),
        weak_rigid=np.array([each.unevenness_rigid[0, 0] for each in weak]),
    )


def weakened(machine: Machine, speed: float, number: int, factor: float) -> ForcedVibration:
    """Forced vibration at a speed [rad/s] with a share of the combustion in one cylinder, counted from 1."""
    weak = replace(machine, {"train.engine.factors": {str(number): factor}})
    return forced_vibration(weak, np.array([speed]))


def _along(found: ForcedVibration, throws: tuple[str, ...]) -> tuple[str, ...]:
    """Discs from the free end: what hangs before the first throw, the throws, what they drive."""
    rest = [name for name in found.discs if name not in throws]
    return (rest[0], *throws, *rest[1:])
