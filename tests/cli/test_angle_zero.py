"""Crank angles counted from a dead centre: the same as of a machine whose crank is turned by that angle."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from command_line import invoke

import linkwright as lw
from linkwright.kernel.figure.style import panels, styled, turn_axis
from linkwright.kernel.reader.angle_zero import Zero, counted_columns, counting
from linkwright.kernel.reader.sentences import sentence

# The top dead centre of its ram is at 90°; nothing but the crank depends on the angle.
PRESS = "press_with_flywheel"
FROM_TOP = ("--zero", "top")
# Crank turned forward: its pin is up where the angle is zero.
TURNED = ("--set", "mechanism.cranks.A.phase=90 deg")


def printed(*words: str) -> str:
    done = invoke(*words)
    assert done.exit_code == 0, done.output
    return done.stdout


def columns(path: Path) -> dict[str, np.ndarray]:
    with path.open() as file:
        head, *rows = csv.reader(file)
    return dict(zip(head, np.array(rows, float).T, strict=True))


@pytest.mark.parametrize("command", ["run", "forces"])
def test_tables_are_those_of_the_turned_crank(command: str) -> None:
    counted = printed(command, PRESS, *FROM_TOP).splitlines()
    turned = printed(command, PRESS, *TURNED).splitlines()
    assert any(line.startswith("Crank angles from the top dead centre of ram, φ = 90°") for line in counted)
    angles = [line.split() for line in counted if "°" in line and "in the file" not in line]
    assert len(angles) > 4
    # Apart from what the solver's own steps change in the last digits.
    numerical = ("Floquet", "accuracy", "steps", "shaking moment")
    for line in turned:
        if "°" in line and not any(word in line for word in numerical):
            assert line.split() in angles


def test_curves_begin_at_the_dead_centre(tmp_path: Path) -> None:
    printed("run", PRESS, *FROM_TOP, "--out", str(tmp_path / "counted"))
    printed("run", PRESS, *TURNED, "--out", str(tmp_path / "turned"))
    for name in ("steady_state.csv", "motion.csv", "forces.csv", "reduction.csv"):
        counted, turned = columns(tmp_path / "counted" / name), columns(tmp_path / "turned" / name)
        assert counted.keys() == turned.keys()
        for head, values in turned.items():
            # Solved to 1e-10, from another start; curves that are zero but for rounding beside the largest.
            scale = max(np.abs(values).max(), 1e-6 * max(np.abs(other).max() for other in turned.values()))
            assert np.allclose(counted[head], values, rtol=0, atol=1e-7 * scale), (name, head)


def test_programs_get_the_angles_of_the_file() -> None:
    counted, plain = (json.loads(printed("run", PRESS, "--json", *more)) for more in (FROM_TOP, ()))
    assert counted.pop("angle_zero") == pytest.approx(np.pi / 2, abs=1e-9)
    assert counted.pop("zero") == "top dead centre of ram"
    assert counted == plain


def test_a_dead_centre_that_is_unknown_is_refused() -> None:
    done = invoke("run", PRESS, "--zero", "left")
    assert done.exit_code == 2
    assert "expected one of outer, inner, top, bottom" in done.stderr


TOP = Zero(np.pi / 2, "top dead centre of ram", 2 * np.pi)


def test_angles_within_the_cycle() -> None:
    assert TOP.counted(np.pi / 2) == 0
    # Rounding of the search for the dead centre is no full revolution.
    assert TOP.counted(np.pi / 2 - 1e-9) == 0
    assert TOP.counted(0) == pytest.approx(1.5 * np.pi)
    assert TOP._replace(cycle=4 * np.pi).counted(0) == pytest.approx(3.5 * np.pi)
    # A rocking drive does not come round.
    assert TOP._replace(cycle=0.0).counted(0) == pytest.approx(-np.pi / 2)
    assert Zero().counted(0.3) == 0.3


@pytest.mark.parametrize("start", [0.0, 0.0123, -3.0])
@pytest.mark.parametrize("samples", [7, 360])
def test_rows_over_a_cycle(start: float, samples: int) -> None:
    angle = start + np.linspace(0, 2 * np.pi, samples + 1)
    rows = {
        "crank_angle [rad]": angle,
        "time [s]": 0.1 * (angle - start),
        "wheel [rad]": -3 * angle,
        "force [N]": np.cos(angle),
    }
    with counting(TOP):
        shown = counted_columns(rows)
    phi = shown["crank_angle [rad]"]
    assert len(phi) == samples + 1
    assert 0 <= phi[0] < 2 * np.pi / samples + 1e-9
    assert np.allclose(np.diff(phi), 2 * np.pi / samples, atol=1e-12)
    assert np.allclose(shown["force [N]"], np.cos(phi + np.pi / 2), atol=1e-12)
    assert np.allclose(shown["time [s]"], 0.1 * (phi - phi[0]), atol=1e-12)
    assert np.allclose(np.diff(shown["wheel [rad]"]), -6 * np.pi / samples, atol=1e-12)


def test_a_motion_from_rest_keeps_its_rows() -> None:
    angle = np.linspace(0, 2 * np.pi, 5)
    with counting(TOP):
        shown = counted_columns({"crank_time [s]": np.arange(5.0), "crank_angle [rad]": angle})
    assert np.array_equal(shown["crank_angle [rad]"], angle - np.pi / 2)


@styled
def _drawn(turns: int):
    figure, (upper, lower) = panels(2, height=3)
    # The zero lies between two of the samples.
    degrees = np.linspace(0, 360 * turns, 217)
    for axes in (upper, lower):
        axes.plot(degrees, np.cos(np.radians(degrees / turns)))
        axes.plot([0], [1.0], "o")
        axes.axhline(0.5)
    turn_axis(upper, degrees, label=False)
    turn_axis(lower, degrees)
    return figure


@pytest.mark.parametrize("turns", [1, 2])
def test_figures_begin_at_the_dead_centre(turns: int) -> None:
    with counting(TOP._replace(angle=1.0, cycle=2 * np.pi * turns)):
        figure = _drawn(turns)
    assert figure.axes[-1].get_xlabel() == "crank angle φ from the top dead centre of ram [°]"
    for axes in figure.axes:
        curve, dot, level = axes.get_lines()
        x = np.radians(np.asarray(curve.get_xdata(), float))
        assert x[[0, -1]] == pytest.approx([0, 2 * np.pi * turns])
        assert np.all(np.diff(x) > 0)
        # Chords between samples.
        assert np.allclose(curve.get_ydata(), np.cos((x + 1.0) / turns), atol=2e-3)
        assert dot.get_xdata() == pytest.approx([360 * turns - np.degrees(1.0)])
        assert list(level.get_xdata()) == [0, 1]
        assert axes.get_xlim() == (0, 360 * turns)


def test_sentences_count_from_the_dead_centre() -> None:
    with counting(TOP):
        assert sentence("It stalls at φ = 120.5° with 3 N m.") == "It stalls at φ = 30.5° with 3 N m."
        assert sentence("at crank angle 12°, 100° to 95°: no force") == (
            "at crank angle 282°, 10° to 5°: no force"
        )
        assert sentence("an angle of 90° is ideal") == "an angle of 90° is ideal"
        # As `:.4g` writes a root next to zero.
        assert sentence("no force at crank angle 1e-05°") == "no force at crank angle 270°"


@pytest.mark.parametrize(
    ("said", "shown"),
    [
        # Rounded to four digits, which do not tell 1000 from 999.8.
        ("up to 104.7 rad/s, 6.902 rad/s", "up to 1000 rpm, 65.91 rpm"),
        ("1 m apart, 0.25 m wide, 1e-05 m off", "1000 mm apart, 250 mm wide, 0.01 mm off"),
        ("−1.25·10⁴ N, 3 N m", "−12.5 kN, 3 N m"),
        ("12 N/m, 0.34 kg m², 9.81 m/s²", "12 N/m, 0.34 kg m², 9810 mm/s²"),
        ("type AIR 5.5 kW 6-pole gives 5.5 kW", "type AIR 5.5 kW 6-pole gives 5500 W"),
        ("after 3 s", "after 3 s"),
    ],
)
def test_sentences_in_units(said: str, shown: str) -> None:
    with lw.shown_in("mm, rpm, kN, W"):
        assert sentence(said) == shown


def test_warnings_are_in_the_units_of_the_reader() -> None:
    plain = printed("run", PRESS)
    shown = printed("run", PRESS, "--units", "rpm")
    assert "design speed of 6.283 rad/s" in " ".join(plain.split())
    assert "design speed of 60 rpm" in " ".join(shown.split())
    said = json.loads(printed("run", PRESS, "--units", "rpm", "--json"))["warnings"]
    assert any("6.283 rad/s" in text for text in said)
