r"""Twist of one crank throw under a torque, from the middle of a journal to the middle of the next.

With $L_1, D_1, d_1$ of the main journal, $L_2, D_2, d_2$ of the pin, R the crank radius, h and B thickness
and width of a web, the *constrained* formula has the torsion of journal and pin, lengthened into the webs,
and the bending of the webs, both relieved by the force S = M/k with which the bearings answer [1]_,

.. math::

    e = \frac1G \left\{ \frac{L_1 + 0.9h}{I_1} + \frac{L_2 + 0.9h}{I_2} \left(1 - \frac Rk\right)
        + \frac GE \frac{2R}{I_3} \left(1 - \frac{R}{2k}\right) \right\}, \quad I_3 = \frac{h B^3}{12}

and $k \to \infty$ where the bearings have play (*free*). Empirical formulas are, as $e = 32/(\pi G)$ times

.. math::

    \text{Carter:}\quad & \frac{L_1 + 0.8h}{D_1^4 - d_1^4} + \frac{0.75 L_2}{D_2^4 - d_2^4}
        + \frac{1.5R}{h B^3} \\
    \text{Ker Wilson:}\quad & \frac{L_1 + 0.4D_1}{D_1^4 - d_1^4} + \frac{L_2 + 0.4D_2}{D_2^4 - d_2^4}
        + \frac{R - 0.2(D_1 + D_2)}{h B^3} \\
    \text{Zimanenko:}\quad & \frac{L_1 + 0.6 h D_1/L_1}{D_1^4 - d_1^4}
        + \frac{0.8L_2 + 0.2 D_1 B/R}{D_2^4 - d_2^4} + \frac{R \sqrt{R/D_2}}{h B^3}

The coefficients of the empirical formulas are those commonly quoted, Carter's and Ker Wilson's for instance
by consultants [2]_; none could be compared with its print, and for Zimanenko's the diameter in its second
term is read as the journal's. Solid models of throws are the check (`docs/theory/crank_stiffness.md`).

References
----------
.. [1] Paper 3, equation (17), after Seelmann.
.. [2] Carter, An empirical formula for crankshaft stiffness in torsion, Engineering, July 1928. Feese, Hill,
    Prevention of torsional vibration problems in reciprocating machinery, Turbomachinery Symposium 38, 2009.
.. [3] Ker Wilson, Practical Solution of Torsional Vibration Problems, vol. 1, 1956, chapter 3.
.. [4] Zimanenko, in Soviet textbooks on the dynamics of automobile and tractor engines.
"""

from __future__ import annotations

import math

from linkwright.torsion.model.engine.throw import CrankThrow
from linkwright.torsion.model.shaft_flexibility import polar_moment

# What journal and pin are lengthened by into each web, over the web's thickness, half of it on each side.
_INTO_WEB = 0.9
# Shear factor of bars in bending, as the formula for k has it.
_SHEAR = 1.2


def restraint_length(throw: CrankThrow) -> float:
    r"""Torque over the force with which rigid bearings answer it: k of formula (17) [m].

    Bearings at both webs hold the journals in place and in line. The force S bends the webs and the pin,
    twists the webs, and follows by Castigliano from dU/dS = 0,

    .. math::

        k = \frac{\frac{R (L_2 + h)^2}{4 C_3} + \frac{L_2 R^2}{2 C_2} + \frac{L_2^3}{24 B_1}
            + \frac{R^3}{3 B_w} + \frac{1.2}{G} \left(\frac{L_2}{2F} + \frac{R}{hB}\right)}
            {\frac{L_2 R}{2 C_2} + \frac{R^2}{2 B_w}}

    with $C_2 = G I_2$, $C_3 = G B^3 h^3/(3.6 (B^2 + h^2))$, $B_1 = E I_2/2$, $B_w = E I_3$.

    The length, always greater than two thirds of the crank radius.
    """
    R, pin, G, E = throw.radius, throw.pin, throw.shear_modulus, throw.elastic_modulus
    L, h, B = pin.length, throw.web.thickness, throw.web.breadth
    I_2 = polar_moment(pin.diameter, pin.inner_diameter)
    C_2, B_1, B_w = G * I_2, E * I_2 / 2, E * h * B**3 / 12
    C_3 = G * (B * h) ** 3 / (3.6 * (B * B + h * h))
    F = math.pi / 4 * (pin.diameter**2 - pin.inner_diameter**2)
    against = R * (L + h) ** 2 / (4 * C_3) + L * R**2 / (2 * C_2) + L**3 / (24 * B_1) + R**3 / (3 * B_w)
    against += _SHEAR / G * (L / (2 * F) + R / (h * B))
    return against / (L * R / (2 * C_2) + R**2 / (2 * B_w))


def _restrained(throw: CrankThrow, k: float) -> float:
    """Formula (17) with a length k."""
    R, h, G = throw.radius, throw.web.thickness, throw.shear_modulus
    journal, pin = throw.journal, throw.pin
    first = (journal.length + _INTO_WEB * h) / polar_moment(journal.diameter, journal.inner_diameter)
    second = (pin.length + _INTO_WEB * h) / polar_moment(pin.diameter, pin.inner_diameter)
    webs = 2 * R * 12 / (h * throw.web.breadth**3)
    return (first + second * (1 - R / k)) / G + webs * (1 - R / (2 * k)) / throw.elastic_modulus


def constrained(throw: CrankThrow) -> float:
    """Compliance by formula (17) with bearings that hold the journals in line [rad/(N m)]."""
    return _restrained(throw, throw.restraint_length or restraint_length(throw))


def free(throw: CrankThrow) -> float:
    """Compliance by formula (17) with bearings that give no force, k → ∞ [rad/(N m)]."""
    return _restrained(throw, math.inf)


def _fourths(throw: CrankThrow) -> tuple[float, float, float]:
    """D₁⁴ − d₁⁴, D₂⁴ − d₂⁴ and hB³ [m⁴]."""
    rings = (polar_moment(each.diameter, each.inner_diameter) for each in (throw.journal, throw.pin))
    journal, pin = (32 / math.pi * each for each in rings)
    return journal, pin, throw.web.thickness * throw.web.breadth**3


def carter(throw: CrankThrow) -> float:
    """Compliance by Carter's formula [rad/(N m)]."""
    journal, pin, web = _fourths(throw)
    shaft = (throw.journal.length + 0.8 * throw.web.thickness) / journal + 0.75 * throw.pin.length / pin
    return 32 / (math.pi * throw.shear_modulus) * (shaft + 1.5 * throw.radius / web)


def ker_wilson(throw: CrankThrow) -> float:
    """Compliance by Ker Wilson's formula [rad/(N m)]."""
    journal, pin, web = _fourths(throw)
    D_1, D_2 = throw.journal.diameter, throw.pin.diameter
    shaft = (throw.journal.length + 0.4 * D_1) / journal + (throw.pin.length + 0.4 * D_2) / pin
    return 32 / (math.pi * throw.shear_modulus) * (shaft + (throw.radius - 0.2 * (D_1 + D_2)) / web)


def zimanenko(throw: CrankThrow) -> float:
    """Compliance by Zimanenko's formula [rad/(N m)]."""
    journal, pin, web = _fourths(throw)
    R, L_1, D_1 = throw.radius, throw.journal.length, throw.journal.diameter
    first = L_1 + 0.6 * throw.web.thickness * D_1 / L_1
    second = 0.8 * throw.pin.length + 0.2 * D_1 * throw.web.breadth / R
    bent = R * math.sqrt(R / throw.pin.diameter)
    return 32 / (math.pi * throw.shear_modulus) * (first / journal + second / pin + bent / web)
