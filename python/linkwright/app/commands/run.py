"""``linkwright run FILE``: everything that can be computed about a machine."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Annotated, Literal

from linkwright.kernel.command.answer import Answer
from linkwright.kernel.command.common import Curves, FolderOutput, ZeroAt, belong_to, to_folder
from linkwright.kernel.command.out import command_line
from linkwright.kernel.command.parameter import Option, Value
from linkwright.kernel.later import later
from linkwright.kernel.units.kinds import ANGLE
from linkwright.machine.file_argument import File

if TYPE_CHECKING:
    from linkwright.app.study import Study

Accuracy = Annotated[float, Option("--accuracy", "X", "Relative accuracy of the steady speed.")]
Method = Annotated[
    Literal["newton", "baranov"],
    Option("--method", help="baranov: also compute by the published step method."),
]
Step = Annotated[float, Value("--step", ANGLE, "Step of the crank angle for --method baranov.", "1 deg")]
To = Annotated[
    FolderOutput, to_folder("Write results.json, the curves as CSV and report.html there.", curves=Curves)
]


def run(
    file: File,
    zero: ZeroAt = None,
    accuracy: Accuracy = 1e-10,
    method: Method = "newton",
    *,
    step: Step,
    to: To,
) -> None:
    """Compute how a machine moves.

    Reduced inertia and load, steady motion and its speed fluctuation, run-up; with --out also a report.
    """
    from contextlib import nullcontext

    from linkwright.app.commands.check import summary
    from linkwright.app.study import results_to_dict, study
    from linkwright.kernel.command.console import progress
    from linkwright.linkages.zero import zero_over

    if method != "baranov":
        belong_to("--method baranov", "step")
    with nullcontext() if to.json else progress("computing"):
        machine = file.read()
        studied = study(machine, accuracy=accuracy, step=step if method == "baranov" else None)
    answer = Answer(
        machine=machine,
        zero=zero_over(machine, zero, studied.motion),
        results=lambda curves: results_to_dict(studied, curves=curves),
        findings=studied.findings,
        warnings=studied.warnings,
        head=partial(summary, machine),
        tables=studied.tables,
        files=partial(_files, studied),
        report=later("app.report.page:content", studied),
    )
    to.hand_over(answer)


def _files(study: Study) -> dict[str, str]:
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
