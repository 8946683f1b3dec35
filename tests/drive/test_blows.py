"""Loads of formulas that jump or have kinks at crank angles: steps end there, each on its side."""

from __future__ import annotations

import numpy as np
import pytest
from random_drives import BLOWS, Table, random_drive, torque_size, with_blow
from scipy.optimize import brentq
from sizes import cases, random_cases

import linkwright as lw
from linkwright import LinkwrightError
from linkwright.drive import accurate_run_up
from linkwright.machine import compile_machine

# What rows promise; of peaks of acceleration a digit less.
_ROWS, _PEAKS = 1e-7, 1e-6


def _blows() -> list[tuple[lw.Machine, lw.SteadyState]]:
    found = []
    for _, random in random_cases(61, 60, 1000):
        drive: Table = random_drive(random)
        try:
            state = lw.steady_state(lw.Machine.model_validate(drive))
            size = torque_size(state)
            machine = lw.Machine.model_validate(with_blow(random, drive, size))
            state = lw.steady_state(machine, n=4001)
        except LinkwrightError:
            continue
        # Under a steep motor rounding forbids more.
        if state.accuracy < 1e-8:
            found.append((machine, state))
    return found


@pytest.fixture(scope="module")
def blows() -> list[tuple[lw.Machine, lw.SteadyState]]:
    found = _blows()
    assert len(found) > cases(25, 400)
    return found


def test_extremes_are_those_of_the_curves(blows: list[tuple[lw.Machine, lw.SteadyState]]) -> None:
    for machine, state in blows:
        for curve, low, high in (
            (state.speed, state.speed_min, state.speed_max),
            (state.acceleration, state.acceleration_min, state.acceleration_max),
        ):
            room = 1e-7 * np.abs(curve).max()
            assert low - room <= curve.min(), machine
            assert curve.max() <= high + room, machine
        for value, angle in (
            (state.acceleration_min, state.acceleration_min_angle),
            (state.acceleration_max, state.acceleration_max_angle),
        ):
            # On either side of a jump.
            beside = lw.steady_state(
                machine, angles=np.clip(angle + np.array([-1e-11, 0.0, 1e-11]), 0.0, 2 * np.pi)
            )
            peak = max(np.abs(state.acceleration).max(), abs(value))
            assert np.abs(beside.acceleration - value).min() < _PEAKS * peak, machine


def test_rows_are_single_answers(blows: list[tuple[lw.Machine, lw.SteadyState]]) -> None:
    compared = 0
    for machine, state in blows:
        radius = float(lw.get(machine, "mechanism.cranks.A.radius"))
        rows = lw.steady_states(machine, {"mechanism.cranks.A.radius": [radius] * 3})
        scale = max(abs(state.energy_motor), abs(state.energy_load), 1e-300)
        if np.isnan(rows.energy_load[1]):
            continue
        compared += 1
        assert rows.energy_load[1] == pytest.approx(state.energy_load, abs=_ROWS * scale), machine
        assert rows.speed_max[1] == pytest.approx(state.speed_max, rel=_ROWS), machine
        peak = max(abs(state.acceleration_max), abs(state.acceleration_min))
        assert rows.acceleration_max[1] == pytest.approx(state.acceleration_max, abs=_PEAKS * peak), machine
        assert rows.acceleration_min[1] == pytest.approx(state.acceleration_min, abs=_PEAKS * peak), machine
    assert compared > 0.8 * len(blows)


# A motor that gives or takes 2000 N m for 0.1 rad/s, on 0.2 kg m².
STEEP = """
format = 1
name = "Steep drive"
[drive.motor]
kind = "table"
speed = ["0 rad/s", "9.9 rad/s", "10.1 rad/s"]
torque = ["2000 N m", "2000 N m", "-2000 N m"]
[drive.flywheel]
inertia = "0.2 kg m2"
[mechanism.cranks.A]
radius = "0.1 m"
[mechanism.sliders.B]
crank = "A"
rod = "0.4 m"
[bodies.B]
mass = "5 kg"
[loads.smooth]
kind = "formula"
on = "A"
torque = "-1500*sin(phi)^8"
"""

# Puts an end of a step at an angle, and does nothing else.
NOTHING = """
[loads.nothing]
kind = "formula"
on = "A"
torque = "1e-300*sign(sin(phi - {at}))"
"""


def test_a_jump_of_nothing_changes_nothing() -> None:
    plain = lw.loads(STEEP)
    state = lw.steady_state(plain, accuracy=1e-11)
    assert state.accuracy < 1e-8
    # Where the acceleration is largest in size too, and where it is zero.
    for at in (1.0, state.acceleration_max_angle, state.acceleration_min_angle, state.speed_max_angle):
        other = lw.steady_state(lw.loads(STEEP + NOTHING.format(at=at)), accuracy=1e-11)
        for name in ("acceleration_min", "acceleration_max", "speed_min", "speed_max", "dynamism"):
            assert getattr(other, name) == pytest.approx(getattr(state, name), rel=2e-9), (name, at)


# Rounding of the speed leaves a digit less under the steep drive.
@pytest.mark.parametrize("off", [0.0, 1e-7, -3e-7])
@pytest.mark.parametrize(("text", "within"), [(STEEP, 2e-6), (STEEP.replace("0.2 kg", "20 kg"), 2e-7)])
def test_a_peak_beside_an_end_of_a_step_is_no_corner(text: str, within: float, off: float) -> None:
    peaks = [f"steady_state.acceleration_{end}" for end in ("min", "max")]
    entries = [
        "mechanism.sliders.B.rod",
        "bodies.B.mass",
        "drive.flywheel.inertia",
        "mechanism.cranks.A.radius",
    ]
    state, plain = lw.steady_state(lw.loads(text)), lw.gradient(lw.loads(text), peaks, entries)
    for peak, at in zip(peaks, (state.acceleration_min_angle, state.acceleration_max_angle), strict=True):
        beside = lw.gradient(lw.loads(text + NOTHING.format(at=at + off)), [peak], entries)
        exact, found = (
            np.array([of[name] for name in entries]) * plain.at for of in (plain.of(peak), beside.of(peak))
        )
        assert np.abs(found - exact).max() < within * np.abs(exact).max()


@pytest.mark.parametrize("stiffness", [1.0, 10.0, 100.0])
def test_a_steep_drive_jumps_by_torque_over_inertia(stiffness: float) -> None:
    # Long after a jump the speed of the crank is constant; at the next jump the speed is what it was.
    torque, inertia = 40.0, 0.2
    drive = STEEP.replace("2000", str(2000 * stiffness)).partition("[mechanism.sliders")[0]
    load = f"""[loads.jump]
    kind = "formula"
    on = "A"
    torque = "-{torque}*step(sin(phi - 1))"
    """
    state = lw.steady_state(lw.loads(drive + load))
    assert state.acceleration_max == pytest.approx(torque / inertia, rel=1e-8)
    assert state.acceleration_min == pytest.approx(-torque / inertia, rel=1e-8)


# Half widths of blows [rad] told by a cosine: its rounding leaves their place known to 1e-16 over the width.
@pytest.mark.parametrize("width", [1e-3, 3e-4, 1e-4, 3e-5, 1e-5])
@pytest.mark.parametrize("stiffness", [1.0, 10.0, 100.0, 1000.0])
def test_a_short_blow_begins_with_torque_over_inertia(stiffness: float, width: float) -> None:
    torque, inertia = 40.0, 0.2
    drive = STEEP.replace("2000", str(2000 * stiffness)).partition("[mechanism.sliders")[0]
    for at in (1.0, 4.0):
        load = f"""[loads.blow]
        kind = "formula"
        on = "A"
        torque = "where(cos(phi - {at}) > 1 - 0.5*{width}^2, {torque}, 0)"
        """
        machine = lw.loads(drive + load)
        assert lw.steady_state(machine).acceleration_max == pytest.approx(torque / inertia, rel=1e-8)
        found = lw.gradient(machine, ["steady_state.acceleration_max"], ["drive.flywheel.inertia"])
        assert found.values[0] == pytest.approx(torque / inertia, rel=1e-8)
        assert found.derivatives[0, 0] == pytest.approx(-torque / inertia**2, rel=1e-7)


@pytest.mark.parametrize("stiffness", [1e5, 1e6, 1e7, 1e8])
def test_beside_a_kink_of_a_steep_drive_torques_balance(stiffness: float) -> None:
    """The motor's torque changes sign under a gearbox with losses: the acceleration changes by half within a
    thousandth of a degree and less."""
    no_load, inertia, lift, efficiency = 12.0, 1.9, 59.0, 0.7
    machine = lw.loads(f"""
    format = 1
    name = "flywheel"
    [drive]
    motor = {{ kind = "dc", speed_no_load = {no_load}, torque_stall = {stiffness} }}
    gearbox = {{ efficiency = {efficiency} }}
    flywheel = {{ inertia = {inertia} }}
    [mechanism.cranks.A]
    radius = 0.2
    [loads]
    lift = {{ kind = "formula", on = "A", torque = "-{lift} * cos(phi)" }}
    """)
    compiled = compile_machine(machine)

    def above(angle: float) -> float:
        return float(compiled.steady(np.array([angle]), 1e-9).speed[0]) - no_load

    near = np.geomspace(1e-9, 1e-2, 15)
    for about in (0.5 * np.pi, 1.5 * np.pi):
        kink = brentq(above, about - 0.1, about + 0.1, xtol=1e-14)
        angles = kink + np.concatenate([-near[::-1], [0.0], near])
        motion = compiled.steady(angles, 1e-9)
        torque = stiffness * (1.0 - motion.speed / no_load)
        torque *= np.where(torque > 0.0, efficiency, 1.0 / efficiency)
        exact = (torque - lift * np.cos(angles)) / inertia
        # Some roundings of the speed, which the motor makes torque of.
        rounding = 1e-15 * stiffness / efficiency / inertia
        assert np.abs(motion.acceleration - exact).max() < rounding + 1e-9 * np.abs(exact).max()


@pytest.mark.parametrize("force", BLOWS)
def test_derivatives_by_place_and_width(force: str) -> None:
    """Central differences, far from kinks; a last stage on the wrong side of a jump cost a 25th."""
    text = PRESS.format(force=force.replace("c*omega/10", "c"))
    for place, width in ((2.0, 0.3), (1.0, 0.3), (4.0, 0.35), (2.0, 0.004)):
        machine = lw.loads(text.format(place=place, width=width))
        found = lw.gradient(machine, ["steady_state.energy_load"])
        for name in ("p", "w", "c"):
            address = f"loads.blow.constants.{name}"
            value = lw.get(machine, address)
            near = {
                n: lw.steady_state(lw.replace(machine, {address: value * (1 + n * 1e-4)}), accuracy=1e-12)
                for n in (-2, -1, 1, 2)
            }
            one, two = ((near[n].energy_load - near[-n].energy_load) / (2e-4 * n * value) for n in (1, 2))
            exact = found.of("steady_state.energy_load")[address]
            assert exact == pytest.approx((4 * one - two) / 3, rel=1e-6, abs=1e-6), (place, width, name)


def test_friction_on_a_crank_pin_leaves_the_kinks_of_others() -> None:
    """Its speed along its circle has no extremes, but p′·p″ is zero everywhere."""
    text = PRESS.format(force="where(phi < p, c, w)").format(place=2.0, width=0.3)
    friction = '[loads.pin]\nkind = "dry"\non = "A"\nforce = 100\n'
    derivatives = [
        lw.gradient(lw.loads(one), ["steady_state.energy_load"]).of("steady_state.energy_load")
        for one in (text, text + friction)
    ]
    # The work of the friction does not depend on the place of the jump; the speed hardly does.
    plain, rubbing = (of["loads.blow.constants.p"] for of in derivatives)
    assert rubbing == pytest.approx(plain, rel=0.1)


@pytest.mark.parametrize("force", BLOWS[::3])
def test_derivatives_of_run_ups(force: str) -> None:
    """Several steps end beside a jump, which is passed once."""
    text = PRESS.format(force=force)
    for place, width in ((2.0, 0.3), (4.0, 0.01)):
        machine = lw.loads(text.format(place=place, width=width))
        found = lw.gradient(machine, ["run_up.time", "run_up.speed_peak"])
        for name in ("p", "w", "c"):
            address = f"loads.blow.constants.{name}"
            value = lw.get(machine, address)
            near = {
                n: _run_up(lw.replace(machine, {address: value * (1 + n * 1e-4)})) for n in (-2, -1, 1, 2)
            }
            one, two = ((near[n] - near[-n]) / (2e-4 * n) for n in (1, 2))
            for result, off in zip(("run_up.time", "run_up.speed_peak"), (4 * one - two) / 3, strict=True):
                exact = found.of(result)[address] * value
                scale = np.abs(found.derivatives[found.responses.index(result)] * found.at).max()
                assert exact == pytest.approx(off, abs=1e-6 * scale), (place, width, name)


def _run_up(machine: lw.Machine) -> np.ndarray:
    up = accurate_run_up(machine, lw.steady_state(machine, accuracy=1e-12), 1e-12)
    return np.array([up.time, up.speed_peak])


PRESS = """format = 1
name = "Press"
mechanism.cranks.A.radius = 0.4
mechanism.sliders.S = {{{{ crank = "A", rod = 1.1 }}}}
bodies.S.mass = 6
[drive]
motor = {{{{ kind = "dc", speed_no_load = 60, torque_stall = 900 }}}}
flywheel.inertia = 2
[loads.friction]
kind = "formula"
on = "S"
force = "-10*v"
[loads.blow]
kind = "formula"
on = "A"
torque = "{force}"
constants = {{{{ p = {{place}}, w = {{width}}, c = -300.0 }}}}
"""


PRESS_WITH_STOP = """format = 1
name = "press with a stop"
[drive]
motor = {{ kind = "dc", speed_no_load = 12.0, torque_stall = 900 }}
flywheel = {{ inertia = 2.0 }}
[mechanism.cranks.A]
radius = 0.1
[mechanism.sliders.B]
crank = "A"
rod = 0.4
offset = {offset}
[bodies.B]
mass = 5
[loads.stop]
kind = "formula"
on = "B"
force = "{force}"
"""


# A stop that damps as it is pressed in (Hunt, Crossley, *J. Appl. Mech.* 42, 1975): the root is of a number
# that rounding takes below zero at half of all ends of steps at the stop.
@pytest.mark.parametrize("stop", np.linspace(0.31, 0.49, 7).tolist())
@pytest.mark.parametrize(
    "force",
    [
        "where(s > {stop}, -20000*(s - {stop})^1.5*(1 + 0.5*v), 0)",
        "-20000*max(0, s - {stop})^1.5*(1 + 0.5*v)",
        "-20000*max(0, s - {stop})^1.5*v^2",
    ],
)
def test_a_stop_with_damping(force: str, stop: float) -> None:
    machine = lw.loads(PRESS_WITH_STOP.format(offset=0, force=force.format(stop=stop)))
    names, entries = ["speed_min", "speed_max"], ["drive.flywheel.inertia", "mechanism.cranks.A.radius"]
    found = lw.gradient(machine, [f"steady_state.{name}" for name in names], entries)
    for at, entry in enumerate(entries):
        value, step = lw.get(machine, entry), 1e-4

        def around(n: int, entry: str = entry, value: float = value, step: float = step) -> np.ndarray:
            state = lw.steady_state(lw.replace(machine, {entry: value * (1 + n * step)}), accuracy=1e-12)
            return np.array([getattr(state, name) for name in names])

        once, twice = ((around(n) - around(-n)) / (2 * n * step) for n in (1, 2))
        sizes = np.abs(found.values) + np.abs(found.derivatives[:, at] * value)
        assert (np.abs((4 * once - twice) / 3 - found.derivatives[:, at] * value) < 1e-7 * sizes).all()


def test_a_jump_may_be_made_of_kinks() -> None:
    """The sign of the speed as v/|v|: at the rest it is nothing by nothing."""
    written = ("-50*sign(v)", "-50*v/abs(v)", "-50*max(0, v)/v + 50*max(0, -v)/(-v)")
    states = [
        lw.steady_state(lw.loads(PRESS_WITH_STOP.format(offset=0.03, force=force))) for force in written
    ]
    for name in ("speed_min", "speed_max", "acceleration_min", "acceleration_max"):
        values = [getattr(state, name) for state in states]
        assert values == pytest.approx([values[0]] * len(values), rel=1e-8), name
