"""Paper 5 as one HTML page."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from linkwright.papers.page import drawn, heading, rendered
from linkwright.papers.paper5.conclusions import conclusions
from linkwright.papers.paper5.table import HEADS, about, tables

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from linkwright.papers.paper5.paper import Paper5

_CAPTIONS = {
    "figure3": "Figure 3: lines of equal length over root diameter and knife speed",
    "step": "The step from (4) to (5), and the lengths over the angle",
    "bands": "The result: bands of heads for which it holds; the green one ends where the edge would retreat",
    "heads": "The result: cut heights and offsets for which it holds, for the largest root",
}


def page(paper: Paper5, figures: Mapping[str, Figure]) -> str:
    """Write paper 5 as an HTML page.

    Parameters
    ----------
    paper : Paper5
        The paper.
    figures : mapping of str to Figure
        By the names of their files.

    Returns
    -------
    str
        The page, with its figures in it.
    """
    chosen = paper.published["chosen"]
    return rendered(
        "paper5/paper5.html",
        **heading(paper.published, conclusions(paper)),
        paper=paper,
        heads=HEADS,
        tables=tables(paper),
        about_tables=about(paper),
        figures=drawn(figures, _CAPTIONS),
        about_figures=(
            f"The angle α = {chosen['edge_angle']:g}°, h_p = {1e3 * chosen['cut_height']:g} mm, Δ = "
            f"{1e3 * chosen['offset']:g} mm and the range of D are chosen here, the paper prints none of "
            "them. Exact is the length for a knife that does not turn back over a head."
        ),
    )
