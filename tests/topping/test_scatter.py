"""Lengths that scatter: values against SciPy's distributions, ends, and what cannot be."""

from __future__ import annotations

import math

import numpy as np
import pytest
from pydantic import TypeAdapter, ValidationError
from scipy import stats

from linkwright.topping.model.scatter import AnyScatter, Scatter

SHARES = np.array([1e-6, 0.01, 0.3, 0.5, 0.77, 0.99, 1 - 1e-6])
ADAPTER: TypeAdapter[Scatter] = TypeAdapter(AnyScatter)


def scatter(**entries: object) -> Scatter:
    return ADAPTER.validate_python(entries)


@pytest.mark.parametrize(
    ("least", "greatest"), [(None, None), (0.08, None), (None, 0.1), (0.09, 0.13), (0.155, 0.2)]
)
def test_normal_values_are_scipys(least: float | None, greatest: float | None) -> None:
    found = scatter(kind="normal", mean=0.1, deviation=0.01, min=least, max=greatest)
    low = -math.inf if least is None else (least - 0.1) / 0.01
    high = math.inf if greatest is None else (greatest - 0.1) / 0.01
    expected = stats.truncnorm.ppf(SHARES, low, high, loc=0.1, scale=0.01)
    np.testing.assert_allclose(found.values(SHARES), expected, rtol=1e-9)


@pytest.mark.parametrize(("least", "greatest"), [(None, None), (0.02, 0.05)])
def test_lognormal_values_have_mean_and_deviation(least: float | None, greatest: float | None) -> None:
    found = scatter(kind="lognormal", mean=0.03, deviation=0.01, min=least, max=greatest)
    width = math.sqrt(math.log(1 + 1 / 9))
    whole = stats.lognorm(s=width, scale=0.03 * math.exp(-(width**2) / 2))
    assert (whole.mean(), whole.std()) == pytest.approx((0.03, 0.01), rel=1e-12)
    start, end = whole.cdf(least or 0.0), whole.cdf(greatest or math.inf)
    np.testing.assert_allclose(found.values(SHARES), whole.ppf(start + SHARES * (end - start)), rtol=1e-9)


def test_uniform_by_mean_or_ends() -> None:
    by_mean = scatter(kind="uniform", mean=0.1, deviation=0.01)
    by_ends = scatter(kind="uniform", min=0.1 - 0.01 * math.sqrt(3), max=0.1 + 0.01 * math.sqrt(3))
    np.testing.assert_allclose(by_mean.values(SHARES), by_ends.values(SHARES), rtol=1e-12)
    even = by_mean.values((np.arange(10_000) + 0.5) / 10_000)
    assert (even.mean(), even.std()) == pytest.approx((0.1, 0.01), rel=1e-6)


@pytest.mark.parametrize("value", ["30 mm", 0.03])
def test_bare_lengths_are_constants(value: object) -> None:
    found = ADAPTER.validate_python(value)
    assert found.is_constant
    assert found.values(SHARES).tolist() == [0.03] * len(SHARES)


@pytest.mark.parametrize("kind", ["normal", "lognormal"])
def test_no_deviation_is_a_constant(kind: str) -> None:
    found = scatter(kind=kind, mean=0.03, deviation=0, least=0.02)
    assert found.is_constant
    assert (found.values(SHARES) == 0.03).all()


def test_shares_of_zero_and_one_stay_finite() -> None:
    ends = np.array([0.0, 1.0])
    for kind in ("normal", "lognormal"):
        assert np.isfinite(scatter(kind=kind, mean=0.1, deviation=0.02).values(ends)).all()
        cut = scatter(kind=kind, mean=0.1, deviation=0.02, least=0.05, greatest=0.2)
        assert cut.values(ends).tolist() == pytest.approx([0.05, 0.2], rel=1e-12)


@pytest.mark.parametrize(
    ("entries", "words"),
    [
        ({"kind": "normal", "mean": 0.1, "deviation": 0.01, "least": 0.3}, "leaves nothing"),
        ({"kind": "normal", "mean": 0.1, "deviation": 0.01, "greatest": 0.02}, "leaves nothing"),
        ({"kind": "normal", "mean": 0.1, "deviation": 0.01, "least": 0.2, "greatest": 0.1}, "0.2 m or more"),
        ({"kind": "normal", "mean": 0.1, "deviation": 0, "least": 0.2}, "nothing scatters"),
        ({"kind": "lognormal", "mean": 0, "deviation": 0.01}, "greater than 0"),
        ({"kind": "lognormal", "mean": 0.1, "deviation": 0.01, "greatest": -1}, "leaves nothing"),
        ({"kind": "normal", "mean": 0.1, "deviation": -0.01}, "of 0 or more"),
        ({"kind": "uniform", "mean": 0.1}, "expected a length"),
        ({"kind": "uniform", "least": 0.1}, "expected a length"),
        ({"kind": "uniform"}, "expected a length"),
        ({"kind": "uniform", "mean": 0.1, "deviation": 0.1, "least": 0.1}, "expected nothing"),
        ({"kind": "uniform", "least": 0.2, "greatest": 0.1}, "or more, as min is"),
    ],
)
def test_what_cannot_be(entries: dict[str, object], words: str) -> None:
    with pytest.raises(ValidationError, match=words):
        ADAPTER.validate_python(entries)
