r"""Polynomials by conditions at their ends.

.. math:: x(z) = \sum_p c_p z^p

with as many powers p as derivatives are given at the two ends. Without a choice the powers are 0, 1, 2, … .
The linear equations are solved in exact fractions, as floats are: the coefficients come out as they are,
rounded once: 10, −15, 6.

Source: VDI 2143 Blatt 1 (1980); Rothbart (ed.), *Cam Design Handbook* (2004), chapter 4.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from math import perm
from typing import Any

from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.cam.laws.piece import Piece
from linkwright.kernel.errors import LawError, Problem
from linkwright.kernel.numerics.tangent import Tangent, plain, primal

Row = list[Fraction]


def solve(
    rows: Sequence[Sequence[Fraction | int]], right: Sequence[float | Fraction]
) -> list[Fraction] | None:
    """The solution by elimination."""
    table = [[*map(Fraction, row), Fraction(value)] for row, value in zip(rows, right, strict=True)]
    for i in range(len(table)):
        pivot = next((j for j in range(i, len(table)) if table[j][i]), None)
        if pivot is None:
            return None
        table[i], table[pivot] = table[pivot], table[i]
        table[i] = [entry / table[i][i] for entry in table[i]]
        table = [row if j == i else _without(row, table[i], i) for j, row in enumerate(table)]
    return [row[-1] for row in table]


def _without(row: Row, other: Row, i: int) -> Row:
    """Eliminate entry i of a row by another row."""
    return [a - row[i] * b for a, b in zip(row, other, strict=True)] if row[i] else row


# Order of the derivative → its value.
Conditions = Mapping[int, float]


def polynomial(start: Conditions, end: Conditions, powers: Sequence[int] | None = None) -> MotionLaw:
    """The polynomial that meets given values and derivatives at z = 0 and z = 1."""
    n = len(start) + len(end)
    used = sorted(set(range(n) if powers is None else powers))
    if len(used) != n:
        expected = f"{n} powers, as many as there are conditions at the two ends"
        raise LawError(Problem("powers", _listed(used), expected))
    rows = [*(_at_start(order, used) for order in start), *(_at_end(order, used) for order in end)]
    values = [*start.values(), *end.values()]
    solved = solve(rows, [primal(value) for value in values])
    if solved is None:
        expected = "powers that can meet every condition: each order that is given at the start is one"
        raise LawError(Problem("powers", _listed(used), expected))
    by_power: dict[int, Any] = dict(zip(used, map(float, solved), strict=True))
    for i, value in enumerate(values):
        if isinstance(value, Tangent):
            # The coefficients are linear in each condition.
            unit = solve(rows, [float(i == k) for k in range(n)])
            still = Tangent(0.0, value.d)
            by_power = {p: by_power[p] + still * float(c) for p, c in zip(used, unit or (), strict=True)}
    return MotionLaw((0.0, 1.0), (Piece(coefficients(by_power)),))


def coefficients(by_power: Mapping[int, Any]) -> tuple[Any, ...]:
    """All coefficients from the constant on, of power → coefficient."""
    given = (by_power.get(p, 0) for p in range(max(by_power) + 1))
    return tuple(map(plain, given))


def polynomial_3_4_5() -> MotionLaw:
    """f = 10 z³ − 15 z⁴ + 6 z⁵: velocity and acceleration vanish at both ends."""
    return polynomial({0: 0, 1: 0, 2: 0}, {0: 1, 1: 0, 2: 0})


def polynomial_4_5_6_7() -> MotionLaw:
    """f = 35 z⁴ − 84 z⁵ + 70 z⁶ − 20 z⁷: the jerk vanishes at both ends too."""
    return polynomial({0: 0, 1: 0, 2: 0, 3: 0}, {0: 1, 1: 0, 2: 0, 3: 0})


def _at_start(order: int, powers: Sequence[int]) -> list[int]:
    """A derivative of each power at z = 0."""
    return [perm(p, order) if p == order else 0 for p in powers]


def _at_end(order: int, powers: Sequence[int]) -> list[int]:
    """A derivative of each power at z = 1."""
    return [perm(p, order) for p in powers]


def _listed(powers: Sequence[int]) -> str:
    return ", ".join(map(str, powers))
