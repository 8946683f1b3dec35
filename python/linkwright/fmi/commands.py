"""``linkwright fmu FILE``: a drive with its mechanism as an FMU."""

from __future__ import annotations

from typing import Annotated, Literal

from linkwright.drive.commands import Clockwise, FromAngle, FromSpeed
from linkwright.driveline.commands import Rigid
from linkwright.kernel.command.answer import Answer
from linkwright.kernel.command.common import Output, to_file
from linkwright.kernel.command.parameter import Option
from linkwright.kernel.later import later
from linkwright.machine.file_argument import File

Fmi = Annotated[
    Literal["2", "3", "2.0", "3.0"],
    Option("--fmi", help="Version of FMI. All tools import 2.0, fewer import 3.0."),
]
Accuracy = Annotated[
    float,
    Option(
        "--accuracy", "A", "Relative accuracy of a step of co-simulation, unless the tool asks for another."
    ),
]
To = Annotated[Output, to_file("Write the FMU there, a file .fmu.")]

_VERSIONS: dict[str, Literal["2.0", "3.0"]] = {"2": "2.0", "3": "3.0", "2.0": "2.0", "3.0": "3.0"}


def fmu(
    file: File,
    *,
    fmi: Fmi = "2",
    from_angle: FromAngle,
    from_speed: FromSpeed,
    clockwise: Clockwise = False,
    rigid: Rigid = False,
    accuracy: Accuracy = 1e-8,
    to: To,
) -> None:
    """Export a drive with its mechanism as an FMU, for co-simulation and model exchange.

    The importing tool switches the motor, brakes and loads the crank, and reads angle, speed, torques, power
    and the motion of all points, links and slides. Masses, inertias, forces and torques are parameters.

    Example: linkwright fmu press.toml --out press.fmu.
    """
    from linkwright.fmi.fmu import fmu as made

    machine = file.read()
    unit = made(
        machine,
        version=_VERSIONS[fmi],
        angle=from_angle,
        speed=from_speed,
        accuracy=accuracy,
        clockwise=clockwise,
        rigid=rigid,
    )
    to.hand_over(
        Answer(
            machine=machine,
            results={"fmu": unit},
            # The version is a name too: 2.0 everywhere.
            names={unit.version, *(variable.name for variable in unit.variables)},
            tables=later("fmi.tables:fmu_tables", unit),
            machine_file=lambda: unit.data,
        )
    )
