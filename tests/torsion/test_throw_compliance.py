"""Compliance of crank throws: closed forms against frames of beams and solids of cubes, and their limits."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sizes import cases
from throw_models import frame_stiffness, solid_compliance

import linkwright as lw
from linkwright import InputError
from linkwright.torsion import CrankThrow, compliances, restraint_length
from linkwright.torsion.model.engine.throw_compliance import (
    COMPLIANCE_FORMULAS,
    compliance,
    compliance_remarks,
)

MACHINES = Path(__file__).parents[2] / "machines"

# Rounding of the frame's elimination, which loses some digits to stiff bars.
FRAME = 1e-9


def throw(
    radius: float = 0.06,
    journal: tuple[float, float, float] = (0.042, 0.095, 0.0),
    pin: tuple[float, float, float] = (0.072, 0.080, 0.0),
    web: tuple[float, float] = (0.026, 0.130),
    **more: object,
) -> CrankThrow:
    """A throw from length, diameter and bore of journal and pin, thickness and width of the web."""
    keys = ("length", "diameter", "inner_diameter")
    entries = {
        "radius": radius,
        "journal": dict(zip(keys, journal, strict=True)),
        "pin": dict(zip(keys, pin, strict=True)),
        "web": {"thickness": web[0], "width": web[1]},
        **more,
    }
    return CrankThrow.model_validate(entries)


@st.composite
def throws(draw: st.DrawFn) -> CrankThrow:
    number = st.floats(0.2, 1.0)
    size = draw(st.floats(0.01, 1.0))
    d_1, d_2 = (size * draw(st.floats(0.5, 1.5)) for _ in range(2))
    return throw(
        size * draw(number),
        (size * draw(number), d_1, d_1 * draw(st.floats(0, 0.8))),
        (size * draw(number), d_2, d_2 * draw(st.floats(0, 0.8))),
        (size * draw(st.floats(0.1, 0.8)), size * draw(st.floats(0.8, 2.0))),
    )


def bare(each: CrankThrow, k: float) -> float:
    """Formula (17) without the journal and without what lengthens the pin: webs and pin alone."""
    one = compliance(each.model_copy(update={"restraint_length": k}), "constrained")
    h, G = each.web.thickness, each.shear_modulus
    rings = [math.pi / 32 * (part.diameter**4 - part.inner_diameter**4) for part in (each.journal, each.pin)]
    return (
        one
        - (each.journal.length + 0.9 * h) / (G * rings[0])
        - 0.9 * h / (G * rings[1]) * (1 - each.radius / k)
    )


@given(throws())
@settings(max_examples=cases(60, 600), deadline=None)
def test_restraint_is_that_of_a_frame_of_beams(each: CrankThrow) -> None:
    """Bearings that leave the second web only its turning answer with M/k, and the twist is that of (17)."""
    K, k = frame_stiffness(each), restraint_length(each)
    assert abs(K[2, 3]) / K[3, 3] == pytest.approx(1 / k, rel=FRAME)
    # What is taken away from (17) to leave webs and pin is up to a hundred times as large.
    assert bare(each, k) == pytest.approx(1 / K[3, 3], rel=1e-7)


@given(throws())
@settings(max_examples=cases(60, 600), deadline=None)
def test_free_bearings_are_a_free_frame(each: CrankThrow) -> None:
    assert bare(each, 1e12) == pytest.approx(np.linalg.inv(frame_stiffness(each))[3, 3], rel=1e-7)


@given(throws())
@settings(max_examples=cases(60, 600), deadline=None)
def test_restraint_is_the_least_of_the_energy(each: CrankThrow) -> None:
    """Castigliano: no other force of the bearings would do with less energy; k is above two thirds of R."""
    K = frame_stiffness(each)
    F = np.linalg.inv(K)

    def energy(S: float) -> float:
        """Of a torque 1, the force S across, and the couples that keep the journals in line."""
        load = np.zeros(6)
        load[[2, 3]] = S, 1.0
        # Couples about y and z, and the other forces, that keep their motions zero.
        others = [0, 1, 4, 5]
        load[others] = -np.linalg.solve(F[np.ix_(others, others)], F[np.ix_(others, [2, 3])] @ load[[2, 3]])
        return float(load @ F @ load)

    S = K[2, 3] / K[3, 3]
    k = restraint_length(each)
    assert abs(S) == pytest.approx(1 / k, rel=FRAME)
    assert energy(S) < min(energy(0.98 * S), energy(1.02 * S))
    assert k > 2 / 3 * each.radius


def test_bearings_make_a_throw_stiffer() -> None:
    """e grows with k, from the computed one to free bearings."""
    each = throw()
    k = restraint_length(each)
    found = [compliance(throw(restraint_length=f * k)) for f in (1.0, 2.0, 10.0, 1e6)]
    assert found == sorted(found)
    assert compliance(each) == pytest.approx(found[0], rel=1e-15)
    # What is left of the restraint falls with its length.
    assert compliance(each, "free") == pytest.approx(found[-1], rel=1e-5)


def test_without_a_crank_radius_it_is_a_shaft() -> None:
    """R → 0: (17) is journal and pin, each with 0.9 of a web's thickness, whatever the bearings do."""
    each = throw(radius=1e-9, web=(0.026, 0.13))
    G, h = each.shear_modulus, 0.026
    shaft = sum(
        (length + 0.9 * h) / (G * math.pi / 32 * d**4) for length, d in ((0.042, 0.095), (0.072, 0.080))
    )
    assert compliance(each, "free") == pytest.approx(shaft, rel=1e-7)
    assert compliance(each, "constrained") == pytest.approx(shaft, rel=1e-7)


@pytest.mark.parametrize("name", ["constrained", "free", "carter", "ker_wilson"])
def test_a_longer_journal_is_a_longer_shaft(name: str) -> None:
    """All formulas take the journal in full: 10 mm more add 10 mm/(G I₁)."""
    short, long = throw(), throw(journal=(0.052, 0.095, 0.0))
    more = 0.01 / (short.shear_modulus * math.pi / 32 * 0.095**4)
    assert compliance(long, name) - compliance(short, name) == pytest.approx(more, rel=1e-9)


def test_zimanenko_of_a_long_journal_is_that_journal() -> None:
    lengths = (10.0, 20.0)
    found = [compliance(throw(journal=(length, 0.095, 0.0)), "zimanenko") for length in lengths]
    more = 10.0 / (throw().shear_modulus * math.pi / 32 * 0.095**4)
    # The rest of 0.6 h D₁/L₁ is a hundred-thousandth of the journal.
    assert found[1] - found[0] == pytest.approx(more, rel=2e-5)


def test_formulas_term_by_term() -> None:
    """Each in lengths of a shaft of 100 mm, written out with the numbers of one throw in mm."""
    each = throw(0.09, (0.06, 0.1, 0.05), (0.08, 0.09, 0.03), (0.03, 0.15), shear_modulus=80e9)
    unit = 32 / (math.pi * 80e9 * 1e-12)
    J, P, W = 100.0**4 - 50.0**4, 90.0**4 - 30.0**4, 30 * 150.0**3
    expected = {
        "carter": 84 / J + 60 / P + 135 / W,
        "ker_wilson": 100 / J + 116 / P + 52 / W,
        "zimanenko": 90 / J + (64 + 100 / 3) / P + 90 / W,
        "free": 87 / J + 107 / P + 12 * math.pi / 32 * 2 * 90 / W * 80 / 206,
    }
    for name, lengths in expected.items():
        # The unit is written in mm⁻³: 1 mm/mm⁴ = 1e9 m⁻³, and 1e-12 of it is in the unit above.
        assert compliance(each, name) == pytest.approx(lengths * unit * 1e-3, rel=1e-12), name


SHAPES = {
    "passenger car": throw(0.045, (0.030, 0.056, 0.0), (0.028, 0.050, 0.0), (0.020, 0.075)),
    "lorry": throw(),
    "medium speed": throw(0.150, (0.130, 0.180, 0.0), (0.150, 0.170, 0.0), (0.070, 0.240)),
}


@pytest.mark.parametrize("name", SHAPES)
def test_against_a_solid_throw(name: str) -> None:
    """Free to shift at its ends, so that (17) with play and the empirical formulas are what it compares with.

    Finer cubes make these throws 2 % more flexible yet.
    """
    each = SHAPES[name]
    solid = solid_compliance(each, each.journal.diameter / 14)
    ratio = {formula: value / solid for formula, value in compliances(each).items()}
    assert 0.96 < ratio["constrained"] < 1.03
    assert 1.08 < ratio["free"] < 1.20
    assert 0.96 < ratio["carter"] < 1.12
    assert 1.03 < ratio["ker_wilson"] < 1.12
    assert 1.03 < ratio["zimanenko"] < 1.19


def test_a_solid_shaft_is_a_shaft() -> None:
    """The model of cubes itself: a throw without crank radius whose webs are parts of the shaft."""
    each = throw(1e-6, (0.08, 0.08, 0.0), (0.06, 0.08, 0.0), (0.002, 0.08))
    length = each.length / (each.shear_modulus * math.pi / 32 * 0.08**4)
    # A square web of 2 mm and the stairs of the cubes count for less than 3 %.
    assert solid_compliance(each, 0.005) == pytest.approx(length, rel=0.03)


@pytest.mark.parametrize("name", SHAPES)
def test_formulas_differ_by_a_tenth_to_a_third(name: str) -> None:
    found = compliances(SHAPES[name])
    assert set(found) == set(COMPLIANCE_FORMULAS)
    assert 1.07 < max(found.values()) / min(found.values()) < 1.35


@given(throws(), st.floats(0.1, 10.0))
@settings(max_examples=cases(50, 500), deadline=None)
def test_compliance_goes_with_the_cube_of_the_size(each: CrankThrow, scale: float) -> None:
    """Similar throws: e ∝ 1/(G · size³)."""

    def scaled(part: object, keys: tuple[str, ...]) -> dict[str, float]:
        return {key: scale * getattr(part, key) for key in keys}

    ring = ("length", "diameter", "inner_diameter")
    similar = CrankThrow.model_validate(
        {
            "radius": scale * each.radius,
            "journal": scaled(each.journal, ring),
            "pin": scaled(each.pin, ring),
            "web": scaled(each.web, ("thickness", "width")),
        }
    )
    for name, value in compliances(each).items():
        assert compliance(similar, name) * scale**3 == pytest.approx(value, rel=1e-9), name


def test_unknown_formula_is_told() -> None:
    with pytest.raises(InputError, match=r'found "cartr".*did you mean "carter"'):
        compliance(throw(), "cartr")


def test_nothing_left_is_told() -> None:
    with pytest.raises(InputError, match=r"constrained: found -.*expected more than 0; k = 0.0001 m"):
        compliance(throw(restraint_length=1e-4))
    assert "constrained" not in compliances(throw(restraint_length=1e-4))


def test_remarks_say_what_is_out_of_range() -> None:
    assert compliance_remarks(throw()) == {}
    assert set(compliance_remarks(throw(radius=0.03))) == {"ker_wilson"}
    assert set(compliance_remarks(throw(journal=(0.02, 0.095, 0.0)))) == {"zimanenko"}
    assert set(compliance_remarks(throw(restraint_length=0.05))) == {"constrained"}


def test_a_throw_outside_the_range_of_its_formula_is_told() -> None:
    """A formula gives a number beyond its range too: whoever uses it has to know."""
    short = {"train.engine.stiffness_formula": "zimanenko", "train.engine.throw.journal.length": "20 mm"}
    found = lw.torsion_study(lw.read(MACHINES / "v_diesel.toml", overrides=short)).warnings
    assert [text for text in found if "outside the range of the formula zimanenko: 0.6 h D₁/L₁" in text]
    as_is = lw.torsion_study(lw.read(MACHINES / "v_diesel.toml")).warnings
    assert not [text for text in as_is if "outside the range of the formula" in text]
