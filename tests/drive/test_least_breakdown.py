"""Motors of the catalogue without a printed breakdown or starting torque: those of a standard."""

from __future__ import annotations

import numpy as np
import pytest

import linkwright as lw
from linkwright.drive import CatalogueMotor
from linkwright.machine import compile_machine

TYPE = "IE3 11 kW 4-pole frame 160"

DRIVE = {"drive.motor": {"kind": "induction", "catalogue": TYPE}, "drive.gearbox.ratio": 14.5}


def test_it_is_the_least_of_iec_60034_1() -> None:
    machine = lw.read("roller_two_carts", DRIVE)
    assert machine.drive is not None
    motor = machine.drive.motor
    # Printed: 71.27 N m.
    assert motor.torque_breakdown == pytest.approx(1.6 * 71.27)  # type: ignore[union-attr]
    said = [text for text in lw.study(machine).warnings if "IEC 60034-1 " in text]
    assert len(said) == 1
    assert TYPE in said[0]


def test_a_torque_that_is_given_counts_without_a_word() -> None:
    given = lw.read("roller_two_carts", DRIVE | {"drive.motor.torque_breakdown": 200.0})
    assert given.drive is not None
    assert given.drive.motor.torque_breakdown == 200.0  # type: ignore[union-attr]
    assert not any("IEC 60034-1 " in text for text in lw.study(given).warnings)


def test_printed_ones_stay_as_they_are() -> None:
    for known in lw.motors():
        if known.torque_breakdown is not None:
            text = {"drive.motor": {"kind": "induction", "catalogue": known.type}}
            machine = lw.read("roller_two_carts", text)
            assert machine.drive is not None
            assert machine.drive.motor.torque_breakdown == known.torque_breakdown  # type: ignore[union-attr]


# IEC 60034-12, design N, four poles: torque at standstill and at pull-up over the rated torque.
DESIGN_N = {5.5: (1.6, 1.1), 11: (1.5, 1.1), 18.5: (1.4, 1.0), 30: (1.3, 1.0), 55: (1.2, 0.9)}


@pytest.mark.parametrize("known", [one for one in lw.motors() if one.poles == 4], ids=lambda one: one.type)
def test_the_start_is_the_least_of_design_n(known: CatalogueMotor) -> None:
    assert known.start_is_minimum
    start, pull_up = DESIGN_N[known.power_rated / 1e3]
    machine = lw.read("roller_two_carts", {"drive.motor": {"kind": "induction", "catalogue": known.type}})
    torques = compile_machine(machine)
    assert machine.drive is not None
    ratio = machine.drive.gearbox.ratio
    speeds = np.linspace(0, known.speed_synchronous * 0.9, 500) / ratio
    curve = torques.motor_torques(speeds).motor / known.torque_rated
    assert curve[0] == pytest.approx(start, rel=1e-12)
    # The curve falls to the pull-up torque and no further before breakdown.
    assert curve.min() == pytest.approx(pull_up, rel=1e-4)
    said = [text for text in lw.study(machine).warnings if "IEC 60034-12" in text]
    assert len(said) == 1
    assert "torque_start" in said[0]


@pytest.mark.parametrize("name", ["torque_start", "torque_pull_up"])
def test_a_start_that_is_given_counts_without_a_word(name: str) -> None:
    own = {"drive.motor.torque_start": 90.0}
    if name == "torque_pull_up":
        own |= {"drive.motor.torque_pull_up": 60.0, "drive.motor.speed_pull_up": 30.0}
    machine = lw.read("roller_two_carts", DRIVE | own)
    assert machine.drive is not None
    assert machine.drive.motor.torque_start == 90.0  # type: ignore[union-attr]
    expected = 60.0 if name == "torque_pull_up" else None
    assert machine.drive.motor.torque_pull_up == expected  # type: ignore[union-attr]
    assert not any("IEC 60034-12" in text for text in lw.study(machine).warnings)
