"""The state of an FMU: kept, restored, and written as bytes, bit for bit."""

from __future__ import annotations

import pytest
from conftest import Unpacked
from fmus import opened

VERSIONS = ("2.0", "3.0")
NAMES = ("crank_angle", "crank_speed", "crank_acceleration", "torque_load", "energy_kinetic")


@pytest.mark.parametrize("version", VERSIONS)
def test_a_motion_from_a_kept_state_is_the_same(version: str, unpacked: Unpacked) -> None:
    """A step after restoring gives the numbers of the step after keeping, inputs and parameters too."""
    with opened(unpacked("roller_two_carts", version)) as unit:
        unit.start({"bodies.cart1.mass": 1234.0})
        unit.step(0.0, 0.3)
        unit.set({"external_torque": -55.0, "motor_on": False})
        state = unit.kept()
        unit.step(0.3, 0.2)
        first = unit.get(*NAMES)
        unit.set({"external_torque": 70.0, "motor_on": True})
        unit.step(0.5, 0.4)
        unit.restore(state)
        assert unit.kept() == state
        unit.step(0.3, 0.2)
        assert unit.get(*NAMES) == first


@pytest.mark.parametrize("version", VERSIONS)
def test_bytes_go_into_another_instance(version: str, unpacked: Unpacked) -> None:
    """Bytes of one instance restore another one of the same FMU, which goes on to the very same numbers."""
    folder = unpacked("press_from_rest", version)
    with opened(folder) as one, opened(folder) as other:
        one.start()
        one.step(0.0, 0.7)
        other.start({"crank_speed": 3.0})
        other.restore(one.kept())
        one.step(0.7, 0.5)
        other.step(0.7, 0.5)
        assert one.get(*NAMES) == other.get(*NAMES)


@pytest.mark.parametrize("version", VERSIONS)
def test_bytes_of_another_machine_are_refused(version: str, unpacked: Unpacked) -> None:
    """Bytes that are cut, changed, or of another machine are an error with a message; the state stays."""
    with opened(unpacked("press_from_rest", version)) as foreign:
        foreign.start()
        foreign_state = foreign.kept()
    log: list[str] = []
    with opened(unpacked("roller_two_carts", version), logged=log) as unit:
        unit.start({"crank_speed": 4.0})
        state = unit.kept()
        before = unit.get(*NAMES)
        damaged = [state[:-3], b"", b"\x00" * len(state), foreign_state, state + b"\x01"]
        for nth, data in enumerate(damaged):
            with pytest.raises(Exception, match=r"(?i)FMUstate"):
                unit.restore(data)
            assert len(log) > nth
        assert unit.get(*NAMES) == before


def test_instances_do_not_touch_each_other(unpacked: Unpacked) -> None:
    """Two instances of one FMU with different inputs move apart, each as it would alone."""
    folder = unpacked("roller_two_carts")
    with opened(folder) as alone:
        alone.start()
        alone.step(0.0, 0.5)
        expected = alone.get(*NAMES)
    with opened(folder) as one, opened(folder) as other:
        one.start()
        other.start({"external_torque": -300.0})
        one.step(0.0, 0.25)
        other.step(0.0, 0.25)
        assert one.get("crank_speed") != other.get("crank_speed")
    with opened(folder) as again:
        again.start()
        again.step(0.0, 0.5)
        assert again.get(*NAMES) == expected


@pytest.mark.parametrize("version", VERSIONS)
def test_reset_is_the_start(version: str, unpacked: Unpacked) -> None:
    """After a reset and a new initialisation the motion is that of a new instance."""
    with opened(unpacked("roller_two_carts", version)) as unit:
        unit.start({"external_torque": -100.0, "bodies.cart1.mass": 700.0})
        unit.step(0.0, 0.4)
        unit.fmu.reset()
        unit.start()
        unit.step(0.0, 0.4)
        found = unit.get(*NAMES)
    with opened(unpacked("roller_two_carts", version)) as fresh:
        fresh.start()
        fresh.step(0.0, 0.4)
        assert fresh.get(*NAMES) == found
