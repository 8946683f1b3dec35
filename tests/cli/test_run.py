"""`linkwright run`: exit codes, names in the JSON, what goes where, what it says of impossible machines."""

from __future__ import annotations

import json
import subprocess
import sys
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from command_line import invoke

from linkwright import read, steady_state
from linkwright.kernel.files.library import template, templates

ROOT = Path(__file__).parents[2]
TWO_CARTS = ROOT / "machines" / "roller_two_carts.toml"

NAMES = {
    "reduction": {"inertia_min", "inertia_max", "torque_load_mean"},
    "constant_energy": {"unevenness", "dynamism"},
    "steady_state": {
        *("speed_min", "speed_max", "speed_mean_extremes", "speed_mean_time"),
        *("acceleration_min", "acceleration_max", "unevenness", "dynamism", "motion_coefficient"),
    },
    "run_up": {"turns", "time"},
}


run = partial(invoke, "run")


def results(*arguments: str | Path) -> dict[str, Any]:
    """What ``--json`` gives, parsed strictly: NaN and infinity are no JSON."""
    done = run(*arguments, "--json")
    assert done.exception is None or isinstance(done.exception, SystemExit)
    return json.loads(done.stdout, parse_constant=pytest.fail)  # type: ignore[no-any-return]


def test_json_has_the_promised_names() -> None:
    found = results(TWO_CARTS)
    assert found["machine"] == read(TWO_CARTS).name
    for analysis, names in NAMES.items():
        assert names <= set(found["results"][analysis])
    every = [name for analysis in found["results"].values() for name in analysis]
    assert not [name for name in every if name.startswith("_")]
    assert found["findings"] == []
    assert all(isinstance(text, str) for text in found["warnings"])


def test_json_holds_what_the_analysis_gives() -> None:
    steady = steady_state(read(TWO_CARTS), accuracy=1e-12)
    found = results(TWO_CARTS, "--accuracy", "1e-12")["results"]["steady_state"]
    assert found["unevenness"] == pytest.approx(steady.unevenness, rel=1e-12)
    assert found["period"] == pytest.approx(steady.period, rel=1e-12)


def test_curves_only_when_asked_for() -> None:
    assert "speed" not in results(TWO_CARTS)["results"]["steady_state"]
    found = results(TWO_CARTS, "--curves")["results"]
    assert len(found["steady_state"]["speed"]) == len(found["steady_state"]["crank_angle"]) > 300
    assert len(found["run_up"]["speed"]) > 10


@pytest.mark.parametrize("name", templates())
def test_templates_run(name: str, tmp_path: Path) -> None:
    path = tmp_path / "machine.toml"
    path.write_text(template(name), encoding="utf-8")
    machine = read(path)
    if machine.train is not None:
        done = invoke("torsion", path, "--json")
        assert done.exit_code == 0
        assert {"scheme", "campbell", "peaks"} <= set(json.loads(done.stdout)["results"])
        return
    assert run(path).exit_code == 0
    alone = {"topper": machine.is_topper_alone, "turning_moment": machine.is_diagram_alone}
    wanted = {table for table, is_alone in alone.items() if is_alone} or set(NAMES)
    assert wanted <= set(results(path)["results"])


def test_set_changes_the_answer() -> None:
    heavy = results(TWO_CARTS, "--set", "drive.flywheel.inertia=500")["results"]
    usual = results(TWO_CARTS)["results"]
    assert heavy["reduction"]["inertia_min"] == pytest.approx(usual["reduction"]["inertia_min"] + 500)
    assert heavy["steady_state"]["unevenness"] < usual["steady_state"]["unevenness"]


def test_standard_output_holds_json_and_nothing_else(tmp_path: Path) -> None:
    command = [
        sys.executable,
        "-m",
        "linkwright",
        "run",
        str(TWO_CARTS),
        "--json",
        "--out",
        str(tmp_path),
    ]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert done.stdout.count("\n") == 1
    assert json.loads(done.stdout)["machine"]
    assert "report.html" in done.stderr


def test_json_needs_no_drawing() -> None:
    code = (
        "import sys\n"
        "from linkwright.app import application\n"
        f"application()(['run', {str(TWO_CARTS)!r}, '--json'], standalone_mode=False)\n"
        "heavy = {'matplotlib', 'jinja2', 'rich', 'pandas', 'pint', 'scipy', 'tomlkit'}\n"
        "print(sorted(heavy & set(sys.modules)), file=sys.stderr)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stderr.strip() == "[]"


def test_tables_have_symbols_and_units() -> None:
    done = run(TWO_CARTS)
    assert done.exit_code == 0
    words = ("Steady motion", "ω_min", "9.919 rad/s", "0.08496", "0.1602", "1.399 s", "10470 W", "WARNING")
    for word in words:
        assert word in done.stdout
    assert "FINDING" not in done.stdout


def test_step_method_stands_beside_the_exact_solution() -> None:
    found = results(TWO_CARTS, "--method", "baranov", "--step", "0.5 deg")["results"]
    assert found["step_method"]["unevenness"] == pytest.approx(found["steady_state"]["unevenness"], rel=0.02)
    assert found["step_method"]["unevenness"] != found["steady_state"]["unevenness"]
    assert "step_method" not in results(TWO_CARTS)["results"]


def test_run_down_needs_a_brake() -> None:
    assert "run_down" not in results(TWO_CARTS)["results"]
    assert results(TWO_CARTS, "--set", "drive.brake.torque=200")["results"]["run_down"]["time"] > 0


def test_files_are_written(tmp_path: Path) -> None:
    folder = tmp_path / "new" / "folder"
    done = run(TWO_CARTS, "--out", folder)
    assert done.exit_code == 0
    curves = {
        f"{name}.csv" for name in ("linkage", "motion", "steady_state", "reduction", "run_up", "forces")
    }
    names = {"results.json", "report.html", *curves}
    assert {path.name for path in folder.glob("[!.]*")} == names
    assert all(str(folder / name) in done.stdout for name in names)
    written = json.loads((folder / "results.json").read_text(encoding="utf-8"))
    assert "speed" in written["results"]["steady_state"]
    head = (folder / "steady_state.csv").read_text(encoding="utf-8").split("\n", 1)[0]
    assert "speed [rad/s]" in head.split(",")


def test_out_refuses_a_file(tmp_path: Path) -> None:
    path = tmp_path / "taken"
    path.write_text("mine")
    for out in (path, path / "below"):
        done = run(TWO_CARTS, "--out", out)
        assert done.exit_code == 2
        assert "expected a folder" in done.stderr
    assert path.read_text() == "mine"


# -- machines that cannot do it: exit code 1, and what can be computed -------------------------------------


def test_motor_that_cannot_start() -> None:
    done = run(TWO_CARTS, "--set", "drive.motor.torque_start=40 N m")
    assert done.exit_code == 1
    assert "FINDING" in done.stdout
    found = results(TWO_CARTS, "--set", "drive.motor.torque_start=40 N m")
    assert found["findings"][0].startswith("Does not start: at 0.0° the motor gives 353 N m")
    assert found["warnings"][0] == found["findings"][0]
    assert "steady_state" in found["results"]
    assert "run_up" not in found["results"]


def test_no_steady_motion() -> None:
    found = results(TWO_CARTS, "--set", "drive.gearbox.ratio=3")
    assert found["findings"][0].startswith("No steady motion: at best")
    assert found["findings"][1].startswith("Does not start")
    assert set(found["results"]) == {"linkage", "motion", "reduction", "constant_energy"}


def test_rod_shorter_than_crank(tmp_path: Path) -> None:
    done = run(TWO_CARTS, "--set", "mechanism.sliders.cart1.rod=0.1", "--out", tmp_path)
    assert done.exit_code == 1
    found = results(TWO_CARTS, "--set", "mechanism.sliders.cart1.rod=0.1")
    assert "the rod of cart1 (0.1 m) does not reach its guide" in found["findings"][0]
    # What the linkage does within its limits is known all the same.
    assert set(found["results"]) == {"linkage", "motion"}
    assert not found["results"]["linkage"]["turns_fully"]
    written = {"results.json", "report.html", "linkage.csv", "motion.csv"}
    assert {path.name for path in tmp_path.glob("[!.]*")} == written


def test_a_machine_without_a_motor_is_no_failure() -> None:
    done = run(TWO_CARTS, "--set", "drive={}")
    assert done.exit_code == 0
    assert "no motor" in done.stdout


# -- input that is wrong: exit code 2, nothing on standard output ------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--set", "bodies.cart1.mass=-3"], ["bodies.cart1.mass", "a mass of 0 or more"]),
        (["--set", "drive.speed=3 m"], ["drive.speed", '"m" is a unit of length']),
        (["--set", "drive.sped=3"], ["an unknown key", 'did you mean "speed"?']),
        (
            ["--set", 'drive.motor={kind="dc", catalogue="4A160S6U3"}'],
            ["types of the catalogue are induction motors"],
        ),
        (["--accuracy", "1"], ["accuracy 1", "1e-13 to 1e-2"]),
        (["--method", "baranov", "--step", "7 deg"], ["does not divide the revolution"]),
        (["--method", "baranov", "--step", "7 kg"], ["an angle"]),
        (["--method", "euler"], ["euler"]),
    ],
)
def test_wrong_input(arguments: list[str], words: list[str], tmp_path: Path) -> None:
    done = run(TWO_CARTS, *arguments, "--json", "--out", tmp_path / "none")
    assert done.exit_code == 2
    assert done.stdout == ""
    for word in words:
        assert word in done.stderr
    assert not (tmp_path / "none").exists()


def test_missing_file(tmp_path: Path) -> None:
    done = run(tmp_path / "none.toml")
    assert done.exit_code == 2
    assert "no such file" in done.stderr


def test_an_option_that_is_no_quantity_is_named() -> None:
    done = run(TWO_CARTS, "--method", "baranov", "--step", "1 kg")
    assert done.exit_code == 2
    assert "--step" in done.stderr
    assert "1 kg" in done.stderr


def test_tables_of_a_slotted_lever_name_each_output_once() -> None:
    """Link and slide of a slotted lever have one name; an angle that is constant has no place."""
    found = invoke("run", "quick_returns")
    assert found.exit_code == 0
    travel = found.stdout[
        found.stdout.index("Linkage over its cycle") : found.stdout.index("Transmission angle")
    ]
    assert "whitworth, angle" in travel
    assert "whitworth, position" in travel
    transmission = found.stdout[found.stdout.index("Transmission angle") : found.stdout.index("Motion over")]
    (row,) = [line.split() for line in transmission.splitlines() if line.startswith("shaper")]
    assert row == ["shaper", "μ", "90°", "–", "90°", "–"]


def test_what_rounding_leaves_is_not_told() -> None:
    """A parallelogram turns as its crank does: no acceleration, one revolution, extremes at 0°."""
    found = invoke("run", "change_points").stdout
    assert "C.rocker, angular acceleration" not in found
    assert "1 revolutions" not in found
    assert "·10⁻" not in found
