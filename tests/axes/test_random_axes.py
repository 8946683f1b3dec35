"""Laws of mechanics on random machines with axes and cylinders.

Powers balance over all drivers; each driver gives the virtual work of what it moves; the rms torque is that
of dense samples; mirrored and enlarged machines need mirrored and enlarged forces; an electric cylinder on an
arm needs the power of a crank by the law of cosines.
"""

from __future__ import annotations

import numpy as np
import pytest
from axis_machines import AxisMachine, random_machine
from numpy.typing import NDArray
from sizes import generator, random_cases

import linkwright as lw
from linkwright.axes.export.exported import exported, law_of
from linkwright.axes.export.formats import FORMATS
from linkwright.linkages.kinematics import kinematics_of
from linkwright.machine.address import replace
from linkwright.machine.program.compiled import compile_machine

KIND = 71

# Step of a driver in central differences: they are true to h² and 1e-16/h.
STEP = 1e-5


def _motion(machine: lw.Machine, phi: NDArray[np.float64]) -> dict[str, tuple[NDArray[np.float64], ...]]:
    """Places of all points with two derivatives by the master angle, (2, n) each."""
    compiled = compile_machine(machine)
    found = {name: compiled.point_motion(index, phi) for name, index in compiled.points.items()}
    return {name: (motion.place, motion.d1, motion.d2) for name, motion in found.items()}


def _virtual_work(
    made: AxisMachine, machine: lw.Machine, axis: str, phi: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Torque or force of a driver: Σ (m (a − g) − F + R)·∂r/∂q, and the inertia of its own shaft."""
    address = made.starts[axis]
    here = _motion(machine, phi)
    value = _number(machine, address)
    ahead, behind = (_motion(replace(machine, {address: value + h}), phi) for h in (STEP, -STEP))
    work = np.zeros_like(phi)
    for point, mass in made.masses.items():
        _, d1, d2 = here[point]
        rate = (ahead[point][0] - behind[point][0]) / (2 * STEP)
        force = mass * (d2 * made.speed**2 - made.gravity[:, None])
        force -= made.forces.get(point, np.zeros(2))[:, None]
        if point in made.frictions:
            size, angle = made.frictions[point]
            along = np.array([np.cos(angle), np.sin(angle)])
            moves = along @ d1
            sense = np.where(np.abs(moves) > 1e-13, np.sign(moves), 0.0)
            force += size * sense * along[:, None]
        work += (force * rate).sum(axis=0)
    return work


def _number(machine: lw.Machine, address: str) -> float:
    node: object = machine
    for key in address.split("."):
        node = node[key] if isinstance(node, dict) else getattr(node, key)
    assert isinstance(node, float)
    return node


def test_powers_balance_over_all_drivers() -> None:
    """Drivers, loads and friction less the change of kinetic energy, to 1e-10 of the largest."""
    for _, rng in random_cases(KIND, 3, 200):
        machine = lw.loads(random_machine(rng).text)
        assert lw.dc_bus(machine).power_residual <= 1e-10


def test_each_driver_gives_the_virtual_work_of_what_it_moves() -> None:
    """At nine angles; the inertia of a crank's shaft beside."""
    for number, rng in random_cases(KIND, 3, 200):
        made = random_machine(rng)
        machine = lw.loads(made.text)
        phi = generator(KIND, number, 1).uniform(0, 2 * np.pi, 9)
        forces = lw.forces(machine, speed=made.speed, angles=phi)
        axes = machine.axes
        for axis in made.starts:
            driver = axes[axis].driver or axis
            found = forces.drives[driver]
            expected = _virtual_work(made, machine, axis, phi)
            if axis in made.inertias:
                link = kinematics_of(compile_machine(machine), phi, [("links", driver)]).links[driver]
                expected = expected + made.inertias[axis] * link.d2 * made.speed**2
            assert found == pytest.approx(expected, rel=1e-5, abs=1e-5 * np.abs(expected).max()), axis


def test_the_rms_torque_of_a_motor_is_that_of_dense_samples() -> None:
    """J i ε + M/i with losses by the sign of the power, at 8 000 even angles of the cycle."""
    for number, rng in random_cases(KIND, 1, 60):
        made = random_machine(rng)
        machine = lw.loads(made.text)
        for name in made.starts:
            axis = lw.servo_axis(machine, name)
            end = float(axis.crank_angle[-1])
            phi = np.linspace(0, end, 8_001)
            phi = 0.5 * (phi[1:] + phi[:-1]) + generator(KIND, number, 2).uniform(0, 1e-6)
            torque = lw.forces(machine, speed=made.speed, angles=phi).drives[axis.driver]
            rate = np.interp(phi, axis.crank_angle, axis.velocity)
            own = machine.axes[name]
            gears, motor = own.gearbox, own.motor
            assert motor is not None
            lead = 1.0 if axis.turns else (gears.per_turn or 0.0) / (2 * np.pi)
            # At rest losses do not count.
            power = torque * np.where(np.abs(rate) > 1e-9 * np.abs(rate).max(), rate, 0.0)
            eta = np.where(power > 0, 1 / gears.efficiency, np.where(power < 0, gears.efficiency, 1.0))
            acceleration = np.interp(phi, axis.crank_angle, axis.acceleration)
            inertia = motor.rotor
            at_motor = inertia * gears.ratio * acceleration / lead + torque * lead / gears.ratio * eta
            assert axis.motor.torque_rms == pytest.approx(np.sqrt(np.mean(at_motor**2)), rel=2e-3), name


def test_a_mirrored_machine_turns_the_other_way_with_the_same_forces() -> None:
    """About the x axis: torques of cranks change their sign, forces of screws and cylinders do not."""
    for number, _ in random_cases(KIND, 3, 200):
        own, other = (random_machine(generator(KIND, number), side=side) for side in (1, -1))
        one, two = lw.loads(own.text), lw.loads(other.text)
        phi = generator(KIND, number, 3).uniform(0, 2 * np.pi, 9)
        left, right = (lw.forces(machine, speed=own.speed, angles=phi).drives for machine in (one, two))
        for name, values in left.items():
            sign = -1 if name in one.mechanism.cranks else 1
            assert right[name] == pytest.approx(sign * values, rel=1e-8, abs=1e-8 * np.abs(values).max()), (
                name
            )


def test_a_machine_of_twice_the_size_needs_twice_the_forces() -> None:
    """Masses alike, gravity and loads twice: forces twice, torques four times."""
    for number, _ in random_cases(KIND, 3, 200):
        own, other = (random_machine(generator(KIND, number), size=size) for size in (1.0, 2.0))
        one, two = lw.loads(own.text), lw.loads(other.text)
        phi = generator(KIND, number, 4).uniform(0, 2 * np.pi, 9)
        small, large = (lw.forces(machine, speed=own.speed, angles=phi).drives for machine in (one, two))
        for name, values in small.items():
            factor = 4 if name in one.mechanism.cranks else 2
            assert large[name] == pytest.approx(factor * values, rel=1e-8, abs=1e-8 * np.abs(values).max()), (
                name
            )


TWIN = """
format = 1
name = "Arm"
[drive]
speed = SPEED
[mechanism.points]
T = { x = DISTANCE }
MECHANISM
[bodies]
PART = { mass = 7, inertia = 0.3, along = 0.2, across = 0.05 }
[loads]
weight = { kind = "gravity" }
damper = { kind = "viscous", on = "PART", damping_torsional = 3 }
"""


def test_a_cylinder_needs_the_power_of_a_crank_by_the_law_of_cosines() -> None:
    """The angle of the arm is acos((a² + d² − L²)/(2 a d)): F v = M ω at every angle."""
    for _, rng in random_cases(KIND + 1, 6, 200):
        a, d, angle = rng.uniform(0.4, 0.8), rng.uniform(0.4, 0.8), rng.uniform(0.8, 2.0)
        start = float(np.sqrt(a * a + d * d - 2 * a * d * np.cos(angle)))
        stroke = 0.3 * min(a + d - start, start - abs(a - d))
        law = f"{stroke:.17g}*sin(phi) + {0.3 * stroke:.17g}*cos(2*phi) - {0.3 * stroke:.17g}"
        at = a * np.array([np.cos(angle), np.sin(angle)])
        cylinder = (
            f"[mechanism.joints]\nP = {{ x = {at[0]:.17g}, y = {at[1]:.17g} }}\n"
            f"[mechanism.bars]\narm = {{ start = 'O', end = 'P', length = {a:.17g} }}\n"
            f"[mechanism.cylinders.Z]\nstart = 'T'\nend = 'P'\nstart_length = {start:.17g}\nlaw = '{law}'"
        )
        crank = (
            f"[mechanism.cranks.P]\nradius = {a:.17g}\n"
            f"law = 'acos(({a * a + d * d:.17g} - ({start:.17g} + {law})^2)/{2 * a * d:.17g})'"
        )
        speed = float(rng.uniform(0.5, 6))
        common = TWIN.replace("SPEED", f"{speed:.17g}").replace("DISTANCE", f"{d:.17g}")
        one = lw.loads(common.replace("MECHANISM", cylinder).replace("PART", "arm"))
        two = lw.loads(common.replace("MECHANISM", crank).replace("PART", "P"))
        push, turn = lw.forces(one), lw.forces(two)
        power = lw.cylinder_force(one).power
        assert power == pytest.approx(turn.power_drive, abs=1e-8 * np.abs(power).max())
        assert push.torque_drive == pytest.approx(
            turn.torque_drive, abs=1e-8 * np.abs(turn.torque_drive).max()
        )


def test_laws_of_axes_go_to_a_controller_and_back() -> None:
    """Whatever the phase and the advance: polynomials and dense points with derivatives keep the law."""
    for _, rng in random_cases(KIND + 2, 3, 100):
        machine = lw.loads(random_machine(rng).text)
        for name in machine.axes:
            exact, dense = (exported(law_of(machine, name), FORMATS[form]) for form in ("codesys", "csv"))
            assert exact.position_deviation <= 1e-8 * exact.position_peak, name
            assert exact.velocity_deviation <= 1e-8 * exact.velocity_peak, name
            # Points have one acceleration; some laws have another on each side of a boundary.
            assert dense.position_deviation <= 1e-6 * dense.position_peak, name
            assert dense.velocity_deviation <= 1e-3 * dense.velocity_peak, name
