"""Down to the nearest best machine by exact derivatives.

Sequential quadratic programming (SLSQP of SciPy [1]_) goes down where goal and limits are smooth. Extremes
of a motion are not where two of them tie, and best machines often stand there; so cutting planes [2]_
follow: the goal is taken as the largest of its tangents at the places nearby, a linear programme finds the
lowest point of these within a radius, and the radius is halved where that is no better. Where two branches
cross, they meet as Newton's method does. In a smooth valley they creep; SLSQP goes on from there.

References
----------
.. [1] Kraft, A software package for sequential quadratic programming, DFVLR-FB 88-28, 1988.
.. [2] Kelley, The cutting-plane method for solving convex programs, J. SIAM 8 (1960) 703; with a trust
   region, Nocedal and Wright, Numerical Optimization, 2nd ed. 2006, chapter 18.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import FindingError
from linkwright.studies.limits import free, limits
from linkwright.studies.plan import StudyPlan
from linkwright.studies.search_log import SearchLog
from linkwright.studies.slopes import n_beside

# Limits are kept by this share of their size: batches, which judge in the end, are computed to 1e-9.
_MARGIN = 3e-9

# Cost of passing a limit by its own size, over the size of the goal: more than any multiplier that is met.
_PENALTY = 1e3

# First radius of the cutting planes and the last, as shares of the ranges, and how many tangents are kept.
_FIRST, _LAST, _KEPT = 0.02, 1e-10, 30

# Cutting planes that gain less than this share in so many steps creep along a smooth valley, where SLSQP is
# faster once the limits are kept; so often at most.
_PATIENCE, _CREEPS, _ROUNDS = 60, 0.01, 6

# Shares this near an end of their range are at that end: what is gained between is rounding of the goal.
_END = 1e-9

# A promised gain below this share of the goal ends the search: results are computed to 1e-11.
_GAIN = 1e-11


@dataclass(frozen=True)
class _Place:
    """Goal, to be made small, and limits, to be kept below zero, with slopes by the shares."""

    share: Floats
    goal: float
    goal_slope: Floats
    over: Floats  # (limits,) by how much each is passed, over its size
    over_slope: Floats  # (limits, variables)

    @property
    def merit(self) -> float:
        return self.goal + _PENALTY * float(np.maximum(self.over, 0.0).sum())


class _SpentError(Exception):
    """As many machines are computed as may be."""


class Descent:
    """The way down from starts of a study whose variables are numbers.

    `most`: machines a log may count; `watch`: called after each machine.
    """

    def __init__(
        self,
        plan: StudyPlan,
        goal: str,
        sign: float,
        log: SearchLog,
        most: float = math.inf,
        watch: Callable[[], None] = lambda: None,
    ) -> None:
        self.plan, self.goal, self.sign, self.log, self.most, self.watch = plan, goal, sign, log, most, watch
        self.free = free(plan)
        # Why machines on the way had no answer.
        self.reasons: Counter[str] = Counter()
        self.size = 1.0
        self._known: dict[bytes, _Place] = {}

    def run(self, start: Floats) -> Floats:
        """The best place from a start, as shares, (variables,); `FindingError` if the start has no answer."""
        self.base = end = start.copy()
        try:
            first = self.at(start[self.free])
        except _SpentError:
            return end
        size = max(abs(first.goal), 1e-300)
        scaled = replace(first, goal=first.goal / size, goal_slope=first.goal_slope / size)
        self.size, self._known = size, {first.share.tobytes(): scaled}
        share = start[self.free]
        for _ in range(_ROUNDS):
            best, is_slow = self._planes(self._slsqp(share))
            end[self.free] = share = best.share
            if not is_slow:
                break
        return end

    def at(self, share: Floats) -> _Place:
        """Goal and limits at a place, its free shares given."""
        share = np.where(share < _END, 0.0, np.where(share > 1.0 - _END, 1.0, share))
        key = share.tobytes()
        if key not in self._known:
            # It is not known beforehand whether derivatives are exact.
            if self.log.count + 1 + n_beside(self.plan) > self.most:
                raise _SpentError
            self._known[key] = self._computed(share)
        return self._known[key]

    def _computed(self, share: Floats) -> _Place:
        shares = self.base.copy()
        shares[self.free] = share
        _, rates, slopes = self.log.slopes(self.plan, shares)
        self.watch()
        slope = {name: (slope * rates)[self.free] for name, slope in slopes.slopes.items()}
        over, over_slope = [], []
        for name, limit, way in limits(self.plan):
            size = abs(limit) or 1.0
            over.append(way * (slopes.values[name] - limit) / size + _MARGIN)
            over_slope.append(way * slope[name] / size)
        n = len(self.free)
        return _Place(
            share,
            self.sign * slopes.values[self.goal] / self.size,
            self.sign * slope[self.goal] / self.size,
            np.array(over),
            np.array(over_slope).reshape(len(over), n),
        )

    def _slsqp(self, start: Floats) -> _Place:
        """Best place on the path of SLSQP."""
        from scipy.optimize import minimize

        kept = {
            "type": "ineq",
            "fun": lambda share: -self.at(share).over,
            "jac": lambda share: -self.at(share).over_slope,
        }
        given: Any = {
            "fun": lambda share: self.at(share).goal,
            "x0": start,
            "jac": lambda share: self.at(share).goal_slope,
            "bounds": [(0.0, 1.0)] * len(start),
            "constraints": [kept] if limits(self.plan) else [],
            "method": "SLSQP",
            "options": {"maxiter": 60, "ftol": 1e-14},
        }
        try:
            minimize(**given)
        except FindingError as error:
            # What was found before it stands.
            self.reasons[str(error)] += 1
        except _SpentError:
            pass
        return self._least()

    def _least(self) -> _Place:
        return min(self._known.values(), key=lambda point: point.merit)

    def _planes(self, best: _Place) -> tuple[_Place, bool]:
        """Best place by cutting planes about one, and whether they merely creep on from there."""
        near, radius, merits = [best], _FIRST, [best.merit]
        while radius > _LAST:
            trial, gain = self._lowest(near, best, radius)
            if gain < _GAIN:
                return best, False
            if len(merits) > _PATIENCE and merits[-_PATIENCE] - best.merit < _CREEPS * abs(best.merit):
                return best, True
            moved = float(np.abs(trial - best.share).max())
            try:
                there = self.at(trial)
            except FindingError as error:
                self.reasons[str(error)] += 1
                radius /= 4
                continue
            except _SpentError:
                return best, False
            near = [*near, there][-_KEPT:]
            if there.merit < best.merit:
                best = there
                radius = min(radius, 4 * moved)
            else:
                radius = min(radius, moved) / 2
            merits.append(best.merit)
        return best, False

    def _lowest(self, near: list[_Place], best: _Place, radius: float) -> tuple[Floats, float]:
        """Lowest point of the tangents nearby, within a radius of the best, and by how much it is lower."""
        from scipy.optimize import linprog

        n, m = len(best.share), len(best.over)
        reach = 4 * radius
        rows, ends = [], []
        for limit in near:
            away = best.share - limit.share
            if np.abs(away).max() > reach:
                continue
            # A tangent that passes above the best place, as on a hump, is lowered to it.
            height = min(float(limit.goal + limit.goal_slope @ away), best.goal)
            rows.append(np.concatenate([limit.goal_slope, [-1.0], np.zeros(m)]))
            ends.append(best.goal - height)
            for k in range(m):
                level = min(float(limit.over[k] + limit.over_slope[k] @ away), max(float(best.over[k]), 0.0))
                rows.append(np.concatenate([limit.over_slope[k], [0.0], -np.eye(m)[k]]))
                ends.append(-level)
        # Unknowns in radii, so that the smallest are no rounding: steps, the goal's change, passing of the
        # limits.
        box = [(max(-1.0, -share / radius), min(1.0, (1.0 - share) / radius)) for share in best.share]
        cost = np.concatenate([np.zeros(n), [1.0], np.full(m, _PENALTY)])
        solution = linprog(
            cost,
            A_ub=np.array(rows),
            b_ub=np.array(ends) / radius,
            bounds=[*box, (None, None), *[(0.0, None)] * m],
        )
        if not solution.success or solution.x is None:
            return best.share, 0.0
        passed = _PENALTY * (np.maximum(best.over, 0.0).sum() - radius * solution.x[n + 1 :].sum())
        return np.clip(best.share + radius * solution.x[:n], 0.0, 1.0), float(passed - radius * solution.x[n])
