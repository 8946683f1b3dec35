"""``linkwright plot``: curves by name, from a dead centre, as picture and table."""

from __future__ import annotations

import csv
import json
import re
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from command_line import invoke

import linkwright as lw
from linkwright import study
from linkwright.app.curves import chosen, curves_figure
from linkwright.kernel.command.console import _head
from linkwright.kernel.page.table import Table

PRESS = Path(__file__).parents[2] / "examples" / "press_with_flywheel" / "machine.toml"


run = partial(invoke, "plot", PRESS)


def test_a_press_from_its_top(tmp_path: Path) -> None:
    """s = −r cos θ + √(l² − r² sin² θ), and its derivative times the steady speed."""
    table, picture = tmp_path / "ram.csv", tmp_path / "ram.png"
    words = ("ram.position", "ram.velocity", "motion.speed", "--zero", "top", "--units", "mm,deg")
    done = run(*words, "--out", str(table), "--out", str(picture))
    assert done.exit_code == 0, done.output
    rows = list(csv.DictReader(table.read_text(encoding="utf-8").splitlines()))
    theta = np.radians([float(row["crank_angle [°]"]) for row in rows])
    place = np.array([float(row["motion.ram.place [mm]"]) for row in rows])
    velocity = np.array([float(row["motion.ram.place.velocity [mm/s]"]) for row in rows])
    speed = np.array([float(row["motion.speed [rad/s]"]) for row in rows])
    root = np.sqrt(500**2 - (80 * np.sin(theta)) ** 2)
    assert place == pytest.approx(-80 * np.cos(theta) + root, abs=1e-9)
    slope = 80 * np.sin(theta) - 80**2 * np.sin(theta) * np.cos(theta) / root
    assert velocity == pytest.approx(slope * speed, abs=1e-8)
    assert theta[[0, -1]] == pytest.approx([0.0, 2 * np.pi])
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_extremes_are_exact_and_counted_from_the_top() -> None:
    """In steady motion: those of `cycle_motion`, wherever angles are counted from."""
    found = lw.cycle_motion(lw.read(PRESS)).extremes["ram.place.velocity"]
    words = ("ram.velocity", "--zero", "top", "--json")
    told = json.loads(run(*words).stdout)["results"]["plot"]["curves"]["motion.ram.place.velocity"]
    assert told["is_exact"]
    assert (told["minimum"], told["maximum"]) == pytest.approx((found.minimum, found.maximum), rel=1e-12)
    assert told["maximum_at"] == pytest.approx(found.maximum_angle - np.pi / 2, abs=1e-6)
    assert told["minimum_at"] == pytest.approx(found.minimum_angle - np.pi / 2, abs=1e-6)


def test_over_another_curve_and_json() -> None:
    done = run("ram.velocity", "--over", "ram.place", "--json")
    found = json.loads(done.stdout)["results"]["plot"]["curves"]["motion.ram.place.velocity"]
    assert (found["over"], found["over_unit"], found["unit"]) == ("ram.place", "m", "m/s")
    assert min(found["x"]) == pytest.approx(0.42, abs=1e-6)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("ram.speeds",), "found no curve"),
        (("ram.place", "run_up.speed"), "draw them separately"),
        (("ram.place", "--out", "a.bmp"), ".png, .svg, .pdf, .csv"),
    ],
)
def test_wrong_input(words: tuple[str, ...], said: str) -> None:
    done = run(*words)
    assert done.exit_code == 2
    assert said in done.stderr


def test_one_angle_for_all_and_the_force_of_the_load(tmp_path: Path) -> None:
    """Curves of analyses with grids of their own stand in one table."""
    table = tmp_path / "ram.csv"
    words = ("ram.place", "loads.work", "steady_state.speed", "--zero", "top", "--units", "mm,rpm,kN")
    done = run(*words, "--out", str(table))
    assert done.exit_code == 0, done.output
    rows = list(csv.reader(table.read_text(encoding="utf-8").splitlines()))
    heads = ["motion.ram.place [mm]", "forces.loads.work [kN]", "steady_state.speed [rpm]"]
    assert rows[0] == ["crank_angle [°]", *heads]
    assert [row[0] for row in rows[1:4]] == ["0.0", "1.0", "2.0"]
    place, force, speed = (np.array([float(row[k]) for row in rows[1:]]) for k in (1, 2, 3))
    table_of_file = lw.read(PRESS).loads["work"]
    ahead = np.interp(place / 1e3, table_of_file.position, table_of_file.forward)  # type: ignore[union-attr]
    going_down = np.arange(len(place)) < len(place) // 2
    # Downward the force is against the motion; upward there is none. It rises by 30 kN in a millimetre, of
    # which the table has nine decimals.
    assert force == pytest.approx(np.where(going_down, -ahead / 1e3, 0.0), abs=3e-8)
    steady = lw.steady_state(lw.read(PRESS))
    assert speed.max() <= steady.speed_max * 30 / np.pi
    assert speed.min() >= steady.speed_min * 30 / np.pi
    assert "rpm" in done.stdout.split("Values")[1]


def test_the_list_of_curves_is_whole() -> None:
    told = run()
    listed = json.loads(run("--json").stdout)["results"]["curves"]
    assert all(name in told.stdout for name in listed)
    assert "more rows" not in told.stdout


def test_what_is_rounding_beside_other_places_is_zero(tmp_path: Path) -> None:
    """The ram moves along a vertical guide through the shaft: its x is rounding of cos 90°."""
    table = tmp_path / "x.csv"
    done = run("motion.ram.x", "--units", "mm", "--out", str(table))
    assert done.exit_code == 0, done.output
    rows = list(csv.DictReader(table.read_text(encoding="utf-8").splitlines()))
    assert {row["motion.ram.x [mm]"] for row in rows} == {"0.0"}
    assert "·10" not in done.stdout


def test_axes_legends_and_heads_say_what_they_hold() -> None:
    """An axis has words and a unit; a table says position and velocity, not the keys of a file."""
    study_of = study(lw.read(PRESS))
    curves = chosen(
        study_of, ["ram.place", "ram.velocity", "steady_state.torque_drive", "ram.rod.angle.velocity"]
    )
    assert [curve.words for curve in curves] == [
        "ram, position",
        "ram, velocity",
        "driving torque at the crank",
        "ram.rod, angular velocity",
    ]
    axes = curves_figure(curves).axes
    assert [one.get_ylabel() for one in axes] == [
        "position [m]",
        "velocity [m/s]",
        "torque [N m]",
        "speed [rad/s]",
    ]
    told = run("ram.velocity").stdout
    assert "crank angle" in told
    assert "_" not in told.split("WARNING")[0]


def test_the_report_of_a_plot_speaks_ukrainian(tmp_path: Path) -> None:
    page = tmp_path / "ram.html"
    words = ["report", "--lang", "uk", "--to", str(page), "plot", str(PRESS), "ram.velocity", "--zero", "top"]
    done = invoke(*words)
    assert done.exit_code == 0, done.output
    text = page.read_text(encoding="utf-8")
    for english in ("Extremes", "Values", "crank angle", "Crank angles", ", velocity", "curve<"):
        assert english not in re.sub(r"<(script|style).*?</\1>|<code.*?</code>", "", text, flags=re.DOTALL)


def test_the_name_of_a_part_stays_in_one_line_of_a_head() -> None:
    table = Table("harmonics", "Harmonics", ("order", "", "starboard_throw_1", "excess after it"), [])
    assert [_head(table, n) for n in (2, 3)] == ["starboard_throw_1", "excess after\nit"]
