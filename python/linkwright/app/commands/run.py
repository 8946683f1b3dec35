"""``linkwright run FILE``: everything that can be computed about a machine."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from linkwright.kernel.command.answer import Answer, hand_over
from linkwright.kernel.command.common import (
    Curves,
    File,
    Json,
    Outside,
    Sets,
    ZeroAt,
    belong_to,
    option_value,
)
from linkwright.kernel.command.out import Force, command_line, out_option, output_folder
from linkwright.kernel.command.parameter import Option

if TYPE_CHECKING:
    from linkwright.app.study import Study
    from linkwright.kernel.page.angle_zero import Zero
    from linkwright.kernel.page.content import Content
    from linkwright.kernel.page.table import Table

Folder = Annotated[Path | None, out_option("Write results.json, the curves as CSV and report.html there.")]
Accuracy = Annotated[float, Option("--accuracy", metavar="X", help="Relative accuracy of the steady speed.")]
Method = Annotated[
    Literal["newton", "baranov"],
    Option("--method", help="baranov: also compute by the published step method."),
]
Step = Annotated[str, Option("--step", metavar="ANGLE", help="Step of the crank angle for --method baranov.")]


def run(
    file: File,
    set: Sets = None,
    allow_outside: Outside = False,
    zero: ZeroAt = None,
    json: Json = False,
    curves: Curves = False,
    out: Folder = None,
    accuracy: Accuracy = 1e-10,
    method: Method = "newton",
    step: Step = "1 deg",
    force: Force = False,
) -> None:
    """Compute how a machine moves.

    Reduced inertia and load, steady motion and its speed fluctuation, run-up; with --out also a report.
    """
    from contextlib import nullcontext

    from linkwright.kernel.command.console import progress

    folder = output_folder(out, force=force)
    if method != "baranov":
        belong_to("--method baranov", "step")
    steps = step if method == "baranov" else None
    with nullcontext() if json else progress("computing"):
        study = _studied(file, set or [], accuracy, steps, allow_outside=allow_outside)
    hand_over(_answer(study, _zero(study, zero)), json=json, curves=curves, folder=folder)


def _studied(file: Path, sets: list[str], accuracy: float, step: str | None, *, allow_outside: bool) -> Study:
    """Read the file and study the machine."""
    from linkwright.app.study import study
    from linkwright.kernel.units.kinds import ANGLE
    from linkwright.machine.read import read

    angle = None if step is None else option_value("--step", step, ANGLE)
    return study(read(file, sets, allow_outside=allow_outside), accuracy=accuracy, step=angle)


def _zero(study: Study, where: str | None) -> Zero:
    """From where crank angles are counted, over the cycle of the steady motion."""
    from math import pi

    from linkwright.kernel.page.angle_zero import Zero
    from linkwright.linkages.zero import zero_angle

    if where is None:
        return Zero()
    zero, motion = zero_angle(study.machine, where), study.motion
    turns = round(float(motion.crank_angle[-1] - motion.crank_angle[0]) / (2 * pi)) if motion else 0
    return zero._replace(cycle=2 * pi * turns) if zero.cycle and turns else zero


def _answer(study: Study, zero: Zero) -> Answer:
    """All that was found, and the files of a study."""
    from linkwright.app.study import results_to_dict

    return Answer(
        machine=study.machine.name,
        units=study.machine.units,
        zero=zero,
        results=lambda curves: results_to_dict(study, curves=curves),
        findings=study.findings,
        warnings=study.warnings,
        head=partial(_head, study),
        tables=partial(_tables, study),
        files=partial(_files, study),
        report=partial(_report, study),
    )


def _head(study: Study) -> str:
    """What the machine consists of."""
    from linkwright.app.commands.check import summary

    return summary(study.machine)


def _tables(study: Study) -> list[Table]:
    """Tables for people."""
    return study.tables()


def _report(study: Study) -> Content:
    """What its report says."""
    from linkwright.app.report.page import content

    return content(study)


def _files(study: Study) -> dict[str, str]:
    """The curves and the report, by name."""
    from linkwright.app.report.page import report_html
    from linkwright.kernel.command.console import progress
    from linkwright.kernel.files.output import file_names
    from linkwright.kernel.page.table import curves_csv

    with progress("writing the report"):
        names = file_names(dict.fromkeys(study, ".csv"))
        tables = {names[name]: curves_csv(result) for name, result in study.items()}
        texts = {name: text for name, text in tables.items() if text}
        if study.topper is not None and not study.topper.obstacle:
            from linkwright.topping.tables.topper import edge_csv

            texts["topper_edge.csv"] = edge_csv(study.topper)
        texts["report.html"] = report_html(study, command=command_line())
    return texts
