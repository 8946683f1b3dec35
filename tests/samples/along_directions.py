"""Derivatives of a machine against differences along random directions over all its entries at once.

One difference along a direction tells a wrong derivative by any entry, at the price of one: so thousands of
machines can be looked at.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray
from sizes import cases

import linkwright as lw
from linkwright import LinkwrightError
from linkwright.kernel.arrays import Floats
from linkwright.machine import exchanged
from linkwright.machine.address import is_given

# Shares of entries over which they are varied: shorter ones do not reach a kink or a tie of two extremes
# beside the machine; over longer ones rounding counts less.
_STEPS = (1e-4, 2e-5, 4e-6, 1e-3, 1e-6, 1e-7, 1e-8)

# What differences are good for, as a share of the largest derivative of a response, or of the response.
TOLERANCE = 1e-7

# Responses of which one may be zero that is a difference of the others.
_ALIKE = ("torque_net", ".last_", "torque_motor_", "power_motor_", "energy_", ".acceleration_m")

# By how many of its own uncertainties a difference may be off.
_UNCERTAIN = 3.0

# Directions over all entries of a machine.
_DIRECTIONS = cases(1, 2)

# Entry → by how much it goes.
Way = dict[str, float]


def closing(machine: lw.Machine, names: tuple[str, ...]) -> Iterator[Way]:
    """Entries and by how much each goes: sections in pairs, so that angles and lifts still close."""
    paired = [
        [name for name in names if ".sections." in name and name.endswith(f".{key}")]
        for key in ("angle", "lift", "swing")
    ]
    for name in sorted(set(names) - {name for pair in paired for name in pair}):
        if value := lw.get(machine, name):
            yield {name: abs(value)}
    for names_of in paired:
        for one, other in pairwise(names_of):
            size = min(abs(lw.get(machine, one)), abs(lw.get(machine, other)))
            yield {one: size, other: -size}


@dataclass(frozen=True)
class Case:
    """A machine, what of its results is compared, and how these are computed anew."""

    machine: lw.Machine
    analyses: list[str]
    measure: Callable[[lw.Machine, list[str]], Floats]
    ways: Callable[[lw.Machine, tuple[str, ...]], Iterator[Way]] = closing
    tolerance: Callable[[str], float] = lambda name: TOLERANCE
    # What the motion itself is good for: under a steep motor rounding of the speed is torque.
    reached: float = 0.0
    # The same of the motions that differences are taken of: what a nearly neutral drive makes of rounding.
    noise: float = 0.0
    # Elasticities up to this are compared: a run-up that barely settles, or barely does not, changes within
    # shares of an entry that no difference is short enough for.
    steepest: float = 1e100
    # How many of the steps are looked at.
    steps: int = len(_STEPS)


def _directions(machine: lw.Machine, ways: list[Way], random: Generator) -> Iterator[Way]:
    """Random ways over all entries together; one of those that others follow from is varied alone."""
    together = [way for way in ways if all(is_given(machine, name) for name in way)]
    following = [way for way in ways if way not in together]
    for _ in range(_DIRECTIONS if together else 0):
        direction: Way = Counter()
        for way in together:
            share = random.uniform(0.3, 1.0) * random.choice([-1, 1])
            direction.update({name: share * size for name, size in way.items()})
        yield direction
    if following:
        yield following[random.integers(len(following))]


@dataclass(frozen=True)
class Difference:
    """Differences along a direction, (responses,) each."""

    # Central, extrapolated to sixth order.
    value: Floats
    # By how much that of fourth order is another, and those to either side: where they are, truncation,
    # rounding or a kink count.
    uncertainty: Floats
    # Smallest change from value to value, infinite where there is none; and whether some are equal.
    smallest: Floats
    has_equal: NDArray[np.bool_]


def _difference(
    machine: lw.Machine, direction: Way, measure: Callable[[lw.Machine], Floats], step: float
) -> Difference:
    """Differences over h, 2h and 4h."""
    here = {name: lw.get(machine, name) for name in direction}
    near = {
        n: np.array(measure(exchanged(machine, {k: here[k] + n * step * x for k, x in direction.items()})))
        for n in (-4, -2, -1, 0, 1, 2, 4)
    }
    once, twice, four = ((near[n] - near[-n]) / (2 * n * step) for n in (1, 2, 4))
    sixth, fourth = (64 * once - 20 * twice + four) / 45, (4 * once - twice) / 3
    right, left = (
        (-21 * near[0] + 32 * near[side] - 12 * near[2 * side] + near[4 * side]) / (12 * side * step)
        for side in (1, -1)
    )
    changes = np.diff(np.sort(list(near.values()), axis=0), axis=0)
    smallest = np.where(changes > 0.0, changes, np.inf).min(axis=0)
    uncertainty = np.abs(sixth - fourth) + 0.3 * np.abs(right - left)
    return Difference(sixth, uncertainty, smallest, (changes == 0.0).any(axis=0))


@dataclass
class Tally:
    """What was compared: derivatives along directions."""

    count: int = 0
    # Of these, such as no difference is good enough for: they agree within its uncertainty.
    coarse: int = 0
    wrong: list[str] = field(default_factory=list)


def compared(case: Case, random: Generator) -> Tally:
    """Derivatives of a machine against differences along random directions."""
    found = lw.gradient(case.machine, case.analyses)
    ways = list(case.ways(case.machine, found.variables))
    used = [found.variables.index(name) for name in {name for way in ways for name in way}]
    sizes = np.abs(found.derivatives[:, used] * found.at[used]).max(axis=1, initial=0.0)
    is_flat = ~(sizes > case.steepest * np.abs(found.values))
    rows = [row for row, name in enumerate(found.responses) if name not in found.ties and is_flat[row]]
    names, d, sizes = [found.responses[row] for row in rows], found.derivatives[rows], sizes[rows]
    # Where a disturbance dies at once its growth over a revolution is no number.
    scales = np.maximum(sizes, np.abs(found.values[rows])) + 1e-200
    # The largest amplitude of a shape is 1.
    scales[["mode_shapes" in name for name in names]] += 1.0
    # Rounding of a net torque of zero is that of the largest, of a place on an axis that along the axis.
    for alike in _ALIKE:
        those = np.array([alike in name for name in names], dtype=bool)
        scales[those] = scales[those].max(initial=0.0)
    good = np.array([max(case.tolerance(name), case.reached) for name in names]) * scales
    tally = Tally()
    for direction in _directions(case.machine, ways, random):
        exact = sum(d[:, found.variables.index(name)] * x for name, x in direction.items())
        try:
            _compare(
                case, names, np.broadcast_to(exact, len(names)), direction, (good, case.noise * scales), tally
            )
        except (LinkwrightError, TypeError):
            # Beside it the machine cannot do it, or the law of the cam is another one.
            continue
    return tally


def _compare(
    case: Case, names: list[str], exact: Floats, direction: Way, limits: tuple[Floats, Floats], tally: Tally
) -> None:
    """Over each step as far as they are needed; what counts is the difference that is surest of itself."""
    good, noise = limits
    errors, uncertainties = [], []
    quantum, has_equal = np.full(len(names), np.inf), np.zeros(len(names), dtype=bool)
    agrees = np.zeros(len(names), dtype=bool)
    for step in _STEPS[: case.steps]:
        found = _difference(case.machine, direction, lambda x: case.measure(x, names), step)
        # There may be none beside the machine, as of a load factor where the mean passes zero.
        errors.append(np.nan_to_num(np.abs(exact - found.value), nan=np.inf))
        uncertainties.append(np.nan_to_num(found.uncertainty, nan=np.inf))
        quantum, has_equal = np.fmin(quantum, found.smallest), has_equal | found.has_equal
        agrees |= errors[-1] + uncertainties[-1] <= good
        if agrees.all():
            tally.count += len(names)
            return
    # A number that stays the same over short steps is known to its smallest change only, over long ones too.
    known = np.where(has_equal & np.isfinite(quantum), quantum, 0.0) + noise
    floor = known / np.array(_STEPS[: case.steps])[:, None]
    least, off = _surest(np.array(uncertainties) + floor, np.array(errors))
    wrong = ~agrees & ~(off <= good + _UNCERTAIN * least)
    tally.count += len(names)
    tally.coarse += int((~agrees & ~wrong).sum())
    tally.wrong += [
        f"{names[row]} is {off[row] / good[row]:.2g} times what is allowed off, with a difference good to "
        f"{least[row] / good[row]:.2g}, along {direction}"
        for row in np.flatnonzero(wrong)
    ]


def _surest(uncertainties: Floats, errors: Floats) -> tuple[Floats, Floats]:
    """Uncertainty and error of the surest differences of those over all steps, (steps, responses)."""
    # Rounding is steps of a number: over one length they may cancel, and a difference seems exact that is
    # not. Rounding that a shorter one shows is in the longer ones, too, by the share of their lengths; of the
    # shortest none tells it.
    order = np.argsort(_STEPS[: len(errors)])
    steps = np.array(_STEPS)[order, None]
    sure = np.maximum.accumulate(uncertainties[order] * steps)[1:] / steps[1:]
    surest = sure.argmin(axis=0), np.arange(sure.shape[1])
    return sure[surest], errors[order][1:][surest]


def all_agree(
    kinds: Mapping[str, Callable[[Generator], Case]], numbered: Iterable[tuple[int, Generator]]
) -> Counter[str]:
    """Derivatives of random machines of some kinds in turn; how many were compared of each kind."""
    counts, coarse = Counter[str](), 0
    for number, random in numbered:
        kind = list(kinds)[number % len(kinds)]
        try:
            tally = compared(kinds[kind](random), random)
        except LinkwrightError:
            # It does not close, nothing drives it, it does not start, all of it is rounding.
            continue
        assert not tally.wrong, (number, kind, tally.wrong)
        counts[kind] += tally.count
        coarse += tally.coarse
    # Where no difference is good enough nothing is compared: an exception.
    assert coarse < 0.05 * sum(counts.values()), counts
    return counts
