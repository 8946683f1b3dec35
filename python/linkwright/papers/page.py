"""A paper as one HTML page that needs nothing but itself."""

from __future__ import annotations

import re
from collections.abc import Mapping
from importlib.resources import files
from typing import TYPE_CHECKING

from linkwright.papers.cell import Cell
from linkwright.papers.paper1 import WAYS, Drive, Paper1
from linkwright.papers.paper1_conclusions import conclusions
from linkwright.papers.published import QUANTITIES
from linkwright.plot.svg import svg

if TYPE_CHECKING:
    from matplotlib.figure import Figure


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
    from jinja2 import Environment
    from markupsafe import Markup

    template = files("linkwright.papers").joinpath("page.html").read_text(encoding="utf-8")
    drawn = {name: Markup(own_names(svg(figure), name)) for name, figure in figures.items()}
    return (
        Environment(autoescape=True)
        .from_string(template)
        .render(
            paper=paper,
            conclusions=conclusions(paper),
            quantities=QUANTITIES,
            ways=WAYS,
            number=number,
            percent=percent,
            reasons=reasons,
            evenness=drawn["evenness"],
            figures=[(each, drawn[each.published.machine]) for each in paper.drives],
        )
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


def own_names(drawing: str, name: str) -> str:
    """The drawing with names inside that no other of the page has.

    Parameters
    ----------
    drawing : str
        An SVG element.
    name : str
        What its names begin with.
    """
    return re.sub(r'(\bid="|href="#|url\(#)', rf"\g<1>{name}-", drawing)
