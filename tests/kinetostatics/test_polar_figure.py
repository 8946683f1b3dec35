"""The polar diagram of reactions: its numbers can be read."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path

import pytest

import linkwright as lw
from linkwright.kinetostatics.figures import polar_figure

PRESS = Path(__file__).parents[2] / "examples" / "bearing_loads_of_a_press" / "machine.toml"


@pytest.mark.parametrize("file", ["roller_two_carts", "roller_four_carts", str(PRESS)])
def test_numbers_of_the_circles_do_not_overlap(file: str) -> None:
    machine = lw.read(file)
    figure = polar_figure(lw.forces(machine, lw.steady_state(machine)))
    figure.draw_without_rendering()
    labels = [label for label in figure.axes[0].get_yticklabels() if label.get_text()]
    assert len(labels) > 2
    boxes = [label.get_window_extent() for label in labels]
    assert not [1 for one, other in combinations(boxes, 2) if one.overlaps(other)]
