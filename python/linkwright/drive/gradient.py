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

from linkwright.drive.model.motor import ConstantSpeedMotor
from linkwright.drive.steady_state import SteadyState, steady_state
from linkwright.kernel.errors import InputError
from linkwright.kernel.numerics.tangent import Tangent
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import Compiled, compile_machine

Floats = NDArray[np.float64]

# Curves of the core's derivatives, in their order.
_CURVES = ("time", "speed", "acceleration", "torque_motor", "torque_drive", "torque_load", "inertia_reduced")

# Numbers of which the core gives the derivative.
_NUMBERS = (
    "speed_min",
    "speed_max",
    "acceleration_min",
    "acceleration_max",
    "period",
    "multiplier",
    "energy_motor",
    "energy_drive",
    "energy_load",
    "torque_motor_mean",
    "torque_motor_rms",
)

# Intervals of a revolution in which rivals of an extreme are looked for: a peak between two of them is missed
# by (2π/1440)² of the curve at most, and a parabola through three makes that 1e-10.
_LOOK = 1440

# Extremes that are this near, as a share of the curve's range, tie: their heights are not known better.
_TIE = 1e-7

# A torque that is this near to the one at an extreme speed is the torque there.
_SAME = 1e-9


@dataclass(frozen=True)
class SteadyTangents:
    """Steady motion with derivatives.

    `state` has tangents for scalars; `ties` has what has a derivative on either side only, with its reason.
    """

    state: SteadyState
    ties: dict[str, str]


def steady_tangents(machine: Machine, values: Floats, accuracy: float = 1e-11) -> SteadyTangents:
    """Steady motion along directions of the program's numbers, `values` (parameters, directions).

    Raises what `steady_state` raises, and InputError where the motor keeps its speed.
    """
    if machine.drive is not None and isinstance(machine.drive.motor, ConstantSpeedMotor):
        raise InputError("a motor of constant speed has the same speed whatever the machine is")
    state = steady_state(machine, accuracy=accuracy, n=_LOOK)
    compiled = compile_machine(machine)
    angles = np.array([state.speed_min_angle, state.speed_max_angle])
    found = compiled.steady_gradient(accuracy, values, angles)
    tangents: dict[str, Any] = {
        name: Tangent(getattr(state, name), getattr(found, name)) for name in _NUMBERS
    }
    ratio = Tangent(compiled.gear_factors[0], values[compiled.ratio_slot])
    tangents |= _of_motor(compiled, state, found.curves, ratio)
    return SteadyTangents(replace(state, **tangents), _ties(state))


def _of_motor(compiled: Compiled, state: SteadyState, curves: Floats, ratio: Tangent) -> dict[str, Tangent]:
    """Extremes of the motor's torque and power, as far as they lie at an extreme speed.

    `curves`: derivatives at both, as the core gives them.

    One that lies between, at the breakdown or pull-up speed, is left out.
    """
    place = {name: at for at, name in enumerate(_CURVES)}
    speeds = np.array([state.speed_min, state.speed_max])
    torques = compiled.motor_torques(speeds)[0]
    found: dict[str, Tangent] = {}
    for at in range(2):
        torque = Tangent(torques[at], curves[place["torque_motor"], at])
        power = torque * Tangent(speeds[at], curves[place["speed"], at]) * ratio
        for name, value in (
            ("torque_motor_min", torque),
            ("torque_motor_max", torque),
            ("power_motor_max", power),
        ):
            extreme = getattr(state, name)
            if abs(value.value - extreme) <= _SAME * max(abs(extreme), float(np.ptp(state.torque_motor))):
                found[name] = value
    return found


def _ties(state: SteadyState) -> dict[str, str]:
    """Extremes that the motion has twice."""
    found: dict[str, str] = {}
    for quantity, curve in (("speed", state.speed), ("acceleration", state.acceleration)):
        for end, sign in (("min", -1.0), ("max", 1.0)):
            angles = _equal_peaks(sign * curve)
            if len(angles) > 1:
                places = " and ".join(f"{np.degrees(angle):.4g}°" for angle in angles[:4])
                found[f"{quantity}_{end}"] = f"it is reached at {places}"
    low, high = state.acceleration_min, state.acceleration_max
    if abs(low + high) <= _TIE * (high - low):
        found["acceleration_peak"] = "the acceleration is as large forwards as backwards"
    return found


def _equal_peaks(curve: Floats) -> list[float]:
    """Angles [rad] of the peaks as high as the highest, of a curve over a revolution with both ends."""
    y = curve[:-1]
    left, right = np.roll(y, 1), np.roll(y, -1)
    peaks = np.flatnonzero((y >= left) & (y > right))
    bend = left[peaks] - 2 * y[peaks] + right[peaks]
    slope = 0.5 * (right[peaks] - left[peaks])
    with np.errstate(divide="ignore", invalid="ignore"):
        tops = np.where(bend < 0, y[peaks] - 0.5 * slope**2 / bend, y[peaks])
    near = tops >= tops.max() - _TIE * np.ptp(y)
    return [float(2 * np.pi * peak / len(y)) for peak in peaks[near]]
