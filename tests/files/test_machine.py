"""Descriptions: motors complete themselves, names are resolved, entries are exchanged by address."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from linkwright import Machine, MachineError, addresses, get, loads, motors, replace
from linkwright.drive import DcMotor, InductionMotor, motor
from linkwright.kernel.files.library import template
from linkwright.kernel.units.kinds import ANGLE, LENGTH
from linkwright.linkages.model.mechanism import Mechanism
from linkwright.machine import kind

RATED: dict[str, Any] = {
    "kind": "induction",
    "speed_synchronous": "1000 rpm",
    "speed_rated": "970 rpm",
    "torque_rated": "100 N m",
    "torque_breakdown": "250 N m",
}


def kloss(motor: InductionMotor, slip: float) -> float:
    """Torque of an induction motor by Kloss's formula [N·m]."""
    omega_0, M_k, omega_k, a = (
        motor.speed_synchronous,
        motor.torque_breakdown,
        motor.speed_breakdown,
        motor.resistance_ratio,
    )
    assert omega_0 is not None
    assert M_k is not None
    assert omega_k is not None
    s_k = (omega_0 - omega_k) / omega_0
    return 2 * M_k * (1 + a * s_k) / (slip / s_k + s_k / slip + 2 * a * s_k)


@pytest.mark.parametrize("ratio", [0.0, 0.5, 1.0, 2.0])
def test_the_characteristic_goes_through_the_rated_point(ratio: float) -> None:
    made = InductionMotor(**RATED, resistance_ratio=ratio)
    assert kloss(made, 0.03) == pytest.approx(100, rel=1e-12)
    assert made.speed_breakdown is not None
    assert made.speed_synchronous is not None
    # The larger root: the rated point lies on the stable side of the breakdown point.
    assert made.speed_breakdown < made.speed_synchronous * 0.97
    assert made.power_rated == pytest.approx(100 * 970 * np.pi / 30)


POSITIVE = st.floats(min_value=0, exclude_min=True, allow_infinity=False, allow_nan=False)


@given(
    st.fixed_dictionaries(
        {},
        optional=dict.fromkeys(
            (
                "speed_synchronous",
                "speed_rated",
                "speed_breakdown",
                "speed_pull_up",
                "torque_rated",
                "torque_breakdown",
                "torque_start",
                "torque_pull_up",
                "power_rated",
                "resistance_ratio",
            ),
            POSITIVE,
        ),
    )
)
def test_any_numbers_make_a_motor_or_a_list_of_problems(numbers: dict[str, float]) -> None:
    try:
        made = InductionMotor.model_validate({"kind": "induction"} | numbers)
    except ValidationError:
        return
    assert made.speed_breakdown is not None
    assert made.speed_synchronous is not None
    assert 0 < made.speed_breakdown < made.speed_synchronous


def test_a_rated_point_that_no_formula_goes_through() -> None:
    # 1/s_n + 2a − 2λa = 2 + 2 − 4 = 0: the equation of the breakdown slip has lost its square.
    numbers = {"speed_synchronous": 100, "speed_rated": 50, "torque_rated": 1, "torque_breakdown": 2}
    with pytest.raises(ValidationError):
        InductionMotor.model_validate({"kind": "induction", "resistance_ratio": 1} | numbers)


def test_what_was_given_is_kept() -> None:
    made = InductionMotor(**RATED, speed_breakdown="850 rpm")
    assert made.speed_breakdown == pytest.approx(850 * np.pi / 30)


def test_a_dc_motor_from_its_rated_point() -> None:
    made = DcMotor(kind="dc", speed_no_load=100, speed_rated=90, power_rated=900)
    assert made.torque_stall == pytest.approx(100)


def test_every_type_of_the_catalogue_makes_a_motor() -> None:
    for each in motors():
        extra = {} if each.torque_breakdown else {"torque_breakdown": 3 * each.torque_rated}
        made = InductionMotor(kind="induction", catalogue=each.type, **extra)
        assert made.speed_rated == each.speed_rated
        assert made.torque_rated == pytest.approx(each.torque_rated, rel=1e-12)
        assert made.torque_start == each.start.get("torque_start")


def test_the_catalogue_keeps_its_sources() -> None:
    types = [each.type for each in motors()]
    assert len(types) == len(set(types)) == 84
    worked = motor("4A160S6U3 (method 1)")
    assert (worked.speed_synchronous, worked.speed_rated, worked.speed_breakdown) == (104.72, 102.1, 94.95)
    assert (worked.torque_start, worked.torque_rated, worked.torque_breakdown) == (129.24, 107.7, 215.4)
    assert worked.inertia == 0.138
    printed = motor("IE3 11 kW 4-pole frame 160")
    assert printed.torque_rated == 71.27
    assert printed.efficiency == pytest.approx(0.914)


def test_an_unknown_type_lists_close_ones() -> None:
    with pytest.raises(MachineError, match="4A160S6U3"):
        motor("4A160S6")


def four_bar() -> Machine:
    return loads(template("four-bar"))


def test_names_that_a_mechanism_makes() -> None:
    mechanism = four_bar().mechanism
    assert list(mechanism.fixed_points()) == ["O", "B"]
    assert mechanism.moving_points() == ("A", "C", "K")
    links = mechanism.links()
    assert list(links) == ["A", "C.coupler", "C.rocker"]
    assert links["C.rocker"] == ("rocker", "C", "B", "C", 0.11)
    assert links["A"][2:4] == ("O", "A")


def test_build_order_does_not_depend_on_the_order_of_the_file() -> None:
    rockers = {
        "R1": {"crank": "A", "pivot": "P", "coupler": 1, "rocker": 1},
        "R2": {"crank": "R1", "pivot": "P", "coupler": 1, "rocker": 1},
        "R3": {"crank": "K", "pivot": "R2", "coupler": 1, "rocker": 1},
    }
    base = {
        "points": {"P": {"x": 1}},
        "cranks": {"A": {"radius": 1}},
        "rigid_points": {"K": {"link": "R2.rocker", "along": 1}},
    }
    for names in itertools.permutations(rockers):
        mechanism = Mechanism.model_validate(base | {"rockers": {name: rockers[name] for name in names}})
        order = mechanism.build_order()
        assert sorted(order) == ["A", "K", "R1", "R2", "R3"]
        assert order.index("A") < order.index("R1") < order.index("R2") < order.index("K") < order.index("R3")


def test_every_number_has_an_address() -> None:
    machine = loads(template("compressor"))
    known = addresses(machine)
    assert known["mechanism.cranks.A.radius"] == 0.035
    assert known['bodies."piston.rod".mass'] == 0.9
    assert known["loads.gas.return.3"] == 0.0
    assert "format" not in known
    for address, value in known.items():
        assert get(machine, address) == value
        # Some shares are at most 1.
        other = 0.9 * value if 0.0 < value <= 1.0 else value + 1
        assert addresses(replace(machine, {address: other}))[address] == other


def test_the_kind_of_an_entry() -> None:
    machine = loads(template("compressor"))
    assert kind(machine, "mechanism.cranks.A.phase") is ANGLE
    assert kind(machine, "loads.gas.position.2") is LENGTH
    assert kind(machine, "bodies.piston.rod.along") is LENGTH
    assert kind(machine, "name") is None
    missing = [each for each in addresses(machine) if kind(machine, each) is None]
    assert missing == []


def test_an_exchange_leaves_the_machine_as_it_was() -> None:
    machine = four_bar()
    changed = replace(machine, {"mechanism.cranks.A.radius": 1.0, "bodies.C.coupler.mass_per_length": 2.5})
    assert get(changed, 'bodies."C.coupler".mass_per_length') == 2.5
    assert machine == four_bar()
    assert changed.loads is machine.loads


def test_what_follows_is_computed_anew_for_many_machines() -> None:
    machine = loads(template("compressor"))
    torques = np.array([20.0, 25.0, 30.0])
    many = replace(machine, {"drive.motor.torque_breakdown": torques})
    one = [replace(machine, {"drive.motor.torque_breakdown": each}) for each in torques.tolist()]
    assert get(many, "drive.motor.speed_breakdown") == pytest.approx(
        [get(each, "drive.motor.speed_breakdown") for each in one], rel=1e-15
    )
    assert get(one[0], "drive.motor.speed_breakdown") != get(one[2], "drive.motor.speed_breakdown")


def test_an_unknown_address_names_close_ones() -> None:
    with pytest.raises(MachineError, match=r"mechanism\.cranks\.A\.radius"):
        replace(four_bar(), {"mechanism.cranks.A.radus": 1})


def test_a_machine_made_in_python_tells_all_its_problems() -> None:
    with pytest.raises(MachineError) as caught:
        Machine(format=1, name="x", mechanism={"cranks": {"A": {"radius": -1}}}, bodies={"B": {"mass": 1}})  # type: ignore[arg-type]
    assert {each.key for each in caught.value.problems} == {"mechanism.cranks.A.radius", "bodies.B"}
