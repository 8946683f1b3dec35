"""``linkwright synthesise``: machine files that open, JSON, messages with line and key, exit codes."""

from __future__ import annotations

import json
import re
from functools import partial
from pathlib import Path

import pytest
from command_line import invoke
from tests.samples.tasks import FUNCTION, POSES

from linkwright import kinematics, read

PATH = """
x = "60, 40, 0, -30, 0, 40 mm"
y = "0, 30, 40, 10, -20, -20 mm"
generations = 30
"""
TASKS = {"motion": POSES, "function": FUNCTION, "path": PATH}


run = partial(invoke, "synthesise")


@pytest.fixture
def task(tmp_path: Path) -> Path:
    return tmp_path / "task.toml"


@pytest.mark.parametrize("what", TASKS)
def test_task_files(what: str, task: Path, tmp_path: Path) -> None:
    task.write_text(TASKS[what])
    out = tmp_path / "machine.toml"
    done = run(what, "--task", task, "--out", out, "--json", "--curves")
    assert done.exit_code == 0, done.stderr
    found = json.loads(done.stdout)
    assert set(found) == {"machine", "results", "findings", "warnings"}
    (result,) = found["results"].values()
    machine = read(out)
    assert machine.name == found["machine"]
    assert machine.mechanism.cranks["A"].radius == result["crank"]
    angles = result.get("crank_angles")
    if angles and what == "motion":
        place = kinematics(machine, angles).points["P"].position
        assert place[1] == pytest.approx([0.04, 0.02], abs=1e-12)
    again = run(what, "--task", task, "--out", out)
    assert again.exit_code == 2
    assert "--force" in again.stderr
    assert run(what, "--task", task, "--out", out, "--force").exit_code == 0


def test_dead_centre(tmp_path: Path) -> None:
    out = tmp_path / "m.toml"
    done = run("dead-centre", "--swing", "60 deg", "--time-ratio", "1.2", "--frame", "200 mm", "--out", out)
    assert done.exit_code == 0
    assert re.search(r"swing of the rocker +ψ_0 +60°", done.stdout)
    assert re.search(r"length of the frame +0\.2 m", done.stdout)
    opened = invoke("run", out, "--json")
    assert opened.exit_code == 0
    done = run("dead-centre", "--stroke", "100 mm", "--time-ratio", "1.2", "--json")
    assert json.loads(done.stdout)["results"]["slider_crank"]["stroke"] == 0.1


def test_warnings_are_printed(task: Path) -> None:
    """A poor transmission angle is reported on the terminal and in JSON."""
    wide = ("dead-centre", "--swing", "110 deg", "--time-ratio", "1.5")
    told = json.loads(run(*wide, "--json").stdout)
    assert "transmission angle falls to" in told["warnings"][0]
    assert "warnings" not in told["results"]["crank_rocker"]
    assert told["warnings"][0] in re.sub(r"\s+", " ", run(*wide).stdout)
    task.write_text(PATH)
    found = json.loads(run("path", "--task", task, "--json").stdout)["results"]["path_generator"]
    assert found["starts"] >= found["found_by"] > 0


def test_line(tmp_path: Path) -> None:
    out = tmp_path / "m.toml"
    assert run("line", "--kind", "hoeken", "--length", "200 mm", "--out", out).exit_code == 0
    assert read(out).mechanism.cranks["A"].radius == pytest.approx(0.05)
    listed = run("line", "--list")
    assert "peaucellier" in listed.stdout
    rows = json.loads(run("line", "--list", "--json").stdout)["results"]["straight_lines"]
    assert [each["kind"] for each in rows][:2] == ["hoeken", "chebyshev"]
    other = run("line", "--kind", "hoeken", "--proportion", "arm=2.6", "--json")
    assert json.loads(other.stdout)["results"]["straight_line"]["deviation"] > 0


def test_all_faults_of_a_task_with_line_and_key(task: Path) -> None:
    task.write_text('function = "log10(x)"\nrange = [1, 2, 3]\ncrank_range = "60 m"\npints = 5\n')
    done = run("function", "--task", task)
    assert done.exit_code == 2
    for text in (f"{task}:3: crank_range", f"{task}:4: pints", 'did you mean "points"', "rocker_range"):
        assert text in done.stderr
    task.write_text(FUNCTION)
    done = run("function", "--task", task, "--set", "points=4")
    assert done.exit_code == 2
    assert "--set points=4: points" in done.stderr
    assert "at least 5 points" in done.stderr


def test_findings_are_exit_code_1(task: Path) -> None:
    done = run("dead-centre", "--swing", "60 deg", "--time-ratio", "9")
    assert done.exit_code == 1
    assert "between 0.2 and 5" in done.stderr
    task.write_text(POSES.replace("20, 60 mm", "40, 60 mm").replace("0, 20, 50 deg", "0, 0, 0 deg"))
    done = run("motion", "--task", task)
    assert done.exit_code == 1
    assert "choose" in done.stderr


@pytest.mark.parametrize(
    "arguments",
    [
        ["dead-centre"],
        ["dead-centre", "--swing", "60 deg", "--stroke", "1 m"],
        ["dead-centre", "--swing", "60 mm"],
        ["dead-centre", "--swing", "190 deg"],
        ["dead-centre", "--stroke", "1 m"],
        ["line"],
        ["line", "--kind", "hoekn"],
        ["line", "--kind", "hoeken", "--proportion", "arm"],
        ["function"],
        ["path", "--task", "missing.toml"],
    ],
)
def test_wrong_input_is_exit_code_2(arguments: list[str]) -> None:
    done = run(*arguments)
    assert done.exit_code == 2
    assert "Traceback" not in done.output


def test_units_of_the_reader(task: Path) -> None:
    """Lengths and angles in wanted units; errors that are rounding are zero."""
    task.write_text(POSES)
    found = json.loads(run("motion", task, "--json").stdout)["results"]["pose_guide"]
    text = run("motion", task, "--units", "mm").stdout
    assert f"{1e3 * found['frame']:.6g} mm" in text
    assert re.search(r"position error of the body.s origin +0 mm", text)
    assert re.search(r"deviation of the body's rotation +0°", text)
    assert "244 um" in run("line", "--list", "--length", "0.2 m", "--units", "µm").stdout


def test_a_missing_task_is_no_machine_file() -> None:
    done = run("path", "missing.toml")
    assert done.exit_code == 2
    assert "expected: a task file" in done.stderr
