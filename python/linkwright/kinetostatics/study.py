"""Forces in the study of a machine, and contacts that are lost in its run-up and run-down."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from linkwright.drive.steady_state import SteadyState
from linkwright.drive.study import has_motor
from linkwright.kernel.findings import Findings
from linkwright.kinetostatics.collect import LEAVES
from linkwright.kinetostatics.contact_in_time import contact_losses
from linkwright.kinetostatics.forces import forces
from linkwright.kinetostatics.motion import Motion
from linkwright.kinetostatics.result import Forces
from linkwright.machine.analysis import Results
from linkwright.machine.machine import Machine

# Every how many angles of the steady motion: a degree. No line shows more, and four times as many take as
# much time as all the rest.
_EVERY = 4


def made_forces(known: Results, findings: Findings) -> Forces | None:
    """Forces along the steady motion; angles without an answer are no fault of the motion, but warnings."""
    machine, steady = known.machine, known.steady_state
    if steady is None:
        # Axes need no motor at the crankshaft, which is a virtual master.
        at_speed = bool(machine.axes) and machine.design_speed is not None and not has_motor(machine)
        return findings.beside_of(forces, machine) if at_speed else None
    return findings.beside_of(_forces, machine, steady)


def _forces(machine: Machine, steady: SteadyState) -> Forces:
    curves = (steady.crank_angle, steady.speed, steady.acceleration, steady.time)
    acting = forces(machine, Motion(*(curve[::_EVERY] for curve in curves)))
    return replace(acting, findings=tuple(text for text in acting.findings if not text.startswith(LEAVES)))


def look_for_losses(known: Results, findings: Findings) -> None:
    """Followers and cables that lose contact in the run-up or run-down, though not in steady motion."""
    floating = {cam.name for cam in known.each("cam_force") if cam.force_min < 0}
    for what, motion in (("run-up", known.run_up), ("run-down", known.run_down)):
        losses = findings.beside_of(contact_losses, known.machine, motion.motion) if motion else None
        lost = [loss for loss in losses or () if not (loss.kind == "cam" and loss.name in floating)]
        findings.about(f"{what}: ").add(loss.sentence() for loss in lost)


def loads_summary(machine: Machine) -> Iterator[tuple[str, str]]:
    """Names of the bodies, and of the loads with their kinds."""
    yield "bodies", ", ".join(machine.bodies)
    kinds = ((name, load.kind.replace("_", " ")) for name, load in machine.loads.items())
    yield "loads", ", ".join(f"{name} ({kind})" for name, kind in kinds)
