"""Torsional vibration: the shapes in which a train swings."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkwright.kernel.figure.style import INK, LINES, SOFT, panels, styled, zero_line
from linkwright.torsion.figures.train_row import in_a_row

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from linkwright.torsion.modes.free import FreeVibration

# Modes in one picture, which is then a page high.
_MODES_MAX = 6

_PANEL = 1.35


@styled
def modes_figure(found: FreeVibration, modes: int = 4) -> Figure:
    """Draw the amplitudes of the discs in the lowest modes that twist the train."""
    twisting = [k for k, f in enumerate(found.natural_frequencies) if f > 0] or [0]
    shown = twisting[: max(1, min(modes, _MODES_MAX))]
    figure, axes = panels(len(shown), height=0.9 + _PANEL * len(shown))
    for panel, k, colour in zip(axes, shown, LINES, strict=False):
        _mode(panel, found, k, colour)
    last = axes[-1]
    names = [found.discs[d] for d in in_a_row(found.discs, found.joined)]
    last.set_xticks(range(len(names)), names, rotation=30 if len(found.discs) > 8 else 0)
    last.set_xlabel("disc")
    return figure


def _mode(axes: Axes, found: FreeVibration, k: int, colour: str) -> None:
    """One shape: discs as stems, shafts as lines between them."""
    row = in_a_row(found.discs, found.joined)
    place = {found.discs[d]: n for n, d in enumerate(row)}
    shape = found.mode_shapes[k][row]
    for first, second in found.joined:
        if first in place and second in place:
            x = (place[first], place[second])
            axes.plot(x, shape[list(x)], color=colour, linewidth=1.4)
    axes.vlines(range(len(shape)), 0, shape, color=SOFT, linewidth=0.8)
    axes.plot(range(len(shape)), shape, "o", color=INK, markersize=4)
    axes.set_ylim(-1.15, 1.15)
    axes.set_ylabel(f"{found.natural_frequencies[k]:.5g} Hz")
    zero_line(axes)
