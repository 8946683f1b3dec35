"""What the knife cuts of a head, for any law: against points swept one by one, and what must hold for all."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import pytest
from knife_sweep import (
    Knife,
    Law,
    Pass,
    dwell_rise_dwell_return,
    is_cut,
    lattice,
    length_by_bisection,
    lengths_of_points,
    needed_length,
    rim,
    slider_crank,
    to_and_fro,
    triangular,
    uncut_share,
    worst,
)

LAWS: dict[str, Law] = {
    "harmonic": np.sin,
    "triangular": triangular,
    "slider-crank": slider_crank(3.0),
    "short rod": slider_crank(1.6),
    "dwells": dwell_rise_dwell_return(0.12, 0.25),
}


@dataclass(frozen=True)
class Case:
    """One knife over one head, in mm, degrees and m/s; the phase in degrees."""

    law: str = "harmonic"
    stroke: float = 60.0
    knife_speed: float = 0.55
    angle: float = 20.0
    forward: float = 1.9
    diameter: float = 98.0
    offset: float = 20.0
    phase: float = 40.0

    def knife(self) -> Knife:
        law, angle = LAWS[self.law], math.radians(self.angle)
        return to_and_fro(law, self.stroke / 1000, self.knife_speed, angle, self.forward)

    def over(self) -> Pass:
        return Pass(self.knife(), self.diameter / 1000, self.offset / 1000, math.radians(self.phase))

    def all_phases(self) -> float:
        """(S + d + 2Δ)/cos α: the edge is long enough wherever the knife stands."""
        return (
            (self.stroke + self.diameter + 2 * abs(self.offset)) / 1000 / math.cos(math.radians(self.angle))
        )


ADVANCING = {
    "usual": Case(),
    "to and fro": Case("triangular", phase=75.0),
    "slider-crank": Case("slider-crank", angle=-30.0, offset=-15.0, phase=200.0),
    "dwells": Case("dwells", angle=35.0, phase=150.0),
    "straight": Case(angle=0.0, offset=0.0, phase=300.0),
    "ten strokes": Case("slider-crank", 12.0, 0.9, 25.0, 1.6, 120.0, -10.0, 10.0),
    "long stroke": Case("short rod", 200.0, 0.7, -15.0, 1.7, 80.0, 30.0, 260.0),
}
RETREATING = {
    "steep": Case(angle=70.0, knife_speed=0.8, phase=220.0),
    "steep, right end ahead": Case("slider-crank", angle=-72.0, knife_speed=0.8, offset=-20.0, phase=120.0),
    "quick": Case("triangular", 40.0, 1.8, 55.0, 1.2, 110.0, 0.0, 15.0),
    "quick, dwells": Case("dwells", 40.0, 1.0, 50.0, 1.2, 110.0, 12.0, 85.0),
    "hums": Case("harmonic", 8.0, 1.5, -60.0, 0.8, 70.0, 10.0, 90.0),
    "sways": Case("short rod", 250.0, 2.0, 60.0, 1.5, 60.0, 40.0, 330.0),
}
CASES = ADVANCING | RETREATING


# --- the brute force is sound ---------------------------------------------------------------------------------


@pytest.mark.parametrize("name", CASES)
def test_both_ways_of_sweeping_agree_point_by_point(name: str) -> None:
    over = CASES[name].over()
    points = lattice(over, 30)
    lengths = lengths_of_points(over, points)
    for length in np.quantile(lengths, [0.2, 0.6, 0.9]):
        # Where the straightened path is off by less than this, the parallelograms decide as the lengths do.
        clear = np.abs(lengths - length) > 2e-3 * length
        assert clear.mean() > 0.9
        wrong = is_cut(over, points, length) != (lengths <= length)
        assert (wrong & clear).sum() <= 1


@pytest.mark.parametrize("name", ["usual", "dwells", "steep", "sways"])
def test_both_ways_find_the_same_least_length(name: str) -> None:
    over = CASES[name].over()
    points = np.concatenate([lattice(over, 30), rim(over, 60)])
    expected = lengths_of_points(over, points).max()
    assert length_by_bisection(over, points) == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize("name", ADVANCING)
def test_worst_phase_of_an_advancing_edge_is_the_closed_form(name: str) -> None:
    case = ADVANCING[name]
    length, _ = worst(case.knife(), case.diameter / 1000, abs(case.offset) / 1000)
    assert length == pytest.approx(case.all_phases(), rel=1e-5)


@pytest.mark.parametrize("name", RETREATING)
def test_an_edge_that_retreats_needs_no_more_than_that(name: str) -> None:
    case = RETREATING[name]
    length, _ = worst(case.knife(), case.diameter / 1000, abs(case.offset) / 1000)
    assert case.diameter / 1000 < length <= case.all_phases() * (1 + 1e-9)
