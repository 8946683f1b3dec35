"""The motion over the cycle as figures: position, velocity, acceleration of sliders, rockers and points."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from textwrap import fill
from typing import TYPE_CHECKING

import numpy as np

from linkwright.drive.cycle_motion import CycleMotion, Extremes
from linkwright.drive.tables_of_cycle import angle_words, outputs, speed_words
from linkwright.kernel.figure.legends import legend_above
from linkwright.kernel.figure.style import (
    LINES,
    CaptionedFigure,
    named,
    panels,
    roomy,
    styled,
    turn_axis,
    zero_line,
)
from linkwright.kernel.reader.numbers import measured
from linkwright.linkages.cycle import Linkage

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Figures of one page, and lines of one picture: more hide each other.
_FIGURES_MAX, _LINES_MAX = 6, 4

# Three panels take half a page.
_HEIGHT, _PANEL = 0.75, 1.2

# Letters that a panel has room for along its axis.
_LETTERS = 14


def cycle_figures(motion: CycleMotion, linkage: Linkage) -> Iterator[CaptionedFigure]:
    """A figure of the sliders, one of the rockers and one of the coupler points, each with its extremes."""
    groups: dict[tuple[tuple[str, str, str], ...], list[str]] = {}
    for name, quantities in outputs(motion, linkage):
        if any(name + ending in motion.extremes for ending, *_ in quantities):
            groups.setdefault(quantities, []).append(name)
    count = 0
    for quantities, names in groups.items():
        for first in range(0, len(names), _LINES_MAX):
            if (count := count + 1) > _FIGURES_MAX:
                return
            some = names[first : first + _LINES_MAX]
            caption = f"{_words(motion, some, quantities)}, {speed_words(motion)}."
            yield CaptionedFigure(
                f"motion_{count}",
                f"Motion of {_listed(some)}",
                caption[0].upper() + caption[1:],
                cycle_figure(motion, some, quantities),
            )


@styled
def cycle_figure(
    motion: CycleMotion, names: Sequence[str], quantities: Sequence[tuple[str, str, str]]
) -> Figure:
    """Draw `quantities` (end of the curve's name, word, symbol) over the crank angle, extremes as dots."""
    figure, axes = panels(len(quantities), height=_HEIGHT + _PANEL * len(quantities))
    for panel, (ending, word, symbol) in zip(axes, quantities, strict=True):
        _panel(panel, motion, [name + ending for name in names], names)
        unit = motion.unit_of(names[0] + ending)
        words = fill(f"{word} {symbol}", _LETTERS)
        panel.set_ylabel(f"{words}\n[{'°' if unit == 'rad' else unit}]")
    if len(names) > 1:
        legend_above(axes[0])
    turn_axis(axes[-1], np.degrees(motion.crank_angle))
    return figure


def _panel(panel: Axes, motion: CycleMotion, curves: Sequence[str], names: Sequence[str]) -> None:
    known = motion.curves()
    phi = np.degrees(motion.crank_angle)
    drawn = []
    for colour, curve, name in zip(LINES, curves, names, strict=False):
        size = 180 / np.pi if motion.unit_of(curve) == "rad" else 1.0
        extremes = motion.extremes.get(curve)
        values = size * known[curve]
        if extremes is not None and extremes.maximum is None and not curve.endswith(".angle"):
            # Towards a limit of crank rotation it is unbounded: the height suits most of the range.
            drawn.append(np.percentile(values, (4, 96)))
        else:
            drawn.append(values)
        panel.plot(phi, values, color=colour, label=named(name))
        _mark(panel, extremes, size, colour)
    roomy(panel, *drawn)
    zero_line(panel)


def _mark(panel: Axes, extremes: Extremes | None, size: float, colour: str) -> None:
    if extremes is None:
        return
    low, high = (extremes.minimum_angle, extremes.minimum), (extremes.maximum_angle, extremes.maximum)
    for place, value in (low, high):
        if place is not None and value is not None:
            panel.plot(np.degrees(place), size * value, "o", color=colour, markersize=4)


def _words(motion: CycleMotion, names: Sequence[str], quantities: Sequence[tuple[str, str, str]]) -> str:
    ending, word, _ = quantities[-2]
    parts = []
    for name in names:
        extremes = motion.extremes.get(name + ending)
        if extremes is None:
            continue
        if extremes.minimum is None or extremes.maximum is None:
            limits = "crank rotation" if motion.driver == "crank" else "travel"
            parts.append(f"the {word} of {name} becomes infinite at the limits of {limits}")
            continue
        peak, at = max(
            (abs(extremes.minimum), extremes.minimum_angle), (abs(extremes.maximum), extremes.maximum_angle)
        )
        value = measured(peak, motion.unit_of(name + ending))
        parts.append(f"the peak {word} of {name} is {value} at φ = {angle_words(motion, at)}")
    return "; ".join(parts) or "at rest"


def _listed(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
