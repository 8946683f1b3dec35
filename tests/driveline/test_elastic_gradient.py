"""Derivatives of the motion of elastic drivelines, against differences of neighbouring machines."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from typing import Any

import numpy as np
from elastic_drives import random_drive
from numpy.random import Generator
from sizes import random_cases

import linkwright as lw

# Relative changes of all entries between which differences are taken, and the accuracy of the motions.
STEP, ACCURACY = 4e-4, 1e-13


def numbers(machine: lw.Machine, names: tuple[str, ...]) -> np.ndarray:
    """Numbers of the motion by the names of their derivatives."""
    motion, found = lw.elastic_motion(machine, accuracy=ACCURACY, n=4), []
    for name in names:
        quantity, _, part = name.removeprefix("elastic_motion.").partition(".")
        value = getattr(motion, quantity)
        places = (motion.stations, motion.shafts, motion.motors)
        at = [listed.index(part) for listed in places if part in listed and len(listed) == np.size(value)]
        found.append(float(value[at[0]] if part else value))
    return np.array(found)


def differences(
    machine: lw.Machine, change: Mapping[str, float], names: tuple[str, ...], step: float = STEP
) -> tuple[np.ndarray, np.ndarray]:
    """Derivatives along a direction of entries by Richardson's central differences, and their errors."""

    def moved(by_share: float) -> np.ndarray:
        entries = {name: lw.get(machine, name) * (1 + by_share * by) for name, by in change.items()}
        return numbers(lw.replace(machine, entries), names)

    slopes = [(moved(h) - moved(-h)) / (2 * h) for h in (4 * step, 2 * step, step)]
    coarse, fine = ((4 * b - a) / 3 for a, b in itertools.pairwise(slopes))
    best = (16 * fine - coarse) / 15
    # What two neighbouring orders differ by, and rounding of the motions over the step.
    return best, np.abs(best - fine) + 1e-12 / step * np.abs(numbers(machine, names))


def varied(rng: Generator) -> lw.Machine:
    """A random drive, now and then with another motor, a loss factor or a load over the crank angle."""
    machine = random_drive(rng).machine
    drive: Any = machine.drive
    entries: dict[str, object] = {}
    kind, fast = rng.random(), float(drive.motor.speed_no_load)
    if kind < 0.25:
        at = {"speed_synchronous": fast, "speed_rated": 0.95 * fast, "speed_breakdown": 0.8 * fast}
        rated = 0.2 * float(drive.motor.torque_stall)
        of = {"torque_rated": rated, "torque_breakdown": 2.5 * rated, "inertia": drive.motor.inertia}
        entries["drive.motor"] = {"kind": "induction", **at, **of}
    elif kind < 0.4 and drive.motor_shaft is not None:
        entries["drive.motor"] = {"kind": "constant_speed", "speed": 0.9 * fast, "inertia": 0.0}
    if rng.random() < 0.3 and drive.crankshaft is not None:
        entries["drive.crankshaft.loss_factor"] = float(rng.uniform(0.02, 0.2))
    if rng.random() < 0.4:
        mean = 0.1 * float(drive.motor.torque_stall) * drive.gearbox.ratio
        # Steep or not.
        angle = [0.0, 1.0, 1.02, 2.5] if rng.random() < 0.5 else [0.0, 1.0, 1.5, 2.5]
        work = {"kind": "torque_angle", "angle": angle, "torque": [0.0, 0.0, mean, 0.0]}
        loads = {name: load.model_dump(exclude_unset=True) for name, load in machine.loads.items()}
        entries["loads"] = {**loads, "work": work}
    return lw.replace(machine, entries) if entries else machine


def test_derivatives_of_random_drives_along_random_directions_are_those_of_differences() -> None:
    """All numbers of the motion by all entries at once, to a millionth of their change."""
    for number, rng in random_cases(4830, 6, 200):
        machine = varied(rng)
        gradient = lw.gradient(machine, ["elastic_motion"])
        change = dict(zip(gradient.variables, rng.uniform(-1, 1, len(gradient.variables)), strict=True))
        by = np.array([change[name] * x for name, x in zip(gradient.variables, gradient.at, strict=True)])
        found = gradient.derivatives @ by
        expected, error = differences(machine, change, gradient.responses)
        scale = np.maximum(np.abs(gradient.derivatives * by).max(axis=1), np.abs(expected))
        off = np.abs(found - expected)
        bad = off > 1e-6 * scale + 30 * error
        ties = [name in gradient.ties for name in gradient.responses]
        assert not (bad & ~np.array(ties)).any(), (
            number,
            [(gradient.responses[k], found[k], expected[k], error[k]) for k in np.flatnonzero(bad)],
        )
