"""Factors of minimum cost: closed forms, the bound of the dual problem, and a study that was refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import linkwright as lw
from linkwright.studies.least_cost import LeastCost

FOUND = Path(__file__).parents[1] / "found" / "use"


def problems(seed: int) -> LeastCost:
    rng = np.random.default_rng(seed)
    n, m = rng.integers(1, 9), rng.integers(1, 5)
    uses = 10 ** rng.uniform(-3, 2, (m, n)) * (rng.random((m, n)) < 0.8)
    uses[uses.sum(axis=1) == 0] = 1.0
    return LeastCost(
        10 ** rng.uniform(-2, 2, n), uses, 10 ** rng.uniform(-1, 1, m), rng.uniform(0.1, 4), 100.0
    )


@pytest.mark.parametrize("seed", range(60))
def test_no_cost_is_below_the_bound(seed: int) -> None:
    """All limits are kept, and the cost is that of the dual problem; other factors have a gap."""
    problem = problems(seed)
    factors = problem.factors()
    assert (problem.uses @ factors**2 <= problem.room * (1 + 1e-8)).all()
    assert problem.gap(factors) < 1e-7
    if problem.uses.all() and (factors < 99).all():
        assert problem.gap(factors * 0.9) > 1e-3


def test_one_limit_has_a_closed_form() -> None:
    """f ∝ (c/a)^(1/(k + 2)), the limit used up."""
    costs, uses = np.array([5.4, 1.7, 0.3]), np.array([[2.0, 0.7, 9.0], [1.9, 0.6, 8.0]])
    factors = LeastCost(costs, uses, np.array([1.0, 1.0]), 1.5, 100.0).factors()
    ratio = (costs / uses[0]) ** (1 / 3.5)
    np.testing.assert_allclose(factors, ratio / np.sqrt(uses[0] @ ratio**2), rtol=1e-9)


def test_the_optimum_that_a_line_search_refused() -> None:
    """SLSQP ended with mode 8 at the optimum; f ∝ (c/s²)^⅓ of a linear response."""
    plan = lw.read_study(FOUND / "cheapest_tolerances.toml")
    found = lw.allocate(plan, 0.95, rows=4000)
    spread = np.array([2.018176 * 0.0854, 0.731320 * 0.3249])
    ratio = (np.array([5.402, 1.734]) / spread**2) ** (1 / 3)
    assert found.factors["x0"] / found.factors["x1"] == pytest.approx(ratio[0] / ratio[1], rel=1e-8)
    assert 0.95 <= found.share_within < 0.953
