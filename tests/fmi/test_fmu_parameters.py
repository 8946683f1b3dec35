"""Parameters of an FMU against the machine file with other entries."""

from __future__ import annotations

import pytest
from conftest import Unpacked
from fmus import opened

import linkwright as lw
from linkwright.fmi.variables import Group, Variable

NAMES = ("crank_acceleration", "torque_motor", "torque_drive", "torque_load", "inertia_reduced")


@pytest.mark.parametrize("name", ["roller_two_carts", "press_from_rest", "fan_by_formula"])
def test_a_parameter_is_the_entry_of_the_file(name: str, unpacked: Unpacked) -> None:
    """Each parameter, set to another value, gives the acceleration that `transient` has of that file."""
    machine = lw.read(name)
    parameters = entries(machine)
    assert len(parameters) >= 6
    with opened(unpacked(machine)) as unit:
        unit.start({"crank_angle": 0.6, "crank_speed": 5.0})
        (before,) = unit.get("crank_acceleration")
        moved = 0
        for variable in parameters:
            value = changed_value(variable)
            changed = lw.replace(machine, {entry_of(machine, variable.name): value})
            expected = lw.transient(changed, angle=0.6, speed=5.0, duration=1e-3).acceleration[0]
            unit.set({variable.name: value})
            (found,) = unit.get("crank_acceleration")
            assert found == pytest.approx(float(expected), rel=1e-9, abs=1e-9), variable.name
            moved += found != before
            unit.set({variable.name: float(variable.start or 0.0)})
        assert moved > len(parameters) / 2
        assert unit.get("crank_acceleration") == [before]


def entries(machine: lw.Machine) -> list[Variable]:
    """Parameters that are entries of the file."""
    return [each for each in lw.fmu(machine).named("parameter") if each.group == Group.PARAMETER]


def changed_value(variable: Variable) -> float:
    """Another value of a parameter, within its bounds."""
    value = 1.25 * float(variable.start or 0.004)
    assert variable.bounds is not None
    return value if value <= variable.bounds[1] else 0.8 * float(variable.start or 0.0)


def entry_of(machine: lw.Machine, name: str) -> str:
    """The address of a parameter: quotes of structured names are other ones."""
    known = {address.replace('"', ""): address for address in lw.addresses(machine)}
    return known[name]


def test_several_parameters_at_once(unpacked: Unpacked) -> None:
    """All parameters changed together are the file with all of these entries."""
    machine = lw.read("roller_two_carts")
    parameters = [v for v in entries(machine) if v.start and v.bounds and v.bounds[1] > 1]
    values = {variable.name: 1.2 * float(variable.start or 0.0) for variable in parameters}
    changed = lw.replace(machine, {entry_of(machine, name): value for name, value in values.items()})
    start = {"crank_angle": 2.1, "crank_speed": 8.0}
    with opened(unpacked(machine)) as own, opened(unpacked(changed)) as other:
        own.start({**start, **values})
        other.start(start)
        assert own.get(*NAMES) == pytest.approx(other.get(*NAMES), rel=1e-10, abs=1e-9)


def test_lengths_are_no_parameters() -> None:
    """What shapes the motion of the mechanism stays fixed: no entry of [mechanism] is offered."""
    for name in ("roller_two_carts", "roller_cam", "bearing_loads_of_a_press"):
        assert not [
            v.name for v in lw.fmu(lw.read(name)).named("parameter") if v.name.startswith("mechanism")
        ]


def test_a_parameter_that_is_tuned_on_the_way(unpacked: Unpacked) -> None:
    """A load that is doubled on the way: the motion goes on as `transient` of the changed file from there."""
    machine = lw.read("roller_two_carts")
    heavier = lw.replace(machine, {"loads.rolling1.force": 7124.0})
    first = lw.transient(machine, duration=0.4, accuracy=1e-12)
    state = {"angle": float(first.crank_angle[-1]), "speed": float(first.speed[-1])}
    second = lw.transient(heavier, **state, duration=0.3, accuracy=1e-12)
    with opened(unpacked(machine)) as unit:
        unit.start(tolerance=1e-11)
        unit.step(0.0, 0.4)
        unit.set({"loads.rolling1.force": 7124.0})
        unit.step(0.4, 0.3)
        assert unit.get("crank_angle", "crank_speed") == pytest.approx(
            [float(second.crank_angle[-1]), float(second.speed[-1])], rel=1e-8
        )
