"""Motors of one's own from a file: units in its head, ratios, errors by line."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import linkwright as lw
from linkwright import MachineFileError

HEAD = """
format = 1
name = "own motor"
[drive.motor]
file = "motors.csv"
catalogue = "M3BP 160"
[drive.gearbox]
ratio = 10
[mechanism.cranks.A]
radius = 0.1
"""

ROWS = """# Motors in stock.
type,series,power_rated [kW],speed_rated [rpm],speed_synchronous[rpm],torque_breakdown_ratio,inertia [kgm^2]
M3BP 132, M3BP, 5.5, 1460, 1500, 2.9, 0.031
M3BP 160, M3BP, 11, 1466, 1500, 2.8, 0.081
"""


def read(folder: Path, rows: str = ROWS, head: str = HEAD) -> lw.Machine:
    (folder / "motors.csv").write_text(rows, encoding="utf-8")
    (folder / "machine.toml").write_text(head, encoding="utf-8")
    return lw.read(folder / "machine.toml")


def test_a_type_of_the_file_is_the_motor(tmp_path: Path) -> None:
    machine = read(tmp_path)
    assert machine.drive is not None
    motor = machine.drive.motor
    assert motor.kind == "induction"  # type: ignore[union-attr]
    torque = 11e3 / (1466 * np.pi / 30)
    assert motor.torque_rated == pytest.approx(torque, rel=1e-14)  # type: ignore[union-attr]
    assert motor.torque_breakdown == pytest.approx(2.8 * torque, rel=1e-14)  # type: ignore[union-attr]
    assert motor.inertia == 0.081  # type: ignore[union-attr]
    # What the machine file says goes first.
    own = read(tmp_path, head=HEAD.replace('"M3BP 160"', '"M3BP 160"\ninertia = 0.1'))
    assert own.drive is not None
    assert own.drive.motor.inertia == 0.1  # type: ignore[union-attr]


def test_a_speed_without_load_makes_it_a_dc_motor(tmp_path: Path) -> None:
    rows = "type, speed_no_load [rpm], torque_stall [Nm]\nM3BP 160, 3000, 12\n"
    machine = read(tmp_path, rows)
    assert machine.drive is not None
    assert machine.drive.motor.kind == "dc"  # type: ignore[union-attr]
    assert machine.drive.motor.torque_stall == 12.0  # type: ignore[union-attr]


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        (ROWS.replace("M3BP 160, M3BP, 11", "M3BP 160, M3BP, x"), "line 4|:4:"),
        (
            ROWS.replace("M3BP 160, M3BP, 11", "M3BP 160, M3BP, 11kW"),
            r'"11kW"\n[^"]*the unit belongs in the header, \[kW\]',
        ),
        (ROWS.replace("inertia [kgm^2]", "inertia [kg]"), "column inertia"),
        (ROWS.replace("power_rated [kW]", "power_rate [kW]"), "power_rated"),
        (ROWS.replace("M3BP 160", "M3BP 180"), "M3BP 132"),
        (ROWS + "M3BP 160, M3BP, 11, 1466, 1500, 2.8, 0.081\n", "each type once"),
        (ROWS + "M3BP 200, M3BP\n", "7 values"),
        (ROWS.replace("1466", "0"), r"in the column speed_rated an angular speed greater than 0"),
        (ROWS.replace("0.081", "-0.081"), "column inertia"),
        (ROWS.replace("2.8", "0"), "column torque_breakdown_ratio"),
        (ROWS.replace("1466", "1e-300"), "between 1e-9 and 1e6 rad/s"),
        ("", "empty"),
        ("power_rated [kW]\n11\n", "a head"),
    ],
)
def test_what_is_wrong_is_told(rows: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(MachineFileError, match=said):
        read(tmp_path, rows)


def test_a_file_elsewhere_is_refused(tmp_path: Path) -> None:
    with pytest.raises(MachineFileError, match="folder of the machine file"):
        read(tmp_path, head=HEAD.replace("motors.csv", "../motors.csv"))


def test_a_type_of_the_catalogue_that_would_change_nothing_is_refused() -> None:
    """All numbers of the motor stand in this file: with another type it would stay the same motor."""
    with pytest.raises(MachineFileError, match="which replace all its data"):
        lw.read("roller_two_carts", ["drive.motor.catalogue=4A250M6U3"])
    other = lw.read("roller_one_cart", ["drive.motor.catalogue=4A250M6U3"])
    assert other.drive is not None
    assert other.drive.motor.power_rated == pytest.approx(55e3)  # type: ignore[union-attr]
