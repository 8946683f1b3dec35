"""Geometry of cams against closed forms: eccentric, involute, spiral, Scotch yoke, support functions."""

from __future__ import annotations

import numpy as np
import pytest
from cam_cases import CIRCLES, TURN, Circle, contact, fitted, machine, profile_of, turned, unit

import linkwright as lw
from linkwright import cam_profile
from linkwright.cam import CamCurve, MotionLaw, Sizes, cam_kernel
from linkwright.cam.laws.motion_law import Harmonic, Piece

SEARCHED = ("tan_pressure_angle", "soundness", "bend_max", "bend_min")

PHI = np.linspace(0.0, TURN, 181)

# A fitted law is good to some 1e-16 of its size; each derivative loses the factor degree²/length of its
# Chebyshev pieces, about 13²/0.26 = 650.
PLACE, SLOPE, BEND = 1e-14, 1e-11, 1e-8


@pytest.fixture(params=CIRCLES, scope="module")
def case(request: pytest.FixtureRequest) -> tuple[Circle, object]:
    circle = CIRCLES[request.param]
    return circle, circle.contact()


# -- eccentric circle under every follower -------------------------------------------------------------------


def test_profile_is_the_circle(case) -> None:
    circle, found = case
    away = np.linalg.norm(profile_of(found).points(PHI) - circle.centre, axis=1) - circle.R
    # First derivatives of the law decide about the place of the contact, along the circle and so to second
    # order about the distance from it.
    assert np.abs(away).max() < SLOPE * circle.R


def test_pitch_curve_is_the_larger_circle(case) -> None:
    circle, found = case
    if circle.roller is None:
        return
    away = np.linalg.norm(CamCurve(found, 0.0).points(PHI) - circle.centre, axis=1) - circle.R - circle.roller
    assert np.abs(away).max() < 4 * PLACE


def test_curvature_is_that_of_the_circle(case) -> None:
    circle, found = case
    bend = found.kernel.rows(PHI)["bend"]
    wanted = circle.R if circle.roller is None else 1 / (circle.R + circle.roller)
    np.testing.assert_allclose(bend, wanted, rtol=BEND)


def test_normal_points_away_from_the_centre(case) -> None:
    circle, found = case
    rows = found.kernel.rows(PHI)
    normal = np.stack((rows["normal_x"], rows["normal_y"]), axis=1)
    outwards = profile_of(found).points(PHI) - circle.centre
    np.testing.assert_allclose(normal, outwards / np.linalg.norm(outwards, axis=1)[:, None], atol=SLOPE)


def test_pressure_angle_by_plain_geometry(case) -> None:
    """Angle from the way of the follower, a difference of its place, to the normal through the centre."""
    circle, found = case
    C = turned(circle.centre, circle.sense * PHI)
    place, direction = circle.follower(PHI)
    if circle.roller is None:
        touches = C + circle.R * direction
        n = direction
    else:
        touches = place
        n = (place - C) / np.linalg.norm(place - C, axis=1)[:, None]
    if circle.oscillating:
        arm = touches - np.array([circle.distance, 0.0])
        d = -circle.side * np.stack((-arm[:, 1], arm[:, 0]), axis=1)
        d /= np.linalg.norm(d, axis=1)[:, None]
    else:
        d = np.broadcast_to([1.0, 0.0], n.shape)
    gamma = np.arctan2(d[:, 0] * n[:, 1] - d[:, 1] * n[:, 0], (d * n).sum(axis=1))
    np.testing.assert_allclose(found.kernel.rows(PHI)["pressure_angle"], gamma, atol=SLOPE)


def test_follower_never_enters_the_circle_and_always_touches_it(case) -> None:
    """Without envelopes: the circle as points, seen from the ground, against roller and face."""
    circle, found = case
    points = profile_of(found).points(np.linspace(0, TURN, 4001))
    for phi in PHI[::9]:
        ground = turned(points, circle.sense * phi)
        place, direction = circle.follower(np.asarray(phi))
        if circle.roller is None:
            gap = -((ground - place) @ direction)
        else:
            gap = np.linalg.norm(ground - place, axis=1) - circle.roller
        # Neighbouring points of the circle are 2πR/4000 apart: between them lies half the square of that
        # over a radius.
        step = TURN * circle.R / 4000
        least = step**2 / 2 * (1 / circle.R + 1 / max(circle.roller or np.inf, 0.01))
        assert -1e-12 < gap.min() < least + (step if circle.roller == 0 else 0)


def test_place_on_the_face_counts_from_the_stem_or_the_pivot(case) -> None:
    circle, found = case
    if circle.roller is not None:
        return
    C = turned(circle.centre, circle.sense * PHI)
    _, n = circle.follower(PHI)
    touches = C + circle.R * n
    if circle.oscillating:
        q = circle.place(PHI)
        u = np.stack((-np.cos(q), circle.side * np.sin(q)), axis=1)
        along = ((touches - [circle.distance, 0.0]) * u).sum(axis=1)
    else:
        stem = np.stack((circle.place(PHI), 0 * PHI), axis=1)
        along = (touches - stem) @ np.array([-np.sin(circle.tilt), np.cos(circle.tilt)])
    np.testing.assert_allclose(found.kernel.rows(PHI)["along"], along, atol=SLOPE * circle.R)


def test_extremes_are_those_of_dense_samples_closed_in_on(case) -> None:
    """γ and the place on the face: golden section between dense samples."""
    circle, found = case
    shape = found.kernel.shape(720)
    rows = {"pressure_angle": lambda phi: found.kernel.rows(phi)["pressure_angle"]}
    if circle.roller is None:
        rows["along"] = lambda phi: found.kernel.rows(phi)["along"]
    for name, row in rows.items():
        for sign, extreme in ((1, shape.greatest[name]), (-1, shape.least[name])):
            wanted = _greatest(lambda phi, row=row, sign=sign: sign * row(phi))
            # A flat arm without offset has γ = 0 throughout, but for rounding.
            scale = max(np.abs(row(PHI)).max(), 1e-3)
            assert sign * extreme.value == pytest.approx(wanted, abs=1e-10 * scale)
            assert float(row(extreme.angle)[0]) == pytest.approx(extreme.value, abs=1e-12 * scale)


def _greatest(f) -> float:
    """Largest value over a revolution by dense samples and golden sections, without derivatives."""
    phi = np.linspace(0, TURN, 7201)
    i = int(np.argmax(f(phi)))
    low, high = phi[max(i - 1, 0)], phi[min(i + 1, 7200)]
    share = (np.sqrt(5) - 1) / 2
    for _ in range(60):
        a, b = high - share * (high - low), low + share * (high - low)
        low, high = (low, b) if f(a)[0] > f(b)[0] else (a, high)
    return float(f(0.5 * (low + high))[0])


def test_derivatives_of_the_profile_against_differences(case) -> None:
    """Central differences of order 4; at h = 2e-3, h⁴ and rounding over h² are near 1e-11 of the radius."""
    circle, found = case
    h, phi = 2e-3, PHI[3:-3] + 0.011
    for away in (0.0, -found.sizes.roller_radius, 0.004):
        curve = CamCurve(found, away)
        # The fit has its own rounding in the first derivative, which the place of a profile contains.
        p = [curve.points(phi + k * h) for k in (-2, -1, 0, 1, 2)]
        first = (p[0] - 8 * p[1] + 8 * p[3] - p[4]) / (12 * h)
        second = (-p[0] + 16 * p[1] - 30 * p[2] + 16 * p[3] - p[4]) / (12 * h * h)
        np.testing.assert_allclose(curve.tangents(phi), first, atol=1e-8 * circle.R)
        np.testing.assert_allclose(curve.seconds(phi), second, atol=1e-5 * circle.R)


# -- laws whose cams are known curves ------------------------------------------------------------------------


def test_scotch_yoke_is_an_eccentric_under_a_flat_face() -> None:
    """A harmonic law needs no fit: s = e (1 − cos φ) under a flat face is a circle, to rounding."""
    e, r0 = 0.01, 0.03
    law = MotionLaw((0.0, TURN), (Piece((e,), (Harmonic(TURN, -e, 0.0),)),))
    for opposite in (False, True):
        found = contact(
            law, Sizes(r0, 0.0, 0.0, 0.0, 0.0, 0.0), r0, oscillating=False, roller=False, opposite=opposite
        )
        away = np.linalg.norm(profile_of(found).points(PHI) - [-e, 0.0], axis=1)
        np.testing.assert_allclose(away, r0 + e, rtol=4e-16)
        np.testing.assert_allclose(found.kernel.rows(PHI)["bend"], r0 + e, rtol=1e-15)
        assert not found.kernel.rows(PHI)["pressure_angle"].any()


def test_scotch_yoke_moves_as_the_follower_does() -> None:
    """The same machine as a crank with a yoke: same places and the same transfer functions."""
    harmonic = """
sections = [
  { angle = "180 deg", lift = "20 mm", law = "harmonic" },
  { angle = "180 deg", lift = "-20 mm", law = "harmonic" },
]
contact = "flat"
base_radius = "30 mm"
"""
    both = machine(
        harmonic,
        '[mechanism.cranks.A]\nradius = "10 mm"\nphase = "180 deg"\n'
        '[mechanism.yokes.Y]\npin = "A"\nguide = { angle = 0 }\nslot = "90 deg"\n',
    )
    motion = lw.kinematics(both, np.arange(360) * TURN / 360)
    F, Y = motion.points["F"], motion.points["Y"]
    for name in ("d1", "d2"):
        np.testing.assert_allclose(getattr(F, name), getattr(Y, name), atol=1e-16)
    np.testing.assert_allclose(F.position - F.position[0], Y.position - Y.position[0], atol=1e-16)


def test_constant_velocity_of_a_flat_face_is_an_involute() -> None:
    """s = bφ under a flat face: p = r_0 + bφ is the support function of the involute of a circle of radius b.

    Its centre of curvature lies on that circle, its radius grows by b a radian."""
    b, r0 = 0.008, 0.03
    law = MotionLaw((0.0, np.pi, TURN), (Piece((0.0, b * np.pi)), Piece((b * np.pi, -b * np.pi))))
    found = contact(law, Sizes(r0, 0.0, 0.0, 0.0, 0.0, 0.0), r0, oscillating=False, roller=False)
    phi = np.linspace(0.01, np.pi - 0.01, 100)
    rows = found.kernel.rows(phi)
    np.testing.assert_allclose(rows["bend"], r0 + b * phi, rtol=1e-15)
    normal = np.stack((rows["normal_x"], rows["normal_y"]), axis=1)
    centre = profile_of(found).points(phi) - rows["bend"][:, None] * normal
    np.testing.assert_allclose(np.linalg.norm(centre, axis=1), b, rtol=1e-13)
    # The normal of an involute touches its base circle.
    np.testing.assert_allclose((centre * normal).sum(axis=1), 0, atol=1e-16)


def test_constant_velocity_of_an_edge_is_the_spiral_of_archimedes() -> None:
    """ρ = r_0 + bφ: tan γ = b/ρ and κ = (ρ² + 2b²)/(ρ² + b²)^(3/2)."""
    b, r0 = 0.008, 0.03
    law = MotionLaw((0.0, np.pi, TURN), (Piece((0.0, b * np.pi)), Piece((b * np.pi, -b * np.pi))))
    found = contact(law, Sizes(r0, 0.0, 0.0, 0.0, 0.0, 0.0), r0, oscillating=False, roller=True)
    phi = np.linspace(0.01, np.pi - 0.01, 100)
    rows, rho = found.kernel.rows(phi), r0 + b * phi
    np.testing.assert_allclose(profile_of(found).points(phi), rho[:, None] * unit(-phi), atol=1e-17)
    # The cam turns to the left, so its rising flank leans to the left of the follower.
    np.testing.assert_allclose(np.tan(rows["pressure_angle"]), b / rho, rtol=1e-14)
    np.testing.assert_allclose(rows["bend"], (rho**2 + 2 * b**2) / (rho**2 + b**2) ** 1.5, rtol=1e-14)


@pytest.mark.parametrize("offset", [0.0, 0.012, -0.012])
@pytest.mark.parametrize("rotation", ["same", "opposite"])
def test_pressure_angle_of_the_cycloidal_law(offset: float, rotation: str) -> None:
    """tan γ = (±s′ + e)/(√((r_0 + r)² − e²) + s) for a cam that turns to the left, to the right.

    Source: Norton, Cam Design and Manufacturing Handbook, 2nd ed., section 7.3."""
    beta, h, r0, r = np.radians(100), 0.02, 0.03, 0.01
    lines = f"""
sections = [
  {{ angle = "100 deg", lift = "20 mm", law = "cycloidal" }},
  {{ angle = "100 deg", lift = "-20 mm", law = "cycloidal" }},
  {{ angle = "160 deg" }},
]
base_radius = 0.03
roller_radius = 0.01
offset = {offset}
rotation = "{rotation}"
"""
    profile = cam_profile(machine(lines))
    sign = 1.0 if rotation == "same" else -1.0

    def tan_gamma(z, rising=1.0):
        s = h * (z - np.sin(TURN * z) / TURN)
        s1 = rising * h / beta * (1 - np.cos(TURN * z))
        return (sign * s1 + offset) / (np.sqrt((r0 + r) ** 2 - offset**2) + s)

    z = np.linspace(0, 1, 200001)
    up, down = np.abs(tan_gamma(z)), np.abs(tan_gamma(z, -1.0))
    wanted = np.arctan(max(up.max(), down.max()))
    # Samples 5e-6 apart miss a flat maximum by about 1e-11.
    assert profile.pressure_angle_max == pytest.approx(wanted, abs=1e-9)
    angle = profile.pressure_angle_max_angle
    z = angle / beta if angle <= beta else 2 - angle / beta
    there = tan_gamma(z, 1.0 if angle <= beta else -1.0)
    assert abs(np.arctan(there)) == pytest.approx(profile.pressure_angle_max, abs=1e-14)


# -- constant breadth and diameter ---------------------------------------------------------------------------


def test_support_function_of_constant_breadth() -> None:
    """p = a + b cos 3θ: breadth 2a in every direction, ρ = a − 8b cos 3θ, perimeter π times the breadth."""
    a, b = 0.05, 0.003
    law = MotionLaw((0.0, TURN), (Piece((b,), (Harmonic(3 * TURN, -b, 0.0),)),))
    size = Sizes(a - b, 0.0, 0.0, 0.0, 0.0, 0.0)
    found = contact(law, size, a - b, oscillating=False, roller=False)
    phi = np.linspace(0, TURN, 1001)[:-1]
    rows = found.kernel.rows(phi)
    np.testing.assert_allclose(rows["bend"], a + 8 * b * np.cos(3 * phi), rtol=2e-14)
    points = profile_of(found).points(np.linspace(0, TURN, 7201)[:-1])
    for direction in np.linspace(0, np.pi, 7):
        along = points @ unit(direction)
        # Between points of the polygon the breadth is short by less than ρ (2π/7200)²/8 at each side.
        assert along.max() - along.min() == pytest.approx(2 * a, abs=3e-8 * a)
    # The trapezoidal rule over a whole revolution of a smooth periodic function is exact to rounding.
    speed = np.linalg.norm(profile_of(found).tangents(phi), axis=1)
    assert speed.mean() * TURN == pytest.approx(np.pi * 2 * a, rel=1e-14), "Barbier's theorem"


BREADTH = """
follower = "translating"
contact = "{contact}"
closure = "{closure}"
{size}
sections = [
  {{ angle = "60 deg" }},
  {{ angle = "120 deg", lift = "15 mm", law = "{law}" }},
  {{ angle = "60 deg" }},
  {{ angle = "120 deg", lift = "-15 mm", law = "{law}" }},
]
"""


@pytest.mark.parametrize(
    ("closure", "kind", "size"),
    [
        ("constant_diameter", "point", 'base_radius = "30 mm"'),
        ("constant_diameter", "point", 'breadth = "75 mm"'),
        ("constant_diameter", "roller", 'breadth = "95 mm"\nroller_radius = "10 mm"'),
        ("constant_breadth", "flat", 'breadth = "200 mm"'),
        ("constant_breadth", "flat", 'breadth = "200 mm"\nface_tilt = "20 deg"'),
        ("constant_breadth", "flat", 'base_radius = "90 mm"\nface_tilt = "-20 deg"'),
    ],
)
def test_two_followers_touch_one_cam_at_every_angle(closure: str, kind: str, size: str) -> None:
    made = machine(BREADTH.format(contact=kind, closure=closure, size=size, law="polynomial_3_4_5"))
    profile = cam_profile(made)
    both = profile.opposite
    assert both is not None
    assert both.is_constant
    assert profile.diameter_max - profile.diameter_min < 1e-12 * both.breadth
    first, second = profile.flanks
    cam, size_of = made.mechanism.cams["F"], first.contact.sizes
    points = first.curve().points(np.linspace(0, TURN, 7201))
    tilt = np.cos(cam.face_tilt)
    for phi in PHI[:-1:6]:
        ground = turned(points, phi)
        s = float(first.contact.law.at(phi))
        ends = (first.contact.start + s, -(second.contact.start + float(second.contact.law.at(phi))))
        assert ends[0] - ends[1] == pytest.approx(both.breadth / tilt, rel=1e-14)
        for end, way in zip(ends, (1.0, -1.0), strict=True):
            if kind == "flat":
                normal = way * unit(cam.face_tilt)
                gap = -((ground - [end, 0.0]) @ normal)
            else:
                gap = np.linalg.norm(ground - [end, 0.0], axis=1) - size_of.roller_radius
            # Half the distance of points at most, squared over twice the smallest radius; an edge meets the
            # polygon up to half a side away.
            assert gap.min() < (8e-5 if kind == "point" else 1e-6)
            assert gap.min() > -1e-12


def test_breadth_that_is_given_is_kept() -> None:
    for kind, closure, extra in (
        ("flat", "constant_breadth", 'face_tilt = "20 deg"'),
        ("point", "constant_diameter", ""),
        ("roller", "constant_diameter", "roller_radius = 0.005"),
    ):
        lines = BREADTH.format(contact=kind, closure=closure, size=f"breadth = 0.2\n{extra}", law="harmonic")
        profile = cam_profile(machine(lines))
        first = profile.flanks[0].contact
        assert 2 * first.start + profile.stroke == pytest.approx(0.2, rel=1e-15)


# -- conjugate pairs -----------------------------------------------------------------------------------------

PAIR = """
closure = "conjugate"
base_radius = "40 mm"
roller_radius = "10 mm"
rotation = "{rotation}"
{more}
sections = [
  {{ angle = "110 deg", {lift} = {h}, law = "cycloidal" }},
  {{ angle = "50 deg" }},
  {{ angle = "120 deg", {lift} = -{h}, law = "modified_sine" }},
  {{ angle = "80 deg" }},
]
[mechanism.points]
P = {{ x = 0.03, y = 0.09 }}
"""


@pytest.mark.parametrize("rotation", ["same", "opposite"])
@pytest.mark.parametrize("side", ["left", "right"])
def test_second_roller_of_an_oscillating_pair_touches_its_cam(rotation: str, side: str) -> None:
    more = (
        f'follower = "oscillating"\narm_pivot = "P"\narm_length = "75 mm"\nside = "{side}"\n'
        'second = { angle = "95 deg", arm_length = "70 mm", roller_radius = "12 mm" }'
    )
    made = machine(PAIR.format(rotation=rotation, more=more, lift="swing", h=0.3))
    cam = made.mechanism.cams["F"]
    first, second = cam_profile(made).flanks
    # Ground: pivot and arms from the mechanism itself, which knows nothing of contacts.
    motion = lw.kinematics(made, np.arange(72) * TURN / 72)
    pivot, axis = np.array([0.03, 0.09]), np.arctan2(0.09, 0.03)
    sense, way = (1.0 if rotation == "same" else -1.0), (1.0 if side == "left" else -1.0)
    for flank, arm, turn, r in ((first, 0.075, 0.0, 0.01), (second, 0.070, 1.0, 0.012)):
        points = flank.curve().points(np.linspace(0, TURN, 14401))
        for k in range(0, 72, 2):
            phi = TURN * k / 72 - cam.phase
            to_roller = (motion.points["F"].position[k] - pivot) / 0.075
            # Arms to the left of the line to the pivot turn backwards to get to the other side.
            centre = pivot + arm * turned(to_roller, way * turn * np.radians(95))
            gap = np.linalg.norm(turned(points, axis + sense * phi) - centre, axis=1) - r
            # Points are at most 4e-5 m apart: (2e-5)²/2/0.01 is 2e-8.
            assert -1e-13 < gap.min() < 4e-8


@pytest.mark.parametrize("rotation", ["same", "opposite"])
@pytest.mark.parametrize("offset", ["0 mm", "9 mm"])
def test_second_roller_of_a_translating_pair_touches_its_cam(rotation: str, offset: str) -> None:
    more = f'direction = "70 deg"\noffset = "{offset}"\nsecond = {{ distance = "125 mm" }}\nphase = "25 deg"'
    made = machine(PAIR.format(rotation=rotation, more=more, lift="lift", h=0.02))
    cam = made.mechanism.cams["F"]
    motion = lw.kinematics(made, np.arange(72) * TURN / 72)
    sense, axis = (1.0 if rotation == "same" else -1.0), np.radians(70)
    for flank, behind in zip(cam_profile(made).flanks, (0.0, 0.125), strict=True):
        points = turned(flank.curve().points(np.linspace(0, TURN, 14401)), flank.contact.turned)
        for k in range(0, 72, 2):
            phi = TURN * k / 72 - cam.phase
            centre = motion.points["F"].position[k] - behind * unit(axis)
            gap = np.linalg.norm(turned(points, axis + sense * phi) - centre, axis=1) - 0.01
            assert -1e-13 < gap.min() < 4e-8


# -- joints --------------------------------------------------------------------------------------------------


def test_values_at_a_joint_have_two_sides() -> None:
    """A harmonic rise after a dwell: acceleration, and so curvature, jumps; both values count."""
    lines = """
sections = [
  { angle = "90 deg" },
  { angle = "90 deg", lift = "10 mm", law = "harmonic" },
  { angle = "90 deg" },
  { angle = "90 deg", lift = "-10 mm", law = "harmonic" },
]
base_radius = "40 mm"
roller_radius = "8 mm"
"""
    profile = cam_profile(machine(lines))
    kernel, q = profile.flanks[0].contact.kernel, 0.5 * np.pi
    before, after = (kernel.rows(q, before=side)["bend"][0] for side in (True, False))
    # A circle, then ρ = r² / (r − s″) in a place with s′ = 0; s″ = h/2 (π/β)² = 2h.
    assert before == pytest.approx(1 / 0.048, rel=1e-14)
    assert after == pytest.approx((0.048 - 0.02) / 0.048**2, rel=1e-13)
    at = profile.angle == q
    assert at.sum() == 2
    np.testing.assert_allclose(1 / (profile.curvature_radius[at] + 0.008), [before, after], rtol=1e-13)
    # At the end of the rise s″ = −2h: the tightest place of the cam is one side of that joint.
    top = (0.058 + 0.02) / 0.058**2
    assert profile.curvature_radius_convex_min == pytest.approx(1 / top - 0.008, rel=1e-13)
    assert profile.curvature_radius_min_angle == pytest.approx(np.pi, rel=1e-14)


def test_curve_at_a_joint_has_two_second_derivatives() -> None:
    law = MotionLaw((0.0, np.pi, TURN), (Piece((0.0,)), Piece((0.0, 0.0, 0.01, -0.02, 0.01))))
    found = contact(law, Sizes(0.04, 0.0, 0.0, 0.0, 0.0, 0.0), 0.04, oscillating=False, roller=True)
    curve, at = CamCurve(found, 0.0), np.array([np.pi])
    s2 = 0.02 / np.pi**2
    np.testing.assert_allclose(curve.seconds(at, "before"), [[0.04, 0.0]], atol=1e-17)
    np.testing.assert_allclose(curve.seconds(at, "after"), [[0.04 - s2, 0.0]], atol=1e-16)
    np.testing.assert_allclose(curve.points(at, "before"), curve.points(at, "after"), atol=1e-17)


def test_fit_of_a_law_is_good_to_rounding() -> None:
    """What the closed forms above rest on."""
    for circle in CIRCLES.values():
        law = circle.contact().law
        phi = np.linspace(0, TURN, 1777)
        s = circle.place(phi)
        assert np.ptp(law.at(phi) - s) < 4 * PLACE * s.max()


def test_lanes_are_the_scalar_kernel() -> None:
    """`search` of many cams against one cam at the same angles; and the same for any column of sizes."""
    rng = np.random.default_rng(5)
    law = fitted(lambda phi: 0.01 * (1 - np.cos(phi)) + 0.002 * np.sin(3 * phi) + 0.002)
    n = 37
    for oscillating in (False, True):
        for roller in (False, True):
            columns = [
                rng.uniform(0.03, 0.06, n),
                rng.uniform(0.002, 0.01, n) if roller else np.zeros(1),
                rng.uniform(-0.01, 0.01, n) if oscillating ^ roller else np.zeros(1),
                np.full(1, 0.14 if oscillating else 0.0),
                rng.uniform(0.09, 0.12, n) if oscillating else np.zeros(1),
                np.zeros(1) if oscillating or roller else rng.uniform(-0.3, 0.3, n),
                rng.uniform(0.5, 1.5, n),
            ]
            kernel = cam_kernel(law, Sizes(*np.zeros(6)), oscillating=oscillating, roller=roller)
            found = kernel.search(Sizes(*columns[:-1]), columns[-1], 360)
            for i in range(n):
                size = Sizes(*(float(column[i % len(column)]) for column in columns[:-1]))
                scaled = law.scaled(float(columns[-1][i]))
                one = cam_kernel(scaled, size, oscillating=oscillating, roller=roller)
                rows = one.shape(360).rows
                wanted = [
                    np.abs(np.tan(rows["pressure_angle"])).max(),
                    rows["soundness"].min(),
                    rows["bend"].max(),
                    rows["bend"].min(),
                ]
                scale = np.array([1.0, 1.0 if roller else 0.1, *[np.abs(rows["bend"]).max()] * 2])
                np.testing.assert_allclose(
                    [getattr(found, name)[i] for name in SEARCHED], wanted, rtol=0, atol=2e-13 * scale.max()
                )


def test_place_in_a_column_changes_no_bit() -> None:
    """The same columns in pieces, that begin in other lanes and tasks, and at once."""
    law = fitted(lambda phi: 0.01 * (1 - np.cos(phi)))
    kernel = cam_kernel(law, Sizes(*np.zeros(6)), oscillating=False, roller=True)
    base = np.linspace(0.01, 0.2, 1111)
    sizes = Sizes(base, 0.004, 0.001, 0.0, 0.0, 0.0)
    whole = kernel.search(sizes, 1.0, 180)
    pieces = np.split(base, [8, 300, 304])
    parts = [kernel.search(sizes._replace(base_radius=piece), 1.0, 180) for piece in pieces]
    for name in SEARCHED:
        together = np.concatenate([getattr(part, name) for part in parts])
        np.testing.assert_array_equal(getattr(whole, name), together)
