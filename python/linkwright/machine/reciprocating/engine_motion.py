"""The moving parts of an engine: running gears, pistons over the turn, inertia of a throw over its angle."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from linkwright.machine.reciprocating.engine import ReciprocatingEngine
from linkwright.machine.reciprocating.running_gear import RunningGear, throw_motion
from linkwright.machine.reciprocating.throw_compliance import compliance
from linkwright.machine.reciprocating.throw_inertia import throw_inertia

Floats = NDArray[np.float64]

# Standard acceleration of free fall [m/s²].
GRAVITY = 9.80665

# Angles over a turn at which pistons are placed: far beyond the harmonics of any rod that closes with room
# to spare.
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
    return [throw_motion(engine.radius, gears, turn + bank)[n].piston for n, bank in enumerate(engine.banks)]


def throw_curves(engine: ReciprocatingEngine, crank_angle: Floats) -> tuple[Floats, Floats, Floats]:
    """Inertia of a throw with its rods and pistons, and what weight does to it.

    Parameters
    ----------
    engine : ReciprocatingEngine
        The engine.
    crank_angle : ndarray, shape (n,)
        Of the throw, from the vertical [rad].

    Returns
    -------
    J, J_d1, V_d1 : ndarray, shape (n,)
        Inertia [kg m²], its derivative [kg m²/rad], derivative of the potential energy [N m/rad].
    """
    J = np.full(len(crank_angle), own_inertia(engine))
    J_d1, V_d1 = np.zeros_like(J), _own_weight(engine, crank_angle)
    gears = running_gears(engine)
    for gear, motion in zip(gears, throw_motion(engine.radius, gears, crank_angle), strict=True):
        mass, centre, inertia = gear.rod.body
        S = motion.point(centre)
        J += mass * np.abs(S.d1) ** 2 + inertia * motion.angle_d1**2 + gear.piston_mass * motion.piston_d1**2
        J_d1 += 2 * (
            mass * (S.d1.conj() * S.d2).real
            + inertia * motion.angle_d1 * motion.angle_d2
            + gear.piston_mass * motion.piston_d1 * motion.piston_d2
        )
        # Up is the real axis.
        V_d1 += GRAVITY * (mass * S.d1.real + gear.piston_mass * motion.piston_d1 * math.cos(gear.bank_angle))
    return J, J_d1, V_d1


def _own_weight(engine: ReciprocatingEngine, crank_angle: Floats) -> Floats:
    """Derivative of the potential energy of the crank itself, where its geometry is known [N m/rad]."""
    if engine.throw is None:
        return np.zeros(len(crank_angle))
    along, across = throw_inertia(engine.throw).static_moment
    found: Floats = -GRAVITY * (along * np.sin(crank_angle) + across * np.cos(crank_angle))
    return found


def own_inertia(engine: ReciprocatingEngine) -> float:
    """Inertia of what turns with a throw, without rods [kg m²]."""
    if engine.throw_inertia is not None:
        return engine.throw_inertia
    assert engine.throw is not None
    return throw_inertia(engine.throw).inertia


def mean_throw_inertia(engine: ReciprocatingEngine) -> float:
    """Mean over the turn of the inertia of a throw with its rods and pistons [kg m²]."""
    turn = 2 * math.pi * np.arange(_SAMPLES) / _SAMPLES
    return float(throw_curves(engine, turn)[0].mean())


def throw_stiffness(engine: ReciprocatingEngine) -> float:
    """Torque per twist from throw to throw [N m/rad]."""
    if engine.stiffness is not None:
        return engine.stiffness
    assert engine.throw is not None
    return 1.0 / compliance(engine.throw, engine.stiffness_formula)
