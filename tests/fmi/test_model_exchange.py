"""Model exchange: fmpy's CVode integrates, and the FMU reports its events."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import Unpacked
from fmus import combined, opened, simulated

import linkwright as lw

VERSIONS = ("2.0", "3.0")


@pytest.mark.deep
@pytest.mark.parametrize(("name", "version"), combined(["roller_two_carts", "press_from_rest"], VERSIONS))
def test_cvode_runs_it_up(name: str, version: str, unpacked: Unpacked) -> None:
    """CVode at 1e-9 follows a run-up through kinks of dry friction as `transient`, within its own error."""
    machine = lw.read(name)
    stop = 1.5
    reference = lw.transient(machine, duration=stop, accuracy=1e-12)
    found = simulated(
        unpacked(machine, version),
        "ModelExchange",
        stop,
        stop / 50,
        ["crank_angle", "crank_speed"],
        relative_tolerance=1e-9,
    )
    angle, speed = reference.at(np.minimum(found["time"], stop))
    assert np.abs(found["crank_angle"] - angle).max() < 1e-5
    assert np.abs(found["crank_speed"] - speed).max() < 1e-5 * speed.max()


@pytest.mark.parametrize("version", VERSIONS)
def test_derivatives_are_the_equation_of_motion(version: str, unpacked: Unpacked) -> None:
    """The derivatives of the states are speed and acceleration of the steady motion at its angles."""
    steady = lw.steady_state(lw.read("roller_two_carts"), n=12)
    for k in (1, 4, 8):
        with opened(unpacked("roller_two_carts", version), exchange=True) as unit:
            unit.start({"crank_angle": float(steady.crank_angle[k]), "crank_speed": float(steady.speed[k])})
            found = unit.get("der(crank_angle)", "crank_acceleration")
            assert found[0] == float(steady.speed[k])
            size = float(np.abs(steady.acceleration).max())
            assert found[1] == pytest.approx(float(steady.acceleration[k]), abs=1e-9 * size)


@pytest.mark.parametrize("version", VERSIONS)
def test_it_comes_to_rest_and_stays(version: str, unpacked: Unpacked) -> None:
    """Without motor the machine comes to rest under dry friction: an event sets the speed to zero."""
    machine = lw.read("roller_one_cart")
    rest = lw.transient(machine, angle=0.4, speed=3.0, motor=False, turns=20, accuracy=1e-12)
    assert rest.came_to_rest
    stop = 1.5 * float(rest.time[-1])
    found = simulated(
        unpacked(machine, version),
        "ModelExchange",
        stop,
        stop / 40,
        ["crank_angle", "crank_speed", "at_rest"],
        relative_tolerance=1e-9,
        start_values={"crank_angle": 0.4, "crank_speed": 3.0, "motor_on": False},
    )
    assert found["at_rest"][-1]
    assert not found["at_rest"][1]
    assert found["crank_speed"][-1] == 0.0
    assert found["crank_angle"][-1] == pytest.approx(float(rest.crank_angle[-1]), abs=1e-5)


def test_it_is_torn_loose_by_an_input(unpacked: Unpacked) -> None:
    """At rest under dry friction, a torque from outside moves the crank once it exceeds the load torque."""
    machine = lw.read("roller_one_cart")
    off = {"crank_angle": 0.4, "motor_on": False}
    with opened(unpacked(machine)) as unit:
        unit.start(off)
        unit.step(0.0, 0.1)
        assert unit.flag("at_rest")
        hold = _needed(machine, 0.4)
        unit.set({"external_torque": 0.999 * hold})
        unit.step(0.1, 0.1)
        assert unit.flag("at_rest")
        assert unit.get("crank_angle") == [0.4]
        unit.set({"external_torque": 1.001 * hold})
        unit.step(0.2, 0.1)
        assert not unit.flag("at_rest")
        assert unit.get("crank_angle")[0] > 0.4


def _needed(machine: lw.Machine, angle: float) -> float:
    """Torque on the crank that loads need to be overcome from rest [N m]."""
    motion = lw.transient(machine, angle=angle, motor=False, duration=1.0)
    assert motion.came_to_rest
    return motion.torque_load_end
