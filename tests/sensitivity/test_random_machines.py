"""Derivatives of random drives and trains against extrapolated differences of the same analyses."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import pytest
from numpy.random import Generator
from random_drives import random_drive
from random_parts import random_train
from sizes import cases

import linkwright as lw
from linkwright.kernel.errors import LinkwrightError

# Share of an entry by which it is varied: rounding over it, and h⁶ of what is left by extrapolation.
_STEP = 1e-4

# Shares of it for differences over shorter steps: between two extremes that nearly tie, the longer ones err.
_SHORTER = (1.0, 0.1, 0.01)

# What differences are good for, as a share of the largest derivative of a response, or of the response.
_TOLERANCE = 1e-7

# Works are left out: of springs and weights they are zero but for rounding.
_NUMBERS = ("speed_mean_time", "period", "speed_max", "torque_motor_rms", "unevenness")

Measure = Callable[[lw.Machine], Sequence[float]]


def _drive(random: Generator) -> tuple[lw.Machine, list[str], Measure]:
    machine = lw.Machine.model_validate(random_drive(random))

    def measure(machine: lw.Machine) -> list[float]:
        state = lw.steady_state(machine, accuracy=1e-13)
        return [getattr(state, name) for name in _NUMBERS]

    return machine, [f"steady_state.{name}" for name in _NUMBERS], measure


def _train(random: Generator) -> tuple[lw.Machine, list[str], Measure]:
    described = {"format": 1, "name": "train", "train": random_train(random)}
    machine = lw.Machine.model_validate(described)
    n = len(machine.train.discs) if machine.train else 0
    names = [f"free_vibration.natural_frequencies.{i}" for i in range(1, n)]
    return machine, names, lambda machine: lw.free_vibration(machine).natural_frequencies[1:].tolist()


def _difference(machine: lw.Machine, address: str, measure: Measure, step: float) -> np.ndarray:
    """Central differences over h, 2h and 4h, extrapolated to sixth order, times the entry."""
    value = lw.get(machine, address)
    near = {
        n: np.array(measure(lw.replace(machine, {address: value * (1 + n * step)})))
        for n in (-4, -2, -1, 1, 2, 4)
    }
    once, twice, four = ((near[n] - near[-n]) / (2 * n * step) for n in (1, 2, 4))
    found: np.ndarray = (64 * once - 20 * twice + four) / 45
    return found


def check(machine: lw.Machine, names: list[str], measure: Measure, every: int) -> tuple[int, list[str]]:
    """How many derivatives were compared, and which are wrong."""
    found = lw.gradient(machine, names)
    exact = found.derivatives * found.at
    # What is zero throughout, as the torque of a motor without load, has a difference of zero.
    scales = np.maximum(np.nanmax(np.abs(exact), axis=1), np.abs(found.values)) + 1e-300
    free = np.array([name not in found.ties for name in found.responses])
    compared, wrong = 0, []
    for at in np.flatnonzero(found.at)[::every]:
        try:
            errors = np.array(
                [
                    np.abs(exact[:, at] - _difference(machine, found.variables[at], measure, step)) / scales
                    for step in (_STEP * share for share in _SHORTER)
                ]
            )
        except LinkwrightError:
            continue
        # Where a step is too coarse, the finer one comes nearer by far more than a wrong one would.
        off = free & (errors.min(axis=0) > _TOLERANCE) & (errors[-1] > 1e-2 * errors[0])
        wrong += [
            f"{found.responses[k]} by {found.variables[at]}: {errors[:, k]}" for k in np.flatnonzero(off)
        ]
        compared += int(free.sum())
    return compared, wrong


@pytest.mark.parametrize("kind", [_drive, _train])
def test_derivatives_are_those_of_the_analysis(kind) -> None:
    compared = 0
    for case in range(cases(12, 1000)):
        try:
            machine, names, measure = kind(np.random.default_rng([3, case]))
            measure(machine)
            one, wrong = check(machine, names, measure, cases(5, 1))
        except LinkwrightError:
            # It closes nowhere, nothing drives it, or its kinks move without end, as the error says.
            continue
        assert not wrong, (case, wrong)
        compared += one
    assert compared > 50
