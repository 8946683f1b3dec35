"""What stands in the way of the analyses of a drive, and the entries that would mend it."""

from __future__ import annotations

from typing import Any

from linkwright.drive.model.motor import ConstantSpeedMotor
from linkwright.drive.steady_state import steady_state
from linkwright.drive.study import has_mass, has_motor
from linkwright.kernel.description.place import join
from linkwright.kernel.errors import LinkwrightError
from linkwright.machine.analysis import Obstacle
from linkwright.machine.machine import Machine

# Entries that make a machine move at all, until its motor is chosen.
_MOTOR = {"drive.motor": {"kind": "constant_speed", "speed": "10 rad/s"}}
MOTORS_OF_TRAIN = "The motors are in [train.motors]: the elastic driveline has their motion."
_BRAKE = {"drive.brake": {"torque": "100 N m"}}
_ELASTIC = {"drive.crankshaft": {"sections": [{"length": "1 m", "diameter": "80 mm"}]}}

# Of a DC motor in place of one that keeps its speed: no-load speed over that speed, and the limit of its
# torque over the root mean square that is needed.
_NO_LOAD, _LIMIT = 1.1, 2.5

# Torque below which a machine without masses needs none: rounding of its motion [N m].
_NO_TORQUE = 1e-9

# Intervals of the revolution for that root mean square.
_INTERVALS = 360


def no_motor(machine: Machine) -> Obstacle | None:
    """A machine without a motor; those of a train with mechanisms do not drive a rigid crankshaft."""
    if has_motor(machine):
        return None
    if machine.has_mounted_mechanisms:
        return Obstacle(MOTORS_OF_TRAIN)
    return Obstacle("The machine has no motor.", "Add a motor", _MOTOR)


def no_mass(machine: Machine) -> Obstacle | None:
    """A machine without masses and loads: a first body goes on a slider, or the moving point built last."""
    if has_mass(machine):
        return None
    places = [*machine.mechanism.sliders, *reversed(machine.linkage.moving_points())]
    entries = {join(("bodies", places[0])): {"mass": "1 kg"}} if places else None
    return Obstacle("No masses and no loads: add a body or a load.", "Add a body" if places else "", entries)


def design_speed(machine: Machine) -> float | None:
    """Speed of the crank at which forces are asked for where no motor makes a motion."""
    return None if has_motor(machine) else machine.design_speed


def no_forces(machine: Machine) -> Obstacle | None:
    """A machine without a speed, or without masses."""
    return (None if design_speed(machine) else no_motor(machine)) or no_mass(machine)


def no_run_up(machine: Machine) -> Obstacle | None:
    """A machine whose motor does not run up."""
    if machine.drive is not None and isinstance(machine.drive.motor, ConstantSpeedMotor):
        entries = _dc_motor(machine)
        mend = "" if entries is None else "Use a DC motor"
        return Obstacle("The motor keeps its speed from the start.", mend, entries)
    return no_motor(machine)


def _dc_motor(machine: Machine) -> dict[str, Any] | None:
    """A DC motor with the needed torque at the speed that a motor keeps; None where none is known."""
    motor = machine.drive.motor if machine.drive is not None else None
    if not isinstance(motor, ConstantSpeedMotor):
        return None
    try:
        needed = steady_state(machine, n=_INTERVALS).torque_motor_rms
    except LinkwrightError:
        # silent: without a steady motion no motor is offered; the findings tell why
        return None
    torque = needed if needed > _NO_TORQUE else 1.0
    stall = torque / (1 - 1 / _NO_LOAD)
    return {
        "drive.motor": {
            "kind": "dc",
            "speed_no_load": f"{_NO_LOAD * float(motor.speed):.6g} rad/s",
            "torque_stall": f"{stall:.6g} N m",
            "torque_max": f"{min(stall, _LIMIT * torque):.6g} N m",
        }
    }


def no_run_down(machine: Machine) -> Obstacle | None:
    """A machine without a brake."""
    if machine.drive is None or machine.drive.brake is None:
        return no_motor(machine) or Obstacle("The driveline has no brake.", "Add a brake", _BRAKE)
    return no_motor(machine)


def no_shaft(machine: Machine) -> Obstacle | None:
    """A machine whose driveline does not twist."""
    if machine.twists:
        return None
    return no_motor(machine) or Obstacle("The driveline is rigid.", "Add an elastic crankshaft", _ELASTIC)
