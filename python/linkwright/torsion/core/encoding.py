"""The lists in which a train in motion crosses the border.

Their meaning: `crates/linkwright-core/src/torsion/transient/system.rs`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from linkwright import _core
from linkwright.kernel.core.curve import Curve
from linkwright.kernel.core.periodic_table import PeriodicTable
from linkwright.torsion.core.torque import DecayingTorque, GovernorTorque, OverSpeed, Power, TrainTorque
from linkwright.torsion.core.train import HELD

if TYPE_CHECKING:
    from linkwright.torsion.core.transient import MovingTrain

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]


def encoded(train: MovingTrain) -> _core.TorsionSystem:
    """A train in motion as the core takes it."""
    n = train.speed
    tables: list[PeriodicTable] = []
    curves: list[Curve] = []
    at_mass = np.zeros((3, train.masses))
    for row, own in zip(at_mass, (train.inertia, train.damping, train.swing_damping), strict=True):
        np.add.at(row, train.mass, n**2 * own)
    # The last is that of the ground, HELD = −1.
    masses = np.append(train.mass, HELD)
    links = [
        [*masses[ends], _place(curve, curves)]
        for ends, curve in zip(train.tip.tolist(), train.curves, strict=True)
    ]
    rotors = [[train.mass[each.on], _place(each.table, tables)] for each in train.inertias]
    torques = [_torque(train, each, tables, curves) for each in train.torques]
    return _core.TorsionSystem(
        at_mass[0],
        at_mass[1],
        at_mass[2],
        _ints(links),
        _floats(np.column_stack([train.lead, train.stiffness, train.shaft_damping])),
        _ints(rotors),
        _floats([[n[each.on], each.phase] for each in train.inertias]),
        _ints([row for row, _ in torques]),
        _floats([row for _, row in torques]),
        _starts([len(table.value) for table in tables]),
        _floats([table.period for table in tables]),
        _end_to_end([getattr(table, name) for name in ("value", "slope", "bend") for table in tables]),
        _starts([len(curve.x) for curve in curves]),
        _end_to_end([getattr(curve, name) for name in ("x", "y", "before", "after") for curve in curves]),
    )


def _place(thing: Any, shelf: list[Any]) -> int:
    """Where a table or curve stands among those met so far; −1 for none."""
    if thing is None:
        return -1
    for place, each in enumerate(shelf):
        if each is thing:
            return place
    shelf.append(thing)
    return len(shelf) - 1


def _torque(
    train: MovingTrain, torque: TrainTorque, tables: list[PeriodicTable], curves: list[Curve]
) -> tuple[list[int], list[float]]:
    """Row of integers and row of numbers of a torque."""
    kind, numbers = 0, [0.0] * 5
    curve: Curve | None = None
    match torque.law:
        case Power(speed, exponent, is_even):
            kind, numbers = (1 if is_even else 2), [speed, exponent, 0.0, 0.0, 0.0]
        case OverSpeed(over_speed):
            kind, curve = 3, over_speed
        case GovernorTorque(gain, over_time):
            curve = over_time
            kind, numbers = 4, [gain, 0.0, 0.0, 0.0, 0.0]
        case DecayingTorque(start, end, rate, speed, phase):
            kind, numbers = 5, [start, end, rate, speed, phase]
    n = float(train.speed[torque.on])
    row = [int(train.mass[torque.on]), kind, _place(torque.weight, curves), _place(torque.shape, tables)]
    return [*row, _place(curve, curves)], [n, torque.scale, torque.pitch * n, torque.phase, *numbers]


def _starts(lengths: Sequence[int]) -> Ints:
    """Start of each list among lists that lie end to end, and the end of the last."""
    return np.cumsum([0, *lengths], dtype=np.int32)


def _end_to_end(lists: Sequence[Floats]) -> Floats:
    return np.concatenate(lists) if lists else np.empty(0)


def _ints(rows: ArrayLike) -> Ints:
    return np.ascontiguousarray(rows, dtype=np.int32).ravel()


def _floats(rows: ArrayLike) -> Floats:
    return np.ascontiguousarray(rows, dtype=np.float64).ravel()
