"""What a machine can be seen to be unable to do without solving for its motion: the cheap part of a study.

| looked at | for | by |
| --- | --- | --- |
| mechanism | closes over the whole revolution, loads have values there | `require_turn` |
| mechanism | no law has a corner that moves masses, no part of it is idle | `require_turn`, `idle_parts` |
| drive | masses and loads repeat, the motor drives, the machine starts | `over_whole_cycle`, `start_of` |
| pumping unit | the crank rotates fully, ratings are not exceeded | `pumping_unit`, `unit_findings` |
| rotator | the lever does as its regime asks | `rod_rotator` |
| cams | undercut, crossed, locked, hollow, no room for a second follower | `cam_profile`, `cam_faults` |
| cams at a given speed | followers that leave them | `loaded_cam` |
| turning-moment diagram | driver and load balance over a cycle | `turning_moment` |
| knife of a topper | advances, over its field too; long enough for all | `knife_look`, `require_advance` |
| train, torsionally flexible driveline | has natural frequencies | `free_vibration` |

Each is the function that the study itself calls, or decides as that does at a part of its places, so what is
a finding here is one there, and the other way round. What takes solving, such as steady motion, forces and
vibration under torques, is left to the study.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from linkwright.drive.model.motor import ConstantSpeedMotor
from linkwright.drive.run_up import start_of
from linkwright.drive.sound_loads import require_same_turns, require_turn
from linkwright.kernel.errors import StartError
from linkwright.kernel.findings import Findings
from linkwright.linkages.closure import closure, is_screw
from linkwright.linkages.idle_parts import idle_parts
from linkwright.linkages.law_jumps import law_cautions
from linkwright.linkages.whole_cycle import over_whole_cycle
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine, compile_machine

if TYPE_CHECKING:
    from linkwright.torsion.modes.free import FreeVibration

# Speeds at which a motor's characteristic is looked at, up to one and a half times its speed without load.
_SPEEDS = 200


@dataclass(frozen=True)
class Soundness:
    """What was looked at, and what was found."""

    looked_at: tuple[str, ...]  # what was looked at, in words
    findings: tuple[str, ...]  # what the machine cannot do, in sentences
    warnings: tuple[str, ...]  # what its designer should know although it moves, in sentences


def soundness(machine: Machine) -> Soundness:
    """Look at all of a machine that can be judged without solving for its motion; with the findings."""
    findings = Findings()
    looked = [
        *_diagram(machine, findings),
        *_knife(machine, findings),
        *_mechanism(machine, findings),
        *_train(machine, findings),
    ]
    return Soundness(tuple(looked), findings.findings, findings.warnings)


def _diagram(machine: Machine, findings: Findings) -> Iterator[str]:
    if machine.turning_moment is None:
        return
    from linkwright.turning.diagram import turning_moment

    findings.of(turning_moment, machine, n=1)
    yield "turning-moment diagram: balance of driver and load over a cycle"


def _knife(machine: Machine, findings: Findings) -> Iterator[str]:
    described = machine.topper
    if described is None:
        return
    from linkwright.topping.cautions import knife_look
    from linkwright.topping.coverage import require_advance
    from linkwright.topping.edge import edges_of
    from linkwright.topping.roots import draw_roots

    looked = findings.of(lambda: tuple(knife_look(machine, described)))
    findings.add(looked or ())
    if looked is not None and described.field is not None:
        findings.of(lambda: require_advance(edges_of(machine, described), draw_roots(described)))
    yield "knife of the topper: advance of the edge, and its length for every head"


def _mechanism(machine: Machine, findings: Findings) -> Iterator[str]:
    if not machine.has_crank:
        return
    if machine.pumping_unit is not None:
        from linkwright.pumping.cautions import unit_findings
        from linkwright.pumping.unit import pumping_unit

        unit = findings.of(pumping_unit, machine)
        findings.add(unit_findings(unit) if unit is not None else ())
        yield "pumping unit: full rotation of its crank, ratings of gearbox and structure"
    if machine.rod_rotator is not None:
        from linkwright.pumping.rod_rotator import rod_rotator

        findings.of(rod_rotator, machine)
        yield "rod rotator: lengths, and motion in its regime"
    if machine.mechanism.cams:
        from linkwright.cam.dynamics.loaded import loaded_cam
        from linkwright.cam.study import sound_cams

        _, sound = sound_cams(machine, findings)
        yield "cams: undercut, self-intersection, pressure angle of 90°, concave parts, second followers"
        if sound and _keeps_its_speed(machine) and (machine.bodies or machine.loads):
            for cam in sound:
                findings.of(loaded_cam, machine, cam)
            yield "cams at constant speed: loss of contact"
    # The travel of a screw ends; without masses and loads nothing asks for a whole revolution.
    ends = is_screw(machine) and not (machine.bodies or machine.loads or machine.drive)
    compiled = (findings.beside_of if ends else findings.of)(require_turn, machine)
    if compiled is not None:
        findings.add(idle_parts(machine))
        findings.warn(law_cautions(machine))
    loads = "; loads are defined everywhere" if machine.loads else ""
    yield f"mechanism: closes over the {'travel' if is_screw(machine) else 'full revolution'}{loads}"
    if machine.drive is not None and machine.drive.motor is not None:
        if compiled is not None:
            findings.of(_require_drive, machine, compiled)
        elif closure(machine).turns_fully:
            findings.of(over_whole_cycle, compile_machine(machine))
        yield "drive: characteristic of the motor, start"


def _keeps_its_speed(machine: Machine) -> bool:
    """Whether the speed is known without solving: that of its motor, or the design speed without one."""
    drive = machine.drive
    if drive is None:
        return False
    return drive.speed is not None if drive.motor is None else isinstance(drive.motor, ConstantSpeedMotor)


def _require_drive(machine: Machine, compiled: CompiledMachine) -> None:
    """Raise unless the motor drives, the revolution repeats, and the machine moves from its start."""
    drive = machine.drive
    over_whole_cycle(compiled)
    require_same_turns(machine)
    if drive is None or isinstance(drive.motor, ConstantSpeedMotor):
        return
    speeds = np.linspace(0.0, 1.5 * compiled.speed_guess, _SPEEDS)
    torque = compiled.motor_torques(speeds).motor
    if not torque.max() > 0:
        raise StartError(
            f"the motor gives no driving torque at any speed up to {speeds[-1]:.4g} rad/s of the crank; give "
            "drive.motor a characteristic with torque in the direction of motion"
        )
    start_of(machine)


def _train(machine: Machine, findings: Findings) -> Iterator[str]:
    if machine.train is None and (machine.drive is None or not machine.drive.twists):
        return
    from linkwright.torsion.modes.free import free_vibration

    free = findings.of(free_vibration, machine)
    findings.add(_not_definite(free) if free else ())
    yield "train: connected, natural frequencies"


def _not_definite(free: FreeVibration) -> Iterator[str]:
    """Frequencies that are no numbers: stiffnesses or inertias beyond what can be computed with."""
    if not np.isfinite(free.natural_frequencies).all():
        yield (
            f"the train of {len(free.discs)} discs has no natural frequencies: its stiffnesses or inertias "
            "span too many orders of magnitude"
        )
