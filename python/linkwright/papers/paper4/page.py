"""Paper 4 as one HTML page."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from linkwright.papers.page import drawn, heading, rendered
from linkwright.papers.paper4.conclusions import conclusions

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from linkwright.papers.paper4.paper import Paper4

_CAPTIONS = {
    "figure3": "Figure 3: angle of the lever, continuous regime",
    "figure4": "Figure 4: its transfer function, continuous regime",
    "figure5": "Figure 5: angle of the lever, intermittent regime",
    "figure6": "Figure 6: its transfer function, intermittent regime",
}


def page(paper: Paper4, figures: Mapping[str, Figure]) -> str:
    """Write paper 4 as an HTML page.

    Parameters
    ----------
    paper : Paper4
        The paper.
    figures : mapping of str to Figure
        By the names of their files.

    Returns
    -------
    str
        The page, with its figures in it.
    """
    return rendered(
        "rows.html",
        **heading(paper.published, conclusions(paper)),
        paper=paper,
        figures=drawn(figures, _CAPTIONS),
        about_figures="Crank angle from 12 o'clock, counter-clockwise, the well to the right.",
    )
