"""Laws as cam tables of motion controllers: what is stated of each format is what the text says.

The texts are read and interpolated here once more, by formulas of this file, and compared with closed forms.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from command_line import invoke
from numpy.polynomial import Polynomial

import linkwright as lw
from linkwright.axes.export.exported import LawExport, MasterLaw, exported, law_of
from linkwright.axes.export.formats import FORMATS
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import ExchangeError, InputError

MACHINE = """
format = 1
name = "Feeder (*test*)"
[mechanism.cams.quintic]
base_radius = "60 mm"
roller_radius = "10 mm"
sections = [
  { angle = "120 deg", lift = "20 mm" },
  { angle = "60 deg" },
  { angle = "100 deg", lift = "-20 mm" },
  { angle = "80 deg" },
]
[mechanism.cams.cycloid]
base_radius = "60 mm"
roller_radius = "10 mm"
sections = [
  { angle = "150 deg", lift = "30 mm", law = "cycloidal" },
  { angle = "210 deg", lift = "-30 mm", law = "cycloidal" },
]
[mechanism.cams.parabola]
base_radius = "60 mm"
roller_radius = "10 mm"
phase = "30 deg"
sections = [
  { angle = "120 deg", lift = "20 mm", law = "parabolic" },
  { angle = "60 deg" },
  { angle = "180 deg", lift = "-20 mm", law = "parabolic" },
]
[mechanism.cams.rocker]
follower = "oscillating"
base_radius = "60 mm"
roller_radius = "10 mm"
arm_pivot = "P"
arm_length = "120 mm"
sections = [
  { angle = "180 deg", swing = "20 deg" },
  { angle = "180 deg", swing = "-20 deg" },
]
[mechanism.points.P]
x = "150 mm"
y = "0 mm"
"""


@pytest.fixture(scope="module")
def machine() -> lw.Machine:
    return lw.loads(MACHINE)


# -- the laws in closed form: value and two derivatives over the master angle in degrees, in mm --------------

Law = Callable[[Floats], Floats]


def stretches(*parts: tuple[float, float, Callable[[Floats], Floats]], start: float = 0.0) -> Law:
    """A programme of sections: angle [deg], lift [mm], and s(z), s'(z), s''(z), from a master angle on."""

    def law(x: Floats) -> Floats:
        rows, at, level = np.zeros((3, len(x))), 0.0, 0.0
        place = np.mod(x - start, 360.0)
        place[(place == 0.0) & (x > start)] = 360.0
        for angle, lift, shape in parts:
            here = (place >= at) & (place <= at + angle)
            s, v, a = shape((place[here] - at) / angle)
            rows[:, here] = level + lift * s, lift * v / angle, lift * a / angle**2
            at, level = at + angle, level + lift
        return rows

    return law


def quintic(z: Floats) -> Floats:
    return np.array(
        [z**3 * (10 - 15 * z + 6 * z**2), 30 * z**2 * (1 - z) ** 2, 60 * z * (1 - z) * (1 - 2 * z)]
    )


def cycloid(z: Floats) -> Floats:
    w = 2 * np.pi
    return np.array([z - np.sin(w * z) / w, 1 - np.cos(w * z), w * np.sin(w * z)])


def parabola(z: Floats) -> Floats:
    first = z < 0.5
    return np.where(first, [2 * z**2, 4 * z, 4 + 0 * z], [1 - 2 * (1 - z) ** 2, 4 * (1 - z), -4 + 0 * z])


def dwell(z: Floats) -> Floats:
    return np.zeros((3, len(z)))


LAWS: dict[str, Law] = {
    "quintic": stretches((120, 20, quintic), (60, 0, dwell), (100, -20, quintic), (80, 0, dwell)),
    "cycloid": stretches((150, 30, cycloid), (210, -30, cycloid)),
    "parabola": stretches((120, 20, parabola), (60, 0, dwell), (180, -20, parabola), start=30.0),
}


# -- the texts, read by this file ----------------------------------------------------------------------------

NUMBER = r"(-?\d[\d.]*(?:[eE]-?\d+)?)"


def fields(text: str, *names: str) -> Floats:
    """Numbers behind the names of fields, a column each."""
    return np.array([[float(n) for n in re.findall(rf"\b{name} := {NUMBER}", text)] for name in names])


def pairs(text: str) -> Floats:
    return np.array([[float(n) for n in line.split()] for line in text.splitlines()[1:]]).T


def tab(text: str) -> Floats:
    inside = text.partition("Begintable\n")[2].partition("EndTable")[0]
    x, y = np.array([[int(n) for n in line.split()] for line in inside.splitlines()]).T * 1e-4
    return np.array([np.append(x, 360.0), np.append(y, y[0])])


def beckhoff_table(text: str) -> Floats:
    inside = text.partition(":= [")[2].partition("]")[0]
    return np.array([float(n) for n in inside.split(",")]).reshape(-1, 2).T


TEXTS: dict[str, Callable[[str], Floats]] = {
    "csv": lambda text: np.array(
        [[float(cell) for cell in line.split(",")] for line in text.splitlines()[1:]]
    ).T[:4],
    "codesys-xyva": lambda text: fields(text, "dX", "dY", "dV", "dA"),
    "beckhoff": lambda text: fields(text, "MasterPos", "SlavePos", "SlaveVelo", "SlaveAcc"),
    "beckhoff-table": beckhoff_table,
    "siemens": lambda text: fields(
        text, "leadingValue", "followingValue", "velocityRatio", "accelerationRatio"
    ),
    "siemens-table": lambda text: fields(text, "x", "y"),
    "tab": tab,
    "sew-linear": pairs,
    "sew-cubic": pairs,
    "sew-spline": pairs,
    "rockwell": lambda text: fields(text, "Master", "Slave"),
}


# -- controllers, by this file: value and two derivatives at master angles -----------------------------------


def pieces(x: Floats, at: Floats, made: Callable[[int], Polynomial]) -> Floats:
    """What a polynomial for each interval, over the distance from its start, gives."""
    where = np.clip(np.searchsorted(x, at, side="right") - 1, 0, len(x) - 2)
    rows = np.zeros((3, len(at)))
    for i in np.unique(where).tolist():
        here, p = where == i, made(i)
        rows[:, here] = [f(at[here] - x[i]) for f in (p, p.deriv(1), p.deriv(2))]
    return rows


def by_ends(h: float, start: list[float], end: list[float]) -> Polynomial:
    """The polynomial with given value and derivatives at 0 and h, from its equations."""
    k = len(start)
    rows = [
        [math.perm(n, order) * u ** (n - order) * h**-order if n >= order else 0.0 for n in range(2 * k)]
        for u in (0.0, 1.0)
        for order in range(k)
    ]
    c = np.linalg.solve(np.array(rows), np.array([*start, *end]))
    return Polynomial(c / h ** np.arange(2 * k))


def quintics(x: Floats, y: Floats, v: Floats, a: Floats, at: Floats) -> Floats:
    return pieces(
        x, at, lambda i: by_ends(x[i + 1] - x[i], [y[i], v[i], a[i]], [y[i + 1], v[i + 1], a[i + 1]])
    )


def lines(x: Floats, y: Floats, at: Floats) -> Floats:
    return pieces(x, at, lambda i: by_ends(x[i + 1] - x[i], [y[i]], [y[i + 1]]))


def cubics(x: Floats, y: Floats, at: Floats) -> Floats:
    """Slopes of the parabola through each point and its neighbours, over the end too."""
    far = np.concatenate([[x[-2] - 360], x, [x[1] + 360]])
    high = np.concatenate([[y[-2] - y[-1] + y[0]], y, [y[1] - y[0] + y[-1]]])
    v = [Polynomial.fit(far[i : i + 3], high[i : i + 3], 2).deriv()(x[i]) for i in range(len(x))]
    return pieces(x, at, lambda i: by_ends(x[i + 1] - x[i], [y[i], v[i]], [y[i + 1], v[i + 1]]))


def splines(x: Floats, y: Floats, at: Floats) -> Floats:
    """The periodic cubic spline, from the equations of its second derivatives at the points."""
    h, n = np.diff(x), len(x) - 1
    slope = np.diff(y) / h
    rows, right = np.zeros((n, n)), np.zeros(n)
    for i in range(n):
        before, after = h[i - 1], h[i]
        rows[i, i - 1] += before / 6
        rows[i, i] += (before + after) / 3
        rows[i, (i + 1) % n] += after / 6
        right[i] = slope[i] - slope[i - 1]
    m = np.linalg.solve(rows, right)
    m = np.append(m, m[0])

    def made(i: int) -> Polynomial:
        v = slope[i] - h[i] * (2 * m[i] + m[i + 1]) / 6
        return Polynomial([y[i], v, m[i] / 2, (m[i + 1] - m[i]) / (6 * h[i])])

    return pieces(x, at, made)


def cam_builder(text: str, at: Floats) -> Floats:
    found = re.findall(r"Poly[57]_Coeffs\(([^)]*)\)", text)
    rows = [[float(n) for n in row.split(",")] for row in found]
    x = np.array([row[0] for row in rows] + [rows[-1][1]])
    return pieces(x, at, lambda i: Polynomial(rows[i][2:]))


def controlled(name: str, text: str, at: Floats) -> Floats:
    """What the controller of a format makes of a text."""
    if name == "codesys":
        return cam_builder(text, at)
    columns = TEXTS[name](text)
    how = {"quintic": quintics, "linear": lines, "cubic": cubics, "spline": splines}
    return how[FORMATS[name].interpolation](*columns, at)


def grid(export: LawExport, law: Law) -> Floats:
    """Master angles all over, and those of the stated deviations."""
    stated = [export.position_deviation_angle, export.velocity_deviation_angle]
    places = np.degrees([*stated, export.acceleration_deviation_angle])
    x: Floats = np.concatenate([np.linspace(0.0, 360.0, 7201)[1:-1] + 1e-7, places])
    return np.sort(x[(x >= 0.0) & (x <= 360.0)])


# mm and mm per deg, per deg², of what is stated per radian in metres.
TO_MM = [1e3, 1e3 / math.degrees(1), 1e3 / math.degrees(1) ** 2]


def stated(export: LawExport) -> list[float]:
    names = ("position", "velocity", "acceleration")
    return [getattr(export, f"{n}_deviation") * f for n, f in zip(names, TO_MM, strict=True)]


@pytest.mark.parametrize("name", FORMATS)
@pytest.mark.parametrize("cam", LAWS)
def test_stated_deviations_are_those_of_the_text(name: str, cam: str, machine: lw.Machine) -> None:
    """Position, velocity and acceleration of the text, interpolated here, deviate from the closed form of the
    law as much as is stated: never more, and not less.
    """
    export = exported(law_of(machine, cam), FORMATS[name])
    at = grid(export, LAWS[cam])
    exact = LAWS[cam](at)
    apart = np.abs(controlled(name, export.text, at) - exact).max(axis=1)
    peaks = np.abs(exact).max(axis=1)
    # Rounding of this file's polynomials through points a degree apart, by order; REAL ends of the slopes.
    noise = np.array([1e-13, 1e-10, 1e-7]) * peaks
    if name == "rockwell":
        noise = np.array([1e-8, 1e-7, 2e-5]) * peaks
    for found, said, rounding in zip(apart, stated(export), noise, strict=True):
        assert found <= said * (1 + 1e-6) + rounding
        assert found >= said * 0.97 - rounding


@pytest.mark.parametrize("name", [f.name for f in FORMATS.values() if f.has_derivatives] + ["codesys"])
def test_a_quintic_law_survives_a_round_trip(name: str, machine: lw.Machine) -> None:
    """Points with velocity and acceleration at the segment boundaries are the law to 1e-12 of its travel."""
    export = exported(law_of(machine, "quintic"), FORMATS[name])
    assert export.position_deviation <= 1e-12 * export.position_peak
    if name != "csv":
        assert export.n_points == 5
        assert export.velocity_deviation <= 1e-12 * export.velocity_peak
        assert export.acceleration_deviation <= 1e-12 * export.acceleration_peak


def test_cam_builder_takes_jumps_of_the_acceleration_exactly(machine: lw.Machine) -> None:
    """Polynomials of a parabolic law go over without loss, though its acceleration jumps."""
    export = exported(law_of(machine, "parabola"), FORMATS["codesys"])
    assert export.acceleration_deviation <= 1e-12 * export.acceleration_peak


def test_points_at_a_jump_halve_it(machine: lw.Machine) -> None:
    """Where the acceleration jumps from +a to −a, one acceleration a point is off by a, and no more."""
    export = exported(law_of(machine, "parabola"), FORMATS["codesys-xyva"])
    np.testing.assert_allclose(export.acceleration_deviation, export.acceleration_peak, rtol=1e-3)
    assert export.position_deviation < 1e-6 * export.position_peak


@pytest.mark.parametrize("name", ["sew-spline", "sew-cubic", "sew-linear", "siemens"])
def test_placed_points_deviate_less_than_equal_steps(name: str, machine: lw.Machine) -> None:
    """The same number of points at equal distances deviates more, in every interpolation."""
    form = FORMATS[name]
    export = exported(law_of(machine, "cycloid"), form, 40)
    x = np.linspace(0.0, 360.0, 40)
    law = law_of(machine, "cycloid").law.placed(0.0, 360.0).scaled(1e3)
    rows = [law.at(x, order) for order in range(3 if form.has_derivatives else 1)]
    how = {"quintic": quintics, "linear": lines, "cubic": cubics, "spline": splines}
    at = grid(export, LAWS["cycloid"])
    apart = np.abs(how[form.interpolation](x, *rows, at) - LAWS["cycloid"](at)).max(axis=1)[0]
    assert export.position_deviation * 1e3 < 0.8 * apart


def test_linear_tables_reach_the_least_deviation(machine: lw.Machine) -> None:
    """The error of straight lines that share it evenly is (∫√|s″|)²/8n²: no placing gives less."""
    export = exported(law_of(machine, "quintic"), FORMATS["sew-linear"], 200)
    x = np.linspace(0.0, 360.0, 720001)
    bound = (np.trapezoid(np.sqrt(np.abs(LAWS["quintic"](x)[2])), x)) ** 2 / (8 * 198**2)
    assert 0.97 * bound < export.position_deviation * 1e3 < 1.2 * bound


def test_real_numbers_keep_six_digits(machine: lw.Machine) -> None:
    """REAL rounds positions to 2^-24 of their size; the format says so, and how many digits are left."""
    export = exported(law_of(machine, "cycloid"), FORMATS["rockwell"])
    x, y = TEXTS["rockwell"](export.text)
    exact = LAWS["cycloid"](x)[0]
    assert export.digits == 6
    assert 0 < np.abs(y - exact).max() <= 30 * 2**-24
    assert np.all(x == x.astype(np.float32))


def test_tab_keeps_its_limits(machine: lw.Machine) -> None:
    """A .tab has 360 pairs of whole numbers or fewer, ascending, 0.1° apart or more, the last one too."""
    text = exported(law_of(machine, "cycloid"), FORMATS["tab"]).text
    x, _ = tab(text)
    assert len(x) - 1 <= 360
    assert f"Lines = {len(x) - 1}\n" in text
    assert np.diff(x).min() >= 0.1 - 1e-9


def test_the_phase_shifts_the_law_over_the_master(machine: lw.Machine) -> None:
    """A cam whose first section begins at 30° has its lift over the crank angle, and closes."""
    text = exported(law_of(machine, "parabola"), FORMATS["codesys-xyva"]).text
    x, y, *_ = TEXTS["codesys-xyva"](text)
    assert (x[0], x[-1]) == (0.0, 360.0)
    np.testing.assert_allclose(y, LAWS["parabola"](x)[0], atol=1e-12)


def test_a_swing_is_in_degrees(machine: lw.Machine) -> None:
    """The angle of an oscillating follower goes over in degrees, its velocity in degrees per degree."""
    _, y, v, _ = TEXTS["csv"](exported(law_of(machine, "rocker"), FORMATS["csv"]).text)
    np.testing.assert_allclose([y.max(), v.max()], [20.0, 20 / 180 * 1.875], rtol=1e-12)


def test_units_of_the_reader(machine: lw.Machine) -> None:
    """Positions are in the unit that is asked for; a CNC counts in 0.0001 mm all the same."""
    with lw.shown_in("m"):
        metres = TEXTS["csv"](exported(law_of(machine, "quintic"), FORMATS["csv"]).text)
        steps = tab(exported(law_of(machine, "quintic"), FORMATS["tab"]).text)
    np.testing.assert_allclose([metres[1].max(), steps[1].max()], [0.02, 20.0], rtol=1e-12)


def advancing(machine: lw.Machine) -> MasterLaw:
    """A law that advances by 20 mm in each cycle: its rise alone."""
    own = law_of(machine, "quintic")
    return own._replace(law=own.law.stretch(0.0, math.radians(180)).placed(0.0, 2 * math.pi))


@pytest.mark.parametrize("name", [name for name in FORMATS if name != "tab"])
def test_a_law_may_advance(name: str, machine: lw.Machine) -> None:
    """An index law ends where the next cycle begins, and deviates as little as a periodic one."""
    export = exported(advancing(machine), FORMATS[name])
    assert export.position_deviation < 1e-3 * export.position_peak
    if name not in ("csv", "sew-linear", "sew-cubic", "sew-spline"):
        assert "advances by 20 mm per cycle" in export.text


def test_a_tab_cannot_advance(machine: lw.Machine) -> None:
    """A table that begins anew with each cycle refuses a law that does not come back."""
    with pytest.raises(ExchangeError, match=r"advances by 20 mm per cycle, .*; take another format"):
        exported(advancing(machine), FORMATS["tab"])


@pytest.mark.parametrize(
    ("name", "points"), [("siemens", 52), ("siemens-table", 1001), ("sew-spline", 65), ("sew-cubic", 1025)]
)
def test_more_points_than_the_maker_permits(name: str, points: int, machine: lw.Machine) -> None:
    """A number of points beyond the maker's limit is refused, with the limit."""
    with pytest.raises(InputError, match=rf"found {points}, expected at most {points - 1} .*take fewer"):
        exported(law_of(machine, "cycloid"), FORMATS[name], points)


def test_fewer_points_than_segment_boundaries(machine: lw.Machine) -> None:
    """Points that do not suffice for the segment boundaries are refused, with the number that does."""
    with pytest.raises(ExchangeError, match="need 5 points, and 4 are permitted"):
        exported(law_of(machine, "quintic"), FORMATS["siemens"], 4)


def test_names_cannot_end_a_comment(machine: lw.Machine) -> None:
    """A machine's name is shown without what would end the comment that it stands in."""
    text = exported(law_of(machine, "quintic"), FORMATS["codesys"]).text
    assert text.splitlines()[0] == "(* Feeder (test): law of quintic; master in deg, position in mm *)"


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "machine.toml"
    path.write_text(MACHINE, encoding="utf-8")
    return path


def test_the_command_compares_all_formats(file: Path) -> None:
    """Without --to all formats are compared, and a warning states what REAL and whole numbers lose."""
    done = invoke("law", str(file), "mechanism.cams.cycloid", "--json")
    answer = json.loads(done.stdout)
    assert list(answer["results"]["law"]["formats"]) == list(FORMATS)
    assert "rockwell: the numbers keep 6 of 15 significant digits." in answer["warnings"]
    assert not answer["findings"]


def test_the_command_writes_a_file(file: Path, tmp_path: Path) -> None:
    """--to and --out write the text of one format; a file that exists is kept without --force."""
    out = tmp_path / "cam.st"
    words = ("law", str(file), "quintic", "--to", "codesys", "--out", str(out))
    assert invoke(*words).exit_code == 0
    assert out.read_text(encoding="utf-8").count("SMCB.Poly5_Coeffs") == 4
    assert invoke(*words).exit_code == 2
    assert invoke(*words, "--force").exit_code == 0


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("quintic --to simens", 'did you mean "siemens"'),
        ("quintic --out x.st", "say which by --to"),
        ("nothing", '"nothing": the machine has no such cam'),
        ("", "name one of quintic, cycloid, parabola, rocker"),
        ("quintic --to siemens --points 60", "expected at most 51"),
        ("quintic --to siemens --points 1", "expected at least 2"),
        ("quintic --to csv --points 100000", "expected at most 3 000 points"),
    ],
)
def test_wrong_input_is_refused(file: Path, words: str, message: str) -> None:
    """Formats, names and numbers that make no sense end with exit code 2 and what to do."""
    done = invoke("law", str(file), *words.split())
    assert (done.exit_code, message in done.stderr) == (2, True), done.output


def test_a_format_that_cannot_hold_the_law_is_a_finding(file: Path) -> None:
    """With too few points for the boundaries the command ends with exit code 1, and writes nothing."""
    done = invoke("law", str(file), "quintic", "--to", "siemens", "--points", "4")
    assert done.exit_code == 1
    assert "need 5 points" in done.output
