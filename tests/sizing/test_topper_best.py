"""The best knife of a topper: closed forms at rest, against many knives at random, limits that none keeps."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from sizes import cases
from tests.samples import topper_fields

import linkwright as lw
from linkwright import best_knife, topper_field
from linkwright.topping import draw_roots, head_diameter
from linkwright.topping.best.best_knife import KnifeSearch
from linkwright.topping.best.knife_trial import Trials, thinned

FIELD = """
[topper.field]
kind = "random"
roots = 1000
rows = 20
root_diameter = { kind = "normal", mean = "110 mm", deviation = "15 mm", min = "60 mm" }
[topper.limits]
"""


def machine(text: str = "", **entries: object) -> lw.Machine:
    return topper_fields.machine(FIELD + text, **entries)


def bands(topped: lw.Machine) -> np.ndarray:
    assert topped.topper is not None
    roots = draw_roots(topped.topper)
    d = head_diameter(roots.root_diameter, roots.cut_height)
    return np.sort(d + 2 * np.abs(roots.offset))


def test_without_a_wish_for_draw_cut_the_knife_rests_across_the_row() -> None:
    topped = machine()
    found = best_knife(topped)
    assert found.best is not None
    assert (found.best.edge_angle, found.best.knife_speed) == (0, 0)
    # The smallest edge for 950 of 1000 heads.
    assert found.best.edge_length == pytest.approx(bands(topped)[949], rel=1e-9)
    assert found.best.share_complete == 0.95
    assert found.best.at_bounds == ("angle_min", "knife_speed_min")


def test_a_knife_that_may_only_rest_slants() -> None:
    topped = machine("knife_speed_max = 0\nslicing_min = 0.5\n")
    found = best_knife(topped)
    assert found.best is not None
    # At rest the ratio is tan α; the search ends within 60°/12/3⁶ of it.
    assert found.best.slicing_ratio_mean >= 0.5
    assert found.best.edge_angle == pytest.approx(math.atan(0.5), abs=math.radians(0.01))
    length = bands(topped)[949] / math.cos(found.best.edge_angle)
    assert found.best.edge_length == pytest.approx(length, rel=1e-9)
    assert found.map_length.shape == (25, 1)


def test_no_knife_at_random_is_better() -> None:
    topped = machine("slicing_min = 0.7\nknife_speed_min = 0.3\n")
    assert topped.topper is not None
    found = best_knife(topped)
    assert found.best is not None
    assert found.best.slicing_ratio_mean >= 0.7
    trials = Trials(topped, topped.topper, draw_roots(topped.topper))
    rng = np.random.default_rng(8)
    others = [trials.at(rng.uniform(0, math.pi / 3), rng.uniform(0.3, 1.0), 1.9) for _ in range(300)]
    lengths = [each.length for each in others if not each.retreats and each.slicing >= 0.7]
    assert len(lengths) > 50
    # Steps of a sample of 1000 leave the search a little room.
    assert min(lengths) > found.best.edge_length * (1 - 2e-3)
    # What is reported of it is what its machine does.
    own = topped.topper.model_dump() | {
        "edge_angle": found.best.edge_angle,
        "edge_length": found.best.edge_length,
        "knife_speed": found.best.knife_speed,
    }
    again = topper_field(topped.with_entries({"topper": type(topped.topper).model_validate(own)}))
    assert again.share_complete == pytest.approx(found.best.share_complete, abs=1e-12)
    assert again.haulm_mean == pytest.approx(found.best.haulm_mean, rel=1e-9)


def test_verification_takes_other_roots() -> None:
    limits = "slicing_min = 0.4\nknife_speed_min = 0.4\nknife_speed_max = 0.4\n"
    found = best_knife(machine(limits))
    best = found.best
    assert best is not None
    assert best.seed_verified != 1
    assert best.share_verified != best.share_complete
    assert best.is_verified
    assert best.share_verified_low <= 0.95 <= best.share_verified_high
    assert best == best_knife(machine(limits)).best
    assert best != best_knife(machine(limits), seed=3).best


def test_haulm_lengthens_the_edge() -> None:
    topped = machine("haulm_max = 2e-5\nknife_speed_max = 0\nangle_max = 0\n", limits__complete_min=0.5)
    found = best_knife(topped)
    assert found.best is not None
    length = found.best.edge_length
    assert length > 1.2 * bands(topped)[499]
    assert found.best.haulm_mean <= 2e-5
    # Its halvings end within 1e-4 of the longest edge.
    shorter = topper_field(
        machine(knife_speed=0.0, edge_angle=0.0, edge_length=length - 1e-4, limits__complete_min=0.5)
    )
    assert shorter.haulm_mean > 2e-5


def test_the_fastest_has_no_length_to_spare() -> None:
    limits = (
        "slicing_min = 0.6\nknife_speed_min = 0.3\nlength_max = 0.215\nangle_min = 0.41\nangle_max = 0.41\n"
    )
    topped = machine(limits, field__roots=200)
    found = best_knife(topped, objective="fastest")
    best = found.best
    assert best is not None
    assert best.edge_length <= 0.215
    assert best.slicing_ratio_mean >= 0.6
    assert 0.5 < best.forward_speed < 4.0
    faster = best_knife(machine(limits, field__roots=200, forward_speed=best.forward_speed * 1.02))
    assert faster.best is None


@pytest.mark.parametrize(
    ("limits", "limit", "words"),
    [
        ("slicing_min = 5\n", "slicing_min", "draw-cut ratio comes to 1.732, 3.268 too little"),
        ("length_max = 0.1\n", "length_max", "the shortest edge that keeps the other limits has 0.1"),
        ("angle_min = '75 deg'\nangle_max = '80 deg'\nknife_speed_min = 0.9\n", "angle_min", "run backwards"),
        ("haulm_max = 0.01\ncomplete_min = 0.8\n", "haulm_max", "at least 1.* % is left"),
        ("", "complete_min", "at most 8.* % of the heads can be cut"),
    ],
)
def test_limits_that_no_knife_keeps(limits: str, limit: str, words: str) -> None:
    missing = limit in ("haulm_max", "complete_min")
    height = {"kind": "normal", "mean": 0.02, "deviation": 0.018} if missing else 0.03
    topped = machine(limits, field__cut_height=height, field__roots=cases(200, 1000))
    found: KnifeSearch = best_knife(topped)
    assert found.best is None
    assert found.failing is not None
    assert found.failing.limit == limit
    assert re.search(words, found.failing.words), found.failing.words


def test_a_crank_is_told_its_speed() -> None:
    limits = {"knife_speed_min": 0.5, "knife_speed_max": 0.5, "slicing_min": 0.4}
    field = {"kind": "random", "roots": 200, "rows": 10}
    found = best_knife(lw.loads(topper_fields.CRANK, {"topper.field": field, "topper.limits": limits}))
    assert found.best is not None
    # Two strokes of 60 mm a revolution.
    assert found.best.crank_speed == pytest.approx(2 * math.pi * 0.5 / 0.12, rel=1e-6)


def test_thinning_keeps_an_even_part() -> None:
    topped = machine()
    assert topped.topper is not None
    roots = draw_roots(topped.topper)
    part = thinned(roots, 400)
    assert len(part.start) == 400
    assert np.bincount(part.cluster).tolist() == [20] * 20
    assert thinned(roots, 1000) is roots
