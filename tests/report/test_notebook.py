"""What a notebook shows of machines, results and studies, and figures of curves by name."""

from __future__ import annotations

from html import escape
from pathlib import Path

import numpy as np
import pytest

import linkwright as lw
from linkwright import InputError

CARTS = Path(__file__).parents[2] / "machines" / "roller_two_carts.toml"


def test_a_result_shows_its_numbers_with_words_and_units() -> None:
    steady = lw.steady_state(lw.read("roller_two_carts"))
    shown = steady._repr_html_()
    assert "coefficient of speed fluctuation" in shown
    assert f'<td style="text-align:left">{steady.speed_max:.4g}</td>' in shown
    assert "rad/s²" in shown
    assert ">ω<sub>max</sub></td>" in shown


def test_a_machine_and_its_study_are_shown_and_names_are_letters() -> None:
    machine = lw.read("roller_two_carts", {"name": "<b>two</b> & two"})
    assert "<b>two</b>" not in machine._repr_html_()
    assert "&lt;b&gt;two&lt;/b&gt; &amp; two" in machine._repr_html_()
    assert "Cranks: A1" in machine._repr_html_()
    shown = lw.study(machine)._repr_html_()
    assert "The motor is overloaded" in shown
    assert "run_up" in shown


def test_a_study_of_torsion_is_shown_with_its_numbers() -> None:
    study = lw.torsion_study(lw.read("v8_diesel"))
    shown = study._repr_html_()
    assert study.machine.name in shown
    assert all(escape(words, quote=True) in shown for words in (*study.findings, *study.warnings))
    assert study.forced is not None
    assert ">forced</caption>" in shown


def test_many_machines_are_shown_by_the_range_of_their_numbers() -> None:
    machine = lw.read("roller_two_carts")
    phases = np.radians([80.0, 90.0, 100.0])
    many = lw.steady_states(machine, {"mechanism.cranks.A2.phase": phases})
    shown = many._repr_html_()
    assert "3 of 3 machines solved" in shown
    assert f"{many.unevenness.min():.4g} … {many.unevenness.max():.4g}" in shown
    assert "nan" not in shown


def test_curves_are_plotted_an_axis_for_each_unit() -> None:
    steady = lw.steady_state(lw.read("roller_two_carts"))
    axes = steady.plot("speed", "torque_load", "torque_drive").axes
    assert [len(each.lines) for each in axes] == [1, 2]
    x, y = axes[0].lines[0].get_data()
    assert np.array_equal(y, steady.speed)
    assert x[-1] == pytest.approx(360)
    assert axes[-1].get_xlabel() == "crank angle [°]"
    assert steady.plot().axes


def test_a_machine_is_drawn_and_its_curves_by_name() -> None:
    machine = lw.read("roller_two_carts")
    (drawn,) = machine.plot().axes
    # Two cranks, two rods: each a line of its link's width from joint to joint.
    assert {text.get_text() for text in drawn.texts} == {"O", "A1", "A2", "cart1", "cart2"}
    curves = machine.plot("cart1.velocity", "steady_state.speed").axes
    assert [axis.get_ylabel() for axis in curves] == ["velocity [m/s]", "speed [rad/s]"]
    study = lw.study(machine)
    assert study.steady_state is not None
    (along,) = study.plot("steady_state.speed", over="time").axes
    assert np.array_equal(along.lines[0].get_xdata(), study.steady_state.time)
    with pytest.raises(InputError, match='found no curve "sped"'):
        machine.plot("sped")


def test_machines_without_a_linkage_are_told_by_a_figure() -> None:
    assert lw.read("topper").plot().axes
    train = lw.read("v8_diesel")
    assert {"flywheel", "damper"} <= {text.get_text() for text in train.plot().axes[0].texts}
    study = lw.torsion_study(train)
    assert study.plot("mode_shapes").axes[-1].get_xlabel() == "disc"
    with pytest.raises(InputError, match="expected one of scheme, mode_shapes"):
        study.plot("modes")


def test_many_machines_are_drawn_over_what_varies() -> None:
    machine = lw.read("roller_two_carts")
    phases = np.radians([100.0, 80.0, 90.0])
    many = lw.steady_states(machine, {"mechanism.cranks.A2.phase": phases})
    above, below = many.plot("unevenness", "speed_max").axes
    assert below.get_xlabel() == "mechanism.cranks.A2.phase [SI]"
    assert np.array_equal(above.lines[0].get_xdata(), np.sort(phases))
    assert np.array_equal(above.lines[0].get_ydata(), many.unevenness[[1, 2, 0]])
    with pytest.raises(InputError, match="no quantity 'sped'"):
        many.plot("sped")


def test_a_sweep_is_drawn_as_the_command_line_draws_it(tmp_path: Path) -> None:
    written = tmp_path / "study.toml"
    written.write_text("""machine = "roller_two_carts"

[variables.phase]
address = "mechanism.cranks.A2.phase"
range = ["80 deg", "100 deg"]
steps = 3

[responses]
delta = "steady_state.unevenness"
H = "steady_state.dynamism"
""")
    swept = lw.sweep(lw.read_study(written), tmp_path / "rows")
    curves = swept.plot().axes
    assert len(curves) == 2
    (curve,) = swept.plot("H").axes
    assert curve.lines[0].get_xdata() == pytest.approx([80, 90, 100])
    assert np.array_equal(curve.lines[0].get_ydata(), curves[1].lines[0].get_ydata())
    with pytest.raises(InputError, match="found no response 'sped'"):
        swept.plot("sped")


def test_a_notebook_shows_a_figure_without_more_ado() -> None:
    figure = lw.steady_state(lw.read("roller_two_carts")).plot("speed")
    assert figure._repr_png_().startswith(b"\x89PNG")  # type: ignore[attr-defined]  # as IPython asks for it


def test_a_curve_that_is_none_is_refused() -> None:
    steady = lw.steady_state(lw.read("roller_two_carts"))
    with pytest.raises(InputError, match="no curve 'sped'"):
        steady.plot("sped")
    with pytest.raises(InputError, match="no curves"):
        lw.law_factors(lw.cam_profile(lw.read("roller_cam")).cam.lift).plot()


def test_derivatives_are_a_table_and_bars() -> None:
    """A notebook shows each response with its derivatives by influence, `plot` the bars, `to_frame` all."""
    pytest.importorskip("pandas")
    found = lw.gradient(lw.read("roller_two_carts"), ["steady_state.unevenness", "steady_state.speed_max"])
    slope = found.of("steady_state.unevenness")["mechanism.cranks.A2.phase"]
    shown = found._repr_html_()
    assert 'scope="row" style="text-align:left">by mechanism.cranks.A2.phase</th>' in shown
    assert f'<td style="text-align:left">{slope:.4g}</td><td style="text-align:left">per rad</td>' in shown
    frame = found.to_frame()
    assert frame.shape == (len(found.variables), 2)
    assert frame.loc["mechanism.cranks.A2.phase", "steady_state.unevenness"] == slope
    above, below = found.plot().axes
    first = [label.get_text() for label in above.get_yticklabels()][-1]
    assert first == found.variables[found.ranked("steady_state.unevenness")[0]]
    assert "maximum speed" in below.get_xlabel()
    (alone,) = found.plot("steady_state.speed_max").axes
    assert [bar.get_width() for bar in alone.patches] == [bar.get_width() for bar in below.patches]
    with pytest.raises(InputError, match="was not derived"):
        found.plot("steady_state.sped")


def test_kinematics_are_columns_by_the_parts_of_the_mechanism() -> None:
    """Names as of `motion`, with derivatives by the crank angle and their units; one machine, no batch."""
    pytest.importorskip("pandas")
    machine = lw.read("roller_two_carts")
    found = lw.kinematics(machine, third=True)
    frame, cart = found.to_frame(), found.slides["cart1"]
    for name, values in (
        ("cart1.place", cart.position),
        ("cart1.place.d3", cart.d3),
        ("A1.y", found.points["A1"].position[:, 1]),
    ):
        assert np.array_equal(frame[name], values), name
    units = ("", "m", "m/rad", "m/rad³", "rad", "")
    names = ("A1.angle.d1", "A1.x", "A1.y.d1", "cart1.place.d3", "A1.angle", "sped")
    assert tuple(found.unit_of(name) for name in names) == units
    assert "0.6 … 1</td>" in found._repr_html_()
    curves = found.plot("cart1.place", "cart1.place.d1").axes
    assert [axis.get_ylabel() for axis in curves] == ["cart1.place\n[m]", "cart1.place.d1\n[m/rad]"]
    assert curves[-1].get_xlabel() == "crank angles [°]"
    assert len(found.plot().axes) == 2
    many = lw.kinematics(lw.replace(machine, {"mechanism.cranks.A1.radius": np.array([0.19, 0.2])}))
    assert "machines" in many._repr_html_()
    with pytest.raises(InputError, match="a batch of 2 machines"):
        many.to_frame()
    with pytest.raises(InputError, match="no curves"):
        many.plot()


def test_a_linkage_shows_strokes_and_draws_transmission_angles() -> None:
    """A notebook has a row for each stroke and transmission angle; `plot` the curves of all elements."""
    found = lw.linkage(lw.read("roller_two_carts"))
    assert "stroke of cart1</th>" in found._repr_html_()
    angles, ratios = found.plot().axes
    assert np.array_equal(angles.lines[0].get_ydata(), found.transmission_angles["cart1"])
    assert [label.get_text() for label in ratios.get_legend().get_texts()] == [
        "cart1.stroke_ratio",
        "cart2.stroke_ratio",
    ]


def test_columns_of_a_motion_are_plotted_by_name() -> None:
    motion = lw.motion(lw.read("roller_two_carts"), lambda t: 10 * t, np.linspace(0, 1, 51))
    (axes,) = motion.plot("cart1.place.velocity").axes
    assert np.array_equal(axes.lines[0].get_ydata(), motion.slides["cart1"].velocity)
    assert axes.get_xlabel() == "time [s]"
