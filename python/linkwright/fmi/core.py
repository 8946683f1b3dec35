"""The machine as data of an FMU, as the core makes it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from linkwright import _core
from linkwright.kernel.arrays import Floats
from linkwright.machine.program.compiled import CompiledMachine
from linkwright.machine.program.core import require


class Settings(NamedTuple):
    """What an FMU starts with."""

    start: tuple[float, float] = (0.0, 0.0)  # crank angle [rad] and speed [rad/s]
    clockwise: bool = False  # whether the motor drives the crank clockwise
    accuracy: float = 1e-8  # relative accuracy of a step, unless the importing tool asks for another


class MachineData(NamedTuple):
    """Content of `resources/machine.lw`."""

    data: bytes
    states: int
    indicators: int  # event indicators


_PLAIN = Settings()

# The value of an entry, and what it moves: a number of the program, a factor, a power.
Parameter = tuple[float, Sequence[tuple[int, float, int]]]


def machine_data(
    compiled: CompiledMachine,
    settings: Settings = _PLAIN,
    parameters: Sequence[Parameter] = (),
    *,
    token: str = "",
    numbers: Floats | None = None,
    driveline: Mapping[str, Any] | None = None,
    brake: int | None = None,
    scales: Sequence[tuple[int, float]] = (),
    ranges: Sequence[tuple[int, float, float]] = (),
) -> MachineData:
    """Plan and numbers of a machine, with what may be changed in them.

    `token`: of the instantiation; `numbers`: others than those of the machine; `driveline`: its masses and
    links, where it is elastic; `brake`: mass on which the brake acts, else the crank; `scales`: value
    references, and factors of what the library has of them; `ranges`: value references, and between which
    numbers they may be set.
    """
    require("fmu_machine")
    made = _core.fmu_machine(
        compiled.plan,
        compiled.one if numbers is None else numbers,
        motor=-1 if settings.clockwise else 1,
        start=settings.start,
        accuracy=settings.accuracy,
        parameters=parameters,
        token=token,
        driveline=driveline,
        brake=brake,
        scales=scales,
        ranges=ranges,
    )
    return MachineData(made.data, made.states, made.event_indicators)
