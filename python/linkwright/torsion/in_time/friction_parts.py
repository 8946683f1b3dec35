"""Clutches, brakes and freewheels of a machine file as elements with dry friction of a train in motion."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import pairwise

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.core.curve import Curve, straight, switched
from linkwright.kernel.errors import MachineError, Problem
from linkwright.torsion.core.train import HELD
from linkwright.torsion.core.transient import Grip, MovingTrain, TrainFriction
from linkwright.torsion.model.clutch import EngagedPart, FrictionPart
from linkwright.torsion.model.train import GROUND, Train
from linkwright.torsion.model.train_transient import BrakeSwitch, ClutchSwitch, TrainTransient
from linkwright.torsion.model.whole_train import parts_of


def friction_elements(
    train: Train, manoeuvre: TrainTransient, place: Mapping[str, int]
) -> Iterator[TrainFriction]:
    """Elements of a train in a manoeuvre; `place`: of each disc."""
    for name, clutch in train.clutches.items():
        first, second = (place[end] for end in clutch.between)
        grip = _grip(clutch)
        yield TrainFriction(name, (first, second), grip, grip, _engagement(name, clutch, manoeuvre))
    for name, brake in train.brakes.items():
        grip = _grip(brake)
        yield TrainFriction(name, (place[brake.on], HELD), grip, grip, _engagement(name, brake, manoeuvre))
    for name, wheel in train.freewheels.items():
        first, second = (HELD if end == GROUND else place[end] for end in wheel.between)
        yield TrainFriction(name, (first, second), None, Grip(wheel.drag, wheel.drag))


def _grip(part: FrictionPart) -> Grip:
    if part.curve is not None:
        return Grip(part.held, part.at_speed, curve=straight(*part.curve))
    if part.stribeck_speed is None:
        return Grip(part.held, part.at_speed)
    return Grip(part.held, part.at_speed, part.held - part.at_speed, part.stribeck_speed)


def _engagement(name: str, part: EngagedPart, manoeuvre: TrainTransient) -> Curve | None:
    """Engagement over time; None where it is always full."""
    if part.times is not None and part.engagement is not None:
        return straight(part.times, part.engagement)
    changes = [
        (event.time, float(event.kind.endswith("_on")), event.over)
        for event in manoeuvre.events
        if (isinstance(event, ClutchSwitch) and event.clutch == name)
        or (isinstance(event, BrakeSwitch) and event.brake == name)
    ]
    return switched(changes, float(part.closed)) if changes or not part.closed else None


def part_numbers(train: MovingTrain) -> list[int]:
    """Number of the part that each mass belongs to: shafts join masses, and friction does not.

    What rests while the train runs, such as a housing, joins nothing.
    """
    joined = (np.flatnonzero(row * train.turning).tolist() for row in train.joins)
    parts = parts_of(range(train.masses), (pair for masses in joined for pair in pairwise(masses)))
    return [number for _, number in sorted((mass, k) for k, part in enumerate(parts) for mass in part)]


def start_speeds(train: MovingTrain, manoeuvre: TrainTransient) -> Floats:
    """Speeds of the masses at the start, with those given by discs of their parts, (masses,) [rad/s]."""
    speeds = np.full(train.masses, manoeuvre.speed)
    parts = part_numbers(train)
    given: dict[int, str] = {}
    for name, speed in manoeuvre.speeds.items():
        disc = train.discs.index(name)
        part = parts[train.mass[disc]]
        if part in given:
            expected = f"no second speed: {name} rotates with {given[part]}"
            raise MachineError([Problem(f"train.transient.speeds.{name}", f"{speed:.6g} rad/s", expected)])
        given[part] = name
        speeds[[of == part for of in parts]] = speed / train.speed[disc]
    _require_free_sense(train, speeds)
    return speeds


def _require_free_sense(train: MovingTrain, speeds: Floats) -> None:
    """A freewheel whose first disc is faster at the start would be struck."""
    turning = np.append(train.speed * speeds[train.mass], 0.0)
    for friction in train.frictions:
        first, second = turning[list(friction.tip)]
        if friction.forward is None and first > second + _SAME * max(abs(first), abs(second)):
            found = f"{first:.6g} rad/s of its first disc and {second:.6g} rad/s of its second"
            expected = "a first disc that is no faster than the second: engaging it would be an impact"
            raise MachineError([Problem(f"train.freewheels.{friction.name}", found, expected)])


# Share by which speeds of discs that turn together differ by rounding.
_SAME = 1e-9
