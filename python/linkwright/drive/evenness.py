r"""How evenly a shaft turns: the coefficients δ, H and k_p, of one motion or of many at once.

.. math:: \delta = \frac{\omega_{max} - \omega_{min}}{\omega_m}, \quad
    H = \frac{|\varepsilon|_{max}}{\omega_m^2}, \quad k_p = \delta^2 + H

The mean speed :math:`\omega_m` is that of the extremes or that over time; the caller says which.

With motor and loads switched off the kinetic energy is constant and :math:`\omega\propto 1/\sqrt J`, so the
measures depend on J(φ) alone: the limit of a machine whose motor's characteristic is flat against its
inertia.

References
----------
.. [1] Paper 1, (13) to (15).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Generic, TypeVar

import numpy as np

from linkwright.drive.reduction import NO_INERTIA, Reduction, has_inertia, reduction
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import SteadyStateError
from linkwright.kernel.numerics.turn_fit import turn_curve
from linkwright.kernel.public import public
from linkwright.kernel.quantities import Label
from linkwright.kernel.reader.numbers import degrees
from linkwright.kernel.result import Result
from linkwright.linkages.whole_cycle import over_known_cycle
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine, compile_machine

V = TypeVar("V", float, Floats)


def mean_of_extremes(slow: V, fast: V) -> V:
    """(ω_max + ω_min)/2 [rad/s]."""
    return 0.5 * (fast + slow)


def unevenness(slow: V, fast: V, mean: V) -> V:
    """δ of the slowest and the fastest speed, about a mean speed [–]."""
    return (fast - slow) / mean


def dynamism(least: V, greatest: V, mean: V) -> V:
    """H of the minimum and maximum angular acceleration, at a mean speed [–]."""
    steepest: V = np.maximum(np.abs(least), np.abs(greatest))
    factor: V = steepest / mean**2
    return factor


def motion_coefficient(delta: V, H: V) -> V:
    """k_p of δ and H [–]."""
    return delta**2 + H


DELTA = Label("coefficient of speed fluctuation", "δ", "")
DYNAMIC_FACTOR = Label("dynamic factor", "H", "")
K_P = Label("combined non-uniformity index", "k_p", "")
# The same of one motion about another mean speed.
_BY_TIME = "by the mean speed over time"
DELTA_TIME, DYNAMIC_FACTOR_TIME, K_P_TIME = (
    label._replace(word=f"{label.word}, {_BY_TIME}") for label in (DELTA, DYNAMIC_FACTOR, K_P)
)
MEAN_SPEED = Label("mean of the extreme speeds", "ω_m", "rad/s")


class Evenness(Generic[V]):
    """δ, H and k_p of a motion, or of many, from the extremes; about the mean of the extremes."""

    if TYPE_CHECKING:  # each motion declares its own extremes, in the order of its table
        speed_min: V
        speed_max: V
        acceleration_min: V
        acceleration_max: V

    @property
    def speed_mean_extremes(self) -> Annotated[V, MEAN_SPEED]:
        """(ω_max + ω_min)/2."""
        return mean_of_extremes(self.speed_min, self.speed_max)

    @property
    def unevenness(self) -> Annotated[V, DELTA]:
        """δ = (ω_max − ω_min)/ω_m with the mean of the extremes, paper 1 (13)."""
        return unevenness(self.speed_min, self.speed_max, self.speed_mean_extremes)

    @property
    def dynamism(self) -> Annotated[V, DYNAMIC_FACTOR]:
        """H = |ε|_max/ω_m² with the mean of the extremes, paper 1 (14)."""
        return dynamism(self.acceleration_min, self.acceleration_max, self.speed_mean_extremes)

    @property
    def motion_coefficient(self) -> Annotated[V, K_P]:
        """k_p = δ² + H with the mean of the extremes, paper 1 (15)."""
        return motion_coefficient(self.unevenness, self.dynamism)


@dataclass(frozen=True)
class ConstantEnergy(Result):
    """Speed fluctuation at constant kinetic energy."""

    unevenness: Annotated[float, DELTA]
    dynamism: Annotated[float, DYNAMIC_FACTOR]

    @property
    def motion_coefficient(self) -> Annotated[float, K_P]:
        """k_p = δ² + H, paper 1 (15)."""
        return motion_coefficient(self.unevenness, self.dynamism)


@public
def constant_energy(machine: Machine) -> ConstantEnergy:
    """Measures of speed fluctuation at constant kinetic energy.

    Parameters
    ----------
    machine : Machine
        The machine; its motor and its loads do not count, the motor's inertia does.

    Returns
    -------
    ConstantEnergy
        δ and H, with the mean of the extremes for the mean speed.

    Raises
    ------
    AssemblyError
        The mechanism does not close all round.
    SteadyStateError
        The reduced inertia is zero at some crank angle, as at a dead centre of a machine without flywheel.
    """
    return constant_energy_of(reduction(machine, n=1), compile_machine(machine).first())


def constant_energy_of(reduced: Reduction, compiled: CompiledMachine | None = None) -> ConstantEnergy:
    r"""`constant_energy` of a reduced machine.

    With E = 1: :math:`\omega = \sqrt{2/J}`, :math:`\varepsilon = -\tfrac12 J'\omega^2/J = -J'/J^2`.
    Its peak is exact for a machine. Of curves alone it is found by a parabola through the best sample and its
    neighbours: with 1440 intervals within 1e-6 of H on the machines that are shipped.
    """
    if not has_inertia(reduced):
        at = degrees(reduced.inertia_min_angle)
        raise SteadyStateError(
            f"no constant-energy limit: the reduced inertia falls to zero at a crank angle of {at}, "
            "where the crank would be infinitely fast; give motor, flywheel or bodies their inertia"
        )
    slow, fast = np.sqrt(2 / reduced.inertia_max), np.sqrt(2 / reduced.inertia_min)
    mean = mean_of_extremes(float(slow), float(fast))
    peak = _by_samples(reduced) if compiled is None else _exactly(compiled)
    delta = unevenness(float(slow), float(fast), mean)
    return ConstantEnergy(unevenness=delta, dynamism=dynamism(-peak, peak, mean))


def _exactly(compiled: CompiledMachine) -> float:
    """Peak of |J'|/J² from the series of the revolution."""

    def acceleration(phi: Floats) -> Floats:
        inertia, slope = inertias(compiled, phi)
        ratio: Floats = (slope / inertia**2)[None]
        return ratio

    compiled = over_known_cycle(compiled)
    turn = turn_curve(acceleration, compiled.kinks(), "angular acceleration at constant energy")
    return max(abs(turn.extreme(sign)[0]) for sign in (1, -1))


def inertias(compiled: CompiledMachine, phi: Floats) -> tuple[Floats, Floats]:
    """J and J' at crank angles, (n,) each; a `SteadyStateError` where there is no inertia."""
    at = compiled.reductions(phi)
    if not (at.inertia > 0).all():
        raise SteadyStateError(NO_INERTIA)
    return at.inertia, at.inertia_slope


def _by_samples(reduced: Reduction) -> float:
    """Peak of |J'|/J² by a parabola."""
    epsilon = np.abs(reduced.inertia_reduced_d1 / reduced.inertia_reduced**2)[:-1]
    best = int(np.argmax(epsilon))
    left, top, right = epsilon[best - 1], epsilon[best], epsilon[(best + 1) % len(epsilon)]
    bend = left - 2 * top + right
    return float(top if bend == 0 else top - (right - left) ** 2 / (8 * bend))
