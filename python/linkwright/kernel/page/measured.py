"""Cells of tables that know their number, so that it can be shown in another unit."""

from __future__ import annotations

import math

from linkwright.kernel.page.numbers import degrees, number, quantity


class Measured(str):
    """Text of a number with its SI unit; an angle is in degrees.

    Attributes
    ----------
    value : float
        In SI.
    unit : str
        SI unit as it is printed.
    digits : int
        Significant digits.
    is_crank_angle : bool
        Whether it is an angle of the crank, which may be counted from a dead centre.
    before : str
        What stands before the number.
    """

    value: float
    unit: str
    digits: int
    is_crank_angle: bool
    before: str


def measured(
    value: float | None,
    unit: str,
    scale: float = 0.0,
    digits: int = 5,
    before: str = "",
    usual: str = "",
) -> str:
    """A value with its unit.

    Parameters
    ----------
    value : float or None
        In SI; None is a dash.
    unit : str
        SI unit, empty for none; printed in the unit that the reader wants, angles in degrees without one.
    scale : float
        Peak absolute value of what the number belongs to: what is rounding beside it is zero.
    digits : int
        Significant digits.
    before : str
        What stands before the number.
    usual : str
        Unit in which it is printed where the reader wants no other, such as ``"mm"``; empty for `unit`.

    Returns
    -------
    str
        A `Measured`, unless there is no number.
    """
    if value is None or not math.isfinite(value):
        return "–"
    plain = degrees(value) if unit == "rad" else quantity(value, unit, digits, scale, usual=usual)
    return _marked(
        before + plain, value if number(value, digits, scale) != "0" else 0.0, unit, digits, before
    )


def crank_angle(angle: float | None, before: str = "") -> str:
    """A crank angle [rad] within a revolution, from 0° on; a full revolution is 0°."""
    if angle is None or not math.isfinite(angle):
        return "–"
    text = degrees(angle)
    plain = "0°" if text == "360°" else text
    return _marked(before + plain, angle, "rad", 5, before, is_crank_angle=True)


def _marked(
    text: str, value: float, unit: str, digits: int, before: str, *, is_crank_angle: bool = False
) -> Measured:
    marked = Measured(text)
    marked.value, marked.unit, marked.digits, marked.before = value, unit, digits, before
    marked.is_crank_angle = is_crank_angle
    return marked
