"""Linear equations in exact fractions, for the few unknowns of a motion law.

A float is a fraction, so the coefficients of a polynomial come out as they are, rounded once: 10, −15, 6.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

Number = Fraction | int | float
Row = list[Fraction]


def solve(
    rows: Sequence[Sequence[Fraction | int]], right: Sequence[float | Fraction]
) -> list[Fraction] | None:
    """The solution by elimination.

    Parameters
    ----------
    rows : sequence of sequence
        Coefficients, n rows of n.
    right : sequence
        Right sides, n.

    Returns
    -------
    list of Fraction or None
        The n unknowns; None if the rows depend on each other.
    """
    table = [[*map(Fraction, row), Fraction(value)] for row, value in zip(rows, right, strict=True)]
    for i in range(len(table)):
        pivot = next((j for j in range(i, len(table)) if table[j][i]), None)
        if pivot is None:
            return None
        table[i], table[pivot] = table[pivot], table[i]
        table[i] = [each / table[i][i] for each in table[i]]
        table = [row if j == i else _without(row, table[i], i) for j, row in enumerate(table)]
    return [row[-1] for row in table]


def _without(row: Row, other: Row, i: int) -> Row:
    """The row less so much of the other that its entry i vanishes."""
    return [a - row[i] * b for a, b in zip(row, other, strict=True)] if row[i] else row
