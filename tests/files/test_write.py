"""What is written reads back as the same machine."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright import InputError, Machine, loads, read, replace, write
from linkwright.kernel.files.library import template, templates
from linkwright.machine import dumps, in_own_units

TWO_CARTS = Path(__file__).parents[2] / "machines" / "roller_two_carts.toml"


@pytest.mark.parametrize("name", templates())
def test_round_trip(name: str) -> None:
    machine = loads(template(name))
    assert loads(dumps(machine)) == machine


@pytest.mark.parametrize("name", templates())
def test_round_trip_in_own_units(name: str) -> None:
    """In the units of the file, too, every quantity is read back to the last digit."""
    units = {"length": "in", "angle": "deg", "mass": "lb", "force": "kN"}
    machine = loads(template(name), {"units": units})
    assert loads(in_own_units(machine)) == machine


def test_through_a_file(tmp_path: Path) -> None:
    machine = read(TWO_CARTS)
    write(machine, tmp_path / "copy.toml")
    assert read(tmp_path / "copy.toml") == machine


@given(phase=st.floats(-10, 10), ratio=st.floats(1e-3, 1e3), name=st.text(max_size=20))
def test_every_float_survives(phase: float, ratio: float, name: str) -> None:
    changes = {"mechanism.cranks.A2.phase": phase, "drive.gearbox.ratio": ratio, "name": name}
    if not name.isprintable():
        with pytest.raises(InputError, match=r"^name"):
            replace(read(TWO_CARTS), changes)
        return
    machine = replace(read(TWO_CARTS), changes)
    assert loads(dumps(machine)) == machine


def test_only_what_was_given_is_written() -> None:
    text = dumps(loads(template("compressor")))
    assert "speed_breakdown" not in text
    assert "run_up" not in text


def test_many_machines_are_not_one_file() -> None:
    many = replace(read(TWO_CARTS), {"mechanism.cranks.A2.phase": [0.1, 0.2]})
    with pytest.raises(InputError, match=r"mechanism\.cranks\.A2\.phase"):
        dumps(many)


def test_a_machine_made_in_python_is_written() -> None:
    machine = Machine.model_validate(
        {"format": 1, "name": "x", "mechanism": {"cranks": {"A": {"radius": "5 cm"}}}}
    )
    assert loads(dumps(machine)) == machine


def test_sections_of_a_cam_are_written() -> None:
    machine = read(TWO_CARTS.with_name("roller_cam.toml"))
    assert loads(dumps(machine)) == machine
    assert "[[mechanism.cams.cart.sections]]" in dumps(machine)
