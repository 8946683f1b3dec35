"""Motors of one's own to choose from: induction, DC and servo motors, each by the checks of its kind."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import linkwright as lw
from linkwright import InputError, MachineError, MachineFileError, choose_motor
from linkwright.drive import CatalogueMotor
from linkwright.sizing.motor import Candidate

HEAD = (
    "type, kind, power_rated [kW], speed_rated [rpm], speed_synchronous [rpm], torque_breakdown_ratio, "
    "torque_start_ratio, speed_no_load [rpm], torque_max [N m], speed_max [rpm], inertia [kg m^2]\n"
)
INDUCTION = "M 160, induction, 15, 1466, 1500, 2.8, 2.2, , , , 0.081\n"
DC = "DC 15, dc, 15, 1400, , , , 1500, 250, , 0.15\n"
SERVO = "AM 20, servo, 20, 2000, , , , , 300, 3000, 0.04\n"


def stock(folder: Path, *rows: str) -> tuple[CatalogueMotor, ...]:
    path = folder / "motors.csv"
    path.write_text(HEAD + "".join(rows), encoding="utf-8")
    return lw.read_motors(path)


def judged(folder: Path, row: str) -> Candidate:
    machine = lw.read("roller_two_carts")
    return choose_motor(machine, catalogue=stock(folder, row), free_ratio=True).candidates[0]


def check(of: Candidate, name: str) -> tuple[float | None, float | None]:
    found = next(check for check in of.checks if check.name == name)
    return found.value, found.limit


def test_a_motor_of_the_file_is_judged_as_the_same_motor_in_the_machine(tmp_path: Path) -> None:
    candidate = judged(tmp_path, INDUCTION)
    assert candidate.machine is not None
    rated = 15e3 / (1466 * np.pi / 30)
    steady = lw.steady_state(candidate.machine)
    assert candidate.ratio == pytest.approx(1466 * np.pi / 30 / 10.5, rel=1e-13)
    assert check(candidate, "torque_rms") == pytest.approx((steady.torque_motor_rms, rated), rel=1e-9)
    # With 10 % less voltage 0.81 of the breakdown torque is left.
    assert check(candidate, "torque_peak")[1] == pytest.approx(0.81 * 2.8 * rated, rel=1e-13)
    assert not candidate.inertia_estimated


def test_a_dc_motor_starts_with_its_maximum_torque(tmp_path: Path) -> None:
    candidate = judged(tmp_path, DC)
    assert candidate.passes
    # Of its stall torque, 15 times the rated one, the current leaves 250 N m; η = 0.9.
    assert check(candidate, "starting_torque")[0] == pytest.approx(250 * candidate.ratio * 0.9, rel=1e-13)
    assert check(candidate, "torque_peak")[1] == 250.0
    assert candidate.machine is not None
    assert candidate.machine.drive.motor.kind == "dc"  # type: ignore[union-attr]
    unknown = judged(tmp_path, DC.replace(" 250", " "))
    assert not unknown.passes
    assert "torque_max" in unknown.reason


def test_a_servo_motor_gives_what_constant_speed_asks(tmp_path: Path) -> None:
    """M = (M_r + ½ J′ω²)/(i η), forward and back by the efficiency of the gearbox, by samples here."""
    candidate = judged(tmp_path, SERVO)
    assert candidate.passes
    machine, ratio = candidate.machine, candidate.ratio
    assert machine is not None
    at = lw.reduction(machine, n=7200)
    drive = at.torque_load + 0.5 * at.inertia_reduced_d1 * 10.5**2
    motor = drive[:-1] / (ratio * np.where(drive[:-1] < 0, 1 / 0.9 if _symmetric(machine) else 0.9, 0.9))
    # Jumps at the dead centres leave the samples 1e-3 of the rms.
    assert check(candidate, "torque_rms")[0] == pytest.approx(np.sqrt(np.mean(motor**2)), rel=2e-3)
    assert check(candidate, "torque_peak") == pytest.approx((np.abs(motor).max(), 300.0), rel=2e-3)
    inertia = float(np.mean(at.inertia_reduced[:-1])) / ratio**2 - 0.04
    assert check(candidate, "inertia_ratio")[0] == pytest.approx(inertia / 0.04, rel=1e-4)
    # It does not decide, and is above 10 here.
    assert "inertia_ratio" not in candidate.decisive


def _symmetric(machine: lw.Machine) -> bool:
    assert machine.drive is not None
    return machine.drive.gearbox.reverse != "same"


def test_a_servo_motor_beyond_its_speed_is_refused_with_the_ratio_that_suits(tmp_path: Path) -> None:
    machine = lw.replace(lw.read("roller_two_carts"), {"drive.gearbox.ratio": 40.0})
    candidate = choose_motor(machine, catalogue=stock(tmp_path, SERVO)).candidates[0]
    assert not candidate.passes
    assert f"{100 * np.pi / 10.5:.4g}" in candidate.reason


def test_the_smallest_of_all_kinds_is_chosen(tmp_path: Path) -> None:
    machine = lw.read("roller_two_carts")
    choice = choose_motor(machine, catalogue=stock(tmp_path, SERVO, DC, INDUCTION), free_ratio=True)
    assert choice.chosen is not None
    assert choice.chosen.type in ("DC 15", "M 160")
    assert [candidate.type for candidate in choice.candidates if candidate.passes][-1] == "AM 20"


@pytest.mark.parametrize(
    ("row", "words"),
    [
        (DC.replace(" dc,", " ac,"), "a kind of motor"),
        (DC.replace(" 1500,", " ,"), "speed_no_load"),
        (SERVO.replace(" 300,", " ,"), "torque_max"),
        (INDUCTION.replace("2.8", ""), "torque_breakdown"),
        (DC.replace(" 15,", " ,"), "power_rated"),
    ],
)
def test_what_a_kind_lacks_is_named(tmp_path: Path, row: str, words: str) -> None:
    with pytest.raises(MachineFileError, match=words):
        stock(tmp_path, row)


def test_nothing_to_choose_from(tmp_path: Path) -> None:
    machine = lw.read("roller_two_carts")
    with pytest.raises(InputError, match="no motor to choose from"):
        choose_motor(machine, catalogue=[])
    with pytest.raises(MachineError, match="DC 15"):
        choose_motor(machine, catalogue=stock(tmp_path, DC), inertias={"DC 51": 0.1})
