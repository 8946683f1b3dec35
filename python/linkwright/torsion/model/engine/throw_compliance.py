r"""Compliance of a crank throw by a formula of choice, and by all of them for their spread.

| name | is | source |
| --- | --- | --- |
| `constrained` | bearings hold the journals in line | formula (17), its length k by Castigliano or given |
| `free` | bearings give no force | formula (17), k → ∞ |
| `carter` | empirical, flexible webs | Carter 1928 |
| `ker_wilson` | empirical, stiff webs | Ker Wilson 1956 |
| `zimanenko` | empirical, automobile and tractor engines | Zimanenko |

They differ by a tenth to a third: a measured stiffness, or one by finite elements, is better than any of
them.

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
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import InputError
from linkwright.kernel.numerics.tangent import sqrt
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
    rings = (polar_moment(part.diameter, part.inner_diameter) for part in (throw.journal, throw.pin))
    journal, pin = (32 / math.pi * ring for ring in rings)
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
    bent = R * sqrt(R / throw.pin.diameter)
    e: float = 32 / (math.pi * throw.shear_modulus) * (first / journal + second / pin + bent / web)
    return e


DEFAULT_FORMULA = "constrained"


@dataclass(frozen=True, slots=True)
class ComplianceFormula:
    """One way to the compliance of a throw."""

    name: str  # as it is chosen by
    compliance: Callable[[CrankThrow], float]  # of a `CrankThrow` [rad/(N m)]
    source: str  # where it comes from
    meant_for: str  # which crankshafts it is meant for
    # What is out of its range for a `CrankThrow`, in words; empty if nothing is.
    remark: Callable[[CrankThrow], str]


def _restraint_remark(throw: CrankThrow) -> str:
    k = throw.restraint_length or restraint_length(throw)
    if k > throw.radius:
        return ""
    return f"k = {k:.4g} m is not greater than the crank radius: the pin's torque has changed its sign"


def _overlap_remark(throw: CrankThrow) -> str:
    taken = 0.2 * (throw.journal.diameter + throw.pin.diameter)
    if throw.radius > taken:
        return ""
    return f"0.2 (D₁ + D₂) = {taken:.4g} m is not less than the crank radius: the webs' share is not positive"


def _short_remark(throw: CrankThrow) -> str:
    added = 0.6 * throw.web.thickness * throw.journal.diameter / throw.journal.length
    if added <= throw.journal.length:
        return ""
    return f"0.6 h D₁/L₁ = {added:.4g} m is longer than the journal itself"


def _nothing(throw: CrankThrow) -> str:
    return ""


COMPLIANCE_FORMULAS: Mapping[str, ComplianceFormula] = MappingProxyType(
    {
        formula.name: formula
        for formula in (
            ComplianceFormula(
                "constrained",
                constrained,
                "formula (17) after Seelmann, bearings in line",
                "throws between two close bearings with little clearance",
                _restraint_remark,
            ),
            ComplianceFormula(
                "free",
                free,
                "formula (17) after Seelmann, bearings with clearance",
                "small amplitudes within the bearing clearance",
                _nothing,
            ),
            ComplianceFormula(
                "carter",
                carter,
                "Carter, Engineering 1928, as commonly quoted",
                "flexible webs, stiff journals and pins",
                _nothing,
            ),
            ComplianceFormula(
                "ker_wilson",
                ker_wilson,
                "Ker Wilson 1956, vol. 1, as commonly quoted",
                "stiff webs, flexible journals and pins",
                _overlap_remark,
            ),
            ComplianceFormula(
                "zimanenko",
                zimanenko,
                "Zimanenko, as in Soviet textbooks; use with caution",
                "automobile and tractor engines",
                _short_remark,
            ),
        )
    }
)


def compliance_formula(name: str) -> ComplianceFormula:
    """The formula of a name. With its source."""
    if name not in COMPLIANCE_FORMULAS:
        remedy = suggestion(name, COMPLIANCE_FORMULAS)
        raise InputError(f'compliance of a throw: found "{name}", expected the name of a formula; {remedy}')
    return COMPLIANCE_FORMULAS[name]


def compliance(throw: CrankThrow, formula: str = DEFAULT_FORMULA) -> float:
    """Twist per torque from the middle of a journal to that of the next [rad/(N m)], above 0."""
    chosen = compliance_formula(formula)
    e = chosen.compliance(throw)
    if e <= 0:
        why = chosen.remark(throw) or "check the sizes of the throw"
        raise InputError(
            f"compliance of a throw by {formula}: found {e:.4g} rad/(N m), expected more than 0; {why}"
        )
    return e


def compliances(throw: CrankThrow) -> dict[str, float]:
    """Twist of a throw per torque [rad/(N m)] by name of the formula, those above 0."""
    by_formula = {name: formula.compliance(throw) for name, formula in COMPLIANCE_FORMULAS.items()}
    return {name: value for name, value in by_formula.items() if value > 0}


def compliance_remarks(throw: CrankThrow) -> dict[str, str]:
    """What is out of the range of a formula, in words by its name."""
    remarks = ((name, formula.remark(throw)) for name, formula in COMPLIANCE_FORMULAS.items())
    return {name: text for name, text in remarks if text}
