"""Figures of machines, studies and sweeps, which stand below what draws them."""

from __future__ import annotations

from functools import singledispatch
from importlib import import_module
from typing import TYPE_CHECKING, Any

from linkwright.kernel.errors import InputError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# The module that registers what draws.
_DRAWN_BY = "linkwright.app.plotted"


@singledispatch
def figure_of(thing: Any, *names: str, over: str | None = None) -> Figure:
    """The figure of a thing by its kind. Raises `InputError` where nothing is registered for it."""
    raise InputError(f"found {type(thing).__name__}, of which there is no figure")


def plotted_figure(thing: Any, *names: str, over: str | None = None) -> Figure:
    """Curves of a thing by name, or its first figure, for a notebook or a file."""
    import_module(_DRAWN_BY)
    return figure_of(thing, *names, over=over)
