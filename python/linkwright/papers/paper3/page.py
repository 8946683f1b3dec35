"""Paper 3 as one HTML page."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from linkwright.papers.page import drawn, heading, rendered
from linkwright.papers.paper3.conclusions import conclusions
from linkwright.papers.paper3.table import COLUMNS, cells

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from linkwright.papers.paper3.paper import Paper3

_CAPTIONS = {
    "scheme": "The equivalent scheme",
    "modes": "Mode shapes",
    "disc": "Inertia of a throw, and the disc that stands for it",
    "formulas": "What the formulas make of the critical speed",
    "amplitude": "Forced vibration along the shaft at the speed of service",
    "unevenness": "Unevenness along the shaft at the speed of service",
    "cylinders": "Unevenness cylinder by cylinder: what would be told of a sound engine",
    "delta": "What a weak cylinder does to the unevenness of the whole cycle",
    "weak": "Which cylinder is weak, told from the orders of the speed",
}


def page(paper: Paper3, figures: Mapping[str, Figure]) -> str:
    """Write paper 3 as an HTML page.

    Parameters
    ----------
    paper : Paper3
        The paper.
    figures : mapping of str to Figure
        By the names of their files.

    Returns
    -------
    str
        The page, with its figures in it.
    """
    return rendered(
        "paper3/paper3.html",
        **heading(paper.published, conclusions(paper)),
        paper=paper,
        heads=COLUMNS,
        shifts=cells(paper),
        figures=drawn(figures, _CAPTIONS),
        about_figures="The V-12 of the library, free end to the left; cylinders 1 to 6 have the master rods.",
    )
