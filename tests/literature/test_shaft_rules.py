"""Permitted stresses of classification societies, against numbers printed or worked out by hand."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.torsion import ShaftLimit
from linkwright.torsion.model.permitted_stress import (
    DESIGN_FACTORS,
    barred_speeds,
    continuous_stress,
    counted_strength,
    crank_stress,
    crank_transient_stress,
    size_factor,
    speed_factor,
    transient_stress,
)

MPA = 1e6


def tau_c(strength: float, diameter: float, design: str, ratio: float) -> float:
    """τ_C in N/mm² of σ_B in N/mm² and d in mm."""
    factor = DESIGN_FACTORS[design]  # type: ignore[index]
    found = continuous_stress(strength * MPA, diameter / 1000, factor, np.array([ratio]))
    return float(found[0] / MPA)


# Worked by hand from IACS UR M68.5 with four figures: 300 mm: C_D = 0.35 + 0.93·0.31958 = 0.64721,
# (560 + 160)/18 = 40; 450 mm: 0.35 + 0.93·0.29470 = 0.62407, (600 + 160)/18 = 42.222.
@pytest.mark.parametrize(
    ("case", "wanted"),
    [
        ((560, 300, "flange", 0.5), 40 * 0.64721 * 2.5),
        ((560, 300, "flange", 0.0), 40 * 0.64721 * 3),
        ((560, 300, "flange", 0.9), 40 * 0.64721 * 1.38),
        ((560, 300, "flange", 1.05), 40 * 0.64721 * 1.38),
        ((600, 450, "propeller_shaft", 0.6), 42.222 * 0.55 * 0.62407 * 2.28),
        ((600, 450, "cylindrical_keyway", 0.8), 42.222 * 0.45 * 0.62407 * 1.72),
    ],
)
def test_continuous_stress_of_m68(case: tuple[float, float, str, float], wanted: float) -> None:
    # Four figures in the factors above.
    assert tau_c(*case) == pytest.approx(wanted, rel=1e-4)


def test_size_factor_of_one_millimetre_and_of_32() -> None:
    assert size_factor(1e-3) == pytest.approx(1.28)
    # 32^(−0.2) = ½.
    assert size_factor(32e-3) == pytest.approx(0.815)


def test_speed_factor_falls_without_a_jump_and_says_nothing_beyond() -> None:
    below, at = speed_factor(np.array([0.9 - 1e-12, 0.9]))
    # 3 − 2·0.81 = 1.38.
    assert below == pytest.approx(at, abs=1e-10)
    assert np.isnan(speed_factor(np.array([1.0500001]))[0])


def test_passing_permits_more_the_worse_the_notch() -> None:
    assert transient_stress(np.array([60.0]), 1.0)[0] == pytest.approx(102.0)
    assert transient_stress(np.array([60.0]), 0.25)[0] == pytest.approx(204.0)


@pytest.mark.parametrize(
    ("design", "factor"),
    [
        ("flange", 1.0),
        ("shrink_fit", 1.0),
        ("tapered_keyway", 0.6),
        ("cylindrical_keyway", 0.45),
        ("radial_hole", 0.5),
        ("slot", 0.3),
        ("thrust_collar", 0.85),
        ("roller_bearing", 0.85),
        ("propeller_shaft", 0.55),
        ("stern_tube_shaft", 0.8),
    ],
)
def test_table_of_design_factors(design: str, factor: float) -> None:
    """IACS UR M68, table of C_K; Korean Register part 5 chapter 4, table 5.4.1."""
    assert ShaftLimit(kind="iacs_m68", tensile_strength=5e8, design=design).shape_factor == factor


@pytest.mark.parametrize(
    ("strength", "steel", "design", "counted"),
    [
        (560e6, "carbon", "flange", 560e6),
        (760e6, "carbon", "flange", 600e6),
        (760e6, "alloy", "flange", 760e6),
        (900e6, "alloy", "thrust_collar", 800e6),
        (900e6, "alloy", "propeller_shaft", 600e6),
        (900e6, "alloy", "stern_tube_shaft", 600e6),
    ],
)
def test_strength_counts_up_to_its_limit(strength: float, steel: str, design: str, counted: float) -> None:
    assert counted_strength(strength, steel, design) == counted  # type: ignore[arg-type]


def test_barred_speeds_about_half_the_rated_speed() -> None:
    # λ = 0.5: 16·60/17.5 = 54.857, 17.5·60/16 = 65.625.
    assert barred_speeds(60.0, 120.0) == pytest.approx((54.857, 65.625), abs=5e-4)


def test_stresses_of_crankshafts() -> None:
    """Korean Register part 5 chapter 4, 201."""
    ratio = np.array([0.0, 0.5, 1.0, 1.15])
    # 21 + 237·0.35·√0.15 = 53.13.
    assert crank_stress(ratio, "even") / MPA == pytest.approx([45.0, 39.0, 21.0, 53.126], abs=1e-3)
    assert crank_stress(ratio, "other") / MPA == pytest.approx([45.0, 37.75, 16.0, 48.126], abs=1e-3)
    assert crank_transient_stress(ratio, "even")[1] / MPA == pytest.approx(78.0)
    assert np.isnan(crank_transient_stress(ratio, "even")[2])


def test_stronger_steel_of_crankshafts_bears_more() -> None:
    # 1 + ⅔·(550/440 − 1) = 7/6; 450/225 = 2.
    assert crank_stress(np.array([0.0]), "even", 550e6)[0] / MPA == pytest.approx(45 * 7 / 6)
    assert crank_transient_stress(np.array([0.0]), "even", 450e6)[0] / MPA == pytest.approx(180.0)
