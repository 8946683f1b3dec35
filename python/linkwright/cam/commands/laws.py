"""``linkwright cam …``: a machine's cams; the motion laws of cams, compared."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from linkwright.cam.commands.search import search
from linkwright.kernel.command.common import Json
from linkwright.kernel.command.out import Force, out_option, output_folder, write_folder
from linkwright.kernel.errors import InputError

if TYPE_CHECKING:
    from linkwright.cam.law_factors import LawFactors
    from linkwright.kernel.files.output import OutputFolder

Names = Annotated[
    list[str] | None,
    typer.Option("--law", metavar="NAME", help="This law alone. May be given again.", show_default=False),
]
Folder = Annotated[
    Path | None, out_option("Write cam_laws.json and the laws in one figure, as SVG and PNG, there.")
]

# Lines that can still be told apart in one figure; without --law, these.
_DRAWN = ("parabolic", "cycloidal", "modified_trapezoid", "modified_sine", "polynomial_3_4_5", "minimum_jerk")


def cam() -> None:
    """Cams: `linkwright cam FILE` looks at those of a machine; or one of these commands."""


def laws(law: Names = None, json: Json = False, out: Folder = None, force: Force = False) -> None:
    """Factors of the motion laws, for a rise between two dwells.

    Greatest velocity, acceleration, jerk, and velocity times acceleration, and the integrals of the squares,
    with what no law can go below.
    """
    from linkwright.cam.law_factors import cam_laws
    from linkwright.cam.tables.laws import bound_table, law_table
    from linkwright.kernel.command.terminal import print_tables

    folder = output_folder(out, force=force)
    everything = cam_laws()
    chosen = {name: everything[name] for name in _known(law or [], everything)}
    if json:
        _print(chosen)
    else:
        print_tables("", [law_table(chosen), bound_table()], [])
    if folder is not None:
        _write(chosen, [name for name in chosen if law or name in _DRAWN], folder, quiet=json)


# In the order of the help.
CAM = (laws, search)


def _known(wanted: list[str], everything: dict[str, Any]) -> list[str]:
    """The laws that are asked for; all of them without a wish."""
    from linkwright.kernel.description.base import suggestion

    for name in wanted:
        if name not in everything:
            remedy = suggestion(name, everything) or "there is " + ", ".join(everything)
            raise InputError(f'--law: found "{name}", expected the name of a law; {remedy}')
    return wanted or list(everything)


def _object(chosen: dict[str, LawFactors]) -> dict[str, Any]:
    """What is printed and written as JSON."""
    from linkwright.cam.laws.bounds import BOUNDS
    from linkwright.cam.laws.catalogue import LAWS

    laws = {
        name: {**factors.to_dict(), "parameters": LAWS[name].parameters, "source": LAWS[name].source}
        for name, factors in chosen.items()
    }
    bounds = {bound.name: bound._asdict() for bound in BOUNDS}
    results = {"cam_laws": laws, "cam_law_bounds": bounds}
    return {"machine": None, "results": results, "findings": [], "warnings": []}


def _text(chosen: dict[str, LawFactors]) -> str:
    from json import dumps

    return dumps(_object(chosen), allow_nan=False, ensure_ascii=False)


def _print(chosen: dict[str, LawFactors]) -> None:
    typer.echo(_text(chosen))


def _write(chosen: dict[str, LawFactors], drawn: list[str], folder: OutputFolder, *, quiet: bool) -> None:
    """JSON and figures; says where they are."""
    from linkwright.cam.figures.laws import motion_laws_figure
    from linkwright.cam.laws.catalogue import LAWS

    figure = motion_laws_figure({name: LAWS[name].normalised() for name in drawn})
    write_folder(folder, {"cam_laws.json": _text(chosen) + "\n"}, {"cam_laws": figure}, quiet=quiet)
