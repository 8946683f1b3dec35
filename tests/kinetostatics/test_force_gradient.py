"""Derivatives of the largest forces against extrapolated differences of the same analysis, and laws."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from sizes import cases, generator
from zoo import ZOO, animal

import linkwright as lw
from linkwright import FindingError, LinkwrightError
from linkwright.machine import exchanged

# Share of an entry by which it is varied: rounding leaves 1e-13 of a force over it, the differences h⁴.
_STEP = 2e-4

# What the differences themselves are good for, as a share of the largest derivative of a response.
_TOLERANCE = 1e-7

_DRIVES = (
    '[drive]\nspeed = "12 rad/s"\n',
    '[drive]\nmotor = { kind = "dc", speed_no_load = 30, torque_stall = 60, inertia = 0.02 }\n'
    "gearbox = { ratio = 2, efficiency = 0.9 }\nflywheel = { inertia = 5 }\n",
)


_FOUR_BAR = """
format = 1
name = "four-bar"
drive = { speed = 12 }
mechanism.cranks.A = { radius = 0.1 }
mechanism.points.D = { x = 0.4, y = 0.05 }
mechanism.rockers.R = { crank = "A", pivot = "D", coupler = 0.35, rocker = 0.25 }
mechanism.rigid_points.K = { link = "R.coupler", along = 0.2, across = 0.1 }
[bodies]
A = { mass = 2, inertia = 0.02, along = 0.03, across = 0.01 }
"R.coupler" = { mass = 1, inertia = 0.01, along = 0.1, across = 0.05 }
"R.rocker" = { mass_per_length = 6 }
[loads]
gravity = { kind = "gravity" }
pull = { kind = "force", on = "K", force = 40, direction = "75 deg" }
spring = { kind = "spring", between = ["O", "K"], stiffness = 300, free_length = 0.2, preload = 5 }
brake = { kind = "dry", on = "R.rocker", torque = 2 }
oil = { kind = "viscous", on = "R.coupler", damping_torsional = 0.4 }
"""


def _varied(machine: lw.Machine, rng: np.random.Generator) -> lw.Machine:
    """A machine whose sizes, masses and loads differ by some per cent."""
    firm = ("drive.speed", ".sections.", ".size", ".size_other", ".cycle", ".angle.", ".position.")
    # An efficiency of 1 is the largest.
    firm += (".efficiency",)
    entries = {
        name: value * (1 + 0.03 * rng.uniform(-1, 1))
        for name, value in lw.addresses(machine).items()
        if value and not any(part in name for part in firm)
    }
    return lw.replace(machine, entries)


def _peaks(machine: lw.Machine) -> tuple[dict[str, float], dict[str, int]]:
    """Largest forces, and at which of the angles they are."""
    motor = machine.drive is not None and machine.drive.motor is not None
    motion = lw.steady_state(machine, accuracy=1e-13) if motor else None
    found = lw.forces(machine, motion, contributions=False)
    curves = {"torque_drive_max": found.torque_drive, "shaking_force_max": np.hypot(*found.shaking_force.T)}
    curves |= {f"reaction_max.{name}": pair.size for name, pair in found.pairs.items()}
    places = {name: int(np.nanargmax(np.abs(curve))) for name, curve in curves.items()}
    return {name: float(curve[places[name]]) for name, curve in curves.items()}, places


def _check(machine: lw.Machine, every: int) -> int:
    """Compare derivatives with differences; how many were compared."""
    found = lw.gradient(machine, ["forces"])
    _, places = _peaks(machine)
    scales = np.nanmax(np.abs(found.derivatives * found.at), axis=1)
    compared = 0
    for at in np.flatnonzero(found.at)[::every]:
        address, value = found.variables[at], found.at[at]
        try:
            near = [_peaks(exchanged(machine, {address: value * (1 + k * _STEP)})) for k in (-2, -1, 1, 2)]
        except LinkwrightError:
            continue
        for row, response in enumerate(found.responses):
            name = response.partition(".")[2]
            # A peak that goes to another angle beside has no derivative between.
            if response in found.ties or any(at_peak[name] != places[name] for _, at_peak in near):
                continue
            low, below, above, high = (peaks[name] for peaks, _ in near)
            difference = (8 * (above - below) - (high - low)) / (12 * _STEP)
            exact = found.derivatives[row, at] * value
            assert abs(exact - difference) <= _TOLERANCE * scales[row], (address, response)
            compared += 1
    return compared


@pytest.mark.parametrize("name", ZOO)
def test_derivatives_are_those_of_the_forces(name: str) -> None:
    """On random machines of every kind of pair and load, at constant speed and behind a motor."""
    compared = 0
    for case in range(cases(2, 20)):
        rng = generator(case, len(name))
        machine = animal(name, _DRIVES[case % 2])
        try:
            lw.forces(_varied(machine, rng))
            machine = _varied(machine, generator(case, len(name)))
        except LinkwrightError:
            # Redundant bars fit with their own lengths alone.
            if not name.startswith("bars"):
                continue
        compared += _check(machine, cases(6, 1))
    assert compared


@pytest.mark.parametrize(
    "path",
    [
        "machines/roller_two_carts.toml",
        "examples/fan_by_formula/machine.toml",
        "examples/press_with_flywheel/machine.toml",
    ],
)
def test_installations(path: str) -> None:
    """Dry friction, an induction motor, a formula: entries with a derivative have that of the analysis."""
    assert _check(lw.read(path), cases(5, 1))


def test_masses_and_loads_scale() -> None:
    """Forces at a given speed are homogeneous of degree one in masses, inertias and loads (Euler)."""
    found = lw.gradient(lw.loads(_FOUR_BAR), ["forces"])
    grows = [unit.startswith(("kg", "N")) for unit in found.variable_units]
    sums = (found.derivatives * found.at)[:, grows].sum(axis=1)
    assert sums == pytest.approx(found.values, rel=1e-12)


def test_a_peak_on_a_kink_has_no_derivative_by_what_moves_it() -> None:
    """The rod presses most at the dead centre, where the dry friction of the cart turns."""
    found = lw.gradient(lw.read("machines/roller_one_cart.toml"), ["forces.reaction_max.A1"])
    assert "mechanism.cranks.A1.phase" in found.ties["forces.reaction_max.A1"]
    told = found.to_dict()["sensitivity"]["forces.reaction_max.A1"]
    assert "mechanism.cranks.A1.phase" not in told
    assert np.isfinite(list(told.values())).all()
    assert np.isfinite(told["mechanism.cranks.A1.radius"])


def test_losses_that_begin_at_an_efficiency_of_one_have_a_derivative() -> None:
    """The torque of the motor changes sign: derivatives by the efficiency leap there, where no kink is.

    Against differences of fifth order to one side, as losses begin at 1; without an end of a step at the
    leap, forces are off by up to 4e-5.
    """
    text = Path("machines/roller_one_cart.toml").read_text(encoding="utf-8")
    text = text.replace("efficiency = 0.9", "efficiency = 1.0").replace('reverse = "same"', "")
    machine, address, h = lw.loads(text), "drive.gearbox.efficiency", 1e-4
    state = lw.steady_state(machine)
    assert state.torque_motor_min < 0.0 < state.torque_motor_max
    found = lw.gradient(machine, ["forces"], [address])
    peaks = [_peaks(lw.replace(machine, {address: 1.0 - k * h}))[0] for k in range(6)]
    weights = (137 / 60, -5.0, 5.0, -10 / 3, 5 / 4, -1 / 5)
    for row, response in enumerate(found.responses):
        name = response.partition(".")[2]
        difference = sum(w * peak[name] for w, peak in zip(weights, peaks, strict=True)) / h
        size = abs(difference) + abs(found.values[row])
        assert abs(found.derivatives[row, 0] - difference) <= 1e-8 * size, response


_IDLE = """
format = 1
name = "idle"
[drive.motor]
kind = "induction"
speed_synchronous = 4.126
speed_rated = 4.003
torque_rated = 32.6
torque_breakdown = 107.6
[drive.gearbox]
ratio = 3
efficiency = 0.7
[mechanism]
cranks.A.radius = 0.3
[bodies]
A = { mass = 0.2, inertia = 0.005 }
"""


def test_a_machine_without_load_has_no_driving_torque() -> None:
    """Its motor runs at the synchronous speed: what rounding of the speed leaves of the torque is nothing."""
    machine = lw.loads(_IDLE)
    found = lw.gradient(machine, ["forces"])
    assert "forces.shaking_force_max" in found.responses
    assert "forces.torque_drive_max" not in found.responses
    with pytest.raises(FindingError, match="zero within rounding error"):
        lw.gradient(machine, ["forces.torque_drive_max"])
    # A load above rounding has one.
    loaded = lw.loads(_IDLE + '[loads]\nrub = { kind = "formula", on = "A", torque = "-1e-6" }')
    of = lw.gradient(loaded, ["forces.torque_drive_max"], ["drive.gearbox.ratio"])
    assert of.values == pytest.approx([1e-6], rel=1e-6)


def test_forces_of_nothing_have_no_derivative() -> None:
    machine = lw.read("examples/press_motion/machine.toml")
    with pytest.raises(FindingError, match="zero within rounding error"):
        lw.gradient(machine, ["forces.torque_drive_max"])


# The crank feels a wheel at a third of its speed alike in every revolution, the frame after three of them: at
# 720° its mass adds to the force of the slider, at 0° and 360° it is aside.
_THIRD = """
format = 1
name = "mass on a wheel at a third of the speed"
drive.motor = { kind = "dc", speed_no_load = 30, torque_stall = 60, inertia = 0.02 }
drive.flywheel = { inertia = 0.5 }
mechanism.cranks.A = { radius = 0.1 }
mechanism.points.P = { x = 1.0 }
mechanism.gears.G = { pivot = "P", meshes = "A", size = 60.0, size_other = 20.0, phase = "240 deg" }
mechanism.rigid_points.K = { link = "G", along = 0.2 }
mechanism.sliders.S = { crank = "A", rod = 0.4 }
bodies.K = { mass = 1.0 }
bodies.S = { mass = 3.0, axial = 0.2 }
loads.oil = { kind = "viscous", on = "S", damping = 20.0 }
"""


def test_forces_that_repeat_after_several_cycles_of_the_speed() -> None:
    """The largest force and its derivatives are those of the whole cycle, as in `forces`."""
    machine = lw.loads(_THIRD)
    assert lw.steady_state(machine).turns == 1
    shaking = np.hypot(*lw.forces(machine).shaking_force.T)
    assert shaking[:361].max() < 0.97 * shaking.max()
    address = "bodies.K.mass"
    found = lw.gradient(machine, ["forces"], [address])
    row = found.responses.index("forces.shaking_force_max")
    assert found.values[row] == pytest.approx(shaking.max(), rel=1e-8)

    def peak(mass: float) -> float:
        return float(np.hypot(*lw.forces(lw.replace(machine, {address: mass})).shaking_force.T).max())

    assert found.derivatives[row, 0] == pytest.approx((peak(1.001) - peak(0.999)) / 0.002, rel=1e-5)


def test_orders_of_a_cycle_of_three_revolutions() -> None:
    """A mass at a third of the speed is order 1/3, m r (ω/3)², beside the whole orders of the slider."""
    machine = lw.loads(_THIRD)
    found, alone = (
        lw.shaking_orders(each, speed=10.0, highest=4)
        for each in (machine, lw.replace(machine, {"bodies.K.mass": 1e-12}))
    )
    np.testing.assert_array_equal(found.order, np.arange(1, 13) / 3)
    assert found.force_max[0] == pytest.approx(0.2 * (10.0 / 3) ** 2, rel=1e-9)
    np.testing.assert_allclose(found.force_max[1:], alone.force_max[1:], atol=1e-9)
    assert list(found.to_dict()["orders"])[:3] == ["0.333333", "0.666667", "1"]
    forces = lw.forces(machine, speed=10.0)
    again = lw.shaking_orders(machine, speed=10.0, highest=30).force
    angles = again.order[:, None] * forces.crank_angle
    series = again.cosine.T @ np.cos(angles) + again.sine.T @ np.sin(angles)
    np.testing.assert_allclose(series.T, forces.contributions["inertia"].shaking_force, atol=1e-7)
