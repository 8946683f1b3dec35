"""Curves as arcs, splines and chords keep the tolerance asked for, with the orders that theory says."""

from __future__ import annotations

import math

import numpy as np
import pytest
from brute_force import area, distances, length, samples
from cam_outlines import (
    CAMS,
    TURN,
    Cam,
    cycloidal,
    dwells,
    eccentric,
    flat_face,
    harmonic,
    knife_edge,
    roller,
    zigzag,
)
from sizes import DEEP

from linkwright import ConvergenceError, ExchangeError, InputError
from linkwright.cam import Form, MotionLaw, Piece, Track
from linkwright.cam.manufacture.arcs import equal_errors
from linkwright.cam.manufacture.fit import Path, deviation, fit
from linkwright.cam.manufacture.outline import Outline

TOLERANCES = (1e-4, 1e-5, 1e-6, 1e-7, 1e-8) if DEEP else (1e-4, 1e-8)

# Sides of the polygons by which distances are checked, for a curve of 0.3 m. With their root over the length
# their own chords, c²/(8r), err by at most 4e-10 m: cams of other sizes have other radii.
_SAMPLES, _CHORD = 60_000, 4e-10


def _blur(tolerance: float) -> float:
    """What the chords of the polygons may add [m]: a thousandth of a coarse tolerance takes fewer sides."""
    return max(_CHORD, 1e-3 * tolerance)


@pytest.mark.parametrize("name", CAMS)
def test_derivatives_of_the_cams_are_right(name: str) -> None:
    """What the other tests stand on; a central difference of step h errs by h²/6 of the third derivative."""
    cam, h = CAMS[name], 1e-5
    phi = np.linspace(0.013, 6.27, 50)
    for f, slope in ((cam.points, cam.tangents), (cam.tangents, cam.seconds)):
        scale = np.abs(slope(phi)).max()
        np.testing.assert_allclose((f(phi + h) - f(phi - h)) / (2 * h), slope(phi), atol=1e-6 * scale)


def _both_ways(cam: Cam, form: Form, tolerance: float) -> tuple[float, float, float]:
    """Largest distance there and back by brute force, and what was measured."""
    track = Track.of(cam)
    path, found = fit(track, form, tolerance)
    n = int(_SAMPLES * (_CHORD / _blur(tolerance) * max(1, length(cam) / 0.3)) ** 0.5)
    curve, places = samples(cam, n), _along(path, n)
    return distances(places, curve).max(), distances(curve, places).max(), found.largest


def _along(path: Path, n: int) -> np.ndarray:
    """Places along a path, so many a side as its chord asks for."""
    chords = np.linalg.norm(np.roll(path.vertices, -1, axis=0) - path.vertices, axis=1)
    counts = np.ceil(n * chords / chords.sum()).astype(int) + 1
    which = np.repeat(np.arange(len(counts)), counts)
    u = np.concatenate([np.arange(k) / k for k in counts])
    return path.at(which, u[:, None])[:, 0]


@pytest.mark.deep
@pytest.mark.parametrize("tolerance", TOLERANCES)
@pytest.mark.parametrize("name", CAMS)
def test_arcs_keep_the_tolerance(name: str, tolerance: float) -> None:
    forth, back, measured = _both_ways(CAMS[name], "arcs", tolerance)
    assert max(forth, back) <= tolerance + _blur(tolerance)
    assert measured <= tolerance
    # The samples cannot find more than there is; that they find nearly all shows that nothing is estimated.
    assert max(forth, back) == pytest.approx(measured, rel=0.02, abs=_blur(tolerance))


@pytest.mark.deep
@pytest.mark.parametrize("tolerance", TOLERANCES)
@pytest.mark.parametrize("form", ["spline", "cubic"])
@pytest.mark.parametrize("name", CAMS)
def test_splines_keep_the_tolerance(name: str, form: Form, tolerance: float) -> None:
    forth, back, measured = _both_ways(CAMS[name], form, tolerance)
    assert max(forth, back) <= tolerance + _blur(tolerance)
    assert max(forth, back) == pytest.approx(measured, rel=0.02, abs=_blur(tolerance))
    assert measured <= tolerance


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6])
@pytest.mark.parametrize("name", CAMS)
def test_chords_keep_the_tolerance(name: str, tolerance: float) -> None:
    forth, back, measured = _both_ways(CAMS[name], "polyline", tolerance)
    assert max(forth, back) <= tolerance + _blur(tolerance)
    assert max(forth, back) == pytest.approx(measured, rel=0.02, abs=_blur(tolerance))
    assert measured <= tolerance


@pytest.mark.parametrize(("form", "order"), [("arcs", 3), ("cubic", 4), ("polyline", 2)])
def test_number_of_pieces_grows_as_the_order_says(form: Form, order: int) -> None:
    """n ∝ tolerance^(−1/order), over decades; whole numbers of pieces a stretch blur it by a tenth."""
    cam = CAMS["large"]
    finest = (1e-4, 1e-6) if form == "polyline" else (1e-5, 1e-8)
    few, many = (fit(Track.of(cam), form, tolerance)[1].sides for tolerance in finest)
    assert math.log(many / few) / math.log(finest[0] / finest[1]) == pytest.approx(1 / order, rel=0.1)


def test_quintic_spline_errs_with_the_sixth_power() -> None:
    """Seventeen even pieces of a circle: h⁶ r/46080, with the circle's own derivatives of size r."""
    _, found = fit(Track.of(eccentric(1.0, 0.2)), "spline", 1e-5)
    assert found.largest == pytest.approx((2 * math.pi / found.sides) ** 6 / 46080, rel=0.01)


def test_number_of_arcs_is_near_the_least_for_biarcs() -> None:
    """Σ ∫ |κ′|^(1/3) ds/(324 tolerance)^(1/3) biarcs, two arcs each: the bound for equal errors."""
    cam, tolerance = CAMS["flat face"], 1e-8
    phi = np.linspace(0, 2 * math.pi, 200_001)[1:-1]
    t, t2 = cam.tangents(phi), cam.seconds(phi)
    speed = np.linalg.norm(t, axis=1)
    curvature = (t[:, 0] * t2[:, 1] - t[:, 1] * t2[:, 0]) / speed**3
    slope = np.gradient(curvature, phi) / speed
    # Jumps of the curvature at the breaks belong to no arc.
    inside = np.abs(phi[:, None] - np.array(cam.breaks)).min(axis=1) > 1e-4
    share = np.abs(slope) ** (1 / 3) * speed * inside
    least = 2 * float(share.sum() * (phi[1] - phi[0])) * (324 * tolerance) ** (-1 / 3)
    sides = fit(Track.of(cam), "arcs", tolerance)[1].sides
    assert least <= sides <= 1.15 * least + 8


def test_arcs_of_a_circle_are_the_circle() -> None:
    path, found = fit(Track.of(eccentric(0.03, 0.01)), "arcs", 1e-6)
    assert isinstance(path, Outline)
    assert found.sides == 4
    # A few units in the last place of coordinates of 0.04 m.
    assert found.largest < 5e-17
    assert path.area == pytest.approx(math.pi * 0.03**2, rel=1e-14)
    assert path.length == pytest.approx(math.tau * 0.03, rel=1e-14)


def test_a_dwell_is_one_arc_or_few() -> None:
    """Of a cam of two dwells, sides with the radius of a dwell cover it, each turning at most a quarter."""
    path, _ = fit(Track.of(knife_edge(dwells(0.02), 0.04)), "arcs", 1e-6)
    assert isinstance(path, Outline)
    radius = path.sides.lengths / np.abs(path.sides.turns)
    for dwell, angle in ((0.06, math.radians(60)), (0.04, math.radians(80))):
        own = np.abs(radius - dwell) < 1e-12
        assert own.sum() == 1
        assert path.sides.turns[own].sum() == pytest.approx(angle, rel=1e-12)


@pytest.mark.parametrize("name", CAMS)
def test_arcs_meet_without_kinks_but_at_corners(name: str) -> None:
    path, _ = fit(Track.of(CAMS[name]), "arcs", 1e-6)
    assert isinstance(path, Outline)
    # Directions of short arcs are known to rounding of their places over their length.
    assert (np.abs(path.kinks) > 1e-8).sum() == (2 if "corners" in name else 0)


@pytest.mark.parametrize("form", ["arcs", "polyline"])
@pytest.mark.parametrize("name", CAMS)
def test_areas_and_lengths(name: str, form: Form) -> None:
    """A path within the tolerance has an area within tolerance times length."""
    cam, tolerance = CAMS[name], 1e-6
    path, _ = fit(Track.of(cam), form, tolerance)
    assert isinstance(path, Outline)
    assert path.area == pytest.approx(area(cam), abs=tolerance * length(cam))
    # A parallel curve at distance d is longer by d times the angle that it turns.
    turn = float(np.abs(path.sides.turns).sum() + np.abs(path.kinks).sum())
    assert path.length == pytest.approx(length(cam), abs=tolerance * turn)


@pytest.mark.parametrize("name", ["dwells, cycloidal, roller", "flat face"])
def test_quintic_spline_has_the_curvature_of_the_curve(name: str) -> None:
    """At its knots; inner knots are repeated three times where the curvature goes on."""
    cam = CAMS[name]
    path, _ = fit(Track.of(cam), "spline", 1e-6)
    cuts, repeated = np.unique(path.knots, return_counts=True)
    assert set(repeated[1:-1]) <= {3, 4}
    assert (repeated[1:-1] == 3).sum() >= len(cuts) - 2 - 4
    h = 1e-4
    for x in cuts[1:-1]:
        for sign in (1, -1):
            y = np.array([x, x + sign * h])
            _, slope = path.values(np.clip(y, x - h, x + h) - (1e-12 if sign < 0 else 0))
            second = sign * (slope[1] - slope[0]) / h
            expected = cam.seconds(np.array([x]), "after" if sign > 0 else "before")[0]
            # A one-sided difference errs by h/2 times the third derivative.
            np.testing.assert_allclose(second, expected, atol=20 * h * np.abs(cam.points(y)).max() + 1e-8)


# -- what has no outline ----------------------------------------------------------------------------------


def test_undercut_is_told_with_its_angle() -> None:
    rise = math.radians(50)
    law = MotionLaw.of(
        0.0, (rise, cycloidal(0.02)), (rise, cycloidal(-0.02, 0.02)), (TURN - 2 * rise, Piece((0.0,)))
    )
    cam = roller(law, 0.04, 0.02)
    with pytest.raises(
        ExchangeError, match=r"turns back on itself at cam angle θ = \d+\.?\d*°.*larger base circle"
    ):
        Track.of(cam)


def test_gap_is_told_with_its_angle_and_size() -> None:
    law = MotionLaw.of(0.0, (math.pi, Piece((0.0, 0.02))), (math.pi, Piece((0.02, -0.01))))
    with pytest.raises(ExchangeError, match=r"gap of 10 mm at cam angle θ = 0°"):
        Track.of(knife_edge(law, 0.03))


def test_a_curve_without_size_is_told() -> None:
    with pytest.raises(ExchangeError, match="no size"):
        Track.of(Cam((0.0, math.tau), lambda phi, side: (0j * phi, 0j * phi, 0j * phi)))


def test_a_standstill_is_a_corner() -> None:
    """A flat face that turns about a point of the cam by 180°: s + s″ + r₀ = 0, a drop's tip."""
    tip = 0.02

    def places(phi: np.ndarray, side: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        here = (phi < math.pi) if side == "after" else (phi <= math.pi)
        z = np.where(here, tip * np.sin(phi) ** 3 * np.exp(1j * phi) + tip, tip)
        sin, cos, turn = np.sin(phi), np.cos(phi), np.exp(1j * phi)
        d1 = tip * (3 * sin**2 * cos + 1j * sin**3) * turn
        d2 = tip * (6 * sin * cos**2 - 3 * sin**3 + 6j * sin**2 * cos - sin**3) * turn
        return z, np.where(here, d1, 0j), np.where(here, d2, 0j)

    track = Track.of(Cam((0.0, math.pi, math.tau), places))
    assert track.period == pytest.approx(math.pi)
    path, found = fit(track, "arcs", 1e-6)
    assert found.largest <= 1e-6
    assert deviation(path, track).largest <= 1e-6


@pytest.mark.parametrize("tolerance", [0.0, -1e-6, math.nan, math.inf, 1e-15])
def test_impossible_tolerances_are_told(tolerance: float) -> None:
    with pytest.raises(InputError, match=r"tolerance .* expected at least"):
        fit(Track.of(eccentric(0.03, 0.01)), "arcs", tolerance)


def test_a_form_that_does_not_exist_is_told() -> None:
    with pytest.raises(InputError, match='form "circles": expected arcs, spline'):
        fit(Track.of(eccentric(0.03, 0.01)), "circles", 1e-6)  # type: ignore[arg-type]


def test_too_fine_a_tolerance_is_told() -> None:
    """Errors that do not fall, as where rounding is all that is left."""
    with pytest.raises(ConvergenceError, match=r"pieces between 0 and 1 rad .* use a wider one"):
        equal_errors(lambda cuts: np.full(len(cuts) - 1, 1e-12), 0.0, 1.0, 2.0, 1e-13)


def test_harmonic_law_ends_at_a_jump_of_curvature() -> None:
    """The cam of the tests has what it is named for."""
    cam = roller(dwells(0.015, harmonic), 0.05, 0.01)
    x = np.array([cam.breaks[1]])
    assert np.linalg.norm(cam.seconds(x, "after") - cam.seconds(x, "before")) > 0.01


def test_heart_has_corners_and_flat_face_has_none() -> None:
    heart, flat = knife_edge(zigzag(0.03), 0.02), flat_face(dwells(0.01), 0.06)
    for cam, corner in ((heart, True), (flat, False)):
        x = np.array([cam.breaks[1]])
        jump = np.linalg.norm(cam.tangents(x, "after") - cam.tangents(x, "before"))
        assert (jump > 1e-3) == corner
