"""Marks of crank angles along x, the same in all figures."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# Range from which on crank angles have the marks of a whole revolution [°].
_HALF_TURN = 180.0


def mark_angles(axes: Axes, low: float, high: float) -> None:
    """Mark crank angles [°] along x, with lines half-way: every 90° from half a revolution to four on."""
    span = high - low
    step = 90.0 * max(1, round(span / 1440)) if span >= _HALF_TURN else _fine_step(span)
    for part in (step, step / 2):
        first, last = np.ceil(low / part - 1e-6), np.floor(high / part + 1e-6)
        axes.set_xticks(part * np.arange(first, last + 1), minor=part < step)
    axes.grid(visible=True, axis="x", which="minor", linewidth=0.35)
    axes.tick_params(axis="x", which="minor", length=0)


def _fine_step(span: float) -> float:
    """Step of round angles of which four or more fit into a short range [°]."""
    power = 10.0 ** np.floor(np.log10(max(span, 1e-9) / 4))
    steps = (30.0, 15.0, *(power * np.array([5.0, 2.0, 1.0])))
    return float(next(step for step in steps if 4 * step <= span * (1 + 1e-9) or step == power))
