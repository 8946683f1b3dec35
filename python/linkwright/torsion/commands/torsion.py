"""``linkwright torsion FILE``: torsional vibration of a train."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from linkwright.kernel.command.common import File, Json, Outside, Sets
from linkwright.kernel.command.out import Force, out_option, output_folder, write_folder

if TYPE_CHECKING:
    from linkwright.kernel.files.output import OutputFolder
    from linkwright.torsion.study import TorsionStudy

Folder = Annotated[
    Path | None,
    out_option("Write report.html, results.json, and scheme and mode shapes as SVG and PNG there."),
]
Holzer = Annotated[
    list[float] | None,
    typer.Option(
        "--holzer",
        metavar="HZ",
        help="Holzer's table at this frequency. May be given again.",
        show_default=False,
    ),
]


def torsion(
    file: File,
    set: Sets = None,
    allow_outside: Outside = False,
    json: Json = False,
    holzer: Holzer = None,
    out: Folder = None,
    force: Force = False,
) -> None:
    """Torsional vibration of a train: modes, and under its torques all that its parts bear.

    Natural frequencies, shapes and nodes; with torques and [train.run] in the file also critical speeds,
    torques, stresses, limits, barred speeds, unevenness and heat. Exit code 1 if a limit is exceeded.
    """
    from linkwright.kernel.command.terminal import progress
    from linkwright.machine.read import read
    from linkwright.torsion.study import torsion_study

    folder = output_folder(out, force=force)
    machine = read(file, set or [], allow_outside=allow_outside)
    with progress("computing"):
        study = torsion_study(machine, holzer=holzer or ())
    shown = _object(study)
    if json:
        typer.echo(shown, nl=False)
    else:
        _print(study)
    if folder is not None:
        _write(study, shown, folder, quiet=json)
    if study.findings:
        raise typer.Exit(1)


def _object(study: TorsionStudy) -> str:
    """One JSON object."""
    from json import dumps

    from linkwright.kernel.result import finite

    head = {"machine": study.machine.name} | ({"balance": study.balance} if study.balance else {})
    told = {"findings": study.findings, "warnings": [*study.findings, *study.warnings]}
    shown = {**head, "results": finite(study.results()), **told}
    return dumps(shown, allow_nan=False, ensure_ascii=False) + "\n"


def _print(study: TorsionStudy) -> None:
    """Tables for people."""
    from linkwright.kernel.command.terminal import print_tables
    from linkwright.torsion.tables.torsion import study_tables

    print_tables(study.balance, list(study_tables(study)), study.findings, study.warnings)


def _write(study: TorsionStudy, shown: str, folder: OutputFolder, *, quiet: bool) -> None:
    """Report, results and drawings; says where they are."""
    from linkwright.kernel.command.out import command_line
    from linkwright.kernel.command.terminal import progress
    from linkwright.torsion.figures.modes import modes_figure
    from linkwright.torsion.figures.scheme import scheme_figure
    from linkwright.torsion.page import torsion_html

    with progress("drawing"):
        page = torsion_html(study, command=command_line())
        figures = {"scheme": scheme_figure(study.scheme), "mode_shapes": modes_figure(study.free)}
    write_folder(folder, {"results.json": shown, "report.html": page}, figures, quiet=quiet)
