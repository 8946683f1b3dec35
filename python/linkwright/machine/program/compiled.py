"""From a machine's description to the arrays of the core, and back. The only package that uses `_core`.

A `Compiled` machine is a plan (what is there, as small integer tables) and a list of parameters (the
numbers). An entry of the description that holds an array over many machines becomes a parameter that varies
from row to row: one description serves a single machine and a batch.
"""

from __future__ import annotations

import operator
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from linkwright import _core
from linkwright.drive.model.drive import Drive
from linkwright.drive.model.motor import (
    ConstantSpeedMotor,
    ConstantTorqueMotor,
    DcMotor,
    InductionMotor,
    TableMotor,
)
from linkwright.kernel.core.core_format import check_format
from linkwright.kernel.description import formula
from linkwright.kernel.description.plain import arrays
from linkwright.kernel.description.text import join
from linkwright.kernel.errors import InputError, MachineError, Problem, ShapeError
from linkwright.kinetostatics.model.body import Body
from linkwright.kinetostatics.model.loads.between import (
    Damper,
    GasSpring,
    Spring,
    TorsionalDamper,
    TorsionalSpring,
)
from linkwright.kinetostatics.model.loads.force import ConstantForce, ConstantTorque, Gravity
from linkwright.kinetostatics.model.loads.formula import FormulaLoad
from linkwright.kinetostatics.model.loads.friction import DryFriction, ViscousFriction
from linkwright.kinetostatics.model.loads.table import ForcePosition, TorqueAngle, TorqueSpeed
from linkwright.linkages.model.outline import TABLES
from linkwright.machine.address import addresses
from linkwright.machine.machine import Machine
from linkwright.machine.program.elements import Rows
from linkwright.machine.program.settle import Settled

Floats = NDArray[np.float64]

check_format(_core)

# Crank speed from which steady motion is sought when nothing in the machine suggests one [rad/s].
_SPEED_UNKNOWN = 10.0

_ROW_WIDTH = 8


@dataclass(frozen=True, slots=True)
class Compiled:
    """A machine in the core's terms.

    Attributes
    ----------
    plan : _core.Plan
        Its structure.
    parameters : ndarray, shape (n_parameters,)
        Its numbers in SI; of the first row where they vary.
    slots : ndarray of int32, shape (k,)
        Which parameters vary from row to row.
    values : ndarray, shape (k, n)
        Their values over n rows; n is 1 for a single machine.
    points, links, slides : dict of str to int
        Index of each point, link and slide by name.
    dyads : tuple of str
        Names of the elements that must close.
    two_turns : ndarray of bool, shape (1,) or (n,)
        Machines in which a dyad passes an odd number of change points, so that it repeats after two
        revolutions.
    one_turn : bool
        Whether all motions repeat after one revolution of the crank by the kinds of the elements alone.
    speed_guess : float
        Crank speed from which steady motion is sought [rad/s].
    gear_factors : tuple of float
        Ratio, and the factor on torque times ratio while the motor drives and while the load does.
    speed_tables : tuple
        Tables of load torque over crank speed.
    rows : tuple of tuple of int
        The core's program: kind and entries of each element, in build order.
    has_laws : bool
        Whether loads depend on both angle and speed in their own way, or on time.
    resisting : _core.Plan
        The structure without its conservative loads, whose work over a closed cycle is zero.
    """

    plan: _core.Plan
    parameters: Floats
    slots: NDArray[np.int32]
    values: Floats
    points: dict[str, int]
    links: dict[str, int]
    slides: dict[str, int]
    dyads: tuple[str, ...]
    two_turns: NDArray[np.bool_]
    one_turn: bool
    speed_guess: float
    gear_factors: tuple[float, float, float]
    speed_tables: tuple[tuple[Sequence[float], Sequence[float]], ...]
    has_laws: bool
    resisting: _core.Plan
    rows: tuple[tuple[int, ...], ...] = ()

    @property
    def n_rows(self) -> int:
        """How many machines."""
        return int(self.values.shape[1])

    def first(self) -> Compiled:
        """The first machine alone."""
        if self.n_rows == 1 and not len(self.slots):
            return self
        return replace(self, slots=np.empty(0, dtype=np.int32), values=np.empty((0, 1)))

    @property
    def one(self) -> Floats:
        """The parameters of a single machine.

        Raises
        ------
        ShapeError
            Entries vary from machine to machine.
        """
        if self.n_rows > 1 or len(self.slots):
            raise ShapeError(
                f"this analysis takes one machine, and the entries describe {self.n_rows}; "
                "use steady_states, kinematics or motions for many"
            )
        return self.parameters

    def gaps(self, angles: Floats) -> Floats:
        """Radicand of each dyad at crank angles, (dyads, n); negative where it does not close."""
        return _core.gaps(self.plan, self.parameters, angles)

    def third(self, angles: Floats, what: Sequence[tuple[int, int]]) -> Floats:
        """Third transfer functions of the first row at crank angles, (numbers, n); see `_core.third`."""
        channels = _ints([list(row) for row in what]).reshape(-1, 2)
        return _core.third(self.plan, self.parameters, angles, channels)

    def without_conservative(self) -> Compiled:
        """The machine without loads that have a potential: gravity, springs, forces fixed in the frame."""
        return replace(self, plan=self.resisting)

    def kinks(self) -> Floats:
        """Crank angles from 0 to 2π [rad] between which everything is smooth."""
        return _core.kinks(self.plan, self.one)

    def reductions(self, angles: Floats) -> Floats:
        """J, dJ/dφ, load torque, dry torque, viscous coefficient at crank angles, (5, n) in SI."""
        return _core.reductions(self.plan, self.one, angles)

    def law_torques(self, angles: ArrayLike, speeds: ArrayLike) -> Floats:
        """Load torque of the laws at crank angles and speeds, (speeds, angles) [N m]."""
        phi, omega = (np.atleast_1d(np.asarray(x, dtype=np.float64)) for x in (angles, speeds))
        return _core.law_torques(self.plan, self.one, np.ascontiguousarray(phi), omega)

    def motor_torques(self, speeds: ArrayLike) -> tuple[Floats, Floats]:
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
        self, start: tuple[float, float], duration: float, turns: float, accuracy: float
    ) -> tuple[int, tuple[float, float], int, list[Floats]]:
        """Motion in time from angle [rad] and speed [rad/s]; see `_core.transient`."""
        return _core.transient(self.plan, self.one, *start, duration, turns, accuracy)

    def steady(self, angles: Floats, accuracy: float) -> tuple[int, Floats, Floats | None]:
        """Steady motion with curves at crank angles in [0, 2π]; see `_core.steady_state`."""
        return _core.steady_state(self.plan, self.one, accuracy, angles)

    def steady_rows(self, accuracy: float) -> tuple[NDArray[np.uint8], Floats, int]:
        """Steady motion of every row; see `_core.steady_rows`."""
        return _core.steady_rows(self.plan, self.parameters, self.slots, self.values, accuracy)

    def motions(self, angles: Floats, what: Sequence[tuple[int, int]], out: Floats) -> None:
        """Motions of every row; see `_core.motions`."""
        channels = _ints([list(row) for row in what]).reshape(-1, 2)
        _core.motions(self.plan, self.parameters, self.slots, self.values, angles, channels, out)


def compile_machine(machine: Machine, *, motor: bool = True, brake: bool = False) -> Compiled:
    """Translate a description.

    Parameters
    ----------
    machine : Machine
        The machine; entries may be arrays of one common length.
    motor : bool
        Whether the motor is on. Its inertia counts in any case.
    brake : bool
        Whether the brake is applied.

    Returns
    -------
    Compiled
        Plan and parameters.

    Raises
    ------
    ShapeError
        Arrays of different length, or an array in a table.
    InputError
        The machine is a torsional train, or a topper whose knife moves by a law, and nothing else.
    """
    _require_mechanism(machine)
    try:
        parts = _parts(machine)
        key = (id(machine), motor, brake)
        known = _known.get(key)
        if known and len(known[0]) == len(parts) and all(map(operator.is_, known[0], parts)):
            return known[1]
        compiled = _translate(machine, motor=motor, brake=brake)
    except (ArithmeticError, ValueError, TypeError) as error:
        raise _not_usable(machine, str(error)) from None
    if not np.isfinite(compiled.parameters).all():
        raise _not_usable(machine, "a number that follows from them is not finite")
    if compiled.n_rows > 1 or len(compiled.slots):
        # Arrays are large, and may change in place.
        return compiled
    if len(_known) >= _KNOWN_MAX:
        _known.pop(next(iter(_known)), None)
    _known[key] = (parts, compiled)
    return compiled


def _require_mechanism(machine: Machine) -> None:
    """Refuse what no crank moves."""
    if machine.is_train_alone:
        raise InputError(
            f"{machine.name} is a train without a [mechanism]: its analyses are those of torsion"
        )
    if machine.is_diagram_alone:
        raise InputError(
            f"{machine.name} is a turning-moment diagram without a [mechanism]: `linkwright run` has what "
            "follows from it"
        )
    if machine.is_topper_alone:
        raise InputError(
            f"{machine.name} is a topper without a [mechanism]: no crank moves its knife; `linkwright run` "
            "and `linkwright topper` have what the knife does"
        )


def _translate(machine: Machine, *, motor: bool, brake: bool) -> Compiled:
    translator = _Translator(machine)
    translator.build()
    translator.bodies()
    translator.loads(brake=brake)
    translator.drive(motor=motor)
    return translator.result()


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


# Kinds of rows: dyads with change points, and where the number of these stands; sums over the crank angle and
# links, groups, and laws, whose motion may take several revolutions or never repeat.
FOLDING = {11: 12, 15: 14}
_RUNNING = (8, 9, 12, 14)

# Kinds of loads that have a potential over the position of the mechanism: constant force, gravity, springs by
# stiffness, by a table, torsional, of gas.
_CONSERVATIVE = (6, 8, 9, 16, 17, 19)

# Entries beyond this size, or below its reciprocal, are named when a machine cannot be computed.
_SIZE_MAX = 1e100

# Machines translated last, with the parts they were made of: frozen objects, so a machine of the same parts
# is the same machine. A few suffice for analyses that follow one another on one machine.
_known: dict[tuple[int, bool, bool], tuple[list[object], Compiled]] = {}
_KNOWN_MAX = 8


def _parts(machine: Machine) -> list[object]:
    """The frozen parts that a machine consists of, with their names."""
    mechanism = machine.linkage
    parts: list[object] = [machine, machine.drive, mechanism.assembled_at]
    tables = [getattr(mechanism, table) for table in TABLES]
    for table in (*tables, machine.bodies, machine.loads):
        parts.append(len(table))
        if table:
            parts += table
            parts += table.values()
    # Constants of formulas are the one part that can be changed in place.
    written: list[Any] = [*mechanism.cranks.values(), *mechanism.linear_drivers.values()]
    written += [load for load in machine.loads.values() if isinstance(load, FormulaLoad)]
    for each in written:
        parts += each.constants.values()
    return parts


class _Translator(Rows):
    """Collects parameters and rows while it walks through a description."""

    def __init__(self, machine: Machine) -> None:
        super().__init__(machine.linkage)
        self.machine = machine
        self.body_rows: list[list[int]] = []
        self.load_rows: list[list[int]] = []
        self.drive_row: list[int] = []

    def table(self, x: Sequence[Any], y: Sequence[Any]) -> int:
        """Adds a table."""
        if any(np.ndim(value) for value in (*x, *y)):
            points = ", ".join(join(place) for place, _ in arrays(self.machine) if place[-1].isdecimal())
            raise ShapeError(
                f"{points}: the points of a table cannot vary from machine to machine in a batch; "
                "compute machines with others one by one"
            )
        return self._table(x, y)

    # -- bodies ------------------------------------------------------------------------------------------

    def bodies(self) -> None:
        """Masses on links and on points."""
        lengths = {name: link.length for name, link in self.links_of.items()}
        for name, body in self.machine.bodies.items():
            carrier = body.on or name
            if carrier in self.links:
                place = [self.links[carrier], self.starts[carrier]]
                numbers = link_body(body, lengths[carrier])
                self.body_rows.append([1, *place, *(self.slot(value) for value in numbers)])
            else:
                self.body_rows.append([0, self.points[carrier], self.slot(body.mass)])

    # -- loads -------------------------------------------------------------------------------------------

    def loads(self, *, brake: bool) -> None:
        """Forces and torques; a brake resists on the crankshaft."""
        for load in self.machine.loads.values():
            if isinstance(load, FormulaLoad):
                self.load_rows += self._formula_load(load)
            else:
                self.load_rows.append(self._load(load))
        drive = self.machine.drive
        if brake and drive and drive.brake:
            ratio = drive.gearbox.ratio if drive.brake.on == "motor" else 1.0
            self.load_rows.append([13, self.slot(drive.brake.torque * ratio)])

    def _load(self, load: Any) -> list[int]:
        match load:
            case DryFriction():
                return self._against_motion(0, load.on, load.force, load.torque)
            case ViscousFriction():
                return self._against_motion(3, load.on, load.damping, load.damping_torsional)
            case ConstantForce():
                size = self._vector(load.force, load.direction)
                if load.along is not None:
                    return [14, self.points[load.on], self.links[load.along], *size]
                return [6, self.points[load.on], *size]
            case ConstantTorque():
                return [7, self.links[load.on], self.slot(load.torque)]
            case Gravity():
                return [8, *self._vector(load.acceleration, load.direction)]
            case Spring() | Damper() | GasSpring():
                return self._between(load, [self.points[end] for end in load.between])
            case TorsionalSpring():
                free = self._vector(1.0, load.free_angle)
                return [17, *self._two_links(load), self.slot(load.stiffness), *free]
            case TorsionalDamper():
                return [18, *self._two_links(load), self.slot(load.damping_torsional)]
            case ForcePosition():
                back = load.return_ or (0.0,) * len(load.position)
                tables = [self.table(load.position, load.forward), self.table(load.position, back)]
                return [10, self.slides[load.on], *tables]
            case TorqueAngle():
                return [11, self.table(*_one_turn(load.angle, load.torque))]
            case TorqueSpeed():
                return [12, self.table(load.speed, load.torque)]
        raise TypeError(f"no translation for {type(load).__name__}")

    def _against_motion(self, kind: int, on: str, on_point: Any, on_link: Any) -> list[int]:
        """Resistance on a slide, a point or a link: three kinds in a row."""
        if on_link is not None:
            return [kind + 2, self.links[on], self.slot(on_link)]
        if on in self.slides:
            return [kind, self.slides[on], self.slot(on_point)]
        return [kind + 1, self.points[on], self.slot(on_point)]

    def _between(self, load: Any, ends: list[int]) -> list[int]:
        """A load along the line between two points."""
        match load:
            case Spring(length=tuple() as length, force=tuple() as force):
                return [16, *ends, self.table(length, force)]
            case Spring():
                rest = [self.slot(load.free_length), self.slot(load.preload)]
                return [9, *ends, self.slot(load.stiffness), *rest]
            case Damper(velocity=tuple() as velocity, force=tuple() as force):
                return [20, *ends, self.table(velocity, force)]
            case Damper():
                return [15, *ends, self.slot(load.damping)]
        numbers = (load.force_extended, load.length_extended, gas_column(load), load.exponent)
        return [19, *ends, *(self.slot(value) for value in numbers)]

    def _two_links(self, load: Any) -> list[int]:
        """The link that a torsional load acts on, and the other one; −1 for the frame."""
        return [self.links[load.on], -1 if load.against is None else self.links[load.against]]

    def _formula_load(self, load: FormulaLoad) -> list[list[int]]:
        """One row for each summand, so that each enters the motion in its own way."""
        if load.torque is not None:
            kind, carrier = 24, [self.links[load.on]]
        elif load.along is not None:
            direction = self._vector(1.0, load.direction or 0.0)
            kind, carrier = 23, [self.points[load.on], self.links[load.along], *direction]
        elif load.direction is not None:
            kind, carrier = 22, [self.points[load.on], *self._vector(1.0, load.direction)]
        else:
            kind, carrier = 21, [self.slides[load.on], self.points[load.on]]
        constants = {name: self.slot(value) for name, value in load.constants.items()}
        return [
            [kind, self._formula(term, constants), *carrier]
            for term in formula.terms(formula.parse(load.text))
        ]

    def _vector(self, size: Any, direction: Any) -> list[int]:
        return [self.slot(size * np.cos(direction)), self.slot(size * np.sin(direction))]

    # -- drive -------------------------------------------------------------------------------------------

    def drive(self, *, motor: bool) -> None:
        """Motor, gearbox, and the inertia that turns with the crank."""
        drive = self.machine.drive or Drive()
        kind, spans = self._motor(drive.motor) if motor else ([0], [])
        gearbox = drive.gearbox
        numbers = (
            gearbox.ratio,
            gearbox.efficiency,
            reverse_factor(drive),
            drive_inertia(drive),
            speed_guess(drive),
        )
        head = [*kind, *[0] * (5 - len(kind))]
        self.drive_row = [*head, *(self.slot(value) for value in numbers), *spans]

    def _motor(self, motor: Any) -> tuple[list[int], list[int]]:
        """Row of the motor, and spans of its curve; a described motor has all its entries filled in."""
        match motor:
            case ConstantTorqueMotor():
                return [1, self.slot(motor.torque)], []
            case DcMotor(torque_stall=stall, speed_no_load=no_load):
                return [2, self.slot(stall), self.slot(1.0 / no_load)], []
            case InductionMotor():
                return self._induction(motor)
            case TableMotor():
                return [4, self.table(motor.speed, motor.torque)], []
        # No motor, or one of constant speed: nothing that answers to the load.
        return [0], []

    def _induction(self, motor: Any) -> tuple[list[int], list[int]]:
        """Kloss, and the curve below breakdown: start, pull-up if there is one, breakdown."""
        slip = 1.0 - motor.speed_breakdown / motor.speed_synchronous
        numbers = (1.0 / motor.speed_synchronous, motor.torque_breakdown, slip, motor.resistance_ratio)
        row = [3, *(self.slot(value) for value in numbers)]
        if motor.torque_start is None:
            return row, []
        knots = [(0.0, motor.torque_start), (motor.speed_breakdown, motor.torque_breakdown)]
        if motor.torque_pull_up is not None:
            knots.insert(1, (motor.speed_pull_up, motor.torque_pull_up))
        spans: list[int] = []
        for nth, (left, right) in enumerate(pairwise(knots)):
            ends = (*left, *right, 1.0 / (right[0] - left[0]))
            spans += [self.slot(value) for value in ends] + [int(nth > 0)]
        return row, spans

    # -- result ------------------------------------------------------------------------------------------

    def result(self) -> Compiled:
        """Plan and parameters as arrays."""
        self.n_described = len(self.parameters)
        columns = _columns(self.parameters, self.varying, _row_count(self.machine))
        settled = Settled(self, columns, self._plan, self.mechanism.assembled_at)
        settled.run()
        parameters = settled.parameters
        ratio, forward, reverse, _, guess = (float(parameters[slot]) for slot in self.drive_row[5:10])
        return Compiled(
            plan=settled.plan,
            parameters=parameters,
            slots=settled.slots,
            values=np.ascontiguousarray(settled.values),
            points=self.points,
            links=self.links,
            slides=self.slides,
            dyads=tuple(self.dyads),
            two_turns=settled.odd,
            one_turn=not (settled.odd.any() or any(row[0] in _RUNNING for row in self.rows)),
            speed_guess=guess,
            gear_factors=(ratio, forward, reverse),
            speed_tables=tuple(self.tables[row[1]] for row in self.load_rows if row[0] == 12),
            rows=tuple(tuple(row) for row in self.rows),
            has_laws=settled.plan.has_laws,
            resisting=self._plan(resisting=True),
        )

    def _plan(self, *, resisting: bool = False) -> _core.Plan:
        """The rows as the core's plan; only those of loads without a potential, if asked."""
        # The hidden origin has no name but has its place.
        sizes = [len(self.parameters), len(self.points) + 1, len(self.links), len(self.slides)]
        starts = np.cumsum([0, *(len(x) for x, _ in self.tables)])
        loads = [row for row in self.load_rows if not (resisting and row[0] in _CONSERVATIVE)]
        return _core.Plan(
            _ints([*sizes, len(self.dyads)]),
            _ints([value for kind, *row in self.rows for value in (kind, len(row), *row)]),
            _rows(self.body_rows, _ROW_WIDTH),
            _rows(loads, _ROW_WIDTH),
            _ints(self.drive_row),
            _ints(starts),
            np.array([value for x, _ in self.tables for value in x], dtype=np.float64),
            np.array([value for _, y in self.tables for value in y], dtype=np.float64),
            _ints(self.formulas),
            np.array(self.motion_laws, dtype=np.float64),
        )


def link_body(body: Body, length: Any) -> tuple[Any, Any, Any, Any]:
    """Place of the centre of mass along and across the link [m], mass [kg], inertia about it [kg m²].

    Without a place the centre is in the middle; without an inertia the body is a uniform slender rod,
    m l²/12.
    """
    mass = 0.0 if body.mass is None else body.mass
    if body.mass_per_length is not None:
        mass = body.mass_per_length * length
    along = 0.5 * length if body.along is None else body.along
    inertia = mass * length**2 / 12 if body.inertia is None else body.inertia
    return along, body.across, mass, inertia


def gas_column(spring: GasSpring) -> Any:
    """Length of the gas of a gas spring at its extended length [m]: volume over the area of the rod.

    The law F = F₁ (h/(h − way))ⁿ goes through the push at the compressed length, F₁·progression.
    """
    way = spring.length_extended - spring.length_compressed
    root = spring.progression ** (1.0 / spring.exponent)
    return way * root / (root - 1.0)


def reverse_factor(drive: Drive) -> Any:
    """Factor on motor torque times ratio while the load drives the motor."""
    gearbox = drive.gearbox
    if gearbox.reverse is None:
        return 1.0 / gearbox.efficiency
    return gearbox.efficiency if isinstance(gearbox.reverse, str) else gearbox.reverse


def drive_inertia(drive: Drive) -> Any:
    """Inertia of all that turns at the motor's speed or the crank's, at the crank [kg m²]."""
    at_motor = (drive.motor.inertia if drive.motor else 0.0) + drive.gearbox.inertia
    at_motor = at_motor + (drive.coupling.inertia if drive.coupling else 0.0)
    at_crank: Any = drive.gearbox.wheel_inertia
    for part in (drive.flywheel, drive.brake):
        if part is not None and part.on == "motor":
            at_motor = at_motor + part.inertia
        elif part is not None:
            at_crank = at_crank + part.inertia
    return at_motor * drive.gearbox.ratio**2 + at_crank


def speed_guess(drive: Drive) -> Any:
    """Crank speed without load, as far as the motor has one; else the design speed [rad/s]."""
    match drive.motor:
        case InductionMotor(speed_synchronous=speed) if speed is not None:
            return speed / drive.gearbox.ratio
        case DcMotor(speed_no_load=speed) | ConstantSpeedMotor(speed=speed):
            return speed / drive.gearbox.ratio
        case TableMotor(speed=speeds, torque=torques):
            driving = [speed for speed, torque in zip(speeds, torques, strict=True) if torque > 0]
            return max([*driving, 0.1 * speeds[-1]]) / drive.gearbox.ratio
    return _SPEED_UNKNOWN if drive.speed is None else drive.speed


def _one_turn(angles: Sequence[float], torques: Sequence[float]) -> tuple[Sequence[float], Sequence[float]]:
    """A table without the repetition of its first point at the end of the revolution."""
    closes = angles[-1] - angles[0] >= 2 * np.pi * (1 - 1e-9)
    return (angles[:-1], torques[:-1]) if closes else (angles, torques)


def _ints(values: ArrayLike) -> NDArray[np.int32]:
    return np.asarray(values, dtype=np.int32)


def _rows(rows: list[list[int]], width: int) -> NDArray[np.int32]:
    return _ints([value for row in rows for value in (*row, *[0] * (width - len(row)))])


def _row_count(machine: Machine) -> int:
    """How many machines the entries describe, also those without an effect."""
    found = {join(place): array for place, array in arrays(machine)}
    if "mechanism.assembled_at" in found:
        raise ShapeError(
            "mechanism.assembled_at cannot vary from machine to machine in a batch: the places of the joints "
            "are those of one crank angle; compute machines with others one by one"
        )
    shapes = {array.shape for array in found.values()}
    if len(shapes) > 1 or any(len(shape) != 1 or not shape[0] for shape in shapes):
        given = ", ".join(f"{address} {array.shape}" for address, array in found.items())
        raise ShapeError(f"arrays of one length are needed, found shapes {given}")
    return shapes.pop()[0] if shapes else 1


def _columns(parameters: list[Any], varying: list[int], n: int) -> tuple[Floats, NDArray[np.int32], Floats]:
    """First row of all parameters; which vary; their values (k, n)."""
    columns = [np.asarray(parameters[slot], dtype=np.float64) for slot in varying]
    first = list(parameters)
    for slot, column in zip(varying, columns, strict=True):
        first[slot] = column[0]
    values = np.ascontiguousarray(columns) if columns else np.empty((0, n))
    return np.array(first, dtype=np.float64), _ints(varying), values
