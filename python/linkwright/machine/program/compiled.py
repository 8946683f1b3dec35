"""A machine's description as plan and parameters."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from linkwright import _core
from linkwright.kernel.arrays import Bools, Floats, Integers
from linkwright.kernel.description.place import arrays, join
from linkwright.kernel.errors import AssemblyError, InputError, MachineError, Problem, ShapeError
from linkwright.kernel.numerics.tangent import primal
from linkwright.kinetostatics.model.loads.force import FormulaLoad
from linkwright.kinetostatics.model.loads.table import TorqueSpeed
from linkwright.machine.address import addresses
from linkwright.machine.machine import Machine
from linkwright.machine.own_motors import on_crankshaft
from linkwright.machine.program.core import Element, require
from linkwright.machine.program.drive_line import drive_of
from linkwright.machine.program.initial_assembly import InitialAssembly
from linkwright.machine.program.loads import Loads, bodies_of
from linkwright.machine.program.mechanism import MechanismProgram
from linkwright.machine.program.motion import LinkRows, PointRows, Rows, link_motion, motion, point_motion


class Translation:
    """What a machine is in the core's terms.

    Parameters
    ----------
    machine : Machine
        The description.
    motor, brake : bool
        Whether the motor is on, and the brake applied.
    """

    def __init__(self, machine: Machine, *, motor: bool, brake: bool) -> None:
        self.program = MechanismProgram(machine.linkage)
        self.program.build()
        felt = on_crankshaft(machine)
        self.bodies = bodies_of(felt, self.program)
        self.loads = Loads(felt, self.program).all(brake=brake)
        self.drive = drive_of(machine, self.program, motor=motor)
        self.machine = machine

    @cached_property
    def assembly(self) -> InitialAssembly:
        """The program with all that follows from the motion filled in."""
        columns = _columns(self.program.parameters, self.program.varying, _row_count(self.machine))
        assembly = InitialAssembly(self.program, columns, self._plan)
        assembly.run()
        return assembly

    def _plan(self) -> _core.Plan:
        return _core.Plan(
            parameters=len(self.program.parameters),
            ground=self.program.ground,
            elements=self.program.elements,
            bodies=self.bodies,
            loads=self.loads,
            drive=self.drive,
        )


def _row_count(machine: Machine) -> int:
    """How many machines the entries describe, also those without an effect."""
    columns = {join(place): array for place, array in arrays(machine)}
    if "mechanism.assembled_at" in columns:
        raise ShapeError(
            "mechanism.assembled_at cannot vary from machine to machine in a batch: the places of the joints "
            "are those of one crank angle; compute machines with others one by one"
        )
    shapes = {array.shape for array in columns.values()}
    if len(shapes) > 1 or any(len(shape) != 1 or not shape[0] for shape in shapes):
        given = ", ".join(f"{address} {array.shape}" for address, array in columns.items())
        raise ShapeError(f"arrays of one length are needed, found shapes {given}")
    return shapes.pop()[0] if shapes else 1


def _columns(parameters: list[Any], varying: list[int], n: int) -> tuple[Floats, Integers, Floats]:
    """First row of all parameters; which vary; their values (k, n)."""
    columns = [np.asarray(parameters[slot], dtype=np.float64) for slot in varying]
    first = [primal(value) for value in parameters]
    for slot, column in zip(varying, columns, strict=True):
        first[slot] = column[0]
    values = np.ascontiguousarray(columns) if columns else np.empty((0, n))
    return np.array(first, dtype=np.float64), np.array(varying, dtype=np.int32), values


@dataclass(frozen=True, slots=True)
class CompiledMachine:
    """A machine in the core's terms."""

    plan: _core.Plan  # its structure
    parameters: Floats  # (n_parameters,): its numbers in SI; of the first row where they vary
    slots: Integers  # (k,): which parameters vary from row to row
    values: Floats  # (k, n): their values over n rows; n is 1 for a single machine
    # Index of each point, link and slide by name.
    points: dict[str, int]
    links: dict[str, int]
    slides: dict[str, int]
    dyads: tuple[str, ...]  # names of the elements that must close
    # (1,) or (n,): machines in which a dyad passes an odd number of change points, so that it repeats after
    # two revolutions.
    two_turns: Bools
    # Whether all motions repeat after one revolution of the crank by the kinds of the elements alone.
    one_turn: bool
    speed_guess: float  # crank speed from which steady motion is sought [rad/s]
    speed_slot: int  # which parameter that is
    gear_slots: tuple[int, int, int]  # which parameters `gear_factors` are
    # Ratio, and the factor on torque times ratio while the motor drives and while the load does.
    gear_factors: tuple[float, float, float]
    # Tables of load torque over crank speed.
    speed_tables: tuple[tuple[Sequence[float], Sequence[float]], ...]
    has_laws: bool  # whether loads depend on both angle and speed in their own way, or on time
    # The structure without its conservative loads, whose work over a closed cycle is zero.
    resisting: _core.Plan
    ground: tuple[_core.GroundPoint, ...] = ()  # points at rest
    # The core's program in build order: indices of what each makes and hangs on, slots of its numbers.
    elements: tuple[_core.Element, ...] = ()
    # Whether the mechanism itself varies from row to row, not masses, loads and drive alone.
    motion_varies: bool = False
    # What is wrong with a driver's law that has no value at some crank angles.
    law_gap: AssemblyError | None = None
    # What has been found out about the machine once and for all, by name.
    kept: dict[str, Any] = field(default_factory=dict, init=False, repr=False, compare=False)

    @property
    def turns(self) -> int:
        """Revolutions of the crank after which all loads repeat."""
        return self.plan.turns

    @property
    def cycle(self) -> float:
        """Angle of the crank after which all loads repeat [rad]."""
        return 2 * np.pi * self.plan.turns

    def over_turns(self, turns: int) -> CompiledMachine:
        """The machine over a cycle of which so many revolutions are a part too."""
        return replace(self, plan=self.plan.over_turns(turns), resisting=self.resisting.over_turns(turns))

    @property
    def n_rows(self) -> int:
        """How many machines."""
        return int(self.values.shape[1])

    def first(self) -> CompiledMachine:
        """The first machine alone."""
        if self.n_rows == 1 and not len(self.slots):
            return self
        return replace(self, slots=np.empty(0, dtype=np.int32), values=np.empty((0, 1)))

    def row(self, k: int) -> CompiledMachine:
        """One machine of a batch alone."""
        q = self.parameters.copy()
        q[self.slots] = self.values[:, k]
        return replace(self, parameters=q, slots=np.empty(0, dtype=np.int32), values=np.empty((0, 1)))

    def rows(self, members: Integers) -> CompiledMachine:
        """Some machines of a batch, by their places in it."""
        return replace(self, values=np.ascontiguousarray(self.values[:, members]))

    @property
    def one(self) -> Floats:
        """The parameters of a single machine; a `ShapeError` if entries vary from machine to machine."""
        if self.n_rows > 1 or len(self.slots):
            raise ShapeError(
                f"this analysis takes one machine, and the entries describe {self.n_rows}; "
                "use steady_states, kinematics or motions for many"
            )
        return self.parameters

    def gaps(self, angles: Floats) -> Floats:
        """Radicand of each dyad at crank angles, (dyads, n); negative where it does not close."""
        return _core.gaps(self.plan, self.parameters, angles)

    def motion(
        self, channels: Sequence[_core.Channel], angles: Floats, directions: Floats | None = None
    ) -> list[Rows]:
        """Motion of the first row at crank angles [rad]: a point, link or slide each.

        With derivatives by directions (parameters, k).
        """
        slopes = None if directions is None else self.motions_along(directions, angles, channels)
        return motion(self.plan, self.parameters, channels, angles, slopes)

    def point_motion(self, point: int, angles: Floats) -> PointRows:
        """Motion of a point of the first row at crank angles [rad]."""
        return point_motion(self.plan, self.parameters, point, angles)

    def link_motion(self, link: int, angles: Floats) -> LinkRows:
        """Motion of a link of the first row at crank angles [rad]."""
        return link_motion(self.plan, self.parameters, link, angles)

    def third(
        self,
        angles: Floats,
        *,
        points: Sequence[int] = (),
        links: Sequence[int] = (),
        slides: Sequence[int] = (),
    ) -> _core.ThirdDerivatives:
        """Third derivatives of the first row at crank angles; see `_core.third`."""
        return _core.third(self.plan, self.parameters, angles, points=points, links=links, slides=slides)

    def motions_along(self, directions: Floats, angles: Floats, channels: Sequence[_core.Channel]) -> Floats:
        """Derivatives of motions at crank angles by directions (parameters, k), (numbers, n, k)."""
        require("motions_along")
        q, way = self.one, np.ascontiguousarray(directions)
        along = _core.motions_along(self.plan, q, way, np.ascontiguousarray(angles), channels)
        return along.reshape(len(along), len(angles), way.shape[1])

    def kinks_along(self, directions: Floats, angles: Floats) -> Floats:
        """Derivatives of crank angles that are kinks by directions (parameters, k), (n, k)."""
        require("kinks_along")
        way = np.ascontiguousarray(directions)
        return _core.kinks_along(self.plan, self.one, way, np.ascontiguousarray(angles))

    def inertias_along(self, directions: Floats, angles: Floats) -> Floats:
        """Derivatives of reduced inertia and its slope by directions (parameters, k), (2, n, k)."""
        require("inertias_along")
        way, phi = np.ascontiguousarray(directions), np.ascontiguousarray(angles)
        along = _core.inertias_along(self.plan, self.one, way, phi)
        return along.reshape(2, len(phi), way.shape[1])

    def without_conservative(self) -> CompiledMachine:
        """The machine without loads that have a potential: gravity, springs, forces fixed in the frame."""
        return replace(self, plan=self.resisting)

    def kinks(self) -> Floats:
        """Crank angles from 0 to the end of the cycle [rad] between which everything is smooth."""
        return _core.kinks(self.plan, self.one)

    def reductions(self, angles: Floats) -> _core.Reductions:
        """The machine reduced to its crank at crank angles; see `_core.Reductions`."""
        return _core.reductions(self.plan, self.one, angles)

    def law_torques(self, angles: ArrayLike, speeds: ArrayLike) -> Floats:
        """Load torque of the laws at crank angles and speeds, (speeds, angles) [N m]."""
        phi, omega = (np.atleast_1d(np.asarray(x, dtype=np.float64)) for x in (angles, speeds))
        return _core.law_torques(self.plan, self.one, np.ascontiguousarray(phi), omega)

    def motor_torques(self, speeds: ArrayLike) -> _core.MotorTorques:
        """Torque at the motor's shaft and at the crank [N m] at crank speeds [rad/s]."""
        at = np.atleast_1d(np.asarray(speeds, dtype=np.float64))
        return _core.motor_torques(self.plan, self.one, at)

    def speed_load(self, speeds: ArrayLike) -> Floats:
        """Load torque of the loads over speed at crank speeds [N m]."""
        at = np.asarray(speeds, dtype=np.float64)
        return sum((np.interp(at, x, y) for x, y in self.speed_tables), np.zeros_like(at))

    def motor_torque_for(self, torque_drive: Floats) -> Floats:
        """Torque at the motor's shaft that gives a torque at the crank [N m]."""
        ratio, forward, reverse = self.gear_factors
        return torque_drive / (ratio * np.where(torque_drive < 0, reverse, forward))

    def transient(
        self,
        start: tuple[float, float],
        turning: tuple[int, int],
        duration: float,
        turns: float,
        accuracy: float,
    ) -> _core.MotionInTime:
        """Motion in time from angle [rad] and speed [rad/s]; see `_core.transient`."""
        return _core.transient(self.plan, self.one, start, turning, duration, turns, accuracy)

    def transient_along(
        self, directions: Floats, start: Floats, motion: tuple[Floats, Floats, Floats], at: ArrayLike
    ) -> _core.MotionVariations:
        """Derivatives of a motion in time by directions (parameters, n); see `_core.transient_along`.

        `start`: derivatives of angle and speed at the start, (2, n); `motion`: times (k,), angles and speeds
        (2, k), factors of the steps (k − 1, 2, 7); `at`: instants, increasing [s].
        """
        require("transient_along")
        time, states, between = (np.ascontiguousarray(part) for part in motion)
        way, begin = np.ascontiguousarray(directions), np.ascontiguousarray(start)
        instants = np.ascontiguousarray(at, dtype=np.float64)
        return _core.transient_along(self.plan, self.one, way, begin, time, states, between, instants)

    def steady(self, angles: Floats, accuracy: float) -> _core.SteadyMotion | _core.NoSteadyMotion:
        """Steady motion with curves at crank angles within the cycle; see `_core.steady_state`."""
        return _core.steady_state(self.plan, self.one, accuracy, angles)

    def driveline(
        self, chain: Mapping[str, Any], **search: Any
    ) -> _core.DrivelineMotion | _core.NoDrivelineMotion:
        """Steady motion behind a torsionally flexible driveline; see `_core.driveline_motion`."""
        require("driveline_motion")
        return _core.driveline_motion(self.plan, self.one, chain, **search)

    def driveline_in_time(self, chain: Mapping[str, Any], **motion: Any) -> _core.DrivelineInTime:
        """Motion in time behind a torsionally flexible driveline; see `_core.driveline_in_time`."""
        require("driveline_in_time")
        return _core.driveline_in_time(self.plan, self.one, chain, **motion)

    def driveline_rows(self, chain: Mapping[str, Any], **asked: Any) -> _core.DrivelineRows:
        """Steady motion of every row behind a torsionally flexible driveline; see `_core.driveline_rows`."""
        require("driveline_rows")
        return _core.driveline_rows(self.plan, self.parameters, self.slots, self.values, chain, **asked)

    def least_inertias(self, angles: Floats) -> Floats:
        """Minimum inertia reduced to the crank at crank angles, of every row, (n,) [kg m²]."""
        return _core.least_inertias(self.plan, self.parameters, self.slots, self.values, angles)

    @property
    def speed_guesses(self) -> Floats:
        """Crank speed from which steady motion is sought, of every row, (n,) [rad/s]."""
        at = np.flatnonzero(self.slots == self.speed_slot)
        return self.values[at[0]] if len(at) else np.full(self.n_rows, self.speed_guess)

    def driveline_branch(self, **family: Any) -> tuple[list[tuple[float, bool, _core.DrivelineMotion]], str]:
        """Steady motions over a parameter behind an elastic driveline; see `_core.driveline_branch`."""
        require("driveline_branch")
        return _core.driveline_branch(self.plan, **family)

    def steady_rows(self, accuracy: float) -> _core.SteadyRows:
        """Steady motion of every row; see `_core.steady_rows`."""
        return _core.steady_rows(self.plan, self.parameters, self.slots, self.values, accuracy)

    def motions(self, angles: Floats, channels: Sequence[_core.Channel], out: Floats) -> bool:
        """Motions of every row; see `_core.motions`."""
        return _core.motions(self.plan, self.parameters, self.slots, self.values, angles, channels, out)


def compile_machine(machine: Machine, *, motor: bool = True, brake: bool = False) -> CompiledMachine:
    """Translate a description into plan and parameters; entries may be arrays of one common length.

    `motor`: whether it is on, its inertia counts in any case; `brake`: whether it is applied. Raises
    `ShapeError` for arrays of different length, or an array in a table; `InputError` if the machine is a
    torsional train, or a topper whose knife moves by a law, and nothing else.
    """
    _require_mechanism(machine)
    try:
        key = (id(machine), motor, brake)
        known = _known.get(key)
        if known is not None and known.is_of(machine):
            return known.compiled
        compiled = _translate(machine, motor=motor, brake=brake)
    except (ValueError, TypeError) as error:
        # Of an array numpy says what a user cannot know.
        varies = next(iter(arrays(machine)), None) is not None
        why = "values that vary where one number is taken" if varies else str(error)
        raise _not_usable(machine, why) from None
    except ArithmeticError as error:
        raise _not_usable(machine, str(error)) from None
    if not np.isfinite(compiled.parameters).all():
        raise _not_usable(machine, "a number that follows from them is not finite")
    is_batch = compiled.n_rows > 1 or len(compiled.slots) > 0
    if is_batch:
        # Its arrays are large: only the last is kept.
        for of_batch in [key for key, known in list(_known.items()) if known.columns]:
            _known.pop(of_batch, None)
    elif len(_known) >= _KNOWN_MAX:
        _known.pop(next(iter(_known)), None)
    _known[key] = _CacheEntry(
        machine,
        tuple((constant, dict(constant)) for constant in _constants(machine)),
        # Arrays may change in place.
        tuple((array, array.copy()) for _, array in arrays(machine)) if is_batch else (),
        compiled,
    )
    return compiled


def _require_mechanism(machine: Machine) -> None:
    """Refuse what no crank moves."""
    if machine.is_train_alone:
        raise InputError(f"{machine.name} is a train without a [mechanism]: use `linkwright torsion`")
    if machine.is_diagram_alone:
        raise InputError(
            f"{machine.name} is a turning-moment diagram without a [mechanism]: `linkwright run` has what "
            "follows from it"
        )
    if machine.is_rod_string_alone:
        raise InputError(
            f"{machine.name} is a rod string without a [pumping_unit]: no crank moves it; "
            "`linkwright rods` has its cards"
        )
    if machine.is_topper_alone:
        raise InputError(
            f"{machine.name} is a topper without a [mechanism]: no crank moves its knife; `linkwright run` "
            "and `linkwright topper` have what the knife does"
        )


def _translate(machine: Machine, *, motor: bool, brake: bool) -> CompiledMachine:
    translation = Translation(machine, motor=motor, brake=brake)
    program, assembly, drive = translation.program, translation.assembly, translation.drive
    parameters = assembly.parameters
    factors = (drive.ratio, drive.forward, drive.reverse)
    ratio, forward, reverse = (float(parameters[slot]) for slot in factors)
    return CompiledMachine(
        plan=assembly.plan,
        parameters=parameters,
        slots=assembly.slots,
        values=np.ascontiguousarray(assembly.values),
        points=program.points,
        links=program.links,
        slides=program.slides,
        dyads=tuple(program.dyads),
        two_turns=assembly.odd,
        one_turn=not (
            assembly.odd.any() or any(isinstance(element, _RUNNING) for element in program.elements)
        ),
        speed_guess=float(parameters[drive.speed_start]),
        speed_slot=int(drive.speed_start),
        gear_slots=factors,
        gear_factors=(ratio, forward, reverse),
        speed_tables=tuple(
            (load.speed, load.torque) for load in machine.all_loads.values() if isinstance(load, TorqueSpeed)
        ),
        has_laws=assembly.plan.has_laws,
        resisting=assembly.plan.without_conservative(),
        ground=tuple(program.ground),
        elements=tuple(program.elements),
        motion_varies=assembly.motion_varies,
        law_gap=assembly.law_gap,
    )


def _not_usable(machine: Machine, reason: str) -> MachineError:
    """The error for entries that were exchanged unchecked, or are too large or too small to compute with."""
    varying = [join(place) for place, _ in arrays(machine)]
    if varying:
        expected = "entries that can vary from machine to machine in a batch"
        remedy = "compute machines that differ in one of these one by one"
        return MachineError([Problem(", ".join(varying), reason, expected, remedy)])
    wrong = [
        Problem(address, f"{value!r}", "a finite number of usual size")
        for address, value in addresses(machine).items()
        if not np.isfinite(value) or abs(value) > _SIZE_MAX or 0 < abs(value) < 1 / _SIZE_MAX
    ]
    return MachineError(wrong or [Problem("", "entries that cannot be computed with", reason)])


# Elements whose motion may take several revolutions or never repeat: sums over the crank angle and links,
# groups, laws.
_RUNNING = (Element.Turn, Element.Runner, Element.Group, Element.Law)

# Entries beyond this size, or below its reciprocal, are named when a machine cannot be computed.
_SIZE_MAX = 1e100


class _CacheEntry(NamedTuple):
    """A machine translated before.

    It is frozen; constants of its formulas, and entries over the machines of a batch, are as they were then.
    """

    machine: Machine
    constants: tuple[tuple[Mapping[str, float], dict[str, float]], ...]
    columns: tuple[tuple[Floats, Floats], ...]
    compiled: CompiledMachine

    def is_of(self, machine: Machine) -> bool:
        """Whether a machine is the same, and its constants and arrays too."""
        return (
            self.machine is machine
            and all(now == then for now, then in self.constants)
            and all(np.array_equal(now, then) for now, then in self.columns)
        )


# Machines translated last. A few suffice for analyses that follow one another on one machine.
_known: dict[tuple[int, bool, bool], _CacheEntry] = {}
_KNOWN_MAX = 8


def _constants(machine: Machine) -> list[Mapping[str, float]]:
    """Constants of formulas: the one part of a description that can be changed in place."""
    mechanism = machine.linkage
    written: list[Any] = [*mechanism.cranks.values(), *mechanism.linear_drivers.values()]
    written += mechanism.cylinders.values()
    written += [load for load in machine.all_loads.values() if isinstance(load, FormulaLoad)]
    return [constant.constants for constant in written]
