"""Cams of the moving sketch touch their followers at every instant, as the page draws them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from linkwright import loads
from linkwright.app.report.scene import scene

SECTIONS = """
sections = [
  { angle = "100 deg", KEY = "HEIGHT", law = "modified_sine" },
  { angle = "60 deg" },
  { angle = "120 deg", KEY = "-HEIGHT", law = "cycloidal" },
  { angle = "80 deg" },
]
"""
LIFT = SECTIONS.replace("KEY", "lift").replace("HEIGHT", "20 mm")
SWING = SECTIONS.replace("KEY", "swing").replace("HEIGHT", "20 deg")
SMALL_SWING = SECTIONS.replace("KEY", "swing").replace("HEIGHT", "8 deg")
HALVES = """
sections = [
  { angle = "180 deg", lift = "30 mm", law = "cycloidal" },
  { angle = "180 deg", lift = "-30 mm", law = "cycloidal" },
]
"""
ARM = """
follower = "oscillating"
pivot = "C"
arm_pivot = "P"
phase = "20 deg"
base_radius = "40 mm"
"""

CAMS = {
    "translating, offset, opposite": 'base_radius="40 mm"\nroller_radius="10 mm"\noffset="8 mm"\n'
    'direction="35 deg"\nphase="50 deg"\nrotation="opposite"\npivot="C"' + LIFT,
    "groove": 'closure="groove"\nbase_radius="40 mm"\nroller_radius="10 mm"\ndirection="-20 deg"' + LIFT,
    "knife edge": 'contact="point"\nbase_radius="40 mm"' + LIFT,
    "constant diameter": 'closure="constant_diameter"\nbreadth="150 mm"\nroller_radius="10 mm"\n'
    'direction="90 deg"' + HALVES,
    "constant breadth": 'contact="flat"\nclosure="constant_breadth"\nbreadth="150 mm"\ndirection="70 deg"'
    + HALVES,
    "conjugate": 'closure="conjugate"\nbase_radius="40 mm"\nroller_radius="10 mm"\noffset="5 mm"\n'
    'direction="15 deg"\nsecond={ distance="130 mm", roller_radius="8 mm" }' + LIFT,
    "flat, tilted": 'contact="flat"\nbase_radius="60 mm"\nface_tilt="10 deg"\nphase="10 deg"' + LIFT,
    "arm to the left": ARM + 'roller_radius="10 mm"\narm_length="80 mm"' + SWING,
    "arm to the right, opposite": ARM
    + 'roller_radius="10 mm"\narm_length="80 mm"\nside="right"\nrotation="opposite"'
    + SWING,
    "conjugate arms": ARM
    + 'roller_radius="10 mm"\narm_length="80 mm"\nclosure="conjugate"\n'
    + 'second={ angle="95 deg", roller_radius="8 mm" }'
    + SWING,
    "conjugate arms to the right": ARM
    + 'roller_radius="10 mm"\narm_length="80 mm"\nside="right"\nclosure="conjugate"\n'
    + 'second={ angle="95 deg", arm_length="70 mm" }'
    + SWING,
    "arm with a face": ARM + 'contact="flat"\noffset="5 mm"' + SMALL_SWING,
    "arm with a face to the right": ARM + 'contact="flat"\noffset="-4 mm"\nside="right"' + SMALL_SWING,
}


def _machine(text: str) -> str:
    points = '[mechanism.points]\nC = { x = "12 mm", y = "-7 mm" }\nP = { x = "100 mm", y = "40 mm" }\n'
    return f'format = 1\nname = "t"\n[drive]\nspeed = "60 rpm"\n{points}[mechanism.cams.f]\n{text}'


def _placed(found: dict[str, Any], part: dict[str, Any], k: int, places: np.ndarray) -> np.ndarray:
    angle = part["angle"] + (found["headings"][part["link"]][k] if part["link"] else 0.0)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return np.asarray(places) @ turn.T + [axis[k] for axis in found["points"][part["at"]]]


def _distance(place: np.ndarray, outline: np.ndarray) -> float:
    start, along = outline, np.roll(outline, -1, axis=0) - outline
    u = np.clip(((place - start) * along).sum(axis=1) / (along**2).sum(axis=1), 0, 1)
    return float(np.linalg.norm(place - start - u[:, None] * along, axis=1).min())


@pytest.mark.parametrize("name", CAMS)
def test_followers_touch_their_cams(name: str) -> None:
    found = scene(loads(_machine(CAMS[name])))
    assert found is not None
    cams = [part for part in found["parts"] if part["kind"] == "cam"]
    touching = [part for part in found["parts"] if part["kind"] in ("roller", "face")]
    assert len(touching) == (2 if any(word in name for word in ("conjugate", "constant")) else 1)
    for part, cam in zip(touching, cams if len(cams) > 1 else cams * 2, strict=False):
        for k in range(0, len(found["angles"]), 7):
            for outline in cam["outlines"]:
                places = _placed(found, cam, k, np.array(outline))
                if part["kind"] == "roller":
                    centre = _placed(found, part, k, np.array([part["place"]]))[0]
                    gap = _distance(centre, places) - part["radius"]
                else:
                    gap = _from_face(found, part, k, places)
                # Chords of a degree lie 4e-5 of the radius off; places have 1e-4 of it.
                # it.
                assert abs(gap) < 2.5e-5


def _from_face(found: dict[str, Any], part: dict[str, Any], k: int, outline: np.ndarray) -> float:
    """Of the nearest place of an outline from the face; none is beyond it, and the contact is on it."""
    base, along = np.array(part["place"]), np.array([np.cos(part["along"]), np.sin(part["along"])])
    ends = _placed(found, part, k, np.array([base + end * along for end in part["ends"]]))
    direction = (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
    off = (outline - ends[0]) @ np.array([-direction[1], direction[0]])
    side = np.sign(off[np.abs(off).argmax()])
    nearest = int((side * off).argmin())
    reach = float((outline[nearest] - ends[0]) @ direction)
    assert -1e-3 < reach < np.linalg.norm(ends[1] - ends[0]) + 1e-3
    return float(side * off[nearest])


def test_the_frame_holds_the_cam() -> None:
    found = scene(loads(_machine(CAMS["translating, offset, opposite"])))
    assert found is not None
    left, bottom, right, top = found["box"]
    (cam,) = (part for part in found["parts"] if part["kind"] == "cam")
    for k in range(0, len(found["angles"]), 5):
        places = _placed(found, cam, k, np.array(cam["outlines"][0]))
        assert places[:, 0].min() > left - 1e-4
        assert places[:, 0].max() < right + 1e-4
        assert places[:, 1].min() > bottom - 1e-4
        assert places[:, 1].max() < top + 1e-4
