"""Digits by what is known: rounding beside what a number belongs to is printed as zero."""

from __future__ import annotations

import numpy as np
import pytest

import linkwright as lw
from linkwright.kernel.page.table import row
from linkwright.kernel.reader.numbers import number
from linkwright.kernel.reader.sentences import sentence
from linkwright.kinetostatics.tables import envelope_table


@pytest.mark.parametrize(
    ("value", "scale", "text"),
    [
        (3.9e-13, 512.0, "0"),
        (-3.9e-13, 512.0, "0"),
        (3.9e-13, 0.0, "3.9·10⁻¹³"),
        (3.9e-13, 1e-6, "3.9·10⁻¹³"),
        (2.96e-323, 0.0, "0"),
        (512.0, 512.0, "512"),
        (np.nan, 512.0, "–"),
    ],
)
def test_rounding_beside_a_scale_is_zero(value: float, scale: float, text: str) -> None:
    assert number(value, scale=scale) == text


def test_a_row_of_a_table_has_the_scale_of_its_unit() -> None:
    machine = lw.read("roller_two_carts", {"loads": {}, "bodies": {}, "drive.flywheel.inertia": 5.0})
    found = lw.reduction(machine)
    assert found.torque_load_max == 0.0
    moved = lw.reduction(lw.read("roller_two_carts"))
    small = type(moved)(**{**vars(moved), "torque_load_mean": 1e-13 * moved.torque_load_max})
    assert row(small, "torque_load_mean")[2] == "0 N m"


def test_forces_that_are_rounding_are_zero() -> None:
    rows = envelope_table(lw.forces(lw.read("press_with_flywheel"), speed=6.0)).rows
    cells = [cell for line in rows for cell in line[2:]]
    assert cells
    assert not [cell for cell in cells if "·10⁻¹" in cell and cell.endswith("N")]


@pytest.mark.parametrize(
    ("said", "shown"),
    [
        ("falls to -1152 N m: there", "falls to −1152 N m: there"),
        ("at crank angles -4500.00° to 60°", "at crank angles −4500.00° to 60°"),
        ("an error of 2.5e-06 m (-3e+07 N)", "an error of 2.5·10⁻⁶ m (−3·10⁷ N)"),
        ('write "-3 m", or --set x=-3, of A-3 and 10-20', 'write "-3 m", or --set x=-3, of A-3 and 10-20'),
    ],
)
def test_sentences_have_the_numbers_of_tables(said: str, shown: str) -> None:
    assert sentence(said) == shown
