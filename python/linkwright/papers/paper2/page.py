"""Paper 2 as one HTML page."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from linkwright.papers.page import drawn, heading, rendered
from linkwright.papers.paper2.conclusions import conclusions
from linkwright.papers.paper2.table import COLUMNS, cells

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from linkwright.papers.paper2.paper import Paper2

_CAPTIONS = {
    "figure1": "Figure 1: the cart there and back",
    "figure3": "Figure 3: the cam between its followers",
    "shape": "Pressure angle and curvature of the profile",
    "start": "The start section and the minima of ∫ jerk²",
    "alternatives": "Other laws and the crank",
    "course": "The cart in steady motion",
}


def page(paper: Paper2, figures: Mapping[str, Figure]) -> str:
    """Write paper 2 as an HTML page.

    Parameters
    ----------
    paper : Paper2
        The paper.
    figures : mapping of str to Figure
        By the names of their files.

    Returns
    -------
    str
        The page, with its figures in it.
    """
    return rendered(
        "paper2/paper2.html",
        **heading(paper.published, conclusions(paper)),
        paper=paper,
        heads=[(head, unit) for head, unit, _ in COLUMNS],
        drives=cells(paper.alternatives),
        figures=drawn(figures, _CAPTIONS),
        about_figures="Cam angle φ from the start of the forward stroke; half a turn is one stroke.",
    )
