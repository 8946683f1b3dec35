"""The motion at which forces are asked for."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from numpy.typing import ArrayLike

from linkwright.drive.steady_state import SteadyState, steady_state
from linkwright.drive.transient import Transient
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import AssemblyError, InputError, ShapeError
from linkwright.kernel.public import public
from linkwright.kernel.public.arguments import array
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import Label
from linkwright.kernel.result import Record
from linkwright.kernel.units.kinds import ANGULAR_ACCELERATION, SPEED
from linkwright.kernel.units.marks import Quantity
from linkwright.linkages.closure import closure, closure_error, turn_angles
from linkwright.linkages.kinematics import crank_angles
from linkwright.linkages.law_jumps import require_finite_accelerations
from linkwright.linkages.whole_cycle import force_turns
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine


@dataclass(frozen=True)
class Motion(Record):
    """Crank angle with speed and acceleration; arrays (n,)."""

    crank_angle: Annotated[Floats, Label("crank angle", "φ", "rad")]
    speed: Annotated[Floats, Label("speed of the crank", "ω", "rad/s")]
    acceleration: Annotated[Floats, Label("angular acceleration of the crank", "ε", "rad/s²")]
    time: Annotated[
        Floats, Label("time", "t", "s", "The crank angle itself where the machine stands at every angle.")
    ]

    @public
    def mean(self, values: ArrayLike) -> float:
        """Mean of values (n,) over the time, or the angle of a machine at rest; without NaN.

        Where the crank turns one way, dt = dφ/ω: even angles then integrate a smooth revolution to rounding,
        which uneven times do not.
        """
        values = np.asarray(values)
        if values.shape != self.time.shape:
            raise ShapeError(f"values: found an array of shape {values.shape}, expected {self.time.shape}")
        known = np.isfinite(values)
        if known.sum() < 2 or self.time[known][-1] == self.time[known][0]:
            return float(np.mean(values[known])) if known.any() else float("nan")
        omega, phi = self.speed[known], self.crank_angle[known]
        if (omega > 0).all() or (omega < 0).all():
            # Over the slowest speed, so that a motion however slow has a mean.
            weight = np.abs(omega).min() / omega
            return float(np.trapezoid(values[known] * weight, phi) / np.trapezoid(weight, phi))
        t = self.time[known]
        return float(np.trapezoid(values[known], t) / (t[-1] - t[0]))


def motion_at(
    machine: Machine,
    motion: SteadyState | Transient | Motion | None,
    *,
    speed: float | None = None,
    acceleration: float = 0.0,
    angles: ArrayLike | None = None,
    n: int = 360,
) -> Motion:
    """The motion that is meant: a computed one, or one at a speed.

    `motion`: a computed motion, with its own angles. Without it and without a speed: the steady motion of the
    motor, or the design speed of the drive; `speed`, `acceleration`: of the crank at every angle [rad/s,
    rad/s²]; `angles` (n,): crank angles for a speed [rad]; without them a cycle. Raises InputError:
    motion and speed are both given, or there is neither of them, nor a motor, nor a design speed.
    """
    if motion is not None and speed is not None:
        raise InputError("forces at a motion or at a speed: found both, expected one of them")
    if isinstance(motion, Motion):
        return motion
    if isinstance(motion, SteadyState | Transient):
        return Motion(motion.crank_angle, motion.speed, motion.acceleration, motion.time)
    if angles is None:
        _require_full_turn(machine)
    require_finite_accelerations(machine)
    if speed is None:
        drive = machine.drive
        if drive is not None and drive.motor is not None and angles is None:
            return over_turns(steady_state(machine, n=n), force_turns(compile_machine(machine)))
        speed = design_speed(machine)
    if speed is None:
        raise InputError(
            "speed: found none, expected that of the crank, as there is neither a motor nor drive.speed; "
            'give one, such as --speed "10 rad/s"'
        )
    in_range(speed=(speed, Quantity(SPEED)), acceleration=(acceleration, Quantity(ANGULAR_ACCELERATION)))
    if angles is None:
        angles = turn_angles(n, force_turns(compile_machine(machine)))
    return _at_speed(speed, acceleration, angles)


def design_speed(machine: Machine) -> Any:
    """Design speed of the drive, or that of the cycle of a cylinder's flow; None where neither is given."""
    if machine.drive is not None and machine.drive.speed is not None:
        return machine.drive.speed
    flowing = (cylinder for cylinder in machine.mechanism.cylinders.values() if cylinder.flow is not None)
    return next((2 * np.pi / cylinder.cycle for cylinder in flowing), None)


def over_turns(steady: SteadyState, turns: int) -> Motion:
    """Steady motion over so many revolutions: forces may take several cycles of the speed to repeat."""
    cycles = math.lcm(turns, steady.turns) // steady.turns
    ends, one = steady.crank_angle[-1], len(steady.crank_angle) - 1
    # The end of each cycle is the start of the next.
    place = np.append(np.arange(one * cycles) % one, one)
    done = np.append(np.repeat(np.arange(cycles), one), cycles - 1)
    return Motion(
        steady.crank_angle[place] + done * ends,
        steady.speed[place],
        steady.acceleration[place],
        steady.time[place] + done * steady.period,
    )


def _require_full_turn(machine: Machine) -> None:
    """Raise AssemblyError if the crank does not rotate fully, with the angles that it has."""
    closed = closure(machine)
    if closed.turns_fully:
        return
    error = closure_error(closed, machine)
    if not closed.moves:
        raise error
    low, high = np.degrees(closed.ranges[0])
    cycle = 360 * (closed.turns or 0)
    if cycle and high > cycle:
        # A range about zero is found from its lower end on.
        low, high = low - cycle, high - cycle
    low, high = np.ceil(10 * low + 1) / 10, np.floor(10 * high - 1) / 10
    raise AssemblyError(
        f"{error}; within that range forces are found at a speed, between given crank angles, such as "
        f'--speed "10 rad/s" --angles="{low:.1f} deg, {high:.1f} deg"',
        element=error.element,
        crank_angle=error.crank_angle,
    )


def _at_speed(speed: float, acceleration: float, angles: ArrayLike) -> Motion:
    """The same speed and acceleration at every angle."""
    phi = crank_angles(np.atleast_1d(array("crank angles", angles)))
    if not phi.size:
        raise ShapeError("crank angles: found an empty list, expected at least one")
    time = phi / speed if abs(speed) >= SPEED.least else phi
    return Motion(phi, np.full_like(phi, speed), np.full_like(phi, acceleration), time)
