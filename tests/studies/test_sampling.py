"""Rows are functions of their numbers: any part of a sweep can be drawn alone."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product
from pathlib import Path

import numpy as np
import pytest

import linkwright as lw
from linkwright import InputError
from linkwright.studies import sampling

N, D, SEED = 257, 3, 11


def drawn(method: str, start: int, stop: int) -> np.ndarray:
    match method:
        case "sobol":
            return sampling.sobol(D, SEED, start, stop)
        case "latin_hypercube":
            return sampling.latin_hypercube(D, N, SEED, start, stop)
    return sampling.random(D, SEED, start, stop)


@pytest.mark.parametrize("method", ["sobol", "latin_hypercube", "random"])
def test_parts_make_the_whole(method: str) -> None:
    whole = drawn(method, 0, N)
    assert whole.shape == (N, D)
    assert ((whole >= 0) & (whole < 1)).all()
    for start, stop in ((0, 1), (1, 6), (6, 131), (131, N)):
        np.testing.assert_array_equal(drawn(method, start, stop), whole[start:stop])


def test_every_stratum_of_a_latin_hypercube_holds_one_row() -> None:
    whole = drawn("latin_hypercube", 0, N)
    for column in whole.T:
        assert sorted((column * N).astype(int)) == list(range(N))
    # Columns are not the same order.
    assert abs(np.corrcoef(whole.T)[0, 1]) < 0.2


def test_sobol_fills_space_more_evenly_than_chance() -> None:
    """The mean of Π 3u², whose integral is 1: its error falls nearly as 1/n, not as 1/√n."""
    n = 4096

    def error(points: np.ndarray) -> float:
        return abs(float((3 * points**2).prod(axis=1).mean()) - 1)

    assert error(sampling.sobol(D, SEED, 0, n)) < 0.005
    assert error(sampling.sobol(D, SEED, 0, n)) < error(sampling.random(D, SEED, 0, n))


def test_a_grid_is_the_product_of_its_levels() -> None:
    levels = [np.array([0.0, 1.0]), np.array([0.2, 0.4, 0.6]), np.array([0.5])]
    wanted = np.array(list(product(*levels)))
    np.testing.assert_array_equal(sampling.grid(levels, 0, 6), wanted)
    np.testing.assert_array_equal(sampling.grid(levels, 2, 5), wanted[2:5])


WRONG_CALLS = {
    "shares: found None": lambda plan, machine: plan.values(None),
    "shares: found an array of shape \\(2, 3\\)": lambda plan, machine: plan.values(np.zeros((2, 3))),
    "shares: found nan": lambda plan, machine: plan.values([[np.nan, 0.5]]),
    "shares: found 0.5 to 2": lambda plan, machine: plan.values([[2.0, 0.5]]),
    "rows 0 to 1000000000": lambda plan, machine: plan.rows(0, 10**9),
    "stop: found 1.5": lambda plan, machine: plan.shares(0, 1.5),
    "entries: found None": lambda plan, machine: machine.with_entries(None),
    "entries: found 'driv'": lambda plan, machine: machine.with_entries({"driv": 1}),
}


@pytest.mark.parametrize("message", WRONG_CALLS)
def test_wrong_arguments_are_refused_by_name(message: str, study_file: Callable[..., Path]) -> None:
    plan = lw.read_study(study_file())
    with pytest.raises(InputError, match=message):
        WRONG_CALLS[message](plan, plan.machine)
