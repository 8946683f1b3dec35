"""Overrides: the same checks as for the file, and the override as the place of a problem."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from linkwright import InputError, MachineFileError, get, read

TWO_CARTS = Path(__file__).parents[2] / "machines" / "roller_two_carts.toml"


@pytest.mark.parametrize(
    ("override", "address", "value"),
    [
        ('mechanism.cranks.A2.phase="80 deg"', "mechanism.cranks.A2.phase", math.radians(80)),
        ("mechanism.cranks.A2.phase=80 deg", "mechanism.cranks.A2.phase", math.radians(80)),
        ("mechanism.cranks.A2.phase = 1.5", "mechanism.cranks.A2.phase", 1.5),
        ("drive.gearbox.ratio=10", "drive.gearbox.ratio", 10.0),
        ("bodies.cart1.rod.mass_per_length=60", 'bodies."cart1.rod".mass_per_length', 60.0),
        ('bodies."cart1.rod".mass_per_length=60', 'bodies."cart1.rod".mass_per_length', 60.0),
        ("bodies.'cart1.rod'.mass_per_length=60", 'bodies."cart1.rod".mass_per_length', 60.0),
        ("mechanism.sliders.cart1.offset=1 cm", "mechanism.sliders.cart1.offset", 0.01),
        ('name="a = b"', "name", "a = b"),
        ("name=two = one", "name", "two = one"),
        ("drive.flywheel.inertia=3 kg m²", "drive.flywheel.inertia", 3.0),
        ('loads.x={kind="torque_speed", speed=[0, 1], torque=[0, 2]}', "loads.x.torque.1", 2.0),
    ],
)
def test_an_entry_is_replaced_or_added(override: str, address: str, value: object) -> None:
    assert get(read(TWO_CARTS, [override]), address) == value


def test_a_mapping_is_taken_as_it_is() -> None:
    machine = read(TWO_CARTS, {"drive.gearbox.ratio": 12, "name": "1"})
    assert get(machine, "drive.gearbox.ratio") == 12.0
    assert machine.name == "1"


def test_later_overrides_reach_into_earlier_ones() -> None:
    curve = "kind='torque_speed', speed=[0, 1], torque=[0, 2]"
    machine = read(TWO_CARTS, [f"loads.x={{{curve}}}", "loads.x.torque.1=5 kN m"])
    assert get(machine, "loads.x.torque") == (0.0, 5000.0)


@pytest.mark.parametrize("override", ["drive.gearbox.ratio", "=3", "", "a..b=1", ".a=1", "a.=1", 'a."b=1'])
def test_malformed(override: str) -> None:
    with pytest.raises(InputError, match="--set"):
        read(TWO_CARTS, [override])


@pytest.mark.parametrize(
    ("override", "key"),
    [
        ("mechanism.cranks.A2.phase=80 kg", "mechanism.cranks.A2.phase"),
        ("drive.gearbx.ratio=3", "drive.gearbx"),
        ("mechanism.cranks.A3.phase=1", "mechanism.cranks.A3.radius"),
        ("mechanism.sliders.cart1.crank=A9", "mechanism.sliders.cart1.crank"),
        ("loads.rolling1.torque=1", "loads.rolling1.torque"),
        ("name=1", "name"),
        ("drive=1", "drive"),
        ("format=7", "format"),
        ("mechanism.cranks.A2.phase=", "mechanism.cranks.A2.phase"),
    ],
)
def test_the_override_is_the_place_of_its_problem(override: str, key: str) -> None:
    with pytest.raises(MachineFileError) as caught:
        read(TWO_CARTS, [override])
    problem = next(each for each in caught.value.problems if each.key == key)
    assert problem.path == f"--set {override}"
    assert problem.line is None


def test_the_words_of_a_key_in_another_order() -> None:
    with pytest.raises(MachineFileError, match='did you mean "torque_rated"'):
        read(TWO_CARTS, ["drive.motor.rated_torque=4 N m"])


def test_a_way_through_a_value() -> None:
    with pytest.raises(InputError, match="expected: a table"):
        read(TWO_CARTS, ["name.x=1"])


def test_a_place_outside_a_list() -> None:
    curve = "kind='torque_speed', speed=[0, 1], torque=[0, 2]"
    with pytest.raises(InputError, match="0 to 1"):
        read(TWO_CARTS, [f"loads.x={{{curve}}}", "loads.x.torque.2=5"])
