r"""Sobol indices of responses, first and total, with confidence intervals.

A block has two independent machines A and B, and for each variable i one, A_i, that is A with the value of B
in this variable. With responses f about their mean and their variance V,

.. math::

    S_i = \frac{\overline{f_B (f_{A_i} - f_A)}}{V}, \qquad T_i = \frac{\overline{(f_A - f_{A_i})^2}}{2V}

by the estimators of Saltelli and of Jansen [1]_. Both are ratios of means over independent blocks. By the
delta method [2]_ such a ratio R = ū/v̄ scatters as the mean of (u − R v)/v̄; the mean of f, which is estimated
too, does not count to first order. The interval is R ± t s/√n with Student's t of n − 1 and the standard
deviation s of these numbers. A block in which a row fails is dropped whole.

References
----------
.. [1] Saltelli et al., *Variance based sensitivity analysis of model output*, Comput. Phys. Commun. 181
   (2010) 259, table 2 (b) and (f).
.. [2] Janon et al., *Asymptotic normality and efficiency of two Sobol index estimators*, ESAIM: Probability
   and Statistics 18 (2014) 342.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import FindingError
from linkwright.studies import sampling
from linkwright.studies.engine import evaluate
from linkwright.studies.plan import StudyPlan
from linkwright.studies.rows import SOLVED

# Ends of the intervals of the first and of the total index.
Interval = tuple[tuple[float, float], tuple[float, float]]


@dataclass(frozen=True)
class Index:
    """First and total index of a variable, with half the width of the interval of each."""

    first: float
    total: float
    first_half: float
    total_half: float


@dataclass(frozen=True)
class SobolIndices:
    """Sobol indices by variable."""

    responses: dict[str, dict[str, Index]]
    failures: dict[str, Index]  # of whether a machine has no result; empty if all have
    n_dropped: int  # blocks with a row without a result
    one_by_one: Counter[str]  # why rows were computed one by one


# Where none are asked for.
NONE = SobolIndices({}, {}, 0, Counter())


def sobol_indices(plan: StudyPlan, seed: int, n: int, level: float) -> SobolIndices:
    """Sobol indices of n blocks, each of as many machines as variables and two.

    `level`: confidence level. Raises FindingError: fewer than two blocks have all their results.
    """
    d = len(plan.axes)
    both = sampling.random(2 * d, seed + 1, 0, n)
    a, b = both[:, :d], both[:, d:]
    mixed = np.repeat(a[None], d, axis=0)
    for i in range(d):
        mixed[i, :, i] = b[:, i]
    rows = evaluate(plan, plan.values(np.vstack([a, b, mixed.reshape(d * n, d)])))
    solved = (rows.status == SOLVED).reshape(d + 2, n)
    kept = solved.all(axis=0)
    if kept.sum() < 2:
        raise FindingError("too few blocks of the Sobol indices have an answer in all their rows")
    names = [axis.name for axis in plan.axes]
    tables = {name: rows.columns[name].reshape(d + 2, n)[:, kept] for name in plan.responses}
    return SobolIndices(
        {name: of_blocks(names, table, level) for name, table in tables.items()},
        {} if solved.all() else of_blocks(names, 1.0 - solved, level),
        int((~kept).sum()),
        rows.one_by_one,
    )


def of_blocks(names: list[str], f: Floats, level: float) -> dict[str, Index]:
    """Indices of each variable; f: ndarray, shape (variables + 2, blocks)."""
    # A shift leaves the indices, and takes away rounding.
    f = f - f[:2].mean()
    squares = (f[:2] ** 2).mean(axis=0)
    if not squares.mean() > 0:
        return dict.fromkeys(names, Index(0.0, 0.0, 0.0, 0.0))
    first, first_half = _ratios(f[1] * (f[2:] - f[0]), squares, level)
    total, total_half = _ratios(0.5 * (f[0] - f[2:]) ** 2, squares, level)
    columns = (first, total, first_half, total_half)
    return {name: Index(*map(float, row)) for name, row in zip(names, np.stack(columns, axis=1), strict=True)}


def _ratios(above: Floats, below: Floats, level: float) -> tuple[Floats, Floats]:
    """Ratios of means over blocks, (k,), with half their intervals; `above` (k, n), `below` (n,)."""
    from scipy.special import stdtrit

    n, mean = len(below), float(below.mean())
    ratio = above.mean(axis=1) / mean
    deviation = ((above - ratio[:, None] * below) / mean).std(axis=1, ddof=1)
    return ratio, float(stdtrit(n - 1, 0.5 * (1 + level))) * deviation / np.sqrt(n)


def values(indices: Mapping[str, Index]) -> dict[str, tuple[float, float]]:
    """First and total index by variable."""
    return {name: (index.first, index.total) for name, index in indices.items()}


def intervals(indices: Mapping[str, Index]) -> dict[str, Interval]:
    """Ends of the intervals of first and total index by variable."""
    return {
        name: (
            (index.first - index.first_half, index.first + index.first_half),
            (index.total - index.total_half, index.total + index.total_half),
        )
        for name, index in indices.items()
    }
