"""Curves of results as CSV, with the unit of each column in its head."""

from __future__ import annotations

from linkwright.analysis.result import Result
from linkwright.report.quantities import SHOWN


def curves_csv(result: Result) -> str:
    """The curves of a result as CSV.

    Parameters
    ----------
    result : Result
        A result with curves.

    Returns
    -------
    str
        One column a curve, such as ``speed [rad/s]``; numbers that read back exactly; empty without curves.
    """
    curves = result.curves()
    if not curves:
        return ""
    rows = zip(*(curve.tolist() for curve in curves.values()), strict=True)
    lines = [",".join(head(name) for name in curves), *(",".join(map(repr, row)) for row in rows)]
    return "\n".join(lines) + "\n"


def head(name: str) -> str:
    """Head of a column: the attribute's name with its unit."""
    unit = SHOWN[name].unit if name in SHOWN else _unit_of_part(name)
    return f"{name} [{unit or '-'}]"


# Units of the columns of parts, by the last word of their name, and by that before a rate.
_PARTS = {
    "x": "m",
    "y": "m",
    "place": "m",
    "angle": "rad",
    "transmission_angle": "rad",
    "stroke_ratio": "m/rad",
}
_RATES = {"velocity": "/s", "acceleration": "/s²", "jerk": "/s³"}


def _unit_of_part(name: str) -> str:
    """Unit of a column such as ``K.x.velocity``."""
    head, _, last = name.rpartition(".")
    if last in _RATES and head:
        return _unit_of_part(head) + _RATES[last]
    return _PARTS.get(last, "") if head else ""
