"""Derivatives of strings that a motor drives, and of peak loads at corners, against differences."""

from __future__ import annotations

import numpy as np
import pytest
from tests.samples.sizes import DEEP, random_cases
from tests.samples.wells import API_STRING, UNIT, random_well, well

import linkwright as lw
from linkwright.kernel.numerics.implicit import iterated_along
from linkwright.machine.address import exchanged, get
from linkwright.rods import core, polished_rod, prediction
from linkwright.rods.gradient import string_tangents
from linkwright.rods.scalars import peak

WELL = (
    """
format = 1
name = "well"
[drive]
gearbox = { ratio = 60, efficiency = 0.95 }
[drive.motor]
kind = "induction"
power_rated = "22 kW"
speed_rated = "960 rpm"
speed_synchronous = "1000 rpm"
torque_breakdown = "600 N m"
inertia = 0.2
[bodies.crank]
on = "crank"
mass = 1.0
inertia = 3000
[pumping_unit.load]
counterbalance = "28 kN m"
efficiency = 0.9
"""
    + API_STRING
    + UNIT
)

ENTRIES = ("rod_string.pump.plunger", "drive.gearbox.ratio")
MORE = (
    *("rod_string.sections.0.length", "rod_string.damping_factor", "rod_string.stuffing_box"),
    *("pumping_unit.R", "pumping_unit.A", "drive.motor.power_rated", "drive.gearbox.efficiency"),
    *("bodies.crank.inertia", "pumping_unit.load.counterbalance", "pumping_unit.load.efficiency"),
)

SCALARS = (
    "period",
    "stroke",
    "plunger_stroke",
    "load_max",
    "load_min",
    "production",
    "power_rod",
    "power_pump",
)
PARTS = {
    "gear": ("torque_net_up", "torque_net_down", "torque_net_mean", "torque_net_rms", "work", "load_max"),
    "gear_best": ("torque_net_up", "counterbalance", "counterbalance_effect"),
    "stress": ("loading_max",),
    "numbers": ("torque_ratio", "stroke_ratio"),
    "drive": ("unevenness", "power_motor_mean", "torque_motor_rms"),
}


@pytest.fixture
def tight(monkeypatch):
    """Solutions to rounding, of which differences can be taken."""
    monkeypatch.setattr(core, "_TOLERANCE", 1e-14)
    monkeypatch.setattr(prediction, "_ALIKE", 1e-10)
    monkeypatch.setattr(polished_rod, "steady_state", lambda m, n: lw.steady_state(m, n=n, accuracy=1e-13))


def scalars_at(machine, n):
    """Scalars of a string and its drive at n samples, at their common motion to rounding."""
    string, wave = machine.rod_string, None
    rod = polished_rod.polished_rod_of(machine, string)
    for _ in range(60):
        moved = rod.motion(n)
        solved = core.solve_string(string, moved.period, moved.position, wave)
        wave, dynamic = solved.wave, solved.cards.load[0][::2]
        if rod.take(prediction.polished_rod_load(string, moved.position, dynamic)) < 1e-13:
            break
    scalars = prediction._scalars(string, rod, moved, solved)
    motion = prediction._result(string, rod, moved, solved, scalars, 0.0)
    found = {name: getattr(motion, name) for name in SCALARS}
    for part, names in PARTS.items():
        of = getattr(motion, part)
        found |= {f"{part}.{name}": getattr(of, name) for name in names if of is not None}
    return {name: float(x) for name, x in found.items()}


@pytest.mark.parametrize("drive", ["motor", "speed"])
def test_strings_gearbox_and_drive_follow_every_entry_as_differences_do(tight, drive):
    """To 1e-5 of the scalar for the entry doubled, as the differences are known; string and motor together.

    A valve may open between two samples: one of three steps avoids that.
    """
    machine, entries = lw.loads(WELL), ENTRIES + (MORE if DEEP else ())
    if drive == "speed":
        machine = _at_speed()
        entries = tuple(name for name in entries if not name.startswith(("drive.", "bodies.")))
        entries = (*entries, "drive.speed", "pumping_unit.load.counterbalance")
    n = len(prediction.solution(machine, 0.1).moved.position)
    derived = string_tangents(machine, entries, 0.1)
    assert not derived.refused
    for place, name in enumerate(derived.variables):
        x = float(get(machine, name))
        size = x or 1e3
        errors = []
        for step in (1e-6 * size, 3e-6 * size) if not DEEP else (3e-7 * size, 1e-6 * size, 3e-6 * size):
            above, below = (scalars_at(exchanged(machine, {name: x + sign * step}), n) for sign in (1, -1))
            errors.append(
                [
                    abs((above[key] - below[key]) / (2 * step) - derived.tangents[key].d[place])
                    * size
                    / abs(derived.tangents[key].value)
                    for key in above
                ]
            )
        worst = np.min(errors, axis=0)
        assert worst.max() < 1e-5, (name, list(above)[int(worst.argmax())], worst.max())


def _at_speed():
    """The well at constant speed in place of its motor."""
    head, rest = WELL.split("[drive]")
    return lw.loads(
        f'{head}[drive]\nspeed = "16 rpm"\n[pumping_unit.load]{rest.split("[pumping_unit.load]")[1]}'
    )


def test_string_and_drive_agree_at_the_finest_samples():
    """The load that the drive bears is that of the string at its motion, to 1e-3 of the load's range."""
    machine = lw.loads(WELL)
    solved = prediction.solution(machine, 0.02)
    moved = solved.rod.motion(len(solved.moved.position))
    string = machine.rod_string
    again = core.solve_string(string, moved.period, moved.position, solved.solved.wave)
    load = prediction.polished_rod_load(string, moved.position, again.cards.load[0][::2])
    answered = polished_rod.over_angle(moved.crank_angle, load)
    assert np.abs(answered - solved.rod.load).max() < 1e-3 * np.ptp(load)


def test_peak_loads_follow_entries_as_over_wide_steps():
    """At corners of the load, too: elasticities of peak loads to 0.05 of those of steps of 0.6 %.

    Derivatives of the highest sample would miss by 0.15 in the median, as that stands still beside a corner.
    """
    entries = ("rod_string.pump.plunger", "rod_string.stroke")
    machines = [well(), *(random_well(generator) for _, generator in random_cases(4902, 1, 12))]
    errors = []
    for machine in machines:
        derived, string = string_tangents(machine, entries), machine.rod_string
        n = core.sample_counts(string, 2 * np.pi / string.speed, 4096)[0]
        for place, name in enumerate(entries):
            x, loads = float(get(machine, name)), []
            for sign in (1, -1):
                other = exchanged(machine, {name: x * (1 + sign * 6e-3)}).rod_string
                moved = polished_rod.HarmonicRod(other.stroke, other.speed).motion(n)
                load = core.solve_string(other, moved.period, moved.position).cards.load[0]
                loads.append([peak(load, side) + other.weight_fluid for side in (1, -1)])
            slopes = np.subtract(*loads) / (2 * 6e-3 * derived.tangents["load_max"].value)
            found = [derived.tangents[key].d[place] * x for key in ("load_max", "load_min")]
            errors.append(np.abs(slopes - np.array(found) / derived.tangents["load_max"].value))
    assert np.median(errors) < 0.01
    assert np.max(errors) < (0.05 if not DEEP else 0.2)


def test_the_corner_of_two_lines_is_where_they_meet():
    """A roof whose ridge is anywhere between samples, rounded by chords as waves are: exact to rounding."""
    samples = np.arange(64.0)
    for ridge in np.linspace(30, 34, 23):
        coarse = np.interp(
            samples, samples[::2], 5 - np.abs(samples[::2] - ridge) * np.where(samples[::2] < ridge, 2, 0.7)
        )
        assert peak(coarse, +1) == pytest.approx(5, rel=1e-12)
        assert peak(-coarse, -1) == pytest.approx(-5, rel=1e-12)


def test_an_iteration_that_does_not_converge_by_itself_has_derivatives():
    """d = A d + b by Krylov spaces against elimination, A with eigenvalues beyond 1; columns of any size."""
    generator = np.random.default_rng(4906)
    matrix = 1.5 * generator.normal(size=(12, 12)) / np.sqrt(12)
    constant = generator.normal(size=(12, 4)) * [1e-6, 1.0, 1e6, 0.0]
    found = iterated_along(lambda d: matrix @ d + constant, 12, 4)
    assert np.abs(np.linalg.eigvals(matrix)).max() > 1
    size = np.abs(constant).max(axis=0) + 1e-300
    exact = np.linalg.solve(np.eye(12) - matrix, constant)
    np.testing.assert_allclose(found / size, exact / size, atol=1e-8)
    with pytest.raises(lw.LinkwrightError, match="hardly determines"):
        iterated_along(lambda d: d + constant, 12, 4)
