"""The drive in the study of a machine: reduction to the crank, steady motion, run-up, run-down.

| order | analysis | needs |
| --- | --- | --- |
| 1 | `reduction`, `constant_energy` | a mechanism that closes all round |
| 2 | `steady_state` | a motor |
| 3 | `run_up` | steady motion to settle to |
| 4 | `run_down` | a brake, and steady motion to begin with |

What fails becomes a finding, and what does not depend on it goes on.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

import numpy as np

from linkwright.drive.cycle_motion import CycleMotion, cycle_motion_of
from linkwright.drive.evenness import ConstantEnergy, constant_energy_of
from linkwright.drive.load_checks import require_same_turns, require_turn
from linkwright.drive.model.motor import ConstantSpeedMotor
from linkwright.drive.reduction import Reduction, has_inertia, reduction
from linkwright.drive.run_up import RunDown, RunUp, run_down, run_up, start_of
from linkwright.drive.steady_state import SteadyState, steady_state
from linkwright.drive.step_method import StepMotion, step_method
from linkwright.drive.transient import Transient, transient
from linkwright.kernel.errors import StartError
from linkwright.kernel.findings import Findings
from linkwright.kernel.reader.numbers import quantity
from linkwright.linkages.closure import closure, is_screw
from linkwright.linkages.idle_parts import idle_parts
from linkwright.linkages.law_jumps import law_warnings
from linkwright.linkages.whole_cycle import over_whole_cycle
from linkwright.machine.analysis import Results
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine, compile_machine
from linkwright.machine.program.drive_line import drive_inertia

# Intervals of the revolution for all curves, a quarter of a degree: what the constant-energy limit and the
# run-up ask of the curves that they are given.
INTERVALS = 1440

# A run-up that failed is followed again for its curve alone: no line shows more than this.
_ATTEMPT_ACCURACY = 1e-6

# Speeds at which a motor's characteristic is examined, up to one and a half times its speed without load.
_SPEEDS = 200


def made_reduction(known: Results, findings: Findings) -> Reduction | None:
    """Reduced inertia and load; None where nothing but motion can be computed."""
    machine = known.machine
    if machine.axes and not has_motor(machine):
        # The crankshaft is a virtual master, on which nothing acts.
        findings.of(require_turn, machine)
        return None
    if not (has_mass(machine) or has_motor(machine)):
        # The travel of a screw ends, which is no fault of it.
        (findings.beside_of if is_screw(machine) else findings.of)(require_turn, machine)
        if machine.pumping_unit is None:
            findings.warn(["The machine has no masses, loads or motor: only its motion is computed."])
        return None
    return findings.of(reduction, machine, n=INTERVALS)


def has_mass(machine: Machine) -> bool:
    """Whether there are masses or loads, a drive with inertia among them."""
    inertia = 0.0 if machine.drive is None else drive_inertia(machine.drive)
    return bool(machine.bodies or machine.all_loads or inertia)


def made_constant_energy(known: Results, findings: Findings) -> ConstantEnergy | None:
    """Speed fluctuation at constant energy; without inertia at some angle there is no energy to stay so."""
    reduced = known.reduction
    if reduced is None or not has_inertia(reduced):
        return None
    return constant_energy_of(reduced, compile_machine(known.machine).first())


def made_steady_state(known: Results, findings: Findings) -> SteadyState | None:
    """Steady motion under a motor."""
    if known.reduction is None or not has_motor(known.machine):
        return None
    return findings.of(steady_state, known.machine, accuracy=known.accuracy, n=INTERVALS)


def made_step_method(known: Results, findings: Findings) -> StepMotion | None:
    """The published step method, if it is asked for."""
    if known.step is None or known.reduction is None or not has_motor(known.machine):
        return None
    return findings.of(step_method, known.machine, step=known.step)


def made_run_up(known: Results, findings: Findings) -> RunUp | None:
    """The run-up; where it fails, the `attempt` is kept."""
    machine, steady = known.machine, known.steady_state
    if known.reduction is None or not has_motor(machine) or _keeps_speed(machine):
        return None
    started = findings.of(run_up, machine, steady=steady) if steady is not None else None
    if steady is None:
        # Without steady motion nothing says when it has run up, but it may be that it cannot even start.
        findings.of(start_of, machine)
    if started is None:
        known.attempt = _attempt(machine, findings)
    return started


def _attempt(machine: Machine, findings: Findings) -> Transient | None:
    options = machine.run_up
    start = {"angle": options.angle_start, "speed": options.speed_start, "turns": options.turns_max}
    motion = findings.of(transient, machine, accuracy=_ATTEMPT_ACCURACY, **start)
    return motion if motion is not None and motion.turns > 0 else None


def made_run_down(known: Results, findings: Findings) -> RunDown | None:
    """The run-down with a brake; what a self-locking gearbox does with the motor off is no fault."""
    steady, drive = known.steady_state, known.machine.drive
    if steady is None or drive is None or drive.brake is None:
        return None
    return (findings.beside_of if drive.gearbox.locks else findings.of)(
        run_down, known.machine, steady=steady
    )


def made_motion(known: Results, findings: Findings) -> Callable[[], CycleMotion] | None:
    """Motion of every point, link and slide over the cycle, computed when it is first asked for."""
    if known.linkage is None:
        return None
    return partial(_motion, known)


def _motion(known: Results) -> CycleMotion:
    return cycle_motion_of(known.machine, known.linkage, known.steady_state, known.accuracy)


def check_drive(machine: Machine, findings: Findings) -> Iterator[str]:
    """Whether the mechanism closes, its loads have values, and the motor drives it from its start."""
    # The travel of a screw ends; without masses and loads nothing asks for a whole revolution.
    ends = is_screw(machine) and not (machine.bodies or machine.all_loads or machine.drive)
    compiled = (findings.beside_of if ends else findings.of)(require_turn, machine)
    if compiled is not None:
        findings.add(idle_parts(machine))
        findings.warn(law_warnings(machine))
    loads = "; loads are defined everywhere" if machine.all_loads else ""
    closes = "closure" if compiled is None else "closes"
    yield f"mechanism: {closes} over the {'travel' if is_screw(machine) else 'full revolution'}{loads}"
    if has_motor(machine):
        if compiled is not None:
            findings.of(_require_drive, machine, compiled)
        elif closure(machine).turns_fully:
            findings.of(over_whole_cycle, compile_machine(machine))
        yield "drive: characteristic of the motor, start"


def _require_drive(machine: Machine, compiled: CompiledMachine) -> None:
    over_whole_cycle(compiled)
    require_same_turns(machine)
    if _keeps_speed(machine):
        return
    speeds = np.linspace(0.0, 1.5 * compiled.speed_guess, _SPEEDS)
    torque = compiled.motor_torques(speeds).motor
    if not torque.max() > 0:
        raise StartError(
            f"the motor gives no driving torque at any speed up to {speeds[-1]:.4g} rad/s of the crank; give "
            "drive.motor a characteristic with torque in the direction of motion"
        )
    start_of(machine)


def drive_summary(machine: Machine) -> Iterator[tuple[str, str]]:
    """Kind of the motor, with its rated power and the ratio of the gearbox."""
    if machine.drive is None or machine.drive.motor is None:
        yield "motor", "none"
        return
    motor, ratio = machine.drive.motor, machine.drive.gearbox.ratio
    power = f", {quantity(motor.power_rated, 'W', usual='kW')}" if motor.power_rated else ""
    yield "motor", f"{motor.kind.replace('_', ' ')}{power}, ratio {ratio:.6g}"


def has_motor(machine: Machine) -> bool:
    """Whether a motor drives the machine."""
    return machine.drive is not None and machine.drive.motor is not None


def _keeps_speed(machine: Machine) -> bool:
    return machine.drive is not None and isinstance(machine.drive.motor, ConstantSpeedMotor)
