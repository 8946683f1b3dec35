"""A drive with its mechanism as a functional mock-up unit (FMU), for co-simulation and model exchange."""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import partial
from hashlib import sha256
from typing import Annotated, Any, Literal
from uuid import UUID

import numpy as np

import linkwright
from linkwright.fmi.archive import archive, identifier
from linkwright.fmi.core import MachineData, Settings, machine_data
from linkwright.fmi.description import Description, Experiment, model_description
from linkwright.fmi.library import libraries
from linkwright.fmi.parameters import Adjustable, adjustable
from linkwright.fmi.program import Program, program_of
from linkwright.fmi.units import unit_definitions
from linkwright.fmi.variables import Variable, variables_of
from linkwright.kernel.errors import InputError, show
from linkwright.kernel.files.output import write_file
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.reader.out_units import OutUnits, reader
from linkwright.kernel.result import Result
from linkwright.kernel.units.kinds import ANGLE, SPEED
from linkwright.kernel.units.marks import Quantity
from linkwright.machine.machine import Machine

Version = Literal["2.0", "3.0"]
VERSIONS: tuple[Version, ...] = ("2.0", "3.0")

# What a tool proposes for a simulation: revolutions at the speed from which steady motion is sought, and
# communication steps of one.
_REVOLUTIONS, _STEPS = 10, 200


@dataclass(frozen=True)
class Fmu(Result):
    """A drive with its mechanism as an FMU."""

    name: Annotated[str, About("Name of the machine.")]
    identifier: Annotated[str, About("Name of the library in the archive.")]
    version: Annotated[str, About("Of FMI: `2.0` or `3.0`.")]
    token: Annotated[str, About("What the library compares with the description: `guid`.")]
    platforms: Annotated[tuple[str, ...], About("For which it has a library, as FMI calls them.")]
    variables: Annotated[tuple[Variable, ...], About("What is set and read, in the order of the archive.")]
    states: Annotated[int, Label("continuous states", "", "")]
    event_indicators: Annotated[int, Label("event indicators", "", "")]
    accuracy: Annotated[float, Label("relative accuracy of a step", "", "")]
    data: Annotated[bytes, About("Content of the file.")]

    @public
    def write(self, path: str | os.PathLike[str]) -> None:
        """Write the file ``.fmu``; one that exists is replaced.

        Raises
        ------
        InputError
            The path is no file, or cannot be written.
        """
        write_file(path, self.data)

    def named(self, causality: str) -> list[Variable]:
        """Variables of a causality, such as ``"input"``."""
        return [variable for variable in self.variables if variable.causality == causality]

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """All but the content; variables by name."""
        parts = {name: x for name, x in super().to_dict(curves=curves).items() if name != "data"}
        return parts | {"variables": {variable.name: variable.to_dict() for variable in self.variables}}


@public
def fmu(
    machine: Machine,
    *,
    version: Version = "2.0",
    angle: float = 0.0,
    speed: float = 0.0,
    accuracy: float = 1e-8,
    clockwise: bool = False,
    rigid: bool = False,
) -> Fmu:
    """Make an FMU of a drive with its mechanism.

    Parameters
    ----------
    machine : Machine
        With a mechanism that a crank drives.
    version : {"2.0", "3.0"}
        Of FMI. All tools import 2.0; fewer import 3.0.
    angle, speed : float
        Crank angle [rad] and speed [rad/s] at the start, unless the importing tool sets others.
    accuracy : float
        Relative accuracy of a step in co-simulation, unless the importing tool asks for another.
    clockwise : bool
        Whether the motor drives the crank clockwise.
    rigid : bool
        Whether an elastic driveline is taken as rigid.

    Returns
    -------
    Fmu
        Inputs are the supply of the motor, a torque on the crank and a braking torque; outputs the motion of
        crank, points, links and slides, torques, power and energy; parameters the masses, inertias, forces
        and torques of the machine.

    Raises
    ------
    AssemblyError
        The mechanism does not close at the crank angle of the start.
    FindingError
        The motion is not determined: no inertia, an infinite acceleration.
    InputError
        The machine has no crank, or a motor that keeps its speed; an argument is out of range.

    References
    ----------
    .. [1] Functional Mock-up Interface for Model Exchange and Co-Simulation, version 2.0.4, 2022.
    .. [2] Functional Mock-up Interface Specification, version 3.0.1, 2023.
    """
    if version not in VERSIONS:
        raise InputError(f'version: found {show(version)}, expected "2.0" or "3.0"')
    in_range(angle=(angle, Quantity(ANGLE)), speed=(speed, Quantity(SPEED)))
    if not 1e-14 <= accuracy <= 1e-2:
        raise InputError(f"accuracy {accuracy:g}: expected a number from 1e-14 to 1e-2")
    program = program_of(machine, angle, rigid=rigid)
    settings = Settings((angle, speed), clockwise, accuracy)
    entries = adjustable(program, rigid=rigid)
    variables = variables_of(program, settings.start, entries)
    return _assembled(program, settings, entries, variables, version)


def _assembled(
    program: Program,
    settings: Settings,
    entries: list[Adjustable],
    variables: list[Variable],
    version: Version,
) -> Fmu:
    """Description, data and library in one archive; the token is a digest of the first two."""
    name = identifier(program.machine.name)
    made = partial(
        machine_data,
        program.compiled,
        settings,
        [(entry.value, entry.moves) for entry in entries],
        driveline=None if program.chain is None else program.chain.core,
        brake=program.brake_mass,
        scales=[(variable.reference, variable.factor) for variable in variables if variable.factor != 1.0],
        ranges=[(variable.reference, *variable.bounds) for variable in variables if variable.bounds],
    )
    data = made()

    def description(token: str) -> bytes:
        return model_description(_description(program, settings, variables, data, name, token), version)

    token = f"{{{UUID(bytes=sha256(data.data + description('')).digest()[:16])}}}"
    data = made(token=token)
    return Fmu(
        name=program.machine.name,
        identifier=name,
        version=version,
        token=token,
        platforms=tuple(platform.folder(version) for platform in libraries()),
        variables=tuple(variables),
        states=data.states,
        event_indicators=data.indicators,
        accuracy=settings.accuracy,
        data=archive(description(token), data.data, version=version, name=name),
    )


def _description(
    program: Program,
    settings: Settings,
    variables: list[Variable],
    data: MachineData,
    name: str,
    token: str,
) -> Description:
    """What `modelDescription.xml` says."""
    period = 2 * np.pi / program.compiled.speed_guess
    stop = float(f"{_REVOLUTIONS * period:.2g}")
    units = ["s", *(variable.unit for variable in variables)]
    return Description(
        program.machine.name,
        name,
        f"Linkwright {linkwright.__version__}",
        token,
        variables,
        data.indicators,
        unit_definitions(units, reader().over(OutUnits.of_table(program.machine.units))),
        Experiment(stop, stop / (_REVOLUTIONS * _STEPS), settings.accuracy),
    )
