"""``linkwright draw FILE``: a mechanism to scale, still or in motion."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import click

from linkwright.kernel.command.common import File, Outside, Sets, option_value
from linkwright.kernel.command.out import Force, output_files, say_written
from linkwright.kernel.command.parameter import Option
from linkwright.kernel.errors import FindingError, InputError, printable

if TYPE_CHECKING:
    from linkwright.machine.machine import Machine

Scene = dict[str, Any]

Places = Annotated[
    list[str] | None,
    Option(
        "--out",
        metavar="FILE",
        help="A figure (.svg, .png, .pdf), the pose as .dxf, the motion as .gif or .mp4. "
        "Repeatable. Default: drawing.svg.",
    ),
]
At = Annotated[
    str | None,
    Option("--at", metavar="ANGLE", help="Crank angle of the pose. Default: an eighth of the motion."),
]
Seconds = Annotated[
    str | None, Option("--seconds", metavar="TIME", help="Duration of the animation. Default: 4 s.")
]

_STILL, _MOVING = (".svg", ".png", ".pdf", ".dxf"), (".gif", ".mp4")

# Seconds of a moving picture, and the most it may last: 25 pictures a second.
_USUAL, _LONGEST = 4.0, 120.0

# Where in the motion a pose is drawn that nobody chose.
_EIGHTH = 0.125


def draw(
    file: File,
    out: Places = None,
    at: At = None,
    seconds: Seconds = None,
    set: Sets = None,
    allow_outside: Outside = False,
    force: Force = False,
) -> None:
    """Draw a mechanism to scale.

    A pose as picture or DXF in millimetres; the motion as GIF or MP4, with the uneven speed of the steady
    motion if there is one.
    """
    from linkwright.kernel.command.console import progress
    from linkwright.kernel.files.output import write_file
    from linkwright.machine.read import read

    places = output_files("--out", out or ["drawing.svg"], (*_STILL, *_MOVING), force=force)
    lasting = _lasting(seconds)
    machine = read(file, set or [], allow_outside=allow_outside)
    scene, place = _scene(machine, at)
    for path in places:
        with progress(f"drawing {path.name}"):
            data = _data(scene, place, lasting, path.suffix.lower())
        write_file(path, data, replace=force)
    say_written(places, quiet=False)


def _lasting(text: str | None) -> float:
    """How long a moving picture lasts [s]."""
    from linkwright.kernel.units.kinds import TIME

    seconds = _USUAL if text is None else option_value("--seconds", text, TIME)
    if not 0.1 <= seconds <= _LONGEST:
        raise InputError(f"--seconds: found {text}, expected 0.1 s to {_LONGEST:g} s")
    return seconds


def _scene(machine: Machine, at: str | None) -> tuple[Scene, float]:
    """All that is drawn, and where in the motion the pose is."""
    import numpy as np

    from linkwright.app.report.scene import moving_scene
    from linkwright.drive.steady_state import steady_state
    from linkwright.kernel.units.kinds import ANGLE
    from linkwright.linkages.closure import closure, in_cycle, require_full_turn
    from linkwright.linkages.model.topology import DRIVERS
    from linkwright.machine.program.compiled import compile_machine

    if not any(getattr(machine.linkage, table) for table in DRIVERS):
        raise InputError("nothing to draw: the machine has no mechanism")
    angle = None if at is None else in_cycle(closure(machine), option_value("--at", at, ANGLE))
    has_motor = machine.drive is not None and machine.drive.motor is not None
    try:
        steady = steady_state(machine) if has_motor else None
    except FindingError as error:
        click.echo(f"Drawn at constant speed: {printable(str(error))}", err=True)
        steady = None
    scene = moving_scene(machine, steady, angle)
    if scene is None:
        require_full_turn(compile_machine(machine), machine)
        raise InputError("nothing to draw: the mechanism does not move")
    if angle is None:
        return scene, _EIGHTH
    nearest = int(np.argmin(np.abs(scene["angles"] - angle)))
    return scene, nearest / (len(scene["angles"]) - 1)


def _data(scene: Scene, place: float, seconds: float, ending: str) -> str | bytes:
    """The file."""
    from linkwright.app.curves import bytes_of
    from linkwright.app.report.moving import dxf, gif, mp4
    from linkwright.app.report.sketch import sketch_figure

    if ending == ".dxf":
        return dxf(scene, place)
    if ending in _MOVING:
        return gif(scene, seconds) if ending == ".gif" else mp4(scene, seconds)
    return bytes_of(sketch_figure(scene, place), ending)
