"""Derivatives of predicted rod strings against differences, and many strings at once against single ones."""

from __future__ import annotations

import numpy as np
import pytest
from tests.samples.sizes import DEEP, random_cases
from tests.samples.wells import random_well, well

import linkwright as lw
from linkwright.machine.address import exchanged, get
from linkwright.rods import core, rod_strings
from linkwright.rods.core import Cards, numbers_of, solve_rows
from linkwright.rods.gradient import string_tangents
from linkwright.rods.scalars import goodman_loadings, string_scalars

ENTRIES = (
    "rod_string.sections.0.length",
    "rod_string.sections.0.modulus",
    "rod_string.pump.plunger",
    "rod_string.pump.fluid_level",
    "rod_string.pump.bulk_modulus",
    "rod_string.pump.leak",
    "rod_string.specific_gravity",
    "rod_string.damping_factor",
    "rod_string.stuffing_box",
    "rod_string.stroke",
    "rod_string.speed",
)

# Of differences, over the entries; places in steps and weights, twelve times, of fourth and second order.
STEPS = np.array([1e-5, 3e-6, 1e-6, 1e-7])
BOTH_SIDES = (-2, -1, 1, 2), [(1, -8, 8, -1), (0, -6, 6, 0)]
# Of what cannot be negative, and is zero.
ONE_SIDE = (0, 1, 2, 3, 4), [(-25, 48, -36, 16, -3), (-18, 24, -6, 0, 0)]


def scalars_at(machine, name, values, n):
    """Scalars with an entry at some values, at n samples, each solved to rounding."""
    rows = [exchanged(machine, {name: float(value)}).rod_string for value in values]
    at = 0.5 * (1 - np.cos(np.pi * np.arange(2 * n) / n))
    periods = [2 * np.pi / string.speed for string in rows]
    motion = np.array([string.stroke * at for string in rows])
    numbers = np.array(
        [numbers_of(string, period) for string, period in zip(rows, periods, strict=True)], float
    )
    found = solve_rows(rows[0], numbers, motion[:, ::2], tolerance=1e-14)
    stations = len(rows[0].sections) + 1
    scalars = []
    for i, string in enumerate(rows):
        work = found.work[i]
        cards = Cards(found.position[i], found.load[i], work[:stations], work[stations:])
        one = string_scalars(string, string.stroke, periods[i], cards, found.ends[i, 0], motion[i])
        worst = goodman_loadings(string, cards.load)
        scalars.append(one | {"stress.loading_max": max(worst.values())})
    return {key: np.array([float(one[key]) for one in scalars]) for key in scalars[0]}


def test_derivatives_by_every_entry_are_those_of_differences(monkeypatch):
    """Every scalar by every entry of random strings to 1e-7 of its scale for the entry doubled.

    All motions are solved to rounding: beside steep flanks peaks curve so much that 1e-9 of the wave is 1e-7
    of their derivative. At the instants of the samples a valve may open between two of them: one of four
    steps avoids that. In one of 200 strings a valve opens within 1e-5 of the stroke, and in smaller steps
    rounding of 1e-12 is 5e-7 of the slope.
    """
    beyond = set()
    monkeypatch.setattr(core, "_TOLERANCE", 1e-14)
    for number, generator in random_cases(4904, 1, 200):
        machine = random_well(generator)
        derived = string_tangents(machine, ENTRIES, 0.02)
        assert not derived.refused
        # Rods that take up the stroke by their stretch hardly open a valve: nothing is smooth there.
        if derived.tangents["plunger_stroke"].value < 0.01 * derived.tangents["stroke"].value:
            continue
        n = lw.rod_string(machine, accuracy=0.02).harmonics + 1
        for place, name in enumerate(derived.variables):
            x = float(get(machine, name))
            # A leak and a friction that are none have units of their size.
            size = x or {"leak": 1e-5, "stuffing_box": 1e3}[name.rsplit(".", 1)[-1]]
            at, weights = BOTH_SIDES if x else ONE_SIDE
            values = x + size * np.outer(STEPS, at).ravel()
            for key, column in scalars_at(machine, name, values, n).items():
                slopes = column.reshape(len(STEPS), -1) @ np.transpose(weights) / (12 * STEPS[:, None])
                tangent = derived.tangents[key]
                error = np.abs(slopes - tangent.d[place] * size).min()
                # A minimum load may be any small part of the loads, a power that of a plunger at rest.
                of = "power_rod" if key.startswith("power") else "load_max" if key == "load_min" else key
                scale = abs(derived.tangents[of].value)
                assert error < 1e-6 * scale, (number, name, key, error / scale)
                if error >= 1e-7 * scale:
                    beyond.add(number)
    assert len(beyond) <= (1 if DEEP else 0)


def test_terms_of_api_have_derivatives_too():
    """S_p/S, F_1/Sk_r and N/N_o′ by the length of the upper section, against differences."""
    machine, name = well(), "rod_string.sections.0.length"
    derived = string_tangents(machine, [name]).tangents
    length = float(get(machine, name))
    ends = [lw.rod_string(exchanged(machine, {name: length * (1 + sign * 1e-3)})).numbers for sign in (1, -1)]
    for key in ("natural_frequency_tapered", "frequency_factor", "spring_rate", "stroke_force"):
        slope = (getattr(ends[0], key) - getattr(ends[1], key)) / (2e-3 * length)
        assert derived[f"numbers.{key}"].d[0] == pytest.approx(slope, rel=1e-5), key


def test_many_strings_at_once_are_each_the_single_one():
    """Loads to 0.8 % of their range, strokes, production and powers to 0.1 %."""
    machine = well({"tubing_diameter": "2.375 in", "tubing_bore": "1.995 in"})
    generator = np.random.default_rng(4905)
    values = {
        "rod_string.stroke": generator.uniform(1.2, 1.6, 20),
        "rod_string.speed": generator.uniform(0.8, 1.7, 20),
        "rod_string.pump.plunger": generator.uniform(0.030, 0.045, 20),
    }
    many = rod_strings(machine, values)
    for row in (0, 7, 19):
        one = lw.rod_string(exchanged(machine, {name: float(x[row]) for name, x in values.items()}))
        reach = one.load_max - one.load_min
        assert many.load_max[row] == pytest.approx(one.load_max, abs=0.008 * reach)
        assert many.load_min[row] == pytest.approx(one.load_min, abs=0.008 * reach)
        for name in ("plunger_stroke", "production", "power_rod", "power_pump", "power_damping"):
            assert getattr(many, name)[row] == pytest.approx(getattr(one, name), rel=2e-3), name
        assert many.loading_max[row] == pytest.approx(one.stress.loading_max, rel=0.01)


def test_many_strings_refuse_what_they_cannot_vary():
    """Unknown entries, columns of several lengths, values out of range."""
    for values, message in (
        ({}, "columns of one length"),
        ({"rod_string.stroke": [1.0, 2.0], "rod_string.speed": [1.0]}, "columns of one length"),
        ({"drive.motor": [1.0]}, "entries of"),
        ({"rod_string.stroke": [1.0, np.nan]}, "not finite"),
        ({"rod_string.stroke": [1.0, -1.0]}, "stroke"),
    ):
        with pytest.raises(lw.LinkwrightError, match=message):
            rod_strings(well(), values)
