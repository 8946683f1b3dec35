"""Rod strings that cannot be, and those that can but should not: refusals and warnings."""

from __future__ import annotations

import re

import numpy as np
import pytest
from tests.samples.wells import well

import linkwright as lw
from linkwright.rods.warnings import string_findings, string_warnings


def of(**entries):
    """A string of one section of ¾ in, its entries exchanged."""
    return {"sections": [{"rod": "3/4", "length": "5000 ft"} | entries]}


def own(**entries):
    """A section by its diameter and weight."""
    return {"sections": [{"diameter": "0.75 in", "weight": "1.63 lb/ft", "length": "5000 ft"} | entries]}


@pytest.mark.parametrize(
    ("pump", "entries", "found"),
    [
        ({}, {"depth": "4900 ft"}, "deeper than the pump"),
        ({}, {"depth": "5500 ft"}, "short of the pump"),
        ({}, of(length="-1 ft"), "a length greater than 0"),
        ({}, of(rod="5/4"), 'one of "1/2"'),
        ({}, of(rod=None), "a nominal size"),
        ({}, of(diameter="20 mm", weight="2.5 kg/m"), "nothing beside diameter and weight"),
        # Pounds per foot read as kilograms per metre are 0.73 of steel, the other way 1.6.
        ({}, own(weight=1.63), "about the weight"),
        ({}, own(weight="2.43 lb/ft"), "about the weight"),
        ({}, own(diameter="0.75 mm"), "about the weight"),
        ({}, own(diameter=0.75), "about the weight"),
        ({}, of(modulus="30.5e6 Pa"), "a speed of sound"),
        ({}, of(modulus="2.1e14 Pa"), "a speed of sound"),
        ({}, of(tensile=90_000), "a pressure from 1e\\+08"),
        ({}, of(tensile="600 MPa", grade="C"), "nothing beside the grade"),
        ({"plunger": 1.5}, {}, "from 0.01 to 0.2 m"),
        ({"plunger": "1.5 mm"}, {}, "from 0.01 to 0.2 m"),
        ({"fillage": 0}, {}, "above 0 and up to 1"),
        ({"fillage": 1.2}, {}, "above 0 and up to 1"),
        ({"gas_exponent": 1.2}, {}, "a fillage below 1"),
        ({"fillage": 0.5, "gas_exponent": 0.5}, {}, "1 or more"),
        ({"fluid_level": "6000 ft"}, {}, "a level above the pump"),
        ({"fluid_level": "-10 ft"}, {}, "0 or more"),
        ({"fluid_level": 0}, {}, "flows by itself"),
        ({"fluid_level": None}, {}, "either fluid_level or intake_pressure"),
        ({"intake_pressure": "1 MPa"}, {}, "either fluid_level or intake_pressure"),
        ({"fluid_level": None, "intake_pressure": "100 MPa"}, {}, "wrong unit"),
        ({"tubing_pressure": -1.0}, {}, "0 or more"),
        ({"bulk_modulus": "1 MPa"}, {}, "1e8 Pa or more"),
        ({"tubing_diameter": "2.375 in"}, {}, "given together"),
        ({"tubing_diameter": "2 in", "tubing_bore": "2.4 in"}, {}, "less than tubing_diameter"),
        ({}, {"density": 900.0}, "either specific_gravity or density"),
        ({}, {"specific_gravity": None}, "either specific_gravity or density"),
        ({}, {"specific_gravity": 90}, "a liquid of 300 to 2000"),
        ({}, {"damping": -1.0}, "0 or more"),
        ({}, {"damping": 500.0}, "a factor up to 5"),
        ({}, {"damping": 0.3, "damping_factor": 0.1}, "either damping or damping_factor"),
        ({}, {"stuffing_box": "50 kN"}, "less than the weight of the rods"),
        ({}, {"inclination": "20 deg"}, "from 0 to 10 deg"),
        ({}, {"service_factor": 1.5}, "above 0 and up to 1"),
        ({}, {"stroke": "54 ft"}, "from 0.1 to 15 m"),
        ({}, {"speed": -1.0}, "greater than 0"),
    ],
)
def test_a_string_that_cannot_be_is_refused_with_its_key(pump, entries, found):
    """What contradicts itself, or is in a wrong unit, is named with what was expected."""
    with pytest.raises(lw.MachineError, match=found):
        well(pump, **entries)


def sentences(machine):
    motion = lw.rod_string(machine, accuracy=3e-3)
    return " ".join([*string_findings(motion), *string_warnings(machine.rod_string, motion)])


@pytest.mark.parametrize(
    ("pump", "entries", "found"),
    [
        ({}, {"depth": "5150 ft"}, "end 45.72 m above the pump"),
        ({}, {"inclination": "5 deg"}, "The well is inclined"),
        ({}, {"speed": "40 rpm"}, "close to resonance"),
        ({}, {"speed": "30 rpm"}, "the rods fall more slowly than the carrier bar"),
        ({}, {"speed": "30 rpm"}, "Section 1 \\(7/8 in\\) is overloaded"),
        ({}, of(rod="1/2", length="16400 ft"), "the plunger hardly moves"),
        ({"leak": "100 l/min"}, {}, "slippage takes all"),
        ({"fillage": 0.3}, {"damping_factor": 0.02}, "falls too suddenly"),
        ({}, {"speed": "40 rpm"}, "Section 1 \\(7/8 in\\) tends to buckle"),
    ],
)
def test_a_string_that_pumps_badly_is_told_of(pump, entries, found):
    """Resonance, floating rods, overload, stretch, slippage, pounding, buckling: a sentence with numbers."""
    text = sentences(well(pump, **entries))
    assert re.search(found, text), text


def test_without_damping_the_valves_alone_end_the_waves():
    """No work is lost along the rods: the surface card has that of the pump card, to 1e-10."""
    motion = lw.rod_string(well(damping=0.0), accuracy=0.02)
    assert motion.power_damping == 0.0
    assert motion.power_rod == pytest.approx(motion.power_pump, rel=1e-10)


def test_a_pump_that_slips_more_than_it_lifts_produces_nothing():
    """Production is zero, not below it, and the load is that of the rods alone."""
    motion = lw.rod_string(well({"leak": "10 l/s"}))
    assert motion.production == 0.0
    without = lw.rod_string(well({"leak": "1000 l/s"}))
    assert motion.load_max == pytest.approx(without.load_max, rel=0.01)


def test_the_pressure_of_the_column_is_that_of_the_pumps_depth():
    """Rods 3 % short of the pump: F_o = ρ g H A_p still, and p_d = ρ g D."""
    string = well(depth="5150 ft").rod_string
    area = np.pi / 4 * (1.5 * 0.0254) ** 2
    assert string.fluid_load == pytest.approx(900 * 9.80665 * 4500 * 0.3048 * area, rel=1e-12)
    assert string.discharge == pytest.approx(900 * 9.80665 * 5150 * 0.3048, rel=1e-12)


@pytest.mark.parametrize(("fillage", "gas"), [(0.1, None), (0.1, 1.0), (0.5, 1.3), (1.0, None)])
def test_fillage_from_pumped_off_to_full_gives_a_card(fillage, gas):
    """Any fillage, with gas or without: production is f times the displacement, work balances."""
    motion = lw.rod_string(well({"fillage": fillage, "gas_exponent": gas}), accuracy=0.01)
    displaced = np.pi / 4 * (1.5 * 0.0254) ** 2 * motion.plunger_stroke / motion.period
    assert motion.production == pytest.approx(fillage * displaced, rel=0.02)
    assert abs(motion.balance) < 1e-10
