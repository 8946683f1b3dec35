"""A machine's description as plan and parameters."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright import _core
from linkwright.kernel.description.plain import arrays
from linkwright.kernel.description.text import join
from linkwright.kernel.errors import ShapeError
from linkwright.machine.machine import Machine
from linkwright.machine.program.drive_line import drive_of
from linkwright.machine.program.loads import Loads, bodies_of
from linkwright.machine.program.mechanism import MechanismProgram
from linkwright.machine.program.settle import Settled

Floats = NDArray[np.float64]


class Translation:
    """What a machine is in the core's terms.

    Parameters
    ----------
    machine : Machine
        The description.
    motor, brake : bool
        Whether the motor is on, and the brake applied.
    """

    def __init__(self, machine: Machine, *, motor: bool, brake: bool) -> None:
        self.program = MechanismProgram(machine.linkage)
        self.program.build()
        self.bodies = bodies_of(machine, self.program)
        self.loads = Loads(machine, self.program).all(brake=brake)
        self.drive = drive_of(machine, self.program, motor=motor)
        columns = _columns(self.program.parameters, self.program.varying, _row_count(machine))
        self.settled = Settled(self.program, columns, self._plan)
        self.settled.run()

    def _plan(self) -> _core.Plan:
        return _core.Plan(
            parameters=len(self.program.parameters),
            ground=self.program.ground,
            elements=self.program.elements,
            bodies=self.bodies,
            loads=self.loads,
            drive=self.drive,
        )


def _row_count(machine: Machine) -> int:
    """How many machines the entries describe, also those without an effect."""
    found = {join(place): array for place, array in arrays(machine)}
    if "mechanism.assembled_at" in found:
        raise ShapeError(
            "mechanism.assembled_at cannot vary from machine to machine in a batch: the places of the joints "
            "are those of one crank angle; compute machines with others one by one"
        )
    shapes = {array.shape for array in found.values()}
    if len(shapes) > 1 or any(len(shape) != 1 or not shape[0] for shape in shapes):
        given = ", ".join(f"{address} {array.shape}" for address, array in found.items())
        raise ShapeError(f"arrays of one length are needed, found shapes {given}")
    return shapes.pop()[0] if shapes else 1


def _columns(parameters: list[Any], varying: list[int], n: int) -> tuple[Floats, NDArray[np.int32], Floats]:
    """First row of all parameters; which vary; their values (k, n)."""
    columns = [np.asarray(parameters[slot], dtype=np.float64) for slot in varying]
    first = list(parameters)
    for slot, column in zip(varying, columns, strict=True):
        first[slot] = column[0]
    values = np.ascontiguousarray(columns) if columns else np.empty((0, n))
    return np.array(first, dtype=np.float64), np.array(varying, dtype=np.int32), values
