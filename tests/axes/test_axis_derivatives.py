"""Derivatives of servo axes and their DC bus: closed forms, central differences, ties and kinks."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import linkwright as lw
from linkwright.machine.address import replace

EXAMPLES = Path(__file__).parents[2] / "examples"

# A crank with a rod, friction and a gearbox with losses, and a carriage on a screw, with a dwell each.
MACHINE = """
format = 1
name = "Crank and carriage"
[master]
cycle_time = "{cycle} s"
[axes.A]
phase = "{phase} deg"
sections = [
  {{ angle = "{rise} deg", swing = "{swing} deg", law = "{law}" }},
  {{ angle = "30 deg" }},
  {{ angle = "{fall} deg", swing = "-{swing} deg", law = "{law}" }},
]
[axes.A.motor]
inertia = "0.9 kg cm^2"
continuous = {{ speed = "0, 3000, 6000 rpm", torque = "2.4, 2.3, 1.2 N m" }}
peak = {{ speed = "0, 3000, 6000 rpm", torque = "7.1, 7.1, 3 N m" }}
[axes.A.gearbox]
ratio = {ratio}
efficiency = {efficiency}
inertia = "5e-5 kg m^2"
[axes.B]
sections = [
  {{ time = "{time} s", lift = "{lift} mm", law = "polynomial_3_4_5" }},
  {{ time = "{time} s", lift = "-{lift} mm", law = "cycloidal" }},
]
[axes.B.gearbox]
ratio = 2
efficiency = 0.9
per_turn = "20 mm"
[mechanism.points]
Q = {{ x = "1 m", y = "0 m" }}
[mechanism.cranks.A]
radius = "{radius} mm"
phase = "{start} deg"
[mechanism.sliders.ram]
crank = "A"
rod = "{rod} mm"
[mechanism.linear_drivers.B]
guide = {{ through = "Q", angle = "{slope} deg" }}
[bodies]
ram = {{ mass = "{mass} kg" }}
"ram.rod" = {{ mass = "1.5 kg" }}
B = {{ mass = "8 kg" }}
[loads]
gravity = {{ kind = "gravity" }}
guide = {{ kind = "dry", on = "ram", force = "{force} N" }}
"""

LAWS = ("cycloidal", "polynomial_3_4_5", "modified_sine", "polynomial_4_5_6_7", "modified_trapezoid")


def random_machine(seed: int) -> lw.Machine:
    """A crank that neither passes a dead centre nor fills the cycle, and a carriage beside it."""
    draw = np.random.default_rng(seed)
    radius, start = draw.uniform(60, 150), draw.uniform(15, 40)
    cycle = draw.uniform(0.6, 1.5)
    return lw.loads(
        MACHINE.format(
            cycle=cycle,
            phase=draw.uniform(1, 25),
            rise=draw.uniform(100, 140),
            fall=draw.uniform(100, 140),
            swing=draw.uniform(60, 160 - start),
            law=LAWS[seed % len(LAWS)],
            ratio=draw.uniform(5, 30),
            efficiency=draw.uniform(0.7, 0.98),
            time=cycle * draw.uniform(0.2, 0.4),
            lift=draw.uniform(50, 200),
            radius=radius,
            start=start,
            rod=radius * draw.uniform(2.5, 4),
            slope=draw.uniform(10, 80),
            mass=draw.uniform(2, 12),
            force=draw.uniform(5, 60),
        )
    )


ENTRIES = (
    "master.cycle_time",
    "axes.A.sections.0.angle",
    "axes.A.gearbox.ratio",
    "axes.A.gearbox.efficiency",
    "axes.A.gearbox.inertia",
    "axes.A.motor.inertia",
    "axes.B.sections.0.time",
    "axes.B.gearbox.per_turn",
    "mechanism.cranks.A.radius",
    "mechanism.cranks.A.phase",
    "mechanism.sliders.ram.rod",
    "bodies.ram.mass",
    "loads.guide.force",
)


def value_of(machine: lw.Machine, name: str) -> float:
    """A quantity of an axis or of the bus by its name."""
    first, *rest = name.split(".")
    result = lw.dc_bus(machine) if first == "dc_bus" else lw.servo_axis(machine, rest.pop(0))
    for key in rest:
        result = getattr(result, key)
    return float(result)


@pytest.mark.parametrize("seed", range(20))
def test_derivatives_of_random_axes_by_central_differences(seed: int) -> None:
    """Torques, powers, energies by lengths, masses, loads, gears, sections and times."""
    machine = random_machine(seed)
    entries = [ENTRIES[(seed + k) % len(ENTRIES)] for k in (0, 5)]
    names = ("axis", "dc_bus")
    found = lw.gradient(machine, names, entries)
    assert set(found.variables) == set(entries)
    for place, entry in enumerate(found.variables):
        at = found.at[place]
        step = 2e-4 * abs(at)
        beside = [replace(machine, {entry: at + k * step}) for k in (-2, -1, 1, 2)]
        for row, name in enumerate(found.responses):
            slope = found.derivatives[row, place]
            # What axes exchange is a small difference of their energies.
            if np.isnan(slope) or name == "dc_bus.energy_shared":
                continue
            # Of equal peaks of either sign the result may be the one or the other.
            sense = np.sign(found.values[row]) if name.endswith("_max") else 1.0
            values = [value_of(one, name) for one in beside]
            a, b, c, d = [sense * abs(value) if name.endswith("_max") else value for value in values]
            numeric = (a - 8 * b + 8 * c - d) / (12 * step)
            scale = max(abs(found.values[row] / at), abs(slope))
            # Losses jump where the power changes its sign, which is found on straight lines between samples:
            # a sample that comes to lie on the other side leaves as much in the difference.
            is_braking = any(word in name for word in ("braking", "regenerated", "swing"))
            passes_losses = any(word in name for word in ("motor", "dc_bus"))
            accuracy = 3e-3 if is_braking else 3e-4 if passes_losses else 1e-6
            assert abs(slope - numeric) < accuracy * scale, (name, entry, slope, numeric)


def test_a_pure_inertia_has_the_slope_of_its_closed_form() -> None:
    """M_rms = (J_M i + J_L/i) ω̇_rms: slopes by ratio, rotor, table and cycle time."""
    machine = lw.read(EXAMPLES / "servo_ratio_and_law" / "machine.toml")
    entries = [
        "axes.left.gearbox.ratio",
        "axes.left.motor.inertia",
        "bodies.left.inertia",
        "master.cycle_time",
    ]
    found = lw.gradient(machine, ["axis.left.motor.torque_rms"], entries)
    ratio, rotor, table, cycle = found.at
    rms = found.values[0]
    rate = rms / (rotor * ratio + table / ratio)
    expected = [(rotor - table / ratio**2) * rate, ratio * rate, rate / ratio, -2 * rms / cycle]
    np.testing.assert_allclose(found.derivatives[0], expected, rtol=1e-9)


def test_a_later_start_of_an_axis_alone_changes_nothing() -> None:
    """All derivatives by the phase of one axis among inertias are zero, though all samples move."""
    machine = lw.read(EXAMPLES / "servo_ratio_and_law" / "machine.toml")
    found = lw.gradient(machine, ["axis.left"], ["axes.left.phase"])
    np.testing.assert_allclose(found.derivatives[:, 0], 0.0, atol=1e-6 * np.abs(found.values).max())


def test_equal_peaks_that_follow_an_entry_otherwise_are_told() -> None:
    """Two strokes with the same peak torque: by the angle of one of them there is no derivative."""
    machine = lw.read(EXAMPLES / "servo_ratio_and_law" / "machine.toml")
    found = lw.gradient(machine, ["axis.left.torque_max"], ["axes.left.sections.0.angle"])
    assert np.isnan(found.derivatives).all()
    assert "the extreme occurs at" in found.ties["axis.left.torque_max"]


def test_a_cylinder_by_sections_is_the_same_as_by_its_law() -> None:
    """The bucket of the excavator: harmonic sections of an axis for the formula 0.1 (1 − cos 2φ)."""
    text = (EXAMPLES / "excavator_bucket" / "machine.toml").read_text("utf-8")
    law = 'law = "0.1*(1 - cos(2*phi))"\n'
    assert law in text
    strokes = ", ".join(
        f'{{ angle = "90 deg", lift = "{sign}200 mm", law = "harmonic" }}' for sign in ("", "-") * 2
    )
    axes = f"[axes.bucket_cylinder]\nsections = [{strokes}]\n"
    by_law = lw.loads(text.replace("[drive]", "[axes.bucket_cylinder]\n[drive]", 1))
    by_axis = lw.loads(text.replace(law, "").replace("[drive]", axes + "[drive]", 1))
    formula, sections = (lw.servo_axis(machine) for machine in (by_law, by_axis))
    assert not sections.turns
    assert sections.unit_of("torque") == "N"
    for name in ("position", "velocity", "torque"):
        one, other = (
            np.interp(np.linspace(0.01, 6.2, 50), axis.crank_angle, getattr(axis, name))
            for axis in (formula, sections)
        )
        np.testing.assert_allclose(other, one, atol=2e-5 * np.abs(one).max())
    assert sections.torque_rms == pytest.approx(formula.torque_rms, rel=1e-7)
    assert sections.torque_max == pytest.approx(formula.torque_max, rel=1e-7)
    names = [track.driver for track in lw.timing(by_axis)]
    assert names == ["stick_cylinder", "bucket_cylinder"]
    assert lw.dc_bus(by_axis).power_residual < 1e-10


def test_the_bus_of_one_axis_regenerates_what_its_motor_does() -> None:
    """The same energy, with pieces that end where the power changes its sign."""
    whole = random_machine(3)
    alone = whole.with_entries({"axes": {"A": whole.axes["A"]}})
    alone = alone.with_entries({"mechanism": alone.mechanism.with_entries({"linear_drivers": {}})})
    alone = alone.with_entries({"bodies": {k: v for k, v in alone.bodies.items() if k != "B"}})
    bus, axis = lw.dc_bus(alone), lw.servo_axis(alone)
    assert bus.energy_regenerated > 0
    assert bus.energy_regenerated == pytest.approx(axis.motor.energy_regenerated, rel=1e-12)


def test_a_peak_between_samples_is_exact() -> None:
    """The acceleration of a cycloidal stroke, 2π h/T², at a quarter of a section of 101 degrees."""
    machine = lw.read(EXAMPLES / "servo_ratio_and_law" / "machine.toml")
    uneven = replace(machine, {"axes.left.sections.0.angle": np.radians(101.0)})
    axis = lw.servo_axis(uneven, "left")
    duration = 101 / 360
    assert abs(axis.acceleration_max) == pytest.approx(2 * np.pi * (np.pi / 2) / duration**2, rel=1e-11)
    assert axis.motor.torque_peak == pytest.approx(
        (1.6e-4 * 20 + 0.4 / 20) * abs(axis.acceleration_max), rel=1e-11
    )
