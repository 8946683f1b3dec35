"""The moving parts of an engine: its running gears, pistons over the turn, inertia of a throw over its angle."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from linkwright.machine.reciprocating.engine import ReciprocatingEngine
from linkwright.machine.reciprocating.equivalent_inertia import throw_inertia
from linkwright.machine.reciprocating.running_gear import RunningGear, throw_motion
from linkwright.machine.reciprocating.throw_compliance import compliance
from linkwright.machine.reciprocating.throw_inertia import throw_mass

Floats = NDArray[np.float64]

# Angles over a turn at which pistons are placed: far beyond the harmonics of any rod that closes with room to spare.
_SAMPLES = 256


def running_gears(engine: ReciprocatingEngine) -> tuple[RunningGear, ...]:
    """Rod and piston of each bank, as they stand on one throw.

    Parameters
    ----------
    engine : ReciprocatingEngine
        The engine.

    Returns
    -------
    tuple of RunningGear
        In the order of the banks.
    """
    rods = [engine.rod] + [engine.articulated or engine.rod] * (len(engine.banks) - 1)
    return tuple(
        RunningGear(rod, engine.piston_mass, bank, name=f"bank {n + 1}")
        for n, (rod, bank) in enumerate(zip(rods, engine.banks, strict=True))
    )


def piston_positions(engine: ReciprocatingEngine) -> list[Floats]:
    """Distance of the pistons of each bank from the axis of the crankshaft.

    Parameters
    ----------
    engine : ReciprocatingEngine
        The engine.

    Returns
    -------
    list of ndarray, shape (n,)
        At n even angles over a turn of the throw, from where it points along the cylinder [m].
    """
    turn = 2 * math.pi * np.arange(_SAMPLES) / _SAMPLES
    gears = running_gears(engine)
    return [
        throw_motion(engine.radius, gears, turn + bank)[n].position for n, bank in enumerate(engine.banks)
    ]
