"""Motor, gearbox, and the inertia that turns with the crank, in the core's terms."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from linkwright import _core
from linkwright.drive.model.drive import Drive, Gears
from linkwright.drive.model.motor import InductionMotor
from linkwright.machine.machine import Machine
from linkwright.machine.program.loads import table_of
from linkwright.machine.program.mechanism import MechanismProgram

# Crank speed from which steady motion is sought when nothing in the machine suggests one [rad/s].
_SPEED_UNKNOWN = 10.0

# Factor of a self-locking gearbox: of the torque with which the load drives, a hundred-thousandth reaches the
# motor. The speed then exceeds that of zero motor torque by as small a share of the motor's slip.
_LOCKED = 1e5


def drive_of(machine: Machine, program: MechanismProgram, *, motor: bool) -> _core.Drive:
    """The driveline.

    `motor`: whether the motor is on.
    """
    drive = machine.drive or Drive()
    turned_on = _motor(machine, program, drive.motor) if motor else None
    return _core.Drive(
        motor=turned_on,
        ratio=program.slot(drive.gearbox.ratio),
        forward=program.slot(drive.gearbox.efficiency),
        reverse=program.slot(reverse_factor(drive.gearbox)),
        inertia=program.slot(drive_inertia(drive)),
        speed_start=program.slot(speed_guess(drive)),
    )


def _motor(machine: Machine, program: MechanismProgram, motor: Any) -> _core.Motor | None:
    """A described motor has all its entries filled in."""
    if isinstance(motor, InductionMotor):
        return _induction(program, motor)
    line = None if motor is None else motor.polyline()
    if line is None:
        # No motor, or one of constant speed: nothing that answers to the load.
        return None
    speeds, torques, is_endless = line
    if is_endless:
        stall, no_load = torques[0], speeds[-1]
        return _core.Motor.Line(torque=program.slot(stall), inverse_speed=program.slot(1.0 / no_load))
    if len(speeds) == 1:
        return _core.Motor.Constant(torque=program.slot(torques[0]))
    return _core.Motor.Table(table=table_of(machine, program, speeds, torques))


def _induction(program: MechanismProgram, motor: Any) -> _core.Motor:
    """Kloss, and the curve below breakdown."""
    return _core.Motor.Induction(
        inverse_synchronous=program.slot(1.0 / motor.speed_synchronous),
        torque=program.slot(motor.torque_breakdown),
        slip=program.slot(1.0 - motor.speed_breakdown / motor.speed_synchronous),
        resistance=program.slot(motor.resistance_ratio),
        spans=_spans(program, motor),
    )


def _spans(program: MechanismProgram, motor: Any) -> list[_core.Span]:
    """From start over pull-up, if there is one, to breakdown; none for Kloss everywhere."""
    if motor.torque_start is None:
        return []
    knots = [(0.0, motor.torque_start), (motor.speed_breakdown, motor.torque_breakdown)]
    if motor.torque_pull_up is not None:
        knots.insert(1, (motor.speed_pull_up, motor.torque_pull_up))
    return [
        _core.Span(
            x0=program.slot(x0),
            y0=program.slot(y0),
            x1=program.slot(x1),
            y1=program.slot(y1),
            inverse_width=program.slot(1.0 / (x1 - x0)),
            is_level=nth > 0,
        )
        for nth, ((x0, y0), (x1, y1)) in enumerate(pairwise(knots))
    ]


def reverse_factor(gearbox: Gears) -> Any:
    """Factor on motor torque times ratio while the load drives the motor."""
    if gearbox.reverse is None:
        return 1.0 / gearbox.efficiency
    if isinstance(gearbox.reverse, str):
        return gearbox.efficiency
    if np.ndim(gearbox.reverse):
        return np.where(gearbox.reverse == 0, _LOCKED, gearbox.reverse)
    return _LOCKED if gearbox.locks else gearbox.reverse


def drive_inertia(drive: Drive) -> Any:
    """Inertia of all that turns at the motor's speed or the crank's, at the crank [kg m²]."""
    at_motor = (drive.motor.inertia if drive.motor else 0.0) + drive.gearbox.inertia
    at_motor = at_motor + (drive.coupling.inertia if drive.coupling else 0.0)
    at_crank: Any = drive.gearbox.wheel_inertia
    for part in (drive.flywheel, drive.brake):
        if part is not None and part.on == "motor":
            at_motor = at_motor + part.inertia
        elif part is not None:
            at_crank = at_crank + part.inertia
    return at_motor * drive.gearbox.ratio**2 + at_crank


def speed_guess(drive: Drive) -> Any:
    """Crank speed without load, as far as the motor has one; else the design speed [rad/s]."""
    motor = drive.motor
    if motor is not None and motor.speed_without_load is not None:
        return motor.speed_without_load / drive.gearbox.ratio
    line = None if motor is None else motor.polyline()
    if line is not None and len(line[0]) > 1:
        driving = [speed for speed, torque in zip(*line[:2], strict=True) if torque > 0]
        return max([*driving, 0.1 * line[0][-1]]) / drive.gearbox.ratio
    return _SPEED_UNKNOWN if drive.speed is None else drive.speed
