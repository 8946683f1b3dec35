"""A sweep is complete and the same, whatever stops it on the way."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from command_line import invoke
from matplotlib.text import Text

import linkwright as lw
from linkwright import InputError
from linkwright.kernel.files.points import place_of
from linkwright.studies import StudyRows, columns_of, opened, shown_of
from linkwright.studies.choices import choice_names
from linkwright.studies.engine import numbers, sound_variant
from linkwright.studies.figures import figures
from linkwright.studies.folder import MANIFEST, plan_of
from linkwright.studies.parquet import one_by_one
from linkwright.studies.plan import plan as plan_with
from linkwright.studies.rows import LAYOUT

Files = Callable[..., Path]

# In make test a few kills; tests/fuzz/deep.py does more.
KILLS = int(os.environ.get("LINKWRIGHT_KILLS", "3"))


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in sorted(folder.glob("*.parquet"))}


def test_rows_are_those_of_single_machines(study_file: Files, tmp_path: Path) -> None:
    plan = lw.read_study(study_file())
    found = lw.sweep(plan, tmp_path / "rows")
    assert found.is_complete
    table = pd.read_parquet(tmp_path / "rows")
    assert list(table["row"]) == list(range(15))
    assert (table["half"] == table["mass"] / 2).all()
    for row in (0, 7, 14):
        entries = {
            "mechanism.cranks.A2.phase": table["phase"][row],
            "bodies.cart1.mass": table["mass"][row],
            "bodies.cart2.mass": table["mass"][row],
        }
        delta, dynamism = numbers(sound_variant(plan.machine, entries), list(plan.asked))
        # What lanes promise of speeds and of peaks of acceleration.
        assert table["delta"][row] == pytest.approx(delta, rel=1e-6)
        assert table["H"][row] == pytest.approx(dynamism, rel=1e-5)
        assert table["k_p"][row] == pytest.approx(delta**2 + dynamism, rel=1e-5)
    low = found.extremes["delta"]
    assert table["delta"][low["min_row"]] == low["min"] == table["delta"].min()


def test_a_row_does_not_depend_on_how_rows_are_divided(study_file: Files, tmp_path: Path) -> None:
    whole = lw.evaluate(lw.read_study(study_file()), (plan := lw.read_study(study_file())).rows(0, 15))
    parts = [lw.evaluate(plan, plan.rows(a, b)) for a, b in ((0, 1), (1, 9), (9, 15))]
    for name in plan.responses:
        together = np.concatenate([each.columns[name] for each in parts])
        # Lanes are filled differently; the promise of each is kept.
        np.testing.assert_allclose(together, whole.columns[name], rtol=1e-6)


def test_rows_that_fail_keep_their_reason(study_file: Files, tmp_path: Path) -> None:
    change = (
        'range = ["900 kg", "1100 kg"]\nsteps = 3',
        'values = ["0.15 m", "0.8 m", "-1 m"]',
    )
    other = ('["bodies.cart1.mass", "bodies.cart2.mass"]', '"mechanism.sliders.cart1.rod"')
    plan = lw.read_study(study_file(change, other))
    found = lw.sweep(plan, tmp_path / "rows")
    table = pd.read_parquet(tmp_path / "rows")
    assert found.n_failed == 10
    assert list(table["status"]) == [1, 0, 2] * 5
    assert table["delta"].isna().tolist() == [True, False, True] * 5
    assert table["reason"].isna().tolist() == [False, True, False] * 5
    assert "rod" in table["reason"][2]
    assert sum(found.reasons.values()) == 10


def test_a_choice_without_numbers(study_file: Files, tmp_path: Path) -> None:
    change = (
        'address = "mechanism.cranks.A2.phase"\nrange = ["45 deg", "135 deg"]\nsteps = 5',
        'address = "drive.gearbox.reverse"\nvalues = ["same", 1.25]',
    )
    plan = lw.read_study(study_file(change))
    lw.sweep(plan, tmp_path / "rows")
    table = pd.read_parquet(tmp_path / "rows")
    assert len(table) == 6
    assert (table["status"] == 0).all()
    same, other = (table["delta"][table["phase"] == place].to_numpy() for place in (0, 1))
    assert (same != other).all()


@pytest.mark.parametrize("place", [-1, 2, 0.5])
def test_a_place_that_a_list_does_not_have_is_refused(
    place: float, study_file: Files, tmp_path: Path
) -> None:
    """Python would count -1 from the end."""
    change = (
        'address = "mechanism.cranks.A2.phase"\nrange = ["45 deg", "135 deg"]\nsteps = 5',
        'address = "drive.gearbox.reverse"\nvalues = ["same", 1.25]',
    )
    plan = lw.read_study(study_file(change))
    with pytest.raises(InputError, match="a place in its values, 0 to 1"):
        lw.evaluate(plan, {"phase": np.array([0.0, place]), "mass": np.array([1e3, 1e3])})
    (tmp_path / "rows.csv").write_text(f"phase, mass\n0, 1000\n{place}, 1000\n")
    with pytest.raises(InputError, match=r"rows\.csv:3: column phase"):
        lw.read_study(study_file(change, ("chunk = 4", 'method = "list"\nfile = "rows.csv"')))


def test_values_of_a_list_outside_the_range_are_refused(study_file: Files, tmp_path: Path) -> None:
    """80 of a head without a unit are radians."""
    listed = ("chunk = 4", 'method = "list"\nfile = "rows.csv"')
    (tmp_path / "rows.csv").write_text("phase [deg],mass\n80,1000\n")
    assert lw.read_study(study_file(listed)).n_rows == 1
    (tmp_path / "rows.csv").write_text("phase,mass\n1,1000\n80,1000\n")
    with pytest.raises(InputError, match=r"rows\.csv: column phase, row 1: found 80 rad, expected 0\.785"):
        lw.read_study(study_file(listed))


def test_a_list_names_texts_among_values(study_file: Files, tmp_path: Path) -> None:
    change = (
        'address = "mechanism.cranks.A2.phase"\nrange = ["45 deg", "135 deg"]\nsteps = 5',
        'address = "mechanism.sliders.cart1.assembly"\nvalues = ["positive", "negative"]',
    )
    listed = ("chunk = 4", 'method = "list"\nfile = "rows.csv"')
    (tmp_path / "rows.csv").write_text(
        "phase,mass [t],note\nnegative,1,as built\n0,1.1,\npositive,1.1,heavier\n"
    )
    plan = lw.read_study(study_file(change, listed))
    assert plan.rows(0, 3)["phase"].tolist() == [1.0, 0.0, 0.0]
    assert plan.rows(0, 3)["mass"].tolist() == [1000.0, 1100.0, 1100.0]
    counts = (change[0], 'address = "drive.gearbox.ratio"\nvalues = [9, 10]')
    (tmp_path / "rows.csv").write_text("phase,mass\n10,1000\n")
    assert lw.read_study(study_file(counts, listed)).rows(0, 1)["phase"].tolist() == [10.0]
    (tmp_path / "rows.csv").write_text("phase,mass\npositiv,1000\n")
    with pytest.raises(InputError, match=r"rows\.csv:2: column phase") as caught:
        lw.read_study(study_file(change, listed))
    assert 'one of "positive", "negative", or its place among them, 0 to 1' in str(caught.value)


def test_a_list_names_tables_among_values(study_file: Files, tmp_path: Path) -> None:
    """By the text in which they differ; a message has no table as Python prints it."""
    motors = [f'{{ kind = "induction", catalogue = "{name}" }}' for name in ("4A132M6U3", "4A160M6U3")]
    change = (
        'address = "mechanism.cranks.A2.phase"\nrange = ["45 deg", "135 deg"]\nsteps = 5',
        f'address = "drive.motor"\nvalues = [{", ".join(motors)}]',
    )
    for kind in ("csv", "parquet"):
        path = study_file(change, ("chunk = 4", f'method = "list"\nfile = "rows.{kind}"'))
        for cells, row in ((["4A160M6U3", "0"], 1.0), (["4A132M6U3", "none"], None), (["2", "0"], None)):
            table = pd.DataFrame({"phase": cells, "mass": [1000.0, 1000.0]})
            if kind == "csv":
                table.to_csv(tmp_path / "rows.csv", index=False)
            else:
                table.to_parquet(tmp_path / "rows.parquet")
            if row is not None:
                assert lw.read_study(path).rows(0, 2)["phase"].tolist() == [row, 0.0]
                continue
            with pytest.raises(InputError, match="column phase") as caught:
                lw.read_study(path)
            assert f"rows.{kind}" in str(caught.value)
            assert '"4A132M6U3", "4A160M6U3", or its place among them, 0 to 1' in str(caught.value)
            assert "kind" not in str(caught.value)


def test_a_damaged_file_is_computed_anew(study_file: Files, tmp_path: Path) -> None:
    """Numbers that a disk has changed, in a file that is as long as before."""
    plan = lw.read_study(study_file())
    lw.sweep(plan, tmp_path / "rows")
    wanted = pd.read_parquet(tmp_path / "rows")
    part = tmp_path / "rows" / "part-000001.parquet"
    sound = part.read_bytes()
    for at in range(4, len(sound), 97):
        part.write_bytes(sound[:at] + bytes([sound[at] ^ 255]) + sound[at + 1 :])
        lw.sweep(plan, tmp_path / "rows")
        pd.testing.assert_frame_equal(pd.read_parquet(tmp_path / "rows"), wanted, check_exact=True)


def test_a_file_of_other_rows_is_computed_anew(study_file: Files, tmp_path: Path) -> None:
    lw.sweep(lw.read_study(study_file()), tmp_path / "rows")
    wanted = pd.read_parquet(tmp_path / "rows")
    parts = sorted((tmp_path / "rows").glob("part-*.parquet"))
    parts[1].write_bytes(parts[0].read_bytes())
    lw.sweep(lw.read_study(study_file()), tmp_path / "rows")
    pd.testing.assert_frame_equal(pd.read_parquet(tmp_path / "rows"), wanted, check_exact=True)


def test_a_file_with_a_damaged_footer_is_read_or_computed_anew(study_file: Files, tmp_path: Path) -> None:
    """Checksums are of pages: names of columns and counts stand in none."""
    lw.sweep(lw.read_study(study_file()), tmp_path / "rows")
    folder = opened(tmp_path / "rows")
    part = folder.part(1)
    sound, wanted = part.read_bytes(), columns_of(part)
    footer = len(sound) - 8 - int.from_bytes(sound[-8:-4], "little")
    for at in range(footer, len(sound), 5):
        part.write_bytes(sound[:at] + bytes([sound[at] ^ 0x15]) + sound[at + 1 :])
        if folder.is_done(1):
            one_by_one(part)
            for name, column in columns_of(part, list(wanted)).items():
                np.testing.assert_array_equal(column, wanted[name])


def test_units_and_machine_are_in_the_metadata(study_file: Files, tmp_path: Path) -> None:
    import json

    import pyarrow.parquet as pq

    lw.sweep(lw.read_study(study_file()), tmp_path / "rows")
    schema = pq.read_schema(tmp_path / "rows" / "part-000000.parquet")
    assert schema.field("mass").metadata == {b"unit": b"kg"}
    about = json.loads(schema.metadata[b"linkwright"])
    assert lw.loads(about["machine"]).name.startswith("Roller")


def test_a_share_and_the_rest(study_file: Files, tmp_path: Path) -> None:
    plan = lw.read_study(study_file())
    lw.sweep(plan, tmp_path / "whole")
    assert lw.sweep(plan, tmp_path / "rows", chunks=(1, 3)).n_done == 8
    # A folder may be completed by others meanwhile; what is there is not computed again.
    kept = (tmp_path / "rows" / "part-000001.parquet").stat().st_mtime_ns
    assert lw.sweep(plan, tmp_path / "rows").is_complete
    assert (tmp_path / "rows" / "part-000001.parquet").stat().st_mtime_ns == kept
    assert contents(tmp_path / "rows") == contents(tmp_path / "whole")
    with pytest.raises(InputError, match="chunks 9:12"):
        lw.sweep(plan, tmp_path / "rows", chunks=(9, 12))


def test_a_file_that_is_cut_off_is_computed_anew(study_file: Files, tmp_path: Path) -> None:
    plan = lw.read_study(study_file())
    lw.sweep(plan, tmp_path / "rows")
    wanted = contents(tmp_path / "rows")
    part = tmp_path / "rows" / "part-000002.parquet"
    part.write_bytes(part.read_bytes()[:-100])
    told = invoke("sweep", "show", tmp_path / "rows")
    assert "part-000002.parquet is truncated" in told.stdout
    found = lw.sweep(plan, tmp_path / "rows")
    assert found.repaired == ("part-000002.parquet",)
    assert contents(tmp_path / "rows") == wanted


def test_the_folder_of_another_study_is_left_alone(study_file: Files, tmp_path: Path) -> None:
    lw.sweep(lw.read_study(study_file()), tmp_path / "rows")
    before = contents(tmp_path / "rows")
    for change, word in (
        ("study.variables.phase.steps=6", "the study"),
        ("drive.gearbox.ratio=9", "the mach"),
    ):
        with pytest.raises(InputError, match=word):
            lw.sweep(lw.read_study(study_file(), [change]), tmp_path / "rows")
    assert contents(tmp_path / "rows") == before
    (tmp_path / "letters").mkdir()
    (tmp_path / "letters" / "to_mother.txt").write_text("Dear")
    with pytest.raises(InputError, match="other files"):
        lw.sweep(lw.read_study(study_file()), tmp_path / "letters")


def test_files_of_another_layout_are_not_read(study_file: Files, tmp_path: Path) -> None:
    """Columns that are not there ended in an error of the library that reads them."""
    plan = lw.read_study(study_file())
    lw.sweep(plan, tmp_path / "rows")
    place = tmp_path / "rows" / MANIFEST
    place.write_text(place.read_text().replace(f'"layout": {LAYOUT}', '"layout": 1'))
    before = contents(tmp_path / "rows")
    for read in (lambda: lw.sweep(plan, tmp_path / "rows"), lambda: opened(tmp_path / "rows")):
        with pytest.raises(InputError, match="another version of Linkwright"):
            read()
    assert contents(tmp_path / "rows") == before


def test_the_order_of_variables_makes_another_grid(study_file: Files, tmp_path: Path) -> None:
    plan = lw.read_study(study_file())
    lw.sweep(plan, tmp_path / "rows")
    assert plan_of(opened(tmp_path / "rows").manifest).axes == plan.axes
    turned = plan.study.model_copy(update={"variables": dict(reversed(plan.study.variables.items()))})
    with pytest.raises(InputError, match="the study differs"):
        lw.sweep(plan_with(plan.machine, turned), tmp_path / "rows")


def test_a_study_without_sense_writes_nothing(study_file: Files, tmp_path: Path) -> None:
    change = ('"steady_state.dynamism"', '"pumping_unit.stroke"')
    plan = lw.read_study(study_file(change))
    with pytest.raises(InputError, match="pumping_unit"):
        lw.sweep(plan, tmp_path / "rows")
    assert not (tmp_path / "rows").exists()


def run(study: Path, out: Path, **options: object) -> subprocess.Popen[str]:
    command = [sys.executable, "-m", "linkwright", "sweep", str(study), "--out", str(out)]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    return subprocess.Popen(command, text=True, **pipes, **options)  # type: ignore[call-overload, no-any-return]


needs_signals = pytest.mark.skipif(os.name == "nt", reason="needs signals and limits of Unix")


@needs_signals
def test_killed_at_any_moment(study_file: Files, tmp_path: Path) -> None:
    """kill -9, then again: complete, no row twice, the same bytes as uninterrupted."""
    study = study_file(("steps = 5", "steps = 120"), ("chunk = 4", "chunk = 3"))
    lw.sweep(lw.read_study(study), tmp_path / "whole")
    chance, interrupted = np.random.default_rng(5), 0
    while interrupted < KILLS:
        process = run(study, tmp_path / "rows")
        # Begun, and then for as long as a few files take.
        begun = len(list((tmp_path / "rows").glob("part-*")))
        while len(list((tmp_path / "rows").glob("part-*"))) <= begun and process.poll() is None:
            time.sleep(0.002)
        time.sleep(chance.uniform(0, 0.02))
        process.send_signal(signal.SIGKILL)
        process.communicate()
        interrupted += process.returncode == -signal.SIGKILL
        if process.returncode == 0:
            # Complete before the signal came: the next ones interrupt a new folder.
            assert contents(tmp_path / "rows") == contents(tmp_path / "whole")
            shutil.rmtree(tmp_path / "rows")
    assert lw.sweep(lw.read_study(study), tmp_path / "rows").is_complete
    assert contents(tmp_path / "rows") == contents(tmp_path / "whole")
    assert list(pd.read_parquet(tmp_path / "rows")["row"]) == list(range(360))
    assert {path.suffix for path in (tmp_path / "rows").iterdir()} == {".parquet", ".json"}


@needs_signals
def test_a_second_run_into_one_folder_is_refused_until_the_first_has_gone(
    study_file: Files, tmp_path: Path
) -> None:
    """Of two processes for the same rows the second ends with exit 2; a claim dies with its process."""
    study, rows = study_file(("steps = 5", "steps = 120"), ("chunk = 4", "chunk = 3")), tmp_path / "rows"
    first = run(study, rows)
    while not list(rows.glob("part-*")) and first.poll() is None:
        time.sleep(0.002)
    first.send_signal(signal.SIGSTOP)
    second = run(study, rows)
    _, told = second.communicate(timeout=120)
    assert second.returncode == 2
    assert "another process computes rows" in told
    assert "Traceback" not in told
    first.send_signal(signal.SIGKILL)
    first.communicate()
    assert lw.sweep(lw.read_study(study), rows).is_complete
    assert {path.suffix for path in rows.iterdir()} == {".parquet", ".json"}


@needs_signals
def test_of_two_studies_that_race_for_a_folder_one_is_refused(study_file: Files, tmp_path: Path) -> None:
    """Two studies that begin at once in a new folder: one has it, the other ends with exit 2."""
    study = study_file()
    other = study.with_name("other.toml")
    other.write_text(study.read_text().replace("steps = 5", "steps = 7"))
    for n in range(2):
        both = [run(one, tmp_path / f"rows{n}") for one in (study, other)]
        told = [process.communicate(timeout=120)[1] for process in both]
        assert sorted(process.returncode for process in both) == [0, 2], told
        assert "found the results of another sweep" in "".join(told)


def test_a_damaged_description_loses_no_row(study_file: Files, tmp_path: Path) -> None:
    """The same study writes it anew; another one leaves the folder as it is."""
    plan, rows = lw.read_study(study_file()), tmp_path / "rows"
    lw.sweep(plan, rows)
    whole = contents(rows)
    part = {key: json.loads((rows / "_study.json").read_text())[key] for key in ("rows", "hash", "layout")}
    (rows / "_study.json").write_text(json.dumps(part), encoding="utf-8")
    with pytest.raises(InputError, match="writes it anew"):
        opened(rows)
    (rows / "_study.json").write_text("{", encoding="utf-8")
    with pytest.raises(InputError, match="writes it anew"):
        opened(rows)
    other = lw.read_study(study_file(("1100 kg", "1200 kg"), name="other.toml"))
    with pytest.raises(InputError, match="rows of another study"):
        lw.sweep(other, rows)
    written = {name: (rows / name).stat().st_mtime_ns for name in whole if name != "_study.json"}
    assert lw.sweep(plan, rows).is_complete
    assert contents(rows) == whole
    assert written == {name: (rows / name).stat().st_mtime_ns for name in written}


@needs_signals
def test_a_full_disk(study_file: Files, tmp_path: Path) -> None:
    """The limit on a file's size stands for a disk without room: a write fails in its middle."""
    import resource

    study = study_file()
    # The description fits, a file of rows does not.
    limits = {"preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (6000, 6000))}
    process = run(study, tmp_path / "rows", **limits)
    _, told = process.communicate()
    assert process.returncode == 2
    assert "the disk is full" in told
    assert "resumes" in told
    assert not list((tmp_path / "rows").glob("*part*"))
    assert lw.sweep(lw.read_study(study), tmp_path / "rows").is_complete


@needs_signals
def test_processes_that_are_lost_are_replaced(study_file: Files, tmp_path: Path) -> None:
    """The folder is that of one process, though one of two is killed as soon as a file is there."""
    import multiprocessing

    plan = lw.read_study(study_file(("chunk = 4", "chunk = 1")))
    lw.sweep(plan, tmp_path / "alone")
    killed: list[int] = []

    def watch(done: int, total: int, rate: float) -> None:
        if not killed:
            child = multiprocessing.active_children()[0]
            assert child.pid is not None
            killed.append(child.pid)
            os.kill(child.pid, signal.SIGKILL)

    found = lw.sweep(plan, tmp_path / "beside", workers=2, watch=watch)
    assert killed
    assert found.is_complete
    assert contents(tmp_path / "beside") == contents(tmp_path / "alone")
    with pytest.raises(InputError, match="workers"):
        lw.sweep(plan, tmp_path / "none", workers=0)


@needs_signals
# What the cluster itself warns of as it ends.
@pytest.mark.filterwarnings("ignore")
def test_a_cluster_with_a_worker_killed(
    study_file: Files, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its folder is that of one process; what cannot be reached is reported."""
    import distributed

    plan = lw.read_study(study_file(("chunk = 4", "chunk = 1")))
    lw.sweep(plan, tmp_path / "alone")
    options = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None, "silence_logs": 50}
    with distributed.LocalCluster(processes=True, **options) as cluster:
        with distributed.Client(cluster) as client:
            victim = next(iter(client.run(os.getpid).values()))
        killed: list[int] = []

        def watch(done: int, total: int, rate: float) -> None:
            if not killed:
                os.kill(victim, signal.SIGKILL)
                killed.append(victim)

        found = lw.sweep(plan, tmp_path / "rows", cluster=cluster.scheduler_address, watch=watch)
    assert killed
    assert found.is_complete
    assert contents(tmp_path / "rows") == contents(tmp_path / "alone")
    monkeypatch.setattr("linkwright.studies.workers._PATIENCE", 0.5)
    with pytest.raises(InputError, match="found no scheduler"):
        lw.sweep(plan, tmp_path / "other", cluster="nowhere:1")


def test_rows_that_lack_a_response_are_drawn_without_lines() -> None:
    """A line goes through all columns: without a row that has them all there is no picture of lines."""
    full, gaps = np.arange(3.0), np.array([np.nan, 1.0, np.nan])
    columns = {"a": full, "b": full, "first": gaps, "second": np.array([2.0, np.nan, np.nan])}
    names = {name: name for name in columns}
    shown = StudyRows(columns, names, ("a", "b"), ("first", "second"), is_grid=False)
    assert set(figures(shown)) == {"scatter"}
    columns["second"] = full
    assert set(figures(shown)) == {"scatter", "parallel"}


def _texts(figure: Any) -> list[str]:
    figure.canvas.draw()
    return [text.get_text() for text in figure.findobj(Text) if text.get_visible() and text.get_text()]


@pytest.mark.parametrize("variables", [("motor",), ("motor", "a"), ("a", "motor"), ("a", "motor", "b")])
def test_figures_name_the_values_of_a_choice(variables: tuple[str, ...]) -> None:
    """They showed the places 0 and 1."""
    motors = ("small", "large one")
    grid = np.meshgrid(*(np.arange(2.0) for _ in variables), indexing="ij")
    columns = {
        name: table.ravel() - (0 if name == "motor" else 5)
        for name, table in zip(variables, grid, strict=True)
    }
    columns["lowest"] = -np.arange(1.0, 1 + 2 ** len(variables))
    labels = {name: name if name == "motor" else f"{name} [m]" for name in columns}
    shown = StudyRows(columns, labels, variables, ("lowest",), is_grid=True, choices={"motor": motors})
    drawn = figures(shown)
    assert len(drawn) == (2 if len(variables) == 3 else 1)
    for figure in drawn.values():
        texts = _texts(figure)
        assert set(motors) <= set(texts)
        # The hyphen of a keyboard is no minus.
        assert not [text for text in texts if "-" in text]
    if len(variables) == 3:
        assert {"−8", "−1", "−5", "−4"} <= set(_texts(drawn["parallel"]))
    if variables == ("motor", "a"):
        assert "minimum −4" in _texts(drawn["map_lowest"])


def test_contours_of_a_map_have_a_minus() -> None:
    x, y = (table.ravel() for table in np.meshgrid(np.arange(5.0), np.arange(5.0), indexing="ij"))
    columns = {"x": x, "y": y, "low": -100 - x * y}
    figure = figures(StudyRows(columns, {name: name for name in columns}, ("x", "y"), ("low",), is_grid=True))
    texts = _texts(figure["map_low"])
    assert any(text.startswith("−1") for text in texts)
    assert not [text for text in texts if "-" in text]


def test_what_is_shown_of_a_choice_has_its_names(study_file: Files, tmp_path: Path) -> None:
    change = (
        'address = "mechanism.cranks.A2.phase"\nrange = ["45 deg", "135 deg"]\nsteps = 5',
        'address = "drive.gearbox.reverse"\nvalues = ["same", 1.25]',
    )
    lw.sweep(lw.read_study(study_file(change)), tmp_path / "rows")
    shown = shown_of(opened(tmp_path / "rows"))
    assert shown.choices == {"phase": ("same", "1.25")}
    assert shown.labels["phase"] == "phase"


@pytest.mark.parametrize(
    ("values", "names"),
    [
        (["a", 2.5, True], ("a", "2.5", "true")),
        ([{"kind": "dc", "n": 1}, {"kind": "table"}], ("dc", "table")),
        ([{"kind": "ac", "of": "x"}, {"kind": "ac", "of": "y"}, {"kind": "dc"}], ("x", "y", "dc")),
        ([{"kind": "dc", "n": 1}, {"kind": "dc", "n": 2}], ("kind = dc, n = 1", "kind = dc, n = 2")),
        ([{"kind": "dc"}, "none"], ("kind = dc", "none")),
        ([["1 m", "2 m"], []], ("[1 m, 2 m]", "[]")),
    ],
)
def test_names_of_choices(values: list[Any], names: tuple[str, ...]) -> None:
    assert choice_names(values) == names


@pytest.mark.parametrize(
    ("cell", "place"),
    [
        ("same", 0),
        ("1.25", 1),
        ("1.250", 1),
        ("1", 2),
        ("1.0", 2),
        ("0", 0),
        ("2", 2),
        ("3", None),
        ("x", None),
    ],
)
def test_numbers_among_choices_are_no_places(cell: str, place: float | None) -> None:
    """However they are written: 1.0 was the second value, not the number 1."""
    assert place_of(cell, choice_names(["same", 1.25, 1])) == place


def test_a_variable_of_one_value_makes_no_map_and_a_constant_no_colour() -> None:
    columns = {
        "x": np.array([0.0, 1.0, 2.0]),
        "y": np.ones(3),
        "low": np.array([1.0, 0.5, 2.0]),
        "same": np.zeros(3),
    }
    labels = {name: name for name in columns}
    assert set(figures(StudyRows(columns, labels, ("x", "y"), ("low",), is_grid=True))) == {"curve"}
    drawn = figures(StudyRows(columns, labels, ("x", "y"), ("low", "same"), is_grid=False))
    assert "low" in drawn["parallel"].axes[0].get_title()
    constant = {**columns, "x": np.ones(3), "low": np.ones(3)}
    plain = figures(StudyRows(constant, labels, ("x", "y"), ("low", "same"), is_grid=False))
    assert not plain["parallel"].axes[0].get_title()
