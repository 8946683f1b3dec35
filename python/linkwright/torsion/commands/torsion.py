"""``linkwright torsion FILE``: torsional vibration of a train."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from linkwright.kernel.command.answer import Answer
from linkwright.kernel.command.common import FolderOutput, to_folder
from linkwright.kernel.command.parameter import Option
from linkwright.kernel.later import later
from linkwright.machine.file_argument import File

if TYPE_CHECKING:
    from linkwright.torsion.study import TorsionStudy

Curves = Annotated[
    bool, Option("--curves", help="With --json: every order over the speed, and the manoeuvre over time.")
]
To = Annotated[
    FolderOutput,
    to_folder(
        "Write report.html, results.json, CSV of all curves, and all figures as SVG and PNG there.",
        curves=Curves,
    ),
]
Holzer = Annotated[
    list[str] | None,
    Option(
        "--holzer",
        "FREQUENCY",
        'Holzer\'s table at a frequency: 45 (Hz), "20 rad/s", "300 rpm", f_3. Repeatable.',
    ),
]

MeasuredFile = Annotated[
    Path | None,
    Option(
        "--measured",
        "FILE.csv",
        "Measured curves over the speed, drawn over the computed ones; header: speed [rpm], line [MPa], …",
    ),
]


def torsion(file: File, holzer: Holzer = None, measured: MeasuredFile = None, *, to: To) -> None:
    """Torsional vibration of a train: modes, and under its torques all that its parts bear.

    Natural frequencies, shapes and nodes; with torques and [train.run] in the file also critical speeds,
    torques, stresses, limits, barred speed ranges, speed fluctuation and heat. Exit code 1 if a limit is
    exceeded.
    """
    from linkwright.kernel.command.console import progress
    from linkwright.torsion.limits.overlay import read_measured
    from linkwright.torsion.study import torsion_study

    machine = file.read()
    overlaid = None if measured is None else read_measured(measured)
    with progress("computing"):
        study = torsion_study(machine, holzer=holzer or (), measured=overlaid)
    answer = Answer(
        machine=machine,
        results=partial(_results, study),
        findings=study.findings,
        warnings=study.warnings,
        extra={"balance": study.balance} if study.balance else {},
        head=study.balance,
        tables=later("torsion.tables.torsion:study_tables", study),
        tail=partial(_tail, study),
        files=partial(_files, study),
        figures=later("torsion.figures.captions:torsion_figures", study),
        report=later("torsion.page:torsion_content", study),
    )
    to.hand_over(answer)


def _results(study: TorsionStudy, curves: bool) -> dict[str, Any]:
    from linkwright.torsion.tables.orders import order_results

    results = study.results()
    if curves and study.excited is not None and study.forced is not None:
        results["orders"] = order_results(study.excited, study.forced)
    if curves and study.transient is not None:
        results["transient"] = study.transient.to_dict(curves=True)
    return results


def _tail(study: TorsionStudy) -> str:
    """What measured curves say of the computed ones, and how the train may be operated."""
    from linkwright.torsion.tables.limits import measured_words

    lines = [measured_words(one) for one in study.overlays]
    return "\n".join([*lines, study.operation]).strip()


def _files(study: TorsionStudy) -> dict[str, str]:
    from linkwright.kernel.command.console import progress
    from linkwright.kernel.command.out import command_line
    from linkwright.torsion.page import torsion_html
    from linkwright.torsion.tables.orders import manoeuvre_csv, order_files
    from linkwright.torsion.tables.system import gear_csv

    with progress("drawing"):
        files = {"report.html": torsion_html(study, command=command_line())}
    if study.excited is not None and study.forced is not None:
        files |= order_files(study.excited, study.forced)
    if study.meshes is not None:
        files["gear_torque.csv"] = gear_csv(study.meshes)
    if study.transient is not None:
        files["manoeuvre.csv"] = manoeuvre_csv(study.transient)
    return files
