"""Derivatives of random drives and trains against extrapolated differences of the same analyses."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
import pytest
from differences import sixth_order
from numpy.random import Generator
from random_drives import random_drive, torque_size, with_jump
from random_parts import random_train
from sizes import cases, random_cases

import linkwright as lw
from linkwright import LinkwrightError
from linkwright.kinetostatics.result import Forces
from linkwright.machine import exchanged

# Share of an entry by which it is varied: rounding over it, and h⁶ of what is left by extrapolation.
_STEP = 1e-4

# Shares of it for differences over shorter steps: between two extremes that nearly tie, the longer ones err.
_SHORTER = (1.0, 0.1, 0.01)

# What differences are good for, as a share of the largest derivative of a response, or of the response.
_TOLERANCE = 1e-7

# The same of drives that pass jumps: what leaps at an extreme is known to the accuracy of its angle.
_BEHIND_JUMPS = 1e-6

# Forces follow the acceleration, of which steep motors leave few digits: over steps that shrink, rounding
# grows and truncation falls, while a wrong derivative is off by about as much over each.
_ALIKE = 3.0

# Works are left out: of springs and weights they are zero but for rounding.
_NUMBERS = ("speed_mean_time", "period", "speed_max", "torque_motor_rms", "unevenness")

Measure = Callable[[lw.Machine], Sequence[float]]

# What a derivative is refused for: the torque of a motor without load stands on the kink at zero.
_STANDS_ON_A_KINK = "within rounding error, or two kinks"

# What random drives and trains, and those with an entry varied, are refused for.
# An accuracy of 1e-13 is not reached behind every jump.
_REFUSALS = (
    "no steady motion",
    "the motion slides along a jump",
    "steady motion was found to a relative accuracy",
    "Newton's method does not converge to it",
    "the existence of a steady motion was not determined",
    _STANDS_ON_A_KINK,
    "it is zero within rounding error",
)


def _reason(error: LinkwrightError) -> str:
    """Why a machine is refused: one of the known reasons, else the test fails by it."""
    reasons = [reason for reason in _REFUSALS if reason in str(error)]
    if not reasons:
        raise AssertionError("refused for no known reason") from error
    return reasons[0]


def _measures(machine: lw.Machine, accuracy: float = 1e-13) -> list[float]:
    state = lw.steady_state(machine, accuracy=accuracy)
    return [getattr(state, name) for name in _NUMBERS]


def _drive(random: Generator) -> tuple[lw.Machine, list[str], Measure]:
    machine = lw.Machine.model_validate(random_drive(random))
    # What is zero but for rounding, as the torque without load, is left out.
    known = lw.gradient(machine, ["steady_state"], ["drive.gearbox.ratio"]).responses
    places = [place for place, name in enumerate(_NUMBERS) if f"steady_state.{name}" in known]

    def measure(machine: lw.Machine) -> list[float]:
        numbers = _measures(machine)
        return [numbers[place] for place in places]

    return machine, [f"steady_state.{_NUMBERS[place]}" for place in places], measure


def _forces(random: Generator) -> tuple[lw.Machine, list[str], Measure]:
    """Largest forces of a drive in steady motion, at the angles that `forces` looks at."""
    return largest_forces(lw.Machine.model_validate(random_drive(random)))


def largest_forces(machine: lw.Machine) -> tuple[lw.Machine, list[str], Measure]:

    def largest(machine: lw.Machine) -> Forces:
        return lw.forces(machine, lw.steady_state(machine, accuracy=1e-13), contributions=False)

    # What is zero but for rounding is left out.
    responses = list(lw.gradient(machine, ["forces"], ["drive.gearbox.ratio"]).responses)

    def measure(machine: lw.Machine) -> list[float]:
        found = largest(machine)
        known = {"torque_drive_max": found.torque_drive_max, "shaking_force_max": found.shaking_force_max}
        known |= {f"reaction_max.{pair}": force for pair, force in found.reaction_max.items()}
        return [known[response.partition(".")[2]] for response in responses]

    return machine, responses, measure


def _jumping_drive(random: Generator) -> lw.Machine:
    """A drive whose load jumps at a speed that it passed without the jump."""
    drive = random_drive(random)
    state = lw.steady_state(lw.Machine.model_validate(drive))
    size = torque_size(state)
    return lw.Machine.model_validate(with_jump(random, drive, (state.speed_min, state.speed_max), size))


def _train(random: Generator) -> tuple[lw.Machine, list[str], Measure]:
    described = {"format": 1, "name": "train", "train": random_train(random)}
    machine = lw.Machine.model_validate(described)
    n = len(machine.train.discs) if machine.train else 0
    names = [f"free_vibration.natural_frequencies.{i}" for i in range(1, n)]
    return machine, names, lambda machine: lw.free_vibration(machine).natural_frequencies[1:].tolist()


def difference(machine: lw.Machine, address: str, measure: Measure, step: float) -> np.ndarray:
    """Central differences over h, 2h and 4h, extrapolated to sixth order, times the entry."""
    value = lw.get(machine, address)
    return sixth_order(
        lambda share: np.array(measure(exchanged(machine, {address: value * (1 + share)}))), step
    )


def check(
    machine: lw.Machine,
    names: list[str],
    measure: Measure,
    every: int,
    tolerance: float = _TOLERANCE,
    alike: float | None = None,
) -> tuple[int, list[str]]:
    """How many derivatives were compared, and which are wrong: by errors within a factor `alike`."""
    found = lw.gradient(machine, names)
    exact = found.derivatives * found.at
    # What is zero throughout, as the torque of a motor without load, has a difference of zero.
    scales = np.maximum(np.nanmax(np.abs(exact), axis=1), np.abs(found.values)) + 1e-300
    free = np.array([name not in found.ties for name in found.responses])
    compared, wrong = 0, []
    for at in np.flatnonzero(found.at)[::every]:
        rows = []
        try:
            for share in _SHORTER:
                rough = difference(machine, found.variables[at], measure, _STEP * share)
                rows.append(np.abs(exact[:, at] - rough) / scales)
                if (rows[-1] <= tolerance)[free].all():
                    break
        except LinkwrightError as error:
            _reason(error)
            continue
        errors = np.array(rows)
        # Where a step is too coarse, the finer one comes nearer by far more than a wrong one would.
        off = free & (errors.min(axis=0) > tolerance) & (errors[-1] > 1e-2 * errors[0])
        if alike is not None:
            off &= errors.max(axis=0) < alike * errors.min(axis=0)
        wrong += [
            f"{found.responses[k]} by {found.variables[at]}: {errors[:, k]}" for k in np.flatnonzero(off)
        ]
        compared += int(free.sum())
    return compared, wrong


@pytest.mark.parametrize(("kind", "few", "many"), [(_drive, 12, 1000), (_train, 12, 1000), (_forces, 4, 300)])
def test_derivatives_are_those_of_the_analysis(kind, few: int, many: int) -> None:
    compared, refused = 0, Counter[str]()
    for case, random in random_cases(3, few, many):
        try:
            machine, names, measure = kind(random)
            measure(machine)
            alike = _ALIKE if kind is _forces else None
            one, wrong = check(machine, names, measure, cases(5, 1), alike=alike)
        except LinkwrightError as error:
            refused[_reason(error)] += 1
            continue
        assert not wrong, (case, wrong)
        compared += one
    assert compared > 50
    # One in 25 of these drives has no load: of more, derivatives must not be refused.
    assert refused[_STANDS_ON_A_KINK] <= max(1, cases(few, many) // 10), refused


# What jumps leave of derivatives that are zero, or found by moving ends of steps in turn, which took turns.
_JUMPS = (1, 23, 164, 222, 349, *range(400, cases(413, 1500)))

# Below, rounding of slow drives makes thousands of steps.
_BESIDE_JUMPS = partial(_measures, accuracy=1e-12)


def test_derivatives_are_found_where_a_load_jumps_over_speed() -> None:
    compared, refused = 0, Counter[str]()
    for case, random in random_cases(11, 0, 0, also=_JUMPS):
        try:
            machine = _jumping_drive(random)
            _BESIDE_JUMPS(machine)
        except LinkwrightError as error:
            refused[_reason(error)] += 1
            continue
        names = [f"steady_state.{name}" for name in _NUMBERS]
        one, wrong = check(machine, names, _BESIDE_JUMPS, cases(12, 1), _BEHIND_JUMPS)
        assert not wrong, (case, wrong)
        compared += one
    assert compared > 50, refused
