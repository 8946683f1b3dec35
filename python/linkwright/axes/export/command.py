"""``linkwright law``: the law of a cam or an axis as a cam table of a motion controller."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

from linkwright.kernel.command.answer import Answer, as_wanted
from linkwright.kernel.command.common import Output, to_file
from linkwright.kernel.command.parameter import Argument, Option
from linkwright.kernel.errors import ExchangeError, InputError
from linkwright.kernel.later import later
from linkwright.machine.file_argument import File

if TYPE_CHECKING:
    from linkwright.axes.export.exported import LawExport, MasterLaw
    from linkwright.axes.export.formats import CamFormat

Name = Annotated[str | None, Argument("NAME", "Name of the cam, if there are several.")]
Format = Annotated[
    str | None,
    Option(
        "--to",
        "FORMAT",
        "csv, codesys, codesys-xyva, beckhoff, beckhoff-table, siemens, siemens-table, tab, sew-linear, "
        "sew-cubic, sew-spline or rockwell. Default: all are compared.",
    ),
]
Points = Annotated[
    int | None,
    Option("--points", "N", "Maximum number of points. Default: what the format permits."),
]
To = Annotated[Output, to_file("Write the cam table there; with --to.")]


def law(file: File, name: Name = None, to_format: Format = None, points: Points = None, *, to: To) -> None:
    """Export a law to a motion controller.

    The cam table is read back and interpolated as the controller does; the largest deviations of position,
    velocity and acceleration from the law are shown, with their master angles. Exit code 1 if the format
    cannot hold the law.
    """
    from linkwright.axes.export.exported import law_of
    from linkwright.axes.export.formats import FORMATS, cam_format
    from linkwright.kernel.command.console import progress

    if to.out is not None and to_format is None:
        raise InputError("--out: it writes one cam table; say which by --to")
    forms = list(FORMATS.values()) if to_format is None else [cam_format(to_format)]
    machine = file.read()
    wanted = law_of(machine, name)
    with progress("computing"), as_wanted(machine.units):
        exports, refused = _exports(wanted, forms, points)
    sentences = [*(f"{name}: {why}." for name, why in refused.items()), *_coarse(exports)]
    answer = Answer(
        machine=machine,
        results={"law": {"name": wanted.name, "formats": {each.format: each.to_dict() for each in exports}}},
        # Of several formats, those that serve are an answer.
        findings=sentences if to_format is not None else [],
        warnings=[*(sentences if to_format is None else []), *_warnings(exports)],
        names={name for e in exports for name in (e.format, e.maker, e.numbers)} | set(refused),
        tables=later("axes.export.tables:export_tables", exports, refused, wanted.unit),
        machine_file=(lambda: exports[0].text) if exports else None,
    )
    to.hand_over(answer)


def _exports(
    wanted: MasterLaw, forms: list[CamFormat], points: int | None
) -> tuple[list[LawExport], dict[str, str]]:
    """The law in each format, and why some cannot hold it; of several, those that permit the points."""
    from linkwright.axes.export.exported import exported

    exports: list[LawExport] = []
    refused: dict[str, str] = {}
    for form in forms:
        few = points if points is None or len(forms) == 1 or form.most is None else min(points, form.most)
        try:
            exports.append(exported(wanted, form, few))
        except ExchangeError as error:
            refused[form.name] = str(error)
    return exports, refused


# Share of the travel from which on a deviation is another motion.
_COARSE = 0.01


def _coarse(exports: list[LawExport]) -> list[str]:
    """Formats in which the law has become another one."""
    return [
        f"{e.format}: the position deviates by {100 * e.position_deviation / e.position_peak:.3g} % of the "
        "travel; take more points, or another format."
        for e in exports
        if e.position_deviation > _COARSE * e.position_peak
    ]


def _warnings(exports: list[LawExport]) -> list[str]:
    """What the numbers of a format lose."""
    return [
        f"{each.format}: the numbers keep {each.digits} of 15 significant digits."
        for each in exports
        if each.numbers != "LREAL"
    ]
