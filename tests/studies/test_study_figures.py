"""Pictures of sweeps: labels of long names are inside the picture, and apart from each other."""

from __future__ import annotations

from itertools import combinations, pairwise
from typing import Any

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from linkwright.kernel.figure.style import broken
from linkwright.studies.figures import StudyRows, curve_figure, parallel_figure, scatter_figure

VARIABLES = ("crank_radius_of_first_cart", "phase_of_second_crank", "mass_of_both_carts", "gearbox_ratio")
RESPONSES = ("coefficient_of_speed_fluctuation", "dynamic_factor_H", "mean_speed_over_time")


def rows(variables: tuple[str, ...] = VARIABLES) -> StudyRows:
    rng = np.random.default_rng(1)
    names = (*variables, *RESPONSES)
    columns = {name: rng.uniform(size=50) for name in names}
    labels = {name: f"{name} [rad/s]" for name in names}
    return StudyRows(columns, labels, variables, RESPONSES, is_grid=False)


def boxes(figure: Figure, texts: list[Any]) -> list[Any]:
    """Boxes of texts, which are all inside the picture."""
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
