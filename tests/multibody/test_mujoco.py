"""MuJoCo moves exported machines as Linkwright does, within its own accuracy."""

from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np
import pytest

import linkwright as lw
from linkwright.multibody import Mjcf

EXAMPLES = Path(__file__).parents[2] / "examples"

SLIDER_CRANK = """
format = 1
name = "Slider-crank"
[drive.flywheel]
inertia = "0.05 kg m^2"
[mechanism.cranks.A]
radius = "0.1 m"
[mechanism.sliders.S]
crank = "A"
rod = "0.35 m"
[bodies]
A = { mass = "2 kg", inertia = "0.01 kg m^2", along = "30 mm" }
"S.rod" = { mass_per_length = "3 kg/m" }
S = { mass = "4 kg" }
[loads]
weight = { kind = "gravity" }
"""

# Six bars, a motor with a straight characteristic, and every load that has a linear law.
SIX_BAR = """
format = 1
name = "Six-bar"
[drive.motor]
kind = "dc"
torque_stall = "30 N m"
speed_no_load = "60 rad/s"
inertia = "0.002 kg m^2"
[drive.gearbox]
ratio = 3
inertia = "0.001 kg m^2"
[mechanism.points]
B = { x = "0.25 m", y = "0 m" }
[mechanism.cranks.A]
radius = "0.07 m"
[mechanism.rockers.R]
crank = "A"
pivot = "B"
coupler = "0.2 m"
rocker = "0.15 m"
[mechanism.sliders.S]
crank = "R"
rod = "0.3 m"
offset = "0.14 m"
[mechanism.rigid_points.K]
link = "R.coupler"
along = "0.1 m"
across = "0.05 m"
[bodies]
A = { mass = "2 kg" }
"R.coupler" = { mass = "1.5 kg", inertia = "0.006 kg m^2", along = "90 mm", across = "20 mm" }
"R.rocker" = { mass = "2 kg" }
S = { mass = "3 kg" }
K = { mass = "0.4 kg" }
[loads]
weight = { kind = "gravity" }
push = { kind = "force", on = "S", force = "20 N", direction = "180 deg" }
turning = { kind = "force", on = "K", force = "15 N", along = "R.coupler", direction = "40 deg" }
couple = { kind = "torque", on = "R.rocker", torque = "2 N m" }
spring = { kind = "spring", between = ["B", "K"], stiffness = "400 N/m", free_length = "0.1 m", preload = 5 }
damper = { kind = "damper", between = ["O", "R"], damping = "8 N s/m" }
wound = { kind = "torsional_spring", on = "R.rocker", stiffness = "3 N m/rad", free_angle = "90 deg" }
slowed = { kind = "torsional_damper", on = "R.coupler", against = "R.rocker", damping_torsional = 0.1 }
oil = { kind = "viscous", on = "S", damping = "12 N s/m" }
air = { kind = "viscous", on = "K", damping = "3 N s/m" }
bearing = { kind = "viscous", on = "R.rocker", damping_torsional = "0.05 N m s" }
seal = { kind = "dry", on = "A", torque = "0.6 N m" }
"""


@dataclass
class Run:
    """What MuJoCo computed at even times."""

    time: np.ndarray
    points: dict[str, np.ndarray]
    speed: np.ndarray


def simulated(made: Mjcf, duration: float, samples: int = 40) -> Run:
    """Simulate a model from its start."""
    model = mujoco.MjModel.from_xml_string(made.text)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    names = [model.site(i).name for i in range(model.nsite)]
    names = [name for name in names if ".loop" not in name and name != "the frame"]
    steps = round(duration / samples / made.step)
    crank = next(i for i in range(model.njnt) if model.jnt_type[i] == mujoco.mjtJoint.mjJNT_HINGE)
    time, speed, places = [], [], []
    for _ in range(samples + 1):
        mujoco.mj_forward(model, data)
        time.append(data.time)
        speed.append(data.qvel[crank])
        places.append([data.site(name).xpos[:2].copy() for name in names])
        mujoco.mj_step(model, data, steps)
    array = np.array(places)
    return Run(np.array(time), {name: array[:, i] for i, name in enumerate(names)}, np.array(speed))


def largest_error(run: Run, machine: lw.Machine, angles: np.ndarray) -> float:
    """Largest distance of a point from where it is at the crank angles, over the largest way of a point."""
    points = lw.kinematics(machine, angles).points
    size = max(np.ptp(points[name].position, axis=0).max() for name in run.points)
    return max(np.abs(place - points[name].position).max() for name, place in run.points.items()) / size


def requires_second_order(errors: list[float]) -> None:
    """Each halving of the step divides the error by about four, as the loops' gap falls with h²."""
    ratios = np.array(errors[:-1]) / errors[1:]
    assert ((ratios > 2.5) & (ratios < 7)).all(), errors


def test_slider_crank_swings_freely_under_gravity_as_its_motion_in_time() -> None:
    """A free slider-crank under gravity: errors of order h², 1e-6 of the way at the finest step."""
    machine = lw.loads(SLIDER_CRANK)
    motion = lw.transient(machine, angle=0.3, speed=20.0, duration=1.001, accuracy=1e-12)
    errors = []
    for step in (1e-3, 5e-4, 2.5e-4):
        run = simulated(lw.mjcf(machine, angle=0.3, speed_start=20.0, step=step), 1.0)
        errors.append(largest_error(run, machine, motion.at(run.time)[0]))
    requires_second_order(errors)
    assert errors[-1] < 1e-6


def test_dry_friction_of_a_slide_at_every_reversal() -> None:
    """Dry friction that reverses twice per revolution: errors of order h², 5e-5 of the way at the end."""
    machine = lw.loads(SLIDER_CRANK + 'rubbing = { kind = "dry", on = "S", force = "30 N" }\n')
    motion = lw.transient(machine, angle=0.3, speed=20.0, duration=0.501, accuracy=1e-11)
    errors = []
    for step in (1e-3, 5e-4, 2.5e-4):
        run = simulated(lw.mjcf(machine, angle=0.3, speed_start=20.0, step=step), 0.5, samples=20)
        errors.append(largest_error(run, machine, motion.at(run.time)[0]))
    requires_second_order(errors)
    assert errors[-1] < 5e-5


def test_four_bar_at_constant_speed_as_its_kinematics() -> None:
    """A four-bar at constant speed: errors of order h², 1e-6 of the way at the finest step."""
    machine = lw.read(EXAMPLES / "four_bar_counterweights" / "machine.toml")
    errors = []
    for step in (1e-3, 5e-4, 2.5e-4):
        made = lw.mjcf(machine, angle=0.2, step=step)
        run = simulated(made, 0.4)
        errors.append(largest_error(run, machine, 0.2 + made.speed_start * run.time))
        assert np.abs(run.speed / made.speed_start - 1).max() < 1e-7
    requires_second_order(errors)
    assert errors[-1] < 1e-6


def test_six_bar_with_motor_and_all_linear_loads_runs_up_as_its_motion_in_time() -> None:
    """A six-bar from rest under a DC motor and all linear loads: errors of order h², 1e-6 of the way."""
    machine = lw.loads(SIX_BAR)
    motion = lw.transient(machine, angle=0.3, duration=1.001, accuracy=1e-11)
    errors = []
    for step in (1e-3, 5e-4, 2.5e-4):
        run = simulated(lw.mjcf(machine, angle=0.3, step=step), 1.0)
        errors.append(largest_error(run, machine, motion.at(run.time)[0]))
    requires_second_order(errors)
    assert errors[-1] < 1e-6


LOADS = [name for name in lw.loads(SIX_BAR).loads if name != "weight"]


@pytest.mark.parametrize("name", ["motor", "weight", *LOADS])
def test_each_load_of_the_six_bar_moves_it(name: str) -> None:
    """Without any one of its loads the exported six-bar moves otherwise by more than 100 times its error."""
    machine = lw.loads(SIX_BAR)
    motion = lw.transient(machine, angle=0.3, duration=1.001, accuracy=1e-10)
    run = simulated(lw.mjcf(machine, angle=0.3, step=1e-3, leave_out=[name]), 1.0)
    assert largest_error(run, machine, motion.at(run.time)[0]) > 1.5e-4


@pytest.mark.parametrize(
    "name",
    [
        "change_points",
        "geared_five_bar",
        "gears_and_guides",
        "jansen_leg",
        "pumping_unit_geometry",
        "quick_returns",
        "six_bar_chains",
        "three_circle_triad",
    ],
)
def test_mechanisms_of_the_gallery_move_as_their_kinematics(name: str) -> None:
    """Slots, yokes, gears, racks, cables, crossings, triads: all points within 1e-6 over a revolution."""
    machine = lw.read(EXAMPLES / name / "machine.toml")
    made = lw.mjcf(machine, angle=0.2, speed=5.0, step=5e-4)
    run = simulated(made, 1.2, samples=24)
    assert largest_error(run, machine, 0.2 + 5.0 * run.time) < 1e-6


def test_cranks_on_one_shaft_are_one_body_and_others_are_coupled() -> None:
    """Cranks with one pivot need no joint between them; a further pivot and a nut follow by couplings."""
    text = SLIDER_CRANK.replace(
        "[mechanism.sliders.S]",
        """[mechanism.points.Q]
x = "0.2 m"
y = "-0.5 m"
[mechanism.cranks.C]
radius = "0.05 m"
phase = "90 deg"
[mechanism.cranks.E]
radius = "0.06 m"
pivot = "Q"
phase = "40 deg"
[mechanism.linear_drivers.D]
per_turn = "0.3 m"
guide = { through = "Q", angle = "30 deg" }
[mechanism.sliders.S]""",
    )
    machine = lw.loads(text)
    made = lw.mjcf(machine, angle=0.1, speed=5.0, step=5e-4)
    model = mujoco.MjModel.from_xml_string(made.text)
    assert model.body("C").jntnum == 0
    assert model.body("E").jntnum == 1
    run = simulated(made, 1.2, samples=24)
    assert largest_error(run, machine, 0.1 + 5.0 * run.time) < 1e-6


@pytest.mark.parametrize("degrees", [0, 60, 145, 290])
def test_kinetic_energy_of_the_model_is_that_of_the_equivalent_inertia(degrees: int) -> None:
    """½ q̇ᵀ M q̇ of MuJoCo's mass matrix at the start is ½ J(φ) ω² of the reduction."""
    machine = lw.loads(SIX_BAR)
    made = lw.mjcf(machine, angle=np.radians(degrees), speed_start=7.0, step=1e-3)
    model = mujoco.MjModel.from_xml_string(made.text)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    momentum = np.zeros(model.nv)
    mujoco.mj_mulM(model, data, momentum, data.qvel)
    inertia = lw.reduction(machine).inertia_reduced[degrees]
    # Bodies without mass have 1e-8 of it.
    assert data.qvel @ momentum == pytest.approx(inertia * 49.0, rel=1e-7)


def test_constraint_force_of_a_loop_is_the_joint_reaction() -> None:
    """The constraint that closes the four-bar exerts the joint reaction, within 2e-4 of its peak."""
    machine = lw.read(EXAMPLES / "four_bar_counterweights" / "machine.toml")
    made = lw.mjcf(machine, step=1e-4)
    model = mujoco.MjModel.from_xml_string(made.text)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    found, angles = [], []
    for _ in range(20):
        mujoco.mj_step(model, data, 100)
        mujoco.mj_forward(model, data)
        # On the first body of the loop, the coupler; a pair's force is that on the second, the rocker.
        found.append(-data.efc_force[:2])
        angles.append(made.speed_start * data.time)
    force = lw.forces(machine, speed=made.speed_start, angles=np.array(angles)).pairs[made.loops[0]].force
    assert np.abs(np.array(found) - force).max() < 2e-4 * np.abs(force).max()


def test_cylinder_with_pressure_damping_and_friction_as_its_motion_in_time() -> None:
    """A cylinder between frame and crank that is a force: barrel and rod slide, pressure and losses act."""
    text = SLIDER_CRANK.replace(
        "[mechanism.cranks.A]", '[mechanism.points.Q]\nx = "-0.5 m"\ny = "0.2 m"\n[mechanism.cranks.A]'
    )
    cylinder = """
[mechanism.cylinders.Z]
start = "Q"
end = "A"
bore = "20 mm"
rod = "10 mm"
pressure = "2 bar"
damping = "5 N s/m"
friction = "5 N"
[bodies.Z]
mass = "0.4 kg"
inertia = "0.002 kg m^2"
along = "0.1 m"
[bodies."Z.rod"]
mass = "0.2 kg"
inertia = "0.001 kg m^2"
along = "0.15 m"
"""
    machine = lw.loads(text + cylinder)
    motion = lw.transient(machine, angle=0.3, speed=20.0, duration=0.401, accuracy=1e-11)
    errors = []
    for step in (5e-4, 2.5e-4):
        run = simulated(lw.mjcf(machine, angle=0.3, speed_start=20.0, step=step), 0.4)
        errors.append(largest_error(run, machine, motion.at(run.time)[0]))
    assert errors[-1] < 1e-5
    run = simulated(lw.mjcf(machine, angle=0.3, speed_start=20.0, step=5e-4, leave_out=["Z.friction"]), 0.4)
    assert largest_error(run, machine, motion.at(run.time)[0]) > 1e-3


def test_motor_of_constant_speed_keeps_its_speed_at_the_crank() -> None:
    """Without --speed the crank has the speed of a motor of constant speed, divided by the ratio."""
    motor = '[drive.motor]\nkind = "constant_speed"\nspeed = "30 rad/s"\n[drive.gearbox]\nratio = 3\n'
    machine = lw.loads(SLIDER_CRANK.replace("[drive.flywheel]", motor + "[drive.flywheel]"))
    made = lw.mjcf(machine, step=1e-3)
    assert made.is_constant_speed
    run = simulated(made, 0.6, samples=20)
    assert run.speed == pytest.approx(10.0, rel=1e-7)
