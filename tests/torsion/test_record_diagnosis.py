"""Speeds recorded over the crank angle, and what they say of the cylinders."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import linkwright as lw
from linkwright import InputError, ShapeError, forced_vibration
from linkwright.kernel.files.library import template
from linkwright.torsion import firing_angles, record_diagnosis
from linkwright.torsion.diagnosis.measured_speed import recorded_speed

SPEED = 150.0
ORDERS = np.array([0.5, 1.0, 4.5])
WAVES = np.array([1 - 2j, 0.5j, 3.0])


def wave(angle: np.ndarray) -> np.ndarray:
    return SPEED + (np.exp(1j * np.outer(angle, ORDERS)) @ WAVES).real


@pytest.mark.parametrize("start", [0.0, -2 * np.pi, 1.234])
@pytest.mark.parametrize(("cycles", "extra"), [(1, 0), (1, 1), (3, 0), (3, 1)])
def test_harmonics_do_not_depend_on_where_a_record_begins(start: float, cycles: int, extra: int) -> None:
    """Over whole cycles of two revolutions, with or without the first sample once more at the end."""
    angle = start + 4 * np.pi * np.arange(64 * cycles + extra) / 64
    record = recorded_speed(angle, wave(angle), 2)
    assert (record.turns, len(record.samples)) == (2 * cycles, 64 * cycles)
    assert record.mean == pytest.approx(SPEED, rel=1e-13)
    found = record.harmonics("disc", ORDERS, noise=0.1)
    np.testing.assert_allclose(found.harmonics, WAVES, atol=1e-11)
    np.testing.assert_allclose(found.noise, 0.1 * np.sqrt(2 / (64 * cycles)))


def test_orders_that_a_record_can_tell() -> None:
    angle = 4 * np.pi * np.arange(16) / 16
    record = recorded_speed(angle, wave(angle), 2)
    # Eight waves in sixteen samples have no phase; 0.7 does not repeat.
    assert record.orders(np.array([0.5, 0.7, 1.0, 3.5, 4.0])).tolist() == [0.5, 1.0, 3.5]


def test_angles_printed_with_few_digits_are_even() -> None:
    angle = np.radians(np.round(720 * np.arange(175) / 175, 2))
    assert recorded_speed(angle, wave(angle), 2).turns == 2


EVEN = np.radians(np.arange(0.0, 720.0, 10.0))


@pytest.mark.parametrize(
    ("angle", "words"),
    [
        (EVEN[:36], r"speed from 0° to 350° in steps of 10°: expected whole cycles of 720°"),
        (EVEN[:70], "expected whole cycles"),
        (np.delete(EVEN, 20), r"a step of 20° after 190°"),
        (EVEN[::-1], "expected even steps that increase"),
        (0 * EVEN, "expected even steps that increase"),
        (np.where(EVEN[5] == EVEN, np.nan, EVEN), r"after 40°: expected even steps"),
    ],
)
def test_angles_that_make_no_cycle(angle: np.ndarray, words: str) -> None:
    with pytest.raises(InputError, match=words):
        recorded_speed(angle, np.full(len(angle), SPEED), 2)


def test_lists_that_do_not_fit() -> None:
    with pytest.raises(ShapeError, match="72 angles and 71 speeds"):
        recorded_speed(EVEN, EVEN[1:], 2)
    with pytest.raises(ShapeError, match="at least 8"):
        recorded_speed(EVEN[:3], EVEN[:3], 2)


@pytest.fixture(scope="module")
def engine() -> lw.Machine:
    """A V-8 whose cylinder 3 burns 60 %."""
    return lw.read(Path(__file__).parents[2] / "examples" / "weak_cylinder" / "machine.toml")


def record(machine: lw.Machine, disc: str, zero: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Angles from some crank angle on, and the speed of a disc, without noise."""
    found = forced_vibration(machine, np.array([SPEED]))
    waves = 1j * found.orders * SPEED * found.amplitudes[:, found.discs.index(disc), 0]
    angle = 4 * np.pi * np.arange(360) / 360
    return angle, SPEED + (np.exp(1j * np.outer(angle + zero, found.orders)) @ waves).real


def test_weak_cylinder_is_found(engine: lw.Machine) -> None:
    read = record_diagnosis(engine, "flywheel", *record(engine, "flywheel"), noise=1e-3)
    assert read.speed == pytest.approx(SPEED, rel=1e-12)
    assert read.orders == 48
    np.testing.assert_allclose(read.found.factor, [1, 1, 0.6, 1, 1, 1, 1, 1], atol=1e-8)
    assert read.weak() == ("3",)
    assert read.warnings == ()


def test_torques_of_fixed_frequency_are_left_out(engine: lw.Machine) -> None:
    """Lines of an inverter at 1× and 2× supply and beside an order fade in a long record."""
    harmonics = [
        {"frequency": "50 Hz", "torque": 90.0},
        {"frequency": "100 Hz", "torque": 40.0},
        {"order": 4, "frequency": "-31 Hz", "torque": 60.0},
    ]
    noisy = lw.replace(engine, {"train.excitations": {"grid": {"on": "generator", "harmonics": harmonics}}})
    found = forced_vibration(noisy, np.array([SPEED]))
    waves = 1j * found.omega[:, 0, 0] * found.amplitudes[:, found.discs.index("flywheel"), 0]
    cycles = 200
    angle = 4 * np.pi * np.arange(360 * cycles) / 360
    turned = np.exp(1j * np.outer(angle, found.omega[:, 0, 0] / SPEED))
    speed = SPEED + (turned @ waves).real
    lines = np.abs(waves[found.offsets != 0])
    assert len(lines) == 3
    read = record_diagnosis(noisy, "flywheel", angle, speed, noise=float(lines.max()))
    assert read.orders == 48
    np.testing.assert_allclose(read.found.factor, [1, 1, 0.6, 1, 1, 1, 1, 1], atol=0.01)
    alone = record_diagnosis(engine, "flywheel", angle, speed, noise=float(lines.max()))
    np.testing.assert_array_equal(read.found.factor, alone.found.factor)


@pytest.mark.parametrize("cylinder", [1, 3, 8])
def test_angle_counted_from_a_firing(engine: lw.Machine, cylinder: int) -> None:
    assert engine.train is not None
    assert engine.train.engine is not None
    parts = engine.train.engine
    fires = firing_angles(parts.places, parts.firing_order, parts.cycle)[0][cylinder - 1]
    angle, speed = record(engine, "front", fires)
    read = record_diagnosis(engine, "front", angle, speed, noise=1e-3, zero=cylinder)
    assert read.weak() == ("3",)


def test_a_record_from_elsewhere_names_nobody(engine: lw.Machine) -> None:
    """The speed of the flywheel, told to be that of the generator behind the soft coupling."""
    read = record_diagnosis(engine, "generator", *record(engine, "flywheel"), noise=1e-3)
    assert not read.is_plausible
    assert read.weak() == ()
    assert "is not physical" in read.warnings[-1]


def test_another_load_than_that_of_the_file(engine: lw.Machine) -> None:
    more = lw.replace(engine, {"train.engine.gas.mean_effective_pressure": 9e5})
    read = record_diagnosis(more, "flywheel", *record(engine, "flywheel"), noise=1e-3)
    assert read.is_plausible
    assert np.argmin(read.found.relative) == 2
    assert "on average" in read.warnings[-1]


@pytest.mark.parametrize(
    ("disc", "zero", "words"),
    [("fly", None, r'found "fly".*"flywheel"'), ("front", 9, "zero: found 9, expected .* 1 to 8")],
)
def test_what_the_engine_has_not(engine: lw.Machine, disc: str, zero: int | None, words: str) -> None:
    with pytest.raises(InputError, match=words):
        record_diagnosis(engine, disc, *record(engine, "front"), zero=zero)


def test_speed_that_does_not_turn(engine: lw.Machine) -> None:
    with pytest.raises(InputError, match="mean speed of 0 rad/s"):
        record_diagnosis(engine, "front", EVEN, 0 * EVEN)


def test_machine_without_an_engine() -> None:
    with pytest.raises(InputError, match=r"no \[train.engine\]"):
        record_diagnosis(lw.loads(template("slider-crank")), "a", EVEN, EVEN)
