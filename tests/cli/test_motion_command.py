"""``linkwright motion``: poses, turns, laws."""

from __future__ import annotations

import csv
import io
import json
import re
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from command_line import invoke

FOUR_BAR = Path(__file__).parents[2] / "examples" / "four_bar_coupler_curve" / "machine.toml"


def run(*args: object, file: Path = FOUR_BAR):
    return invoke("motion", file, *args)


def columns(text: str) -> dict[str, list[float]]:
    rows = list(csv.reader(io.StringIO(text)))
    return {head: [float(row[k]) for row in rows[1:]] for k, head in enumerate(rows[0])}


def test_a_pose() -> None:
    done = run("--at", "30 deg", "--speed", "2 rad/s", "--json")
    assert done.exit_code == 0
    found = json.loads(done.stdout)["results"]["pose"]
    assert found["crank_angle"] == pytest.approx(np.pi / 6)
    assert found["points"]["A"]["velocity"] == pytest.approx([-0.05, 0.1 * np.cos(np.pi / 6)])
    table = run("--at", "30 deg").stdout
    assert "C.rocker angle [°, rad/s, rad/s²]" in table
    assert run("--at", "30 deg", "--csv").stdout.startswith("name,quantity,position,velocity,acceleration\n")


def test_a_pose_takes_the_acceleration_of_the_crank() -> None:
    """a = p″ω² + p′ε: what ε adds is the velocity times ε/ω."""
    words = ("--at", "30 deg", "--speed", "2 rad/s", "--json")
    plain, driven = (
        json.loads(run(*words, *more).stdout)["results"]["pose"]
        for more in ((), ("--acceleration", "5 rad/s^2"))
    )
    for name, link in driven["links"].items():
        before = plain["links"][name]
        wanted = before["acceleration"] + link["velocity"] * 5 / 2
        assert link["acceleration"] == pytest.approx(wanted, rel=1e-12)
    assert run("--acceleration", "5 rad/s^2").exit_code == 2


def test_a_turn() -> None:
    found = columns(run("--csv", "--steps", 36).stdout)
    assert len(found["time [s]"]) == 37
    assert found["crank_angle [rad]"][-1] == pytest.approx(2 * np.pi)
    np.testing.assert_allclose(found["A.x [m]"], 0.05 * np.cos(found["crank_angle [rad]"]), atol=1e-15)
    assert {"K.y.jerk [m/s³]", "C.rocker.angle.velocity [rad/s]"} <= found.keys()
    # People see what moves, without its rates.
    head = re.split(r"  +", run("--steps", 4).stdout.splitlines()[1].strip())
    assert head[:4] == ["time [s]", "crank_angle [°]", "A.x [m]", "A.y [m]"]
    assert "O.x [m]" not in head


# Drives, and the crank speed that a motion without --speed has [rad/s].
SPEEDS = {
    "design speed, drive.speed": (("drive.speed=10.5",), 10.5),
    "drive.motor.speed over drive.gearbox.ratio": (
        ('drive.motor={kind="constant_speed", speed="300 rpm"}', "drive.gearbox.ratio=5"),
        2 * np.pi,
    ),
    "the file has no drive.speed: rates are those for a radian per second": ((), 1.0),
}


@pytest.mark.parametrize("source", SPEEDS)
def test_the_speed_is_that_of_the_file_and_is_said(source: str, tmp_path: Path) -> None:
    sets, speed = SPEEDS[source]
    words = [word for each in sets for word in ("--set", each)]
    own = FOUR_BAR.read_text(encoding="utf-8")
    without = re.sub(r"(?m)^speed = .*$", "", own)
    assert without != own
    file = tmp_path / "four_bar.toml"
    file.write_text(without, encoding="utf-8")
    ask = partial(run, *words, file=file)
    pose = json.loads(ask("--at", "30 deg", "--json").stdout)["results"]["pose"]
    assert (pose["speed"], pose["speed_source"]) == (pytest.approx(speed), source)
    assert pose["points"]["A"]["velocity"][1] == pytest.approx(0.05 * speed * np.cos(np.pi / 6))
    turn = json.loads(ask("--json").stdout)["results"]["motion"]
    assert (turn["crank_speed"], turn["speed_source"]) == (pytest.approx(speed), source)
    assert turn["time"][-1] == pytest.approx(2 * np.pi / speed)
    for args in (("--at", "30 deg"), (), ("--at", "30 deg", "--csv"), ("--csv",)):
        said = ask(*args).output
        assert f"{speed:.4g} rad/s = {speed * 30 / np.pi:.4g} rpm ({source})" in said
    assert "crank angle 30° = 0.5235988 rad" in ask("--at", "30 deg").stdout


def test_a_given_speed_goes_before_that_of_the_file() -> None:
    done = run("--set", "drive.speed=10.5", "--speed", "60 rpm", "--at", "0", "--json")
    found = json.loads(done.stdout)["results"]["pose"]
    assert (found["speed"], found["speed_source"]) == (pytest.approx(2 * np.pi), "--speed")


def test_a_law(tmp_path: Path) -> None:
    found = columns(run("--law", "3*t^2", "--duration", "2 s", "--steps", 4, "--csv").stdout)
    np.testing.assert_allclose(found["crank_angle [rad]"], 3 * np.array(found["time [s]"]) ** 2)
    assert set(found["acceleration [rad/s²]"]) == {6.0}
    table = tmp_path / "law.csv"
    table.write_text("time,angle\n0,0\n1,2\n3,4\n", encoding="utf-8")
    found = json.loads(run("--law", table, "--steps", 3, "--json").stdout)["results"]["motion"]
    assert found["time"] == [0.0, 1.0, 2.0, 3.0]
    assert found["crank_angle"][1] == pytest.approx(2)


@pytest.mark.parametrize(
    ("args", "words"),
    [
        (("--at", "30 m"), "--at: found"),
        (("--at", "30"), '--at "30 deg" or --at "30 rad"'),
        (("--at", "-1e1"), '--at "-1e1 deg"'),
        (("--speed", "90"), '--speed "90 rpm" or --speed "90 rad/s"'),
        (("--speed", "9 rad/s", "--law", "t"), "the law gives the speed"),
        (("--duration", "2 s"), "belongs to a --law"),
        (("--at", "1 rad", "--law", "t"), "not both"),
        (("--law", "2*"), "character 3"),
        (("--steps", "0"), "--steps"),
        (("--speed", "-1 rad/s"), "above zero"),
        (("--law", "t", "--duration", "0 s"), "--duration"),
        (("--law", "missing.csv"), "missing.csv"),
    ],
)
def test_wrong_input(args: tuple[str, ...], words: str) -> None:
    done = run(*args)
    assert done.exit_code == 2
    assert words in done.output


def test_a_table_with_words(tmp_path: Path) -> None:
    table = tmp_path / "law.csv"
    table.write_text("0,0\n1,two\n", encoding="utf-8")
    done = run("--law", table)
    assert done.exit_code == 2
    assert "law.csv:2" in done.output


def test_angles_from_a_dead_centre() -> None:
    """The ram of the press is at its top there; a revolution begins and ends with it."""

    def told(*words: str) -> str:
        result = invoke("motion", "press_motion", "--zero", "top", *words)
        assert result.exit_code == 0, result.output
        return result.stdout

    # 500 mm − 80 mm, and 90° on the circle of the pin: √(500² − 80²) mm.
    at = json.loads(told("--at", "0 deg", "--json"))["results"]["pose"]
    assert at["slides"]["ram"]["position"] == pytest.approx(0.42, rel=1e-12)
    assert at["angle_zero"] == pytest.approx(np.pi / 2)
    rows = list(csv.DictReader(io.StringIO(told("--csv", "--steps", "4", "--units", "mm, deg"))))
    assert [float(row["crank_angle [°]"]) for row in rows] == pytest.approx([0, 90, 180, 270, 360], abs=1e-9)
    places = [float(row["ram.place [mm]"]) for row in rows]
    side = np.sqrt(500**2 - 80**2)
    assert places == pytest.approx([420, side, 580, side, 420], rel=1e-12)
