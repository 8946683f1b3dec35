"""Differential evolution over whole populations: the global search behind path generation.

Each trial starts from its parent, moves towards one of the best, and by the difference of two others:

    v = x + F (x_best − x) + F (x_a − x_b)

and takes each coordinate of v with probability C, else that of x. F and C follow those that have succeeded.
Trials are compared by Deb's rules: what keeps the constraints beats what does not; among the former the
smaller cost wins, among the latter the smaller violation.

Source: J. Zhang, A. C. Sanderson, JADE: adaptive differential evolution with optional external archive, IEEE
Transactions on Evolutionary Computation 13 (2009) 945–958; K. Deb, An efficient constraint handling method
for genetic algorithms, Computer Methods in Applied Mechanics and Engineering 186 (2000) 311–338.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

# Rows, improved where that is cheap; cost and violation of each; violation 0 where all constraints are kept.
Judge = Callable[[Floats], tuple[Floats, Floats, Floats]]

# Share of the population that counts as the best, and rate at which F and C follow (Zhang and Sanderson: 5 to
# 20 %, 0.1).
_BEST = 0.1
_RATE = 0.1

# Generations without an improvement by a thousandth after which the search has come to rest.
_PATIENCE = 150


@dataclass(frozen=True)
class Generation:
    """State of a search after a generation.

    Attributes
    ----------
    number : int
        Generations done.
    evaluated : int
        Rows judged so far.
    best : ndarray, shape (k,)
        The best row.
    cost, violation : float
        Of the best row.
    population : ndarray, shape (m, k)
        All rows, the best first.
    """

    number: int
    evaluated: int
    best: Floats
    cost: float
    violation: float
    population: Floats


def evolve(judge: Judge, low: Floats, high: Floats, population: int, seed: int) -> Iterator[Generation]:
    """Search a box; yields after every generation, until the search has come to rest.

    Parameters
    ----------
    judge : callable
        Rows (m, k) → the rows to go on with (m, k), their cost (m,) and violation (m,).
    low, high : ndarray, shape (k,)
        Bounds of the rows.
    population : int
        Rows in a generation.
    seed : int
        Start of the random numbers.

    Yields
    ------
    Generation
        The state; the same for the same arguments.
    """
    random = np.random.default_rng(seed)
    x = low + (high - low) * random.random((population, len(low)))
    x, cost, violation = judge(x)
    mean_F, mean_C = 0.5, 0.5
    evaluated, number = population, 0
    record, rested = np.inf, 0
    while rested < _PATIENCE:
        order = np.lexsort((cost, violation))
        x, cost, violation = x[order], cost[order], violation[order]
        yield Generation(number, evaluated, x[0], float(cost[0]), float(violation[0]), x)
        measure = float(cost[0]) if violation[0] == 0 else np.inf
        rested = 0 if not measure > 0.999 * record else rested + 1
        record = min(record, measure) if rested == 0 else record
        F, C = _factors(random, population, mean_F, mean_C)
        trial, new_cost, new_violation = judge(_trials(random, x, F, C, low, high))
        wins = (new_violation < violation) | ((new_violation == violation) & (new_cost < cost))
        x[wins], cost[wins], violation[wins] = trial[wins], new_cost[wins], new_violation[wins]
        if wins.any():
            mean_F += _RATE * (float((F[wins] ** 2).sum() / F[wins].sum()) - mean_F)
            mean_C += _RATE * (float(C[wins].mean()) - mean_C)
        evaluated, number = evaluated + population, number + 1


def _factors(random: np.random.Generator, n: int, mean_F: float, mean_C: float) -> tuple[Floats, Floats]:
    """F from a Cauchy distribution, C from a normal one, about what has succeeded, (n,)."""
    F = mean_F + 0.1 * random.standard_cauchy(n)
    C = np.clip(mean_C + 0.1 * random.standard_normal(n), 0, 1)
    return np.clip(np.abs(F), 0.05, 1), C


def _trials(
    random: np.random.Generator, x: Floats, F: Floats, C: Floats, low: Floats, high: Floats
) -> Floats:
    """Trial rows for rows in order of merit, inside the box, (m, k)."""
    n, k = x.shape
    best = x[random.integers(0, max(2, int(_BEST * n)), n)]
    # Two others, different from the row and from one another.
    a = (np.arange(n) + random.integers(1, n, n)) % n
    b = (a + random.integers(1, n, n)) % n
    moved = x + F[:, None] * (best - x) + F[:, None] * (x[a] - x[b])
    # Beyond a bound: half-way from the row to it.
    moved = np.where(moved < low, 0.5 * (x + low), np.where(moved > high, 0.5 * (x + high), moved))
    taken = random.random((n, k)) < C[:, None]
    taken[np.arange(n), random.integers(0, k, n)] = True
    return np.where(taken, moved, x)
