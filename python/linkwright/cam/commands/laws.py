"""``linkwright cam …``: a machine's cams; the motion laws of cams, compared."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from linkwright.kernel.command.answer import Answer, hand_over
from linkwright.kernel.command.common import Json
from linkwright.kernel.command.out import Force, out_option, output_folder
from linkwright.kernel.command.parameter import Option
from linkwright.kernel.errors import InputError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from linkwright.cam.law_factors import LawFactors
    from linkwright.kernel.page.table import Table

Names = Annotated[
    list[str] | None,
    Option("--law", metavar="NAME", help="This law alone. May be given again.", show_default=False),
]
Folder = Annotated[
    Path | None, out_option("Write cam_laws.json and the laws in one figure, as SVG and PNG, there.")
]

# Lines that can still be distinguished in one figure; without --law, these.
_DRAWN = ("parabolic", "cycloidal", "modified_trapezoid", "modified_sine", "polynomial_3_4_5", "minimum_jerk")


def laws(law: Names = None, json: Json = False, out: Folder = None, force: Force = False) -> None:
    """Factors of the motion laws, for a rise between two dwells.

    Maximum velocity, acceleration, jerk, and velocity times acceleration, and the integrals of the squares,
    with theoretical lower bounds.
    """
    from linkwright.cam.law_factors import cam_laws

    folder = output_folder(out, force=force)
    everything = cam_laws()
    chosen = {name: everything[name] for name in _known(law or [], everything)}
    drawn = [name for name in chosen if law or name in _DRAWN]
    answer = Answer(
        machine=None,
        results=lambda _: _results(chosen),
        tables=partial(_tables, chosen),
        results_file="cam_laws.json",
        figures=partial(_figures, drawn),
    )
    hand_over(answer, json=json, folder=folder)


# In the order of the help.


def _known(wanted: list[str], everything: dict[str, Any]) -> list[str]:
    """The laws that are asked for; all of them without a wish."""
    from linkwright.kernel.description.base import suggestion

    for name in wanted:
        if name not in everything:
            remedy = suggestion(name, everything) or "there is " + ", ".join(everything)
            raise InputError(f'--law: found "{name}", expected the name of a law; {remedy}')
    return wanted or list(everything)


def _results(chosen: dict[str, LawFactors]) -> dict[str, Any]:
    """The factors of each law, and their theoretical lower bounds."""
    from linkwright.cam.laws.catalogue import BOUNDS, LAWS

    laws = {
        name: {**factors.to_dict(), "parameters": LAWS[name].parameters, "source": LAWS[name].source}
        for name, factors in chosen.items()
    }
    return {"cam_laws": laws, "cam_law_bounds": {bound.name: bound._asdict() for bound in BOUNDS}}


def _tables(chosen: dict[str, LawFactors]) -> list[Table]:
    """Tables for people."""
    from linkwright.cam.tables import bound_table, law_table

    return [law_table(chosen), bound_table()]


def _figures(drawn: list[str]) -> dict[str, Figure]:
    """The laws in one figure."""
    from linkwright.cam.figures.cam import motion_laws_figure
    from linkwright.cam.laws.catalogue import LAWS

    return {"cam_laws": motion_laws_figure({name: LAWS[name].normalised() for name in drawn})}
