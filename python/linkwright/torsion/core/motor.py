"""Torque of a motor over its speed, for a train that moves in time."""

from __future__ import annotations

import numpy as np

from linkwright.drive.model.drive import Drive
from linkwright.drive.model.motor import ConstantTorqueMotor, DcMotor, InductionMotor, TableMotor
from linkwright.kernel.core.curve import Curve, smooth, straight
from linkwright.linkages.model.element import Crank
from linkwright.linkages.model.mechanism import Mechanism
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine

# Points up to twice the synchronous speed: a hundred of them in the narrowest breakdown slip, so that cubics
# between them err by less than 1e-6.
_POINTS = 4001


def motor_curve(motor: InductionMotor | DcMotor | TableMotor | ConstantTorqueMotor) -> Curve:
    """Torque of a motor over its speed.

    Torque [N m] over speed [rad/s]. That of an induction motor is held below rest and beyond twice its
    synchronous speed.
    """
    match motor:
        case ConstantTorqueMotor():
            return straight([0.0], [motor.torque])
        case DcMotor(speed_no_load=no_load, torque_stall=stall):
            assert stall is not None
            return straight([0.0, no_load], [stall, 0.0], beyond="straight")
        case TableMotor():
            return straight(motor.speed, motor.torque)
    assert motor.speed_synchronous is not None
    speeds = np.linspace(0.0, 2 * motor.speed_synchronous, _POINTS)
    # The torque is the core's own, that of a machine with nothing but this motor.
    bare = Machine(
        format=1,
        name="motor",
        drive=Drive(motor=motor),
        mechanism=Mechanism(cranks={"A": Crank(radius=1.0)}),
    )
    torque = compile_machine(bare).motor_torques(speeds)[0]
    return smooth(speeds, torque, np.gradient(torque, speeds, edge_order=2), beyond="held")
