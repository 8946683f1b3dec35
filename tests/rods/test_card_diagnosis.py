"""Diagnosis of surface cards: those of predicted motions, noise, and what is no card of the well."""

from __future__ import annotations

import numpy as np
import pytest
from tests.samples.wells import POUND, well

import linkwright as lw


def card_of(machine, n=200):
    """The predicted surface card at n samples."""
    motion = lw.rod_string(machine)
    at, own = np.arange(n) / n, np.arange(len(motion.time)) / len(motion.time)
    return motion, *(np.interp(at, own, curve, period=1) for curve in (motion.rod_position, motion.rod_load))


TUBING = {"tubing_diameter": "2.375 in", "tubing_bore": "1.995 in"}


@pytest.mark.parametrize(
    ("pump", "fillage", "damping_factor"),
    [
        ({}, 1.0, 0.1),
        (TUBING, 1.0, 0.1),
        ({"fillage": 0.6}, 0.6, 0.15),
        ({**TUBING, "fillage": 0.7, "gas_exponent": 1.2}, None, 0.2),
    ],
)
def test_the_card_of_a_predicted_motion_leads_back_to_its_pump(pump, fillage, damping_factor):
    """With the damping fitted: stroke to 0.3 %, fluid load to 2 %, damping to 5 %, fillage to 0.02."""
    machine = well(pump, damping_factor=damping_factor)
    motion, position, load = card_of(machine)
    found = lw.diagnose_card(machine, position, load)
    assert found.plunger_stroke == pytest.approx(motion.plunger_stroke, rel=0.003)
    assert found.fluid_load == pytest.approx(motion.fluid_load, rel=0.02)
    assert found.damping == pytest.approx(machine.rod_string.damping_rate, rel=0.05)
    assert abs(found.balance) < 1e-10
    if fillage is not None:
        assert found.fillage == pytest.approx(fillage, abs=0.02)


def test_with_the_damping_known_the_pump_card_is_the_predicted_one():
    """Stroke to 0.3 %, loads to 1.5 % of their range in the mean."""
    machine = well(TUBING)
    motion, position, load = card_of(machine)
    found = lw.diagnose_card(machine, position, load, damping=float(machine.rod_string.damping_rate))
    assert found.plunger_stroke == pytest.approx(motion.plunger_stroke, rel=0.003)
    at, own = found.time, motion.time
    expected = np.interp(at, own, motion.load[-1], period=motion.period)
    assert np.sqrt(np.mean((found.load[-1] - expected) ** 2)) < 0.015 * np.ptp(expected)


def test_noise_is_measured_and_its_harmonics_are_left_out():
    """With 1 % of noise on the load, its size is found, and fewer harmonics count."""
    machine = well(TUBING)
    _, position, load = card_of(machine)
    clean = lw.diagnose_card(machine, position, load)
    scatter = 0.01 * np.ptp(load)
    noisy = load + scatter * np.random.default_rng(49).normal(size=len(load))
    found = lw.diagnose_card(machine, position, noisy)
    assert found.noise == pytest.approx(scatter, rel=0.25)
    assert found.harmonics < 0.5 * clean.harmonics
    assert found.fluid_load == pytest.approx(clean.fluid_load, rel=0.04)


def test_the_order_of_the_start_of_a_card_does_not_matter():
    """A record that begins anywhere in the stroke gives the same pump."""
    machine = well()
    _, position, load = card_of(machine)
    first = lw.diagnose_card(machine, position, load, damping=0.5)
    turned = lw.diagnose_card(machine, np.roll(position, 37), np.roll(load, 37), damping=0.5)
    assert turned.plunger_stroke == pytest.approx(first.plunger_stroke, rel=2e-3)
    assert turned.power_pump == pytest.approx(first.power_pump, rel=1e-9)


def refused(change, message, **options):
    machine = well()
    _, position, load = card_of(machine)
    with pytest.raises(lw.InputError, match=message):
        lw.diagnose_card(machine, *change(position, load), **options)


def test_a_card_that_does_not_close_is_refused():
    """Half a stroke has a gap that no step of it has."""
    refused(lambda p, f: (p[:120], f[:120]), "does not close")


def test_a_card_that_runs_backwards_is_refused():
    """In the wrong order the rods would drive the unit."""
    refused(lambda p, f: (p[::-1], f[::-1]), "reverse the order")
    refused(lambda p, f: (-p, f), "reverse the order")


def test_too_few_samples_and_too_many_harmonics_are_refused():
    """24 samples or more; as many harmonics as the samples hold."""
    refused(lambda p, f: (p[::10], f[::10]), "20 samples, expected 24 or more")
    refused(lambda p, f: (p, f), "harmonics: found 100, expected 1 to 99", harmonics=100)


@pytest.mark.parametrize(
    ("factor", "unit"),
    [(1 / POUND, "probably in lbf"), (1e-3, "probably in kN"), (POUND, "multiplied by 4.448")],
)
def test_loads_in_the_wrong_unit_give_themselves_away_by_the_weight_of_the_rods(factor, unit):
    """The mean load is the weight of the rods in the fluid and some of a column of fluid; the unit is
    named.
    """
    refused(lambda p, f: (p, f * factor), unit)


def test_a_stroke_in_the_wrong_unit_gives_itself_away_by_the_stroke_of_the_unit():
    """Inches taken for metres."""
    refused(lambda p, f: (p / 0.0254, f), "probably in in")


def test_a_card_without_a_period_is_refused():
    """Neither time nor speed is known."""
    machine = well(speed=None)
    _, position, load = card_of(well())
    with pytest.raises(lw.InputError, match="the period of the card is unknown"):
        lw.diagnose_card(machine, position, load)
    assert lw.diagnose_card(machine, position, load, period=3.75).period == 3.75


def test_a_card_is_read_with_its_units_and_its_time(tmp_path):
    """position [in], load [lbf], time [s]: the period is the number of samples times their step."""
    _, position, load = card_of(well())
    columns = np.stack([3.75 * np.arange(200) / 200, position / 0.0254, load / POUND], axis=1)
    rows = [", ".join(map(repr, row)) for row in columns.tolist()]
    text = "\n".join(["time [s], position [in], load [lbf]", *rows])
    path = tmp_path / "card.csv"
    path.write_text(text, encoding="utf-8")
    card = lw.read_card(path)
    np.testing.assert_allclose(card.position, position, rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(card.load, load, rtol=1e-12)
    assert card.period == pytest.approx(3.75, rel=1e-9)
