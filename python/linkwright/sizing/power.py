r"""The power that the motor must have at the design speed.

.. math:: P = \bar M_r\,\omega / \eta

Source: paper 1, the step before the choice of the motor.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from linkwright.drive.reduction import mean_laws, mean_over_turn
from linkwright.kernel.errors import InputError
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.linkages.closure import require_full_turn
from linkwright.linkages.whole_cycle import over_whole_cycle
from linkwright.machine.machine import Machine
from linkwright.machine.own_motors import axis_drivers, on_crankshaft
from linkwright.machine.program.compiled import compile_machine


@dataclass(frozen=True)
class RequiredPower(Result):
    """Power at the motor's shaft that the loads take at the design speed."""

    power: Annotated[
        float,
        Label(
            "power that the loads take at the motor's shaft",
            "P",
            "W",
            "Negative if the loads drive the machine.",
        ),
    ]
    torque_load_mean: Annotated[
        float,
        Label(
            "mean load torque",
            "M_r,mean",
            "N m",
            "Over the crank angle at that speed, viscous and speed loads included.",
        ),
    ]
    speed: Annotated[float, Label("design speed of the crank", "ω", "rad/s")]
    efficiency: Annotated[float, Label("efficiency of the gearbox", "η", "")]
    formula: Annotated[str, About("What was computed.")] = "P = M_load_mean · ω / η"
    source: Annotated[str, About("Where it is from.")] = (
        "paper 1, required power before the choice of the motor"
    )


@public
def required_power(machine: Machine) -> RequiredPower:
    r"""Find the power that the loads take at the design speed, at the motor's shaft.

    .. math:: P = \bigl(\bar M_r + \bar B\,\omega + M_\omega(\omega)\bigr)\,\omega / \eta

    Parameters
    ----------
    machine : Machine
        The machine, with ``drive.speed``; a motor is not needed.

    Returns
    -------
    RequiredPower
        The power [W], with what it follows from.

    Raises
    ------
    InputError
        The machine has no design speed.
    AssemblyError
        The mechanism does not close all round.

    Notes
    -----
    The mean is over the crank angle, as if the crank turned evenly. :math:`\bar B` is the mean viscous
    coefficient, :math:`M_\omega` the loads given over speed.

    References
    ----------
    .. [1] Paper 1: P = M_0 ω/(10³ η), in kW.
    """
    drive = machine.drive
    if machine.turning_moment is not None:
        raise InputError(
            f"{machine.name}: a turning-moment diagram has no motor; `linkwright run` sizes its flywheel, "
            "also for another δ: --set turning_moment.unevenness=0.02"
        )
    if machine.axes and set(machine.linkage.drivers()) <= set(axis_drivers(machine)):
        raise InputError(
            f"{machine.name}: its drivers have motors of their own: `linkwright axes FILE --catalogue "
            "motors.csv` chooses them"
        )
    if drive is None or drive.speed is None:
        raise InputError(f'{machine.name}: sizing needs the design speed; add speed = "… rad/s" to [drive]')
    machine = on_crankshaft(machine, has_motor=True)
    compiled = compile_machine(machine, motor=False)
    require_full_turn(compiled, machine)
    compiled = over_whole_cycle(compiled)
    load, viscous = mean_over_turn(compiled)
    torque = load + viscous * drive.speed + float(np.sum(compiled.speed_load(drive.speed)))
    torque += float(mean_laws(compiled, drive.speed)[0])
    efficiency = drive.gearbox.efficiency
    return RequiredPower(torque * drive.speed / efficiency, torque, drive.speed, efficiency)
