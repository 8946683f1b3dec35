"""A record beside what the fitted machine would have recorded, and what is left over."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from linkwright.kernel.figure.style import BLUE, INK, RED, SOFT, panels, styled
from linkwright.studies.fit import Fit

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_WORDS = {"motor_speed": "motor speed", "angle": "crank angle", "speed": "speed"}


@styled
def fit_figure(fit: Fit) -> Figure:
    """Draw each channel with the fitted motion, and below it the residuals with twice their noise."""
    record = fit.record
    is_angle = record.over == "angle"
    at = np.degrees(record.at) if is_angle else record.at
    figure, axes = panels(2 * len(record.channels), height=0.8 + 3.2 * len(record.channels))
    for place, (name, measured) in enumerate(record.channels.items()):
        above, below = axes[2 * place], axes[2 * place + 1]
        unit, fitted = record.unit(name), fit.predicted[name]
        above.plot(at, measured, ".", color=SOFT, markersize=3, label="record")
        above.plot(at, fitted, color=BLUE, linewidth=1.2, label="fitted machine")
        above.set_ylabel(f"{_WORDS.get(name, name)} [{unit or '–'}]")
        above.legend(loc="best")
        below.plot(at, measured - fitted, ".", color=RED, markersize=3)
        for side in (-2, 2):
            below.axhline(side * fit.noise[name], color=SOFT, linewidth=0.8, linestyle="--")
        below.axhline(0.0, color=INK, linewidth=0.8)
        below.set_ylabel(f"residual [{unit or '–'}]")
    axes[-1].set_xlabel("crank angle [°]" if is_angle else "time [s]")
    return figure
