"""``linkwright cam FILE``: a machine's cams, and the files to make them by."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

from linkwright.kernel.command.answer import Answer
from linkwright.kernel.command.common import Curves, FolderOutput, to_folder
from linkwright.kernel.command.parameter import Option, Value
from linkwright.kernel.errors import ExchangeError, InputError
from linkwright.kernel.later import later
from linkwright.kernel.units.kinds import ANGLE, LENGTH
from linkwright.kernel.units.marks import positive
from linkwright.machine.file_argument import File

if TYPE_CHECKING:
    from linkwright.app.study import Study
    from linkwright.cam.manufacture.drawing import MeasuredOutline

Tolerance = Annotated[
    float,
    Value("--tolerance", positive(LENGTH), "Maximum distance of a drawing from its profile.", "1 um"),
]
Step = Annotated[float, Value("--step", positive(ANGLE), "Step of the tables.", "1 deg")]
By = Annotated[
    str,
    Option("--by", "cam|polar", "Step over the cam angle or over the polar angle."),
]
Form = Annotated[
    str,
    Option(
        "--form", "arcs|spline|cubic|polyline", "Outlines in DXF: arcs, a spline of degree 5 or 3, or chords."
    ),
]
Formats = Annotated[
    str, Option("--formats", "LIST", "Files to write, separated by commas: dxf, csv, svg, step.")
]
To = Annotated[
    FolderOutput,
    to_folder("Folder for the report, results.json and the drawings of the cams.", curves=Curves),
]


def cam_file(
    file: File,
    *,
    tolerance: Tolerance,
    step: Step,
    by: By = "cam",
    form: Form = "arcs",
    formats: Formats = "dxf,csv,svg",
    to: To,
) -> None:
    """Look at the cams of a machine.

    Lift, pressure angle, curvature, forces, what is wrong and what would mend it; with --out a report with
    figures, and drawings for manufacture, each read back and compared with the profile.
    """
    from linkwright.app.study import study
    from linkwright.kernel.command.console import progress
    from linkwright.kernel.command.out import command_line

    options = {
        "tolerance": tolerance,
        "step": step,
        "by": by,
        "form": form,
        "formats": _formats(by, form, formats),
    }
    with progress("computing"):
        machine = file.read()
        if not machine.mechanism.cams:
            raise InputError(f"{file.file}: the machine has no cam; describe one as [mechanism.cams.NAME]")
        studied = study(machine)
    drawn: dict[str, _Drawing] = {}
    findings: list[str] = []
    if to.out is not None:
        with progress("drawing"):
            drawn, findings = _drawn(studied, options)
    listed = [
        {
            "path": name if to.out is None else str(to.out / name),
            "layer": outline.layer,
            "form": outline.form,
            "sides": outline.deviation.sides,
            "deviation": outline.deviation.largest,
            "tolerance": outline.tolerance,
        }
        for name, drawing in drawn.items()
        for outline in drawing.outlines
    ]
    cams = {name: result for name, result in studied.results().items() if name.startswith("cam")}
    answer = Answer(
        machine=machine,
        # The file has what is printed: all curves of a cam are in its drawings.
        results=lambda _: {name: result.to_dict(curves=to.curves) for name, result in cams.items()},
        findings=[*studied.findings, *findings],
        warnings=studied.warnings,
        extra={"files": listed},
        tables=later("cam.tables:cam_tables", studied.cams, studied.cam_sizes, studied.loaded_cams),
        files={
            "report.html": later("app.report.page:report_html", studied, command=command_line()),
            **{name: drawing.data for name, drawing in drawn.items()},
        },
        report=later("app.report.page:content", studied),
        remarks={name: _measured(name, drawing) for name, drawing in drawn.items()},
    )
    to.hand_over(answer)


def _formats(by: str, form: str, formats: str) -> tuple[str, ...]:
    """Formats of the drawings; invalid options are reported before anything is computed."""
    from linkwright.cam.manufacture.fit import FORMS
    from linkwright.cam.manufacture.write import ALL_FORMATS

    wanted = tuple(ending.strip() for ending in formats.split(",") if ending.strip())
    for option, values, known in (
        ("--form", (form,), FORMS),
        ("--by", (by,), ("cam", "polar")),
        ("--formats", wanted, ALL_FORMATS),
    ):
        if unknown := [value for value in values if value not in known]:
            raise InputError(f'{option}: found "{unknown[0]}", expected {", ".join(known)}')
    return wanted


class _Drawing(NamedTuple):
    """A drawing written and read back: its bytes, and what was measured in them."""

    data: bytes
    outlines: tuple[MeasuredOutline, ...]


def _drawn(study: Study, options: dict[str, Any]) -> tuple[dict[str, _Drawing], list[str]]:
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


def _measured(name: str, drawn: _Drawing) -> str:
    most = max(outline.deviation.largest for outline in drawn.outlines)
    sides = "+".join(str(outline.deviation.sides) for outline in drawn.outlines)
    if name.endswith(".csv"):
        return f"{sides} rows, chords between them within {1e3 * most:.3g} mm"
    return f"{sides} pieces, read back within {1e3 * most:.3g} mm"
