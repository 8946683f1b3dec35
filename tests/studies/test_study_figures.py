"""Pictures of sweeps: labels of long names are inside the picture, and apart from each other."""

from __future__ import annotations

from collections.abc import Callable
from itertools import combinations, pairwise
from typing import Any

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from scipy.stats.qmc import Sobol

from linkwright.kernel.figure.style import broken
from linkwright.studies import StudyRows
from linkwright.studies.figures import _drawn, _mixed, curve_figure, parallel_figure, scatter_figure

VARIABLES = ("crank_radius_of_first_cart", "phase_of_second_crank", "mass_of_both_carts", "gearbox_ratio")
RESPONSES = ("coefficient_of_speed_fluctuation", "dynamic_factor_H", "mean_speed_over_time")


def rows(variables: tuple[str, ...] = VARIABLES) -> StudyRows:
    rng = np.random.default_rng(1)
    names = (*variables, *RESPONSES)
    columns = {name: rng.uniform(size=50) for name in names}
    labels = {name: f"{name} [rad/s]" for name in names}
    return StudyRows(columns, labels, variables, RESPONSES, is_grid=False)


def boxes(figure: Figure, texts: list[Any]) -> list[Any]:
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    found = [text.get_window_extent() for text in texts]
    width, height = canvas.get_width_height()
    for text, box in zip(texts, found, strict=True):
        assert box.x0 >= -1, text
        assert box.y0 >= -1, text
        # A trailing underscore may stand over the edge.
        assert box.x1 <= width + 8, text
        assert box.y1 <= height + 1, text
    return found


def test_labels_of_parallel_coordinates() -> None:
    figure = parallel_figure(rows())
    (panel,) = figure.axes
    labels = boxes(figure, panel.get_xticklabels())
    assert len(labels) == 7
    for left, right in pairwise(labels):
        assert left.x1 <= right.x0


def test_labels_of_a_scatter_matrix() -> None:
    figure = scatter_figure(rows())
    below = [axes.xaxis.label for axes in figure.axes if axes.get_xlabel()]
    beside = [axes.yaxis.label for axes in figure.axes if axes.get_ylabel()]
    assert (len(below), len(beside)) == (7, 7)
    for labels in (boxes(figure, below), boxes(figure, beside)):
        for one, other in combinations(labels, 2):
            assert not one.overlaps(other)


def test_labels_of_curves() -> None:
    figure = curve_figure(rows(VARIABLES[:1]))
    labels = boxes(figure, [axes.yaxis.label for axes in figure.axes])
    for one, other in combinations(labels, 2):
        assert not one.overlaps(other)


@pytest.mark.parametrize(
    ("label", "lines"),
    [
        ("delta [–]", ["delta [–]"]),
        ("crank_radius_of_first_cart [kg m²]", ["crank_", "radius_of_", "first_cart", "[kg m²]"]),
        ("coefficientofspeed [m]", ["coefficientofspeed", "[m]"]),
        ("_a_b", [" _a_b"]),
    ],
)
def test_a_name_breaks_behind_its_underscores(label: str, lines: list[str]) -> None:
    assert broken(label, 10).split("\n") == lines
    assert broken(label, 60).strip() == label


@pytest.mark.parametrize("draw", [scatter_figure, parallel_figure])
def test_a_part_of_a_sobol_sequence_covers_its_ranges(draw: Callable[[StudyRows], Figure]) -> None:
    """Every second row of the sequence has half the range of one variable, every fourth of another."""
    n = 65536
    columns = dict(zip(("radius", "rod", "mass"), Sobol(3, scramble=False).random(n).T, strict=True))
    # One row alone has the maximum.
    columns["delta"] = np.where(np.arange(n) == 4711, 9.0, columns["rod"])
    labels = {name: f"{name} [–]" for name in columns}
    shown = StudyRows(columns, labels, ("radius", "rod", "mass"), ("delta",), is_grid=False, n_rows=n)
    figure = draw(shown)
    drawn = _drawn(shown, np.arange(n), 600)
    assert f"of {n} rows" in figure.get_suptitle()
    assert 4711 in drawn
    for name in shown.variables:
        values = columns[name][drawn]
        assert (values.min(), values.max()) == (columns[name].min(), columns[name].max())
        # Each tenth of the range has a tenth of the rows, but for chance.
        counts = np.histogram(values, bins=10, range=(0.0, 1.0))[0]
        assert (np.abs(counts - 60) < 5 * np.sqrt(60)).all()
        mixed = _mixed(np.arange(n)) % np.uint64(2) == 0
        halves = np.histogram(columns[name][mixed], bins=2, range=(0.0, 1.0))[0]
        assert np.abs(halves / n - 0.25).max() < 0.01
