"""Checks of weak couplings and of speed fluctuation in paper 3."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from linkwright.kernel.arrays import Complexes, Floats
from linkwright.machine.address import replace
from linkwright.machine.machine import Machine
from linkwright.papers.paper3.crank_train import TrialEngine
from linkwright.torsion.diagnosis.diagnosis import diagnosis
from linkwright.torsion.diagnosis.measured_speed import MeasuredSpeed
from linkwright.torsion.excitation.engine_torques import cylinder_torques
from linkwright.torsion.excitation.excited_train import ExcitedTrain, excited_train
from linkwright.torsion.excitation.harmonics import span
from linkwright.torsion.model.engine.engine import firing_angles
from linkwright.torsion.model.train_torques import throw_names
from linkwright.torsion.response.forced import ForcedVibration, forced_vibration, responded
from linkwright.torsion.response.unevenness_along import UnevennessAlong, unevenness_along


@dataclass(frozen=True)
class WeakChecks:
    """Shares of the combustion of all cylinders as they come out where one is weak."""

    cylinder: int  # the weak one, from 1
    discs: tuple[str, ...]  # whose speed is examined
    # (discs, cylinders): shares by least squares over the orders, with the elastic train, and with one taken
    # as rigid.
    elastic: Floats
    rigid: Floats
    # (discs, cylinders): by the rigid train, from what has changed since the engine was sound.
    against_sound: Floats


def weak_checks(trial: TrialEngine, cylinder: int, factor: float, discs: tuple[str, ...]) -> WeakChecks:
    """Tell the shares of all cylinders at the speed of service from the speeds of some discs without noise.

    By the orders below that of the firing; one cylinder, counted from 1, has a share of its combustion.
    """
    at = excited_train(trial.machine, np.array([trial.service]))
    sources = _sources(trial, at)
    weak = weakened(trial.machine, trial.service, cylinder, factor)
    sound = responded(at)

    def factors(vibration: ForcedVibration, *, rigid: bool) -> Floats:
        measured = (_measured(vibration, disc, trial.order) for disc in discs)
        return np.array([diagnosis(at, sources, speed, rigid=rigid).factor for speed in measured])

    rigid = factors(weak, rigid=True)
    # Shares follow from harmonics linearly: what has changed is the difference of both.
    change = rigid - factors(sound, rigid=True)
    return WeakChecks(cylinder, discs, factors(weak, rigid=False), rigid, 1 + change)


def _measured(vibration: ForcedVibration, disc: str, below: float) -> MeasuredSpeed:
    orders = vibration.orders[vibration.orders < below]
    theta = vibration.amplitudes[: len(orders), vibration.discs.index(disc), 0]
    return MeasuredSpeed(disc, orders, 1j * orders * vibration.speeds[0] * theta, None)


def _sources(trial: TrialEngine, at: ExcitedTrain) -> Complexes:
    """What the firing of each cylinder adds to the torque on its throw, (cylinders, orders, discs)."""
    engine, orders = trial.engine, at.torques.orders
    gas = cylinder_torques(engine, at.torques.speeds, float(orders[-1]))
    rows = np.abs(orders[:, None] - gas.orders).argmin(axis=1)
    sources = np.zeros((engine.n_cylinders, len(orders), len(at.train.discs)), complex)
    for number, place in enumerate(engine.places):
        sources[number, :, place.throw] = (gas.firing - gas.motored)[number, rows, 0]
    return sources


# Orders whose swing is reported one by one.
_TOLD = 3


@dataclass(frozen=True)
class UnevennessChecks:
    """Speed fluctuation of the discs at the speed of service."""

    speed: float  # of service [rad/s]
    # Along the shaft, from its free end, and where they stand in results.
    discs: tuple[str, ...]
    places: list[int]
    sound: UnevennessAlong  # n of the sound engine, cylinder by cylinder
    # (discs,): δ of the sound engine, with torsion, and if nothing twisted.
    delta: Floats
    delta_rigid: float
    swing: Floats  # (discs,): half the peak-to-peak angle of vibration, all orders in phase [rad]
    # (orders, discs): those that swing most, and their amplitudes [rad].
    orders: tuple[float, ...]
    by_order: Floats
    # (cylinders, discs): δ with each cylinder weak in turn, with torsion, and if nothing twisted.
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
    """δ along the shaft in service, sound and with each cylinder in turn at ``factor`` of its combustion."""
    machine, engine, speed = trial.machine, trial.engine, trial.service
    at = excited_train(machine, np.array([speed]))
    response = responded(at)
    discs = _along(response, throw_names(len(engine.throws)))
    places = [response.discs.index(name) for name in discs]
    theta = response.amplitudes[:, places, 0]
    most = np.argsort(np.abs(theta).max(axis=1))[::-1][:_TOLD]
    greatest, least = span(response.together, theta)
    angles, _ = firing_angles(engine.places, engine.firing_order, engine.cycle)
    firing = {str(n + 1): float(angle) for n, angle in enumerate(angles)}
    weak = [weakened(machine, speed, n + 1, factor) for n in range(engine.n_cylinders)]
    return UnevennessChecks(
        speed=speed,
        discs=discs,
        places=places,
        sound=unevenness_along(at, response, firing, engine.strokes // 2, speed),
        delta=response.unevenness[places, 0],
        delta_rigid=float(response.unevenness_rigid[0, 0]),
        swing=0.5 * (greatest - least),
        orders=tuple(response.orders[most].tolist()),
        by_order=np.abs(theta[most]),
        weak=np.array([cylinder.unevenness[places, 0] for cylinder in weak]),
        weak_rigid=np.array([cylinder.unevenness_rigid[0, 0] for cylinder in weak]),
    )


def weakened(machine: Machine, speed: float, number: int, factor: float) -> ForcedVibration:
    """Forced vibration at a speed [rad/s] with a share of the combustion in one cylinder, counted from 1."""
    weak = replace(machine, {"train.engine.factors": {str(number): factor}})
    return forced_vibration(weak, np.array([speed]))


def _along(vibration: ForcedVibration, throws: tuple[str, ...]) -> tuple[str, ...]:
    """Discs from the free end: what hangs before the first throw, the throws, what they drive."""
    rest = [name for name in vibration.discs if name not in throws]
    return (rest[0], *throws, *rest[1:])
