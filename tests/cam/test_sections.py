"""Programmes as they stand in a file: they close, their joints are reported, faults have their places."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from pydantic import Field
from pydantic_core import InitErrorDetails

import linkwright as lw
from linkwright import MachineFileError
from linkwright.cam import Programme
from linkwright.cam.model.motion_section import Family, MotionSection, programme, section_faults
from linkwright.kernel.description.base import CheckedDescription
from linkwright.kernel.description.problems import WholeDescription
from linkwright.kernel.errors import Problem
from linkwright.machine import read_as
from linkwright.machine.read import loads_as


class SomeCam(CheckedDescription):
    """A cam with nothing but its programme."""

    sections: tuple[MotionSection, ...] = Field(description="Sections.")
    follower: str = Field("lift", description="What the follower does.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        family: Family = "swing" if self.follower == "swing" else "lift"
        yield from section_faults(self.sections, family)


class SomeFile(WholeDescription):
    """A file with cams, that tells its problems as a machine does."""

    cams: dict[str, SomeCam] = Field(description="Cams.")


def cam(sections: str, overrides: tuple[str, ...] = (), follower: str = "lift") -> SomeCam:
    text = f'[cams.K]\nfollower = "{follower}"\nsections = [\n{sections}\n]\n'
    return loads_as(SomeFile, text, overrides, path="cam.toml").cams["K"]


def moved(sections: str, overrides: tuple[str, ...] = (), follower: Family = "lift") -> Programme:
    return programme(cam(sections, overrides, follower).sections, follower)


def told(sections: str, overrides: tuple[str, ...] = (), follower: str = "lift") -> list[Problem]:
    with pytest.raises(MachineFileError) as caught:
        cam(sections, overrides, follower)
    assert all(each.found and each.expected for each in caught.value.problems)
    return caught.value.problems


RISE_AND_RETURN = """
{ angle = "120 deg", lift = "20 mm", law = "cycloidal" },
{ angle = "60 deg" },
{ angle = "120 deg", lift = "-20 mm", law = { kind = "modified_sine", share = 0.2 } },
{ angle = "60 deg" },"""

# Start, constant speed, braking, return: the slope of the second section counts for its neighbours.
STEADY = """
{ angle = "60 deg", lift = "12 mm" },
{ angle = "90 deg", lift = "36 mm", law = "constant_velocity" },
{ angle = "60 deg", lift = "12 mm", law = "cycloidal" },
{ angle = "150 deg", lift = "-60 mm", law = "modified_trapezoid" },"""


def test_a_programme_closes_exactly() -> None:
    found = moved(RISE_AND_RETURN)
    assert found.law.start == 0.0
    assert found.law.end == 2 * math.pi
    assert float(found.law.at(0.0)) == 0.0
    # Lifts of cm, four sections: rounding of the sum.
    assert abs(float(found.law.at(2 * math.pi))) < 1e-17
    assert float(found.law.at(np.radians(150))) == pytest.approx(0.02, rel=1e-14)


def test_joints_of_a_programme() -> None:
    found = moved(RISE_AND_RETURN)
    assert [each.angle for each in found.joints] == pytest.approx(np.radians([0, 120, 180, 300]).tolist())
    # A cycloidal law has the jerk 4π² h/β³ at both its ends.
    jerk = 4 * math.pi**2 * 0.02 / np.radians(120) ** 3
    assert [each.order for each in found.joints] == [2, 2, 2, 2]
    assert found.joints[0].jumps[3] == pytest.approx(jerk, rel=1e-12)
    assert found.joints[1].jumps[3] == pytest.approx(-jerk, rel=1e-12)
    words = found.joints[0].words("m")
    assert words == f"continuous up to the acceleration; the jerk jumps by {jerk:.4g} m/rad³"


def test_constant_velocity_gives_its_slope_to_both_neighbours() -> None:
    found = moved(STEADY)
    slope = 0.036 / np.radians(90)
    for degrees in (60, 150):
        for side in ("before", "after"):
            assert float(found.law.at(np.radians(degrees), 1, side)) == pytest.approx(slope, rel=1e-12)
            assert float(found.law.at(np.radians(degrees), 2, side)) == pytest.approx(0, abs=1e-15)
    assert [each.order for each in found.joints] == [2, 2, 2, 2]


def test_a_neighbour_may_say_otherwise() -> None:
    otherwise = STEADY.replace('"12 mm" }', '"12 mm", velocity_end = "10 mm/rad" }')
    joint = moved(otherwise).joints[1]
    assert joint.order == 0
    assert joint.jumps[1] == pytest.approx(0.036 / np.radians(90) - 0.01, rel=1e-12)
    assert joint.words().startswith("continuous up to the lift; the velocity jumps by 0.0129")


def test_what_one_side_says_counts_for_both() -> None:
    found = moved("""
    { angle = "180 deg", lift = "20 mm", acceleration_end = "-50 mm/rad^2" },
    { angle = "180 deg", lift = "-20 mm", velocity_end = 0 },""")
    assert found.joints[1].order >= 2
    assert float(found.law.at(math.pi, 2)) == pytest.approx(-0.05, rel=1e-12)
    assert [each.letters for each in found.tasks] == ["R-U", "U-R"]


def test_constant_velocity_by_its_slope() -> None:
    by_slope = STEADY.replace('lift = "36 mm", law', 'velocity_start = "0.4 mm/deg", law')
    np.testing.assert_allclose(moved(by_slope).law.at(1.9, 1), 0.036 / np.radians(90), rtol=1e-12)


def test_swings() -> None:
    found = moved(RISE_AND_RETURN.replace("lift", "swing").replace("20 mm", "15 deg"), follower="swing")
    assert float(found.law.at(np.radians(150))) == pytest.approx(np.radians(15), rel=1e-14)


def test_rounding_of_angles_and_lifts_is_absorbed() -> None:
    third = 2 * math.pi / 3
    text = "".join(f"{{ angle = {third!r}, lift = {lift!r} }}," for lift in (0.1, 0.2, -0.30000000000000004))
    found = moved(text)
    assert found.law.end == 2 * math.pi
    assert abs(float(found.law.at(2 * math.pi))) < 1e-15
    assert all(each.order >= 2 for each in found.joints)


def test_overrides_reach_the_entries_of_the_list() -> None:
    changes = (
        "cams.K.sections.2.law.share=0.25",
        "cams.K.sections.1.angle=80 deg",
        "cams.K.sections.3.angle=40 deg",
    )
    found = cam(RISE_AND_RETURN, changes).sections
    assert found[2].law is not None
    assert getattr(found[2].law, "share") == 0.25  # noqa: B009
    assert found[1].angle == pytest.approx(np.radians(80))


def test_a_fault_of_an_override_is_told_as_its_own() -> None:
    (problem,) = told(RISE_AND_RETURN, ("cams.K.sections.2.law.share=0.6",))
    assert problem.key == "cams.K.sections.2.law.share"
    assert problem.path == "--set cams.K.sections.2.law.share=0.6"
    assert "between 0 and 0.5" in problem.expected


def test_angles_that_do_not_add_to_a_turn() -> None:
    (problem,) = told(RISE_AND_RETURN.replace('"60 deg" },\n{', '"70 deg" },\n{'))
    assert problem.key == "cams.K.sections"
    assert problem.line == 3
    assert problem.found == "angles that add to 370 deg"
    assert problem.remedy == '10 deg too much: sections.1.angle = "60 deg" closes the revolution'
    (problem,) = told(RISE_AND_RETURN.replace('"60 deg" },\n{', '"50 deg" },\n{'))
    assert problem.remedy == '10 deg missing: sections.3.angle = "70 deg" closes the revolution'


@pytest.mark.parametrize("remedy", ["angle", "lift"])
def test_the_remedy_heals(remedy: str) -> None:
    broken = {
        "angle": RISE_AND_RETURN.replace('"60 deg" },\n{', '"100.5 deg" },\n{'),
        "lift": RISE_AND_RETURN.replace('"-20 mm"', '"-17.5 mm"'),
    }[remedy]
    (problem,) = told(broken)
    change = problem.remedy.split(": ")[-1].rsplit('"', 1)[0].replace(' = "', "=")
    assert moved(broken, (f"cams.K.{change}",)).law.end == 2 * math.pi


def test_lifts_that_do_not_close() -> None:
    (problem,) = told(RISE_AND_RETURN.replace('"-20 mm"', '"-19 mm"'))
    assert problem.found == "lifts that add to 0.001 m"
    assert problem.remedy == 'sections.2.lift = "-0.02 m" brings the follower back'


@pytest.mark.parametrize(
    ("old", "new", "key", "expected"),
    [
        (
            '{ angle = "60 deg" },\n{',
            '{ angle = "60 deg", velocity_end = 0.1 },\n{',
            "1.velocity_end",
            "dwell",
        ),
        ('lift = "20 mm"', 'swing = "20 deg"', "0.swing", "lift: the follower moves along a guide"),
        ('lift = "20 mm", ', "", "0.lift", "the lift or swing of the section"),
        ('"cycloidal"', '"cyclodial"', "0.law", "cycloidal"),
        ('"cycloidal"', '{ kind = "cycloidal", share = 0.1 }', "0.law.share", "kind"),
        ("share = 0.2", "shore = 0.2", "2.law.shore", "share"),
        ('"120 deg", lift = "20', '"-120 deg", lift = "20', "0.angle", "greater than 0"),
        ('"20 mm"', '"20 kg"', "0.lift", "a length"),
        ('"cycloidal"', '"double_harmonic", acceleration_end = 0', "0.law", "neighbouring sections"),
        ('"cycloidal"', '{ kind = "polynomial", powers = [0, 1, 2] }', "0.law.powers", "6 powers"),
        ('"cycloidal"', '{ kind = "polynomial", powers = [0, 1, 2, 2] }', "0.law.powers.3", "each once"),
        ('"cycloidal"', '{ kind = "polynomial", continuity_end = 9 }', "0.law.continuity_end", "one of 0, 1"),
    ],
)
def test_what_is_wrong_has_its_place(old: str, new: str, key: str, expected: str) -> None:
    assert old in RISE_AND_RETURN
    found = told(RISE_AND_RETURN.replace(old, new, 1))
    assert f"cams.K.sections.{key}" in [each.key for each in found]
    problem = next(each for each in found if each.key == f"cams.K.sections.{key}")
    assert expected in problem.expected
    assert problem.line is not None
    assert problem.line > 3


def test_ends_of_constant_velocity_are_its_slope() -> None:
    text = STEADY.replace(
        '"constant_velocity"', '"constant_velocity", velocity_end = 0.1, acceleration_start = 1'
    )
    keys = {each.key.rsplit(".", 1)[1]: each.expected for each in told(text)}
    assert keys.keys() == {"velocity_end", "acceleration_start"}
    assert "the slope 0.0229183" in keys["velocity_end"]


SPLINE = """
{ angle = "120 deg", law = { kind = "spline", angle = "0, 30, 80, 120 deg", lift = "0, 4, 17, 20 mm" } },
{ angle = "60 deg" },
{ angle = "180 deg", lift = "-20 mm", law = { kind = "limited", acceleration_max = "10 mm/rad^2" } },"""


def test_a_spline_says_its_lift_itself() -> None:
    found = moved(SPLINE)
    np.testing.assert_allclose(
        found.law.at(np.radians([0, 30, 80, 120, 360])), [0, 4e-3, 17e-3, 20e-3, 0], atol=1e-17
    )
    assert [each.order for each in found.joints] == [1, 2, 1]
    # Limited: the acceleration jumps to its limit.
    assert found.joints[2].jumps[2] == pytest.approx(-0.01, rel=1e-12)


@pytest.mark.parametrize(
    ("old", "new", "key", "words"),
    [
        ('lift = "0, 4, 17, 20 mm"', 'swing = "0, 1, 2, 3 deg"', "0.lift", "the lift or swing"),
        ('"0, 30, 80, 120 deg"', '"0, 30, 80, 110 deg"', "0.law.angle", "that of the section"),
        ('"0, 30, 80, 120 deg"', '"0, 30, 20, 120 deg"', "0.law.angle.2", "more than"),
        ('"0, 30, 80, 120 deg"', '"0, 30, 120 deg"', "0.law.lift", "3 values"),
        ('120 deg", law', '120 deg", lift = "20.1 mm", law', "", "lifts that add to 0"),
        ('"10 mm/rad^2"', '"8 mm/rad^2"', "2.law", "complete the lift in 180 deg"),
        ('"10 mm/rad^2"', '"8 mm/s^2"', "2.law.acceleration_max", "a length per cam angle squared"),
        ("acceleration_max", "velocity_max", "2.law.velocity_max", "a length per cam angle"),
        ("acceleration_max", "swing_acceleration_max", "2.law.swing_acceleration_max", "per angle"),
    ],
)
def test_points_and_limits_that_do_not_fit(old: str, new: str, key: str, words: str) -> None:
    assert old in SPLINE
    found = told(SPLINE.replace(old, new, 1))
    place = f"cams.K.sections.{key}".removesuffix(".")
    assert words in next(each for each in found if each.key == place).expected


def test_a_section_that_is_too_short_is_told_the_shortest() -> None:
    (problem,) = told(SPLINE.replace('"10 mm/rad^2"', '"8 mm/rad^2"'))
    shortest = np.degrees(2 * np.sqrt(0.02 / 0.008))
    assert problem.found == f"limits that require at least {shortest:.10g} deg"
    longer = SPLINE.replace('"10 mm/rad^2"', '"8 mm/rad^2"').replace('"180 deg"', f'"{shortest} deg"')
    left = f'{{ angle = "{360 - 120 - shortest} deg" }}'
    assert moved(longer.replace('{ angle = "60 deg" }', left)).law.end == 2 * math.pi


def test_points_from_a_file(tmp_path: Path) -> None:
    (tmp_path / "rise.csv").write_text("angle [deg], lift [mm]\n0, 0\n30, 4\n80, 17\n120, 20\n")
    points = 'angle = "0, 30, 80, 120 deg", lift = "0, 4, 17, 20 mm"'
    by_file = SPLINE.replace(points, 'file = "rise.csv"')
    text = f"[cams.K]\nsections = [{by_file}]\n"
    (tmp_path / "cam.toml").write_text(text)
    found = read_as(SomeFile, tmp_path / "cam.toml").cams["K"]
    assert found.sections == cam(SPLINE).sections


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        (None, "a file of comma-separated values"),
        ("", "a header such as"),
        ("angle [deg, lift\n0, 0\n", "a header such as"),
        ("angle, lift\n0, 0, 0\n", "2 values"),
        ("angle [deg], lift [mm]\n0, 0\nx, 4\n", "rise.csv:3: cams.K.sections.0.law.file, column angle"),
        ("angle [deg], lift [mm]\n0, 0\n\n60,\n", "rise.csv:4: cams.K.sections.0.law.file, column lift"),
        ("angle [deg], lift [mm]\n0, 0\n60, nan\n", "a finite number"),
        ("angle [deg], height [mm]\n0, 0\n120, 4\n", "one of file, angle"),
    ],
)
def test_files_that_hold_no_points(tmp_path: Path, content: str | None, expected: str) -> None:
    if content is not None:
        (tmp_path / "rise.csv").write_text(content)
    law = '{ kind = "table", file = "rise.csv" }'
    (tmp_path / "cam.toml").write_text(
        f"[cams.K]\nsections = [{{ angle = 6.283185307179586, law = {law} }}]\n"
    )
    with pytest.raises(MachineFileError) as caught:
        read_as(SomeFile, tmp_path / "cam.toml")
    assert expected in str(caught.value)


def test_extremes_of_every_section() -> None:
    """Rise by the cycloidal law, dwell, return by the harmonic law: their closed forms, and by time."""
    h, rise, back, speed = 0.02, np.radians(120), np.radians(150), 8.0
    sections = [
        {"angle": rise, "lift": h, "law": "cycloidal"},
        {"angle": np.radians(30)},
        {"angle": back, "lift": -h, "law": "harmonic"},
        {"angle": np.radians(60)},
    ]
    machine = lw.Machine.model_validate(
        {
            "format": 1,
            "name": "cam",
            "drive": {"speed": speed},
            "mechanism": {"cams": {"C": {"base_radius": 0.05, "roller_radius": 0.01, "sections": sections}}},
        }
    )
    first, dwell, third, _ = lw.cam_profile(machine).sections
    assert (first["law"], dwell["law"], third["law"]) == ("cycloidal", "dwell", "harmonic")
    assert (third["start"], third["end"]) == pytest.approx(tuple(np.radians([150, 300])), rel=1e-13)
    assert first["lift_d1_max"] == pytest.approx(2 * h / rise, rel=1e-12)
    assert first["lift_d1_max_angle"] == pytest.approx(rise / 2, rel=1e-6)
    assert first["velocity_max"] == pytest.approx(2 * h / rise * speed, rel=1e-12)
    assert first["acceleration_min"] == pytest.approx(-2 * np.pi * h / rise**2 * speed**2, rel=1e-12)
    assert first["lift_d2_min_angle"] == pytest.approx(0.75 * rise, rel=1e-6)
    assert first["jerk_max"] == pytest.approx(4 * np.pi**2 * h / rise**3 * speed**3, rel=1e-12)
    assert first["lift_d1_min"] == 0.0
    # Within the section: the harmonic law jumps at its ends.
    assert third["lift_d2_max"] == pytest.approx(0.5 * np.pi**2 * h / back**2, rel=1e-12)
    assert third["lift_d2_max_angle"] == pytest.approx(np.radians(300), rel=1e-13)
    assert {dwell[name] for name in dwell if name.startswith(("lift_d", "jerk")) and "angle" not in name} == {
        0.0
    }


def test_the_remedy_is_an_entry_of_a_section_that_may_have_one() -> None:
    """A section by a formula has no lift to change: the dwell behind it takes the remedy."""
    text = """
    format = 1
    name = "formula"
    [mechanism.cams.C]
    base_radius = 0.04
    [[mechanism.cams.C.sections]]
    angle = "180 deg"
    law = { kind = "formula", lift = "0.02*(z - sin(2*pi*z)/(2*pi))" }
    [[mechanism.cams.C.sections]]
    angle = "180 deg"
    lift = 0
    law = "cycloidal"
    """
    with pytest.raises(MachineFileError, match=r'sections\.1\.lift = "-0\.02 m" brings the follower back'):
        lw.loads(text)
