"""Co-simulation of drives by fmpy against `transient`, whatever the communication steps."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
from conftest import Unpacked
from fmus import combined, opened

import linkwright as lw
from linkwright.linkages.law import PolynomialLaw

VERSIONS = ("2.0", "3.0")
# Of the speed and of 2π.
_CLOSE = 1e-8


def reference(machine: Any, times: np.ndarray, **start: Any) -> tuple[np.ndarray, np.ndarray]:
    return lw.transient(machine, duration=float(times[-1]), accuracy=1e-12, **start).at(times)


def followed(folder: Any, times: np.ndarray, values: Any = (), tolerance: float = 1e-11) -> np.ndarray:
    with opened(folder) as unit:
        unit.start(dict(values), tolerance=tolerance)
        return np.array(unit.run(list(times), "crank_angle", "crank_speed")).T


@pytest.mark.deep
@pytest.mark.parametrize(
    ("name", "version"),
    combined(["roller_two_carts", "press_from_rest", "fan_by_formula", "roller_cam"], VERSIONS),
)
def test_a_run_up_is_that_of_transient(name: str, version: str, unpacked: Unpacked) -> None:
    """From rest to work, a drive runs up in a tool as in `transient`, to 1e-8 of angle and speed."""
    machine = lw.read(name)
    speed = lw.steady_state(machine).speed_mean_time
    times = np.linspace(0.0, 3 * 2 * np.pi / speed, 200)
    angle, omega = reference(machine, times)
    found = followed(unpacked(machine, version), times)
    assert np.abs(found[0] - angle).max() < _CLOSE * 2 * np.pi
    assert np.abs(found[1] - omega).max() < _CLOSE * speed


def test_steady_motion(unpacked: Unpacked) -> None:
    """From the steady motion on, the speed repeats after a revolution, as collocation says."""
    machine = lw.read("roller_two_carts")
    steady = lw.steady_state(machine)
    times = np.array([0.0, steady.period])
    start = {"crank_speed": float(steady.speed[0])}
    found = followed(unpacked(machine), times, start)
    assert abs(found[0, 1] - 2 * np.pi) < 1e-8
    assert abs(found[1, 1] - steady.speed[0]) < 1e-8 * steady.speed[0]


@pytest.mark.parametrize("parts", [1, 7, 1000])
def test_communication_steps_do_not_matter(parts: int, unpacked: Unpacked) -> None:
    """One communication step or a thousand: the end of the motion is the same to 1e-8."""
    machine = lw.read("press_from_rest")
    times = np.linspace(0.0, 2.0, parts + 1)
    angle, speed = reference(machine, times[[0, -1]])
    found = followed(unpacked(machine), times)[:, -1]
    assert abs(found[0] - angle[-1]) < _CLOSE * 2 * np.pi
    assert abs(found[1] - speed[-1]) < _CLOSE * speed[-1]


def test_supply_off_and_on_again(unpacked: Unpacked) -> None:
    """The motor is switched off and on again: each part is that of `transient` from the state before."""
    machine = lw.read("roller_two_carts")
    work = lw.steady_state(machine).speed_mean_time
    now, times = (0.3, work), np.array([0.0, 0.2])
    with opened(unpacked(machine)) as unit:
        unit.start({"crank_angle": now[0], "crank_speed": now[1]}, tolerance=1e-11)
        for nth, motor in enumerate((True, False, True)):
            unit.set({"motor_on": motor})
            unit.step(nth * 0.2, 0.2)
            angle, speed = reference(machine, times, angle=now[0], speed=now[1], motor=motor)
            now = float(angle[-1]), float(speed[-1])
            assert unit.get("crank_angle", "crank_speed") == pytest.approx(now, rel=1e-8)
            assert (unit.get("torque_drive")[0] == 0.0) == (not motor)


def test_a_brake_stops_and_holds(unpacked: Unpacked) -> None:
    """Switched off and braked, the machine comes to rest where `transient` has it, and stays there."""
    machine = lw.read("roller_two_carts", ['drive.brake.torque="600 N m"', 'drive.brake.on="crank"'])
    work = lw.steady_state(machine).speed_mean_time
    rest = lw.transient(machine, speed=work, motor=False, brake=True, turns=20, accuracy=1e-12)
    assert rest.came_to_rest
    with opened(unpacked(machine)) as unit:
        unit.start({"crank_speed": work, "motor_on": False, "brake_torque": 600.0}, tolerance=1e-11)
        unit.step(0.0, 1.25 * float(rest.time[-1]))
        assert unit.flag("at_rest")
        angle, speed = unit.get("crank_angle", "crank_speed")
        assert speed == 0.0
        assert angle == pytest.approx(float(rest.crank_angle[-1]), abs=1e-7)
        unit.step(1.25 * float(rest.time[-1]), 1.0)
        assert unit.get("crank_angle") == [angle]


def test_an_external_torque_is_one_of_the_file(unpacked: Unpacked) -> None:
    """A torque that the tool applies moves the crank as the same torque of the file does."""
    machine = lw.read("roller_one_cart")
    loaded = lw.read(
        "roller_one_cart",
        [
            'loads.extra.kind="torque_angle"',
            'loads.extra.angle="0, 360 deg"',
            'loads.extra.torque="120, 120 N m"',
        ],
    )
    times = np.linspace(0.0, 1.0, 11)
    angle, speed = reference(loaded, times)
    found = followed(unpacked(machine), times, {"external_torque": -120.0})
    assert np.abs(found - np.array([angle, speed])).max() < 1e-7


def test_a_load_step_on_the_way(unpacked: Unpacked) -> None:
    """Work of motor, loads and torque from outside is the gain of kinetic energy over a load step."""
    machine = lw.read("roller_two_carts")
    work = lw.steady_state(machine).speed_mean_time
    times = np.linspace(0.0, 1.0, 4001)
    names = ("energy_kinetic", "torque_drive", "torque_load", "crank_speed")
    with opened(unpacked(machine)) as unit:
        unit.start({"crank_speed": work}, tolerance=1e-11)
        rows = []
        for start, end in itertools.pairwise(times):
            unit.set({"external_torque": -200.0 if start >= 0.4 else 0.0})
            rows.append(unit.get(*names))
            unit.step(float(start), float(end - start))
            rows.append(unit.get(*names))
    energy, drive, load, speed = np.array(rows).T
    power = ((drive - load) * speed).reshape(-1, 2)
    gained = power.mean(axis=1) @ np.diff(times)
    assert energy[-1] - energy[0] == pytest.approx(gained, rel=1e-4)


def test_clockwise(unpacked: Unpacked) -> None:
    """A motor that drives clockwise runs the crank up as `transient` has it, at negative speeds."""
    machine = lw.read("roller_two_carts")
    times = np.linspace(0.0, 1.0, 20)
    angle, speed = reference(machine, times, clockwise=True)
    found = followed(unpacked(machine, clockwise=True), times)
    assert speed[-1] < -1
    assert np.abs(found - np.array([angle, speed])).max() < 1e-7


def test_torques_are_those_of_the_steady_motion(unpacked: Unpacked) -> None:
    """At angles and speeds of the steady motion, torques, power, inertia and acceleration are its curves."""
    machine = lw.read("roller_two_carts")
    steady = lw.steady_state(machine, n=12)
    names = {
        "torque_motor": steady.torque_motor,
        "torque_drive": steady.torque_drive,
        "torque_load": steady.torque_load,
        "power_motor": steady.power_motor,
        "inertia_reduced": steady.inertia_reduced,
        "crank_acceleration": steady.acceleration,
    }
    # Between the kinks of dry friction, where a torque has one value.
    for k in (1, 2, 4, 5, 7, 8):
        with opened(unpacked(machine)) as unit:
            start = {"crank_angle": float(steady.crank_angle[k]), "crank_speed": float(steady.speed[k])}
            unit.start(start)
            for name, curve in names.items():
                size = float(np.abs(curve).max())
                assert unit.get(name)[0] == pytest.approx(float(curve[k]), abs=1e-9 * size), name
            ratio = float(machine.drive.gearbox.ratio)
            assert unit.get("speed_motor")[0] == pytest.approx(ratio * steady.speed[k], rel=1e-14)
            energy = 0.5 * steady.inertia_reduced[k] * steady.speed[k] ** 2
            assert unit.get("energy_kinetic")[0] == pytest.approx(energy, rel=1e-12)


@pytest.mark.parametrize("version", VERSIONS)
def test_the_mechanism_moves_as_motion_has_it(version: str, unpacked: Unpacked) -> None:
    """Position, velocity and acceleration of points, links and slides are those of `motion`."""
    machine = lw.read("roller_two_carts")
    with opened(unpacked(machine, version)) as unit:
        unit.start({"crank_angle": 0.7, "crank_speed": 9.0})
        epsilon = unit.get("crank_acceleration")[0]
        moving = lw.motion(machine, PolynomialLaw((0.7, 9.0, epsilon / 2)), [0.0, 1e-3])
        names = {"points": ("x", "y", "vx", "vy", "ax", "ay"), "links": ("angle", "speed", "acceleration")}
        names["slides"] = ("position", "velocity", "acceleration")
        for part, columns in names.items():
            for name, path in getattr(moving, part).items():
                if name == "O":
                    continue
                found = unit.get(*(f"{part}.{name}.{column}" for column in columns))
                rates = [path.position[0], path.velocity[0], path.acceleration[0]]
                expected = np.concatenate([np.atleast_1d(rate) for rate in rates])
                if part == "links":
                    expected[0] = np.angle(np.exp(1j * expected[0]))
                assert found == pytest.approx(expected, rel=1e-11, abs=1e-11), (part, name)
