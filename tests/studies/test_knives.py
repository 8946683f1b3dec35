"""The grid of `linkwright topper field --over` as a study: the same rows, and the study file of them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_line import invoke as run
from tests.samples.topper_fields import CRANK, FIELD, TOPPER, machine

import linkwright as lw
from linkwright import InputError, MachineFileError, get, sweep_field
from linkwright.studies import field_study

SMALL = '[topper.field]\nkind = "random"\nroots = 300\nspacing = "0.31 m"\n'


def rows_of(study: Path, folder: Path) -> dict[str, np.ndarray]:
    """Columns of the sweep of a study file."""
    import pyarrow.parquet as parquet

    done = run("sweep", str(study), "--out", str(folder), "--json")
    assert done.exit_code == 0, done.output
    table = parquet.read_table(sorted(folder.glob("*.parquet")))
    return {name: table.column(name).to_numpy() for name in table.column_names if name != "reason"}


@pytest.mark.parametrize(
    ("text", "over", "options"),
    [
        (TOPPER + FIELD, ["edge_length=0.1:0.2:3", "edge_angle=0 deg:30 deg:2"], []),
        (TOPPER + FIELD, ["cut_height=-0.05:0.05:3"], ["--seed", "7", "--level", "0.9"]),
        (CRANK + SMALL, ["knife_speed=0.3:0.9:4"], ["--set", "topper.edge_length=0.15 m"]),
    ],
)
def test_the_written_study_has_the_rows_of_the_command(
    text: str, over: list[str], options: list[str], tmp_path: Path
) -> None:
    file, study = tmp_path / "topper.toml", tmp_path / "folder" / "study.toml"
    file.write_text(text, encoding="utf-8")
    study.parent.mkdir()
    words = [word for axis in over for word in ("--over", axis)]
    done = run("topper", "field", str(file), *words, *options, "--study", str(study), "--json")
    assert done.exit_code == 0, done.output
    swept: dict[str, Any] = json.loads(done.stdout)["results"]["topper_field_sweep"]
    rows = rows_of(study, tmp_path / "rows")
    assert (rows["status"] == 0).all()
    del swept["shape"]
    for name, column in swept.items():
        own = np.where(np.isfinite(rows[name]), rows[name], np.nan)
        told = np.array(column, dtype=float)
        # Values of a range are those of the command to rounding.
        np.testing.assert_allclose(own, told, rtol=1e-9, atol=1e-15, err_msg=name)


def test_a_study_names_the_machine_file_that_is_as_it_is(tmp_path: Path) -> None:
    file = tmp_path / "topper.toml"
    file.write_text(TOPPER + FIELD, encoding="utf-8")
    words = ("topper", "field", str(file), "--over", "edge_length=0.1:0.2:3", "--study")
    folder = tmp_path / "folder"
    folder.mkdir()
    assert run(*words, str(folder / "same.toml")).exit_code == 0
    # A study names files of its own folder alone.
    assert 'machine = "same_machine.toml"\n' in (folder / "same.toml").read_text()
    assert run(*words, str(tmp_path / "same.toml")).exit_code == 0
    assert 'machine = "topper.toml"\n' in (tmp_path / "same.toml").read_text()
    assert run(*words, str(folder / "other.toml"), "--set", "topper.offset=30 mm").exit_code == 0
    assert 'machine = "other_machine.toml"\n' in (folder / "other.toml").read_text()
    assert get(lw.read(folder / "other_machine.toml"), "topper.offset") == 0.03
    assert run(*words, str(folder / "seeded.toml"), "--seed", "9").exit_code == 0
    assert get(lw.read(folder / "seeded_machine.toml"), "topper.field.seed") == 9
    assert len(list(folder.iterdir())) == 6


def test_a_study_is_not_written_over_a_file(tmp_path: Path) -> None:
    words = ("topper", "field", "topper", "--over", "edge_length=0.1:0.2:2", "--seed", "3", "--study")
    study, beside = tmp_path / "mine.toml", tmp_path / "mine_machine.toml"
    beside.write_text("other")
    refused = run(*words, str(study))
    assert refused.exit_code == 2
    assert "mine_machine.toml: exists already; --force replaces it" in refused.stderr
    # Neither of the two is written.
    assert not study.exists()
    assert beside.read_text() == "other"
    assert run(*words, str(study), "--force").exit_code == 0
    assert lw.read_study(study).n_rows == 2
    (tmp_path / "link.toml").symlink_to(study)
    assert run(*words, str(tmp_path / "link.toml"), "--force").exit_code == 2


def test_a_study_never_replaces_its_machine(tmp_path: Path) -> None:
    """Neither under its own name nor under that of the machine beside it, whatever --force says."""
    for name, study, extra in (
        ("own.toml", "own.toml", ()),
        ("k_machine.toml", "k.toml", ("--set", "topper.offset=30 mm")),
    ):
        file = tmp_path / name
        file.write_text(TOPPER + FIELD, encoding="utf-8")
        over = ("--over", "edge_length=0.1:0.2:3", *extra)
        done = run("topper", "field", str(file), *over, "--study", str(tmp_path / study), "--force")
        assert done.exit_code == 2
        assert "machine file of the study itself" in done.stderr
        assert file.read_text() == TOPPER + FIELD
    for place in (".", "/"):
        assert run("topper", "field", str(file), *over, "--study", place).exit_code == 2
    size = ("size", "roller_two_carts", "--minimum-cost")
    done = run(*size, "--study", str(tmp_path / "z.toml"), "--out", str(tmp_path / "z.toml"), "--force")
    assert done.exit_code == 2
    assert "a file that --study writes" in done.stderr


def test_a_study_in_a_linked_folder_finds_its_machine(tmp_path: Path) -> None:
    (tmp_path / "real" / "deep").mkdir(parents=True)
    (tmp_path / "link").symlink_to(tmp_path / "real" / "deep")
    file = tmp_path / "topper.toml"
    file.write_text(TOPPER + FIELD, encoding="utf-8")
    study = tmp_path / "link" / "s.toml"
    over = ("--over", "edge_length=0.1:0.2:3")
    assert run("topper", "field", str(file), *over, "--study", str(study)).exit_code == 0
    assert lw.read_study(study).n_rows == 3


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["topper"], "--study: found it without --over"),
        (["topper_crank", "--over", "knife_speed=0:1:3"], "knife_speed: found 0 m/s, expected more than 0"),
        (["topper", "--over", "edge_length=-1:1:3"], "found edge_length -1 m, expected more than 0"),
        (["topper", "--over", "edge_length=0.1:0.2:3", "--seed", "-1"], "seed: found -1"),
    ],
)
def test_what_is_no_study(words: list[str], told: str, tmp_path: Path) -> None:
    done = run("topper", "field", *words, "--study", str(tmp_path / "study.toml"))
    assert done.exit_code == 2
    assert told in done.stderr
    assert not list(tmp_path.iterdir())


def test_rows_of_the_plan_are_those_of_the_sweep() -> None:
    own = machine(SMALL)
    over = {"edge_length": [0.1, 0.15, 0.25], "knife_speed": [0.0, 0.5]}
    plan, swept = field_study(own, over, level=0.8), sweep_field(own, over, level=0.8)
    rows = lw.evaluate(plan, plan.rows(0, plan.n_rows))
    for name, column in swept.columns().items():
        assert np.array_equal(rows.columns[name], column), name
    # A wider level has wider intervals.
    wide = sweep_field(own, over)
    assert (wide.haulm_mean_high - wide.haulm_mean_low > swept.haulm_mean_high - swept.haulm_mean_low).any()


def test_a_shift_of_the_cut_moves_all_heights() -> None:
    text = SMALL + 'cut_height = { kind = "normal", mean = "30 mm", deviation = "5 mm" }\n'
    deeper = text.replace("30 mm", "34 mm")
    shifted = lw.topper_field(machine(text + 'cut_height_shift = "4 mm"\n'))
    own = lw.topper_field(machine(deeper))
    assert shifted.loss_mean == pytest.approx(own.loss_mean, rel=1e-12)
    assert shifted.share_complete == own.share_complete


def _study(response: str) -> lw.StudyPlan:
    import tomllib

    tables = tomllib.loads(f"""
[variables.shift]
address = "topper.field.cut_height_shift"
values = [-0.05, 0.0]
[responses]
share = "topper_field.share_complete"
low = {{ quantity = "topper_field.share_complete_low" }}
asked = {response}
""")
    return lw.new_study(machine(SMALL + "cut_height_shift = 0.0\n"), tables)


def test_a_number_stands_for_one_that_there_is_not() -> None:
    plain = _study('{ quantity = "topper_field.length_for_95" }')
    rows = lw.evaluate(plain, plain.rows(0, 2))
    assert rows.status.tolist() == [1, 0]
    kept = _study('{ quantity = "topper_field.length_for_95", otherwise = inf }')
    rows = lw.evaluate(kept, kept.rows(0, 2))
    assert rows.status.tolist() == [0, 0]
    assert rows.columns["share"][0] == 0
    assert np.isinf(rows.columns["asked"]).tolist() == [True, False]


def test_a_level_is_that_of_the_response_alone() -> None:
    plan = _study('{ quantity = "topper_field.share_complete_low", level = 0.5 }')
    rows = lw.evaluate(plan, plan.rows(1, 2))
    assert rows.columns["low"][0] == lw.topper_field(plan.machine).share_complete_low
    assert rows.columns["asked"][0] == lw.topper_field(plan.machine, level=0.5).share_complete_low
    assert rows.columns["low"][0] < rows.columns["asked"][0]


@pytest.mark.parametrize(
    ("response", "words"),
    [
        ('{ quantity = "topper_field.haulm_mean", level = 1.5 }', "level"),
        ('{ quantity = "topper.stroke", level = 0.9 }', "topper has no intervals"),
        ('{ quantity = "topper_field.haulm_mean", otherwise = nan }', "a number, or inf"),
        ('{ entry = "topper.offset", otherwise = 1.0 }', "nothing without quantity or curve"),
    ],
)
def test_what_a_response_cannot_have(response: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        _study(response)


def test_scatter_needs_finite_numbers() -> None:
    tables = {
        "variables": {"length": {"address": "topper.edge_length", "range": [0.1, 0.2]}},
        "responses": {"l": {"quantity": "topper_field.length_for_95", "otherwise": np.inf}},
    }
    with pytest.raises(InputError, match=r"responses\.l\.otherwise: found inf, expected a finite number"):
        lw.tolerance(lw.new_study(machine(SMALL), tables), 10)


def test_a_wrong_study_file_names_its_line(tmp_path: Path) -> None:
    path = tmp_path / "study.toml"
    path.write_text('machine = "topper"\n[responses]\nx = { quantity = "topper.stroke", level = 0.9 }\n')
    with pytest.raises(MachineFileError, match=r"study\.toml"):
        lw.read_study(path)
