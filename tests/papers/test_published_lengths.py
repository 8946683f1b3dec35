"""For which heads a length does: bands put back into all speeds, closed limits, phases by the core."""

from __future__ import annotations

import json

import numpy as np
import pytest
from numpy.typing import NDArray

from linkwright import length_verdict, loads
from linkwright.papers.published_lengths import PAPER, WAYS, Claim, Stroke, bands_of, lengths_over
from linkwright.topping import (
    Edge,
    Knife,
    constant_speed_lengths,
    knives,
    length_consistent,
    length_published,
)
from linkwright.topping.coverage import coverage

Floats = NDArray[np.float64]

# α, d, Δ: with and without offset, both signs of the angle.
HEADS = [(0.0, 0.1, 0.02), (0.35, 0.14, 0.0), (-0.6, 0.09, 0.03), (0.9, 0.05, 0.001)]


def _by_all_speeds(way: str, alpha: float, d: float, delta: float) -> Floats:
    v, v_h = np.meshgrid(np.linspace(*PAPER.forward_speeds, 25), np.linspace(*PAPER.knife_speeds, 25))
    if way == "constant_speed":
        return constant_speed_lengths(d, delta, alpha, v, v_h).max(axis=0)
    bound = {"published": length_published, "consistent": length_consistent}[way]
    return bound(d + 2 * delta, alpha, v_h / v)


@pytest.mark.parametrize("way", ["published", "consistent", "constant_speed"])
@pytest.mark.parametrize("head", HEADS)
def test_extremes_by_all_speeds(way: str, head: tuple[float, float, float]) -> None:
    """All lengths are homogeneous in the speeds, so that the corners of the box are its extremes."""
    found = lengths_over(PAPER, way, *head)
    grid = _by_all_speeds(way, *head)
    assert found.tolist() == pytest.approx([grid.min(), grid.max()], rel=1e-12)


@pytest.mark.parametrize("way", list(WAYS))
@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_bands_put_back_give_the_claim(way: str, share: float) -> None:
    stroke = Stroke(0.06, np.pi / 2)
    alpha = np.radians([-40.0, 0.0, 10.0, 25.0, 45.0])
    for length, band in zip(PAPER.lengths, bands_of(PAPER, way, alpha, share, stroke), strict=True):
        assert (band > 0).all()
        back = lengths_over(PAPER, way, alpha, band * (1 - share), 0.5 * band * share, stroke)[1]
        np.testing.assert_allclose(back, length, rtol=1e-12)


def test_printed_bound_at_rest_and_slope() -> None:
    """(10) for all of the band: L/b = (v_h/v) cos α + sin α, with v_h/v = 0.8/1.6."""
    bands = bands_of(PAPER, "published", np.radians([0.0, 30.0]), 0.0)
    assert bands[0] == pytest.approx([0.5, 0.25 / (0.25 * 3**0.5 + 0.5)], rel=1e-14)
    assert bands[1] == pytest.approx([0.6, 0.30 / (0.25 * 3**0.5 + 0.5)], rel=1e-14)


def test_no_edge_does_where_it_moves_along_itself() -> None:
    """At α with v_h tan α = v for speeds of the box no length is enough; beside it one is."""
    alpha = np.arctan([1 / 0.49, 1 / 0.51])
    greatest = lengths_over(PAPER, "constant_speed", alpha, 0.1, 0.02)[1]
    assert greatest[0] == np.inf
    assert np.isfinite(greatest[1])
    assert bands_of(PAPER, "constant_speed", alpha, 0.3)[:, 0].tolist() == [0.0, 0.0]
    told = length_verdict(PAPER, float(alpha[0]), 0.1, 0.02).ways
    assert told[2]["length_greatest"] is None
    assert not told[2]["holds"]
    json.dumps(told, allow_nan=False)


def test_edge_that_retreats_at_all_speeds() -> None:
    """Beyond the singular ratio the slowest knife needs the longest edge."""
    claim = Claim((1.0, 1.0), (2.0, 4.0), (0.1, 0.2))
    least, greatest = lengths_over(claim, "constant_speed", 1.2, 0.1, 0.02).tolist()
    ends = [float(constant_speed_lengths(0.1, 0.02, 1.2, 1.0, v_h).max()) for v_h in (2.0, 4.0)]
    assert (greatest, least) == pytest.approx(tuple(ends), rel=1e-14)
    assert greatest > least


def test_every_phase_by_the_heads_themselves() -> None:
    """The worst of many phases of a harmonic knife, by the core, nears (S + d + 2Δ)/cos α from below."""
    alpha, d, delta, S = np.radians(15.0), 0.1, 0.02, 0.06
    phases = np.linspace(0, 2 * np.pi, 20_001)
    edge = Edge(_harmonic(S, 0.55), float(alpha), 1.9)
    needed = max(float(coverage(edge, d, each, phases).length_needed.max()) for each in (-delta, delta))
    formula = lengths_over(PAPER, "every_phase", alpha, d, delta, Stroke(S, np.pi / 2))
    assert formula.tolist() == pytest.approx([(S + d + 2 * delta) / np.cos(alpha)] * 2, rel=1e-14)
    # 3e-4 rad from the worst phase take its square off.
    assert needed == pytest.approx(float(formula[1]), rel=1e-6)
    assert needed <= float(formula[1]) * (1 + 1e-12)


def _harmonic(stroke: float, speed: float) -> Knife:
    machine = loads(
        f"""
format = 1
name = "topper"
[topper]
root_diameter = "110 mm"
cut_height = "30 mm"
offset = "20 mm"
edge_angle = "15 deg"
edge_length = "0.28 m"
forward_speed = "1.9 m/s"
knife_speed = "{speed} m/s"
[topper.motion]
kind = "harmonic"
stroke = "{stroke} m"
"""
    )
    (knife,) = knives(machine, machine.topper)
    return knife


def test_every_phase_only_while_the_edge_advances() -> None:
    """A harmonic knife is π/2 times as fast as its mean: tan α < 2/(π 0.5)."""
    limit = np.degrees(np.arctan(4 / np.pi))
    alpha = np.radians([limit - 0.01, limit + 0.01])
    found = lengths_over(PAPER, "every_phase", alpha, 0.1, 0.0, Stroke(0.06, np.pi / 2))[1]
    assert np.isfinite(found).tolist() == [True, False]
    constant = lengths_over(PAPER, "every_phase", alpha, 0.1, 0.0, Stroke(0.06))[1]
    assert np.isfinite(constant).all()


def test_stroke_longer_than_the_claim() -> None:
    """A stroke that takes all of the length leaves no band."""
    assert bands_of(PAPER, "every_phase", 0.3, 0.0, Stroke(0.4)).tolist() == [0.0, 0.0]
    with pytest.raises(ValueError, match="stroke"):
        lengths_over(PAPER, "every_phase", 0.3, 0.1, 0.0)


def test_verdict_says_what_holds() -> None:
    """By hand at α = 0: exact 0.2 √1.25 + 0.04 = 0.2636 m, at the minimum 0.2 √(1 + ρ²) + 0.04."""
    found = length_verdict(PAPER, 0.0, 0.2, 0.02)
    assert [each.way for each in found.demands] == ["published", "consistent", "constant_speed"]
    printed, _, exact = found.demands
    rho = 0.3 / 2.2
    assert exact.length_greatest == pytest.approx(0.2 * 1.25**0.5 + 0.04, rel=1e-14)
    assert exact.length_least == pytest.approx(0.2 * (1 + rho**2) ** 0.5 + 0.04, rel=1e-14)
    assert (exact.holds, exact.holds_throughout) == (True, False)
    assert not printed.holds
    assert found.band == pytest.approx(0.24)
    assert exact.band_low < found.band < exact.band_high
    narrow = length_verdict(Claim((1.9, 2.0), (0.3, 0.3), (0.23, 0.25)), 0.0, 0.2, 0.02).demands[2]
    assert narrow.holds_throughout
