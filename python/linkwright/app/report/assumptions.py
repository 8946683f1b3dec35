"""What was taken for granted, as far as it applies to a machine: sentences for its report."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.app.study import Study
from linkwright.drive.model.drive import Drive
from linkwright.drive.model.motor import (
    ConstantSpeedMotor,
    ConstantTorqueMotor,
    DcMotor,
    InductionMotor,
    TableMotor,
)
from linkwright.drive.tables_in_time import methods_sentence
from linkwright.kernel.page.numbers import degrees, number, quantity
from linkwright.kinetostatics.model.body import Body
from linkwright.kinetostatics.model.loads.between import Damper, GasSpring, Spring, TorsionalSpring
from linkwright.kinetostatics.model.loads.force import DryFriction, FormulaLoad, Gravity, ViscousFriction
from linkwright.kinetostatics.model.loads.table import ForcePosition, TorqueAngle, TorqueSpeed, TorqueSwing
from linkwright.linkages.closure import is_screw
from linkwright.machine.machine import Machine
from linkwright.machine.program.drive_line import drive_inertia, reverse_factor

# Meshes that agree better than this agree to rounding.
_FINEST = 1e-15

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


def assumptions(study: Study) -> list[str]:
    """All that was taken for granted: sentences, from the mechanism to the methods."""
    return [*assumed_of(study.machine), *_methods(study)]


def assumed_of(machine: Machine) -> list[str]:
    """What was taken for granted of a machine, whatever is computed of it."""
    cut = [*_diagram(machine), *_topper(machine)]
    if machine.is_topper_alone or machine.is_diagram_alone:
        return cut
    sentences = [*cut, *_mechanism(machine), *_bodies(machine), *_loads(machine)]
    if machine.drive is not None:
        sentences += [*_drive(machine.drive), *_motor(machine.drive)]
    return sentences


def _diagram(machine: Machine) -> list[str]:
    if machine.turning_moment is None:
        return []
    from linkwright.turning.tables import ASSUMPTIONS

    return list(ASSUMPTIONS)


def _topper(machine: Machine) -> list[str]:
    if machine.topper is None:
        return []
    from linkwright.topping.tables.words import topper_assumptions

    return list(topper_assumptions(machine.topper))


def _mechanism(machine: Machine) -> Iterator[str]:
    angle = "crank angle φ, which counts counter-clockwise from the x axis and"
    if is_screw(machine):
        angle = "angle φ of the drive, which"
    yield (
        f"The machine has one degree of freedom, the {angle} increases in time. Links and shafts are rigid. "
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
    kinds = {type(load) for load in machine.loads.values()}
    yield from (text for kind, text in _LOADS.items() if kind in kinds)
    for load in machine.loads.values():
        if isinstance(load, Gravity):
            way = degrees(load.direction)
            yield f"Gravity acts on all bodies, {quantity(load.acceleration, 'm/s²')} in the direction {way}."
    if not any(isinstance(load, Gravity) for load in machine.loads.values()):
        yield "Weight is neglected: the machine has no load of kind gravity."


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
    back = number(float(reverse_factor(drive)))
    usual = ", the reciprocal of the efficiency" if gearbox.reverse is None else ", as given"
    yield (
        f"{forward}while the load drives the motor, η is replaced by "
        f"{back}{usual if gearbox.efficiency != 1 or gearbox.reverse is not None else ''}."
    )


def _motor(drive: Drive) -> Iterator[str]:
    match drive.motor:
        case InductionMotor() as motor:
            yield from _induction(motor)
        case DcMotor() as motor:
            yield "The motor torque falls linearly from standstill to the no-load speed."
            if motor.torque_max is not None:
                yield f"The limit of the current holds it within ±{quantity(motor.torque_max, 'N m')}."
        case TableMotor():
            yield "The motor torque is linear between the given speeds and constant outside them."
        case ConstantTorqueMotor():
            yield "The motor gives the same torque at any speed."
        case ConstantSpeedMotor():
            yield "The motor keeps its speed under any load; the driving torque follows from the motion."
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


def _methods(study: Study) -> Iterator[str]:
    """How the numbers were found."""
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
