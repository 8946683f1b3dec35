r"""Derivatives of the largest forces by entries of the machine.

With the equilibrium A(x) x + b = 0 of all members at a crank angle, and the forces x known,

.. math:: A\,\mathrm dx = -(\mathrm db + \mathrm dA\,x)

for all entries at once. Motion, loads, A and b are those of `linkwright.kinetostatics.forces`, worked out a
second time in arrays of tangents, at the angles of the extremes alone. The derivative of an extreme among
given angles is that of the force at its angle; where two tie there is one on either side.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from linkwright.drive.gradient import gradient_along, solved_along
from linkwright.drive.model.motor import ConstantSpeedMotor
from linkwright.drive.steady_state import solved_state
from linkwright.kernel.arrays import Bools, Floats
from linkwright.kernel.numerics.extreme import TIE_OF_SOLVED, Kinks, occurs_at
from linkwright.kernel.numerics.implicit import solution_along
from linkwright.kernel.numerics.tangent import Tangent, lifted, primal
from linkwright.kinetostatics.applied import AppliedLoad, together
from linkwright.kinetostatics.collect import Collector
from linkwright.kinetostatics.equilibrium import Equilibrium, Solution
from linkwright.kinetostatics.forces import acting, solved
from linkwright.kinetostatics.motion import Motion, has_speed, motion_at, over_turns
from linkwright.kinetostatics.pairs import PairModel
from linkwright.kinetostatics.places import Scene
from linkwright.kinetostatics.wrench import Wrenches
from linkwright.linkages.closure import closure_of
from linkwright.linkages.kinematics import kinematics_along
from linkwright.linkages.model.structure import Structure, structure
from linkwright.linkages.whole_cycle import cycle_of, force_turns
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine
from linkwright.machine.program.core import SteadySolution
from linkwright.machine.tangents import Derivatives, Directions, directions, followed

# Relative accuracy of the steady motion, and its intervals per revolution: those of `forces`.
_ACCURACY, _N = 1e-9, 360

# A peak below this share of what forces and torques are made of is rounding.
_NOTHING = 1e-12

# Share of a speed to both sides at which the motor's torque is read for its slope.
_ASIDE = 1e-6

# An angle this near to a kink [rad] is on it; its two sides are looked at this far from it.
ON_KINK, _BESIDE = 1e-8, 5e-9


class _Entries(NamedTuple):
    """What varies: numbers of the program, and the description with tangents by the same entries."""

    program: Directions
    machine: Machine
    structure: Structure


def force_tangents(machine: Machine, variables: Sequence[str]) -> Derivatives:
    """Largest driving torque, shaking force and reactions in the motion of the machine, by some entries.

    Raises what `forces` raises.
    """
    entries = _entries(machine, variables)
    program = entries.program
    solution = _solution(machine, program)
    kinks = kinks_of(machine, program)
    motion, is_beside = _motion_and_sides(machine, kinks)
    scene = Scene(machine, motion)
    curves = {
        name: (curve[~is_beside], curve[is_beside]) for name, curve in _curves(_collected(scene)).items()
    }
    angles, beside = motion.crank_angle[~is_beside], motion.crank_angle[is_beside]
    sizes = np.abs(np.stack([curve for curve, _ in curves.values()]))
    peaks = dict(zip(curves, np.nanmax(sizes, axis=1).tolist(), strict=True))
    nothing = _rounding(scene, peaks)
    missing = {
        name: "it is zero within rounding error"
        for name, peak in peaks.items()
        if peak <= nothing["torque" if name.startswith("torque") else "force"]
    }
    at_peaks = zip(curves, np.nanargmax(sizes, axis=1).tolist(), strict=True)
    places = {name: place for name, place in at_peaks if name not in missing}
    if not places:
        return Derivatives(program.variables, {}, {}, missing, program.refused)
    at = angles[np.unique(list(places.values()))]
    along, lost, driving = _motion_along(machine, _there(machine, solution, motion, at), entries, solution)
    tangents = _curves(_collected(_SceneAlong(machine, along, entries)))
    if driving is not None:
        # Equilibrium makes the driving torque of torques of inertia, in a nearly neutral drive of some that
        # are a million times as large. It is that of the motor at its speed.
        tangents["torque_drive_max"] = Tangent(primal(tangents["torque_drive_max"]), driving)
    extremes, ties = {}, {}
    for name, place in places.items():
        (curve, sides), angle = curves[name], float(angles[place])
        tangent = tangents[name][int(np.searchsorted(at, angle))]
        moving = kinks.moved_at(angle, ON_KINK)
        larger = beside[np.abs(sides) > peaks[name] * (1.0 + TIE_OF_SOLVED)].tolist()
        for other in larger:
            moving = moving | kinks.moved_at(other, ON_KINK)
        # The extreme is that of the result to the last digit; the tangent's is worked out anew.
        at_kink = larger[0] if larger else angle
        extremes[name], why = kinks.extreme(float(curve[place]), tangent.d, at_kink, moving)
        if reason := "; ".join(filter(None, (tied(np.abs(curve), place, angles), why))):
            ties[name] = reason
    pairs = [name for name in (*extremes, *missing) if name.startswith("reaction_max.")]
    words = {name: f"maximum force of {name.partition('.')[2]}" for name in pairs}
    units = dict.fromkeys(pairs, "N")
    return Derivatives(program.variables, extremes, ties, missing, program.refused, lost, words, units)


class DrivesAlong(NamedTuple):
    """Drives of a machine at crank angles, with their derivatives by some entries."""

    program: Directions  # the entries that have some
    scene: Scene  # machine and motion
    forces: dict[str, Any]  # of drives and cams by name, (n,) each
    shaft_torques: dict[str, Any]  # the same referred to the shaft that all follow
    lost: dict[str, float]  # entries by which the motion is lost
    kinks: Kinks


def drives_along(machine: Machine, variables: Sequence[str], angles: Floats) -> DrivesAlong:
    """Drives of a machine at crank angles along its motion; at rest where nothing says how fast it is."""
    entries = _entries(machine, variables)
    program = entries.program
    solution = _solution(machine, program)
    if solution is None:
        speed = None if has_speed(machine) else 0.0
        motion = motion_at(machine, None, speed=speed, angles=angles)
    else:
        motion = _read(machine, solution, angles)
    along, lost, _ = _motion_along(machine, motion, entries, solution)
    scene = _SceneAlong(machine, along, entries)
    of = _collected(scene)
    return DrivesAlong(program, scene, of.drives(), of.shaft_torques(), lost, kinks_of(machine, program))


def unit_scene_along(machine: Machine, variables: Sequence[str], angles: Floats) -> Scene:
    """A machine at crank angles at unit speed, with derivatives by some entries that have some."""
    motion = Motion(angles, np.ones(len(angles)), np.zeros(len(angles)), angles)
    return _SceneAlong(machine, motion, _entries(machine, variables))


def unknowns_along(scene: Scene, models: list[PairModel], columns: Mapping[str, AppliedLoad]) -> Any:
    """Forces of pairs and drives under each of several loads alone, (n, unknowns, columns)."""
    listed = []
    for load in columns.values():
        system, found = solved(scene, models, {"": load})
        listed.append(_along(system, found, load).x[:, :, 0])
    return np.stack(listed, axis=-1)


def drive_torque_along(
    machine: Machine, variables: Sequence[str], angles: Floats
) -> tuple[Directions, Any, Kinks]:
    """Driving torque at crank angles at the design speed, (n,), with its derivatives by some entries.

    Beside them the entries that have some, and the kinks of the machine.
    """
    entries = _entries(machine, variables)
    program = entries.program
    motion = motion_at(machine, None, speed=machine.design_speed, angles=angles)
    along = _at_speed(motion, entries.machine.design_speed, len(program.variables))
    torque, _ = _collected(_SceneAlong(machine, along, entries)).drive_and_frame()
    return program, torque, kinks_of(machine, program)


def _entries(machine: Machine, variables: Sequence[str]) -> _Entries:
    """Entries by which both the program's numbers and the description can be followed."""
    program = directions(machine, variables)
    refused = dict(program.refused)
    known, (along, of) = followed(machine, program.variables, _described, refused)
    return _Entries(replace(program.only(known), refused=refused), along, of)


def _described(along: Machine) -> tuple[Machine, Structure]:
    """What forces take from the description: members and pairs; the laws of cams have to be followed, too."""
    for cam in along.mechanism.cams.values():
        assert cam.lift
    return along, structure(along.linkage)


_MOTION = ("crank_angle", "speed", "acceleration", "time")


def _motion_and_sides(machine: Machine, kinks: Kinks) -> tuple[Motion, Bools]:
    """The motion of `forces`, and both sides of the kinks that lie on its angles; which angles are sides."""
    has_motor = machine.drive is not None and machine.drive.motor is not None
    state, solution = solved_state(machine, _ACCURACY, _N) if has_motor else (None, None)
    if state is None:
        motion = motion_at(machine, None)
    else:
        motion = over_turns(state, force_turns(compile_machine(machine)))
    moved = kinks.moved_near(motion.crank_angle, ON_KINK)
    beside = np.sort(np.mod([kink + side for kink in moved for side in (-_BESIDE, _BESIDE)], kinks.cycle))
    if not len(beside):
        return motion, np.zeros(len(motion.crank_angle), dtype=bool)
    sides = _there(machine, solution, motion, beside)
    order = np.argsort(np.concatenate([motion.crank_angle, beside]), kind="stable")
    both = (np.concatenate([getattr(motion, name), getattr(sides, name)])[order] for name in _MOTION)
    return Motion(*both), order >= len(motion.crank_angle)


def _solution(machine: Machine, program: Directions) -> SteadySolution | None:
    """A solution that has derivatives; None where nothing is solved, since the speed is given."""
    motor = None if machine.drive is None else machine.drive.motor
    if motor is None or isinstance(motor, ConstantSpeedMotor):
        return None
    # A steep motor makes much torque of little speed: derivatives are those of a finer mesh.
    return solved_along(machine, program)[1]


def _there(machine: Machine, solution: SteadySolution | None, motion: Motion, angles: Floats) -> Motion:
    """A motion that is solved, or at the speed of another one, at some crank angles."""
    if solution is None:
        return motion_at(machine, None, speed=float(motion.speed[0]), angles=angles)
    return _read(machine, solution, angles)


def _read(machine: Machine, solution: SteadySolution, angles: Floats) -> Motion:
    """The motion that derivatives are of: what is left of large torques needs both from one mesh."""
    read = solution.curves(_of_speed(machine, angles))
    return Motion(angles, read.speed, read.acceleration, read.time)


def _of_speed(machine: Machine, angles: Floats) -> Floats:
    """Crank angles within the cycle of the speed; that of forces may be several of these."""
    cycle = cycle_of(machine)
    rest = np.mod(angles, cycle)
    return np.where((rest == 0.0) & (angles > 0.0), cycle, rest)


def _rounding(scene: Scene, peaks: Mapping[str, float]) -> dict[str, float]:
    """Torque [N m] and force [N] that are rounding in a motion of a machine."""
    # They follow the acceleration, which is what the torque of the motor and that of the loads leave: the
    # torque is known to rounding of the speed times its slope, however small it is.
    force = max(peak for name, peak in peaks.items() if "torque" not in name)
    torque = max(force * scene.size, peaks["torque_drive_max"], _motor_change(scene))
    return {"torque": _NOTHING * torque, "force": _NOTHING * torque / scene.size}


def _motor_change(scene: Scene) -> float:
    """By how much the motor's torque at the crank would change for a speed doubled, by its slope [N m]."""
    motor = None if scene.machine.drive is None else scene.machine.drive.motor
    if motor is None or isinstance(motor, ConstantSpeedMotor):
        return 0.0
    speeds = np.array([np.nanmin(scene.motion.speed), np.nanmax(scene.motion.speed)])
    above, below = (
        compile_machine(scene.machine).motor_torques(speeds * (1 + by)).crank for by in (_ASIDE, -_ASIDE)
    )
    return float(np.abs(above - below).max()) / (2 * _ASIDE)


def tied(size: Floats, place: int, angles: Floats) -> str:
    """Where a curve is as large as at its extreme; empty if nowhere."""
    span = float(size[place] - np.nanmin(size))
    others = angles[size >= size[place] - TIE_OF_SOLVED * span]
    turn = round(float(angles[-1] - angles[0]) / (2 * np.pi)) * 2 * np.pi
    away = np.abs(others - angles[place])
    apart = others[np.minimum(away, np.abs(away - turn)) > ON_KINK]
    if not len(apart) or span == 0.0:
        return "" if span else "it is the same at all angles"
    return occurs_at((angles[place], apart[0]))


def kinks_of(machine: Machine, program: Directions) -> Kinks:
    """Kinks of a machine over the turns of its forces."""
    compiled = compile_machine(machine)
    if closure_of(compiled).turns_fully:
        compiled = compiled.over_turns(force_turns(compiled))
    return Kinks.of(compiled, program)


def _motion_along(
    machine: Machine, motion: Motion, entries: _Entries, solution: SteadySolution | None
) -> tuple[Motion, dict[str, float], Floats | None]:
    """The motion with derivatives, entries by which they are lost, those of the driving torque if solved."""
    program, drive = entries.program, entries.machine.drive
    if solution is not None:
        gradient = gradient_along(machine, solution, program)
        curves = gradient.curves(_of_speed(machine, motion.crank_angle))
        followed: dict[str, Any] = {
            name: Tangent(getattr(motion, name), getattr(curves, name)) for name in _MOTION[1:]
        }
        return replace(motion, **followed), program.lost(gradient.lost), curves.torque_drive
    speed: Any = entries.machine.design_speed or 0.0
    if drive is not None and isinstance(drive.motor, ConstantSpeedMotor):
        speed = drive.motor.speed / drive.gearbox.ratio
    return _at_speed(motion, speed, len(program.variables)), {}, None


def _at_speed(motion: Motion, speed: Any, n: int) -> Motion:
    """A motion at a given speed, with derivatives by n variables."""
    phi: Any = motion.crank_angle
    speeds: Any = lifted(np.ones(len(phi)), n) * speed
    time: Any = phi / speeds if motion.speed.any() else lifted(phi, n)
    acceleration: Any = lifted(motion.acceleration, n)
    return replace(motion, speed=speeds, acceleration=acceleration, time=time)


class _SceneAlong(Scene):
    """A machine at the angles of a motion, with derivatives of all that is worked out.

    `motion`: the motion with its derivatives.
    """

    def __init__(self, machine: Machine, motion: Motion, entries: _Entries) -> None:
        self.n_variables = len(entries.program.variables)
        super().__init__(machine, motion)
        self.kinematics = kinematics_along(machine, self.kinematics.angles, entries.program.values)
        self.machine, self.structure = entries.machine, entries.structure
        self.mechanism = self.machine.linkage
        self.links = self.mechanism.links()

    def zeros(self, *shape: int) -> Any:
        """An array to be filled with what follows from the machine."""
        return Tangent(np.zeros(shape), np.zeros((*shape, self.n_variables)))


def _collected(scene: Scene) -> Collector:
    """The forces of a scene, with derivatives where it has some."""
    models, sources = acting(scene, {})
    columns = {"": together(scene, sources.values())}
    system, found = solved(scene, models, columns)
    if isinstance(scene, _SceneAlong):
        found = _along(system, found, columns[""])
    return Collector(scene, models, sources, columns, found)


def _curves(of: Collector) -> dict[str, Any]:
    torque, frame = of.drive_and_frame()
    curves = {"torque_drive_max": torque, "shaking_force_max": np.hypot(frame[:, 0], frame[:, 1])}
    reactions = of.reactions().items()
    return curves | {f"reaction_max.{name}": np.hypot(force[:, 0], force[:, 1]) for name, force in reactions}


def _along(system: Equilibrium, found: Solution, load: AppliedLoad) -> Solution:
    """The unknowns with their derivatives, A dx = −(db + dA x)."""
    x = found.x.sum(axis=-1)
    # The extra forces are homogeneous of degree one: slopes times x, with x held.
    slopes = system.slopes_along(x)
    left = Wrenches(load.wrenches.scene).add(load.wrenches)
    for model, span in zip(system.models, system.spans, strict=True):
        for unknown, force in zip(model.unknowns, x[:, span].T, strict=True):
            left.add(unknown, force)
        if model.is_nonlinear and model.extra is not None:
            left.add(model.extra, (slopes[:, span] * x[:, span]).sum(axis=-1))
    change: Any = system.equations(left.values)
    size, usable = system.column_scale, ~(found.singular | found.locked)
    d = np.full(change.d.shape, np.nan)
    d[usable] = (
        solution_along(x[usable], change[usable], system.matrix(primal(slopes))[usable]).d * size[:, None]
    )
    followed: Any = Tangent(x, d)
    return replace(found, x=followed[:, :, None], slopes=slopes)
