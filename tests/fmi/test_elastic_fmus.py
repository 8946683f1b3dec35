"""FMUs of torsionally flexible drivelines, and of trains with mechanisms, against `elastic_transient`."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import Unpacked
from fmus import combined, opened, simulated
from sizes import DEEP

import linkwright as lw
from linkwright import DriveSwitch
from linkwright.fmi.variables import Group

VERSIONS = ("2.0", "3.0")


@pytest.mark.deep
@pytest.mark.parametrize(
    ("name", "version"),
    combined(["elastic_coupling_of_carts", "rattling_backlash", "press_line_two_motors"], VERSIONS),
)
def test_a_run_up_is_that_of_elastic_transient(name: str, version: str, unpacked: Unpacked) -> None:
    """Shafts, backlash, several motors: the crank runs up in a tool as in `elastic_transient`, to 1e-8."""
    machine = lw.read(name)
    times = np.linspace(0.0, 1.0, 40)
    expected = lw.elastic_transient(machine, duration=1.0, accuracy=1e-12, times=times)
    assert expected.end == "time"
    with opened(unpacked(machine, version)) as unit:
        unit.start(tolerance=1e-12)
        found = np.array(unit.run(list(times), "crank_angle"))[:, 0]
    assert np.abs(found - expected.crank_angle).max() < 1e-8 * 2 * np.pi


def test_twists_are_states(unpacked: Unpacked) -> None:
    """Twist and slip of the motor against the crank are angles and speeds of the stations, less the crank."""
    machine = lw.read("elastic_coupling_of_carts")
    times = np.linspace(0.0, 0.5, 6)
    expected = lw.elastic_transient(machine, duration=0.5, accuracy=1e-12, times=times)
    with opened(unpacked(machine)) as unit:
        unit.start(tolerance=1e-12)
        rows = np.array(unit.run(list(times), "driveline.motor.twist", "driveline.motor.slip", "speed_motor"))
    ratio = float(machine.drive.gearbox.ratio)
    station = expected.stations.index("motor")
    crank = expected.speed[-1]
    assert rows[:, 0] == pytest.approx(
        expected.angle[station] / expected.ratio[station] - expected.angle[-1], abs=1e-9
    )
    assert rows[:, 1] == pytest.approx(expected.speed[station] / expected.ratio[station] - crank, abs=1e-7)
    assert rows[:, 2] == pytest.approx(expected.speed[station] * ratio / expected.ratio[station], abs=1e-6)


def test_stations_and_shafts_at_their_own_speed(unpacked: Unpacked) -> None:
    """Speeds of stations, torques and twists of shafts are those of `elastic_transient`, at their speeds."""
    for name in ("elastic_coupling_of_carts", "press_line_two_motors", "drive_line_torsion"):
        machine = lw.read(name)
        times = np.linspace(0.0, 0.4, 5)
        expected = lw.elastic_transient(machine, duration=0.4, accuracy=1e-12, times=times)
        with opened(unpacked(machine)) as unit:
            stations = [each for each in expected.stations if f"driveline.{each}.speed" in unit.variables]
            assert len(stations) == expected.twist.shape[0]
            unit.start(tolerance=1e-12)
            names = [f"driveline.{each}.speed" for each in stations]
            names += [f"shafts.{each}.{of}" for of in ("torque", "twist") for each in expected.shafts]
            rows = np.array(unit.run(list(times), *names)).T
        speeds = expected.speed[[expected.stations.index(each) for each in stations]]
        for found, curve in zip(rows, [*speeds, *expected.torque, *expected.twist], strict=True):
            assert np.abs(found - curve).max() < 1e-7 * max(np.abs(curve).max(), 1e-3), name


def test_the_brake_acts_on_the_motor_shaft(unpacked: Unpacked) -> None:
    """A brake on the motor shaft of an elastic drive stops the motor, and the crank by the shaft."""
    sets = ['drive.brake.torque="60 N m"', 'drive.brake.on="motor"']
    machine = lw.read("elastic_coupling_of_carts", sets)
    ratio = float(machine.drive.gearbox.ratio)
    times = np.array([0.0, 0.15])
    switches = (DriveSwitch(0.8, motor=False, brake=True),)
    ends = np.array([0.0, 0.8, 0.95])
    expected = lw.elastic_transient(machine, duration=0.95, accuracy=1e-12, times=ends, switches=switches)
    with opened(unpacked(machine)) as unit:
        unit.start(tolerance=1e-12)
        unit.step(0.0, 0.8)
        unit.set({"motor_on": False, "brake_torque": 60.0 * ratio})
        unit.step(0.8, float(times[-1]))
        assert unit.get("crank_angle")[0] == pytest.approx(float(expected.crank_angle[-1]), abs=1e-7)
        assert unit.get("crank_speed")[0] == pytest.approx(float(expected.speed[-1, -1]), abs=1e-6)


def test_supply_off_and_on_again(unpacked: Unpacked) -> None:
    """Switched off and on again, the driveline moves as by switches of `elastic_transient`."""
    machine = lw.read("elastic_coupling_of_carts")
    switches = (DriveSwitch(0.5, motor=False), DriveSwitch(0.7, motor=True))
    times = np.array([0.0, 0.5, 0.7, 1.0])
    expected = lw.elastic_transient(machine, duration=1.0, accuracy=1e-12, times=times, switches=switches)
    with opened(unpacked(machine)) as unit:
        unit.start(tolerance=1e-12)
        unit.step(0.0, 0.5)
        unit.set({"motor_on": False})
        unit.step(0.5, 0.2)
        unit.set({"motor_on": True})
        unit.step(0.7, 0.3)
        assert unit.get("crank_angle")[0] == pytest.approx(float(expected.crank_angle[-1]), abs=1e-7)


@pytest.mark.deep
@pytest.mark.parametrize("version", VERSIONS if DEEP else VERSIONS[:1])
def test_cvode_runs_it_up(version: str, unpacked: Unpacked) -> None:
    """CVode at 1e-9 follows the run-up of an elastic drive by derivatives and events of the FMU."""
    machine = lw.read("elastic_coupling_of_carts")
    found = simulated(
        unpacked(machine, version), "ModelExchange", 0.6, 0.03, ["crank_angle"], relative_tolerance=1e-9
    )
    times = np.unique(np.clip(found["time"], 0.0, 0.6))
    expected = lw.elastic_transient(machine, duration=0.6, accuracy=1e-12, times=times).crank_angle
    at = np.searchsorted(times, np.clip(found["time"], 0.0, 0.6))
    assert np.abs(found["crank_angle"] - expected[at]).max() < 1e-5


def test_derivatives_by_twist_and_stiffness(unpacked: Unpacked) -> None:
    """By twists, speeds and entries of the shaft, accelerations change as differences of order eight."""
    machine = lw.read("elastic_coupling_of_carts")
    folder = unpacked(machine)
    state = {
        "crank_angle": 0.9,
        "crank_speed": 8.0,
        "driveline.motor.twist": 0.01,
        "driveline.motor.slip": 0.2,
    }
    stiffness = float(machine.drive.crankshaft.stiffness)
    knowns = {**state, "drive.crankshaft.stiffness": stiffness, "bodies.cart1.mass": 1000.0}
    unknowns = ["crank_acceleration", "der(driveline.motor.slip)", "torque_drive", "energy_kinetic"]

    def values(known: str, x: float) -> np.ndarray:
        with opened(folder, exchange=True) as unit:
            unit.start({**state, known: x})
            return np.array(unit.get(*unknowns))

    weights = {1: 4 / 5, 2: -1 / 5, 3: 4 / 105, 4: -1 / 280}
    for known, at in knowns.items():
        step = 2e-3 * at
        pairs = {k: values(known, at + k * step) - values(known, at - k * step) for k in weights}
        expected = sum(weight * pairs[k] for k, weight in weights.items()) / step
        base = np.abs(values(known, at)) / at
        with opened(folder, exchange=True) as unit:
            unit.start(state)
            found = np.array(unit.along(unknowns, known))
        assert (np.abs(found - expected) <= 1e-9 * np.maximum(np.abs(expected), base)).all(), known


@pytest.mark.parametrize("name", ["elastic_coupling_of_carts", "rattling_backlash"])
def test_a_parameter_is_the_entry_of_the_file(name: str, unpacked: Unpacked) -> None:
    """Each parameter of shaft, drive, bodies and loads gives the motion of the file with that entry."""
    machine = lw.read(name)
    known = {address.replace('"', ""): address for address in lw.addresses(machine)}
    parameters = [v for v in lw.fmu(machine).named("parameter") if v.group == Group.PARAMETER]
    assert "drive.crankshaft.stiffness" in {variable.name for variable in parameters}
    with opened(unpacked(machine)) as unit:
        unit.start({"crank_angle": 0.7, "crank_speed": 6.0}, tolerance=1e-12)
        state = unit.kept()
        for variable in parameters:
            value = 1.25 * float(variable.start or 0.004)
            value = min(value, (variable.bounds or (0.0, value))[1])
            changed = lw.replace(machine, {known[variable.name]: value})
            expected = lw.elastic_transient(changed, angle=0.7, speed=6.0, duration=0.05, accuracy=1e-12)
            unit.restore(state)
            unit.set({variable.name: value})
            unit.step(0.0, 0.05)
            found = unit.get("crank_angle", "crank_speed")
            end = float(expected.crank_angle[-1]), float(expected.speed[-1, -1])
            assert found == pytest.approx(end, rel=1e-9), variable.name


def test_it_can_be_exported_as_rigid(unpacked: Unpacked) -> None:
    """With `rigid`, an elastic driveline is the rigid drive that `transient` has."""
    machine = lw.read("elastic_coupling_of_carts")
    expected = lw.transient(machine, duration=0.8, accuracy=1e-12)
    with opened(unpacked(machine, rigid=True)) as unit:
        assert "driveline.motor.twist" not in unit.variables
        unit.start(tolerance=1e-12)
        unit.step(0.0, 0.8)
        assert unit.get("crank_angle")[0] == pytest.approx(float(expected.crank_angle[-1]), abs=1e-7)


def test_the_state_goes_into_another_instance(unpacked: Unpacked) -> None:
    """Twists and forms of links with backlash are part of the state: another instance goes on bit for bit."""
    folder = unpacked("rattling_backlash")
    names = ("crank_angle", "crank_speed", "driveline.motor.twist", "driveline.motor.slip")
    with opened(folder) as one, opened(folder) as other:
        one.start()
        one.step(0.0, 0.31)
        other.start()
        other.restore(one.kept())
        one.step(0.31, 0.2)
        other.step(0.31, 0.2)
        assert one.get(*names) == other.get(*names)
