"""The library: laws begin and end as promised, and are what their sources say."""

from __future__ import annotations

import math
from typing import get_args

import numpy as np
import pytest

from linkwright import LawError
from linkwright.cam import LAWS, Boundary, PlainLaw, modified_sine, modified_trapezoid, polynomial, ramp_of
from linkwright.cam.laws.boundary import is_symmetric
from linkwright.cam.laws.polynomial import polynomial_3_4_5, polynomial_4_5_6_7
from linkwright.cam.laws.ramps import RAMPS, s_curve, start_and_stop, trapezoidal_velocity
from linkwright.cam.model.motion_law import CombinedLaw
from linkwright.cam.model.motion_section import AnyLaw
from linkwright.kernel.description.schema_walk import kinds_of

Z = np.linspace(0.0, 1.0, 101)
# Rounding of a sum of ten terms of the size of the law.
EXACT = 4e-15
FROM_REST = [name for name in LAWS if name != "constant_velocity"]


@pytest.mark.parametrize("name", LAWS)
def test_from_zero_to_one(name: str) -> None:
    law = LAWS[name].normalised()
    assert (law.start, law.end) == (0.0, 1.0)
    assert float(law.at(0.0)) == pytest.approx(0.0, abs=EXACT)
    assert float(law.at(1.0)) == pytest.approx(1.0, abs=EXACT)
    assert np.abs(law.jumps(0)).max(initial=0.0) < EXACT


@pytest.mark.parametrize("name", FROM_REST)
def test_from_rest_to_rest(name: str) -> None:
    law = LAWS[name].normalised()
    assert abs(float(law.at(0.0, 1))) < EXACT
    assert abs(float(law.at(1.0, 1, "before"))) < EXACT
    assert np.abs(law.jumps(1)).max(initial=0.0) < 2 * EXACT


@pytest.mark.parametrize("name", [name for name in LAWS if name != "double_harmonic"])
def test_symmetric_about_the_middle(name: str) -> None:
    law = LAWS[name].normalised()
    assert is_symmetric(law)
    np.testing.assert_allclose(law.at(Z) + law.at(1 - Z), 1.0, atol=EXACT)


def test_the_double_harmonic_is_not_symmetric() -> None:
    assert not is_symmetric(LAWS["double_harmonic"].normalised())


def test_closed_forms() -> None:
    expected = {
        "cycloidal": Z - np.sin(2 * np.pi * Z) / (2 * np.pi),
        "harmonic": (1 - np.cos(np.pi * Z)) / 2,
        "double_harmonic": (1 - np.cos(np.pi * Z)) / 2 - (1 - np.cos(2 * np.pi * Z)) / 8,
        "parabolic": np.where(Z < 0.5, 2 * Z**2, 1 - 2 * (1 - Z) ** 2),
        "polynomial_3_4_5": 10 * Z**3 - 15 * Z**4 + 6 * Z**5,
        "polynomial_4_5_6_7": 35 * Z**4 - 84 * Z**5 + 70 * Z**6 - 20 * Z**7,
        "gutman_1_3": Z
        - 15 / (32 * np.pi) * np.sin(2 * np.pi * Z)
        - 1 / (96 * np.pi) * np.sin(6 * np.pi * Z),
        "optimal": 3 * Z**2 - 2 * Z**3,
    }
    for name, values in expected.items():
        np.testing.assert_allclose(LAWS[name].normalised().at(Z), values, atol=EXACT, err_msg=name)


def test_coefficients_of_polynomials_are_exact() -> None:
    assert polynomial_3_4_5().pieces[0].polynomial == (0, 0, 0, 10, -15, 6)
    assert polynomial_4_5_6_7().pieces[0].polynomial == (0, 0, 0, 0, 35, -84, 70, -20)
    by_powers = polynomial({0: 0, 1: 0, 2: 0}, {0: 1, 1: 0, 2: 0}, powers=[0, 1, 2, 3, 4, 8])
    assert by_powers.at([1.0], 2) == pytest.approx([0.0], abs=1e-14)


def test_powers_that_cannot_do_it() -> None:
    with pytest.raises(LawError, match="6 powers"):
        polynomial({0: 0, 1: 0, 2: 0}, {0: 1, 1: 0, 2: 0}, powers=[3, 4, 5])
    with pytest.raises(LawError, match="can meet every condition"):
        polynomial({0: 0, 1: 1.0}, {0: 1}, powers=[0, 2, 3])


def test_shares_lead_from_law_to_law() -> None:
    laws = {name: LAWS[name].normalised().at(Z) for name in ("parabolic", "harmonic", "cycloidal")}
    np.testing.assert_allclose(modified_trapezoid(0.0).at(Z), laws["parabolic"], atol=EXACT)
    np.testing.assert_allclose(modified_trapezoid(0.25).at(Z), laws["cycloidal"], atol=EXACT)
    np.testing.assert_allclose(modified_sine(0.0).at(Z), laws["harmonic"], atol=EXACT)
    np.testing.assert_allclose(modified_sine(0.25).at(Z), laws["cycloidal"], atol=EXACT)


def test_acceleration_of_the_modified_laws_is_continuous() -> None:
    for law in (modified_trapezoid(0.1), modified_sine(0.3)):
        assert np.abs(law.jumps(2)).max() < 1e-13
        assert abs(float(law.at(0.0, 2))) < 1e-13


def test_the_combined_law_is_that_of_paper_2() -> None:
    """Equations (17) to (19) of paper 2, from the lowest place on: x over the stroke, z = φ/π."""
    law = start_and_stop()
    z = Z[Z <= 1 / 6]
    np.testing.assert_allclose(law.at(z), 1080 / 13 * (1 - 6 * z + 10.8 * z**2) * z**3, atol=EXACT)
    z = Z[(Z >= 1 / 6) & (Z <= 5 / 6)]
    np.testing.assert_allclose(law.at(z), 3 / 26 * (1 + 10 * (z - 1 / 6)), atol=EXACT)
    w = Z[Z >= 5 / 6] - 5 / 6
    np.testing.assert_allclose(
        law.at(w + 5 / 6), 1 - 15 / 13 * (0.1 - w + 216 * w**4 - 777.6 * w**5), atol=EXACT
    )
    # A stroke of 0.4 m in 3 s.
    assert float(law.at(0.5, 1)) * 0.4 / 3 == pytest.approx(0.1538461538, abs=5e-11)


@pytest.mark.parametrize("name", RAMPS)
def test_any_split_with_any_ramp(name: str) -> None:
    for start, stop in ((0.2, 0.5), (0.0, 0.4), (0.5, 0.5), (0.3, 0.0), (1.0, 0.0)):
        law = start_and_stop(start, stop, name)
        assert float(law.at(1.0)) == pytest.approx(1.0, abs=EXACT)
        assert np.abs(law.jumps(0)).max(initial=0.0) < EXACT
        assert np.abs(law.jumps(1)).max(initial=0.0) < 10 * EXACT
        assert float(law.at(1e-9, 1)) < 1e-3 or start == 0


def test_shares_beyond_the_whole_are_told() -> None:
    with pytest.raises(LawError, match="together at most 1"):
        start_and_stop(0.6, 0.5)
    with pytest.raises(LawError, match="one of optimal_jerk"):
        start_and_stop(0.2, 0.2, "ramp")


def test_ramps_go_from_rest_to_a_velocity_of_one() -> None:
    for name in RAMPS:
        G = ramp_of(name)
        assert [float(G.at(0.0, 1)), float(G.at(1.0, 1, "before"))] == pytest.approx([0.0, 1.0], abs=EXACT)
    assert float(ramp_of("optimal_jerk").at(1.0)) == pytest.approx(0.6, abs=EXACT)
    assert float(ramp_of("optimal_jerk_free").at(1.0)) == pytest.approx(0.5, abs=EXACT)


def test_trapezoid_and_s_curve() -> None:
    law = trapezoidal_velocity(0.2, 0.3)
    v = 1 / (1 - 0.25)
    assert float(law.at(0.5, 1)) == pytest.approx(v, rel=1e-14)
    assert [float(law.at(x, 2)) for x in (0.1, 0.5, 0.9)] == pytest.approx([v / 0.2, 0, -v / 0.3], rel=1e-13)
    np.testing.assert_allclose(s_curve(0.2, 0.3, 0.0).at(Z), law.at(Z), atol=EXACT)
    curve = s_curve(0.2, 0.3, 0.5)
    assert float(curve.at(0.1, 2)) == pytest.approx(2 * v / 0.2, rel=1e-13)
    assert np.abs(curve.jumps(2)).max() < 1e-12


def test_every_law_of_the_catalogue_can_stand_in_a_file() -> None:
    """And every name of a file is one of the catalogue, or made of more than numbers."""
    kinds = [
        kind
        for model in get_args(get_args(AnyLaw)[0])
        for kind in get_args(model.model_fields["kind"].annotation)
    ]
    assert len(kinds) == len(set(kinds))
    assert set(LAWS) <= set(kinds)
    assert set(kinds) - set(LAWS) == {"polynomial", "limited", "spline", "table", "formula"}
    plain = set(kinds_of(PlainLaw))
    assert plain == {name for name, entry in LAWS.items() if not entry.parameters}
    assert get_args(CombinedLaw.model_fields["ramp"].annotation) == RAMPS
    for model in get_args(get_args(AnyLaw)[0]):
        for kind in set(kinds_of(model)) & set(LAWS):
            if kind == "optimal":
                continue
            usual = {name: field.default for name, field in model.model_fields.items() if name != "kind"}
            assert usual == LAWS[kind].parameters


def test_laws_of_a_section_without_lift_stand_still() -> None:
    for entry in LAWS.values():
        np.testing.assert_allclose(entry.section(Boundary(0.0)).at(Z), 0.0, atol=1e-300)


def test_peaks_of_the_freudenstein_series_are_small() -> None:
    """Their promise: less than the cycloidal law's, the more terms the less; never below the parabola's."""
    peaks = [
        abs(LAWS[name].normalised().peak(2).value)
        for name in ("cycloidal", "freudenstein_1_3", "freudenstein_1_3_5")
    ]
    assert peaks == sorted(peaks, reverse=True)
    assert peaks[0] == pytest.approx(2 * math.pi, rel=1e-14)
    assert peaks[-1] > 4
