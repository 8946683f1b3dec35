"""The choice of a motor: its checks hold when the machine is analysed again."""

from __future__ import annotations

import pytest

from linkwright import InputError, Machine, choose_motor, loads, motors, read, replace, run_up, steady_state
from linkwright.drive import InductionMotor, estimated_inertia, motor
from linkwright.kernel.files.library import library_path, template
from linkwright.machine import dumps
from linkwright.sizing.checks import PEAK_SHARE, motion_checks
from linkwright.sizing.motor import MotorChoice
from linkwright.sizing.motor_change import rotor_inertia

DRIVES = ("one_cart", "two_carts", "three_carts", "four_carts")


def machine_of(name: str) -> Machine:
    return read(library_path(f"roller_{name}"))


@pytest.fixture(scope="module")
def choices() -> dict[str, MotorChoice]:
    return {name: choose_motor(machine_of(name)) for name in DRIVES}


@pytest.mark.parametrize("name", DRIVES)
def test_analysis_gives_back_what_was_asked(name: str, choices: dict[str, MotorChoice]) -> None:
    choice = choices[name]
    assert choice.chosen is not None
    machine = choice.chosen.machine
    assert machine is not None
    assert machine.drive is not None
    motor = machine.drive.motor
    assert isinstance(motor, InductionMotor)
    steady = steady_state(machine, n=2000)
    assert motor.power_rated >= 1.1 * choice.required.power
    assert steady.torque_motor_rms <= motor.torque_rated
    assert abs(steady.torque_motor).max() <= PEAK_SHARE * motor.torque_breakdown * (1 + 1e-4)
    assert run_up(machine).turns > 0
    # From the worst angle, too: at every angle of the revolution the motor sets the machine moving.
    for angle in range(0, 360, 15):
        start = replace(machine, {"run_up.angle_start": angle * 3.141592653589793 / 180})
        assert run_up(start, steady=steady).turns > 0


@pytest.mark.parametrize("name", DRIVES)
def test_the_smallest_is_chosen_and_others_have_reasons(name: str, choices: dict[str, MotorChoice]) -> None:
    choice = choices[name]
    assert choice.chosen is not None
    assert len(choice.candidates) == len(motors())
    for each in choice.candidates:
        if not each.passes:
            assert each.reason, each.type
        elif each is not choice.chosen:
            assert each.known.power_rated >= choice.chosen.known.power_rated


def test_pinned_choices(choices: dict[str, MotorChoice]) -> None:
    """Our own numbers: nothing moved. With them the files of `machines/` explain their motors."""
    chosen = {name: choice.chosen.type for name, choice in choices.items() if choice.chosen}
    assert chosen == {
        "one_cart": "4A200M6U3",
        "two_carts": "4A180M6U3",
        "three_carts": "4A200L6U3",
        "four_carts": "4A200L6U3",
    }


@pytest.mark.parametrize(
    ("name", "type"),
    list(zip(DRIVES, ("4A132S6U3", "4A160S6U3 (method 1)", "4A180M6U3", "4A200M6U3"), strict=True)),
)
def test_by_power_the_motors_of_the_files_come_out(name: str, type: str) -> None:
    """For two carts this is the paper's own choice; the other files follow the same rule."""
    choice = choose_motor(machine_of(name), by="power", reserve=1.0)
    assert choice.chosen is not None
    assert choice.chosen.type == type


def test_a_flywheel_lets_a_smaller_motor_do() -> None:
    together = choose_motor(machine_of("one_cart"), unevenness=0.05)
    assert together.chosen is not None
    assert together.chosen.known.power_rated == 7500
    assert together.chosen.steady is not None
    assert together.chosen.steady.unevenness == pytest.approx(0.05, abs=1e-6)


def test_none_suffices_and_the_reason_says_by_how_much() -> None:
    heavy = replace(machine_of("one_cart"), {"loads.rolling1.force": 1e5})
    choice = choose_motor(heavy)
    assert choice.chosen is None
    share = 1.1 * choice.required.power / 55e3
    assert f"{100 / share:.3g} % of the requirement" in choice.reason


def test_a_press_is_not_sized_for_a_start_in_the_work_stroke() -> None:
    """From the worst angle the press needs a motor several times as large as from its start angle."""
    press = loads(template("press"), {"drive.speed": 6.7})
    worst, fixed = choose_motor(press), choose_motor(press, by="fixed-start")
    assert fixed.chosen is not None
    assert worst.chosen is not None
    assert worst.chosen.known.power_rated > 3 * fixed.chosen.known.power_rated
    assert any(fixed.chosen.type in text for text in worst.warnings)
    assert not any("fixed-start" in text for text in fixed.warnings)


def test_no_motor_suits_the_ratio() -> None:
    slow = replace(machine_of("two_carts"), {"drive.gearbox.ratio": 50.0})
    choice = choose_motor(slow)
    assert choice.chosen is None
    assert "6.98 to 29.5" in choice.reason


def test_a_missing_start_torque_is_not_held_against_a_motor_as_a_failure() -> None:
    choice = choose_motor(machine_of("two_carts"))
    weak = next(each for each in choice.candidates if each.type == "AIR 15 kW 6-pole")
    check = next(each for each in weak.checks if each.name == "starting_torque_worst")
    assert check.passed is None
    assert "Kloss" in check.note


def test_a_missing_breakdown_torque_is_the_minimum_of_standards() -> None:
    """IEC 60034-1, 9.4.1: 1.6 times the rated torque; the same in sizing and in the sized machine."""
    light = replace(machine_of("two_carts"), {"loads.rolling1.force": 300.0, "loads.rolling2.force": 300.0})
    choice = choose_motor(
        light, free_ratio=True, by="fixed-start", catalogue=[motor("IE3 30 kW 4-pole frame 200")]
    )
    assert choice.chosen is not None
    peak = next(check for check in choice.chosen.checks if check.name == "torque_peak")
    assert peak.limit == pytest.approx(PEAK_SHARE * 1.6 * 193.0, rel=1e-12)
    assert "IEC 60034-1" in peak.note
    assert any("breakdown torque" in text and "308.8 N m" in text for text in choice.warnings)
    assert choice.chosen.to_dict()["torque_breakdown_is_minimum"] is True
    # Four poles, 30 kW, design N of IEC 60034-12: 1.3 times the rated torque at standstill.
    assert choice.chosen.to_dict()["torque_start"] == pytest.approx(1.3 * 193.0, rel=1e-12)
    assert any("starting torque" in text and "250.9 N m" in text for text in choice.warnings)
    machine = choice.chosen.machine
    assert machine is not None
    assert next(c for c in motion_checks(machine).checks if c.name == "torque_peak") == peak


def test_rotor_inertia_by_similarity() -> None:
    """Twice the size: eight times the torque, thirty-two times the inertia."""
    assert estimated_inertia(8 * 107.7) == pytest.approx(32 * 0.138, rel=1e-12)
    known = {each.type: each for each in motors()}
    assert rotor_inertia(known["4A160S6U3 (method 1)"]) == (0.138, False)
    estimate, estimated = rotor_inertia(known["4A200M6U3"])
    assert estimated
    assert estimate == pytest.approx(0.138 * (known["4A200M6U3"].torque_rated / 107.7) ** (5 / 3))


def test_a_given_inertia_wins() -> None:
    machine = machine_of("two_carts")
    choice = choose_motor(machine, inertias={"4A180M6U3": 0.2})
    given = next(each for each in choice.candidates if each.type == "4A180M6U3")
    assert (given.inertia, given.inertia_estimated) == (0.2, False)
    own = choose_motor(machine_of("three_carts"))
    mine = next(each for each in own.candidates if each.type == "4A180M6U3")
    assert (mine.inertia, mine.inertia_estimated) == (0.3284, False)


def test_a_free_ratio_meets_the_design_speed() -> None:
    choice = choose_motor(machine_of("two_carts"), free_ratio=True)
    for each in choice.candidates:
        assert each.known.speed_rated / each.ratio == pytest.approx(10.5, rel=1e-12)


def test_the_machine_with_its_motor_reads_back(choices: dict[str, MotorChoice]) -> None:
    chosen = choices["two_carts"].chosen
    assert chosen is not None
    assert chosen.machine is not None
    again = loads(dumps(chosen.machine))
    assert again == chosen.machine
    assert "by similarity" in again.description


def test_nothing_to_size() -> None:
    idle = replace(machine_of("one_cart"), {"loads.rolling1.force": 0.0})
    with pytest.raises(InputError, match="no motor to size"):
        choose_motor(idle)
    with pytest.raises(InputError, match="reserve"):
        choose_motor(machine_of("one_cart"), reserve=0.0)
