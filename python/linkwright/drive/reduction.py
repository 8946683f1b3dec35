r"""The machine reduced to the crank: reduced inertia and load torque over one cycle.

A cycle is a revolution, or as many as mechanism and loads take to repeat.

.. math::

    J(\varphi) = J_0 + \sum m\,\lVert\mathbf p'\rVert^2 + J_S\,\psi'^2, \qquad
    M_r(\varphi) = -\sum \mathbf F\cdot\mathbf p' - \sum M\,\psi'
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike

from linkwright.drive.load_checks import require_turn
from linkwright.kernel.arrays import Complexes, Floats
from linkwright.kernel.numerics.turn_fit import turn_curve
from linkwright.kernel.public import public
from linkwright.kernel.quantities import Label
from linkwright.kernel.result import Result
from linkwright.linkages.closure import turn_angles
from linkwright.linkages.period import turns_to_repeat
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine

# What is said of a machine that nothing keeps from infinite acceleration.
NO_INERTIA = (
    "the reduced inertia is zero at some crank angle, so its motion is not determined: "
    "give motor, flywheel or bodies their inertia"
)

# Inertia that is a smaller share of the maximum is zero within rounding.
_ROUNDING = 1e-12

# Speeds at which laws are integrated together; more only take memory.
_SPEEDS = 64

_LOADS = "Of all loads that do not depend on the magnitude of the speed, in forward rotation."


@dataclass(frozen=True)
class Reduction(Result):
    """Reduced inertia and torque over one cycle."""

    crank_angle: Annotated[
        Floats, Label("crank angle", "φ", "rad", "Over a cycle, from 0.", shape="(n + 1,)")
    ]
    inertia_reduced: Annotated[Floats, Label("reduced inertia", "J", "kg m²", "Motor and gearbox included.")]
    inertia_reduced_d1: Annotated[Floats, Label("derivative of the reduced inertia", "J′", "kg m²/rad")]
    torque_load: Annotated[Floats, Label("load torque referred to the crank", "M_r", "N m", _LOADS)]
    torque_dry: Annotated[
        Floats,
        Label("share of dry friction", "M_dry", "N m", "Part that always opposes the motion."),
    ]
    viscous: Annotated[
        Floats, Label("viscous coefficient at the crank", "c", "N m s/rad", "Load torque per speed.")
    ]
    inertia_min: Annotated[float, Label("minimum reduced inertia", "J_min", "kg m²", table="reduction")]
    inertia_max: Annotated[float, Label("maximum reduced inertia", "J_max", "kg m²", table="reduction")]
    inertia_min_angle: Annotated[float, Label("crank angle of the minimum inertia", "φ(J_min)", "rad")]
    inertia_max_angle: Annotated[float, Label("crank angle of the maximum inertia", "φ(J_max)", "rad")]
    torque_load_mean: Annotated[
        float, Label("mean load torque", "M_r,mean", "N m", "Over the angle.", table="reduction")
    ]
    torque_load_max: Annotated[float, Label("maximum load torque", "M_r,max", "N m", table="reduction")]
    viscous_mean: Annotated[
        float,
        Label(
            "mean viscous coefficient at the crank",
            "c_mean",
            "N m s/rad",
            "Over the angle.",
            table="reduction",
        ),
    ]


@public
def reduction(machine: Machine, *, n: int = 360) -> Reduction:
    """Reduce masses and loads to the crank.

    Parameters
    ----------
    machine : Machine
    n : int
        Intervals of the revolution for the curves.

    Returns
    -------
    Reduction
        Curves over a cycle of the machine, extremes and means; these do not depend on ``n``. Where masses and
        loads do not repeat within 24 revolutions, over the first one.

    Raises
    ------
    AssemblyError
        The mechanism does not close all round.
    FindingError
        A load has no value at some angle.

    Notes
    -----
    The derivative of J is exact. The load torque is positive where it opposes forward rotation.

    References
    ----------
    .. [1] Artobolevsky, Theory of Mechanisms and Machines, reduction of masses and forces.
    .. [2] Paper 1, equations (5) and (10), for the in-line slider-crank with rod.
    """
    return reduction_of(require_turn(machine), n)


def reduction_of(compiled: CompiledMachine, n: int = 360) -> Reduction:
    """`reduction` of a compiled machine that closes, over its cycle."""
    phi = turn_angles(n, compiled.turns)
    at = compiled.reductions(phi)
    turn = turn_curve(lambda at: _inertia_and_load(compiled, at), compiled.kinks(), "inertia and load")
    low, low_at = turn.extreme(-1, 0)
    high, high_at = turn.extreme(+1, 0)
    means = mean_over_turn(compiled)
    return Reduction(
        crank_angle=phi,
        inertia_reduced=at.inertia,
        inertia_reduced_d1=at.inertia_slope,
        torque_load=at.load + at.dry,
        torque_dry=at.dry,
        viscous=at.viscous,
        inertia_min=low,
        inertia_max=high,
        inertia_min_angle=low_at,
        inertia_max_angle=high_at,
        torque_load_mean=means[0],
        torque_load_max=turn.extreme(+1, 1)[0],
        viscous_mean=means[1],
    )


def has_inertia(reduced: Reduction) -> bool:
    """Whether the reduced inertia is above zero all round, beyond rounding."""
    return reduced.inertia_min > _ROUNDING * reduced.inertia_max


def mean_over_turn(compiled: CompiledMachine) -> tuple[float, float]:
    """Means of the load torque and of the viscous coefficient over the cycle of a compiled machine.

    Loads that have a potential do no work over a closed cycle, whatever their size: they are left out of the
    integral where the mechanism is after a cycle where it was.
    """
    turns = turns_to_repeat(compiled)
    if turns is not None and compiled.turns % turns == 0:
        compiled = compiled.without_conservative()
    turn = turn_curve(lambda at: _resistance(compiled, at), compiled.kinks(), "resistance")
    load, viscous = turn.mean()
    return float(load), float(viscous)


def mean_laws(compiled: CompiledMachine, speeds: ArrayLike) -> Floats:
    """Mean over the crank angle of the torque of laws at constant speeds of the crank, shape (n,) [N m]."""
    mean: Floats = law_harmonics(compiled, speeds, np.zeros(1)).real[:, 0]
    return mean


def law_harmonics(compiled: CompiledMachine, speeds: ArrayLike, orders: Floats) -> Complexes:
    """Means of the torque of laws times e^{−iνφ} at constant speeds of the crank, (speeds, orders) [N m]."""
    omega = np.atleast_1d(np.asarray(speeds, dtype=np.float64))
    if not compiled.has_laws:
        return np.zeros((len(omega), len(orders)), dtype=np.complex128)
    kinks = compiled.kinks()
    parts = [omega[i : i + _SPEEDS] for i in range(0, len(omega), _SPEEDS)]
    turns = (turn_curve(partial(_laws, compiled, part), kinks, "load") for part in parts)
    return np.concatenate([turn.harmonics(orders) for turn in turns])


def _inertia_and_load(compiled: CompiledMachine, phi: Floats) -> Floats:
    """Reduced inertia and load torque, (2, n)."""
    at = compiled.reductions(phi)
    return np.stack([at.inertia, at.load + at.dry])


def _resistance(compiled: CompiledMachine, phi: Floats) -> Floats:
    """Load torque and viscous coefficient, (2, n)."""
    at = compiled.reductions(phi)
    return np.stack([at.load + at.dry, at.viscous])


def _laws(compiled: CompiledMachine, omega: Floats, phi: Floats) -> Floats:
    """Torque of the laws at constant speeds, (speeds, n)."""
    return compiled.law_torques(phi, omega)
