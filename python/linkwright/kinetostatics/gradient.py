r"""Derivatives of the largest forces by entries of the machine.

With the equilibrium A(x) x + b = 0 of all members at a crank angle, and the forces x known,

.. math:: A\,\mathrm dx = -(\mathrm db + \mathrm dA\,x)

for all entries at once. Motion, loads, A and b are those of `linkwright.kinetostatics.forces`, worked out a
second time in arrays of tangents, at the angles of the extremes alone. The derivative of an extreme among
given angles is that of the force at its angle; where two tie there is one on either side.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from linkwright.drive.gradient import solved_along
from linkwright.drive.model.motor import ConstantSpeedMotor
from linkwright.drive.steady_state import SteadyState, solved_state
from linkwright.kernel.arrays import Bools, Floats
from linkwright.kernel.numerics.tangent import Tangent
from linkwright.kernel.numerics.tangent_array import TangentArray, lifted
from linkwright.kinetostatics.applied import together
from linkwright.kinetostatics.collect import Collector
from linkwright.kinetostatics.equilibrium import Equilibrium, Solution
from linkwright.kinetostatics.forces import acting, equilibrium, forces, solved
from linkwright.kinetostatics.motion import Motion
from linkwright.kinetostatics.pairs import with_pulls
from linkwright.kinetostatics.places import Scene
from linkwright.kinetostatics.result import Forces
from linkwright.linkages.closure import over_whole_cycle
from linkwright.linkages.kinematics import kinematics_along
from linkwright.linkages.model.structure import structure
from linkwright.machine.address import get
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine
from linkwright.machine.program.core import SteadySolution
from linkwright.machine.tangents import Derivatives, Directions, directions, followed, seeded

# Relative accuracy of the steady motion, and its intervals per revolution: those of `forces`.
_ACCURACY, _N = 1e-9, 360

# Extremes this near, as a share of the curve's range, tie: the steady motion is not known better.
_TIE = 1e-7

# A peak below this share of what forces and torques are made of is rounding.
_NOTHING = 1e-12

# Share of a speed to both sides at which the motor's torque is read for its slope.
_ASIDE = 1e-6

# A kink that moves by less than this [rad] for its entry doubled stays where it is.
_ROUNDING = 1e-12

# An angle this near to a kink [rad] is on it; its two sides are looked at this far from it.
_ON_KINK, _BESIDE = 1e-8, 5e-9


def force_tangents(machine: Machine, variables: Sequence[str]) -> Derivatives:
    """Largest driving torque, shaking force and reactions in the motion of the machine, by some entries.

    Raises what `forces` raises.
    """
    program = _directions(machine, variables)
    state, solution = _state(machine), _solution(machine, program)
    result = forces(machine, state, contributions=False)
    curves = _curves(result)
    nothing = _rounding(machine, result)
    missing = {
        name: "it is zero but for rounding"
        for name, curve in curves.items()
        if np.nanmax(np.abs(curve)) <= nothing["torque" if name.startswith("torque") else "force"]
    }
    places = {name: int(np.nanargmax(np.abs(curve))) for name, curve in curves.items() if name not in missing}
    if not places:
        return Derivatives(program.variables, {}, {}, missing, program.refused)
    at = np.unique(list(places.values()))
    if solution is None:
        motion = Motion(*(getattr(result.motion, name)[at] for name in _MOTION))
    else:
        motion = _read(solution, result.crank_angle[at])
    along, lost = _motion_along(machine, motion, program, solution)
    tangents = _curves(_forces_along(machine, motion, along, program))
    extremes, ties = {}, {}
    kinks = Kinks(machine, program, solution)
    beside = _beside_kinks(machine, result, solution, kinks)
    for name, place in places.items():
        curve, tangent = curves[name], tangents[name][int(np.searchsorted(at, place))].number()
        angle = float(result.crank_angle[place])
        moving = kinks.moved_at(angle)
        larger = [at for at, size in beside[name] if size > abs(curve[place]) * (1.0 + _TIE)]
        for other in larger:
            moving = moving | kinks.moved_at(other)
        # The extreme is that of the result to the last digit; the tangent's is worked out anew.
        extremes[name] = Tangent(float(curve[place]), np.where(moving, np.nan, tangent.d))
        reasons = [tied(np.abs(curve), place, result.crank_angle)]
        reasons += [kinks.words(larger[0] if larger else angle, moving)] if moving.any() else []
        if any(reasons):
            ties[name] = "; ".join(filter(None, reasons))
    return Derivatives(program.variables, extremes, ties, missing, program.refused, lost)


def drive_forces_along(
    machine: Machine, variables: Sequence[str], angles: Floats
) -> tuple[Directions, dict[str, Any], dict[str, float], Kinks]:
    """Forces of drives and cams at crank angles with their derivatives by some entries, by name, (n,) each.

    Beside the entries that have some: entries by which the motion is lost, and the kinks of the machine.
    """
    program = _directions(machine, variables)
    solution = _solution(machine, program)
    if solution is None:
        motion = forces(machine, angles=angles, contributions=False).motion
    else:
        motion = _read(solution, angles)
    along, lost = _motion_along(machine, motion, program, solution)
    drives = _forces_along(machine, motion, along, program).drives
    return program, drives, lost, Kinks(machine, program, solution)


def drive_torque_along(
    machine: Machine, variables: Sequence[str], angles: Floats
) -> tuple[Directions, Any, Kinks]:
    """Driving torque at crank angles at the design speed, (n,), with its derivatives by some entries.

    Beside them the entries that have some, and the kinks of the machine.
    """
    program = _directions(machine, variables)
    assert machine.drive is not None
    motion = forces(machine, speed=machine.drive.speed, angles=angles, contributions=False).motion
    n, drive = len(program.variables), seeded(machine, program.variables).drive
    assert drive is not None
    given: Any = drive.speed
    speed: Any = lifted(given * lifted(np.ones(len(angles)), n), n)
    still: Any = lifted(motion.acceleration, n)
    along = replace(motion, speed=speed, acceleration=still, time=motion.crank_angle / speed)
    return program, _forces_along(machine, motion, along, program).torque_drive, Kinks(machine, program, None)


def _directions(machine: Machine, variables: Sequence[str]) -> Directions:
    """Directions of the program's numbers by entries that the description can be followed by, too."""
    program = directions(machine, variables)
    refused = dict(program.refused)
    known, _ = followed(machine, program.variables, lambda along: structure(along.linkage), refused)
    at = [program.variables.index(name) for name in known]
    return Directions(known, program.values[:, at], program.sizes[at], refused)


_MOTION = ("crank_angle", "speed", "acceleration", "time")


def _state(machine: Machine) -> SteadyState | None:
    """The steady motion of `forces`; None where the speed is given."""
    has_motor = machine.drive is not None and machine.drive.motor is not None
    return solved_state(machine, _ACCURACY, _N)[0] if has_motor else None


def _solution(machine: Machine, program: Directions) -> SteadySolution | None:
    """A solution that has derivatives; None where nothing is solved, since the speed is given."""
    motor = None if machine.drive is None else machine.drive.motor
    if motor is None or isinstance(motor, ConstantSpeedMotor):
        return None
    # A steep motor makes much torque of little speed: derivatives are those of a finer mesh.
    return solved_along(machine, program)[1]


def _read(solution: SteadySolution, angles: Floats) -> Motion:
    """The motion that derivatives are of: what is left of large torques needs both from one mesh."""
    read = solution.curves(angles)
    return Motion(angles, read.speed, read.acceleration, read.time)


def _curves(result: Forces) -> dict[str, Any]:
    """What is differentiated where it is largest."""
    force = result.shaking_force
    curves = {
        "torque_drive_max": result.torque_drive,
        "shaking_force_max": np.hypot(force[:, 0], force[:, 1]),
    }
    return curves | {f"reaction_max.{name}": pair.size for name, pair in result.pairs.items()}


def _rounding(machine: Machine, result: Forces) -> dict[str, float]:
    """Torque [N m] and force [N] that are rounding in a motion of a machine."""
    # They follow the acceleration, which is what the torque of the motor and that of the loads leave: the
    # torque is known to rounding of the speed times its slope, however small it is.
    size = Scene(machine, result.motion).size
    force = max(
        float(np.nanmax(np.abs(curve))) for name, curve in _curves(result).items() if "torque" not in name
    )
    torque = max(force * size, float(np.nanmax(np.abs(result.torque_drive))), _motor_change(machine, result))
    return {"torque": _NOTHING * torque, "force": _NOTHING * torque / size}


def _motor_change(machine: Machine, result: Forces) -> float:
    """By how much the motor's torque at the crank would change for a speed doubled, by its slope [N m]."""
    motor = None if machine.drive is None else machine.drive.motor
    if motor is None or isinstance(motor, ConstantSpeedMotor):
        return 0.0
    speeds = np.array([np.nanmin(result.speed), np.nanmax(result.speed)])
    above, below = (
        compile_machine(machine).motor_torques(speeds * (1 + by)).crank for by in (_ASIDE, -_ASIDE)
    )
    return float(np.abs(above - below).max()) / (2 * _ASIDE)


def _beside_kinks(
    machine: Machine, result: Forces, solution: Any, kinks: Kinks
) -> dict[str, list[tuple[float, float]]]:
    """Sizes of the curves on both sides of kinks that lie on angles of the result, with their angles."""
    half = 0.5 * kinks.cycle
    apart = np.abs((kinks.angles[:, None] - result.crank_angle + half) % kinks.cycle - half)
    on = [angle for angle in kinks.angles[(apart <= _ON_KINK).any(axis=1)] if kinks.moved_at(angle).any()]
    phi = np.sort(np.mod([angle + side for angle in on for side in (-_BESIDE, _BESIDE)], kinks.cycle))
    if not on:
        return {name: [] for name in _curves(result)}
    if solution is None:
        there = forces(machine, speed=float(result.speed[0]), angles=phi, contributions=False)
    else:
        there = forces(machine, _read(solution, phi), contributions=False)
    return {
        name: list(zip(phi.tolist(), np.abs(curve).tolist(), strict=True))
        for name, curve in _curves(there).items()
    }


def tied(size: Floats, place: int, angles: Floats) -> str:
    """Where a curve is as large as at its extreme; empty if nowhere."""
    span = float(np.nanmax(size) - np.nanmin(size))
    others = np.flatnonzero(size >= size[place] - _TIE * span)
    turn = round(float(angles[-1] - angles[0]) / (2 * np.pi)) * 2 * np.pi
    off = np.abs(angles - angles[place])
    apart = [i for i in others if min(off[i], abs(off[i] - turn)) > _ON_KINK]
    if not apart or span == 0.0:
        return "" if span else "it is the same at all angles"
    return f"it is reached at {np.degrees(angles[place]):.4g}° and {np.degrees(angles[apart[0]]):.4g}°"


class Kinks:
    """Crank angles at which loads or motion have a kink or jump, and the entries that move them."""

    def __init__(self, machine: Machine, program: Directions, solution: Any) -> None:
        compiled = compile_machine(machine)
        # At a given speed forces are those of one revolution, whether it repeats or not.
        compiled = compiled if solution is None else over_whole_cycle(compiled)
        self.variables = program.variables
        self.angles, self.cycle = compiled.kinks(), compiled.cycle
        at = np.array([float(get(machine, name)) for name in self.variables])
        along = compiled.kinks_along(program.values, self.angles) * np.where(at == 0.0, 1.0, at)
        self.moves: Bools = np.abs(along) > _ROUNDING

    def on(self, angle: float) -> Bools:
        """Which kinks are at a crank angle [rad]."""
        half = 0.5 * self.cycle
        apart = np.abs((self.angles - angle + half) % self.cycle - half)
        return np.asarray(apart <= _ON_KINK)

    def moved_at(self, angle: float) -> Bools:
        """Which variables move a kink at a crank angle [rad], (variables,)."""
        return np.asarray(self.moves[self.on(angle)].any(axis=0))

    def words(self, angle: float, moving: Bools) -> str:
        """Which entries have no derivative there."""
        names = [name for name, moves in zip(self.variables, moving, strict=True) if moves]
        kink = float(self.angles[self.on(angle)][0])
        return (
            f"it is reached at {np.degrees(kink):.4g}°, at a kink of loads or motion; there is no derivative "
            f"by the entries that move this kink: {', '.join(names)}"
        )


def _motion_along(
    machine: Machine, motion: Motion, program: Directions, solution: Any
) -> tuple[Motion, dict[str, float]]:
    """The motion at its angles, with derivatives, and entries by which these are lost."""
    n = len(program.variables)
    phi = motion.crank_angle
    if solution is not None:
        gradient = solution.gradient(program.values, program.sizes, phi)
        followed: dict[str, Any] = {
            name: TangentArray(getattr(motion, name), getattr(gradient.curves, name)) for name in _MOTION[1:]
        }
        return replace(motion, **followed), program.lost(gradient.lost)
    drive = seeded(machine, program.variables).drive
    assert drive is not None
    given: Any = drive.speed
    if isinstance(drive.motor, ConstantSpeedMotor):
        given = drive.motor.speed / drive.gearbox.ratio
    speed: Any = lifted(given * lifted(np.ones(len(phi)), n), n)
    acceleration: Any = lifted(motion.acceleration, n)
    time: Any = phi / speed if motion.speed.any() else lifted(phi, n)
    return replace(motion, speed=speed, acceleration=acceleration, time=time), {}


class _SceneAlong(Scene):
    """A machine at the angles of a motion, with derivatives of all that is worked out."""

    def __init__(self, scene: Scene, motion: Motion, program: Directions) -> None:
        self.machine = seeded(scene.machine, program.variables)
        self.mechanism = self.machine.linkage
        self.motion = motion
        self.structure = structure(self.mechanism)
        self.links = self.mechanism.links()
        self.kinematics = kinematics_along(scene.machine, scene.kinematics, program.values)
        self.n, self.index, self.size = scene.n, scene.index, scene.size
        self.n_variables = len(program.variables)
        self._still = self.zeros(self.n, 2)

    def zeros(self, *shape: int) -> Any:
        """An array to be filled with what follows from the machine."""
        return lifted(np.zeros(shape), self.n_variables)


def _forces_along(machine: Machine, motion: Motion, along: Motion, program: Directions) -> Forces:
    """Forces at the angles of a motion, with derivatives."""
    scene = Scene(machine, motion)
    models, sources = acting(scene, {})
    solution, without = solved(scene, models, {"": together(scene, sources.values())})
    moving = _SceneAlong(scene, along, program)
    models, sources = acting(moving, {})
    with_pulls(moving, models, without)
    columns = {"": together(moving, sources.values())}
    followed = _along(equilibrium(moving, models, columns), solution)
    return Collector(moving, models, sources, columns, followed).forces()


def _along(system: Equilibrium, solution: Solution) -> Solution:
    """The unknowns with their derivatives, A dx = −(db + dA x)."""
    x = solution.x.sum(axis=-1)
    # The extra forces are homogeneous of degree one: slopes times x, with x held.
    slopes: Any = np.concatenate(
        [model.slopes(x[:, span]) for model, span in zip(system.models, system.spans, strict=True)], axis=1
    )
    A: Any = system.base
    for k, span in enumerate(system.spans):
        extra: Any = system.extras[k]
        if extra is not None:
            A = A.copy()
            A[:, :, span] = A[:, :, span] + extra * slopes[:, None, span]
    left = np.einsum("nij,nj->ni", A, x) + system.b.sum(axis=-1)
    size = system.column_scale
    usable = ~(solution.singular | solution.locked)
    d = np.full((*x.shape, left.d.shape[-1]), np.nan)
    d[usable] = np.linalg.solve(A.value[usable] * size, -left.d[usable]) * size[:, None]
    followed: Any = TangentArray(x, d)
    return replace(solution, x=followed[:, :, None], slopes=slopes)
