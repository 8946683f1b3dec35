"""Compliance of a crank throw by a formula of choice, and by all of them for their spread.

| name | is | source |
| --- | --- | --- |
| `constrained` | bearings hold the journals in line | formula (17), its length k by Castigliano or given |
| `free` | bearings give no force | formula (17), k → ∞ |
| `carter` | empirical, flexible webs | Carter 1928 |
| `ker_wilson` | empirical, stiff webs | Ker Wilson 1956 |
| `zimanenko` | empirical, automobile and tractor engines | Zimanenko |

The formulas themselves are in `throw_formulas`. They differ by a tenth to a third: a measured stiffness, or
one by finite elements, is better than any of them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import InputError
from linkwright.torsion.model.engine import throw_formulas
from linkwright.torsion.model.engine.throw import CrankThrow

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
    """Webs so slender that the bearings turn the torque of the pin round."""
    k = throw.restraint_length or throw_formulas.restraint_length(throw)
    if k > throw.radius:
        return ""
    return f"k = {k:.4g} m is not greater than the crank radius: the pin's torque has changed its sign"


def _overlap_remark(throw: CrankThrow) -> str:
    """Journal and pin so thick that no web is left between them."""
    taken = 0.2 * (throw.journal.diameter + throw.pin.diameter)
    if throw.radius > taken:
        return ""
    return f"0.2 (D₁ + D₂) = {taken:.4g} m is not less than the crank radius: the webs' share is not positive"


def _short_remark(throw: CrankThrow) -> str:
    """A journal so short that what is added to it is longer than itself."""
    added = 0.6 * throw.web.thickness * throw.journal.diameter / throw.journal.length
    if added <= throw.journal.length:
        return ""
    return f"0.6 h D₁/L₁ = {added:.4g} m is longer than the journal itself"


def _nothing(throw: CrankThrow) -> str:
    """No limit is published."""
    return ""


COMPLIANCE_FORMULAS: Mapping[str, ComplianceFormula] = MappingProxyType(
    {
        each.name: each
        for each in (
            ComplianceFormula(
                "constrained",
                throw_formulas.constrained,
                "formula (17) after Seelmann, bearings in line",
                "throws between two close bearings with little clearance",
                _restraint_remark,
            ),
            ComplianceFormula(
                "free",
                throw_formulas.free,
                "formula (17) after Seelmann, bearings with clearance",
                "small amplitudes within the bearing clearance",
                _nothing,
            ),
            ComplianceFormula(
                "carter",
                throw_formulas.carter,
                "Carter, Engineering 1928, as commonly quoted",
                "flexible webs, stiff journals and pins",
                _nothing,
            ),
            ComplianceFormula(
                "ker_wilson",
                throw_formulas.ker_wilson,
                "Ker Wilson 1956, vol. 1, as commonly quoted",
                "stiff webs, flexible journals and pins",
                _overlap_remark,
            ),
            ComplianceFormula(
                "zimanenko",
                throw_formulas.zimanenko,
                "Zimanenko, as in Soviet textbooks, read with reserve",
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
    """Twist of a throw per torque, from the middle of a journal to the middle of the next [rad/(N m)].

    Greater than 0.
    """
    chosen = compliance_formula(formula)
    found = chosen.compliance(throw)
    if found <= 0:
        why = chosen.remark(throw) or "check the sizes of the throw"
        raise InputError(
            f"compliance of a throw by {formula}: found {found:.4g} rad/(N m), expected more than 0; {why}"
        )
    return found


def compliances(throw: CrankThrow) -> dict[str, float]:
    """Twist of a throw per torque by every formula, for their spread [rad/(N m)].

    By name of the formula; a formula that gives nothing positive is left out.
    """
    found = {name: each.compliance(throw) for name, each in COMPLIANCE_FORMULAS.items()}
    return {name: value for name, value in found.items() if value > 0}


def compliance_remarks(throw: CrankThrow) -> dict[str, str]:
    """What is out of the range of a formula, in words.

    By name of the formula; without those that have nothing to remark.
    """
    remarks = ((name, each.remark(throw)) for name, each in COMPLIANCE_FORMULAS.items())
    return {name: text for name, text in remarks if text}
