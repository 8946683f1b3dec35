"""`linkwright topper best` as a study: its knife keeps the limits of the study, which finds none better."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_line import invoke as run
from sizes import cases
from tests.samples.topper_fields import TOPPER

import linkwright as lw

FIELD = f'[topper.field]\nkind = "random"\nroots = {cases(100, 400)}\nrows = 20\n'
LIMITS = "[topper.limits]\ncomplete_min = 0.9\nslicing_min = 0.4\nhaulm_max = 0.05\n"


def searched(folder: Path, *words: str) -> tuple[dict[str, Any], lw.StudyPlan]:
    file, study = folder / "topper.toml", folder / "study.toml"
    file.write_text(TOPPER + FIELD + LIMITS, encoding="utf-8")
    done = run("topper", "best", str(file), *words, "--study", str(study), "--json")
    assert done.exit_code == 0, done.output
    return json.loads(done.stdout)["results"]["topper_best"], lw.read_study(study)


@pytest.mark.parametrize("objective", ["shortest", "fastest"])
def test_the_best_knife_keeps_the_limits_of_the_study(objective: str, tmp_path: Path) -> None:
    best, plan = searched(tmp_path, "--objective", objective)
    assert 'machine = "topper.toml"\n' in (tmp_path / "study.toml").read_text()
    names = [axis.name for axis in plan.axes]
    rows = lw.evaluate(plan, {name: np.array([best[name]]) for name in names})
    assert rows.status.tolist() == [0], rows.reasons
    for name, (low, high) in plan.limits.items():
        assert low * (1 - 1e-9) <= rows.columns[name][0] <= high * (1 + 1e-9), name
    for name in ("share_complete", "haulm_mean", "slicing_ratio_mean"):
        assert rows.columns[name][0] == pytest.approx(best[name], rel=1e-9)
    for axis in plan.axes:
        assert axis.low - 1e-12 <= best[axis.name] <= axis.high + 1e-12, axis.name
    ((goal, sense),) = plan.study.goals.items()
    assert (goal, sense) == (("speed", "maximise") if objective == "fastest" else ("length", "minimise"))
    assert rows.columns[goal][0] == best["forward_speed" if objective == "fastest" else "edge_length"]


def test_a_general_search_of_the_study_finds_none_better(tmp_path: Path) -> None:
    # At rest, the knife stands at mid-stroke: no speed above zero comes near to that.
    words = ("--set", "topper.limits.knife_speed_min=0.2", "--set", "topper.field.roots=100")
    best, plan = searched(tmp_path, *words)
    assert (tmp_path / "study_machine.toml").exists()
    optimum = lw.optimise(plan, 120, method="global")
    assert best["edge_length"] * (1 - 1e-3) <= optimum.responses["length"] <= 1.2 * best["edge_length"]


def test_a_knife_on_a_crank_varies_its_speed(tmp_path: Path) -> None:
    study = tmp_path / "study.toml"
    words = ("--set", "topper.field.kind=random", "--set", f"topper.field.roots={cases(100, 200)}")
    done = run("topper", "best", "topper_crank", *words, "--study", str(study), "--json", "--seed", "3")
    assert done.exit_code == 0, done.output
    best, plan = json.loads(done.stdout)["results"]["topper_best"], lw.read_study(study)
    names = {"crank_speed": "crank_speed", "edge_angle": "edge_angle", "edge_length": "edge_length"}
    assert {axis.name for axis in plan.axes} == set(names)
    rows = lw.evaluate(plan, {name: np.array([best[name]]) for name in names})
    assert rows.columns["knife_speed"][0] == pytest.approx(best["knife_speed"], rel=1e-9)
    assert rows.columns["share_complete"][0] == pytest.approx(best["share_complete"], rel=1e-9)
