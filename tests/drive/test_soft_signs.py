"""Friction by a formula as c·tanh(k v) changes within a small angle at dead centres: none of it is missed."""

import numpy as np
import pytest

import linkwright as lw

FILE = """format = 1
name = "Press"
mechanism.cranks.A.radius = 0.4
mechanism.sliders.S = {{ crank = "A", rod = 1.1 }}
bodies.S.mass = 6
[drive]
motor = {{ kind = "dc", speed_no_load = 60, torque_stall = 900 }}
flywheel.inertia = 5
[loads.oil]
kind = "formula"
on = "S"
force = "-300*{sign}"
"""

# As they are written for a sign of the speed, beside a plain one that rises or falls there (Stribeck).
SIGNS = {
    "tanh": "tanh({k}*v)",
    "arc tangent": "2/pi*atan({k}*v)",
    "root": "v/sqrt(v*v + 1/{k}**2)",
    "tanh of the square": "tanh({k}*v*abs(v))",
    "off its zero": "tanh({k}*(v + 0.001))",
    "logistic": "(2/(1 + exp(-{k}*v)) - 1)",
    "bump": "(v/sqrt(v*v + 0.01) + 0.1*tanh(3*v)*exp(-({k}*v)**2))",
    "Stribeck": "(1 + 0.1*exp(-({k}*v)**2))*sign(v)",
    "narrow Stribeck of speeds": "(1 + 0.1*exp(-({k}*v/omega)**2))*sign(v)",
}


def work_of_load(machine: lw.Machine) -> float:
    """∮M_r dφ by Gauss with pieces that get shorter towards dead centres, along a motion of more digits."""
    x, weights = np.polynomial.legendre.leggauss(12)
    off = np.pi / 2 * 0.5 ** np.arange(40)
    ends = np.unique(
        np.concatenate([[0.0, np.pi, 2 * np.pi], off, np.pi - off, np.pi + off, 2 * np.pi - off])
    )
    middle, half = (ends[1:] + ends[:-1]) / 2, np.diff(ends) / 2
    angles = (middle[:, None] + half[:, None] * x).ravel()
    curves = lw.steady_state(machine, angles=angles, accuracy=1e-12)
    return float((half[:, None] * weights).ravel() @ curves.torque_load)


@pytest.mark.parametrize("sign", SIGNS)
@pytest.mark.parametrize("k", [1, 5, 20, 100, 1000, 1e5])
def test_work_of_steady_motion(k: float, sign: str) -> None:
    machine = lw.loads(FILE.format(sign=SIGNS[sign].format(k=k)))
    motion = lw.steady_state(machine)
    expected = work_of_load(machine)
    assert motion.energy_load == pytest.approx(expected, rel=1e-9)
    row = lw.steady_states(machine, {"bodies.S.mass": [6.0, 6.0]})
    # A row is promised to 1e-7.
    assert row.energy_load == pytest.approx(expected, rel=1e-7)
    assert row.speed_max == pytest.approx(motion.speed_max, rel=1e-7)


def test_a_sign_with_an_overflow_has_a_slope() -> None:
    """1/(1 + exp x) is 0 where exp x overflows, and so is its slope; 0 ∞ kept machines from starting."""
    tanh, logistic = (
        lw.steady_state(lw.loads(FILE.format(sign=sign))) for sign in ("tanh(100*v)", "(2/(1+exp(-200*v))-1)")
    )
    assert logistic.speed_max == pytest.approx(tanh.speed_max, rel=1e-9)
    assert logistic.energy_load == pytest.approx(tanh.energy_load, rel=1e-9)


@pytest.mark.parametrize("belt", [0.3, 2.0, 7.5])
@pytest.mark.parametrize("k", [100, 1e4, 1e6])
def test_friction_on_a_moving_belt(k: float, belt: float) -> None:
    """Where the slide is as fast as the belt, the friction changes within a small angle, wherever that is."""
    sign = f"tanh({k}*(v - {belt}))"
    motion = lw.steady_state(lw.loads(FILE.format(sign=sign)))
    finer = lw.steady_state(lw.loads(FILE.format(sign=sign)), accuracy=1e-11)
    assert motion.energy_load == pytest.approx(finer.energy_load, rel=1e-9)
    assert motion.speed_max == pytest.approx(finer.speed_max, rel=1e-9)
    assert motion.speed_min == pytest.approx(finer.speed_min, rel=1e-9)


def test_newton_is_brought_back_into_a_steep_layer() -> None:
    """A stage in the layer in which the friction changes left a step of a finer mesh without a solution."""
    text = FILE.format(sign="(2/(1+exp(-11848*(v - 2)))-1)").replace("-300*", "-192.9*")
    text = text.replace("radius = 0.4", "radius = 0.3").replace("rod = 1.1", "rod = 1.001, offset = 0.15")
    text = text.replace("mass = 6", "mass = 18.75").replace("inertia = 5", "inertia = 4")
    text = text.replace("speed_no_load = 60, torque_stall = 900", "speed_no_load = 40, torque_stall = 600")
    machine = lw.loads(text)
    for accuracy in (1e-7, 1e-10, 1e-11):
        motion = lw.steady_state(machine, accuracy=accuracy)
        assert motion.speed_max == pytest.approx(41.2251905942326, rel=max(accuracy, 1e-10))
