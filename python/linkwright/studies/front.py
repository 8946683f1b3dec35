r"""Two goals at once: the machines of which none is better in both, by ε-constraints.

The first goal is sought while the second is held to a limit, which goes in equal steps from what the best
machine by the first goal has to what the best by the second has [1]_. That finds all of a front, also where
it is concave, where weighted sums do not. Where several machines are the best by one goal, the end of the
front is the best of these by the other.

References
----------
.. [1] Haimes, Lasdon, Wismer, On a bicriterion formulation of the problems of integrated system
   identification and system optimization, IEEE Trans. Syst. Man Cybern. 1 (1971) 296.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Callable, Mapping
from contextlib import closing
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Annotated, Any

import numpy as np

from linkwright.kernel.errors import FindingError, InputError
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.studies.optimise import Optimum, check, searched
from linkwright.studies.plan import StudyPlan
from linkwright.studies.rows import OneByOne
from linkwright.studies.search import Method
from linkwright.studies.search_log import SearchLog

# Machines whose goals differ by less, relative to the range of the front, are one.
_SAME = 1e-9

# What of one goal is given, as a share of it, for the other at an end of the front: where many machines are
# as good by the one, as those whose flywheel is the smallest, they differ by the other.
_GIVEN = 1e-6


@dataclass(frozen=True)
class Front(Result):
    """Machines of which none is better in both goals."""

    goals: Annotated[tuple[str, str], About("Names of the responses that are sought.")]
    machines: Annotated[
        tuple[Optimum, ...], About("From the best by the first goal to the best by the second.")
    ]
    failed: Annotated[
        dict[str, str], About("Limits of the second goal for which no machine was found → reason.")
    ]
    n_evaluations: Annotated[int, Label("machines that were computed", "", "")]
    one_by_one: OneByOne = field(default_factory=dict)

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Numbers by name, each machine as that of `optimise`, ready for JSON; `curves` is without effect."""
        machines = [machine.to_dict() for machine in self.machines]
        return {
            **super().to_dict(),
            "goals": list(self.goals),
            "machines": machines,
            "failed": dict(self.failed),
            "one_by_one": dict(self.one_by_one),
        }


@public
def front(
    plan: StudyPlan,
    points: int = 9,
    evaluations: int = 2000,
    *,
    seed: int = 0,
    method: Method = "both",
    starts: int = 8,
    log: str | os.PathLike[str] | None = None,
) -> Front:
    """Pareto front of two goals.

    Parameters
    ----------
    plan : StudyPlan
        A study with two goals.
    points : int
        How many machines, 3 to 1000.
    evaluations : int
        Machines that each search computes at most for each combination of choices, as of `optimise`.
    seed : int
        Seed of the random generator.
    method : {"both", "global", "gradient"}
        As of `optimise`.
    starts : int
        As of `optimise`.
    log : path-like, optional
        As of `optimise`: one file for all searches of the front.

    Returns
    -------
    Front
        The machines, with what is active.

    Raises
    ------
    InputError
        There are not two goals, or `optimise` refuses the study.
    FindingError
        No machine keeps the constraints.
    """
    if len(plan.study.goals) != 2:
        raise InputError(f"goals: found {', '.join(plan.study.goals) or 'none'}, expected two for a front")
    if not 3 <= points <= 1000:
        raise InputError(f"points {points}: expected 3 to 1000")
    (first, _), (second, way) = plan.study.goals.items()

    signs = {goal: 1.0 if kind == "minimise" else -1.0 for goal, kind in plan.study.goals.items()}
    check(_of_one(plan, first, second, None), evaluations, method, starts)
    with closing(SearchLog(plan, None if log is None else Path(log))) as known:

        def sought(goal: str, other: str, limit: float | None) -> Optimum:
            study = _of_one(plan, goal, other, limit)
            return searched(study, evaluations, known, seed, method, starts)

        ends = _end(sought, first, second, signs), _end(sought, second, first, signs)
        optimums, failed = list(ends), {}
        for limit in np.linspace(ends[0].responses[second], ends[1].responses[second], points)[1:-1]:
            try:
                optimums.append(sought(first, second, float(limit)))
            except FindingError as error:
                word = "at most" if way == "minimise" else "at least"
                failed[f"{second} {word} {limit:.6g} {plan.units[second]}".rstrip()] = str(error)
    return Front(
        (first, second),
        _best(optimums, (first, second), np.array([signs[first], signs[second]])),
        failed,
        known.count,
        dict(sum((Counter(optimum.one_by_one) for optimum in optimums), start=Counter[str]()).most_common()),
    )


def _end(
    sought: Callable[[str, str, float | None], Optimum], goal: str, other: str, signs: Mapping[str, float]
) -> Optimum:
    """Best by one goal; of equally good machines the best by the other."""
    best = sought(goal, other, None)
    value = best.responses[goal]
    try:
        also = sought(other, goal, value + signs[goal] * _GIVEN * abs(value))
    except FindingError:
        # silent: the best by one goal stands, where a search does not find another that is as good by it
        return best
    gained = signs[other] * (best.responses[other] - also.responses[other])
    return also if gained > _GIVEN * abs(best.responses[other]) else best


def _of_one(plan: StudyPlan, goal: str, other: str, limit: float | None) -> StudyPlan:
    study = plan.study.model_copy(update={"goals": {goal: plan.study.goals[goal]}})
    limits = dict(plan.limits)
    if limit is not None:
        low, high = limits.get(other, (-np.inf, np.inf))
        is_small = plan.study.goals[other] == "minimise"
        limits[other] = (low, min(high, limit)) if is_small else (max(low, limit), high)
    return replace(plan, study=study, limits=limits)


def _best(optimums: list[Optimum], goals: tuple[str, str], signs: Any) -> tuple[Optimum, ...]:
    table = signs * np.array([[optimum.responses[goal] for goal in goals] for optimum in optimums])
    order = np.lexsort((table[:, 1], table[:, 0]))
    slack = _SAME * np.ptp(table[:, 1])
    kept: list[int] = []
    for at in order.tolist():
        if not kept or table[at, 1] < table[kept[-1], 1] - slack:
            kept.append(at)
    return tuple(optimums[at] for at in kept)
