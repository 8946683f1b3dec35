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
from linkwright.machine.machine import Machine
from linkwright.machine.program.drive_line import drive_inertia
from linkwright.torsion.core.train import HELD, ReferredTrain, refer
from linkwright.torsion.excitation.drive_line import mean_inertia
from linkwright.torsion.in_time.moving_train import shaft_damping
from linkwright.torsion.model.drive_shaft import LooseShaft
from linkwright.torsion.model.drive_train import CRANK, CRANKSHAFT, GEARS, MOTOR, MOTOR_SHAFT, drive_train
from linkwright.torsion.model.train import Train

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

    @property
    def is_linear(self) -> bool:
        """Whether no link has backlash or a curve."""
        return not self.links["gap"].any() and all(curve is None for curve in self.links["curves"])


def chain_of(machine: Machine) -> Chain:
    """Masses and links of the driveline of a machine."""
    drive = machine.drive
    assert drive is not None
    mechanism = mean_inertia(machine) if _has_hysteresis(drive) else _ANY
    train = drive_train(drive, mechanism)
    referred = refer(train)
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
    others = np.empty(len(order) - 1)
    others[order[order < len(others)]] = inertia[order < len(others)]
    shafts = tuple(referred.shafts[k] for k in row)
    links: dict[str, Any] = {
        "inertia": others,
        "apart": float(drive_inertia(drive)) - own,
        "first": np.ascontiguousarray(ends[:, 0], dtype=np.int32),
        "second": np.ascontiguousarray(ends[:, 1], dtype=np.int32),
        "damping": damping[row] * lead**2,
        **_laws(train, shafts, referred.stiffness[row] * n**2, lead),
        "driven": int(order[referred.mass[_driven(referred)]]),
        "held": None,
    }
    stations, ratio, mass = referred.discs, referred.speed * n, order[referred.mass]
    if isinstance(drive.motor, ConstantSpeedMotor):
        links |= _held(links, float(drive.motor.speed) / drive.gearbox.ratio)
        # The motor is the mass before the crank, which moves on by one.
        held = links["driven"]
        mass = np.append(held, np.where(mass == held, held + 1, mass))
        stations, ratio = (MOTOR, *stations), np.append(drive.gearbox.ratio, ratio)
    return Chain(stations, ratio, mass, shafts, lead, links, tuple(notes))


def _laws(train: Train, names: tuple[str, ...], stiffness: Floats, lead: Floats) -> dict[str, Any]:
    """Stiffness of each link, half of its backlash, and its curve, with the steepest slope as stiffness."""
    parts = [train.gears.get(name) or train.shafts[name] for name in names]
    laws: dict[str, Any] = {
        "stiffness": stiffness,
        "gap": np.array([getattr(part, "backlash", 0.0) / 2 for part in parts]) / lead,
        "curves": [None] * len(parts),
    }
    for k, (part, n) in enumerate(zip(parts, lead, strict=True)):
        if isinstance(part, LooseShaft) and part.twist is not None:
            twist, torque, slope = part.points
            laws["curves"][k] = (twist / n, torque * n, slope * n**2)
            stiffness[k] = _steepest(*laws["curves"][k])
    return laws


def _steepest(twist: Floats, torque: Floats, slope: Floats) -> float:
    """A bound of the slope of the cubics through points [N m/rad]."""
    chord = np.diff(torque) / np.diff(twist)
    return float(max(slope.max(), 1.5 * chord.max()))


def _has_hysteresis(drive: Drive) -> bool:
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
    return {**ends, "inertia": np.append(links["inertia"], 1.0), "driven": last, "held": speed}


def fastest(chain: Chain, inertia: float, period: float) -> float:
    """Size of the fastest eigenvalue whose disturbances last for a cycle; 0 where none does [1/s].

    `inertia`: all that the crank feels, also of the drive [kg m²]; `period`: of a cycle [s].
    """
    links, n = chain.links, len(chain.links["inertia"]) + 1
    joins = np.zeros((len(chain.shafts), n))
    rows = np.arange(len(joins))
    joins[rows, links["first"]], joins[rows, links["second"]] = 1.0, -1.0
    J = np.append(links["inertia"], max(inertia - links["apart"], 0.0))
    if links["held"] is not None:
        joins[:, links["driven"]] = 0.0
    if not J.min() > 0:
        return 0.0
    K, C = (-(joins.T * links[name]) @ joins / J[:, None] for name in ("stiffness", "damping"))
    system = np.block([[np.zeros((n, n)), np.eye(n)], [K, C]])
    found = np.linalg.eigvals(system)
    lasting = found[found.real * period > np.log(_GONE)]
    return float(np.abs(lasting).max(initial=0.0))
