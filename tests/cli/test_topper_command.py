"""`linkwright topper field` and `linkwright topper best`: tables, JSON, files, exit codes."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from command_line import invoke
from tests.samples.topper_fields import FIELD, TOPPER

run = partial(invoke, "topper")


@pytest.fixture
def file(tmp_path: Path) -> str:
    path = tmp_path / "topper.toml"
    path.write_text(TOPPER + FIELD, encoding="utf-8")
    return str(path)


def told(*words: str) -> dict[str, Any]:
    result = run(*words, "--json")
    found: dict[str, Any] = json.loads(result.stdout)
    return found


def test_tables_of_a_field(file: str) -> None:
    result = run("field", file, "--over", "edge_angle=0 deg:30 deg:3")
    assert result.exit_code == 0
    assert result.stdout.startswith("Topper\n")
    for words in (
        "500 heads of 10 rows",
        "heads cut through",
        "for 99.9 % of the heads",
        "mass of it",
        "the knife passes above",
        "draw-cut ratio",
        "15°",
    ):
        assert words in result.output


def test_json_of_a_field(file: str) -> None:
    found = told("field", file)
    field = found["results"]["topper_field"]
    assert 0 < field["share_complete_low"] < field["share_complete"] < field["share_complete_high"] < 1
    assert field["haulm_mean_low"] < field["haulm_mean"] < field["haulm_mean_high"]
    assert field["loss_mass_mean"] == pytest.approx(1050 * field["loss_mean"])
    assert field["length_for_50"] < field["length_for_90"]
    assert field["quantile_length"][0] == field["length_for_50"]
    # More than a percent of the heads is missed: no length for 99.9 %.
    assert field["length_for_99_9"] is None
    assert "passes above" in found["warnings"][0]
    assert found == told("field", file)
    assert told("field", file, "--seed", "7")["results"] != found["results"]
    longer = told("field", file, "--set", "topper.edge_length=0.2 m")["results"]["topper_field"]
    assert longer["share_complete"] > field["share_complete"]
    assert longer["length_for_50"] == field["length_for_50"]


def test_two_entries_are_combined(file: str) -> None:
    words = ("--over", "edge_length=0.1:0.2:3", "--over", "knife_speed=0:0.5 m/s:2")
    swept = told("field", file, *words)["results"]["topper_field_sweep"]
    assert swept["shape"] == [3, 2]
    assert swept["edge_length"] == pytest.approx([0.1, 0.1, 0.15, 0.15, 0.2, 0.2])
    assert swept["knife_speed"] == pytest.approx([0, 0.5] * 3)
    assert len(swept["share_complete"]) == 6


def test_files_of_a_field(file: str, tmp_path: Path) -> None:
    out = tmp_path / "out"
    result = run("field", file, "--out", str(out), "--over", "cut_height=0.01:0.05:3")
    assert result.exit_code == 0
    names = {"results.json", "share.csv", "haulm.csv", "sweep.csv"}
    names |= {
        f"{n}.{k}" for n in ("share", "length_needed", "haulm_and_loss", "sweep") for k in ("svg", "png")
    }
    assert {path.name for path in out.glob("[!.]*")} == names
    head, *rows = (out / "share.csv").read_text().splitlines()
    assert head == "length [m],share [-],share_low [-],share_high [-]"
    assert len(rows) == 201
    head = (out / "sweep.csv").read_text().splitlines()[0]
    assert head.startswith("cut_height [m],share_complete [-]")
    assert "loss_mean [m³]" in head


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("height", [-0.01, 0.03])
def test_heads_that_are_all_alike_are_drawn(file: str, tmp_path: Path, height: float) -> None:
    sets = ("--set", f"topper.field.cut_height={height}", "--set", "topper.motion.phase=1")
    result = run("field", file, *sets, "--set", "topper.field.offset=0", "--out", str(tmp_path / "out"))
    assert result.exit_code == 0
    assert len(list((tmp_path / "out").glob("*.png"))) == 3


def test_limits_give_the_exit_code(file: str) -> None:
    sound = run("field", file, "--set", "topper.limits.complete_min=0.5")
    assert sound.exit_code == 0
    failing = run("field", file, "--set", "topper.limits.complete_min=0.99", "--json")
    assert failing.exit_code == 1
    found = json.loads(failing.stdout)
    assert "99 % are required" in found["findings"][0]
    assert found["findings"][0] in found["warnings"]


def test_best_knife(file: str, tmp_path: Path) -> None:
    out = tmp_path / "best"
    sets = ("--set", "topper.limits.slicing_min=0.5", "--set", "topper.limits.complete_min=0.9")
    result = run("best", file, *sets, "--out", str(out))
    assert result.exit_code == 0, result.output
    assert result.stdout.startswith("Topper\n")
    for words in ("Shortest edge", "over other", "≥ 90 %", "[topper]", "edge_angle = "):
        assert words in result.output
    best = json.loads((out / "results.json").read_text())["results"]["topper_best"]
    assert best["slicing_ratio_mean"] >= 0.5
    assert best["share_complete"] >= 0.9
    assert best["failing"] is None
    lines = (out / "topper.toml").read_text()
    assert f"edge_length = {best['edge_length']!r}" in lines
    assert {path.name for path in out.glob("[!.]*")} == {
        "results.json",
        "map.csv",
        "topper.toml",
        "map.svg",
        "map.png",
    }
    # What is reported can be set, and gives the same share.
    keys = ("edge_angle", "edge_length", "knife_speed")
    own = [word for key in keys for word in ("--set", f"topper.{key}={best[key]!r}")]
    field = told("field", file, *own)["results"]["topper_field"]
    assert field["share_complete"] == pytest.approx(best["share_complete"], abs=1e-12)


@pytest.mark.parametrize(
    ("limits", "words"),
    [
        ({}, "No slicing_min is given"),
        ({"slicing_min": 0.4}, "A slanted edge at rest reaches"),
        ({"slicing_min": 0.4, "knife_speed_min": 0.8, "angle_max": 0.1}, "No such"),
    ],
)
def test_what_to_know_of_the_best(file: str, limits: dict[str, float], words: str) -> None:
    asked = {"complete_min": 0.9, **limits}
    sets = [word for key, x in asked.items() for word in ("--set", f"topper.limits.{key}={x}")]
    warnings = " ".join(told("best", file, *sets)["warnings"])
    if words == "No such":
        assert "rests" not in warnings
    else:
        assert words in warnings


def test_no_knife_keeps_the_limits(file: str) -> None:
    sets = ("--set", "topper.limits.knife_speed_max=0", "--set", "topper.limits.slicing_min=3")
    result = run("best", file, *sets, "--json")
    assert result.exit_code == 1
    found = json.loads(result.stdout)
    failing = found["results"]["topper_best"]["failing"]
    assert failing["limit"] == "slicing_min"
    assert failing["reached"] == pytest.approx(3**0.5)
    assert "slicing_min = 3" in found["findings"][0]
    assert "edge_length" not in found["results"]["topper_best"]


@pytest.mark.filterwarnings("error")
def test_a_map_without_any_knife(file: str, tmp_path: Path) -> None:
    # Half of the heads are missed: no edge is long enough anywhere.
    shallow = 'topper.field.cut_height={kind="normal", mean=0, deviation=0.01}'
    result = run("best", file, "--set", shallow, "--out", str(tmp_path / "none"))
    assert result.exit_code == 1
    assert "cut deeper" in result.output
    assert {path.name for path in (tmp_path / "none").glob("[!.]*")} == {"results.json", "map.csv"}


def test_fastest(file: str) -> None:
    limits = {"angle_max": 0, "knife_speed_min": 0.5, "knife_speed_max": 0.5, "length_max": 0.175}
    sets = [
        word
        for key, x in {**limits, "complete_min": 0.9}.items()
        for word in ("--set", f"topper.limits.{key}={x}")
    ]
    best = told("best", file, "--objective", "fastest", *sets)["results"]["topper_best"]
    assert best["objective"] == "fastest"
    assert best["edge_length"] <= 0.175
    assert best["forward_speed"] > 0.5


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--over", "edge_lenght=0:1:3"), 'did you mean "edge_length"'),
        (("--over", "edge_length=0.1:0.2"), "expected LOW:HIGH:N"),
        (("--over", "edge_length=0.1:0.2:0"), "expected LOW:HIGH:N"),
        (("--over", "edge_length=0.1 kg:0.2:3"), "expected a length"),
        (("--over", "edge_length=0:0.2:3"), "found edge_length 0 m, expected more than 0"),
        (("--over", "edge_length=0.1:0.2:3", "--over", "edge_length=0.1:0.2:3"), "same name twice"),
        (("--seed", "-1"), "found -1"),
        (("--level", "1"), "--level: found 1, expected at least 0.001"),
        (("--set", "topper.field.rows=501"), "at most one for each of 500 roots"),
    ],
)
def test_wrong_words(file: str, words: tuple[str, ...], message: str) -> None:
    result = run("field", file, *words)
    assert result.exit_code == 2
    assert message in result.output


def test_a_measured_root_that_cannot_be(file: str, tmp_path: Path) -> None:
    text = TOPPER + '[topper.field]\nkind = "measured"\nfile = "roots.csv"\n'
    Path(file).write_text(text)
    points = tmp_path / "roots.csv"
    points.write_text("root_diameter [mm], cut_height [mm], offset [mm]\n100, 20, 3\n90, 95, -4\n")
    result = run("field", file)
    assert result.exit_code == 2
    assert f"{points}:3: topper.field.cut_height.1" in result.output
    points.write_text("root_diameter [mm], cut_height [mm], offset [mm]\n100, 20, 3\n90, 25, -4\n")
    assert told("field", file)["results"]["topper_field"]["clusters"] == "roots"


def test_a_file_alone_is_run() -> None:
    machine = str(Path(__file__).parents[2] / "machines" / "topper.toml")
    whole = json.loads(invoke("run", machine, "--json").stdout)
    assert told(machine)["results"]["topper"] == whole["results"]["topper"]


def test_folder_that_cannot_be_written(file: str) -> None:
    result = run("field", file, "--out", file)
    assert result.exit_code == 2
    assert "found a file, expected a folder for --out" in result.output


def test_a_machine_without_topper() -> None:
    machine = str(Path(__file__).parents[2] / "machines" / "roller_cam.toml")
    for command in ("field", "best"):
        result = run(command, machine)
        assert result.exit_code == 2
        assert "has no [topper]" in result.output
