"""What stands in the way of an analysis, and buttons that mend it; transfer functions follow every change."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import linkwright as lw
from linkwright import loads
from linkwright.drive.obstacles import MOTORS_OF_TRAIN
from linkwright.kernel.reader.language import language
from linkwright.studio.analyses import chips, fast, found, said
from linkwright.studio.document import changed
from linkwright.studio.language import as_read, in_units

ROOT = Path(__file__).parents[2]
MACHINES = sorted([*ROOT.glob("machines/*.toml"), *ROOT.glob("examples/*/machine.toml")])

# Presses of a button each: a motor, another one, a body, a brake, an elastic shaft.
PRESSES = 8


def with_buttons(text: str, path: str) -> tuple[lw.Machine, set[str]]:
    machine = loads(text, path=path)
    for _ in range(PRESSES):
        blocked = [chip for chip in chips(machine) if chip.get("obstacle")]
        mends = [chip for chip in blocked if chip["mend"]]
        if not mends:
            return machine, {chip["obstacle"] for chip in blocked}
        text = changed(text, mends[0]["entries"])
        machine = loads(text, path=path)
    raise AssertionError(f"the buttons lead to no end: {blocked}")


@pytest.mark.parametrize("path", MACHINES, ids=lambda path: path.parent.name + "." + path.stem)
def test_buttons_lead_to_a_machine_that_can_be_computed(path: Path) -> None:
    machine, left = with_buttons(path.read_text(), str(path))
    # Where the crank does not turn fully there is no speed to keep.
    turns = machine.has_crank and lw.closure(machine).turns_fully
    kept = {MOTORS_OF_TRAIN} if machine.has_mounted_mechanisms else set()
    assert left <= kept | (set() if turns else {"The motor keeps its speed from the start."})
    if machine.has_crank:
        assert {"steady_state", "forces", "torsion"} <= {chip["name"] for chip in chips(machine)}


def test_a_dc_motor_in_place_of_a_kept_speed_runs_near_it() -> None:
    text = (ROOT / "machines" / "topper_crank.toml").read_text()
    kept = loads(text, path=str(ROOT / "machines" / "topper_crank.toml"))
    chip = next(one for one in chips(kept) if one["name"] == "run_up")
    assert chip["mend"] == "Use a DC motor"
    machine = loads(changed(text, chip["entries"]))
    # Between the no-load speed and the speed at the root mean square, which is above the mean torque.
    speed = lw.steady_state(machine).speed_mean_time
    assert 1.0 < speed / lw.steady_state(kept).speed_mean_time < 1.1
    assert lw.run_up(machine).time > 0


def test_transfer_functions_are_those_of_the_package() -> None:
    machine = lw.read(ROOT / "machines" / "roller_two_carts.toml")
    answer = fast(machine, held=False)
    assert answer.scene is not None
    plots = next(one["plots"] for one in answer.results if one["name"] == "transfer")
    motion = lw.kinematics(machine, answer.scene["angles"])
    assert [plot["unit"] for plot in plots] == ["m", "m/rad", "m/rad²"]
    for plot, order in zip(plots, ("position", "d1", "d2"), strict=True):
        assert [curve["name"] for curve in plot["curves"]] == ["cart1", "cart2"]
        for curve in plot["curves"]:
            wanted = getattr(motion.slides[curve["name"]], order)
            np.testing.assert_allclose(curve["values"], wanted, rtol=0, atol=1e-12)


def test_tables_of_the_report_are_there_in_the_language() -> None:
    machine = lw.read(ROOT / "machines" / "v8_diesel.toml")
    study = found(machine, "torsion")
    answer = said(study, "torsion", language("uk"))
    titles = [table["title"] for table in answer.tables]
    assert any("частот" in title for title in titles), titles
    assert answer.headline
    english = said(study, "torsion")
    lowest = next(f for f in lw.free_vibration(machine).natural_frequencies.tolist() if f > 0)
    cells = [cell for table in english.tables for row in table["rows"] for cell in row]
    assert any(cell.startswith(f"{lowest:.4g}") for cell in cells)


def test_sentences_and_diagrams_are_in_the_units_of_the_page() -> None:
    machine = lw.read(ROOT / "machines" / "roller_two_carts.toml")
    with in_units(["mm", "rpm", "kW"]):
        body = as_read(said(found(machine, "study"), "study").body())
    assert any(" rpm" in words for words in body["warnings"])
    assert not any("rad/s" in words for words in body["warnings"])
    motion = next(figure for figure in body["figures"] if figure["name"].startswith("motion"))
    assert "mm/s" in motion["caption"]
    cells = [cell for table in body["tables"] for row in table["rows"] for cell in row]
    assert any(cell.endswith(" rpm") for cell in cells)
