"""The entries that matter most for a response, as a table."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from linkwright.kernel.page.numbers import measured, number
from linkwright.kernel.page.table import Row, Table
from linkwright.sensitivity.gradient import Gradient

# Rows of a table: what comes after changes a response by less than these.
ROWS = 12

# Elasticity that is rounding error: a derivative is exact to some 1e-14 of the largest of its sum.
ROUNDED = 1e-13


def ranked(gradient: Gradient, response: str) -> list[int]:
    """Places of the variables by their influence: change of the response for 1 % of each, largest first.

    Entries that are zero follow, by the size of the derivative. Rounding errors are left out.
    """
    row = gradient.responses.index(response)
    slopes = gradient.derivatives[row]
    effect = np.abs(slopes * gradient.at)
    is_rounding = (gradient.at != 0) & (effect <= ROUNDED * np.abs(gradient.values[row]))
    known = np.flatnonzero(np.isfinite(slopes) & (slopes != 0) & ~is_rounding).tolist()
    return sorted(known, key=lambda at: (-effect[at], -abs(slopes[at])))


def gradient_tables(gradient: Gradient) -> Iterator[Table]:
    """A table for each response."""
    for row, response in enumerate(gradient.responses):
        title = f"{gradient.words[row]} = {measured(float(gradient.values[row]), gradient.units[row])}"
        heads = ("entry", "", "value", "derivative", "change for +1 %")
        rows = [_row(gradient, row, at) for at in ranked(gradient, response)[:ROWS]]
        yield Table(response.replace(".", "_"), title, heads, rows)


def _row(gradient: Gradient, row: int, at: int) -> Row:
    entry, value = gradient.variables[at], float(gradient.at[at])
    derivative, unit = float(gradient.derivatives[row, at]), gradient.variable_units[at]
    per = f"{gradient.units[row]} per {unit}".strip() if unit else gradient.units[row]
    elasticity = float(gradient.elasticities[row, at])
    share = "–" if not np.isfinite(elasticity) or value == 0 else f"{number(elasticity, 3)} %"
    return entry, "", measured(value, unit), measured(derivative, per), share
