"""What the speed of a disc is, however strongly, late or tight each cylinder of an engine works.

A weak cylinder is no small change for the train: loads take off less, pulsate and damp by as much less, and a
coupling that stiffens under torque becomes softer. Each state of the engine therefore has its own torques,
mean torques, stiffness and damping. The gas is computed once.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.errors import InputError
from linkwright.machine.machine import Machine
from linkwright.torsion.core.train import refer
from linkwright.torsion.diagnosis.cylinder_response import disc_speed
from linkwright.torsion.modes.free import train_of
from linkwright.torsion.response.engine_torques import CylinderStates, cylinder_torques, throw_sources
from linkwright.torsion.response.excited_train import ExcitedTrain, highest_order, under

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]

# Step by which derivatives are taken. Harmonics are linear in what cylinders burn and compress but for what
# operating points change, so that it may be large against rounding; by a delay of this the highest orders
# turn by some thousandths [–, rad].
_STEP = 1e-4


class EngineSpeed:
    """Speed of one disc of an engine at one speed of its crank. `speed`: mean speed of the crank [rad/s]."""

    def __init__(self, machine: Machine, speed: float, disc: str, *, rigid: bool = False) -> None:
        train = machine.train
        if train is None or train.engine is None:
            raise InputError(
                f"{machine.name} has no [train.engine]: expected one whose cylinders are to be judged"
            )
        self.machine, self.engine, self.disc, self.rigid = machine, train.engine, disc, rigid
        self.train = train_of(machine)
        self.referred = refer(self.train)
        self.gas = cylinder_torques(self.engine, np.array([speed]), highest_order(train))

    def states(self, values: Floats) -> ExcitedTrain:
        """The train in some states of its cylinders.

        A column for each state, all at the same speed. `values`: (kinds · cylinders, states) [rad].
        """
        speeds = np.repeat(self.gas.banks[0].speeds, values.shape[1])
        combustion, *further = np.split(values, len(values) // self.engine.n_cylinders)
        delay, compression = further or (0.0, 0.0)
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
        orders, found = self.harmonics(np.column_stack([values, beside]))
        return orders, found[0], (found[1:] - found[0]) / _STEP
