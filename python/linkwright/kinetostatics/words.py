"""What is taken for granted of a mechanism, its bodies and its loads: sentences for a report."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.kernel.reader.numbers import degrees, quantity
from linkwright.kinetostatics.model.body import Body
from linkwright.kinetostatics.model.loads.between import Damper, GasSpring, Spring, TorsionalSpring
from linkwright.kinetostatics.model.loads.force import DryFriction, FormulaLoad, Gravity, ViscousFriction
from linkwright.kinetostatics.model.loads.table import ForcePosition, TorqueAngle, TorqueSpeed, TorqueSwing
from linkwright.linkages.closure import is_screw
from linkwright.machine.machine import Machine

_LOADS = {
    DryFriction: "Dry friction has a constant magnitude and opposes the motion; at rest it holds up to this "
    "magnitude in either direction.",
    ViscousFriction: "Viscous friction is proportional to the speed.",
    ForcePosition: "A force over position is linear between the given points and constant outside them. It "
    "is positive against the motion, forward and back.",
    TorqueSwing: "A torque over the angle of a link is linear between the given angles and constant outside "
    "them. It is positive against the motion, forward and back.",
    TorqueAngle: "A load torque over the crank angle is linear between the given angles.",
    TorqueSpeed: "A load torque over the speed is linear between the given speeds and constant outside them.",
    Spring: "Springs have no mass; a force over the length is linear between the given lengths and constant "
    "outside them.",
    Damper: "Dampers between points have no mass; a force over the velocity is linear between the given "
    "velocities and constant outside them.",
    GasSpring: "Gas springs follow p Vⁿ = constant, without friction and atmospheric pressure.",
    TorsionalSpring: "Torsional springs are linear, within 180° of their free angle.",
    FormulaLoad: "A load given by a formula is in SI units; at rest it acts as at a vanishing speed.",
}


def load_assumptions(machine: Machine) -> Iterator[str]:
    """What is taken for granted of the mechanism, its bodies and its loads."""
    yield from _mechanism(machine)
    yield from _bodies(machine)
    yield from _loads(machine)


def _mechanism(machine: Machine) -> Iterator[str]:
    angle = "crank angle φ, which counts counter-clockwise from the x axis and"
    if is_screw(machine):
        angle = "angle φ of the drive, which"
    rigid = "Links" if machine.drive is not None and machine.drive.twists else "Links and shafts"
    yield (
        f"The machine has one degree of freedom, the {angle} increases in time. {rigid} are rigid. "
        "Joints have no clearance, and no friction except the given loads."
    )
    yield "Load torque M_r is positive where it opposes forward rotation."


def _bodies(machine: Machine) -> Iterator[str]:
    if any(_is_slender(body) for body in machine.bodies.values()):
        yield (
            "A body on a link with a mass, or a mass per length, but no moment of inertia is a uniform "
            "slender rod: centre of mass in the middle, m l²/12 about it."
        )
    if not machine.bodies:
        yield "No masses are given: only the drive has inertia."


def _is_slender(body: Body) -> bool:
    return body.mass_per_length is not None or (body.mass is not None and body.inertia is None)


def _loads(machine: Machine) -> Iterator[str]:
    kinds = {type(load) for load in machine.all_loads.values()}
    yield from (text for kind, text in _LOADS.items() if kind in kinds)
    for load in machine.all_loads.values():
        if isinstance(load, Gravity):
            way = degrees(load.direction)
            yield f"Gravity acts on all bodies, {quantity(load.acceleration, 'm/s²')} in the direction {way}."
    # Weights of rods, beam and counterbalance act on a pumping unit without a load of that kind.
    is_pumped = machine.pumping_unit is not None or machine.rod_string is not None
    if not is_pumped and not any(isinstance(load, Gravity) for load in machine.all_loads.values()):
        yield "Weight is neglected: the machine has no load of kind gravity."
