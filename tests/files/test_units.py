"""Units: every built-in spelling agrees with pint; texts and numbers give SI; nonsense gives a message."""

from __future__ import annotations

import contextlib
import math
import subprocess
import sys
from typing import Annotated, Any

import numpy as np
import pint
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import TypeAdapter, ValidationError

from linkwright import UnitError
from linkwright.kernel.units import kinds, marks, reading, spellings
from linkwright.kernel.units.spellings import factor_of, unknown

REGISTRY: pint.UnitRegistry[Any] = pint.UnitRegistry()
REGISTRY.define("@alias turn = rev")
SPELLINGS = [
    (text, f, kinds.Dimension.of(unit)) for unit, row in spellings.COMMON.items() for text, f in row.items()
]


def test_quantities_have_their_plural() -> None:
    """Lists are of velocities, masses per length and moments of inertia."""
    plurals = {kind.noun: kind.plural for kind in kinds.KINDS}
    assert plurals["velocity"] == "velocities"
    assert plurals["mass per length"] == "masses per length"
    assert plurals["moment of inertia"] == "moments of inertia"
    assert plurals["angular speed"] == "angular speeds"


@pytest.mark.parametrize(("text", "factor", "dimension"), SPELLINGS, ids=[each[0] for each in SPELLINGS])
def test_common_spellings_agree_with_pint(text: str, factor: float, dimension: kinds.Dimension) -> None:
    # A barrel of oil is 42 US gallons, of which only the field's spelling is meant here.
    parsed = REGISTRY.parse_units(text.replace("%", "percent").replace("bbl", "oil_bbl"))
    theirs, base = REGISTRY.get_base_units(parsed)
    # Some of pint's factors are products of rounded ones.
    assert factor == pytest.approx(float(theirs), rel=1e-14)
    powers = {str(name): power for name, power in base._units.items()}
    ours = zip(("meter", "kilogram", "second", "radian", "kelvin", "ampere"), dimension, strict=True)
    assert powers == {name: power for name, power in ours if power}


@pytest.mark.parametrize(
    ("text", "kind", "value"),
    [
        ("0.2 m", kinds.LENGTH, 0.2),
        ("20cm", kinds.LENGTH, 0.2),
        (" 1e3 kg ", kinds.MASS, 1000.0),
        ("−5 mm", kinds.LENGTH, -0.005),
        (".5 µm", kinds.LENGTH, 0.5e-6),
        ("90 deg", kinds.ANGLE, math.pi / 2),
        ("90°", kinds.ANGLE, math.pi / 2),
        ("1 turn", kinds.ANGLE, 2 * math.pi),
        ("1000 rpm", kinds.SPEED, 1000 * 2 * math.pi / 60),
        ("2 rev/s", kinds.SPEED, 4 * math.pi),
        ("5.5 kW", kinds.POWER, 5500.0),
        ("48.4 kg m^2", kinds.INERTIA, 48.4),
        ("48.4 kg·m²", kinds.INERTIA, 48.4),
        ("48.4 kg*m**2", kinds.INERTIA, 48.4),
        ("3 N·m", kinds.TORQUE, 3.0),
        ("3 N*m", kinds.TORQUE, 3.0),
        ("3 N m/rad", kinds.TORSIONAL_STIFFNESS, 3.0),
        ("3 N m", kinds.TORSIONAL_STIFFNESS, 3.0),
        ("9.81 m s⁻²", kinds.ACCELERATION, 9.81),
        ("330 K", kinds.TEMPERATURE, 330.0),
        ("5 delta_degC", kinds.TEMPERATURE, 5.0),
        ("90 %", kinds.RATIO, 0.9),
        ("0.9", kinds.RATIO, 0.9),
        # Products run together, and what other trades write.
        ("120 Nm", kinds.TORQUE, 120.0),
        ("1.2kNm", kinds.TORQUE, 1200.0),
        ("500 Nmm", kinds.TORQUE, 0.5),
        ("3 Nm/rad", kinds.TORSIONAL_STIFFNESS, 3.0),
        ("3 Nmm/rad", kinds.TORSIONAL_STIFFNESS, 0.003),
        ("300 Ns/m", kinds.DAMPING, 300.0),
        ("4 Nms/rad", kinds.TORSIONAL_DAMPING, 4.0),
        ("0.14 kgm^2", kinds.INERTIA, 0.14),
        ("0.14 kgm²", kinds.INERTIA, 0.14),
        ("1400 kgcm²", kinds.INERTIA, 0.14),
        ("2 kWh", kinds.ENERGY, 7.2e6),
        ("960 RPM", kinds.SPEED, 32 * math.pi),
        ("960 r/min", kinds.SPEED, 32 * math.pi),
        ("960 U/min", kinds.SPEED, 32 * math.pi),
        ("10 ft lb", kinds.TORQUE, 13.558179483314004),
        ("10 ft-lb", kinds.TORQUE, 13.558179483314004),
        ("10 lb·ft", kinds.TORQUE, 13.558179483314004),
        ("10 ft lbf", kinds.TORQUE, 13.558179483314004),
        ("10 in lb", kinds.TORQUE, 1.129848290276167),
        ("100 lbf", kinds.FORCE, 444.82216152605),
        ("100 lbf/in", kinds.STIFFNESS, 17512.683524647636),
        # Spellings that only pint knows.
        ("2 inch", kinds.LENGTH, 0.0508),
        ("1 metre", kinds.LENGTH, 1.0),
        ("10 N/(m s)", kinds.STIFFNESS, None),
        ("10 kg/(m s^2)", kinds.STIFFNESS, None),
        ("10 newton/meter", kinds.STIFFNESS, 10.0),
        ("1 W h", kinds.ENERGY, 3600.0),
        (3, kinds.FORCE, 3.0),
    ],
)
def test_texts_give_si(text: object, kind: kinds.Kind, value: float | None) -> None:
    if value is None:
        with pytest.raises(UnitError):
            reading.parse(text, kind)
    else:
        assert reading.parse(text, kind) == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize(
    ("given", "same"),
    [
        ("kg m2", "kg m^2"),
        ("kgm2", "kg m^2"),
        ("kg-m2", "kg m^2"),
        ("g cm2", "g cm^2"),
        ("lb ft2", "lb ft^2"),
        ("N/mm2", "N/mm^2"),
        ("kg/m3", "kg/m^3"),
        ("m/s2", "m/s^2"),
        ("m s-2", "m s^-2"),
        ("rad s-1", "rad/s"),
        ("cmH2O", "cmH2O"),
        ("lbft", "ft lbf"),
        ("ftlb", "ft lbf"),
        ("in-lb", "in lbf"),
        ("oz in", "ozf in"),
        ("daNm", "daN m"),
        ("r.p.m.", "rpm"),
        ("lbm", "lb"),
        ("kp", "kgf"),
        ("PS", "metric_horsepower"),
        ("мм", "mm"),
        ("кг", "kg"),
        ("кг·м²", "kg m^2"),
        ("кг м2", "kg m^2"),
        ("Нм", "N m"),
        ("кНм", "kN m"),
        ("кН·м/рад", "kN m/rad"),
        ("Н·с/м", "N s/m"),
        ("об/хв", "rpm"),
        ("рад/с", "rad/s"),
        ("кВт", "kW"),
        ("МПа", "MPa"),
    ],
)
def test_spellings_of_one_unit(given: str, same: str) -> None:
    found, wanted = factor_of(given), factor_of(same)
    assert found is not None
    assert wanted is not None
    # The same factor but for the order of its products.
    assert found[0] == pytest.approx(wanted[0], rel=1e-12)
    assert found[1] == wanted[1]


@pytest.mark.parametrize(
    ("value", "kind", "word"),
    [
        ("0.2 kg", kinds.LENGTH, "unit of mass"),
        ("0.2", kinds.LENGTH, '0.2 m"'),
        ("0,2 m", kinds.LENGTH, "point"),
        ("0,5 kN m", kinds.TORQUE, "point"),
        ("1,500 rpm", kinds.SPEED, "thousands"),
        ("1,500.5 mm", kinds.LENGTH, "thousands"),
        ("20 lb", kinds.FORCE, "lbf"),
        ("20 lb/in", kinds.STIFFNESS, "lbf"),
        ("4 Nms", kinds.TORSIONAL_DAMPING, "N m s"),
        ("", kinds.LENGTH, "a length"),
        ("m", kinds.LENGTH, "a length"),
        ("1 m m", kinds.LENGTH, "unit of area"),
        ("1 kg m22", kinds.INERTIA, "not a known unit"),
        ("1 NM", kinds.TORQUE, "did you mean N m?"),
        ("1 KG M2", kinds.INERTIA, "did you mean kg m^2?"),
        ("3000 min-1", kinds.SPEED, "revolutions or radians"),
        ("1 000 mm", kinds.LENGTH, "thousands"),
        ("1'000 mm", kinds.LENGTH, "thousands"),
        ("1 кг", kinds.LENGTH, "unit of mass"),
        ("1 обертань", kinds.SPEED, "not a known unit"),
        ("1 wobble", kinds.LENGTH, "not a known unit"),
        ("0.2 m ± 0.2 mm", kinds.LENGTH, "into [study.variables.NAME]"),
        ("25 H7", kinds.LENGTH, "into [study.variables.NAME]"),
        ("1 N/m s", kinds.STIFFNESS, "two ways"),
        ("50 Hz", kinds.SPEED, "revolutions or radians"),
        ("3000 1/min", kinds.SPEED, "revolutions or radians"),
        ("1 rad", kinds.RATIO, "unit of angle"),
        ("1", kinds.ANGLE, "rad"),
        ("1e999 m", kinds.LENGTH, "finite"),
        ("1e308 km", kinds.LENGTH, "finite"),
        ("nan m", kinds.LENGTH, "a length"),
        ("20 degC", kinds.LENGTH, "absolute zero"),
        ("60 degC", kinds.TEMPERATURE, "273.15"),
        ("60 °C", kinds.TEMPERATURE, "273.15"),
        ("3 N m K", kinds.TORSIONAL_STIFFNESS, "something else"),
        ("1 m**99999", kinds.LENGTH, ""),
        ("1 " + "m" * 5000, kinds.LENGTH, ""),
        ("1 __import__('os')", kinds.LENGTH, "not a known unit"),
        (True, kinds.LENGTH, "true"),
        (math.nan, kinds.LENGTH, "finite"),
        (math.inf, kinds.LENGTH, "finite"),
        (10**400, kinds.LENGTH, "between 1e-9 and 1e6 m"),
        (None, kinds.LENGTH, "a length"),
        ([1], kinds.LENGTH, "a length"),
    ],
)
def test_nonsense_gives_a_message(value: object, kind: kinds.Kind, word: str) -> None:
    with pytest.raises(UnitError) as caught:
        reading.parse(value, kind)
    assert word in str(caught.value)
    assert kind.noun in str(caught.value)


@given(st.text(max_size=30))
def test_any_text_is_a_number_or_a_unit_error(text: str) -> None:
    with contextlib.suppress(UnitError):
        assert math.isfinite(reading.parse(text, kinds.LENGTH))


@given(st.floats(-1, 1), st.sampled_from(kinds.KINDS))
def test_si_texts_read_back_as_the_same_float(share: float, kind: kinds.Kind) -> None:
    value = share * kind.most
    assert reading.parse(reading.to_text(value, kind), kind) == value


@pytest.mark.parametrize("kind", [*kinds.KINDS, kinds.COUNT], ids=lambda kind: kind.noun)
@pytest.mark.parametrize("sign", [1, -1])
def test_the_range_of_a_kind_is_held_by_every_reader(kind: kinds.Kind, sign: int) -> None:
    assert reading.parse(sign * kind.most, kind) == sign * kind.most
    beyond = sign * kind.most * 1.001
    for value in (beyond, f"{beyond!r} {kind.unit}", sign * 1e300, np.float64(beyond)):
        with pytest.raises(UnitError, match="in size") as caught:
            reading.parse(value, kind)
        assert kinds.range_words(kind) in str(caught.value)
    with pytest.raises(UnitError, match="in size"):
        reading.parse_list([0, beyond], kind)


@pytest.mark.parametrize("kind", [*kinds.KINDS, kinds.COUNT], ids=lambda kind: kind.noun)
def test_specks_are_zero_where_zero_may_stand_and_no_size_where_it_may_not(kind: kinds.Kind) -> None:
    allowed = (marks.Quantity(kind), marks.positive(kind), marks.not_negative(kind))
    signed, positive, not_negative = (TypeAdapter(Annotated[float, mark]) for mark in allowed)
    for value in (1e-320, 1e-300, 0.999 * kind.least):
        assert signed.validate_python(value) == value
        assert signed.validate_python(-value) == -value
        assert not_negative.validate_python(value) == 0.0
        with pytest.raises(ValidationError) as caught:
            positive.validate_python(value)
        assert caught.value.errors()[0]["ctx"]["remedy"] == kinds.range_words(kind)
    assert positive.validate_python(kind.least) == not_negative.validate_python(kind.least) == kind.least


@pytest.mark.parametrize("kind", kinds.KINDS, ids=lambda kind: kind.noun)
def test_examples_and_units_of_the_kinds_are_valid(kind: kinds.Kind) -> None:
    reading.parse(kind.example, kind)
    assert reading.parse(f"1 {kind.unit}".strip(), kind) == 1.0


def test_lists() -> None:
    for value in (["0 m", "10 cm"], [0, 0.1], (0, "0.1 m"), "0, 10 cm", "0 10 cm", "0; 10 cm"):
        assert reading.parse_list(value, kinds.LENGTH) == pytest.approx([0.0, 0.1])
    for value in ("0, x", {"a": 1}, 3, None, [[1]], "0, 1"):
        with pytest.raises(UnitError):
            reading.parse_list(value, kinds.LENGTH)


@pytest.mark.parametrize("text", ["0,2 m", "1,5; 2,5 mm", "1,5, 2,5 mm", "0,2; 3 m"])
def test_a_comma_that_may_be_decimal_is_no_list(text: str) -> None:
    with pytest.raises(UnitError, match="decimal point"):
        reading.parse_list(text, kinds.LENGTH)
    assert reading.parse_list("0,100,200 mm", kinds.LENGTH) == [0.0, 0.1, 0.2]


@pytest.mark.parametrize("text", ["0,2 m", "1,000.5 m", "1.000,5 m", "1.000.000,5 m", "-1.000,5 m"])
def test_a_comma_in_a_number_is_named(text: str) -> None:
    with pytest.raises(UnitError, match="decimal point"):
        reading.parse(text, kinds.LENGTH)


def test_common_spellings_do_not_load_pint() -> None:
    code = (
        "import sys\nfrom linkwright.kernel.units import kinds, reading\n"
        "reading.parse('48.4 kg·m²', kinds.INERTIA), reading.parse('90 deg', kinds.ANGLE)\n"
        "assert not {'pint', 'numpy'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_letters_of_the_other_case_are_named() -> None:
    assert "did you mean rpm?" in unknown("Rpm")
    assert "did you mean kN?" in unknown("KN")
    assert "did you mean" not in unknown("furlongs")
