"""Cards as load cells record them: few samples, noise, offsets, gaps, any start; records that are none."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from tests.samples.wells import FOOT, INCH, POUND, well

import linkwright as lw
from linkwright.rods.warnings import diagnosis_warnings

TUBING = {"tubing_diameter": "2.375 in", "tubing_bore": "1.995 in"}


@cache
def predicted():
    """A well, its predicted motion, and 200 samples of its surface card."""
    machine = well(TUBING)
    motion = lw.rod_string(machine)
    return machine, motion, *samples(motion, 200)


def samples(motion, n, start=0.0):
    """The surface card at n samples, the first a share of the stroke after the bottom."""
    at, own = np.arange(n) / n + start, np.arange(len(motion.time)) / len(motion.time)
    return tuple(np.interp(at % 1, own, curve, period=1) for curve in (motion.rod_position, motion.rod_load))


def noise(size, n, seed=49):
    return size * np.random.default_rng(seed).normal(size=n)


def differs(change, **options):
    """Errors of plunger stroke, fluid load and damping, as shares, of a card that is changed."""
    machine, motion, position, load = predicted()
    found = lw.diagnose_card(machine, *change(position, load), **options)
    return (
        abs(found.plunger_stroke / motion.plunger_stroke - 1),
        abs(found.fluid_load / motion.fluid_load - 1),
        abs(found.damping / float(machine.rod_string.damping_rate) - 1),
    )


@pytest.mark.parametrize(
    ("change", "limits"),
    [
        (lambda p, f: (p, f), (0.002, 0.005, 0.01)),
        # Anywhere in the stroke, neither end of it at a sample.
        (lambda p, f: samples(predicted()[1], 149, 0.3117), (0.002, 0.01, 0.03)),
        (lambda p, f: samples(predicted()[1], 60, 0.77), (0.005, 0.02, 0.1)),
        # A load cell that is 3 kN off: loads of the pump are, its fluid load and damping are not.
        (lambda p, f: (p, f + 3e3), (0.002, 0.005, 0.01)),
        (lambda p, f: (p, f - 3e3), (0.002, 0.005, 0.01)),
        # Numbers as files round them: 0.1 in, 10 lbf.
        (lambda p, f: (np.round(p / INCH, 1) * INCH, np.round(f / POUND, -1) * POUND), (0.003, 0.01, 0.05)),
        (lambda p, f: (p, f + noise(0.01 * np.ptp(f), 200)), (0.006, 0.02, 0.1)),
        (lambda p, f: (p + noise(2e-3, 200), f), (0.01, 0.02, 0.1)),
        # A last sample that repeats the first but for the last digits, and a few that are missing.
        (lambda p, f: (np.append(p, p[0] + 1e-4), np.append(f, f[0] - 20)), (0.01, 0.03, 0.1)),
        (lambda p, f: (p[:-2], f[:-2]), (0.01, 0.06, 0.17)),
    ],
)
def test_what_records_suffer_does_not_move_the_pump_card(change, limits):
    """Plunger stroke, fluid load and fitted damping within shares that grow with what the record lost."""
    for error, limit in zip(differs(change), limits, strict=True):
        assert error < limit


@pytest.mark.parametrize("fillage", [0.85, 0.5, 0.35])
def test_damping_is_fitted_beside_a_hard_fluid_pound(fillage):
    """Anchored tubing, gas without pressure: a factor of 0.06 to 2 %, where ringing once hid it."""
    machine = well({"bulk_modulus": "1e15 Pa", "fillage": fillage}, damping_factor=0.06)
    motion = lw.rod_string(machine, accuracy=0.01)
    # A recorder of 200 samples averages over each.
    own = np.arange(len(motion.time)) / len(motion.time)
    position, load = (
        np.interp(np.arange(2000) / 2000, own, curve, period=1).reshape(200, 10).mean(axis=1)
        for curve in (motion.rod_position, motion.rod_load)
    )
    assert lw.diagnose_card(machine, position, load).damping_factor == pytest.approx(0.06, rel=0.02)


def test_an_offset_of_the_load_cell_is_an_offset_of_the_pump_card():
    """Every load of the pump card moves by it, and nothing else."""
    machine, _, position, load = predicted()
    plain = lw.diagnose_card(machine, position, load, damping=0.5)
    off = lw.diagnose_card(machine, position, load + 2e3, damping=0.5)
    np.testing.assert_allclose(off.load[-1] - plain.load[-1], 2e3, rtol=1e-9)
    assert off.fluid_load == pytest.approx(plain.fluid_load, rel=1e-9)


def test_a_recorder_slower_than_its_file_is_filtered_out():
    """Each sample twice: steps of the record count as its noise, and the pump card stays."""
    errors = differs(lambda p, f: (np.repeat(p, 2), np.repeat(f, 2)))
    assert errors[0] < 0.01
    assert errors[1] < 0.07


def test_few_harmonics_do_not_tell_the_damping():
    """With six harmonics above the noise, a warning says so instead of a damping that is certain."""
    machine, _, position, load = predicted()
    found = lw.diagnose_card(machine, position, load + noise(0.1 * np.ptp(load), 200))
    text = " ".join(diagnosis_warnings(machine.rod_string, found))
    assert f"{found.harmonics} harmonics of the load stand above its noise" in text
    clean = lw.diagnose_card(machine, position, load)
    assert "stand above its noise" not in " ".join(diagnosis_warnings(machine.rod_string, clean))


FREE = {"stroke": None}


@pytest.mark.parametrize(
    ("change", "message", "entries", "options"),
    [
        (lambda p, f: (f, p), "position and load are probably exchanged", {}, {}),
        (lambda p, f: (f, p), "position and load are probably exchanged", FREE, {}),
        (
            lambda p, f: (f / POUND * INCH, p / INCH * POUND),
            "position and load are probably exchanged",
            {},
            {},
        ),
        (lambda p, f: (p / INCH * 0.01, f), "probably in in, not in cm", {}, {}),
        (lambda p, f: (p, f / POUND * 1e3), "probably in lbf, not in kN", {}, {}),
        (lambda p, f: (p / INCH, f), "probably in in", {}, {}),
        (lambda p, f: (p / FOOT, f), "probably in ft", {}, {}),
        (lambda p, f: (p * 1e3, f), "probably in mm", {}, {}),
        (lambda p, f: (p / INCH, f), "another unit than their header says", FREE, {}),
        (lambda p, f: (p / FOOT, f), "its pump card has a fluid load", FREE, {}),
        (lambda p, f: (p, f / POUND), "probably in lbf", {}, {}),
        (lambda p, f: (p, f / 1e3), "probably in kN", {}, {}),
        (lambda p, f: (p, f / POUND / 1e3), "probably in klbf", {}, {}),
        (lambda p, f: (p, f * POUND), "multiplied by 4.448", {}, {}),
        (lambda p, f: (p, -f), "loads count downward: reverse their sign", {}, {}),
        (lambda p, f: (p, f + 3e4), "expected .* by the weight of the rods", {}, {}),
        (lambda p, f: (p[::-1], f[::-1]), "reverse the order", {}, {}),
        (lambda p, f: (-p, f), "reverse the order of the samples, or the sign", {}, {}),
        (lambda p, f: (p[:180], f[:180]), "does not close", {}, {}),
        (lambda p, f: (np.tile(p, 2), np.tile(f, 2)), "found 2 strokes", {}, {}),
        (lambda p, f: (p[::10], f[::10]), "20 samples, expected 24 or more", {}, {}),
        (lambda p, f: (p, f[:-1]), "as many of both", {}, {}),
        (lambda p, f: (0 * p + 1, f), "a position that does not change", {}, {}),
        (lambda p, f: (p, 0 * f + 4e4), "a load that does not change", {}, {}),
        (lambda p, f: (np.where(p == p[7], np.nan, p), f), "found nan at index 7", {}, {}),
        (lambda p, f: (p, f), "compare the unit of time", {}, {"period": 0.0625}),
        (lambda p, f: (p, f), "about that of the machine file, 3.75 s", {}, {"period": 225.0}),
        (lambda p, f: (p, f), "expected 1 to 300 s", {}, {"period": 3750.0}),
        (lambda p, f: (p, f), "period of the card is unknown", {"speed": None}, {}),
        (lambda p, f: (p, f), "damping: found -1", {}, {"damping": -1.0}),
        (lambda p, f: (p, f), "damping: found 1000", {}, {"damping": 1000.0}),
        (lambda p, f: (p, f), "harmonics: found 0", {}, {"harmonics": 0}),
    ],
)
def test_a_record_that_is_no_card_of_the_well_is_refused(change, message, entries, options):
    """Never a plausible wrong card: what is wrong is named, and the remedy where it shows."""
    _, _, position, load = predicted()
    with pytest.raises(lw.LinkwrightError, match=message):
        lw.diagnose_card(well(TUBING, **entries), *change(position, load), **options)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("position [m]\n1\n2\n", "load"),
        ("position [m], load [furlong]\n1, 2\n", "furlong"),
        ("position [m], load [N]\n1, two\n", "two"),
        ("position [m], load [N]\n", "no rows"),
        ("position [m], load [m]\n1, 2\n", "m"),
        ("time [s], position [m], load [N]\n0, 1, 2\n1, 1, 2\n5, 1, 2\n", "equally spaced"),
        ("time [s], position [m], load [N]\n2, 1, 2\n1, 1, 2\n0, 1, 2\n", "equally spaced"),
    ],
)
def test_a_file_that_is_no_card_is_refused(tmp_path, text, message):
    """A missing column, an unknown unit, a word, no rows, times that are uneven or run backwards."""
    path = tmp_path / "card.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(lw.LinkwrightError, match=message):
        lw.read_card(path)


def test_a_record_of_a_spreadsheet_with_semicolons_is_refused_with_its_remedy(tmp_path):
    """The message shows the header of a card, and how columns and decimals are written."""
    path = tmp_path / "card.csv"
    path.write_text("position [in];load [lbf]\n12,40;9830\n13,91;9870\n")
    with pytest.raises(lw.MachineFileError) as refused:
        lw.read_card(path)
    assert "position [in], load [lbf]" in str(refused.value)
    assert "a comma between columns, and a point in decimals" in str(refused.value)
