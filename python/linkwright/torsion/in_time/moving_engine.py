r"""An engine in motion: the inertia of its throws over the angle, torques of gas and weight.

Nothing is linear here: a throw at the angle φ + α has the inertia J(φ + α), and its swinging changes both.
What linear vibration calls inertia torque, :math:`-\tfrac12 J'\Omega^2`, is part of the motion's own
equation.

A cylinder gives the torque of its gas without combustion, and on top of it, with a weight over time, what the
combustion adds. Both are taken at one speed.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.core.curve import Curve, product, switched
from linkwright.kernel.core.periodic_table import PeriodicTable, smooth, waves
from linkwright.torsion.core.torque import TrainTorque
from linkwright.torsion.core.transient import VariableInertia, variable_inertia
from linkwright.torsion.model.engine.engine import ReciprocatingEngine
from linkwright.torsion.model.engine.engine_motion import reduced_throw
from linkwright.torsion.model.engine.firing import firing_angles
from linkwright.torsion.model.train_event import FuelSwitch, Misfire
from linkwright.torsion.model.train_transient import TrainTransient
from linkwright.torsion.response.engine_torques import cylinder_torques

Floats = NDArray[np.float64]

# Name of what combustion adds in a cylinder, before its number.
COMBUSTION = "combustion_"

# Angles over one revolution at which a throw is reduced: far beyond its harmonics.
_SAMPLES = 256


def throw_inertias(engine: ReciprocatingEngine) -> list[VariableInertia]:
    """Inertia of each throw with its rods and pistons over the angle."""
    phi = 2 * np.pi * np.arange(_SAMPLES) / _SAMPLES
    reduced = reduced_throw(engine, phi)
    first = variable_inertia(0, reduced.inertia_reduced, reduced.inertia_reduced_d1)
    return [VariableInertia(n, first.table, angle) for n, angle in enumerate(engine.throws)]


def engine_motion_torques(
    engine: ReciprocatingEngine, manoeuvre: TrainTransient, speed: float, highest: float
) -> list[TrainTorque]:
    """Torques of gas and weight on the throws.

    ``"gas_N"`` of each cylinder without combustion, ``"combustion_N"`` on top of it, ``"weight_N"`` of each
    throw. `speed`: [rad/s].
    """
    fires, _ = firing_angles(engine.places, engine.firing_order, engine.cycle)
    motored, added = _gas_tables(engine, speed, highest)
    found = []
    for n, (place, angle) in enumerate(zip(engine.places, fires, strict=True)):
        number = n + 1
        gas = TrainTorque(f"gas_{number}", place.throw, shape=motored[place.bank], phase=-float(angle))
        factor = engine.factor(number)
        burns = TrainTorque(
            f"{COMBUSTION}{number}",
            place.throw,
            factor,
            shape=added[place.bank],
            phase=-float(angle),
            weight=combustion_weight(manoeuvre, number),
        )
        found += [gas, burns]
    return [*found, *_weights(engine)]


def combustion_weight(manoeuvre: TrainTransient, cylinder: int) -> Curve | None:
    """Share of the combustion in a cylinder over time. None if it burns all the time."""
    fuel = [
        (each.time, float(each.kind == "fuel_on"), each.over)
        for each in manoeuvre.events
        if isinstance(each, FuelSwitch)
    ]
    weight = switched(fuel, manoeuvre.fuel) if fuel or manoeuvre.fuel != 1.0 else None
    for change in _misfires(manoeuvre, cylinder):
        weight = change if weight is None else product(weight, change)
    return weight


def _misfires(manoeuvre: TrainTransient, cylinder: int) -> Iterator[Curve]:
    """Share that each event leaves to a cylinder."""
    for each in manoeuvre.events:
        if isinstance(each, Misfire) and cylinder in each.cylinders:
            end = [(each.end, 1.0, 0.0)] if np.isfinite(each.end) else []
            yield switched([(each.time, each.factor, 0.0), *end])


def _gas_tables(
    engine: ReciprocatingEngine, speed: float, highest: float
) -> tuple[list[PeriodicTable], list[PeriodicTable]]:
    """Torque of a cylinder of each bank without combustion, and what the combustion adds."""
    gas = cylinder_torques(engine, np.array([speed]), highest)
    turns = engine.strokes // 2

    def table(harmonics: NDArray[np.complex128]) -> PeriodicTable:
        wave = harmonics[1:]
        return waves(gas.orders[1:].tolist(), np.abs(wave), np.angle(wave), turns, float(harmonics[0].real))

    motored = [table(each.motored[0]) for each in gas.banks]
    added = [table(each.firing[0] - each.motored[0]) for each in gas.banks]
    return motored, added


def _weights(engine: ReciprocatingEngine) -> list[TrainTorque]:
    """Torque of the weights of each throw."""
    phi = 2 * np.pi * np.arange(_SAMPLES) / _SAMPLES
    table = smooth(reduced_throw(engine, phi).weight_torque)
    return [
        TrainTorque(f"weight_{n + 1}", n, shape=table, phase=angle) for n, angle in enumerate(engine.throws)
    ]
