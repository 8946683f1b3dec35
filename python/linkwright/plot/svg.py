"""A figure as SVG text."""

from __future__ import annotations

import re
from io import StringIO
from typing import TYPE_CHECKING

from linkwright.plot.style import styled

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@styled
def svg(figure: Figure, *, transparent: bool = False) -> str:
    """Write a figure as SVG.

    Parameters
    ----------
    figure : Figure
        The figure.
    transparent : bool
        Whether the page shows through.

    Returns
    -------
    str
        The ``<svg>`` element alone, letters as outlines; the same text in every run.
    """
    text = StringIO()
    # A date would make each run's file another one.
    figure.savefig(text, format="svg", transparent=transparent, metadata={"Date": None})
    element = re.search(r"<svg.*</svg>", text.getvalue(), re.DOTALL)
    assert element is not None
    return re.sub(r"\s*<metadata>.*?</metadata>", "", element[0], flags=re.DOTALL)
