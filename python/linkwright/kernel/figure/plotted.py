"""The curves of a result as a figure, an axis for each unit."""

from __future__ import annotations

from textwrap import fill
from typing import TYPE_CHECKING, Any

import numpy as np

from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import InputError
from linkwright.kernel.figure.style import LINES, legend_above, named, panels, styled, turn_axis
from linkwright.kernel.quantities import DeclaredQuantity, quantities_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Height of each axis [inch], and letters that it has room for along it.
_HEIGHT = 1.9
_LETTERS = 22


@styled
def plotted(result: Any, names: tuple[str, ...]) -> Figure:
    """Draw curves of a result, all without names, over what they run over.

    Raises `InputError` if it has no such curve, none at all, or if they run over different quantities.
    """
    owner: type = type(result)
    known = {quantity.name: quantity for quantity in quantities_of(owner) if quantity.kind == "curve"}
    drawn = {
        name: quantity
        for name, quantity in known.items()
        if quantity.over in known and _is_drawn(result, quantity)
    }
    for name in names:
        if name not in drawn:
            raise InputError(f"no curve {name!r} of this result: {suggestion(name, drawn)}")
    chosen = [drawn[name] for name in names or drawn]
    if not chosen:
        raise InputError(f"{owner.__name__} has no curves to plot")
    over = chosen[0].over
    if strange := [quantity.name for quantity in chosen if names and quantity.over != over]:
        raise InputError(f"{strange[0]} runs over {drawn[strange[0]].over}, not over {over}: plot it alone")
    return _figure(result, known[over], [quantity for quantity in chosen if quantity.over == over])


def _is_drawn(result: Any, quantity: DeclaredQuantity) -> bool:
    """Whether there are as many values as places."""
    values, places = getattr(result, quantity.name, None), getattr(result, quantity.over, None)
    return isinstance(values, np.ndarray) and isinstance(places, np.ndarray) and values.shape == places.shape


def _figure(result: Any, over: DeclaredQuantity, chosen: list[DeclaredQuantity]) -> Figure:
    units = list(dict.fromkeys(result.unit_of(quantity.name) for quantity in chosen))
    figure, axes = panels(len(units), height=_HEIGHT * len(units) + 0.5)
    x, unit = getattr(result, over.name), result.unit_of(over.name)
    if unit == "rad":
        x, unit = np.degrees(x), "°"
    for axis, own in zip(axes, units, strict=True):
        curves = [quantity for quantity in chosen if result.unit_of(quantity.name) == own]
        for curve, colour in zip(curves, LINES * len(curves), strict=False):
            axis.plot(x, getattr(result, curve.name), color=colour, label=curve.word)
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
    """Draw quantities of many machines over the entry that varies, over their numbers if several do.

    Raises `InputError` if the machines have no such quantity.
    """
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
