"""What a surveyor asks for beside the verdict: K_A of gears, phase vector sums, measured curves."""

from pathlib import Path

import numpy as np
import pytest

import linkwright as lw
from linkwright import InputError, MachineFileError
from linkwright.torsion import survey
from linkwright.torsion.figures.stars import star_figure
from linkwright.torsion.limits.overlay import overlay
from linkwright.torsion.tables.limits import measured_words

GEARED = """
format = 1
name = "Motor, gear, fan"
[train.discs]
motor = { inertia = 2.0 }
pinion = { inertia = 0.1 }
wheel = { inertia = 3.0 }
fan = { inertia = 20.0, damping = 8.0 }
[train.shafts]
fast = { between = ["motor", "pinion"], stiffness = 4e4, loss_factor = 0.02 }
[train.shafts.slow]
between = ["wheel", "fan"]
sections = [{ length = 0.9, diameter = 0.08 }]
loss_factor = 0.02
limit = { stress_permitted = 5e6, stress_transient = 60e6 }
[train.gears]
stage = { between = ["pinion", "wheel"], ratio = 4.0 }
[train.loads.air]
on = "fan"
torque = 800.0
speed = 40.0
exponent = 2
harmonics = [{ order = 6, share = 0.1 }]
[train.run]
speed_min = 20.0
speed_max = 160.0
"""


def test_application_factor() -> None:
    """K_A = (mean + vibratory)/mean; one order alone has its amplitude as vibratory torque."""
    machine = lw.loads(GEARED)
    found = lw.mesh_torques(machine)
    amplitude = np.abs(found.torques[0, 0])
    # The load gives its mean to the wheel, a quarter of it to the pinion.
    mean = 200.0 * (found.speeds / 160.0) ** 2
    np.testing.assert_allclose(np.abs(found.mean[0]), mean, rtol=1e-9)
    np.testing.assert_allclose(found.application_factor[0], 1 + amplitude / mean, rtol=1e-9)
    assert found.separation[0]
    for low, high in found.separation[0]:
        inside = (found.speeds >= low) & (found.speeds <= high)
        assert (found.application_factor[0][inside] > 2).all()
    study = lw.torsion_study(machine)
    assert study.results()["gears"]["stages"]["stage"]["separation"] == [list(p) for p in found.separation[0]]


def test_vector_sums_do_the_work() -> None:
    """The sum times the torque is the work in the mode, which the Campbell diagram has by its own way."""
    machine = lw.replace(lw.read("v8_diesel"), {"train.run.points": 12, "train.run.orders_max": 8.0})
    study = lw.torsion_study(machine)
    assert study.campbell is not None
    work = {(one.order, one.mode): one.vector_sum for one in study.campbell.critical}
    assert len(study.stars) > 4
    for star in study.stars:
        # Torques between the speeds of the run are interpolated.
        assert star.vector_sum * star.torque == pytest.approx(work[star.order, star.mode], rel=2e-3, abs=0.05)
        assert star.vector_sum <= star.largest_sum * (1 + 1e-12)
    assert {round(table.frequency, 6) for table in study.critical_holzer} == {
        round(study.free.natural_frequencies[mode], 6)
        for mode in {one.mode for one in study.campbell.critical}
    }
    assert all(abs(t.residual_torque) < 1e-6 * np.abs(t.torque).max() for t in study.critical_holzer)


def measured(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "trial.csv"
    path.write_text(text)
    return path


def test_a_shifted_curve_is_found_as_far_off(tmp_path: Path) -> None:
    machine = lw.loads(GEARED)
    seen = survey(machine)
    speeds = np.linspace(25.0, 150.0, 600)
    stress = lw.shaft_stress(machine, lw.forced_vibration(machine, speeds * 1.03))
    size = 0.9 * stress.vibratory[0]
    rows = "\n".join(f"{w!r}, {v!r}" for w, v in zip(speeds.tolist(), (size / 1e6).tolist(), strict=True))
    curves = lw.read_measured(measured(tmp_path, f"speed [rad/s], slow [MPa]\n{rows}\n"))
    found = overlay(seen, "slow", curves["slow"])
    (peak,) = [one for one in found.peaks if one.value == max(each.value for each in found.peaks)]
    assert peak.speed_difference == pytest.approx(0.03, abs=0.125 / peak.speed * 2)
    # The peak lies between two of the measured points.
    assert peak.value_difference == pytest.approx(1 / 0.9 - 1, rel=0.05)
    np.testing.assert_allclose(
        found.computed, lw.shaft_stress(machine, lw.forced_vibration(machine, speeds)).vibratory[0], rtol=1e-9
    )
    words = measured_words(found)
    assert words.startswith("Stress of slow: highest measured")
    assert "exceeds the limit of continuous operation" in words


def test_the_computed_curve_itself_differs_by_nothing() -> None:
    machine = lw.loads(GEARED)
    forced = lw.forced_vibration(machine)
    fan = forced.discs.index("fan")
    curve = {"kind": "response", "on": "fan", "speed": forced.speeds.tolist(), "order": 1.5}
    curve["angle"] = np.abs(forced.amplitudes[0, fan]).tolist()
    study = lw.torsion_study(lw.replace(machine, {"train.measured": {"same": curve}}))
    (found,) = study.overlays
    assert found.mean_difference < 1e-12


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("speed [rad/s], slow [MPa]\n30, 1\n40, x\n", r"trial.csv:3: column slow"),
        ("speed [rad/s], slow [MPa]\n30, 1\n20, 2\n", r"trial.csv:3: column speed"),
        ("speed [rad/s], slow\n30, 1\n40, 2\n", r"trial.csv:1: column slow"),
        ("speed [rad/s]\n30\n40\n", r"a column for each shaft or disc"),
        ("rpm, slow [MPa]\n30, 1\n40, 2\n", r"no column speed|a column of each name"),
    ],
)
def test_bad_files_are_named_by_line(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(MachineFileError, match=message):
        lw.read_measured(measured(tmp_path, text))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("speed [rad/s], slwo [MPa]\n30, 1\n40, 2\n", 'did you mean "slow"'),
        ("speed [rad/s], fast [MPa]\n30, 1\n40, 2\n", "no section of fast is known"),
        ("speed [rad/s], fan [deg]\n30, 1\n400, 2\n", "those of \\[train.run\\]"),
        ("speed [rad/s], slow_order_2_5 [N m]\n30, 1\n40, 2\n", "found order 2.5, expected one of 1.5"),
    ],
)
def test_what_is_not_computed(tmp_path: Path, text: str, message: str) -> None:
    curves = lw.read_measured(measured(tmp_path, text))
    with pytest.raises(InputError, match=message):
        lw.torsion_study(lw.loads(GEARED), measured=curves)


def test_words_of_a_star_stand_at_the_tips_of_their_vectors() -> None:
    """Of vectors of any length, not on a circle about all of them."""
    machine = lw.replace(lw.read("v8_diesel"), {"train.run.points": 12, "train.run.orders_max": 8.0})
    checked = 0
    for star in lw.torsion_study(machine).stars:
        longest = float(np.abs(star.vectors).max())
        written = {
            text.get_text(): complex(*text.get_position()) for text in star_figure([star]).axes[0].texts
        }
        for name, vector in zip(star.discs, star.vectors.tolist(), strict=True):
            if (place := written.get(name.removeprefix("throw_"))) and 0.5 < abs(vector) / longest < 0.9:
                assert abs(place - vector) < 0.3 * longest
                checked += 1
    assert checked
