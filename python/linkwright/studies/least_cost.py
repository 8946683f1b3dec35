r"""Factors of minimum cost within limits of squares.

.. math:: \min \sum_i c_i f_i^{-k}, \qquad \sum_i a_{ji} f_i^2 \le r_j, \qquad 1/F \le f_i \le F

is a geometric program, convex in log f [1]_. With multipliers λ ≥ 0 of the limits the Lagrangian separates:

.. math:: f_i^{k + 2} = \frac{k\, c_i}{2 \sum_j \lambda_j a_{ji}}

within the bounds, and its minimum is a lower bound of the cost: the distance from it, the duality gap, says
how far factors are from the optimum, however they were found.

References
----------
.. [1] Boyd, Vandenberghe, Convex Optimization, 2004, sections 4.5 and 5.5.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import ConvergenceError
from linkwright.kernel.numerics.zeros import zero

# Duality gap of an optimum, as a share of its cost: factors are then known to its square root, 3e-4.
_GAP = 1e-7

# Use of a limit beyond it that is rounding.
_ROUNDING = 1e-9

# Iterations of SLSQP.
_ITERATIONS = 300


@dataclass(frozen=True)
class LeastCost:
    """Factors of minimum cost; `costs` c (n,), `uses` a (limits, n), `room` r > 0 (limits,), `most` F > 1."""

    costs: Floats
    uses: Floats
    room: Floats
    power: float
    most: float

    def factors(self) -> Floats:
        """The cheapest factors, (n,); `ConvergenceError` if the duality gap is too large."""
        for j in range(len(self.room)):
            alone = self._of_one(j)
            if self._used(alone).max() <= 1 + _ROUNDING:
                return alone
        factors, message = self._of_many()
        if self.gap(factors) > _GAP:
            raise ConvergenceError(
                f"the cheapest tolerances were not found ({message}; duality gap {self.gap(factors):.1e})",
                method="SLSQP",
                iterations=_ITERATIONS,
            )
        return factors

    def gap(self, factors: Floats) -> float:
        """Cost above the lower bound of the dual problem, as a share of the cost."""
        from scipy.optimize import nnls

        cost = self.costs * factors**-self.power
        inside = (factors > 1.000001 / self.most) & (factors < self.most / 1.000001)
        scale = 1 / cost.sum()
        parts = (self.uses / self.room[:, None] * factors**2)[:, inside]
        used = self._used(factors) > 1 - 1e-4  # limits that are idle have no multiplier
        multipliers = np.zeros(len(self.room))
        if inside.any() and used.any():
            multipliers[used], _ = nnls(2 * parts[used].T, self.power * cost[inside] * scale)
        multipliers = multipliers / scale / self.room
        least = self._lagrangian(multipliers)
        bound = (self.costs * least**-self.power + multipliers @ self.uses * least**2).sum()
        return float((cost.sum() - bound + multipliers @ self.room) * scale)

    def _used(self, factors: Floats) -> Floats:
        """Shares of the limits that factors use, (limits,)."""
        used: Floats = self.uses @ factors**2 / self.room
        return used

    def _lagrangian(self, multipliers: Floats) -> Floats:
        """Factors of the minimum of the Lagrangian, (n,)."""
        with np.errstate(divide="ignore"):
            free = (self.power * self.costs / (2 * multipliers @ self.uses)) ** (1 / (self.power + 2))
        return np.clip(free, 1 / self.most, self.most)

    def _of_one(self, j: int) -> Floats:
        """Factors that keep limit j alone at minimum cost, (n,)."""
        most = np.full(len(self.costs), self.most)
        if self._used(most)[j] <= 1:
            return most

        def over(log_multiplier: float) -> float:
            multipliers = np.zeros(len(self.room))
            multipliers[j] = np.exp(log_multiplier)
            return float(np.log(self._used(self._lagrangian(multipliers))[j]))

        # From where the first factor leaves its upper bound to where the last reaches the lower one.
        counts = self.uses[j] > 0
        ends = np.log(self.power * self.costs[counts] / (2 * self.uses[j, counts]))
        span = (self.power + 2) * np.log(self.most)
        return self._lagrangian(
            np.eye(len(self.room))[j] * np.exp(zero(over, ends.min() - span, ends.max() + span))
        )

    def _of_many(self) -> tuple[Floats, str]:
        """Factors by SLSQP, within all limits, (n,), and its message, which alone is no verdict."""
        from scipy.optimize import minimize

        edge, n = np.log(self.most), len(self.costs)
        costs, uses = self.costs / self.costs.sum(), self.uses / self.room[:, None]

        def slope(x: Floats) -> Floats:
            parts = uses * np.exp(2 * x)
            slope: Floats = 2 * parts / parts.sum(axis=1, keepdims=True)
            return slope

        def use(x: Floats) -> Floats:
            used: Floats = np.log(uses @ np.exp(2 * x))
            return used

        # All of them narrower by one factor keep the limits, to begin with.
        start = np.full(n, np.clip(-0.5 * use(np.zeros(n)).max(), -edge, edge))
        kept: Any = {"type": "ineq", "fun": lambda x: -use(x), "jac": lambda x: -slope(x)}
        given: Any = {
            # The logarithm of the cost is as large at the optimum of cheap tolerances as of dear ones.
            "fun": lambda x: float(np.log(costs @ np.exp(-self.power * x))),
            "x0": start,
            "jac": lambda x: (
                -self.power * costs * np.exp(-self.power * x) / (costs @ np.exp(-self.power * x))
            ),
            "bounds": [(-edge, edge)] * n,
            "constraints": [kept],
            "method": "SLSQP",
            "options": {"maxiter": _ITERATIONS, "ftol": 1e-13},
        }
        best = minimize(**given)
        x = best.x - 0.5 * max(float(use(best.x).max()), 0.0)
        return np.clip(np.exp(x), 1 / self.most, self.most), str(best.message)
