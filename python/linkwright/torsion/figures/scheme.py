"""The equivalent scheme of a train, drawn: discs as bars, shafts as lines, gears, branches, grounds."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from linkwright.kernel.figure.style import BLUE, GREEN, INK, PAPER, RED, SMALL, SOFT, styled
from linkwright.torsion.figures.equal_planets import equal_planets_once
from linkwright.torsion.figures.scheme_layout import Bridge, Riser, Span
from linkwright.torsion.figures.scheme_page import GAP, HALF, HIGH, LINE, LOW, MARGIN, Page, in_a_row, page

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from linkwright.torsion.modes.scheme import Connection, Scheme

_COLOURS = {
    "shaft": BLUE,
    "coupling": BLUE,
    "mesh": RED,
    "gears": RED,
    "bearing": SOFT,
    "clutch": RED,
    "damper": GREEN,
    "pendulum": GREEN,
}


@styled
def scheme_figure(scheme: Scheme) -> Figure:
    """Draw the equivalent scheme of a train."""
    from matplotlib.figure import Figure

    scheme = equal_planets_once(scheme).scheme
    laid = page(scheme, turned=False)
    if laid.oversize > 1:
        laid = min(laid, page(scheme, turned=True), key=lambda part: part.oversize)
    levels, note = laid.levels(), laid.note()
    bottom = levels[-1][2] - 1.3 * LINE * len(note)
    figure = Figure(figsize=(laid.width, 2 * MARGIN - bottom))
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_axis_off()
    axes.set_xlim(laid.left - MARGIN, laid.left + laid.width - MARGIN)
    axes.set_ylim(bottom - MARGIN, MARGIN)
    _Pen(axes, laid).draw()
    axes.text(laid.left, bottom, "\n".join(note), size=SMALL, color=SOFT, va="bottom", linespacing=1.3)
    return figure


class _Pen:
    """Draws a scheme into axes whose unit is an inch."""

    def __init__(self, axes: Axes, laid: Page) -> None:
        self.axes, self.laid, self.places = axes, laid, laid.places
        self.levels = laid.levels()
        J = laid.scheme.inertia_referred
        heights = np.maximum(LOW, HIGH * (J / J.max()) ** 0.25)
        self.half = dict(zip(laid.scheme.discs, heights.tolist(), strict=True))
        # Discs that a line leaves upwards (+1) or downwards (−1): their words step aside.
        self.left: set[tuple[str, int]] = set()

    def draw(self) -> None:
        for span in self.places.spans:
            self._span(span)
        for riser in self.places.risers:
            self._riser(riser)
        for bridge in self.places.bridges:
            self._bridge(bridge)
        for name in self.places.discs:
            self._disc(name)

    def _line(self, x: Sequence[float], y: Sequence[float], part: Connection) -> None:
        dashes: Any = (0, (4, 2)) if part.kind in ("gears", "clutch") else "-"
        self.axes.plot(x, y, color=_COLOURS[part.kind], linewidth=1.3, zorder=1, linestyle=dashes)

    def _words(self, x: float, y: float, text: str, **more: Any) -> None:
        style = {"size": SMALL, "linespacing": 1.15, "zorder": 4, **more}
        self.axes.text(x, y, text, **style)

    # -- shafts ------------------------------------------------------------------------------------------

    def _span(self, span: Span) -> None:
        y, middle = self.levels[span.row][0], 0.5 * (span.start + span.stop)
        self._elastic(span, y)
        if span.part.name in self.laid.broken:
            # A spring has the middle of its line for itself.
            self._break(middle if span.part.kind == "shaft" else 0.5 * (middle + span.stop), y)
        if span.to_ground:
            self._ground(span.stop, y, 1 if span.stop > span.start else -1)
        words = self.laid.parts[span.part.name]
        if self.laid.turned:
            text, down = in_a_row(words), {"rotation": 90, "va": "top", "ha": "center"}
            self._words(middle, y - 2 * GAP, text, color=SOFT, **down)
            return
        lift = 1.5 * GAP
        self._words(middle, y + lift, "\n".join(words.above), ha="center", va="bottom", color=SOFT)
        self._words(middle, y - lift, "\n".join(words.below), ha="center", va="top", color=SOFT)

    def _elastic(self, span: Span, y: float) -> None:
        part, middle = span.part, 0.5 * (span.start + span.stop)
        if part.kind in ("shaft", "gears", "bearing", "clutch"):
            self._line((span.start, span.stop), (y, y), part)
            return
        self._line((span.start, middle - 0.12), (y, y), part)
        self._line((middle + 0.12, span.stop), (y, y), part)
        if part.stiffness is None:
            self._dashpot(middle, y, part)
        else:
            wave = 0.045 * np.array([0, 1, -1, 1, -1, 1, -1, 0])
            self._line(np.linspace(middle - 0.12, middle + 0.12, 8).tolist(), (y + wave).tolist(), part)

    def _dashpot(self, x: float, y: float, part: Connection) -> None:
        self._line((x + 0.08, x - 0.12, x - 0.12, x + 0.08), (y + 0.06, y + 0.06, y - 0.06, y - 0.06), part)
        self._line((x, x), (y - 0.04, y + 0.04), part)
        self._line((x, x + 0.12), (y, y), part)

    def _break(self, x: float, y: float) -> None:
        """Two strokes across a shaft that is longer than it is drawn."""
        self.axes.plot((x - 0.03, x + 0.03), (y, y), color="white", linewidth=3, zorder=2)
        for shift in (-0.03, 0.03):
            self.axes.plot(
                (x + shift - 0.025, x + shift + 0.025),
                (y - 0.07, y + 0.07),
                color=BLUE,
                linewidth=1,
                zorder=3,
            )

    def _ground(self, x: float, y: float, side: int) -> None:
        """A wall with hatching behind it."""
        self.axes.plot((x, x), (y - 0.2, y + 0.2), color=INK, linewidth=1.4)
        for step in np.linspace(-0.2, 0.12, 5):
            self.axes.plot((x, x + 0.08 * side), (y + step, y + step + 0.08), color=INK, linewidth=0.7)

    # -- between rows ------------------------------------------------------------------------------------

    def _riser(self, riser: Riser) -> None:
        x, part = self.places.discs[riser.disc][0], riser.part
        down = riser.side
        start, stop = self.levels[riser.row][0], self.levels[riser.to_row][0]
        geared = part.is_geared
        other = part.second if part.first == riser.disc else part.first
        begin = start - down * self.half[riser.disc]
        end = stop + down * self.half[other] if geared else stop
        if x != riser.x:
            # A third line from one disc leaves it aside.
            begin = start - down * 0.5 * self.half[riser.disc]
            self._line((x, riser.x), (begin, begin), part)
        self._rise(riser.x, begin, end, part)
        self.left |= {(riser.disc, -down)} if x == riser.x else set()
        if geared:
            self.left.add((other, down))
            self._riser_words(riser)

    def _riser_words(self, riser: Riser) -> None:
        """Beside gears, where they enter a row; other ways that pass there are interrupted."""
        words, ends = self.laid.parts[riser.part.name], self.levels[riser.to_row]
        y, va = (ends[1] - GAP, "top") if riser.side > 0 else (ends[2] + GAP, "bottom")
        clear = {"facecolor": PAPER, "edgecolor": "none", "pad": 0.6}
        if self.laid.turned:
            text, x, more = in_a_row(words), riser.x + LINE, {"rotation": 90, "ha": "center"}
        else:
            text, x, more = "\n".join(words.below), riser.x + 2 * GAP, {"ha": "left"}
        self._words(x, y, text, color=SOFT, va=va, bbox=clear, **more)

    def _rise(self, x: float, begin: float, end: float, part: Connection) -> None:
        if part.kind != "mesh":
            self._line((x, x), (begin, end), part)
            return
        middle, reach = 0.5 * (begin + end), 0.12 * np.sign(end - begin)
        self._line((x, x), (begin, middle - reach), part)
        self._line((x, x), (middle + reach, end), part)
        wave = 0.045 * np.array([0, 1, -1, 1, -1, 1, -1, 0])
        self._line((x + wave).tolist(), np.linspace(middle - reach, middle + reach, 8).tolist(), part)

    def _bridge(self, bridge: Bridge) -> None:
        """What closes a loop: over the names of its row, or straight between two rows."""
        part, row = bridge.part, self.laid.row_of(bridge)
        (x, x_row), (z, z_row) = (self.places.discs[end] for end in (part.first, part.second))
        text = in_a_row(self.laid.parts[part.name])
        if x_row != z_row:
            way, (high, deep) = self.laid.way_round(bridge), (self.levels[at][0] for at in (x_row, z_row))
            self._line((x, way, way, z), (high, high, deep, deep), part)
            up = {"va": "center", "ha": "right", "rotation": 90}
            self._words(way - 0.5 * GAP, 0.5 * (high + deep), text, color=SOFT, **up)
            return
        y = self.levels[row][0]
        top = y + self.laid.bridge_height(bridge)
        low = [y + self.half[end] for end in (part.first, part.second)]
        self._line((x, x, z, z), (low[0], top, top, low[1]), part)
        self.left |= {(part.first, 1), (part.second, 1)}
        self._words(0.5 * (x + z), top + 0.5 * GAP, text, va="bottom", ha="center", color=SOFT)

    # -- discs -------------------------------------------------------------------------------------------

    def _disc(self, name: str) -> None:
        from matplotlib.patches import Rectangle

        x, row = self.places.discs[name]
        y, half = self.levels[row][0], self.half[name]
        self.axes.add_patch(Rectangle((x - HALF, y - half), 2 * HALF, 2 * half, color=INK, zorder=3))
        words = self.laid.discs[name]
        for side, lines in ((1, words.above), (-1, words.below)):
            aside = (name, side) in self.left
            if self.laid.turned:
                at, text = y + side * (HIGH + GAP), ", ".join(lines)
                more = {"rotation": 90, "ha": "center", "va": "bottom" if side > 0 else "top"}
                self._words(x + (LINE if aside else 0.0), at, text, **more)
            else:
                at = y + side * (max(half, 2.6 * LINE) + GAP)
                more = {"ha": "left" if aside else "center", "va": "bottom" if side > 0 else "top"}
                self._words(x + (GAP if aside else 0.0), at, "\n".join(lines), **more)
