"""`linkwright size --study`: the written study is optimised to the very same machine."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from command_line import invoke as run

VALVE = """
format = 1
name = "Valve"
[mechanism.cams.valve]
base_radius = "30 mm"
roller_radius = "8 mm"
offset = "2 mm"
sections = [
  { angle = "100 deg", lift = "12 mm", law = "cycloidal" },
  { angle = "120 deg", lift = "-12 mm", law = "modified_sine" },
  { angle = "140 deg" },
]
"""


def optimum(*words: str) -> dict[str, Any]:
    done = run(*words, "--json")
    assert done.exit_code == 0, done.output
    found: dict[str, Any] = json.loads(done.stdout)["results"]["optimum"]
    return found


@pytest.mark.parametrize(
    ("source", "words", "named"),
    [
        ("roller_two_carts", ["--minimum-cost", "--unevenness", "0.08"], "study_machine.toml"),
        ("valve.toml", ["--pressure-angle", "25 deg"], "valve.toml"),
    ],
)
def test_the_written_study_has_the_same_optimum(
    source: str, words: list[str], named: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("valve.toml").write_text(VALVE, encoding="utf-8")
    sized = optimum("size", source, *words, "--study", "study.toml")
    assert f'machine = "{named}"\n' in Path("study.toml").read_text()
    assert Path("study_machine.toml").exists() == (named == "study_machine.toml")
    again = optimum("optimise", "study.toml", "--method", "gradient", "--starts", "3")
    assert again["variables"] == sized["variables"]
    assert again["responses"] == sized["responses"]


def test_a_choice_of_motor_is_no_study(tmp_path: Path) -> None:
    done = run("size", "roller_two_carts", "--study", str(tmp_path / "study.toml"))
    assert done.exit_code == 2
    assert "--study: it belongs to --minimum-cost, --pressure-angle or --shaft" in done.stderr
    assert not list(tmp_path.iterdir())
