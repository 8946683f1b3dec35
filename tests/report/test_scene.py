"""The data of the moving sketch: links keep their length, sliders their guide, time its playback speed."""

from __future__ import annotations

import json
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from linkwright import loads, read, study
from linkwright.app.report.scene import scene
from linkwright.kernel.files.library import template, templates
from linkwright.machine import dumps

# A torsional train, a knife that follows a law, and a turning-moment diagram have no mechanism to be drawn.
GALLERY = [
    path
    for path in sorted((Path(__file__).parents[2] / "examples").glob("*/machine.toml"))
    if read(path).has_crank
]
TWO_CARTS = Path(__file__).parents[2] / "machines" / "roller_two_carts.toml"
MECHANISMS = [name for name in templates() if loads(template(name)).has_crank]


def drawn(text: str, *overrides: str) -> dict[str, Any]:
    result = study(loads(text, overrides))
    found = scene(result.machine, result.steady_state)
    assert found is not None
    return found


def points(found: dict[str, Any]) -> dict[str, np.ndarray]:
    return {name: np.array(xy) for name, xy in found["points"].items()}


def size(found: dict[str, Any]) -> float:
    left, bottom, right, top = found["box"]
    return float(max(right - left, top - bottom))


@pytest.mark.parametrize("name", MECHANISMS)
def test_loops_close(name: str) -> None:
    text = template(name)
    found, machine = drawn(text), loads(text)
    at = points(found)
    for link in machine.mechanism.links().values():
        length = np.hypot(*(at[link.end] - at[link.start]))
        # Positions are rounded to 1e-5 of the size, at both ends.
        assert np.abs(length - link.length).max() < 2e-5 * size(found)


@pytest.mark.parametrize("name", MECHANISMS)
def test_a_turn_ends_where_it_began(name: str) -> None:
    found = drawn(template(name))
    assert not found["swings"]
    for line in points(found).values():
        assert np.abs(line[:, -1] - line[:, 0]).max() < 1e-5 * size(found)


def test_every_part_draws_points_that_are_there() -> None:
    spring = 'loads.s={kind="spring", between=["B","K"], stiffness=1, free_length=0}'
    found = drawn(template("four-bar"), spring)
    kinds = {part["kind"] for part in found["parts"]}
    assert kinds == {"ground", "trace", "link", "plate", "spring", "mass", "point"}
    for part in found["parts"]:
        names = [part[key] for key in ("from", "to", "at") if key in part] + part.get("corners", [])
        assert set(names) <= set(found["points"])


def test_sliders_stay_on_their_guides() -> None:
    found = drawn(template("slider-crank"), "mechanism.sliders.ram.angle=30 deg")
    guide = next(part for part in found["parts"] if part["kind"] == "guide")
    a, b = np.array(guide["ends"])
    along = (b - a) / np.hypot(*(b - a))
    path = points(found)["ram"].T - a
    assert np.abs(path @ [-along[1], along[0]]).max() < 2e-5 * size(found)
    assert (path @ along).min() > -1e-5
    assert np.hypot(*(b - a)) == pytest.approx(0.2)


def test_sketch_moves_with_the_true_speed() -> None:
    result = study(read(TWO_CARTS))
    found, steady = scene(result.machine, result.steady_state), result.steady_state
    assert found is not None
    assert steady is not None
    assert found["true_speed"]
    assert found["times"][-1] == pytest.approx(steady.period, rel=1e-5)
    # Between two angles of the sketch the speed hardly changes: their difference over time is the speed.
    rates = [(b - a) / (t - s) for (a, b), (s, t) in zip(pairwise(found["angles"]), pairwise(found["times"]))]  # noqa: B905
    middle = 0.5 * (np.array(found["speeds"][1:]) + found["speeds"][:-1])
    assert np.abs(np.array(rates) / middle - 1).max() < 2e-3


def test_without_steady_motion_it_turns_at_the_design_speed() -> None:
    found = drawn(TWO_CARTS.read_text(encoding="utf-8"), "drive.gearbox.ratio=3")
    assert not found["true_speed"]
    assert found["times"][-1] == pytest.approx(2 * np.pi / 10.5, rel=1e-5)


def test_a_mechanism_that_does_not_close_swings() -> None:
    found = drawn(TWO_CARTS.read_text(encoding="utf-8"), "mechanism.sliders.cart1.rod=0.1")
    assert found["swings"]
    assert np.degrees(found["angles"][0]) == pytest.approx(150, abs=0.01)
    assert np.degrees(found["angles"][-1]) == pytest.approx(210, abs=0.01)
    assert all(np.isfinite(line).all() for line in points(found).values())


@pytest.mark.parametrize("path", GALLERY, ids=lambda path: path.parent.name)
def test_every_machine_of_the_gallery_can_be_drawn(path: Path) -> None:
    machine = read(path)
    found = drawn(dumps(machine))
    at, n = points(found), len(found["angles"])
    for part in found["parts"]:
        names = [part[key] for key in ("from", "to", "at") if part.get(key)] + part.get("corners", [])
        assert set(names) <= set(at)
        assert part.get("link") is None or len(found["headings"][part["link"]]) == n
    # Every element that moves is seen: a link, a wheel, a block, a point of its own, or a rope on its arc.
    seen = {part["name"] for part in found["parts"]}
    assert set(machine.linkage.moving_points()) | set(machine.linkage.links()) <= seen
    for link in machine.linkage.links().values():
        if link.role not in ("lever", "gear", "yoke", "barrel", "piston rod"):
            length = np.hypot(*(at[link.end] - at[link.start]))
            assert np.abs(length - link.length).max() < 2e-5 * size(found)
    json.dumps(found, allow_nan=False)


def test_a_motion_of_several_turns_is_drawn_to_its_end() -> None:
    """The pulley turns half as fast as the crank, the planet 7/3 as fast: six turns."""
    found = drawn((GALLERY[0].parents[1] / "gears_and_guides/machine.toml").read_text(encoding="utf-8"))
    assert found["angles"][-1] == pytest.approx(12 * np.pi, abs=1e-4)
    assert not found["swings"]
    for line in points(found).values():
        assert np.abs(line[:, -1] - line[:, 0]).max() < 1e-5 * size(found)


def test_the_horsehead_of_a_pumping_unit_stays_in_the_picture() -> None:
    """Both ends of its arc, at every instant."""
    text = (GALLERY[0].parents[1] / "pumping_unit_torque/machine.toml").read_text(encoding="utf-8")
    found = drawn(text)
    left, bottom, right, top = found["box"]
    (head,) = (part for part in found["parts"] if part["kind"] == "arc")
    for end in head["span"]:
        angle = np.array(found["headings"][head["link"]]) + end
        tip = points(found)[head["at"]] + head["radius"] * np.stack([np.cos(angle), np.sin(angle)])
        # Positions are rounded to 1e-5 of the size.
        room = 2e-5 * size(found)
        assert (tip >= np.array([[left], [bottom]]) - room).all()
        assert (tip <= np.array([[right], [top]]) + room).all()


def test_pitch_circles_touch() -> None:
    found = drawn((GALLERY[0].parents[1] / "gears_and_guides/machine.toml").read_text(encoding="utf-8"))
    radii = {part["name"]: part["radius"] for part in found["parts"] if part["kind"] == "gear"}
    # Cardan's circles of 50 mm in 100 mm; ring 60, planet 18, sun 24 teeth on an arm of 50 mm for 42 of them.
    assert radii["cardan"] == pytest.approx(0.05)
    assert radii["planet"] == pytest.approx(0.05 * 18 / 42)
    assert radii["sun"] == pytest.approx(0.05 * 24 / 42)


def test_a_slotted_lever_holds_its_pin_in_the_slot() -> None:
    found = drawn((GALLERY[0].parents[1] / "quick_returns/machine.toml").read_text(encoding="utf-8"))
    at = points(found)
    for part in (part for part in found["parts"] if part["kind"] == "slot" and part["link"]):
        heading = np.array(found["headings"][part["link"]])
        pin = at["A" if part["name"] == "whitworth" else "B"] - at[part["at"]]
        along = pin[0] * np.cos(heading) + pin[1] * np.sin(heading)
        across = pin[1] * np.cos(heading) - pin[0] * np.sin(heading)
        assert np.abs(across - part["offset"]).max() < 5e-5 * size(found)
        assert part["span"] == pytest.approx([along.min(), along.max()], abs=1e-4 * size(found))
