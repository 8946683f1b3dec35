"""A figure of the page with its words."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class Captioned(NamedTuple):
    """A figure, its name in the page, its title, and its caption."""

    name: str
    title: str
    caption: str
    figure: Figure
