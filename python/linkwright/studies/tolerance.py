r"""Tolerances: how responses scatter when variables do, by first and second order, and by Monte Carlo.

With the values x of the variables, their middles and standard deviations σ, to first order

.. math:: \sigma_f^2 = \sum_i \left(\frac{\partial f}{\partial x_i} \sigma_i\right)^2

and to second order the mean is shifted by ½ Σ f″σ². First derivatives are exact where the analysis has them
(`linkwright.studies.slopes`), and otherwise extrapolated differences, as `Tolerance.exact` says; second ones
are central differences over a quarter of a standard deviation. The worst case is that of the machine at the
corners of the tolerances (`linkwright.studies.worst_case`). Sobol indices are those of
`linkwright.studies.indices`.

References
----------
.. [1] JCGM 100:2008, *Guide to the expression of uncertainty in measurement*, section 5.1.
.. [2] Clopper, Pearson, *The use of confidence or fiducial limits*, Biometrika 26 (1934) 404.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated, Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import FindingError, InputError
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.studies import sampling
from linkwright.studies.engine import evaluate
from linkwright.studies.indices import NONE, Interval, intervals, sobol_indices, values
from linkwright.studies.plan import StudyPlan, with_tolerances
from linkwright.studies.rows import SOLVED, FastStarts, OneByOne, Rows
from linkwright.studies.slopes import slopes
from linkwright.studies.worst_case import WorstCase, worst_case

# Share of a standard deviation to both sides over which derivatives are taken: large against the accuracy of
# responses, and its square over six is the relative error where the third derivative counts as much as the
# first over one deviation.
_STEP = 0.25

# By how much the deviation at random may differ from that to first order, as a share. The deviation of n
# machines scatters by 1/√(2n) if they are normal, and by more with longer tails: 4/√n is beyond chance.
_BENT, _SCATTER = 0.1, 4.0

# A deviation that is a smaller share of the response may be rounding.
_ROUNDING = 1e-8

# Shares below which 99.73 % of a normal distribution lie between three deviations.
_BAND = (0.00135, 0.99865)


@dataclass(frozen=True)
class Tolerance(Result):
    """How responses scatter; every table has an entry a response."""

    n_rows: Annotated[int, Label("machines drawn at random", "", "")]
    n_failed: Annotated[int, Label("machines without a result", "", "", "They count as outside the limits.")]
    reasons: Annotated[dict[str, int], About("Reasons for machines without a result → number of machines.")]
    variables: Annotated[
        dict[str, dict[str, float]],
        About("Variable → mean, standard deviation and limits as they are computed with [SI]."),
    ]
    responses: Annotated[
        dict[str, dict[str, float]],
        About(
            "Response → value at the middle, mean, deviation and 99.73 % band by Monte Carlo, deviation to "
            "first order, worst case of the machine itself, shift of the mean to second order, in SI."
        ),
    ]
    beyond_corners: Annotated[
        dict[str, str],
        About("Responses whose worst case may be wider than the one given, each with the reason."),
    ]
    contributions: Annotated[
        dict[str, dict[str, float]], About("Response → variable → share of the variance to first order.")
    ]
    slopes: Annotated[dict[str, dict[str, float]], About("Response → variable → derivative [SI].")]
    exact: Annotated[
        tuple[str, ...],
        About("Responses whose derivatives are exact; the others have extrapolated differences."),
    ]
    ties: Annotated[
        dict[str, str], About("Responses that have only one-sided derivatives, each with the reason.")
    ]
    indices: Annotated[
        dict[str, dict[str, tuple[float, float]]],
        About("Response → variable → first and total Sobol index; empty if not asked for."),
    ]
    failure_indices: Annotated[
        dict[str, tuple[float, float]],
        About(
            "Variable → first and total Sobol index of whether a machine has no result; empty if all have."
        ),
    ]
    index_intervals: Annotated[
        dict[str, dict[str, Interval]],
        About(
            "Response → variable → lower and upper end of the confidence intervals of both indices, to first "
            "order in 1/√blocks; a part may lie outside of 0 to 1."
        ),
    ]
    failure_index_intervals: Annotated[
        dict[str, Interval], About("Variable → the same of the indices of failures.")
    ]
    n_dropped: Annotated[
        int, Label("blocks dropped from the Sobol indices", "", "", "Some row of each failed.")
    ]
    share_within: Annotated[
        float | None, Label("yield", "", "", "Share within all limits; None without any.")
    ]
    share_low: Annotated[float | None, Label("lower end of the yield", "", "", "Of its interval.")]
    share_high: Annotated[float | None, Label("upper end of the yield", "", "", "Of its interval.")]
    level: Annotated[float, Label("probability that the interval holds the truth", "", "")]
    fast_starts: FastStarts
    one_by_one: OneByOne = field(default_factory=dict)

    @property
    def bent(self) -> tuple[str, ...]:
        """Responses whose scatter is not that to first order."""
        return tuple(
            name for name, row in self.responses.items() if _is_bent(row, self.n_rows - self.n_failed)
        )

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Numbers and tables by name, ready for JSON; `curves` is without effect."""
        names = (
            "reasons",
            "variables",
            "responses",
            "contributions",
            "slopes",
            "indices",
            "index_intervals",
            "failure_indices",
            "failure_index_intervals",
            "ties",
            "beyond_corners",
            "fast_starts",
            "one_by_one",
        )
        return {**super().to_dict(), **{name: getattr(self, name) for name in names}}


@public
def tolerance(
    plan: StudyPlan, rows: int = 10_000, *, seed: int = 0, level: float = 0.95, indices: int = 0
) -> Tolerance:
    """Scatter of the responses of a study, and the yield within its constraints.

    Parameters
    ----------
    plan : StudyPlan
        A study whose variables have tolerances or distributions; a range counts as uniform. Entries of the
        machine with a tolerance are variables as well, unless the study sets them.
    rows : int
        Machines drawn at random, 2 to 10⁷.
    seed : int
        Seed of the random generator.
    level : float
        Probability that the interval of the yield, or of a Sobol index, holds the truth.
    indices : int
        Blocks for Sobol indices, each of as many machines as variables and two; 0 for none.

    Returns
    -------
    Tolerance
        Bands, contributions, yield.

    Raises
    ------
    InputError
        A variable is a list; a number is out of range.
    FindingError
        The machine in the middle of all tolerances, or a neighbour of it, has no answer.
    """
    plan = with_tolerances(plan)
    _check(plan, rows, indices)
    scatters = _Scatters(plan)
    middle, bends = _bends(plan, scatters)
    place = slopes(plan, scatters.means, _STEP * scatters.deviations)
    drawn = evaluate(plan, plan.values(sampling.random(len(plan.axes), seed, 0, rows)))
    solved = drawn.status == SOLVED
    if solved.sum() < 2:
        ((reason, _),) = drawn.failures().most_common(1)
        raise FindingError(f"only {int(solved.sum())} of {rows} machines have a result; most often: {reason}")
    columns = {name: drawn.columns[name][solved] for name in plan.responses}
    worst = worst_case(plan, scatters.means, place.slopes, middle, columns)
    sobol = sobol_indices(plan, seed, indices, level) if indices else NONE
    names, deviations = scatters.names, scatters.deviations
    return Tolerance(
        n_rows=rows,
        n_failed=int((~solved).sum()),
        reasons=dict(drawn.failures().most_common()),
        variables=scatters.to_dict(),
        responses={
            name: _row(scatters, columns[name], middle[name], place.slopes[name], bends[name], worst[name])
            for name in plan.responses
        },
        contributions={name: _shares(names, place.slopes[name] * deviations) for name in plan.responses},
        slopes={
            name: dict(zip(names, map(float, place.slopes[name]), strict=True)) for name in plan.responses
        },
        exact=tuple(name for name in plan.responses if name in place.exact),
        ties=place.ties,
        beyond_corners={name: case.doubt for name, case in worst.items() if case.doubt},
        indices={name: values(of) for name, of in sobol.responses.items()},
        failure_indices=values(sobol.failures),
        index_intervals={name: intervals(of) for name, of in sobol.responses.items()},
        failure_index_intervals=intervals(sobol.failures),
        n_dropped=sobol.n_dropped,
        **yield_of(plan, drawn, level),
        level=level,
        fast_starts=drawn.not_settling(),
        one_by_one=dict((drawn.one_by_one + sobol.one_by_one).most_common()),
    )


def _check(plan: StudyPlan, rows: int, indices: int) -> None:
    if not 2 <= rows <= 10_000_000 or not 0 <= indices <= 1_000_000:
        raise InputError(
            f"rows {rows}, indices {indices}: expected 2 to 10 000 000 rows, to 1 000 000 blocks"
        )
    for axis in plan.axes:
        if axis.choices or axis.is_open:
            what = "a list" if axis.choices else "nothing"
            raise InputError(
                f"variables.{axis.name}: found {what}, expected a tolerance, a distribution or a range"
            )
    for asked in plan.asked:
        if asked.otherwise is not None and not np.isfinite(asked.otherwise):
            raise InputError(
                f"responses.{asked.name}.otherwise: found {asked.otherwise:g}, expected a finite number: a "
                "scatter has its mean"
            )


class _Scatters:
    """Means, standard deviations and limits of the variables [SI], (variables,) each.

    Where a variable has no ends, they are infinite.
    """

    def __init__(self, plan: StudyPlan) -> None:
        self.names = [axis.name for axis in plan.axes]
        self.means, self.deviations = np.array([axis.moments() for axis in plan.axes]).T
        self.low, self.high = np.array([(axis.low, axis.high) for axis in plan.axes]).T

    def to_dict(self) -> dict[str, dict[str, float]]:
        table = np.stack([self.means, self.deviations, self.low, self.high], axis=1).tolist()
        keys = ("mean", "deviation", "low", "high")
        return {name: dict(zip(keys, row, strict=True)) for name, row in zip(self.names, table, strict=True)}


def _bends(plan: StudyPlan, scatters: _Scatters) -> tuple[dict[str, float], dict[str, Floats]]:
    """Value in the middle, and second derivatives by each variable, of each response."""
    middles, steps = scatters.means, _STEP * scatters.deviations
    n = len(middles)
    points = np.vstack([middles, middles + np.diag(steps), middles - np.diag(steps)])
    rows = evaluate(plan, {axis.name: points[:, i].copy() for i, axis in enumerate(plan.axes)})
    rows.require_solved(
        lambda row: (
            f"beside it in {plan.axes[(row - 1) % n].name}" if row else "in the middle of the tolerances"
        )
    )
    values = {name: rows.columns[name] for name in plan.responses}
    second = {name: (f[1 : n + 1] - 2 * f[0] + f[n + 1 :]) / steps**2 for name, f in values.items()}
    return {name: float(f[0]) for name, f in values.items()}, second


def _row(
    scatters: _Scatters, drawn: Floats, middle: float, slopes: Floats, bends: Floats, worst: WorstCase
) -> dict[str, float]:
    low, high = np.quantile(drawn, _BAND)
    return {
        "middle": middle,
        "mean": float(drawn.mean()),
        "deviation": float(drawn.std(ddof=1)),
        "band_low": float(low),
        "band_high": float(high),
        "deviation_first_order": float(np.sqrt(((slopes * scatters.deviations) ** 2).sum())),
        "mean_shift_second_order": float(0.5 * (bends * scatters.deviations**2).sum()),
        "worst_low": worst.low,
        "worst_high": worst.high,
    }


def _shares(names: list[str], parts: Floats) -> dict[str, float]:
    squares = parts**2
    total = squares.sum()
    shares = squares / total if total > 0 else squares
    return {names[i]: float(shares[i]) for i in np.argsort(-shares)}


def yield_of(plan: StudyPlan, drawn: Rows, level: float) -> dict[str, float | None]:
    """Share of machines within all limits, with its interval after Clopper and Pearson."""
    if not plan.limits:
        return {"share_within": None, "share_low": None, "share_high": None}
    from scipy.special import betaincinv

    within = drawn.status == SOLVED
    for name, (low, high) in plan.limits.items():
        with np.errstate(invalid="ignore"):
            within &= (drawn.columns[name] >= low) & (drawn.columns[name] <= high)
    n, k, tail = len(within), int(within.sum()), 0.5 * (1 - level)
    return {
        "share_within": k / n,
        "share_low": float(betaincinv(k, n - k + 1, tail)) if k else 0.0,
        "share_high": float(betaincinv(k + 1, n - k, 1 - tail)) if k < n else 1.0,
    }


def _is_bent(row: Mapping[str, float], n: int) -> bool:
    """Whether random machines scatter otherwise than to first order."""
    first, drawn = row["deviation_first_order"], row["deviation"]
    if max(first, drawn) < _ROUNDING * abs(row["middle"]):
        return False
    return bool(abs(drawn - first) > (_BENT + _SCATTER / np.sqrt(n)) * max(first, drawn))
