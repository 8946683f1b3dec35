"""The reproduction of paper 5: what it concludes follows from numbers that are checked here."""

from __future__ import annotations

import json
import math
from html import unescape

import numpy as np
import pytest
from numpy.typing import NDArray

from linkwright.papers.page import page, shown
from linkwright.papers.paper5.paper import Paper5, _heads, paper5
from linkwright.papers.paper5.steps import exact_over, factors
from linkwright.topping import length_consistent, length_published, published_lengths


@pytest.fixture(scope="module")
def paper() -> Paper5:
    return paper5()


def test_step_in_closed_form(paper: Paper5) -> None:
    """(cos α + sin² α)/cos² α is 1 at 0, 1 + √2 at 45° and 5 at 60°."""
    assert factors(np.radians([0.0, 45.0, 60.0])) == pytest.approx([1, 1 + math.sqrt(2), 5], rel=1e-14)
    # A few roundings, over cos² α of the steepest angle.
    assert paper.step["identity"] < 1e-14
    assert paper.step["travel_identity"] < 1e-14
    assert paper.step["flips"]
    at = paper.step["angles"].tolist()
    cos, sin = np.cos(at), np.sin(at)
    np.testing.assert_allclose(paper.step["times"], cos**2 / (cos + sin**2), rtol=1e-14)
    np.testing.assert_allclose(paper.step["times"] * paper.step["factors"], 1, rtol=1e-14)


def test_difference_of_the_bounds(paper: Paper5) -> None:
    """As the conclusion has it: (v_h/v)(1 − cos α)(1 + 2 cos α)/cos α, at every angle and ratio."""
    alpha, ratio = np.meshgrid(np.radians(np.arange(0, 80, 1.0)), [0.1, 0.5, 2.0])
    apart = length_consistent(1.0, alpha, ratio) - length_published(1.0, alpha, ratio)
    cos = np.cos(alpha)
    np.testing.assert_allclose(apart, ratio * (1 - cos) * (1 + 2 * cos) / cos, atol=1e-13)
    assert "(1 − cos α)(1 + 2 cos α)/cos α" in paper.conclusions[0]


def test_condition_is_met_by_an_edge_that_covers_nothing() -> None:
    """A resting knife meets (1) as soon as L ≥ d sin α."""
    for alpha in np.radians([0.0, 20.0, 50.0]).tolist():
        assert published_lengths(0.1, alpha, 0.1 * math.sin(alpha) + 1e-12, 1.9, 0.0).holds


def test_too_short_for_every_knife_slower_than_the_machine() -> None:
    """The bound 2 cos² θ, at random; it is reached by a band that is all offset at α = 45° − θ."""
    at = np.random.default_rng(5).uniform(size=(3, 20_000))
    theta, alpha, share = at[0] * np.pi / 4, at[1] * np.pi / 2, at[2]
    over = exact_over(np.tan(theta), alpha, share)[0]
    assert (over >= 2 * np.cos(theta) ** 2 * (1 - 1e-12)).all()
    edge = math.radians(20.0)
    over, _ = exact_over(*(np.array([each]) for each in (math.tan(edge), math.radians(25.0), 1.0)))
    assert over[0] == pytest.approx(2 * math.cos(edge) ** 2, rel=1e-12)


def test_only_a_knife_faster_than_the_machine_makes_it_long_enough() -> None:
    over, _ = exact_over(*(np.array([each]) for each in (math.tan(math.radians(50.0)), 0.0, 1.0)))
    assert over[0] == pytest.approx(2 * math.cos(math.radians(50.0)) ** 2 / math.sin(math.radians(100.0)))
    assert over[0] < 1


def test_scan_finds_the_bound(paper: Paper5) -> None:
    short = paper.short
    # The grid is a quarter of a degree fine, the top flat.
    assert short["least"] == pytest.approx(short["bound"], rel=1e-4)
    assert short["least"] >= short["bound"]
    assert short["least_axis"] == pytest.approx(2 / math.sqrt(1.25), rel=1e-4)
    assert short["least_consistent"] > 1
    assert (short["across"], short["across_published"]) == (1.0, 0.0)


def _crossed(x: NDArray[np.float64], y: NDArray[np.float64], length: float, ratio: float) -> bool:
    """Whether an edge at 20° and v = 1 m/s cuts every point of a head, by when its line meets the point."""
    alpha = math.radians(20.0)
    # Middle of the edge at (t, ρt), its direction (sin α, cos α): the point lies on its line at the time t.
    t = (x * math.cos(alpha) - y * math.sin(alpha)) / (math.cos(alpha) - ratio * math.sin(alpha))
    along = (x - t) * math.sin(alpha) + (y - ratio * t) * math.cos(alpha)
    return bool((np.abs(along) <= length / 2).all())


def test_chosen_heads_point_by_point(paper: Paper5) -> None:
    """The exact length cuts all of the largest head at both offsets; a hair less, or (10), does not."""
    found = paper.verdict
    need = {each.way: each.length_greatest for each in found.chosen.demands}
    turn = np.linspace(0, 2 * np.pi, 100_001)
    d, offsets = found.diameters[1], (-found.offset, found.offset)
    heads = [(d / 2 * np.cos(turn), d / 2 * np.sin(turn) + each) for each in offsets]

    def all_crossed(length: float) -> bool:
        return all(_crossed(x, y, length, ratio) for x, y in heads for ratio in (0.5, -0.5))

    assert all_crossed(need["constant_speed"] * (1 + 1e-9))
    # An edge that is 1e-8 short misses an arc of some 1e-4 rad, wider than the points are apart.
    assert not all_crossed(need["constant_speed"] * (1 - 1e-8))
    assert not all_crossed(need["published"])


def test_figure_3_by_hand(paper: Paper5) -> None:
    """Its corner with the largest root and the fastest knife."""
    first = paper.surfaces[0]
    d = 2 * math.sqrt(0.03 * 0.17)
    cos, sin = math.cos(math.radians(20)), math.sin(math.radians(20))
    assert first.published[-1, -1] == pytest.approx((d + 0.04) * (0.5 * cos + sin), rel=1e-14)
    exact = (d * math.sqrt(1.25) + 0.04) / (cos - 0.5 * sin)
    assert first.exact[-1, -1] == pytest.approx(exact, rel=1e-14)
    for each in paper.surfaces:
        for lengths in (each.published, each.exact):
            assert (np.diff(lengths, axis=0) > 0).all()
            assert (np.diff(lengths, axis=1) > 0).all()
    for slow, fast in zip(paper.surfaces, paper.surfaces[1:], strict=False):
        assert (slow.published > fast.published).all()
        assert (slow.exact > fast.exact).all()


def test_verdict_in_closed_form(paper: Paper5) -> None:
    """(10) has its largest (d + 2Δ)√(1 + ρ²) at tan α = 1/ρ; its smallest over its largest is 5/6 where
    tan α = (5ρ_max/6 − ρ_min)/(1 − 5/6)."""
    found = paper.verdict
    # The angles of the scan are hundredths of a degree apart.
    assert found.least_band == pytest.approx(0.25 / math.sqrt(1.25), rel=1e-7)
    low, _ = found.throughout["published"]
    wanted = math.atan((5 / 6 * 0.5 - 0.3 / 2.2) * 6)
    assert wanted <= low <= wanted + math.radians(0.0101)
    assert "consistent" not in found.throughout
    start, end = found.throughout["constant_speed"]
    assert start == 0
    assert math.degrees(end) == pytest.approx(14.3, abs=0.05)


def test_offsets_put_back_into_lengths(paper: Paper5) -> None:
    """With the offsets of the table the largest head needs the lengths of the claim."""
    found, d = paper.verdict, paper.verdict.diameters[1]
    for row, verdict in enumerate(found.angles):
        a = verdict.edge_angle
        cos, sin = math.cos(a), math.sin(a)
        lengths = {
            "published": lambda delta, c=cos, s=sin: (d + 2 * delta) * (0.5 * c + s),
            "constant_speed": lambda delta, c=cos, s=sin: (d * 1.25**0.5 + 2 * delta) / (c - 0.5 * s),
            "every_phase": lambda delta, c=cos: (0.06 + d + 2 * delta) / c,
        }
        for way, length in lengths.items():
            told = [length(each) for each in found.offsets[way][row].tolist()]
            assert told == pytest.approx([0.25, 0.30], rel=1e-12)


def test_verdicts(paper: Paper5) -> None:
    rows = {row.name: row for row in paper.rows}
    assert rows["head diameter"].kind == "reproduced"
    assert rows["(3), (4) condition by travels"].kind == "reproduced"
    assert rows["(5) length, from (4)"].kind == "far"
    assert rows["result by (10)"].kind == "far"
    assert rows["result by the exact length"].kind == "near"
    assert "308…370 mm" in rows["result by (10)"].computed
    assert shown(_heads(-0.02, -0.01), ".0f mm") == "none"
    assert shown(_heads(-0.02, 0.01), ".0f mm") == "0…10 mm"


def test_everything_is_told(paper: Paper5) -> None:
    told = json.loads(json.dumps(paper.to_dict(), allow_nan=False))
    assert told["conclusions"] == paper.conclusions
    assert len(told["rows"]) == len(paper.rows)
    assert len(told["verdict"]["angles"]) == len(paper.published["verdict"]["angles"])
    drawn = paper.figures()
    assert list(drawn) == ["figure3", "step", "bands", "heads"]
    text = unescape(page(paper, drawn))
    assert text.count("<svg") == 4
    for row in paper.rows:
        assert row.verdict.split(",")[0] in text
    assert len(paper.tables) == 2
    for table in paper.tables:
        assert table.title in text
        assert all(f"<td>{cell.text}</td>" in text for line in table.rows for cell in line)
