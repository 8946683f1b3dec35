"""``linkwright synthesise``: the kinds of synthesis."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeVar

from linkwright.kernel.command.answer import Answer, hand_over
from linkwright.kernel.command.common import Curves, Output, Outside, Sets, belong_to, to_file
from linkwright.kernel.command.console import bar
from linkwright.kernel.command.parameter import Argument, Group, Option, Value
from linkwright.kernel.errors import InputError
from linkwright.kernel.later import later
from linkwright.kernel.units.kinds import ANGLE, LENGTH
from linkwright.studies.commands.study_file import ToStudy, hand_over_study

if TYPE_CHECKING:
    from pydantic import BaseModel

    from linkwright.kernel.result import Result

T = TypeVar("T", bound="BaseModel")


@dataclass(frozen=True)
class TaskFile:
    """The file of a task, by its place or by the option, and the entries that override its own."""

    task: Annotated[Path | None, Argument("TASK", "Task file of the linkage.")] = None
    task_file: Annotated[Path | None, Option("--task", "FILE", "Task file, instead of TASK.")] = None
    set: Sets = None
    allow_outside: Outside = False

    @property
    def file(self) -> Path:
        """The file; an `InputError` if it is given twice, or not at all."""
        given = [place for place in (self.task, self.task_file) if place is not None]
        if len(given) != 1:
            found = "both" if given else "neither"
            raise InputError(
                f"TASK or --task: found {found}, expected the file of the task, such as task.toml"
            )
        return given[0]

    def read(self, kind: type[T]) -> T:
        """The task of a kind."""
        from linkwright.machine.read import read_as

        return read_as(kind, self.file, self.set or (), allow_outside=self.allow_outside)


Task = Annotated[TaskFile, Group(TaskFile)]
To = Annotated[Output, to_file("Write the machine there.", curves=Curves)]
ToFile = Annotated[Output, to_file("Write the machine there.")]
Swing = Annotated[float | None, Value("--swing", ANGLE, "Swing of the rocker, for a crank-rocker.")]
Stroke = Annotated[float | None, Value("--stroke", LENGTH, "Stroke of the slider, for a slider-crank.")]
TimeRatio = Annotated[
    float,
    Option(
        "--time-ratio", "X", "Crank angle from outer to inner dead centre over the rest of the revolution."
    ),
]
Frame = Annotated[float, Value("--frame", LENGTH, "Distance between the pivots of a crank-rocker.", "1 m")]
CouplerMax = Annotated[
    float, Option("--coupler-max", "X", "Maximum ratio of coupler to rocker of a crank-rocker.")
]
Rod = Annotated[float | None, Value("--rod", LENGTH, "Rod of a slider-crank. Default: the best one.")]
Kind = Annotated[str | None, Option("--kind", "KIND", "Kind of linkage; --list lists them.")]
Length = Annotated[float, Value("--length", LENGTH, "Length of the straight line.", "1 m")]
Proportions = Annotated[
    list[str] | None,
    Option("--proportion", "NAME=X", "Proportion other than the default; only ratios matter. Repeatable."),
]
List = Annotated[bool, Option("--list", help="List the catalogue for this length of the line.")]


def dead_centre(
    swing: Swing = None,
    stroke: Stroke = None,
    time_ratio: TimeRatio = 1.0,
    *,
    frame: Frame,
    coupler_max: CouplerMax = 3.0,
    rod: Rod = None,
    to: ToFile,
) -> None:
    """Crank-rocker for a swing, or slider-crank for a stroke, and a time ratio; best transmission angle."""
    from linkwright.synthesis.dead_centre import crank_rocker
    from linkwright.synthesis.stroke import slider_crank

    if (swing is None) == (stroke is None):
        raise InputError("expected --swing ANGLE for a crank-rocker, or --stroke LENGTH for a slider-crank")
    if swing is not None:
        belong_to("--stroke", "rod")
        rocker = crank_rocker(swing, time_ratio, frame=frame, coupler_max=coupler_max)
        _hand_over("crank_rocker", rocker, to)
        return
    assert stroke is not None
    belong_to("--swing", "frame", "coupler_max")
    _hand_over("slider_crank", slider_crank(stroke, time_ratio, rod=rod), to)


def function(task: Task, *, to: To) -> None:
    """Four-bar whose rocker follows a function of the crank angle, by Freudenstein's equation."""
    from linkwright.synthesis.function_generator import function_generator
    from linkwright.synthesis.task import FunctionTask

    _hand_over("function_generator", function_generator(task.read(FunctionTask)), to)


def path(task: Task, study: ToStudy = None, *, to: To) -> None:
    """Four-bar whose coupler point passes given points, by global search."""
    from linkwright.synthesis.path import path_generator
    from linkwright.synthesis.task import PathTask

    read = task.read(PathTask)
    with bar("refinement") as watch:
        generator = path_generator(read, track=lambda done, total: watch(done / total))
    if study is not None:
        from linkwright.studies.paths import path_study

        hand_over_study(path_study(read, generator), study, task.file, None, to)
    _hand_over("path_generator", generator, to)


def motion(task: Task, *, to: To) -> None:
    """Four-bar or slider-crank whose coupler passes two or three poses."""
    from linkwright.synthesis.pose import pose_guide
    from linkwright.synthesis.task import PoseTask

    _hand_over("pose_guide", pose_guide(task.read(PoseTask)), to)


def line(
    kind: Kind = None,
    *,
    length: Length,
    proportion: Proportions = None,
    list: List = False,
    to: To,
) -> None:
    """Straight-line linkage from the catalogue, exact or approximate."""
    from linkwright.synthesis.line_kinds import KINDS
    from linkwright.synthesis.straight_line import straight_line, straight_lines

    if kind is None and not list:
        raise InputError("expected --kind KIND, or --list for the catalogue")
    if kind is None or list:
        lines = straight_lines(length)
        answer = Answer(
            machine=None,
            names=tuple(KINDS),
            results={"straight_lines": [line.to_dict() for line in lines]},
            tables=later("synthesis.tables:catalogue_table", lines),
        )
        hand_over(answer, json=to.json)
        return
    straight = straight_line(kind, length, proportions=_proportions(proportion or []))
    _hand_over("straight_line", straight, to)


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


def _hand_over(what: str, result: Result, to: Output) -> None:
    from linkwright.synthesis.line_kinds import KINDS

    machine = result.machine  # type: ignore[attr-defined]
    entries = result.to_dict(curves=to.curves)
    # Lines of the catalogue have none.
    warnings = entries.pop("warnings", [])
    answer = Answer(
        machine=machine,
        names=tuple(KINDS),
        results={what: entries},
        warnings=warnings,
        head=machine.name,
        tables=later("synthesis.tables:linkage_table", result, entries),
        tail=f"Written: {to.out}" if to.out else "--out FILE writes the machine file.",
        machine_file=later("machine.write:dumps", machine),
    )
    to.hand_over(answer)
