"""``linkwright transient``: from any state, counted from a dead centre, in the units that are asked for."""

from __future__ import annotations

import csv
import json
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_line import invoke

import linkwright as lw

PRESS = Path(__file__).parents[2] / "examples" / "press_with_flywheel" / "machine.toml"


run = partial(invoke, "transient", PRESS)


def told(*words: str) -> dict[str, Any]:
    done = run(*words, "--json")
    assert done.exit_code == 0, done.output
    found: dict[str, Any] = json.loads(done.stdout)["results"]["transient"]
    return found


def test_json_is_what_python_gives() -> None:
    found = told("--from-angle", "20 deg", "--from-speed", "30 rpm", "--duration", "0.5 s", "--curves")
    motion = lw.transient(lw.read(PRESS), angle=np.radians(20), speed=np.pi, duration=0.5)
    assert found["end"] == "time"
    assert found["speed"][-1] == motion.speed[-1]
    assert found["acceleration"][0] == pytest.approx(motion.acceleration[0], rel=1e-9)
    assert found["extremes"] == [each._asdict() for each in lw.motion_extremes(motion)]
    assert len(found["ram.place"]) == len(found["time"]) == 501
    place = lw.kinematics(lw.read(PRESS), [found["crank_angle"][250]]).slides["ram"].position[0]
    assert found["ram.place"][250] == place


def test_angles_count_from_the_dead_centre() -> None:
    found = told("--zero", "top", "--from-angle", "30 deg", "--duration", "0.1 s")
    assert found["angle_zero"] == pytest.approx(np.pi / 2)
    # JSON has the angle of the file.
    assert found["events"][0]["crank_angle"] == pytest.approx(np.radians(120))


def test_files_have_the_units_that_are_asked_for(tmp_path: Path) -> None:
    words = ("--zero", "top", "--units", "mm, rpm, deg", "--revolutions", "0.5", "--steps", "20")
    assert run(*words, "--out", str(tmp_path / "out")).exit_code == 0
    names = {path.name for path in (tmp_path / "out").iterdir()}
    assert {"results.json", "transient.csv", "transient.svg", "transient.png"} <= names
    rows = list(csv.DictReader((tmp_path / "out" / "transient.csv").read_text(encoding="utf-8").splitlines()))
    assert len(rows) == 21
    assert float(rows[0]["crank_angle [°]"]) == 0.0
    assert float(rows[-1]["crank_angle [°]"]) == pytest.approx(180.0)
    assert float(rows[0]["ram.place [mm]"]) == pytest.approx(420.0)
    assert float(rows[-1]["ram.place [mm]"]) == pytest.approx(580.0)
    assert "ram.place.velocity [mm/s]" in rows[0]
    assert "speed [rpm]" in rows[0]


def test_a_stall_is_a_finding_and_a_run_down_is_none() -> None:
    stalled = run("--set", "drive.flywheel.inertia=2", "--set", "drive.motor.catalogue=AIR 0.75 kW 6-pole")
    assert stalled.exit_code == 1
    assert "N m at the crank" in " ".join(stalled.stdout.split())
    stopped = run("--no-motor", "--from-speed", "30 rpm")
    assert stopped.exit_code == 0
    assert "WARNING" in stopped.stdout


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--zero", "left"), "outer, inner, top, bottom"),
        (("--units", "mm,cm"), "one unit of a kind"),
        (("--units", "smoot"), "smoot"),
        (("--revolutions", "0"), "more than 0"),
        (("--from-angle", "30"), "30 deg"),
        (("--from-speed=-3",), "may be rpm or rad/s"),
    ],
)
def test_wrong_input(words: tuple[str, ...], said: str) -> None:
    done = run(*words)
    assert done.exit_code == 2
    assert said in done.stderr


def test_a_long_motion_has_a_short_table_of_events() -> None:
    """Kinks at which nothing jumps are in JSON alone; of many jumps the first and the last are shown."""
    events = told("--revolutions", "60")["events"]
    kinks = [event for event in events if event["kind"] == "kink"]
    assert len(kinks) > 400
    shown = run("--revolutions", "60").stdout
    assert f"Events, 2 of {len(events)}" in shown
    assert "kink" not in shown
    rod = str(Path(__file__).parents[1] / "found" / "tangent_rod.toml")
    shown = invoke("transient", rod, "--revolutions", "60").stdout
    table = shown[shown.index("Events, 24 of ") : shown.index("Motion in time")]
    assert table.count("jump of") == 22
    assert "end of the" in table
    assert "Events  " in run("--duration", "0.1 s").stdout


CARTS = "elastic_coupling_of_carts"


def test_an_elastic_driveline_is_followed_with_its_shafts() -> None:
    """As `elastic_transient` has it, with a load step and a stop; `--rigid` has one crankshaft."""
    machine = lw.read(CARTS)
    switches = [
        lw.DriveSwitch(1.5, machine=lw.replace(machine, {"loads.rolling1.force": 7000.0})),
        lw.DriveSwitch(2.0, motor=False),
    ]
    motion = lw.elastic_transient(machine, duration=2.5, accuracy=1e-8, switches=switches)
    by_hand = ("--switch", "1.5 s: loads.rolling1.force=7 kN", "--switch", "2 s: motor=off")
    done = invoke("transient", CARTS, "--duration", "2.5 s", *by_hand, "--json")
    assert done.exit_code == 1
    found = json.loads(done.stdout)
    assert found["results"]["elastic_transient"]["torque_max"]["crankshaft"] == motion.torque_max[0]
    assert "permitted 3000 N m: limit exceeded" in found["findings"][0]
    rigid = json.loads(invoke("transient", CARTS, "--duration", "2.5 s", "--rigid", "--json").stdout)
    assert rigid["results"]["transient"]["duration"] == 2.5


@pytest.mark.parametrize("change", ["motor=off", "motor = off"])
def test_a_machine_that_is_switched_off_is_meant_to_come_to_rest(change: str) -> None:
    """Whatever the spaces, rest is a warning then, no finding."""
    switch = ("--switch", f"2 s: {change}")
    done = invoke("transient", CARTS, "--duration", "200 s", *switch, "--accuracy", "1e-6", "--json")
    assert not any("rest" in line for line in json.loads(done.stdout)["findings"])


@pytest.mark.parametrize(
    ("machine", "text", "words"),
    [
        (CARTS, "2 s", "expected TIME and what changes then"),
        (CARTS, "2 s: motor=slow", 'motor: found "slow", expected on or off'),
        (CARTS, "9 s: motor=off", "expected increasing times above 0"),
        ("roller_two_carts", "2 s: motor=off", "found a rigid driveline"),
    ],
)
def test_a_switch_that_cannot_be_is_refused(machine: str, text: str, words: str) -> None:
    """Exit code 2 and what was expected."""
    done = invoke("transient", machine, "--duration", "5 s", "--switch", text)
    assert done.exit_code == 2
    assert words in done.stderr
