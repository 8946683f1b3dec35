"""The Floquet multiplier keeps the accuracy that is promised: exp ∮ ∂ε/∂u dφ along the motion, by SciPy."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import linkwright as lw

# Inertia [kg m²]; torque at standstill [N m] and speed [rad/s] where a straight motor has none.
J, LINE, END = 0.3, 30.0, 36.0

# A crank of constant inertia; a motor of two straight lines with a corner.
FILE = """format = 1
name = "Crank"
mechanism.cranks.A.radius = "1 m"
bodies.A = {{ on = "A", inertia = {J} }}
[drive]
motor = {{ kind = "table", speed = [0, {level!r}, 60], torque = [{LINE}, {at!r}, {last!r}], inertia = 0 }}
gearbox = {{ ratio = 1, efficiency = 1 }}
[loads.L]
kind = "formula"
on = "A"
torque = "-(15 + 7*cos(phi) + {second}*sin(2*phi))"
"""


def torque(speed: float) -> float:
    return LINE * (1 - speed / END)


def machine(level: float, steeper: float, second: float) -> lw.Machine:
    """Above the level the motor falls so many times as fast as below."""
    last = torque(level) - steeper * LINE / END * (60 - level)
    return lw.loads(FILE.format(J=J, LINE=LINE, level=level, at=torque(level), last=last, second=second))


def exponent(u: float, level: float, steeper: float, second: float) -> float:
    """∮ ∂ε/∂u dφ from u = ½ω² at φ = 0 on, from passage to passage of the corner."""
    is_above, phi, total = bool(2 * u > level**2), 0.0, 0.0

    def slope(phi: float, y: np.ndarray) -> list[float]:
        omega = float(np.sqrt(2 * y[0]))
        fall = LINE / END * (steeper if is_above else 1.0)
        load = 15.0 + 7.0 * np.cos(phi) + second * np.sin(2 * phi)
        return [(torque(level) - fall * (omega - level) - load) / J, -fall / (J * omega)]

    def passes(_phi: float, y: np.ndarray) -> float:
        return float(y[0] - 0.5 * level**2)

    passes.terminal = True  # type: ignore[attr-defined]
    while phi < 2 * np.pi:
        passes.direction = -1.0 if is_above else 1.0  # type: ignore[attr-defined]
        piece = solve_ivp(
            slope,
            (phi, 2 * np.pi),
            [u, total],
            "DOP853",
            rtol=1e-13,
            atol=1e-13,
            events=passes,
            max_step=1e-2,
        )
        phi, (u, total) = float(piece.t[-1]), piece.y[:, -1]
        is_above ^= piece.status == 1
    return total


@pytest.mark.parametrize("steeper", [3.0, 0.1])
@pytest.mark.parametrize("by", [0.03, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6])
def test_of_a_motion_that_just_passes_a_corner_of_the_motor(by: float, steeper: float) -> None:
    """The motion is above the corner over a few hundredths of a revolution only, within a step or two."""
    second = 4.0
    top = lw.steady_state(machine(30.0, 1.0, second), accuracy=1e-12).speed_max
    level = top * (1 - by)
    motion = lw.steady_state(machine(level, steeper, second))
    assert motion.speed_max > level
    found = exponent(0.5 * float(motion.speed[0]) ** 2, level, steeper, second)
    # The accuracy asked for, 1e-9, and what SciPy errs by.
    assert motion.multiplier == pytest.approx(np.exp(found), abs=2e-9 + motion.accuracy)


@pytest.mark.parametrize("accuracy", [1e-7, 1e-9, 1e-11])
def test_is_as_exact_as_the_motion(accuracy: float) -> None:
    of = machine(18.0, 2.5, 4.0)
    best = lw.steady_state(of, accuracy=1e-13)
    motion = lw.steady_state(of, accuracy=accuracy)
    assert motion.multiplier == pytest.approx(best.multiplier, abs=motion.accuracy + best.accuracy)
    assert motion.accuracy <= accuracy
