"""A topper in the report and in the terminal: tables, page, files, machine data."""

from __future__ import annotations

import csv
import json
import re
from functools import cache
from io import StringIO
from pathlib import Path

import numpy as np
import pytest
from command_line import invoke

from linkwright import read, study
from linkwright.app.commands.check import summary
from linkwright.app.report.page import report_html
from linkwright.app.study import Study
from linkwright.kernel.page.table import Table, curves_csv
from linkwright.kernel.reader.numbers import number
from linkwright.machine import machine_parts
from linkwright.topping import edge_csv

MACHINES = Path(__file__).parents[2] / "machines"

SHORT = ("topper.edge_length=0.16 m",)
ONE_WAY = ('topper.motion={kind="constant"}',)
CASES: dict[str, tuple[str, tuple[str, ...]]] = {
    "own": ("topper", ()),
    "short": ("topper", SHORT),
    "crank": ("topper_crank", ()),
    "one way": ("topper", ONE_WAY),
    "at rest": ("topper", ("topper.knife_speed=0",)),
    "phase given": ("topper", ("topper.motion.phase=90 deg", "topper.edge_length=0.18 m")),
    "stands": ("topper", (*ONE_WAY, "topper.edge_angle=45 deg", "topper.knife_speed=1.9")),
    "retreats": ("topper", ("topper.edge_angle=60 deg", "topper.edge_length=0.15 m")),
    "barely advances": (
        "topper",
        ("topper.edge_angle=80 deg", "topper.knife_speed=5", "topper.motion.stroke=2 mm"),
    ),
    "on the row": ("topper", ("topper.offset=0", "topper.edge_angle=0")),
}

# Pages take a second each.
PAGES = ("own", "short", "crank", "one way", "stands", "barely advances")


@cache
def studied(case: str) -> Study:
    name, overrides = CASES[case]
    return study(read(MACHINES / f"{name}.toml", list(overrides)))


@cache
def page(case: str) -> str:
    return report_html(studied(case))


def shown(case: str) -> dict[str, Table]:
    return {table.name: table for table in studied(case).tables()}


def rows(table: Table) -> dict[str, tuple[str, ...]]:
    return {row[0]: row[2:] for row in table.rows}


def test_lengths_stand_side_by_side() -> None:
    found = studied("short").topper
    assert found is not None
    listed = rows(shown("short")["topper_lengths"])
    for word, value, is_met in (
        ("printed in paper 5", found.length_published, "yes"),
        ("by its condition (4)", found.length_consistent, "yes"),
        ("knife at rest", found.length_at_rest, "yes"),
        ("exact at constant speed", found.length_exact_constant_speed, "no"),
        ("exact, best phase", found.length_best_phase, "yes"),
        ("exact, every phase", found.length_exact, "no"),
    ):
        assert listed[word][:2] == (f"{number(1e3 * value, 4)} mm", is_met)


@pytest.mark.parametrize("case", CASES)
def test_tables_are_whole(case: str) -> None:
    for table in studied(case).tables():
        assert {len(row) for row in table.rows} == {len(table.heads)}
        for row in table.rows:
            assert not re.search(r"nan|inf\b|None", " ".join(row))


def test_what_is_left_is_said_with_its_place() -> None:
    found = studied("short").topper
    assert found is not None
    listed = rows(shown("short")["topper_head"])
    assert listed["maximum uncut share of a head"][0] == f"{100 * found.uncut_share:.3g} %"
    sides = {"to the right": found.uncut_right, "to the left": found.uncut_left}
    told = {side for side in sides if f"of that, {side} of the edge" in listed}
    assert told == {side for side, share in sides.items() if share > 0}
    assert rows(shown("own")["topper_head"])["maximum uncut share of a head"][0] == "nothing"


def test_mechanism_adds_its_drive() -> None:
    assert "topper_drive" not in shown("own")
    listed = rows(shown("crank")["topper_drive"])
    # 2.6 kg on a crank of 30 mm at 275 rpm with λ = 0.2: largest at the outer dead centre.
    force = 2.6 * 0.03 * (275 * np.pi / 30) ** 2 * 1.2
    assert listed["maximum inertia force of the knife"][0] == f"{number(force)} N"
    assert "reduction" in shown("crank")


def test_a_drive_without_losses_takes_no_power() -> None:
    free = study(read(MACHINES / "topper_crank.toml", ["loads={}"]))
    listed = rows({table.name: table for table in free.tables()}["topper_drive"])
    assert listed["mean power"][0] == "0 W"


def test_verdict_is_that_of_the_paper_for_these_heads() -> None:
    listed = rows(shown("own")["topper_verdict"])
    # Every phase: (60 + 97.98 + 40) mm/cos 20°, at all speeds; bands L cos 20° − 60 mm for 250 and 300 mm.
    assert listed["exact, every phase of the stroke"] == ("210.7 mm", "no", "174.9 mm to 221.9 mm")
    assert "exact, every phase of the stroke" not in rows(shown("one way")["topper_verdict"])


@pytest.mark.parametrize("case", PAGES)
def test_page_is_about_the_topper(case: str) -> None:
    text = page(case)
    figures = set(re.findall(r'id="figure-(\w+)"', text))
    moves = case not in ("one way", "stands")
    followed = case != "barely advances"
    assert {"topper_lengths", "topper_verdict"} <= figures
    assert ("topper_view" in figures) == followed
    assert ("topper_phase" in figures) == (moves and followed)
    assert ("topper_slicing" in figures) == moves
    assert ("topper_use" in figures) == (followed and case != "stands")
    assert "Paper 5" in text
    # What moves a topper alone is no driveline.
    assert ("reduced to the crank" in text) == (case == "crank")
    assert ("Paper 1" in text) == (case == "crank")
    assert ('id="scene"' in text) == (case == "crank")
    assert ('id="topper-scene"' in text) == followed


@pytest.mark.parametrize("case", PAGES)
def test_page_loads_nothing(case: str) -> None:
    text = page(case)
    assert not re.search(r"https?://|@import|url\((?!#)", text)
    assert all(target.startswith("#") for target in re.findall(r'\b(?:src|href)="([^"]*)"', text))
    names = re.findall(r'\bid="([^"]*)"', text)
    assert len(names) == len(set(names))


def test_finding_stands_on_top() -> None:
    text, (finding,) = page("short"), studied("short").findings
    assert text.index(finding) < text.index('class="headline"') < text.index('id="topper"')
    assert "16.8 %" in finding
    assert 'aria-label="Findings"' not in page("own")


def test_hatched_area_is_in_the_picture_of_a_short_edge() -> None:
    pictures = {
        case: page(case).split('id="figure-topper_view"')[1].split("</section>")[0]
        for case in ("own", "short")
    }
    assert "<pattern" in pictures["short"]
    assert "<pattern" not in pictures["own"]


def test_run_writes_the_same_page_with_a_finding(tmp_path: Path) -> None:
    arguments = ["run", str(MACHINES / "topper.toml"), "--set", *SHORT, "--out", str(tmp_path)]
    result = invoke(*arguments)
    assert result.exit_code == 1
    assert "FINDING" in result.output
    assert "exact, every phase" in result.output
    assert studied("short").findings[0] in (tmp_path / "report.html").read_text(encoding="utf-8")
    names = {path.name for path in tmp_path.glob("[!.]*")}
    assert names == {"report.html", "results.json", "topper.csv", "topper_edge.csv"}
    kept = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))["results"]["topper"]
    assert len(kept["edge_place"]) == len(kept["edge_use"])
    assert len(kept["phase"]) == len(kept["length_by_phase"]) == len(kept["uncut_by_phase"])


def test_curves_of_different_lengths_have_files_of_their_own() -> None:
    found = studied("short").topper
    assert found is not None
    phases = list(csv.reader(StringIO(curves_csv(found))))
    assert phases[0] == ["phase [rad]", "length_by_phase [m]", "uncut_by_phase [-]"]
    assert np.array(phases[1:], dtype=float)[:, 1].tolist() == found.length_by_phase.tolist()
    edge = list(csv.reader(StringIO(edge_csv(found))))
    assert edge[0] == ["edge_place [m]", "edge_use [m]"]
    use = np.array(edge[1:], dtype=float)[:, 1]
    # What is rounding beside the peak is written as zero.
    assert use == pytest.approx(found.edge_use, rel=0, abs=1e-12 * found.edge_use.max())
    assert (use[use != 0] == found.edge_use[use != 0]).all()


def test_an_edge_that_cannot_be_followed_keeps_what_is_known() -> None:
    found = studied("barely advances")
    assert found.topper is not None
    assert found.topper.obstacle in found.findings
    listed = rows(shown("barely advances")["topper_lengths"])
    assert listed["exact"] == ("–", "–", "not computed: too many strokes over a head")
    assert listed["knife at rest"][0] == f"{number(1e3 * found.topper.length_at_rest, 4)} mm"
    assert curves_csv(found.topper).splitlines()[1] == "0.0,,"


def test_frame_has_the_curves_over_the_phase() -> None:
    pytest.importorskip("pandas")
    found = studied("own").topper
    assert found is not None
    assert list(found.to_frame().columns) == ["phase", "length_by_phase", "uncut_by_phase"]


def test_check_says_head_edge_and_knife() -> None:
    lines = summary(read(MACHINES / "topper.toml")).splitlines()
    assert [line.split()[0] for line in lines] == ["machine", "head", "edge", "knife"]
    assert "97.98 mm across" in lines[1]
    assert "280 mm at 20°" in lines[2]
    assert "harmonic, stroke 60 mm, 0.55 m/s" in lines[3]
    crank = summary(read(MACHINES / "topper_crank.toml"))
    assert "moved by knife" in crank
    assert "mobility" in crank


def test_machine_data_has_the_topper_and_its_motion() -> None:
    parts = {part.name: part for part in machine_parts(read(MACHINES / "topper.toml"))}
    entries = {entry.word: entry.value for entry in parts["topper"].entries}
    assert entries["edge angle"] == "20°"
    assert entries["edge length"] == "0.28 m"
    motion = {entry.word: entry.value for entry in parts["motion"].entries}
    assert motion == {"kind": "harmonic", "stroke": "0.06 m"}
    # Limits of the best knife that nobody set are no data of the machine.
    assert set(parts) == {"topper", "motion"}


def test_field_is_among_the_data() -> None:
    spread = '{kind="normal", mean="110 mm", deviation="18 mm", min="50 mm"}'
    field = f'topper.field={{kind="random", root_diameter={spread}, spacing="0.3 m", roots=500}}'
    limits = "topper.limits.complete_min=0.9"
    machine = read(MACHINES / "topper.toml", [field, limits])
    parts = {part.name: part for part in machine_parts(machine)}
    assert list(parts) == ["topper", "motion", "field", "field: root diameter", "field: spacing", "limits"]
    entries = {entry.word: entry.value for entry in parts["field: root diameter"].entries}
    assert entries["deviation"] == "0.018 m"
    assert "500 random roots in 100 rows" in summary(machine)
