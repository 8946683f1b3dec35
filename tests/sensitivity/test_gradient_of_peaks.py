"""Derivatives of extremes where inertia changes fast over the angle: the peaks are narrow there."""

from __future__ import annotations

import numpy as np
import pytest
from found_machines import found_machine

import linkwright as lw

# A heavy slider on a light crank: between dead centres inertia grows ninefold or more within a few degrees.
FILE = """format = 1
name = "Heavy slider"
drive.motor = {{ kind = "dc", speed_no_load = 33, torque_stall = 577, inertia = 0.007 }}
mechanism.cranks.A.radius = 0.31
mechanism.sliders.S = {{ crank = "A", rod = 1.0, offset = {offset}, angle = 1.57 }}
bodies.A.mass = 32
bodies.S.mass = {mass}
loads.drag = {{ kind = "viscous", on = "A", damping = 1 }}
"""

NUMBERS = (
    "speed_min", "speed_max", "unevenness", "torque_motor_min", "torque_motor_max",
    "acceleration_min", "acceleration_max",
)  # fmt: skip


@pytest.mark.parametrize("offset", [0.0, 0.0155])
@pytest.mark.parametrize("mass", [50.0, 267.0])
def test_a_slider_that_is_turned_about_the_crank_does_the_same_later(offset: float, mass: float) -> None:
    """Drive and drag know of no angle: by that of the slider no extreme has a derivative."""
    machine = lw.loads(FILE.format(offset=offset, mass=mass))
    found = lw.gradient(
        machine, [f"steady_state.{name}" for name in NUMBERS], variables=["mechanism.sliders.S.angle"]
    )
    assert not found.ties
    # Angles of peaks of the acceleration are known to rounding of it over its bend: its derivative less well.
    tolerance = np.where(["acceleration" in name for name in NUMBERS], 1e-8, 1e-9)
    assert (np.abs(found.derivatives[:, 0]) <= tolerance * np.abs(found.values)).all(), found.derivatives


# A heavy rod behind a motor by table, whose largest acceleration lies just behind the start of a step.
HEAVY_ROD = """format = 1
name = "Heavy rod"
drive.motor = { kind = "table", speed = [0, 3.6, 7.2, 10.9], torque = [260, 326, 130, -260] }
mechanism.cranks.A.radius = 0.52
mechanism.sliders.S = { crank = "A", rod = 2, angle = 0.3 }
bodies.A.mass = 0.3
bodies.S.mass = 240
bodies."S.rod".mass = 66
"""


def test_a_peak_beside_the_end_of_a_step_does_the_same_later() -> None:
    names = [f"steady_state.acceleration_{of}" for of in ("min", "max")]
    found = lw.gradient(lw.loads(HEAVY_ROD), names, variables=["mechanism.sliders.S.angle"])
    assert not found.ties
    assert (np.abs(found.derivatives[:, 0]) <= 1e-8 * np.abs(found.values)).all(), found.derivatives


# Cranks of one shaft, a motor that is steep against the inertia, and a gearbox: where the torque of the motor
# changes sign the acceleration has a corner, and a layer behind it.
STEEP = """format = 1
name = "Steep drive"
[drive]
gearbox = { ratio = 40, efficiency = 0.9 }
[drive.motor]
kind = "table"
speed = [0, 3.7898, 7.5796, 11.3694]
torque = [5.48966, 6.86207, 2.74483, -5.48966]
inertia = 0.0130795
[mechanism]
points.P0.y = -0.255808
cranks.A = { radius = 0.126781, phase = -0.50317 }
cranks.A2 = { radius = 0.167254, phase = 2.654649 }
sliders.S1 = { crank = "A2", rod = 0.98939, offset = -0.046474 }
sliders.S2 = { crank = "A2", rod = 0.51957, offset = -0.042423 }
slotted_levers.L0 = { pin = "A", pivot = "P0", length = 0.271895 }
[bodies]
A.mass = 0.30318
L0.mass = 15.76354
S1.mass = 44.81016
"S1.rod".mass = 1.074066
"S2.rod".mass = 9.846909
[loads]
gravity = { kind = "gravity" }
"""

# An induction motor whose slip is next to nothing: the torque takes either sign, the speed changes by 2e-7.
STIFF = """format = 1
name = "Stiff motor"
[drive.motor]
kind = "induction"
speed_synchronous = 15.68
speed_rated = 15.6
torque_rated = 1076
torque_breakdown = 3750
inertia = 0.015
[drive.gearbox]
ratio = 40
efficiency = 0.7
[mechanism]
cranks.A = { radius = 0.044, phase = -1.36 }
sliders.S0 = { crank = "A", rod = 0.24, offset = -0.022 }
[bodies]
A = { mass = 75, inertia = 12 }
S0.mass = 1.46
[loads]
force = { kind = "force", on = "A", force = 18, direction = 1.01 }
drag = { kind = "viscous", on = "A", damping = 9.4 }
"""


# What is known of the sum. Behind the steep drive: rounding of the acceleration, 3e-16 of its parts that
# balance each other, over the readings beside it. Of the stiff motor: the speed is read at 3 % of a step
# from its peak, where it has changed by 1e-9 of itself, and rounding is 1e-7 of that.
@pytest.mark.parametrize(("text", "known"), [(STEEP, 5e-8), (STIFF, 2e-6)])
def test_a_shaft_whose_angle_is_counted_from_elsewhere_does_the_same(text: str, known: float) -> None:
    """Where no load knows the crank angle, the derivatives by the phases of all cranks add up to zero."""
    machine = lw.loads(text)
    assert machine.mechanism is not None
    phases = [f"mechanism.cranks.{crank}.phase" for crank in machine.mechanism.cranks]
    names = [f"steady_state.{name}" for name in (*NUMBERS, "power_motor_max")]
    # Rounding of the speed is acceleration: where the motor is stiff it has no known peaks.
    if text == STIFF:
        names = [name for name in names if "acceleration" not in name]
    by_all, by_phases = lw.gradient(machine, names), lw.gradient(machine, names, variables=phases)
    sizes = np.abs(by_all.derivatives * by_all.at).max(axis=1)
    sums = by_phases.derivatives.sum(axis=1)
    assert (np.abs(sums) <= known * sizes).all(), dict(zip(names, sums / sizes, strict=True))


# A motor by table that comes near rest in each revolution: its acceleration has a corner at the knot that it
# passes at once.
ALMOST_AT_REST = """format = 1
name = "Almost at rest"
[drive]
gearbox.ratio = 40
[drive.motor]
kind = "table"
speed = [0, 36.1858, 72.3716, 108.5574]
torque = [4.664836, 5.831045, 2.332418, -4.664836]
[mechanism]
points.P0.y = -1.14213
cranks.A = { radius = 0.502916, phase = -0.641242 }
slotted_levers.L0 = { pin = "A", pivot = "P0", length = 1.167551 }
[bodies]
A.mass = 3.097806
L0.mass = 2.778336
[loads]
l0 = { kind = "formula", on = "A", torque = "-736.823*(0.3 + sin(phi)^2)*tanh(omega)" }
"""


@pytest.mark.parametrize("address", ["drive.gearbox.ratio", "bodies.L0.mass"])
def test_a_peak_at_a_corner_goes_with_the_corner(address: str) -> None:
    machine, step = lw.loads(ALMOST_AT_REST), 2e-4
    found = lw.gradient(machine, ["steady_state.acceleration_max"], variables=[address])
    at = lw.get(machine, address)

    def peak(share: float) -> float:
        return lw.steady_state(
            lw.replace(machine, {address: at * (1 + share)}), accuracy=1e-11
        ).acceleration_max

    once, twice = ((peak(n * step) - peak(-n * step)) / (2 * n * step * at) for n in (1, 2))
    # By the fourth power of the step, and by rounding over it.
    assert abs(found.derivatives[0, 0] - (4 * once - twice) / 3) < 1e-6 * abs(found.derivatives[0, 0])


def test_rounding_of_a_steep_drive_does_not_place_a_peak() -> None:
    """Nothing but the crank's own phase says where it is: no extreme has a derivative by it."""
    found = lw.gradient(
        found_machine("light_crank_of_steep_motor"),
        ["steady_state.acceleration_min"],
        variables=["mechanism.cranks.A.phase"],
    )
    # ε″ = 950 at the peak, whose angle is known to 1e-9; by differences of readings it is to 1e-8.
    assert abs(found.derivatives[0, 0]) < 1e-6 * abs(found.values[0]), found.derivatives


@pytest.mark.parametrize("name", ["fan_by_formula", "motor_from_own_catalogue"])
def test_a_jump_at_the_start_of_the_revolution_moves_as_any_other(name: str) -> None:
    """The force of the slider jumps at dead centre, at 0 deg: there the acceleration has its maximum."""
    machine = lw.read(name)
    slider = next(iter(machine.mechanism.sliders))
    entries = [f"mechanism.sliders.{slider}.{entry}" for entry in ("offset", "angle", "rod")]
    entries += ["mechanism.cranks.A.phase", "mechanism.cranks.A.radius"]
    extremes = [f"{of}_{end}" for of in ("speed", "acceleration") for end in ("min", "max")]
    names = [*extremes, "dynamism", "unevenness", "motion_coefficient"]
    found = lw.gradient(machine, [f"steady_state.{name}" for name in names], entries)
    step = 1e-5
    for entry, column in zip(entries, found.derivatives.T, strict=True):
        at = lw.get(machine, entry)
        ahead, behind = (
            lw.steady_state(lw.replace(machine, {entry: at + side * step}), accuracy=1e-12)
            for side in (1, -1)
        )
        wanted = [(getattr(ahead, name) - getattr(behind, name)) / (2 * step) for name in names]
        # A difference is off by 1e-12 of the number over the step, and by the square of the step.
        room = 1e-6 * np.maximum(np.abs(found.values), np.abs(wanted))
        assert (np.abs(column - wanted) <= room).all(), entry
