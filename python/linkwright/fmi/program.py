"""The numbers and the structure of what an FMU has: mechanism and drive, rigid or elastic.

The numbers are those of the program of the mechanism, and behind them those of the driveline.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np

from linkwright.drive.load_checks import require_half_turns
from linkwright.drive.model.motor import ConstantSpeedMotor
from linkwright.drive.reduction import NO_INERTIA
from linkwright.drive.study import has_mass
from linkwright.driveline.chain import Chain, listed
from linkwright.driveline.in_time import ready_in_time
from linkwright.driveline.study import has_elastic_drive
from linkwright.fmi.core import machine_data
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError, SteadyStateError
from linkwright.linkages.closure import require_closed
from linkwright.linkages.law_jumps import require_finite_accelerations
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine, compile_machine
from linkwright.torsion.model.drive_train import brake_disc

_CONSTANT_SPEED = (
    "drive.motor.kind: found constant_speed, a motor that keeps its speed under any load; an FMU computes "
    "the speed: give a motor whose torque follows its speed, such as induction or dc"
)
_LOCKS = (
    "drive.gearbox.reverse: found 0, a self-locking gearbox, which holds the load while the motor is off; an "
    "FMU has a motor that can be switched: give the factor of a gearbox that is not self-locking"
)
_NO_MASS = (
    "the machine has no masses, so that its motion in time is not determined; give its bodies or its drive "
    "their inertia"
)
_AXES = (
    "the machine is moved by servo axes, linear drivers or cylinders; an FMU has a crank whose speed follows "
    "from its motor: give a crank and a drive, or export the laws of the axes by linkwright law"
)
_ROD_STRING = (
    "rod_string: an FMU has no rod string, whose load depends on the whole stroke; export the unit without "
    "it and apply the load by the input external_torque"
)


class Program:
    """A machine in the core's terms.

    Parameters
    ----------
    machine : Machine
        The machine.
    rigid : bool
        Whether an elastic driveline is taken as rigid.
    """

    def __init__(self, machine: Machine, *, rigid: bool) -> None:
        self.machine = machine
        self.chain: Chain | None = None
        if not rigid and has_elastic_drive(machine):
            self.compiled, self.chain, _ = ready_in_time(machine)
        else:
            self.compiled = compile_machine(machine)

    @cached_property
    def numbers(self) -> Floats:
        """All numbers, of mechanism and drive, then of the driveline."""
        behind = [] if self.chain is None else [np.asarray(listed(self.chain), dtype=np.float64)]
        return np.concatenate([self.compiled.one, *behind])

    @cached_property
    def form(self) -> tuple[Any, ...]:
        """What of the driveline is not its numbers."""
        if self.chain is None:
            return ()
        links = self.chain.links
        torques = ([(each.mass, each.kind) for each in links[name]] for name in ("drivers", "loads"))
        ends = (links[end].tolist() for end in ("first", "second"))
        curves = [None if curve is None else len(curve[0]) for curve in links["curves"]]
        return (*torques, *ends, curves, self.chain.stations, self.chain.shafts)

    def has_structure_of(self, other: Program) -> bool:
        """Whether nothing but numbers differs from another program."""
        if self.form != other.form or self.numbers.shape != other.numbers.shape:
            return False
        return machine_data(self.compiled, numbers=other.compiled.one).data == other.structure

    @cached_property
    def structure(self) -> bytes:
        """The mechanism with its numbers as data."""
        return machine_data(self.compiled).data

    @property
    def brake_mass(self) -> int | None:
        """The mass of an elastic driveline on which the brake acts; None for the crank."""
        drive = self.machine.drive
        if self.chain is None or drive is None or drive.brake is None:
            return None
        return int(self.chain.mass[self.chain.stations.index(brake_disc(drive))])


def program_of(machine: Machine, angle: float, *, rigid: bool) -> Program:
    """The program of a machine whose motion in time is determined.

    `angle`: of the crank at the start [rad].
    """
    if machine.rod_string is not None:
        raise InputError(_ROD_STRING)
    parts = machine.mechanism
    if machine.axes or (not parts.cranks and (parts.linear_drivers or parts.cylinders)):
        raise InputError(_AXES)
    drive = machine.drive
    if drive is not None and isinstance(drive.motor, ConstantSpeedMotor):
        raise InputError(_CONSTANT_SPEED)
    if drive is not None and drive.gearbox.locks:
        raise InputError(_LOCKS)
    program = Program(machine, rigid=rigid)
    if program.chain is None:
        _require_motion(machine, program.compiled, angle)
    return program


def _require_motion(machine: Machine, compiled: CompiledMachine, angle: float) -> None:
    """Raise if a rigid drive has no determined motion from a crank angle."""
    if not has_mass(machine):
        raise InputError(_NO_MASS)
    require_half_turns(compiled, machine)
    require_finite_accelerations(machine)
    at = np.array([angle])
    require_closed(compiled, machine, at)
    if not float(compiled.reductions(at).inertia[0]) > 0:
        raise SteadyStateError(NO_INERTIA)
