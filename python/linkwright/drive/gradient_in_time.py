"""Derivatives of run-up and run-down by entries of the machine.

The core follows the variational equation along the motion (its module
`derivatives::variation`). What ends a motion at g(t, φ, ω, p) = 0 comes later by δt = −δg/ġ, the change
at the time held over the rate. A run-up ends where the speed enters the band about that of steady motion at
the same angle, ω − ω_s(φ) = ±s ω_m, of which the derivatives are those of `linkwright.drive.gradient`; a
run-down where ω = 0.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from linkwright.drive.gradient import gradient_along, solved_along
from linkwright.drive.run_up import RunUp, accurate_run_down, accurate_run_up, peak_until, start_of
from linkwright.drive.steady_state import SteadyState
from linkwright.drive.transient import Transient
from linkwright.kernel.arrays import Floats
from linkwright.kernel.numerics.tangent import Tangent
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine, compile_machine
from linkwright.machine.program.core import SteadyGradient, SteadySolution
from linkwright.machine.tangents import Derivatives, Directions, directions

# Relative accuracy of the motions whose derivatives are taken: where a run-down ends softly, its time errs
# some ten thousand times as much.
_ACCURACY = 1e-12

# An acceleration below this share of the mean one is zero: the peak of the speed is smooth there.
_LEVEL = 1e-5

# Share of a step by which a peak of the speed is looked at from both sides: what is a little off is carried
# to it by slopes.
_ASIDE = 1e-3


class _MotionDerivatives(NamedTuple):
    """Derivatives of angle and speed at instants that are held, (instants, entries), and the accelerations
    there, (instants,); at a kink or jump those before it.
    """

    angle: Floats
    speed: Floats
    acceleration: Floats


_CORNER = "its peak coincides with a jump of the acceleration"


def run_up_tangents(machine: Machine, variables: Sequence[str]) -> Derivatives:
    """Scalars of `run_up` with their derivatives by some entries.

    Raises what `run_up` raises.
    """
    start_of(machine)
    along = directions(machine, variables)
    state, solution, telling = solved_along(machine, along)
    up = accurate_run_up(telling, state, _ACCURACY)
    start = np.stack([_unit(along, f"run_up.{entry}_start") for entry in ("angle", "speed")])
    lost: dict[str, float] = {}
    later, turned, peak = np.zeros_like(start[0]), np.zeros_like(start[0]), start[1]
    missing = {}
    if up.time > 0:
        at = _beside_peak(up)
        moved = _moved(compile_machine(telling), along, start, up.motion, [*at, up.time])
        gradient = gradient_along(machine, solution, along)
        later, lost = _entry(up, state, (solution, gradient), along, moved)
        speed = float(up.motion.at([up.time])[1][0])
        turned = (moved.angle[-1] + speed * later - start[0]) / (2 * np.pi)
        if at[1] == up.time:
            peak = moved.speed[-1] + up.motion.slope(up.time) * later
        elif at[1] == 0.0:
            peak = moved.speed[1]
        elif abs(moved.acceleration[1]) > _LEVEL * up.speed_peak / up.time:
            missing = {"speed_peak": _CORNER}
        else:
            peak = _at_peak(moved)
    tangents = {
        "turns": Tangent(up.turns, turned),
        "time": Tangent(up.time, later),
        "speed_peak": Tangent(up.speed_peak, peak),
    }
    kept = {name: tangent for name, tangent in tangents.items() if name not in missing}
    return Derivatives(along.variables, kept, {}, missing, along.refused, lost)


# Where the speed at the start of a run-down is read [rad]: at the angle itself its derivative is that along a
# kink that may lie there and moves, while the run-down starts where it did.
_START = 1e-9


def run_down_tangents(machine: Machine, variables: Sequence[str]) -> Derivatives:
    """Scalars of `run_down` with their derivatives by some entries.

    Raises what `run_down` raises.
    """
    running = directions(machine, variables)
    coasting = directions(machine, running.variables, motor=False, brake=True)
    running = running.only(coasting.variables)
    state, solution, _ = solved_along(machine, running)
    down = accurate_run_down(machine, float(state.speed[0]), _ACCURACY)
    gradient = gradient_along(machine, solution, running)
    start = np.stack([np.zeros(len(running.variables)), gradient.curves(np.array([_START])).speed[0]])
    compiled = compile_machine(machine, motor=False, brake=True)
    moved = _moved(compiled, coasting, start, down.motion, [down.time])
    later = -moved.speed[0] / moved.acceleration[0]
    # At rest no angle is covered in the time by which it comes later.
    turned = moved.angle[0]
    tangents = {
        "turns": Tangent(down.turns, turned / (2 * np.pi)),
        "time": Tangent(down.time, later),
        "angle_end": Tangent(down.angle_end, turned),
    }
    refused = {**running.refused, **coasting.refused}
    return Derivatives(running.variables, tangents, {}, {}, refused, running.lost(gradient.lost))


def _beside_peak(up: RunUp) -> list[float]:
    """Time of the maximum speed, and times a little before and after it [s]."""
    peak, times = peak_until(up.motion, up.time)[1], up.motion.time
    step = times[1:-1].searchsorted(peak)
    aside = _ASIDE * (times[step + 1] - times[step])
    return [max(peak - aside, 0.0), peak, min(peak + aside, up.time)]


def _at_peak(moved: _MotionDerivatives) -> Floats:
    """Derivatives of the maximum speed, from three instants beside it."""
    # The equation of motion tells the place, where ε = 0, better than speeds do, and derivatives change fast
    # there under a steep motor.
    before, at, after = moved.acceleration[:3]
    peak: Floats = moved.speed[1] + (moved.speed[2] - moved.speed[0]) * (at / (before - after))
    return peak


def _unit(along: Directions, entry: str) -> Floats:
    """The derivatives of an entry that is no number of the program."""
    return np.array([float(name == entry) for name in along.variables])


def _moved(
    compiled: CompiledMachine, along: Directions, start: Floats, motion: Transient, at: list[float]
) -> _MotionDerivatives:
    """What the core says of a motion at instants [s]."""
    states = np.stack([motion.crank_angle, motion.speed])
    steps = (motion.time, states, motion.between.factors)
    moved = compiled.transient_along(along.values, start, steps, at)
    return _MotionDerivatives(moved.crank_angle, moved.speed, moved.acceleration)


def _entry(
    up: RunUp,
    state: SteadyState,
    steady: tuple[SteadySolution, SteadyGradient],
    along: Directions,
    moved: _MotionDerivatives,
) -> tuple[Floats, dict[str, float]]:
    """By how much the speed enters the band later [s], and entries by which this was not found."""
    angle, speed = (part[0] for part in up.motion.at([up.time]))
    at = np.array([angle % (2 * np.pi * state.turns)])
    solution, gradient = steady
    there, by_entry = solution.curves(at), gradient.curves(at)
    rise = there.acceleration[0] / there.speed[0]
    mean = state.speed_mean_time
    side = np.copysign(1.0, speed - there.speed[0])
    width = mean * (_unit(along, "run_up.settled") - up.settled * gradient.period / state.period)
    off = moved.speed[-1] - rise * moved.angle[-1] - by_entry.speed[0] - side * width
    return -off / (up.motion.slope(up.time) - rise * speed), along.lost(gradient.lost)
