"""``linkwright run FILE``: everything that can be computed about a machine."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from linkwright.kernel.command.common import File, Json, Outside, Sets, option_value
from linkwright.kernel.command.out import Force, command_line, out_option, output_folder, say_written

if TYPE_CHECKING:
    from linkwright.app.study import Study
    from linkwright.kernel.files.output import OutputFolder

Curves = Annotated[bool, typer.Option("--curves", help="With --json: curves too, not scalars alone.")]
Folder = Annotated[Path | None, out_option("Write results.json, the curves as CSV and report.html there.")]
Accuracy = Annotated[
    float, typer.Option("--accuracy", metavar="X", help="Relative accuracy of the steady speed.")
]
Method = Annotated[
    Literal["newton", "baranov"],
    typer.Option("--method", help="baranov: the published step method beside the exact solution."),
]
Step = Annotated[
    str, typer.Option("--step", metavar="ANGLE", help="Step of the crank angle for --method baranov.")
]


def run(
    file: File,
    set: Sets = None,
    allow_outside: Outside = False,
    json: Json = False,
    curves: Curves = False,
    out: Folder = None,
    accuracy: Accuracy = 1e-10,
    method: Method = "newton",
    step: Step = "1 deg",
    force: Force = False,
) -> None:
    """Compute how a machine moves.

    Reduced inertia and load, steady motion and its evenness, run-up; with --out also a report.
    """
    folder = output_folder(out, force=force)
    steps = step if method == "baranov" else None
    if json:
        result = _studied(file, set or [], accuracy, steps, allow_outside=allow_outside)
        _print_json(result, curves=curves)
    else:
        result = _shown(file, set or [], accuracy, steps, allow_outside=allow_outside)
    if folder is not None:
        _write(result, folder, quiet=json)
    if result.findings:
        raise typer.Exit(1)


def _studied(file: Path, sets: list[str], accuracy: float, step: str | None, *, allow_outside: bool) -> Study:
    """Read the file and study the machine."""
    from linkwright.app.study import study
    from linkwright.kernel.units import ANGLE
    from linkwright.machine.read import read

    angle = None if step is None else option_value("--step", step, ANGLE)
    return study(read(file, sets, allow_outside=allow_outside), accuracy=accuracy, step=angle)


def _shown(file: Path, sets: list[str], accuracy: float, step: str | None, *, allow_outside: bool) -> Study:
    """Study the machine and print tables for people."""
    from linkwright.app.commands.check import summary
    from linkwright.app.report.tables import tables
    from linkwright.kernel.command.terminal import print_tables, progress

    with progress("computing"):
        result = _studied(file, sets, accuracy, step, allow_outside=allow_outside)
    print_tables(summary(result.machine), tables(result), result.findings, result.warnings)
    return result


def _print_json(study: Study, *, curves: bool) -> None:
    """One object on standard output."""
    from json import dumps

    typer.echo(dumps(study.to_dict(curves=curves), allow_nan=False, ensure_ascii=False))


def _write(study: Study, folder: OutputFolder, *, quiet: bool) -> None:
    """All files of a study; says where they are, on standard error where the output is JSON."""
    from linkwright.kernel.command.terminal import progress

    with progress("writing the report"):
        paths = folder.write(_files(study))
    say_written(paths, quiet=quiet)


def _files(study: Study) -> dict[str, str]:
    """The files by name."""
    from json import dumps

    from linkwright.app.report.page import report_html
    from linkwright.kernel.files.output import file_names
    from linkwright.kernel.page.csv import curves_csv

    texts = {"results.json": dumps(study.to_dict(curves=True), allow_nan=False, ensure_ascii=False) + "\n"}
    names = file_names(dict.fromkeys(study.results(), ".csv"))
    tables = {names[name]: curves_csv(result) for name, result in study.results().items()}
    texts |= {name: text for name, text in tables.items() if text}
    if study.topper is not None and not study.topper.obstacle:
        from linkwright.topping.tables.topper import edge_csv

        texts["topper_edge.csv"] = edge_csv(study.topper)
    texts["report.html"] = report_html(study, command=command_line())
    return texts
