"""The best machine: whole populations of an evolution strategy through the batches of the core.

Variables without numbers, and lists, are enumerated: each combination has a search of its own. Within one,
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
import os
from collections import Counter
from collections.abc import Callable, Mapping
from contextlib import closing
from dataclasses import dataclass, field, replace
from itertools import product
from pathlib import Path
from typing import Annotated, Any, Literal, get_args

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import FindingError, InputError
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.kernel.units import is_number
from linkwright.machine.address import get
from linkwright.machine.machine import Machine
from linkwright.studies import sampling
from linkwright.studies.axes import Axis, variant
from linkwright.studies.engine import evaluate, sound_variant
from linkwright.studies.local import Descent, Price, prices
from linkwright.studies.plan import StudyPlan
from linkwright.studies.rows import SOLVED, OneByOne, Rows
from linkwright.studies.search_log import SearchLog

Method = Literal["both", "global", "gradient"]

# Places that are looked at for each start from which derivatives lead down.
_LOOKED = 16

# Combinations of what is enumerated.
_COMBINATIONS = 1000

# Share of the machines that is for the derivatives.
_KEPT = 0.5

# First standard deviation of the search, as a share of each range: 0.3, as [1] advises in section B.5.
_SIGMA = 0.3

# A limit counts as active where a response is as near to it, relative to its size.
_ACTIVE = 1e-4

# A goal that differs by less among all machines, relative to its size, does so by rounding.
_FLAT = 1e-13


@dataclass(frozen=True)
class Optimum(Result):
    """The best machine that was found."""

    machine: Annotated[Machine, About("The machine.")]
    goal: Annotated[str, About("Name of the response that was sought.")]
    variables: Annotated[dict[str, Any], About("Variable → its value [SI], or what stands at its address.")]
    responses: Annotated[dict[str, float], About("Response → its value for the best machine [SI].")]
    active: Annotated[tuple[str, ...], About("Limits that the best machine touches, in words.")]
    multipliers: Annotated[
        dict[str, float],
        About("Active limit → by how much the goal would be better if it were wider by one unit [SI]."),
    ]
    worth: Annotated[tuple[str, ...], About("The same in words, or why it is not known.")]
    tried: Annotated[
        tuple[dict[str, Any], ...],
        About(
            "Each combination of choices: its best value, and with None instead, under `refused`, what its "
            "nearest machine passes or why it has no answer."
        ),
    ]
    n_evaluations: Annotated[int, Label("machines that were computed", "", "")]
    n_failed: Annotated[int, Label("machines without a result", "", "")]
    reasons: Annotated[dict[str, int], About("Why machines had no answer → how many.")]
    fast_starts: Annotated[
        str, About("What becomes of fast starts of the best machine that do not settle; empty if they do.")
    ]
    one_by_one: OneByOne = field(default_factory=dict)
    goal_range: Annotated[
        tuple[float, float], About("Minimum and maximum of the goal among machines with an answer [SI].")
    ] = (math.nan, math.nan)

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
    """Seek the machine that is best by the goal of a study and keeps its constraints.

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
        Told after each population how many machines were computed, the best value of the goal, None as long
        as no machine keeps the limits, and the values of that machine's variables [SI].
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
    search = _Search(plan, *goal, watch, log)
    choices = [axis for axis in plan.axes if axis.choices]
    for shares in product(*(choice.levels for choice in choices)):
        fixed = {choice.name: float(s) for choice, s in zip(choices, shares, strict=True)}
        search.run(fixed, evaluations, seed, method, starts)
    return search.result()


def check(plan: StudyPlan, evaluations: int, method: str, starts: int) -> None:
    """Refuse a study that cannot be searched."""
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
    if n_free and evaluations < _population(n_free):
        expected = f"at least {_population(n_free)}, the first population of {n_free} variables"
        raise InputError(f"evaluations {evaluations}: expected {expected}")
    try:
        import cmaes  # noqa: F401
    except ImportError:
        raise InputError("the search needs cmaes: pip install 'linkwright[studies]'") from None


class _Search:
    """The best machine so far, and what was computed on the way."""

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
        self.alone: Counter[str] = Counter()

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
        given = _given(self.plan, shares)
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
        chosen = {axis.name: _chosen(axis, fixed[axis.name]) for axis in self.plan.axes if axis.choices}
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
        many = _population(len(free))
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
        """The machine of the study itself, if it is one of those sought and has an answer."""
        return [given] if given is not None and self._ranked(given[None])[0][0] < 2 else []

    def _started(self, shares: Floats, free: list[int], seed: int, starts: int) -> list[Floats]:
        """The best of many places that fill the ranges."""
        points = np.tile(shares, (starts * _LOOKED, 1))
        points[:, free] = sampling.sobol(len(free), seed, 0, len(points))
        keys = self._ranked(points)
        order = sorted(range(len(keys)), key=keys.__getitem__)
        return [points[i] for i in order[:starts] if keys[i][0] < 2]

    def _descend(self, starts: list[Floats], last: float = math.inf) -> None:
        """Derivatives lead down from each start, as long as the log has no more than `last` machines."""
        for start in starts:
            plan, kept = numbers_alone(self.plan, start)
            if not any(axis.is_continuous for axis in plan.axes):
                return
            # The end is ranked as one machine more.
            descent = Descent(plan, self.goal, self.sign, self.log, last - 1)
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
        """How good machines are, the smaller the better: by limits kept, then by goal or violation."""
        rows = self.log.evaluate(self.plan, self.plan.values(points))
        self.reasons.update(rows.failures())
        self.alone.update(rows.one_by_one)
        solved = rows.columns[self.goal][rows.status == SOLVED].tolist()
        self.low, self.high = min([self.low, *solved]), max([self.high, *solved])
        keys = [self._key(rows, i) for i in range(len(rows))]
        at = min(range(len(keys)), key=keys.__getitem__)
        if self.best is None or keys[at] < self.best[0]:
            self.best = (keys[at], points[at].copy())
        if self.watch is not None:
            (rank, value), best = self.best
            at_best = {name: float(column[0]) for name, column in self.plan.values(best[None]).items()}
            self.watch(self.count, self.sign * value if rank == 0 else None, at_best)
        return keys

    def _key(self, rows: Rows, row: int) -> tuple[int, float]:
        if rows.status[row] != SOLVED:
            return 2, 0.0
        beyond = 0.0
        for name, (low, high) in self.plan.limits.items():
            value = rows.columns[name][row]
            for excess, limit in ((low - value, low), (value - high, high)):
                beyond += max(excess, 0.0) / (abs(limit) or 1.0)
        return (1, beyond) if beyond > 0 else (0, self.sign * float(rows.columns[self.goal][row]))

    def result(self) -> Optimum:
        """The best machine, computed once more by itself."""
        if self.best is None or self.best[0][0] > 0:
            raise FindingError(self._refusal())
        plan, values = self.plan, self.plan.values(self.best[1][None])
        rows = evaluate(plan, values)
        responses = {name: float(rows.columns[name][0]) for name in plan.responses}
        kind = {
            axis.name: _chosen(axis, s)
            for axis, s in zip(plan.axes, self.best[1], strict=True)
            if axis.choices
        }
        active = (*_active(plan, responses), *_ends(plan, self.best[1]))
        worth, unknown = self._prices() if active else ([], "")
        words = [_in_words(plan, self.goal, self.sign, price) for price in worth if price.multiplier > 0]
        words += [f"what wider limits would be worth is not known: {unknown}"] if unknown else []
        return Optimum(
            machine=machine_of(plan, rows),
            goal=self.goal,
            variables={axis.name: kind.get(axis.name, float(values[axis.name][0])) for axis in plan.axes},
            responses=responses,
            active=active,
            multipliers={price.what: price.multiplier for price in worth},
            worth=tuple(words),
            tried=tuple(self.tried) if kind else (),
            n_evaluations=self.count,
            n_failed=sum(self.reasons.values()),
            reasons=dict(self.reasons),
            fast_starts=next(iter(rows.not_settling()), ""),
            one_by_one=dict(self.alone.most_common()),
            goal_range=(self.low, self.high),
        )

    def _prices(self) -> tuple[list[Price], str]:
        """What active limits cost, or why that is not known."""
        assert self.best is not None
        plan, kept = numbers_alone(self.plan, self.best[1])
        try:
            return prices(plan, self.goal, self.sign, self.best[1][kept], _ACTIVE, self.log)
        except FindingError as error:
            # A machine beside the best has no answer, so that there are no derivatives to explain it by.
            self.reasons[str(error)] += 1
            return [], "a machine beside the best has no answer"

    def _against(self, best: tuple[tuple[int, float], Floats] | None) -> str | None:
        """Why no machine of a combination of choices serves; None if one does."""
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

    def _refusal(self) -> str:
        if self.best is not None and self.best[0][0] == 1:
            rows = evaluate(self.plan, self.plan.values(self.best[1][None]))
            limits = self.plan.limits.items()
            nearest = ", ".join(f"{name} = {rows.columns[name][0]:.6g}" for name, _ in limits)
            return (
                f"none of {self.count} machines keeps all constraints; the nearest has {nearest}: allow more"
            )
        most = max(self.reasons, key=self.reasons.__getitem__, default="")
        return f"none of {self.count} machines has an answer; most often: {most}"


def _given(plan: StudyPlan, shares: Floats) -> Floats | None:
    """The machine of a study as shares, those of choices as they are; None outside of its ranges."""
    given = shares.copy()
    for i, axis in enumerate(plan.axes):
        if axis.choices:
            continue
        entries = {get(plan.machine, address) for address in axis.addresses}
        value = entries.pop()
        share = axis.share(value) if is_number(value) and not entries else math.nan
        if not 0.0 <= share <= 1.0:
            return None
        given[i] = share
    return given


def numbers_alone(plan: StudyPlan, shares: Floats) -> tuple[StudyPlan, list[int]]:
    """The study with what is no number chosen, and the places of the variables that are left."""
    kept = [i for i, axis in enumerate(plan.axes) if axis.is_number]
    pairs = zip(plan.axes, shares, strict=True)
    machine = _with_choices(plan, {axis.name: _chosen(axis, s) for axis, s in pairs if not axis.is_number})
    return replace(plan, machine=machine, axes=tuple(plan.axes[i] for i in kept)), kept


def _with_choices(plan: StudyPlan, chosen: Mapping[str, Any]) -> Machine:
    """The machine with values of the variables that are no numbers."""
    changes = [
        (place, chosen[axis.name]) for axis in plan.axes if axis.name in chosen for place in axis.addresses
    ]
    return variant(plan.machine, changes) if changes else plan.machine


def _ends(plan: StudyPlan, shares: Floats) -> tuple[str, ...]:
    """Ends of ranges that a machine touches."""
    ends = []
    for axis, share in zip(plan.axes, shares, strict=True):
        if not axis.choices and min(share, 1.0 - share) <= _ACTIVE:
            word, value = ("lower", axis.low) if share < 0.5 else ("upper", axis.high)
            ends.append(f"{axis.name} is at the {word} end of its range, {value:.6g} {axis.unit}".rstrip())
    return tuple(ends)


def _in_words(plan: StudyPlan, goal: str, sign: float, price: Price) -> str:
    """What one hundredth of a limit is worth."""
    unit, own = plan.units[goal], plan.units[price.of]
    wider = 0.01 * (abs(price.limit) or 1.0)
    way = "more" if price.is_upper else "less"
    better = "smaller" if sign > 0 else "larger"
    gain = f"{price.multiplier * wider:.4g} {unit}".rstrip()
    return f"{wider:.4g} {own} {way} at the {price.what} would make {goal} {gain} {better}".replace("  ", " ")


def machine_of(plan: StudyPlan, rows: Rows) -> Machine:
    """The machine of the first row."""
    lists = [axis for axis in plan.axes if not axis.is_number]
    base = _with_choices(plan, {axis.name: axis.choices[int(rows.columns[axis.name][0])] for axis in lists})
    named = [(axis.name, axis.addresses) for axis in plan.axes if axis.is_number]
    named += [(entry.name, entry.addresses) for entry in plan.derived]
    return sound_variant(
        base, {place: float(rows.columns[name][0]) for name, places in named for place in places}
    )


def _population(n: int) -> int:
    """Machines of a population that varies n numbers, as [1] advises in table 1; it has two at least."""
    return 4 + math.floor(3 * math.log(max(n, 2)))


def _step(axis: Axis) -> float:
    """Distance of whole numbers as a share of their range; 0 for what may have any value."""
    return 1.0 / (axis.high - axis.low) if axis.is_whole else 0.0


def _chosen(axis: Axis, share: float) -> Any:
    """What stands in the list at a share."""
    return axis.choices[min(int(share * len(axis.choices)), len(axis.choices) - 1)]


def _active(plan: StudyPlan, responses: dict[str, float]) -> tuple[str, ...]:
    """Limits that a machine touches."""
    active = []
    for name, (low, high) in plan.limits.items():
        for limit, word in ((low, "minimum"), (high, "maximum")):
            if np.isfinite(limit) and abs(responses[name] - limit) <= _ACTIVE * max(
                abs(limit), abs(responses[name])
            ):
                active.append(f"{name} is at its {word}, {limit:.6g} {plan.units[name]}".rstrip())
    return tuple(active)
