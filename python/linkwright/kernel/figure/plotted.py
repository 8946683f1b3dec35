"""The curves of a result as a figure, an axis for each unit."""

from __future__ import annotations

from textwrap import fill
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import InputError
from linkwright.kernel.figure.legends import legend_above
from linkwright.kernel.figure.style import LINES, named, panels, styled, turn_axis
from linkwright.kernel.quantities import quantities_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Height of each axis [inch], and letters that it has room for along it.
_HEIGHT = 1.9
_LETTERS = 22


class _PlotCurve(NamedTuple):
    word: str
    unit: str
    over: str  # name of what it runs over
    values: Floats


@styled
def plotted(result: Any, names: tuple[str, ...]) -> Figure:
    """Draw curves of a result, the usual ones without names, over what they run over.

    Raises `InputError` if it has no such curve, none at all, or if they run over different quantities.
    """
    known = _curves(result)
    drawn = {name: curve for name, curve in known.items() if curve.over in known}
    for name in names:
        if name not in drawn:
            raise InputError(f"no curve {name!r} of this result: {suggestion(name, drawn)}")
    chosen = [drawn[name] for name in names or result.usual_curves() if name in drawn]
    if not chosen:
        raise InputError(f"{type(result).__name__} has no curves to plot")
    over = chosen[0].over
    if strange := [name for name in names if drawn[name].over != over]:
        raise InputError(f"{strange[0]} runs over {drawn[strange[0]].over}, not over {over}: plot it alone")
    return _figure(known[over], [curve for curve in chosen if curve.over == over])


def _curves(result: Any) -> dict[str, _PlotCurve]:
    """All curves of a result by name; those of its parts run over its first one."""
    owner: type = type(result)
    words = {quantity.name: quantity for quantity in quantities_of(owner)}
    columns = result.curves()
    first = next(iter(columns), "")
    own = {name: getattr(result, name, None) for name, quantity in words.items() if quantity.kind == "curve"}
    columns = {name: values for name, values in own.items() if isinstance(values, np.ndarray)} | columns
    curves = {}
    for name, values in columns.items():
        over = words[name].over if name in words else first
        if not over or values.shape == columns.get(over, values[:0]).shape:
            word = words[name].word if name in words else named(name)
            curves[name] = _PlotCurve(word, result.unit_of(name), over, values)
    return curves


def _figure(over: _PlotCurve, chosen: list[_PlotCurve]) -> Figure:
    units = list(dict.fromkeys(curve.unit for curve in chosen))
    figure, axes = panels(len(units), height=_HEIGHT * len(units) + 0.5)
    x, unit = over.values, over.unit
    if unit == "rad":
        x, unit = np.degrees(x), "°"
    for axis, own in zip(axes, units, strict=True):
        curves = [curve for curve in chosen if curve.unit == own]
        for curve, colour in zip(curves, LINES * len(curves), strict=False):
            axis.plot(x, curve.values, color=colour, label=curve.word)
        word = curves[0].word if len(curves) == 1 else ""
        # Long words stand in several lines, so that they do not run into those of the next axis.
        words = fill(word, _LETTERS)
        axis.set_ylabel(f"{words}\n[{own}]".strip() if own else words)
        if len(curves) > 1:
            legend_above(axis)
    axes[-1].set_xlabel(f"{over.word} [{unit}]" if unit else over.word)
    if unit == "°":
        turn_axis(axes[-1], x, label=False)
    return figure


@styled
def batch_plotted(batch: Any, names: tuple[str, ...]) -> Figure:
    """Draw quantities over the entry that varies, or over row numbers; `InputError` if there is none."""
    known = {quantity.name: quantity for quantity in quantities_of(type(batch)) if quantity.symbol}
    for name in names:
        if name not in known:
            raise InputError(f"no quantity {name!r} of these machines: {suggestion(name, known)}")
    varied = {address: values for address, values in batch.entries.items() if np.ptp(values) > 0}
    label, x = next(iter(varied.items())) if len(varied) == 1 else ("machine", np.arange(len(batch.status)))
    order = np.argsort(x, kind="stable")
    figure, axes = panels(len(names), height=_HEIGHT * len(names) + 0.5)
    for axis, name, colour in zip(axes, names, LINES * len(names), strict=False):
        axis.plot(x[order], np.asarray(getattr(batch, name))[order], color=colour)
        words, unit = fill(known[name].word, _LETTERS), known[name].unit
        axis.set_ylabel(f"{words}\n[{unit}]" if unit else words)
    # The address says which entry; machines of a batch have it in SI.
    axes[-1].set_xlabel(label if label == "machine" else f"{named(label)} [SI]")
    return figure
