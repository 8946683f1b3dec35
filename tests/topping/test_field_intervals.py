"""Intervals of shares and means: against textbook forms, and as often right as they say."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import stats
from topper_fields import machine

from linkwright import topper_field
from linkwright.topping.intervals import Clusters, ShareCurve

Floats = NDArray[np.float64]


def alone(n: int, level: float = 0.95) -> Clusters:
    """Independent pieces, each its own cluster."""
    return Clusters(np.arange(n), n, True, level)


def wilson(p: float, n: float, t: float) -> tuple[float, float]:
    """Where (p − x)² = t² x (1 − x)/n."""
    low, high = np.sort(np.roots([1 + t**2 / n, -(2 * p + t**2 / n), p**2]).real)
    return float(low), float(high)


def test_shares_of_independent_pieces_are_wilsons() -> None:
    hits = np.zeros(40)
    hits[:9] = 1
    found = alone(40).shares(hits[:, None])
    # The variance of a sample of 40 is 40/39 of p(1 − p)/40.
    expected = wilson(9 / 40, 39.0, float(stats.t.ppf(0.975, 39)))
    assert (float(found.low[0]), float(found.high[0])) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("p", [0.0, 1.0])
def test_shares_of_zero_and_one_have_room(p: float) -> None:
    t = float(stats.t.ppf(0.975, 9))
    free = Clusters(np.repeat(np.arange(10), 30), 10, True)
    bound = Clusters(np.repeat(np.arange(10), 30), 10, False)
    known = Clusters(np.repeat(np.arange(10), 30), 10, False, worth=77.0)
    for clusters, worth in ((free, 300), (bound, 10), (known, 77)):
        for found in (clusters.share(np.full(300, p)), clusters.shares(np.full((10, 1), 30 * p))):
            room = np.abs(np.array([found.low, found.high]).ravel() - p)
            assert sorted(room) == pytest.approx([0, t**2 / (worth + t**2)], rel=1e-12)


def test_mean_over_equal_clusters_is_that_of_their_means() -> None:
    values = np.random.default_rng(3).gamma(2.0, size=(12, 25))
    clusters = Clusters(np.repeat(np.arange(12), 25), 12, False, 0.9)
    found = clusters.mean(values.ravel())
    means = values.mean(axis=1)
    low, high = stats.t.interval(0.9, 11, loc=means.mean(), scale=stats.sem(means))
    assert tuple(map(float, found)) == pytest.approx((means.mean(), low, high), rel=1e-6)


def test_ratio_of_unequal_clusters_is_cochrans() -> None:
    rng = np.random.default_rng(4)
    sizes = rng.integers(5, 40, 15)
    of = np.repeat(np.arange(15), sizes)
    y = rng.normal(5, 1, len(of)) + of * 0.1
    found = Clusters(of, 15, False).mean(y)
    totals = np.bincount(of, y)
    mean = totals.sum() / sizes.sum()
    # Cochran (2.39) with f = 0: v = Σ (y_c − R n_c)²/(C (C − 1) n̄²).
    variance = ((totals - mean * sizes) ** 2).sum() / (15 * 14 * sizes.mean() ** 2)
    half = stats.t.ppf(0.975, 14) * np.sqrt(variance)
    assert tuple(map(float, found)) == pytest.approx((mean, mean - half, mean + half), rel=1e-6)


def test_pieces_are_never_worth_more_than_they_are() -> None:
    # Each cluster has exactly half: its variance is zero, its pieces are not.
    clusters = Clusters(np.repeat(np.arange(10), 4), 10, False)
    found = clusters.shares(np.full((10, 1), 2.0))
    assert (float(found.low[0]), float(found.high[0])) == pytest.approx(
        wilson(0.5, 40, float(stats.t.ppf(0.975, 9))), rel=1e-9
    )


def test_quantiles_are_order_statistics() -> None:
    needed = np.random.default_rng(5).permutation(np.arange(1.0, 101.0))
    curve = ShareCurve(needed, alone(100))
    assert curve.quantiles((0.0, 0.005, 0.5, 0.9, 0.999, 1.0)).tolist() == [1, 1, 50, 90, 100, 100]
    value, low, high = curve.lengths((0.5,))
    assert value[0] == 50
    # Of a median of 100 the order statistics 40 and 61 hold 95 %.
    assert low[0] == pytest.approx(40, abs=1)
    assert high[0] == pytest.approx(61, abs=1)


def test_quantiles_beyond_the_heads_that_can_be_cut() -> None:
    # 5.1 % cannot be cut: that may be chance for 95 % of the heads, not for 99 %.
    needed = np.concatenate([np.linspace(0.1, 0.2, 9490), np.full(510, np.inf)])
    found = ShareCurve(needed, alone(10_000)).lengths((0.5, 0.95, 0.99))
    assert np.isinf(found.value).tolist() == [False, True, True]
    assert np.isinf(found.low).tolist() == [False, False, True]
    assert np.isinf(found.high).tolist() == [False, True, True]
    assert found.low[1] == pytest.approx(0.2, abs=0.001)
    none = ShareCurve(np.full(10, np.inf), alone(10)).lengths((0.5,))
    assert all(np.isinf(each[0]) for each in none)


def covered(entries: dict[str, object], truth: dict[str, float], seeds: int) -> dict[str, float]:
    small = machine('[topper.field]\nkind = "random"\n', **entries)
    hits = dict.fromkeys(truth, 0)
    for seed in range(seeds):
        found = topper_field(small, seed=1000 + seed).to_dict()
        for name, value in truth.items():
            if name.startswith("length"):
                low, high = (found[f"quantile_length_{end}"][1] for end in ("low", "high"))
            else:
                low, high = found[f"{name}_low"], found[f"{name}_high"]
            hits[name] += low <= value <= high
    return {name: count / seeds for name, count in hits.items()}


# Of 200 intervals of 95 %, as many as these hold the truth with 99.9 %; what is rounded up by Wilson holds it
# more often.
LEAST, MOST = 0.895, 1.0


def test_intervals_of_independent_heads_hold_the_truth() -> None:
    # A knife at rest over heads of one size: |δ| up to 20 mm needs (d + 2|δ|)/cos α; haulm by 4000 offsets.
    size = {"knife_speed": 0.0, "edge_length": 0.14, "field__roots": 300, "field__rows": 15}
    d, cos = 2 * np.sqrt(0.03 * 0.08), np.cos(np.radians(20))
    fine = topper_field(
        machine('[topper.field]\nkind = "random"\nroots = 200000\n', knife_speed=0.0, edge_length=0.14)
    )
    truth = {
        "share_complete": (0.14 * cos - d) / 0.04,
        "haulm_mean": fine.haulm_mean,
        "length_for_90": (d + 0.9 * 0.04) / cos,
    }
    for rate in covered(size, truth, 200).values():
        assert LEAST <= rate <= MOST


def test_intervals_of_locked_rows_hold_the_truth() -> None:
    # All roots of a row meet the knife in one phase; even phases and offsets give the truth.
    locked = {
        "field__spacing": 1.9 * 0.12 / 0.55,
        "field__roots": 600,
        "field__rows": 30,
        "edge_length": 0.17,
    }
    many = '[topper.field]\nkind = "random"\nroots = 200000\nrows = 1000\n'
    fine = topper_field(machine(many, edge_length=0.17))
    truth = {
        "share_complete": fine.share_complete,
        "haulm_mean": fine.haulm_mean,
        "length_for_90": fine.length_for_90,
    }
    rates = covered(locked, truth, 200)
    for rate in rates.values():
        assert LEAST <= rate <= MOST


def test_heads_of_locked_rows_are_worth_few() -> None:
    text = '[topper.field]\nkind = "random"\nrows = 50\nroots = 5000\noffset = 0\n'
    found = topper_field(machine(text, field__spacing=1.9 * 0.12 / 0.55, edge_length=0.16))
    # One phase and one size: a row is cut or is not, and 5000 heads are worth 50 rows.
    p = found.share_complete
    half = 0.5 * (found.share_complete_high - found.share_complete_low)
    assert (p * 50) == pytest.approx(round(p * 50), abs=1e-9)
    assert half == pytest.approx(2.01 * np.sqrt(p * (1 - p) / 49), rel=0.1)
