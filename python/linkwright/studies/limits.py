r"""Limits of a study: which of them a machine touches, and what these cost.

At the best machine the multipliers λ ≥ 0 of the active limits c are those of

.. math:: \min_\lambda \Bigl\| \nabla f + \sum \lambda_i \nabla c_i \Bigr\|

so that a limit which is wider by one unit makes the goal better by λ. Where extremes tie, goal or limit has a
kink and a gradient on each side of it; a convex combination of them takes the place of ∇f, a multiple of one
that of λ ∇c (Clarke, Optimization and Nonsmooth Analysis, 1983, theorem 6.1.1).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.studies.plan import StudyPlan
from linkwright.studies.search_log import SearchLog
from linkwright.studies.slopes import Slopes

# A limit counts as active where a response is as near to it, relative to its size.
_ACTIVE = 1e-4

# Residuals of the multipliers as shares of the goal's gradient: above the first there may be a kink, above
# the second they explain nothing.
_SMOOTH, _EXPLAINED = 1e-3, 1e-2

# So far to both sides the slopes on a kink are taken, as a share of a range: best machines lie on kinks to
# 1e-10, and over this distance slopes of one side hardly change.
_SIDE = 1e-6

# Random directions besides, for each variable: branches that meet in a point may lie between the axes.
_ROUND = 4

# Weight of the condition that the goal's sides add up to one, over the size of its slopes.
_TOGETHER = 1e3


def limits(plan: StudyPlan) -> list[tuple[str, float, float]]:
    """Finite limits: response, value [SI], 1 of a maximum and −1 of a minimum."""
    return [
        (name, limit, way)
        for name, (low, high) in plan.limits.items()
        for limit, way in ((low, -1.0), (high, 1.0))
        if np.isfinite(limit)
    ]


def free(plan: StudyPlan) -> list[int]:
    """Places of the variables that have derivatives."""
    return [i for i, axis in enumerate(plan.axes) if axis.is_continuous]


def touched(plan: StudyPlan, responses: dict[str, float], shares: Floats) -> tuple[str, ...]:
    """Limits and ends of ranges that a machine touches, in words."""
    words = []
    for name, limit, way in limits(plan):
        if _is_at(limit, responses[name]):
            word = "maximum" if way > 0 else "minimum"
            words.append(f"{name} is at its {word}, {limit:.6g} {plan.units[name]}".rstrip())
    for axis, share in zip(plan.axes, shares, strict=True):
        if not axis.choices and min(share, 1.0 - share) <= _ACTIVE:
            word, value = ("lower", axis.low) if share < 0.5 else ("upper", axis.high)
            words.append(f"{axis.name} is at the {word} end of its range, {value:.6g} {axis.unit}".rstrip())
    return tuple(words)


def _is_at(limit: float, value: float) -> bool:
    return abs(value - limit) <= _ACTIVE * max(abs(limit), abs(value))


@dataclass(frozen=True)
class Price:
    """What an active limit of a response or variable costs: `multiplier` [goal per unit of the limit, SI]."""

    what: str
    of: str
    limit: float
    is_upper: bool
    multiplier: float


def prices(plan: StudyPlan, goal: str, sign: float, share: Floats, log: SearchLog) -> tuple[list[Price], str]:
    """Multipliers of the active limits of a place, `share`: (variables,), or why there are none."""
    if not free(plan):
        return [], "no variable has derivatives"
    values, rates, slopes = log.slopes(plan, share)
    near = [slopes]
    listed = list(_active(plan, near, values, rates))
    if not listed:
        return [], f"{goal} is not differentiable there: {slopes.ties[goal]}" if goal in slopes.ties else ""
    tied = [name for name in (goal, *(limit.of for limit in listed)) if name in slopes.ties]
    multipliers = None if tied else _multipliers(plan, goal, sign * rates, near, listed, _SMOOTH)
    if multipliers is None:
        # Best machines stand on kinks, where extremes tie: each side of them has slopes of its own.
        near += [log.slopes(plan, beside)[2] for beside in _beside(share, free(plan))]
        listed = list(_active(plan, near, values, rates))
        multipliers = _multipliers(plan, goal, sign * rates, near, listed, _EXPLAINED)
    if multipliers is None:
        if tied:
            return [], f"{tied[0]} is not differentiable there: {slopes.ties[tied[0]]}"
        return [], "the machine is not yet at the very minimum; more evaluations get closer"
    return [
        Price(limit.what, limit.of, limit.limit, limit.is_upper, float(x / limit.unit))
        for limit, x in zip(listed, multipliers, strict=True)
    ], ""


def _beside(share: Floats, places: list[int]) -> Iterator[Floats]:
    """Neighbours within the ranges: both ways along each variable and in random directions."""
    n = len(places)
    random = np.random.default_rng(0).standard_normal((_ROUND * n if n > 1 else 0, n))
    ways = np.concatenate([np.eye(n), random / np.abs(random).max(axis=1, keepdims=True, initial=1e-300)])
    for way in (*ways, *-ways):
        beside = share.copy()
        beside[places] += _SIDE * way
        if beside.min() >= 0.0 and beside.max() <= 1.0:
            yield beside


class _ActiveLimit(NamedTuple):
    """Words, response or variable, value [SI], outward slopes by the shares, unit of an active limit."""

    what: str
    of: str
    limit: float
    is_upper: bool
    outward: list[Floats]
    unit: float


def _multipliers(
    plan: StudyPlan,
    goal: str,
    rates: Floats,
    near: list[Slopes],
    listed: list[_ActiveLimit],
    within: float,
) -> Floats | None:
    """Multipliers of active limits that explain why a place is the best; None if they do not."""
    from scipy.optimize import linprog, nnls

    # Of a kink each side has its weight: weights of the goal's sides add up to one, those of a limit's to its
    # multiplier.
    places = free(plan)
    goals = np.array([slopes.slopes[goal] * rates for slopes in near])[:, places]
    size = float(np.linalg.norm(goals, axis=1).max()) or 1.0
    ways = np.array([way[places] for limit in listed for way in limit.outward])
    of = np.repeat(np.arange(len(listed)), [len(limit.outward) for limit in listed])
    columns = np.concatenate([goals, ways]).T / size
    together = np.concatenate([np.ones(len(goals)), np.zeros(len(ways))])
    weights, _ = nnls(np.vstack([columns, _TOGETHER * together]), np.append(0.0 * columns[:, 0], _TOGETHER))
    rest = float(np.linalg.norm(columns @ weights))
    if rest > within:
        return None
    # Where active limits depend on each other, the multipliers of one have a range: its minimum is what one
    # wider limit gains while the others stay.
    slack = np.abs(columns @ weights).max() * (1 + 1e-6) + 1e-9
    multipliers = np.zeros(len(listed))
    for nth in range(len(listed)):
        least = linprog(
            np.append(0.0 * goals[:, 0], of == nth),
            A_ub=np.vstack([columns, -columns]),
            b_ub=np.full(2 * len(columns), slack),
            A_eq=together[None],
            b_eq=[1.0],
        )
        multipliers[nth] = least.fun if least.success else np.bincount(of, weights[len(goals) :])[nth]
    return multipliers


def _active(plan: StudyPlan, near: list[Slopes], values: Floats, rates: Floats) -> Iterator[_ActiveLimit]:
    """Active limits of responses and of ranges, with their slopes at a place and near it."""
    for name, limit, way in limits(plan):
        if _is_at(limit, near[0].values[name]):
            word = "maximum" if way > 0 else "minimum"
            outward = [way * slopes.slopes[name] * rates for slopes in near]
            yield _ActiveLimit(f"{word} of {name}", name, limit, way > 0, outward, 1.0)
    for i, axis in enumerate(plan.axes):
        if not axis.is_continuous:
            continue
        for limit, way, word in ((axis.low, -1.0, "lower"), (axis.high, 1.0, "upper")):
            if abs(values[i] - limit) <= _ACTIVE * (axis.high - axis.low):
                # A unit of the variable is 1/rate of its share.
                outward = [way * np.eye(len(values))[i]]
                yield _ActiveLimit(
                    f"{word} end of {axis.name}", axis.name, limit, way > 0, outward, abs(rates[i])
                )


def in_words(plan: StudyPlan, goal: str, sign: float, price: Price) -> str:
    """What one hundredth of a limit is worth."""
    unit, own = plan.units[goal], plan.units[price.of]
    wider = 0.01 * (abs(price.limit) or 1.0)
    way = "more" if price.is_upper else "less"
    better = "smaller" if sign > 0 else "larger"
    gain = f"{price.multiplier * wider:.4g} {unit}".rstrip()
    return f"{wider:.4g} {own} {way} at the {price.what} would make {goal} {gain} {better}".replace("  ", " ")
