"""Pages about axes and cylinders: what cards, tables, figures and machine data say, and what is left out."""

from __future__ import annotations

import re

import pytest
from tests.axes.test_servo_axes import CARRIAGE, PACKAGING, changed

import linkwright as lw
from linkwright.app.report.page import content
from linkwright.kernel.page.formulas import with_index
from linkwright.kernel.page.typeset import document

CAM = """
format = 1
name = "Cam alone"
[mechanism.cams.C]
base_radius = "40 mm"
roller_radius = "10 mm"
sections = [
  { angle = "120 deg", lift = "20 mm", law = "cycloidal" },
  { angle = "240 deg", lift = "-20 mm", law = "cycloidal" },
]
"""

LIFT = """
format = 1
name = "Boom on a cylinder"
[mechanism.points]
T = { x = "0.8 m", y = "0 m" }
[mechanism.cylinders.Z]
start = "T"
end = "B"
start_length = "1 m"
law = "0.2*(1 - cos(phi))"
bore = "100 mm"
rod = "56 mm"
[mechanism.joints]
B = { x = "0.9 m", y = "1 m" }
[mechanism.bars]
boom = { start = "O", end = "B", length = "1.3 m" }
[loads]
load = { kind = "force", on = "B", force = "5 kN", direction = "-90 deg" }
"""


def _tables(text: str) -> dict[str, list[tuple[str, ...]]]:
    page = content(lw.study(lw.loads(text)))
    return {table.name: [table.heads, *table.rows] for part in page.parts for table in part.tables}


def _figures(text: str) -> dict[str, str]:
    page = content(lw.study(lw.loads(text)))
    return {figure.name: figure.caption for part in page.parts for figure in part.figures}


def _cards(text: str) -> dict[str, tuple[str, str]]:
    return {word: (value, unit) for word, value, unit in content(lw.study(lw.loads(text))).headline}


def test_a_page_has_the_timing_figure_in_place_of_its_letters() -> None:
    """Blocks of a terminal would overlap the columns beside them."""
    assert "timing" in _figures(PACKAGING)
    assert "timing" not in _tables(PACKAGING)
    assert not re.search("[▁▂▃▅▆▇]", str(_tables(PACKAGING)))


def test_heads_in_print_are_as_large_as_their_columns() -> None:
    """A table that is set smaller to fit the page has smaller heads too."""
    printed = document(content(lw.study(lw.loads(PACKAGING))))
    assert 'head[#"peak velocity";]' in printed
    assert "#let head(body) = text(fill: soft, body)" in printed


def test_axes_without_losses_take_no_power_on_average() -> None:
    """The dial gives back what it took: a mean of 0 W, not what the integration leaves."""
    means = [row for row in _tables(PACKAGING)["dc_bus"] if row[0] == "mean power of the bus"]
    assert means == [("mean power of the bus", "P_bus,mean", "0 W")]
    assert "mean 0 W" in _figures(PACKAGING)["dc_bus"]


def test_a_symbol_after_a_delta_has_its_index_lowered() -> None:
    assert with_index("ΔE_bus") == "ΔE<sub>bus</sub>"


def test_a_constant_speed_stands_inside_the_diagram_of_torque_over_speed() -> None:
    """The camshaft's motor turns at one speed: its line is not the edge of the diagram."""
    study = lw.study(lw.loads(PACKAGING))
    (drawn,) = (figure for figure in study.figures() if figure.name == "axis_shaft")
    _, right = drawn.figure.axes[0].get_xlim()
    assert right > 1.02 * 4 * 3.14159


def test_the_data_of_a_page_have_master_and_axes() -> None:
    """Sections and motor of an axis are data of the machine, and its name stays in every language."""
    page = content(lw.study(lw.loads(CARRIAGE)))
    (parts,) = (parts for group, parts in page.groups if group == "Servo axes")
    assert [part.name for part in parts][:3] == ["master", "A", "A: motor"]
    shaft = changed(
        CARRIAGE, ("[axes.A]", '[axes.shaft]\ndriver = "A"'), ("[axes.A.motor]", "[axes.shaft.motor]")
    )
    shaft = shaft.replace("[axes.A.gearbox]", "[axes.shaft.gearbox]")
    from linkwright.kernel.page.translation import in_language
    from linkwright.kernel.reader.language import language

    words = in_language(content(lw.study(lw.loads(shaft))), language("uk")).headline
    assert any(word.startswith("вісь shaft: ") for word, _, _ in words)


def test_a_cam_without_masses_and_loads_has_no_cards_of_them() -> None:
    """No reduced inertia of 0, no load torque of 0, and neither table nor figure of zeros."""
    assert not {word for word in _cards(CAM) if "inertia" in word or "load torque" in word}
    assert "reduction" not in {*_tables(CAM), *_figures(CAM)}
    loaded = CAM + '[bodies]\nC = { mass = "2 kg" }\n[drive]\nspeed = "60 rpm"\n'
    assert "maximum reduced inertia" in _cards(loaded)


def test_a_cylinder_at_rest_has_pressure_in_bar_and_no_power() -> None:
    """Without a speed only force and pressure are known; with one its power and flow are."""
    still, moving = LIFT, LIFT + '[drive]\nspeed = "6 rpm"\n[bodies]\nboom = { mass = "10 kg" }\n'
    assert _cards(still)["cylinder Z: maximum pressure"][1] == "bar"
    assert "cylinder Z: peak power of the cylinder" not in _cards(still)
    assert "cylinder Z: peak power of the cylinder" in _cards(moving)
    assert "peak power" not in _tables(still)["cylinders"][0]
    assert "peak power" in _tables(moving)["cylinders"][0]
    # The second column is printed as a symbol.
    assert _tables(still)["cylinders"][1][1] == ""


@pytest.mark.parametrize(("name", "words"), [("scissor_lift", "falls to 0° at post"), ("roller_cam", "")])
def test_a_page_says_that_a_poor_transmission_angle_is_no_check(name: str, words: str) -> None:
    """All checks passed beside a transmission angle of 0° would say that it was one of them."""
    passed = content(lw.study(lw.read(name))).passed
    assert passed.startswith("All checks passed")
    assert words in passed
    assert ("not one of them" in passed) == bool(words)


def test_a_warning_has_no_more_digits_than_its_angle() -> None:
    """The inertia vanishes at 0°, not at 0.0°; a motion by a law alone asks for no inertia of the drive."""
    crank = 'format = 1\nname = "n"\n[mechanism.cranks.A]\nradius = 0.1\n{law}'
    crank += '[mechanism.sliders.B]\ncrank = "A"\nrod = 0.4\n[bodies.B]\nmass = 5\n'
    told = lw.study(lw.loads(crank.replace("{law}", ""))).warnings
    assert any("at a crank angle of 0°:" in words for words in told)
    by_law = lw.study(lw.loads(crank.replace("{law}", 'law = "sin(phi)"\n'))).warnings
    assert not any("falls to zero" in words for words in by_law)
