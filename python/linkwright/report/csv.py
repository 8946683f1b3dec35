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
    unit = SHOWN[name].unit if name in SHOWN else ""
    return f"{name} [{unit or '-'}]"
