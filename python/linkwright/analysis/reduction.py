r"""The machine reduced to the crank: reduced inertia and resisting torque over a turn.

.. math::

    J(\varphi) = J_0 + \sum m\,\lVert\mathbf p'\rVert^2 + J_S\,\psi'^2, \qquad
    M_r(\varphi) = -\sum \mathbf F\cdot\mathbf p' - \sum M\,\psi'
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from linkwright.analysis.closure import require_full_turn, turn_angles
from linkwright.analysis.result import Result
from linkwright.analysis.sound_loads import require_sound_loads
from linkwright.engine import Compiled, compile_machine
from linkwright.machine import Machine
from linkwright.public import public

Floats = NDArray[np.float64]

# What is said of a machine that nothing keeps from infinite acceleration.
NO_INERTIA = (
    "the reduced inertia is zero at some crank angle, so its motion is not determined: "
    "give motor, flywheel or bodies their inertia"
)

# Nodes of Gauss–Legendre quadrature between two kinks: on a quarter turn of a slider-crank 24 nodes are
# exact to rounding.
_NODES = 24


@dataclass(frozen=True)
class Reduction(Result):
    """Reduced inertia and torque over a turn.

    Attributes
    ----------
    crank_angle : ndarray, shape (n + 1,)
        0 to 2π [rad].
    inertia_reduced : ndarray
        J [kg m²], motor and gearbox included.
    inertia_reduced_d1 : ndarray
        dJ/dφ [kg m²/rad].
    torque_load : ndarray
        Resisting torque of all loads that do not depend on the size of the speed, crank turning forward
        [N m].
    torque_dry : ndarray
        Share of it that always opposes the motion [N m].
    viscous : ndarray
        Resisting torque per speed [N m s/rad].
    inertia_min, inertia_max : float
        Extremes of J [kg m²].
    inertia_min_angle, inertia_max_angle : float
        Crank angles where they are [rad].
    torque_load_mean, torque_load_max : float
        Mean over the angle, and greatest value, of the resisting torque [N m].
    viscous_mean : float
        Mean over the angle of the resisting torque per speed [N m s/rad].
    """

    crank_angle: Floats
    inertia_reduced: Floats
    inertia_reduced_d1: Floats
    torque_load: Floats
    torque_dry: Floats
    viscous: Floats
    inertia_min: float
    inertia_max: float
    inertia_min_angle: float
    inertia_max_angle: float
    torque_load_mean: float
    torque_load_max: float
    viscous_mean: float


@public
def reduction(machine: Machine, *, n: int = 360) -> Reduction:
    """Reduce masses and loads to the crank.

    Parameters
    ----------
    machine : Machine
        The machine.
    n : int
        Intervals of the turn for the curves.

    Returns
    -------
    Reduction
        Curves over the turn, extremes and means; these do not depend on ``n``.

    Raises
    ------
    AssemblyError
        The mechanism does not close all round.
        A load has no value at some angle.

    Notes
    -----
    The derivative of J is exact. The resisting torque is positive where it opposes forward rotation.

    References
    ----------
    .. [1] Artobolevsky, Theory of Mechanisms and Machines, reduction of masses and forces.
    .. [2] Paper 1, equations (5) and (10), for the in-line slider-crank with rod.
    """
    compiled = compile_machine(machine)
    require_full_turn(compiled, machine)
    require_sound_loads(compiled, machine)
    return reduction_of(compiled, n)


def reduction_of(compiled: Compiled, n: int = 360) -> Reduction:
    """`reduction` of a compiled machine that closes."""
    phi = turn_angles(n)
    J, J_d1, load, dry, viscous = compiled.reductions(phi)
    low, low_at = _extreme(compiled, -1, _inertia)
    high, high_at = _extreme(compiled, +1, _inertia)
    means = mean_over_turn(compiled)
    return Reduction(
        crank_angle=phi,
        inertia_reduced=J,
        inertia_reduced_d1=J_d1,
        torque_load=load + dry,
        torque_dry=dry,
        viscous=viscous,
        inertia_min=low,
        inertia_max=high,
        inertia_min_angle=low_at,
        inertia_max_angle=high_at,
        torque_load_mean=means[0],
        torque_load_max=_extreme(compiled, +1, _load)[0],
        viscous_mean=means[1],
    )


def mean_over_turn(compiled: Compiled) -> tuple[float, float]:
    """Means of the resisting torque and of the viscous coefficient over the crank angle."""
    phi, weights = turn_nodes(compiled)
    _, _, load, dry, viscous = compiled.reductions(phi)
    return float(weights @ (load + dry)), float(weights @ viscous)


def mean_laws(compiled: Compiled, speeds: ArrayLike) -> Floats:
    """Mean over the crank angle of the torque of laws at constant speeds of the crank, shape (n,) [N m]."""
    omega = np.atleast_1d(np.asarray(speeds, dtype=np.float64))
    if not compiled.has_laws:
        return np.zeros_like(omega)
    phi, weights = turn_nodes(compiled)
    mean: Floats = compiled.law_torques(phi, omega) @ weights
    return mean


def turn_nodes(compiled: Compiled, pieces: int = 1) -> tuple[Floats, Floats]:
    """Crank angles and weights for means over a turn: Gauss–Legendre quadrature from kink to kink.

    What varies faster than the mechanism, such as high harmonics, needs several pieces between two kinks.
    """
    x, w = np.polynomial.legendre.leggauss(_NODES)
    kinks = compiled.kinks()
    parts = np.linspace(kinks[:-1], kinks[1:], pieces, endpoint=False)
    ends = np.append(parts.T.ravel(), kinks[-1])
    half = 0.5 * np.diff(ends)[:, None]
    phi = (ends[:-1, None] + half * (x + 1)).ravel()
    return phi, (half * w).ravel() / (2 * np.pi)


def _inertia(reductions: Floats) -> Floats:
    J: Floats = reductions[0]
    return J


def _load(reductions: Floats) -> Floats:
    torque: Floats = reductions[2] + reductions[3]
    return torque


def _extreme(compiled: Compiled, sign: int, of: Callable[[Floats], Floats]) -> tuple[float, float]:
    """Greatest (+1) or least (−1) value of a quantity over the turn, and its crank angle [rad].

    The best of 720 samples and of the kinks is closed in on by ever finer samples. The value errs by the
    square of the angle's error, which ends below 1e-7 rad; at a kink, by its first power.
    """
    kinks = compiled.kinks()[:-1]
    centre, reach = np.pi, np.pi
    for samples in (721, 41, 41, 41, 41, 41):
        phi = np.append(np.linspace(centre - reach, centre + reach, samples), kinks)
        values = of(compiled.reductions(phi))
        best = int(np.argmax(sign * values))
        centre, reach = float(phi[best]), 2 * reach / (samples - 1)
    # Angles just short of a turn are the start of it.
    return float(values[best]), 0.0 if 2 * np.pi - centre % (2 * np.pi) < 1e-6 else centre % (2 * np.pi)
