"""Force, pressure, flow and power of cylinders against closed forms, virtual work and differences."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import linkwright as lw

BUCKET = """
format = 1
name = "bucket linkage"
[drive]
speed = "6 rpm"
[mechanism.points]
T = { x = "0 m", y = "0.35 m" }
F = { x = "1.9 m", y = "0 m" }
G = { x = "2.3 m", y = "-0.05 m" }
[mechanism.cylinders.Z]
start = "T"
end = "P"
start_length = "1.75 m"
law = "0.1*(1 - cos(phi)) + 0.01*sin(2*phi)"
bore = "90 mm"
rod = "60 mm"
back_pressure = "4 bar"
[mechanism.joints]
P = { x = "1.75 m", y = "0.45 m" }
Q = { x = "2.45 m", y = "0.35 m" }
[mechanism.bars]
lever = { start = "F", end = "P", length = "0.48 m" }
link = { start = "P", end = "Q", length = "0.55 m" }
bucket = { start = "G", end = "Q", length = "0.42 m" }
[mechanism.rigid_points]
K = { link = "bucket", along = "-0.9 m", across = "0.2 m" }
[bodies]
bucket = { mass = "300 kg", inertia = "40 kg m^2", along = "-0.3 m", across = "0.2 m" }
[loads]
soil = { kind = "force", on = "K", force = "9 kN", direction = "20 deg" }
"""

# A crank-rocker whose rocker works against a cylinder.
ROCKER = """
format = 1
name = "rocker with a cylinder"
[drive]
speed = "60 rpm"
[mechanism.points]
G = { x = "0.6 m" }
T = { x = "0.6 m", y = "-0.5 m" }
[mechanism.cranks.A]
radius = "0.1 m"
[mechanism.rockers.R]
crank = "A"
pivot = "G"
coupler = "0.5 m"
rocker = "0.3 m"
[mechanism.cylinders.Z]
start = "T"
end = "R"
bore = "40 mm"
rod = "20 mm"
ENTRIES
[bodies]
Z = { mass = "2 kg", inertia = "0.05 kg m^2", along = "0.2 m" }
"Z.rod" = { mass = "1 kg", inertia = "0.01 kg m^2", along = "0.15 m" }
"""
BORE, ANNULUS = np.pi / 4 * 0.04**2, np.pi / 4 * (0.04**2 - 0.02**2)


def test_holding_force_is_that_of_virtual_work() -> None:
    """F dL = −P·dp of the load at the teeth, at rest at each position."""
    machine, phi = lw.loads(BUCKET), np.radians([20.0, 75.0, 130.0, 200.0, 310.0])
    held, motion = lw.forces(machine, speed=0.0, angles=phi), lw.kinematics(machine, phi)
    force = 9e3 * np.array([np.cos(np.radians(20)), np.sin(np.radians(20))])
    work = motion.points["K"].d1 @ force
    assert held.drives["Z"] * motion.slides["Z"].d1 == pytest.approx(-work, rel=1e-9)


def test_power_goes_into_masses_and_load() -> None:
    """Power of the cylinder, less that of the load, changes the kinetic energy; the residual is rounding."""
    machine = lw.loads(BUCKET)
    cylinder, forces = lw.cylinder_force(machine), lw.forces(machine)
    assert np.abs(forces.power_residual).max() <= 1e-10 * np.abs(cylinder.power).max()
    assert cylinder.power == pytest.approx(forces.power_kinetic - forces.power_load, abs=1e-7)


def test_toggle_clamp_by_its_closed_form() -> None:
    """Two equal arms a; cylinder from below: F dL = P dx with x = 2a cos α, J = (a cos α, a sin α)."""
    machine = lw.loads("""
format = 1
name = "toggle clamp"
[mechanism.points]
T = { x = "0.25 m", y = "-0.3 m" }
[mechanism.cylinders]
Z = { start = "T", end = "J", start_length = "0.36 m", law = "-0.02*(1 - cos(phi))", bore = "50 mm" }
[mechanism.joints]
J = { x = "0.22 m", y = "0.06 m" }
C = { x = "0.45 m", y = "0 m", guide = {} }
[mechanism.bars]
fixed = { start = "O", end = "J", length = "0.23 m" }
moving = { start = "J", end = "C", length = "0.23 m" }
[loads]
clamping = { kind = "force", on = "C", force = "2 kN", direction = "180 deg" }
""")
    cylinder = lw.cylinder_force(machine)
    joint = lw.kinematics(machine, cylinder.crank_angle).points["J"].position
    alpha = np.arctan2(joint[:, 1], joint[:, 0])
    along = ((joint[:, 0] - 0.25) * -np.sin(alpha) + (joint[:, 1] + 0.3) * np.cos(alpha)) * 0.23
    # dL/dα = along/L; the slider goes out by dx/dα = −2a sin α, against the clamping force.
    expected = 2e3 * -2 * 0.23 * np.sin(alpha) / (along / cylinder.length)
    assert cylinder.force == pytest.approx(expected, rel=1e-10)
    assert cylinder.power == pytest.approx(0.0 * expected, abs=0)


def test_pressures_make_the_force_and_none_is_below_the_back_pressure() -> None:
    """F = p₁A₁ − p₂A₂, one of them at 4 bar; flows fill and empty the chambers, P = F v."""
    cylinder = lw.cylinder_force(lw.loads(BUCKET))
    assert cylinder.pressure_bore is not None
    assert cylinder.pressure_rod is not None
    bore, annulus = np.pi / 4 * 0.09**2, np.pi / 4 * (0.09**2 - 0.06**2)
    made = cylinder.pressure_bore * bore - cylinder.pressure_rod * annulus
    assert made == pytest.approx(cylinder.force, rel=1e-12)
    assert np.minimum(cylinder.pressure_bore, cylinder.pressure_rod) == pytest.approx(4e5, rel=1e-12)
    assert cylinder.flow_bore == pytest.approx(bore * cylinder.velocity)
    assert cylinder.flow_rod == pytest.approx(annulus * cylinder.velocity)
    assert cylinder.power == pytest.approx(cylinder.force * cylinder.velocity)
    assert cylinder.stroke == pytest.approx(np.ptp(cylinder.length), rel=1e-14)


def test_pressure_pushes_the_points_apart() -> None:
    """50 bar on the bore, 5 bar on the annulus; friction takes its force times the speed of the rod."""
    entries = 'pressure = "50 bar"\npressure_rod = "5 bar"\nfriction = "100 N"'
    machine = lw.loads(ROCKER.replace("ENTRIES", entries))
    cylinder, forces = lw.cylinder_force(machine), lw.forces(machine)
    assert cylinder.force == pytest.approx(50e5 * BORE - 5e5 * ANNULUS, rel=1e-12)
    assert np.abs(forces.power_residual).max() <= 1e-10 * np.abs(forces.power_drive).max()
    without = lw.forces(lw.loads(ROCKER.replace("ENTRIES", entries.replace("100", "0"))))
    lost = forces.power_drive - without.power_drive
    assert lost == pytest.approx(100 * np.abs(cylinder.velocity), abs=1e-9)


def test_a_passive_cylinder_is_spring_and_damper() -> None:
    """k (L − L₀) and c v against the motion, as the loads of the same name between two points."""
    entries = 'stiffness = "10 N/mm"\nfree_length = "0.7 m"\npreload = "20 N"\ndamping = "300 N s/m"'
    machine = lw.loads(ROCKER.replace("ENTRIES", entries))
    cylinder = lw.cylinder_force(machine)
    expected = -(20 + 1e4 * (cylinder.length - 0.7)) - 300 * cylinder.velocity
    assert cylinder.force == pytest.approx(expected, rel=1e-12)
    loads = """
[loads]
spring = { kind = "spring", between = ["T", "R"], stiffness = 1e4, free_length = 0.7, preload = 20 }
damper = { kind = "damper", between = ["T", "R"], damping = 300 }
"""
    other = lw.loads(ROCKER.replace("ENTRIES", 'damping = "0 N s/m"') + loads)
    assert lw.forces(machine).torque_drive == pytest.approx(lw.forces(other).torque_drive, abs=1e-9)


def test_flow_and_speed_that_disagree_are_told() -> None:
    """Flow for a cycle of 4 s, a drive of 6 rpm: 10 s."""
    flow = 'flow = "0, 9, 0, -5, 0 l/min"\nflow_time = "0, 1, 2, 3, 4 s"'
    text = BUCKET.replace('law = "0.1*(1 - cos(phi)) + 0.01*sin(2*phi)"', flow)
    machine = lw.loads(text)
    (said,) = [text for text in lw.study(machine).warnings if "The flow of the cylinder Z" in text]
    assert "a cycle of 4 s, and a revolution of the drive takes 10 s" in said
    # Without a design speed the flow says how fast it is.
    cylinder = lw.cylinder_force(lw.loads(text.replace('speed = "6 rpm"', "")))
    assert cylinder.flow_max == pytest.approx(9e-3 / 60, rel=1e-3)


def test_derivatives_are_those_of_differences() -> None:
    """Largest forces, pressures, lengths and powers by lengths, masses, areas and pressures."""
    force = 'pressure = "50 bar"\npressure_rod = "5 bar"\nfriction = "100 N"'
    cases: tuple[tuple[str, dict[str, float], tuple[str, ...]], ...] = (
        (
            BUCKET,
            {
                "mechanism.cylinders.Z.start_length": 1.75,
                "mechanism.bars.lever.length": 0.48,
                "bodies.bucket.mass": 300,
            },
            ("force_max", "force_min", "length_max", "pressure_max", "power_max"),
        ),
        (
            ROCKER.replace("ENTRIES", force),
            {
                "mechanism.cylinders.Z.bore": 0.04,
                "mechanism.cylinders.Z.pressure": 50e5,
                "mechanism.cranks.A.radius": 0.1,
            },
            ("force_max", "power_max", "length_max"),
        ),
    )
    for text, entries, names in cases:
        machine = lw.loads(text)
        found = lw.gradient(machine, [f"cylinder.{name}" for name in names], list(entries))
        for row, response in enumerate(found.responses):
            for column, (address, value) in enumerate(entries.items()):
                step = 1e-5 * value
                ends = [
                    getattr(
                        lw.cylinder_force(lw.replace(machine, {address: value + way})),
                        response.split(".")[-1],
                    )
                    for way in (-step, step)
                ]
                by_difference = (ends[1] - ends[0]) / (2 * step)
                assert float(found.derivatives[row, column]) == pytest.approx(
                    by_difference, rel=2e-6, abs=1e-9
                ), (response, address)


def test_no_such_cylinder_is_named() -> None:
    with pytest.raises(lw.InputError, match='found "Y", expected one of Z'):
        lw.cylinder_force(lw.loads(BUCKET), "Y")


def test_tables_and_figures_of_a_study() -> None:
    """A row each, pressure in bar and flow in l/min; the headline says force and pressure."""
    from linkwright.kinetostatics.cylinder_report import cylinder_figures, cylinder_tables

    known: Any = lw.study(lw.loads(BUCKET))
    (table,) = cylinder_tables(known.each("cylinder"))
    assert table.rows[0][0] == "Z"
    assert any("bar" in head for head in table.heads)
    (figure,) = cylinder_figures(known.each("cylinder"))
    assert figure.name == "cylinder_Z"


def test_seal_friction_resists_the_drive_of_the_machine() -> None:
    """A driver of 20 mm stroke with 100 N of friction takes 4 J a revolution: 4/2π N m on average."""
    text = """
format = 1
name = "Press"
[mechanism.joints]
S = { x = "0.4 m", y = "0 m", guide = { angle = "0 deg" } }
[mechanism.cylinders.Z]
start = "O"
end = "S"
start_length = "0.4 m"
law = "0.01*(1 - cos(phi))"
friction = "100 N"
[bodies]
S = { mass = "5 kg" }
"""
    reduced = lw.study(lw.loads(text)).reduction
    assert reduced is not None
    assert reduced.torque_load_mean == pytest.approx(4 / (2 * np.pi), rel=1e-4)
