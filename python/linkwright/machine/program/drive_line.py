"""Motor, gearbox, and the inertia that turns with the crank, in the core's terms."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from linkwright import _core
from linkwright.drive.model.drive import Drive, Gears
from linkwright.drive.model.motor import (
    ConstantSpeedMotor,
    ConstantTorqueMotor,
    DcMotor,
    InductionMotor,
    TableMotor,
)
from linkwright.kernel.errors import ShapeError
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
    match motor:
        case ConstantTorqueMotor():
            return _core.Motor.Constant(torque=program.slot(motor.torque))
        case DcMotor(torque_max=most) if most is not None:
            return _core.Motor.Table(table=_limited(program, motor))
        case DcMotor(torque_stall=stall, speed_no_load=no_load):
            return _core.Motor.Line(torque=program.slot(stall), inverse_speed=program.slot(1.0 / no_load))
        case InductionMotor():
            return _induction(program, motor)
        case TableMotor():
            return _core.Motor.Table(table=table_of(machine, program, motor.speed, motor.torque))
    # No motor, or one of constant speed: nothing that answers to the load.
    return None


def _limited(program: MechanismProgram, motor: DcMotor) -> _core.Table:
    """A straight characteristic between its ends, constant beyond them. Raises ShapeError: they vary."""
    speeds, torques = zip(*motor.limited(), strict=True)
    if any(np.ndim(value) for value in (*speeds, *torques)):
        raise ShapeError(
            "drive.motor: a characteristic with torque_max cannot vary from machine to machine in a batch; "
            "compute machines with others one by one"
        )
    return program.table(speeds, torques)


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
    match drive.motor:
        case InductionMotor(speed_synchronous=speed) if speed is not None:
            return speed / drive.gearbox.ratio
        case DcMotor(speed_no_load=speed) | ConstantSpeedMotor(speed=speed):
            return speed / drive.gearbox.ratio
        case TableMotor(speed=speeds, torque=torques):
            driving = [speed for speed, torque in zip(speeds, torques, strict=True) if torque > 0]
            return max([*driving, 0.1 * speeds[-1]]) / drive.gearbox.ratio
    return _SPEED_UNKNOWN if drive.speed is None else drive.speed
