"""Search for the best machine: whole populations of an evolution strategy through the batches of the core.

CMA-ES [1]_ with margin for whole numbers [2]_, by the package ``cmaes``, orders machines as Deb does [3]_:
one that keeps all limits before one that does not, those by the goal, these by how far they pass the limits,
machines without a result last. From the best of them, or from many starts instead, exact derivatives lead
further down (`linkwright.studies.local`).

References
----------
.. [1] Hansen, *The CMA evolution strategy: a tutorial*, arXiv 1604.00772.
.. [2] Hamano et al., *CMA-ES with margin*, GECCO 2022, 639.
.. [3] Deb, *An efficient constraint handling method for genetic algorithms*, Comput. Methods Appl. Mech. Eng.
   186 (2000) 311.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Mapping
from typing import Any, Literal

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import FindingError
from linkwright.studies import sampling
from linkwright.studies.axes import Axis
from linkwright.studies.chosen import choice, given_shares, numbers_alone
from linkwright.studies.engine import evaluate
from linkwright.studies.local import Descent
from linkwright.studies.plan import StudyPlan
from linkwright.studies.rows import SOLVED, Rows
from linkwright.studies.search_log import SearchLog

Method = Literal["both", "global", "gradient"]

# Places that are examined for each start from which derivatives lead down.
_LOOKED = 16

# Share of the machines that is for the derivatives.
_KEPT = 0.5

# First standard deviation of the search, as a share of each range: 0.3, as [1] advises in section B.5.
_SIGMA = 0.3


class Search:
    """The best machine so far, and what was computed on the way.

    Attributes
    ----------
    best : tuple or None
        How good the best machine is, as `_ranked` says, and its shares, (variables,).
    tried : list of dict
        Each combination of choices, as `Optimum.tried`.
    reasons : Counter
        Why machines had no answer.
    low, high : float
        Minimum and maximum of the goal [SI].
    one_by_one : Counter
        Why rows were computed outside of batches.
    """

    def __init__(
        self,
        plan: StudyPlan,
        goal: str,
        direction: str,
        watch: Callable[..., None] | None,
        log: SearchLog,
    ) -> None:
        self.plan, self.goal, self.watch, self.log = plan, goal, watch, log
        self.sign = 1.0 if direction == "minimise" else -1.0
        self.best: tuple[tuple[int, float], Floats] | None = None
        self.tried: list[dict[str, Any]] = []
        self.computed_before = log.count
        self.low, self.high = math.inf, -math.inf
        self.reasons: Counter[str] = Counter()
        self.one_by_one: Counter[str] = Counter()

    @property
    def count(self) -> int:
        """Machines that this search computed."""
        return self.log.count - self.computed_before

    def run(
        self, fixed: Mapping[str, float], evaluations: int, seed: int, method: Method, starts: int
    ) -> None:
        """One combination of choices."""
        free = [i for i, axis in enumerate(self.plan.axes) if not axis.choices]
        shares = np.array([fixed.get(axis.name, 0.5) for axis in self.plan.axes])
        before, self.best = self.best, None
        given = given_shares(self.plan, shares)
        if not free:
            self._ranked(shares[None])
        elif method == "gradient":
            self._descend([*self._sound(given), *self._started(shares, free, seed, starts)])
        else:
            last = self.log.count + evaluations
            self._sound(given)
            is_both = method == "both"
            self._evolve(shares, free, evaluations - int(_KEPT * evaluations) * is_both, seed)
            if is_both and self.best is not None and self.best[0][0] < 2:
                self._descend([self.best[1]], last)
        nearest = self.best
        own = (3, 0.0) if nearest is None else nearest[0]
        if before is not None and (self.best is None or before[0] <= own):
            self.best = before
        chosen = {axis.name: choice(axis, fixed[axis.name]) for axis in self.plan.axes if axis.choices}
        best = self.sign * own[1] if own[0] == 0 else None
        self.tried.append({**chosen, self.goal: best, "refused": self._against(nearest)})

    def _evolve(self, shares: Floats, free: list[int], most: int, seed: int) -> None:
        """Populations of the evolution strategy: the first one, and further ones up to so many machines."""
        from cmaes import CMAwM

        # The strategy takes two variables at least: one more, on which nothing depends.
        size = max(len(free), 2)
        steps = np.zeros(size)
        steps[: len(free)] = [_step(self.plan.axes[i]) for i in free]
        bounds = np.tile([0.0, 1.0], (size, 1))
        many = population(len(free))
        strategy = CMAwM(np.full(size, 0.5), _SIGMA, bounds, steps, seed=seed, population_size=many)
        used = 0
        while (not used or used + many <= most) and not strategy.should_stop():
            asked = [strategy.ask() for _ in range(many)]
            points = np.tile(shares, (len(asked), 1))
            points[:, free] = np.array([shares[0] for shares in asked])[:, : len(free)]
            keys = self._ranked(np.clip(points, 0.0, 1.0))
            order = {key: float(rank) for rank, key in enumerate(sorted(set(keys)))}
            strategy.tell([(shares[1], order[key]) for shares, key in zip(asked, keys, strict=True)])
            used += many

    def _sound(self, given: Floats | None) -> list[Floats]:
        """The machine of the study itself, if it is among those sought and has an answer."""
        return [given] if given is not None and self._ranked(given[None])[0][0] < 2 else []

    def _started(self, shares: Floats, free: list[int], seed: int, starts: int) -> list[Floats]:
        points = np.tile(shares, (starts * _LOOKED, 1))
        points[:, free] = sampling.sobol(len(free), seed, 0, len(points))
        keys = self._ranked(points)
        order = sorted(range(len(keys)), key=keys.__getitem__)
        return [points[i] for i in order[:starts] if keys[i][0] < 2]

    def _descend(self, starts: list[Floats], last: float = math.inf) -> None:
        """Descend by derivatives from each start until the log has `last` machines."""
        for start in starts:
            plan, kept = numbers_alone(self.plan, start)
            if not any(axis.is_continuous for axis in plan.axes):
                return
            # The end is ranked as one machine more.
            descent = Descent(plan, self.goal, self.sign, self.log, last - 1, self._watched)
            point, before = start.copy(), self.log.count
            try:
                point[kept] = descent.run(start[kept])
            except FindingError as error:
                # A machine beside the start has no answer: the start stands.
                self.reasons[str(error)] += 1
            self.reasons += descent.reasons
            if self.log.count > before:
                self._ranked(point[None])

    def _ranked(self, points: Floats) -> list[tuple[int, float]]:
        """Rank of machines, smaller is better: by limits kept, then by goal or violation."""
        rows = self.log.evaluate(self.plan, self.plan.values(points))
        self.reasons.update(rows.failures())
        self.one_by_one.update(rows.one_by_one)
        solved = rows.columns[self.goal][rows.status == SOLVED].tolist()
        self.low, self.high = min([self.low, *solved]), max([self.high, *solved])
        keys = [self._key(rows, i) for i in range(len(rows))]
        at = min(range(len(keys)), key=keys.__getitem__)
        if self.best is None or keys[at] < self.best[0]:
            self.best = (keys[at], points[at].copy())
        self._watched()
        return keys

    def _watched(self) -> None:
        """Call back with the number of machines and the best of those that were ranked."""
        if self.watch is not None and self.best is not None:
            (rank, value), best = self.best
            at_best = {name: float(column[0]) for name, column in self.plan.values(best[None]).items()}
            self.watch(self.count, self.sign * value if rank == 0 else None, at_best)

    def _key(self, rows: Rows, row: int) -> tuple[int, float]:
        if rows.status[row] != SOLVED:
            return 2, 0.0
        beyond = 0.0
        for name, (low, high) in self.plan.limits.items():
            value = rows.columns[name][row]
            for excess, limit in ((low - value, low), (value - high, high)):
                beyond += max(excess, 0.0) / (abs(limit) or 1.0)
        return (1, beyond) if beyond > 0 else (0, self.sign * float(rows.columns[self.goal][row]))

    def _against(self, best: tuple[tuple[int, float], Floats] | None) -> str | None:
        """Why no machine of a combination of choices is feasible; None if one is."""
        if best is None:
            return "no machine was computed"
        (rank, _), shares = best
        if rank == 0:
            return None
        rows = evaluate(self.plan, self.plan.values(shares[None]))
        if rank > 1:
            return rows.why(0)
        passed = []
        for name, (low, high) in self.plan.limits.items():
            number, unit = rows.columns[name][0], self.plan.units[name]
            if not low <= number <= high:
                limit, word = (low, "below") if number < low else (high, "above")
                passed.append(f"{name} {number:.4g} {unit}".rstrip() + f" {word} {limit:.4g}")
        return ", ".join(passed)


def population(n: int) -> int:
    """Machines of a population that varies n numbers, as [1] advises in table 1; it has two at least."""
    return 4 + math.floor(3 * math.log(max(n, 2)))


def _step(axis: Axis) -> float:
    """Step of whole numbers as a share of their range; 0 for real ones."""
    return 1.0 / (axis.high - axis.low) if axis.is_whole else 0.0
