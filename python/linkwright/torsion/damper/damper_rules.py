r"""Dampers of one mass on a spring in closed form: Lanchester's, and those tuned by a spring or by rubber.

A mass J on a spring K, :math:`\omega_n^2 = K/J`, carries a ring :math:`\mu J`, held by
:math:`k(1 + i\eta)` and c. With :math:`g = \omega/\omega_n`, the tuning :math:`f^2 = k/(\mu K)`, and
:math:`\zeta = c/(2\mu J\omega_n)` the ring adds the stiffness D to the mass,

.. math:: \frac{\theta K}{M} = \frac{1}{1 - g^2 + D}, \qquad
    \frac1D = \frac{1}{\mu f^2 (1 + i\eta) + 2i\zeta\mu g} - \frac{1}{\mu g^2}

and whatever the damping is, all curves go through the same points where those with none and with infinite
damping meet. The best that damping can do is to make the curve level there:

| ring held by | tuning | damping | largest magnification |
| --- | --- | --- | --- |
| fluid | 0 | :math:`\zeta^2 = 1/(2(1 + \mu)(2 + \mu))` | :math:`1 + 2/\mu` |
| spring, fluid | :math:`1/(1 + \mu)` | :math:`\zeta^2 = 3\mu/(8(1 + \mu)^3)` | :math:`\sqrt{1 + 2/\mu}` |
| rubber | :math:`1/(1 + \mu)` | :math:`\eta^2 = \mu(3 + 2\mu)/(2 + \mu)` | :math:`\sqrt{1 + 2/\mu}` |

The first is exact. With a spring, the curve cannot be level at both points at once, and the squares of the
two dampings that make it so are averaged, as Brock did; the largest value lies a little above the points, by
1 % for a fluid and :math:`\mu = 1`, by 5 % for rubber and :math:`\mu = 0.2`. Damping is counted by the
frequency of the mass; by that of the ring alone, :math:`f\omega_n`, the second is
:math:`3\mu/(8(1 + \mu))`.

References
----------
.. [1] Den Hartog, Mechanical Vibrations, 4th ed. 1956, section 3.3: the undamped and the damped absorber,
   Lanchester's damper.
.. [2] Brock, A note on the damped vibration absorber, J. Appl. Mech. 13 (1946) A-284.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError

Complex = NDArray[np.complexfloating[Any, Any]]


@dataclass(frozen=True)
class DamperRule:
    """A damper of one mass on a spring, by its ratios."""

    mass_ratio: float  # μ, inertia of the ring over that of the mass
    tuning: float  # f, frequency of the ring on its spring over that of the mass; 0 without a spring
    damping_ratio: float  # ζ, over twice the ring's inertia times the frequency of the mass
    loss_factor: float  # η of the spring
    # Of the static deflection at the fixed points: the smallest possible maximum, to a few percent.
    magnification: float
    fixed_points: tuple[float, ...]  # their frequencies over that of the mass


def viscous_rule(mass_ratio: float) -> DamperRule:
    """The best damper of a fluid alone, Lanchester's or Houde's. Exact. `mass_ratio`: μ."""
    mu = _positive(mass_ratio)
    damping = 1 / math.sqrt(2 * (1 + mu) * (2 + mu))
    return DamperRule(mu, 0.0, damping, 0.0, 1 + 2 / mu, (math.sqrt(2 / (2 + mu)),))


def tuned_rule(mass_ratio: float) -> DamperRule:
    """The best damper of a spring and a fluid. By the fixed points. `mass_ratio`: μ."""
    mu = _positive(mass_ratio)
    return _tuned(mu, damping=math.sqrt(3 * mu / (8 * (1 + mu) ** 3)), loss=0.0)


def rubber_rule(mass_ratio: float) -> DamperRule:
    """The best damper of rubber, whose loss does not depend on the frequency.

    By the fixed points. `mass_ratio`: μ. Rubber in torsional dampers has η of 0.1 to 0.3, much less than this
    asks for with a heavy ring.
    """
    mu = _positive(mass_ratio)
    return _tuned(mu, damping=0.0, loss=math.sqrt(mu * (3 + 2 * mu) / (2 + mu)))


def magnification(rule: DamperRule, frequency: ArrayLike) -> Floats:
    """Dynamic over static deflection, (n,), infinite at an undamped resonance; `frequency`: (n,) g."""
    g = np.atleast_1d(np.asarray(frequency, dtype=np.float64))
    mu = rule.mass_ratio
    held: Complex = mu * rule.tuning**2 * (1 + 1j * rule.loss_factor) + 2j * rule.damping_ratio * mu * g
    with np.errstate(divide="ignore"):
        deflection: Floats = 1 / np.abs(1 - g**2 + ring_stiffness(held, mu * g**2))
    return deflection


def ring_stiffness(held: Complex, carried: Floats) -> Complex:
    """Dynamic stiffness that a ring adds to its disc, (n,).

    Torque on the disc against its angle, per angle [N m/rad]. `held`: (n,) [N m/rad]; `carried`: (n,) its
    inertia times ω² [N m/rad].
    """
    stiffness: Complex = -held * carried / (held - carried)
    return stiffness


def viscous_heat(damping: float, omega: ArrayLike, twist: ArrayLike) -> float:
    r"""Heat of a fluid between ring and disc, :math:`\tfrac12 c\,\sum\omega^2|\Delta|^2`.

    Mean over time [W]. `damping`: c [N m s/rad]; `omega`: (n,) angular frequency of each order [rad/s];
    `twist`: (n,) [rad].
    """
    return float(0.5 * damping * np.sum(np.asarray(omega) ** 2 * np.abs(twist) ** 2))


def hysteretic_heat(stiffness: float, loss_factor: float, omega: ArrayLike, twist: ArrayLike) -> float:
    r"""Heat of rubber between ring and disc, :math:`\tfrac12\eta k\,\sum\omega|\Delta|^2`.

    Mean over time: a cycle of ω loses πηk|Δ|² [W]. `stiffness`: k [N m/rad]; `loss_factor`: η; `omega`: (n,)
    angular frequency of each order [rad/s]; `twist`: (n,) [rad].
    """
    return float(0.5 * loss_factor * stiffness * np.sum(np.asarray(omega) * np.abs(twist) ** 2))


def _tuned(mu: float, *, damping: float, loss: float) -> DamperRule:
    """Fixed points of the same height: f = 1/(1 + μ)."""
    apart = math.sqrt(mu / (2 + mu))
    points = tuple(math.sqrt((1 + sign * apart) / (1 + mu)) for sign in (-1, 1))
    return DamperRule(mu, 1 / (1 + mu), damping, loss, 1 / apart, points)


def _positive(mass_ratio: float) -> float:
    if not 0 < mass_ratio < math.inf:
        raise InputError(f"mass_ratio: found {mass_ratio:g}, expected a number greater than 0")
    return float(mass_ratio)
