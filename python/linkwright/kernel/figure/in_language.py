"""Figures with their words in another language, and its decimal sign at the marks of the axes."""

from __future__ import annotations

from textwrap import wrap
from typing import TYPE_CHECKING, Any

from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.ticker import Formatter

if TYPE_CHECKING:
    from linkwright.kernel.page.language import Language


def translated_figure(figure: Figure, to: Language) -> Figure:
    """The figure, with its words in a language; it is changed in place."""
    for artist in figure.findobj(Text):
        artist.set_text(_said(artist.get_text(), to))
    for axes in figure.axes:
        # What the cursor tells of a curve is its label.
        for line in axes.get_lines():
            line.set_label(to.label(str(line.get_label())))
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_formatter(_Marks(axis.get_major_formatter(), to))
    return figure


def _said(text: str, to: Language) -> str:
    """Words of a figure: line by line, a paragraph as a whole in lines as long as they were."""
    lines = text.split("\n")
    if len(lines) == 1 or not text.rstrip().endswith("."):
        return "\n".join(map(to.label, lines))
    return "\n".join(wrap(to(" ".join(lines)), max(map(len, lines))))


class _Marks(Formatter):
    """Marks of another formatter with the decimal sign of a language."""

    def __init__(self, inner: Formatter, to: Language) -> None:
        self.inner, self.to = inner, to

    def set_axis(self, axis: Any) -> None:
        """Let the other one see the axis."""
        super().set_axis(axis)
        self.inner.set_axis(axis)

    def set_locs(self, locs: list[float]) -> None:
        """The places of all marks."""
        self.inner.set_locs(locs)

    def __call__(self, x: float, pos: int | None = None) -> str:
        return self.to.number(self.inner(x, pos))

    def get_offset(self) -> str:
        """What stands at the end of the axis."""
        return self.to.number(self.inner.get_offset())
