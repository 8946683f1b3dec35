r"""The motor's characteristic and the mean load that it works against, both at the motor's shaft.

.. math:: M_\mathrm{load}(\omega_m) = \frac{\bar M_r + \bar c\,\omega + M_r(\omega)}{i\,\eta}, \qquad
    \omega = \omega_m/i
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from linkwright.drive.model.motor import ConstantSpeedMotor, Motor
from linkwright.drive.reduction import Reduction, mean_laws, reduction
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError
from linkwright.kernel.quantities import Label
from linkwright.kernel.result import Result
from linkwright.linkages.whole_cycle import over_known_cycle
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine

# How far beyond the speed without torque the curve goes, as a share of that speed.
_BEYOND = 0.04


@dataclass(frozen=True)
class Characteristic(Result):
    """Torque of a motor over its speed."""

    speed: Annotated[Floats, Label("speed of the motor's shaft", "ω", "rad/s", "From standstill.")]
    torque: Annotated[Floats, Label("torque of the motor", "M", "N m")]
    torque_load: Annotated[
        Floats,
        Label("mean load torque", "M_r,mean", "N m", "Over one revolution, referred to the motor's shaft."),
    ]
    ratio: Annotated[float, Label("motor speed over crank speed", "i", "")]
    speed_no_load: Annotated[float | None, Label("synchronous speed, or speed without load", "ω₀", "rad/s")]
    speed_rated: Annotated[float | None, Label("rated speed", "ω_N", "rad/s")]
    torque_rated: Annotated[float | None, Label("rated torque", "M_N", "N m")]
    speed_breakdown: Annotated[float | None, Label("speed of maximum torque", "ω_k", "rad/s")]
    torque_breakdown: Annotated[float | None, Label("breakdown torque", "M_k", "N m")]


def characteristic(
    machine: Machine, *, reduced: Reduction | None = None, speed_max: float = 0.0, n: int = 800
) -> Characteristic:
    """Torque of the motor, and of the mean load, over the motor's speed.

    `speed_max`: speed of the motor's shaft that the curve must reach [rad/s]. Returns: from standstill to a
    little beyond the speed without load. Raises AssemblyError: the mechanism does not close all round;
    InputError: the machine has no motor, or one that keeps its speed under any load.
    """
    drive = machine.drive
    if drive is None or drive.motor is None or isinstance(drive.motor, ConstantSpeedMotor):
        raise InputError(f"{machine.name}: a characteristic needs a motor whose speed depends on the load")
    reduced = reduced or reduction(machine)
    compiled = compile_machine(machine)
    ratio = drive.gearbox.ratio
    top = max((1 + _BEYOND) * compiled.speed_guess * ratio, speed_max)
    speed = np.linspace(0.0, top, n + 1)
    crank = speed / ratio
    load = reduced.torque_load_mean + reduced.viscous_mean * crank
    load = load + compiled.speed_load(crank) + mean_laws(over_known_cycle(compiled), crank)
    return Characteristic(
        speed=speed,
        torque=compiled.motor_torques(crank).motor,
        torque_load=compiled.motor_torque_for(load),
        ratio=ratio,
        **_points(drive.motor),
    )


def _points(motor: Motor) -> dict[str, float | None]:
    given = ("speed_breakdown", "torque_breakdown", "speed_rated", "torque_rated")
    no_load = motor.speed_without_load if motor.no_load_word else None
    return {"speed_no_load": no_load} | {name: getattr(motor, name, None) for name in given}
