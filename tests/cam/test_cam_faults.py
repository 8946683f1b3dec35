"""Impossible and doubtful cams: undercut, crossing, hollow, locked, limits; each against brute force."""

from __future__ import annotations

import re

import numpy as np
import pytest
from cam_cases import TURN, contact, fitted, machine, turned

import linkwright as lw
from linkwright import FindingError, InputError, cam_cautions, cam_faults, cam_profile
from linkwright.cam import CamCurve, CamProfile, Sizes, base_for_pressure_angle, largest_roller
from linkwright.cam.core import crossings
from linkwright.cam.profile.least_sizes import base_for_curvature, least_sound_base

DENSE = np.linspace(0.0, TURN, 20001)

SHARP = """
sections = [
  { angle = "60 deg", lift = "20 mm", law = "cycloidal" },
  { angle = "40 deg" },
  { angle = "60 deg", lift = "-20 mm", law = "cycloidal" },
  { angle = "200 deg" },
]
"""


def profile(lines: str, sections: str = SHARP, rest: str = "") -> CamProfile:
    return cam_profile(machine(sections + lines, rest))


def told(lines: str, sections: str = SHARP, rest: str = "") -> str:
    found = cam_faults(profile(lines, sections, rest))
    assert len(found) == 1, found
    return found[0]


def numbers(text: str) -> list[float]:
    return [float(each) for each in re.findall(r"-?\d+(?:\.\d+)?(?:e-?\d+)?", text)]


def signed_spans(angle: np.ndarray, sound: np.ndarray) -> list[float]:
    """Ends of the stretches of dense samples where something is not sound, in degrees."""
    passes = np.flatnonzero(np.diff(sound))
    return sorted(np.degrees(0.5 * (angle[passes] + angle[passes + 1])).tolist())


# -- undercut ------------------------------------------------------------------------------------------------


def test_undercut_by_a_roller_is_where_it_cuts_into_its_own_profile() -> None:
    """Brute force: the roller at some angle covers a point that another angle made."""
    lines = 'base_radius = "8 mm"\nroller_radius = "14 mm"\n'
    text = told(lines)
    found = profile(lines).flanks[0]
    pitch = CamCurve(found.contact, 0.0).points(DENSE[::4])
    made = found.curve().points(DENSE[::4])
    gap = np.min(np.linalg.norm(made[:, None] - pitch[None, ::4], axis=2), axis=1) - 0.014
    cut = gap < -1e-5
    assert cut.any()
    # What is cut away reaches beyond the stretch where the profile runs backwards, on both sides.
    spans = numbers(text.split(":")[0])
    spans = [spans[i : i + 2] for i in range(0, len(spans), 2)]
    for low, high in spans:
        inside = (np.degrees(DENSE[::4]) > low) & (np.degrees(DENSE[::4]) < high)
        assert cut[inside].any()
    backwards = _runs_backwards(found)
    wanted = signed_spans(DENSE, backwards)
    np.testing.assert_allclose(sorted(np.ravel(spans)), wanted, atol=0.06, err_msg="four digits are reported")


def _runs_backwards(flank) -> np.ndarray:
    """Where the profile runs against the pitch curve, by differences of places."""
    made = flank.curve().points(DENSE)
    pitch = CamCurve(flank.contact, 0.0).points(DENSE)
    way = (np.gradient(made, axis=0) * np.gradient(pitch, axis=0)).sum(axis=1)
    return way < 0


def test_undercut_under_a_flat_face_is_told_with_the_base_radius_that_mends_it() -> None:
    """ρ = r_0 + s + s″; the smallest base radius makes its smallest value zero."""
    lines = 'base_radius = "30 mm"\ncontact = "flat"\n'
    text = told(lines)
    law = profile(lines).cam.lift
    needed = -float((law.at(DENSE) + law.at(DENSE, 2)).min())
    assert needed > 0.03
    assert f"a base radius of more than {1e3 * needed:.5g} mm" in text
    assert not cam_faults(profile(f'base_radius = {needed + 1e-7}\ncontact = "flat"\n'))
    wanted = signed_spans(DENSE, 0.03 + law.at(DENSE) + law.at(DENSE, 2) < 0)
    np.testing.assert_allclose(sorted(numbers(text.split(":")[0])), wanted, atol=0.03)


def test_undercut_that_ends_at_the_start_of_the_turn() -> None:
    """A harmonic return whose deceleration jumps to nothing where the revolution closes."""
    sections = """
sections = [
  { angle = "200 deg" },
  { angle = "100 deg", lift = "20 mm" },
  { angle = "60 deg", lift = "-20 mm", law = "harmonic" },
]
"""
    text = told('base_radius = "40 mm"\ncontact = "flat"\n', sections)
    # Turned round in time the same stretch begins at zero.
    assert "over the whole revolution" not in text
    starts = """
sections = [
  { angle = "60 deg", lift = "-20 mm", law = "harmonic" },
  { angle = "200 deg" },
  { angle = "100 deg", lift = "20 mm" },
]
"""
    again = told('base_radius = "40 mm"\ncontact = "flat"\n', starts)
    spans, shifted = (numbers(each.split(":")[0]) for each in (text, again))
    np.testing.assert_allclose(
        np.sort(np.subtract(spans, 300) % 360), np.sort(np.mod(shifted, 360)), atol=0.1
    )


def test_base_radius_and_roller_that_mend_an_undercut() -> None:
    lines = 'base_radius = "8 mm"\nroller_radius = "14 mm"\n'
    text, found = told(lines), profile(lines)
    roller = largest_roller(found.flanks[0].contact)
    base = least_sound_base(found.cam, found.flanks[0].contact)
    assert roller is not None
    assert base is not None
    # The roller keeps the pitch curve if the prime circle stays.
    assert f"a roller of less than {1e3 * roller:.5g} mm" in text
    assert f"a base radius of more than {1e3 * base:.5g} mm" in text
    for radius, sound in ((base * (1 + 1e-6), True), (base * (1 - 1e-6), False)):
        mended = profile(f'base_radius = {radius}\nroller_radius = "14 mm"\n')
        assert (not cam_faults(mended)) is sound
    for r, sound in ((roller * (1 - 1e-6), True), (roller * (1 + 1e-6), False)):
        mended = profile(f"base_radius = {0.022 - r}\nroller_radius = {r}\n")
        assert (not cam_faults(mended)) is sound


def test_outer_flank_of_a_groove() -> None:
    """The roller is larger than the hollow of the pitch curve: only a groove minds."""
    lines = 'base_radius = "60 mm"\nroller_radius = "12 mm"\n'
    sections = SHARP.replace('"60 deg"', '"30 deg"').replace('"200 deg"', '"260 deg"')
    pitch = profile(lines, sections).flanks[0].shape.least["bend"]
    hollow = -1 / pitch.value
    assert hollow > 0
    r = hollow + 0.002
    lines = f"base_radius = {0.072 - r}\nroller_radius = {r}\n"
    spring = cam_faults(profile(lines, sections))
    groove = cam_faults(profile(lines + 'closure = "groove"\n', sections))
    assert len(groove) == len(spring) + 1
    text = groove[-1]
    assert "outer flank" in text
    assert f"a roller of less than {1e3 * hollow:.5g} mm" in text
    # Outwards of the pitch curve by the roller, the flank runs backwards there: by differences.
    found = profile(lines, sections).flanks[0]
    outer, base = (CamCurve(found.contact, away).points(DENSE) for away in (r, 0.0))
    way = (np.gradient(outer, axis=0) * np.gradient(base, axis=0)).sum(axis=1)
    assert (way < 0).any()
    less = f"base_radius = {0.072 - hollow + 1e-6}\nroller_radius = {hollow - 1e-6}\n"
    assert not any("outer" in each for each in cam_faults(profile(less + 'closure = "groove"\n', sections)))


# -- crossing, hollow, locked, turned over -------------------------------------------------------------------


def test_profile_that_crosses_itself() -> None:
    """A lobe whose neck is narrower than the roller: nowhere undercut, yet cut from the other side."""
    sections = """
sections = [
  { angle = "45 deg", lift = "100 mm", law = "modified_trapezoid" },
  { angle = "20 deg" },
  { angle = "45 deg", lift = "-100 mm", law = "modified_trapezoid" },
  { angle = "250 deg" },
]
"""
    lines = 'base_radius = "{} mm"\nroller_radius = "17.4 mm"\n'
    text = told(lines.format(2.6), sections)
    assert "crosses itself" in text
    found = profile(lines.format(2.6), sections).flanks[0]
    assert found.shape.rows["soundness"].min() > 0
    place = np.array(numbers(text.split("(")[1].split(")")[0])) * 1e-3
    away = np.linalg.norm(found.curve().points(DENSE) - place, axis=1)
    # The place lies on two branches that are far apart along the curve; it is that of a polygon of half
    # degrees.
    angles = [float(each) for each in re.findall(r"([\d.]+)°", text)]
    for angle in angles:
        assert away[np.abs(np.degrees(DENSE) - angle) < 0.5].min() < 1e-4
    assert abs(angles[0] - angles[1]) > 20
    base = numbers(text.split("base radius of")[1])[0]
    assert not cam_faults(profile(lines.format(base), sections))
    assert cam_faults(profile(lines.format(0.998 * base), sections))


def test_crossings_of_many_polygons_against_all_pairs() -> None:
    rng = np.random.default_rng(3)
    for n in (5, 17, 60):
        points = rng.normal(size=(n, 2))
        found = crossings(points)
        wanted = 0
        for i in range(n):
            for j in range(i + 2, n):
                if j - i == n - 1:
                    continue
                a, b = points[i], points[(i + 1) % n] - points[i]
                c, d = points[j], points[(j + 1) % n] - points[j]
                t, u = np.linalg.solve(np.column_stack((b, -d)), c - a)
                wanted += 0 <= t < 1 and 0 <= u < 1
        assert len(found.x) == wanted
        for first, second, x, y in zip(found.first, found.second, found.x, found.y, strict=True):
            for side in (first, second):
                i, share = int(side), side % 1
                place = (1 - share) * points[i] + share * points[(i + 1) % n]
                np.testing.assert_allclose(place, [x, y], atol=1e-12)


def test_cutter_wider_than_its_groove() -> None:
    lines = 'base_radius = "40 mm"\nroller_radius = "8 mm"\nclosure = "groove"\n'
    assert not cam_faults(profile(lines + "cutter_radius = 0.008\n"))
    (text,) = cam_faults(profile(lines + "cutter_radius = 0.0081\n"))
    assert "its groove is as wide as the roller of 8 mm radius" in text


def test_cutter_in_a_hollow() -> None:
    sections = SHARP.replace('"60 deg"', '"40 deg"').replace('"200 deg"', '"240 deg"')
    lines = 'base_radius = "60 mm"\nroller_radius = "5 mm"\n'
    found = profile(lines, sections)
    hollow = found.curvature_radius_concave_min
    assert hollow is not None
    # Three neighbouring points of the profile make a circle there.
    at = found.flanks[0].concave.angle
    a, b, c = found.flanks[0].curve().points(at + np.array([-1e-4, 0.0, 1e-4]))
    area = 0.5 * abs((b - a)[0] * (c - a)[1] - (b - a)[1] * (c - a)[0])
    circle = np.linalg.norm(b - a) * np.linalg.norm(c - b) * np.linalg.norm(c - a) / (4 * area)
    assert hollow == pytest.approx(circle, rel=1e-4)
    assert not cam_faults(profile(lines + f"cutter_radius = {hollow * 0.999}\n", sections))
    (text,) = cam_faults(profile(lines + f"cutter_radius = {hollow * 1.01}\n", sections))
    assert f"{1e3 * hollow:.5g} mm" in text
    assert "cutter" in text


ARM = """
follower = "oscillating"
arm_pivot = "P"
"""
PIVOT = "[mechanism.points]\nP = { x = 0.1, y = 0 }\n"


def swings(angle: float, swing: float, law: str = "cycloidal") -> str:
    return f"""
sections = [
  {{ angle = "{angle} deg", swing = "{swing} deg", law = "{law}" }},
  {{ angle = "{angle} deg", swing = "{-swing} deg", law = "{law}" }},
  {{ angle = "{360 - 2 * angle} deg" }},
]
"""


def test_arm_that_the_cam_cannot_move() -> None:
    """Beyond the line through both pivots the arm would have to be pulled: d·n goes with a sin ψ."""
    lines = ARM + "arm_length = 0.08\nbase_radius = {}\nroller_radius = 0.005\n"
    text, found = (
        told(lines.format(0.13), swings(90, 90), PIVOT),
        profile(lines.format(0.13), swings(90, 90), PIVOT),
    )
    assert "cannot move its follower" in text
    assert found.flanks[0].contact.start + np.pi / 2 > np.pi
    gamma = found.flanks[0].contact.kernel.rows(DENSE)["pressure_angle"]
    assert np.abs(gamma).max() > np.pi / 2
    assert found.pressure_angle_max == pytest.approx(np.abs(gamma).max(), rel=1e-6)


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("rotation", ["same", "opposite"])
def test_face_that_turns_over_the_cam(side: str, rotation: str) -> None:
    """The face turns back where ψ′ = −1 for an arm to the left of a cam that turns to the left."""
    lines = ARM + f'contact = "flat"\nbase_radius = 0.02\nside = "{side}"\nrotation = "{rotation}"\n'
    # A slow rise and a quick return: s′ from about 0.6 down to −1.2.
    sections = """
sections = [
  { angle = "60 deg", swing = "30 deg", law = "harmonic" },
  { angle = "40 deg", swing = "-30 deg", law = "harmonic" },
  { angle = "260 deg" },
]
"""
    both = profile(lines, sections, PIVOT)
    least, greatest = (each.value for each in both.cam.lift.extremes(1))
    assert least < -1
    assert greatest < 1
    turns = (side == "left") == (rotation == "same")
    rolls = any("rolls on" in each for each in cam_faults(both))
    normal = both.flanks[0].contact.kernel.rows(DENSE)
    turned_by = np.unwrap(np.arctan2(normal["normal_y"], normal["normal_x"]))
    back = np.diff(turned_by) * np.sign(turned_by[-1] - turned_by[0]) < 0
    assert back.any() == turns
    assert rolls == turns


def test_second_follower_that_does_not_touch_is_told() -> None:
    lines = 'closure = "constant_diameter"\ncontact = "point"\nbase_radius = "30 mm"\n'
    text = told(lines, SHARP.replace('"200 deg"', '"190 deg"').replace('"40 deg"', '"50 deg"'))
    assert "not of constant diameter" in text
    assert "must mirror the first" in text
    found = profile(lines, SHARP)
    s = found.cam.lift
    both = s.at(DENSE) + s.at((DENSE + np.pi) % TURN)
    assert found.diameter_max == pytest.approx(0.06 + both.max(), abs=1e-7)
    assert found.diameter_min == pytest.approx(0.06 + both.min(), abs=1e-7)


PAIR = 'closure = "conjugate"\nbase_radius = "40 mm"\nroller_radius = "15 mm"\n'


def test_all_shapes_of_second_cams_are_told_with_the_key_that_mends_them() -> None:
    lines = PAIR + 'second = { distance = "%g mm" }\n'
    found = cam_faults(profile(lines % 96))
    (text,) = [each for each in found if "second cam" in each]
    distance = numbers(text.split("a distance of more than")[1])[0]
    assert not any("second cam" in each for each in cam_faults(profile(lines % (distance + 0.1))))
    assert any("second cam" in each for each in cam_faults(profile(lines % (distance - 0.1))))


def test_no_room_for_a_second_cam() -> None:
    lines = PAIR + 'second = { distance = "80 mm" }\n'
    with pytest.raises(FindingError, match=r"second\.distance must be more than 0\.09 m"):
        profile(lines)
    assert cam_profile(machine(SHARP + lines.replace("80 mm", "90.1 mm")))


# -- limits --------------------------------------------------------------------------------------------------


def scan(size: Sizes, margin, low: float, high: float) -> float:
    """The first base radius whose margin is not negative, by steps of a thousandth."""
    for base in np.geomspace(low, high, int(np.log(high / low) / 1e-3)):
        if margin(base) >= 0:
            return float(base)
    raise AssertionError("none")


@pytest.mark.parametrize("kind", ["roller", "offset", "arm", "flat arm"])
def test_least_base_against_a_scan(kind: str) -> None:
    """Scans with dense samples find the same radius to the scan's step; the limit is met exactly."""
    more = {
        "roller": "roller_radius = 0.01\n",
        "offset": "roller_radius = 0.01\noffset = 0.012\n",
        "arm": ARM + "arm_length = 0.08\nroller_radius = 0.01\n",
        "flat arm": ARM + 'contact = "flat"\noffset = 0.02\n',
    }[kind]
    sections = swings(90, 15) if "arm" in kind else SHARP
    found = profile(more + "base_radius = 0.035\n", sections, PIVOT)
    touching = found.flanks[0].contact
    phi = DENSE[::10]

    def rows(base: float) -> dict[str, np.ndarray]:
        kernel = touching.kernel.with_sizes(touching.sizes._replace(base_radius=base))
        return kernel.rows(phi)

    limit = np.radians(28)
    found_base = base_for_pressure_angle(found.cam, touching, limit)
    wanted = scan(touching.sizes, lambda b: limit - np.abs(rows(b)["pressure_angle"]).max(), 0.004, 0.4)
    if wanted == 0.004:
        assert found_base <= wanted, "any base radius will do"
    else:
        assert found_base == pytest.approx(wanted, rel=1.2e-3)
        kernel = touching.kernel.with_sizes(touching.sizes._replace(base_radius=found_base))
        shape = kernel.shape(720)
        steepest = max(abs(shape.greatest["pressure_angle"].value), abs(shape.least["pressure_angle"].value))
        assert steepest == pytest.approx(limit, rel=1e-12)
    sound = least_sound_base(found.cam, touching)
    wanted = scan(touching.sizes, lambda b: rows(b)["soundness"].min(), 0.004, 0.4)
    assert sound == pytest.approx(wanted, rel=2e-3)
    tight = base_for_curvature(found.cam, touching, 0.005)

    def radius(base: float) -> float:
        r = rows(base)
        if kind == "flat arm":
            return float(r["bend"].min()) - 0.005
        return float(1 - (touching.sizes.roller_radius + 0.005) * r["bend"].max())

    assert tight == pytest.approx(scan(touching.sizes, radius, 0.004, 0.4), rel=2e-3)


# Without undercut at any base radius.
GENTLE = """
sections = [
  { angle = "120 deg", lift = "40 mm", law = "harmonic" },
  { angle = "30 deg" },
  { angle = "150 deg", lift = "-40 mm", law = "cycloidal" },
  { angle = "60 deg" },
]
"""
BARELY_REACHED = {
    "offset": ('roller_radius = "10 mm"\noffset = "12 mm"\n', GENTLE, "", 0.002),
    "arm": (
        'follower = "oscillating"\nroller_radius = "8 mm"\narm_pivot = "P"\narm_length = "70 mm"\n',
        GENTLE.replace("lift", "swing").replace("40 mm", "20 deg").replace("harmonic", "cycloidal"),
        '[mechanism.points]\nP = { x = "80 mm" }\n',
        0.002,
    ),
}


@pytest.mark.parametrize("kind", BARELY_REACHED)
def test_least_base_lets_the_follower_reach_the_cam(kind: str) -> None:
    """An offset within the prime circle, an arm that spans to it: a smaller base radius has no cam at all."""
    lines, sections, rest, bound = BARELY_REACHED[kind]
    base = lw.least_sizes(profile(f'base_radius = "30 mm"\n{lines}', sections, rest)).base_radius_sound
    # Halvings end at rounding above the bound.
    assert base == pytest.approx(bound, rel=1e-9)
    profile(f"base_radius = {1.0001 * base}\n{lines}", sections, rest)
    with pytest.raises(InputError, match="base_radius"):
        profile(f"base_radius = {0.9999 * base}\n{lines}", sections, rest)


def test_limits_are_warnings_with_the_size_that_keeps_them() -> None:
    lines = 'base_radius = "{} mm"\nroller_radius = "8 mm"\ncurvature_limit = "30 mm"\n'
    texts = cam_cautions(profile(lines.format(35)))
    steep = next(each for each in texts if "pressure angle" in each)
    tight = next(each for each in texts if "radius of curvature" in each)
    for text, word in ((steep, "pressure angle"), (tight, "radius of curvature")):
        base = numbers(text.split("base radius of")[1])[0]
        # Five digits are reported.
        assert not any(word in each for each in cam_cautions(profile(lines.format(base * 1.0001))))
        assert any(word in each for each in cam_cautions(profile(lines.format(base * 0.9999))))
    found = profile(lines.format(35)).flanks[0]
    bend = found.contact.kernel.rows(DENSE)["bend"]
    assert f"{1e3 * (1 / bend.max() - 0.008):.4g}"[:4] in tight
    assert f"{np.degrees(DENSE[bend.argmax()]):.4g}"[:3] in tight


def test_jumps_inside_a_law_are_told_and_leave_no_largest_jerk() -> None:
    """Parabolas back to back meet in the same acceleration: only their middles jump."""
    sections = """
sections = [
  { angle = "180 deg", lift = "20 mm", law = "parabolic" },
  { angle = "180 deg", lift = "-20 mm", law = "parabolic" },
]
"""
    found = cam_profile(machine(sections + "base_radius = 0.05\nroller_radius = 0.01", "[drive]\nspeed = 10"))
    assert found.jerk_max is None
    assert found.acceleration_max == pytest.approx(4 * 0.02 / np.pi**2 * 100, rel=1e-14)
    (text,) = [each for each in cam_cautions(found) if "jumps" in each]
    assert "acceleration" in text
    assert "90°, 270°" in text


def test_undercut_between_samples_is_seen() -> None:
    """A bend that passes its limit over less than a step of the samples."""
    law = fitted(lambda phi: 0.01 * (1 - np.cos(phi - 0.0005)))
    size = Sizes(0.02, 0.005, 0.0, 0.0, 0.0, 0.0)
    found = contact(law, size, 0.025, oscillating=False, roller=True)
    bend = found.kernel.shape(720).greatest["bend"].value
    assert bend == pytest.approx(found.kernel.rows(DENSE)["bend"].max(), rel=1e-9)
    study = lw.study(machine(SHARP + 'contact = "flat"\nbase_radius = "30 mm"'))
    assert any("undercut" in each for each in study.findings)


def test_turned_is_a_rotation() -> None:
    np.testing.assert_allclose(turned(np.array([1.0, 0.0]), np.pi / 2), [0.0, 1.0], atol=1e-16)
