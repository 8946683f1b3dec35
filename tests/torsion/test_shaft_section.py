"""Sections of shafts: closed forms against quadrature and against torsion solved as a field."""

from __future__ import annotations

import math
import re
import tomllib

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import ValidationError
from scipy.integrate import quad
from scipy.optimize import brentq
from sizes import cases
from torsion_fields import flange_flexibility, keyed_constant, spline_constant, step_length

import linkwright as lw
from linkwright import MachineError
from linkwright.torsion.model import shaft_flexibility as closed
from linkwright.torsion.model.shaft_flexibility import cone_integral
from linkwright.torsion.model.shaft_row import end_inertias, flexibilities, place
from linkwright.torsion.model.shaft_section import ShaftSection

# Rounding of closed forms over a few operations.
ROUNDING = 1e-13


def section(**entries: object) -> ShaftSection:
    """A section 0.3 m long and 0.1 m thick, unless said otherwise."""
    return ShaftSection.model_validate({"length": 0.3, "diameter": 0.1, **entries})


def polar(diameter: float, bore: float = 0.0) -> float:
    return math.pi / 32 * (diameter**4 - bore**4)


def test_a_cylinder() -> None:
    each = section(inner_diameter=0.06)
    assert each.flexibility == pytest.approx(0.3 / polar(0.1, 0.06), rel=ROUNDING)
    # Largest shear stress T r/I_p at the surface.
    assert each.section_modulus == pytest.approx(polar(0.1, 0.06) / 0.05, rel=ROUNDING)
    assert each.place(0.25) == 0.25 * 0.3


def test_a_thin_tube_keeps_its_digits() -> None:
    """I_p = 2π r³ t, to the next power of t/r."""
    each = section(inner_diameter=0.1 * (1 - 2e-9))
    assert each.section_modulus == pytest.approx(2 * math.pi * 0.05**3 * 2e-9, rel=1e-6)


sizes = st.floats(0.02, 0.3)
shares = st.floats(0.0, 0.97)


@given(sizes, sizes, shares, shares)
@settings(max_examples=cases(60, 600), deadline=None)
def test_a_taper_is_the_integral(first: float, second: float, bore: float, other: float) -> None:
    each = section(
        kind="taper",
        diameter=first,
        diameter_end=second,
        inner_diameter=first * bore,
        inner_diameter_end=second * other,
    )

    # A bore below a nanometre is none.
    inner = each.bores

    def resisting(x: float) -> float:
        return 1 / polar(first + x / 0.3 * (second - first), inner[0] + x / 0.3 * (inner[1] - inner[0]))

    whole, _ = quad(resisting, 0, 0.3, epsrel=1e-12, limit=200)
    assert each.flexibility == pytest.approx(whole, rel=1e-10)
    part, _ = quad(resisting, 0, each.place(0.3), epsrel=1e-12, limit=200)
    assert part == pytest.approx(0.3 * whole, rel=1e-9)


@given(sizes, sizes, shares)
@settings(max_examples=cases(40, 400), deadline=None)
def test_a_hollow_taper_whose_bore_vanishes_is_solid(first: float, second: float, share: float) -> None:
    solid = cone_integral(1.0, (first, second))
    # The bore counts by its fourth power.
    assert cone_integral(1.0, (first, second), (1e-5 * first, 1e-5 * second)) == pytest.approx(
        solid, rel=1e-12
    )
    pieces = first + share * (second - first)
    parts = share * cone_integral(1.0, (first, pieces)) + (1 - share) * cone_integral(1.0, (pieces, second))
    assert parts == pytest.approx(solid, rel=1e-12)
    assert cone_integral(1.0, (first, first)) == pytest.approx(1 / polar(first), rel=ROUNDING)


@pytest.mark.parametrize(("half_angle", "softer"), [(10.0, 0.005), (20.0, 0.021), (30.0, 0.052)])
def test_a_steep_cone_against_its_exact_solution(half_angle: float, softer: float) -> None:
    """Föppl: ψ = C/ρ³ with ρ from the tip, C = T/(6πG (2/3 − cos α + cos³α/3)); spheres are rigid."""
    a = math.radians(half_angle)
    C = 1 / (6 * math.pi * (2 / 3 - math.cos(a) + math.cos(a) ** 3 / 3))
    rim = math.cos(a) ** 3  # 1/ρ³ at the rim of the disc at x is cos³α/x³.
    exact = C * rim * (1 / 1.0**3 - 1 / 2.0**3)
    found = cone_integral(1.0, (2 * math.tan(a), 4 * math.tan(a)))
    assert exact / found - 1 == pytest.approx(softer, abs=6e-4)


@pytest.mark.parametrize(
    ("ratio", "fillet", "bore"),
    [
        (1.05, 0.0, 0.0),
        (1.2, 0.0, 0.0),
        (1.2, 0.05, 0.0),
        (1.5, 0.0, 0.0),
        (1.5, 0.1, 0.0),
        (2.0, 0.0, 0.6),
        (2.0, 0.15, 0.0),
        (2.0, 0.25, 0.0),
        (3.0, 0.05, 0.75),
        (8.0, 0.0, 0.0),
        (8.0, 0.2, 0.0),
        (8.0, 0.0, 0.8),
    ],
)
def test_a_step_against_the_field(ratio: float, fillet: float, bore: float) -> None:
    """In thinner diameters, within the 0.0035 that the fit promises; the mesh is good to 0.0003."""
    exact = step_length(ratio, fillet=2 * fillet, bore=bore)
    assert closed.step_length(1.0, ratio, fillet, bore) == pytest.approx(exact, abs=0.0038)


def test_no_step_no_length() -> None:
    assert closed.step_length(0.1, 0.1) == 0.0


@pytest.mark.parametrize(
    ("thickness", "circle", "bore", "fillet"),
    [
        (0.125, 2.0, 0.0, 0.0),
        (0.25, 3.0, 0.0, 0.0),
        (0.25, 1.5, 0.6, 0.0),
        (0.5, 2.0, 0.0, 0.0),
        (0.2, 2.0, 0.0, 0.05),
        (0.25, 2.0, 0.0, 0.1),
        (0.4, 2.5, 0.0, 0.2),
    ],
)
def test_a_flange_against_the_field(thickness: float, circle: float, bore: float, fillet: float) -> None:
    """Within 0.015 diameters of the solid shaft; sizes over its diameter 2."""
    each = section(
        kind="flange",
        diameter=2.0,
        length=2 * thickness,
        bolt_circle=2 * circle,
        inner_diameter=2 * bore,
        fillet=2 * fillet,
    )
    exact = flange_flexibility(2 * thickness, circle, bore, 2 * fillet)
    assert each.flexibility == pytest.approx(exact, abs=0.015 * 2 / polar(2.0))


def test_a_wide_thin_flange_is_a_plate() -> None:
    """Timoshenko and Goodier: u/r = T/(4πGt) (1/a² − 1/b²); the shaft's entry counts for little."""
    each = section(kind="flange", length=1e-4, bolt_circle=0.4)
    assert each.flexibility == pytest.approx((1 / 0.05**2 - 1 / 0.2**2) / (4 * math.pi * 1e-4), rel=0.005)
    assert each.section_modulus == pytest.approx(2 * math.pi * 0.05**2 * 1e-4)


@pytest.mark.parametrize(
    ("width", "depth", "keyways", "bore", "within"),
    [
        (0.12, 0.06, 1, 0.0, 0.005),
        (0.25, 0.11, 1, 0.0, 0.005),
        (0.30, 0.14, 1, 0.0, 0.005),
        (0.40, 0.18, 1, 0.0, 0.006),
        (0.25, 0.11, 2, 0.0, 0.008),
        (0.30, 0.14, 2, 0.0, 0.008),
        (0.25, 0.11, 1, 0.5, 0.013),
    ],
)
def test_keyways_against_the_field(
    width: float, depth: float, keyways: int, bore: float, within: float
) -> None:
    """In parts of I_p of the solid shaft, as the fit promises it; the mesh is good to 0.0005."""
    each = section(
        diameter=1.0, inner_diameter=bore, keyway_width=width, keyway_depth=depth, keyways=keyways, length=1.0
    )
    exact = keyed_constant(width, depth, keyways, bore)
    assert 1 / each.flexibility / polar(1.0) == pytest.approx(exact, abs=within)


@pytest.mark.parametrize(
    ("teeth", "root", "tip", "tooth"), [(6, 23, 28, 6), (8, 42, 48, 8), (10, 102, 112, 16)]
)
def test_splines_against_the_field(teeth: int, root: float, tip: float, tooth: float) -> None:
    """Straight-sided splines of ISO 14, whose stiffness is met within 1.5 %."""
    each = section(kind="spline", diameter=1.0, root_diameter=root / tip, length=1.0)
    exact = spline_constant(teeth, root / tip, tooth / tip)
    assert 1 / each.flexibility / polar(1.0) == pytest.approx(exact, rel=0.015)
    assert polar(root / tip) < exact * polar(1.0) < polar(1.0)


def test_a_third_of_a_hub_twists() -> None:
    assert section(kind="hub").flexibility == pytest.approx(0.1 / polar(0.1), rel=ROUNDING)
    assert section(kind="hub", share=0.5).flexibility == pytest.approx(0.15 / polar(0.1), rel=ROUNDING)


def test_strength_of_the_weakest_place() -> None:
    """Moore: 1 − 0.2 b/d − 1.1 t/d is left by a keyway; a taper breaks where it is thin."""
    keyed = section(keyway_width=0.025, keyway_depth=0.0125)
    assert keyed.section_modulus == pytest.approx(polar(0.1) / 0.05 * (1 - 0.05 - 0.1375), rel=ROUNDING)
    both = section(keyway_width=0.025, keyway_depth=0.0125, keyways=2)
    assert both.section_modulus == pytest.approx(polar(0.1) / 0.05 * (1 - 0.05 - 0.1375) ** 2, rel=ROUNDING)
    taper = section(kind="taper", diameter_end=0.06, inner_diameter=0.02)
    assert taper.section_modulus == pytest.approx(polar(0.06, 0.02) / 0.03, rel=ROUNDING)
    assert section(kind="spline", root_diameter=0.08).section_modulus == pytest.approx(polar(0.08) / 0.04)


@given(sizes, sizes, shares)
@settings(max_examples=cases(40, 400), deadline=None)
def test_inertia_is_the_integral(first: float, second: float, bore: float) -> None:
    inside = bore * min(first, second)
    each = section(kind="taper", diameter=first, diameter_end=second, inner_diameter=inside)
    J, _ = quad(lambda x: 7850 * polar(first + x / 0.3 * (second - first), inside), 0, 0.3)
    assert each.inertia(7850) == pytest.approx(J, rel=1e-10)


def test_inertia_of_a_cylinder_is_that_of_a_disc() -> None:
    """m d²/8."""
    mass = 7850 * math.pi / 4 * 0.1**2 * 0.3
    assert section().inertia(7850) == pytest.approx(mass * 0.1**2 / 8, rel=ROUNDING)
    flange = section(kind="flange", length=0.02, bolt_circle=0.3)
    assert flange.inertia(7850) == pytest.approx(7850 * 0.02 * polar(0.3), rel=ROUNDING)


def test_inertia_is_shared_out_as_by_a_lever() -> None:
    one = end_inertias([section()], 7850)
    assert one == pytest.approx([section().inertia(7850) / 2] * 2, rel=ROUNDING)
    row = [section(), section(diameter=0.2), section(diameter=0.05)]
    first, second = end_inertias(row, 7850)
    assert first + second == pytest.approx(sum(each.inertia(7850) for each in row), rel=ROUNDING)
    # The thick section hangs on the first end by nine tenths, since the thin one twists most.
    assert first > second
    parts = np.array([each.flexibility for each in row])
    share = (np.cumsum(parts) - parts / 2) / parts.sum()
    assert second == pytest.approx(share @ [each.inertia(7850) for each in row], rel=ROUNDING)


def test_half_the_inertia_to_each_end_keeps_low_frequencies() -> None:
    """A shaft held at one end, with a disc of its own inertia at the other: x tan x = 1 (Den Hartog)."""
    shaft = section(length=1.0)
    J, k = shaft.inertia(7850), 80e9 / shaft.flexibility
    _, end = end_inertias([shaft], 7850)
    exact = 0.8603335890193797  # Root of x tan x = J_shaft/J_disc = 1, with ω = x √(k/J_shaft).
    # Half instead of the better third of the inertia: too low by less than 6 %.
    assert math.sqrt(k / (J + end)) / (exact * math.sqrt(k / J)) == pytest.approx(1.0, abs=0.06)


@pytest.mark.parametrize("parts", [1, 4, 16])
def test_a_shaft_with_a_density_swings_by_itself(parts: int) -> None:
    """A plain shaft between two discs as heavy as itself, in parts: tan x = 2x/(x² − 1) (Timoshenko).

    Inertia at the ends of n parts makes the frequency too low by about 0.13/n².
    """
    shaft = section(length=1.0)
    J, k = shaft.inertia(7850), 79.3e9 / shaft.flexibility
    tiny = 1e-9 * J
    discs = [J, *[tiny] * (parts - 1), J]
    lines = ["format = 1", 'name = "Heavy shaft"', "[train.discs]"]
    lines += [f"d{n} = {{ inertia = {each!r} }}" for n, each in enumerate(discs)]
    for n in range(parts):
        lines += [f"[train.shafts.s{n}]", f'between = ["d{n}", "d{n + 1}"]', "density = 7850"]
        lines += [f"sections = [{{ length = {1 / parts!r}, diameter = 0.1 }}]"]
    found = lw.free_vibration(lw.loads("\n".join(lines)))
    exact = brentq(lambda x: math.tan(x) - 2 * x / (x * x - 1), 1.1, 1.5)
    x = 2 * math.pi * found.natural_frequencies[1] / math.sqrt(k / J)
    assert x == pytest.approx(exact, rel=0.14 / parts**2)


def test_a_shaft_to_the_ground_gives_half_its_inertia() -> None:
    machine = lw.loads("""
        format = 1
        name = "Held"
        [train.discs]
        a = { inertia = 1.0 }
        [train.shafts.s]
        between = ["ground", "a"]
        density = "7.85 g/cm^3"
        sections = [{ length = "300 mm", diameter = "100 mm" }]
    """)
    J = 1.0 + section().inertia(7850) / 2
    found = lw.free_vibration(machine)
    omega = math.sqrt(79.3e9 / section().flexibility / J)
    assert 2 * math.pi * found.natural_frequencies[0] == pytest.approx(omega, rel=1e-12)


def test_a_density_without_sections_is_told() -> None:
    text = FILE.replace('shear_modulus = "80 GPa"', "density = 7850\nstiffness = 1e6")
    text = text[: text.index("sections")]
    with pytest.raises(MachineError, match=r"the sections whose inertia it gives"):
        lw.loads(text)


def test_a_row_with_steps() -> None:
    """A step lengthens its thinner side, before it or after it."""
    row = [
        section(fillet=0.0),
        section(diameter=0.2, fillet=0.01),
        section(diameter=0.1, inner_diameter=0.05),
    ]
    plain = [each.flexibility for each in row]
    found = flexibilities(row)
    assert found[0] - plain[0] == pytest.approx(closed.step_length(0.1, 0.2) / polar(0.1), rel=1e-9)
    assert found[1] == plain[1]
    added = closed.step_length(0.1, 0.2, 0.01, 0.05) / polar(0.1, 0.05)
    assert found[2] - plain[2] == pytest.approx(added, rel=1e-9)
    without = [each.model_copy(update={"fillet": None}) for each in row]
    assert flexibilities(without) == tuple(plain)
    backwards = [
        section(diameter=0.1, inner_diameter=0.05, fillet=0.01),
        section(diameter=0.2, fillet=0.0),
        section(),
    ]
    assert flexibilities(backwards)[::-1] == pytest.approx(found, rel=ROUNDING)


def test_place_along_a_row() -> None:
    row = [section(), section(kind="taper", diameter_end=0.05), section(diameter=0.05)]
    parts = np.array(flexibilities(row))
    ends = np.concatenate([[0], np.cumsum(parts)]) / parts.sum()
    assert [place(row, float(share)) for share in ends] == pytest.approx([0, 0.3, 0.6, 0.9], abs=1e-12)


FILE = """
format = 1
name = "Propeller shaft"
[train.discs]
engine = { inertia = "40 kg m^2" }
propeller = { inertia = "60 kg m^2" }
[train.shafts.line]
between = ["engine", "propeller"]
shear_modulus = "80 GPa"
sections = [
  { kind = "flange", length = "40 mm", diameter = "150 mm", bolt_circle = "260 mm", fillet = "10 mm" },
  { length = "2 m", diameter = "150 mm", fillet = "5 mm" },
  { length = "300 mm", diameter = "170 mm", keyway_width = "40 mm", keyway_depth = "16 mm" },
  { kind = "spline", length = "120 mm", diameter = "140 mm", root_diameter = "125 mm" },
  { kind = "taper", length = "350 mm", diameter = "140 mm", diameter_end = "110 mm" },
  { kind = "hub", length = "300 mm", diameter = "110 mm", share = 0.4 },
]
"""


def test_sections_of_a_machine_file() -> None:
    """All kinds in one shaft: k = 1/Σe, and ω² = k (J₁ + J₂)/(J₁ J₂)."""
    machine = lw.loads(FILE)
    assert machine.train is not None
    listed = tomllib.loads(FILE)["train"]["shafts"]["line"]["sections"]
    row = [ShaftSection.model_validate(each) for each in listed]
    e = sum(flexibilities(row)) / 80e9
    assert machine.train.shafts["line"].rate == pytest.approx(1 / e, rel=ROUNDING)
    found = lw.free_vibration(machine)
    assert found.natural_frequencies[1] * 2 * math.pi == pytest.approx(math.sqrt(100 / 2400 / e), rel=1e-12)
    (node,) = found.nodes[1]
    assert node.distance == pytest.approx(place(row, node.share), rel=1e-12)


@pytest.mark.parametrize(
    ("entries", "key", "words"),
    [
        ({"kind": "taper"}, "diameter_end", 'which the kind "taper" needs'),
        ({"kind": "flange"}, "bolt_circle", 'which the kind "flange" needs'),
        ({"kind": "spline"}, "root_diameter", 'which the kind "spline" needs'),
        ({"bolt_circle": 0.2}, "bolt_circle", 'no such entry for the kind "cylinder"'),
        ({"kind": "taper", "diameter_end": 0.1, "share": 0.5}, "share", "no such entry"),
        ({"inner_diameter": 0.1}, "inner_diameter", "a bore smaller than the diameter, 0.1 m"),
        ({"kind": "taper", "diameter_end": 0.05, "inner_diameter": 0.06}, "inner_diameter", "0.05 m"),
        ({"kind": "taper", "diameter_end": 0.05, "inner_diameter_end": 0.06}, "inner_diameter_end", "0.05 m"),
        ({"kind": "flange", "bolt_circle": 0.09}, "bolt_circle", "a circle larger than the shaft, 0.1 m"),
        ({"kind": "flange", "bolt_circle": 0.2, "fillet": 0.03}, "fillet", "a quarter of the diameter"),
        ({"kind": "spline", "root_diameter": 0.1}, "root_diameter", "less than over the teeth, 0.1 m"),
        ({"kind": "spline", "root_diameter": 0.08, "inner_diameter": 0.09}, "inner_diameter", "0.08 m"),
        ({"keyway_width": 0.02}, "keyway_depth", "both width and depth"),
        ({"keyway_depth": 0.02}, "keyway_width", "both width and depth"),
        ({"keyway_width": 0.05, "keyway_depth": 0.01}, "keyway_width", "0.4 of the diameter, 0.04 m"),
        ({"keyway_width": 0.02, "keyway_depth": 0.03}, "keyway_depth", "0.6 of the wall, 0.02 m"),
        ({"kind": "hub", "share": 1.5}, "share", "above 0 and up to 1"),
        ({"diameter": -0.1}, "diameter", "greater than 0"),
    ],
)
def test_faults_of_a_section(entries: dict[str, object], key: str, words: str) -> None:
    with pytest.raises(ValidationError) as caught:
        section(**entries)
    told = [each for each in caught.value.errors() if each["loc"] == (key,)]
    assert told, caught.value.errors()
    assert words in told[0]["msg"]


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('fillet = "5 mm"', 'fillet = "12 mm"', r"sections\.1\.fillet.*at most 0.01 m"),
        ("share = 0.4", 'fillet = "1 mm"', r"sections\.5\.fillet"),
        (
            'keyway_depth = "16 mm"',
            'keyway_depth = "16 mm", fillet = 0',
            r"sections\.2\.fillet.*a cylinder or a taper",
        ),
    ],
)
def test_faults_of_fillets(old: str, new: str, words: str) -> None:
    with pytest.raises(MachineError) as caught:
        lw.loads(FILE.replace(old, new))
    assert re.search(words, " ".join(str(caught.value).split()))
