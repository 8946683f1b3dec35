"""``linkwright cam FILE``: a machine's cams, and the files to make them by."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from linkwright.cli.common import File, Json, Sets, option_value
from linkwright.errors import ExchangeError, InputError

if TYPE_CHECKING:
    from linkwright.analysis.study import Study
    from linkwright.exchange.drawing import Written

Folder = Annotated[
    Path | None,
    typer.Option(
        "--out",
        metavar="DIR",
        help="Write a report, results.json and the drawings of the cams there.",
        show_default=False,
    ),
]
Tolerance = Annotated[
    str, typer.Option("--tolerance", metavar="LENGTH", help="Largest distance of a drawing from its profile.")
]
Step = Annotated[str, typer.Option("--step", metavar="ANGLE", help="Step of the tables.")]
By = Annotated[
    str, typer.Option("--by", metavar="cam|polar", help="Whether it is one of the cam or of the polar angle.")
]
Form = Annotated[
    str,
    typer.Option(
        "--form",
        metavar="arcs|spline|cubic|polyline",
        help="Outlines in DXF: arcs without kinks, a spline of degree 5 or 3, or chords.",
    ),
]
Formats = Annotated[
    str, typer.Option("--formats", metavar="LIST", help="Which files, of dxf, csv, svg, step; with commas.")
]
Curves = Annotated[bool, typer.Option("--curves", help="With --json: curves too, not scalars alone.")]


def cam_file(
    file: File,
    set: Sets = None,
    json: Json = False,
    curves: Curves = False,
    out: Folder = None,
    tolerance: Tolerance = "1 um",
    step: Step = "1 deg",
    by: By = "cam",
    form: Form = "arcs",
    formats: Formats = "dxf,csv,svg",
) -> None:
    """Look at the cams of a machine.

    Lift, pressure angle, curvature, forces, what is wrong and what would mend it; with --out a report with
    figures, and drawings for manufacture, each read back and compared with the profile.
    """
    from linkwright.cli.tables import progress

    options = _options(tolerance, step, by, form, formats)
    with progress("computing"):
        study = _studied(file, set or [])
    with progress("drawing"):
        written, findings = _drawn(study, out, options) if out is not None else ([], [])
    findings = [*study.findings, *findings]
    shown = _object(study, written, findings, curves=curves)
    if json:
        _print_json(shown)
    else:
        _print(study, findings)
    if out is not None:
        _write(study, shown, written, out, quiet=json)
    if findings:
        raise typer.Exit(1)


def _options(tolerance: str, step: str, by: str, form: str, formats: str) -> dict[str, Any]:
    """What the drawings shall be; what makes no sense is told before anything is computed."""
    from linkwright.exchange.fit import FORMS
    from linkwright.exchange.write import ALL_FORMATS
    from linkwright.units import ANGLE, LENGTH

    wanted = tuple(each.strip() for each in formats.split(",") if each.strip())
    for option, values, known in (
        ("--form", (form,), FORMS),
        ("--by", (by,), ("cam", "polar")),
        ("--formats", wanted, ALL_FORMATS),
    ):
        if unknown := [value for value in values if value not in known]:
            raise InputError(f'{option}: found "{unknown[0]}", expected {", ".join(known)}')
    lengths = {"tolerance": option_value("--tolerance", tolerance, LENGTH)}
    if lengths["tolerance"] <= 0:
        raise InputError(f'--tolerance: found "{tolerance}", expected more than 0, such as "1 um"')
    return {**lengths, "step": option_value("--step", step, ANGLE), "by": by, "form": form, "formats": wanted}


def _studied(file: Path, sets: list[str]) -> Study:
    """Everything about a machine that has cams."""
    from linkwright.analysis.study import study
    from linkwright.files.read import read

    machine = read(file, sets)
    if not machine.mechanism.cams:
        raise InputError(f"{file}: the machine has no cam; describe one as [mechanism.cams.NAME]")
    return study(machine)


def _drawn(study: Study, folder: Path, options: dict[str, Any]) -> tuple[list[Written], list[str]]:
    """Drawings of the cams that can be made; what cannot be drawn is a finding."""
    from linkwright.analysis.cam.faults import cam_faults
    from linkwright.exchange.cam import cam_drawings
    from linkwright.exchange.write import write_drawing

    written: list[Written] = []
    findings: list[str] = []
    for profile in study.cams:
        if cam_faults(profile):
            continue
        try:
            for drawing in cam_drawings(profile):
                written += write_drawing(folder, drawing, **options)
        except ExchangeError as error:
            findings.append(f"Cam {profile.name}: {error}.")
    return written, findings


def _object(study: Study, written: list[Written], findings: list[str], *, curves: bool) -> dict[str, Any]:
    """What is printed and written as JSON: the results of cams, and the files."""
    from linkwright.analysis.result import finite

    results = {
        name: result.to_dict(curves=curves)
        for name, result in study.results().items()
        if name.startswith("cam")
    }
    files = [
        {
            "path": str(each.path),
            "layer": outline.layer,
            "form": outline.form,
            "sides": outline.deviation.sides,
            "deviation": outline.deviation.largest,
            "tolerance": outline.tolerance,
        }
        for each in written
        for outline in each.outlines
    ]
    warnings = [*findings, *study.warnings]
    told = {"findings": findings, "warnings": warnings, "files": files}
    return {"machine": study.machine.name, "results": finite(results), **told}


def _print_json(shown: dict[str, Any]) -> None:
    from json import dumps

    typer.echo(dumps(shown, allow_nan=False, ensure_ascii=False))


def _print(study: Study, findings: list[str]) -> None:
    """Tables for people."""
    from linkwright.cli.tables import print_tables
    from linkwright.report.cam_tables import cam_tables

    print_tables("", list(cam_tables(study)), findings, study.warnings)


def _write(study: Study, shown: dict[str, Any], written: list[Written], folder: Path, *, quiet: bool) -> None:
    """Report and results; says where everything is, and what was measured in the drawings."""
    from json import dumps

    from linkwright.cli.run import command_line
    from linkwright.report import report_html

    texts = {
        "results.json": dumps(shown, allow_nan=False, ensure_ascii=False) + "\n",
        "report.html": report_html(study, command=command_line()),
    }
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, text in texts.items():
            (folder / name).write_text(text, encoding="utf-8")
    except OSError as error:
        raise InputError(f"{folder}: cannot be written to ({error.strerror or error})") from None
    lines = [str(folder / name) for name in texts] + [_told(each) for each in written]
    typer.echo("Written:\n" + "\n".join(f"  {line}" for line in lines), err=quiet)


def _told(written: Written) -> str:
    """A drawing with what was measured in it."""
    most = max(each.deviation.largest for each in written.outlines)
    sides = "+".join(str(each.deviation.sides) for each in written.outlines)
    if written.path.suffix == ".csv":
        return f"{written.path}: {sides} rows, chords between them within {1e3 * most:.3g} mm"
    return f"{written.path}: {sides} pieces, read back within {1e3 * most:.3g} mm"
