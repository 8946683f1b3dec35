"""``linkwright export FILE``: a machine for programs of multibody dynamics and robotics."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from linkwright.drive.commands import FromAngle, FromSpeed
from linkwright.kernel.command.answer import Answer
from linkwright.kernel.command.common import Output, belong_to, to_file
from linkwright.kernel.command.out import out_option
from linkwright.kernel.command.parameter import Option, Value
from linkwright.kernel.errors import InputError
from linkwright.kernel.later import later
from linkwright.kernel.units.kinds import SPEED, TIME
from linkwright.machine.file_argument import File, MachineFile

if TYPE_CHECKING:
    from linkwright.multibody.export import Mjcf, Urdf


class Format(StrEnum):
    """Model formats."""

    mjcf = "mjcf"
    urdf = "urdf"


To = Annotated[Format, Option("--to", help="MJCF for MuJoCo, or URDF for robotics.")]
Constant = Annotated[
    float | None,
    Value(
        "--speed",
        SPEED,
        'With mjcf: constant speed of the crank, such as "90 rpm". Default: that of a motor of constant '
        "speed; without a motor, the design speed, unless --from-speed is given.",
    ),
]
Step = Annotated[
    float | None, Value("--step", TIME, "With mjcf: time step. Default: about 2000 per revolution.")
]
LeaveOut = Annotated[
    list[str] | None,
    Option(
        "--leave-out",
        "NAME",
        "With mjcf: load, or motor, that the receiving program applies itself. Repeatable.",
    ),
]
TableFile = Annotated[
    Path | None,
    out_option("With urdf: write the positions of all joints over a cycle there, as CSV.", "FILE", "--table"),
]
Written = Annotated[Output, to_file("Write the model there.")]


def export(
    file: File,
    *,
    to_format: To,
    from_angle: FromAngle,
    from_speed: FromSpeed,
    speed: Constant = None,
    step: Step = None,
    leave_out: LeaveOut = None,
    table: TableFile = None,
    to: Written,
) -> None:
    """Export a machine to programs of multibody dynamics and robotics.

    MJCF closes the loops by constraints, and has motor and loads that are linear; URDF is a tree, whose
    joints follow a table over the crank angle.

    Example: linkwright export press_motion --to mjcf --out press.xml.
    """
    from linkwright.kernel.files.output import require_place
    from linkwright.multibody.export import mjcf, urdf

    made: Mjcf | Urdf
    if to_format is Format.urdf:
        belong_to("--to mjcf", "from_speed", "speed", "step", "leave_out")
        if table is not None:
            require_place(table, replace=to.force)
        machine = file.read()
        with _located(file):
            made = urdf(machine, angle=from_angle)
        if table is not None:
            _write_table(made, table, force=to.force)
    else:
        if table is not None:
            raise InputError("--table: it belongs to --to urdf")
        machine = file.read()
        with _located(file):
            made = mjcf(
                machine,
                angle=from_angle,
                speed=speed,
                speed_start=from_speed,
                step=step,
                leave_out=tuple(leave_out or ()),
            )
    to.hand_over(
        Answer(
            machine=machine,
            names={*made.bodies, *made.joints, *made.loops, *getattr(made, "loads", ())},
            results={"export": {"format": to_format.value, **made.to_dict()}},
            warnings=_warnings(made),
            tables=later("multibody.tables:export_tables", made),
            machine_file=lambda: made.text,
        )
    )


@contextmanager
def _located(file: MachineFile) -> Iterator[None]:
    """Problems of the machine with their lines of its file."""
    from linkwright.kernel.errors import MachineError, MachineFileError
    from linkwright.kernel.files.lines import located
    from linkwright.machine.read import text_of_machine

    try:
        yield
    except MachineError as error:
        text = text_of_machine(file.file)
        raise MachineFileError(located(error.problems, text, str(file.file))) from None


def _write_table(made: Urdf, path: Path, *, force: bool) -> None:
    from linkwright.kernel.command.out import put
    from linkwright.kernel.page.table import curves_csv

    put(curves_csv(made.transmission), path, force=force)


def _warnings(made: Mjcf | Urdf) -> list[str]:
    """What the model has and the machine has not, and what it lacks."""
    warnings = []
    if made.massless:
        warnings.append(
            f"Bodies without mass get {made.mass_min:.3g} kg, since models cannot do without: "
            f"{', '.join(made.massless)}."
        )
    if not getattr(made, "moves", True):
        warnings.append("The model starts at rest, and nothing moves it: give --speed or --from-speed.")
    return warnings
