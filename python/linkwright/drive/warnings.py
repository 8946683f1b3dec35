"""What the designer of a machine should know although it runs: sentences with numbers.

Each function below examines one thing and yields a sentence if there is something to say about it.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from linkwright.drive.model.catalogue import KNOWN, OVERLOAD, estimated_inertia
from linkwright.drive.model.drive import Drive
from linkwright.drive.model.motor import ConstantSpeedMotor, DcMotor, InductionMotor
from linkwright.drive.reduction import Reduction, has_inertia
from linkwright.drive.steady_state import START_WORDS, SteadyState
from linkwright.kernel.reader.numbers import degrees
from linkwright.linkages.whole_cycle import first_revolution_words
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine
from linkwright.machine.program.drive_line import reverse_factor

# Share of the design speed by which the steady speed may differ before it is mentioned.
_SPEED_AGREES = 0.05

# Mains voltage may be 10 % low (EN 50160), and the torque of an induction motor falls with its square.
_LOW_VOLTAGE = 0.81

# Torques against the motion, and energies, that are a smaller share of the maximum are not worth a sentence.
_SMALL = 0.01

# Relative accuracy of the steady motion above which it is worth a sentence: results are shown with six
# digits.
_ACCURATE = 1e-6


def drive_warnings(machine: Machine, reduced: Reduction, steady: SteadyState | None) -> tuple[str, ...]:
    """All that should be known. Returns: sentences, empty if there is nothing to say."""
    drive = machine.drive
    sentences = [
        *_unloaded(machine),
        *_reduced(machine, reduced),
        *first_revolution_words(machine),
        *unjudged_limits(machine, torques_are_judged=drive is not None and drive.motor is not None),
    ]
    if (machine.axes or machine.has_mounted_mechanisms) and (drive is None or drive.motor is None):
        # Nothing but axes, or the motors of a train, move it: those are looked at instead.
        return tuple(sentences)
    if drive is None or drive.motor is None:
        return (*sentences, "The machine has no motor: steady motion and run-up are not computed.")
    sentences += _without_run_up(drive)
    sentences += _start_by_kloss(machine, drive)
    sentences += _start_by_line(drive)
    sentences += _without_rotor(drive)
    sentences += [*_least_breakdown(drive), *_least_start(drive)]
    if steady is not None:
        sentences += [*_cycle(steady), *_design_speed(drive, steady), *_overload(drive, steady)]
        sentences += [*_breakdown(drive, steady), *_generator(drive, steady), *_gear_gain(drive, steady)]
        sentences += _held(drive, steady)
    return tuple(sentences)


def unjudged_limits(machine: Machine, *, torques_are_judged: bool = False) -> Iterator[str]:
    """Limits of shafts that an analysis with rigid shafts does not judge.

    `torques_are_judged`: by the elastic motion beside it; the stresses are not.
    """
    drive = machine.drive
    shafts = {} if drive is None else {"motor_shaft": drive.motor_shaft, "crankshaft": drive.crankshaft}
    for name, shaft in shafts.items():
        if shaft is None or shaft.limit is None:
            continue
        if torques_are_judged:
            if shaft.limit.needs_section:
                yield f"The stresses of drive.{name}.limit are judged by `linkwright torsion`"
        else:
            yield (
                f"drive.{name}.limit is not judged here, where shafts are rigid: `linkwright torsion` judges "
                "it by the torque that twists the shaft"
            )


def _without_rotor(drive: Drive) -> Iterator[str]:
    motor = drive.motor
    assert motor is not None
    if isinstance(motor, InductionMotor) and motor.inertia_is_estimated:
        yield (
            f"The catalogue gives no rotor inertia for {motor.catalogue}: an estimate by similarity "
            f"with {KNOWN} is used, {motor.inertia:.3g} kg m²: give drive.motor.inertia."
        )
    elif motor.inertia or "inertia" in motor.model_fields_set or isinstance(motor, ConstantSpeedMotor):
        return
    elif isinstance(motor, InductionMotor) and motor.torque_rated is not None:
        estimate = estimated_inertia(float(motor.torque_rated))
        yield (
            f"{_NO_ROTOR}, and zero is used; similarity with {KNOWN} gives an estimate of {estimate:.3g} "
            "kg m²: give drive.motor.inertia."
        )
    elif motor.torque_rated is not None:
        yield f"{_NO_ROTOR}, and zero is used: give drive.motor.inertia."


_NO_ROTOR = "The file gives no rotor inertia for the motor"


def _least_breakdown(drive: Drive) -> Iterator[str]:
    motor = drive.motor
    if isinstance(motor, InductionMotor) and motor.breakdown_is_minimum:
        yield (
            f"The catalogue gives no breakdown torque for {motor.catalogue}: the minimum of IEC 60034-1 "
            f"is used, {OVERLOAD:g} times the rated torque, {motor.torque_breakdown:.4g} N m; most "
            f"motors have more: give drive.motor.torque_breakdown."
        )


def _least_start(drive: Drive) -> Iterator[str]:
    motor = drive.motor
    if isinstance(motor, InductionMotor) and motor.start_is_minimum:
        yield (
            f"The catalogue gives no starting torque for {motor.catalogue}: the minima of IEC 60034-12 for "
            f"design N are used, {motor.torque_start:.4g} N m at standstill and {motor.torque_pull_up:.4g} "
            "N m at pull-up, which is assumed at a seventh of the synchronous speed; most motors have more, "
            "so the computed run-up is conservative: give drive.motor.torque_start."
        )


def _unloaded(machine: Machine) -> Iterator[str]:
    if not machine.all_loads:
        yield "The machine has no loads: only its inertia resists."


def _reduced(machine: Machine, reduced: Reduction) -> Iterator[str]:
    # A law gives the motion whatever the inertia is, and without masses none is asked for.
    cranks = machine.linkage.cranks.values()
    is_free = machine.mechanism.cams or any(one.law is None and one.follows() is None for one in cranks)
    if is_free and reduced.inertia_max and not has_inertia(reduced):
        yield (
            "The reduced inertia falls to zero at a crank angle of "
            f"{degrees(reduced.inertia_min_angle)}: give the inertias "
            "of the drive; without them there is no constant-energy limit."
        )
    if reduced.torque_load_mean < -_SMALL * float(np.abs(reduced.torque_load).max()):
        yield (
            f"The loads drive the machine: their mean torque at the crank is {-reduced.torque_load_mean:.4g} "
            "N m in the direction of motion."
        )


def _without_run_up(drive: Drive) -> Iterator[str]:
    if isinstance(drive.motor, ConstantSpeedMotor):
        yield "A motor of constant speed has no run-up: it keeps its speed under any load."


def _start_by_kloss(machine: Machine, drive: Drive) -> Iterator[str]:
    """The simplified formula is low at standstill, where a real cage rotor has more torque."""
    motor = drive.motor
    if not isinstance(motor, InductionMotor) or motor.torque_start is not None:
        return
    torque = compile_machine(machine).motor_torques(0.0).motor[0]
    yield (
        f"The motor has no torque_start: by Kloss's formula it gives only {torque:.4g} N m at standstill, "
        f"{100 * torque / motor.torque_breakdown:.0f} % of its breakdown torque; real motors give more, so "
        "the computed run-up is conservative."
    )


# Share of its rated torque from which a start by the straight characteristic is worth a sentence: controllers
# allow currents of twice the rated one or less.
_START_SHARE = 2.0


def _start_by_line(drive: Drive) -> Iterator[str]:
    """The straight characteristic of a DC motor at standstill, which no controller allows."""
    motor = drive.motor
    if not isinstance(motor, DcMotor) or motor.torque_max is not None or motor.torque_rated is None:
        return
    assert motor.torque_stall is not None
    share = motor.torque_stall / motor.torque_rated
    if share > _START_SHARE:
        yield (
            f"By its straight characteristic the DC motor gives {motor.torque_stall:.4g} N m at standstill, "
            f"{share:.3g} times its rated torque; its controller limits the current, so the run-up takes "
            "longer: give drive.motor.torque_max."
        )


def _cycle(steady: SteadyState) -> Iterator[str]:
    if not steady.is_stable:
        yield (
            f"The steady motion is unstable: a small disturbance of the speed grows {steady.multiplier:.4g} "
            "times in each revolution, so the machine does not keep it."
        )
    yield from _others(steady)
    yield from _start_limits(steady)
    if steady.accuracy > _ACCURATE:
        yield (
            f"The steady motion is known to a relative accuracy of {steady.accuracy:.1e} only: the motor's "
            "torque is so steep over the speed that rounding limits it. The usual cause is a missing "
            "inertia of motor or crank."
        )


def _others(steady: SteadyState) -> Iterator[str]:
    """Other periodic motions: where the machine may stay, and which speed it must exceed."""
    for other in steady.others:
        range_ = (
            f"from {other.speed_min:.4g} to {other.speed_max:.4g} rad/s "
            f"({other.speed_mean_time:.4g} rad/s on average)"
        )
        faster = other.period < steady.period
        start = "slower" if faster else "faster"
        if other.multiplier == 1.0:
            yield (
                f"A motion {range_} bounds a range of periodic motions: within it neither drive nor loads "
                f"depend on the speed; the computed motion is reached from a {start} start."
            )
        elif other.is_stable:
            yield (
                f"Another steady motion is possible, {range_}: a machine that starts near it stays there; "
                f"the computed one is reached from a {start} start."
            )
        elif faster:
            yield f"From speeds above an unstable motion {range_} the machine does not settle."
        else:
            yield (
                f"There is an unstable motion {range_}: from lower speeds the machine does not reach the "
                "steady motion."
            )


def _start_limits(steady: SteadyState) -> Iterator[str]:
    has_range = any(other.multiplier == 1.0 and other.period < steady.period for other in steady.others)
    for limit in steady.start_limits:
        starts = f"speeds {limit.side} {limit.speed:.4g} rad/s at φ = 0°"
        if limit.outcome == "runs away" and has_range:
            yield (
                f"From {starts} the machine accelerates into the range of periodic motions; it reaches the "
                "steady motion from slower starts."
            )
        else:
            yield START_WORDS[limit.outcome].format(starts)


def _design_speed(drive: Drive, steady: SteadyState) -> Iterator[str]:
    if drive.speed is None:
        return
    off = steady.speed_mean_time / drive.speed - 1
    if abs(off) > _SPEED_AGREES:
        yield (
            f"The machine runs at {steady.speed_mean_time:.4g} rad/s on average, {100 * abs(off):.1f} % "
            f"{'above' if off > 0 else 'below'} the design speed of {drive.speed:.4g} rad/s (drive.speed)."
        )


def _overload(drive: Drive, steady: SteadyState) -> Iterator[str]:
    """Heating follows the rms torque, the energy bill the mean power."""
    motor = drive.motor
    assert motor is not None
    if motor.torque_rated is not None and steady.torque_motor_rms > motor.torque_rated:
        yield (
            f"The motor is overloaded: its torque has a root mean square of {steady.torque_motor_rms:.4g} "
            f"N m, {_percent_above(steady.torque_motor_rms, motor.torque_rated)} above the rated "
            f"{motor.torque_rated:.4g} N m; in continuous duty it overheats."
        )
    if motor.power_rated is not None and steady.power_motor_mean > motor.power_rated:
        yield (
            f"The motor is overloaded: it gives {steady.power_motor_mean:.4g} W on average, "
            f"{_percent_above(steady.power_motor_mean, motor.power_rated)} above the rated "
            f"{motor.power_rated:.4g} W."
        )


def _percent_above(value: float, limit: float) -> str:
    return f"{100 * (value / limit - 1):.3g} %"


def _breakdown(drive: Drive, steady: SteadyState) -> Iterator[str]:
    motor = drive.motor
    if not isinstance(motor, InductionMotor):
        return
    assert motor.speed_breakdown is not None
    assert motor.torque_breakdown is not None
    slowest = steady.speed_min * drive.gearbox.ratio
    share = steady.torque_motor_max / motor.torque_breakdown
    if slowest < motor.speed_breakdown:
        yield (
            f"The motor slows to {slowest:.4g} rad/s in each revolution, below its breakdown speed of "
            f"{motor.speed_breakdown:.4g} rad/s: the machine passes this point on "
            "stored kinetic energy alone."
        )
    elif share > _LOW_VOLTAGE:
        yield (
            f"The maximum motor torque, {steady.torque_motor_max:.4g} N m, is {100 * share:.0f} % of the "
            f"breakdown torque of {motor.torque_breakdown:.4g} N m; a 10 % voltage drop reduces "
            f"the breakdown torque to {_LOW_VOLTAGE * motor.torque_breakdown:.4g} N m."
        )


def _generator(drive: Drive, steady: SteadyState) -> Iterator[str]:
    least, most = steady.torque_motor_min, steady.torque_motor_max
    if least >= -_SMALL * max(abs(most), abs(least)):
        return
    time = np.interp(np.linspace(0, steady.period, 1000), steady.time, steady.torque_motor)
    share = 100 * float(np.mean(time < 0))
    yield (
        f"The load drives the motor during {share:.3g} % of the time{_beyond(drive, steady)}: it works as a "
        f"generator, with up to {-least:.4g} N m."
    )


def _beyond(drive: Drive, steady: SteadyState) -> str:
    fastest = steady.speed_max * drive.gearbox.ratio
    motor = drive.motor
    if motor is None or not motor.no_load_word:
        return ""
    limit = f"{motor.no_load_word} speed of {motor.speed_without_load:.4g} rad/s"
    return f", up to {fastest:.4g} rad/s, beyond its {limit}"


def _held(drive: Drive, steady: SteadyState) -> Iterator[str]:
    least = float(steady.torque_drive.min())
    if not drive.gearbox.locks or least >= -_SMALL * float(np.abs(steady.torque_drive).max()):
        return
    time = np.interp(np.linspace(0, steady.period, 1000), steady.time, steady.torque_drive)
    yield (
        f"The load drives the gearbox during {100 * float(np.mean(time < 0)):.3g} % of the time: it is "
        f"self-locking (drive.gearbox.reverse = 0) and holds up to {-least:.4g} N m at the crank, while the "
        "motor runs without torque."
    )


def _gear_gain(drive: Drive, steady: SteadyState) -> Iterator[str]:
    """A factor below 1 in reverse hands the motor more power than the crank gives."""
    factor = float(reverse_factor(drive.gearbox))
    driven = np.minimum(steady.torque_drive, 0.0)
    gained = -float(np.trapezoid(driven, steady.crank_angle)) * (1 / factor - 1)
    if gained > 0.1 * _SMALL * abs(steady.energy_drive):
        yield (
            f"While the load drives the motor, the gearbox factor {factor:.4g} (drive.gearbox.reverse) gives "
            f"the motor {gained:.4g} J per revolution more than the crank returns; a gearbox with losses has "
            "a factor above 1."
        )
