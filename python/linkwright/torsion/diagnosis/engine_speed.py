"""What the speed of a disc is, however strongly, late or tight each cylinder of an engine works.

A weak cylinder is no small change for the train: loads take off less, pulsate and damp by as much less, and a
coupling that stiffens under torque becomes softer. Each state of the engine therefore has its own torques,
mean torques, stiffness and damping. The gas is computed once.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from linkwright.kernel.arrays import Complexes, Floats
from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import InputError
from linkwright.machine.machine import Machine
from linkwright.torsion.core.response import OperatingState, respond
from linkwright.torsion.core.train import ReferredTrain, refer
from linkwright.torsion.excitation.drive_line import train_of
from linkwright.torsion.excitation.engine_torques import CylinderStates, cylinder_torques, throw_sources
from linkwright.torsion.excitation.excited_train import ExcitedTrain, highest_order, under
from linkwright.torsion.model.engine.engine import ReciprocatingEngine
from linkwright.torsion.response.forced import responses


def disc_speed(at: ExcitedTrain, disc: str, *, rigid: bool = False) -> Complexes:
    """Harmonics of the speed of a disc under the torques of its train, (speeds, orders) [rad/s]."""
    place = _place(at.referred, disc)
    if rigid:
        torques = at.referred_harmonics
        q = _rigid(at.referred, at.operating, at.torques.orders, torques)
    else:
        q = responses(at)[:, at.referred.mass[place]]
    omega = at.torques.orders[:, None] * at.torques.speeds
    speed: Complexes = (1j * omega * at.referred.speed[place] * q).T
    return speed


def cylinder_response(at: ExcitedTrain, sources: Complexes, disc: str, *, rigid: bool = False) -> Complexes:
    """Speed harmonics of a disc [rad/s], (sources, orders), by torques (sources, orders, discs) [N m]."""
    referred, many, orders = at.referred, len(sources), at.torques.orders
    place = _place(referred, disc)
    onto = np.zeros((len(referred.discs), len(referred.inertia)))
    onto[np.arange(len(onto)), referred.mass] = referred.speed
    torques = np.ascontiguousarray(np.einsum("sod,dm->oms", sources, onto))
    same = OperatingState(
        np.repeat(at.operating.speeds, many),
        np.repeat(at.operating.stiffness, many, axis=1),
        np.repeat(at.operating.disc_damping, many, axis=1),
        None if at.operating.modal is None else at.operating.modal.repeated(many),
        at.operating.disc_stiffness,
    )
    if rigid:
        q = _rigid(referred, same, orders, torques)
    else:
        q = respond(referred, same, orders, torques)[:, referred.mass[place]]
    speed: Complexes = (1j * orders[:, None] * same.speeds * referred.speed[place] * q).T
    return speed


def _place(referred: ReferredTrain, disc: str) -> int:
    if disc not in referred.discs:
        remedy = suggestion(disc, referred.discs)
        raise InputError(f'the train has no disc "{disc}"' + (f": {remedy}" if remedy else ""))
    return referred.discs.index(disc)


def _rigid(
    referred: ReferredTrain, operating: OperatingState, orders: Floats, torques: Complexes
) -> Complexes:
    """Amplitude of a train that does not twist, (orders, speeds)."""
    if not referred.is_free:
        raise InputError("a train held by the ground has no rigid-body mode: it cannot be taken as rigid")
    omega = orders[:, None] * operating.speeds
    damping = operating.disc_damping.sum(axis=0)
    held = 0.0 if operating.disc_stiffness is None else operating.disc_stiffness.sum()
    q: Complexes = torques.sum(axis=1) / (held - omega**2 * referred.inertia.sum() + 1j * omega * damping)
    return q


# Step by which derivatives are taken. Harmonics are linear in what cylinders burn and compress but for what
# operating points change, so that it may be large against rounding; by a delay of this the highest orders
# turn by some thousandths [–, rad].
_STEP = 1e-4


def the_engine(machine: Machine) -> ReciprocatingEngine:
    """The one engine of a machine. Raises InputError: there is none, or several."""
    if machine.train is None or machine.train.engine is None or machine.train.engines:
        raise InputError(
            f"{machine.name} has no [train.engine] alone: expected one engine, whose cylinders "
            "are to be judged"
        )
    return machine.train.engine


def of_orders(machine: Machine) -> Machine:
    """A machine without its torques of fixed frequency, which no order of a record has.

    Over the crank angle they keep no phase, and leave the mean over many cycles.
    """
    train = machine.train
    if train is None or not any(h.frequency for one in train.excitations.values() for h in one.harmonics):
        return machine
    kept = {
        name: one.with_entries({"harmonics": tuple(h for h in one.harmonics if not h.frequency)})
        for name, one in train.excitations.items()
    }
    excitations = {name: one for name, one in kept.items() if one.harmonics}
    return machine.with_entries({"train": train.with_entries({"excitations": excitations})})


def lines_of_orders(at: ExcitedTrain) -> ExcitedTrain:
    """The same of a train that has been prepared: its lines of orders alone."""
    own, torques = at.torques.offsets == 0, at.torques
    plain = replace(torques, orders=torques.orders[own], harmonics=torques.harmonics[own], fixed=np.empty(0))
    return replace(at, torques=plain)


class EngineSpeed:
    """Speed of one disc of an engine at one speed of its crank. `speed`: mean speed of the crank [rad/s]."""

    def __init__(self, machine: Machine, speed: float, disc: str, *, rigid: bool = False) -> None:
        self.machine, self.engine = of_orders(machine), the_engine(machine)
        self.disc, self.rigid = disc, rigid
        self.train = train_of(self.machine)
        self.referred = refer(self.train)
        self.gas = cylinder_torques(self.engine, np.array([speed]), highest_order(self.train))

    @property
    def bends(self) -> bool:
        """Whether the stiffness follows the mean torque."""
        train = self.machine.train
        return train is not None and any(coupling.twist is not None for coupling in train.couplings.values())

    def states(self, values: Floats) -> ExcitedTrain:
        """The train in states of its cylinders, a column each; values (kinds · cylinders, states) [rad]."""
        speeds = np.repeat(self.gas.banks[0].speeds, values.shape[1])
        combustion, *others = np.split(values, len(values) // self.engine.n_cylinders)
        delay, compression = others or (0.0, 0.0)
        states = CylinderStates(1 + combustion, delay, 1 + compression)
        sources = throw_sources(self.engine, self.gas, states)
        # A record is of steady running: whatever the cylinders give, the loads took it off.
        return under(self.machine, self.train, self.referred, speeds, sources, loads_follow=True)

    def harmonics(self, values: Floats) -> tuple[Floats, Complexes]:
        """Speed of the disc in some states of the cylinders.

        Gives `orders`: (orders,) cycles per revolution of the first disc; `harmonics`: (states, orders)
        [rad/s]. `values`: (kinds · cylinders, states) as of `states`.
        """
        at = self.states(values)
        return at.torques.orders, disc_speed(at, self.disc, rigid=self.rigid)

    def about(self, values: Floats) -> tuple[Floats, Complexes, Complexes]:
        """Speed of the disc in one state, and what a change of each value makes of it.

        Gives `orders`: (orders,) cycles per revolution of the first disc; `harmonics`: (orders,) [rad/s];
        `derivatives`: (kinds · cylinders, orders) by each value, with what loads and couplings do at the
        other operating point [rad/s]. `values`: (kinds · cylinders,) as of `states`.
        """
        beside = values[:, None] + _STEP * np.eye(len(values))
        orders, speed = self.harmonics(np.column_stack([values, beside]))
        return orders, speed[0], (speed[1:] - speed[0]) / _STEP
