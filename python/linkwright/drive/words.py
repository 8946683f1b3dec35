"""What a report says of a drive beside its numbers: formulas with their sources, and assumptions."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.drive.model.drive import Drive
from linkwright.drive.model.motor import (
    InductionMotor,
    Motor,
)
from linkwright.drive.tables_in_time import methods_sentence
from linkwright.kernel.page.formulas import Formula
from linkwright.kernel.reader.numbers import number, quantity
from linkwright.machine.analysis import Results
from linkwright.machine.machine import Machine
from linkwright.machine.program.drive_line import drive_inertia, reverse_factor

_PAPER = (
    "Paper 1: “Аналіз нерівномірності руху приводних механізмів машин роликового формування” (Analysis of "
    "the unevenness of motion of the drive mechanisms of roller-forming machines)"
)

_KLOSS_1909 = "M. Kloss, Drehmoment und Schlüpfung des Drehstrommotors, Archiv für Elektrotechnik, 1909"

# Meshes that agree better than this agree to rounding.
_FINEST = 1e-15

_MOTION = Formula(
    "Motion of the machine, reduced to the crank",
    "J ω frac(d ω|d φ) + frac(1|2) ω^2 frac(d J|d φ) = M_d − M_r",
    "paper 1 (1)",
)
_INERTIA = Formula(
    "Reduced inertia, over all bodies and the drive",
    "J = J_0 + Σ ( m |p′|^2 + J_S ψ′^2 )",
    "paper 1 (10), for any linkage",
)
_LOAD = Formula(
    "Reduced torque of all forces and torques",
    "M_r = − Σ F · p′ − Σ M ψ′",
    "paper 1 (5), for any linkage",
)
_KLOSS = Formula(
    "Torque of an induction motor over its slip",
    "M = frac(2 M_k|s / s_k + s_k / s) , s = frac(ω_0 − ω_m|ω_0)",
    "Kloss 1909; paper 1 (8)",
)
_GEARBOX = Formula("Driving torque at the crank, behind the gearbox", "M_d = M i η", "paper 1 (9)")
_UNEVENNESS = Formula("Coefficient of speed fluctuation", "δ = frac(ω_max − ω_min|ω_mean)", "paper 1 (13)")
_DYNAMISM = Formula("Dynamic factor", "H = frac(∣ε∣_max|ω_mean^2)", "paper 1 (14)")
_COEFFICIENT = Formula("Combined non-uniformity index", "k_p = δ^2 + H", "paper 1 (15)")
_MEANS = Formula(
    "Mean speed, of the extremes or over time",
    "ω_mean = frac(ω_max + ω_min|2) , ω_mean = frac(2 π|T)",
    "paper 1 takes the first",
)
_LIMIT = Formula(
    "Constant-energy limit: motor and loads switched off",
    "ω ∝ frac(1|root(J)) , ε = − frac(ω^2|2 J) frac(d J|d φ)",
    "(1) without torques",
)
_STEPS = Formula(
    "Step method",
    "ω_k+1 = frac(( M_d − M_r ) Δφ|J_k ω_k) + frac(3 J_k − J_k+1|2 J_k) ω_k",
    "Baranov; paper 1 (4)",
)


def drive_formulas(study: Results) -> list[Formula]:
    """The formulas of a report, from the motion to its measures."""
    motor = study.machine.drive.motor if study.machine.drive is not None else None
    needed = [_MOTION, _INERTIA, _LOAD]
    needed += [_KLOSS] if isinstance(motor, InductionMotor) else []
    needed += [_GEARBOX, _UNEVENNESS, _DYNAMISM, _COEFFICIENT, _MEANS] if motor is not None else []
    return [*needed, _LIMIT, *([_STEPS] if study.step_method is not None else [])]


def drive_papers(machine: Machine) -> tuple[str, ...]:
    """The papers that formulas are from."""
    motor = None if machine.drive is None else machine.drive.motor
    return (_PAPER, _KLOSS_1909) if isinstance(motor, InductionMotor) else (_PAPER,)


def drive_assumptions(study: Results) -> Iterator[str]:
    """What is taken for granted of motor and gearbox, and how the numbers were found."""
    drive = study.machine.drive
    if drive is not None:
        yield from _drive(drive)
        yield from _motor(drive)
    yield from _methods(study)


def _drive(drive: Drive) -> Iterator[str]:
    yield (
        "Motor, coupling, brake, gearbox and flywheel have a moment of inertia of "
        f"{quantity(float(drive_inertia(drive)), 'kg m²')}, referred to the crank; inertias at the motor "
        "shaft are multiplied by the square of the ratio."
    )
    if drive.motor is None:
        return
    gearbox = drive.gearbox
    forward = (
        f"Gearbox: M_d = M i η while the motor drives, with i = {number(gearbox.ratio)} and "
        f"η = {number(gearbox.efficiency)}; "
    )
    if gearbox.locks:
        yield (
            f"{forward}it is self-locking: it holds any load that drives the crank, and none reaches the "
            "motor."
        )
        return
    back = number(float(reverse_factor(drive.gearbox)))
    usual = ", the reciprocal of the efficiency" if gearbox.reverse is None else ", as given"
    yield (
        f"{forward}while the load drives the motor, η is replaced by "
        f"{back}{usual if gearbox.efficiency != 1 or gearbox.reverse is not None else ''}."
    )


def _motor(drive: Drive) -> Iterator[str]:
    match drive.motor:
        case InductionMotor() as motor:
            yield from _induction(motor)
        case Motor() as motor:
            yield motor.sentence
            if (most := getattr(motor, "torque_max", None)) is not None:
                yield f"The limit of the current holds it within ±{quantity(most, 'N m')}."
    if drive.motor is not None:
        yield "The motor follows its static characteristic, without electrical transients."


def _induction(motor: InductionMotor) -> Iterator[str]:
    ratio = number(motor.resistance_ratio)
    form = "simplified formula" if motor.resistance_ratio == 0 else f"formula with R₁/R₂′ = {ratio}"
    yield f"The motor's torque follows Kloss's {form} from breakdown to beyond the synchronous speed."
    if "speed_breakdown" not in motor.model_fields_set:
        yield "The breakdown speed is the one for which Kloss's formula passes through the rated point."
    if motor.torque_start is None:
        yield "Below breakdown the formula applies down to standstill, where it underestimates real motors."
    else:
        points = "the starting, the pull-up" if motor.torque_pull_up is not None else "the starting"
        yield f"Below breakdown a smooth curve passes through {points} and the breakdown torque."


def _methods(study: Results) -> Iterator[str]:
    steady = study.steady_state
    if steady is not None and steady.method == "collocation":
        difference = number(max(steady.accuracy, _FINEST), 1)
        yield (
            "Steady motion is the periodic solution, by Newton's method on the revolution with "
            f"{steady.steps} steps, each compared with two steps of half its length: relative error "
            f"{difference}. Curves have {len(steady.crank_angle)} points; extremes, work and "
            "root mean squares do not depend on them."
        )
    if study.run_up is not None:
        yield f"The run-up is integrated in time: {methods_sentence(study.run_up.motion)}."
