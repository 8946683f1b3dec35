"""What the pages of all papers share: one HTML page that needs nothing but itself."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from importlib.resources import files
from typing import TYPE_CHECKING, Any

from linkwright.kernel.figure.svg import svg

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def rendered(template: str, **values: Any) -> str:
    """Fill a template of this package.

    Parameters
    ----------
    template : str
        Name of its file.
    **values
        What it shows.

    Returns
    -------
    str
        The page.
    """
    from jinja2 import Environment, FunctionLoader

    folder = files("linkwright.papers")
    loader = FunctionLoader(lambda name: folder.joinpath(name).read_text(encoding="utf-8"))
    text: str = Environment(autoescape=True, loader=loader).get_template(template).render(**values)
    return text


def heading(printed: Mapping[str, Any], conclusions: Sequence[str]) -> dict[str, Any]:
    """What stands above every page: number, title and original title, and what comes out.

    Parameters
    ----------
    printed : Mapping
        Printed values.
    conclusions : sequence of str
        In sentences.
    """
    return {name: printed[name] for name in ("number", "title", "original")} | {"conclusions": conclusions}


def drawn(figures: Mapping[str, Figure], captions: Mapping[str, str]) -> list[tuple[str, str]]:
    """Captions and drawings.

    Parameters
    ----------
    figures : mapping of str to Figure
        By name.
    captions : mapping of str to str
        For each name.

    Returns
    -------
    list of tuple of str
        Markup of the drawings.
    """
    return [(captions[name], drawing(figure, name)) for name, figure in figures.items()]


def drawing(figure: Figure, name: str) -> str:
    """A figure as markup, with names inside that no other of the page has."""
    from markupsafe import Markup

    return Markup(re.sub(r'(\bid="|href="#|url\(#)', rf"\g<1>{name}-", svg(figure)))
