"""Formulas of a report with their sources, in a notation that becomes MathML or Typst.

Symbols have spaces between them; ``x_y``, ``x^y``, ``frac(a|b)`` and ``root(a)`` do more.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from markupsafe import Markup

# A symbol of one letter and its index.
INDEX = re.compile(r"\b(Δ?[^\W\d_])_(\w+(?:,\w+)?)")


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


def with_index(text: str) -> Markup:
    """A text in which the index of each symbol is lowered."""
    from markupsafe import Markup, escape

    return Markup(INDEX.sub(r"\1<sub>\2</sub>", str(escape(text))))


# What stands between two formulas, with room around it.
_BETWEEN = {"or": "\u2003or\u2003", ",": ",\u2003"}

# Names of functions, with a little room about them.
_FUNCTIONS = {"sin", "cos", "tan", "max"}

_PIECE = re.compile(r"(frac|root)\(((?:[^()]|\([^()]*\))*)\)|(\S+)")


def _row(text: str) -> str:
    return "".join(_piece(match) for match in _PIECE.finditer(text))


def _piece(match: re.Match[str]) -> str:
    if match[1] == "frac":
        over, under = match[2].split("|")
        return f"<mfrac><mrow>{_row(over)}</mrow><mrow>{_row(under)}</mrow></mfrac>"
    if match[1] == "root":
        return f"<msqrt>{_row(match[2])}</msqrt>"
    if match[3] in _BETWEEN:
        return f"<mtext>{_BETWEEN[match[3]]}</mtext>"
    return _symbol(match[3])


def _symbol(text: str) -> str:
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
