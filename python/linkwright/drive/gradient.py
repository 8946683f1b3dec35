"""Derivatives of steady motion by entries of the machine: a `SteadyState` whose scalars are tangents.

The core gives the derivatives of the solution itself (`linkwright-core`, module `drive::gradient`): Newton's
step in dual numbers, once, at the solution. All that is worked out from those, δ, H, k_p, efficiencies, comes
from the formulas of `SteadyState` and `evenness`, which take tangents as they take numbers. The derivative of
an extreme is that of the curve where it is (envelope theorem); where two extremes tie there is one on either
side, and `ties` says so.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.drive.batch import COLUMNS
from linkwright.drive.model.motor import ConstantSpeedMotor
from linkwright.drive.steady_state import SteadyState, solved_state, unknown_work
from linkwright.kernel.errors import InputError
from linkwright.kernel.numerics.tangent import Tangent
from linkwright.linkages.closure import over_whole_cycle, turn_angles
from linkwright.machine.address import exchanged
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine, compile_machine
from linkwright.machine.program.core import SteadyCurves, SteadyGradient, SteadySolution
from linkwright.machine.tangents import Directions

Floats = NDArray[np.float64]

# Angles at which rivals of an extreme are looked for. A peak between two of the even ones is missed by
# (2π/1440)² of the curve at most; where the motor is steep, the motion bends sharply beside a kink.
_LOOK = 1440

# Relative accuracy of the steady motion whose derivatives are taken.
_ACCURACY = 1e-11
_BESIDE = np.geomspace(1e-9, 3e-3, 14)

# How far a rival may seem to stay below the extreme before it is read more closely, as a share of the range:
# far more than the angles above leave.
_DOUBT = 1e-2

# Rounds in which a peak is closed in on, and readings of each: an eighth of the interval, and a 64th of what
# the height lacks, from round to round.
_ROUNDS, _READINGS = 3, 17

# Change of a gearbox's efficiency beside 1: of the order of the accuracy above.
_NEXT_TO_NOTHING = 1e-11

# Angles of a tie that a message lists.
_TOLD = 4

# Peaks nearer than this [rad] are one: the two sides of a corner.
_APART = 1e-3

# Extremes that are this near, as a share of the curve's range, tie: their heights are not known better.
_TIE = 1e-7

# Share of a speed to both sides at which the motor's torque is read for its slope.
_ASIDE = 1e-6

# Share of the torque by which a motor would change for a speed doubled, of a speed or of a disturbance, that
# is rounding.
_ROUNDING = 1e-14

# A torque that is this near to the one at an extreme speed is the torque there.
_SAME = 1e-9


@dataclass(frozen=True)
class SteadyTangents:
    """Steady motion with derivatives.

    `state` has tangents for scalars; `ties` has what has a derivative on either side only, with its reason;
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
    ties = _ties(compiled, state, solution)
    lost, rounding = along.lost(gradient.lost), _rounding(compiled, state)
    return SteadyTangents(replace(state, **tangents), ties, lost, rounding)


def solved_along(machine: Machine, along: Directions) -> tuple[SteadyState, SteadySolution, Machine]:
    """Steady motion, a solution whose derivatives by all directions are sound, and the machine that it is of.

    Raises what `steady_state` raises, and InputError where the motor keeps its speed.
    """
    if machine.drive is not None and isinstance(machine.drive.motor, ConstantSpeedMotor):
        raise InputError("a motor of constant speed has the same speed whatever the machine is")
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
        kept["fine steady motion"] = solved_state(machine, _ACCURACY, _LOOK)
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
        "multiplier": _ROUNDING,
        **dict.fromkeys(("acceleration_min", "acceleration_max"), acceleration),
        **dict.fromkeys(("dynamism", "dynamism_time"), dynamism),
        **dict.fromkeys(("motion_coefficient", "motion_coefficient_time"), dynamism),
        **dict.fromkeys(("unevenness", "unevenness_time"), _ROUNDING),
    }


def _ties(compiled: CompiledMachine, state: SteadyState, solution: SteadySolution) -> dict[str, str]:
    """Extremes that the motion has twice."""
    ties: dict[str, str] = {}
    peaks = _Peaks(compiled, solution)
    for quantity in ("speed", "acceleration"):
        for end, sign in (("min", -1.0), ("max", 1.0)):
            name = f"{quantity}_{end}"
            extreme = (getattr(state, f"{name}_angle"), sign * getattr(state, name))
            angles = peaks.as_high_as(extreme, quantity, sign)
            if len(angles) > 1:
                places = [f"{np.degrees(angle):.4g}°" for angle in angles[:_TOLD]]
                places += [f"{len(angles) - _TOLD} angles more"] if len(angles) > _TOLD else []
                ties[name] = f"it is reached at {' and '.join(places)}"
    low, high = state.acceleration_min, state.acceleration_max
    if abs(low + high) <= _TIE * (high - low):
        ties["acceleration_peak"] = "its positive and negative peaks are equal"
    return ties


class _Peaks:
    """Peaks of speed and acceleration over a revolution, on the solution itself."""

    def __init__(self, compiled: CompiledMachine, solution: SteadySolution) -> None:
        self.solution, self.cycle = solution, compiled.cycle
        even = turn_angles(_LOOK, compiled.turns)[:-1]
        beside = np.concatenate([-_BESIDE, _BESIDE])
        angles = np.concatenate([even, (compiled.kinks()[:, None] + beside).ravel()])
        self.angles = np.unique(angles % self.cycle)
        self.curves = self._read(self.angles)

    def _read(self, angles: Floats) -> dict[str, Floats]:
        """Speed and acceleration at crank angles of any shape."""
        order, back = np.unique(angles % self.cycle, return_inverse=True)
        read = self.solution.curves(order)
        back = back.reshape(angles.shape)
        return {name: getattr(read, name)[back] for name in ("speed", "acceleration")}

    def as_high_as(self, extreme: tuple[float, float], quantity: str, sign: float) -> list[float]:
        """Angles [rad] of the highest peak and of all that are as high, of a curve with a sign."""
        at, top = extreme
        curve = sign * self.curves[quantity]
        span = float(np.ptp(curve))
        near = np.flatnonzero(curve >= top - _DOUBT * span)
        before, behind = near - 1, (near + 1) % len(curve)
        is_peak = (curve[near] >= curve[before]) & (curve[near] > curve[behind])
        is_peak &= self._apart(self.angles[near], at) > _APART
        if not is_peak.any():
            return [at]
        peaks = near[is_peak]
        low = self.angles[before[is_peak]] - self.cycle * (peaks == 0)
        high = self.angles[behind[is_peak]] + self.cycle * (peaks == len(curve) - 1)
        places, heights = self._refined(low, high, quantity, sign)
        angles = [at]
        for angle in places[heights >= top - _TIE * span] % self.cycle:
            if self._apart(np.array(angles), angle).min() > _APART:
                angles.append(float(angle))
        return sorted(angles)

    def _refined(self, low: Floats, high: Floats, quantity: str, sign: float) -> tuple[Floats, Floats]:
        """Angles [rad] and heights of the peaks between angles, closed in on from reading to reading."""
        rows = np.arange(len(low))
        for _ in range(_ROUNDS):
            angles = np.linspace(low, high, _READINGS, axis=-1)
            values = sign * self._read(angles)[quantity]
            best = values.argmax(axis=-1)
            low, high = (angles[rows, np.clip(best + way, 0, _READINGS - 1)] for way in (-1, 1))
        return angles[rows, best], values[rows, best]

    def _apart(self, angles: Floats, angle: float) -> Floats:
        """How far angles are from another one round the cycle [rad]."""
        half = 0.5 * self.cycle
        return np.abs((angles - angle + half) % self.cycle - half)
