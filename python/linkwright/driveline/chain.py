r"""A torsionally flexible driveline as masses and links, referred to the speed of the crank.

A disc that turns n times as fast as the crank counts there with n² J, a shaft at its own speed with n² k
and n² c. The last mass is the crank; the mechanism on it has its inertia and loads by the core's reduction. A
motor of constant speed holds the end of the driveline: it is a mass that keeps its speed. A train with
mechanisms is in `train_chain`.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from linkwright.drive.model.drive import Drive
from linkwright.drive.model.motor import ConstantSpeedMotor
from linkwright.kernel.arrays import Floats, Integers
from linkwright.machine.machine import Machine
from linkwright.machine.program.core import DrivelineTorque
from linkwright.machine.program.drive_line import drive_inertia
from linkwright.torsion.core.train import HELD, ReferredTrain, refer
from linkwright.torsion.excitation.drive_line import mean_inertia
from linkwright.torsion.in_time.moving_train import shaft_damping
from linkwright.torsion.model.drive_train import CRANK, CRANKSHAFT, GEARS, MOTOR, MOTOR_SHAFT, drive_train

# Share of a disturbance below which it is gone.
_GONE = 1e-8

# Inertia of the mechanism where it is of no account: it is taken off again [kg m²].
_ANY = 1.0


class Chain(NamedTuple):
    """Masses and links of a driveline."""

    stations: tuple[str, ...]  # what turns, from the motor on
    ratio: Floats  # (stations,) speed over that of the crank
    mass: Integers  # (stations,) mass that each belongs to
    shafts: tuple[str, ...]  # what twists
    lead: Floats  # (shafts,) speed at which their torque counts, over that of the crank
    links: dict[str, Any]  # masses, links and torques as the core takes them
    crank: str  # station whose crank angle counts
    motors: tuple[str, ...]  # what drives
    motor_ratio: Floats  # (motors,) speed of what it drives over that of the crank
    felt: Floats  # (masses,) inertia of further mechanisms [kg m²]
    held: int | None  # mass that keeps its speed
    notes: tuple[str, ...]  # what was assumed


def chain_of(machine: Machine) -> Chain:
    """Masses and links of the driveline of a machine that a [drive] describes."""
    drive = machine.drive
    assert drive is not None
    mechanism = mean_inertia(machine) if _has_hysteresis(drive) else _ANY
    referred = refer(drive_train(drive, mechanism))
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
    links = links_of(referred, n, order, row, damping)
    links["apart"] = float(drive_inertia(drive)) - own
    driven, held = int(order[referred.mass[_driven(referred)]]), None
    shafts, lead = tuple(referred.shafts[k] for k in row), referred.lead[row] * n
    stations, ratio, mass = referred.discs, referred.speed * n, order[referred.mass]
    if isinstance(drive.motor, ConstantSpeedMotor):
        links |= _held(links)
        # The motor is the mass before the crank, which moves on by one.
        held = driven = len(links["inertia"]) - 1
        mass = np.append(held, np.where(mass == held, held + 1, mass))
        stations, ratio = (MOTOR, *stations), np.append(drive.gearbox.ratio, ratio)
        driver = DrivelineTorque.held(held, float(drive.motor.speed) / drive.gearbox.ratio)
    else:
        driver = DrivelineTorque.own(driven)
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
        motor_ratio=np.array([drive.gearbox.ratio]),
        felt=np.zeros(len(links["inertia"]) + 1),
        held=held,
        notes=tuple(notes),
    )


def links_of(
    referred: ReferredTrain, n: float, order: Integers, row: list[int], damping: Floats
) -> dict[str, Any]:
    """Masses but the crank, and links, as the core takes them.

    `n`: speed of the first disc over that of the crank; `order`: new number of each mass; `row`: which
    shafts; `damping`: of all, at their own speeds [N m s/rad].
    """
    inertia, last = referred.inertia * n**2, len(order)
    ends = np.where(referred.ends == HELD, last, np.append(order, 0)[referred.ends])[row]
    others = np.empty(last - 1)
    others[order[order < last - 1]] = inertia[order < last - 1]
    return {
        "inertia": others,
        "first": np.ascontiguousarray(ends[:, 0], dtype=np.int32),
        "second": np.ascontiguousarray(ends[:, 1], dtype=np.int32),
        "stiffness": referred.stiffness[row] * n**2,
        "damping": damping[row] * (referred.lead[row] * n) ** 2,
    }


def _has_hysteresis(drive: Drive) -> bool:
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
    return {**ends, "inertia": np.append(links["inertia"], 1.0)}


def fastest(chain: Chain, inertia: float, period: float) -> float:
    """Size of the fastest eigenvalue whose disturbances last for a cycle; 0 where none does [1/s].

    `inertia`: all that the crank feels, also of the drive [kg m²]; `period`: of a cycle [s].
    """
    links, n = chain.links, len(chain.links["inertia"]) + 1
    joins = np.zeros((len(chain.shafts), n))
    rows = np.arange(len(joins))
    joins[rows, links["first"]], joins[rows, links["second"]] = 1.0, -1.0
    J = np.append(links["inertia"], max(inertia - links["apart"], 0.0)) + chain.felt
    if chain.held is not None:
        joins[:, chain.held] = 0.0
    if not J.min() > 0:
        return 0.0
    K, C = (-(joins.T * links[name]) @ joins / J[:, None] for name in ("stiffness", "damping"))
    system = np.block([[np.zeros((n, n)), np.eye(n)], [K, C]])
    found = np.linalg.eigvals(system)
    lasting = found[found.real * period > np.log(_GONE)]
    return float(np.abs(lasting).max(initial=0.0))
