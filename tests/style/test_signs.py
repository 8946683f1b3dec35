"""What `docs/signs.md` says about signs is so."""

from __future__ import annotations

import numpy as np
import pytest

import linkwright as lw
from linkwright.topping import Coverage, edges_of
from linkwright.topping.coverage import coverage

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
    from linkwright.machine import compile_machine

    drive = '[drive.motor]\nkind = "dc"\nspeed_no_load = 100\ntorque_stall = 10\n'
    text = MACHINE.format(load='{ kind = "gravity" }', slider="") + drive
    gearbox = "[drive.gearbox]\nratio = 10\nefficiency = 0.8\n"
    for more, factor in (("", 1 / 0.8), ('reverse = "same"', 0.8), ("reverse = 0.5", 0.5)):
        torques = compile_machine(lw.loads(text + gearbox + more)).motor_torques([5.0, 12.0])
        assert torques.motor == pytest.approx([5.0, -2.0])
        assert torques.crank == pytest.approx([5.0 * 10 * 0.8, -2.0 * 10 * factor])


TOPPER = """
format = 1
name = "Edge"
[topper]
root_diameter = 0.1
cut_height = 0.05
edge_angle = "{angle} deg"
edge_length = 0.1
forward_speed = 2
knife_speed = {speed}
motion = {{ kind = "harmonic", stroke = 0.06 }}
"""


def heads(offset: float, phase: float, angle: float = 0, speed: float = 0.01) -> Coverage:
    """One head of 0.1 m under an edge of 0.1 m."""
    machine = lw.loads(TOPPER.format(angle=angle, speed=speed))
    assert machine.topper is not None
    edge = edges_of(machine, machine.topper)[0]
    return coverage(edge, 0.1, offset, phase, length=0.1)


def test_offsets_of_roots_count_to_the_left() -> None:
    found = heads(offset=0.02, phase=0)
    assert found.uncut_left[0] > 0 == found.uncut_right[0]
    assert found.last_y[0] == pytest.approx(0.05, abs=1e-3)


def test_a_sine_goes_to_the_left_from_phase_zero() -> None:
    """A quarter of a revolution on it is at its left end, and leaves the right side of a head."""
    found = heads(offset=0, phase=np.pi / 2)
    assert found.uncut_right[0] > 0 == found.uncut_left[0]


def test_the_left_end_leads_at_positive_angles() -> None:
    """Going to the left, towards its leading end, it hardly goes on, and leaves more."""
    ahead, behind = (heads(0, phase, angle=40, speed=0.5) for phase in (0, np.pi))
    assert ahead.length_needed[0] > behind.length_needed[0]
    assert heads(0, 0, angle=-40, speed=0.5).length_needed[0] == pytest.approx(behind.length_needed[0])


LINKAGE = """
format = 1
name = "Elements on a crank"
[mechanism.points]
P = { x = 0.5, y = 0 }
[mechanism.cranks.A]
radius = 0.2
"""


def element(text: str, angle: float = 0.3) -> lw.Kinematics:
    return lw.kinematics(lw.loads(LINKAGE + text), [angle])


@pytest.mark.parametrize(
    ("kind", "sense"), [("external", -1), ("crossed_belt", -1), ("internal", 1), ("belt", 1)]
)
def test_sense_and_phase_of_gears(kind: str, sense: int) -> None:
    gear = f'G = {{ kind = "{kind}", pivot = "P", meshes = "A", size = 2, size_other = 1, phase = "40 deg" }}'
    found = element("[mechanism.gears]\n" + gear).links["G"]
    assert found.d1[0] == pytest.approx(sense / 2)
    assert found.angle[0] == pytest.approx(np.radians(40) + sense * 0.3 / 2)


@pytest.mark.parametrize(("side", "sign"), [("right", 1), ("left", -1)])
def test_rack_on_the_right_goes_ahead(side: str, sign: int) -> None:
    rack = f'T = {{ gear = "A", radius = 0.1, side = "{side}", guide = {{ angle = "90 deg" }} }}'
    assert element("[mechanism.racks]\n" + rack).points["T"].d1[0] == pytest.approx([0, sign * 0.1])


@pytest.mark.parametrize(("side", "sign"), [("left", -1), ("right", 1)])
def test_cable_on_the_left_is_drawn_in(side: str, sign: int) -> None:
    """It hangs down; left of downward is to the right of the page."""
    cable = f'H = {{ link = "A", radius = 0.1, length = 1, side = "{side}" }}'
    found = element("[mechanism.cables]\n" + cable)
    assert found.slides["H"].d1[0] == pytest.approx(sign * 0.1)
    assert found.points["H"].position[0] == pytest.approx([-sign * 0.1, -1 - sign * 0.1 * 0.3])


@pytest.mark.parametrize(("assembly", "sign"), [("ahead", 1), ("behind", -1)])
def test_slot_passes_to_the_left_of_the_pivot(assembly: str, sign: int) -> None:
    lever = f'L = {{ pin = "A", pivot = "P", offset = 0.05, assembly = "{assembly}" }}'
    found = element("[mechanism.slotted_levers]\n" + lever)
    angle, pin = found.links["L"].angle[0], found.points["A"].position[0] - [0.5, 0]
    along, across = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    assert pin @ across == pytest.approx(0.05)
    assert np.sign(pin @ along) == sign
    assert found.slides["L"].position[0] == pytest.approx(pin @ along)


def test_guide_on_a_link_counts_from_the_link() -> None:
    slider = 'S = { crank = "B", rod = 0.6, on = "A", angle = "30 deg", offset = 0.03 }\n'
    found = element("[mechanism.sliders]\n" + slider + '[mechanism.cranks.B]\nradius = 0.1\npivot = "P"\n')
    angle = 0.3 + np.radians(30)
    place = found.points["S"].position[0]
    assert place @ [-np.sin(angle), np.cos(angle)] == pytest.approx(0.03)
    assert place @ [np.cos(angle), np.sin(angle)] == pytest.approx(found.slides["S"].position[0])


def test_slot_of_a_yoke_counts_from_its_guide() -> None:
    found = element('[mechanism.yokes]\nY = { pin = "A", slot = "60 deg", guide = { angle = "20 deg" } }')
    u = found.points["Y"].position[0] - found.points["A"].position[0]
    assert u @ [-np.sin(np.radians(80)), np.cos(np.radians(80))] == pytest.approx(0, abs=1e-15)
    assert found.slides["Y.slot"].position[0] == pytest.approx(
        u @ [np.cos(np.radians(80)), np.sin(np.radians(80))]
    )
    assert found.links["Y"].angle[0] == pytest.approx(np.radians(20))
