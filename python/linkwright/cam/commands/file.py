"""``linkwright cam FILE``: a machine's cams, and the files to make them by."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

from linkwright.kernel.command.answer import Answer, hand_over
from linkwright.kernel.command.common import Curves, File, Json, Outside, Sets, option_value
from linkwright.kernel.command.out import Force, out_option, output_folder
from linkwright.kernel.command.parameter import Option
from linkwright.kernel.errors import ExchangeError, InputError

if TYPE_CHECKING:
    from linkwright.app.study import Study
    from linkwright.cam.manufacture.drawing import MeasuredOutline
    from linkwright.kernel.files.output import OutputFolder
    from linkwright.kernel.page.content import Content
    from linkwright.kernel.page.table import Table

Folder = Annotated[
    Path | None, out_option("Folder for the report, results.json and the drawings of the cams.")
]
Tolerance = Annotated[
    str, Option("--tolerance", metavar="LENGTH", help="Maximum distance of a drawing from its profile.")
]
Step = Annotated[str, Option("--step", metavar="ANGLE", help="Step of the tables.")]
By = Annotated[
    str,
    Option("--by", metavar="cam|polar", help="Step over the cam angle or over the polar angle."),
]
Form = Annotated[
    str,
    Option(
        "--form",
        metavar="arcs|spline|cubic|polyline",
        help="Outlines in DXF: arcs, a spline of degree 5 or 3, or chords.",
    ),
]
Formats = Annotated[
    str, Option("--formats", metavar="LIST", help="Files to write, separated by commas: dxf, csv, svg, step.")
]


def cam_file(
    file: File,
    set: Sets = None,
    allow_outside: Outside = False,
    json: Json = False,
    curves: Curves = False,
    out: Folder = None,
    tolerance: Tolerance = "1 um",
    step: Step = "1 deg",
    by: By = "cam",
    form: Form = "arcs",
    formats: Formats = "dxf,csv,svg",
    force: Force = False,
) -> None:
    """Look at the cams of a machine.

    Lift, pressure angle, curvature, forces, what is wrong and what would mend it; with --out a report with
    figures, and drawings for manufacture, each read back and compared with the profile.
    """
    from linkwright.kernel.command.console import progress

    folder = output_folder(out, force=force)
    options = _options(tolerance, step, by, form, formats)
    with progress("computing"):
        study = _studied(file, set or [], allow_outside=allow_outside)
    drawn: dict[str, _Drawing] = {}
    findings: list[str] = []
    if folder is not None:
        with progress("drawing"):
            drawn, findings = _drawn(study, options)
    findings = [*study.findings, *findings]
    answer = _answer(study, folder, drawn, findings, curves=curves)
    hand_over(answer, json=json, curves=curves, folder=folder)


def _options(tolerance: str, step: str, by: str, form: str, formats: str) -> dict[str, Any]:
    """What the drawings shall be; what makes no sense is reported before anything is computed."""
    from linkwright.cam.manufacture.fit import FORMS
    from linkwright.cam.manufacture.write import ALL_FORMATS
    from linkwright.kernel.units.kinds import ANGLE, LENGTH
    from linkwright.kernel.units.marks import positive

    wanted = tuple(ending.strip() for ending in formats.split(",") if ending.strip())
    for option, values, known in (
        ("--form", (form,), FORMS),
        ("--by", (by,), ("cam", "polar")),
        ("--formats", wanted, ALL_FORMATS),
    ):
        if unknown := [value for value in values if value not in known]:
            raise InputError(f'{option}: found "{unknown[0]}", expected {", ".join(known)}')
    return {
        "tolerance": option_value("--tolerance", tolerance, positive(LENGTH)),
        "step": option_value("--step", step, positive(ANGLE)),
        "by": by,
        "form": form,
        "formats": wanted,
    }


def _studied(file: Path, sets: list[str], *, allow_outside: bool) -> Study:
    """Everything about a machine that has cams."""
    from linkwright.app.study import study
    from linkwright.machine.read import read

    machine = read(file, sets, allow_outside=allow_outside)
    if not machine.mechanism.cams:
        raise InputError(f"{file}: the machine has no cam; describe one as [mechanism.cams.NAME]")
    return study(machine)


class _Drawing(NamedTuple):
    """A drawing that was written and read back: its bytes, and what was measured in them."""

    data: bytes
    outlines: tuple[MeasuredOutline, ...]


def _drawn(study: Study, options: dict[str, Any]) -> tuple[dict[str, _Drawing], list[str]]:
    """Name of the file → drawing, of the cams that can be made; what cannot be drawn is a finding."""
    from tempfile import TemporaryDirectory

    from linkwright.cam.manufacture.drawing import cam_drawings
    from linkwright.cam.manufacture.write import write_drawing
    from linkwright.cam.profile.faults import cam_faults
    from linkwright.kernel.files.output import file_names

    sound = [profile for profile in study.cams if not cam_faults(profile)]
    drawings = [(profile, drawing) for profile in sound for drawing in cam_drawings(profile)]
    # Names may differ in letters alone that no file can have.
    stems = file_names({drawing.name: "" for _, drawing in drawings})
    findings: list[str] = []
    drawn: dict[str, _Drawing] = {}
    with TemporaryDirectory() as folder:
        for profile, drawing in drawings:
            try:
                written = write_drawing(folder, drawing, stem=stems[drawing.name], **options)
            except ExchangeError as error:
                findings.append(f"Cam {profile.name}: {error}.")
            else:
                drawn |= {file.path.name: _Drawing(file.path.read_bytes(), file.outlines) for file in written}
    return drawn, findings


def _answer(
    study: Study,
    folder: OutputFolder | None,
    drawn: dict[str, _Drawing],
    findings: list[str],
    *,
    curves: bool,
) -> Answer:
    """The results of cams, and the files."""
    listed = [
        {
            "path": name if folder is None else str(folder.path / name),
            "layer": outline.layer,
            "form": outline.form,
            "sides": outline.deviation.sides,
            "deviation": outline.deviation.largest,
            "tolerance": outline.tolerance,
        }
        for name, drawing in drawn.items()
        for outline in drawing.outlines
    ]
    cams = {name: result for name, result in study.results().items() if name.startswith("cam")}
    return Answer(
        machine=study.machine.name,
        units=study.machine.units,
        # The file has what is printed: all curves of a cam are in its drawings.
        results=lambda _: {name: result.to_dict(curves=curves) for name, result in cams.items()},
        findings=findings,
        warnings=study.warnings,
        extra={"files": listed},
        tables=partial(_tables, study),
        files=partial(_files, study, drawn),
        report=partial(_report, study),
        remarks={name: _measured(name, drawing) for name, drawing in drawn.items()},
    )


def _tables(study: Study) -> list[Table]:
    """Tables for people."""
    from linkwright.cam.tables import cam_tables

    return list(cam_tables(study.cams, study.cam_sizes, study.loaded_cams))


def _report(study: Study) -> Content:
    """What its report says."""
    from linkwright.app.report.page import content

    return content(study)


def _files(study: Study, drawn: dict[str, _Drawing]) -> dict[str, str | bytes]:
    """Report and drawings."""
    from linkwright.app.report.page import report_html
    from linkwright.kernel.command.out import command_line

    return {
        "report.html": report_html(study, command=command_line()),
        **{name: drawing.data for name, drawing in drawn.items()},
    }


def _measured(name: str, drawn: _Drawing) -> str:
    """What was measured in a drawing."""
    most = max(outline.deviation.largest for outline in drawn.outlines)
    sides = "+".join(str(outline.deviation.sides) for outline in drawn.outlines)
    if name.endswith(".csv"):
        return f"{sides} rows, chords between them within {1e3 * most:.3g} mm"
    return f"{sides} pieces, read back within {1e3 * most:.3g} mm"
