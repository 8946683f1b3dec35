r"""A torsionally flexible driveline as masses and links, referred to the speed of the crank.

A disc that turns n times as fast as the crank counts there with n² J, a shaft at its own speed with n² k
and n² c. The last mass is the crank; the mechanism on it has its inertia and loads by the core's reduction. A
motor of constant speed holds the end of the driveline: it is a mass that keeps its speed. A train with
mechanisms is in `train_chain`.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from linkwright.drive.model.drive import Drive
from linkwright.drive.model.motor import ConstantSpeedMotor
from linkwright.kernel.arrays import Floats, Integers
from linkwright.kernel.numerics.tangent import numbers, primal
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine
from linkwright.machine.program.core import DrivelineStation, DrivelineTorque
from linkwright.machine.program.drive_line import drive_inertia
from linkwright.torsion.core.train import HELD, ReferredTrain, refer
from linkwright.torsion.excitation.drive_line import mean_inertia
from linkwright.torsion.in_time.moving_train import shaft_damping
from linkwright.torsion.model.coupling import Coupling
from linkwright.torsion.model.drive_train import CRANK, CRANKSHAFT, GEARS, MOTOR, MOTOR_SHAFT, drive_train
from linkwright.torsion.model.train import Train
from linkwright.torsion.model.whole_train import whole_train

# Share of a disturbance below which it is gone.
_GONE = 1e-8

# Inertia of the mechanism where it is of no account: it is taken off again [kg m²].
_ANY = 1.0


class Outside(NamedTuple):
    """A torque on a mass from outside. Its numbers, which may be tangents, are those of the core."""

    mass: int
    kind: str = "own"  # "own": by the machine's own motor; or "held", "motor", "power"
    numbers: Any = ()  # "held": speed; "power": torque, speed, exponent; "motor": those of its program
    program: CompiledMachine | None = None  # of a "motor"

    def core(self) -> DrivelineTorque:
        """For the core."""
        if self.program is not None:
            return DrivelineTorque.motor(self.mass, self.program.plan, np.ascontiguousarray(self.numbers))
        values = [float(x) for x in self.numbers]
        if self.kind == "power":
            torque, speed, exponent = values
            return DrivelineTorque.power(self.mass, torque=torque, speed=speed, exponent=exponent)
        return DrivelineTorque.held(self.mass, values[0]) if values else DrivelineTorque.own(self.mass)


class Stand(NamedTuple):
    """A further mechanism on a mass."""

    mass: int
    compiled: CompiledMachine
    ratio: Any  # speed of its crank over that of the mass
    phase: Any  # its crank angle where that of the mass is zero [rad]

    def core(self) -> DrivelineStation:
        """For the core."""
        compiled = self.compiled
        return DrivelineStation(
            self.mass, compiled.plan, compiled.one, ratio=float(self.ratio), phase=float(self.phase)
        )


class Chain(NamedTuple):
    """Masses and links of a driveline; but for places all numbers may be tangents."""

    stations: tuple[str, ...]  # what turns, from the motor on
    ratio: Floats  # (stations,) speed over that of the crank
    mass: Integers  # (stations,) mass that each belongs to
    shafts: tuple[str, ...]  # what twists
    lead: Floats  # (shafts,) speed at which their torque counts, over that of the crank
    links: dict[str, Any]  # masses, links, torques from outside, further mechanisms
    crank: str  # station whose crank angle counts
    motors: tuple[str, ...]  # what drives
    motor_ratio: Floats  # (motors,) speed of what it drives over that of the crank
    felt: Floats  # (masses,) inertia of further mechanisms [kg m²]
    held: int | None  # mass that keeps its speed
    notes: tuple[str, ...]  # what was assumed

    @property
    def is_linear(self) -> bool:
        """Whether no link has backlash or a curve."""
        return not primal(self.links["gap"]).any() and all(curve is None for curve in self.links["curves"])

    @property
    def speed_held(self) -> float | None:
        """Speed of the crank where a driver keeps its own [rad/s]."""
        kept = [each.numbers[0] for each in self.links["drivers"] if each.kind == "held"]
        return float(kept[0]) if kept else None

    @property
    def joins(self) -> Floats:
        """Twists of the links by angles of the masses, (shafts, masses)."""
        rows = np.arange(len(self.shafts))
        joins = np.zeros((len(rows), len(self.links["inertia"]) + 1))
        joins[rows, self.links["first"]], joins[rows, self.links["second"]] = 1.0, -1.0
        return joins

    @property
    def core(self) -> dict[str, Any]:
        """Masses, links, torques and mechanisms as the core takes them."""
        made = {name: [each.core() for each in self.links[name]] for name in _MADE}
        return self.links | made


_MADE = ("drivers", "loads", "stations")


class Driven(NamedTuple):
    """A driveline with its mechanisms, ready for steady motion."""

    compiled: CompiledMachine  # the mechanism at the crank, over the cycle of all
    chain: Chain
    speed: float  # of the crank, with which the search begins [rad/s]


def chain_of(machine: Machine, mechanism: Any = None) -> Chain:
    """Masses and links of the driveline of a machine that a [drive] describes; tangents go through.

    `mechanism`: its mean inertia, where that is known already [kg m²].
    """
    drive = machine.drive
    assert drive is not None
    if mechanism is None:
        mechanism = mean_inertia(machine) if has_hysteresis(drive) else _ANY
    train = drive_train(drive, mechanism)
    referred = refer(train)
    crank = referred.discs.index(CRANK)
    # All was referred to the first disc.
    n = 1.0 / referred.speed[crank]
    inertia = referred.inertia * n**2
    order = order_of(len(inertia), int(referred.mass[crank]))
    damping, notes = shaft_damping(referred)
    # From the motor on.
    row = [
        referred.shafts.index(name) for name in (MOTOR_SHAFT, GEARS, CRANKSHAFT) if name in referred.shafts
    ]
    own = inertia[referred.mass[crank]] - mechanism
    links = links_of(train, referred, n, order, row, damping)
    links["apart"] = drive_inertia(drive) - own
    held = None
    driver = Outside(int(order[referred.mass[_driven(referred)]]))
    shafts, lead = tuple(referred.shafts[k] for k in row), referred.lead[row] * n
    stations, ratio, mass = referred.discs, referred.speed * n, order[referred.mass]
    if isinstance(drive.motor, ConstantSpeedMotor):
        links |= _held(links)
        # The motor is the mass before the crank, which moves on by one.
        held = len(links["inertia"]) - 1
        mass = np.append(held, np.where(mass == held, held + 1, mass))
        stations, ratio = (MOTOR, *stations), np.concatenate([numbers([drive.gearbox.ratio]), ratio])
        driver = Outside(held, "held", (drive.motor.speed / drive.gearbox.ratio,))
    links |= {"drivers": [driver], "loads": [], "stations": [], "swing": None}
    return Chain(
        stations,
        ratio,
        mass,
        shafts,
        lead,
        links,
        crank=CRANK,
        motors=(MOTOR,),
        motor_ratio=numbers([drive.gearbox.ratio]),
        felt=np.zeros(len(links["inertia"]) + 1),
        held=held,
        notes=tuple(notes),
    )


def links_of(
    train: Train, referred: ReferredTrain, n: Any, order: Integers, row: list[int], damping: Any
) -> dict[str, Any]:
    """Masses but the crank, and links, as the core takes them; tangents go through.

    `n`: speed of the first disc over that of the crank; `order`: new number of each mass; `row`: which
    shafts; `damping`: of all, at their own speeds [N m s/rad].
    """
    names = [referred.shafts[k] for k in row]
    ends = np.where(referred.ends == HELD, len(order), np.append(order, 0)[referred.ends])[row]
    return {
        "inertia": (referred.inertia * n**2)[np.argsort(order)[:-1]],
        "first": np.ascontiguousarray(ends[:, 0], dtype=np.int32),
        "second": np.ascontiguousarray(ends[:, 1], dtype=np.int32),
        "damping": damping[row] * (referred.lead[row] * n) ** 2,
        **_laws(train, names, referred.stiffness[row] * n**2, referred.lead[row] * n),
    }


def _laws(train: Train, names: list[str], stiffness: Any, lead: Any) -> dict[str, Any]:
    """Stiffness of each link, half of its backlash, and its curve, with the steepest slope as stiffness."""
    shafts = whole_train(train).shafts
    parts: list[Any] = [train.gears.get(name) or train.couplings.get(name) or shafts[name] for name in names]
    gaps = [getattr(part, "backlash", 0.0) / 2 for part in parts]
    slopes, curves = list(stiffness), list[Any]()
    for k, (part, n) in enumerate(zip(parts, lead, strict=True)):
        curves.append(None)
        if getattr(part, "twist", None) is not None:
            twist, torque, slope = part.curve() if isinstance(part, Coupling) else part.points
            curves[k] = (twist / n, torque * n, slope * n**2)
            slopes[k] = _steepest(*(primal(points) for points in curves[k]))
    return {"stiffness": numbers(slopes), "gap": numbers(gaps) / lead, "curves": curves}


def _steepest(twist: Floats, torque: Floats, slope: Floats) -> float:
    """A bound of the slope of the cubics through points [N m/rad]."""
    chord = np.diff(torque) / np.diff(twist)
    return float(max(slope.max(), 1.5 * chord.max()))


def has_hysteresis(drive: Drive) -> bool:
    """Whether a loss factor stands for viscous damping, by the mean inertia of the mechanism."""
    return any(shaft is not None and shaft.loss_factor for shaft in (drive.motor_shaft, drive.crankshaft))


def order_of(masses: int, crank: int) -> Integers:
    """New number of each mass: the crank comes last."""
    order: Integers = np.arange(masses, dtype=np.int32)
    order[crank + 1 :] -= 1
    order[crank] = masses - 1
    return order


def _driven(referred: ReferredTrain) -> int:
    return referred.discs.index(MOTOR) if MOTOR in referred.discs else 0


def _held(links: dict[str, Any]) -> dict[str, Any]:
    """The motor as one mass more, before the crank, in the place of what is held."""
    last = len(links["inertia"])
    # The crank moves on by one; what is held has had the number behind it.
    ends = {
        end: np.select([links[end] == last, links[end] == last + 1], [last + 1, last], links[end]).astype(
            np.int32
        )
        for end in ("first", "second")
    }
    return {**ends, "inertia": np.concatenate([links["inertia"], [1.0]])}


def listed(chain: Chain) -> Any:
    """Numbers of a driveline in the core's order, which may be tangents: see `Chain::numbers` there."""
    links = chain.links
    of_links = list(_of_links(links))
    outside = [x for each in (*links["drivers"], *links["loads"]) for x in each.numbers]
    stations = [x for each in links["stations"] for x in (each.ratio, each.phase)]
    swing = [] if links["swing"] is None else [x for part in links["swing"] for x in part]
    return numbers([*links["inertia"], links["apart"], *of_links, *outside, *stations, *swing])


def _of_links(links: dict[str, Any]) -> Iterator[Any]:
    """Stiffness, damping, half of the backlash and points of the curve of every link."""
    names = ("stiffness", "damping", "gap", "curves")
    for *rates, curve in zip(*(links[name] for name in names), strict=True):
        yield from rates
        for point in zip(*(curve or ()), strict=True):
            yield from point


def fastest(chain: Chain, inertia: float, period: float) -> float:
    """Size of the fastest eigenvalue whose disturbances last for a cycle; 0 where none does [1/s].

    `inertia`: all that the crank feels, also of the drive [kg m²]; `period`: of a cycle [s].
    """
    one = fastest_of(chain, np.asarray(listed(chain))[None], np.array([inertia]), np.array([period]))
    return float(one[0])


def fastest_of(chain: Chain, rows: Floats, inertia: Floats, period: Floats) -> Floats:
    """The same of drivelines of one form, (n,). `rows`: their numbers as `listed` has them, (n, numbers)."""
    links, others = chain.links, len(chain.links["inertia"])
    apart = rows[:, others]
    sizes = [3 + (0 if curve is None else 3 * len(curve[0])) for curve in links["curves"]]
    at = others + 1 + np.cumsum([0, *sizes[:-1]])
    stiffness, damping = rows[:, at], rows[:, at + 1]
    joins = chain.joins
    J = np.column_stack([rows[:, :others], np.maximum(inertia - apart, 0.0)]) + chain.felt
    if chain.held is not None:
        joins[:, chain.held] = 0.0
    has_inertia = np.asarray((J > 0).all(axis=1))
    size = np.where(has_inertia[:, None], J, 1.0)[:, :, None]
    K, C = (-np.einsum("sa,ns,sb->nab", joins, rates, joins) / size for rates in (stiffness, damping))
    unit = np.broadcast_to(np.eye(others + 1), K.shape)
    system = np.block([[np.zeros_like(K), unit], [K, C]])
    found = np.linalg.eigvals(system)
    lasting = np.asarray(found.real * period[:, None] > np.log(_GONE))
    fastest: Floats = np.where(lasting & has_inertia[:, None], np.abs(found), 0.0).max(axis=1, initial=0.0)
    return fastest
