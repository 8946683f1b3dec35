"""Mode shapes of a train, and Campbell's diagram: natural frequencies and orders over the speed."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.figure.legends import legend_above
from linkwright.kernel.figure.style import (
    INK,
    LINES,
    MARK_LETTERS,
    ORANGE,
    RED,
    SMALL,
    SOFT,
    WIDTH,
    panels,
    shortened,
    styled,
    zero_line,
)
from linkwright.kernel.reader.numbers import quantity
from linkwright.torsion.excitation.harmonics import line_words

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from linkwright.torsion.modes.campbell import CampbellDiagram
    from linkwright.torsion.modes.free import FreeVibration, ShaftShapes

# Modes in one picture, which is then a page high.
_MODES_MAX = 6

# Letters of names that stand beside each other under the axes; more of them are turned.
_LETTERS = 70

_PANEL = 1.35


@styled
def modes_figure(free: FreeVibration, modes: int = 4) -> Figure:
    """Draw the amplitudes of the discs in the lowest modes that twist the train."""
    twisting = [k for k, f in enumerate(free.natural_frequencies) if f > 0] or [0]
    shown = twisting[: max(1, min(modes, _MODES_MAX))]
    figure, axes = panels(len(shown), height=0.9 + _PANEL * len(shown))
    for panel, k, colour in zip(axes, shown, LINES, strict=False):
        _mode(panel, free, k, colour)
    last = axes[-1]
    names = [shortened(free.discs[d], MARK_LETTERS) for d in in_a_row(free.discs, free.joined)]
    turned = len(names) > 8 or sum(map(len, names)) > _LETTERS
    last.set_xticks(
        range(len(names)), names, rotation=40 if turned else 0, ha="right" if turned else "center"
    )
    if len(names) > 14:
        last.tick_params("x", labelsize=SMALL)
    last.set_xlabel("disc")
    return figure


def _mode(axes: Axes, free: FreeVibration, k: int, colour: str) -> None:
    row = in_a_row(free.discs, free.joined)
    place = {free.discs[d]: n for n, d in enumerate(row)}
    shape = free.mode_shapes[k][row]
    curved = {frozenset(shape.between): shape for shape in free.along if place.keys() & {*shape.between}}
    # Fluids of dampers hold no shape.
    slack = {n for n in range(len(free.shafts)) if not free.potential_shares[:, n].any()}
    for n, (first, second) in enumerate(free.joined):
        if n in slack:
            continue
        along = curved.get(frozenset((first, second)))
        if along is not None:
            _along(axes, along, k, place, colour)
        elif first in place and second in place:
            x = (place[first], place[second])
            # What joins discs that do not stand beside each other, or in a loop, is no shape between them.
            beside = abs(x[0] - x[1]) == 1 and len(free.joined) <= len(free.discs)
            axes.plot(x, shape[list(x)], color=colour, linewidth=1.4 if beside else 0.5)
    axes.vlines(range(len(shape)), 0, shape, color=SOFT, linewidth=0.8)
    axes.plot(range(len(shape)), shape, "o", color=INK, markersize=4)
    axes.set_ylim(-1.15, 1.15)
    axes.set_ylabel(quantity(free.natural_frequencies[k], "Hz"))
    zero_line(axes)


def _along(axes: Axes, along: ShaftShapes, k: int, place: Mapping[str, int], colour: str) -> None:
    """The shape of a shaft with distributed inertia between its discs, or beside the one that it holds."""
    first, second = (place.get(name) for name in along.between)
    start = first if first is not None else (second or 0) - 1
    end = second if second is not None else start + 1
    axes.plot(start + (end - start) * along.share, along.angles[k], color=colour, linewidth=1.4)


def in_a_row(discs: Sequence[str], joined: Sequence[tuple[str, str]]) -> list[int]:
    """Places of the discs along a chain, from the end that is nearer to the first."""
    about: dict[str, list[str]] = {name: [] for name in discs}
    for a, b in joined:
        if a in about and b in about and b not in about[a]:
            about[a].append(b)
            about[b].append(a)
    ends = [name for name in discs if len(about[name]) < 2]
    if len(ends) != 2 or any(len(name) > 2 for name in about.values()):
        return list(range(len(discs)))
    row = _from(ends[0], about)
    if len(row) != len(discs):  # An open clutch leaves two trains.
        return list(range(len(discs)))
    # From the end that is nearer to the first disc of the file.
    if 2 * row.index(discs[0]) >= len(row):
        row.reverse()
    place = {name: n for n, name in enumerate(discs)}
    return [place[name] for name in row]


def _from(end: str, about: Mapping[str, Sequence[str]]) -> list[str]:
    row, before = [end], ""
    while after := [name for name in about[row[-1]] if name != before]:
        before = row[-1]
        row.append(after[0])
    return row


_RPM = 30 / math.pi

# Areas of the points [pt²]: without severity, and of the most severe.
_PLAIN, _LARGEST = 14.0, 150.0

# Critical speeds that are reported beside their points.
_TOLD = 6

# Width of a letter, and height, of the words beside a point, as shares of the picture.
_WORDS = (0.0105, 0.045)

# Heights of the modes up to which a fixed frequency is shown.
_ABOVE = 3.0

# Room between numbers of orders along an edge, as a share of it.
_APART = 0.035


@styled
def campbell_figure(diagram: CampbellDiagram) -> Figure:
    """Draw natural frequencies, the rays of the orders, and critical speeds.

    Points are as large as their mode swings: at resonance where damping is known, else if the torque acted
    slowly; without torques all are alike.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(WIDTH, 5.0), layout="constrained")
    axes = figure.subplots()
    speeds = diagram.speeds * _RPM
    axes.set_xlim(speeds[0], speeds[-1])
    axes.set_ylim(0, _top(diagram))
    _rays(axes, diagram)
    moving = [row for row in diagram.frequencies if row.max() > 0]
    for nth, row in enumerate(moving):
        axes.plot(speeds, row, color=LINES[nth % len(LINES)], linewidth=1.6)
    _points(axes, diagram)
    axes.set_xlabel("speed [rpm]")
    axes.set_ylabel("frequency [Hz]")
    if axes.get_legend_handles_labels()[0]:
        # Above the numbers of the orders, which stand on the upper edge.
        legend_above(axes, gap=1.5)
    return figure


def _top(diagram: CampbellDiagram) -> float:
    ends = np.abs(np.outer(diagram.orders, diagram.speeds[[0, -1]]) + _offsets(diagram)[:, None])
    ray = float(ends.max()) / (2 * math.pi)
    reached = [row.max() for row in diagram.frequencies if 0 < row.min() <= ray]
    top = 1.12 * float(max(reached, default=ray))
    # Lines of a supply are named where they lie not far above the modes.
    fixed = np.abs(diagram.fixed[diagram.orders == 0] if len(diagram.fixed) else np.empty(0)) / math.pi / 2
    return max(top, 1.05 * float(fixed[fixed <= _ABOVE * top].max(initial=0.0)))


def _offsets(diagram: CampbellDiagram) -> Floats:
    """Fixed frequency beside each order, 0 for none [rad/s]."""
    return diagram.fixed if len(diagram.fixed) else np.zeros(len(diagram.orders))


def _rays(axes: Axes, diagram: CampbellDiagram) -> None:
    (left, right), top = axes.get_xlim(), axes.get_ylim()[1]
    last = None
    fixed = _offsets(diagram)
    for order, offset in zip(diagram.orders[fixed != 0].tolist(), fixed[fixed != 0].tolist(), strict=True):
        rpm = np.linspace(left, right, 200)
        hertz = np.abs(order * rpm / 60 + offset / (2 * math.pi))
        axes.plot(rpm, hertz, color=SOFT, linewidth=0.5, linestyle="--", alpha=0.8, zorder=1)
        _name_of_line(axes, rpm, hertz, line_words(order, offset))
    for order in sorted(diagram.orders[fixed == 0].tolist()):
        axes.plot(
            [left, right],
            [order * left / 60, order * right / 60],
            color=SOFT,
            linewidth=0.5,
            alpha=0.6,
            zorder=1,
        )
        x, y = (right, order * right / 60) if order * right / 60 <= top else (60 * top / order, top)
        # Along the right edge upwards, then along the upper edge to the left.
        along = y / top if x == right else 1 + (right - x) / (right - left)
        if x < left or (last is not None and along - last < _APART):
            continue
        last = along
        at_right = x == right
        axes.annotate(
            f"{order:.4g}",
            (x, y),
            xytext=(3, 0) if at_right else (0, 2),
            textcoords="offset points",
            ha="left" if at_right else "center",
            va="center" if at_right else "bottom",
            color=SOFT,
            fontsize=SMALL,
        )


def _name_of_line(axes: Axes, rpm: Floats, hertz: Floats, words: str) -> None:
    """The name of a line of fixed frequency where it leaves the picture on the right, or above."""
    top = axes.get_ylim()[1]
    inside = np.flatnonzero(hertz <= top)
    if not len(inside):
        return
    where: dict[str, Any] = {"textcoords": "offset points", "color": SOFT, "fontsize": SMALL}
    last = int(inside[-1])
    if last == len(rpm) - 1:
        # Inside: numbers of orders stand beside the edge.
        axes.annotate(words, (rpm[last], hertz[last]), xytext=(-4, 2), ha="right", va="bottom", **where)
    else:
        # Below the numbers of the orders, which stand on the upper edge.
        axes.annotate(words, (rpm[last], top), xytext=(-4, -5), ha="right", va="top", **where)


def _points(axes: Axes, diagram: CampbellDiagram) -> None:
    critical = diagram.critical
    if not critical:
        return
    severity, name = _severity(diagram)
    share = severity / severity.max() if severity.max() > 0 else np.zeros_like(severity)
    x = np.array([crossing.speed for crossing in critical]) * _RPM
    y = np.array([crossing.frequency for crossing in critical])
    area = np.maximum(_LARGEST * share, 3.0) if name else np.full(len(x), _PLAIN)
    axes.scatter(
        x, y, s=area, facecolor=ORANGE, edgecolor=RED, linewidth=0.8, alpha=0.85, zorder=3, label=name
    )
    if name:
        worst = [n for n in np.argsort(-severity, kind="stable").tolist() if share[n] > 0]
        _write_labels(axes, [(x[n], y[n], area[n], critical[n].line) for n in worst[:_TOLD]])


def _write_labels(axes: Axes, listed: list[tuple[float, float, float, str]]) -> None:
    """Speed and line beside points of known area, the most severe first, where there is room."""
    (left, right), top = axes.get_xlim(), axes.get_ylim()[1]
    taken: list[tuple[float, float, float]] = []
    for x, y, area, line in listed:
        words = f"{x:.4g} ({line})"
        across, height = (x - left) / (right - left), y / top
        half = _WORDS[0] * len(words) / 2
        if any(abs(across - u) < half + w and abs(height - v) < _WORDS[1] for u, v, w in taken):
            continue
        taken.append((across, height, half))
        side = "left" if across < half else "right" if across > 1 - half else "center"
        axes.annotate(
            words,
            (x, y),
            xytext=(0, 3 + math.sqrt(area) / 2),
            textcoords="offset points",
            ha=side,
            fontsize=SMALL,
            color=INK,
            zorder=4,
        )


def _severity(diagram: CampbellDiagram) -> tuple[Floats, str]:
    """Severity of critical speeds and its measure; infinite values at twice the largest finite one."""
    for entry, name in (
        (
            "resonance_amplitude",
            "critical, undamped: rpm (order), by amplitude of the mode alone at resonance",
        ),
        ("equilibrium_amplitude", "critical: rpm (order), by equilibrium amplitude"),
    ):
        amplitudes = [getattr(crossing, entry) for crossing in diagram.critical]
        if all(value is not None for value in amplitudes) and any(amplitudes):
            size = np.array(amplitudes, float)
            finite = size[np.isfinite(size)]
            if len(finite) and finite.max() > 0:
                return np.where(np.isfinite(size), size, 2 * finite.max()), name
    return np.ones(len(diagram.critical)), ""
