"""What is known of a drive: reduction to the crank, steady motion, run-up, run-down.

| order | analysis | needs |
| --- | --- | --- |
| 1 | `reduction`, `constant_energy` | a mechanism that closes all round |
| 2 | `steady_state` | a motor |
| 3 | `run_up` | steady motion to settle to |
| 4 | `run_down` | a brake, and steady motion to begin with |

What fails becomes a finding, and what does not depend on it goes on.
"""

from __future__ import annotations

from dataclasses import dataclass

from linkwright.drive.cautions import cautions
from linkwright.drive.evenness import ConstantEnergy, constant_energy_of
from linkwright.drive.model.motor import ConstantSpeedMotor
from linkwright.drive.reduction import Reduction, has_inertia, reduction
from linkwright.drive.run_up import RunDown, RunUp, run_down, run_up, start_of
from linkwright.drive.steady_state import SteadyState, steady_state
from linkwright.drive.step_method import StepMotion, step_method
from linkwright.drive.transient import Transient, transient
from linkwright.kernel.findings import Findings
from linkwright.kernel.result import PlainRecord
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine

# Intervals of the revolution for all curves, a quarter of a degree: what the constant-energy limit and the
# run-up ask of the curves that they are given.
INTERVALS = 1440

# A run-up that failed is followed again for its curve alone: no line shows more than this.
_ATTEMPT_ACCURACY = 1e-6


@dataclass(frozen=True)
class DriveStudy(PlainRecord):
    """What is known of a machine's drive; None where there is nothing.

    Attributes
    ----------
    machine : Machine
    reduction, constant_energy, steady_state, run_up, run_down, step_method : Result or None
        Results by analysis.
    attempt : Transient or None
        The motion from the start to the stall, where the run-up fails on the way.
    warnings : tuple of str
        What its designer should know, in sentences.
    """

    machine: Machine
    reduction: Reduction | None = None
    constant_energy: ConstantEnergy | None = None
    steady_state: SteadyState | None = None
    run_up: RunUp | None = None
    run_down: RunDown | None = None
    step_method: StepMotion | None = None
    attempt: Transient | None = None
    warnings: tuple[str, ...] = ()


def drive_study(machine: Machine, findings: Findings, accuracy: float, step: float | None) -> DriveStudy:
    """What follows from bodies, loads and drive.

    `accuracy`: relative, of the steady speed; `step`: of the crank angle [rad] for the step method, None
    without it.
    """
    reduced = findings.of(reduction, machine, n=INTERVALS)
    if reduced is None:
        return DriveStudy(machine)
    # Without inertia at some angle there is no energy to stay constant.
    limit = constant_energy_of(reduced, compile_machine(machine).first()) if has_inertia(reduced) else None
    if not has_motor(machine):
        return DriveStudy(machine, reduced, limit, warnings=cautions(machine, reduced, None))
    steady = findings.of(steady_state, machine, accuracy=accuracy, n=INTERVALS)
    started, attempt = _run_up(machine, steady, findings)
    stopped = _run_down(machine, steady, findings) if steady and _has_brake(machine) else None
    stepped = findings.of(step_method, machine, step=step) if step is not None else None
    return DriveStudy(
        machine,
        reduced,
        limit,
        steady,
        started,
        stopped,
        stepped,
        attempt,
        warnings=cautions(machine, reduced, steady),
    )


def _run_down(machine: Machine, steady: SteadyState, findings: Findings) -> RunDown | None:
    """The run-down; what a self-locking gearbox does with the motor off is no fault of the machine."""
    locks = machine.drive is not None and machine.drive.gearbox.locks
    return (findings.beside_of if locks else findings.of)(run_down, machine, steady=steady)


def _run_up(
    machine: Machine, steady: SteadyState | None, findings: Findings
) -> tuple[RunUp | None, Transient | None]:
    """The run-up, or how far it comes."""
    if _keeps_speed(machine):
        return None, None
    if steady is None:
        # Without steady motion nothing says when it has run up, but it may be that it cannot even start.
        findings.of(start_of, machine)
        return None, _attempt(machine, findings)
    started = findings.of(run_up, machine, steady=steady)
    return started, None if started else _attempt(machine, findings)


def _attempt(machine: Machine, findings: Findings) -> Transient | None:
    """The motion from the start to the stall; None if it never moves or cannot be followed."""
    options = machine.run_up
    start = {"angle": options.angle_start, "speed": options.speed_start, "turns": options.turns_max}
    motion = findings.of(transient, machine, accuracy=_ATTEMPT_ACCURACY, **start)
    return motion if motion is not None and motion.turns > 0 else None


def has_motor(machine: Machine) -> bool:
    """Whether a motor drives the machine."""
    return machine.drive is not None and machine.drive.motor is not None


def _has_brake(machine: Machine) -> bool:
    return machine.drive is not None and machine.drive.brake is not None


def _keeps_speed(machine: Machine) -> bool:
    return machine.drive is not None and isinstance(machine.drive.motor, ConstantSpeedMotor)
