"""Units of what is shown: ``--units`` and the table ``[units]`` of a machine file, in all but JSON."""

from __future__ import annotations

import csv
import io
import re
from pathlib import Path

import numpy as np
import pytest
from command_line import invoke

import linkwright as lw
from linkwright import linkage
from linkwright.kernel.reader.numbers import degrees, measured, quantity
from linkwright.kernel.reader.out_units import OutUnits, reading

WIDE = {"COLUMNS": "300"}


def told(*words: str, code: int = 0) -> str:
    result = invoke(*words, env=WIDE)
    assert result.exit_code == code, result.output
    return result.stdout + (result.stderr if code else "")


@pytest.mark.parametrize(
    ("unit", "chosen", "expected"),
    [
        ("m", "mm", ("mm", 1e-3)),
        ("m/s²", "mm", ("mm/s²", 1e-3)),
        ("m/rad", "mm", ("mm/rad", 1e-3)),
        ("1/m", "mm", ("1/mm", 1e3)),
        ("m/s", "mm, m/min", ("m/min", 1 / 60)),
        ("rad/s", "RPM", ("rpm", np.pi / 30)),
        ("rad", "deg", ("°", np.pi / 180)),
        ("N m", "kNm, kJ", ("kN m", 1e3)),
        ("J", "kNm, kJ", ("kJ", 1e3)),
        ("J", "kNm", ("J", 1.0)),
        ("N m", "kJ", ("N m", 1.0)),
        ("N m", "ft lb", ("ft lbf", 1.3558179483314004)),
        ("kg m²", "kgcm^2", ("kg cm²", 1e-4)),
        ("N per m", "kN, mm", ("kN per mm", 1e6)),
        ("per rad/s", "rpm", ("per rpm", 30 / np.pi)),
        ("", "mm", ("", 1.0)),
    ],
)
def test_unit_that_is_shown(unit: str, chosen: str, expected: tuple[str, float]) -> None:
    name, factor = OutUnits.of(chosen).shown(unit)
    # Products of two factors are rounded once.
    assert (name, factor) == (expected[0], pytest.approx(expected[1], rel=1e-15))


def test_numbers_are_as_those_of_the_unit() -> None:
    assert quantity(0.1, "m", usual="mm") == "100 mm"
    with reading(OutUnits.of("cm, rad, rpm")):
        assert quantity(0.1, "m", usual="mm") == "10 cm"
        assert degrees(np.pi) == "3.142 rad"
        assert measured(2 * np.pi, "rad/s", before="at ") == "at 60 rpm"
        # What is rounding beside a scale stays so in every unit.
        assert quantity(1e-14, "m", scale=1.0) == "0 cm"
    assert degrees(np.pi) == "180°"


def test_option_table_and_both() -> None:
    plain = told("run", "press_motion")
    assert "0.16 m " in plain
    for words in (("--units", "mm"), ("--set", "units.length=mm")):
        text = told("run", "press_motion", *words)
        assert "160 mm" in text
        # −0.5091 m/s is printed with the same digits.
        assert "−509.1 mm/s" in text
    both = told(
        "run", "press_motion", "--set", "units.length=cm", "--set", "units.angle=rad", "--units", "mm"
    )
    assert "160 mm" in both
    assert "1.571 rad" in both


def test_json_is_in_si() -> None:
    words = ("run", "press_motion", "--json", "--curves")
    assert told(*words) == told(*words, "--units", "mm, rad") == told(*words, "--set", "units.length=mm")


def test_csv_has_the_units_in_its_heads(tmp_path: Path) -> None:
    told("run", "press_motion", "--units", "mm, rpm, deg", "--out", str(tmp_path / "out"))
    motion = linkage(lw.read("press_motion"))
    rows = list(csv.DictReader(io.StringIO((tmp_path / "out" / "linkage.csv").read_text(encoding="utf-8"))))
    angles = [float(row["crank_angle [°]"]) for row in rows]
    # Divided once, and read back exactly.
    np.testing.assert_allclose(np.radians(angles), motion.crank_angle, rtol=4e-16)
    assert "ram.place [mm]" in (tmp_path / "out" / "motion.csv").read_text(encoding="utf-8").split("\n")[0]
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert re.search(r"160\s*<[^>]*>\s*mm", page)
    assert '"speed_unit":["rpm"' in page.replace(" ", "")


def test_figures_have_the_units_on_their_axes() -> None:
    motion = lw.steady_state(lw.read("roller_two_carts"))
    plain, data = motion.plot("speed"), motion.speed
    with lw.shown_in("rpm"):
        figure = motion.plot("speed")
    assert plain.axes[0].get_ylabel().endswith("[rad/s]")
    axis = figure.axes[0]
    assert axis.get_ylabel().endswith("[rpm]")
    np.testing.assert_array_equal(axis.lines[0].get_ydata(), data)
    figure.savefig(io.BytesIO())
    low, high = axis.get_ylim()
    marks = [
        (tick.get_loc(), float(tick.label1.get_text().replace("−", "-")))
        for tick in axis.yaxis.get_major_ticks()
        if low <= tick.get_loc() <= high
    ]
    assert len(marks) >= 3
    for place, number in marks:
        # Marks stand at round numbers of the unit that is shown.
        assert place * 30 / np.pi == pytest.approx(number, rel=1e-12)
        assert number == pytest.approx(round(number, 1), abs=1e-9)


def test_a_pose_has_degrees_for_people_and_radians_in_csv() -> None:
    words = ("motion", "press_motion", "--at", "30 deg")
    assert re.search(r"ram μ \[°\] +97\.96", told(*words))
    assert "ram,μ [rad],1.7098" in told(*words, "--csv")
    assert "ram,μ [°],97.96" in told(*words, "--csv", "--units", "deg")


def test_a_long_name_is_whole_in_a_narrow_terminal() -> None:
    """In the 100 columns of pipes names without a space are broken, never cut by an ellipsis."""
    result = invoke("run", "pumping_unit_torque", "--units", "mm,rpm")
    assert "Linkage over its cycle" in result.stdout
    assert "…" not in result.stdout


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--units", "mm, cm"), "one unit of a kind"),
        (("--units", "smoot"), "smoot"),
        (("--set", "units.length=kg"), "unit of mass"),
        (("--set", "units.torque=kJ"), "unit of energy"),
        (("--set", "units.energy=kNm"), "unit of torque"),
        (("--set", "units.speed=1/min"), "write rpm"),
        (("--set", "units.lenght=mm"), "length"),
    ],
)
def test_wrong_units_are_refused(words: tuple[str, ...], said: str) -> None:
    assert said in told("run", "press_motion", *words, code=2)
