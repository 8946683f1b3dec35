r"""Limits of a study: which of them a machine touches, and what these cost.

At the best machine the multipliers λ ≥ 0 of the active limits c are those of

.. math:: \min_\lambda \Bigl\| \nabla f + \sum \lambda_i \nabla c_i \Bigr\|

so that a limit which is wider by one unit makes the goal better by λ.
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

# A residual of the multipliers above this share of the goal's gradient: they explain nothing.
_EXPLAINED = 0.05


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
    """Whether a response is at its limit."""
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
    from scipy.optimize import nnls

    places = free(plan)
    if not places:
        return [], "no variable has derivatives"
    values, rates, slopes = log.slopes(plan, share)
    listed = list(_active(plan, slopes, values, rates))
    if goal in slopes.ties:
        return [], f"{goal} has a kink there: {slopes.ties[goal]}"
    if not listed:
        return [], ""
    down = -(sign * slopes.slopes[goal] * rates)[places]
    ways = np.array([limit.outward[places] for limit in listed]).T
    found_lambda, rest = nnls(ways, down)
    if rest > _EXPLAINED * np.linalg.norm(down):
        return [], "the machine is not yet at the very minimum; more evaluations get closer"
    return [
        Price(limit.what, limit.of, limit.limit, limit.is_upper, float(x / limit.unit))
        for limit, x in zip(listed, found_lambda, strict=True)
    ], ""


class _ActiveLimit(NamedTuple):
    """Words, response or variable, value [SI], outward slope by the shares, unit of an active limit."""

    what: str
    of: str
    limit: float
    is_upper: bool
    outward: Floats
    unit: float


def _active(plan: StudyPlan, slopes: Slopes, values: Floats, rates: Floats) -> Iterator[_ActiveLimit]:
    """Active limits of responses and of ranges."""
    for name, limit, way in limits(plan):
        if _is_at(limit, slopes.values[name]):
            word = "maximum" if way > 0 else "minimum"
            outward = way * slopes.slopes[name] * rates
            yield _ActiveLimit(f"{word} of {name}", name, limit, way > 0, outward, 1.0)
    for i, axis in enumerate(plan.axes):
        if not axis.is_continuous:
            continue
        for limit, way, word in ((axis.low, -1.0, "lower"), (axis.high, 1.0, "upper")):
            if abs(values[i] - limit) <= _ACTIVE * (axis.high - axis.low):
                # A unit of the variable is 1/rate of its share.
                outward = way * np.eye(len(values))[i]
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
