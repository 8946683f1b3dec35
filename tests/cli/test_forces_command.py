"""``linkwright forces`` and ``linkwright balance``."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path

import pytest
from command_line import invoke

import linkwright as lw
from linkwright.app.commands.check import summary

FILE = """
format = 1
name = "Press"
[mechanism.cranks.A]
radius = "100 mm"
[mechanism.sliders.S]
crank = "A"
rod = "240 mm"
[bodies]
S = { mass = "4 kg" }
A = { mass = "1 kg" }
[loads]
work = { kind = "force", on = "S", force = "-200 N" }
"""


@pytest.fixture
def press(tmp_path: Path) -> Path:
    path = tmp_path / "press.toml"
    path.write_text(FILE, encoding="utf-8")
    return path


def run(*words: str | Path) -> tuple[int, str]:
    result = invoke(*words)
    assert result.exception is None or isinstance(result.exception, SystemExit)
    return result.exit_code, result.output


def test_table_has_the_forces(press: Path) -> None:
    code, text = run("forces", press, "--speed", "60 rpm")
    assert code == 0
    assert "pin, A on S.rod" in text
    assert "loads.work" in text
    peak = lw.forces(lw.read(press), speed=6.283185307179586).pairs["A"].size.max()
    assert f"{peak:.4g} N" in text


def test_json_is_that_of_python(press: Path) -> None:
    code, text = run("forces", press, "--speed", "10 rad/s", "--json", "--curves")
    assert code == 0
    found = json.loads(text)["results"]["Press"]
    result = lw.forces(lw.read(press), speed=10.0)
    assert found["reaction_max"] == pytest.approx(result.reaction_max)
    assert found["torque_drive"] == pytest.approx(result.torque_drive.tolist())
    assert found["envelope"]["torque_drive"]["peak"] == pytest.approx(result.torque_drive_max)


@pytest.mark.parametrize("name", ["log_function_generator", "scissor_lift"])
def test_a_rocking_drive_names_the_angles_that_it_has(name: str) -> None:
    """What the message proposes works as printed."""
    code, text = run("forces", name, "--speed", "1 rad/s")
    assert code == 1
    proposed = re.search('--speed "(.*?)" --angles="(.*?)"', " ".join(text.split()))
    assert proposed is not None
    code, _ = run("forces", name, "--speed", proposed[1], f"--angles={proposed[2]}")
    assert code == 0


def test_angles_are_those_asked_for(press: Path) -> None:
    # A crank longer than its rod turns within a range alone.
    words = (
        "forces",
        press,
        "--speed",
        "1 rad/s",
        "--set",
        "mechanism.cranks.A.radius=0.3",
        "--json",
        "--curves",
    )
    assert run(*words)[0] == 1
    code, text = run(*words, "--angles=-30 deg, 40 deg")
    assert code == 0
    found = json.loads(text)["results"]["Press"]["crank_angle"]
    assert [found[0], found[-1]] == pytest.approx([-0.5235987755982988, 0.6981317007977318])


def test_a_pose_has_the_components_of_every_force(press: Path) -> None:
    """At rest the rod carries F/cos β, the guide F tan β, the crank F sin(φ + β)/cos β times its radius."""
    words = ("forces", press, "--speed", "0 rad/s", "--at", "50 deg")
    code, text = run(*words, "--json")
    assert code == 0
    found = json.loads(text)["results"]["Press"]
    beta = math.asin(0.1 / 0.24 * math.sin(math.radians(50)))
    wanted = 200 * 0.1 * math.sin(math.radians(50) + beta) / math.cos(beta)
    # The slider is pushed towards the shaft and drives the crank onwards.
    assert found["torque_drive"] == pytest.approx([-wanted], rel=1e-12)
    assert found["reactions"]["A"][0] == pytest.approx([200, -200 * math.tan(beta)], rel=1e-12)
    assert found["reactions"]["S.guide"][0] == pytest.approx([0, 200 * math.tan(beta)], rel=1e-12, abs=1e-12)
    table = run(*words)[1]
    assert f"{200 / math.cos(beta):.4g} N" in table
    assert f"{-math.degrees(beta):.4g}°".replace("-", "−") in table
    assert "at φ = 50°" in table


def test_a_pose_takes_the_acceleration_of_the_crank(press: Path) -> None:
    """The torque grows by the reduced inertia times the acceleration."""
    words = ("forces", press, "--speed", "10 rad/s", "--json", "--zero", "outer", "--at", "-30 deg")
    torques = [
        json.loads(run(*words, "--acceleration", given)[1])["results"]["Press"]["torque_drive"][0]
        for given in ("0", "20 rad/s^2")
    ]
    machine = lw.read(press)
    inertia = lw.reduction(machine, n=360).inertia_reduced[330]
    assert torques[1] - torques[0] == pytest.approx(20 * inertia, rel=1e-12)


def test_load_cases_of_a_pose_stand_one_below_the_other(press: Path, tmp_path: Path) -> None:
    words = ("forces", press, "--speed", "10 rad/s", "--at", "1 rad", "--out", tmp_path / "found")
    code, text = run(*words, "--case", "idle: loads.work.force=0", "--case", "full:")
    assert code == 0
    assert "Forces at φ = 57.3°, idle" in text
    assert "Forces at φ = 57.3°, full" in text
    # One angle has no curve.
    assert not list((tmp_path / "found").glob("forces*.png"))


WRONG_POSES = {
    "--at": ("--at", "1 rad", "--angles", "0 deg, 1 deg", "--speed", "1 rad/s"),
    "--acceleration": ("--acceleration", "1 rad/s^2"),
    "unit of acceleration": ("--at", "1 rad", "--speed", "1 rad/s", "--acceleration", "1 m/s^2"),
}


@pytest.mark.parametrize(("named", "words"), WRONG_POSES.items())
def test_wrong_words_of_a_pose(press: Path, named: str, words: tuple[str, ...]) -> None:
    code, text = run("forces", press, *words)
    assert code == 2
    assert named in text


def test_cases_stand_in_columns(press: Path) -> None:
    code, text = run(
        *("forces", press, "--speed", "10 rad/s", "--case", "idle: loads.work.force=0"),
        *("--case", 'heavy: loads.work.force="-1 kN"; bodies.S.mass=8'),
    )
    assert code == 0
    assert "idle" in text
    assert "heavy" in text


def test_friction_and_findings(press: Path) -> None:
    words = ["forces", press, "--speed", "10 rad/s", "--friction", "A: radius=20 mm, coefficient=0.1"]
    code, text = run(*words, "--json")
    assert code == 0
    friction = {"A": lw.Friction(0.1, radius=0.02)}
    wanted = lw.forces(lw.read(press), speed=10.0, friction=friction).torque_drive_max
    assert json.loads(text)["results"]["Press"]["torque_drive_max"] == pytest.approx(wanted)
    code, text = run(*words, "--friction", "S.guide: coefficient=6")
    assert code == 1
    assert "FINDING" in text
    assert "locks" in text


def test_folder_has_files(press: Path, tmp_path: Path) -> None:
    code, _ = run("forces", press, "--speed", "10 rad/s", "--out", tmp_path / "found")
    assert code == 0
    names = {path.name for path in (tmp_path / "found").glob("[!.]*")}
    assert names == {
        *("results.json", "forces.csv"),
        *(f"{name}.{kind}" for name in ("forces", "hodograph", "polar") for kind in ("svg", "png")),
    }
    head, *rows = (tmp_path / "found" / "forces.csv").read_text(encoding="utf-8").splitlines()
    assert len(rows) == 361
    assert "A_x [N]" in head


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("forces",), "neither a motor"),
        (("forces", "--speed", "fast"), "--speed"),
        (("forces", "--speed", "1 rad/s", "--case", "idle"), "--case"),
        (("forces", "--speed", "1 rad/s", "--friction", "A"), "--friction"),
        (("forces", "--speed", "1 rad/s", "--friction", "A: mu=1"), "mu=1"),
        (("forces", "--speed", "1 rad/s", "--friction", "B: coefficient=1"), "friction.B"),
        (("forces", "--speed", "1 rad/s", "--angles", "3 deg"), "--angles"),
        (("forces", "--angles", "3 deg, 5 deg"), "--speed"),
        (("balance", "--speed", "1 rad/s"), "neither"),
        (("balance", "--speed", "1 rad/s", "--links", "S.rod"), "fixed points"),
    ],
)
def test_wrong_input_is_named(press: Path, words: tuple[str, ...], said: str) -> None:
    code, text = run(words[0], press, *words[1:])
    assert code == 2
    assert said in text


def test_balance_of_a_symmetric_machine_shows_no_rounding(press: Path) -> None:
    """The shaking moment of a central slider-crank about its shaft is zero, with a counterweight too."""
    words = ("--slider", "S", "--speed", "10 rad/s", "--set", "loads.work.force=0")
    code, text = run("balance", press, *words)
    assert code == 0
    (row,) = (line for line in text.splitlines() if line.startswith("shaking moment"))
    assert row.split()[-7:] == ["0", "N", "m", "0", "N", "m", "–"]


def test_balance_writes_a_machine(press: Path, tmp_path: Path) -> None:
    out = tmp_path / "balanced.toml"
    code, text = run(
        "balance", press, "--links", "A", "--speed", "10 rad/s", "--radius", "80 mm", "--out", out
    )
    assert code == 0
    assert "Counterweights" in text
    machine = lw.read(out)
    assert machine.bodies["counterweight_A"].along == pytest.approx(-0.08, rel=1e-6)
    code, text = run("balance", press, "--slider", "S", "--share", "0.5", "--speed", "10 rad/s", "--json")
    assert code == 0
    weight = json.loads(text)["results"]["balance"]["counterweights"]["A"]
    # Half of 4 kg at the pin, and the crank's 1 kg in its middle.
    assert weight["moment"] == pytest.approx((2 * 0.1 + 1 * 0.05), rel=1e-12)


def test_check_says_the_mobility(press: Path) -> None:
    assert "3 moving links, 4 pins and guides: W = 3·3 − 2·4 = 1" in summary(lw.read(press))
