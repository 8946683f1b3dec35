"""Which cylinder of an engine is weak: what the firing of each adds to its torque, from the machine file."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from linkwright.analysis.torsion.diagnosis import Diagnosis, diagnosis
from linkwright.analysis.torsion.engine_torques import cylinder_torques
from linkwright.analysis.torsion.excited import Excited, excited
from linkwright.analysis.torsion.measured_speed import MeasuredSpeed
from linkwright.errors import InputError
from linkwright.machine import Machine
from linkwright.machine.reciprocating.engine import ReciprocatingEngine
from linkwright.public import public

Complexes = NDArray[np.complex128]

# Orders that differ by less are one.
_EQUAL = 1e-9


@public
def engine_diagnosis(
    machine: Machine, measured: MeasuredSpeed, speed: float, *, rigid: bool = False
) -> Diagnosis:
    """Which cylinder of an engine is weak, from the speed measured at a disc.

    Parameters
    ----------
    machine : Machine
        With a [train.engine]; cylinders that its file calls weak are taken as healthy.
    measured : MeasuredSpeed
        At one of its discs, at orders of its torques.
    speed : float
        Mean speed of the crank in the measurement [rad/s].
    rigid : bool
        Whether the train is taken as rigid, to see what that costs.

    Returns
    -------
    Diagnosis
        Factors of the combustion, by number of the cylinder. The gas of the file is that of the load at which
        was measured; at another load `Diagnosis.relative` tells cylinders apart.

    Raises
    ------
    InputError
        The machine has no engine, or the measurement does not fit its train.
    """
    train = machine.train
    if train is None or train.engine is None:
        raise InputError(
            f"{machine.name} has no [train.engine]: expected one whose cylinders are to be judged"
        )
    healthy = train.engine.model_copy(update={"factors": {}})
    sound = machine.model_copy(update={"train": train.model_copy(update={"engine": healthy})})
    at = excited(sound, np.array([speed]))
    return diagnosis(at, firing_sources(healthy, at), measured, rigid=rigid)


def firing_sources(engine: ReciprocatingEngine, at: Excited) -> Complexes:
    """Torque that the combustion of each healthy cylinder adds on its throw.

    Parameters
    ----------
    engine : ReciprocatingEngine
        The engine, whose throws are the first discs of the train.
    at : Excited
        The train, at one speed.

    Returns
    -------
    ndarray of complex, shape (cylinders, orders, discs)
        At the orders of the train's torques, by number of the cylinder [N m].
    """
    orders = at.torques.orders
    gas = cylinder_torques(engine, at.torques.speeds, float(orders.max()))
    found = np.zeros((engine.n_cylinders, len(orders), len(at.referred.discs)), complex)
    added = (gas.firing - gas.motored)[:, :, 0]
    place = np.abs(gas.orders[:, None] - orders).argmin(axis=0)
    fits = np.abs(gas.orders[place] - orders) <= _EQUAL * orders
    for c, cylinder in enumerate(engine.places):
        found[c, fits, cylinder.throw] = added[c, place[fits]]
    return found
