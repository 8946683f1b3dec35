"""Motion laws in one picture: lift, velocity, acceleration and jerk."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from linkwright.kernel.figure.style import LINES, legend_above, panels, styled, zero_line

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from linkwright.cam.laws.motion_law import MotionLaw

# Where the colours begin again, the lines look different.
_DASHES = ("-", "--", "-.", ":")

# Points a piece of a law; a piece has few waves.
_POINTS = 120

_LABELS = ("lift f [–]", "velocity f′ [–]", "acceleration f″ [–]", "jerk f‴ [–]")


@styled
def motion_laws_figure(laws: Mapping[str, MotionLaw]) -> Figure:
    """Draw laws and their first three derivatives over their length.

    Parameters
    ----------
    laws : Mapping of str to MotionLaw
        Name → law.

    Returns
    -------
    Figure
        Four panels, one above the other; jumps are upright lines, and a law rests before and after.
    """
    figure, axes = panels(4, height=8.2)
    for n, (name, law) in enumerate(laws.items()):
        colour, dash = LINES[n % len(LINES)], _DASHES[n // len(LINES) % len(_DASHES)]
        for order, each in enumerate(axes):
            x, y = _course(law, order)
            each.plot(x, y, dash, color=colour, label=name)
    for each, label in zip(axes, _LABELS, strict=True):
        each.set_ylabel(label)
        zero_line(each)
    axes[-1].set_xlabel("share z of the section [–]")
    # More names than fit into one line take a second.
    legend_above(axes[0])
    return figure


def _course(law: MotionLaw, order: int) -> tuple[list[float], list[float]]:
    """A derivative piece by piece, with the values on both sides of each break; rest at the outer ends."""
    derivative = law.derivative(order)
    u = np.linspace(0.0, 1.0, _POINTS)
    x, y = [law.start], [float(law.at(law.start)) if order == 0 else 0.0]
    for low, high, piece in zip(law.breaks, law.breaks[1:], derivative.pieces, strict=False):
        x += (low + (high - low) * u).tolist()
        y += piece.at(u).tolist()
    return [*x, law.end], [*y, y[-1] if order == 0 else 0.0]
