"""Predicted motions against a march in time with damping, tapers and valves; API RP 11L's plunger stroke."""

from __future__ import annotations

import numpy as np
import pytest
from tests.samples.rod_march import march
from tests.samples.wells import FOOT, INCH, POUND, UNIT, well

import linkwright as lw


@pytest.mark.parametrize(
    ("pump", "entries"),
    [
        ({}, {}),
        ({"plunger": "2 in"}, {"damping_factor": 0.3}),
        ({}, {"speed": "9 rpm", "damping": 0.4, "sections": [{"rod": "7/8", "length": "4600 ft"}]}),
    ],
)
def test_a_march_in_time_with_valves_and_damping_has_the_same_cards(pump, entries):
    """Full barrel: plunger stroke to 1e-4, loads to 0.2 % of their range, their mean error to 0.05 %."""
    machine = well({"bulk_modulus": "1e15 Pa", **pump}, **entries)
    motion = lw.rod_string(machine, accuracy=3e-4)
    n, span = 2000, motion.load_max - motion.load_min
    rod = 0.5 * motion.stroke * (1 - np.cos(2 * np.pi * np.arange(n) / n))
    found = march(machine.rod_string, rod, motion.period)
    weight = float(machine.rod_string.weight_fluid)
    assert np.ptp(found.plunger) == pytest.approx(motion.plunger_stroke, rel=1e-4)
    assert found.load.max() + weight == pytest.approx(motion.load_max, abs=2e-3 * span)
    assert found.load.min() + weight == pytest.approx(motion.load_min, abs=2e-3 * span)
    at = np.interp(np.arange(n) / n, motion.time / motion.period, motion.load[0], period=1)
    assert np.std(found.load - at) < 5e-4 * span


def test_a_march_in_time_pounds_the_fluid_as_predicted():
    """With 60 % fillage: plunger stroke to 0.1 %, loads to 3 % in the mean, where the march still rings."""
    machine = well({"bulk_modulus": "1e15 Pa", "fillage": 0.6})
    motion = lw.rod_string(machine, accuracy=0.02)
    n = 2000
    rod = 0.5 * motion.stroke * (1 - np.cos(2 * np.pi * np.arange(n) / n))
    found = march(machine.rod_string, rod, motion.period, fillage=0.6)
    assert np.ptp(found.plunger) == pytest.approx(motion.plunger_stroke, rel=1e-3)
    at = np.interp(np.arange(n) / n, motion.time / motion.period, motion.load[0], period=1)
    assert np.std(found.load - at) < 0.03 * (motion.load_max - motion.load_min)


def test_the_card_of_a_march_in_time_is_diagnosed():
    """A card that knows no harmonics: stroke to 0.3 %, fillage to 0.02, fluid load to 6 %, damping to 15 %.

    Ringing of the march after the fluid pound counts as load of the pump.
    """
    machine = well({"bulk_modulus": "1e15 Pa", "fillage": 0.7}, damping_factor=0.12)
    n, period = 2000, 3.75
    rod = 27 * INCH * (1 - np.cos(2 * np.pi * np.arange(n) / n))
    found = march(machine.rod_string, rod, period, fillage=0.7)
    load = found.load + float(machine.rod_string.weight_fluid)
    # A recorder of 200 samples averages the load over each.
    seen = lw.diagnose_card(machine, rod.reshape(200, 10).mean(axis=1), load.reshape(200, 10).mean(axis=1))
    assert seen.plunger_stroke == pytest.approx(np.ptp(found.plunger), rel=3e-3)
    assert seen.fillage == pytest.approx(0.7, abs=0.02)
    assert seen.fluid_load == pytest.approx(float(machine.rod_string.fluid_load), rel=0.06)
    assert seen.damping_factor == pytest.approx(0.12, rel=0.15)


MOTOR = """
[drive.gearbox]
ratio = 60
[drive.motor]
kind = "induction"
power_rated = "9 kW"
speed_rated = "960 rpm"
speed_synchronous = "1000 rpm"
torque_breakdown = "300 N m"
inertia = 0.1
[bodies.crank]
on = "crank"
mass = 1.0
inertia = 1000
"""

STRING = """
[rod_string]
specific_gravity = 0.9
[[rod_string.sections]]
rod = "7/8"
length = "1585 ft"
[[rod_string.sections]]
rod = "3/4"
length = "3415 ft"
[rod_string.pump]
plunger = "1.5 in"
fluid_level = "4500 ft"
"""


def test_slip_and_string_have_one_motion_however_the_motor_slips():
    """Motors of 4 and 10 % of slip: the period of the string is that of its drive to 1e-6."""
    head = 'format = 1\nname = "well"\n'
    for rated in (960, 900):
        motion = lw.rod_string(lw.loads(head + MOTOR.replace("960", str(rated)) + UNIT + STRING))
        assert motion.drive is not None
        assert motion.period == pytest.approx(motion.drive.period, rel=1e-6)
        work = motion.power_rod * motion.period
        assert motion.drive.energy_drive == pytest.approx(work, rel=3e-3)


def test_the_plunger_stroke_of_api_rp_11l():
    """41.7 in to 3 %, as API computes it: anchored tubing, less F_o/k_t, and a motor of medium slip.

    At constant speed it is 6 % more, and 14 % where tubing moves with the load of every instant.
    """
    stretch = (
        3098 * POUND * 5000 * FOOT / (30e6 * 6894.757293168361 * np.pi / 4 * (2.375**2 - 1.995**2) * INCH**2)
    )
    assert stretch == pytest.approx(4.76 * INCH, rel=0.005)
    head = 'format = 1\nname = "well"\n'
    slips = lw.rod_string(lw.loads(head + MOTOR + UNIT + STRING))
    assert 60 / slips.period == pytest.approx(16, rel=0.01)
    assert slips.plunger_stroke - stretch == pytest.approx(41.7 * INCH, rel=0.03)
    even = lw.rod_string(lw.loads(head + '[drive]\nspeed = "16 rpm"\n' + UNIT + STRING))
    assert even.plunger_stroke - stretch == pytest.approx(1.06 * 41.7 * INCH, rel=0.01)
    moves = STRING + 'tubing_diameter = "2.375 in"\ntubing_bore = "1.995 in"\n'
    moving = lw.rod_string(lw.loads(head + '[drive]\nspeed = "16 rpm"\n' + UNIT + moves))
    assert moving.plunger_stroke == pytest.approx(1.14 * 41.7 * INCH, rel=0.01)


def test_everyday_numbers_of_a_field():
    """¾ in × 4200 ft, 1¼ in plunger, G = 0.85: F_o 2096 lbf and 7.7 in of stretch with their head of 4640 ft.

    0.433 G H A_p = 2096 lbf is a net lift of 4640 ft: level and wellhead pressure together.
    """
    area = np.pi / 4 * 1.25**2
    head = 2096 / (0.433 * 0.85 * area)
    pressure = f"{0.433 * 0.85 * (head - 4200):.6g} psi"
    sections = [{"rod": "3/4", "length": "4200 ft"}]
    pump = {"plunger": "1.25 in", "fluid_level": "4200 ft", "tubing_pressure": pressure}
    motion = lw.rod_string(
        well(pump, sections=sections, stroke="41 in", speed="6.4 rpm", specific_gravity=0.85)
    )
    assert motion.fluid_load == pytest.approx(2096 * POUND, rel=2e-3)
    assert motion.stretch == pytest.approx(7.7 * INCH, rel=0.02)
    assert 60 * motion.numbers.natural_frequency == pytest.approx(244_500 / 4200, rel=0.005)


def test_a_catalogue_unit_has_its_stroke():
    """C-320-305-120 with A 136, C 118, I 125.63, K 188.25, P 142.63, R 50 in: 120.14 in."""
    unit = {"A": 136, "C": 118, "I": 125.63, "K": 188.25, "P": 142.63, "R": 50}
    entries = {key: value * INCH for key, value in unit.items()} | {"designation": "C-320D-305-120"}
    machine = lw.Machine.model_validate({"format": 1, "name": "unit", "pumping_unit": entries})
    assert lw.pumping_unit(machine).stroke == pytest.approx(120.14 * INCH, abs=0.005 * INCH)


def test_json_has_sections_gearbox_and_terms_of_api():
    """What the tables show, `--json` has: loading of every section, torque, F_o/Sk_r."""
    motion = lw.rod_string(lw.loads('format = 1\nname = "w"\n[drive]\nspeed = "16 rpm"\n' + UNIT + STRING))
    found = motion.to_dict()
    assert found["stress"]["load_max"] == motion.stress.load_max.tolist()
    assert found["gear"]["torque_net_up"] == motion.gear.torque_net_up
    assert found["numbers"]["load_ratio"] == motion.numbers.load_ratio
    assert "position" not in found
