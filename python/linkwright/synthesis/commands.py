"""``linkwright synthesise``: the kinds of synthesis."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from linkwright.kernel.command.answer import Answer, hand_over
from linkwright.kernel.command.common import Curves, Json, Outside, Sets, belong_to, option_value
from linkwright.kernel.command.console import bar
from linkwright.kernel.command.out import Force, out_option
from linkwright.kernel.command.parameter import Argument, Option
from linkwright.kernel.errors import InputError
from linkwright.studies.commands.study_file import ToStudy, hand_over_study

if TYPE_CHECKING:
    from linkwright.kernel.result import Result
    from linkwright.machine.machine import Machine

OutFile = Annotated[Path | None, out_option("Write the machine there.", "FILE")]
TaskFile = Annotated[Path | None, Argument("TASK", "Task file of the linkage.")]
TaskOption = Annotated[Path | None, Option("--task", metavar="FILE", help="Task file, instead of TASK.")]
Swing = Annotated[
    str | None, Option("--swing", metavar="ANGLE", help="Swing of the rocker, for a crank-rocker.")
]
Stroke = Annotated[
    str | None, Option("--stroke", metavar="LENGTH", help="Stroke of the slider, for a slider-crank.")
]
TimeRatio = Annotated[
    float,
    Option(
        "--time-ratio",
        metavar="X",
        help="Crank angle from outer to inner dead centre over the rest of the revolution.",
    ),
]
Frame = Annotated[
    str, Option("--frame", metavar="LENGTH", help="Distance between the pivots of a crank-rocker.")
]
CouplerMax = Annotated[
    float, Option("--coupler-max", metavar="X", help="Maximum ratio of coupler to rocker of a crank-rocker.")
]
Rod = Annotated[
    str | None, Option("--rod", metavar="LENGTH", help="Rod of a slider-crank. Default: the best one.")
]
Kind = Annotated[str | None, Option("--kind", metavar="KIND", help="Kind of linkage; --list lists them.")]
Length = Annotated[str, Option("--length", metavar="LENGTH", help="Length of the straight line.")]
Proportions = Annotated[
    list[str] | None,
    Option(
        "--proportion",
        metavar="NAME=X",
        help="Proportion other than the default; only ratios matter. Repeatable.",
    ),
]
List = Annotated[bool, Option("--list", help="List the catalogue for this length of the line.")]


def dead_centre(
    swing: Swing = None,
    stroke: Stroke = None,
    time_ratio: TimeRatio = 1.0,
    frame: Frame = "1 m",
    coupler_max: CouplerMax = 3.0,
    rod: Rod = None,
    json: Json = False,
    out: OutFile = None,
    force: Force = False,
) -> None:
    """Crank-rocker for a swing, or slider-crank for a stroke, and a time ratio; best transmission angle."""
    from linkwright.kernel.units.kinds import ANGLE, LENGTH
    from linkwright.synthesis.dead_centre import crank_rocker
    from linkwright.synthesis.stroke import slider_crank

    if (swing is None) == (stroke is None):
        raise InputError("expected --swing ANGLE for a crank-rocker, or --stroke LENGTH for a slider-crank")
    if swing is not None:
        belong_to("--stroke", "rod")
        size = option_value("--frame", frame, LENGTH)
        angle = option_value("--swing", swing, ANGLE)
        _finish(
            "crank_rocker",
            crank_rocker(angle, time_ratio, frame=size, coupler_max=coupler_max),
            json,
            out,
            force,
        )
        return
    assert stroke is not None
    belong_to("--swing", "frame", "coupler_max")
    length = None if rod is None else option_value("--rod", rod, LENGTH)
    way = option_value("--stroke", stroke, LENGTH)
    _finish("slider_crank", slider_crank(way, time_ratio, rod=length), json, out, force)


def function(
    task: TaskFile = None,
    task_file: TaskOption = None,
    set: Sets = None,
    allow_outside: Outside = False,
    json: Json = False,
    curves: Curves = False,
    out: OutFile = None,
    force: Force = False,
) -> None:
    """Four-bar whose rocker follows a function of the crank angle, by Freudenstein's equation."""
    from linkwright.machine.read import read_as
    from linkwright.synthesis.function_generator import function_generator
    from linkwright.synthesis.task import FunctionTask

    generator = function_generator(
        read_as(FunctionTask, _task(task, task_file), set or (), allow_outside=allow_outside)
    )
    _finish("function_generator", generator, json, out, force, curves=curves)


def path(
    task: TaskFile = None,
    task_file: TaskOption = None,
    set: Sets = None,
    allow_outside: Outside = False,
    study: ToStudy = None,
    json: Json = False,
    curves: Curves = False,
    out: OutFile = None,
    force: Force = False,
) -> None:
    """Four-bar whose coupler point passes given points, by global search."""
    from linkwright.machine.read import read_as
    from linkwright.synthesis.path import path_generator
    from linkwright.synthesis.task import PathTask

    file = _task(task, task_file)
    read = read_as(PathTask, file, set or (), allow_outside=allow_outside)
    with bar("refinement") as watch:
        generator = path_generator(read, track=lambda done, total: watch(done / total))
    if study is not None:
        from linkwright.studies.paths import path_study

        plan = path_study(read, generator)
        hand_over_study(plan, study, file, None, force=force, quiet=json, out=out)
    _finish("path_generator", generator, json, out, force, curves=curves)


def motion(
    task: TaskFile = None,
    task_file: TaskOption = None,
    set: Sets = None,
    allow_outside: Outside = False,
    json: Json = False,
    curves: Curves = False,
    out: OutFile = None,
    force: Force = False,
) -> None:
    """Four-bar or slider-crank whose coupler passes two or three poses."""
    from linkwright.machine.read import read_as
    from linkwright.synthesis.pose import pose_guide
    from linkwright.synthesis.task import PoseTask

    guide = pose_guide(read_as(PoseTask, _task(task, task_file), set or (), allow_outside=allow_outside))
    _finish("pose_guide", guide, json, out, force, curves=curves)


def _task(task: Path | None, option: Path | None) -> Path:
    """The file of the task, by its place or by the option."""
    if (task is None) == (option is None):
        found = "neither" if task is None else "both"
        raise InputError(f"TASK or --task: found {found}, expected the file of the task, such as task.toml")
    chosen = task or option
    assert chosen is not None
    return chosen


def line(
    kind: Kind = None,
    length: Length = "1 m",
    proportion: Proportions = None,
    list: List = False,
    json: Json = False,
    curves: Curves = False,
    out: OutFile = None,
    force: Force = False,
) -> None:
    """Straight-line linkage from the catalogue, exact or approximate."""
    from linkwright.kernel.units.kinds import LENGTH
    from linkwright.synthesis.line_kinds import KINDS
    from linkwright.synthesis.straight_line import straight_line, straight_lines
    from linkwright.synthesis.tables import catalogue_table

    wanted = option_value("--length", length, LENGTH)
    if kind is None and not list:
        raise InputError("expected --kind KIND, or --list for the catalogue")
    if kind is None or list:
        lines = straight_lines(wanted)
        answer = Answer(
            machine=None,
            names=tuple(KINDS),
            results=lambda _: {"straight_lines": [line.to_dict() for line in lines]},
            tables=lambda: [catalogue_table(lines)],
        )
        hand_over(answer, json=json)
        return
    straight = straight_line(kind, wanted, proportions=_proportions(proportion or []))
    _finish("straight_line", straight, json, out, force, curves=curves)


def _proportions(texts: list[str]) -> dict[str, float]:
    """Name → value, of ``NAME=X``."""
    proportions = {}
    for text in texts:
        name, _, value = text.partition("=")
        try:
            proportions[name.strip()] = float(value)
        except ValueError:
            raise InputError(
                f"--proportion {text}: expected NAME=X with a plain number, such as arm=2.5"
            ) from None
    return proportions


def _finish(
    what: str, result: Result, json: bool, out: Path | None, force: bool, *, curves: bool = False
) -> None:
    """Write the machine and print the result."""
    from linkwright.machine.write import dumps
    from linkwright.synthesis.line_kinds import KINDS
    from linkwright.synthesis.tables import linkage_table

    machine: Machine = result.machine  # type: ignore[attr-defined]
    entries = result.to_dict(curves=curves)
    # Lines of the catalogue have none.
    warnings = entries.pop("warnings", [])
    answer = Answer(
        machine=machine.name,
        units=machine.units,
        names=tuple(KINDS),
        results=lambda _: {what: entries},
        warnings=warnings,
        head=lambda: machine.name,
        tables=lambda: [linkage_table(result, entries)],
        tail=lambda: f"Written: {out}\n" if out else "--out FILE writes the machine file.\n",
        machine_file=lambda: dumps(machine),
    )
    hand_over(answer, json=json, out=out, force=force)
