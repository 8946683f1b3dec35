"""Derivatives of steady motion by entries of the machine: a `SteadyState` whose scalars are tangents.

The core gives the derivatives of the solution itself (its module `derivatives::gradient`): Newton's step in
dual numbers, once, at the solution. All that is worked out from those, δ, H, k_p, efficiencies, comes from
the formulas of `SteadyState` and `evenness`, which take tangents as they take numbers. The derivative of
an extreme is that of the curve where it is (envelope theorem); where two extremes tie there is one on either
side, and `ties` says so.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np

from linkwright.drive.batch import COLUMNS
from linkwright.drive.model.motor import ConstantSpeedMotor
from linkwright.drive.steady_state import SteadyState, solved_state, unknown_work
from linkwright.kernel.arrays import Bools, Floats
from linkwright.kernel.errors import InputError
from linkwright.kernel.numerics.extreme import (
    ALIKE_OF_SOLVED,
    READINGS,
    TIE_OF_SOLVED,
    Kinks,
    as_high,
    chosen,
    occurs_at,
    they_differ,
)
from linkwright.kernel.numerics.tangent import Tangent
from linkwright.kernel.quantities import Label, declared
from linkwright.linkages.closure import turn_angles
from linkwright.linkages.whole_cycle import over_whole_cycle
from linkwright.machine.address import exchanged
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine, compile_machine
from linkwright.machine.program.core import SteadyCurves, SteadyGradient, SteadySolution
from linkwright.machine.tangents import Derivatives, Directions, directions

# Angles at which rivals of an extreme are looked for. A peak between two of the even ones is missed by
# (2π/1440)² of the curve at most; where the motor is steep, the motion bends sharply beside a kink.
_LOOK = 1440

# Relative accuracy of the steady motion whose derivatives are taken: with formulas, which may bend at any
# angle, two digits more, as derivatives by the place of a bend, sharp or soft, change faster beside it than
# the motion does.
_ACCURACY, _ACCURACY_WITH_FORMULAS = 1e-11, 1e-13
_BESIDE = np.geomspace(1e-9, 3e-3, 14)

# Rounds in which a peak is closed in on.
_ROUNDS = 3

# Change of a gearbox's efficiency beside 1: of the order of the accuracy above.
_NEXT_TO_NOTHING = 1e-11

# Peaks nearer than this [rad] are one: the two sides of a corner.
_APART = 1e-3

# How far the angles of rivals are known at most [rad], by the last of these rounds.
_OFF = 2 * (2 * np.pi / _LOOK) / (READINGS - 1) * (2 / (READINGS - 1)) ** (_ROUNDS - 1)

# Share of a speed to both sides at which the motor's torque is read for its slope.
_ASIDE = 1e-6

# Share of the torque by which a motor would change for a speed doubled, of a speed or of a disturbance, that
# is rounding.
_ROUNDING = 1e-14

# A disturbance of which no more than this is left after a revolution has died out: what is left is known as
# the motion is, by its share of 1.
_DIED_OUT = 1e-9

# A torque that is this near to the one at an extreme speed is the torque there.
_SAME = 1e-9


@dataclass(frozen=True)
class SteadyTangents:
    """Steady motion with derivatives.

    `state` has tangents for scalars; `ties` has what has only one-sided derivatives, with its reason;
    `lost` has entries by which the move of a kink was not found, each with the crank angle of the kink [rad];
    `rounding` is what may be left of scalars that are zero.
    """

    state: SteadyState
    ties: dict[str, str]
    lost: dict[str, float]
    rounding: dict[str, float]


def steady_tangents(machine: Machine, along: Directions) -> SteadyTangents:
    """Steady motion along directions of the program's numbers.

    Raises what `steady_state` raises, and InputError where the motor keeps its speed.
    """
    state, solution, _ = solved_along(machine, along)
    compiled, values = over_whole_cycle(compile_machine(machine)), along.values
    gradient = gradient_along(machine, solution, along)
    curves = gradient.curves(np.array([state.speed_min_angle, state.speed_max_angle]))
    # The core's works are those of a cycle.
    times = {name: state.turns if name.startswith("energy") else 1 for name in COLUMNS}
    tangents: dict[str, Any] = {
        name: Tangent(getattr(state, name), getattr(gradient, name) / turns) for name, turns in times.items()
    }
    ratio = Tangent(compiled.gear_factors[0], values[compiled.gear_slots[0]])
    tangents |= _of_motor(compiled, state, tangents, curves, ratio)
    ties = {
        name: tie.words(compiled, gradient, along) for name, tie in _ties(compiled, state, solution).items()
    }
    ties["acceleration_peak"] = _equal_peaks(state, gradient, along)
    ties = {name: words for name, words in ties.items() if words}
    lost, rounding = along.lost(gradient.lost), _rounding(compiled, state)
    return SteadyTangents(replace(state, **tangents), ties, lost, rounding)


def steady_derivatives(machine: Machine, variables: Sequence[str]) -> Derivatives:
    """Scalars of steady motion by some entries. Raises what `steady_tangents` raises."""
    return derivatives_along(machine, directions(machine, variables))


def derivatives_along(machine: Machine, program: Directions) -> Derivatives:
    """Scalars of steady motion along directions of the program's numbers."""
    steady = steady_tangents(machine, program)
    listed = [name for name, (_, mark) in declared(SteadyState).items() if isinstance(mark, Label)]
    values = {name: getattr(steady.state, name) for name in listed}
    tangents = {name: value for name, value in values.items() if isinstance(value, Tangent)}
    nothing = _nothing(tangents, steady.rounding)
    missing = dict.fromkeys(sorted(nothing), "it is zero within rounding error")
    missing |= {name: _BETWEEN for name in _OF_MOTOR if name not in tangents}
    tangents = {name: value for name, value in tangents.items() if name not in nothing}
    ties = {name: reason for name in tangents if (reason := _tie(name, steady.ties))}
    return Derivatives(program.variables, tangents, ties, missing, program.refused, steady.lost)


# Extremes of the motor, and why one has no derivative.
_OF_MOTOR = ("torque_motor_min", "torque_motor_max", "power_motor_max")
_BETWEEN = "the extreme occurs at a speed between minimum and maximum, such as the breakdown speed"

# Ratio → what it is a ratio of.
_RATIOS = {
    "cyclic_load_factor": ("torque_motor_rms", "torque_motor_mean"),
    "efficiency": ("energy_load", "energy_motor"),
}


def _nothing(tangents: Mapping[str, Tangent], rounding: Mapping[str, float]) -> set[str]:
    """Scalars that are zero but for rounding, and ratios of them; one that nothing moves stays zero."""
    nothing = {
        name
        for name, least in rounding.items()
        if name in tangents and abs(tangents[name].value) <= least and tangents[name].d.any()
    }
    return nothing | {ratio for ratio, of in _RATIOS.items() if nothing & {*of} and ratio in tangents}


# Extremes → what is made of them.
_MADE_OF = {
    "speed": (
        *("speed_mean_extremes", "unevenness", "unevenness_time", "motion_coefficient"),
        *("motion_coefficient_time", "dynamism", "torque_motor_min", "torque_motor_max", "power_motor_max"),
    ),
    "acceleration": ("dynamism", "dynamism_time", "motion_coefficient", "motion_coefficient_time"),
}


def _tie(name: str, ties: Mapping[str, str]) -> str:
    """Why a scalar of the motion has only one-sided derivatives; empty if it has one."""
    for extreme, reason in ties.items():
        if name == extreme or name in _MADE_OF[extreme.partition("_")[0]]:
            return f"{extreme.replace('_', ' ')}: {reason}"
    return ""


def solved_along(machine: Machine, along: Directions) -> tuple[SteadyState, SteadySolution, Machine]:
    """Steady motion, a solution whose derivatives by all directions are sound, and the machine that it is of.

    Raises what `steady_state` raises, and InputError where the motor keeps its speed.
    """
    if machine.drive is not None and isinstance(machine.drive.motor, ConstantSpeedMotor):
        raise InputError("a constant-speed motor keeps its speed regardless of the machine")
    state, solution = _solved(machine)
    compiled = over_whole_cycle(compile_machine(machine))
    moving = _telling_directions(machine, compiled, state, along.values)
    if moving is not None:
        solution = _solved(moving)[1]
    return state, solution, moving or machine


def gradient_along(machine: Machine, solution: SteadySolution, along: Directions) -> SteadyGradient:
    """Derivatives of a solution of the machine, once for all analyses that ask for the same directions."""
    kept = compile_machine(machine).kept
    known: tuple[SteadySolution, Directions, SteadyGradient] | None = kept.get("steady gradient")
    if known is not None and known[0] is solution and known[1].has_those_of(along):
        return known[2]
    gradient = solution.gradient(along.values, along.sizes)
    kept["steady gradient"] = solution, along, gradient
    return gradient


def _solved(machine: Machine) -> tuple[SteadyState, SteadySolution]:
    """Steady motion and its solution, once for all analyses of a machine."""
    kept = compile_machine(machine).kept
    if "fine steady motion" not in kept:
        has_formulas = any(load.kind == "formula" for load in machine.all_loads.values())
        accuracy = _ACCURACY_WITH_FORMULAS if has_formulas else _ACCURACY
        kept["fine steady motion"] = solved_state(machine, accuracy, _LOOK)
    known: tuple[SteadyState, SteadySolution] = kept["fine steady motion"]
    return known


def _telling_directions(
    machine: Machine, compiled: CompiledMachine, state: SteadyState, values: Floats
) -> Machine | None:
    """The machine with a gearbox that tells the directions of power apart by next to nothing."""
    # A gearbox that does not has no kink where the motor's torque changes sign, but derivatives by its
    # factors leap there: the solution needs ends of steps at it. None where there is no such place, or no
    # direction of `values` moves the factors apart.
    _, forward, reverse = compiled.gear_factors
    _, *slots = compiled.gear_slots
    if (
        forward != reverse
        or np.array_equal(*values[slots])
        or not state.torque_motor_min < 0.0 < state.torque_motor_max
    ):
        return None
    return exchanged(machine, {"drive.gearbox.efficiency": forward * (1.0 - _NEXT_TO_NOTHING)})


def _of_motor(
    compiled: CompiledMachine,
    state: SteadyState,
    known: dict[str, Tangent],
    curves: SteadyCurves,
    ratio: Tangent,
) -> dict[str, Tangent]:
    """Extremes of the motor's torque and power, as far as they lie at an extreme speed."""
    # `curves`: derivatives at both, (2, directions), at angles that are off the peaks by so little that the
    # torque there differs by its slope alone. One that lies between, at the breakdown or pull-up speed, is
    # left out.
    speeds = np.array([state.speed_min, state.speed_max])
    torques, slopes = compiled.motor_torques(speeds).motor, _slopes(compiled, speeds)
    tangents: dict[str, Tangent] = {}
    for at in range(2):
        speed = known[("speed_min", "speed_max")[at]]
        off = speed.d - curves.speed[at]
        torque = Tangent(torques[at], curves.torque_motor[at] + slopes[at] * off)
        power = torque * speed * ratio
        for name, value in (
            ("torque_motor_min", torque),
            ("torque_motor_max", torque),
            ("power_motor_max", power),
        ):
            extreme = getattr(state, name)
            if abs(value.value - extreme) <= _SAME * max(abs(extreme), float(np.ptp(state.torque_motor))):
                tangents[name] = value
    return tangents


def _slopes(compiled: CompiledMachine, speeds: Floats) -> Floats:
    """Derivatives of the motor's torque by the crank speed at crank speeds [N m s/rad]."""
    below, above = (compiled.motor_torques(speeds * by).motor for by in (1 - _ASIDE, 1 + _ASIDE))
    slopes: Floats = (above - below) / (2 * _ASIDE * speeds)
    return slopes


def _rounding(compiled: CompiledMachine, state: SteadyState) -> dict[str, float]:
    """Scalar → what rounding of the speed may leave of it where it is zero, as without load."""
    ratio, speeds = compiled.gear_factors[0], np.array([state.speed_min, state.speed_max])
    change = float(np.abs(_slopes(compiled, speeds) * speeds).max())
    torque = _ROUNDING * max(change, state.torque_motor_rms)
    acceleration = torque * ratio / float(state.inertia_reduced.mean())
    dynamism = acceleration / state.speed_mean_time**2
    work = max(torque * ratio * 2 * np.pi, unknown_work(state))
    return {
        **dict.fromkeys((f"torque_motor_{of}" for of in ("mean", "rms", "min", "max")), torque),
        "power_motor_mean": work * state.turns / state.period,
        "power_motor_max": torque * ratio * state.speed_max,
        **dict.fromkeys(("energy_motor", "energy_drive", "energy_load"), work),
        "multiplier": _DIED_OUT,
        **dict.fromkeys(("acceleration_min", "acceleration_max"), acceleration),
        **dict.fromkeys(("dynamism", "dynamism_time"), dynamism),
        **dict.fromkeys(("motion_coefficient", "motion_coefficient_time"), dynamism),
        **dict.fromkeys(("unevenness", "unevenness_time"), _ROUNDING),
    }


@dataclass(frozen=True)
class _Tie:
    """An extreme of a quantity that the motion has at several angles."""

    quantity: str
    value: float
    angles: list[float]

    def words(self, compiled: CompiledMachine, gradient: SteadyGradient, along: Directions) -> str:
        """Where, and by which entries there are only one-sided derivatives; empty if by none."""
        differs = self._differs(compiled, gradient, along.sizes)
        # A rival on a kink that an entry moves moves with it.
        kinks = Kinks.of(compiled, along)
        for angle in self.angles:
            differs = differs | kinks.moved_at(angle, 2 * _OFF)
        by = chosen(along.variables, differs)
        return occurs_at(self.angles, by) if by else ""

    def _differs(self, compiled: CompiledMachine, gradient: SteadyGradient, sizes: Floats) -> Bools:
        """Whether derivatives of rivals differ in each direction, or bend there, (directions,)."""
        near = (np.array(self.angles)[:, None] + np.array([-_OFF, 0.0, _OFF])) % compiled.cycle
        order, back = np.unique(near, return_inverse=True)
        slopes = getattr(gradient.curves(order), self.quantity)[back.reshape(near.shape)]
        rounding = np.maximum(
            ALIKE_OF_SOLVED * np.abs(slopes).max(axis=(0, 1)), _ROUNDING * abs(self.value) / sizes
        )
        low, high = slopes.min(axis=1), slopes.max(axis=1)
        is_one = low.max(axis=0) - high.min(axis=0) <= rounding
        bend = np.abs(slopes[:, 1] - 0.5 * (slopes[:, 0] + slopes[:, 2]))
        # One that was lost at a kink is named for that.
        is_known = np.isfinite(slopes).all(axis=(0, 1))
        differs: Bools = is_known & ~(is_one & (bend <= 0.25 * (high - low) + rounding).all(axis=0))
        return differs


def _ties(compiled: CompiledMachine, state: SteadyState, solution: SteadySolution) -> dict[str, _Tie]:
    """Extremes that the motion has twice, by its peaks on the solution itself."""
    cycle, beside = compiled.cycle, np.concatenate([-_BESIDE, _BESIDE])
    near_kinks = (compiled.kinks()[:, None] + beside).ravel()
    angles = np.unique(np.concatenate([turn_angles(_LOOK, compiled.turns)[:-1], near_kinks]) % cycle)
    curves, ties = solution.curves(angles), dict[str, _Tie]()
    for quantity, (end, sign) in product(("speed", "acceleration"), (("min", -1.0), ("max", 1.0))):

        def read(at: Floats, quantity: str = quantity, sign: float = sign) -> Floats:
            order, back = np.unique(at % cycle, return_inverse=True)
            values: Floats = sign * getattr(solution.curves(order), quantity)
            return values[back.reshape(at.shape)]

        name = f"{quantity}_{end}"
        looked = angles, sign * getattr(curves, quantity)
        extreme = (getattr(state, f"{name}_angle"), sign * getattr(state, name))
        rivals = as_high(read, looked, extreme, cycle, near=_APART, rounds=_ROUNDS)
        if len(rivals) > 1:
            ties[name] = _Tie(quantity, getattr(state, name), rivals)
    return ties


def _equal_peaks(state: SteadyState, gradient: SteadyGradient, along: Directions) -> str:
    """By which entries the larger peak of the acceleration changes its sign; empty if it does by none."""
    low, high = state.acceleration_min, state.acceleration_max
    if abs(low + high) > TIE_OF_SOLVED * (high - low):
        return ""
    change = np.abs(gradient.acceleration_min + gradient.acceleration_max)
    # One that was lost at a kink is named for that.
    differs = np.isfinite(change) & (change > ALIKE_OF_SOLVED * np.abs(gradient.acceleration_max))
    by = chosen(along.variables, differs)
    return f"its positive and negative peaks are equal; {they_differ(by)}" if by else ""
