"""The entries that matter most for a response, as a table."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from linkwright.kernel.page.table import Row, Table
from linkwright.kernel.reader.numbers import measured, number
from linkwright.sensitivity.figures import ROWS
from linkwright.sensitivity.gradient import Gradient, derivative_unit


def gradient_tables(gradient: Gradient) -> Iterator[Table]:
    """A table for each response."""
    for row, response in enumerate(gradient.responses):
        title = f"{gradient.words[row]} = {measured(float(gradient.values[row]), gradient.units[row])}"
        heads = ("entry", "", "value", "derivative", "change for +1 %")
        rows = [_row(gradient, row, at) for at in gradient.ranked(response)[:ROWS]]
        yield Table(response.replace(".", "_"), title, heads, rows)


def _row(gradient: Gradient, row: int, at: int) -> Row:
    entry, value = gradient.variables[at], float(gradient.at[at])
    derivative, per = float(gradient.derivatives[row, at]), derivative_unit(gradient, row, at)
    elasticity = float(gradient.elasticities[row, at])
    share = "–" if not np.isfinite(elasticity) or value == 0 else f"{number(elasticity, 3)} %"
    return entry, "", measured(value, gradient.variable_units[at]), measured(derivative, per), share
