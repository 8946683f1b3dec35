"""A figure as SVG text, or as the bytes of a PNG file."""

from __future__ import annotations

import re
from io import BytesIO, StringIO
from typing import TYPE_CHECKING

from linkwright.kernel.figure.style import styled

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Dots an inch: sharp on paper and on screens of twice the usual density.
DPI = 150


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


@styled
def png(figure: Figure) -> bytes:
    """Write a figure as PNG.

    Parameters
    ----------
    figure : Figure
        The figure.

    Returns
    -------
    bytes
        The file, at `DPI` dots an inch.
    """
    data = BytesIO()
    figure.savefig(data, format="png", dpi=DPI)
    return data.getvalue()
