"""Geometry of crank throws: faults, and inertia against quadrature of the shapes themselves."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import ValidationError
from scipy.integrate import quad
from sizes import cases

from linkwright import InputError
from linkwright.torsion import CrankThrow, published_inertia
from linkwright.torsion.model.engine.polygon import area_moments, first_crossing, holds, signed_area
from linkwright.torsion.model.engine.throw_inertia import throw_inertia

# Rounding of closed forms over a few operations.
ROUNDING = 1e-13

JOURNAL = {"length": "60 mm", "diameter": "100 mm"}
PIN = {"length": "70 mm", "diameter": "90 mm"}
WEB = {"thickness": "30 mm", "width": "140 mm"}


def throw(**entries: object) -> CrankThrow:
    """A throw of 90 mm with plain journal, pin and rectangular webs, unless said otherwise."""
    return CrankThrow.model_validate(
        {"radius": "90 mm", "journal": JOURNAL, "pin": PIN, "web": WEB, **entries}
    )


def polygon(along: str, across: str) -> dict[str, object]:
    return {**WEB, "outline": "polygon", "along": along, "across": across}


def grid_moments(full: object, low: float, high: float, n: int = 2000) -> tuple[float, float, float, float]:
    """Area, its first moments along and across, and polar moment about the axis, by the middle-point rule."""
    at = low + (np.arange(n) + 0.5) * (high - low) / n
    x, y = np.meshgrid(at, at, indexing="ij")
    inside = full(x, y) * ((high - low) / n) ** 2  # type: ignore[operator]
    return inside.sum(), (inside * x).sum(), (inside * y).sum(), (inside * (x**2 + y**2)).sum()


# An edge along the grid may be wrong by half a cell, of some 1000 across a shape.
GRID = 2e-3


def test_journal_pin_and_webs() -> None:
    """m/8 (D² + d²), m(a² + b²)/12, and Steiner's term."""
    each = throw(pin={**PIN, "inner_diameter": "40 mm"}, density=8000)
    found = throw_inertia(each)
    journal = 8000 * math.pi / 4 * 0.1**2 * 0.06
    pin = 8000 * math.pi / 4 * (0.09**2 - 0.04**2) * 0.07
    web = 8000 * 0.14 * 0.185 * 0.06
    middle = (0.09 + 0.045 - 0.05) / 2
    J = journal * 0.1**2 / 8 + pin * ((0.09**2 + 0.04**2) / 8 + 0.09**2)
    J += web * ((0.14**2 + 0.185**2) / 12 + middle**2)
    assert found.mass == pytest.approx(journal + pin + web, rel=ROUNDING)
    assert found.inertia == pytest.approx(J, rel=ROUNDING)
    assert found.static_moment == pytest.approx((pin * 0.09 + web * middle, 0.0), rel=ROUNDING)
    assert found.unbalance == pytest.approx(pin * 0.09 + web * middle, rel=ROUNDING)
    assert sum(part.mass for part in found.parts) == pytest.approx(found.mass, rel=ROUNDING)
    assert each.length == pytest.approx(0.19, rel=ROUNDING)


def test_a_bore_beside_the_axis_of_the_pin() -> None:
    each = throw(pin={**PIN, "inner_diameter": "40 mm", "bore_offset": "12 mm"}, density=1000)
    _, m_x, _, J = grid_moments(
        lambda x, y: (np.hypot(x - 0.09, y) < 0.045) & (np.hypot(x - 0.102, y) > 0.02), -0.15, 0.15
    )
    parts = [part for part in throw_inertia(each).parts if part.name.startswith("pin")]
    assert sum(part.inertia for part in parts) == pytest.approx(70 * J, rel=GRID)
    assert sum(part.mass * part.centre[0] for part in parts) == pytest.approx(70 * m_x, rel=GRID)


OUTLINES = {
    "rectangle": (
        {**WEB, "length": "200 mm", "centre": "30 mm"},
        lambda x, y: (np.abs(x - 0.03) < 0.1) & (np.abs(y) < 0.07),
    ),
    "disc": (
        {"thickness": "30 mm", "outline": "disc", "diameter": "240 mm", "centre": "35 mm"},
        lambda x, y: np.hypot(x - 0.035, y) < 0.12,
    ),
    "polygon": (
        # A hollow on one side, and corners given clockwise.
        polygon("-60, 0, 140, 140, 40, -60 mm", "70, 50, 70, -60, -30, -70 mm"),
        lambda x, y: (
            (x > -0.06)
            & (x < 0.14)
            & (y < np.where(x < 0, 0.07 - (x + 0.06) / 3, 0.05 + x / 7))
            & (y > np.where(x < 0.04, -0.07 + 0.4 * (x + 0.06), -0.03 - 0.3 * (x - 0.04)))
        ),
    ),
}


@pytest.mark.parametrize("name", OUTLINES)
def test_webs_against_quadrature(name: str) -> None:
    web, full = OUTLINES[name]
    area, m_x, m_y, J = grid_moments(full, -0.16, 0.16)
    (part,) = (part for part in throw_inertia(throw(web=web, density=1000)).parts if part.name == "webs")
    assert part.mass == pytest.approx(60 * area, rel=GRID)
    assert part.mass * part.centre[0] == pytest.approx(60 * m_x, rel=GRID)
    assert part.mass * part.centre[1] == pytest.approx(60 * m_y, rel=GRID, abs=GRID * part.mass * 0.1)
    assert part.inertia == pytest.approx(60 * J, rel=GRID)


def test_a_rectangle_as_a_polygon() -> None:
    """Either way round, the first corner repeated or not."""
    plain = throw_inertia(throw())
    for along, across in (
        ("-50, 135, 135, -50 mm", "-70, -70, 70, 70 mm"),
        ("-50, -50, 135, 135, -50 mm", "-70, 70, 70, -70, -70 mm"),
    ):
        found = throw_inertia(throw(web=polygon(along, across)))
        assert found.inertia == pytest.approx(plain.inertia, rel=1e-12)
        assert found.static_moment == pytest.approx(plain.static_moment, rel=1e-12, abs=1e-15)


@pytest.mark.parametrize("inclination", [0.0, 0.4, math.pi / 2])
def test_a_drilling_against_quadrature(inclination: float) -> None:
    """∫ over its length of a disc across its axis: I of a disc about an axis at γ, and Steiner along it."""
    drilling = {"diameter": 0.02, "length": 0.11, "radius": 0.05, "inclination": inclination}
    (part,) = (each for each in throw_inertia(throw(drillings=[drilling])).parts if "drill" in each.name)
    area, r = math.pi * 0.01**2, 0.01

    def slice_about_the_shaft(s: float) -> float:
        own = area * r**2 / 4 * (2 * math.cos(inclination) ** 2 + math.sin(inclination) ** 2)
        return own + area * (0.05 + s * math.sin(inclination)) ** 2

    J, _ = quad(slice_about_the_shaft, -0.055, 0.055)
    assert part.inertia == pytest.approx(-7850 * J, rel=1e-12)
    assert part.mass == pytest.approx(-7850 * area * 0.11, rel=ROUNDING)


def test_a_sector_against_quadrature() -> None:
    weight = {
        "outer_radius": 0.14,
        "inner_radius": 0.06,
        "angle": "100 deg",
        "thickness": 1.0,
        "density": 1.0,
    }
    (part,) = (each for each in throw_inertia(throw(counterweights=[weight])).parts if "weight" in each.name)
    area, m_x, m_y, J = grid_moments(
        lambda x, y: (
            (np.hypot(x, y) < 0.14) & (np.hypot(x, y) > 0.06) & (np.abs(np.arctan2(y, -x)) < np.radians(50))
        ),
        -0.15,
        0.15,
    )
    assert part.mass == pytest.approx(area, rel=GRID)
    assert (part.mass * part.centre[0], part.mass * part.centre[1]) == pytest.approx(
        (m_x, m_y), rel=GRID, abs=1e-9
    )
    assert part.inertia == pytest.approx(J, rel=GRID)


def test_a_counterweight_that_balances() -> None:
    """As much static moment opposite the crank leaves none; its direction is counted from the crank."""
    out = throw_inertia(throw()).unbalance
    weight = {"mass": out / 0.1, "radius": 0.1, "inertia": 0.004}
    balanced = throw_inertia(throw(counterweights=[weight]))
    assert balanced.unbalance == pytest.approx(0.0, abs=1e-15)
    assert balanced.inertia - throw_inertia(throw()).inertia == pytest.approx(0.004 + out * 0.1, rel=1e-12)
    beside = throw_inertia(throw(counterweights=[{**weight, "direction": "90 deg"}]))
    assert beside.static_moment == pytest.approx((out, out), rel=1e-12)


def test_a_counterweight_on_each_web() -> None:
    one = {"mass": 1.2, "radius": 0.11}
    two = throw_inertia(throw(counterweights=[one, one]))
    assert two.inertia - throw_inertia(throw()).inertia == pytest.approx(2.4 * 0.11**2, rel=1e-12)


def test_the_published_formula() -> None:
    """(16), written out; exact while drillings are parallel and bores concentric."""
    disc = {"thickness": "30 mm", "outline": "disc", "diameter": "240 mm", "centre": "35 mm"}
    parallel = [{"diameter": 0.02, "length": 0.05, "radius": 0.06}, {"diameter": 0.03, "length": 0.06}]
    plain = throw(pin={**PIN, "inner_diameter": "40 mm"}, web=disc, drillings=parallel)
    quarter = math.pi / 4
    written = 7850 * (
        quarter * (0.09**2 - 0.04**2) * 0.07 * ((0.09**2 + 0.04**2) / 8 + 0.09**2)
        + quarter * 0.1**2 * 0.06 * 0.1**2 / 8
        + quarter * 0.24**2 * 0.06 * (0.24**2 / 8 + 0.035**2)
        - quarter * 0.02**2 * 0.05 * (0.02**2 / 8 + 0.06**2)
        - quarter * 0.03**2 * 0.06 * 0.03**2 / 8
    )
    assert published_inertia(plain) == pytest.approx(written, rel=ROUNDING)
    assert throw_inertia(plain).inertia == pytest.approx(written, rel=1e-12)
    # An oblique drilling takes m l²/12 sin²γ more than (16) says, but for its thickness.
    oblique = throw(
        web=disc, drillings=[{"diameter": 0.01, "length": 0.12, "radius": 0.05, "inclination": 0.6}]
    )
    mass, sine = 7850 * quarter * 0.01**2 * 0.12, math.sin(0.6) ** 2
    more = mass * sine * (0.12**2 / 12 - 0.01**2 / 16)
    assert published_inertia(oblique) - throw_inertia(oblique).inertia == pytest.approx(more, rel=1e-9)


def test_the_published_formula_is_for_discs() -> None:
    with pytest.raises(InputError, match=r'webs of outline "rectangle", expected "disc"'):
        published_inertia(throw())


def test_more_holes_than_metal_are_told() -> None:
    with pytest.raises(InputError, match="left after drillings and bores"):
        throw_inertia(throw(drillings=[{"diameter": 0.2, "length": 1.0, "radius": 0.1}]))


@st.composite
def stars(draw: st.DrawFn) -> tuple[tuple[float, float], ...]:
    n = draw(st.integers(3, 9))
    radii = [draw(st.floats(0.1, 1.0)) for _ in range(n)]
    x, y = draw(st.floats(-50, 50)), draw(st.floats(-50, 50))
    corners = tuple(
        (x + r * math.cos(2 * math.pi * j / n), y + r * math.sin(2 * math.pi * j / n))
        for j, r in enumerate(radii)
    )
    return corners[::-1] if draw(st.booleans()) else corners


@given(stars(), st.floats(0, 6.28))
@settings(max_examples=cases(80, 800), deadline=None)
def test_polygons_turned_and_taken_apart(corners: tuple[tuple[float, float], ...], angle: float) -> None:
    """The middle and the moments go with the turning; triangles from a corner add up to the whole."""
    area, centre, polar = area_moments(corners)
    c, s = math.cos(angle), math.sin(angle)
    turned = area_moments(tuple((c * x - s * y, s * x + c * y) for x, y in corners))
    assert turned.area == pytest.approx(area, rel=1e-9)
    assert turned.polar == pytest.approx(polar, rel=1e-7)
    assert turned.centroid == pytest.approx(
        (c * centre[0] - s * centre[1], s * centre[0] + c * centre[1]), abs=1e-9
    )
    # A triangle: A/36 times the sum of the squares of its sides.
    J = 0.0
    for a, b in pairwise(corners[1:]):
        triangle = (corners[0], a, b)
        size = signed_area(triangle)
        middle = [sum(p[n] for p in triangle) / 3 for n in (0, 1)]
        squares = sum(math.dist(p, q) ** 2 for p, q in ((corners[0], a), (a, b), (b, corners[0])))
        J += size * (squares / 36 + math.dist(middle, centre) ** 2)
    assert abs(J) == pytest.approx(polar, rel=1e-7)
    assert first_crossing(corners) is None


@pytest.mark.parametrize(
    ("corners", "crossing"),
    [
        (((0, 0), (1, 1), (1, 0), (0, 1)), (0, 2)),
        (((0, 0), (2, 0), (2, 1), (1, 0), (0, 1)), (0, 2)),
        (((0, 0), (2, 0), (1, 0), (1, 1)), (0, 1)),
        (((0, 0), (1, 0), (1, 1), (2, 0)), (0, 3)),
        (((0, 0), (1, 0), (1, 0), (0, 1)), (0, 1)),
        (((1, 0), (0, 1), (0, 0), (2, 0)), (0, 2)),
        (((0, 0), (1, 0), (2, 0), (2, 2), (0, 2)), None),
    ],
)
def test_outlines_that_meet_themselves(
    corners: tuple[tuple[float, float], ...], crossing: tuple[int, int] | None
) -> None:
    assert first_crossing(corners) == crossing


def test_inside_and_outside() -> None:
    corners = ((0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (2.0, 1.0), (0.0, 4.0))
    assert holds(corners, (1.0, 1.0))
    assert not holds(corners, (2.0, 2.0))
    assert not holds(corners, (-1.0, 1.0))


@pytest.mark.parametrize(
    ("entries", "place", "words"),
    [
        ({"journal": {**JOURNAL, "inner_diameter": 0.1}}, "journal.inner_diameter", "a bore smaller than"),
        (
            {"pin": {**PIN, "inner_diameter": 0.08, "bore_offset": 0.006}},
            "pin.bore_offset",
            "less than 0.005 m",
        ),
        ({"web": {"thickness": 0.03}}, "web.width", 'which the outline "rectangle" needs'),
        ({"web": {**WEB, "diameter": 0.2}}, "web.diameter", 'no entry for the outline "rectangle"'),
        ({"web": {**WEB, "centre": 0.02}}, "web.length", "the rectangle that the centre is of"),
        ({"web": {**WEB, "length": 0.08}}, "web.length", "the axis of the pin"),
        ({"web": {**WEB, "length": 0.1, "centre": 0.09}}, "web.length", "the axis of the shaft"),
        ({"web": {"thickness": 0.03, "outline": "disc"}}, "web.diameter", "which the outline"),
        (
            {"web": {"thickness": 0.03, "outline": "disc", "diameter": 0.16, "centre": 0.0}},
            "web.diameter",
            "axis of the pin goes through, 0.09 m along",
        ),
        (
            {"web": polygon("-50, 140, 140, -50 mm", "-70, 70, -70, 70 mm")},
            "web.along",
            "does not touch or cross",
        ),
        (
            {"web": polygon("-50, 140, 140, -50 mm", "-70, 70, -70 mm")},
            "web.across",
            "as many lengths as in along, 4",
        ),
        ({"web": polygon("-50, 140 mm", "-70, 70 mm")}, "web.along", "at least three corners"),
        (
            {"web": polygon("50, 140, 140, 50 mm", "-70, -70, 70, 70 mm")},
            "web.along",
            "the axis of the shaft",
        ),
        ({"counterweights": [{}]}, "counterweights.0.mass", "an entry"),
        ({"counterweights": [{"mass": 1}]}, "counterweights.0.radius", "an entry beside mass"),
        ({"counterweights": [{"mass": 1, "radius": 0.1, "angle": 1}]}, "counterweights.0.angle", "no angle"),
        (
            {"counterweights": [{"outer_radius": 0.1, "inner_radius": 0.1, "angle": 1, "thickness": 0.1}]},
            "counterweights.0.inner_radius",
            "less than the outer radius, 0.1 m",
        ),
        (
            {"counterweights": [{"outer_radius": 0.1, "angle": "370 deg", "thickness": 0.1}]},
            "counterweights.0.angle",
            "up to 360°",
        ),
        ({"radius": 0}, "radius", "greater than 0"),
        ({"density": "7.85 kg"}, "density", "a density"),
    ],
)
def test_faults_of_a_throw(entries: dict[str, object], place: str, words: str) -> None:
    with pytest.raises(ValidationError) as caught:
        throw(**entries)
    told = {".".join(map(str, each["loc"])): each["msg"] for each in caught.value.errors()}
    assert words in told.get(place, ""), told
