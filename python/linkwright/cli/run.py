"""``linkwright run FILE``: everything that can be computed about a machine."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from linkwright.cli.common import File, Json, Sets

if TYPE_CHECKING:
    from linkwright.analysis.study import Study
    from linkwright.machine import Machine

Curves = Annotated[bool, typer.Option("--curves", help="With --json: curves too, not scalars alone.")]
Folder = Annotated[
    Path | None,
    typer.Option(
        "--out",
        metavar="DIR",
        help="Write results.json, the curves as CSV and report.html there.",
        show_default=False,
    ),
]
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
    json: Json = False,
    curves: Curves = False,
    out: Folder = None,
    accuracy: Accuracy = 1e-10,
    method: Method = "newton",
    step: Step = "1 deg",
) -> None:
    """Compute how a machine moves.

    Reduced inertia and load, steady motion and its evenness, run-up; with --out also a report.
    """
    from linkwright.analysis.study import study
    from linkwright.files.read import read
    from linkwright.units import ANGLE, parse

    machine = read(file, set or ())
    angle = parse(step, ANGLE) if method == "baranov" else None
    result = study(machine, accuracy=accuracy, step=angle)
    if json:
        _print_json(result, curves=curves)
    raise typer.Exit(1 if result.findings else 0)


def _print_json(study: Study, *, curves: bool) -> None:
    """One object on standard output."""
    from json import dumps

    typer.echo(dumps(study.to_dict(curves=curves), allow_nan=False, ensure_ascii=False))
