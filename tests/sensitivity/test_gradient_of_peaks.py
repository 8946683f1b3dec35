"""Derivatives of extremes where inertia changes fast over the angle: the peaks are narrow there."""

from __future__ import annotations

import numpy as np
import pytest

import linkwright as lw

# A heavy slider on a light crank: between dead centres inertia grows ninefold or more within a few degrees.
FILE = """format = 1
name = "Heavy slider"
drive.motor = {{ kind = "dc", speed_no_load = 33, torque_stall = 577, inertia = 0.007 }}
mechanism.cranks.A.radius = 0.31
mechanism.sliders.S = {{ crank = "A", rod = 1.0, offset = {offset}, angle = 1.57 }}
bodies.A.mass = 32
bodies.S.mass = {mass}
loads.drag = {{ kind = "viscous", on = "A", damping = 1 }}
"""

NUMBERS = (
    "speed_min", "speed_max", "unevenness", "torque_motor_min", "torque_motor_max",
    "acceleration_min", "acceleration_max",
)  # fmt: skip


@pytest.mark.parametrize("offset", [0.0, 0.0155])
@pytest.mark.parametrize("mass", [50.0, 267.0])
def test_a_slider_that_is_turned_about_the_crank_does_the_same_later(offset: float, mass: float) -> None:
    """Drive and drag know of no angle: by that of the slider no extreme has a derivative."""
    machine = lw.loads(FILE.format(offset=offset, mass=mass))
    found = lw.gradient(
        machine, [f"steady_state.{name}" for name in NUMBERS], variables=["mechanism.sliders.S.angle"]
    )
    assert not found.ties
    # Angles of peaks of the acceleration are known to rounding of it over its bend: its derivative less well.
    tolerance = np.where(["acceleration" in name for name in NUMBERS], 1e-8, 1e-9)
    assert (np.abs(found.derivatives[:, 0]) <= tolerance * np.abs(found.values)).all(), found.derivatives


# A heavy rod behind a motor by table, whose largest acceleration lies just behind the start of a step.
HEAVY_ROD = """format = 1
name = "Heavy rod"
drive.motor = { kind = "table", speed = [0, 3.6, 7.2, 10.9], torque = [260, 326, 130, -260] }
mechanism.cranks.A.radius = 0.52
mechanism.sliders.S = { crank = "A", rod = 2, angle = 0.3 }
bodies.A.mass = 0.3
bodies.S.mass = 240
bodies."S.rod".mass = 66
"""


def test_a_peak_beside_the_end_of_a_step_does_the_same_later() -> None:
    names = [f"steady_state.acceleration_{of}" for of in ("min", "max")]
    found = lw.gradient(lw.loads(HEAVY_ROD), names, variables=["mechanism.sliders.S.angle"])
    assert not found.ties
    assert (np.abs(found.derivatives[:, 0]) <= 1e-8 * np.abs(found.values)).all(), found.derivatives
