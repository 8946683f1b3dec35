"""Axes in the units that the reader wants: data stay as they were drawn, marks and labels are in other units.

The label of an axis says its unit in brackets at its end; places of its marks are round numbers of the unit
that is shown.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.ticker import AutoLocator, FixedLocator, Formatter, Locator

from linkwright.kernel.page.out_units import reader

if TYPE_CHECKING:
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure


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
    axis.set_major_formatter(_Numbers(formatter, factor))


class _UnitAxis:
    """An axis whose interval is in the unit that is shown."""

    def __init__(self, axis: Any, factor: float) -> None:
        self._axis, self._factor = axis, factor

    def __getattr__(self, name: str) -> Any:
        return getattr(self._axis, name)

    def get_view_interval(self) -> Any:
        return np.asarray(self._axis.get_view_interval()) / self._factor

    def get_data_interval(self) -> Any:
        return np.asarray(self._axis.get_data_interval()) / self._factor


class _Places(Locator):
    """Places of another locator in the unit that is shown."""

    def __init__(self, inner: Locator, factor: float) -> None:
        self.inner, self.factor = inner, factor

    def set_axis(self, axis: Any) -> None:
        """Let the other one see the axis in the unit that is shown."""
        super().set_axis(axis)
        self.inner.set_axis(_UnitAxis(axis, self.factor))  # type: ignore[arg-type]

    def __call__(self) -> Any:
        return np.asarray(self.inner()) * self.factor

    def tick_values(self, vmin: float, vmax: float) -> Any:
        """Places between two ends, in the unit of the data."""
        return np.asarray(self.inner.tick_values(vmin / self.factor, vmax / self.factor)) * self.factor


class _Numbers(Formatter):
    """Numbers of another formatter in the unit that is shown."""

    def __init__(self, inner: Formatter, factor: float) -> None:
        self.inner, self.factor = inner, factor

    def set_axis(self, axis: Any) -> None:
        """Let the other one see the axis in the unit that is shown."""
        super().set_axis(axis)
        self.inner.set_axis(_UnitAxis(axis, self.factor))  # type: ignore[arg-type]

    def set_locs(self, locs: Sequence[float]) -> None:
        """The places of all marks."""
        self.inner.set_locs([place / self.factor for place in locs])

    def __call__(self, x: float, pos: int | None = None) -> str:
        return self.inner(x / self.factor, pos)

    def get_offset(self) -> str:
        """What stands at the end of the axis."""
        return self.inner.get_offset()
