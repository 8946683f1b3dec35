"""What is seen of a rod string: along the rods, drawing, figures, limits of the load, cards on the page."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from tests.samples.wells import well

import linkwright as lw
from linkwright.app.report.scene import moving_scene, scene
from linkwright.app.study import study
from linkwright.machine.table import machine_parts
from linkwright.pumping.unit import pumping_unit
from linkwright.rods import prediction
from linkwright.rods.along import along_rods, cards
from linkwright.rods.figures import string_figures
from linkwright.rods.model.rod_string import GRAVITY
from linkwright.rods.tables import string_headline, string_tables
from linkwright.rods.warnings import string_warnings
from linkwright.studio.analyses import fast

WELL = Path(__file__).parents[1] / "samples" / "measured_well.toml"
UNIT = lw.read("rod_string")


def test_displacement_and_load_along_undamped_rods_are_the_closed_form():
    """u = U cos(k(L − x))/cos kL cos ωt, upward, and F = −EA ∂u/∂x with nothing below: at every node, to
    rounding; the load beside the weight of the rods in the fluid below.
    """
    section = {"rod": "3/4", "length": "5000 ft", "grade": "C"}
    string = well(sections=[section], damping=0.0).rod_string
    rigidity, mass, length = (float(values[0]) for values in string.columns[2:4] + string.columns[:1])
    period, n = 3.75, 512
    omega = 2 * np.pi / period
    k = omega * np.sqrt(mass / rigidity)
    swing = 0.7 * np.cos(omega * period * np.arange(n) / n)
    top = -rigidity * k * np.tan(k * length) * swing
    result = SimpleNamespace(time=np.zeros(n), period=period, position=[swing], load=[top])
    along = along_rods(string, result)
    left = length - along.depth[:, None]
    assert along.position == pytest.approx(np.cos(k * left) / np.cos(k * length) * swing, abs=1e-9)
    weight = GRAVITY * mass * float(string.buoyancy_factor) * left
    own = -rigidity * k * np.sin(k * left) / np.cos(k * length) * swing
    assert along.load == pytest.approx(own + weight, abs=1e-6 * float(string.weight_fluid))
    assert along.stress * string.columns.area[0] == pytest.approx(along.load)


def test_the_string_between_stations_meets_them():
    """Top, both sides of the taper and pump are those of the prediction."""
    motion = lw.rod_string(UNIT)
    along = along_rods(UNIT.rod_string, motion)
    taper = np.flatnonzero(np.diff(along.section))[0]
    for node, station in ((0, 0), (taper, 1), (taper + 1, 1), (-1, 2)):
        assert along.position[node] == pytest.approx(motion.position[station], abs=1e-6)
    assert along.load[-1] == pytest.approx(motion.load[-1], abs=1e-3)
    loads = [load for _, _, load in cards(UNIT.rod_string, motion)]
    area = UNIT.rod_string.columns.area[1]
    assert along.stress[taper + 1] == pytest.approx(loads[1] / area, rel=1e-9)
    assert along.load[0] == pytest.approx(loads[0], rel=1e-9)
    # A corner of the load between two samples stands a little above them.
    assert 1 <= motion.load_max / loads[0].max() < 1.002
    assert 1 <= motion.stress.stress_max[1] * area / loads[1].max() < 1.002


def test_the_area_of_each_card_is_the_work_of_its_station():
    """By the polygon of its samples: the polished rod's power, the pump's, and damping between them."""
    motion = lw.rod_string(UNIT)
    work = [
        0.5 * abs(float(u @ np.roll(f, -1) - np.roll(u, -1) @ f))
        for _, u, f in cards(UNIT.rod_string, motion)
    ]
    assert work[0] / motion.period == pytest.approx(motion.power_rod, rel=1e-4)
    assert work[-1] / motion.period == pytest.approx(motion.power_pump, rel=2e-3)
    assert work[0] > work[1] > work[2]


@pytest.mark.parametrize("machine", [UNIT, well({"fillage": 0.6})], ids=["unit", "alone"])
def test_the_drawn_string_hangs_on_the_polished_rod_and_its_plunger_moves_to_scale(machine):
    """Top node at the hanger, plunger's travel that of the prediction, no rod passes the one below."""
    motion = lw.rod_string(machine)
    drawn = moving_scene(machine, None, string=motion)
    heights, shares = drawn["rods"]["heights"], drawn["rods"]["shares"]
    assert heights[0] == pytest.approx(drawn["points"]["polished_rod"][:, 1])
    assert np.ptp(heights[-1]) == pytest.approx(motion.plunger_travel, rel=1e-3)
    assert (np.diff(heights, axis=0) <= 1e-9).all()
    assert shares.min() > -0.01
    assert shares.max() <= 1.0
    part = next(part for part in drawn["parts"] if part["kind"] == "rods")
    # What is drawn are samples, between which a corner stands a little higher.
    assert part["range"][1] == pytest.approx(motion.stress.stress_max.max(), rel=0.01)
    low, high = part["barrel"]
    assert low < heights[-1].min() < heights[-1].max() < high
    assert drawn["box"][1] <= low
    listed = scene(machine, None, motion)["rods"]
    assert len(listed["heights"]) == heights.size


def test_the_gearbox_has_its_rated_torque_under_the_permissible_load():
    """TF (W_p − B) − M sin θ is the rating on both strokes: an upper limit up, a lower one down."""
    gear, unit = lw.rod_string(UNIT).gear, pumping_unit(UNIT, n=360)
    inside = np.isfinite(gear.load_permissible) & (np.abs(unit.torque_factor) > 0.05)
    torque = unit.torque_factor * gear.load_permissible - gear.counterbalance * np.sin(gear.crank_angle)
    assert torque[inside] == pytest.approx(np.full(inside.sum(), gear.torque_rated), rel=1e-9)
    above = gear.load_permissible > gear.rod_load
    is_within = gear.torque_net < gear.torque_rated
    assert (above == (is_within == (unit.torque_factor > 0)))[inside].all()


def test_rods_that_are_compressed_above_the_pump_are_told():
    """A plunger that falls on its liquid sends compression up the rods, though nothing pushes its end:
    less tension there than at the ends of the section. A full pump does hardly so.
    """
    pound, full = well({"fillage": 0.7}), well()
    motion = lw.rod_string(pound)
    along = along_rods(pound.rod_string, motion)
    low = along.load.min()
    assert motion.stress.load_bottom_min[-1] > -1e-2 * motion.fluid_load
    assert low < -0.3 * motion.fluid_load
    told = [line for line in string_warnings(pound.rod_string, motion) if "buckle" in line]
    assert len(told) == 1
    assert f"{low:.4g} N" in told[0]
    steady = along_rods(full.rod_string, lw.rod_string(full))
    assert steady.load.min() > -0.05 * motion.fluid_load


def test_figures_of_a_prediction_and_of_a_measured_card_have_their_own_names():
    """A study with both has each figure once, in words with the numbers of its result."""
    machine = lw.read(WELL)
    known = study(machine)
    names = [figure.name for figure in known.figures()]
    assert len(names) == len(set(names))
    assert {"rod_cards", "rod_gear", "goodman", "rod_depth", "measured_cards"} <= set(names)
    assert not known.findings
    figures = {figure.name: figure for figure in string_figures(machine.rod_string, known.rod_string)}
    assert f"{100 * known.rod_string.stress.loading_max:.4g}" in figures["goodman"].caption
    axes = figures["rod_cards"].figure.axes[0]
    assert {"polished rod", "taper 1", "pump", "gearbox rating", "structure rating"} == {
        text.get_text() for text in axes.get_legend().get_texts()
    }


def test_a_measured_card_of_the_file_is_diagnosed_as_that_of_the_command():
    """The pump was filled to 65 %; by a file of points or by an array, the same numbers."""
    machine = lw.read(WELL)
    found = study(machine).card_diagnosis
    assert found.fillage == pytest.approx(0.65, abs=0.02)
    card = lw.read_card(WELL.with_suffix(".csv"))
    by_hand = lw.diagnose_card(machine, card.position, card.load)
    assert by_hand.plunger_stroke == pytest.approx(found.plunger_stroke, rel=1e-9)
    assert by_hand.fluid_load == pytest.approx(found.fluid_load, rel=1e-9)


def test_a_string_with_a_card_alone_needs_no_motion():
    """Without stroke and speed its card is diagnosed, and nothing is said of a prediction."""
    card = lw.read_card(WELL.with_suffix(".csv"))
    entries = {"position": card.position.tolist(), "load": card.load.tolist(), "period": 3.75}
    known = study(well(stroke=None, speed=None, card=entries))
    assert known.rod_string is None
    assert known.card_diagnosis.fillage == pytest.approx(0.65, abs=0.02)
    assert known.findings == ()


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        ("position [in], load [lbf]\n1, 2\n2\n", "measured_well.csv"),
        ("place [in], load [lbf]\n1, 2\n", "place"),
        ("position [kg], load [lbf]\n1, 2\n", "position"),
        ("", "an empty file"),
    ],
)
def test_a_wrong_file_of_a_card_is_named(tmp_path, rows, words):
    """The error says file, entry and what is wrong."""
    machine = tmp_path / "machine.toml"
    machine.write_text(WELL.read_text(encoding="utf-8"), encoding="utf-8")
    (tmp_path / "measured_well.csv").write_text(rows, encoding="utf-8")
    with pytest.raises(lw.MachineFileError, match=r"rod_string\.card") as refused:
        lw.read(machine)
    assert words in str(refused.value)


def test_the_studio_draws_and_plots_a_string_with_every_change():
    """Scene, cards that close, and a string without a unit too."""
    for machine in (UNIT, well()):
        answers = fast(machine, held=False)
        assert "rods" in answers.scene
        plot = next(plot for known in answers.results for plot in known["plots"] if plot["key"] == "cards")
        assert [curve["unit"] for curve in plot["curves"]] == ["m", "N"] * 3
        for curve in plot["curves"]:
            assert len(curve["values"]) == len(plot["x"]["values"])
            assert curve["values"][0] == curve["values"][-1]
        assert (np.diff(plot["x"]["values"]) > 0).all()


def test_speeds_are_shown_in_strokes_a_minute_and_production_by_the_day():
    """8 strokes of 7.5 s a minute and volume a stroke times 11 520 strokes a day, where nobody asks for other
    units; SI for who does.
    """
    machine = lw.replace(UNIT, {"drive.speed": 8 * 2 * np.pi / 60})
    motion = lw.rod_string(machine, accuracy=1e-2)
    daily = motion.production * motion.period * 11_520

    def shown(name, row):
        tables = {table.name: table for table in string_tables(motion)}
        return next(cells[2] for cells in tables[name].rows if cells[0] == row)

    assert shown("rod_numbers", "pumping speed") == "8 1/min"
    assert shown("rod_string", "production") == f"{daily:.4g} m³/d"
    assert ("production", f"{daily:.4g}", "m³/d") in list(string_headline(motion))
    with lw.shown_in("Hz, bbl/d"):
        assert shown("rod_numbers", "pumping speed") == "0.1333 Hz"
        assert shown("rod_string", "production") == f"{daily / 0.158987294928:.4g} bbl/d"


def test_the_torque_of_the_gearbox_is_computed_for_the_last_solution_alone(monkeypatch):
    """Once where the best counterbalance is given, however many samples were tried before."""
    calls = []
    known = prediction.gear_torque
    monkeypatch.setattr(prediction, "gear_torque", lambda *given: calls.append(1) or known(*given))
    motion = lw.rod_string(UNIT)
    assert motion.harmonics > 1000
    assert len(calls) == 1


def test_a_report_counts_strokes_per_minute_and_weighs_the_rods():
    """Speeds per minute; a sucker rod is no connecting rod; weight, which the string lives by, is counted."""
    parts = machine_parts(UNIT)
    entries = {entry[:2] for part in parts for entry in part.entries}
    assert {("speed", f"{UNIT.drive.speed * 30 / np.pi:.6g} rpm"), ("nominal size", "7/8")} <= entries
    assert not any(word == "rod" or word.startswith("section ") for word, _ in entries)
    assumed = [*study(UNIT).showing("assumptions")]
    assert any("structural unbalance" in text for text in assumed)
    assert not any("neglected" in text for text in assumed)
