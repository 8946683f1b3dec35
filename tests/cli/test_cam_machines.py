"""Commands on machines with cams: exit codes, what is reported, entries and sections given with ``--set``."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from click.testing import Result
from command_line import invoke

ROLLER_CAM = Path(__file__).parents[2] / "machines" / "roller_cam.toml"

VALVE = """
format = 1
name = "Valve"
[drive]
speed = "100 rad/s"
[mechanism.cams.valve]
base_radius = "30 mm"
roller_radius = "8 mm"
direction = "90 deg"
sections = [
  { angle = "60 deg", lift = "8 mm" },
  { angle = "60 deg", lift = "-8 mm" },
  { angle = "240 deg" },
]
[bodies]
valve = { mass = "0.2 kg" }
[mechanism.points]
top = { x = 0, y = "150 mm" }
[loads]
spring = { kind = "spring", between = ["valve", "top"], stiffness = "20 N/mm", free_length = "150 mm" }
"""


@pytest.fixture
def valve(tmp_path: Path) -> Path:
    path = tmp_path / "valve.toml"
    path.write_text(VALVE, encoding="utf-8")
    return path


def command(*arguments: str | Path) -> Result:
    done = invoke(*arguments)
    assert done.exception is None or isinstance(done.exception, SystemExit), done.exception
    return done


def cam(*arguments: str | Path) -> dict[str, Any]:
    done = command("run", *arguments, "--json")
    return json.loads(done.stdout, parse_constant=pytest.fail)["results"]["cam"]  # type: ignore[no-any-return]


def test_sound_machines_pass_their_checks(valve: Path) -> None:
    for path in (valve, ROLLER_CAM):
        assert command("check", path).exit_code == 0
    assert command("run", valve).exit_code == 0


def test_run_tells_what_the_paper_does() -> None:
    """v = 15 Δx/(13 t_3) for 0.4 m in 3 s, and a diameter that is the distance of the followers."""
    found = cam(ROLLER_CAM)
    assert found["speed_constant"] == pytest.approx(0.1538461538, abs=1e-10)
    assert found["diameter_max"] - found["diameter_min"] < 1e-12
    for name in ("acceleration_max", "jerk_max", "pressure_angle_max", "curvature_radius_min"):
        assert found[name] is not None


def test_entries_of_cams_are_set(valve: Path) -> None:
    plain = cam(valve)
    wider = cam(valve, "--set", "mechanism.cams.valve.base_radius=45 mm")
    assert wider["base_radius"] == pytest.approx(0.045)
    assert wider["pressure_angle_max"] < plain["pressure_angle_max"]


def test_sections_are_set(valve: Path) -> None:
    lifts = ("--set", "mechanism.cams.valve.sections.0.lift=6 mm")
    lifts += ("--set", "mechanism.cams.valve.sections.1.lift=-6 mm")
    assert cam(valve, *lifts)["stroke"] == pytest.approx(0.006)
    law = cam(valve, "--set", "mechanism.cams.valve.sections.0.law=cycloidal")
    # C_a = 2π of the cycloidal law, 5.7735 of the quintic on the other flank.
    assert law["acceleration_max"] == pytest.approx(6.283185 * 0.008 * (3 / 3.14159265) ** 2 * 1e4, rel=1e-6)


def test_sections_that_do_not_close_are_told(valve: Path) -> None:
    done = command("run", valve, "--set", "mechanism.cams.valve.sections.0.lift=6 mm")
    assert done.exit_code == 2
    assert "lifts that add to -0.002 m" in done.stderr
    done = command("check", valve, "--set", "mechanism.cams.valve.sections.7.lift=6 mm")
    assert done.exit_code == 2
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize(
    ("entries", "words"),
    [
        (['contact="flat"', "roller_radius"], "undercut"),
        (["roller_radius=40 mm", "base_radius=1 mm"], "undercut"),
        (['closure="constant_diameter"'], "constant diameter"),
    ],
)
def test_impossible_cams_are_findings(tmp_path: Path, entries: list[str], words: str) -> None:
    text = VALVE
    for entry in entries:
        if entry == "roller_radius":
            text = (
                text.replace('roller_radius = "8 mm"\n', "").replace('"8 mm"', '"16 mm"').replace("-8", "-16")
            )
    path = tmp_path / "machine.toml"
    path.write_text(text, encoding="utf-8")
    sets = [x for entry in entries if "=" in entry for x in ("--set", f"mechanism.cams.valve.{entry}")]
    done = command("run", path, *sets)
    assert done.exit_code == 1
    assert words in done.stdout + done.stderr


def test_motion_and_forces(valve: Path, tmp_path: Path) -> None:
    done = command("motion", valve, "--json")
    assert done.exit_code == 0
    assert "valve" in done.stdout
    done = command("forces", valve, "--speed", "100 rad/s")
    assert done.exit_code == 0, done.stderr
    assert "valve" in done.stdout


def test_schema_knows_cams(tmp_path: Path) -> None:
    done = command("schema")
    assert done.exit_code == 0
    schema = json.loads(done.stdout)
    jsonschema.validate(tomllib.loads(VALVE), schema)
    jsonschema.validate(tomllib.loads(ROLLER_CAM.read_text(encoding="utf-8")), schema)
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(tomllib.loads(VALVE.replace("base_radius", "base")), schema)
