"""``linkwright torsion FILE``: torsional vibration of a train."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from linkwright.cli.common import File, Json, Sets
from linkwright.errors import InputError

if TYPE_CHECKING:
    from linkwright.analysis.torsion.study import TorsionStudy

Folder = Annotated[
    Path | None,
    typer.Option(
        "--out",
        metavar="DIR",
        help="Write report.html, results.json, and scheme and mode shapes as SVG and PNG there.",
        show_default=False,
    ),
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
    file: File, set: Sets = None, json: Json = False, holzer: Holzer = None, out: Folder = None
) -> None:
    """Torsional vibration of a train: modes, and under its torques all that its parts bear.

    Natural frequencies, shapes and nodes; with torques and [train.run] in the file also critical speeds,
    torques, stresses, limits, barred speeds, unevenness and heat. Exit code 1 if a limit is exceeded.
    """
    from linkwright.analysis.torsion.study import torsion_study
    from linkwright.cli.tables import progress
    from linkwright.files.read import read

    machine = read(file, set or [])
    with progress("computing"):
        study = torsion_study(machine, holzer=holzer or ())
    shown = _object(study)
    if json:
        typer.echo(shown, nl=False)
    else:
        _print(study)
    if out is not None:
        _write(study, shown, out, quiet=json)
    if study.findings:
        raise typer.Exit(1)


def _object(study: TorsionStudy) -> str:
    """One JSON object."""
    from json import dumps

    from linkwright.analysis.result import finite

    head = {"machine": study.machine.name} | ({"balance": study.balance} if study.balance else {})
    told = {"findings": study.findings, "warnings": [*study.findings, *study.warnings]}
    shown = {**head, "results": finite(study.results()), **told}
    return dumps(shown, allow_nan=False, ensure_ascii=False) + "\n"


def _print(study: TorsionStudy) -> None:
    """Tables for people."""
    from linkwright.cli.tables import print_tables
    from linkwright.report.torsion_tables import study_tables

    print_tables(study.balance, list(study_tables(study)), study.findings, study.warnings)


def _write(study: TorsionStudy, shown: str, folder: Path, *, quiet: bool) -> None:
    """Report, results and drawings; says where they are."""
    from linkwright.cli.run import command_line
    from linkwright.cli.tables import progress
    from linkwright.plot import modes_figure, scheme_figure, svg
    from linkwright.report.torsion_page import torsion_html

    with progress("drawing"):
        page = torsion_html(study, command=command_line())
        figures = {"scheme": scheme_figure(study.scheme), "mode_shapes": modes_figure(study.free)}
    try:
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "results.json").write_text(shown, encoding="utf-8")
        (folder / "report.html").write_text(page, encoding="utf-8")
        for name, figure in figures.items():
            (folder / f"{name}.svg").write_text(svg(figure), encoding="utf-8")
            figure.savefig(folder / f"{name}.png", dpi=150)
    except OSError as error:
        raise InputError(f"{folder}: cannot be written to ({error.strerror or error})") from None
    drawn = [f"{name}.{kind}" for name in figures for kind in ("svg", "png")]
    names = ["results.json", "report.html", *drawn]
    typer.echo("Written:\n" + "\n".join(f"  {folder / name}" for name in names), err=quiet)
