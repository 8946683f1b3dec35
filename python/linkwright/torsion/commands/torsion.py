"""``linkwright torsion FILE``: torsional vibration of a train."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from linkwright.kernel.command.answer import Answer, hand_over
from linkwright.kernel.command.common import File, Json, Outside, Sets
from linkwright.kernel.command.out import Force, out_option, output_folder
from linkwright.kernel.command.parameter import Option

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from linkwright.kernel.page.content import Content
    from linkwright.kernel.page.table import Table
    from linkwright.torsion.study import TorsionStudy

Folder = Annotated[
    Path | None,
    out_option("Write report.html, results.json, CSV of all curves, and all figures as SVG and PNG there."),
]
Curves = Annotated[
    bool, Option("--curves", help="With --json: every order over the speed, and the manoeuvre over time.")
]
Holzer = Annotated[
    list[str] | None,
    Option(
        "--holzer",
        metavar="FREQUENCY",
        help='Holzer\'s table at a frequency: 45 (Hz), "20 rad/s", "300 rpm", f_3. Repeatable.',
    ),
]

MeasuredFile = Annotated[
    Path | None,
    Option(
        "--measured",
        metavar="FILE.csv",
        help="Measured curves over the speed, drawn over the computed ones; header: speed [rpm], line "
        "[MPa], …",
    ),
]


def torsion(
    file: File,
    set: Sets = None,
    allow_outside: Outside = False,
    json: Json = False,
    curves: Curves = False,
    holzer: Holzer = None,
    measured: MeasuredFile = None,
    out: Folder = None,
    force: Force = False,
) -> None:
    """Torsional vibration of a train: modes, and under its torques all that its parts bear.

    Natural frequencies, shapes and nodes; with torques and [train.run] in the file also critical speeds,
    torques, stresses, limits, barred speed ranges, speed fluctuation and heat. Exit code 1 if a limit is
    exceeded.
    """
    from linkwright.kernel.command.console import progress
    from linkwright.machine.read import read
    from linkwright.torsion.limits.overlay import read_measured
    from linkwright.torsion.study import torsion_study

    folder = output_folder(out, force=force)
    machine = read(file, set or [], allow_outside=allow_outside)
    overlaid = None if measured is None else read_measured(measured)
    with progress("computing"):
        study = torsion_study(machine, holzer=holzer or (), measured=overlaid)
    hand_over(_answer(study), json=json, folder=folder, curves=curves)


def _answer(study: TorsionStudy) -> Answer:
    """All that was found of the train."""
    return Answer(
        machine=study.machine.name,
        units=study.machine.units,
        results=partial(_results, study),
        findings=study.findings,
        warnings=study.warnings,
        extra={"balance": study.balance} if study.balance else {},
        head=lambda: study.balance,
        tables=partial(_tables, study),
        tail=partial(_tail, study),
        files=partial(_files, study),
        figures=partial(_figures, study),
        report=partial(_report, study),
    )


def _results(study: TorsionStudy, curves: bool) -> dict[str, Any]:
    """Results by name; with curves every order over the speed, and the samples of the manoeuvre."""
    from linkwright.torsion.tables.orders import order_results

    results = study.results()
    if curves and study.excited is not None and study.forced is not None:
        results["orders"] = order_results(study.excited, study.forced)
    if curves and study.transient is not None:
        results["transient"] = study.transient.to_dict(curves=True)
    return results


def _tables(study: TorsionStudy) -> list[Table]:
    """Tables for people."""
    from linkwright.torsion.tables.torsion import study_tables

    return list(study_tables(study))


def _tail(study: TorsionStudy) -> str:
    """What measured curves say of the computed ones, and how the train may be operated."""
    from linkwright.torsion.tables.limits import measured_words

    lines = [measured_words(one) for one in study.overlays]
    lines += [study.operation] if study.operation else []
    return "".join(f"{line}\n" for line in lines)


def _files(study: TorsionStudy) -> dict[str, str]:
    """The report, every order over the speed, the curves of the manoeuvre."""
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


def _report(study: TorsionStudy) -> Content:
    """What its report says."""
    from linkwright.torsion.page import torsion_content

    return torsion_content(study)


def _figures(study: TorsionStudy) -> dict[str, Figure]:
    """The figures of the report, under names that files may have."""
    from linkwright.kernel.files.output import file_names
    from linkwright.torsion.figures.captions import torsion_figures

    drawn = {one.name: one.figure for one in torsion_figures(study)}
    names = file_names(dict.fromkeys(drawn, ""))
    return {names[name]: figure for name, figure in drawn.items()}
