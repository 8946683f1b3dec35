"""`linkwright cam FILE`: tables, JSON, report and drawings; what cannot be made is reported."""

from __future__ import annotations

import json
import math
from functools import partial
from pathlib import Path

import pytest
from command_line import invoke

ROOT = Path(__file__).parents[2]
ROLLER_CAM = str(ROOT / "machines" / "roller_cam.toml")

GROOVE = """
format = 1
name = "Shuttle"
[drive]
speed = "300 rpm"
[mechanism.cams.shuttle]
closure = "groove"
base_radius = "50 mm"
roller_radius = "10 mm"
offset = "8 mm"
cutter_radius = "6 mm"
width = "12 mm"
sections = [
  { angle = "90 deg", lift = "20 mm", law = "cycloidal" },
  { angle = "60 deg" },
  { angle = "90 deg", lift = "-20 mm", law = "cycloidal" },
  { angle = "120 deg" },
]
[bodies]
shuttle = { mass = "3 kg" }
"""


run = partial(invoke, "cam")


@pytest.fixture
def groove(tmp_path: Path) -> str:
    path = tmp_path / "shuttle.toml"
    path.write_text(GROOVE, encoding="utf-8")
    return str(path)


def test_tables_and_warnings() -> None:
    result = run(ROLLER_CAM)
    assert result.exit_code == 0
    for words in ("Cam cart", "maximum pressure angle", "23.45°", "constant velocity", "0.1538 m/s"):
        assert words in result.output
    assert "The jerk of cam cart jumps at cam angle θ = 0°, 180°" in result.output
    assert "Forces on cam cart" in result.output


def test_json_is_one_object(groove: str, tmp_path: Path) -> None:
    result = invoke("cam", groove, "--json", "--out", tmp_path / "out", "--tolerance", "10 um")
    assert result.exit_code == 0
    found = json.loads(result.stdout)
    assert found["results"]["cam"]["stroke"] == pytest.approx(0.02)
    assert found["results"]["cam_force"]["force_max"] > 0
    drawn = {(Path(each["path"]).name, each["layer"]) for each in found["files"]}
    layers = {"PROFILE", "PROFILE_OUTER", "PITCH_CURVE", "CUTTER_PATH", "CUTTER_PATH_OUTER"}
    assert {layer for name, layer in drawn if name == "shuttle.dxf"} == layers
    assert all(0 <= each["deviation"] <= each["tolerance"] for each in found["files"])
    asked = [each["tolerance"] for each in found["files"] if not each["path"].endswith("csv")]
    assert asked == [pytest.approx(1e-5)] * 10
    assert (tmp_path / "out" / "results.json").read_text(encoding="utf-8") == result.stdout


def test_report_has_figures_and_the_turning_cam(groove: str, tmp_path: Path) -> None:
    result = run(groove, "--out", str(tmp_path / "out"))
    assert result.exit_code == 0
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    for name in ("cam_shuttle", "cam_shuttle_lift", "cam_shuttle_pressure_angle", "cam_shuttle_curvature"):
        assert f'id="figure-{name}"' in page
    assert '"kind":"cam"' in page
    assert "section 1" in page


@pytest.mark.parametrize(("form", "entity"), [("spline", "SPLINE"), ("polyline", "LWPOLYLINE")])
def test_form_and_formats(groove: str, tmp_path: Path, form: str, entity: str) -> None:
    result = run(
        groove, "--out", str(tmp_path / "o"), "--form", form, "--formats", "dxf", "--tolerance", "0.1 mm"
    )
    assert result.exit_code == 0
    assert not list((tmp_path / "o").glob("*.csv"))
    assert entity in (tmp_path / "o" / "shuttle.dxf").read_text(encoding="utf-8")


def test_an_impossible_cam_is_told_and_not_drawn(groove: str, tmp_path: Path) -> None:
    change = (
        "sections.0.angle=20 deg",
        "sections.1.angle=130 deg",
        "roller_radius=40 mm",
        "base_radius=20 mm",
    )
    sets = [part for each in change for part in ("--set", f"mechanism.cams.shuttle.{each}")]
    result = run(groove, *sets, "--out", str(tmp_path / "o"))
    assert result.exit_code == 1
    assert "undercut" in result.output
    assert (tmp_path / "o" / "report.html").exists()
    assert not list((tmp_path / "o").glob("*.dxf"))


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--form", "circles"], '--form: found "circles", expected arcs, spline, cubic, polyline'),
        (["--by", "time"], '--by: found "time", expected cam, polar'),
        (["--formats", "dxf,dwg"], '--formats: found "dwg", expected dxf, csv, svg, step'),
        (["--tolerance", "1 s"], "--tolerance: found"),
        (["--out", "OUT", "--tolerance", "0 mm"], "expected a length greater than 0"),
        (["--out", "OUT", "--step", "0.7 deg"], "step of 0.7°: expected a whole number"),
    ],
)
def test_wrong_options_are_told(groove: str, tmp_path: Path, words: list[str], message: str) -> None:
    result = run(groove, *(str(tmp_path / "o") if word == "OUT" else word for word in words))
    assert result.exit_code == 2
    assert message in result.output


def test_a_machine_without_cams_is_told() -> None:
    result = run(str(ROOT / "machines" / "roller_two_carts.toml"))
    assert result.exit_code == 2
    assert "the machine has no cam" in result.output


def test_conjugate_cams_have_a_drawing_each(groove: str, tmp_path: Path) -> None:
    words = ['closure="conjugate"', 'second={ distance="160 mm", roller_radius="8 mm" }']
    sets = [part for each in words for part in ("--set", f"mechanism.cams.shuttle.{each}")]
    result = run(groove, *sets, "--out", str(tmp_path / "o"))
    assert result.exit_code == 0, result.output
    names = {path.name for path in (tmp_path / "o").glob("[!.]*")}
    assert {"shuttle.dxf", "shuttle_second.dxf", "shuttle_second.csv"} <= names


def test_the_cams_of_a_search_keep_their_limit_between_the_angles_too() -> None:
    """Steps of a tenth of a micrometre about the radius at which the pressure angle is at its limit."""
    done = run("search", ROLLER_CAM, "--vary", "base_radius=0.21694:0.21697:301", "--count", "3", "--json")
    found = json.loads(done.stdout)["results"]["cam_search"]
    assert done.exit_code == 0
    assert len(found["smallest"]) == 3
    for each in found["smallest"]:
        assert each["pressure_angle_max"] <= math.radians(30) * (1 + 1e-12)
    # The angles of the search alone let some pass.
    assert found["n_kept"] > 150


def test_a_search_without_a_cam_that_keeps_its_limit_has_a_finding() -> None:
    done = run("search", ROLLER_CAM, "--vary", "base_radius=0.21695:0.21696:11", "--json")
    assert done.exit_code == 1
    found = json.loads(done.stdout)
    assert found["results"]["cam_search"]["n_kept"] > 0
    assert "between the sampled angles" in found["findings"][0]


def test_a_search_shows_the_units_of_the_reader() -> None:
    done = run("search", ROLLER_CAM, "--vary", "base_radius=0.254:0.255:2", "--units", "in")
    assert done.exit_code == 0, done.output
    assert "10 in" in done.stdout
    assert "mm" not in done.stdout


def test_backslashes_in_a_name_are_letters(tmp_path: Path) -> None:
    """They were references of the expression that names the elements of a figure."""
    text = GROOVE.replace("shuttle", "'a\\input'")
    (tmp_path / "cam.toml").write_text(text, encoding="utf-8")
    done = run(str(tmp_path / "cam.toml"), "--out", str(tmp_path / "o"))
    assert done.exit_code == 0, done.output
    assert (tmp_path / "o" / "a_input.dxf").is_file()
