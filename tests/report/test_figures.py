"""Figures of a report share marks of the crank angle, legends that tell, names of joints, size of letters."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.text import Text

import linkwright as lw
from linkwright import InputError, torsion_study
from linkwright.app.report.page import content
from linkwright.kernel.figure.legends import legend_above
from linkwright.kernel.figure.lines import Level, Line, Panel, line_figure
from linkwright.kernel.figure.style import BLUE, RED, SMALL, panels, styled
from linkwright.kernel.figure.svg import svg
from linkwright.kernel.page.translation import in_language
from linkwright.kernel.reader.language import language
from linkwright.kernel.reader.numbers import number
from linkwright.torsion import torsion_content


@pytest.mark.parametrize("machine", ["roller_two_carts", "press_with_flywheel", "four_stroke_speed"])
def test_all_figures_over_the_crank_angle_have_the_same_marks(machine: str) -> None:
    """Every 90 degrees of one revolution or two, from zero on, also where samples begin beside it."""
    steps = set()
    for figure in lw.study(lw.read(machine)).figures():
        for axes in figure.figure.axes:
            if axes.name == "rectilinear" and axes.get_xlabel().startswith("crank angle"):
                marks = axes.get_xticks()
                assert marks[0] == 0.0
                steps |= set(np.diff(marks).tolist())
    assert steps == {90.0}


@styled
def _drawn(curves: Sequence[np.ndarray]) -> Figure:
    figure, (axes,) = panels(1, height=3.0)
    for n, curve in enumerate(curves):
        axes.plot(np.arange(len(curve)), curve, label=f"x{n}")
    legend_above(axes)
    return figure


def test_a_legend_tells_of_curves_that_coincide() -> None:
    """The second of two curves within the width of a line is dashed and names the first; a third does not."""
    wave = np.sin(np.linspace(0.0, 6.0, 99))
    axes = _drawn([wave, wave + 1e-3, wave + 0.2]).axes[0]
    legend = axes.get_legend()
    assert legend is not None
    assert [text.get_text() for text in legend.get_texts()] == ["x0", "x1 (coincides with x0)", "x2"]
    assert [line.is_dashed() for line in axes.get_lines()] == [False, True, False]


def test_a_legend_is_no_wider_than_its_axes() -> None:
    """Long names stand in fewer columns: the axes keep their width."""
    figure = _drawn([np.full(9, n) for n in range(4)])
    for line in figure.axes[0].get_lines():
        line.set_label(f"starboard_crank_{line.get_label()}_of_the_second_engine")

    @styled
    def again() -> Figure:
        legend_above(figure.axes[0])
        return figure

    svg(again())
    assert figure.axes[0].get_position().width > 0.8


def test_joints_are_named_in_the_drawing_as_in_the_tables() -> None:
    """Every pin of the table of forces has its name beside its joint in the drawing."""
    machine = lw.read("roller_two_carts")
    sketch = content(lw.study(machine)).sketch
    assert sketch is not None
    drawn = {text.get_text() for text in sketch().findobj(Text)}
    pins = {name.rpartition(":")[2] for name, pair in lw.forces(machine).pairs.items() if pair.kind == "pin"}
    assert pins
    assert pins <= drawn


@pytest.mark.parametrize("code", ["en", "uk"])
@pytest.mark.parametrize("machine", ["rod_rotator_continuous", "pumping_unit_torque", "jansen_leg"])
def test_names_of_joints_stand_beside_them(machine: str, code: str) -> None:
    """No name of the drawing covers a joint, whatever the language and the length of its words."""
    report = in_language(content(lw.study(lw.read(machine))), language(code))
    assert report.sketch is not None
    figure = report.sketch()
    (axes,) = figure.axes
    FigureCanvasAgg(figure).draw()
    # Filled areas of joints are white and lie before the links.
    joints = [patch.get_window_extent() for patch in axes.patches if patch.get_facecolor()[:3] == (1, 1, 1)]
    names = [text.get_window_extent() for text in axes.texts]
    assert joints
    for joint in joints:
        centre = (joint.x0 + joint.x1) / 2, (joint.y0 + joint.y1) / 2
        assert not [name for name in names if name.contains(*centre)]


def test_a_moving_drawing_names_its_parts_in_the_language_of_the_page() -> None:
    """Names that a file gives stay; those of expanded parts have their words, as in the tables."""
    (scene,) = in_language(content(lw.study(lw.read("pumping_unit_torque"))), language("uk")).scenes.values()
    assert scene["labels"]["beam"] == "балансир"
    (own,) = in_language(content(lw.study(lw.read("roller_two_carts"))), language("uk")).scenes.values()
    assert own["labels"] == {}


def test_a_tall_drawing_leaves_room_on_its_page() -> None:
    """Warnings, cards and the drawing of a square machine stand on the first page of its report."""
    sketch = content(lw.study(lw.read("roller_cam"))).sketch
    assert sketch is not None
    width, height = sketch().get_size_inches()
    # Printed as wide as the text, 170 mm.
    assert 170 * height / width < 100


@pytest.mark.parametrize("machine", ["v8_diesel", "twin_engine_ship"])
def test_letters_of_a_scheme_can_be_read(machine: str) -> None:
    """No text of a scheme is smaller than 7.5 points, of which print leaves 7."""
    report = torsion_content(torsion_study(lw.read(machine)))
    (scheme,) = (each.figure for part in report.parts for each in part.figures if each.name == "scheme")
    sizes = [text.get_fontsize() for text in scheme.findobj(Text) if text.get_text()]
    assert min(sizes) >= SMALL


def test_rounding_on_a_card_is_zero() -> None:
    """A mean or a minimum that is rounding beside its maximum is zero in the summary, as in the tables."""
    report = content(lw.study(lw.read("cam_oscillating_valve")))
    cards = {few.word: few.value for few in report.headline}
    assert cards["minimum reduced inertia"] == "0"
    assert cards["maximum reduced inertia"] != "0"
    assert "from 0 kg m² to" in next(
        figure.caption for part in report.parts for figure in part.figures if figure.name == "reduction"
    )


def test_numbers_have_four_digits_unless_asked() -> None:
    """Tables, cards and captions have four significant digits; whoever asks for others gets them."""
    assert number(np.pi) == "3.142"
    with lw.shown_in(digits=6):
        assert number(np.pi) == "3.14159"
        with lw.shown_in("mm"):
            assert number(np.pi) == "3.14159"
    with pytest.raises(InputError, match="digits: found 0, expected 1 to 15"):
        lw.shown_in(digits=0)


def test_lines_and_levels_of_a_panel_are_in_its_legend_and_in_view() -> None:
    """Angles reach over the revolution with their words below the last panel; wanted heights are in view."""
    x = np.linspace(0.0, 360.0, 5)
    pull = Panel("pull $Z$\n[N]", [Line(2 + np.sin(x), BLUE, "rope"), Level(2.0, "mean")], room=(0.0,))
    figure = line_figure(x, pull, Panel("lift [m]", [Line(x, RED)]), height=3.0)
    above, below = figure.axes
    legend = above.get_legend()
    assert legend is not None
    assert [text.get_text() for text in legend.get_texts()] == ["rope", "mean"]
    assert below.get_legend() is None
    assert above.get_ylim()[0] < 0
    assert (above.get_xlabel(), below.get_xlabel()) == ("", "crank angle φ [°]")
    assert below.get_xlim() == (0.0, 360.0)
