"""Findings, warnings and captions as they are shown: in the units, and with the crank angles, of the reader.

A sentence holds numbers with SI units, such as ``97.4 rad/s``, and crank angles as in ``φ = 90°`` or ``at
crank angle 90°``. It is changed where it is shown alone: programs get the sentence as it was said.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from math import ceil, floor, log10, radians

from linkwright.kernel.reader.angle_zero import zero_shown
from linkwright.kernel.reader.numbers import RAISED, degrees, number
from linkwright.kernel.reader.out_units import reader

# Units that sentences are written in, those of several parts first.
_UNITS = (
    *("N m s/rad", "N m/rad", "N s/m", "kg m²", "rad/s²", "rad/s", "kg/m", "m/s²", "m/s", "m/rad", "N/m"),
    *("N m", "J/kg", "kJ", "kW", "MPa", "GPa", "kN", "mm", "rpm", "Hz", "Pa", "kg", "J", "W", "N", "m", "s"),
)
_NUMBER = r"(?<![\w.,·^])[-−]?\d+(?:\.\d+)?(?:·10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+|e[-+]?\d+)?"
# Not the start of a longer unit, nor the power in the name of a type of motor.
_END = r"(?![\w²³⁴/·^]| \d+-pole)"
_QUANTITY = re.compile(rf"({_NUMBER}) ({'|'.join(map(re.escape, _UNITS))}){_END}")
_ANGLE = r"[-−]?\d+(?:\.\d+)?(?:e[-+]?\d+)?°"
_CRANK_ANGLES = re.compile(rf"((?:φ = |crank angles? (?:of )?))({_ANGLE}(?:(?:, | to | and ){_ANGLE})*)")

# A number as Python writes it, alone or behind a bracket: no part of a name, a command or a quoted entry.
_PLAIN = re.compile(r"(?<![^\s(±])(-?)(\d+(?:\.\d+)?)(?:e([-+]\d+))?(?=[\s),.;:°%]|$)")

# Digits with which a number in another unit is written at least: 1 m is 3.28 ft.
_DIGITS = 3


def sentence(text: str) -> str:
    """A sentence as the reader wants it."""
    if zero_shown().words:
        text = _CRANK_ANGLES.sub(_counted, text)
    return _PLAIN.sub(_typeset, _QUANTITY.sub(_in_units, text) if reader().chosen else text)


def sentences(texts: Iterable[str]) -> list[str]:
    """Sentences as the reader wants them."""
    return [sentence(text) for text in texts]


def _typeset(match: re.Match[str]) -> str:
    sign, head, power = match.groups()
    return f"{'−' if sign else ''}{head}{f'·10{str(int(power)).translate(RAISED)}' if power else ''}"


def _counted(match: re.Match[str]) -> str:
    return match[1] + re.sub(
        _ANGLE, lambda angle: degrees(zero_shown().counted(radians(_value(angle[0][:-1])))), match[2]
    )


def _in_units(match: re.Match[str]) -> str:
    unit, factor = reader().shown(match[2])
    if factor == 1.0:
        return match[0]
    value = _value(match[1]) / factor
    text = number(round(value, -_place(match[1], value, factor)), _ALL)
    return f"{text}{'' if unit == '°' else ' '}{unit}"


def _place(text: str, value: float, factor: float) -> int:
    head, _, power = text.replace("·10", "e").translate(_LOWERED).partition("e")
    last = 10.0 ** (int(power or 0) - len(head.partition(".")[2])) / abs(factor)
    first = floor(log10(abs(value))) if value else 0
    return min(ceil(log10(last) - _EXACT), first - _DIGITS + 1)


# Rounding of a logarithm.
_EXACT = 1e-9

# More digits than a number keeps that is rounded to a place.
_ALL = 12

_LOWERED = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")


def _value(text: str) -> float:
    """A number as `linkwright.kernel.reader.numbers` or Python writes it."""
    return float(text.replace("−", "-").replace("·10", "e").translate(_LOWERED))
