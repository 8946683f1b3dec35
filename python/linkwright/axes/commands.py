"""``linkwright axes FILE``: torque of every axis, duty of its motor, timing of all cams and axes."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from linkwright.kernel.command.answer import Answer
from linkwright.kernel.command.common import Curves, FolderOutput, belong_to, to_folder
from linkwright.kernel.command.parameter import Group, Option, Value
from linkwright.kernel.errors import InputError
from linkwright.kernel.later import later
from linkwright.kernel.units.kinds import LENGTH, SPEED
from linkwright.kernel.units.marks import positive
from linkwright.machine.file_argument import File

if TYPE_CHECKING:
    from linkwright.axes.axis import ServoAxis
    from linkwright.axes.bus import DcBus
    from linkwright.axes.choice import ServoChoice
    from linkwright.axes.clearance import Clearance
    from linkwright.axes.timing import Track
    from linkwright.kernel.figure.style import CaptionedFigure
    from linkwright.kernel.page.table import Table
    from linkwright.machine.machine import Machine

Speed = Annotated[
    float | None,
    Value(
        "--speed",
        SPEED,
        'Constant speed of the master, such as "120 rpm". Default: that of [master], or the steady motion of '
        "the crankshaft.",
    ),
]
Catalogue = Annotated[
    Path | None,
    Option("--catalogue", "FILE", "Choose motors for the axes from a CSV file of servo motors."),
]
Gearboxes = Annotated[
    Path | None,
    Option("--gearboxes", "FILE", "Gearboxes to choose from, a CSV file. Default: those of the axes."),
]
AxisName = Annotated[str | None, Option("--axis", "NAME", "Choose for this axis alone.")]
Goal = Annotated[
    Literal["cost", "power", "inertia", "rms"],
    Option("--goal", help="Lowest first: cost, rated power, inertia of the rotor, or rms utilisation."),
]
To = Annotated[
    FolderOutput,
    to_folder("Write results.json, the curves of each axis as CSV, and figures there.", curves=Curves),
]


Points = Annotated[
    str | None,
    Option(
        "--clearance", '"P Q"', "Minimum distance of two points over the cycle, which different axes move."
    ),
]
Keep = Annotated[
    float | None,
    Value(
        "--keep",
        positive(LENGTH),
        'With --clearance: distance to keep, such as "20 mm"; says how much earlier the axis of Q may start.',
    ),
]


@dataclass(frozen=True)
class ChoiceOptions:
    """Catalogues to choose from."""

    catalogue: Catalogue = None
    gearboxes: Gearboxes = None
    axis: AxisName = None
    goal: Goal = "power"


def axes(
    file: File,
    speed: Speed = None,
    clearance: Points = None,
    keep: Keep = None,
    *,
    choice: Annotated[ChoiceOptions, Group(ChoiceOptions)],
    to: To,
) -> None:
    """Torque of every servo axis over the cycle, and whether its motor stands it.

    Each driver has its own torque or force; at its motor: speed, peak and root mean square torque, inertia
    ratio and regenerated energy against the limits of motor, gearbox and brake resistor; the DC bus of all
    axes; the timing of all cams and axes over one master angle. With --catalogue: every motor with every
    gearbox, the pairs that pass, and what refuses the others. Exit code 1 if a motor fails a check, or none
    of a catalogue passes.

    Examples: linkwright axes packaging.toml --clearance "pusher jaw" --keep "20 mm"; linkwright axes
    packaging.toml --catalogue motors.csv --gearboxes gearboxes.csv --axis dial.
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
    chosen = _chosen(found, choice)
    apart = _clearance(machine, clearance, keep)
    results: dict[str, Any] = {
        **speeds,
        "axes": found,
        "dc_bus": bus,
        "timing": {track.name: track for track in tracks},
        **({"choice": chosen} if chosen else {}),
        **({} if apart is None else {"clearance": apart}),
    }
    answer = Answer(
        machine=machine,
        is_described=True,
        results=results,
        findings=[
            *cycle.forces.findings,
            *(_choice_findings(chosen) if chosen else axis_findings(listed)),
            *_not_kept(apart),
        ],
        warnings=list(axis_warnings(listed)),
        head=later("axes.commands:_head", speed_words(speeds), chosen),
        tables=later("axes.commands:_tables", listed, bus, tracks, apart, chosen),
        files={
            f"axis_{name}.csv": later("kernel.page.table:curves_csv", axis) for name, axis in found.items()
        }
        | {f"choice_{name}.csv": later("axes.page.choice:pairs_csv", one) for name, one in chosen.items()},
        figures=later("axes.commands:_figures", listed, bus, tracks, chosen),
    )
    to.hand_over(answer)


def _clearance(machine: Machine, points: str | None, keep: float | None) -> Clearance | None:
    """Distance of the two points of --clearance; None without it."""
    from linkwright.axes.clearance import clearance

    if points is None:
        belong_to("--clearance", "keep")
        return None
    names = points.replace(",", " ").split()
    if len(names) != 2:
        raise InputError(f'--clearance: found "{points}", expected two points, such as "pusher jaw"')
    return clearance(machine, *names, keep=keep)


def _not_kept(apart: Clearance | None) -> list[str]:
    """A wanted distance that no shift keeps."""
    if apart is None or apart.wanted is None or apart.earlier is not None:
        return []
    return [
        f"no start of axis {apart.axis} keeps {apart.wanted:.4g} m between {apart.first} and {apart.second}"
    ]


def _chosen(axes: dict[str, ServoAxis], options: ChoiceOptions) -> dict[str, ServoChoice]:
    """The choice for each axis, or for one; none without a catalogue."""
    from linkwright.axes.choice import choose_servo
    from linkwright.axes.model.axis_catalogue import CatalogueGearbox, read_gearboxes, read_servo_motors
    from linkwright.kernel.description.base import suggestion

    if options.catalogue is None:
        belong_to("--catalogue", "gearboxes", "axis", "goal")
        return {}
    if options.axis is not None and options.axis not in axes:
        known = suggestion(options.axis, axes)
        raise InputError(f'--axis: found "{options.axis}", expected an axis of the machine; {known}')
    motors = read_servo_motors(options.catalogue)
    gears = None if options.gearboxes is None else read_gearboxes(options.gearboxes)
    return {
        name: choose_servo(
            found.cycle,
            motors,
            gears or (CatalogueGearbox("the gearbox of the axis", found.axis.gearbox, 0.0),),
            goal=options.goal,
            starts=found.starts,
            coupling=0.0 if found.axis.coupling is None else found.axis.coupling.inertia,
        )
        for name, found in axes.items()
        if options.axis in (None, name)
    }


def _choice_findings(chosen: dict[str, ServoChoice]) -> list[str]:
    """Axes for which no pair suffices."""
    from linkwright.axes.page.choice import choice_headline

    return [choice_headline(name, choice) for name, choice in chosen.items() if not len(choice.order)]


def _head(speeds: str, chosen: dict[str, ServoChoice]) -> str:
    """The speed, and what is chosen."""
    from linkwright.axes.page.choice import choice_headline

    found = [choice_headline(name, choice) for name, choice in chosen.items() if len(choice.order)]
    return "\n".join([speeds, *found])


def _tables(
    axes: list[ServoAxis],
    bus: DcBus,
    tracks: tuple[Track, ...],
    apart: Clearance | None,
    chosen: dict[str, ServoChoice],
) -> list[Table]:
    """A row an axis, checks, bus, timing; a clearance; what is chosen."""
    from linkwright.axes.page.choice import choice_tables
    from linkwright.axes.tables import axis_tables, bus_tables, clearance_tables, timing_tables

    choices = [table for name, choice in chosen.items() for table in choice_tables(name, choice)]
    clearances = () if apart is None else clearance_tables(apart)
    return [*timing_tables(tracks), *axis_tables(axes), *bus_tables(bus), *clearances, *choices]


def _figures(
    axes: list[ServoAxis], bus: DcBus, tracks: tuple[Track, ...], chosen: dict[str, ServoChoice]
) -> list[CaptionedFigure]:
    """Timing diagram, torque over speed of each motor, power of the bus, motors to choose from."""
    from linkwright.axes.figures import axis_figures, bus_figures, timing_figures
    from linkwright.axes.page.ratio_chart import ratio_chart

    charts = [ratio_chart(name, choice) for name, choice in chosen.items()]
    return [*timing_figures(tracks), *axis_figures(axes), *bus_figures(bus), *charts]
