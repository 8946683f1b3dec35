"""Servo axes: torques by Newton and Euler, index steps, start of the master, what is refused."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from command_line import invoke

import linkwright as lw
from linkwright.axes.axis import ServoAxis, servo_axes
from linkwright.sizing.flywheel import constant_inertia

CARRIAGE = """
format = 1
name = "Servo axis: a crank by a motion law"
[master]
cycle_time = "1 s"
[axes.A]
sections = [
  { angle = "180 deg", swing = "180 deg", law = "cycloidal" },
  { angle = "180 deg", swing = "-180 deg", law = "cycloidal" },
]
[axes.A.motor]
type = "SV 750"
inertia = "0.9 kg cm^2"
continuous = { speed = "0, 3000, 6000 rpm", torque = "2.4, 2.3, 1.2 N m" }
peak = { speed = "0, 3000, 6000 rpm", torque = "7.1, 7.1, 3 N m" }
[axes.A.gearbox]
ratio = 10
efficiency = "92 %"
inertia = "5e-5 kg m^2"
[mechanism.cranks.A]
radius = "120 mm"
[mechanism.sliders.carriage]
crank = "A"
rod = "400 mm"
[bodies]
carriage = { mass = "12 kg" }
"carriage.rod" = { mass = "1.5 kg" }
A = { mass = "2 kg" }
[loads]
guide = { kind = "dry", on = "carriage", force = "40 N" }
"""

PACKAGING = """
format = 1
name = "Packaging machine: dial, pusher, sealing jaw"
[master]
speed = "120 rpm"
[axes.dial]
sections = [{ angle = "120 deg", swing = "60 deg", law = "cycloidal" }]
advance = "60 deg"
[axes.shaft]
driver = "pusher"
[mechanism.cranks.dial]
radius = "200 mm"
[mechanism.cams.pusher]
closure = "groove"
base_radius = "60 mm"
roller_radius = "12 mm"
phase = "120 deg"
sections = [
  { angle = "80 deg", lift = "70 mm", law = "modified_sine" },
  { angle = "20 deg" },
  { angle = "100 deg", lift = "-70 mm", law = "modified_sine" },
  { angle = "160 deg" },
]
[bodies]
dial = { inertia = "0.8 kg m^2" }
pusher = { mass = "3 kg" }
"""


# The step of the dial.
STEP = 'sections = [{ angle = "120 deg", swing = "60 deg", law = "cycloidal" }]\nadvance = "60 deg"\n'


def changed(text: str, *pairs: tuple[str, str]) -> str:
    """A machine file with some of its words exchanged."""
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new, 1)
    return text


def _cycloidal(u: np.ndarray, h: float) -> np.ndarray:
    """Rise by h over u from 0 to 1, with two derivatives by u, (3, n)."""
    wave = 2 * np.pi * u
    rise = [u - np.sin(wave) / (2 * np.pi), 1 - np.cos(wave), 2 * np.pi * np.sin(wave)]
    return h * np.array(rise)


def _carriage_by_newton(time: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Speed, acceleration and torque of the crank by Newton and Euler: power of all forces of inertia."""
    half = 0.5
    back = time >= half
    psi, d1, d2 = _cycloidal(np.where(back, time - half, time) / half, np.pi)
    psi, d1, d2 = (
        np.where(back, np.pi - psi, psi),
        np.where(back, -d1, d1) / half,
        np.where(back, -d2, d2) / half**2,
    )
    r, rod = 0.12, 0.4
    place = r * np.exp(1j * psi)
    velocity, acceleration = 1j * d1 * place, (1j * d2 - d1**2) * place
    beta = np.arcsin(-place.imag / rod)
    beta_1 = -velocity.imag / (rod * np.cos(beta))
    beta_2 = (-acceleration.imag + rod * np.sin(beta) * beta_1**2) / (rod * np.cos(beta))
    arm = rod * np.exp(1j * beta)
    arm_1, arm_2 = 1j * beta_1 * arm, (1j * beta_2 - beta_1**2) * arm
    power = 12 * (velocity + arm_1).real * (acceleration + arm_2).real + 40 * np.abs((velocity + arm_1).real)
    centre_1, centre_2 = velocity + arm_1 / 2, acceleration + arm_2 / 2
    power += 1.5 * (centre_1 * centre_2.conj()).real + 1.5 * rod**2 / 12 * beta_1 * beta_2
    power += 2 * r**2 / 3 * d1 * d2
    with np.errstate(invalid="ignore", divide="ignore"):
        return d1, d2, np.where(np.abs(d1) > 1e-7, power / d1, np.nan)


def test_a_carriage_on_a_crank_by_newton_and_euler() -> None:
    """The motor makes the motion: 2.90 N m, rms 1.10, 126 rad/s at the motor; 26.0 N m at the crank."""
    axis = lw.servo_axis(lw.loads(CARRIAGE))
    speed, acceleration, torque = _carriage_by_newton(axis.time)
    known = np.isfinite(torque)
    assert known.sum() > 0.98 * len(known)
    np.testing.assert_allclose(axis.torque[known], torque[known], atol=1e-6 * 26, rtol=1e-6)
    assert axis.torque_max == pytest.approx(25.9987, abs=1e-3)
    # At the motor: losses against the way of the power.
    geared = torque / 10 * np.where(torque * speed > 0, 1 / 0.92, 0.92) + 1.4e-4 * 10 * acceleration
    fine = np.linspace(0.0, 1.0, 200001)
    speed, acceleration, torque = _carriage_by_newton(fine)
    geared = torque / 10 * np.where(torque * speed > 0, 1 / 0.92, 0.92) + 1.4e-4 * 10 * acceleration
    assert axis.motor.torque_rms == pytest.approx(np.sqrt(np.nanmean(geared**2)), rel=1e-4)
    assert axis.motor.torque_peak == pytest.approx(np.nanmax(np.abs(geared)), rel=1e-6)
    assert axis.motor.torque_peak == pytest.approx(2.904, abs=1e-3)
    assert axis.motor.torque_rms == pytest.approx(1.100, abs=1e-3)
    assert axis.motor.speed_peak == pytest.approx(40 * np.pi, rel=1e-9)
    assert axis.passes
    assert lw.dc_bus(lw.loads(CARRIAGE)).power_residual < 1e-10


def test_a_heavier_rotor_takes_its_own_torque() -> None:
    """With 3e-4 kg m² at the motor shaft the peak is 2.99 N m: inertia adds to the load."""
    text = changed(CARRIAGE, ('inertia = "0.9 kg cm^2"', 'inertia = "2.5 kg cm^2"'))
    axis = lw.servo_axis(lw.loads(text))
    assert axis.motor.torque_peak == pytest.approx(2.993, abs=1e-3)
    assert axis.motor.torque_rms == pytest.approx(1.1605, abs=1e-3)


FIVE_BAR = """
format = 1
name = "Five-bar with two motors"
[master]
cycle_time = "0.8 s"
[mechanism.points]
P = { x = "0.3 m" }
[mechanism.cranks.A]
radius = "0.2 m"
phase = "100 deg"
[mechanism.cranks.B]
radius = "0.2 m"
phase = "60 deg"
pivot = "P"
[mechanism.joints.J]
x = "0.15 m"
y = "0.5 m"
[mechanism.bars]
left = { start = "A", end = "J", length = "0.35 m" }
right = { start = "B", end = "J", length = "0.35 m" }
[bodies]
J = { mass = "4 kg" }
[axes.A]
sections = [
  { angle = "100 deg", swing = "40 deg", law = "modified_sine" },
  { angle = "150 deg", swing = "-40 deg", law = "cycloidal" },
]
[axes.B]
phase = "50 deg"
sections = [
  { time = "0.3 s", swing = "-30 deg", law = "polynomial_3_4_5" },
  { time = "0.3 s", swing = "30 deg", law = "polynomial_3_4_5" },
]
"""


def _joint(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Place of the joint of a five-bar by the angles of its cranks, as complex numbers."""
    one, other = 0.2 * np.exp(1j * a), 0.3 + 0.2 * np.exp(1j * b)
    half = 0.5 * (other - one)
    height = np.sqrt(0.35**2 - np.abs(half) ** 2)
    return one + half + 1j * height * half / np.abs(half)


def test_two_motors_of_a_five_bar_each_have_their_torque() -> None:
    """Virtual work on the only mass: M_j = m a · ∂r/∂q_j; the sum over the master is another number."""
    machine = lw.loads(FIVE_BAR)
    axes = servo_axes(machine)
    a, b = (axes[name].position for name in "AB")
    rates = [(axes[name].velocity, axes[name].acceleration) for name in "AB"]
    h = 1e-4
    steps = {"A": (h, 0.0), "B": (0.0, h)}
    slope = {k: (_joint(a + x, b + y) - _joint(a - x, b - y)) / (2 * h) for k, (x, y) in steps.items()}
    middle = _joint(a, b)
    bend_a, bend_b = (
        (_joint(a + x, b + y) - 2 * middle + _joint(a - x, b - y)) / h**2 for x, y in steps.values()
    )
    cross = _joint(a + h, b + h) - _joint(a + h, b - h) - _joint(a - h, b + h) + _joint(a - h, b - h)
    (va, aa), (vb, ab) = rates
    acceleration = slope["A"] * aa + slope["B"] * ab + bend_a * va**2 + bend_b * vb**2
    acceleration += 2 * cross / (4 * h * h) * va * vb
    for name in "AB":
        torque = 4 * (acceleration * slope[name].conj()).real
        np.testing.assert_allclose(axes[name].torque, torque, atol=2e-5 * np.abs(torque).max())
    forces = lw.forces(machine)
    assert forces.shaft == "torque referred to the master shaft"
    assert lw.dc_bus(machine).power_residual < 1e-10
    # Neither motor gives what the imaginary master would.
    assert abs(forces.drive_max["A"]) == pytest.approx(abs(axes["A"].torque_max), rel=1e-3)
    assert abs(forces.torque_drive_max) < 0.9 * abs(axes["B"].torque_max)


def test_a_dial_indexes_and_its_steps_add_up() -> None:
    """After every cycle the dial stands 60° further, and all is back after six."""
    machine = lw.loads(PACKAGING)
    assert lw.period_turns(machine) == 6
    dial = lw.servo_axis(machine, "dial")
    assert dial.advance == pytest.approx(np.pi / 3, rel=1e-12)
    # J q̈ of a cycloidal step: 0.8 · 2π h/t² with t a third of half a second.
    assert dial.torque_max == pytest.approx(0.8 * 2 * np.pi * (np.pi / 3) / (0.5 / 3) ** 2, rel=1e-9)
    assert dial.inertia_mean == pytest.approx(0.8, rel=1e-9)
    places = lw.kinematics(machine, 2 * np.pi * np.arange(7.0)).points["dial"]
    step = np.exp(1j * np.pi / 3 * np.arange(7))
    np.testing.assert_allclose(places.position @ [1, 1j], 0.2 * step, atol=1e-12)
    shaft = lw.servo_axis(machine, "shaft")
    assert shaft.advance == pytest.approx(2 * np.pi)
    assert lw.dc_bus(machine).power_residual < 1e-10


def test_a_formula_that_advances_is_the_same_motion() -> None:
    """A crank's law with `advance` restarts in every cycle and adds up, as sections do."""
    by_sections = lw.loads(PACKAGING)
    by_formula = lw.loads(
        changed(
            PACKAGING,
            (STEP, ""),
            (
                'radius = "200 mm"\n',
                'radius = "200 mm"\nadvance = "60 deg"\nconstants = { b = "120 deg", h = "60 deg" }\n'
                'law = "where(phi < b, h*(phi/b - sin(2*pi*phi/b)/(2*pi)), h)"\n',
            ),
        )
    )
    one, other = (lw.servo_axis(machine, "dial") for machine in (by_sections, by_formula))
    assert other.torque_max == pytest.approx(one.torque_max, rel=1e-4)
    assert other.torque_rms == pytest.approx(one.torque_rms, rel=1e-6)
    assert lw.period_turns(by_formula) == 6


def test_both_sides_of_a_jump_are_met() -> None:
    """A parabolic law: torque ±4 J h/t² to the end of each half; the mean square is exact."""
    text = changed(PACKAGING, ('law = "cycloidal"', 'law = "parabolic"'))
    dial = lw.servo_axis(lw.loads(text), "dial")
    size = 4 * 0.8 * (np.pi / 3) / (0.5 / 3) ** 2
    assert dial.torque.max() == pytest.approx(size, rel=1e-9)
    assert dial.torque.min() == pytest.approx(-size, rel=1e-9)
    assert dial.torque_rms == pytest.approx(size / np.sqrt(3), rel=1e-9)


SCREW = """
format = 1
name = "Screw"
[master]
cycle_time = "2 s"
start_time = "0.5 s"
[axes.slide]
sections = [
  { time = "0.5 s", lift = "0.3 m", law = "parabolic" },
  { time = "0.4 s" },
  { time = "0.5 s", lift = "-0.3 m", law = "parabolic" },
]
[axes.slide.gearbox]
per_turn = "20 mm"
[axes.disc]
[mechanism.linear_drivers.slide]
[mechanism.cranks.disc]
radius = "50 mm"
[bodies]
slide = { mass = "10 kg" }
disc = { inertia = "0.2 kg m^2" }
"""


def test_a_slide_on_a_screw() -> None:
    """F = m a = 4 m h/t²; at the motor F p/2π, without its rotor."""
    slide = lw.servo_axis(lw.loads(SCREW), "slide")
    force = 10 * 4 * 0.3 / 0.5**2
    assert slide.unit_of("torque") == "N"
    assert slide.torque_max == pytest.approx(force, rel=1e-9)
    assert slide.inertia_mean == pytest.approx(10.0)
    assert slide.motor.torque_peak == pytest.approx(force * 0.02 / (2 * np.pi), rel=1e-9)
    assert slide.motor.speed_peak == pytest.approx(2 * 0.3 / 0.5 * 2 * np.pi / 0.02, rel=1e-9)
    assert slide.passes is None


def test_the_master_starts_evenly() -> None:
    """A disc that turns with the master asks for J ω/t while that starts, and for nothing later."""
    disc = lw.servo_axis(lw.loads(SCREW), "disc")
    assert disc.start is not None
    assert disc.stop is None
    assert disc.start.torque_peak == pytest.approx(0.2 * np.pi / 0.5, rel=1e-9)
    assert disc.motor.torque_peak == pytest.approx(0.0, abs=1e-9)


CRANK_AND_DIAL = """
format = 1
name = "Press with an indexing dial"
[drive.motor]
kind = "dc"
speed_no_load = "12 rad/s"
torque_stall = "60 N m"
[drive.flywheel]
inertia = "0.5 kg m^2"
[mechanism.cranks.A]
radius = "0.1 m"
[mechanism.sliders.ram]
crank = "A"
rod = "0.3 m"
[mechanism.points]
P = { x = "1 m" }
[mechanism.cranks.dial]
radius = "0.2 m"
pivot = "P"
[axes.dial]
sections = [{ angle = "120 deg", swing = "60 deg", law = "cycloidal" }]
advance = "60 deg"
[bodies]
ram = { mass = "6 kg" }
dial = { inertia = "0.8 kg m^2" }
[loads]
work = { kind = "dry", on = "ram", force = "50 N" }
"""


def test_a_crankshaft_with_its_uneven_motion_is_the_master() -> None:
    """The main motor does not feel the dial, which follows its angle: M = J (q' ε + q'' ω²)."""
    machine = lw.loads(CRANK_AND_DIAL)
    alone = lw.loads(changed(CRANK_AND_DIAL, ('dial = { inertia = "0.8 kg m^2" }', "")))
    steady = lw.steady_state(machine)
    assert steady.speed_max == pytest.approx(lw.steady_state(alone).speed_max, rel=1e-9)
    assert steady.unevenness > 0.02
    dial = lw.servo_axis(machine)
    own = lw.steady_state(machine, angles=np.linspace(0, 2 * np.pi, 2001))
    u = np.minimum(own.crank_angle / (2 * np.pi / 3), 1.0)
    _, d1, d2 = _cycloidal(u, np.pi / 3)
    moves = own.crank_angle < 2 * np.pi / 3
    span = 2 * np.pi / 3
    torque = np.where(moves, 0.8 * (d1 / span * own.acceleration + d2 / span**2 * own.speed**2), 0.0)
    np.testing.assert_allclose(
        np.interp(own.crank_angle, dial.crank_angle, dial.torque), torque, atol=1e-4 * np.abs(torque).max()
    )
    assert lw.dc_bus(machine).power_residual < 1e-10


def test_a_part_that_crankshaft_and_axis_move_together_is_refused() -> None:
    """A spring from the ram to the dial: the reason names the load, both drivers and the remedy."""
    tied = changed(
        CRANK_AND_DIAL,
        (
            "[loads]\n",
            '[loads]\ntie = { kind = "spring", between = ["ram", "dial"], stiffness = 9, free_length = 0 }\n',
        ),
    )
    with pytest.raises(
        lw.LinkwrightError, match=r"loads\.tie is moved by the crankshaft \(A\) and by the axis dial"
    ):
        lw.steady_state(lw.loads(tied))


@pytest.mark.parametrize(
    ("old", "new", "key", "words"),
    [
        ("[axes.shaft]", '[axes.shaft]\ndriver = "pushr"\n[axes.spare]', "shaft.driver", "pusher"),
        ("[axes.shaft]", '[axes.again]\ndriver = "dial"\n[axes.shaft]', "again.driver", "without an axis"),
        ('{ angle = "120 deg"', '{ angle = "420 deg"', "dial.sections", "60 deg too much"),
        ('{ angle = "120 deg"', '{ time = "0.7 s"', "dial.sections", "0.2 s more than the cycle"),
        ('advance = "60 deg"', 'advance = "50 deg"', "dial.sections", "advance, 50 deg"),
        ('swing = "60 deg"', 'lift = "60 mm"', "dial.sections.0.lift", "swings"),
        ('advance = "60 deg"', 'travel = "60 mm"', "dial.travel", "advance"),
        ('radius = "200 mm"', 'radius = "200 mm"\nlaw = "phi"', "dial.sections", "either sections or law"),
        ('{ angle = "120 deg"', '{ angle = "120 deg", time = "0.1 s"', "dial.sections.0.angle", "either"),
        ('speed = "120 rpm"', 'speed = "120 rpm"\ncycle_time = "1 s"', "master.speed", "either"),
    ],
)  # fmt: skip
def test_what_is_wrong_with_an_axis_is_told(old: str, new: str, key: str, words: str) -> None:
    """Each fault has its key, and says what belongs there."""
    with pytest.raises(lw.MachineError) as found:
        lw.loads(changed(PACKAGING, (old, new)))
    problem = next(problem for problem in found.value.problems if problem.key.removeprefix("axes.") == key)
    assert words in f"{problem.found} {problem.expected} {problem.remedy}"


def test_a_time_without_a_cycle_time_is_refused() -> None:
    """Sections over time need the duration of the cycle."""
    text = changed(
        PACKAGING, ('[master]\nspeed = "120 rpm"', ""), ('{ angle = "120 deg"', '{ time = "0.1 s"')
    )
    with pytest.raises(lw.MachineError, match="cycle time is not known"):
        lw.loads(text)


def test_a_law_that_does_not_close_is_refused() -> None:
    """`advance` beside a formula must be what the formula advances by."""
    text = changed(
        PACKAGING,
        (STEP, ""),
        ('radius = "200 mm"', 'radius = "200 mm"\nlaw = "0.5*sin(phi)"\nadvance = "60 deg"'),
    )
    with pytest.raises(lw.MachineError, match="expected: 0 deg, from phi = 0"):
        lw.loads(text)


def test_the_command_prints_a_row_for_every_axis(tmp_path: Path) -> None:
    """Tables, JSON and figures; a motor that fails ends with exit code 1 and its reason."""
    path = tmp_path / "packaging.toml"
    path.write_text(PACKAGING)
    shown = invoke("axes", str(path))
    assert shown.exit_code == 0
    assert "Axes: torque or force of each driver" in shown.stdout
    assert "▁▁▁▁▂▂▃▄▅▆▇▇█" in shown.stdout
    results = json.loads(invoke("axes", str(path), "--json").stdout)["results"]
    assert set(results["axes"]) == {"dial", "shaft"}
    assert results["dc_bus"]["power_residual"] < 1e-10
    path.write_text(changed(CARRIAGE, ('torque = "7.1, 7.1, 3 N m"', 'torque = "2.6, 2.6, 2 N m"')))
    failed = invoke("axes", str(path))
    assert failed.exit_code == 1
    assert "axis A: peak torque 2.904 N m, at most 2.600 N m" in " ".join(failed.output.split())
    assert invoke("axes", "roller_one_cart").exit_code == 2


def test_a_study_has_the_axes() -> None:
    """Results by the name of their analysis, forces at the speed of the master, and the timing of all."""
    study = lw.study(lw.loads(PACKAGING))
    assert {"axis.dial", "axis.shaft", "dc_bus", "timing.dial", "timing.pusher", "forces"} <= set(study)
    assert isinstance(study["axis.dial"], ServoAxis)
    assert not study.findings
    assert not any("no motor" in text for text in study.warnings)


def test_a_carriage_is_no_longer_called_a_cam() -> None:
    """A driver with an axis needs no caution about the shaft in front of its law."""
    study = lw.study(lw.loads(CARRIAGE))
    assert not any("acts as a cam" in text for text in study.warnings)


def test_clearance_and_the_shift_that_keeps_it() -> None:
    """Two slides with the same harmonic motion: d_min = D − 2 a sin(Δφ/2)."""
    text = """
format = 1
name = "Two slides"
[master]
cycle_time = "1 s"
[axes.P]
[axes.Q]
[mechanism.linear_drivers]
P = { law = "0.05*(1 - cos(phi))", advance = 0 }
Q = { law = "0.05*(1 - cos(phi))", start = "0.3 m", advance = 0 }
"""
    machine = lw.loads(text)
    assert lw.clearance(machine, "P", "Q").distance_min == pytest.approx(0.3, rel=1e-12)
    found = lw.clearance(machine, "P", "Q", keep=0.25)
    assert found.earlier == pytest.approx(np.radians(60), rel=1e-5)
    assert found.axis == "Q"
    near = lw.clearance(machine, "P", "Q", keep=0.35)
    assert near.earlier is None
    assert lw.clearance(machine, "P", "Q", keep=0.1).earlier == pytest.approx(2 * np.pi)
    with pytest.raises(lw.InputError, match="both moved by P"):
        lw.clearance(machine, "P", "P")


def test_a_corner_of_a_law_is_refused_and_a_jump_of_the_acceleration_warned_of() -> None:
    """A step at constant velocity would need an infinite acceleration of the dial; a parabolic one jumps."""
    corner = lw.loads(changed(PACKAGING, ('law = "cycloidal"', 'law = "constant_velocity"')))
    with pytest.raises(
        lw.LinkwrightError, match=r"the velocity of the law of dial jumps from 0 to 0\.5 rad/rad"
    ):
        lw.servo_axis(corner, "dial")
    assert any("infinite acceleration" in text for text in lw.study(corner).findings)
    bent = lw.study(lw.loads(changed(PACKAGING, ('law = "cycloidal"', 'law = "parabolic"'))))
    assert any("The acceleration of the law of dial jumps" in text for text in bent.warnings)


PRESS = """
format = 1
name = "Press with a feed over a time"
[drive]
speed = "60 rpm"
[drive.gearbox]
ratio = 16
[drive.motor]
kind = "dc"
speed_no_load = "1000 rpm"
torque_stall = "200 N m"
inertia = "0.05 kg m^2"
[mechanism.cranks.A]
radius = "50 mm"
[mechanism.linear_drivers.feed]
[axes.feed]
sections = [ { time = "0.4 s", lift = "40 mm" }, { time = "0.4 s", lift = "-40 mm" } ]
[bodies]
A = { mass = "5 kg" }
feed = { mass = "5 kg" }
[loads]
A = { kind = "viscous", on = "A", damping_torsional = "20 N m s/rad" }
"""


def test_sections_over_a_time_beside_the_motor_of_the_crankshaft() -> None:
    """The cycle is that of the design speed, also where the mechanism is looked at without its drive."""
    machine = lw.loads(PRESS)
    axis = lw.servo_axis(machine)
    assert axis.position.max() == pytest.approx(0.04)
    assert axis.crank_angle[np.argmax(axis.position)] == pytest.approx(np.radians(0.4 * 360), abs=0.02)
    assert constant_inertia(machine) == pytest.approx(0.05 * 16**2 + 5 * 0.05**2 / 3)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (CARRIAGE.split("[axes.A]")[1].split("[axes.A.motor]")[0], "\nsections = []\n", "an empty list"),
        ('cycle_time = "1 s"', 'cycle_time = "1 s"\nstart_time = "1 h"', "1800 revolutions of the master"),
    ],
)
def test_empty_sections_and_endless_starts_are_refused(old: str, new: str, words: str) -> None:
    assert old in CARRIAGE
    with pytest.raises(lw.InputError, match=words):
        lw.servo_axis(lw.loads(CARRIAGE.replace(old, new)))


def test_gears_that_gain_energy_in_reverse_are_warned_of() -> None:
    """With a factor of 0.5 the motor gets twice what the braked carriage returns; with 1/η less."""
    plain = lw.loads(CARRIAGE)
    assert not [text for text in lw.study(plain).warnings if "gearbox factor" in text]
    gains = lw.loads(CARRIAGE.replace("ratio = 10", "ratio = 10\nreverse = 0.5"))
    (said,) = [text for text in lw.study(gains).warnings if "gearbox factor" in text]
    axis = lw.servo_axis(gains)
    returned = np.trapezoid(np.maximum(-axis.power, 0), axis.time)
    assert f"factor 0.5 (axes.A.gearbox.reverse) gives the motor {returned:.3g}"[:-1] in said


def test_a_law_that_does_not_repeat_is_a_finding() -> None:
    """phi² turns ever faster; a law over two revolutions repeats after these."""
    text = """
format = 1
name = "Shaft"
[master]
cycle_time = "0.5 s"
[axes.A]
[mechanism.cranks.A]
radius = "0.1 m"
law = "LAW"
[bodies]
A = { mass = "1 kg" }
"""
    with pytest.raises(lw.FindingError, match=r"does not repeat: its slope is .* and 12\.57 at its end"):
        lw.servo_axis(lw.loads(text.replace("LAW", "phi^2")))
    repeats = lw.servo_axis(lw.loads(text.replace("LAW", "0.3*sin(phi/2)")))
    assert repeats.crank_angle[-1] == pytest.approx(4 * np.pi)


def test_a_bus_without_axes_is_wrong_input() -> None:
    with pytest.raises(lw.InputError, match="no axis"):
        lw.dc_bus(lw.loads(PRESS.split("[axes.feed]")[0].replace("[mechanism.linear_drivers.feed]", "")))
