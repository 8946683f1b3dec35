r"""A train with mechanisms as masses and links, referred to the crank of its first mechanism.

The crank of mechanism k turns with its disc and leads it by β_k. With the speeds n of the discs over that of
the first one, the angle φ of the first mechanism and the twist δ of the disc against its crank

.. math:: \psi_k = r_k\,(\varphi + \delta - \beta_1) + \beta_k, \qquad r_k = n_k/n_1

so that the motion repeats where all cycles have passed together. A load or driver with the torque
:math:`M_0 (\omega/\omega_0)^p` at a disc counts with :math:`r M_0` at :math:`\omega_0/r`. Damping of a disc
from outside acts on its speed against the rotation of the train as a whole, as it does in motion in time.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from linkwright.drive.model.motor import ConstantSpeedMotor
from linkwright.driveline.carried import require_carried
from linkwright.driveline.chain import Chain, Driven, Outside, Stand, chain_of, links_of, order_of
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError, SteadyStateError
from linkwright.kernel.numerics.tangent import Tangent, numbers, primal
from linkwright.linkages.closure import turn_angles
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine
from linkwright.machine.tangents import directions
from linkwright.torsion.core.torque import motor_machine, motor_program
from linkwright.torsion.core.train import ReferredTrain, refer
from linkwright.torsion.excitation.drive_line import mounted_mechanism
from linkwright.torsion.in_time.moving_train import shaft_damping
from linkwright.torsion.model.train import Train

# Revolutions of the first crank after which all mechanisms shall be back.
_TURNS_MAX = 24

# Share by which rounding takes a ratio off a fraction.
_WHOLE = 1e-9

# Angles of a revolution at which mean inertia and mean torque of a mechanism are taken, speeds at which a
# balance is sought, and how often the highest of them is doubled.
_ANGLES = 180
_SPEEDS = 400
_DOUBLINGS = 6


class _Mounted(NamedTuple):
    """A mechanism on its disc."""

    name: str
    compiled: CompiledMachine
    disc: int
    ratio: float  # speed of its crank over that of the first mechanism
    phase: float  # its crank angle where that of the first is zero, without twist [rad]

    @property
    def inertia(self) -> Any:
        """Its mean inertia, referred to the first crank [kg m²]."""
        at = self.compiled.reductions(turn_angles(_ANGLES, self.compiled.turns)[:-1])
        return self.ratio**2 * float(at.inertia.mean())

    def torque(self, speeds: Floats) -> Floats:
        """Its mean resistance at constant speeds of the first crank, referred to that [N m]."""
        phi, own = turn_angles(_ANGLES, self.compiled.turns)[:-1], self.ratio * speeds
        at = self.compiled.reductions(phi)
        torque: Floats = (at.load + at.dry).mean() + at.viscous.mean() * own
        torque = torque + self.compiled.speed_load(own)
        if self.compiled.has_laws:
            torque = torque + self.compiled.law_torques(phi, own).mean(axis=1)
        return self.ratio * torque


def driven_train(machine: Machine) -> Driven:
    """Masses, links, torques and mechanisms of a train; its mean torques balance at the speed."""
    chain, mounted = _chain(machine)
    compiled = mounted[0].compiled.over_turns(_turns(mounted))
    return Driven(compiled, chain, _balance(machine, chain, mounted))


def moving_train(machine: Machine, *, motor: bool = True) -> Driven:
    """Masses, links, torques and mechanisms of a train that moves in time; the speed is that at work, about.

    `motor`: whether what drives is on.
    """
    chain, mounted = _chain(machine)
    if chain.held is not None:
        kinds = [each.kind for each in chain.links["drivers"]]
        raise InputError(
            f"train.motors.{chain.motors[kinds.index('held')]}.motor.kind: found constant_speed, which has "
            "no motion in time; expected a motor whose torque follows its speed"
        )
    if not motor:
        off = [Outside(each.mass, "power", (0.0, 1.0, 0.0)) for each in chain.links["drivers"]]
        chain = chain._replace(links=chain.links | {"drivers": off})
    try:
        speed = _balance(machine, chain, mounted)
    except SteadyStateError:
        # silent: it moves all the same; only sizes are compared with the speed
        speed = _highest(machine, chain)
    return Driven(mounted[0].compiled, chain, speed)


def driveline_chain(machine: Machine, inertia: Any = None) -> Chain:
    """Masses and links of a train with mechanisms, or of the driveline that [drive] describes.

    `inertia`: mean inertia of the first mechanism, if it is not that of its machine [kg m²].
    """
    return _chain(machine, inertia)[0] if machine.has_mounted_mechanisms else chain_of(machine, inertia)


def _chain(machine: Machine, inertia: Any = None) -> tuple[Chain, list[_Mounted]]:
    train = machine.train
    assert train is not None
    require_carried(train)
    referred = refer(train)
    mounted = _mounted(machine, train, referred)
    first = mounted[0]
    n = 1.0 / referred.speed[first.disc]
    order = order_of(len(referred.inertia), int(referred.mass[first.disc]))
    mass, ratio, last = order[referred.mass], referred.speed * n, len(order) - 1
    own, by_mass = (referred.inertia * n**2)[np.argsort(order)], [0.0] * len(order)
    for one in mounted[1:]:
        by_mass[mass[one.disc]] = by_mass[mass[one.disc]] + one.inertia
    felt = numbers(by_mass)
    mean = own + felt + (first.inertia if inertia is None else inertia) * (np.arange(len(order)) == last)
    # Frequencies at which hysteresis counts are those with the mean inertia of the mechanisms.
    whole = replace(referred, inertia=mean[order] / n**2)
    damping, notes = shaft_damping(whole)
    links = links_of(train, referred, n, order, list(range(len(referred.shafts))), damping)
    place = {name: (int(mass[k]), ratio[k]) for k, name in enumerate(referred.discs)}
    drivers = dict(_drivers(machine, train, place))
    damped = (referred.disc_damping * n**2)[np.argsort(order)]
    links |= {
        "apart": -own[last],
        "drivers": list(drivers.values()),
        "loads": [
            _power(place[load.on], -load.torque, load.speed, load.exponent) for load in train.loads.values()
        ],
        "stations": [Stand(int(mass[one.disc]), one.compiled, one.ratio, one.phase) for one in mounted[1:]],
        "swing": (damped, mean / mean.sum()) if primal(damped).any() else None,
    }
    on = [_on(train, name) for name in drivers]
    held = [
        place[motor.on][0] for motor in train.motors.values() if isinstance(motor.motor, ConstantSpeedMotor)
    ]
    chain = Chain(
        referred.discs,
        ratio,
        mass,
        referred.shafts,
        referred.lead * n,
        links,
        crank=referred.discs[first.disc],
        motors=tuple(drivers),
        motor_ratio=numbers([place[disc][1] for disc in on]),
        felt=primal(felt),
        held=held[0] if held else None,
        notes=tuple(notes),
    )
    return chain, mounted


def _mounted(machine: Machine, train: Train, referred: ReferredTrain) -> list[_Mounted]:
    found: list[_Mounted] = []
    lead = 0.0
    for name, mechanism in train.mechanisms.items():
        disc = referred.discs.index(mechanism.on)
        compiled = mounted_mechanism(machine, name)
        ratio = referred.speed[disc] / referred.speed[found[0].disc] if found else 1.0
        lead = lead if found else mechanism.phase
        found.append(_Mounted(name, compiled, disc, ratio, mechanism.phase - ratio * lead))
    return found


def _turns(mounted: list[_Mounted]) -> int:
    """Revolutions of the first crank after which all mechanisms are back."""
    turns = 1
    for one in mounted:
        cycles = Fraction(one.ratio).limit_denominator(_TURNS_MAX)
        together = math.lcm(turns, (cycles / one.compiled.turns).denominator)
        if abs(float(cycles) / one.ratio - 1) > _WHOLE or together > _TURNS_MAX:
            raise InputError(
                f"train.mechanisms.{one.name}: its crank turns {one.ratio:.8g} times as fast as that of "
                f"{mounted[0].name}, so that both do not repeat together within {_TURNS_MAX} revolutions; "
                "choose gears whose ratio is one of small whole numbers"
            )
        turns = together
    return turns


def _drivers(
    machine: Machine, train: Train, place: dict[str, tuple[int, float]]
) -> Iterator[tuple[str, Outside]]:
    for name, motor in train.motors.items():
        yield name, _motor(motor.motor, *place[motor.on])
    for name, driver in train.drivers.items():
        if driver.torque is None:
            raise InputError(
                f"train.drivers.{name}.torque: found nothing, expected the torque of a driver in steady "
                "motion with mechanisms; give it, or describe the motor as [train.motors]"
            )
        yield name, _power(place[driver.on], driver.torque, driver.speed or 1.0, driver.exponent)
    if not (train.motors or train.drivers):
        raise InputError(f"{machine.name}: steady motion needs a motor; add [train.motors.NAME]")


def _on(train: Train, name: str) -> str:
    """Disc of a motor or driver."""
    return train.motors[name].on if name in train.motors else train.drivers[name].on


def _motor(motor: Any, mass: int, ratio: float) -> Outside:
    """A motor whose disc turns at a ratio to the crank, which stands for its gears."""
    if isinstance(motor, ConstantSpeedMotor):
        return Outside(mass, "held", (motor.speed / ratio,))
    moving = {name: x for name, x in vars(motor).items() if isinstance(x, Tangent)}
    known = motor.model_copy(update={name: float(primal(x)) for name, x in moving.items()})
    compiled = motor_program(known, float(primal(ratio)))
    slopes = {f"drive.motor.{name}": x.d for name, x in moving.items() if x.d.any()}
    if isinstance(ratio, Tangent) and ratio.d.any():
        slopes["drive.gearbox.ratio"] = ratio.d
    if not slopes:
        return Outside(mass, "motor", compiled.one, compiled)
    along = directions(motor_machine(known, float(primal(ratio))), [*slopes])
    if along.refused:
        raise InputError(next(iter(along.refused.values())))
    values = along.values @ np.array([slopes[name] for name in along.variables])
    return Outside(mass, "motor", Tangent(compiled.one, values), compiled)


def _power(place: tuple[int, float], torque: float, speed: float, exponent: float) -> Outside:
    mass, ratio = place
    return Outside(mass, "power", (torque * ratio, speed / ratio, exponent))


def _balance(machine: Machine, chain: Chain, mounted: list[_Mounted]) -> float:
    """Highest speed of the first crank at which the mean torques balance stably, as if all was rigid."""
    train = machine.train
    assert train is not None
    if chain.speed_held is not None:
        return chain.speed_held
    ratio = dict(zip(chain.stations, chain.ratio.tolist(), strict=True))
    highest = _highest(machine, chain)
    for _ in range(_DOUBLINGS):
        speeds = np.linspace(highest / _SPEEDS, highest, _SPEEDS)
        net = _net(train, ratio, mounted, speeds)
        stable = np.flatnonzero((net[:-1] > 0) & (net[1:] <= 0))
        if len(stable):
            k = stable[-1]
            share = net[k] / (net[k] - net[k + 1])
            return float(speeds[k] + share * (speeds[k + 1] - speeds[k]))
        if not (net > 0).any():
            raise SteadyStateError(
                f"no steady motion of the train: up to {highest:.4g} rad/s of the first crank the mean "
                f"torque of the loads exceeds that of the motors, at {speeds[net.argmax()]:.4g} rad/s by "
                f"{-net.max():.4g} N m; choose larger motors or smaller loads"
            )
        highest *= 2
    raise SteadyStateError(
        "no steady motion of the train: the motors drive more than the loads take at every speed up to "
        f"{highest / 2:.4g} rad/s of the first crank; give loads that grow with the speed, or motors whose "
        "torque falls with it"
    )


def _highest(machine: Machine, chain: Chain) -> float:
    """A speed of the first crank above that at which mean torques balance, about [rad/s]."""
    train = machine.train
    assert train is not None
    ratio = dict(zip(chain.stations, chain.ratio.tolist(), strict=True))
    known = [
        float(motor.motor.speed_without_load) / ratio[motor.on]
        for motor in train.motors.values()
        if motor.motor.speed_without_load is not None
    ]
    known += [2 * load.speed / ratio[load.on] for load in train.loads.values()]
    known += [2 * one.speed / ratio[one.on] for one in train.drivers.values() if one.speed is not None]
    return max(known, default=100.0)


def _net(train: Train, ratio: dict[str, float], mounted: list[_Mounted], speeds: Floats) -> Floats:
    """Mean torque of drivers less that of loads at speeds of the first crank, referred to that [N m]."""
    net: Floats = -np.sum([one.torque(speeds) for one in mounted], axis=0)
    for motor in train.motors.values():
        net = net + motor_program(motor.motor, ratio[motor.on]).motor_torques(speeds).crank
    for name in train.drivers:
        driver = train.drivers[name]
        net = net + np.array([ratio[driver.on] * driver.torque_at(ratio[driver.on] * w) for w in speeds])
    for load in train.loads.values():
        net = net - np.array([ratio[load.on] * load.resistance(ratio[load.on] * w) for w in speeds])
    return net
