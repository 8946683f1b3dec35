"""Drives that creep: a load that grows steeply with speed balances the drive far below its working speed."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq
from sizes import cases

import linkwright as lw
from linkwright import SteadyStateError

STALL, NO_LOAD, J = 3.0, 40.0, 0.3  # N m, rad/s, kg m²

# A crank of constant inertia.
FILE = f"""format = 1
name = "Crank in a thick fluid"
mechanism.cranks.A.radius = "1 m"
bodies.A = {{{{ on = "A", inertia = {J} }}}}
drive.motor = {{{{ kind = "dc", speed_no_load = {NO_LOAD}, torque_stall = {STALL} }}}}
[loads.drag]
kind = "formula"
on = "A"
torque = "-({{weight}}*cos(phi) + {{drag!r}}*(1 + 0.5*sin(phi))*tanh(omega))"
"""

# Drag at speed, over the drive's torque at rest: the machine creeps at about the inverse of it [rad/s].
# With the later ones drive and loads balance to all digits of their accelerations.
DRAGS = [1e2, 1e4, 1e6, 1e8, 1e10]


def balanced(phi: float, weight: float, drag: float) -> float:
    """Speed at which drive and load balance [rad/s]: J ω ω′, a share ω² J/M of them, is left out."""

    def left(log: float) -> float:
        omega = np.exp(log)
        load = weight * np.cos(phi) + drag * (1 + 0.5 * np.sin(phi)) * np.tanh(omega)
        return float(STALL * (1 - omega / NO_LOAD) - load)

    return float(np.exp(brentq(left, -40.0, np.log(NO_LOAD), xtol=1e-14)))


@pytest.mark.parametrize("weight", [0.0, 0.9 * STALL])
# The last one takes many times as long as all others; what is lost to rounding shows at the one before.
@pytest.mark.parametrize("share", DRAGS[: cases(4, 5)])
def test_a_drive_that_creeps_has_a_steady_motion(share: float, weight: float) -> None:
    drag = share * STALL
    machine = lw.loads(FILE.format(weight=weight, drag=drag))
    motion = lw.steady_state(machine, n=24)
    expected = [balanced(phi, weight, drag) for phi in motion.crank_angle]
    # J ω ω′ is left out above; 1e-9 is promised. A tanh good to 1e-16 of 1 would leave 1e-16 share.
    left_out = J * max(expected) ** 2 / STALL * 10
    assert motion.speed == pytest.approx(np.array(expected), rel=max(left_out, 1e-9))
    assert motion.accuracy < 1e-7
    assert motion.is_stable
    batch = lw.steady_states(machine, {"drive.motor.torque_stall": np.array([STALL, 2 * STALL])})
    assert batch.speed_max[0] == pytest.approx(motion.speed_max, rel=1e-6)


@pytest.mark.parametrize("share", DRAGS)
def test_a_drive_that_creeps_to_a_weight_that_it_cannot_lift_rests(share: float) -> None:
    """Where the drive at rest does not lift the weight, at φ = 0, the machine comes to rest."""
    machine = lw.loads(FILE.format(weight=1.1 * STALL, drag=share * STALL))
    with pytest.raises(SteadyStateError, match="comes to rest at φ"):
        lw.steady_state(machine)
