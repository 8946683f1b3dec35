r"""The cheapest tolerances for a wanted yield.

A tolerance that is f times as wide as it stands in the study costs :math:`c f^{-k}`, reciprocal for k = 1
[1]_, [2]_. To first order the limits of response j, at the distance m from its middle, are kept by z
deviations if

.. math:: \sum_i \Bigl(\frac{z\, s_{ji}\, \sigma_i f_i}{m_j}\Bigr)^2 \le 1

with derivatives s and standard deviations σ. Their minimum cost is a convex problem
(`linkwright.studies.least_cost`). z is then chosen by Monte Carlo on the machine itself, with the same random
numbers each time, so that the yield is what was wanted.

References
----------
.. [1] Chase, Greenwood, Design issues in mechanical tolerance analysis, Manufacturing Review 1 (1988) 50.
.. [2] Spotts, Allocation of tolerances to minimize cost of assembly, J. Eng. Ind. 95 (1973) 762: k = 2.
"""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass, field, replace
from typing import Annotated, Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import FindingError, InputError
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.machine.address import get
from linkwright.studies import sampling
from linkwright.studies.axes import Axis
from linkwright.studies.engine import evaluate
from linkwright.studies.least_cost import LeastCost
from linkwright.studies.limits import limits
from linkwright.studies.plan import StudyPlan, with_tolerances
from linkwright.studies.rows import FastStarts, OneByOne
from linkwright.studies.slopes import slopes
from linkwright.studies.tolerance import yield_of

# A tolerance is made wider or narrower by this factor at most.
_FACTOR = 100.0

# Deviations to the nearest limit that are tried, and halvings of that range: to 1e-3 of a deviation.
_FEWEST, _MOST, _HALVINGS = 0.05, 8.0, 13

# Machines drawn at random, at most.
_ROWS_MOST = 10_000_000

# Steps of differences as a share of a standard deviation.
_STEP = 1e-2


@dataclass(frozen=True)
class Allocation(Result):
    """Tolerances of minimum cost that give a yield."""

    tolerances: Annotated[
        dict[str, tuple[float, float]], About("Variable → limits about the value of the machine [SI].")
    ]
    factors: Annotated[dict[str, float], About("Variable → how many times as wide as in the study.")]
    cost: Annotated[float, Label("cost of the tolerances", "", "")]
    cost_before: Annotated[float, Label("cost of the tolerances of the study", "", "")]
    share_within: Annotated[float, Label("yield", "", "")]
    share_low: Annotated[float, Label("lower end of the interval of the yield", "", "")]
    share_high: Annotated[float, Label("upper end of the interval of the yield", "", "")]
    share_before: Annotated[float, Label("yield of the tolerances of the study", "", "")]
    active: Annotated[tuple[str, ...], About("Limits that hold the tolerances down.")]
    n_rows: Annotated[int, Label("machines drawn for each yield", "", "")]
    fast_starts: FastStarts
    one_by_one: OneByOne = field(default_factory=dict)

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Numbers and tables by name, ready for JSON; `curves` is without effect."""
        names = ("tolerances", "factors", "fast_starts", "one_by_one")
        return {**super().to_dict(), **{name: dict(getattr(self, name)) for name in names}}


@public
def allocate(
    plan: StudyPlan, wanted: float, *, power: float = 1.0, rows: int = 10_000, seed: int = 0
) -> Allocation:
    """Find the cheapest tolerances for a required yield.

    Parameters
    ----------
    plan : StudyPlan
        A study with constraints; variables with a ``tolerance`` and a ``cost`` are allocated, others stay.
    wanted : float
        Share of machines within all limits, at least one machine of the rows within and one beyond them.
    power : float
        k of the cost :math:`c f^{-k}`, 0.1 to 10.
    rows : int
        Machines drawn at random, 100 to 10⁷.
    seed : int
        Seed of the random generator.

    Returns
    -------
    Allocation
        Tolerances, their cost and their yield.

    Raises
    ------
    InputError
        There are no limits, no costs, or a number is out of range.
    FindingError
        The machine in the middle of the tolerances does not keep the limits, or no tolerances give the yield.
    """
    plan = with_tolerances(plan)
    _check(wanted, power, rows)
    problem = _Problem(plan, power)
    yields = _Yields(plan, sampling.random(len(plan.axes), seed, 0, rows))
    high = _deviations(problem, yields, wanted)
    factors = problem.factors(high)
    after, before = yields.at(factors), yields.at(np.ones(len(factors)))
    names = [axis.name for axis in plan.axes]
    widened = dict(zip(names, map(_widened, plan.axes, factors), strict=True))
    return Allocation(
        tolerances={name: _about(plan, widened[name]) for name in problem.names},
        factors={name: float(factors[names.index(name)]) for name in problem.names},
        cost=problem.cost(factors),
        cost_before=problem.cost(np.ones(len(factors))),
        share_within=after["share_within"],
        share_low=after["share_low"],
        share_high=after["share_high"],
        share_before=before["share_within"],
        active=problem.active(factors, high),
        n_rows=rows,
        fast_starts=after["fast_starts"],
        one_by_one=dict(yields.alone.most_common()),
    )


def _check(wanted: float, power: float, rows: int) -> None:
    if not 0 < wanted < 1:
        raise InputError(f"wanted {wanted}: expected a number between 0 and 1, such as 0.99")
    if not 0.1 <= power <= 10:
        raise InputError(f"power {power}: expected 0.1 to 10")
    if not 100 <= rows <= _ROWS_MOST:
        raise InputError(f"rows {rows}: expected 100 to 10 000 000 rows")
    # One machine of the rows, with room for rounding.
    finest = (1 - 1e-9) / rows
    if not finest <= wanted <= 1 - finest:
        many = math.ceil(min((1 - 1e-9) / min(wanted, 1 - wanted), 1e300))
        remedy = f"; give at least {many} rows" if many <= _ROWS_MOST else ""
        expected = f"{1 / rows:g} to {1 - 1 / rows:.10g}, the shares that {rows} rows tell"
        raise InputError(f"wanted {wanted:.15g}: expected {expected}{remedy}")


class _Yields:
    """Yields with tolerances widened by factors, with the same random numbers each time."""

    def __init__(self, plan: StudyPlan, shares: Floats) -> None:
        self.plan, self.shares = plan, shares
        self.alone: Counter[str] = Counter()  # why rows were computed one by one

    def at(self, factors: Floats) -> dict[str, Any]:
        """Yield with its interval, and what becomes of fast starts."""
        wider = replace(self.plan, axes=tuple(map(_widened, self.plan.axes, factors)))
        drawn = evaluate(self.plan, wider.values(self.shares))
        self.alone.update(drawn.one_by_one)
        return yield_of(self.plan, drawn, 0.95) | {"fast_starts": drawn.not_settling()}


def _deviations(problem: _Problem, yields: _Yields, wanted: float) -> float:
    """Fewest deviations to the nearest limit with which the cheapest tolerances give a yield."""
    low, high = _FEWEST, _MOST
    if yields.at(problem.factors(high))["share_within"] < wanted:
        raise FindingError(
            f"no tolerances give a yield of {100 * wanted:g} %: variables without a cost scatter too much, "
            "or the middle is too near to a limit; give them a cost, or move the machine"
        )
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        is_enough = yields.at(problem.factors(middle))["share_within"] >= wanted
        low, high = (low, middle) if is_enough else (middle, high)
    return high


class _Problem:
    """Cost and limits as sums of powers of the factors of all variables."""

    def __init__(self, plan: StudyPlan, power: float) -> None:
        costs = [plan.study.variables[axis.name].cost for axis in plan.axes]
        self.costs, self.power = np.array([cost or 0.0 for cost in costs]), power
        self.free = np.flatnonzero(self.costs > 0)
        self.names = [plan.axes[i].name for i in self.free]
        if not len(self.free) or not plan.limits:
            lacks = "constraints" if not plan.limits else "variables with a `cost` beside their tolerance"
            raise InputError(f"allocation: found no {lacks}")
        listed = [axis.name for axis in plan.axes if axis.distribution is None]
        if listed:
            raise InputError(f"variables.{listed[0]}: found no tolerance, expected one, or a distribution")
        middles, spread = np.array([axis.moments() for axis in plan.axes]).T
        place = slopes(plan, middles, _STEP * spread)
        self.words, rows = [], []
        for name, limit, way in limits(plan):
            margin = way * (limit - place.values[name])
            if margin <= 0:
                found = f"{name} is {place.values[name]:.6g} in the middle of the tolerances"
                raise FindingError(f"{found}, beyond its limit {limit:.6g}")
            self.words.append(f"{'maximum' if way > 0 else 'minimum'} of {name}")
            rows.append((place.slopes[name] * spread / margin) ** 2)
        self.table = np.array(rows)

    def cost(self, factors: Floats) -> float:
        return float(self.costs @ factors**-self.power)

    def factors(self, z: float) -> Floats:
        """Cheapest factors that keep all limits by z deviations, else the narrowest, (variables,)."""
        factors = np.ones(len(self.costs))
        own, fixed = self.table[:, self.free], np.delete(self.table, self.free, axis=1).sum(axis=1)
        room = z**-2.0 - fixed
        if (room <= own.sum(axis=1) / _FACTOR**2).any():
            factors[self.free] = 1 / _FACTOR
        else:
            factors[self.free] = LeastCost(self.costs[self.free], own, room, self.power, _FACTOR).factors()
        return factors

    def active(self, factors: Floats, z: float) -> tuple[str, ...]:
        use = z**2 * self.table @ factors**2
        return tuple(word for word, share in zip(self.words, use, strict=True) if share > 0.999)


def _widened(axis: Axis, factor: float) -> Axis:
    """A variable whose tolerance is wider by a factor, about its middle."""
    if factor == 1 or axis.distribution is None:
        return axis
    kind, mean, deviation = axis.distribution
    low, high = (mean + factor * (end - mean) for end in (axis.low, axis.high))
    return replace(axis, low=low, high=high, distribution=(kind, mean, factor * deviation))


def _about(plan: StudyPlan, axis: Axis) -> tuple[float, float]:
    value = float(get(plan.machine, axis.addresses[0]))
    return axis.low - value, axis.high - value
