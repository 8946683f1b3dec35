r"""Steady start of a train with clutches: what is engaged rotates as one, and mean torques balance.

Engaged clutches and freewheels are rigid for the balance and the twists of the shafts. Brakes count with the
sliding torque at the speed of their disc, S(ω) of VDI 2241-1 and of the falling law,

.. math:: S(\omega) = T_\mathrm{d} + (T_\mathrm{s} - T_\mathrm{d})\,\mathrm{e}^{-\omega/\omega_\mathrm{S}}

and the drag of backstops likewise. The motion itself has all of them with stick and slip.

References
----------
.. [1] VDI 2241-1, Clutches and brakes with frictional connection, 1982.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from linkwright.kernel.arrays import Floats, Integers
from linkwright.kernel.core.curve import Curve, smooth
from linkwright.kernel.errors import MachineError, Problem
from linkwright.torsion.core.torque import OverSpeed, TrainTorque
from linkwright.torsion.core.train import HELD
from linkwright.torsion.core.transient import Grip, MovingTrain, TrainFriction
from linkwright.torsion.in_time.ice_impacts import IceStarts
from linkwright.torsion.in_time.moving_train import moving_train
from linkwright.torsion.in_time.steady_start import balanced_start, loaded_angles
from linkwright.torsion.model.train import Train
from linkwright.torsion.model.train_transient import TrainTransient

# Slips over that of the falling law up to which it is a curve, and its points: cubics err by 1e-9 of it.
_FALLEN, _POINTS = 30.0, 1200


class EngagedStart(NamedTuple):
    """A train with friction at the start of its steady running."""

    moving: MovingTrain  # with what balances it
    speed: float  # of the first disc [rad/s]
    words: str  # what was changed
    rigid: MovingTrain  # the same, of which engaged discs are one mass

    def angles(self, rigid: Floats, *, loaded: bool) -> Floats:
        """Angles of the masses by those of the rigid train, with the twists of mean torques [rad]."""
        if loaded:
            rigid = loaded_angles(self.rigid, rigid, self.speed * self.rigid.turning)
        first = np.unique(self.moving.mass, return_index=True)[1]
        angles: Floats = rigid[self.rigid.mass[first]]
        return angles


def is_asked(manoeuvre: TrainTransient) -> bool:
    """Whether a manoeuvre of a train with friction begins in steady running: with `balanced = true`."""
    named = "balanced" in manoeuvre.model_fields_set and manoeuvre.balanced
    return named and manoeuvre.speed > 0 and not manoeuvre.twists


def engaged_start(
    moving: MovingTrain, train: Train, manoeuvre: TrainTransient, ice: IceStarts
) -> EngagedStart:
    """Balance the mean torques of a train whose clutches are engaged, with `moving` as it starts."""
    wrong = list(_separate(moving, manoeuvre))
    if wrong:
        raise MachineError(wrong)
    rigid = moving_train(train, manoeuvre, ice, slips=False)
    braking = list(_braking(moving))
    balanced, speed, words = balanced_start(
        replace(rigid, torques=(*rigid.torques, *braking)), train, manoeuvre
    )
    names = {torque.name for torque in braking}
    torques = tuple(torque for torque in balanced.torques if torque.name not in names)
    started = replace(moving, torques=torques, controllers=balanced.controllers)
    return EngagedStart(started, speed, words, balanced)


def slipping_notes(moving: MovingTrain, states: Integers) -> Iterator[str]:
    """Parts that slip as the motion begins, although steady running has them engaged; (frictions, n)."""
    names = [
        one.name
        for one, state in zip(moving.frictions, states[:, 0].tolist(), strict=True)
        if HELD not in one.tip and state != _STUCK
    ]
    if names:
        yield f"the start is not steady: {', '.join(names)} cannot carry the mean torque without slip"


_STUCK = 1


def _separate(moving: MovingTrain, manoeuvre: TrainTransient) -> Iterator[Problem]:
    """What keeps a train from turning as one at the start."""
    remedy = "leave balanced out: the motion then begins with the given speeds and without twist"
    for one in moving.frictions:
        if HELD not in one.tip and not _engagement(one):
            found, expected = f"true with the open clutch {one.name}", "engaged clutches at the start"
            yield Problem("train.transient.balanced", found, expected, remedy)
    for name, speed in manoeuvre.speeds.items():
        expected = "none beside balanced = true, which has one speed"
        yield Problem(f"train.transient.speeds.{name}", f"{speed:.6g} rad/s", expected, remedy)


def _engagement(friction: TrainFriction) -> float:
    """Share of the normal force before the start."""
    return 1.0 if friction.engagement is None else max(float(friction.engagement.y[0]), 0.0)


def _braking(moving: MovingTrain) -> Iterator[TrainTorque]:
    """Friction against the ground over the speed of its disc."""
    for one in moving.frictions:
        if HELD not in one.tip:
            continue
        is_first = one.tip[1] == HELD
        grip, share = one.forward if is_first else one.backward, _engagement(one)
        if grip is not None and share:
            disc = one.tip[0 if is_first else 1]
            yield TrainTorque(f"friction of {one.name}", disc, -share, OverSpeed(_over_speed(grip)))


def _over_speed(grip: Grip) -> Curve:
    """Sliding torque over the slip."""
    if grip.curve is not None:
        return grip.curve
    slip = grip.speed * np.linspace(0.0, _FALLEN, _POINTS if grip.rise else 2)
    rise = grip.rise * np.exp(-slip / grip.speed)
    return smooth(slip, grip.sliding + rise, -rise / grip.speed, beyond="held")
