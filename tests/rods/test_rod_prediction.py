"""Predicted motion of a rod string: worked values, pump, unit, drive."""

from __future__ import annotations

import numpy as np
import pytest
from tests.samples.sizes import random_cases
from tests.samples.wells import API_STRING, FOOT, INCH, POUND, UNIT, random_well, well

import linkwright as lw

STRING = (
    API_STRING
    + """
tubing_diameter = "2.375 in"
tubing_bore = "1.995 in"
"""
)


def machine(*tables: str) -> lw.Machine:
    return lw.loads('format = 1\nname = "well"\n' + "\n".join(tables))


def test_the_worked_example_of_api_rp_11l():
    """5000 ft of ⅞ and ¾ in, 1½ in plunger, 54 in, 16 a minute, on a conventional unit.

    API's analog computations have 7 % in loads and 10 % in torque and power as their own limits.
    """
    motion = lw.rod_string(machine('[drive]\nspeed = "16 rpm"', UNIT, STRING))
    numbers = motion.numbers
    assert motion.stroke == pytest.approx(54 * INCH, rel=0.005)
    assert motion.fluid_load == pytest.approx(3098 * POUND, rel=0.003)
    assert numbers.stroke_force == pytest.approx(13_433 * POUND, rel=0.02)
    assert numbers.speed_ratio == pytest.approx(0.326, rel=0.01)
    assert motion.load_max == pytest.approx(14_355 * POUND, rel=0.07)
    assert motion.load_min == pytest.approx(5248 * POUND, rel=0.07)
    assert motion.gear is not None
    peak = max(motion.gear.torque_net_up, motion.gear.torque_net_down)
    assert peak == pytest.approx(133_793 * POUND * INCH, rel=0.1)
    assert motion.power_rod == pytest.approx(8.5 * 745.7, rel=0.1)
    assert numbers.counterbalance_effect == pytest.approx(10_237 * POUND, rel=0.01)


def test_everyday_numbers():
    """¾ in × 4200 ft, 41 in, 6.4 a minute, 1¼ in plunger, G = 0.85: N_o, k_r, F_o and stretch."""
    weight = 30.5e6 * 6894.757293168361 * np.pi / 4 * (0.75 * INCH) ** 2 / (245_000 / 15 * FOOT) ** 2
    section = {"diameter": "0.75 in", "weight": weight, "length": "4200 ft", "modulus": "30.5e6 psi"}
    pump = {"plunger": "1.25 in", "fluid_level": "4200 ft"}
    motion = lw.rod_string(
        well(pump, sections=[section], stroke="41 in", speed="6.4 rpm", specific_gravity=0.85)
    )
    assert 60 * motion.numbers.natural_frequency == pytest.approx(58.33, abs=0.01)
    # API's elastic constant 0.883e-6 in/(lb ft) is that of 30.75e6 psi.
    assert motion.numbers.spring_rate == pytest.approx(271.7 * POUND / INCH, rel=0.02)
    # Their head of 4840 ft has a column of 2096 lbf; ours is that of the level.
    area = np.pi / 4 * 1.25**2
    assert motion.fluid_load == pytest.approx(0.433 * 0.85 * 4200 * area * POUND, rel=2e-3)


def test_natural_frequency_of_equal_tapers_is_that_of_a_uniform_string():
    """Two sections of one rod: F_c = 1; a heavier upper section raises it, as API's table has for tapers."""
    half = {"rod": "3/4", "length": "2500 ft"}
    assert lw.rod_string(well(sections=[half, half])).numbers.frequency_factor == pytest.approx(1, rel=1e-12)
    # API RP 11L, table 4.1, rods No. 76 with a plunger of 1½ in: F_c = 1.082.
    assert lw.rod_string(well()).numbers.frequency_factor == pytest.approx(1.08, abs=0.005)


def test_loads_of_slow_pumping_are_static():
    """At a stroke in ten minutes: PPRL = W_rf + F_o, MPRL = W_rf, S_p = S − F_o/k_r − the stretch of the
    tubing.
    """
    pump = {"tubing_diameter": "2.375 in", "tubing_bore": "1.995 in", "bulk_modulus": "1e15 Pa"}
    slow = well(pump, speed="0.1 rpm")
    motion, string = lw.rod_string(slow), slow.rod_string
    assert motion.load_max == pytest.approx(motion.weight_fluid + motion.fluid_load, rel=2e-3)
    assert motion.load_min == pytest.approx(motion.weight_fluid, rel=3e-3)
    tubing = float(string.pump.tubing_compliance(string.length)) * motion.fluid_load
    assert motion.plunger_stroke == pytest.approx(motion.stroke - motion.stretch - tubing, rel=1e-3)
    assert motion.production == pytest.approx(
        float(string.pump.area) * motion.plunger_stroke / motion.period, rel=1e-6
    )


def test_the_pump_card_of_a_full_barrel_is_a_rectangle():
    """F_o on the upstroke, none on the downstroke: hydraulic power is the power of the pump."""
    motion = lw.rod_string(well({"bulk_modulus": "1e15 Pa"}), accuracy=2e-4)
    load = motion.load[-1]
    assert load.min() > -1e-3 * motion.fluid_load
    assert load.max() < 1.001 * motion.fluid_load
    inside = (load > 0.02 * motion.fluid_load) & (load < 0.98 * motion.fluid_load)
    velocity = np.gradient(motion.position[-1], motion.time)
    assert np.abs(velocity[inside]).max() < 0.02 * np.abs(velocity).max()
    assert motion.power_hydraulic == pytest.approx(motion.power_pump, rel=1e-5)


@pytest.mark.parametrize("gas", [{}, {"gas_exponent": 1.2}])
def test_partial_fillage_drops_the_load_where_the_plunger_meets_the_liquid(gas):
    """With 60 % of liquid the load falls at 60 % of the stroke; gas compresses to its part of the volume
    before.
    """
    machine = well({"fillage": 0.6, **gas})
    motion = lw.rod_string(machine)
    position, load = motion.position[-1], motion.load[-1]
    top = int(position.argmax())
    p, f = np.roll(position, -top), np.roll(load, -top)
    falls = int(np.argmax(f < 0.02 * motion.fluid_load))
    share = (p[falls] - p.min()) / np.ptp(p)
    string = machine.rod_string
    # Gas at discharge pressure still fills a little of the barrel when the travelling valve opens.
    left = 0.4 * (float(string.intake) / float(string.discharge)) ** (1 / 1.2) if gas else 0.0
    assert share == pytest.approx(0.6 + left, abs=0.03)


def test_the_drive_and_the_string_have_one_motion():
    """A motor that slips: torque of the gearbox, steady speed and the motion of the rods fit one another."""
    drive = """
[drive]
gearbox = { ratio = 60 }
[drive.motor]
kind = "induction"
power_rated = "15 kW"
speed_rated = "960 rpm"
speed_synchronous = "1000 rpm"
torque_breakdown = "350 N m"
inertia = 0.2
[bodies.crank]
on = "crank"
mass = 1.0
inertia = 3000
"""
    motion = lw.rod_string(machine(drive, UNIT, STRING))
    steady = motion.drive
    assert steady is not None
    # The last round moves the polished rod by less than a thousandth of the accuracy.
    assert motion.period == pytest.approx(steady.period, rel=1e-6)
    assert steady.speed_max > 1.05 * steady.speed_min
    # Work of the motor at the crank in a stroke is that at the polished rod: the unit itself loses nothing.
    assert steady.energy_drive == pytest.approx(motion.power_rod * motion.period, rel=2e-3)
    # The polished rod is where the crank is at the steady motion's time.
    unit = lw.pumping_unit(machine(UNIT))
    at = np.interp(motion.crank_angle, unit.crank_angle, unit.rod_travel)
    np.testing.assert_allclose(motion.rod_position, at, atol=2e-4 * motion.stroke)
    start = np.interp(motion.crank_angle[0], steady.crank_angle, steady.time)
    time = np.interp(motion.crank_angle, steady.crank_angle, steady.time)
    late = (time - start - motion.time + 0.5 * steady.period) % steady.period - 0.5 * steady.period
    assert np.abs(late).max() < 1e-4 * steady.period


def test_a_given_counterbalance_stands_beside_the_best_one():
    """The best one has equal peaks; a given one is used, and loads the gearbox more."""
    given = '[pumping_unit.load]\ncounterbalance = "20 kN m"'
    motion = lw.rod_string(machine('[drive]\nspeed = "16 rpm"', UNIT, given, STRING))
    assert motion.gear is not None
    assert motion.gear_best is not None
    assert motion.gear.counterbalance == 20e3
    best = motion.gear_best
    assert best.torque_net_up == pytest.approx(best.torque_net_down, rel=1e-9)
    assert max(motion.gear.torque_net_up, motion.gear.torque_net_down) > best.torque_net_up
    # Work of the polished rod by the crank angle is that of the card over time.
    assert best.work == pytest.approx(motion.power_rod * motion.period, rel=2e-3)


def test_modified_goodman_diagram():
    """S_max ≤ (T/4 + 0.5625 S_min) SF at every taper; a section without a strength has no limit."""
    sections = [
        {"rod": "7/8", "length": "1585 ft", "tensile": "90000 psi"},
        {"rod": "3/4", "length": "3415 ft"},
    ]
    stress = lw.rod_string(well(sections=sections, service_factor=0.9)).stress
    high, low, T = stress.stress_max[0], stress.stress_min[0], 90_000 * 6894.757293168361
    permissible = 0.9 * (T / 4 + 0.5625 * low)
    assert stress.stress_permissible[0] == pytest.approx(permissible, rel=1e-12)
    assert stress.loading[0] == pytest.approx((high - low) / (permissible - low), rel=1e-12)
    assert np.isnan(stress.loading[1])
    assert stress.loading_max == stress.loading[0]
    area = np.pi / 4 * (0.875 * INCH) ** 2
    assert stress.load_max[0] == pytest.approx(high * area, rel=1e-12)


def test_the_accuracy_that_is_told_is_that_of_the_result():
    """Against four times as many harmonics, peak loads and stroke differ by no more than three times what
    was told.
    """
    for _, generator in random_cases(4902, 4, 30):
        found = random_well(generator)
        motion, fine = lw.rod_string(found, accuracy=2e-3), lw.rod_string(found, accuracy=1e-6)
        span = fine.load_max - fine.load_min
        error = max(abs(motion.load_max - fine.load_max), abs(motion.load_min - fine.load_min)) / span
        assert error < 3 * max(motion.accuracy, fine.accuracy)
        assert abs(motion.balance) < 1e-10


def test_friction_of_the_stuffing_box_is_work_at_the_polished_rod():
    """Twice the stroke times the friction is added to the work of a stroke, and to the range of the load."""
    without, with_box = lw.rod_string(well()), lw.rod_string(well(stuffing_box="500 N"))
    work = (with_box.power_rod - without.power_rod) * without.period
    assert work == pytest.approx(2 * 500 * without.stroke, rel=1e-9)
    assert with_box.load_max == pytest.approx(without.load_max + 500, rel=1e-9)
    assert with_box.load_min == pytest.approx(without.load_min - 500, rel=1e-9)


@pytest.mark.parametrize(
    ("pump", "entries", "found"),
    [
        ({}, {"depth": "4000 ft"}, "deeper than the pump"),
        ({}, {"depth": "5500 ft"}, "short of the pump"),
        ({"fluid_level": "6000 ft"}, {}, "a level above the pump"),
        ({"intake_pressure": "2e7 Pa", "fluid_level": None}, {}, "below the discharge pressure"),
        ({}, {"inclination": "30 deg"}, "from 0 to 10 deg"),
        ({}, {"specific_gravity": 900}, "a liquid of 300 to 2000"),
        ({}, {"sections": []}, "one section or more"),
        ({}, {"sections": [{"rod": "3/4", "length": 0}]}, "a length greater than 0"),
        (
            {},
            {"sections": [{"diameter": "0.75 in", "weight": 16.3, "length": "5000 ft"}]},
            "about the weight",
        ),
        ({"gas_exponent": 1.2}, {}, "a fillage below 1"),
        ({"tubing_bore": "2 in"}, {}, "given together"),
    ],
)
def test_a_string_that_cannot_be_is_refused(pump, entries, found):
    """What contradicts itself is named, with what was expected."""
    with pytest.raises(lw.MachineError, match=found):
        well(pump, **entries)


def test_two_motions_and_two_loads_are_refused():
    """A unit moves the polished rod and a string loads it: nothing else does."""
    load = '[pumping_unit.load]\nangle = ["0 deg", "180 deg"]\nforce = [1e4, 2e4]'
    with pytest.raises(lw.MachineError, match="remove the table, or the string"):
        machine(UNIT, load, STRING)
    with pytest.raises(lw.MachineError, match="moves the polished rod"):
        machine(UNIT, STRING.replace("[rod_string]", "[rod_string]\nstroke = 1.0"))
    with pytest.raises(lw.MachineError, match=r"or a \[rod_string\]"):
        machine(UNIT, '[pumping_unit.load]\ncounterbalance = "optimal"')
    with pytest.raises(lw.InputError, match="no pumping speed"):
        lw.rod_string(machine(UNIT, STRING))
