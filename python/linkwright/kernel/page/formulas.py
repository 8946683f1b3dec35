"""Formulas of a report with their sources, in a notation that becomes MathML or Typst.

Symbols have spaces between them; ``x_y``, ``x^y``, ``frac(a|b)`` and ``root(a)`` do more.
"""

from __future__ import annotations

import re
from typing import NamedTuple

PAPER_1 = (
    "Paper 1: “Аналіз нерівномірності руху приводних механізмів машин роликового формування” (Analysis of "
    "the unevenness of motion of the drive mechanisms of roller-forming machines)"
)

KLOSS_1909 = "M. Kloss, Drehmoment und Schlüpfung des Drehstrommotors, Archiv für Elektrotechnik, 1909"


class Formula(NamedTuple):
    """A formula: what it says, the formula in the notation of this module, and where it is from."""

    words: str
    text: str
    origin: str


def mathml(text: str) -> str:
    """A formula as MathML."""
    return f'<math displaystyle="true"><mrow>{_row(text)}</mrow></math>'


def typst(text: str) -> str:
    """A formula as Typst writes it, without the dollar signs around it."""
    return " ".join(_typst_piece(match) for match in _PIECE.finditer(text))


# What stands between two formulas, with room around it.
_BETWEEN = {"or": "\u2003or\u2003", ",": ",\u2003"}

# Names of functions, with a little room about them.
_FUNCTIONS = {"sin", "cos", "tan", "max"}

_PIECE = re.compile(r"(frac|root)\(((?:[^()]|\([^()]*\))*)\)|(\S+)")


def _row(text: str) -> str:
    return "".join(_piece(match) for match in _PIECE.finditer(text))


def _piece(match: re.Match[str]) -> str:
    """A fraction, a root, or one symbol."""
    if match[1] == "frac":
        over, under = match[2].split("|")
        return f"<mfrac><mrow>{_row(over)}</mrow><mrow>{_row(under)}</mrow></mfrac>"
    if match[1] == "root":
        return f"<msqrt>{_row(match[2])}</msqrt>"
    if match[3] in _BETWEEN:
        return f"<mtext>{_BETWEEN[match[3]]}</mtext>"
    return _symbol(match[3])


def _symbol(text: str) -> str:
    """A symbol with its index and its power."""
    base, _, power = text.partition("^")
    base, _, index = base.partition("_")
    core = f"<{_tag(base)}>{base}</{_tag(base)}>"
    room = '<mspace width="0.17em"></mspace>' if base in _FUNCTIONS else ""
    if not index and not power:
        return f"{room}{core}{room}"
    below = f"<mtext>{index}</mtext>" if index else "<mrow></mrow>"
    above = f"<mn>{power}</mn>" if power else "<mrow></mrow>"
    return f"{room}<msubsup>{core}{below}{above}</msubsup>{room}"


def _tag(text: str) -> str:
    """Element of MathML for a symbol: a number, an operator, or a letter."""
    if text[0].isdigit():
        return "mn"
    return "mi" if text[0].isalpha() else "mo"


def _typst_piece(match: re.Match[str]) -> str:
    """A fraction, a root, or one symbol."""
    if match[1] == "frac":
        over, under = match[2].split("|")
        return f"frac({typst(over)}, {typst(under)})"
    if match[1] == "root":
        return f"sqrt({typst(match[2])})"
    if match[3] in _BETWEEN:
        return {",": '"," quad'}.get(match[3], f'quad "{match[3]}" quad')
    base, _, power = match[3].partition("^")
    base, _, index = base.partition("_")
    below = f'_"{index}"' if index else ""
    above = f'^"{power}"' if power else ""
    return "".join(_typst_part(part) for part in _PARTS.findall(base)).strip() + below + above


# Words, numbers, a letter or sign with its primes.
_PARTS = re.compile(r"[A-Za-z]{2,}|[\d.]+|.′*")

# Signs that mean something else in Typst.
_BAR = 'class("normal", bar.v)'
_SIGNS = {"|": _BAR, "∣": _BAR, "/": "slash"}


def _typst_part(part: str) -> str:
    """A word is an operator, a sign its name; a letter stays as it is. A blank ends each."""
    if len(part) > 1 and part.isascii() and part.isalpha():
        return f'op("{part}") '
    return _SIGNS.get(part, part.replace("′", "'")) + " "


MOTION = Formula(
    "Motion of the machine, reduced to the crank",
    "J ω frac(d ω|d φ) + frac(1|2) ω^2 frac(d J|d φ) = M_d − M_r",
    "paper 1 (1)",
)
INERTIA = Formula(
    "Reduced inertia, over all bodies and the drive",
    "J = J_0 + Σ ( m |p′|^2 + J_S ψ′^2 )",
    "paper 1 (10), for any linkage",
)
LOAD = Formula(
    "Reduced torque of all forces and torques",
    "M_r = − Σ F · p′ − Σ M ψ′",
    "paper 1 (5), for any linkage",
)
KLOSS = Formula(
    "Torque of an induction motor over its slip",
    "M = frac(2 M_k|s / s_k + s_k / s) , s = frac(ω_0 − ω_m|ω_0)",
    "Kloss 1909; paper 1 (8)",
)
GEARBOX = Formula("Driving torque at the crank, behind the gearbox", "M_d = M i η", "paper 1 (9)")
UNEVENNESS = Formula("Coefficient of speed fluctuation", "δ = frac(ω_max − ω_min|ω_mean)", "paper 1 (13)")
DYNAMISM = Formula("Dynamic factor", "H = frac(∣ε∣_max|ω_mean^2)", "paper 1 (14)")
COEFFICIENT = Formula("Combined non-uniformity index", "k_p = δ^2 + H", "paper 1 (15)")
MEANS = Formula(
    "Mean speed, of the extremes or over time",
    "ω_mean = frac(ω_max + ω_min|2) , ω_mean = frac(2 π|T)",
    "paper 1 takes the first",
)
LIMIT = Formula(
    "Constant-energy limit: motor and loads switched off",
    "ω ∝ frac(1|root(J)) , ε = − frac(ω^2|2 J) frac(d J|d φ)",
    "(1) without torques",
)
STEPS = Formula(
    "Step method",
    "ω_k+1 = frac(( M_d − M_r ) Δφ|J_k ω_k) + frac(3 J_k − J_k+1|2 J_k) ω_k",
    "Baranov; paper 1 (4)",
)


def formulas(*, induction: bool, motor: bool, steps: bool) -> list[Formula]:
    """The formulas that a report needs, from the motion to its measures.

    With those of an induction motor, of any motor, of the step method if these are in it.
    """
    needed = [MOTION, INERTIA, LOAD]
    needed += [KLOSS] if induction else []
    needed += [GEARBOX] if motor else []
    needed += [UNEVENNESS, DYNAMISM, COEFFICIENT, MEANS] if motor else []
    return [*needed, LIMIT, *([STEPS] if steps else [])]
