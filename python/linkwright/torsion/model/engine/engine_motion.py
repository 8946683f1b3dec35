"""Moving parts of an engine: running gears, pistons over a revolution, inertia of a throw over its angle."""

from __future__ import annotations

import math

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.torsion.model.engine.engine import ReciprocatingEngine
from linkwright.torsion.model.engine.equivalent_inertia import mean_inertia
from linkwright.torsion.model.engine.running_gear import (
    RunningGear,
    ThrowReduction,
    throw_motion,
    throw_reduction,
)
from linkwright.torsion.model.engine.throw_compliance import compliance
from linkwright.torsion.model.engine.throw_inertia import throw_inertia

# Angles over one revolution at which pistons are placed: far beyond the harmonics of any rod that closes with
# room to spare.
_SAMPLES = 256


def running_gears(engine: ReciprocatingEngine) -> tuple[RunningGear, ...]:
    """Rod and piston of each bank, as they stand on one throw."""
    rods = [engine.rod] + [engine.articulated or engine.rod] * (len(engine.banks) - 1)
    return tuple(
        RunningGear(rod, engine.piston_mass, bank, name=f"bank {n + 1}")
        for n, (rod, bank) in enumerate(zip(rods, engine.banks, strict=True))
    )


def piston_positions(engine: ReciprocatingEngine) -> list[Floats]:
    """Distance of the pistons of each bank from the axis of the crankshaft, (n,).

    At n even angles over one revolution of the throw, from where it points along the cylinder [m].
    """
    turn = 2 * math.pi * np.arange(_SAMPLES) / _SAMPLES
    gears = running_gears(engine)
    return [throw_motion(engine.radius, gears, turn + bank)[n].piston for n, bank in enumerate(engine.banks)]


def reduced_throw(engine: ReciprocatingEngine, crank_angle: Floats) -> ThrowReduction:
    """A throw with its rods and pistons, reduced to the crank.

    Inertia, its derivative, torque of the weights; that of the crank itself where its geometry is known.
    `crank_angle`: (n,) [rad].
    """
    moment = (0.0, 0.0) if engine.throw is None else throw_inertia(engine.throw).static_moment
    return throw_reduction(
        engine.radius, running_gears(engine), crank_angle, own_inertia(engine), complex(*moment)
    )


def own_inertia(engine: ReciprocatingEngine) -> float:
    """Inertia of what turns with a throw, without rods [kg m²]."""
    if engine.throw_inertia is not None:
        return engine.throw_inertia
    assert engine.throw is not None
    return throw_inertia(engine.throw).inertia


def mean_throw_inertia(engine: ReciprocatingEngine) -> float:
    """Mean over the revolution of the inertia of a throw with its rods and pistons [kg m²]."""
    return mean_inertia(engine.radius, running_gears(engine), own_inertia(engine)).mean


def throw_stiffness(engine: ReciprocatingEngine) -> float:
    """Torque per twist from throw to throw [N m/rad]."""
    if engine.stiffness is not None:
        return engine.stiffness
    assert engine.throw is not None
    return 1.0 / compliance(engine.throw, engine.stiffness_formula)
