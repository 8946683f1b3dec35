"""``linkwright axes FILE``: torque of every axis, duty of its motor, timing of all cams and axes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

from linkwright.kernel.command.answer import Answer
from linkwright.kernel.command.common import Curves, FolderOutput, to_folder
from linkwright.kernel.command.parameter import Value
from linkwright.kernel.errors import InputError
from linkwright.kernel.later import later
from linkwright.kernel.units.kinds import SPEED
from linkwright.machine.file_argument import File

if TYPE_CHECKING:
    from linkwright.axes.axis import ServoAxis
    from linkwright.axes.bus import DcBus
    from linkwright.axes.timing import Track
    from linkwright.kernel.figure.style import CaptionedFigure
    from linkwright.kernel.page.table import Table

Speed = Annotated[
    float | None,
    Value(
        "--speed",
        SPEED,
        'Constant speed of the master, such as "120 rpm". Default: that of [master], or the steady motion of '
        "the crankshaft.",
    ),
]
To = Annotated[
    FolderOutput,
    to_folder("Write results.json, the curves of each axis as CSV, and figures there.", curves=Curves),
]


def axes(file: File, speed: Speed = None, *, to: To) -> None:
    """Torque of every servo axis over the cycle, and whether its motor stands it.

    Each driver has its own torque or force; at its motor: speed, peak and root mean square torque, inertia
    ratio and regenerated energy against the limits of motor, gearbox and brake resistor; the DC bus of all
    axes; the timing of all cams and axes over one master angle. Exit code 1 if a motor fails a check.
    """
    from linkwright.axes.axis import servo_axes
    from linkwright.axes.bus import bus_of
    from linkwright.axes.cycle import axes_cycle
    from linkwright.axes.study import axis_findings, axis_warnings
    from linkwright.axes.timing import tracks_of
    from linkwright.drive.crank_speed import speed_words, speeds_of

    machine = file.read()
    if not machine.axes:
        raise InputError(f"{file.file}: the machine has no axis; give a driver a motor as [axes.NAME]")
    found = servo_axes(machine, speed=speed)
    cycle = axes_cycle(machine, speed)
    bus, tracks = bus_of(machine, found, cycle), tracks_of(machine, cycle)
    listed = list(found.values())
    speeds = speeds_of(cycle.forces.speed, machine, speed)
    results: dict[str, Any] = {
        **speeds,
        "axes": found,
        "dc_bus": bus,
        "timing": {track.name: track for track in tracks},
    }
    answer = Answer(
        machine=machine,
        is_described=True,
        results=results,
        findings=[*cycle.forces.findings, *axis_findings(listed)],
        warnings=list(axis_warnings(listed)),
        head=speed_words(speeds),
        tables=later("axes.commands:_tables", listed, bus, tracks),
        files={
            f"axis_{name}.csv": later("kernel.page.table:curves_csv", axis) for name, axis in found.items()
        },
        figures=later("axes.commands:_figures", listed, bus, tracks),
    )
    to.hand_over(answer)


def _tables(axes: list[ServoAxis], bus: DcBus, tracks: tuple[Track, ...]) -> list[Table]:
    """A row an axis, checks, bus, timing."""
    from linkwright.axes.tables import axis_tables, bus_tables, timing_tables

    return [*timing_tables(tracks), *axis_tables(axes), *bus_tables(bus)]


def _figures(axes: list[ServoAxis], bus: DcBus, tracks: tuple[Track, ...]) -> list[CaptionedFigure]:
    """Timing diagram, torque over speed of each motor, power of the bus."""
    from linkwright.axes.figures import axis_figures, bus_figures, timing_figures

    return [*timing_figures(tracks), *axis_figures(axes), *bus_figures(bus)]
