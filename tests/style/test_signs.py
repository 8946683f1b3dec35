"""What `docs/signs.md` says about signs is so."""

from __future__ import annotations

import numpy as np
import pytest

import linkwright as lw

MACHINE = """
format = 1
name = "One slider-crank with one load"
[mechanism.points]
F = {{ x = -1, y = 0 }}
[mechanism.cranks.A]
radius = 0.2
[mechanism.sliders.s]
crank = "A"
rod = 0.8
{slider}
[bodies]
s = {{ mass = 10 }}
[loads]
load = {load}
"""

# Torque that the load asks of the crank, from position and first transfer function of the slider.
LOADS = {
    '{ kind = "dry", on = "s", force = 100 }': lambda s, d1: 100 * abs(d1),
    '{ kind = "force", on = "s", force = 100 }': lambda s, d1: -100 * d1,
    '{ kind = "force", on = "s", force = 100, direction = "180 deg" }': lambda s, d1: 100 * d1,
    '{ kind = "torque", on = "A", torque = 5 }': lambda s, d1: -5 + 0 * s,
    '{ kind = "torque_angle", angle = [0, 3], torque = [5, 5] }': lambda s, d1: 5 + 0 * s,
    '{ kind = "spring", between = ["F", "s"], stiffness = 100, free_length = 1.5 }': lambda s, d1: (
        100 * (s + 1 - 1.5) * d1
    ),
    '{ kind = "force_position", on = "s", position = [0, 2], forward = [100, 100], return = [20, 20] }': (
        lambda s, d1: np.where(d1 > 0, 100, 20) * abs(d1)
    ),
    '{ kind = "gravity", direction = 0 }': lambda s, d1: -10 * 9.81 * d1,
}


def machine(load: str = '{ kind = "gravity" }', slider: str = "") -> lw.Machine:
    """The slider-crank with a load and further entries of the slider."""
    return lw.loads(MACHINE.format(load=load, slider=slider))


@pytest.mark.parametrize("load", LOADS)
def test_torque_of_a_load_is_positive_against_the_motion(load: str) -> None:
    reduced = lw.reduction(machine(load), n=36)
    slide = lw.kinematics(machine(load), reduced.crank_angle).slides["s"]
    # At the dead centres the sign of s′ is rounding; there nothing is asked.
    moving = abs(slide.d1) > 1e-9
    expected = LOADS[load](slide.position, slide.d1)
    np.testing.assert_allclose(reduced.torque_load[moving], expected[moving], rtol=1e-12, atol=1e-11)


@pytest.mark.parametrize(("side", "sign"), [("positive", 1), ("negative", -1)])
def test_slider_is_on_its_side(side: str, sign: int) -> None:
    phi = np.linspace(0, 2 * np.pi, 13)
    found = lw.kinematics(machine(slider=f'assembly = "{side}"'), phi).slides["s"].position
    expected = 0.2 * np.cos(phi) + sign * np.sqrt(0.8**2 - (0.2 * np.sin(phi)) ** 2)
    np.testing.assert_allclose(found, expected, rtol=1e-14)


def test_offset_is_to_the_left_of_the_guide() -> None:
    found = lw.kinematics(machine(slider='offset = 0.05\nangle = "90 deg"'), [1.0]).points["s"].position
    assert found[0, 0] == pytest.approx(-0.05, abs=1e-15)


def test_gear_efficiency_acts_by_direction() -> None:
    from linkwright.engine import compile_machine

    drive = '[drive.motor]\nkind = "dc"\nspeed_no_load = 100\ntorque_stall = 10\n'
    text = MACHINE.format(load='{ kind = "gravity" }', slider="") + drive
    gearbox = "[drive.gearbox]\nratio = 10\nefficiency = 0.8\n"
    for more, factor in (("", 1 / 0.8), ('reverse = "same"', 0.8), ("reverse = 0.5", 0.5)):
        at_motor, at_crank = compile_machine(lw.loads(text + gearbox + more)).motor_torques([5.0, 12.0])
        assert at_motor == pytest.approx([5.0, -2.0])
        assert at_crank == pytest.approx([5.0 * 10 * 0.8, -2.0 * 10 * factor])
