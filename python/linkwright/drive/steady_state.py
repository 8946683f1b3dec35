r"""Steady motion: the periodic solution of the machine's equation of motion, and its measures.

.. math:: J \frac{du}{d\varphi} = M_d(\omega) - M_r(\varphi,\omega) - J' u, \qquad u = \tfrac12 \omega^2

The solution is found by Newton on the map from one revolution to the next, not by waiting for transients; the
core says how (`linkwright-core`, module `drive::cycle`).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np

from linkwright.drive import evenness
from linkwright.drive.fallback import in_time
from linkwright.drive.load_checks import require_same_turns, require_sound_loads, sliding
from linkwright.drive.model.motor import ConstantSpeedMotor
from linkwright.drive.reduction import NO_INERTIA, mean_laws, mean_over_turn
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import ConvergenceError, InputError, SteadyStateError
from linkwright.kernel.numerics.tangent import primal
from linkwright.kernel.numerics.turn_fit import turn_curve
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.linkages.closure import require_full_turn, turn_angles
from linkwright.linkages.whole_cycle import over_whole_cycle
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine, compile_machine
from linkwright.machine.program.core import (
    MESH_STEPS_MAX,
    SEARCH_STEPS_MAX,
    SEARCH_TURNS_MAX,
    NoSteadyMotion,
    Status,
    SteadyCurves,
    SteadyMotion,
    SteadySolution,
)

# Speeds at which it is looked whether the drive can balance the mean load at all.
_SPEEDS = 400

# Share of the square of the speed that accelerations are at least compared with.
_LEAST_ACCELERATION = 1e-4

# Share of the work of the motor below which that of the loads is rounding of a sum of ten thousand doubles.
_ROUNDING = 1e-12


class OtherMotion(NamedTuple):
    """A motion that repeats besides the one that a fast machine settles to.

    Attributes
    ----------
    speed_min, speed_max : float
        Of the crank [rad/s].
    period : float
        Duration of a cycle [s].
    multiplier : float
        What is left of a small disturbance of the speed after one cycle, as a share. From 1 up the
        machine departs from the motion: what starts slower slows down, what starts faster speeds up.
    turns : int
        Revolutions of a cycle.
    """

    speed_min: float
    speed_max: float
    period: float
    multiplier: float
    turns: int = 1

    @property
    def speed_mean_time(self) -> float:
        """Angle of a cycle over its duration [rad/s]."""
        return 2 * np.pi * self.turns / self.period

    @property
    def is_stable(self) -> bool:
        """Whether a small disturbance dies away."""
        return abs(self.multiplier) < 1


class StartLimit(NamedTuple):
    """Starts of which it is known that they do not settle to the motion, or not known whether they do.

    Attributes
    ----------
    outcome : str
        ``"runs away"``: the machine gains speed from cycle to cycle, up to a range of motions that repeat,
        or at 1500 times the working speed too.
        ``"undecided"``: the search for other motions ended before these starts were followed.
    side : str
        ``"above"`` or ``"below"``: which starts.
    speed : float
        Of the crank at φ = 0, where they begin [rad/s].
    """

    outcome: Literal["runs away", "undecided"]
    side: Literal["above", "below"]
    speed: float


# What is said of such starts, by their outcome.
START_WORDS = {
    "runs away": "From {} the machine runs away: the driving torque exceeds the load torque at every "
    "speed; it reaches the steady motion from slower starts.",
    "undecided": "The behaviour from {} was not determined: the search for other steady motions reached "
    "its limit; simulate the machine in time (linkwright transient).",
}

_MULTIPLIER = (
    "Share of a small disturbance of the speed left after one cycle; the motion is stable if it is "
    "below 1 in magnitude."
)
_ACCURACY = (
    "Measured relative error of speeds, of accelerations (relative to their peak, or to 1e-4 ω² or a "
    "millionth of what the drive alone would give if that is larger), of the integrals (relative to the sum "
    "of their parts, or to what that acceleration takes if that is larger), and of the Floquet multiplier "
    "(relative to 1, or to itself if that is larger). Every step is compared with two half steps."
)
_OTHERS = "Other periodic motions of the machine, from the fastest down to a hundredth of the working speed."
_LIMITS = "Starts from which the machine runs away, or was not followed to an end; empty if there are none."


@dataclass(frozen=True)
class SteadyState(Result, evenness.Evenness[float]):
    """One cycle of steady motion; extremes are exact, not those of the curves.

    A cycle is a revolution of the crank, or as many as loads and mechanism take to repeat.
    """

    crank_angle: Annotated[
        Floats, Label("crank angle", "φ", "rad", "Over a cycle, from 0 on.", shape="(n + 1,)")
    ]
    time: Annotated[Floats, Label("time", "t", "s", "From the start of the cycle.")]
    speed: Annotated[Floats, Label("speed of the crank", "ω", "rad/s")]
    acceleration: Annotated[Floats, Label("acceleration of the crank", "ε", "rad/s²")]
    torque_motor: Annotated[Floats, Label("torque of the motor", "M", "N m", "At its shaft.")]
    torque_drive: Annotated[Floats, Label("driving torque at the crank", "M_d", "N m")]
    torque_load: Annotated[Floats, Label("load torque referred to the crank", "M_r", "N m")]
    power_motor: Annotated[Floats, Label("power of the motor", "P", "W", "At its shaft.")]
    inertia_reduced: Annotated[Floats, Label("reduced inertia", "J", "kg m²")]
    speed_min: Annotated[float, Label("minimum speed", "ω_min", "rad/s", table="steady_state")]
    speed_max: Annotated[float, Label("maximum speed", "ω_max", "rad/s", table="steady_state")]
    acceleration_min: Annotated[float, Label("minimum acceleration", "ε_min", "rad/s²", table="steady_state")]
    acceleration_max: Annotated[float, Label("maximum acceleration", "ε_max", "rad/s²", table="steady_state")]
    speed_min_angle: Annotated[float, Label("crank angle of the minimum speed", "φ(ω_min)", "rad")]
    speed_max_angle: Annotated[float, Label("crank angle of the maximum speed", "φ(ω_max)", "rad")]
    acceleration_min_angle: Annotated[
        float, Label("crank angle of the minimum acceleration", "φ(ε_min)", "rad")
    ]
    acceleration_max_angle: Annotated[
        float, Label("crank angle of the maximum acceleration", "φ(ε_max)", "rad")
    ]
    period: Annotated[float, Label("period", "T", "s", "Duration of a cycle.", table="steady_state")]
    multiplier: Annotated[
        float,
        # A disturbance of which less than rounding is left is gone.
        Label("Floquet multiplier", "G", "", _MULTIPLIER, table="steady_state", scale=1.0),
    ]
    energy_motor: Annotated[float, Label("work of the motor per revolution", "A_m", "J", table="drive")]
    energy_drive: Annotated[float, Label("work at the crank per revolution", "A_d", "J", table="drive")]
    energy_load: Annotated[float, Label("work of the loads per revolution", "A_r", "J", table="drive")]
    torque_motor_mean: Annotated[
        float, Label("mean torque of the motor", "M_mean", "N m", "Over time.", table="drive")
    ]
    torque_motor_rms: Annotated[
        float, Label("root mean square torque of the motor", "M_rms", "N m", "Over time.", table="drive")
    ]
    torque_motor_min: Annotated[
        float,
        Label("minimum torque of the motor", "M_min", "N m", "Negative: the load drives it.", table="drive"),
    ]
    torque_motor_max: Annotated[float, Label("maximum torque of the motor", "M_max", "N m", table="drive")]
    power_motor_max: Annotated[
        float,
        Label("maximum power of the motor", "P_max", "W", table="drive", before="torque_motor_mean"),
    ]
    accuracy: Annotated[float, Label("accuracy reached", "", "", _ACCURACY, table="steady_state")]
    sweeps: Annotated[int, Label("Newton sweeps", "", "", "Over the revolution, in all.")]
    steps: Annotated[int, Label("steps of the finest mesh", "", "", table="steady_state")]
    turns: Annotated[int, Label("revolutions of a cycle", "", "")] = 1
    method: Annotated[str, About('``"collocation"`` or ``"constant speed"``.')] = "collocation"
    others: Annotated[tuple[OtherMotion, ...], About(_OTHERS)] = ()
    start_limits: Annotated[tuple[StartLimit, ...], About(_LIMITS)] = ()

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """As `Result.to_dict`, ready for JSON; other motions and limits of starts as tables with names."""
        others = [other._asdict() for other in self.others]
        limits = [limit._asdict() for limit in self.start_limits]
        return super().to_dict(curves=curves) | {"others": others, "start_limits": limits}

    @property
    def speed_mean_time(self) -> Annotated[float, Label("mean speed over time", "ω_m", "rad/s")]:
        """Angle of a cycle over its duration."""
        return 2 * np.pi * self.turns / self.period

    @property
    def unevenness_time(self) -> Annotated[float, evenness.DELTA_TIME]:
        """δ with the mean over time."""
        return evenness.unevenness(self.speed_min, self.speed_max, self.speed_mean_time)

    @property
    def dynamism_time(self) -> Annotated[float, evenness.DYNAMIC_FACTOR_TIME]:
        """H with the mean over time."""
        return evenness.dynamism(self.acceleration_min, self.acceleration_max, self.speed_mean_time)

    @property
    def motion_coefficient_time(self) -> Annotated[float, evenness.K_P_TIME]:
        """k_p with the mean over time."""
        return evenness.motion_coefficient(self.unevenness_time, self.dynamism_time)

    @property
    def is_stable(self) -> bool:
        """Whether a small disturbance dies away."""
        return abs(self.multiplier) < 1

    @property
    def power_motor_mean(
        self,
    ) -> Annotated[
        float, Label("mean power of the motor", "P_mean", "W", table="drive", before="power_motor_max")
    ]:
        """Work of the motor in a cycle over its period."""
        return self.energy_motor * self.turns / self.period

    @property
    def cyclic_load_factor(
        self,
    ) -> Annotated[
        float | None,
        Label("cyclic load factor of the motor", "CLF", "", table="drive", before="torque_motor_min"),
    ]:
        """Root mean square over mean torque: what heats the motor against what works; None where the mean is
        not positive.
        """
        return self.torque_motor_rms / self.torque_motor_mean if self.torque_motor_mean > 0 else None

    @property
    def efficiency(
        self,
    ) -> Annotated[
        float | None,
        Label("efficiency of the drive per revolution", "η", "", table="drive", before="power_motor_mean"),
    ]:
        """Work taken by the loads over work of the motor; None without any work of the motor."""
        share = self.energy_load / self.energy_motor if self.energy_motor > unknown_work(self) else None
        # Zero, with the derivatives that it may have.
        return share - primal(share) if share is not None and abs(share) <= _ROUNDING else share


def unknown_work(state: SteadyState) -> float:
    """Work per revolution that may be left where what is given in a part is taken back in another [J].

    A share of the parts, or of what the acceleration takes, as `SteadyState.accuracy` says, or rounding.
    """
    acceleration = max(np.abs(state.acceleration).max(), _LEAST_ACCELERATION * state.speed.max() ** 2)
    torques = (state.torque_drive, state.torque_load, state.inertia_reduced * acceleration)
    share = max(state.accuracy, _ROUNDING)
    return share * 2 * np.pi * max(float(np.abs(torque).max()) for torque in torques)


@public
def steady_state(
    machine: Machine, *, accuracy: float = 1e-9, n: int = 360, angles: Floats | None = None
) -> SteadyState:
    """Find the steady motion.

    Parameters
    ----------
    machine : Machine
        The machine, with a motor.
    accuracy : float
        Relative accuracy of everything that is returned, down to 1e-13: speeds, accelerations against their
        peak, integrals, the multiplier against 1. Rounding may forbid it where the motor is very steep;
        `SteadyState.accuracy` says what was reached.
    n : int
        Intervals of a revolution for the curves; extremes and integrals do not depend on it.
    angles : ndarray, shape (m,), optional
        Crank angles of the curves instead, within the cycle [rad].

    Returns
    -------
    SteadyState
        One cycle from φ = 0.

    Raises
    ------
    AssemblyError
        The mechanism does not close all round.
    FindingError
        It does not repeat after 24 revolutions of the crank or fewer.
    SteadyStateError
        There is no periodic motion; says what the drive lacks. Or it slides along a jump of a load.
    ConvergenceError
        The accuracy was not reached.
    InputError
        The machine has no motor; angles are outside the cycle.

    Notes
    -----
    With a motor of constant speed nothing is solved: the drive's torque is what the motion needs.

    References
    ----------
    .. [1] Paper 1, equation (1) for the motion, (13)–(15) for the measures.
    """
    if angles is not None:
        _require_within_cycle(machine, angles)
    return solved_state(machine, accuracy, n if angles is None else angles)[0]


def _require_within_cycle(machine: Machine, angles: Floats) -> None:
    compiled = compile_machine(machine)
    require_full_turn(compiled, machine)
    cycle = 2 * np.pi * over_whole_cycle(compiled).turns
    if angles.min() < 0 or angles.max() > cycle * (1 + 1e-12):
        found = f"{angles.min():.6g} to {angles.max():.6g} rad"
        raise InputError(f"angles: found {found}, expected them from 0 to {cycle:.6g} rad")


def require_accuracy(accuracy: float) -> None:
    """Refuse a relative accuracy that no steady motion is computed to."""
    if not 1e-13 <= accuracy <= 1e-2:
        raise InputError(f"accuracy {accuracy:g}: expected a number from 1e-13 to 1e-2")


def solved_state(
    machine: Machine, accuracy: float, at: Floats | int
) -> tuple[SteadyState, SteadySolution | None]:
    """`steady_state` at crank angles or so many per revolution, and its solution; None for constant speed."""
    if machine.drive is None or machine.drive.motor is None:
        raise InputError(f"{machine.name}: steady motion needs a motor; add [drive.motor]")
    require_accuracy(accuracy)
    compiled = compile_machine(machine)
    require_full_turn(compiled, machine)
    compiled = over_whole_cycle(compiled)
    phi = turn_angles(at, compiled.turns) if isinstance(at, int) else at
    require_same_turns(machine)
    require_sound_loads(compiled, machine)
    if isinstance(machine.drive.motor, ConstantSpeedMotor):
        return _at_constant_speed(machine, compiled, phi), None
    motion = compiled.steady(phi, accuracy)
    if isinstance(motion, NoSteadyMotion):
        raise _failure(motion, machine, compiled, accuracy)
    compile_machine(machine).kept["steady motion"] = accuracy, motion
    return _from_core(motion, phi, compiled), motion.solution


def steady_curves(machine: Machine, accuracy: float, angles: Floats) -> SteadyState | SteadyCurves:
    """Curves of steady motion at crank angles, from the last solution if that is one to this accuracy."""
    known = _last_solved(machine)
    if known is not None and known[0] == accuracy:
        return known[1].solution.curves(angles)
    return solved_state(machine, accuracy, angles)[0]


def known_start_limits(machine: Machine) -> tuple[StartLimit, ...]:
    """Limits of starts of the steady motion that was solved last of a machine; empty if none was."""
    known = _last_solved(machine)
    return () if known is None else tuple(_start_limits(known[1]))


def _last_solved(machine: Machine) -> tuple[float, SteadyMotion] | None:
    """The last steady motion that was solved of a machine, behind the accuracy that was asked for."""
    last: tuple[float, SteadyMotion] | None
    last = compile_machine(machine).kept.get("steady motion")
    return last


def _from_core(motion: SteadyMotion, phi: Floats, compiled: CompiledMachine) -> SteadyState:
    ratio = compiled.gear_factors[0]
    others = [(other.speed_min, other.speed_max, other.period, other.multiplier) for other in motion.others]
    return SteadyState(
        crank_angle=phi,
        time=motion.time,
        speed=motion.speed,
        acceleration=motion.acceleration,
        torque_motor=motion.torque_motor,
        torque_drive=motion.torque_drive,
        torque_load=motion.torque_load,
        power_motor=motion.torque_motor * motion.speed * ratio,
        inertia_reduced=motion.inertia_reduced,
        speed_min=motion.speed_min,
        speed_max=motion.speed_max,
        acceleration_min=motion.acceleration_min,
        acceleration_max=motion.acceleration_max,
        speed_min_angle=motion.speed_min_angle,
        speed_max_angle=motion.speed_max_angle,
        acceleration_min_angle=motion.acceleration_min_angle,
        acceleration_max_angle=motion.acceleration_max_angle,
        period=motion.period,
        multiplier=motion.multiplier,
        energy_motor=motion.energy_motor / compiled.turns,
        energy_drive=motion.energy_drive / compiled.turns,
        energy_load=motion.energy_load / compiled.turns,
        torque_motor_mean=motion.torque_motor_mean,
        torque_motor_rms=motion.torque_motor_rms,
        torque_motor_min=motion.torque_motor_min,
        torque_motor_max=motion.torque_motor_max,
        power_motor_max=motion.power_motor_max,
        accuracy=motion.accuracy,
        sweeps=motion.sweeps,
        steps=motion.steps,
        turns=compiled.turns,
        others=tuple(OtherMotion(*other, compiled.turns) for other in others),
        start_limits=tuple(_start_limits(motion)),
    )


def _start_limits(motion: SteadyMotion) -> Iterator[StartLimit]:
    if not np.isnan(motion.away_from):
        yield StartLimit("runs away", "above", motion.away_from)
    if not np.isnan(motion.undecided_above):
        yield StartLimit("undecided", "above", motion.undecided_above)
    if not np.isnan(motion.undecided_below):
        yield StartLimit("undecided", "below", motion.undecided_below)


def _at_constant_speed(machine: Machine, compiled: CompiledMachine, phi: Floats) -> SteadyState:
    """Revolution of a machine at constant speed: the motor supplies the torque that the motion needs."""
    drive = machine.drive
    assert drive is not None
    assert isinstance(drive.motor, ConstantSpeedMotor)
    ratio = drive.gearbox.ratio
    omega = drive.motor.speed / ratio

    def needs(angles: Floats) -> Floats:
        """J, load torque, driving torque that the motion needs, and the motor's, (4, n)."""
        at = compiled.reductions(angles)
        resisting = at.load + at.dry + at.viscous * omega + compiled.speed_load(omega)
        if compiled.has_laws:
            resisting = resisting + compiled.law_torques(angles, omega)[0]
        driving = resisting + 0.5 * at.inertia_slope * omega**2
        return np.stack([at.inertia, resisting, driving, compiled.motor_torque_for(driving)])

    J, torque_load, torque_drive, torque_motor = needs(phi)
    turn = turn_curve(needs, compiled.kinks(), "torque of the drive")
    _, load_mean, drive_mean, motor_mean = turn.mean().tolist()
    motor_max = turn.extreme(+1, 3)[0]
    period = compiled.cycle / omega
    still: dict[str, Any] = dict.fromkeys(("speed_min_angle", "speed_max_angle"), 0.0)
    still |= dict.fromkeys(("acceleration_min", "acceleration_max"), 0.0)
    still |= dict.fromkeys(
        ("acceleration_min_angle", "acceleration_max_angle", "accuracy", "multiplier"), 0.0
    )
    return SteadyState(
        crank_angle=phi,
        time=phi / omega,
        speed=np.full_like(phi, omega),
        acceleration=np.zeros_like(phi),
        torque_motor=torque_motor,
        torque_drive=torque_drive,
        torque_load=torque_load,
        power_motor=torque_motor * omega * ratio,
        inertia_reduced=J,
        speed_min=omega,
        speed_max=omega,
        period=period,
        energy_motor=motor_mean * ratio * 2 * np.pi,
        energy_drive=drive_mean * 2 * np.pi,
        energy_load=load_mean * 2 * np.pi,
        torque_motor_mean=motor_mean,
        torque_motor_rms=float(turn.rms()[3]),
        torque_motor_min=turn.extreme(-1, 3)[0],
        torque_motor_max=motor_max,
        power_motor_max=motor_max * omega * ratio,
        sweeps=0,
        steps=0,
        turns=compiled.turns,
        method="constant speed",
        others=(),
        **still,
    )


def _failure(
    motion: NoSteadyMotion, machine: Machine, compiled: CompiledMachine, accuracy: float
) -> Exception:
    angle, speed, reached = motion.crank_angle, motion.speed, motion.accuracy
    if motion.status == Status.DOES_NOT_CLOSE:
        return SteadyStateError(NO_INERTIA)
    if motion.status == Status.NO_STEADY_MOTION:
        if np.isnan(angle):
            return SteadyStateError(_runs_away(compiled, speed))
        return SteadyStateError(
            f"{_what_lacks(compiled)} (started at {speed:.4g} rad/s at φ = 0, it comes to rest at "
            f"φ = {np.degrees(angle):.4g}°; from higher speeds it slows down to this motion)"
        )
    if motion.status == Status.SLIDES:
        return sliding(machine, angle, speed)
    if motion.status == Status.NEUTRAL:
        return SteadyStateError(_neutral(compiled, motion.speed_slowest, speed))
    if motion.status == Status.UNDECIDED:
        return ConvergenceError(
            "the existence of a steady motion was not determined: the search is limited to "
            f"{SEARCH_TURNS_MAX} revolutions and {SEARCH_STEPS_MAX} integration steps; "
            + in_time(machine, compiled.speed_guess, compiled.turns),
            method="integration over revolutions",
            iterations=SEARCH_TURNS_MAX,
        )
    if motion.status == Status.NOT_CONVERGED:
        return ConvergenceError(
            "a periodic motion exists"
            + ("" if np.isnan(speed) else f" at {speed:.4g} rad/s at φ = 0°")
            + ", but Newton's method does not converge to it: its values are unknown; "
            + in_time(machine, compiled.speed_guess if np.isnan(speed) else speed, compiled.turns),
            method="Newton's method",
        )
    if not reached > accuracy:
        return ConvergenceError(
            f"steady motion needs more than {MESH_STEPS_MAX} steps per revolution to resolve the steep "
            "parts of the load formulas; use fewer, or wider, pulses and switches",
            method="collocation",
            iterations=MESH_STEPS_MAX,
        )
    return ConvergenceError(
        f"steady motion was found to a relative accuracy of {reached:.1e} only, {accuracy:g} is required; "
        "reduce the accuracy, or check whether the mechanism nearly locks",
        method="collocation",
        iterations=MESH_STEPS_MAX,
    )


def _neutral(compiled: CompiledMachine, slowest: float, fastest: float) -> str:
    load, viscous = mean_over_turn(compiled)
    omega = np.array([slowest if np.isinf(fastest) else 0.5 * (slowest + fastest)])
    drive = float(compiled.motor_torques(omega).crank[0])
    needed = float((load + viscous * omega + compiled.speed_load(omega) + mean_laws(compiled, omega))[0])
    if np.isinf(fastest):
        range_ = f"from {slowest:.5g} rad/s up" if slowest else "at any speed"
    else:
        range_ = f"from {slowest:.5g} to {fastest:.5g} rad/s at φ = 0"
    return (
        f"no unique steady motion: {range_} the mean driving torque equals the mean load torque "
        f"({drive:.4g} against {needed:.4g} N m at the crank), and neither depends on the speed, so the "
        "machine keeps any of these speeds; add a load that grows with speed or a motor whose torque "
        "falls with it"
    )


def _runs_away(compiled: CompiledMachine, speed: float) -> str:
    load, viscous = mean_over_turn(compiled)
    omega = np.array([speed])
    drive = float(compiled.motor_torques(omega).crank[0])
    needed = float((load + viscous * omega + compiled.speed_load(omega) + mean_laws(compiled, omega))[0])
    return (
        f"no steady motion: at {speed:.4g} rad/s the driving torque still exceeds the mean load torque "
        f"({drive:.4g} against {needed:.4g} N m), so the machine accelerates without limit; "
        "add a load that grows with speed or a motor whose torque falls with it"
    )


def _what_lacks(compiled: CompiledMachine) -> str:
    load, viscous = mean_over_turn(compiled)
    omega = np.linspace(0.0, 1.5 * compiled.speed_guess, _SPEEDS + 1)[1:]
    drive = compiled.motor_torques(omega).crank
    resisting = load + viscous * omega + compiled.speed_load(omega) + mean_laws(compiled, omega)
    best = int(np.argmax(drive - resisting))
    if drive[best] < resisting[best]:
        return (
            f"no steady motion: at best, at {omega[best]:.4g} rad/s, the drive gives {drive[best]:.4g} N m "
            f"at the crank and the mean load needs {resisting[best]:.4g} N m; choose a larger motor or ratio"
        )
    return (
        "no steady motion: the drive balances the mean load, but not its peaks: the machine comes to rest "
        "within the revolution; add a flywheel or choose a larger motor"
    )
