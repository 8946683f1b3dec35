r"""A torsionally flexible driveline as masses and links, referred to the speed of the crank.

A disc that turns n times as fast as the crank counts there with n² J, a shaft at its own speed with n² k
and n² c. The last mass is the crank; the mechanism on it has its inertia and loads by the core's reduction. A
motor of constant speed holds the end of the driveline: it is a mass that keeps its speed.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from linkwright.drive.model.drive import Drive
from linkwright.drive.model.motor import ConstantSpeedMotor
from linkwright.kernel.arrays import Floats, Integers
from linkwright.kernel.numerics.tangent import numbers
from linkwright.machine.machine import Machine
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
    links: dict[str, Any]  # masses and links as the core takes them
    notes: tuple[str, ...]  # what was assumed


def chain_of(machine: Machine, mechanism: Any = None) -> Chain:
    """Masses and links of the driveline of a machine; entries that are tangents go through.

    `mechanism`: its mean inertia, where that is known already [kg m²].
    """
    drive = machine.drive
    assert drive is not None
    if mechanism is None:
        mechanism = mean_inertia(machine) if has_hysteresis(drive) else _ANY
    referred = refer(drive_train(drive, mechanism))
    crank = referred.discs.index(CRANK)
    # All was referred to the first disc.
    n = 1.0 / referred.speed[crank]
    inertia = referred.inertia * n**2
    order = _order(len(inertia), int(referred.mass[crank]))
    ends = np.where(referred.ends == HELD, len(order), np.append(order, 0)[referred.ends])
    damping, notes = shaft_damping(referred)
    # From the motor on.
    row = [
        referred.shafts.index(name) for name in (MOTOR_SHAFT, GEARS, CRANKSHAFT) if name in referred.shafts
    ]
    lead, ends = referred.lead[row] * n, ends[row]
    own = inertia[referred.mass[crank]] - mechanism
    others = inertia[np.argsort(order)[:-1]]
    links: dict[str, Any] = {
        "inertia": others,
        "apart": drive_inertia(drive) - own,
        "first": np.ascontiguousarray(ends[:, 0], dtype=np.int32),
        "second": np.ascontiguousarray(ends[:, 1], dtype=np.int32),
        "stiffness": referred.stiffness[row] * n**2,
        "damping": damping[row] * lead**2,
        "driven": int(order[referred.mass[_driven(referred)]]),
        "held": None,
    }
    shafts = tuple(referred.shafts[k] for k in row)
    stations, ratio, mass = referred.discs, referred.speed * n, order[referred.mass]
    if isinstance(drive.motor, ConstantSpeedMotor):
        links |= _held(links, drive.motor.speed / drive.gearbox.ratio)
        # The motor is the mass before the crank, which moves on by one.
        held = links["driven"]
        mass = np.append(held, np.where(mass == held, held + 1, mass))
        stations, ratio = (MOTOR, *stations), np.concatenate([numbers([drive.gearbox.ratio]), ratio])
    return Chain(stations, ratio, mass, shafts, lead, links, tuple(notes))


def has_hysteresis(drive: Drive) -> bool:
    """Whether a loss factor stands for viscous damping, by the mean inertia of the mechanism."""
    return any(shaft is not None and shaft.loss_factor for shaft in (drive.motor_shaft, drive.crankshaft))


def _order(masses: int, crank: int) -> Integers:
    """New number of each mass: the crank comes last."""
    order: Integers = np.arange(masses, dtype=np.int32)
    order[crank + 1 :] -= 1
    order[crank] = masses - 1
    return order


def _driven(referred: ReferredTrain) -> int:
    return referred.discs.index(MOTOR) if MOTOR in referred.discs else 0


def _held(links: dict[str, Any], speed: float) -> dict[str, Any]:
    """The motor as one mass more, before the crank, in the place of what is held."""
    last = len(links["inertia"])
    # The crank moves on by one; what is held has had the number behind it.
    ends = {
        end: np.select([links[end] == last, links[end] == last + 1], [last + 1, last], links[end]).astype(
            np.int32
        )
        for end in ("first", "second")
    }
    return {**ends, "inertia": np.concatenate([links["inertia"], [1.0]]), "driven": last, "held": speed}


def listed(chain: Chain) -> Any:
    """Numbers of a driveline in the core's order, which may be tangents: see `Chain::numbers` there."""
    links = chain.links
    of_links = [x for name in zip(links["stiffness"], links["damping"], strict=True) for x in name]
    held = [] if links["held"] is None else [links["held"]]
    return numbers([*links["inertia"], links["apart"], *of_links, *held])


def fastest(chain: Chain, inertia: float, period: float) -> float:
    """Size of the fastest eigenvalue whose disturbances last for a cycle; 0 where none does [1/s].

    `inertia`: all that the crank feels, also of the drive [kg m²]; `period`: of a cycle [s].
    """
    one = fastest_of(chain, np.asarray(listed(chain))[None], np.array([inertia]), np.array([period]))
    return float(one[0])


def fastest_of(chain: Chain, rows: Floats, inertia: Floats, period: Floats) -> Floats:
    """The same of drivelines of one form, (n,). `rows`: their numbers as `listed` has them, (n, numbers)."""
    links, others, shafts = chain.links, len(chain.links["inertia"]), len(chain.shafts)
    apart = rows[:, others]
    stiffness, damping = (rows[:, others + 1 + k : others + 1 + 2 * shafts : 2] for k in (0, 1))
    joins = np.zeros((shafts, others + 1))
    at = np.arange(shafts)
    joins[at, links["first"]], joins[at, links["second"]] = 1.0, -1.0
    J = np.column_stack([rows[:, :others], np.maximum(inertia - apart, 0.0)])
    if links["held"] is not None:
        joins[:, links["driven"]] = 0.0
    has_inertia = np.asarray((J > 0).all(axis=1))
    size = np.where(has_inertia[:, None], J, 1.0)[:, :, None]
    K, C = (-np.einsum("sa,ns,sb->nab", joins, rates, joins) / size for rates in (stiffness, damping))
    unit = np.broadcast_to(np.eye(others + 1), K.shape)
    system = np.block([[np.zeros_like(K), unit], [K, C]])
    found = np.linalg.eigvals(system)
    lasting = np.asarray(found.real * period[:, None] > np.log(_GONE))
    fastest: Floats = np.where(lasting & has_inertia[:, None], np.abs(found), 0.0).max(axis=1, initial=0.0)
    return fastest
