"""Figures: drawn from results, alike in every run, in words with units."""

from __future__ import annotations

import warnings
from functools import cache
from pathlib import Path

import pytest

import linkwright as lw
from linkwright import loads, read, study
from linkwright.app.study import Study
from linkwright.drive.characteristic import characteristic
from linkwright.drive.figures import motor_figure, reduction_figure, run_up_figure
from linkwright.kernel.figure.svg import svg
from linkwright.kinetostatics.figures import forces_figure
from linkwright.sensitivity.figures import influence_figure

TWO_CARTS = Path(__file__).parents[2] / "machines" / "roller_two_carts.toml"


@cache
def two_carts() -> Study:
    return study(read(TWO_CARTS))


def test_axes_have_words_and_units() -> None:
    for each in two_carts().figures():
        for axes in each.figure.axes:
            assert "[" in axes.get_ylabel() or axes.get_subplotspec().colspan.start > 0
        assert any("[" in axes.get_xlabel() for axes in each.figure.axes)


def test_curves_are_those_of_the_result() -> None:
    reduced = two_carts().reduction
    assert reduced is not None
    line = reduction_figure(reduced).axes[0].lines[0]
    assert line.get_ydata() == pytest.approx(reduced.inertia_reduced)
    assert line.get_xdata()[-1] == pytest.approx(360)


def test_run_up_is_drawn_beyond_its_end() -> None:
    run_up = two_carts().run_up
    assert run_up is not None
    time, turns = run_up_figure(run_up, two_carts().steady_state).axes
    assert time.get_xlim()[1] > run_up.time
    assert turns.get_xlim()[1] == pytest.approx(run_up.turns + 1, rel=1e-3)


def test_working_range_lies_on_the_characteristic() -> None:
    steady = two_carts().steady_state
    assert steady is not None
    figure = motor_figure(characteristic(read(TWO_CARTS)), steady)
    left, right = figure.axes[1].get_xlim()
    assert left < steady.speed_min * 9.8 < steady.speed_max * 9.8 < right
    assert len(motor_figure(characteristic(read(TWO_CARTS))).axes) == 1


def test_svg_is_alike_in_every_run_and_knows_nothing_of_the_day() -> None:
    reduced = two_carts().reduction
    assert reduced is not None
    first, second = (svg(reduction_figure(reduced)) for _ in range(2))
    assert first == second
    assert first.startswith("<svg")
    assert "<text" not in first
    assert "dc:date" not in first


def test_style_of_the_user_does_not_matter() -> None:
    from matplotlib import rc_context

    reduced = two_carts().reduction
    assert reduced is not None
    usual = svg(reduction_figure(reduced))
    with rc_context({"font.size": 30, "axes.grid": False, "svg.fonttype": "none"}):
        assert svg(reduction_figure(reduced)) == usual


def test_the_longest_names_leave_axes_room() -> None:
    """A name may have 100 letters: figures show both of its ends."""
    text = TWO_CARTS.read_text(encoding="utf-8")
    for cart in ("cart1", "cart2"):
        text = text.replace(cart, f"cart_{'long' * 22}_{cart[-1]}")
    machine = loads(text)
    gradient = lw.gradient(machine, ["steady_state.unevenness"])
    with warnings.catch_warnings():
        # The layout only warns where it leaves axes no room.
        warnings.simplefilter("error")
        svg(forces_figure(lw.forces(machine)))
        svg(influence_figure(gradient, "steady_state.unevenness"))
