"""Motion in time from a given angle and speed, and how it ended."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from enum import IntEnum
from typing import Annotated, Any, NamedTuple

import numpy as np
from numpy.polynomial import polynomial
from numpy.typing import ArrayLike

from linkwright.drive.load_checks import require_half_turns, require_sound_loads, sliding
from linkwright.drive.model.motor import ConstantSpeedMotor, ConstantTorqueMotor
from linkwright.drive.reduction import NO_INERTIA
from linkwright.kernel.arrays import Bools, Floats
from linkwright.kernel.errors import ConvergenceError, InputError, StartError, SteadyStateError
from linkwright.kernel.public import public
from linkwright.kernel.public.arguments import array, number
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.kernel.units.kinds import ANGLE, COUNT, SPEED, TIME
from linkwright.kernel.units.marks import Quantity, positive
from linkwright.linkages.closure import require_full_turn, require_off_limits
from linkwright.linkages.law_jumps import require_finite_accelerations
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine
from linkwright.machine.program.core import motion_at


class End(IntEnum):
    """How a motion ended; names of `linkwright-core`, module `drive::transient`."""

    TIME = 0
    TURNS = 1
    DOES_NOT_START = 2
    STARTS_BACKWARDS = 3
    STALL = 4
    REVERSAL = 5
    DOES_NOT_CLOSE = 6
    INACCURATE = 7
    SLIDES = 8


class MethodPart(NamedTuple):
    """A part of a motion in time whose steps are all by one method."""

    method: str  # `"explicit"` (DOP853) or `"implicit"` (Radau IIA, where the drive is stiff)
    # Where it begins and ends [s].
    time_start: float
    time_end: float
    steps: int  # steps of the solver [–]


@dataclass(frozen=True)
class StepPolynomials:
    """Motion between the ends of the solver's steps."""

    factors: Floats  # (steps, 2, 7): of the angle [rad] and the speed [rad/s] in each step

    def at_shares(self, z: Floats) -> Floats:
        """Change of angle and speed since the start of every step at shares z of it, 0 to 1, (steps, 2, m).

        z (f₀ + (1 − z)(f₁ + z (f₂ + (1 − z)(f₃ + …)))).
        """
        basis, product = np.empty((self.factors.shape[-1], len(z))), np.ones(len(z))
        for i in range(len(basis)):
            product = product * (1 - z if i % 2 else z)
            basis[i] = product
        changes: Floats = self.factors @ basis
        return changes

    def coefficients(self, which: int) -> Floats:
        """The same polynomials by powers z⁰, whose coefficient is 0, to z⁷, (steps, 8) [rad or rad/s].

        What the step begins with is left out; `which`: 0 the angle, 1 the speed.
        """
        return self.factors[:, which] @ _POWERS


def _powers() -> Floats:
    """What z, z(1 − z), z²(1 − z), z²(1 − z)², … are by powers of z, (7, 8)."""
    rows, product = [], np.array([1.0])
    for i in range(7):
        product = polynomial.polymul(product, [0.0, 1.0] if i % 2 == 0 else [1.0, -1.0])
        rows.append(np.pad(product, (0, 8 - len(product))))
    return np.array(rows)


_POWERS = _powers()

# What the numbers of a motion are.
_ANGLE, _SPEED = Quantity(ANGLE), Quantity(SPEED)
_DURATION, _TURNS = positive(TIME), positive(COUNT)

# Share of the duration by which a sum of times may miss the end of the motion.
_ROUNDING = 1e-12

# Share of its maximum speed below which a crank stands.
_STANDS = 1e-6


@dataclass(frozen=True)
class Transient(Result):
    """A motion in time, at the ends of the solver's steps."""

    time: Annotated[Floats, Label("time", "t", "s")]
    crank_angle: Annotated[Floats, Label("crank angle", "φ", "rad", "Continuous over the revolutions.")]
    speed: Annotated[Floats, Label("speed of the crank", "ω", "rad/s")]
    acceleration: Annotated[Floats, Label("acceleration of the crank", "ε", "rad/s²")]
    end: Annotated[End, About("How it ended.")]
    torque_drive_end: Annotated[
        float,
        Label("driving torque at the crank at the last angle", "", "N m", "What the drive gives at rest."),
    ]
    torque_load_end: Annotated[
        float,
        Label(
            "load torque referred to the crank at the last angle", "", "N m", "What the loads need at rest."
        ),
    ]
    evaluations: Annotated[int, Label("evaluations of the machine", "", "")]
    between: Annotated[StepPolynomials, About("What `at` reads between the ends of the steps.")]
    implicit: Annotated[
        Bools,
        About("Whether a step is by the implicit method; False is the explicit one.", shape="(steps,)"),
    ]

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """As any result, with the parts as tables by name."""
        return super().to_dict(curves=curves) | {"methods": [method._asdict() for method in self.methods]}

    @property
    def turns(self) -> Annotated[float, Label("revolutions of the crank", "n", "")]:
        """Revolutions of the crank from start to end, in whichever direction."""
        return abs(float(self.crank_angle[-1] - self.crank_angle[0])) / (2 * np.pi)

    @property
    def steps(self) -> Annotated[int, Label("steps", "", "")]:
        """Steps of the solver."""
        return len(self.time) - 1

    @property
    def methods(
        self,
    ) -> Annotated[tuple[MethodPart, ...], About("Which method was used from when to when.")]:
        """Which method was used from when to when, in the order of time; none if there is no step."""
        switches = np.flatnonzero(np.diff(self.implicit)) + 1
        ends = [0, *switches.tolist(), self.steps] if self.steps else []
        return tuple(
            MethodPart(
                "implicit" if self.implicit[first] else "explicit",
                float(self.time[first]),
                float(self.time[last]),
                last - first,
            )
            for first, last in itertools.pairwise(ends)
        )

    @property
    def came_to_rest(self) -> bool:
        """Whether the machine never moved or came to rest."""
        return self.end in (End.DOES_NOT_START, End.STARTS_BACKWARDS, End.STALL, End.REVERSAL)

    def at(self, time: ArrayLike) -> tuple[Floats, Floats]:
        """Crank angle and speed at given times.

        Parameters
        ----------
        time : array_like, shape (m,)
            Times between the first and the last [s].

        Returns
        -------
        tuple of ndarray, shape (m,)
            Angle [rad] and speed [rad/s], as exact as at the ends of the steps.

        Raises
        ------
        InputError
            A time is before the start or after the end of the motion.

        References
        ----------
        .. [1] Hairer, Nørsett, Wanner, Solving Ordinary Differential Equations I, II.6: the polynomial of
        order 7 of DOP853; II.7: that of collocation.
        """
        t = self._within(array("time", time))
        if len(self.time) == 1:
            return np.full_like(t, self.crank_angle[0]), np.full_like(t, self.speed[0])
        angle, speed = motion_at(self.time, self.crank_angle, self.speed, self.between.factors, t.ravel())
        return angle.reshape(t.shape), speed.reshape(t.shape)

    def slope(self, time: float) -> float:
        """Acceleration at a time, at the end of a step that before it [rad/s²]."""
        time = float(self._within(np.array(number("time", time))))
        k = int(self.time[1:-1].searchsorted(time))
        h = self.time[k + 1] - self.time[k]
        rate = polynomial.polyder(self.between.coefficients(1)[k])
        return float(polynomial.polyval((time - self.time[k]) / h, rate) / h)

    def _within(self, time: Floats) -> Floats:
        """Times of the motion; those that rounding put beyond an end are at that end."""
        first, last = float(self.time[0]), float(self.time[-1])
        if time.size and time.min() >= first and time.max() <= last:
            return time
        inside = np.clip(time, first, last)
        beyond = np.abs(time - inside) > _ROUNDING * last
        if beyond.any():
            wrong = f"found {time[beyond].flat[0]:.6g} s"
            raise InputError(
                f"time: {wrong}, expected times from {first:g} s to {last:.6g} s, when the motion ends"
            )
        return inside


@public
def transient(
    machine: Machine,
    *,
    angle: float = 0.0,
    speed: float = 0.0,
    duration: float = np.inf,
    turns: float = np.inf,
    accuracy: float = 1e-8,
    motor: bool = True,
    brake: bool = False,
    clockwise: bool = False,
) -> Transient:
    """Compute the motion in time.

    Parameters
    ----------
    machine : Machine
    angle, speed : float
        Crank angle [rad] and speed [rad/s] at the start; a clockwise motion has a negative speed.
    duration : float
        Longest time [s].
    turns : float
        Most revolutions of the crank; one of the two must be finite.
    accuracy : float
        Relative accuracy of a step, at its end and on the way there.
    motor, brake : bool
        Whether the motor is on and the brake applied.
    clockwise : bool
        Whether the motor drives the crank clockwise; from rest the machine is to start that way.

    Returns
    -------
    Transient
        The motion until time or turns are over, or the machine comes to rest.

    Raises
    ------
    AssemblyError
        The motion reaches an angle at which the mechanism does not close.
    ConvergenceError
        The accuracy cannot be kept.
    InputError
        Neither duration nor turns is finite, or the motor is one of constant speed.
    SteadyStateError
        The motion is held at a speed at which a load jumps.

    References
    ----------
    .. [1] Hairer, Nørsett, Wanner, Solving Ordinary Differential Equations I, II.5 (DOP853).
    .. [2] Hairer, Wanner, Solving Ordinary Differential Equations II, IV.5 (Radau IIA, for stiff drives).
    """
    require_motion(angle, speed, (duration, turns), accuracy)
    if motor and machine.drive and isinstance(machine.drive.motor, ConstantSpeedMotor):
        raise InputError("a constant-speed motor has no run-up: it keeps its speed under any load")
    compiled = compile_machine(machine, motor=motor, brake=brake)
    require_half_turns(compiled, machine)
    require_finite_accelerations(machine)
    turning = _turning(machine, speed, clockwise)
    locks = machine.drive is not None and machine.drive.gearbox.locks
    if locks and not motor and speed == 0:
        raise StartError(f"does not start: the motor is off, and {_LOCKS}, so that no load moves the crank")
    motion = compiled.transient((angle, abs(speed)), turning, duration, turns, accuracy)
    end = _HELD.get(End[motion.end], End[motion.end]) if locks else End[motion.end]
    if end == End.DOES_NOT_CLOSE:
        require_full_turn(compiled, machine)
        require_sound_loads(compiled, machine)
        raise SteadyStateError(NO_INERTIA)
    if not math.isfinite(motion.torque_drive_end + motion.torque_load_end):
        require_sound_loads(compiled, machine)
    last = float(motion.crank_angle[-1]), float(motion.speed[-1])
    if last[1] <= _STANDS * float(motion.speed.max()):
        # At a limit of its rotation the crank stops for an instant, and its links drive it back.
        require_off_limits(compiled, machine, last[0])
    if locks and not motor:
        _require_no_driving_load(motion.crank_angle, turning[0] * motion.acceleration)
    if end == End.SLIDES:
        raise sliding(machine, *last)
    if end == End.INACCURATE:
        raise ConvergenceError(
            f"the integration stopped at {motion.time[-1]:.6g} s: steps became too small or too many for "
            f"an accuracy of {accuracy:g}",
            method="DOP853 and Radau IIA",
            iterations=len(motion.time),
        )
    return Transient(
        time=motion.time,
        crank_angle=motion.crank_angle,
        speed=motion.speed,
        acceleration=motion.acceleration,
        end=end,
        torque_drive_end=motion.torque_drive_end,
        torque_load_end=motion.torque_load_end,
        evaluations=motion.evaluations,
        between=StepPolynomials(motion.factors),
        implicit=motion.implicit,
    )


def require_motion(angle: float, speed: float, limits: tuple[float, float], accuracy: float) -> None:
    """Raise InputError unless start, duration, turns and accuracy of a motion in time are possible."""
    duration, turns = limits
    if duration == turns == np.inf:
        raise InputError("duration, turns: found neither, expected one of them as the end of the motion")
    in_range(
        angle=(angle, _ANGLE),
        speed=(speed, _SPEED),
        duration=(None if duration == np.inf else duration, _DURATION),
        turns=(None if turns == np.inf else turns, _TURNS),
    )
    if not 1e-14 <= accuracy <= 1e-2:
        raise InputError(f"accuracy {accuracy:g}: expected a number from 1e-14 to 1e-2")


# What a self-locking gearbox holds would turn backwards.
_HELD = {End.STARTS_BACKWARDS: End.DOES_NOT_START, End.REVERSAL: End.STALL}

_LOCKS = "the gearbox is self-locking (drive.gearbox.reverse = 0)"


def _require_no_driving_load(crank_angle: Floats, gained: Floats) -> None:
    """Raise if the load accelerates a machine with its motor off, which a self-locking gearbox prevents."""
    at = int(np.argmax(gained))
    if gained[at] > _ROUNDING * np.abs(gained).max():
        raise SteadyStateError(
            f"the motion with the motor off is not computed: {_LOCKS}, and at a crank angle of "
            f"{np.degrees(crank_angle[at] % (2 * np.pi)):.1f}° the load or the changing inertia would "
            "drive the motor; give drive.gearbox.reverse the factor of a gearbox that is not self-locking"
        )


def _turning(machine: Machine, speed: float, clockwise: bool) -> tuple[int, int]:
    """Directions, +1 or −1, in which the crank turns, or is to from rest, and in which the motor drives."""
    motor = -1 if clockwise else 1
    if speed != 0:
        return (1 if speed > 0 else -1), motor
    characteristic = machine.drive.motor if machine.drive else None
    backwards = isinstance(characteristic, ConstantTorqueMotor) and characteristic.torque < 0
    return (-motor if backwards else motor), motor
