"""Drivelines in motion: the rigid driveline as their limit, energy, kinks of loads, motors."""

from __future__ import annotations

import numpy as np
import pytest

import linkwright as lw
from linkwright import InputError, MachineError, torsion_transient
from linkwright.kernel.core.curve import straight
from linkwright.torsion import TrainTransient
from linkwright.torsion.in_time.moving_drive import _lossy

CART = """
format = 1
name = "Cart on an elastic driveline"
[mechanism.cranks.A]
radius = 0.2
[mechanism.sliders.cart]
crank = "A"
rod = 0.8
[bodies]
cart = { mass = 300 }
"cart.rod" = { mass = 40 }
[drive.motor]
kind = "dc"
inertia = 0.4
speed_no_load = 110
torque_stall = 900
[drive.gearbox]
ratio = 9.8
inertia = 0.3
efficiency = 0.92
"""
LOADS = """
[loads]
rolling = { kind = "dry", on = "cart", force = 900 }
drag = { kind = "viscous", on = "cart", damping = 150 }
"""
SHAFT = "[drive.motor_shaft]\nstiffness = {k}\ndamping = {c}\n"


def manoeuvre(**entries: object) -> TrainTransient:
    return TrainTransient.model_validate(entries)


@pytest.mark.parametrize(
    "loads", [LOADS, '[loads]\nlaw = { kind = "formula", on = "cart", force = "-80*v-300*tanh(9*v)" }\n']
)
def test_stiff_shaft_moves_as_the_rigid_drive(loads: str) -> None:
    """Run-up from rest with J(φ), gear losses and dead centres: as `transient` has it without shafts."""
    rigid = lw.transient(lw.loads(CART + loads), duration=1.5, accuracy=1e-10)
    elastic = torsion_transient(
        lw.loads(CART + loads + SHAFT.format(k=4e6, c=300.0)), manoeuvre(duration=1.5, sample_time=1e-3)
    )
    crank = elastic.discs.index("crank")
    angle, speed = rigid.at(elastic.time)
    # Dry friction sets in over a thousandth of the speed, its kinks are rounded, the shaft gives way a bit.
    assert elastic.speed[crank] == pytest.approx(speed, abs=2e-3 * speed.max())
    assert elastic.angle[crank] == pytest.approx(angle, abs=3e-3)
    assert abs(elastic.energy_error) < 1e-6
    # The speed swings with the mechanism: a mean inertia alone would not do.
    late = elastic.time > 1.2
    assert np.ptp(elastic.speed[crank, late]) > 0.05 * speed.max()


def test_soft_shaft_swings() -> None:
    """The shaft carries what the mechanism asks for, with the ratio; its mean is the motor's torque."""
    machine = lw.loads(CART + LOADS + SHAFT.format(k=4e3, c=5.0))
    found = torsion_transient(machine, manoeuvre(duration=6.0, speed=100.0))
    late = found.time > 3.0
    # Torque of the motor at its speed; the gearbox takes its share from it, in either direction.
    motor = 900 * (1 - found.speed[0, late] / 110)
    driving = np.where(motor > 0, 0.92 * motor, motor / 0.92)
    left = np.trapezoid(driving - found.torque[0, late], found.time[late])
    # What is left over speeds up the rotor of 0.4 kg m²; trapezoids of half a millisecond.
    assert left == pytest.approx(0.4 * (found.speed[0, late][-1] - found.speed[0, late][0]), abs=0.01)
    assert np.ptp(found.torque[0, late]) > 5 * driving.mean()
    # The work of the loads is that of the motor, less losses and what the energy gained.
    assert abs(found.energy_error) < 1e-7
    assert found.work["dry"] < 0
    assert found.work["viscous"] < 0


def test_motor_is_switched_off() -> None:
    event = {"kind": "motor_off", "time": 1.0, "motor": "motor"}
    machine = lw.loads(CART + LOADS + SHAFT.format(k=4e3, c=5.0))
    found = torsion_transient(machine, manoeuvre(duration=9.0, speed=100.0, events=[event]))
    assert found.speed[0, -1] < 1e-2
    braked = -found.work["dry"] - found.work["viscous"]
    assert braked > found.work["motor"] > 0


def test_what_a_drive_line_cannot_do_is_told() -> None:
    machine = lw.loads(CART + LOADS + SHAFT.format(k=4e3, c=5.0))
    with pytest.raises(InputError, match="has no manoeuvre"):
        torsion_transient(machine)
    event = {"kind": "load_step", "time": 0.0, "load": "rolling", "factor": 0.0}
    with pytest.raises(MachineError, match=r"train.transient.events.0.load(.|\n)*there is no load"):
        torsion_transient(machine, manoeuvre(duration=1.0, events=[event]))
    held = CART.replace('kind = "dc"', 'kind = "constant_speed"\nspeed = 100').replace(
        "speed_no_load = 110\n", ""
    )
    held = held.replace("torque_stall = 900\n", "")
    with pytest.raises(InputError, match="found constant_speed, expected a motor whose torque follows"):
        torsion_transient(lw.loads(held + SHAFT.format(k=4e3, c=5.0)), manoeuvre(duration=1.0))
    with pytest.raises(InputError, match="is rigid"):
        torsion_transient(lw.loads(CART), manoeuvre(duration=1.0))


def test_gear_losses_by_direction() -> None:
    curve = _lossy(straight([0.0, 10.0, 20.0], [8.0, 2.0, -2.0], beyond="straight"), 0.5, 2.0)
    assert curve.x.tolist() == [0.0, 10.0, 15.0, 20.0]
    assert curve.y.tolist() == [4.0, 1.0, 0.0, -4.0]
    assert (curve.after[1], curve.before[2], curve.after[2]) == pytest.approx((-0.2, -0.2, -0.8))


GAS = """
[loads.gas]
kind = "force_angle"
on = "cart"
cycle = "720 deg"
angle = "0, 40, 90, 200, 360, 540, 660, 720 deg"
force = "-9, -5, -2, 0.4, 0, -0.3, -3, -9 kN"
[loads.brake]
kind = "viscous"
on = "A"
damping_torsional = 60
"""


def test_loads_over_two_revolutions_move_as_the_rigid_drive() -> None:
    text = CART + "[loads]\n" + GAS
    rigid = lw.transient(lw.loads(text), duration=2.0, accuracy=1e-10)
    elastic = torsion_transient(
        lw.loads(text + SHAFT.format(k=4e6, c=300.0)), manoeuvre(duration=2.0, sample_time=1e-3)
    )
    crank = elastic.discs.index("crank")
    angle, speed = rigid.at(elastic.time)
    # More than a cycle, so that both revolutions of it count.
    assert angle[-1] > 5 * np.pi
    # The corners of the table are rounded over a few tenths of a degree, the shaft gives way a bit.
    np.testing.assert_allclose(elastic.angle[crank], angle, atol=3e-3)
    np.testing.assert_allclose(elastic.speed[crank], speed, atol=3e-3 * speed.max())
