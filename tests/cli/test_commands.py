"""The command line: messages on standard error, exit codes, no traceback for wrong input."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Annotated

import pytest
from click.testing import CliRunner
from command_line import invoke as run

from linkwright import StartError, loads
from linkwright.kernel.command.common import reports_errors
from linkwright.kernel.command.parameter import Option, command
from linkwright.kernel.files.library import templates

ROOT = Path(__file__).parents[2]
TWO_CARTS = ROOT / "machines" / "roller_two_carts.toml"


def test_check_says_what_is_in_the_file() -> None:
    done = run("check", TWO_CARTS)
    assert done.exit_code == 0
    assert done.stdout.startswith("OK")
    for word in ("cart1.rod", "induction, 11 kW, ratio 9.8", "rolling1 (dry)"):
        assert word in done.stdout


@pytest.mark.parametrize(
    ("name", "change", "words"),
    [
        ("roller_two_carts", "mechanism.sliders.cart1.rod=0.1 m", "closes only at crank angles"),
        ("roller_cam", "mechanism.cams.cart.cutter_radius=0.9", "cannot be cut"),
        ("topper", "topper.edge_length=20 mm", "does not cut through every head"),
        ("rod_rotator_intermittent", "rod_rotator.swing=0.5 deg", "No lever of the rotator"),
    ],
)
def test_check_finds_what_the_geometry_does_not_allow(name: str, change: str, words: str) -> None:
    """Exit code 1, the findings, and what was looked at; as `run` has it."""
    file = TWO_CARTS.with_name(f"{name}.toml")
    done = run("check", file, "--set", change)
    assert done.exit_code == 1
    assert "OK" not in done.stdout
    assert re.search(rf"FINDING  .*{words}", done.stdout)
    assert re.search(r"\nChecked *\npart +what *\n─+\n\w+ ", done.stdout)
    assert run("run", file, "--set", change).exit_code == 1


def test_check_tells_all_problems_on_standard_error(tmp_path: Path) -> None:
    path = tmp_path / "bad.toml"
    path.write_text("format = 1\nname = 3\n[mechanism.cranks.A]\nradius = '1 kg'\n")
    done = run("check", path)
    assert done.exit_code == 2
    assert done.stdout == ""
    assert f"{path}:2: name" in done.stderr
    assert f"{path}:4: mechanism.cranks.A.radius" in done.stderr


def test_set_is_checked_like_the_file() -> None:
    assert run("check", TWO_CARTS, "--set", "drive.gearbox.ratio=10", "--set", "name=x").exit_code == 0
    done = run("check", TWO_CARTS, "--set", "drive.gearbox.ratio=-10")
    assert done.exit_code == 2
    assert "--set drive.gearbox.ratio=-10" in done.stderr
    assert run("check", TWO_CARTS, "--set", "ratio").exit_code == 2


@pytest.mark.parametrize("arguments", [["check"], ["nonsense"], ["check", "a", "b"], ["check", "--what"]])
def test_wrong_usage(arguments: list[str]) -> None:
    assert run(*arguments).exit_code == 2


# Every option that takes an angle or a speed of rotation, and where its bare number stands.
BARE = (
    ("motion {press} --at 30", '--at "30 deg"'),
    ("motion {press} --speed 9", '--speed "9 rpm"'),
    ("forces {press} --speed 9", '--speed "9 rpm"'),
    ("forces {press} --speed=1rpm --angles=-1,30", '--angles "-1 deg"'),
    ("forces {press} --pressure-angle 20", '--pressure-angle "20 deg"'),
    ("balance {press} --links A1 --speed 9", '--speed "9 rpm"'),
    ("run {press} --method baranov --step 1", '--step "1 deg"'),
    ("cam {cam} --step 1", '--step "1 deg"'),
    ("cam search {cam} --vary face_tilt=1:2:3", '"1 deg"'),
    ("synthesise dead-centre --swing 60", '--swing "60 deg"'),
    ("topper field {topper} --over edge_angle=0:30:3", '"30 deg"'),
    ("torsion diagnose {engine} {press} --on flywheel --noise 1", '--noise "1 rpm"'),
)


@pytest.mark.parametrize(("words", "remedy"), BARE)
def test_an_angle_or_a_speed_needs_its_unit(words: str, remedy: str) -> None:
    machines = TWO_CARTS.parent
    files = {
        "press": TWO_CARTS,
        "cam": machines / "roller_cam.toml",
        "topper": machines / "topper.toml",
        "engine": machines / "v8_diesel.toml",
    }
    done = run(*(word.format(**files) for word in words.split()))
    assert done.exit_code == 2
    assert remedy in done.stderr


def test_an_option_says_what_the_file_says_of_a_unit() -> None:
    comma = run("synthesise", "line", "--kind", "hoeken", "--length", "0,2 m").stderr
    assert "decimal point" in comma
    assert "or a number in metres" in comma
    angle = run("motion", TWO_CARTS, "--at", "30,5 deg").stderr
    assert "decimal point" in angle
    assert "or a number in" not in angle


def test_an_unknown_size_of_a_cam_is_named_with_what_may_be_meant() -> None:
    cam = TWO_CARTS.parent / "roller_cam.toml"
    done = run("cam", "search", cam, "--vary", "base_radiu=0.2:0.3:3")
    assert 'expected a size of the cam; did you mean "base_radius"' in done.stderr


def test_in_a_file_and_after_set_bare_numbers_are_si() -> None:
    done = run("motion", TWO_CARTS, "--set", "drive.speed=9", "--at", "0", "--json")
    assert json.loads(done.stdout)["results"]["pose"]["speed"] == 9


@pytest.mark.parametrize("name", templates())
def test_new_writes_a_sound_file(name: str, tmp_path: Path) -> None:
    assert loads(run("new", name).stdout) == loads(run("new", name).stdout)
    out = tmp_path / "machine.toml"
    assert run("new", name, "--out", out).exit_code == 0
    assert run("check", out).exit_code == 0


def test_new_replaces_nothing_unasked(tmp_path: Path) -> None:
    out = tmp_path / "machine.toml"
    out.write_text("mine")
    done = run("new", "press", "--out", out)
    assert done.exit_code == 2
    assert "--force" in done.stderr
    assert out.read_text() == "mine"
    assert run("new", "press", "--out", out, "--force").exit_code == 0
    assert out.read_text() != "mine"


def test_new_names_its_templates() -> None:
    for done in (run("new", "--list"), run("new")):
        assert done.exit_code == 0
        assert all(name in done.stdout for name in templates())
    unknown = run("new", "pres")
    assert unknown.exit_code == 2
    assert '"press"' in unknown.stderr


@pytest.mark.parametrize(
    ("name", "command"), [("poses", "motion"), ("function", "function"), ("path", "path")]
)
def test_templates_of_tasks_have_a_linkage(name: str, command: str, tmp_path: Path) -> None:
    task = tmp_path / "task.toml"
    assert run("new", name, "--out", task).exit_code == 0
    assert f"  {name} " in run("new", "--list").stdout
    done = run("synthesise", command, task, "--json")
    assert done.exit_code == 0, done.stdout + done.stderr


def test_forces_of_a_machine_without_masses_and_loads_say_so() -> None:
    done = run("forces", "press_motion", "--json")
    assert done.exit_code == 0
    assert "no masses and no loads" in json.loads(done.stdout)["warnings"][0]
    assert "[pumping_unit.load]" in run("forces", "pumping_unit_torque").stdout
    assert json.loads(run("forces", "press_with_flywheel", "--json").stdout)["warnings"] == []


def test_a_power_without_its_unit_may_be_watts_or_kilowatts() -> None:
    done = run("motors", "--power-min", "5.5")
    assert done.exit_code == 2
    assert '--power-min "5.5 kW"' in done.stderr


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("run", "marine_turbine"), "linkwright torsion"),
        (("size", "flywheel_four_stroke"), "turning_moment.unevenness"),
        (("torsion", "propeller_shaft_line", "--measured", "no.csv"), "--measured"),
        (("new", "bench"), "linkwright new --list"),
    ],
)
def test_a_refusal_names_the_way(words: tuple[str, ...], said: str) -> None:
    done = run(*words)
    assert done.exit_code == 2
    assert said in done.stderr


def test_out_in_a_folder_that_does_not_exist(tmp_path: Path) -> None:
    done = run("new", "press", "--out", tmp_path / "no" / "x.toml")
    assert done.exit_code == 2
    assert "cannot be written" in done.stderr


def test_schema_is_json() -> None:
    assert json.loads(run("schema").stdout)["title"] == "Linkwright machine file"


def test_a_finding_is_exit_code_1_and_an_interrupt_130() -> None:
    def stall(interrupt: Annotated[bool, Option("--interrupt")] = False) -> None:
        raise KeyboardInterrupt if interrupt else StartError("the drive does not start")

    app = command(reports_errors(stall))
    done = CliRunner().invoke(app, [])
    assert done.exit_code == 1
    assert done.stderr == "the drive does not start\n"
    assert CliRunner().invoke(app, ["--interrupt"]).exit_code == 130


def program(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "linkwright", *map(str, arguments)]
    path = os.pathsep.join([str(ROOT / "python"), os.environ.get("PYTHONPATH", "")])
    environment = os.environ | {"PYTHONPATH": path}
    return subprocess.run(command, capture_output=True, text=True, env=environment, check=False)


def test_what_is_no_machine_file(tmp_path: Path) -> None:
    garbage = tmp_path / "garbage.toml"
    garbage.write_bytes(os.urandom(10_000_000))
    empty = tmp_path / "empty.toml"
    empty.touch()
    for path in (garbage, empty, tmp_path, tmp_path / "missing.toml"):
        done = program("check", path)
        assert done.returncode == 2
        assert done.stdout == ""
        assert str(path) in done.stderr
        assert "Traceback" not in done.stderr


def test_letters_that_the_terminal_has_not(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("PYTHONIOENCODING", "ascii")
    path = tmp_path / "машина.toml"
    path.write_text("format = 1\nname = 'Візок'\n[mechanism.cranks.A]\nradius = 1\n", encoding="utf-8")
    assert program("check", path).returncode == 0
    done = program("check", path, "--set", "mechanism.rockers.Ж.crank=Ж")
    assert done.returncode == 2
    assert "Traceback" not in done.stderr


def test_help_loads_nothing_heavy() -> None:
    code = (
        "import sys\nfrom linkwright.app import application\n"
        "application().main(['--help'], standalone_mode=False)\n"
        "heavy = {'linkwright.machine', 'numpy', 'pint', 'pydantic', 'rich', 'tomlkit', 'matplotlib'}\n"
        "assert not heavy & set(sys.modules), heavy & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
    assert "check" in program("--help").stdout


@pytest.mark.parametrize(
    ("name", "change", "table", "words"),
    [
        (
            "rod_rotator_intermittent",
            "rod_rotator.pin_distance=4.5",
            "[rod_rotator]",
            "no link and lever fit",
        ),
        ("rod_rotator_continuous", "pumping_unit.P=1", "[pumping_unit]", "closes only"),
        ("roller_two_carts", "mechanism.sliders.cart1.rod=0.1 m", "[mechanism.sliders.cart1]", "closes only"),
    ],
)
def test_what_does_not_close_is_told_with_file_and_line(
    name: str, change: str, table: str, words: str
) -> None:
    """Also of elements that a table stands for, such as the rotator's link and lever."""
    file = TWO_CARTS.with_name(f"{name}.toml")
    line = file.read_text(encoding="utf-8").splitlines().index(table) + 1
    done = run("forces", str(file), "--set", change, "--speed", "1 rad/s")
    assert done.exit_code == 1
    assert done.stderr.startswith(f"{file}:{line}: ")
    assert words in done.stderr
