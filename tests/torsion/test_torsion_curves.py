"""Tables over angle, curves and waterfalls of trains in motion, against SciPy and closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import linkwright as lw
from linkwright import InputError, waterfall
from linkwright.drive import ConstantTorqueMotor, DcMotor, Drive, InductionMotor, TableMotor
from linkwright.kernel.core.curve import Curve, product, straight, switched
from linkwright.kernel.core.periodic_table import smooth, spline, waves
from linkwright.machine import compile_machine
from linkwright.torsion import motor_curve

# Rounding of a Fourier transform of some hundred samples, and of its second derivative.
ROUNDING, ROUNDING_D2 = 1e-13, 1e-9


def turn(n: int, period: float = 2 * np.pi) -> np.ndarray:
    """Even angles."""
    return period * np.arange(n) / n


@pytest.mark.parametrize("n", [32, 33])
def test_smooth_table_is_exact_for_few_waves(n: int) -> None:
    def f(x: np.ndarray) -> np.ndarray:
        return 2 + 0.3 * np.cos(x + 0.2) - 0.1 * np.sin(5 * x)

    table = smooth(f(turn(n)))
    x = turn(len(table.value))
    assert len(x) >= 512
    assert table.value == pytest.approx(f(x), abs=ROUNDING)
    assert table.slope == pytest.approx(-0.3 * np.sin(x + 0.2) - 0.5 * np.cos(5 * x), abs=1e-11)
    assert table.bend == pytest.approx(-0.3 * np.cos(x + 0.2) + 2.5 * np.sin(5 * x), abs=ROUNDING_D2)
    assert table.mean == pytest.approx(2.0, rel=ROUNDING)
    # Given samples stay what they are.
    assert table.value[:: len(x) // n] == pytest.approx(f(turn(n)), abs=ROUNDING)


def test_wave_of_two_samples_is_a_cosine() -> None:
    table = smooth([1.0, -1.0] * 4)
    x = turn(len(table.value))
    assert table.value == pytest.approx(np.cos(4 * x), abs=ROUNDING)


@pytest.mark.parametrize("n", [5, 8, 720])
def test_spline_is_scipys(n: int) -> None:
    period = 4 * np.pi
    x = turn(n, period)
    y = np.maximum(np.sin(x / 2), 0.0) ** 2 + 0.1 * np.cos(x)
    wanted = CubicSpline(np.append(x, period), np.append(y, y[0]), bc_type="periodic")
    table = spline(y, period)
    assert table.slope == pytest.approx(wanted(x, 1), abs=1e-10)
    assert table.bend == pytest.approx(wanted(x, 2), abs=1e-7)
    assert table.mean == pytest.approx(wanted.integrate(0, period) / period, rel=1e-12)


def test_waves_are_their_harmonics() -> None:
    table = waves([0.5, 3.0], [2.0, 1.0], [0.1, -0.4], turns=2, mean=5.0)
    x = turn(len(table.value), 4 * np.pi)
    assert table.period == 4 * np.pi
    assert table.value == pytest.approx(5 + 2 * np.cos(0.5 * x + 0.1) + np.cos(3 * x - 0.4), rel=ROUNDING)
    assert table.slope == pytest.approx(-np.sin(0.5 * x + 0.1) - 3 * np.sin(3 * x - 0.4), abs=1e-12)
    assert table.bend == pytest.approx(-0.5 * np.cos(0.5 * x + 0.1) - 9 * np.cos(3 * x - 0.4), abs=1e-11)
    # 32 knots for each wave of the highest order.
    assert len(waves([48.0], [1.0], [0.0]).value) == 48 * 32


def test_switched_factors() -> None:
    weight = switched([(2.0, 0.5, 0.0), (1.0, 0.0, 0.5), (3.0, 1.0, 4.0), (5.0, 0.0, 0.0)])
    at = np.array([0.0, 0.9, 1.25, 1.6, 2.1, 4.0, 4.9, 5.1, 9.0])
    # The third change is half done when the fourth ends it.
    wanted = [1.0, 1.0, 0.5, 0.0, 0.5, 0.625, 0.5 + 0.5 * 1.9 / 4, 0.0, 0.0]
    assert np.interp(at, weight.x, weight.y) == pytest.approx(wanted)
    assert switched([], 0.3).y.tolist() == [0.3]


def test_product_of_factors() -> None:
    fuel, misfire = switched([(1.0, 0.0, 2.0)]), switched([(2.0, 0.5, 0.0), (2.5, 1.0, 0.0)])
    found = product(fuel, misfire)
    at = np.array([0.5, 1.5, 1.99, 2.01, 2.49, 2.51, 3.5])
    wanted = np.interp(at, fuel.x, fuel.y) * np.where((at > 2) & (at < 2.5), 0.5, 1.0)
    assert np.interp(at, found.x, found.y) == pytest.approx(wanted)
    # Slopes on both sides of the steps are those of the lines beside them.
    assert found.after[np.flatnonzero(found.x == 2.0)[-1]] == pytest.approx(-0.25)


def test_straight_lines_go_on() -> None:
    held, on = straight([0.0, 2.0], [1.0, 5.0]), straight([0.0, 2.0], [1.0, 5.0], beyond="straight")
    assert (held.before[0], held.after[0], held.after[-1]) == (0.0, 2.0, 0.0)
    assert (on.before[0], on.after[-1]) == (2.0, 2.0)


@pytest.mark.parametrize(
    "motor",
    [
        InductionMotor(
            kind="induction",
            speed_synchronous=157.08,
            torque_breakdown=120.0,
            speed_rated=152.0,
            torque_rated=50.0,
        ),
        InductionMotor(
            kind="induction",
            speed_synchronous=157.08,
            torque_breakdown=120.0,
            speed_breakdown=125.0,
            torque_start=90.0,
            torque_pull_up=70.0,
            speed_pull_up=40.0,
        ),
        DcMotor(kind="dc", speed_no_load=100.0, torque_stall=80.0),
        TableMotor(kind="table", speed=(0.0, 50.0, 90.0), torque=(30.0, 20.0, 0.0)),
        ConstantTorqueMotor(kind="constant_torque", torque=12.0),
    ],
    ids=lambda motor: motor.kind,
)
def test_motor_curve_is_the_characteristic(
    motor: InductionMotor | DcMotor | TableMotor | ConstantTorqueMotor,
) -> None:
    text = 'format = 1\nname = "m"\n[mechanism.cranks]\nA = { radius = "1 m" }\n'
    machine = lw.loads(text).with_entries({"drive": Drive(motor=motor)})
    speeds = np.linspace(1.0, 300.0, 1499)
    wanted = compile_machine(machine).motor_torques(speeds).motor
    curve = motor_curve(motor)
    found = cubic(curve, speeds)
    # The points are dense enough for 1e-5 of the largest torque beside kinks, 1e-6 elsewhere.
    assert found == pytest.approx(wanted, abs=1e-5 * np.abs(wanted).max())


def cubic(curve: Curve, x: np.ndarray) -> np.ndarray:
    """Values of a curve by Hermite's cubics, straight lines outside."""
    k = np.clip(np.searchsorted(curve.x, x, side="right") - 1, 0, max(len(curve.x) - 2, 0))
    left = curve.y[0] + curve.before[0] * (x - curve.x[0])
    right = curve.y[-1] + curve.after[-1] * (x - curve.x[-1])
    if len(curve.x) < 2:
        return np.where(x < curve.x[0], left, right)
    h = curve.x[k + 1] - curve.x[k]
    z = (x - curve.x[k]) / h
    inside = (
        curve.y[k] * (1 + 2 * z) * (1 - z) ** 2
        + curve.y[k + 1] * z**2 * (3 - 2 * z)
        + h * curve.after[k] * z * (1 - z) ** 2
        - h * curve.before[k + 1] * z**2 * (1 - z)
    )
    return np.where(x < curve.x[0], left, np.where(x > curve.x[-1], right, inside))


def test_waterfall_finds_orders_while_the_speed_rises() -> None:
    """Orders 1.5 and 4 with known amplitudes on a run-up of 40 revolutions; nothing two steps away."""
    t = np.linspace(0, 4, 16001)
    angle = 30 * t + 5 * t**2
    signal = 7 + 3 * np.cos(1.5 * angle + 0.3) + 0.5 * np.cos(4 * angle)
    found = waterfall(t, angle, signal, highest=6, turns=8)
    # Half an order lies two bins of the window apart, where Hann's window has a zero.
    assert found.order(1.5) == pytest.approx(np.full(len(found.time), 3.0), rel=1e-3)
    assert found.order(4) == pytest.approx(np.full(len(found.time), 0.5), rel=1e-2)
    quiet = np.isin(found.orders, [1.5, 4], invert=True)
    assert found.amplitudes[:, quiet].max() < 3e-3
    # Mean speed over a window: its eight turns over the time they took.
    assert found.speed == pytest.approx(30 + 10 * found.time, rel=1e-3)
    assert (found.orders[0], found.orders[-1], found.turns) == (0.5, 6.0, 8)


def test_waterfall_tells_what_it_cannot_do() -> None:
    t = np.linspace(0, 1, 2001)
    angle = 100 * t
    for entries, words in (
        ({"highest": 0.2}, "0 < step ≤ highest"),
        ({"turns": 2}, "turns: found 2, expected at least 4"),
        ({"turns": 30}, "a motion of 15.92 revolutions, expected 30"),
        ({"highest": 60.0}, "expected 31.4 at most .* sample_time"),
    ):
        with pytest.raises(InputError, match=words):
            waterfall(t, angle, angle, **entries)
    with pytest.raises(InputError, match="always rotates forward"):
        waterfall(t, np.sin(angle), angle)
    with pytest.raises(InputError, match="lists of one length"):
        waterfall(t, angle[:-1], angle)
