"""The moving top view of a topper: its data are the knife's law, and its heads those of the study."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from linkwright import loads, read, study
from linkwright.app.report.page import knife_scene
from linkwright.kernel.files.library import template
from linkwright.topping import edges_of

MACHINES = Path(__file__).parents[2] / "machines"
ONE_WAY = 'topper.motion={kind="constant"}'

CASES: dict[str, tuple[str, tuple[str, ...]]] = {
    "sine": ("topper", ("topper.edge_length=0.16 m",)),
    "crank": ("topper_crank", ()),
    "back and forth": ("topper", ('topper.motion={kind="constant", stroke="50 mm"}',)),
    "one way": ("topper", (ONE_WAY,)),
    "at rest": ("topper", ("topper.knife_speed=0",)),
    "retreats": ("topper", ("topper.edge_angle=-65 deg",)),
    "phase given": ("topper", ("topper.motion.phase=90 deg",)),
    "slow": ("topper", ("topper.knife_speed=0.01", "topper.motion.phase=90 deg")),
    "stands": ("topper", (ONE_WAY, "topper.edge_angle=45 deg", "topper.knife_speed=1.9")),
}


@cache
def drawn(case: str) -> dict[str, Any]:
    name, overrides = CASES[case]
    found = knife_scene(study(read(MACHINES / f"{name}.toml", list(overrides))))
    assert found is not None
    return found


def place(found: dict[str, Any], time: np.ndarray) -> np.ndarray:
    """Where the page has the middle of the edge: straight between places of the law."""
    phases = np.linspace(0, 2 * np.pi, len(found["law"]))
    phase = np.mod(found["phase"] + found["rate"] * time, 2 * np.pi)
    return np.asarray(np.interp(phase, phases, found["law"]) + found["drift"] * time)


@pytest.mark.parametrize("case", CASES)
def test_knife_goes_by_its_law(case: str) -> None:
    found, (name, overrides) = drawn(case), CASES[case]
    machine = read(MACHINES / f"{name}.toml", list(overrides))
    assert machine.topper is not None
    time = np.linspace(*found["span"], 301)
    ways = [edge.knife.at(time, found["phase"]) for edge in edges_of(machine, machine.topper)]
    # Half a degree between places: S/2 · (π/360)²/8 of 60 mm, and the last digit.
    fine = 1e-5 * found["diameter"] + 0.03 * (np.pi / 360) ** 2 / 4
    assert min(np.abs(place(found, time) - y).max() for y in ways) < fine


@pytest.mark.parametrize("case", CASES)
def test_edge_starts_before_the_first_head_and_ends_behind_the_last(case: str) -> None:
    found = drawn(case)
    first, last = (np.array(time) for time in found["span"])
    sin, cos = np.sin(found["angle"]), np.cos(found["angle"])
    for x, y in found["heads"]:
        before, behind = ((found["speed"] * t - x) * cos - (place(found, t) - y) * sin for t in (first, last))
        if case != "stands":
            assert before < -0.5 * found["diameter"]
            assert behind > 0.5 * found["diameter"]


@pytest.mark.parametrize("case", CASES)
def test_all_is_inside_the_box(case: str) -> None:
    found = drawn(case)
    x0, y0, x1, y1 = found["box"]
    time = np.linspace(*found["span"], 301)
    half = 0.5 * found["length"] * np.array([np.sin(found["angle"]), np.cos(found["angle"])])
    for sign in (-1, 1):
        x, y = found["speed"] * time + sign * half[0], place(found, time) + sign * half[1]
        assert x0 - 1e-6 <= x.min() and x.max() <= x1 + 1e-6  # noqa: PT018
        assert y0 - 1e-6 <= y.min() and y.max() <= y1 + 1e-6  # noqa: PT018
    for x, y in found["heads"]:
        assert x0 <= x <= x1
        assert abs(y) <= found["offset"] + 1e-9


def test_head_in_the_middle_is_the_worst() -> None:
    name, overrides = CASES["sine"]
    result = study(read(MACHINES / f"{name}.toml", list(overrides)))
    found, scene = result.topper, drawn("sine")
    assert found is not None
    assert scene["phase"] == found.uncut_phase
    assert scene["heads"][2] == pytest.approx([0, found.uncut_offset], abs=1e-6)
    enough = study(read(MACHINES / "topper.toml")).topper
    assert enough is not None
    kept = knife_scene(study(read(MACHINES / "topper.toml")))
    assert kept is not None
    assert kept["phase"] == enough.worst_phase


def test_heads_do_not_touch_and_meet_the_knife_in_several_phases() -> None:
    scene = drawn("sine")
    x = np.array([head[0] for head in scene["heads"]])
    assert np.diff(x).min() > scene["diameter"]
    phases = np.mod(scene["phase"] + scene["rate"] * x / scene["speed"], 2 * np.pi)
    assert len(np.unique(np.round(phases, 2))) == len(x)


def test_heads_of_a_given_phase_all_come_in_it() -> None:
    scene = drawn("phase given")
    assert len(scene["heads"]) == 5
    x = np.array([head[0] for head in scene["heads"]])
    turns = scene["rate"] * x / scene["speed"] / (2 * np.pi)
    # Places are given to 1e-5 of the diameter.
    assert turns == pytest.approx(np.round(turns), abs=1e-4)
    # A slow knife comes to that phase again only far away.
    assert len(drawn("slow")["heads"]) == 1
    assert len(drawn("one way")["heads"]) == 1


@pytest.mark.parametrize("case", CASES)
def test_data_are_small(case: str) -> None:
    assert len(json.dumps(drawn(case), allow_nan=False)) < 20_000


def test_there_is_nothing_without_a_topper() -> None:
    assert knife_scene(study(loads(template("slider-crank")))) is None
