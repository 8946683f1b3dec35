"""The catalogue of motors against standards for induction motors, whose figures here are from memory.

IEC 60034-1, 9.4.1: an excess torque of 60 % for 15 s. IEC 60034-30-1: minimum efficiencies at 50 Hz.
IEC 60072-1 gives the sizes of frames, EN 50347 the powers that belong to them (enclosed motors, cooled by
their own fan).
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import linkwright as lw
from linkwright.drive import OVERLOAD, CatalogueMotor
from linkwright.drive import motor as catalogue_motor
from linkwright.sizing.motor_change import rotor_inertia

INDUCTION = [motor for motor in lw.motors() if motor.kind == "induction"]
FRAMED = [motor for motor in INDUCTION if motor.frame is not None]
ONE_CART = (Path(__file__).parents[2] / "machines" / "roller_one_cart.toml").read_text(encoding="utf-8")

# Rated power of motors with four poles [kW] → frame.
FRAMES = {
    5.5: "132S",
    7.5: "132M",
    11: "160M",
    15: "160L",
    18.5: "180M",
    22: "180L",
    30: "200L",
    37: "225S",
    45: "225M",
    55: "250M",
    75: "280S",
    90: "280M",
}
# Rated power of motors with four poles [kW] → minimum efficiency of the class [–].
EFFICIENCIES = {
    "IEC IE2": {5.5: 0.877, 11: 0.898, 18.5: 0.912, 30: 0.923, 55: 0.935},
    "IEC IE3": {5.5: 0.896, 11: 0.914, 18.5: 0.926, 30: 0.936, 55: 0.946},
}


@pytest.mark.parametrize("motor", INDUCTION, ids=lambda motor: motor.type)
def test_breakdown_and_rated_point(motor: CatalogueMotor) -> None:
    if motor.torque_breakdown is not None:
        assert motor.torque_breakdown >= OVERLOAD * motor.torque_rated * (1 - 1e-12)
    assert motor.speed_synchronous == pytest.approx(2 * np.pi * 50 / (motor.poles / 2), rel=1e-4)
    # A slip of 0.5 to 9 %: large motors have little, the smallest ones much.
    assert 0.005 < 1 - motor.speed_rated / motor.speed_synchronous < 0.09
    # Catalogues round the rated torque, or the speed to 5 rpm.
    assert motor.torque_rated * motor.speed_rated == pytest.approx(motor.power_rated, rel=0.015)


@pytest.mark.parametrize("motor", FRAMED, ids=lambda motor: motor.type)
def test_frames_suit_the_power(motor: CatalogueMotor) -> None:
    # Some sources print the height of the shaft alone.
    assert FRAMES[motor.power_rated / 1e3].startswith(motor.frame)
    # Makers print the minimum of the class.
    assert motor.efficiency == pytest.approx(EFFICIENCIES[motor.series][motor.power_rated / 1e3], abs=5e-4)


def test_a_rotor_without_a_printed_inertia_is_estimated_and_marked() -> None:
    """A file that names a type of the catalogue has the inertia that sizing has, and says that it is one."""
    machine = lw.loads(ONE_CART.replace('inertia = "0.0442 kg m^2"', ""))
    motor = machine.drive.motor
    assert motor.inertia_is_estimated
    assert motor.inertia == rotor_inertia(catalogue_motor(motor.catalogue))[0] > 0
    (words,) = [text for text in lw.study(machine).warnings if "no rotor inertia" in text]
    assert f"is used, {motor.inertia:.3g} kg m²" in words
    given = lw.loads(ONE_CART)
    assert not given.drive.motor.inertia_is_estimated
    assert given.drive.motor.inertia == 0.0442


@pytest.mark.parametrize("series", ["4A", "AIR"])
def test_series_have_motors_with_two_and_eight_poles(series: str) -> None:
    """Speeds of one power fall with the number of poles, torques rise."""
    of = {(m.power_rated, m.poles): m for m in INDUCTION if m.series == series and m.power_rated <= 15e3}
    both = [power for power, poles in of if poles == 2 and (power, 8) in of]
    assert len(both) >= 6
    assert all(of[power, 2].torque_rated < 0.3 * of[power, 8].torque_rated for power in both)
