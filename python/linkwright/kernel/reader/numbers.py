"""Numbers as text, and cells of tables that know their number, so that it can be shown in another unit."""

from __future__ import annotations

import math
import sys
from typing import TYPE_CHECKING

from linkwright.kernel.reader.angle_zero import Zero, zero_shown
from linkwright.kernel.reader.out_units import reader

if TYPE_CHECKING:
    from linkwright.kernel.arrays import Floats

# Share of what it belongs to below which a number is rounding: sums of some ten thousand doubles.
NOISE = 1e-12


def number(value: float | None, digits: int | None = None, scale: float = 0.0) -> str:
    """A number as text, with a true minus sign and a power of ten where it is very large or small; None is a
    dash.

    `digits`: significant digits, those that the reader wants without it; `scale`: peak absolute value of what
    the number belongs to (a row, a curve, quantities of one unit): what is rounding beside it is zero.

    >>> number(0.08495914), number(-1.4051e-08, 3), number(3.9e-13, scale=512.0)
    ('0.08496', '−1.41·10⁻⁸', '0')
    """
    if value is None or not math.isfinite(value):
        return "–"
    # Below the smallest normal number, a double has lost its digits.
    if abs(value) <= max(NOISE * scale, sys.float_info.min):
        return "0"
    text = f"{value:.{digits or reader().digits}g}"
    if "e" in text and 1 <= abs(value) < _LARGE:
        text = f"{float(text):.0f}"
    if "e" in text:
        head, power = text.split("e")
        text = f"{head}·10{str(int(power)).translate(RAISED)}"
    return text.replace("-", "−")


# Below this, a number with more places than digits is written out: 20240 W, not 2.024·10⁴ W.
_LARGE = 1e7

RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


# An angle at which links are in line follows from a root: below that of some ten rounding errors it is zero
# [rad].
_ROUNDING = 1e-7

# The place of an extreme is known to the root of the accuracy of the curve, 1e-12 of its size [rad].
_PLACE = 1e-6


def degrees(angle: float, digits: int | None = None) -> str:
    """An angle in radians as text, in degrees unless the reader wants another unit; rounding is zero."""
    return quantity(0.0 if abs(angle) < _ROUNDING else angle, "rad", digits, usual="deg")


def quantity(
    value: float | None,
    unit: str,
    digits: int | None = None,
    scale: float = 0.0,
    before: str = "",
    usual: str = "",
) -> str:
    """A number with its unit as text, such as ``0.08496 m``, in the unit that the reader wants; None is a
    dash.

    `scale` as of `number`; `before`: what stands before it; `usual`: unit where the reader wants no other.
    """
    if value is None or not math.isfinite(value):
        return "–"
    text, name = parted(value, unit, digits, scale, usual)
    return f"{before}{text}{'' if name == '°' else ' '}{name}".rstrip()


def parted(
    value: float, unit: str, digits: int | None = None, scale: float = 0.0, usual: str = ""
) -> tuple[str, str]:
    """A number and its unit as texts, as `quantity` writes them together."""
    name, factor = reader().shown(unit, usual)
    return number(value / factor, digits, scale / factor), name


def pretty_unit(unit: str) -> str:
    """A unit as it is printed: ``kg m^2`` becomes ``kg m²``."""
    return unit.replace("^2", "²").replace("^3", "³").replace("^4", "⁴")


class QuantityText(str):
    """Text of a number with its SI unit; an angle is in degrees."""

    value: float  # in SI
    unit: str  # SI unit as it is printed
    is_crank_angle: bool  # whether it is an angle of the crank, which may be counted from a dead centre
    before: str  # what stands before the number


# Units in which people read a quantity, where they want no other.
_USUAL = {"Pa": "MPa"}


def measured(
    value: float | None,
    unit: str,
    scale: float = 0.0,
    digits: int | None = None,
    before: str = "",
    usual: str = "",
) -> str:
    """A value [SI] with its unit, a `QuantityText`; None is a dash. Angles are in degrees without a unit.

    `scale` as of `number`; `before`: what stands before it; `usual`: unit where the reader wants no other.
    """
    if value is None or not math.isfinite(value):
        return "–"
    usual = usual or _USUAL.get(unit, "")
    number_text = (
        degrees(value, digits) if unit == "rad" else quantity(value, unit, digits, scale, usual=usual)
    )
    return _marked(before + number_text, value if number(value, digits, scale) != "0" else 0.0, unit, before)


def crank_angle(angle: float | None, before: str = "", cycle: float = 2 * math.pi) -> str:
    """A crank angle within a cycle [rad], its end 0, counted from the dead centre that the reader wants."""
    if angle is None or not math.isfinite(angle):
        return "–"
    counted = zero_shown().counted(angle)
    text = degrees(0.0 if abs(counted) < _PLACE else counted)
    number_text = "0°" if text == degrees(cycle) else text
    return _marked(before + number_text, angle, "rad", before, is_crank_angle=True)


# Share of a revolution by which angles may exceed whole ones: rounding.
_WHOLE = 1e-6


def cycle_of_angles(angles: Floats) -> float:
    """The cycle that crank angles (n,) run through [rad]: whole revolutions, at least one."""
    turns = float(angles[-1] - angles[0]) / (2 * math.pi)
    return 2 * math.pi * max(math.ceil(turns - _WHOLE), 1)


def zero_words(zero: Zero) -> str:
    """From where crank angles are counted, in a line; empty where it is the zero of the file."""
    if not zero.words:
        return ""
    return f"Crank angles from the {zero.words}, φ = {degrees(zero.angle)} in the file"


def _marked(text: str, value: float, unit: str, before: str, *, is_crank_angle: bool = False) -> QuantityText:
    marked = QuantityText(text)
    marked.value, marked.unit, marked.before = value, unit, before
    marked.is_crank_angle = is_crank_angle
    return marked
