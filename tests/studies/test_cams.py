"""`linkwright cam search` as a study: the smallest cam is the best row of the sweep that keeps the limits."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_line import invoke as run
from sizes import cases

import linkwright as lw
from linkwright import InputError, get
from linkwright.cam import LAWS
from linkwright.cam.profile.check import cam_check
from linkwright.studies import Levels, cam_search_study, kept

ROLLER = """
format = 1
name = "Valve"
[mechanism.cams.valve]
follower = "translating"
contact = "roller"
closure = "spring"
base_radius = "20 mm"
roller_radius = "8 mm"
offset = "2 mm"
sections = [
  { angle = "100 deg", lift = "12 mm", law = "cycloidal" },
  { angle = "40 deg" },
  { angle = "120 deg", lift = "-8 mm", law = "modified_sine" },
  { angle = "60 deg", lift = "-4 mm", law = "cycloidal" },
  { angle = "40 deg" },
]
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "valve.toml"
    path.write_text(ROLLER, encoding="utf-8")
    return path


def test_the_smallest_cam_is_the_best_row_of_the_sweep(file: Path, tmp_path: Path) -> None:
    import pyarrow.parquet as parquet

    study = tmp_path / "study.toml"
    words = ["--vary", "base_radius=14 mm:44 mm:16", "--vary", "lift_factor=0.8:1.2:3"]
    words += ["--law", "modified_sine", "--law", "cycloidal", "--law", "polynomial_3_4_5"]
    words += ["--pressure-angle", "24 deg", "--curvature-radius", "12 mm"]
    file.write_text(ROLLER + '[drive]\nspeed = "300 rpm"\n', encoding="utf-8")
    done = run("cam", "search", str(file), *words, "--count", "3", "--study", str(study), "--json")
    assert done.exit_code == 0, done.output
    found: dict[str, Any] = json.loads(done.stdout)["results"]["cam_search"]
    assert 0 < found["n_kept"] < found["n_cams"] == 144
    assert 'machine = "valve.toml"' in study.read_text()
    swept = run("sweep", str(study), "--out", str(tmp_path / "rows"), "--json")
    assert swept.exit_code == 0, swept.output
    rows = parquet.read_table(sorted((tmp_path / "rows").glob("*.parquet"))).to_pandas()
    assert len(rows) == 144
    keeps = rows.pressure_angle <= math.radians(24)
    keeps &= (rows.convex_radius >= 0.012) & (rows.faults == 0)
    order = rows[keeps].sort_values(["size", "pressure_angle"])
    for own, (_, row) in zip(found["smallest"], order.iterrows(), strict=False):
        assert own["law"] == ("modified_sine", "cycloidal", "polynomial_3_4_5")[int(row.law)]
        assert own["base_radius"] == row.base_radius
        assert own["lift_factor"] == pytest.approx(row.lift_factor, rel=1e-12)
        assert own["pressure_angle_max"] == row.pressure_angle
        assert own["curvature_radius_convex_min"] == row.convex_radius
        assert own["acceleration_max"] == row.acceleration


def test_the_study_is_optimised_between_the_levels(file: Path, tmp_path: Path) -> None:
    study = tmp_path / "study.toml"
    words = ("--vary", "base_radius=14 mm:44 mm:16", "--pressure-angle", "24 deg")
    done = run("cam", "search", str(file), *words, "--count", "1", "--study", str(study), "--json")
    (best,) = json.loads(done.stdout)["results"]["cam_search"]["smallest"]
    optimum = lw.optimise(lw.read_study(study), method="gradient", starts=cases(1, 3))
    # The limit is reached, and the grid lies at most a step above it.
    assert optimum.responses["pressure_angle"] == pytest.approx(math.radians(24), rel=1e-6)
    assert 0 <= best["base_radius"] - optimum.variables["base_radius"] <= 0.002


def test_the_lift_of_all_sections_follows_one_variable() -> None:
    machine = lw.loads(ROLLER, {"drive.speed": 10.0})
    plan = cam_search_study(machine, over={"lift_factor": Levels(0.5, 2.0, 4)}, pressure_angle=0.6)
    rows = lw.evaluate(plan, plan.rows(0, 4))
    assert rows.columns["lift_factor"].tolist() == pytest.approx([0.5, 1.0, 1.5, 2.0])
    plain = lw.cam_profile(machine)
    assert plain.acceleration_max is not None
    assert rows.columns["acceleration"][1] == pytest.approx(plain.acceleration_max, rel=1e-12)
    assert rows.columns["acceleration"][3] == pytest.approx(2 * plain.acceleration_max, rel=1e-12)


@pytest.mark.parametrize("law", sorted(LAWS))
def test_every_law_of_the_search_is_a_value_of_the_study(law: str) -> None:
    over = {"base_radius": Levels(0.06, 0.08, 2)}
    plan = cam_search_study(lw.loads(ROLLER), over=over, laws=[law], pressure_angle=1.5)
    rows = lw.evaluate(plan, plan.rows(0, 1))
    # Laws that are cut off by their jumps have no answer for another reason than their name.
    assert all(why == "" or "law" not in why.split(":")[0] for why in rows.reasons)


def test_faults_are_counted_and_excluded() -> None:
    machine = lw.loads(ROLLER, {"mechanism.cams.valve.base_radius": 0.004})
    assert cam_check(machine).n_faults == len(lw.cam_faults(lw.cam_profile(machine))) > 0
    assert cam_check(lw.loads(ROLLER)).n_faults == 0
    plan = cam_search_study(machine, over={"base_radius": Levels(0.004, 0.06, 2)}, pressure_angle=1.5)
    rows = lw.evaluate(plan, plan.rows(0, 2))
    assert kept(plan, rows).tolist() == (rows.columns["faults"] == 0).tolist() == [False, True]


def test_a_breadth_gives_way_to_the_base_radius(tmp_path: Path) -> None:
    study = tmp_path / "study.toml"
    done = run("cam", "search", "roller_cam", "--vary", "base_radius=0.2:0.3:5", "--study", str(study))
    assert done.exit_code == 0, done.output
    plan = lw.read_study(study)
    assert get(plan.machine, "mechanism.cams.cart.breadth") is None
    assert np.all(lw.evaluate(plan, plan.rows(0, 5)).status == 0)


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--vary", "face_tilt=0 deg:1 deg:2"], 'found "face_tilt", expected what such a cam depends on'),
        (["--vary", "base_radius=0.02:0.03:2", "--law", "cycloid"], 'did you mean "cycloidal"'),
        (["--vary", "base_radius=-0.02:0.03:2"], "base_radius -0.02, expected more than 0"),
        ([], "--vary: found nothing that varies"),
        (["--vary", "base_radius=0.02:0.03:2", "--force"], "--force"),
    ],
)
def test_what_is_no_search(words: list[str], told: str, file: Path) -> None:
    done = run("cam", "search", str(file), *words)
    assert done.exit_code == 2
    assert told in done.stderr


def test_a_cam_without_lift_has_no_factor_on_it() -> None:
    still = ROLLER[: ROLLER.index("sections")] + 'sections = [{ angle = "360 deg" }]\n'
    with pytest.raises(InputError, match="lift"):
        cam_search_study(lw.loads(still), over={"lift_factor": Levels(0.5, 2.0, 4)}, pressure_angle=0.6)
