"""Figures as the reader wants them: units, the zero of crank angles, language.

Data stay as they were drawn; marks and labels change. The label of an axis says its unit in brackets at its
end, and places of its marks are round numbers of the unit that is shown. Crank angles are counted from the
wanted dead centre: over a whole cycle the curves begin there, over a part of it the angles move.
"""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import wrap
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.text import Text
from matplotlib.ticker import AutoLocator, FixedLocator, Formatter, Locator

from linkwright.kernel.reader.angle_marks import mark_angles
from linkwright.kernel.reader.angle_zero import Zero, zero_shown
from linkwright.kernel.reader.out_units import reader

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

    from linkwright.kernel.reader.language import Language

# Beginning of the labels of axes over crank angles; one with the words of a zero is counted from it already.
_LABEL = "crank angle"

# How far the ends of axes are from whole revolutions at most [°].
_WHOLE = 1e-3


def in_units_of_reader(figure: Figure) -> None:
    """Mark the axes of a figure in the units that the reader wants."""
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            label, factor = reader().label(axis.get_label_text())
            if factor != 1.0:
                axis.set_label_text(label)
                _rescale(axis, factor)


def _rescale(axis: Axis, factor: float) -> None:
    """Marks at round numbers of the unit that is shown; axes that share theirs are marked once."""
    locator, formatter = axis.get_major_locator(), axis.get_major_formatter()
    if isinstance(locator, _Places):
        return
    # Places that were round in the unit of the data are not in another one.
    places = AutoLocator() if isinstance(locator, FixedLocator) else locator
    axis.set_major_locator(_Places(places, factor))
    axis.set_major_formatter(_Marks(formatter, factor))


class _UnitAxis:
    def __init__(self, axis: Any, factor: float) -> None:
        self._axis, self._factor = axis, factor

    def __getattr__(self, name: str) -> Any:
        return getattr(self._axis, name)

    def get_view_interval(self) -> Any:
        return np.asarray(self._axis.get_view_interval()) / self._factor

    def get_data_interval(self) -> Any:
        return np.asarray(self._axis.get_data_interval()) / self._factor


class _Places(Locator):
    def __init__(self, inner: Locator, factor: float) -> None:
        self.inner, self.factor = inner, factor

    def set_axis(self, axis: Any) -> None:
        super().set_axis(axis)
        self.inner.set_axis(_UnitAxis(axis, self.factor))  # type: ignore[arg-type]

    def __call__(self) -> Any:
        return np.asarray(self.inner()) * self.factor

    def tick_values(self, vmin: float, vmax: float) -> Any:
        return np.asarray(self.inner.tick_values(vmin / self.factor, vmax / self.factor)) * self.factor


class _Marks(Formatter):
    """Marks of another formatter, whose axis may be in another unit, with the words of a language."""

    def __init__(self, inner: Formatter, factor: float = 1.0, to: Language | None = None) -> None:
        self.inner, self.factor, self.to = inner, factor, to

    def set_axis(self, axis: Any) -> None:
        super().set_axis(axis)
        self.inner.set_axis(_UnitAxis(axis, self.factor) if self.factor != 1.0 else axis)  # type: ignore[arg-type]

    def set_locs(self, locs: Sequence[float]) -> None:
        self.inner.set_locs([place / self.factor for place in locs])

    def __call__(self, x: float, pos: int | None = None) -> str:
        return self._said(self.inner(x / self.factor, pos))

    def get_offset(self) -> str:
        return self._said(self.inner.get_offset())

    def _said(self, number: str) -> str:
        return self.to.number(number) if self.to else number


def from_zero_of_reader(figure: Figure) -> None:
    """Count crank angles along the axes of a figure from the zero that is shown."""
    zero = zero_shown()
    if not zero.words:
        return
    for axes in figure.axes:
        group = [axes, *axes.get_shared_x_axes().get_siblings(axes)]
        labels = [one.get_xlabel() for one in group]
        label = next((text for text in labels if text.startswith(_LABEL)), "")
        if not label or zero.words in label:
            continue
        # Those that share the angles change together; the label comes last, since it tells what was done.
        for one in dict.fromkeys(group):
            _move(one, zero)
        for one, text in zip(group, labels, strict=True):
            if text.startswith(_LABEL):
                words, _, unit = text.rpartition(" [")
                one.set_xlabel(f"{words} from the {zero.words} [{unit}")


def _move(axes: Axes, zero: Zero) -> None:
    is_polar = axes.name == "polar"
    size = 1.0 if is_polar else 180 / np.pi
    low, high = axes.get_xlim()
    turns = 1 if is_polar else round((high - low) / 360)
    is_cycle = is_polar or (zero.cycle > 0 and turns > 0 and abs(high - low - 360 * turns) < _WHOLE)
    own = zero._replace(cycle=2 * np.pi * turns if is_cycle else 0.0)
    for line in axes.get_lines():
        if line.get_transform().contains_branch_seperately(axes.transData)[0]:
            _move_line(line, own, size)
    if is_polar:
        return
    if is_cycle:
        low, high = 0.0, 360.0 * turns
    else:
        low, high = low - size * zero.angle, high - size * zero.angle
    axes.set_xlim(low, high)
    mark_angles(axes, low, high)


def _move_line(line: Line2D, zero: Zero, size: float) -> None:
    x, y = (np.asarray(values, float) for values in line.get_data(orig=True))
    if np.all(np.diff(x) >= 0) and zero.cycle_of(x / size):
        moved, curves = zero.rolled(x / size, {"": y})
        line.set_data(*_closed(size * moved, curves[""], size * zero.cycle))
    else:
        line.set_data([size * zero.counted(float(at) / size) for at in x], y)


def _closed(x: Any, y: Any, cycle: float) -> tuple[Any, Any]:
    """A curve over a cycle with its value at the zero, between two samples, at both ends."""
    if not 0 < x[0] < cycle or x[-1] < cycle:
        return x, y
    share = (cycle - x[-2]) / (x[-1] - x[-2])
    end = y[-2] + share * (y[-1] - y[-2])
    return np.concatenate([[0.0], x[:-1], [cycle]]), np.concatenate([[end], y[:-1], [end]])


def translated_figure(figure: Figure, to: Language) -> Figure:
    """The figure, with its words in a language; it is changed in place."""
    for artist in figure.findobj(Text):
        artist.set_text(_said(artist.get_text(), to))
    for axes in figure.axes:
        # What the cursor tells of a curve is its label.
        for line in axes.get_lines():
            line.set_label(to.label(str(line.get_label())))
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_formatter(_Marks(axis.get_major_formatter(), to=to))
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
