"""SVG that can stand in a page with others: names of its own, colours of the page."""

from __future__ import annotations

import re
from html import escape
from typing import TYPE_CHECKING

from linkwright.kernel.figure.style import BLUE, GREEN, GRID, INK, ORANGE, PAPER, PURPLE, RED, SKY, SOFT
from linkwright.kernel.figure.svg import svg

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Colours of the figures → variables of the page, which differ between light and dark.
_COLOURS = {
    INK: "--ink",
    SOFT: "--soft",
    GRID: "--grid",
    PAPER: "--paper",
    BLUE: "--blue",
    RED: "--red",
    GREEN: "--green",
    ORANGE: "--orange",
    PURPLE: "--purple",
    SKY: "--sky",
}


def inline_svg(figure: Figure, name: str, text: str) -> str:
    """A figure as SVG for a page.

    Parameters
    ----------
    figure : Figure
        The figure.
    name : str
        What the names inside begin with, so that figures of one page do not share them.
    text : str
        What the figure shows, for those who cannot see it.

    Returns
    -------
    str
        An ``<svg>`` element that fills the width that it is given.
    """
    drawn = svg(figure, transparent=True)
    drawn = re.sub(r'(\bid="|href="#|url\(#)', rf"\g<1>{name}-", drawn)
    for colour, variable in _COLOURS.items():
        drawn = drawn.replace(colour, f"var({variable})")
    # The page's own size counts; names of other vocabularies are no use in HTML.
    tail = f'" role="img" aria-label="{escape(text)}">'
    drawn = re.sub(r'^<svg[^>]*?(viewBox="[^"]*)"[^>]*>', lambda head: f"<svg {head[1]}{tail}", drawn)
    # A style inside a figure would hold for the whole page; the page has its own.
    drawn = re.sub(r"\s*<style.*?</style>", "", drawn, flags=re.DOTALL)
    return drawn.replace("xlink:href", "href")
