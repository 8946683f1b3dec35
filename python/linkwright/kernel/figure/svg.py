"""A figure as SVG, as PNG, as SVG that can stand in a page with others, and what the cursor reads there."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from html import escape
from io import BytesIO, StringIO
from typing import TYPE_CHECKING, Any

import numpy as np

from linkwright.kernel.figure.style import (
    BLUE,
    GREEN,
    GRID,
    INK,
    ORANGE,
    PAPER,
    PURPLE,
    RED,
    SKY,
    SOFT,
    styled,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D


# Dots an inch: sharp on paper and on screens of twice the usual density.
DPI = 150


@styled
def svg(figure: Figure, *, transparent: bool = False) -> str:
    """The ``<svg>`` element of a figure alone, letters as outlines; the same text in every run."""
    from matplotlib.backends.backend_svg import FigureCanvasSVG

    text = StringIO()
    _place(figure, FigureCanvasSVG)
    # A date would make each run's file another one.
    figure.savefig(text, format="svg", transparent=transparent, metadata={"Date": None})
    element = re.search(r"<svg.*</svg>", text.getvalue(), re.DOTALL)
    assert element is not None
    return re.sub(r"\s*<metadata>.*?</metadata>", "", element[0], flags=re.DOTALL)


@styled
def png(figure: Figure) -> bytes:
    """A figure as a PNG file, at `DPI` dots an inch."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    data = BytesIO()
    figure.set_dpi(DPI)
    _place(figure, FigureCanvasAgg)
    figure.savefig(data, format="png", dpi=DPI)
    return data.getvalue()


def _place(figure: Figure, canvas: Callable[[Figure], object]) -> None:
    """Place the axes once; a figure that keeps a layout engine is laid out twice whenever it is written."""
    engine = figure.get_layout_engine()
    if engine is not None:
        canvas(figure)
        engine.execute(figure)
        figure.set_layout_engine(None)


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


# By how much a figure is enlarged at most where a page has the room.
_LARGER = 1.5


def inline_svg(figure: Figure, name: str, text: str) -> str:
    """A figure as an ``<svg>`` element for a page, which fills the width that it is given.

    `name`: what the names inside begin with, so that figures of one page do not share them; `text`: what the
    figure shows, for those who cannot see it.
    """
    drawn = with_own_names(svg(figure, transparent=True), name)
    for colour, variable in _COLOURS.items():
        drawn = drawn.replace(colour, f"var({variable})")
    # The page's own size counts, up to letters half as large again; names of other vocabularies are no use in
    # HTML.
    widest = f"{_LARGER * float(figure.get_size_inches()[0]):.4g}in"
    tail = f'" style="max-width: {widest}" role="img" aria-label="{escape(text)}">'
    drawn = re.sub(r'^<svg[^>]*?(viewBox="[^"]*)"[^>]*>', lambda head: f"<svg {head[1]}{tail}", drawn)
    # A style inside a figure would hold for the whole page; the page has its own.
    drawn = re.sub(r"\s*<style.*?</style>", "", drawn, flags=re.DOTALL)
    return drawn.replace("xlink:href", "href")


# What stands before the name of an element, and before its use.
_BEFORE_NAME = re.compile(r'(\bid="|href="#|url\(#)')


def with_own_names(drawn: str, name: str) -> str:
    """A drawing whose elements have names that no other figure of the page has."""
    before = identifier(name)
    return _BEFORE_NAME.sub(lambda mark: f"{mark[0]}{before}-", drawn)


def identifier(name: str) -> str:
    """A name as an identifier, no two the same: what is no letter, digit or ``-`` stands by its code."""
    return re.sub(r"[^\w-]", lambda letter: f".{ord(letter[0]):x}.", name)


# Points of a curve that a page reads, and steps across the axes in which they are given.
_POINTS, _STEPS = 241, 10_000


def readout(figure: Figure) -> list[dict[str, Any]]:
    """Axes of a figure that was written as SVG, so that their places are known, ready for JSON.

    Of each axes with straight scales ``box``, left, top, right and bottom as shares of the figure; ``x`` and
    ``y``, the values at its ends, and whether the scale is logarithmic; ``over``, the words along x;
    ``curves``, label, colour, and x and y of each curve in ten-thousandths of the axes.
    """
    width, height = figure.get_size_inches()
    return [_read(axes, float(width), float(height)) for axes in figure.axes if axes.name == "rectilinear"]


def _read(axes: Axes, width: float, height: float) -> dict[str, Any]:
    box = axes.get_position()
    below = axes.get_shared_x_axes().get_siblings(axes)
    over = next((label for one in (axes, *below) if (label := one.get_xlabel())), "")
    return {
        "box": [round(v, 5) for v in (box.x0, 1 - box.y1, box.x1, 1 - box.y0)],
        "x": [*map(float, axes.get_xlim()), axes.get_xscale() == "log"],
        "y": [*map(float, axes.get_ylim()), axes.get_yscale() == "log"],
        "over": over,
        "curves": list(_curves(axes)),
    }


def _curves(axes: Axes) -> Iterator[dict[str, Any]]:
    """Those over a rising x: the others are read by the coordinates alone."""
    for line in axes.get_lines():
        points = _points(axes, line)
        if points is None:
            continue
        label = str(line.get_label())
        words = label.strip() if not label.startswith("_") else axes.get_ylabel().replace("\n", " ")
        yield {"label": words, "colour": str(line.get_color()), "points": points}


def _points(axes: Axes, line: Line2D) -> list[list[int]] | None:
    """Places of a curve in the axes; None of a mark, a level, or a curve that turns back."""
    xy = np.asarray(line.get_xydata(), float)
    if len(xy) < 3 or line.get_transform() != axes.transData or not np.all(np.diff(xy[:, 0]) >= 0):
        return None
    xy = xy[np.isfinite(xy).all(axis=1)]
    chosen = np.unique(np.linspace(0, len(xy) - 1, min(len(xy), _POINTS)).round().astype(int))
    shares = axes.transAxes.inverted().transform(axes.transData.transform(xy[chosen]))
    # What a logarithm of zero leaves is outside.
    return [np.round(_STEPS * np.clip(shares[:, k], -9, 9)).astype(int).tolist() for k in (0, 1)]
