"""Figures of toppers show what the results say."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from linkwright import read, topper
from linkwright.papers.published_lengths import Stroke
from linkwright.topping import HeadPass, TopperStudy, constant_speed_lengths, edges_of, length_chart
from linkwright.topping.charts import verdict_chart
from linkwright.topping.figures.lengths import (
    edge_use_figure,
    length_chart_figure,
    phase_figure,
    slicing_figure,
    verdict_figure,
)
from linkwright.topping.figures.view import top_view_figure
from linkwright.topping.head_pass import head_pass

MACHINE = Path(__file__).parents[2] / "machines" / "topper.toml"


def found(*overrides: str) -> TopperStudy:
    return topper(read(MACHINE, list(overrides)))


def seen(length: float) -> HeadPass:
    machine = read(MACHINE)
    assert machine.topper is not None
    return head_pass(edges_of(machine, machine.topper)[0], 0.098, 0.02, 5.13, length)


def labels(axes: object) -> list[str]:
    return axes.get_legend_handles_labels()[1]  # type: ignore[attr-defined, no-any-return]


def test_length_and_share_over_the_phase() -> None:
    short = found("topper.edge_length=0.16 m")
    needed, left = phase_figure(short, 0.16).axes
    assert needed.lines[0].get_ydata() == pytest.approx(1e3 * short.length_by_phase)
    assert {"the edge", "printed (10)", "exact, constant speed"} <= set(labels(needed))
    assert left.lines[0].get_ydata() == pytest.approx(100 * short.uncut_by_phase)
    assert len(phase_figure(found(), 0.28).axes) == 1


def test_a_given_phase_is_marked() -> None:
    (axes,) = phase_figure(found(), 0.28, phase=-np.pi / 2).axes
    assert 270 in [line.get_xdata()[0] for line in axes.lines]


def test_top_view_is_to_scale_and_hatches_what_is_left() -> None:
    (axes,) = top_view_figure(seen(0.16), 0.02).axes
    assert axes.get_aspect() == 1
    hatched = [patch for patch in axes.patches if patch.get_hatch()]
    assert len(hatched) == len(seen(0.16).outlines) == 1
    edges = [line for line in axes.lines if line.get_linewidth() == pytest.approx(2.6)]
    lengths = [np.hypot(*np.ptp(line.get_xydata(), axis=0)) for line in edges]
    assert lengths == pytest.approx([160] * 5)
    whole = top_view_figure(seen(0.28), 0.02, (0.0, 0.049)).axes[0]
    assert not any(patch.get_hatch() for patch in whole.patches)
    assert "left uncut" not in labels(whole)


def test_swept_slices_turn_one_way() -> None:
    """Slices of opposite sense would cancel where they overlap."""
    machine = read(MACHINE, ["topper.edge_angle=-65 deg", "topper.knife_speed=1.4"])
    assert machine.topper is not None
    retreating = head_pass(edges_of(machine, machine.topper)[0], 0.098, 0.0, 1.0, 0.1)
    (axes,) = top_view_figure(retreating).axes
    swept = next(patch for patch in axes.patches if patch.get_label() == "swept by the edge")
    corners = swept.get_path().vertices.reshape(-1, 5, 2)
    a, b = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
    assert (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0] >= 0).all()


def test_chart_has_one_scale_and_three_ways() -> None:
    machine = read(MACHINE)
    assert machine.topper is not None
    chart = length_chart(machine.topper, edges_of(machine, machine.topper))
    axes = length_chart_figure(chart).axes
    assert [each.get_title() for each in axes[:3]] == ["printed (10)", "from (4)", "exact"]
    assert len({each.get_ylim() for each in axes}) == 1
    assert axes[0].lines[1].get_ydata() == pytest.approx(1e3 * chart.over_roots.published[1])
    assert axes[5].lines[0].get_ydata() == pytest.approx(1e3 * chart.over_speeds.constant_speed[0])
    assert "motion of this knife" in labels(axes[2])


def test_use_beyond_the_ends_is_shaded() -> None:
    short = found("topper.edge_length=0.16 m")
    (axes,) = edge_use_figure(short.edge_place, short.edge_use, 0.16, short.head_diameter).axes
    assert "beyond its ends" in labels(axes)
    (whole,) = edge_use_figure(short.edge_place, short.edge_use, 0.28, short.head_diameter).axes
    assert "beyond its ends" not in labels(whole)


def test_slicing_leaves_out_where_the_edge_retreats() -> None:
    phases, speed = np.linspace(0, 2 * np.pi, 5), np.full(5, 2.0)
    ratio, _ = slicing_figure(phases, np.array([0.4, np.nan, 0.2, 50.0, 0.4]), speed).axes
    drawn = ratio.lines[0].get_ydata()
    assert np.isnan(drawn).tolist() == [False, True, False, True, False]
    assert labels(ratio) == ["retreats"]


def test_verdict_has_a_dot_for_the_machine_and_bands_of_all_ways() -> None:
    machine = read(MACHINE)
    assert machine.topper is not None
    chart = verdict_chart(machine.topper, Stroke(0.06, np.pi / 2))
    bands, heads = verdict_figure(chart).axes
    assert {"printed bound (10)", "exact, every phase of the stroke", "this machine"} <= set(labels(bands))
    assert bands.lines[-1].get_xydata()[0] == pytest.approx([20, 137.98], rel=1e-4)
    assert heads.lines[-1].get_xydata()[0] == pytest.approx([30, 20])
    # Without a stroke there is no length for every phase.
    assert len(verdict_chart(machine.topper).bands) == 3


def test_verdict_chart_is_that_of_the_lengths() -> None:
    machine = read(MACHINE)
    assert machine.topper is not None
    chart = verdict_chart(machine.topper, Stroke(0.06, np.pi / 2))
    d = 2 * np.sqrt(chart.cut_heights * (0.11 - chart.cut_heights))
    every = (0.06 + d + 2 * chart.offsets[:, None]) / np.cos(np.radians(20))
    assert chart.longest["every_phase"] == pytest.approx(every)
    low, high = (np.interp(np.radians(20), chart.angles, each) for each in chart.bands["every_phase"])
    # L cos α − S, between points of the chart.
    assert low == pytest.approx(0.25 * np.cos(np.radians(20)) - 0.06, rel=1e-4)
    assert high == pytest.approx(0.30 * np.cos(np.radians(20)) - 0.06, rel=1e-4)
    # With the machine's share of Δ in the band, such heads need the lengths claimed at the largest v_h/v.
    share = 2 * 0.02 / chart.band
    for each, length in zip(chart.bands["constant_speed"], chart.lengths, strict=True):
        band = float(np.interp(np.radians(20), chart.angles, each))
        needed = constant_speed_lengths(band * (1 - share), band * share / 2, np.radians(20), 1.6, 0.8)
        assert needed.max() == pytest.approx(length, rel=1e-4)
