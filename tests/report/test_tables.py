"""Numbers, tables and curves as text."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import numpy as np
import pytest

from linkwright import loads, read, study
from linkwright.kernel.arrays import Floats
from linkwright.kernel.files.library import template
from linkwright.kernel.page.table import columns_csv, curves_csv, part_table, parts_of
from linkwright.kernel.quantities import About, Label, over
from linkwright.kernel.reader.numbers import number
from linkwright.kernel.reader.out_units import OutUnits, reading
from linkwright.kernel.result import Result
from linkwright.machine import machine_parts

TWO_CARTS = Path(__file__).parents[2] / "machines" / "roller_two_carts.toml"


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.084959144, "0.08496"),
        (-48.298, "−48.3"),
        (20237.3, "20240"),
        (1234567.0, "1235000"),
        (2.5e9, "2.5·10⁹"),
        (-1.4051e-8, "−1.405·10⁻⁸"),
        (0.0, "0"),
        (None, "–"),
        (float("nan"), "–"),
    ],
)
def test_number(value: float | None, text: str) -> None:
    assert number(value) == text


def test_tables_are_those_that_there_are_results_for() -> None:
    machine = read(TWO_CARTS)
    usual = ["linkage", "transmission", "motion", "reduction", "steady_state", "measures", "drive", "run_up"]
    last = ["forces", "dead_points", "numerical"]
    assert [table.name for table in study(machine).tables()] == [*usual, *last]
    stepped = study(machine, step=np.radians(1)).tables()
    assert [table.name for table in stepped] == [*usual, "step_method", *last]
    for table in stepped:
        assert {len(row) for row in table.rows} == {len(table.heads)}
    with_brake = read(TWO_CARTS, ["drive.brake.torque=100"])
    assert [table.name for table in study(with_brake).tables()] == [*usual, "run_down", *last]


def test_curves_read_back_exactly() -> None:
    steady = study(read(TWO_CARTS)).steady_state
    assert steady is not None
    head, *lines = curves_csv(steady).splitlines()
    assert head.split(",")[:3] == ["crank_angle [rad]", "time [s]", "speed [rad/s]"]
    values = np.array([[float(cell) for cell in line.split(",")] for line in lines])
    assert np.array_equal(values[:, 2], steady.speed)
    assert "power_motor [W]" in head


def test_machine_parts_have_units_and_what_follows_is_marked() -> None:
    parts = {(part.group, part.name): part.entries for part in machine_parts(loads(template("press")))}
    motor = {entry.word: entry for entry in parts["Drive", "motor"]}
    assert motor["power rated"].value == "5500 W"
    assert not motor["power rated"].given
    assert motor["inertia"].given
    work = {entry.word: entry.value for entry in parts["Loads", "work"]}
    assert work["position"] == "0.42, 0.56, 0.562, 0.578, 0.58 m"
    slider = {entry.word: entry.value for entry in parts["Sliders", "ram"]}
    assert slider["angle"] == "−90°"
    assert "offset" not in slider


def test_what_is_rounding_beside_its_unit_is_zero_in_csv() -> None:
    """Numbers of one unit stand beside each other; a plain number beside its own column alone."""
    columns = {
        "force [N]": np.array([5e4, -2.0]),
        "side [N]": np.array([3.9e-13, 1e-6]),
        "ratio [-]": np.array([1e-14, 2e-14]),
        "gap [mm]": np.array([np.nan, 1e-20]),
    }
    rows = columns_csv(columns).splitlines()[1:]
    assert rows == ["50000.0,0.0,1e-14,", "-2.0,1e-06,2e-14,1e-20"]


@dataclass(frozen=True)
class Sheaves(Result):
    """Sheaves of a hoist at two speeds."""

    speeds: Annotated[Floats, Label("speed", "ω", "rad/s")]
    sheaves: Annotated[tuple[str, ...], About("Names.")]
    pull: Annotated[Floats, Label("pull of the rope", "Z", "N", shape="(sheaves, speeds)")]
    worst: Annotated[Floats, Label("speed of the largest pull", "", "rad/s", shape="(sheaves,)")]


SHEAVES = Sheaves(
    np.array([1.0, 2.0]),
    ("upper", "lower"),
    np.array([[400.0, 500.0], [300.0, 1e-14]]),
    np.array([2.0, 1.0]) * np.pi / 30,
)


def test_table_has_a_row_for_each_part_with_declared_units() -> None:
    """Rounding beside the largest of a column is zero; a unit in the head stands for its column."""
    cells = ("name", "", "pull", "worst", lambda part: part.name[0])
    heads = ("sheave", "", "pull", "worst {rpm}", "letter")
    table = part_table("sheaves", "Sheaves", parts_of(SHEAVES, "sheaves", 1), heads, *cells)
    assert table.heads == ("sheave", "", "pull", "worst rpm", "letter")
    assert table.rows == [("upper", "", "500 N", "2", "u"), ("lower", "", "0 N", "1", "l")]


def test_units_of_the_reader_hold_for_cells_and_heads_of_parts() -> None:
    with reading(OutUnits.of("kN, rad/s")):
        table = part_table("", "", parts_of(SHEAVES, "sheaves", 0), ("", "at {rpm}"), "pull", "worst")
    assert table.heads[1] == "at rad/s"
    assert table.rows[0] == ("0.4 kN", "0.2094")


def test_numbers_of_named_parts_run_over_no_curve() -> None:
    assert over(Sheaves, "worst") == ""
    assert over(Sheaves, "pull") == "speeds"
