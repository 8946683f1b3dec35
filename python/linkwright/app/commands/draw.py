"""``linkwright draw FILE``: a mechanism to scale, still or in motion."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import click

from linkwright.kernel.command.out import Force, output_files, say_written
from linkwright.kernel.command.parameter import Option, Value
from linkwright.kernel.errors import FindingError, InputError, printable
from linkwright.kernel.units.kinds import ANGLE, TIME
from linkwright.machine.file_argument import File

if TYPE_CHECKING:
    from linkwright.machine.machine import Machine

Scene = dict[str, Any]

Places = Annotated[
    list[str] | None,
    Option(
        "--out",
        "FILE",
        "A figure (.svg, .png, .pdf), the pose as .dxf, the motion as .gif or .mp4. "
        "Repeatable. Default: drawing.svg.",
    ),
]
At = Annotated[
    float | None, Value("--at", ANGLE, "Crank angle of the pose. Default: an eighth of the motion.")
]
Seconds = Annotated[float | None, Value("--seconds", TIME, "Duration of the animation. Default: 4 s.")]

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
    force: Force = False,
) -> None:
    """Draw a mechanism to scale.

    A pose as picture or DXF in millimetres; the motion as GIF or MP4, with the uneven speed of the steady
    motion if there is one.
    """
    from linkwright.kernel.command.console import progress
    from linkwright.kernel.files.output import write_file

    places = output_files("--out", out or ["drawing.svg"], (*_STILL, *_MOVING), force=force)
    lasting = _USUAL if seconds is None else seconds
    if not 0.1 <= lasting <= _LONGEST:
        raise InputError(f"--seconds: found {lasting:g} s, expected 0.1 s to {_LONGEST:g} s")
    scene, place = _scene(file.read(), at)
    for path in places:
        with progress(f"drawing {path.name}"):
            data = _data(scene, place, lasting, path.suffix.lower())
        write_file(path, data, replace=force)
    say_written(places, quiet=False)


def _scene(machine: Machine, at: float | None) -> tuple[Scene, float]:
    import numpy as np

    from linkwright.app.report.scene import moving_scene
    from linkwright.drive.steady_state import steady_state
    from linkwright.linkages.closure import closure, in_cycle, require_full_turn
    from linkwright.linkages.model.topology import Topology
    from linkwright.machine.program.compiled import compile_machine

    if machine.is_rod_string_alone and (string := moving_scene(machine, None)) is not None:
        return string, _EIGHTH if at is None else at / (2 * np.pi) % 1.0
    if not Topology.of(machine.linkage).drivers:
        raise InputError("nothing to draw: the machine has no mechanism")
    angle = None if at is None else in_cycle(closure(machine), at)
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
    from linkwright.app.curves import bytes_of
    from linkwright.app.report.moving import dxf, gif, mp4
    from linkwright.app.report.sketch import sketch_figure

    if ending == ".dxf":
        return dxf(scene, place)
    if ending in _MOVING:
        return gif(scene, seconds) if ending == ".gif" else mp4(scene, seconds)
    return bytes_of(sketch_figure(scene, place), ending)
