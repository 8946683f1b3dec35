"""The best machine of a study: its search, what it touches, and what wider limits would be worth.

Variables without numbers, and lists, are enumerated: each combination has a search of its own
(`linkwright.studies.search`).
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable
from contextlib import closing
from dataclasses import dataclass, field
from itertools import product
from pathlib import Path
from typing import Annotated, Any, get_args

import numpy as np

from linkwright.kernel.errors import FindingError, InputError
from linkwright.kernel.extras import require
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.kinetostatics.contact import lost_contacts
from linkwright.machine.machine import Machine
from linkwright.studies.chosen import choice, machine_of, numbers_alone
from linkwright.studies.engine import evaluate
from linkwright.studies.limits import Price, in_words, prices, touched
from linkwright.studies.plan import StudyPlan, require_variables
from linkwright.studies.rows import OneByOne
from linkwright.studies.search import Method, Search, population
from linkwright.studies.search_log import SearchLog

# Combinations of what is enumerated.
_COMBINATIONS = 1000

# A goal that differs by less among all machines, relative to its size, does so by rounding.
_FLAT = 1e-13


@dataclass(frozen=True)
class Optimum(Result):
    """The best machine that was found."""

    machine: Annotated[Machine, About("The machine.")]
    goal: Annotated[str, About("Name of the response that was sought.")]
    variables: Annotated[dict[str, Any], About("Variable → its value [SI], or what stands at its address.")]
    responses: Annotated[dict[str, float], About("Response → its value for the best machine [SI].")]
    active: Annotated[tuple[str, ...], About("Active limits of the best machine, in words.")]
    multipliers: Annotated[
        dict[str, float],
        About("Active limit → improvement of the goal per unit of a wider limit [SI]."),
    ]
    worth: Annotated[tuple[str, ...], About("The same in words, or the reason why it is unknown.")]
    tried: Annotated[
        tuple[dict[str, Any], ...],
        About(
            "Each combination of choices: its best value, and with None instead, under `refused`, what its "
            "nearest machine passes or why it has no answer."
        ),
    ]
    n_evaluations: Annotated[int, Label("machines that were computed", "", "")]
    n_failed: Annotated[int, Label("machines without a result", "", "")]
    reasons: Annotated[dict[str, int], About("Reasons for machines without a result → number of machines.")]
    fast_starts: Annotated[
        str, About("Behaviour of fast starts of the best machine that do not settle; empty if all settle.")
    ]
    one_by_one: OneByOne = field(default_factory=dict)
    goal_range: Annotated[
        tuple[float, float], About("Minimum and maximum of the goal among machines with an answer [SI].")
    ] = (math.nan, math.nan)
    findings: Annotated[
        tuple[str, ...],
        About("Failed checks of the best machine: a follower that leaves its cam, a slack cable."),
    ] = ()

    @property
    def is_flat(self) -> bool:
        """Whether the goal is the same for all machines, so that none is better."""
        low, high = self.goal_range
        return self.n_evaluations - self.n_failed > 1 and high - low <= _FLAT * max(abs(low), abs(high))

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Numbers and tables by name, ready for JSON; `curves` is without effect."""
        names = ("variables", "responses", "multipliers", "reasons", "one_by_one")
        return {**super().to_dict(), **{name: dict(getattr(self, name)) for name in names}}


@public
def optimise(
    plan: StudyPlan,
    evaluations: int = 4000,
    *,
    seed: int = 0,
    method: Method = "both",
    starts: int = 8,
    watch: Callable[..., None] | None = None,
    log: str | os.PathLike[str] | None = None,
) -> Optimum:
    """Find the best machine for the goal of a study within its constraints.

    Parameters
    ----------
    plan : StudyPlan
        A study with one goal; variables with ranges, or with values that are enumerated.
    evaluations : int
        Machines that the search computes at most for each combination of choices, 10 to 10⁷ and no fewer
        than the first population; where `method` is ``"both"``, the second half is for derivatives. Without
        effect where it is ``"gradient"``.
    seed : int
        Seed of the random generator; the same seed gives the same search.
    method : {"both", "global", "gradient"}
        CMA-ES and from its best on by derivatives; CMA-ES alone; derivatives from many starts.
    starts : int
        From how many places derivatives lead down, 1 to 1000, where `method` is ``"gradient"``.
    watch : callable, optional
        Called after each population, and each machine of the derivatives, with how many machines were
        computed, the best value of the goal, None as long as no machine keeps the limits, and the values of
        that machine's variables [SI].
    log : path, optional
        File to which each computation is written; a search that was stopped goes on by replaying it.

    Returns
    -------
    Optimum
        The best machine of all that were computed.

    Raises
    ------
    InputError
        There is no goal or more than one, a variable scatters, cmaes is not installed, or the log is that of
        another search.
    FindingError
        No machine has an answer and keeps the constraints; says what fails.
    """
    check(plan, evaluations, method, starts)
    with closing(SearchLog(plan, None if log is None else Path(log))) as known:
        return searched(plan, evaluations, known, seed, method, starts, watch)


def searched(
    plan: StudyPlan,
    evaluations: int,
    log: SearchLog,
    seed: int,
    method: Method,
    starts: int,
    watch: Callable[..., None] | None = None,
) -> Optimum:
    """The best machine of a checked study with one goal, whose computations a log has or takes."""
    goal = next(iter(plan.study.goals.items()))
    search = Search(plan, *goal, watch, log)
    lists = [axis for axis in plan.axes if axis.choices]
    for shares in product(*(axis.levels for axis in lists)):
        fixed = {axis.name: float(s) for axis, s in zip(lists, shares, strict=True)}
        search.run(fixed, evaluations, seed, method, starts)
    return _optimum(search)


def _optimum(search: Search) -> Optimum:
    if search.best is None or search.best[0][0] > 0:
        raise FindingError(_refusal(search))
    plan, values = search.plan, search.plan.values(search.best[1][None])
    rows = evaluate(plan, values)
    responses = {name: float(rows.columns[name][0]) for name in plan.responses}
    kind = {
        axis.name: choice(axis, s) for axis, s in zip(plan.axes, search.best[1], strict=True) if axis.choices
    }
    active = touched(plan, responses, search.best[1])
    worth, unknown = _prices(search) if active else ([], "")
    words = [in_words(plan, search.goal, search.sign, price) for price in worth if price.multiplier > 0]
    words += [f"the value of wider limits is unknown: {unknown}"] if unknown else []
    best = machine_of(plan, rows)
    return Optimum(
        machine=best,
        goal=search.goal,
        variables={axis.name: kind.get(axis.name, float(values[axis.name][0])) for axis in plan.axes},
        responses=responses,
        active=active,
        multipliers={price.what: price.multiplier for price in worth},
        worth=tuple(words),
        tried=tuple(search.tried) if kind else (),
        n_evaluations=search.count,
        n_failed=sum(search.reasons.values()),
        reasons=dict(search.reasons),
        fast_starts=next(iter(rows.not_settling()), ""),
        one_by_one=dict(search.one_by_one.most_common()),
        goal_range=(search.low, search.high),
        findings=lost_contacts(best),
    )


def _prices(search: Search) -> tuple[list[Price], str]:
    assert search.best is not None
    plan, kept = numbers_alone(search.plan, search.best[1])
    try:
        return prices(plan, search.goal, search.sign, search.best[1][kept], search.log)
    except FindingError as error:
        # A machine beside the best has no answer, so that there are no derivatives to explain it by.
        search.reasons[str(error)] += 1
        return [], "a machine next to the best has no result"


def _refusal(search: Search) -> str:
    if search.best is not None and search.best[0][0] == 1:
        rows = evaluate(search.plan, search.plan.values(search.best[1][None]))
        limits = search.plan.limits.items()
        nearest = ", ".join(f"{name} = {rows.columns[name][0]:.6g}" for name, _ in limits)
        return (
            f"none of {search.count} machines satisfies all constraints; the nearest has {nearest}: relax "
            "the limits"
        )
    most = max(search.reasons, key=search.reasons.__getitem__, default="")
    return f"none of {search.count} machines has a result; most often: {most}"


def check(plan: StudyPlan, evaluations: int, method: str, starts: int) -> None:
    """Refuse a study that cannot be searched."""
    require_variables(plan)
    if len(plan.study.goals) != 1:
        found = ", ".join(plan.study.goals) or "none"
        raise InputError(f'goals: found {found}, expected one, such as delta = "minimise"; limit the others')
    if not 10 <= evaluations <= 10_000_000:
        raise InputError(f"evaluations {evaluations}: expected 10 to 10 000 000")
    if method not in get_args(Method) or not 1 <= starts <= 1000:
        expected = "both, global or gradient, and 1 to 1000 starts"
        raise InputError(f"method {method}, starts {starts}: expected {expected}")
    integers = [axis.name for axis in plan.axes if axis.is_whole]
    if method == "gradient" and integers:
        raise InputError(
            f"variables.{integers[0]}: found whole numbers, which have no derivatives; leave out --method"
        )
    for axis in plan.axes:
        if axis.distribution is not None or axis.is_open:
            what = "nothing" if axis.is_open else "a scatter"
            raise InputError(
                f"variables.{axis.name}: found {what}, expected a range or values to choose from"
            )
    combinations = np.prod([len(axis.choices) for axis in plan.axes if axis.choices], dtype=float)
    if combinations > _COMBINATIONS:
        raise InputError(f"values: found {combinations:.0f} combinations, expected at most {_COMBINATIONS}")
    if method == "gradient":
        return
    n_free = sum(not axis.choices for axis in plan.axes)
    if n_free and evaluations < population(n_free):
        expected = f"at least {population(n_free)}, the first population of {n_free} variables"
        raise InputError(f"evaluations {evaluations}: expected {expected}")
    require("cmaes", "studies", "the search needs cmaes")
