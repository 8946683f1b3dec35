"""Paper 4 as one HTML page that needs nothing but itself."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.resources import files
from typing import TYPE_CHECKING

from linkwright.papers.page import own_names
from linkwright.papers.paper4_conclusions import conclusions
from linkwright.plot.svg import svg

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from linkwright.papers.paper4 import Paper4

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
    from jinja2 import Environment
    from markupsafe import Markup

    template = files("linkwright.papers").joinpath("paper4.html").read_text(encoding="utf-8")
    drawn = [(_CAPTIONS[name], Markup(own_names(svg(figure), name))) for name, figure in figures.items()]
    rendered: str = (
        Environment(autoescape=True)
        .from_string(template)
        .render(paper=paper, conclusions=conclusions(paper), figures=drawn)
    )
    return rendered
