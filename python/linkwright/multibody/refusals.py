"""What a program of multibody dynamics cannot do, as problems of the machine file with their remedies."""

from __future__ import annotations

from collections.abc import Collection, Iterator

import numpy as np

from linkwright.drive.model.drive import Drive
from linkwright.kernel.errors import MachineError, Problem
from linkwright.kinetostatics.model import loads
from linkwright.kinetostatics.places import Scene
from linkwright.linkages.kinematics import kinematics_of
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine
from linkwright.machine.program.drive_line import drive_inertia
from linkwright.multibody.linear_laws import slide_joint
from linkwright.multibody.tree import Tree, is_plain, is_split

_LEAVE_OUT = "leave it out with --leave-out {name} and let the receiving program apply it"


def require_tree(machine: Machine) -> None:
    """Raise `MachineError` for a machine without a crank in proportion to the shaft, or with other parts."""
    problems = list(_parts(machine)) or list(_drivers(machine))
    if problems:
        raise MachineError(problems)


def require_guides(scene: Scene) -> None:
    """Raise `MachineError` if one body carries a guide and another turns it."""
    split = [pair for pair in scene.structure.pairs.values() if is_split(scene, pair)]
    if split:
        raise MachineError(
            [
                Problem(
                    "mechanism",
                    f"guide {pair.name} through a point of {pair.first}, which does not turn it",
                    "a guide on the body that carries its point",
                    'give the guide "on" with the name of that link',
                )
                for pair in split
            ]
        )


def _parts(machine: Machine) -> Iterator[Problem]:
    """Parts that are no bodies on a crankshaft."""
    expected = "a linkage with rigid links on a rigid driveline"
    if not machine.has_crank:
        yield Problem("mechanism", "none", expected)
        return
    if machine.twists:
        yield Problem("drive", "elastic shafts", expected, "leave out the stiffness of shafts and gearbox")
    for table in ("axes", "rod_string", "rod_rotator", "train"):
        if getattr(machine, table):
            yield Problem(table, "a table", expected, "leave it out")


def _drivers(machine: Machine) -> Iterator[Problem]:
    """Drivers that do not turn or move evenly with the crankshaft."""
    mechanism = machine.linkage
    expected = "cranks that turn with the shaft, and linear drivers with per_turn"
    remedy = "linkwright motion has positions, velocities and accelerations of its bodies as CSV"
    for name in machine.mechanism.cams:
        yield Problem(f"mechanism.cams.{name}", "a cam", expected, remedy)
    for table in ("cranks", "linear_drivers"):
        for name, driver in getattr(mechanism, table).items():
            if not is_plain(driver) and name not in machine.mechanism.cams:
                yield Problem(f"mechanism.{table}.{name}.law", "a law", expected, remedy)
    for name, cylinder in mechanism.cylinders.items():
        if cylinder.drives:
            yield Problem(f"mechanism.cylinders.{name}", "a cylinder that drives", expected, remedy)
    if not mechanism.cranks and not machine.mechanism.cams:
        yield Problem("mechanism.cranks", "none", "a crank, which is the joint of the drive", remedy)


def require_laws(tree: Tree, left_out: Collection[str], *, motor: bool) -> None:
    """Raise `MachineError` for loads, and a motor, that are no linear laws and are not left out."""
    machine = tree.scene.machine
    problems = list(_motor(machine.drive)) if motor and "motor" not in left_out else []
    for name, load in machine.all_loads.items():
        if name not in left_out and (found := _found(tree, load)):
            own = name.partition(".")[0]
            key = f"loads.{name}" if name in machine.loads else f"mechanism.cylinders.{own}"
            expected = "weight, a constant, a linear spring or damper, or dry friction of a joint with mass"
            problems.append(Problem(key, found, expected, _LEAVE_OUT.format(name=name)))
    if problems:
        raise MachineError(problems)


def _motor(drive: Drive | None) -> Iterator[Problem]:
    """A motor without a straight characteristic, or behind a gearbox with losses."""
    if drive is None or drive.motor is None:
        return
    line = drive.motor.polyline()
    if line is None or not (line[2] or len(line[0]) == 1):
        yield Problem(
            "drive.motor",
            f"the characteristic of a motor of the kind {drive.motor.kind}",
            "a constant torque, or a straight line over the speed",
            'give a constant speed, such as --speed "10 rad/s", or ' + _LEAVE_OUT.format(name="motor"),
        )
    if float(drive.gearbox.efficiency) != 1.0 or drive.gearbox.reverse not in (None, "same", 1.0):
        yield Problem(
            "drive.gearbox.efficiency",
            f"{float(drive.gearbox.efficiency):g}",
            "1: losses that depend on which side drives have no linear law",
            "set 1 and reduce the torque of the motor, or " + _LEAVE_OUT.format(name="motor"),
        )


def _found(tree: Tree, load: object) -> str:
    """What is wrong with a load; empty if it is a linear law."""
    scene = tree.scene
    match load:
        case loads.Spring() | loads.Damper():
            return "" if load.force is None else f"a {load.kind} with a curve"
        case loads.ConstantForce():
            is_own = load.along is None or scene.carrier(load.on) == load.along
            return "" if is_own else f"a force on {load.on} that turns with another link, {load.along}"
        case loads.TorsionalSpring():
            return _revolves(scene, load)
        case loads.DryFriction():
            return _dry(tree, load)
        case loads.Gravity() | loads.ConstantTorque() | loads.ViscousFriction():
            return ""
        case loads.TorsionalDamper():
            return ""
    return f"a load of the kind {getattr(load, 'kind', '')}"


def _dry(tree: Tree, load: loads.DryFriction) -> str:
    """Dry friction is a constraint of a joint, as soft as the mass that it acts on is small."""
    joint = slide_joint(tree, load.on)
    if load.torque is None and not joint:
        return "dry friction on a point"
    body = tree.joints()[joint] if load.torque is None else tree.bodies[load.on]
    is_shaft = body.joint == tree.crank or body.kind == "fixed"
    inertia = drive_inertia(tree.scene.machine.drive or Drive()) if is_shaft else 0.0
    return "" if body.mass or body.inertia or inertia else f"dry friction on {body.name}, which has no mass"


def _revolves(scene: Scene, load: loads.TorsionalSpring) -> str:
    """A torsional spring is linear as long as it is not wound by more than half a revolution."""
    compiled = compile_machine(scene.machine).first()
    names = [load.on] if load.against is None else [load.on, load.against]
    phi = float(scene.motion.crank_angle[0]) + np.linspace(0.0, 2 * np.pi, 361)
    links = kinematics_of(compiled, phi, [("links", name) for name in names]).links
    wound = links[load.on].angle - load.free_angle
    wound = wound - (links[load.against].angle if load.against is not None else 0.0)
    wound = wound[np.isfinite(wound)]
    first = np.arctan2(np.sin(wound[0]), np.cos(wound[0]))
    is_within = np.abs(wound - wound[0] + first).max() <= np.pi
    return "" if is_within else "a torsional spring wound by more than half a revolution"
