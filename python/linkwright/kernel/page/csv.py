"""Curves of results as CSV, with the unit of each column in its head."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.files.csv_text import csv_text
from linkwright.kernel.page.out_units import shown_columns
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
    columns = {head(result, name): curve for name, curve in result.curves().items()} | result.columns()
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
        In the units that the reader wants. Numbers that read back exactly; empty cells for NaN.
    """
    shown = shown_columns(columns)
    rows = zip(*(column.tolist() for column in shown.values()), strict=True)
    return csv_text(list(shown), rows)


def head(result: Result, name: str) -> str:
    """Head of a column: the curve's name with its unit."""
    return f"{name} [{result.unit_of(name) or '-'}]"
