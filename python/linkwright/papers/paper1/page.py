"""Paper 1 as one HTML page."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from linkwright.papers.cell import Cell
from linkwright.papers.page import drawing, drawn, heading, rendered
from linkwright.papers.paper1.conclusions import conclusions
from linkwright.papers.paper1.paper import WAYS, Drive, Paper1
from linkwright.papers.published import QUANTITIES

if TYPE_CHECKING:
    from matplotlib.figure import Figure


_ABOUT_FIGURES = (
    "As figures 5 to 12 of the paper: load and inertia over a turn of the crank [°], run-up, one turn of "
    "steady motion. Dashed: mean of the load; published extremes; published end of the run-up."
)


def page(paper: Paper1, figures: Mapping[str, Figure]) -> str:
    """Write a paper as an HTML page.

    Parameters
    ----------
    paper : Paper1
        The paper.
    figures : mapping of str to Figure
        ``"evenness"``, and each drive's under the name of its machine.

    Returns
    -------
    str
        The page, with its figures in it.
    """
    printed = vars(paper.published)
    captions = {each.published.machine: each.published.name for each in paper.drives}
    own = {name: figure for name, figure in figures.items() if name in captions}
    return rendered(
        "paper1/paper1.html",
        **heading(printed, conclusions(paper)),
        paper=paper,
        quantities=QUANTITIES,
        ways=WAYS,
        number_of=number,
        percent=percent,
        reasons=reasons,
        evenness=drawing(figures["evenness"], "evenness"),
        figures=drawn(own, captions),
        about_figures=_ABOUT_FIGURES,
    )


def number(value: float | None) -> str:
    """A computed value with five digits.

    Parameters
    ----------
    value : float or None
        None gives a dash.

    Returns
    -------
    str
        The digits.
    """
    return "–" if value is None else f"{value:.5g}"


def percent(cell: Cell) -> str:
    """The deviation in percent.

    Parameters
    ----------
    cell : Cell
        The cell.

    Returns
    -------
    str
        With its sign; empty where there is nothing to compare.
    """
    if cell.deviation is None:
        return ""
    if cell.given:
        return "taken"
    digits = 2 if cell.kind == "reproduced" else 1
    return f"{100 * cell.deviation:+.{digits}f} %".replace("-", "−")


def reasons(drive: Drive) -> list[str]:
    """Why values of a drive are not reproduced, each reason once.

    Parameters
    ----------
    drive : Drive
        The drive.

    Returns
    -------
    list of str
        Way, quantities and reason.
    """
    found: dict[tuple[str, str], list[str]] = {}
    for way, cells in drive.cells.items():
        for name, cell in cells.items():
            if cell.kind == "far":
                found.setdefault((way, cell.because), []).append(QUANTITIES[name][0])
    return [
        f"{WAYS[way]}: {', '.join(symbols)} not reproduced because {because}."
        for (way, because), symbols in found.items()
    ]
