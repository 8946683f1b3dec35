"""Run-up from rest, and run-down with the motor off.

Whether the machine starts, how long it takes, and where it stalls if it does; how long it turns until the
brake or its losses stop it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from linkwright.drive.motion_events import largest
from linkwright.drive.steady_state import SteadyState, steady_curves, steady_state
from linkwright.drive.transient import End, MethodPart, Transient, transient
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError, StartError, SteadyStateError
from linkwright.kernel.numerics.zeros import zeros
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.linkages.whole_cycle import cycle_of
from linkwright.machine.machine import Machine

# Relative accuracy of a step, and of the steady motion that is approached: as in a study, which has it.
_ACCURACY, _STEADY_ACCURACY = 1e-9, 1e-10

# Turns after which it is looked again whether the motion has settled; most drives settle in the first ten.
_FIRST_TURNS = 10.0

_UNTIL = (
    "From the start until the speed last differed from that of steady motion at the same angle by more than "
    "``settled`` times the mean speed."
)


@dataclass(frozen=True)
class RunUp(Result):
    """The run-up, at the ends of the solver's steps."""

    crank_time: Annotated[Floats, Label("time", "t", "s")]
    crank_angle: Annotated[Floats, Label("crank angle", "φ", "rad")]
    speed: Annotated[Floats, Label("speed of the crank", "ω", "rad/s")]
    acceleration: Annotated[Floats, Label("acceleration of the crank", "ε", "rad/s²")]
    turns: Annotated[float, Label("revolutions of the crank", "n", "", _UNTIL, table="run_up")]
    time: Annotated[float, Label("time", "t", "s", _UNTIL, table="run_up")]
    settled: Annotated[float, Label("share of the mean speed that counts as settled", "", "")]
    speed_peak: Annotated[
        float, Label("maximum speed during the run-up", "ω_peak", "rad/s", "Until then.", table="run_up")
    ]
    motion: Annotated[Transient, About("The whole motion.")]

    @property
    def methods(
        self,
    ) -> Annotated[tuple[MethodPart, ...], About("Which method was used from when to when.")]:
        """Which method was used from when to when, in the order of time."""
        return self.motion.methods

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """As any result, with the parts as tables by name."""
        return super().to_dict(curves=curves) | {"methods": [method._asdict() for method in self.methods]}


@public
def run_up(machine: Machine, *, steady: SteadyState | None = None) -> RunUp:
    """Run-up from the start angle and speed (``[run_up]`` of the file).

    Parameters
    ----------
    machine : Machine
        The machine, with a motor.
    steady : SteadyState, optional
        Its steady motion, if known already.

    Returns
    -------
    RunUp
        The motion, and when it has settled.

    Raises
    ------
    StartError
        It does not start, stalls, is driven backwards, or has not settled within ``run_up.turns_max``; says
        at which angle, with the torques.
    SteadyStateError, AssemblyError
        See `steady_state`.

    Notes
    -----
    At rest a dry resistance holds up to its size in either direction.
    """
    start_of(machine)
    return accurate_run_up(machine, steady or _steady_or_stall(machine), _ACCURACY)


def accurate_run_up(machine: Machine, steady: SteadyState, accuracy: float) -> RunUp:
    """`run_up` of a machine that starts, with the relative accuracy of a step."""
    options = machine.run_up
    turns = min(_FIRST_TURNS, options.turns_max)
    while True:
        motion = transient(
            machine,
            angle=options.angle_start,
            speed=options.speed_start,
            turns=turns,
            accuracy=accuracy,
        )
        if motion.came_to_rest:
            raise StartError(_why_not(motion, cycle_of(machine)))
        settled = _settled(machine, motion, steady, accuracy)
        # Settled well before the end: otherwise the speed may yet leave the band again.
        if settled is not None and (settled[0] <= 0.8 * turns or turns >= options.turns_max):
            break
        if turns >= options.turns_max:
            raise StartError(_too_slow(machine, motion, steady))
        turns = min(3 * turns, options.turns_max)
    return RunUp(
        crank_time=motion.time,
        crank_angle=motion.crank_angle,
        speed=motion.speed,
        acceleration=motion.acceleration,
        turns=settled[0],
        time=settled[1],
        settled=options.settled,
        speed_peak=peak_until(motion, settled[1])[0],
        motion=motion,
    )


def _steady_or_stall(machine: Machine) -> SteadyState:
    """Steady motion; a `StartError` says where the machine comes to rest instead."""
    try:
        return steady_state(machine, accuracy=_STEADY_ACCURACY)
    except SteadyStateError:
        options = machine.run_up
        motion = transient(
            machine, angle=options.angle_start, speed=options.speed_start, turns=options.turns_max
        )
        if motion.came_to_rest:
            raise StartError(_why_not(motion, cycle_of(machine))) from None
        raise


def start_of(machine: Machine) -> None:
    """Raise if the machine cannot move from its start angle and speed.

    An `InputError` without a motor, a `StartError` if the drive does not overcome the load at the start.
    """
    if machine.drive is None or machine.drive.motor is None:
        raise InputError(f"{machine.name}: a run-up needs a motor; add [drive.motor]")
    options = machine.run_up
    # Any short motion will do: what counts is whether there is one.
    first = transient(
        machine, angle=options.angle_start, speed=options.speed_start, turns=0.01, accuracy=1e-6
    )
    if first.came_to_rest:
        raise StartError(_why_not(first, cycle_of(machine)))


def _why_not(motion: Transient, cycle: float) -> str:
    """One sentence: at which angle of a cycle [rad] the machine comes to rest, with both torques."""
    angle = f"{np.degrees(motion.crank_angle[-1] % cycle):.1f}°"
    drive, load = motion.torque_drive_end, motion.torque_load_end
    balance = f"at {angle} the motor gives {drive:.0f} N m at the crank, the load needs {load:.0f} N m"
    remedy = "choose a motor with more starting torque, a larger ratio, or another start angle"
    if motion.end == End.DOES_NOT_START:
        return f"does not start: {balance}; {remedy}"
    if motion.end == End.STARTS_BACKWARDS:
        return f"does not start: the load drives the crank backwards; {balance}; {remedy}"
    after = f"after {motion.turns:.2f} revolutions and {motion.time[-1]:.2f} s"
    if motion.end == End.REVERSAL:
        return f"runs backwards {after}: {balance}, and the load turns the crank back; {remedy}"
    return f"stalls {after}: {balance}; {remedy}"


def _too_slow(machine: Machine, motion: Transient, steady: SteadyState) -> str:
    end, band = float(motion.speed[-1]), machine.run_up.settled
    for other in steady.others:
        if other.is_stable and (1 - band) * other.speed_min <= end <= (1 + band) * other.speed_max:
            return (
                f"does not reach the steady motion of {steady.speed_mean_time:.4g} rad/s: after "
                f"{motion.turns:.0f} revolutions it runs at {end:.4g} rad/s, within another steady motion, "
                f"{other.speed_min:.4g} to {other.speed_max:.4g} rad/s; choose a motor with more torque at "
                "low speed, or start at a higher run_up.speed_start"
            )
    last = _steady_speed(machine, steady, motion.crank_angle[-1:], _STEADY_ACCURACY)[0]
    off = abs(motion.speed[-1] / last - 1)
    return (
        f"has not settled after {motion.turns:.0f} revolutions ({motion.time[-1]:.1f} s): its speed still "
        f"differs from it by {100 * off:.2g} %, more than {100 * band:.2g} %; raise run_up.turns_max"
    )


def _steady_speed(machine: Machine, steady: SteadyState, angle: Floats, accuracy: float) -> Floats:
    """Steady speed at crank angles by its solution: an interpolated curve would miss narrow peaks."""
    phi, place = np.unique(angle % (2 * np.pi * steady.turns), return_inverse=True)
    speed: Floats = steady_curves(machine, min(accuracy, _STEADY_ACCURACY), phi).speed[place]
    return speed


def _settled(
    machine: Machine, motion: Transient, steady: SteadyState, accuracy: float
) -> tuple[float, float] | None:
    """Turns and time at which the motion last enters the band about steady motion; None if never."""
    limit = machine.run_up.settled * steady.speed_mean_time
    looks, angle, speed = _looks(motion)
    outside = np.flatnonzero(np.abs(speed - _steady_speed(machine, steady, angle, accuracy)) > limit)
    if not len(outside):
        return 0.0, 0.0
    if outside[-1] == len(looks) - 1:
        return None
    low, high = looks[outside[-1:]], looks[outside[-1:] + 1]

    def excess(time: Floats) -> Floats:
        angle, speed = motion.at(time)
        return np.abs(speed - _steady_speed(machine, steady, angle, accuracy)) - limit

    settled = np.maximum(*zeros(excess, low, high))
    turned = motion.at(settled)[0][0] - motion.crank_angle[0]
    return float(turned) / (2 * np.pi), float(settled[0])


def peak_until(motion: Transient, until: float) -> tuple[float, float]:
    """Maximum speed up to a time, and when: that of the motion between the solver's steps, to rounding."""
    if len(motion.time) < 2:
        return float(motion.speed[0]), 0.0
    last = int(motion.time[1:-1].searchsorted(until, side="right"))
    start, end = motion.time[last : last + 2]
    speed = motion.between.coefficients(1)[: last + 1]
    speed[:, 0] = motion.speed[: last + 1]
    # Of the last step the part up to the time, as a step of its own.
    speed[last] *= ((until - start) / (end - start)) ** np.arange(speed.shape[1])
    peak, step, share = largest(speed)
    begin, end = motion.time[step], min(until, motion.time[step + 1])
    return peak, float(begin + share * (end - begin))


def _looks(motion: Transient) -> tuple[Floats, Floats, Floats]:
    """Times, angles and speeds at eight looks a step of the solver, which takes some twenty a revolution."""
    z = np.arange(8) / 8
    time = motion.time[:-1, None] + np.diff(motion.time)[:, None] * z
    changes = motion.between.at_shares(z)
    angle, speed = motion.crank_angle[:-1, None] + changes[:, 0], motion.speed[:-1, None] + changes[:, 1]
    ends = (motion.time, time), (motion.crank_angle, angle), (motion.speed, speed)
    times, angles, speeds = (np.append(even, curve[-1]) for curve, even in ends)
    return times, angles, speeds


# Turns after which a run-down is given up: nothing brakes.
_TURNS_MAX = 1000.0

# Relative accuracy of a step of the run-down.
_RUN_DOWN_ACCURACY = 1e-8


@dataclass(frozen=True)
class RunDown(Result):
    """The run-down from the steady speed at φ = 0."""

    turns: Annotated[float, Label("revolutions of the crank", "n", "", "Until rest.", table="run_down")]
    time: Annotated[float, Label("time", "t", "s", "Until rest.", table="run_down")]
    angle_end: Annotated[float, Label("crank angle at rest", "φ_end", "rad", table="run_down")]
    motion: Annotated[Transient, About("The whole motion.")]


@public
def run_down(machine: Machine, *, steady: SteadyState | None = None) -> RunDown:
    """Run-down from steady motion: motor off, brake applied if there is one.

    Parameters
    ----------
    machine : Machine
    steady : SteadyState, optional
        Its steady motion, if known already.

    Returns
    -------
    RunDown
        Until it stands; where gravity or a spring would swing it back, until it first comes to rest.

    Raises
    ------
    SteadyStateError
        It does not come to rest within 1000 revolutions: nothing brakes it.
    """
    steady = steady or steady_state(machine, n=8)
    return accurate_run_down(machine, float(steady.speed[0]), _RUN_DOWN_ACCURACY)


def accurate_run_down(machine: Machine, speed: float, accuracy: float) -> RunDown:
    """`run_down` from a speed [rad/s] at φ = 0, with the relative accuracy of a step."""
    motion = transient(machine, speed=speed, turns=_TURNS_MAX, accuracy=accuracy, motor=False, brake=True)
    if not motion.came_to_rest:
        raise SteadyStateError(
            f"does not come to rest within {_TURNS_MAX:.0f} revolutions: add [drive.brake]"
        )
    end = float(motion.crank_angle[-1] % cycle_of(machine))
    return RunDown(turns=motion.turns, time=float(motion.time[-1]), angle_end=end, motion=motion)
