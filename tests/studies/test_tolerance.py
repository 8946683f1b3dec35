"""Tolerances: linear and bent cases in closed form, yields, indices."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from command_line import invoke
from scipy.stats import norm

import linkwright as lw
from linkwright import InputError
from linkwright.kernel.arrays import Floats
from linkwright.studies import Distribution, StudyPlan
from linkwright.studies.axes import axis
from linkwright.studies.indices import intervals, of_blocks
from linkwright.studies.model import Variable

MACHINE = Path(__file__).parents[2] / "machines" / "roller_two_carts.toml"

# Two lengths add up; a third response is their product. σ = 1 mm and 2 mm.
TEXT = """
machine = "roller_two_carts"
[variables.a]
address = "mechanism.sliders.cart1.rod"
distribution = { kind = "normal", mean = "0.8 m", deviation = "1 mm" }
[variables.b]
address = "mechanism.sliders.cart2.rod"
distribution = { kind = "normal", mean = "0.8 m", deviation = "2 mm" }
[responses]
sum = { formula = "3*a + b" }
square = { formula = "1e6*(a - 0.8)^2" }
[constraints]
sum = { max = 3.205 }
"""


def plan_of(tmp_path: Path, text: str = TEXT) -> StudyPlan:
    (tmp_path / "study.toml").write_text(text)
    return lw.read_study(tmp_path / "study.toml")


MOMENTS = {
    # Johnson, Kotz, Balakrishnan, *Continuous Univariate Distributions*, 2nd ed. 1994 and 1995.
    "normal": ('{ kind = "normal", mean = 450, deviation = 10 }', 450.0, 10.0),
    "lognormal": ('{ kind = "lognormal", mean = 1000, deviation = 1500 }', 1000.0, 1500.0),
    "uniform": ('{ kind = "uniform", min = 2, max = 3 }', 2.5, 12**-0.5),
}


@pytest.mark.parametrize("kind", MOMENTS)
def test_mean_and_deviation_are_those_that_were_given(kind: str) -> None:
    import tomllib

    text, mean, deviation = MOMENTS[kind]
    given = tomllib.loads(f"it = {text}")["it"]
    variable = Variable(address="bodies.cart1.mass", distribution=Distribution(**given))
    found = axis(lw.read(MACHINE), "mass", variable).moments()
    # The rule by which they are integrated is good to 1e-9.
    assert found == pytest.approx((mean, deviation), rel=1e-9)


def test_a_sum(tmp_path: Path) -> None:
    found = lw.tolerance(plan_of(tmp_path), 40_000, indices=4000)
    each, deviation = found.responses["sum"], np.hypot(3e-3, 2e-3)
    assert each["middle"] == pytest.approx(3.2, abs=1e-9)
    # Deviations of the cut tables of quantiles: 2000 strata miss 0.1 % of them.
    assert each["deviation_first_order"] == pytest.approx(deviation, rel=2e-3)
    # Standard error of a deviation from n rows: 1/√(2n) = 0.35 %; four of them.
    assert each["deviation"] == pytest.approx(deviation, rel=0.015)
    assert found.contributions["sum"]["a"] == pytest.approx(9 / 13, rel=2e-3)
    assert found.slopes["sum"] == pytest.approx({"a": 3.0, "b": 1.0}, rel=1e-9)
    wanted = norm.cdf(5e-3 / deviation)
    assert found.share_low < wanted < found.share_high
    assert found.share_high - found.share_low < 0.01
    # Indices of a sum are the shares of its variance; their errors fall as 1/√4000.
    first, total = found.indices["sum"]["a"]
    assert first == pytest.approx(9 / 13, abs=0.08)
    assert total == pytest.approx(9 / 13, abs=0.08)


def test_the_mean_of_a_square_is_its_second_order(tmp_path: Path) -> None:
    """z² of a standard normal z: mean 1, and nothing to first order."""
    found = lw.tolerance(plan_of(tmp_path), 40_000).responses["square"]
    assert found["mean_shift_second_order"] == pytest.approx(1.0, rel=5e-3)
    # Standard error √(2/n) = 0.7 %; four of them.
    assert found["mean"] == pytest.approx(1.0, rel=0.03)
    assert found["deviation_first_order"] == pytest.approx(0.0, abs=1e-9)


def test_limits_of_a_tolerance(tmp_path: Path) -> None:
    text = TEXT.replace('distribution = { kind = "normal", mean = "0.8 m", deviation = "1 mm" }', "X", 1)
    for given, low, high in (
        ("± 0.6 mm", 0.7994, 0.8006),
        ("+0.1 -0.3 mm", 0.7997, 0.8001),
        ("+0.1/-0.3 mm", 0.7997, 0.8001),
        ("0/-0.3 mm", 0.7997, 0.8),
        ("+1e-1/-3e-1 mm", 0.7997, 0.8001),
        ("0.8 m ± 0.6 mm", 0.7994, 0.8006),
        ("800 mm +0.1 −0.3 mm", 0.7997, 0.8001),
        ("800 ± 0.6 mm", 0.7994, 0.8006),
        ("0.8 ± 0.0006", 0.7994, 0.8006),
    ):
        axis = plan_of(tmp_path, text.replace("X", f'tolerance = "{given}"')).axes[0]
        assert (axis.low, axis.high) == pytest.approx((low, high), abs=1e-15)
        values = axis.values(np.linspace(0, 1, 1001))
        # Rounding of the sum of value and limit.
        assert values.min() >= low - 1e-15
        assert values.max() <= high + 1e-15
        assert values.mean() == pytest.approx((low + high) / 2, abs=1e-12)
    for wrong in ("0.6 mm", "0.7 m ± 0.6 mm", "0.8 ± 0.6 mm", "0.8 kg ± 0.6 mm", "± 0.6 kg", "± 0 mm"):
        with pytest.raises(InputError, match=r"variables\.a\.tolerance"):
            plan_of(tmp_path, text.replace("X", f'tolerance = "{wrong}"'))


@pytest.mark.parametrize(
    ("given", "found", "told"),
    [
        ('tolerance = "810 ± 0.2 mm"', '"810 ± 0.2 mm"', "the size that the machine has, 800 mm"),
        ('tolerance = "81 cm ± 0.2 mm"', '"81 cm ± 0.2 mm"', "the size that the machine has, 80 cm"),
        ('tolerance = "0.9 ± 0.2"', '"0.9 ± 0.2"', "the size that the machine has, 0.8\n"),
        ('tolerance = "31.5 in ± 0.01 in"', '"31.5 in ± 0.01 in"', "has, 31.49606299 in"),
        ('tolerance = "0 mm ± 0.2 mm"', '"0 mm ± 0.2 mm"', "the size that the machine has, 0.8 m"),
        ('tolerance = "0.8 m ± 0.2 kg"', '"0.8 m ± 0.2 kg"', '"kg" is a unit of mass'),
        ('tolerance = "+0.1 -0.3 kg"', '"+0.1 -0.3 kg"', '"kg" is a unit of mass'),
        ('tolerance = "± 0,2 mm"', '"± 0,2 mm"', "write the decimal point as a point"),
        ('tolerance = "0,8 m ± 0.2 mm"', '"0,8 m ± 0.2 mm"', "write the decimal point as a point"),
        ('range = ["900 mm", "80 cm"]', '"900 mm" to "80 cm"', "a minimum below the maximum"),
        (
            'distribution = { kind = "uniform", min = "9 mm", max = "8 mm" }',
            '"8 mm"',
            'more than `min`, "9 mm"',
        ),
        (
            'distribution = { kind = "triangular", min = "7 mm", mean = "9 mm", max = "8 mm" }',
            '"9 mm"',
            '"7 mm" to "8 mm"',
        ),
        ('distribution = { kind = "normal", mean = "9 mm", deviation = "-1 mm" }', '"-1 mm"', "more than 0"),
        (
            'range = ["1 m", "2 m"]\n[constraints]\nx = { min = "9 mm", max = "8 mm" }',
            '"9 mm" to "8 mm"',
            "min",
        ),
    ],
)
def test_what_is_wrong_is_told_as_it_is_written(given: str, found: str, told: str, tmp_path: Path) -> None:
    """In the units of the user, and all of a text."""
    text = """
machine = "roller_one_cart"
[responses]
x = { curve = "motion.cart1.x", extreme = "max" }
[variables.rod]
address = "mechanism.sliders.cart1.rod"
"""
    with pytest.raises(InputError) as caught:
        plan_of(tmp_path, text + given)
    message = f"{caught.value}\n"
    assert f"found:    {found}\n" in message
    assert told in message


@pytest.mark.parametrize(
    ("address", "given", "low", "high"),
    [
        ("drive.gearbox.ratio", "± 1 %", 9.702, 9.898),
        ("drive.gearbox.ratio", "± 0.01", 9.79, 9.81),
        ("drive.gearbox.efficiency", "± 1 %", 0.891, 0.909),
        ("drive.gearbox.efficiency", "+1 -2 %", 0.882, 0.909),
        ("drive.gearbox.efficiency", "90 % ± 0.01", 0.89, 0.91),
        ("mechanism.sliders.cart1.rod", "0.8 m ± 1 %", 0.792, 0.808),
        ("mechanism.sliders.cart1.rod", "± 200 ppm", 0.79984, 0.80016),
        ("bodies.cart1.mass", "± 10 %", 900.0, 1100.0),
    ],
)
def test_percent_is_of_the_value_of_any_quantity(address: str, given: str, low: float, high: float) -> None:
    one = axis(lw.read(MACHINE), "x", Variable(address=(address,), tolerance=given))
    assert (one.low, one.high) == pytest.approx((low, high), rel=1e-12)


@pytest.mark.parametrize("size", ["90 %", "90", "0.95"])
def test_percent_of_a_size_in_percent_is_refused(size: str) -> None:
    """One hundredth of 90 %, or from 89 to 91 %?"""
    given = Variable(address=("drive.gearbox.efficiency",), tolerance=f"{size} ± 1 %")
    with pytest.raises(InputError, match=r"variables\.x\.tolerance"):
        axis(lw.read(MACHINE), "x", given)


@pytest.mark.parametrize(
    ("entry", "key", "given"),
    [
        ("mechanism.sliders.cart1.rod", "tolerance", '"0.8 m ± 1 furlong"'),
        ("mechanism.sliders.cart1.rod", "tolerance", '"± 100 %"'),
        ("mechanism.sliders.cart1.rod", "clearance", '"1.6 m"'),
        ("drive.gearbox.efficiency", "tolerance", '"± 20 %"'),
        ("drive.gearbox.efficiency", "distribution.max", "1.1"),
        ("bodies.cart1.mass", "distribution.min", '"-1 kg"'),
    ],
)
def test_limits_beyond_the_range_of_an_entry_are_refused(
    entry: str, key: str, given: str, tmp_path: Path
) -> None:
    """A rod of negative length is in no worst case."""
    first, _, end = key.partition(".")
    value = f'{{ kind = "normal", mean = 0.9, deviation = 1, {end} = {given} }}' if end else given
    text = f"""
machine = "roller_two_carts"
[variables.x]
address = "{entry}"
{first} = {value}
[responses]
y = {{ formula = "x" }}
"""
    with pytest.raises(InputError) as caught:
        plan_of(tmp_path, text)
    message = str(caught.value)
    assert f"study.toml:5: variables.x.{key}" in message
    assert given in message
    assert "expected:" in message


def test_ends_of_a_distribution_may_touch_the_range_of_an_entry() -> None:
    given = {"kind": "uniform", "least": "0 kg", "greatest": "2 t"}
    one = axis(
        lw.read(MACHINE), "x", Variable(address=("bodies.cart1.mass",), distribution=Distribution(**given))
    )
    assert (one.low, one.high) == (0.0, 2000.0)


def test_the_result_echoes_the_limits(tmp_path: Path) -> None:
    text = TEXT.replace('distribution = { kind = "normal", mean = "0.8 m", deviation = "1 mm" }', "X", 1)
    (tmp_path / "study.toml").write_text(text.replace("X", 'tolerance = "± 1 %"'))
    found = lw.tolerance(lw.read_study(tmp_path / "study.toml"), 100).variables
    assert (found["a"]["low"], found["a"]["high"]) == pytest.approx((0.792, 0.808), rel=1e-12)
    assert found["a"]["mean"] == pytest.approx(0.8, rel=1e-12)
    assert found["b"]["deviation"] == pytest.approx(2e-3, rel=2e-3)
    told = invoke("tolerance", tmp_path / "study.toml", "--rows", "100")
    (row,) = (line.split() for line in told.stdout.splitlines() if line.split()[:1] == ["a"])
    assert row[1:3] + row[5:] == ["0.8", "m", "−0.008", "m", "0.008", "m"]


def test_a_tolerance_of_a_size_below_zero() -> None:
    machine = lw.read(MACHINE, {"mechanism.cranks.A2.phase": "-90 deg"})
    for given in ("-90 deg ± 1 deg", "−90 ± 1 deg", "-90 deg +1 -1 deg"):
        one = axis(machine, "phase", Variable(address=("mechanism.cranks.A2.phase",), tolerance=given))
        assert np.degrees([one.low, one.high]) == pytest.approx([-91.0, -89.0], abs=1e-12)


def test_worst_case_holds_all(tmp_path: Path) -> None:
    text = TEXT.replace('distribution = { kind = "normal", mean = "0.8 m", deviation = "1 mm" }', "X", 1)
    text = text.replace('distribution = { kind = "normal", mean = "0.8 m", deviation = "2 mm" }', "X", 1)
    plan = plan_of(tmp_path, text.replace("X", 'tolerance = "± 1 mm"'))
    each = lw.tolerance(plan, 2000).responses["sum"]
    assert each["worst_low"] == pytest.approx(3.196, abs=1e-9)
    assert each["worst_high"] == pytest.approx(3.204, abs=1e-9)
    assert each["worst_low"] < each["band_low"] < each["band_high"] < each["worst_high"]


def test_tolerance_and_clearance_of_one_length_add_up(tmp_path: Path) -> None:
    """Variances add; the ends too. The sum against a million sums of both."""
    text = TEXT.replace('distribution = { kind = "normal", mean = "0.8 m", deviation = "1 mm" }', "X", 1)
    both = 'tolerance = "± 0.3 mm"\nclearance = "0.4 mm"'
    axis = plan_of(tmp_path, text.replace("X", both)).axes[0]
    assert (axis.low, axis.high) == pytest.approx((0.7995, 0.8005), abs=1e-15)
    shares = (np.arange(20_000) + 0.5) / 20_000
    values = axis.values(shares)
    # Normal, of which 0.27 % are sorted out, and an arcsine.
    rng = np.random.default_rng(1)
    length = rng.normal(0.0, 0.1e-3, 1_000_000)
    length = length[np.abs(length) <= 0.3e-3]
    sums = np.sort(0.8 + length + 0.2e-3 * np.cos(rng.uniform(0, 2 * np.pi, len(length))))
    assert values.mean() == pytest.approx(0.8, abs=1e-10)
    assert values.std() == pytest.approx(np.hypot(length.std(), 0.2e-3 / np.sqrt(2)), rel=3e-3)
    # A share of a million is known to 5e-4, and the density is above 5e2 per metre there.
    picked = values[[1000, 5000, 10_000, 19_000]]
    expected = sums[(np.array([1000.5, 5000.5, 10_000.5, 19_000.5]) / 20_000 * len(sums)).astype(int)]
    np.testing.assert_allclose(picked, expected, atol=2e-6)
    with pytest.raises(InputError, match="nothing beside clearance"):
        plan_of(tmp_path, text.replace("X", f"{both}\ncost = 2"))


def test_joint_clearance_as_a_tolerance(tmp_path: Path) -> None:
    """Half the clearance times a cosine: σ = c/(2√2); 25 H7/g6 has 0.021/2 + 0.007 + 0.013/2 = 0.024 mm."""
    text = TEXT.replace('distribution = { kind = "normal", mean = "0.8 m", deviation = "1 mm" }', "X", 1)
    for given, clearance in (("0.05 mm", 0.05e-3), ("25 H7/g6", 0.024e-3)):
        plan = plan_of(tmp_path, text.replace("X", f'clearance = "{given}"'))
        axis = plan.axes[0]
        assert (axis.low, axis.high) == pytest.approx((0.8 - clearance / 2, 0.8 + clearance / 2), abs=1e-15)
        shares = (np.arange(20_000) + 0.5) / 20_000
        values = axis.values(shares)
        assert values.mean() == pytest.approx(0.8, abs=1e-12)
        # 20 000 strata miss 1e-8 of an integral that has a root at both ends.
        assert values.std() == pytest.approx(clearance / np.sqrt(8), rel=1e-4)
        worst = lw.tolerance(plan, 2000).responses["sum"]
        assert worst["deviation_first_order"] == pytest.approx(
            np.hypot(3 * clearance / np.sqrt(8), 2e-3), rel=2e-3
        )
    for wrong, message in (
        ("0 mm", "more than 0"),
        ("25 H7/p6", "a clearance fit"),
        ("25 H7/k6", "clearance fit"),
        ("1 kg", "unit of mass"),
    ):
        with pytest.raises(InputError, match=message):
            plan_of(tmp_path, text.replace("X", f'clearance = "{wrong}"'))


def test_what_is_not_linear_is_told(tmp_path: Path) -> None:
    """A square at its bottom scatters, and to first order does not; a sum is linear."""
    found = lw.tolerance(plan_of(tmp_path), 2000)
    assert found.bent == ("square",)
    told = invoke("tolerance", tmp_path / "study.toml", "--rows", "2000")
    assert "square is not linear within the tolerances" in " ".join(told.stdout.split())
    fixed = TEXT.replace("1e6*(a - 0.8)^2", "2 + 0*a")
    assert lw.tolerance(plan_of(tmp_path, fixed), 2000).bent == ()


def test_indices_of_failures(tmp_path: Path) -> None:
    """A machine has no result where a is above its mean, whatever b is: a decides alone."""
    found = lw.tolerance(
        plan_of(tmp_path, TEXT.replace("1e6*(a - 0.8)^2", "1 + 0*sqrt(0.801 - a)")), indices=2000
    )
    share = norm.cdf(1.0)
    # A block has two values of a, of which one in three rows stands twice.
    assert found.n_dropped / 2000 == pytest.approx(1 - share**2, abs=4 * np.sqrt(0.25 / 2000))
    first, total = found.failure_indices["a"]
    assert (first, total) == pytest.approx((1.0, 1.0), abs=0.12)
    assert found.failure_indices["b"] == pytest.approx((0.0, 0.0), abs=0.12)
    told = invoke("tolerance", tmp_path / "study.toml", "--rows", "500", "--indices", "200")
    assert "of 200 blocks are omitted" in " ".join(told.stdout.split())
    assert "a has the most influence on whether it has one" in " ".join(told.stdout.split())


def test_the_size_that_is_told_is_accepted(tmp_path: Path) -> None:
    """Rounded further it was refused again: 1000 rpm where 1000 rpm was expected."""
    text = """
machine = "roller_two_carts"
[responses]
delta = "steady_state.unevenness"
[variables.speed]
address = "drive.motor.speed_synchronous"
tolerance = "SIZE ± 1 rpm"
"""
    with pytest.raises(InputError) as caught:
        plan_of(tmp_path, text.replace("SIZE", "1000 rpm"))
    told = re.search(r"the size that the machine has, (.* rpm)", str(caught.value))
    assert told is not None
    plan = plan_of(tmp_path, text.replace("SIZE", told[1]))
    assert plan.axes[0].low < 104.72 < plan.axes[0].high


def covered(f: Callable[[Floats], Floats], truth: list[tuple[float, float]], blocks: int) -> Floats:
    """Share of 2000 repetitions whose intervals at 95 % hold the closed-form indices, (variables, 2)."""
    n, d = 2000, len(truth)
    hits = np.zeros((d, 2))
    for seed in range(n):
        z = np.random.default_rng(seed).normal(size=(2, d, blocks))
        rows = [z[0], z[1], *(np.where(np.eye(d)[i][:, None] > 0, z[1], z[0]) for i in range(d))]
        names = [str(i) for i in range(d)]
        found = intervals(of_blocks(names, np.array([f(row) for row in rows]), 0.95))
        for i, name in enumerate(names):
            hits[i] += [low <= one <= high for one, (low, high) in zip(truth[i], found[name], strict=True)]
    return hits / n


@pytest.mark.parametrize("shift", [0.0, 100.0])
def test_intervals_of_indices_hold_the_truth_at_their_level(shift: float) -> None:
    """3 z₁ + z₂: 9/10 and 1/10. (1 + z₁)(1 + z₂): of the variance 3 each alone has 1, both together 1."""
    # 2000 repetitions scatter by 0.005; four of them, and 0.015 for intervals that hold to first order.
    sums = covered(lambda z: shift + 3 * z[0] + z[1], [(0.9, 0.9), (0.1, 0.1)], 500)
    np.testing.assert_allclose(sums, 0.95, atol=0.02)
    products = covered(lambda z: shift + (1 + z[0]) * (1 + z[1]), [(1 / 3, 2 / 3)] * 2, 1000)
    np.testing.assert_allclose(products, 0.95, atol=0.035)


def test_intervals_of_indices_in_a_study(tmp_path: Path) -> None:
    """A sum and a product by formulas; in four fifths of the blocks all rows have an answer."""
    product = "(1 + (a - 0.8)/1e-3)*(1 + (b - 0.8)/2e-3)"
    plan = plan_of(tmp_path, TEXT.replace("1e6*(a - 0.8)^2", product))
    truth = {"sum": {"a": (9 / 13, 9 / 13), "b": (4 / 13, 4 / 13)}}
    truth["square"] = dict.fromkeys("ab", (1 / 3, 2 / 3))
    hits = []
    for seed in range(40):
        found = lw.tolerance(plan, 50, seed=seed, indices=400)
        hits += [
            low <= one <= high
            for name, variables in truth.items()
            for variable, pair in variables.items()
            for one, (low, high) in zip(pair, found.index_intervals[name][variable], strict=True)
        ]
    # Eight intervals of a run share its blocks: 40 independent runs scatter by 0.034 at most.
    assert np.mean(hits) == pytest.approx(0.95, abs=4 * 0.034 / np.sqrt(2))
    wide = lw.tolerance(plan, 50, indices=400, level=0.99).index_intervals["sum"]["a"][0]
    close = lw.tolerance(plan, 50, indices=400, level=0.9).index_intervals["sum"]["a"][0]
    assert (wide[1] - wide[0]) / (close[1] - close[0]) == pytest.approx(2.576 / 1.645, rel=0.01)


def test_blocks_with_a_failed_row_are_dropped_whole(tmp_path: Path) -> None:
    """Of a sum where b has to stay below its mean + σ: its indices are those with b cut off there."""
    plan = plan_of(tmp_path, TEXT.replace("1e6*(a - 0.8)^2", "3*a + b + 0*sqrt(0.802 - b)"))
    # Variance of a standard normal number below 1: 1 − φ(1)/Φ(1) − (φ(1)/Φ(1))².
    ratio = norm.pdf(1.0) / norm.cdf(1.0)
    share = 9 / (9 + 4 * (1 - ratio - ratio**2))
    hits = []
    for seed in range(60):
        found = lw.tolerance(plan, 50, seed=seed, indices=400)
        assert found.n_dropped > 0
        hits += [low <= share <= high for low, high in found.index_intervals["square"]["a"]]
        assert set(found.failure_index_intervals) == {"a", "b"}
    # 60 runs scatter by 0.028; four of them.
    assert np.mean(hits) == pytest.approx(0.95, abs=0.11)


def test_the_table_gives_half_the_intervals(tmp_path: Path) -> None:
    plan_of(tmp_path, TEXT)
    words = ["tolerance", str(tmp_path / "study.toml"), "--rows", "100", "--indices", "500"]
    told = invoke(*words)
    assert "at a level of 95 %" in told.stdout
    assert re.search(r"0\.\d+ ± 0\.\d+ +0\.\d+ ± 0\.\d+", told.stdout), told.stdout
    found = json.loads(invoke(*words, "--json").stdout)["results"]["tolerance"]
    (low, high), _ = found["index_intervals"]["sum"]["a"]
    assert low < found["indices"]["sum"]["a"][0] < high
