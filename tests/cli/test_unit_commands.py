"""Pumping units and rotators on the command line."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from command_line import invoke as run

from linkwright import loads, pumping_units

MACHINES = Path(__file__).parents[2] / "machines"


@pytest.mark.parametrize("known", pumping_units(), ids=lambda known: known.designation)
def test_new_writes_every_unit_of_the_catalogue(known) -> None:
    for hole in range(1, len(known.holes) + 1):
        text = run("new", "pumping-unit", "--designation", known.designation, "--hole", str(hole)).stdout
        unit, expected = loads(text).pumping_unit, known.unit(hole)
        for letter in ("A", "C", "I", "P", "H", "G", "R", "structural_unbalance"):
            assert getattr(unit, letter) == pytest.approx(getattr(expected, letter), rel=1e-12), letter


def test_new_pumping_unit_runs(tmp_path: Path) -> None:
    path = tmp_path / "unit.toml"
    assert run("new", "pumping-unit", "--designation", "c-114d-133-54", "--out", path).exit_code == 0
    done = run("run", path, "--json")
    assert done.exit_code == 0
    results = json.loads(done.stdout)["results"]
    unit = results["pumping_unit"]
    assert len(unit["torque_factors"]) == 24
    assert unit["torque_factor_min"] < min(unit["torque_factors"])
    assert unit["torque_factor_max"] > max(unit["torque_factors"])
    assert unit["stroke"] == pytest.approx(1.4106, abs=5e-5)
    assert results["gear_torque"]["gear_load"] < 1
    short = json.loads(run("run", path, "--json", "--set", "pumping_unit.R=20 in").stdout)
    assert short["results"]["pumping_unit"]["stroke"] < unit["stroke"]


def test_report_of_a_unit(tmp_path: Path) -> None:
    path = tmp_path / "unit.toml"
    run("new", "pumping-unit", "--out", path)
    assert run("run", path, "--out", tmp_path / "out").exit_code == 0
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    for words in (
        "Polished rod over one revolution",
        "Torque of the gearbox",
        "Positions of rods and torque factors",
    ):
        assert words in page
    head = (tmp_path / "out" / "pumping_unit.csv").read_text(encoding="utf-8").splitlines()[0]
    assert "torque_factor [m]" in head
    assert "rod_velocity [m/s]" in head


def test_unknown_designation_and_hole() -> None:
    done = run("new", "pumping-unit", "--designation", "C-114D-133-55")
    assert done.exit_code == 2
    assert 'did you mean "C-114D-133-54"' in done.stderr
    done = run("new", "pumping-unit", "--designation", "C-25D-67-30", "--hole", "3")
    assert done.exit_code == 2
    assert "expected 1 (outermost) to 2" in done.stderr
    done = run("new", "press", "--hole", "1")
    assert done.exit_code == 2
    assert "pumping-unit" in done.stderr


def test_list_of_units() -> None:
    lines = run("new", "pumping-unit", "--list").stdout.splitlines()
    assert len(lines) == 27
    assert lines[0].split()[0] == "C-114D-133-54"
    assert "pumping-unit" in run("new", "--list").stdout


def test_rotator_in_the_continuous_regime() -> None:
    found = json.loads(run("run", MACHINES / "rod_rotator_continuous.toml", "--json").stdout)
    rotator = found["results"]["rotator"]
    assert rotator["lever_turns_per_cycle"] == 1
    assert rotator["lever_length"] == pytest.approx(0.3, abs=5e-4)
    assert rotator["link_length"] == pytest.approx(3.704, abs=5e-4)
    assert 0 < rotator["transfer_min"] < 1 < rotator["transfer_max"]
    assert found["findings"] == []


def test_rotator_in_the_intermittent_regime() -> None:
    done = run("run", MACHINES / "rod_rotator_intermittent.toml", "--json")
    rotator = json.loads(done.stdout)["results"]["rotator"]
    assert rotator["lever_swing"] == pytest.approx(1.5707963, abs=1e-7)
    assert rotator["transfer_min"] < 0 < rotator["transfer_max"]


def test_printed_lengths_are_a_finding(tmp_path: Path) -> None:
    path = MACHINES / "rod_rotator_intermittent.toml"
    sets = ("--set", "rod_rotator.link_length=3.5", "--set", "rod_rotator.lever_length=0.3")
    text = path.read_text(encoding="utf-8").replace('swing = "90 deg"\n', "")
    own = tmp_path / "printed.toml"
    own.write_text(text, encoding="utf-8")
    done = run("run", own, "--json", *sets)
    assert done.exit_code == 1
    found = json.loads(done.stdout)
    assert "rotator" in found["findings"][0]
    # The unit itself runs.
    assert found["results"]["pumping_unit"]["stroke"] == pytest.approx(3.0, abs=1e-3)


def test_paper_4(tmp_path: Path) -> None:
    done = run("papers", "4", "--json")
    assert done.exit_code == 0
    found = json.loads(done.stdout)["results"]["paper4"]
    assert found["recomputed"]["k_1"] == pytest.approx(2.986, abs=5e-4)
    assert run("papers", "4", "--out", tmp_path).exit_code == 0
    names = {path.name for path in tmp_path.glob("[!.]*")}
    assert {"papers4.html", "figure3.svg", "figure4.png", "figure5.svg", "figure6.png"} <= names
    assert re.search(r"\n4 +Lever mechanism", run("papers").stdout)
