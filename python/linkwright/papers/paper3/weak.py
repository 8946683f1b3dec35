"""Which cylinder is weak, told from the speed of a disc: by the elastic train, and by one taken as rigid."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.papers.paper3.engine import TrialEngine
from linkwright.papers.paper3.uneven import weakened
from linkwright.torsion.diagnosis.diagnosis import diagnosis
from linkwright.torsion.diagnosis.measured_speed import MeasuredSpeed
from linkwright.torsion.response.engine_torques import cylinder_torques
from linkwright.torsion.response.excited_train import ExcitedTrain, excited_train
from linkwright.torsion.response.forced import ForcedVibration, responded

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]


@dataclass(frozen=True)
class WeakChecks:
    """Shares of the combustion of all cylinders as they come out where one is weak.

    Attributes
    ----------
    cylinder : int
        The weak one, from 1.
    discs : tuple of str
        Whose speed is looked at.
    elastic, rigid : ndarray, shape (discs, cylinders)
        Shares by least squares over the orders, with the elastic train, and with one taken as rigid.
    against_sound : ndarray, shape (discs, cylinders)
        By the rigid train, from what has changed since the engine was sound.
    """

    cylinder: int
    discs: tuple[str, ...]
    elastic: Floats
    rigid: Floats
    against_sound: Floats


def weak_checks(trial: TrialEngine, cylinder: int, factor: float, discs: tuple[str, ...]) -> WeakChecks:
    """Tell the shares of all cylinders at the speed of service from the speeds of some discs without noise.

    By the orders below that of the firing; one cylinder, counted from 1, has a share of its combustion.
    """
    at = excited_train(trial.machine, np.array([trial.service]))
    sources = _sources(trial, at)
    weak = weakened(trial.machine, trial.service, cylinder, factor)
    sound = responded(at)

    def told(found: ForcedVibration, *, rigid: bool) -> Floats:
        measured = (_measured(found, disc, trial.order) for disc in discs)
        return np.array([diagnosis(at, sources, each, rigid=rigid).factor for each in measured])

    rigid = told(weak, rigid=True)
    # Shares follow from harmonics linearly: what has changed is the difference of both.
    change = rigid - told(sound, rigid=True)
    return WeakChecks(cylinder, discs, told(weak, rigid=False), rigid, 1 + change)


def _measured(found: ForcedVibration, disc: str, below: float) -> MeasuredSpeed:
    """Speed of a disc by its orders below one."""
    orders = found.orders[found.orders < below]
    theta = found.amplitudes[: len(orders), found.discs.index(disc), 0]
    return MeasuredSpeed(disc, orders, 1j * orders * found.speeds[0] * theta, None)


def _sources(trial: TrialEngine, at: ExcitedTrain) -> Complexes:
    """What the firing of each cylinder adds to the torque on its throw, (cylinders, orders, discs)."""
    engine, orders = trial.engine, at.torques.orders
    gas = cylinder_torques(engine, at.torques.speeds, float(orders[-1]))
    rows = np.abs(orders[:, None] - gas.orders).argmin(axis=1)
    found = np.zeros((engine.n_cylinders, len(orders), len(at.train.discs)), complex)
    for number, place in enumerate(engine.places):
        found[number, :, place.throw] = (gas.firing - gas.motored)[number, rows, 0]
    return found
