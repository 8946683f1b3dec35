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
    """Words of a figure, as a whole in as many lines, or line by line."""
    lines = text.split("\n")
    joined = " ".join(lines)
    said = to(joined) if text.rstrip().endswith(".") else to.label(joined)
    if len(lines) > 1 and said != joined:
        # Longer words in as many lines, with room for the last word of each.
        width = max(*map(len, lines), len(said) // len(lines) + 8)
        return "\n".join(wrap(said, width, break_long_words=False))
    return "\n".join(map(to.label, lines))


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
