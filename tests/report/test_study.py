"""A study: what is computed, what becomes a finding, and what its warnings say."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from linkwright import InputError, loads, read, steady_state, study
from linkwright.app.study import Study
from linkwright.drive.characteristic import characteristic
from linkwright.drive.warnings import drive_warnings
from linkwright.kernel.files.library import template

TWO_CARTS = Path(__file__).parents[2] / "machines" / "roller_two_carts.toml"
ALONE = 'format = 1\nname = "alone"\n[mechanism.cranks.A]\nradius = 0.1\n[bodies]\nA = { mass = 1 }\n'


def two_carts(*overrides: str) -> Study:
    return study(read(TWO_CARTS, overrides))


def warned(found: Study, *words: str) -> bool:
    return any(all(word in text for word in words) for text in found.warnings)


def test_sentences_are_sentences() -> None:
    cases = [(), ("drive.gearbox.ratio=3",), ("drive={}",), ("mechanism.sliders.cart1.rod=0.1",)]
    for overrides in cases:
        found = two_carts(*overrides)
        for text in (*found.findings, *found.warnings):
            assert text[0].isupper()
            assert text.endswith(".")
            assert not text.endswith("..")


def test_steady_motion_is_that_of_the_analysis() -> None:
    found, steady = two_carts().steady_state, steady_state(read(TWO_CARTS), accuracy=1e-10)
    assert found is not None
    assert found.unevenness == steady.unevenness


def test_a_sound_machine_has_nothing_to_warn_of() -> None:
    assert study(loads(template("compressor"))).warnings == ()


def test_a_motor_without_a_rotor_is_told_with_an_estimate() -> None:
    """0.138 kg m² at 107.7 N m, and the power 5/3 of the ratio of torques: by hand for 3 kW at 955 rpm."""
    given = 'inertia = "0.02 kg m^2"'
    text = template("slider-crank")
    estimate = 0.138 * (3000 / (955 * math.pi / 30) / 107.7) ** (5 / 3)
    assert text.count(given) == 1
    without = study(loads(text.replace(given, "")))
    assert warned(without, "no rotor inertia for 4A112MA6U3", f"is used, {estimate:.3g} kg m²")
    assert not warned(study(loads(text)), "rotor inertia")


def test_overload_is_told_with_both_numbers() -> None:
    found = two_carts()
    assert warned(found, "root mean square of 128.8 N m", "19.6 % above the rated 107.7 N m")
    heavy = two_carts("drive.motor.torque_rated=90 N m", "loads.rolling1.force=4500 N")
    assert heavy.steady_state is not None
    power = f"{heavy.steady_state.power_motor_mean:.4g} W on average"
    assert warned(heavy, power, f"above the rated {90 * 102.1:.4g} W")


def test_nearness_of_breakdown_is_told() -> None:
    assert warned(two_carts(), "97 % of the breakdown torque of 215.4 N m")
    weak = two_carts("drive.motor.torque_breakdown=135 N m", "run_up.speed_start=10 rad/s")
    assert warned(weak, "below its breakdown speed of 94.95 rad/s")


def test_generator_and_its_gearbox_are_told() -> None:
    found = two_carts()
    assert warned(found, "drives the motor during 14 % of the time", "synchronous speed of 104.7 rad/s")
    assert warned(found, "gearbox factor 0.9", "22.61 J per revolution")
    assert not warned(two_carts("drive.gearbox.reverse=1.1"), "gearbox factor")


def test_gain_of_the_gearbox_closes_the_balance_of_energy() -> None:
    """Work of the motor = losses while it drives − gain while it is driven + work at the crank."""
    steady = two_carts().steady_state
    assert steady is not None
    driving = np.maximum(steady.torque_drive, 0)
    losses = np.trapezoid(driving, steady.crank_angle) * (1 / 0.9 - 1)
    # 22.61 J is the gain that the warning tells, to four digits.
    assert steady.energy_motor == pytest.approx(steady.energy_drive + losses - 22.61, abs=0.02)


def test_design_speed_is_compared() -> None:
    assert not warned(two_carts(), "design speed")
    assert warned(two_carts("drive.speed=12 rad/s"), "13.5 % below the design speed of 12 rad/s")
    assert warned(two_carts("drive.speed=9 rad/s"), "15.4 % above the design speed of 9 rad/s")


def test_start_by_kloss_is_told() -> None:
    motor = read(TWO_CARTS).drive
    assert motor is not None
    text = TWO_CARTS.read_text(encoding="utf-8").replace('torque_start = "129.24 N m"', "")
    found = study(loads(text))
    slip = (104.72 - 94.95) / 104.72
    assert warned(found, "no torque_start", f"{2 * 215.4 / (slip + 1 / slip):.4g} N m at standstill")
    assert found.findings[0].startswith("Does not start")


def test_instability_is_told() -> None:
    found = two_carts()
    assert found.reduction is not None
    assert found.steady_state is not None
    unstable = replace(found.steady_state, multiplier=1.25)
    assert "grows 1.25 times" in drive_warnings(found.machine, found.reduction, unstable)[0]


@pytest.mark.parametrize(
    ("overrides", "words"),
    [
        ((), "no motor"),
        ((), "no loads"),
        (('mechanism.sliders.S={crank="A", rod=0.3}', "bodies={S={mass=1}}"), "falls to zero"),
        (("bodies={}",), "no masses, loads or motor"),
        (('loads.fall={kind="torque", on="A", torque=2}',), "loads drive the machine"),
        (('drive.motor={kind="constant_speed", speed=5}',), "has no run-up"),
    ],
)
def test_what_is_missing_is_told(overrides: tuple[str, ...], words: str) -> None:
    found = study(loads(ALONE, overrides))
    assert warned(found, words)
    assert found.findings == ()


def test_motion_to_the_stall_is_kept() -> None:
    found = two_carts("drive.motor.torque_start=90 N m", "drive.motor.torque_breakdown=135 N m")
    assert found.findings[0].startswith("Stalls after 0.01 revolutions")
    assert found.attempt is not None
    assert found.attempt.came_to_rest
    assert f"{found.attempt.time[-1]:.2f} s" in found.findings[0]


def test_numbers_that_are_not_finite_are_none() -> None:
    found = two_carts()
    assert found.reduction is not None
    found._results["reduction"] = replace(found.reduction, inertia_min=math.nan, inertia_max=math.inf)
    given = found.to_dict(curves=True)
    assert given["results"]["reduction"]["inertia_min"] is None
    assert given["results"]["reduction"]["inertia_max"] is None
    json.dumps(given, allow_nan=False)


def test_accuracy_is_checked() -> None:
    with pytest.raises(InputError, match="accuracy"):
        study(read(TWO_CARTS), accuracy=0.5)


def test_characteristic_goes_through_its_points() -> None:
    curve = characteristic(read(TWO_CARTS))
    at = np.interp([0, 94.95, 104.72], curve.speed, curve.torque)
    assert at == pytest.approx([129.24, 215.4, 0], abs=0.3)
    # Mean load at the crank over ratio and efficiency.
    assert curve.torque_load == pytest.approx(907.06 / (9.8 * 0.9), rel=1e-4)
    assert characteristic(read(TWO_CARTS), speed_max=150).speed[-1] == 150
    with pytest.raises(InputError, match="needs a motor"):
        characteristic(loads(ALONE))
