"""The reproduction of paper 4: what it concludes follows from numbers that are checked here."""

from __future__ import annotations

import json

import numpy as np
import pytest

from linkwright import closure, read
from linkwright.kernel.files.library import library_path
from linkwright.papers.page import page
from linkwright.papers.paper4.formulas import LeverFormula
from linkwright.papers.paper4.paper import Paper4, paper4


@pytest.fixture(scope="module")
def paper() -> Paper4:
    return paper4()


def test_recomputed_unit(paper: Paper4) -> None:
    """Both places of the crankshaft give the printed stroke and the printed lengths exactly."""
    assert paper.unit.k_1 == pytest.approx(2.986, abs=5e-4)
    for place in paper.places:
        (_, top), (_, bottom) = place.unit.ends()
        assert place.unit.k_1 * (top - bottom) == pytest.approx(3.0, abs=1e-12)
        assert np.degrees([top, bottom]) == pytest.approx([26.6, -30.9], abs=0.05)
        m, M = place.unit.extremes()
        assert [(M + m) / 2, (M - m) / 2] == pytest.approx([3.704, 0.3], abs=1e-12)
    found = [(each.unit.x, each.unit.y) for each in paper.places]
    assert found[0] == pytest.approx((-0.824, -2.650), abs=5e-4)
    assert found[1] == pytest.approx((-4.283, -2.520), abs=5e-4)
    angles = np.degrees([each.least_angle for each in paper.places])
    assert angles == pytest.approx([30.7, 7.9], abs=0.05)


def test_machine_files_are_the_recomputed_unit(paper: Paper4) -> None:
    for name in ("continuous", "intermittent"):
        unit = read(library_path(f"rod_rotator_{name}")).pumping_unit
        x, y = unit.saddle
        # The files give a tenth of a millimetre.
        assert (unit.A, -x, -y) == pytest.approx((paper.unit.k_1, paper.unit.x, paper.unit.y), abs=5.1e-5)


def test_front_arm_by_the_loop(paper: Paper4) -> None:
    """The pitman keeps its length, and the rate is the slope of the angle."""
    unit = paper.unit
    phi = np.linspace(0, 2 * np.pi, 100)
    front, rate = unit.front(phi)
    pin = np.stack((unit.x + unit.r * np.cos(phi), unit.y + unit.r * np.sin(phi)))
    rear = -unit.k * np.stack((np.cos(front), np.sin(front)))
    np.testing.assert_allclose(np.hypot(*(pin - rear)), unit.L, rtol=1e-14)
    slope = (unit.front(phi + 1e-5)[0] - unit.front(phi - 1e-5)[0]) / 2e-5
    np.testing.assert_allclose(rate, slope, atol=1e-9)


def test_rates_of_the_lever_by_differences(paper: Paper4) -> None:
    phi = np.linspace(0.1, 6.2, 50)
    lever = LeverFormula(paper.unit, 3.72, 0.45)
    slope = (lever.rocking(phi + 1e-5)[0] - lever.rocking(phi - 1e-5)[0]) / 2e-5
    np.testing.assert_allclose(lever.rocking(phi)[1], slope, atol=1e-9)


def test_limits_at_change_points_by_nearness(paper: Paper4) -> None:
    lever = LeverFormula(paper.unit, 3.704, 0.3)
    for (angle, _), limit in zip(lever.unit.ends(), lever.change_point_rates(), strict=True):
        near = lever.turning(np.array([angle - 1e-4, angle + 1e-4]))[1]
        # The mean of both sides leaves the second order of 1e-4.
        assert near.mean() == pytest.approx(limit, abs=1e-6)


def test_where_the_printed_lengths_close(paper: Paper4) -> None:
    """By bisection of the closed form, and by the closure of the machine with these lengths."""
    rotator = {"regime": "intermittent", "pin_distance": 2.5, "link_length": 3.5, "lever_length": 0.3}
    found = closure(read(library_path("rod_rotator_intermittent"), {"rod_rotator": rotator}))
    assert found.element == "rotator"
    (low, high), *more = found.ranges
    assert not more
    # The file's lengths are rounded to a tenth of a millimetre.
    assert np.degrees(low) % 360 == pytest.approx(np.degrees(paper.closing[0]), abs=0.02)
    assert np.degrees(high) % 360 == pytest.approx(np.degrees(paper.closing[1]), abs=0.02)


def test_condition_18_is_not_sufficient(paper: Paper4) -> None:
    """There are angles where (18) holds and the printed lengths do not close."""
    lever, phi = paper.printed_intermittent, np.linspace(0, 2 * np.pi, 721)
    l_6 = lever.unit.l_6(lever.unit.front(phi)[0])
    holds = lever.l_5 + l_6 > lever.unit.l_3 + lever.l_4
    assert (holds & ~lever.closes(phi)).any()


def test_verdicts(paper: Paper4) -> None:
    rows = {row.name: row for row in paper.rows}
    assert rows["l_4, continuous"].kind == rows["l_5, continuous"].kind == "reproduced"
    assert rows["S"].verdict == "reproduced"
    assert rows["l_4, l_5, intermittent"].kind == "far"
    assert rows["figure 4, dφ_5/dφ_1 continuous"].verdict == "reproduced"
    assert paper.continuous.lever_turns_per_cycle == 1
    assert np.degrees(paper.intermittent.lever_swing) == pytest.approx(90)


def test_everything_is_told(paper: Paper4) -> None:
    told = json.loads(json.dumps(paper.to_dict(), allow_nan=False))
    assert told["conclusions"] == paper.conclusions
    assert len(told["rows"]) == len(paper.rows)
    drawn = paper.figures()
    assert list(drawn) == ["figure3", "figure4", "figure5", "figure6"]
    text = page(paper, drawn)
    assert text.count("<svg") == 4
    for row in paper.rows:
        assert row.verdict.split(",")[0] in text
