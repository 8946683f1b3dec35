"""Unevenness of rotation along the shaft of the V-12: rigid, with torsion, with a weak cylinder."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.analysis.torsion.forced import ForcedVibration, forced_vibration
from linkwright.analysis.torsion.synthesis import span
from linkwright.machine import Machine, replace
from linkwright.machine.whole_train import throw_names

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class UnevennessChecks:
    """Unevenness δ of the discs at the speed of service.

    Attributes
    ----------
    speed : float
        Of service [rad/s].
    discs : tuple of str
        Along the shaft, from its free end.
    rigid : float
        δ of the sound engine if nothing twisted.
    sound : ndarray, shape (discs,)
        δ with torsion.
    swing : ndarray, shape (discs,)
        Half of greatest less least angle of vibration, all orders in phase [rad].
    orders : tuple of float
        The three that swing most.
    by_order : ndarray, shape (orders, discs)
        Amplitudes of these [rad].
    weak_rigid : ndarray, shape (cylinders,)
        δ if nothing twisted, with each cylinder weak in turn.
    weak : ndarray, shape (cylinders, discs)
        δ with torsion, with each cylinder weak in turn.
    """

    speed: float
    discs: tuple[str, ...]
    rigid: float
    sound: Floats
    swing: Floats
    orders: tuple[float, ...]
    by_order: Floats
    weak_rigid: Floats
    weak: Floats

    @property
    def rise_rigid(self) -> Floats:
        """δ with a weak cylinder over that of the sound engine if nothing twisted, shape (cylinders,)."""
        return self.weak_rigid / self.rigid

    @property
    def rise(self) -> Floats:
        """The same with torsion, shape (cylinders, discs)."""
        return self.weak / self.sound


def unevenness_checks(machine: Machine, factor: float) -> UnevennessChecks:
    """Unevenness along the shaft, sound and with each cylinder weak in turn.

    Parameters
    ----------
    machine : Machine
        The engine and what it drives.
    factor : float
        Share of the combustion of a weak cylinder.

    Returns
    -------
    UnevennessChecks
        At the speed of service.
    """
    train = machine.train
    assert train is not None
    assert train.run is not None
    assert train.engine is not None
    speed = np.array([train.run.service])
    found = forced_vibration(machine, speed)
    along = _along(found, throw_names(len(train.engine.throws)))
    places = [found.discs.index(name) for name in along]
    theta = found.amplitudes[:, places, 0]
    most = np.argsort(np.abs(theta).max(axis=1))[::-1][:3]
    greatest, least = span(found.together, theta)
    weak = [_weak(machine, speed, n + 1, factor) for n in range(train.engine.n_cylinders)]
    return UnevennessChecks(
        speed=float(speed[0]),
        discs=along,
        rigid=float(found.unevenness_rigid[0, 0]),
        sound=found.unevenness[places, 0],
        swing=0.5 * (greatest - least),
        orders=tuple(found.orders[most].tolist()),
        by_order=np.abs(theta[most]),
        weak_rigid=np.array([each.unevenness_rigid[0, 0] for each in weak]),
        weak=np.array([each.unevenness[places, 0] for each in weak]),
    )


def _along(found: ForcedVibration, throws: tuple[str, ...]) -> tuple[str, ...]:
    """Discs from the free end: what hangs before the first throw, the throws, what they drive."""
    rest = [name for name in found.discs if name not in throws]
    return (rest[0], *throws, *rest[1:])


def _weak(machine: Machine, speed: Floats, number: int, factor: float) -> ForcedVibration:
    """Forced vibration with one weak cylinder."""
    return forced_vibration(replace(machine, {"train.engine.factors": {str(number): factor}}), speed)
