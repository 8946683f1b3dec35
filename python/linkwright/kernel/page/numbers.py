"""Numbers as text."""

from __future__ import annotations

import math


def number(value: float | None, digits: int = 5) -> str:
    """A number as text.

    Parameters
    ----------
    value : float or None
        The number; None is a dash.
    digits : int
        Significant digits.

    Returns
    -------
    str
        With a true minus sign, and a power of ten where it is very large or very small.

    Examples
    --------
    >>> number(0.08495914)
    '0.084959'
    >>> number(-1.4051e-08, 3)
    '−1.41·10⁻⁸'
    """
    if value is None or not math.isfinite(value):
        return "–"
    text = f"{value:.{digits}g}"
    if "e" in text and 1 <= abs(value) < _LARGE:
        text = f"{float(text):.0f}"
    if "e" in text:
        head, power = text.split("e")
        text = f"{head}·10{str(int(power)).translate(_RAISED)}"
    return text.replace("-", "−")


# Below this, a number with more places than digits is written out: 20240 W, not 2.024·10⁴ W.
_LARGE = 1e7

_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


# An angle at which links are in line follows from a root: below that of the rounding unit it is zero [rad].
_ROUNDING = 2e-8


def degrees(angle: float) -> str:
    """An angle in radians as text in degrees; what is left of zero by rounding is zero."""
    shown = 0.0 if abs(angle) < _ROUNDING else math.degrees(angle)
    return f"{shown:.5g}°".replace("-", "−")


def pretty_unit(unit: str) -> str:
    """A unit as it is printed: ``kg m^2`` becomes ``kg m²``."""
    return unit.replace("^2", "²").replace("^3", "³")
