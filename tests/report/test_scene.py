"""The data of the moving sketch: links keep their length, sliders their guide, time its pace."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from linkwright.analysis.study import study
from linkwright.files import loads, read, template, templates
from linkwright.report.scene import scene

TWO_CARTS = Path(__file__).parents[2] / "machines" / "roller_two_carts.toml"


def drawn(text: str, *overrides: str) -> dict[str, Any]:
    found = scene(study(loads(text, overrides)))
    assert found is not None
    return found


def points(found: dict[str, Any]) -> dict[str, np.ndarray]:
    return {name: np.array(xy) for name, xy in found["points"].items()}


def size(found: dict[str, Any]) -> float:
    left, bottom, right, top = found["box"]
    return float(max(right - left, top - bottom))


@pytest.mark.parametrize("name", templates())
def test_loops_close(name: str) -> None:
    text = template(name)
    found, machine = drawn(text), loads(text)
    at = points(found)
    for link in machine.mechanism.links().values():
        length = np.hypot(*(at[link.end] - at[link.start]))
        # Positions are rounded to 1e-5 of the size, at both ends.
        assert np.abs(length - link.length).max() < 2e-5 * size(found)


@pytest.mark.parametrize("name", templates())
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
    found, steady = scene(result), result.steady_state
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
