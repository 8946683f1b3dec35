"""Tables of controllers and measured ones as laws of a machine file."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest

import linkwright as lw
from linkwright.axes.export.exported import exported, law_of
from linkwright.axes.export.formats import FORMATS
from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.kernel.errors import MachineError, MachineFileError
from linkwright.kernel.files.cam_tables import controller_table

MACHINE = """
format = 1
name = "Table"
[mechanism.cams.feed]
base_radius = "60 mm"
roller_radius = "10 mm"
sections = [ {{ {section} }} ]
"""
OWN = """angle = "120 deg", lift = "20 mm" }, { angle = "60 deg" },
{ angle = "100 deg", lift = "-20 mm" }, { angle = "80 deg\""""
TABLE = 'angle = "360 deg", law = {{ kind = "table", file = "law.txt"{more} }}'
COLUMNS = ', columns = "angle [deg], lift [mm]"'


def law(section: str) -> MotionLaw:
    return law_of(lw.loads(MACHINE.format(section=section.replace("\n", " ")))).law


def read(folder: Path, text: str, more: str = "") -> MotionLaw:
    """The law of a machine whose cam has a table in a file of this text."""
    (folder / "law.txt").write_text(text, encoding="utf-8")
    (folder / "m.toml").write_text(MACHINE.format(section=TABLE.format(more=more)), encoding="utf-8")
    return law_of(lw.read(folder / "m.toml")).law


def deviations(one: MotionLaw, other: MotionLaw) -> list[float]:
    x = np.linspace(0.0, 2 * math.pi, 2001)[1:-1]
    return [float(np.abs(one.at(x, order) - other.at(x, order)).max()) for order in range(3)]


@pytest.mark.parametrize("name", ["csv", "codesys-xyva", "beckhoff", "siemens"])
def test_points_with_derivatives_come_back_as_the_law(name: str, tmp_path: Path) -> None:
    """A law that goes out with velocities and accelerations, and comes in again, is the same to rounding."""
    own = law(OWN)
    text = exported(law_of(lw.loads(MACHINE.format(section=OWN.replace("\n", " ")))), FORMATS[name]).text
    s, v, a = deviations(own, read(tmp_path, text))
    assert s < 1e-14
    assert v < 1e-12
    # Differences of positions a degree apart, to rounding, over the square of the degree.
    assert a < 1e-9


@pytest.mark.parametrize(
    ("name", "more", "most"),
    [
        ("siemens-table", "", 1e-9),
        ("tab", "", 1e-7),
        ("sew-cubic", COLUMNS, 1e-9),
        ("rockwell", "", 1e-8),
    ],
)
def test_tables_come_back_near_the_law(name: str, more: str, most: float, tmp_path: Path) -> None:
    """Tables of positions come in as a cubic spline through their points, whatever wrote them [m]."""
    text = exported(law_of(lw.loads(MACHINE.format(section=OWN.replace("\n", " ")))), FORMATS[name]).text
    assert deviations(law(OWN), read(tmp_path, text, more))[0] < most


def test_the_default_cam_of_codesys(tmp_path: Path) -> None:
    """A foreign XYVA array, here quintics of rest, motion, motion, rest, needs only its units."""
    points = [(0, 0, 0, 0), (120, 40, 0.5, 0), (240, 40, -0.5, 0), (360, 0, 0, 0)]
    rows = ", ".join(f"(dX := {x}, dY := {y}, dV := {v}, dA := {a})" for x, y, v, a in points)
    text = f"VAR_GLOBAL (* by hand *)\nCam_A : ARRAY[0..3] OF SMC_CAMXYVA := [{rows}];\nEND_VAR\n"
    heads = "angle [deg], lift [mm], velocity [mm/deg], acceleration [mm/deg^2]"
    found = read(tmp_path, text, f', columns = "{heads}"')
    # Between equal ends with velocities ±v over L: the middle is v·L·5/16 above.
    assert found.value(math.pi) == pytest.approx(0.04 + 5 / 16 * 0.5e-3 * 120, rel=1e-12)


def test_decimal_commas_and_semicolons(tmp_path: Path) -> None:
    """Pairs apart by a semicolon may have decimal commas."""
    x = np.linspace(0.0, 360.0, 25)
    rows = [f"{a:.1f};{10 - 10 * math.cos(math.radians(a)):.6f}".replace(".", ",") for a in x]
    found = read(tmp_path, "\n".join(["25", *rows]), COLUMNS)
    assert found.value(math.pi) == pytest.approx(0.02, abs=1e-8)


def test_a_measured_file_without_a_header(tmp_path: Path) -> None:
    """Columns of a file without a header are named in the machine file."""
    rows = [f"{a}, {10 - 10 * math.cos(math.radians(a)):.9f}" for a in range(0, 361, 5)]
    found = read(tmp_path, "\n".join(rows), COLUMNS)
    assert found.value(math.pi) == pytest.approx(0.02, abs=1e-8)


def noisy(sigma: float) -> str:
    rng = np.random.default_rng(1)
    y = 10 - 10 * np.cos(np.radians(np.arange(361))) + sigma * rng.normal(size=361)
    y[[0, -1]] = 0.0
    return "\n".join(["angle [deg], lift [mm]", *(f"{x}, {s:.9f}" for x, s in enumerate(y))])


def test_noise_is_refused(tmp_path: Path) -> None:
    """A record whose slope turns at every other point has no acceleration, and is refused with a remedy; as a
    table of straight lines it is taken, and so is one with noise that does not turn the slope.
    """
    with pytest.raises(
        MachineFileError, match=r"(?s)law\.txt:\d+.*slope turns at \d+ of 358 points"
    ) as error:
        read(tmp_path, noisy(0.05))
    assert "smooth the record" in str(error.value)
    read(tmp_path, noisy(0.05), ", degree = 1")
    read(tmp_path, noisy(1e-5))


@pytest.mark.parametrize(
    ("text", "more", "words"),
    [
        ("3\n0\t0\n200\t5\n100\t1\n", COLUMNS, 'law.txt:4: .*found: +"100 deg".*more than 200 deg'),
        ("3\n0\t0\n200\t5\n", COLUMNS, "law.txt:1: .*found: +2 points.*expected: 3, as its head says"),
        ("1\n0\t0\n", COLUMNS, "law.txt:1: .*at least 2 values"),
        ("2\n0\t0\n360 deg\n", COLUMNS, 'law.txt:3: .*column lift.*found: +"deg"'),
        ("2\n0\t0\n1\t2\t3\n", COLUMNS, 'law.txt:3: .*found: +"1,2,3".*2 values'),
        ("2\n0\t0\n360\t0\n", "", 'law.txt:1: .*without units.*columns = "angle'),
        ("2\n0\t0\n360\t0\n", ", columns = 3", "law.columns.*found: +3"),
        ("Lines = 2\nBegintable\n0 0\nx 3\nEndTable\n", "", 'law.txt:4: .*column angle.*found: +"x"'),
        ("Lines = 9\nBegintable\n0 0\n5 3\nEndTable\n", "", "law.txt:1: .*found: +2 points.*9, as its head"),
        ("Begintable\nEndTable\n", "", "law.txt:1: .*no rows below the header"),
    ],
)
def test_errors_in_files_have_their_lines(text: str, more: str, words: str, tmp_path: Path) -> None:
    """Errors in a file of a controller have the file, its line and what belongs there."""
    with pytest.raises(MachineFileError) as error:
        read(tmp_path, text, more)
    assert re.search(words, str(error.value), re.DOTALL), str(error.value)


POINTS = 'angle = "0, 180, 360 deg", lift = "0, 20, 0 mm"'


@pytest.mark.parametrize(
    ("entries", "words"),
    [
        ('velocity = "0, 0 mm/deg"', "3 values"),
        ('acceleration = "0, 1, 0 mm/deg^2"', "law.velocity"),
        ('velocity = "0, 0, 0 mm/deg", degree = 3', "law.degree"),
        ('swing_velocity = "0, 0, 0"', "law.swing_velocity"),
        ('velocity = "0.1, 0, 0 mm/deg"', "a velocity of 0 at its start"),
        ('columns = "angle [deg]"', "law.columns"),
    ],
)
def test_derivatives_that_do_not_fit(entries: str, words: str) -> None:
    """Lists of derivatives are as long as the points, complete from the first, and meet the neighbours."""
    section = f'angle = "360 deg", law = {{ kind = "table", {POINTS}, {entries} }}'
    with pytest.raises(MachineError, match=words):
        law(section)


def test_tables_with_velocities_alone_are_cubics() -> None:
    """Points with velocities are joined by cubics: a rise between rests is 3z² − 2z³."""
    section = f'angle = "360 deg", law = {{ kind = "table", {POINTS}, velocity = "0, 0, 0 mm/deg" }}'
    z = 0.3
    assert law(section).value(z * math.pi) == pytest.approx(0.02 * (3 * z**2 - 2 * z**3), rel=1e-12)


@pytest.mark.parametrize("part", ["(*", "(a := 1,", "x[1].y := ", "x", "1[1].y:=1;"])
def test_reading_takes_linear_time(part: str) -> None:
    """A hundred thousand parts that lead nowhere are read in one pass; their square would take hours."""
    controller_table(part * 100_000 + ":=")
