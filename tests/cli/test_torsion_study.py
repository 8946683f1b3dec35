"""``linkwright torsion`` on machines that something excites."""

from __future__ import annotations

import json
import re
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from command_line import invoke

V12 = "machines/v_diesel.toml"


run = partial(invoke, "torsion")


@pytest.fixture(scope="module")
def told() -> dict[str, Any]:
    found = run(V12, "--json")
    assert found.exit_code == 0, found.output
    return json.loads(found.stdout)


def test_forced_results_have_a_list_over_the_speeds_for_every_part(told: dict[str, Any]) -> None:
    free, forced = told["results"]["free"], told["results"]["forced"]
    assert free["natural_frequencies"][0] == 0.0
    assert len(forced["speeds"]) == 200
    assert forced["orders"][0] == 0.5
    assert forced["orders"][-1] == 24.0
    assert list(forced["shaft_torque_max"]) == free["shafts"]
    assert list(forced["unevenness"]) == free["discs"]
    for name in ("shaft_torque_max", "shaft_torque_vibratory", "unevenness", "unevenness_torsional"):
        assert {len(row) for row in forced[name].values()} == {200}
        assert min(min(row) for row in forced[name].values()) >= 0.0


def test_engine_stress_verdict_and_measure_are_there(told: dict[str, Any]) -> None:
    results = told["results"]
    assert results["engine"]["stiffness_by"] == "constrained"
    assert set(results["engine"]["stiffness_formulas"]) == {
        "constrained",
        "free",
        "carter",
        "ker_wilson",
        "zimanenko",
    }
    assert results["verdict"]["state"] == "ok"
    assert len(results["unevenness_along"]["discs"]) == len(results["free"]["discs"])
    assert told["findings"] == []


def test_every_entry_can_be_set(told: dict[str, Any]) -> None:
    missing = run(V12, "--json", "--set", "train.engine.factors.3=0")
    found = json.loads(missing.stdout)
    way = ("results", "forced", "unevenness", "flywheel")
    before, after = told, found
    for key in way:
        before, after = before[key], after[key]
    assert max(after) > max(before)


def test_a_limit_that_is_not_kept_is_a_finding() -> None:
    found = run(V12, "--set", "train.engine.limit.stress_permitted=20 MPa")
    assert found.exit_code == 1
    assert "FINDING" in found.stdout
    assert "permitted 20 MPa" in found.stdout


def test_report_is_one_page_with_every_figure(tmp_path: Path) -> None:
    found = run("machines/v8_diesel.toml", "--out", str(tmp_path), "--holzer", "100")
    assert found.exit_code == 0, found.output
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    for name in ("scheme", "mode_shapes", "torques", "stress", "orders", "amplitude", "unevenness", "heat"):
        assert f'id="figure-{name}"' in page
    for name in ("limits", "engine", "shaft_torques", "unevenness"):
        assert f'id="table-{name}"' in page
    assert "http://" not in page.replace("http://www.w3.org", "")
    assert json.loads((tmp_path / "results.json").read_text())["results"]["holzer"]


def test_speeds_are_asked_for(tmp_path: Path) -> None:
    text = Path(V12).read_text(encoding="utf-8")
    file = tmp_path / "no_run.toml"
    file.write_text(text[: text.index("[train.run]")], encoding="utf-8")
    found = run(str(file))
    assert found.exit_code == 0
    # Without speeds there is free vibration alone, and the warning says what to give.
    assert "[train.run]" in found.stdout


RUN = """
[train.excitations.e]
on = "a"
harmonics = [{ order = 2, torque = 10 }]
[train.run]
speed_min = 64
speed_max = 192
points = 3
"""
ONE_DISC = 'format = 1\nname = "One"\n[train.discs]\na = { inertia = 1 }\n' + RUN
UNDAMPED = (
    'format = 1\nname = "Two"\n[train.discs]\na = { inertia = 1 }\nb = { inertia = 1 }\n[train.shafts.s]\n'
    'between = ["a", "b"]\nstiffness = 32768\n' + RUN + "speed_rated = 128\n"
)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("text", [ONE_DISC, UNDAMPED])
def test_page_of_a_train_without_shafts_and_of_one_without_bounds(text: str, tmp_path: Path) -> None:
    file = tmp_path / "train.toml"
    file.write_text(text, encoding="utf-8")
    found = run(str(file), "--out", str(tmp_path / "out"))
    assert found.exit_code == 0, found.output
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert ('id="figure-torques"' in page) == ("train.shafts" in text)
    assert not re.search(r">[^<]*\b(nan|inf)\b[^<]*<", page)
    assert not re.search(r"\b(nan|inf)\b", found.stdout)


def test_speed_of_service_that_is_not_looked_at_is_told(tmp_path: Path) -> None:
    file = tmp_path / "train.toml"
    file.write_text(UNDAMPED.replace("speed_rated = 128", "speed_rated = 300"), encoding="utf-8")
    told = json.loads(run(str(file), "--json").stdout)
    assert any("service speed" in each and "1833.5 rpm" in each for each in told["warnings"])


@pytest.mark.parametrize(
    ("entry", "word"),
    [
        ("train.engine.firing_order=[1,2,3]", "firing_order"),
        ("train.run.speed_max=1 rpm", "speed_max"),
        ("train.engine.gas.compression_ratio=0.5", "compression_ratio"),
        ("train.couplings.coupling.stiffness=-3", "stiffness"),
        ("train.engine.rod.inertia=40 kg m^2", "inertia"),
    ],
)
def test_wrong_input_is_told_with_its_key(entry: str, word: str) -> None:
    found = run(V12, "--set", entry)
    assert found.exit_code == 2
    assert word in found.output
    assert "Traceback" not in found.output
