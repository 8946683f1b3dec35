"""Elastic drivelines in time, against SciPy on equations written here, energy and the rigid machine."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from elastic_drives import Drive, accelerations, random_drive
from numpy.random import Generator
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from sizes import random_cases

import linkwright as lw


def two_carts(stiffness: float, damping: float) -> lw.Machine:
    entries = {"stiffness": stiffness, "damping": damping}
    return lw.replace(lw.read("roller_two_carts"), {"drive.crankshaft": entries})


def _slope(drive: Drive, phi: float) -> float:
    """ds/dφ of the slider."""
    s, c = drive.radius * np.sin(phi), drive.radius * np.cos(phi)
    return float(-s - s * c / np.sqrt(drive.rod**2 - s**2))


def _from_rest(drive: Drive, angle: float, times: np.ndarray) -> np.ndarray:
    """Twists, speeds and crank angle at times from rest, (states, times): the slider sticks, then slips.

    Written here: the crank stands until the torque of the last spring exceeds F |s′|; dead centres end a
    piece of the integration, and no speed of it changes its sign again.
    """
    n = len(drive.inertia)
    limit = drive.dry * abs(_slope(drive, angle))

    def rate(is_held: bool):
        def of(_: float, y: np.ndarray) -> np.ndarray:
            twist, speed = y[: n - 1, None], y[n - 1 : 2 * n - 1, None]
            a, _ = accelerations(drive, y[-1], twist, speed)
            a = a[:, 0]
            a[-1] *= not is_held
            return np.concatenate([(speed[:-1] - speed[1:])[:, 0], a, speed[-1]])

        return of

    def torn(_: float, y: np.ndarray) -> float:
        return drive.stiffness[-1] * y[n - 2] + drive.damping[-1] * y[2 * n - 3] - limit

    def dead_centre(_: float, y: np.ndarray) -> float:
        return float(np.sin(y[-1]))

    torn.terminal, torn.direction = True, 1
    dead_centre.terminal = True
    exact = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-14, "dense_output": True}
    y, t = np.concatenate([np.zeros(2 * n - 1), [angle]]), 0.0
    out = np.empty((2 * n, len(times)))
    is_held = limit > 0
    while t < times[-1]:
        solved = solve_ivp(rate(is_held), (t, times[-1]), y, events=torn if is_held else dead_centre, **exact)
        mine = (times >= t) & (times <= solved.t[-1])
        out[:, mine] = solved.sol(times[mine])
        y, t, is_held = solved.y[:, -1].copy(), float(solved.t[-1]), False
        if t < times[-1]:
            # A little beyond the dead centre, so that it is not met again.
            step = 1e-9
            y, t = y + step * rate(False)(t, y), t + step
    return out


def _states(motion: lw.ElasticTransient, drive: Drive) -> np.ndarray:
    """Twists of springs and speeds of masses at the crank, and its angle."""
    n = len(drive.inertia)
    referred = motion.speed / motion.ratio[:, None]
    distinct = [0] + [
        k for k in range(1, len(referred)) if np.abs(referred[k] - referred[k - 1]).max() > 1e-12
    ]
    assert len(distinct) == n
    return np.concatenate([motion.twist / drive.ratio[:, None], referred[distinct], motion.crank_angle[None]])


def _started(rng: Generator) -> tuple[Drive, float]:
    """A random drive with dry friction, away from its dead centres."""
    drive = random_drive(rng)
    while not drive.dry:
        drive = random_drive(rng)
    return drive, float(rng.choice([-1, 1]) * np.radians(rng.uniform(30, 150)))


def test_random_drives_start_as_equations_written_down_here() -> None:
    """Stuck, torn loose and running: states at given times to 1e-7 of their scale, one to three springs."""
    for number, rng in random_cases(4811, 4, 100):
        drive, angle = _started(rng)
        times = np.linspace(0, 2.0, 41)
        motion = lw.elastic_transient(drive.machine, angle=angle, duration=2.0, times=times, accuracy=1e-10)
        found, expected = _states(motion, drive), _from_rest(drive, angle, times)
        scale = np.abs(expected).max(axis=1, keepdims=True)
        assert np.abs((found - expected) / scale).max() < 1e-7, number
        assert len(motion.slips) == 1, number
        assert motion.energy_error <= 1e-9, number


def test_the_crank_is_torn_loose_when_the_coupling_bears_the_friction() -> None:
    """At that instant the torque of the last shaft is F |ds/dφ|; before it the crank stands."""
    rng = np.random.default_rng(7)
    drive, angle = _started(rng)
    motion = lw.elastic_transient(drive.machine, angle=angle, duration=1.0)
    torn = lw.elastic_transient(drive.machine, angle=angle, duration=1.0, times=motion.slips)
    own = drive.dry * abs(_slope(drive, angle)) / drive.ratio[-1]
    assert torn.torque[-1] == pytest.approx([own], rel=1e-9)
    assert np.all(motion.speed[-1, motion.time < motion.slips[0]] == 0.0)
    assert np.all(motion.speed[-1, motion.time > motion.slips[0]] > 0.0)


def test_the_run_up_ends_in_the_steady_motion() -> None:
    """After forty revolutions twist and speeds are those of the periodic solution at that angle, to 1e-8."""
    machine = two_carts(2e4, 50.0)
    late = lw.elastic_transient(machine, turns=40, accuracy=1e-11)
    angle = late.state_end[-1] % (2 * np.pi)
    steady = lw.elastic_motion(machine, accuracy=1e-11, angles=np.array([angle]))
    assert late.speed[:, -1] == pytest.approx(steady.speed[:, 0], rel=1e-8)
    assert late.twist[0, -1] == pytest.approx(steady.twist[0, 0], abs=1e-8 * steady.twist_max[0])


def test_a_steady_motion_goes_on_in_time() -> None:
    """From its state at φ = 0 three cycles repeat its extremes."""
    machine = two_carts(2e4, 50.0)
    steady = lw.elastic_motion(machine, accuracy=1e-11)
    motion = lw.elastic_transient(machine, start=steady, turns=3, accuracy=1e-11)
    assert motion.torque_max == pytest.approx(steady.torque_max, rel=1e-8)
    assert motion.speed_min == pytest.approx(steady.speed_min, rel=1e-8)
    assert motion.acceleration_max == pytest.approx(steady.acceleration_max, rel=1e-7)
    assert motion.time[-1] == pytest.approx(3 * steady.period, rel=1e-9)


def test_a_stiff_coupling_approaches_the_rigid_motion_by_one_over_its_stiffness() -> None:
    """Two seconds after 6 rad/s: ten times the stiffness leaves a tenth of the difference."""
    rigid = lw.transient(lw.read("roller_two_carts"), speed=6.0, duration=2.0, accuracy=1e-11)
    off = []
    for stiffness in (1e6, 1e7, 1e8):
        # As damped at every stiffness: what vibrates at the start has died away.
        machine = two_carts(stiffness, 0.2 * np.sqrt(stiffness * 30))
        motion = lw.elastic_transient(machine, speed=6.0, duration=2.0, accuracy=1e-11)
        off.append(motion.crank_angle[-1] - rigid.crank_angle[-1])
    assert abs(off[0]) < 1e-2
    assert off[1] / off[0] == pytest.approx(0.1, rel=0.05)
    assert off[2] / off[1] == pytest.approx(0.1, rel=0.05)


IDLE = """
format = 1
name = "motor that brings a flywheel to speed"
[drive.motor]
kind = "dc"
speed_no_load = 100
torque_stall = 50
inertia = 0.1
[drive.gearbox]
ratio = 5
inertia = 0.02
[drive.flywheel]
inertia = 1
[drive.crankshaft]
stiffness = 1000
damping = 20
[mechanism.cranks.A]
radius = 0.1
"""


def test_the_rotor_of_a_motor_without_load_is_heated_by_the_kinetic_energy() -> None:
    """∫ M (ω₀ − ω) dt = ½ J ω₀² whatever the characteristic, less what the coupling takes."""
    motion = lw.elastic_transient(lw.loads(IDLE), duration=30.0, accuracy=1e-10)
    inertia = (0.1 + 0.02) * 5**2 + 1
    kinetic = 0.5 * inertia * 20.0**2
    # All masses turn at 20 rad/s in the end: M ω₀ t = J ω₀² is the work of the field.
    assert motion.energy_kinetic == pytest.approx(kinetic, rel=1e-8)
    assert motion.heat_motor == pytest.approx(kinetic - motion.energy_dissipated.sum(), rel=1e-8)


def test_what_is_switched_off_turns_its_energy_into_heat() -> None:
    """Stop: loads and coupling take the kinetic and strain energy, and all comes to rest."""
    machine = two_carts(2e4, 50.0)
    running = lw.elastic_transient(machine, duration=4.0)
    stopped = lw.elastic_transient(machine, start=running, duration=30.0, motor=False)
    assert stopped.end == "rest"
    assert stopped.energy_motor == 0.0
    assert np.abs(stopped.speed[:, -1]).max() < 1e-5 * running.speed_max.max()
    gained = stopped.energy_kinetic + stopped.energy_elastic
    lost = stopped.energy_load + stopped.energy_dissipated.sum()
    assert -gained == pytest.approx(lost, rel=1e-9)


def test_switches_are_motions_one_after_another() -> None:
    """A load step and a stop by switches are those of three motions, each from the end of the one before."""
    machine = two_carts(2e4, 50.0)
    loaded = lw.replace(machine, {"loads.rolling1.force": 7000.0})
    whole = lw.elastic_transient(
        machine,
        duration=6.0,
        switches=[lw.DriveSwitch(2.0, machine=loaded), lw.DriveSwitch(4.0, motor=False)],
    )
    parts = [lw.elastic_transient(machine, duration=2.0)]
    parts.append(lw.elastic_transient(loaded, start=parts[-1], duration=2.0))
    parts.append(lw.elastic_transient(loaded, start=parts[-1], duration=2.0, motor=False))
    assert whole.state_end == pytest.approx(parts[-1].state_end, abs=1e-12)
    assert whole.energy_load == pytest.approx(sum(part.energy_load for part in parts), rel=1e-12)
    assert whole.torque_max[0] == max(part.torque_max[0] for part in parts)
    assert whole.energy_error <= 1e-9


def test_losses_of_the_gearbox_hold_the_motor() -> None:
    """Against a stuck crank the motor comes to rest, where the coupling has η to 1/η of its torque."""
    machine = lw.replace(
        two_carts(2e4, 500.0),
        {"loads.rolling1.force": 2e4, "loads.rolling2.force": 2e4, "drive.gearbox.reverse": None},
    )
    motion = lw.elastic_transient(machine, angle=np.radians(45), duration=60.0)
    assert motion.end == "rest"
    motor = 129.24 * 9.8
    assert 0.9 * motor * (1 - 1e-9) <= motion.torque[0, -1] <= motor / 0.9 * (1 + 1e-9)
    assert motion.heat_gearbox > 0
    assert motion.energy_error <= 1e-9


def test_a_machine_that_cannot_start_says_at_which_angle_and_why() -> None:
    """A friction torque above that of the motor at standstill; the torques are those of statics."""
    machine = lw.replace(two_carts(2e4, 500.0), {"loads.rolling1.force": 2e4, "loads.rolling2.force": 2e4})
    with pytest.raises(
        lw.StartError, match=r"(stalls|does not start).* the motor gives 1140 N m at the crank"
    ):
        lw.elastic_run_up(machine)


def test_the_run_up_has_settled_where_all_stations_stay_in_the_band() -> None:
    """Time and peak torque are those of 4001 samples of the motion against 721 of the steady one."""
    machine = two_carts(2e4, 50.0)
    found = lw.elastic_run_up(machine)
    steady = lw.elastic_motion(machine, angles=np.linspace(0, 2 * np.pi, 721))
    fine = np.linspace(0, found.motion.duration, 4001)
    course = lw.elastic_transient(machine, duration=found.motion.duration, times=fine)
    referred = (course.speed / course.ratio[:, None])[1:]
    expected = np.array(
        [
            np.interp(course.crank_angle % (2 * np.pi), steady.crank_angle, speed)
            for speed in (steady.speed / steady.ratio[:, None])[1:]
        ]
    )
    off = np.abs(referred - expected).max(axis=0) / steady.speed_mean_time
    last = fine[off > found.settled].max()
    assert found.time == pytest.approx(last, abs=2e-3)
    assert found.torque_peak == pytest.approx(np.abs(course.torque).max(axis=1), rel=1e-4)
    assert found.torque_peak >= np.abs(course.torque).max(axis=1) * (1 - 1e-9)


def test_wrong_arguments_are_refused() -> None:
    """A rigid driveline, a motor that keeps its speed, times that are not in order or beyond the end."""
    machine = two_carts(2e4, 50.0)
    with pytest.raises(lw.InputError, match="driveline is rigid"):
        lw.elastic_transient(lw.read("roller_two_carts"), duration=1.0)
    with pytest.raises(lw.InputError, match="found neither"):
        lw.elastic_transient(machine)
    with pytest.raises(lw.InputError, match="increasing times"):
        lw.elastic_transient(machine, duration=1.0, switches=[lw.DriveSwitch(2.0, motor=False)])
    with pytest.raises(lw.InputError, match="expected times from 0 s"):
        lw.elastic_transient(machine, duration=1.0, times=[2.0])


PENDULUM = """
format = 1
name = "pendulum behind an elastic drive, with its brake at the motor"
[drive]
speed = "10 rad/s"
[drive.motor]
kind = "dc"
speed_no_load = 100
torque_stall = 50
inertia = 0.1
[drive.gearbox]
ratio = 5
inertia = 0.02
[drive.flywheel]
inertia = 1
[drive.brake]
torque = 0.5
[drive.crankshaft]
stiffness = 1e9
damping = 1e4
[mechanism.cranks.A]
radius = 0.5
[mechanism.sliders.S]
crank = "A"
rod = 2
[bodies]
S = { mass = 1e-6 }
A = { mass = 10, along = 0.5, inertia = 0 }
[loads]
gravity = { kind = "gravity", acceleration = 9.81 }
"""


def test_a_pendulum_swings_out_against_the_brake() -> None:
    """It turns back: from turn to turn m g r (cos θ₁ − cos θ₀) = M_B |θ₁ − θ₀|, for a stiff shaft."""
    motion = lw.elastic_transient(
        lw.loads(PENDULUM), angle=1 - np.pi / 2, duration=60, motor=False, brake=True, accuracy=1e-10
    )
    weight, held = 10 * 9.81 * 0.5, 0.5 * 5
    swing, ends = 1.0, [1.0]
    while weight * abs(np.sin(swing)) > held:
        start = swing
        swing = brentq(
            lambda end, start=start: weight * (np.cos(end) - np.cos(start)) - held * abs(end - start),
            -start,
            start * (1 - 1e-6),
        )
        ends.append(swing)
    assert len(ends) > 5
    assert motion.end == "rest"
    assert motion.crank_angle[-1] + np.pi / 2 == pytest.approx(ends[-1], abs=1e-6)
    assert motion.energy_brake == pytest.approx(held * np.abs(np.diff(ends)).sum(), rel=1e-6)
    assert motion.energy_error <= 1e-9


def test_a_stiff_shaft_is_followed_by_implicit_steps() -> None:
    """A shaft 10⁴ times as stiff and damped: states to 1e-7 against SciPy's Radau on the equations here."""
    rng = np.random.default_rng(3)
    drive, angle = _started(rng)
    while len(drive.stiffness) > 1 or drive.ratio[0] != 1.0:
        drive, angle = _started(rng)
    k, c = 1e4 * drive.stiffness, 1e4 * drive.damping
    entries = {"drive.crankshaft.stiffness": float(k[0]), "drive.crankshaft.damping": float(c[0])}
    stiff = replace(drive, machine=lw.replace(drive.machine, entries), stiffness=k, damping=c)
    motion = lw.elastic_transient(stiff.machine, angle=angle, speed=3.0, turns=0.2, accuracy=1e-10)
    assert motion.steps_implicit > 10

    def rate(_: float, y: np.ndarray) -> np.ndarray:
        a, _ = accelerations(stiff, y[-1], y[:1, None], y[1:3, None])
        return np.array([y[1] - y[2], *a[:, 0], y[2]])

    start = np.array([0.0, 3.0, 3.0, angle])
    # Before the first dead centre, where friction bends the motion.
    before = motion.time[np.sin(motion.crank_angle) * np.sin(angle) > 0][-1]
    solved = solve_ivp(rate, (0, before), start, "Radau", rtol=1e-11, atol=1e-13)
    course = lw.elastic_transient(
        stiff.machine, angle=angle, speed=3.0, turns=0.2, accuracy=1e-10, times=[before]
    )
    expected = solved.y[:, -1]
    assert _states(course, stiff)[:, 0] == pytest.approx(expected, rel=1e-7)
