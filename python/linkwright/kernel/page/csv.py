"""Curves of results as CSV, with the unit of each column in its head."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.files.csv_text import csv_text
from linkwright.kernel.page.quantities import SHOWN
from linkwright.kernel.result import Result

Floats = NDArray[np.float64]


def curves_csv(result: Result) -> str:
    """The curves of a result as CSV.

    Parameters
    ----------
    result : Result
        A result with curves.

    Returns
    -------
    str
        One column a curve, such as ``speed [rad/s]``; numbers that read back exactly, empty cells where there
        is none; empty without curves.
    """
    columns = {head(name): curve for name, curve in result.curves().items()} | result.columns()
    return columns_csv(columns) if columns else ""


def columns_csv(columns: Mapping[str, Floats]) -> str:
    """Columns as CSV.

    Parameters
    ----------
    columns : mapping of str to ndarray, shape (n,)
        Head, with the unit, → values.

    Returns
    -------
    str
        Numbers that read back exactly; empty cells for NaN.
    """
    rows = zip(*(column.tolist() for column in columns.values()), strict=True)
    return csv_text(list(columns), rows)


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
