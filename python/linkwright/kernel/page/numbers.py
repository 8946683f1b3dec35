"""Numbers as text."""

from __future__ import annotations

import math
import sys

from linkwright.kernel.page.out_units import reader

# Share of what it belongs to below which a number is rounding: sums of some ten thousand doubles.
_NOISE = 1e-12


def number(value: float | None, digits: int = 5, scale: float = 0.0) -> str:
    """A number as text.

    Parameters
    ----------
    value : float or None
        The number; None is a dash.
    digits : int
        Significant digits.
    scale : float
        Peak absolute value of what the number belongs to: of a row, a curve, quantities of one unit. What is
        rounding beside it is zero.

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
    >>> number(3.9e-13, scale=512.0)
    '0'
    """
    if value is None or not math.isfinite(value):
        return "–"
    # Below the smallest normal number, a double has lost its digits.
    if abs(value) <= max(_NOISE * scale, sys.float_info.min):
        return "0"
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
    """An angle in radians as text, in degrees unless the reader wants another unit; rounding is zero."""
    return quantity(0.0 if abs(angle) < _ROUNDING else angle, "rad", usual="deg")


def quantity(
    value: float | None, unit: str, digits: int = 5, scale: float = 0.0, before: str = "", usual: str = ""
) -> str:
    """A number with its unit as text, in the unit that the reader wants.

    Parameters
    ----------
    value : float or None
        In `unit`; None is a dash.
    unit : str
        As it is printed; empty for none.
    digits : int
        Significant digits.
    scale : float
        Peak absolute value of what the number belongs to: what is rounding beside it is zero.
    before : str
        What stands before the number.
    usual : str
        Unit in which it is shown where the reader wants no other; empty for `unit`.

    Returns
    -------
    str
        Such as ``0.084959 m``.
    """
    if value is None or not math.isfinite(value):
        return "–"
    text, name = parted(value, unit, digits, scale, usual)
    return f"{before}{text}{'' if name == '°' else ' '}{name}".rstrip()


def parted(value: float, unit: str, digits: int = 5, scale: float = 0.0, usual: str = "") -> tuple[str, str]:
    """A number and its unit as texts, as `quantity` writes them together."""
    name, factor = reader().shown(unit, usual)
    return number(value / factor, digits, scale / factor), name


def pretty_unit(unit: str) -> str:
    """A unit as it is printed: ``kg m^2`` becomes ``kg m²``."""
    return unit.replace("^2", "²").replace("^3", "³")
