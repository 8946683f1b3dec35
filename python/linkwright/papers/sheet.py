"""A paper as one HTML page that needs nothing but itself."""

from __future__ import annotations

import re
from collections.abc import Mapping
from importlib.resources import files
from typing import TYPE_CHECKING

from linkwright.kernel.figure.svg import svg
from linkwright.papers.words import filled

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from linkwright.papers.paper import Paper


def page(paper: Paper, figures: Mapping[str, Figure]) -> str:
    """The page of a paper with its figures, by the names of their files, in it."""
    from jinja2 import Environment

    template = files("linkwright.papers").joinpath("paper.html").read_text(encoding="utf-8")
    captions = {name: filled(text, paper.values) for name, text in paper.published["captions"].items()}
    drawn = [(captions[name], _drawing(figure, name)) for name, figure in figures.items()]
    text: str = Environment(autoescape=True).from_string(template).render(paper=paper, figures=drawn)
    return text


def _drawing(figure: Figure, name: str) -> str:
    """A figure as markup, with names inside that no other of the page has."""
    from markupsafe import Markup

    return Markup(re.sub(r'(\bid="|href="#|url\(#)', rf"\g<1>{name}-", svg(figure)))
