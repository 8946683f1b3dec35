"""``linkwright torsion``: JSON, tables, files, errors."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from command_line import invoke

from linkwright import loads
from linkwright.machine import dumps

TRAIN = """
format = 1
name = "Motor, gear and pump"
[train.discs]
motor = { inertia = "2 kg m^2" }
pinion = { inertia = "0.1 kg m^2" }
wheel = { inertia = "1.6 kg m^2" }
pump = { inertia = "8 kg m^2" }
[train.shafts]
fast = { between = ["motor", "pinion"], stiffness = "1e5 N m/rad" }
slow = { between = ["wheel", "pump"], sections = [{ length = "1 m", diameter = "90 mm" }] }
[train.gears]
stage = { between = ["pinion", "wheel"], teeth = [20, 80] }
"""


@pytest.fixture
def file(tmp_path: Path) -> str:
    path = tmp_path / "train.toml"
    path.write_text(TRAIN, encoding="utf-8")
    return str(path)


run = partial(invoke, "torsion")


BAR = """
format = 1
name = "Held bar"
[train]
inertia = "distributed"
modes = 2
[train.discs]
tip = { inertia = 1e-9 }
[train.shafts.bar]
between = ["ground", "tip"]
density = "7850 kg/m^3"
shear_modulus = "80 GPa"
sections = [{ length = "2 m", diameter = "50 mm" }]
"""


def test_a_bar_that_moves_alone_names_no_disc(tmp_path: Path) -> None:
    """f = c/4l, and only the shaft has energy."""
    path = tmp_path / "bar.toml"
    path.write_text(BAR, encoding="utf-8")
    found = json.loads(run(str(path), "--json").stdout)["results"]["free"]["natural_frequencies"]
    # The disc at the tip has a ten-millionth of the bar's inertia, and lowers them by as much.
    assert found == pytest.approx([np.sqrt(80e9 / 7850) / 8, 3 * np.sqrt(80e9 / 7850) / 8], rel=2e-7)
    text = run(str(path)).stdout
    assert "bar 100 %" in text
    assert ";  " not in text


def test_json(file: str) -> None:
    result = run(file, "--json")
    assert result.exit_code == 0
    free = json.loads(result.stdout)["results"]["free"]
    k = 79.3e9 * np.pi / 32 * 0.09**4 / 16
    J = np.array([2.0, 0.1 + 1.6 / 16, 8.0 / 16])
    K = np.array([[1e5, -1e5, 0], [-1e5, 1e5 + k, -k], [0, -k, k]])
    square = np.linalg.eigvalsh(K / np.sqrt(np.outer(J, J)))
    assert free["natural_frequencies"][0] == 0
    assert free["natural_frequencies"][1:] == pytest.approx(np.sqrt(square[1:]) / (2 * np.pi), rel=1e-10)
    assert free["discs"] == ["motor", "pinion", "wheel", "pump"]
    assert free["mode_shapes"][0] == pytest.approx([1, 1, 0.25, 0.25])
    assert [len(shape) for shape in free["mode_shapes"]] == [4, 4, 4]
    assert [len(nodes) for nodes in free["nodes"]] == [0, 1, 2]
    assert free["nodes"][1][0].keys() == {"at", "share", "distance"}


def test_torques_without_speeds_are_told(file: str) -> None:
    """What pulsates but has no speeds is not passed over in silence."""
    wave = "train.excitations.gas={ on = 'motor', harmonics = [{ order = 2, torque = 5 }] }"
    told = json.loads(run(file, "--json", "--set", wave).stdout)
    assert "forced" not in told["results"]
    assert any("[train.run]" in each for each in told["warnings"])
    speeds = ["--set", 'train.run={ speed_min = "500 rpm", speed_max = "600 rpm" }']
    told = json.loads(run(file, "--json", "--set", wave, *speeds).stdout)
    assert "forced" in told["results"]
    assert not any("[train.run]" in each for each in told["warnings"])


def test_set(file: str) -> None:
    plain = json.loads(run(file, "--json").stdout)["results"]["free"]["natural_frequencies"]
    sets = ["discs.motor.inertia=8", "discs.pinion.inertia=0.4", "discs.wheel.inertia=6.4"]
    sets += ["discs.pump.inertia=32 kg m^2"]
    words = [word for each in sets for word in ("--set", f"train.{each}")]
    heavy = json.loads(run(file, "--json", *words).stdout)["results"]["free"]["natural_frequencies"]
    assert heavy[1:] == pytest.approx([f / 2 for f in plain[1:]], rel=1e-12)


def test_tables(file: str) -> None:
    result = run(file, "--holzer", "30")
    assert result.exit_code == 0
    for words in ("Natural frequencies", "rigid-body rotation", "Mode shapes", "Holzer's table at 30 Hz"):
        assert words in result.stdout


def test_out(file: str, tmp_path: Path) -> None:
    out = tmp_path / "out"
    result = run(file, "--json", "--holzer", "30", "--out", str(out))
    assert result.exit_code == 0
    assert (out / "results.json").read_text(encoding="utf-8") == result.stdout
    assert json.loads(result.stdout)["results"]["holzer"][0]["frequency"] == 30
    for name in ("scheme", "mode_shapes"):
        assert (out / f"{name}.svg").read_text(encoding="utf-8").startswith("<svg")
        assert (out / f"{name}.png").stat().st_size > 5000
    parts = json.loads(result.stdout)["results"]["scheme"]["connections"]
    assert [each["name"] for each in parts] == ["fast", "slow", "stage"]


def test_out_has_every_figure_of_the_report(file: str, tmp_path: Path) -> None:
    """The manoeuvre too, as picture for a text."""
    hit = "{ kind = 'torque', time = 0.05, on = 'motor', torque = 9 }"
    out = tmp_path / "out"
    assert (
        run(
            file, "--set", f"train.transient={{ duration = 0.2, events = [{hit}] }}", "--out", str(out)
        ).exit_code
        == 0
    )
    for name in ("scheme", "mode_shapes", "transient"):
        assert (out / f"{name}.svg").read_text(encoding="utf-8").startswith("<svg")
        assert (out / f"{name}.png").read_bytes().startswith(b"\x89PNG")


def test_drive_study_with_stiffness(tmp_path: Path) -> None:
    text = (Path(__file__).parents[2] / "machines" / "roller_two_carts.toml").read_text(encoding="utf-8")
    path = tmp_path / "drive.toml"
    path.write_text(text, encoding="utf-8")
    rigid = run(str(path))
    assert rigid.exit_code == 2
    assert "drive.crankshaft.stiffness" in rigid.stderr
    path.write_text(text + '[drive.crankshaft]\nstiffness = "1.2 MN m/rad"\n', encoding="utf-8")
    result = run(str(path), "--json")
    # At some speeds the teeth lose contact, which is a finding.
    assert result.exit_code == (1 if json.loads(result.stdout)["findings"] else 0)
    free = json.loads(result.stdout)["results"]["free"]
    assert free["discs"] == ["motor", "gearbox", "crank"]
    motor, gearbox, crank = (each["inertia"] for each in discs_of(path))
    whole = motor * 9.8**2 + gearbox
    omega = np.sqrt(1.2e6 * (whole + crank) / (whole * crank))
    assert free["natural_frequencies"] == pytest.approx([0, omega / (2 * np.pi)], rel=1e-9)


@pytest.mark.parametrize(("speed", "parts"), [("", {"free", "scheme"}), ("speed = 9\n", {"forced"})])
def test_drive_study_without_motor(tmp_path: Path, speed: str, parts: set[str]) -> None:
    path = tmp_path / "drive.toml"
    text = 'format = 1\nname = "x"\n[drive]\n' + speed + "[drive.flywheel]\ninertia = 3\n"
    text += 'beside = "gearbox"\n[drive.crankshaft]\nstiffness = 1e5\n[mechanism.cranks.A]\nradius = 0.1\n'
    text += '[mechanism.sliders.S]\ncrank = "A"\nrod = 0.4\n[bodies]\nS = { mass = 50 }\n'
    path.write_text(text, encoding="utf-8")
    result = run(str(path), "--json")
    assert result.exit_code == 0
    assert parts <= json.loads(result.stdout)["results"].keys()


def discs_of(path: Path) -> list[dict[str, float]]:
    from linkwright import drive_line, read

    return [{"inertia": disc.inertia} for disc in drive_line(read(path)).discs.values()]


def test_two_trains_in_a_file(tmp_path: Path) -> None:
    path = tmp_path / "both.toml"
    path.write_text(TRAIN + "[drive.crankshaft]\nstiffness = 1e6\n", encoding="utf-8")
    result = run(str(path))
    assert result.exit_code == 2
    assert "drive.crankshaft" in result.stderr
    assert "one train" in result.stderr


def test_damper(file: str, tmp_path: Path) -> None:
    out = tmp_path / "out"
    words = ["damper", file, "--on", "motor", "--ring-inertia", "0.2 kg m^2", "--mode", "1"]
    result = run(*words, "--json", "--out", str(out))
    assert result.exit_code == 0
    found = json.loads(result.stdout)["results"]["damper"]
    assert (found["on"], found["kind"], found["mode"]) == ("motor", "viscous", 1)
    mu = found["mass_ratio"]
    assert mu == pytest.approx(0.2 / found["modal_inertia"])
    assert found["magnification"] == pytest.approx(1 + 2 / mu)
    assert (out / "damper.json").read_text(encoding="utf-8") == result.stdout
    assert (out / "damper.svg").read_text(encoding="utf-8").startswith("<svg")
    # The written damper is a part of a machine file.
    machine = loads(TRAIN + (out / "damper.toml").read_text(encoding="utf-8"))
    assert machine.train is not None
    assert machine.train.dampers["damper"].damping == pytest.approx(found["damping_best"], rel=1e-5)
    told = run(*words, "--kind", "rubber", "--loss-factor", "0.2")
    assert told.exit_code == 0
    for part in ("by the mode", "optimum", "loss factor", 'kind = "tuned"', "loss_factor = 0.2"):
        assert part in told.stdout


@pytest.mark.parametrize(
    ("words", "part"),
    [
        (["--on", "x", "--ring-inertia", "0.2"], 'found "x"'),
        (["--on", "motor", "--ring-inertia", "2 m"], "--ring-inertia"),
        (["--on", "motor", "--ring-inertia", "0.2", "--mode", "9"], "mode: found 9"),
        (["--on", "motor", "--ring-inertia", "-1"], "--ring-inertia: found -1"),
    ],
)
def test_wrong_damper(file: str, words: list[str], part: str) -> None:
    result = run("damper", file, *words)
    assert result.exit_code == 2
    assert part in result.stderr


def test_wrong_train(file: str) -> None:
    result = run(file, "--set", "train.discs.motor.inertia=0")
    assert result.exit_code == 2
    assert "train.discs.motor.inertia" in result.stderr


def test_machine_without_train(tmp_path: Path) -> None:
    path = tmp_path / "crank.toml"
    path.write_text('format = 1\nname = "x"\n[mechanism.cranks.A]\nradius = 0.1\n', encoding="utf-8")
    result = run(str(path))
    assert result.exit_code == 2
    assert "[train]" in result.stderr


@pytest.mark.parametrize("command", ["run", "motion", "forces", "size"])
def test_a_train_has_no_mechanism(file: str, command: str) -> None:
    words = ["--speed", "10 rad/s"] if command == "forces" else []
    result = invoke(command, file, *words)
    assert result.exit_code == 2
    assert result.exception is None or isinstance(result.exception, SystemExit)


def test_check_names_the_parts(file: str) -> None:
    result = invoke("check", file)
    assert result.exit_code == 0
    assert "motor, pinion, wheel, pump" in result.stdout


def test_written_train_reads_back() -> None:
    machine = loads(TRAIN)
    assert loads(dumps(machine)) == machine
