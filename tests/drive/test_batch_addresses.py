"""Every number of every machine varies in a batch as it does one by one, or is refused by name."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from found_machines import found_machine
from random_drives import random_drive
from sizes import generator

import linkwright as lw
from linkwright import InputError, LinkwrightError, Machine
from linkwright.drive import ConstantSpeedMotor

MACHINES = sorted(Path("machines").glob("*.toml"))

# Promised accuracy of a row in lanes.
ROW = 1e-6


def _with_mechanism() -> list[Machine]:
    read = (lw.read(path) for path in MACHINES)
    return [machine for machine in read if not machine.is_train_alone and not machine.is_topper_alone]


def _rows(value: float) -> np.ndarray:
    """A number, a neighbour of it, and the number again; an efficiency of 1 has one below."""
    return np.array([value, value * (0.9999 if value == 1.0 else 1.0001) if value else 1e-6, value])


def _checked(machine: Machine) -> Machine:
    return Machine.model_validate(machine.model_dump(by_alias=True, exclude_unset=True))


def _require_named(error: LinkwrightError, address: str) -> None:
    assert any(key in str(error) for key in address.split(".")[-3:]), f"{address}: {error}"


@pytest.mark.parametrize("machine", _with_mechanism(), ids=lambda machine: machine.name)
def test_motions_of_every_address(machine: Machine) -> None:
    angles = np.linspace(0, 2 * np.pi, 7)
    points = list(lw.kinematics(machine, angles).points)
    refused = 0
    for address, value in lw.addresses(machine).items():
        column = _rows(value)
        try:
            found = lw.motions(lw.replace(machine, {address: column}), angles, points=points)
        except InputError as error:
            _require_named(error, address)
            refused += 1
            continue
        assert len(found) == 3, address
        np.testing.assert_array_equal(found[0], found[2], err_msg=address)
        alone = lw.motions(lw.replace(machine, {address: column[1]}), angles, points=points)
        # Sides and turns of angles are the first machine's; the numbers are the same to rounding.
        np.testing.assert_allclose(found[1], alone[0], rtol=1e-12, atol=1e-12, err_msg=address)
    # The crank angle of given places, the cycles of loads, and in a cam's sections angle, lift and two shares
    # of each.
    cycles = sum(hasattr(load, "cycle") for load in machine.loads.values())
    assert refused == (9 if machine.mechanism.cams else 1) + cycles


def _has_characteristic(machine: Machine) -> bool:
    motor = machine.drive and machine.drive.motor
    return motor is not None and not isinstance(motor, ConstantSpeedMotor)


@pytest.mark.parametrize(
    "machine", list(filter(_has_characteristic, _with_mechanism())), ids=lambda machine: machine.name
)
def test_steady_motion_of_every_address(machine: Machine) -> None:
    solved = 0
    for address, value in lw.addresses(machine).items():
        column = _rows(value)
        try:
            found = lw.steady_states(machine, {address: column})
        except InputError as error:
            _require_named(error, address)
            continue
        solved += 1
        assert not found.status.any(), address
        assert found.speed_max[0] == found.speed_max[2], address
        alone = lw.steady_state(_checked(lw.replace(machine, {address: float(column[1])})))
        np.testing.assert_allclose(found.speed_max[1], alone.speed_max, rtol=ROW, err_msg=address)
        np.testing.assert_allclose(found.speed_min[1], alone.speed_min, rtol=ROW, err_msg=address)
    assert solved > 10


def test_entries_without_effect_have_none_one_by_one() -> None:
    machine = lw.read("machines/roller_one_cart.toml")
    plain = lw.steady_state(machine)
    for address, value in lw.addresses(machine).items():
        column = _rows(value)
        try:
            lw.steady_states(machine, {address: column})
        except InputError as error:
            if "no effect" in str(error):
                alone = lw.steady_state(lw.replace(machine, {address: float(column[1])}))
                assert alone.speed_max == plain.speed_max, address


@pytest.mark.parametrize("address", ["speed_synchronous", "speed_rated", "torque_rated"])
def test_a_row_without_a_characteristic_leaves_its_neighbours_alone(address: str) -> None:
    # The breakdown speed of each row follows from entries that vary; none follows from the wrong row's.
    machine = lw.read("machines/roller_one_cart.toml")
    address = f"drive.motor.{address}"
    values = np.full(40, lw.get(machine, address))
    sound = lw.kinematics(lw.replace(machine, {address: values})).angles
    assert len(sound) == 361
    values[17] *= 1.5 if "torque" not in address else 10.0
    motors = lw.replace(machine, {address: values}).drive.motor
    knee = motors.speed_breakdown
    assert np.isfinite(np.delete(knee, 17)).all()
    assert (np.delete(knee, 17) == lw.get(machine, "drive.motor.speed_breakdown")).all()


def test_a_machine_of_constant_speed_is_refused_by_name() -> None:
    with pytest.raises(InputError, match=r"mechanism\.cranks\.crank\.radius: .*drive\.motor"):
        lw.steady_states(lw.read("topper_crank"), {"mechanism.cranks.crank.radius": np.array([0.02, 0.03])})


@pytest.mark.parametrize("shape", [(2, 2), (0,)])
def test_arrays_that_are_no_rows(shape: tuple[int, ...]) -> None:
    machine = lw.read("machines/roller_one_cart.toml")
    with pytest.raises(InputError, match=r"drive\.gearbox\.ratio"):
        lw.kinematics(lw.replace(machine, {"drive.gearbox.ratio": np.ones(shape)}))


@pytest.mark.parametrize("rod", [0.11, 0.15])
def test_a_row_that_fails_leaves_the_bits_of_its_neighbours(rod: float) -> None:
    machine = lw.read("machines/roller_two_carts.toml")
    rods = np.linspace(0.6, 0.9, 41)
    sound = lw.steady_states(machine, {"mechanism.sliders.cart1.rod": rods})
    rods[17] = rod
    found = lw.steady_states(machine, {"mechanism.sliders.cart1.rod": rods})
    assert found.status[17] == 1
    for name in ("speed_min", "speed_max", "acceleration_max", "torque_motor_rms"):
        others = [np.delete(getattr(each, name), 17) for each in (sound, found)]
        np.testing.assert_array_equal(*others, err_msg=name)


@pytest.mark.parametrize(
    ("name", "address", "value"),
    [
        # Too heavy for the motor.
        ("roller_two_carts", "loads.rolling1.force", 1e5),
        ("roller_four_carts", 'bodies."cart2.rod".mass_per_length', 8e5),
        ("roller_one_cart", "loads.gravity.acceleration", 981.0),
        # Slow enough to pass the breakdown of its motor.
        ("roller_two_carts", 'bodies."cart2.rod".mass_per_length', 640.0),
        ("roller_three_carts", "drive.gearbox.ratio", 0.0098),
    ],
)
def test_no_row_changes_the_bits_of_another(name: str, address: str, value: float) -> None:
    machine = lw.read(f"machines/{name}.toml")
    usual = lw.get(machine, address)
    values = usual * np.linspace(0.85, 1.2, 21)
    alone = lw.steady_states(machine, {address: values})
    values[5] = value
    beside = lw.steady_states(machine, {address: values})
    for column in (
        "speed_min",
        "speed_max",
        "acceleration_min",
        "acceleration_max",
        "period",
        "energy_motor",
    ):
        others = [np.delete(getattr(each, column), 5) for each in (alone, beside)]
        np.testing.assert_array_equal(*others, err_msg=column)


def test_no_row_changes_the_bits_of_another_whatever_the_machine() -> None:
    """Random drives: motors, kinks, springs, dry friction; a row far from the others among them."""
    compared = 0
    for n in range(40):
        random = generator(20261128, n)
        try:
            machine = lw.Machine.model_validate(random_drive(random))
            entries = [(address, value) for address, value in lw.addresses(machine).items() if value]
            address, value = entries[random.integers(len(entries))]
            values = value * random.uniform(0.7, 1.3, 9)
            alone = lw.steady_states(machine, {address: values})
            values[4] = value * 10.0 ** random.choice([-3, -1, 1, 3])
            beside = lw.steady_states(machine, {address: values})
        except LinkwrightError:
            continue
        compared += 1
        for column in ("speed_min", "acceleration_max", "period", "multiplier"):
            others = [np.delete(getattr(each, column), 4) for each in (alone, beside)]
            np.testing.assert_array_equal(*others, err_msg=f"{n}: {address}: {column}")
    assert compared > 10


def test_dead_centres_do_not_depend_on_a_row_that_does_not_close() -> None:
    """They are found lane by lane: one without any is looked for longest."""
    machine = found_machine("rocker_under_dry_friction")
    entries = {
        "mechanism.points.P.x": np.array(
            [1.07219822, 1.09614006, 0.95702984, 0.95953933, 0.95695376, 1.14561111, 0.99023333, 0.97657207]
        ),
        "mechanism.cranks.A.radius": np.array(
            [0.3739625, 0.33799671, 0.37716362, 0.35879507, 0.39646456, 0.39805609, 0.40376465, 0.39658385]
        ),
    }
    alone = lw.steady_states(machine, entries)
    entries["mechanism.points.P.x"] = np.append(entries["mechanism.points.P.x"][:-1], 1e-3)
    beside = lw.steady_states(machine, entries)
    assert alone.status.tolist() == [0] * 8
    assert beside.status[-1] != 0
    for column in ("speed_min", "acceleration_min", "acceleration_max", "period"):
        np.testing.assert_array_equal(getattr(alone, column)[:-1], getattr(beside, column)[:-1])
