"""Curves of results as CSV, with the unit of each column in its head."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.files.csv_text import csv_text
from linkwright.kernel.page.quantities import SHOWN
from linkwright.kernel.result import Result
from linkwright.kinetostatics.result import Forces
from linkwright.topping.topper import TopperStudy

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
    if isinstance(result, Forces):
        return forces_csv(result)
    curves = result.curves()
    return columns_csv({head(name): curve for name, curve in curves.items()}) if curves else ""


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


def edge_csv(found: TopperStudy) -> str:
    """The use of a topper's edge along its length as CSV: a curve of its own length.

    Parameters
    ----------
    found : TopperStudy
        The study of the topper.

    Returns
    -------
    str
        Two columns.
    """
    return columns_csv({head(name): getattr(found, name) for name in ("edge_place", "edge_use")})


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


def forces_csv(forces: Forces) -> str:
    """Forces over the crank angle as CSV.

    Parameters
    ----------
    forces : Forces
        The forces.

    Returns
    -------
    str
        The motion, torques and powers, then the two components of each pair's force and its moment, and the
        force on each driver; empty cells where there is no value.
    """
    columns = {head(name): curve for name, curve in forces.curves().items()}
    columns |= {f"shaking_force_{axis} [N]": forces.shaking_force[:, k] for k, axis in enumerate("xy")}
    for name, pair in forces.pairs.items():
        columns |= {f"{name}_{axis} [N]": pair.force[:, k] for k, axis in enumerate("xy")}
        columns[f"{name}_moment [N m]"] = pair.moment
    columns |= {f"{name}_drive [N m or N]": values for name, values in forces.drives.items()}
    return columns_csv(columns)
