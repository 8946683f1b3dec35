"""Accelerating and load factor: identities of a pure inertia, and the limits of feasible ratios."""

from __future__ import annotations

import math

import pytest
from axis_cycles import ACCELERATION_RMS, SPEED_MEAN, SPEED_PEAK, inertia_cycle

import linkwright as lw
from linkwright.axes.axis import servo_axis
from linkwright.axes.duty import motor_duty
from linkwright.axes.feasibility import load_factor, ratio_range, ratio_ranges
from linkwright.axes.model.axis_catalogue import CatalogueServo
from linkwright.axes.model.axis_gearbox import AxisGearbox
from linkwright.axes.model.servo_motor import ServoMotor


def motor(inertia: object, torque: float = 2.4, top: float = 1e5) -> ServoMotor:
    """A motor of level torque up to its maximum speed [rad/s]."""
    curve = {"speed": (0, top), "torque": (torque, torque)}
    peak = {"speed": (0, top), "torque": (3 * torque, 3 * torque)}
    return ServoMotor.model_validate({"inertia": inertia, "continuous": curve, "peak": peak})


def test_load_factor_of_a_pure_inertia() -> None:
    """β = 4 J_L ω̇_rms², and the minimum torque is 2 √(J_M J_L) ω̇_rms."""
    load = load_factor(inertia_cycle(0.02))
    assert load.load_factor == pytest.approx(4 * 0.02 * ACCELERATION_RMS**2, rel=1e-9)
    found = ratio_range(load, motor(0.9e-4))
    assert found.torque_rms_best == pytest.approx(2 * math.sqrt(0.9e-4 * 0.02) * ACCELERATION_RMS, rel=1e-9)
    assert found.torque_rms_best == pytest.approx(math.sqrt(0.9e-4 * load.load_factor), rel=1e-12)


@pytest.mark.parametrize(("rotor", "ratio"), [("0.277 kg cm^2", 237.5), ("8.17 kg cm^2", 43.7)])
def test_a_disc_has_its_matched_ratio(rotor: str, ratio: float) -> None:
    """50 kg of 500 mm diameter are 15 625 kg cm²: the best ratio is √(J_L/J_M)."""
    disc = 50 * 0.25**2 / 2
    assert disc == pytest.approx(1.5625)
    assert ratio_range(load_factor(inertia_cycle(disc)), motor(rotor)).ratio_best == pytest.approx(
        ratio, rel=1e-3
    )


@pytest.mark.parametrize("weight", [0.0, 4.0])
@pytest.mark.parametrize("efficiency", [1.0, 0.85])
def test_at_the_ends_of_the_range_the_torque_is_the_continuous_torque(
    weight: float, efficiency: float
) -> None:
    """With the gears' losses, which the duty counts by the power."""
    cycle, servo = inertia_cycle(0.02, weight), motor(0.9e-4)
    found = ratio_range(load_factor(cycle, AxisGearbox(efficiency=efficiency)), servo)
    assert found.feasible
    for ratio in (found.ratio_min, found.ratio_max):
        assert ratio is not None
        duty = motor_duty(cycle, servo, AxisGearbox(ratio=ratio, efficiency=efficiency))
        assert duty.torque_rms == pytest.approx(2.4, rel=1e-9)
    assert found.ratio_best is not None
    best, *others = (
        motor_duty(
            cycle, servo, AxisGearbox(ratio=share * found.ratio_best, efficiency=efficiency)
        ).torque_rms
        for share in (1, 0.99, 1.01)
    )
    assert best == pytest.approx(found.torque_rms_best, rel=1e-9)
    assert best < min(others)


def test_a_motor_is_possible_where_its_accelerating_factor_is_above_the_load_factor() -> None:
    """α = M_N²/J_M against β, to either side."""
    load = load_factor(inertia_cycle(0.02, 4.0))
    for share, feasible in ((1.001, True), (0.999, False)):
        torque = math.sqrt(share * load.load_factor * 0.9e-4)
        found = ratio_range(load, motor(0.9e-4, torque))
        assert found.accelerating_factor == pytest.approx(share * load.load_factor, rel=1e-12)
        assert found.feasible == feasible
        assert (found.ratio_max is None) != feasible


def test_speeds_of_the_motor_limit_the_ratio() -> None:
    """By the maximum speed, and on average by the end of the curve of continuous torque."""
    load = load_factor(inertia_cycle(0.02))
    slow = motor(0.9e-4, 10.0, top=5 * SPEED_PEAK)
    assert ratio_range(load, slow).ratio_max == pytest.approx(5, rel=1e-6)
    assert ratio_range(load, slow).ratio_best == pytest.approx(5, rel=1e-6)
    fast = {"speed": (0, 3 * SPEED_MEAN), "torque": (10.0, 10.0)}
    short = ServoMotor.model_validate(slow.model_dump(exclude_unset=True) | {"continuous": fast})
    assert ratio_range(load, short).ratio_max == pytest.approx(3, rel=1e-6)
    named = ratio_ranges(load, (CatalogueServo("A", slow), CatalogueServo("B", short)))
    assert [found.type for found in named] == ["A", "B"]


TURNTABLE = """
format = 1
name = "turntable"
[master]
cycle_time = "0.5 s"
[axes.A]
sections = [{{ swing = "45 deg", angle = "324 deg" }}]
advance = "45 deg"
[mechanism.cranks.A]
radius = "100 mm"
[bodies.A]
mass = "{mass}"
along = 0
inertia = {inertia}
"""


@pytest.mark.parametrize(
    ("mass", "inertia", "size"),
    [
        # 50 kg, 500 mm in diameter.
        ("50 kg", 50 * 0.25**2 / 2, 15625e-4),
        # 150 lb, 34 × 2.5 in: m (L² + h²)/12 = 37.63 lb in s², weight over g.
        ("150 lb", 150 * 0.45359237 * (34**2 + 2.5**2) * 0.0254**2 / 12, 37.63 * 4.4482216 * 0.0254),
    ],
)
def test_a_table_of_a_machine_has_its_matched_ratio(mass: str, inertia: float, size: float) -> None:
    """Disc and bar on a crank that is indexed: inertia at the driver, and √(J_L/J_M) for any law."""
    axis = servo_axis(lw.loads(TURNTABLE.format(mass=mass, inertia=inertia)))
    assert axis.inertia_mean == pytest.approx(size, rel=2e-4)
    assert axis.inertia_mean == pytest.approx(inertia, rel=1e-12)
    found = ratio_range(load_factor(axis.cycle), motor("8.17 kg cm^2"))
    assert found.ratio_best == pytest.approx(math.sqrt(inertia / 8.17e-4), rel=1e-9)
    acceleration = axis.cycle.torque / inertia
    assert acceleration == pytest.approx(axis.cycle.acceleration, abs=1e-9 * float(abs(acceleration).max()))
