"""Motors of the catalogue without a printed breakdown torque: the smallest of a standard, and it is said."""

from __future__ import annotations

import pytest

import linkwright as lw

TYPE = "IE3 11 kW 4-pole frame 160"

DRIVE = {"drive.motor": {"kind": "induction", "catalogue": TYPE}, "drive.gearbox.ratio": 14.5}


def test_it_is_the_least_of_iec_60034_1() -> None:
    machine = lw.read("roller_two_carts", DRIVE)
    assert machine.drive is not None
    motor = machine.drive.motor
    # Printed: 71.27 N m.
    assert motor.torque_breakdown == pytest.approx(1.6 * 71.27)  # type: ignore[union-attr]
    said = [text for text in lw.study(machine).warnings if "IEC 60034-1" in text]
    assert len(said) == 1
    assert TYPE in said[0]


def test_a_torque_that_is_given_counts_without_a_word() -> None:
    given = lw.read("roller_two_carts", DRIVE | {"drive.motor.torque_breakdown": 200.0})
    assert given.drive is not None
    assert given.drive.motor.torque_breakdown == 200.0  # type: ignore[union-attr]
    assert not any("IEC 60034-1" in text for text in lw.study(given).warnings)


def test_printed_ones_stay_as_they_are() -> None:
    for known in lw.motors():
        if known.torque_breakdown is not None:
            text = {"drive.motor": {"kind": "induction", "catalogue": known.type}}
            machine = lw.read("roller_two_carts", text)
            assert machine.drive is not None
            assert machine.drive.motor.torque_breakdown == known.torque_breakdown  # type: ignore[union-attr]
