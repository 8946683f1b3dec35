"""Read a number, or a text with a unit, as a quantity; write a quantity as text.

Specks below the smallest size of a kind are what arithmetic leaves of zero: a quantity with a sign keeps
them, one that may be zero is zero there, and one that may not is refused (`marks`).
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from numbers import Real
from typing import TypeGuard

from linkwright.kernel.errors import Problem, UnitError, show
from linkwright.kernel.units.kinds import ANGLE, OF_ANY_KIND, Kind, range_words
from linkwright.kernel.units.spellings import factor_of, fits, other_quantity, unknown

# Repetitions that never give back what they took (`++`): a text of any length is read once.
_NUMBER = r"[+-]?(?:\d++(?:\.\d*+)?|\.\d++)(?:[eE][+-]?\d++)?"
# A number without a unit: digits, a point, an exponent.
NUMBER = re.compile(_NUMBER, re.ASCII)
_VALUE = re.compile(rf"({_NUMBER})\s*(.*)", re.DOTALL)
_VALUES = re.compile(rf"({_NUMBER}(?:[\s,;]++{_NUMBER})*)\s*(.*)", re.DOTALL)
# 0,5 kN; 1,000.5 mm; 1.000,5 mm: what a comma means there depends on the country.
_DECIMAL_COMMA = re.compile(
    r"[+-]?(?:\d++(?:,\d++)++(?:\.\d*+)?|\d++(?:\.\d++)++,\d++)(?:[eE][+-]?\d++)?(?:\s*+[^\d\s,;].*)?",
    re.DOTALL,
)
# 1 000 mm, 1'000 mm: thousands by a space or an apostrophe.
_THOUSANDS = re.compile(r"[+-]?\d{1,3}(?:[ '’\u00a0\u202f]\d{3})+(?![\d^/]).*", re.DOTALL)
# In a list: beside semicolons or commas with spaces, or as its one comma.
_COMMA_IN_LIST = re.compile(r"(?=.*\d,\d)(?=.*(?:;|,\s)).*|[+-]?\d+,\d+(?:\s*[^\d\s,;].*)?", re.DOTALL)

_NO_COMMA = "write the decimal point as a point, not as a comma, and thousands without a separator"


def parse(value: object, kind: Kind) -> float:
    """A number [SI] or a text with a unit as a quantity of one kind, finite, in the SI unit of the kind.

    Raises `UnitError` for a wrong type or dimension, an unknown unit, or a value beyond the range of the
    kind.

    >>> parse("0.5 kN", FORCE), parse(3, FORCE)
    (500.0, 3.0)
    """
    if isinstance(value, str):
        number, unit = _split(value, kind)
        return _in_range(float(number) * _factor(unit, kind, value), value, kind)
    if not is_number(value):
        raise wrong(value, kind)
    try:
        return _in_range(float(value), value, kind)
    except OverflowError:
        raise wrong(value, kind, range_words(kind)) from None


def is_number(value: object) -> TypeGuard[float]:
    """Whether an entry is a number: no switch, which Python counts as one, and no text."""
    return type(value) is float or (isinstance(value, Real) and not isinstance(value, bool))


def parse_any(value: object) -> float:
    """A number [SI], or a text with a unit of whatever quantity, in the coherent SI unit; else a `UnitError`.

    >>> parse_any("2 kN/m"), parse_any(3)
    (2000.0, 3.0)
    """
    if not isinstance(value, str):
        return parse(value, OF_ANY_KIND)
    number, unit = _split(value, OF_ANY_KIND)
    known = factor_of(unit)
    if known is None:
        raise wrong(value, OF_ANY_KIND, unknown(unit))
    return _in_range(float(number) * known[0], value, OF_ANY_KIND)


def parse_list(value: object, kind: Kind) -> list[float]:
    """A list of numbers and texts, an array, or one text with one unit, as quantities of one kind [SI].

    Raises `UnitError` if one of the values is no such quantity.

    >>> parse_list("0, 10, 25 cm", LENGTH)
    [0.0, 0.1, 0.25]
    """
    return [parse(item, kind) for item in items(value, kind)]


def to_text(value: float, kind: Kind) -> str:
    """A value [SI] with its unit, such as ``"0.2 m"``; `parse` gives back the very same float."""
    return f"{float(value)!r} {kind.unit}".removesuffix(" ").replace(".0 ", " ")


def worded(value: float, kind: Kind) -> str:
    """A value [SI] for a message, with six digits and its unit: angles in degrees, all else in SI."""
    if kind is ANGLE:
        return f"{math.degrees(value):.6g} deg"
    return f"{value:.6g} {kind.unit}".removesuffix(" ")


def _split(text: str, kind: Kind) -> tuple[str, str]:
    """The number and the unit of a text."""
    stripped = text.strip().replace("−", "-")
    match = _VALUE.fullmatch(stripped)
    if _DECIMAL_COMMA.fullmatch(stripped) or _THOUSANDS.fullmatch(stripped):
        raise wrong(text, kind, _NO_COMMA)
    if match is None:
        raise wrong(text, kind)
    if not match[2] and kind.unit:
        raise wrong(text, kind, f'add the unit ("{stripped} {kind.unit}"), or remove the quotes')
    return match[1], match[2]


def items(value: object, kind: Kind) -> Sequence[object]:
    """The separate values of a list, of an array, or of one text with one unit."""
    if isinstance(value, str):
        text = value.strip().replace("−", "-")
        match = _VALUES.fullmatch(text)
        if match is None or _COMMA_IN_LIST.fullmatch(text):
            raise wrong(value, kind, _NO_COMMA if "," in text else "", many=True)
        return [f"{number} {match[2]}" for number in re.split(r"[\s,;]+", match[1])]
    listed = value.tolist() if hasattr(value, "tolist") else value
    if not isinstance(listed, list | tuple):
        raise wrong(value, kind, many=True)
    return listed


def _factor(unit: str, kind: Kind, given: object) -> float:
    """What a value in this unit is multiplied by to be in SI."""
    known = factor_of(unit)
    if known is None:
        raise wrong(given, kind, unknown(unit))
    factor, dimension = known
    if not fits(dimension, kind):
        raise wrong(given, kind, other_quantity(unit, dimension, kind))
    return factor


def _in_range(number: float, given: object, kind: Kind) -> float:
    """The number itself, unless it is larger than any of its kind, infinite, or not a number."""
    if not math.isfinite(number):
        raise wrong(given, kind, "the number must be finite")
    if abs(number) > kind.most:
        raise wrong(given, kind, range_words(kind))
    return number


def wrong(value: object, kind: Kind, remedy: str = "", *, many: bool = False) -> UnitError:
    """The error that says what was found and what a quantity of this kind looks like."""
    expected = list_words(kind) if many else kind.expected
    return UnitError(Problem(found=show(value), expected=expected, remedy=remedy))


def list_words(kind: Kind) -> str:
    """What belongs into a list of a kind."""
    return f"a list; each entry {kind.expected}"
