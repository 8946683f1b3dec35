"""Many cams at once against each of them looked at exactly."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import linkwright as lw
from linkwright import InputError, Machine, ShapeError, cam_faults, cam_profile, search_cams
from linkwright.cam import PlainLaw
from linkwright.cam.search import Cams

SECTIONS = """
sections = [
  { angle = "100 deg", lift = "9 mm", law = "cycloidal" },
  { angle = "80 deg", lift = "-9 mm" },
  { angle = "180 deg" },
]
"""
SWING = SECTIONS.replace("lift", "swing").replace("9 mm", "9 deg")
HEAD = 'format = 1\nname = "F"\n[mechanism.points]\nP = { x = 0.1, y = 0 }\n[mechanism.cams.F]\n'
ROLLER = 'base_radius = "30 mm"\nroller_radius = "8 mm"\noffset = "4 mm"\n' + SECTIONS
FLAT = 'contact = "flat"\nbase_radius = "30 mm"\nface_tilt = "5 deg"\n' + SECTIONS
ARM = (
    'follower = "oscillating"\narm_pivot = "P"\narm_length = "80 mm"\nbase_radius = "30 mm"\n'
    'roller_radius = "8 mm"\n' + SWING
)
FACE = (
    'follower = "oscillating"\ncontact = "flat"\narm_pivot = "P"\noffset = "3 mm"\nbase_radius = "30 mm"\n'
    + SWING
)


def machine(lines: str) -> Machine:
    return lw.loads(HEAD + lines)


def variant(machine: lw.Machine, name: str, searched: Cams, i: int) -> lw.Machine:
    cam = machine.mechanism.cams[name]
    entries: dict[str, Any] = {
        key: float(column[i]) for key, column in searched.entries.items() if key != "lift_factor"
    }
    if "base_radius" in entries:
        entries["breadth"] = None
    factor = float(searched.entries["lift_factor"][i]) if "lift_factor" in searched.entries else 1.0
    sections = []
    for section in cam.sections:
        scaled: dict[str, Any] = {
            key: factor * value for key in ("lift", "swing") if (value := getattr(section, key))
        }
        if searched.laws and scaled:
            law: dict[str, Any] = {"kind": searched.laws[int(searched.law[i])]}
            scaled["law"] = PlainLaw.model_construct(**law)
        sections.append(section.with_entries(scaled))
    own = cam.with_entries({**entries, "sections": tuple(sections)})
    cams = {**machine.mechanism.cams, name: own}
    return machine.with_entries({"mechanism": machine.mechanism.with_entries({"cams": cams})})


@pytest.mark.parametrize(
    ("lines", "varied"),
    [
        (ROLLER, {"roller_radius": [0.004, 0.012], "offset": [-0.01, 0.01]}),
        (FLAT, {"face_tilt": [-0.2, 0.2]}),
        (ARM, {"arm_length": [0.07, 0.09]}),
        (FACE, {"offset": [-0.01, 0.01]}),
    ],
)
def test_each_is_what_it_is_alone(lines: str, varied: dict[str, list[float]]) -> None:
    m, rng = machine(lines), np.random.default_rng(4)
    entries = {key: rng.uniform(low, high, 12) for key, (low, high) in varied.items()}
    entries |= {"base_radius": rng.uniform(0.015, 0.06, 12), "lift_factor": rng.uniform(0.5, 1.5, 12)}
    laws = ["cycloidal", "modified_sine"]
    found = search_cams(m, entries=entries, laws=laws)
    assert found.laws == tuple(laws)
    assert found.law.tolist() == [0] * 12 + [1] * 12
    assert found.is_sound.any()
    for i in range(24):
        alone = cam_profile(variant(m, "F", found, i))
        # An extreme between two of 360 angles is missed by (step)²/8 of its second derivative: 4e-5 of that.
        assert found.pressure_angle_max[i] == pytest.approx(alone.pressure_angle_max, rel=1e-3)
        assert found.is_sound[i] == (not cam_faults(alone))
        if found.is_sound[i] and alone.curvature_radius_convex_min is not None:
            wanted = pytest.approx(alone.curvature_radius_convex_min, abs=1e-3 * alone.prime_radius)
            assert found.curvature_radius_min[i] == wanted


def test_the_smallest_keep_the_limits() -> None:
    m = machine(ROLLER)
    base = np.linspace(0.005, 0.06, 221)
    found = search_cams(m, entries={"base_radius": base})
    keeps = found.keeps(np.radians(30), 0.01)
    best = found.smallest(keeps, 3)
    np.testing.assert_array_equal(best, np.flatnonzero(keeps)[:3])
    below = cam_profile(variant(m, "F", found, int(best[0]) - 1))
    assert below.pressure_angle_max > np.radians(30) or (below.curvature_radius_convex_min or 0) < 0.01


def test_a_cam_without_place_is_nan_alone() -> None:
    found = search_cams(machine(ROLLER), entries={"offset": [0.0, 0.05, 0.01]})
    assert np.isnan(found.pressure_angle_max).tolist() == [False, True, False]
    assert found.is_sound.tolist() == [True, False, True]


def test_a_base_radius_takes_the_place_of_a_breadth() -> None:
    lines = (
        'closure = "constant_diameter"\ncontact = "point"\nbreadth = "80 mm"\nsections = [\n'
        '  { angle = "180 deg", lift = "9 mm" },\n  { angle = "180 deg", lift = "-9 mm" },\n]\n'
    )
    m = machine(lines)
    found = search_cams(m, entries={"base_radius": [0.03, 0.05]})
    other = variant(m, "F", found, 1)
    assert other.mechanism.cams["F"].breadth is None
    alone = cam_profile(other)
    assert alone.base_radius == 0.05
    assert alone.diameter_max == pytest.approx(0.109, rel=1e-14)
    assert not cam_faults(alone)


def test_what_makes_no_sense_is_told() -> None:
    m = machine(ARM)
    with pytest.raises(InputError, match="base_radius"):
        search_cams(m, entries={"base_radii": [1.0]})
    with pytest.raises(InputError, match="more than 0"):
        search_cams(m, entries={"base_radius": [0.02, 0.0]})
    with pytest.raises(InputError, match="name of a law"):
        search_cams(m, entries={"base_radius": [0.02]}, laws=["cycloid"])
    with pytest.raises(ShapeError, match="same length"):
        search_cams(m, entries={"base_radius": [0.02, 0.03], "arm_length": [0.07, 0.08, 0.09]})
