"""The knife of a topper from above: its edge over a head, the area it sweeps, and what it leaves."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.figure.style import BLUE, GREEN, INK, RED, SKY, SOFT, panels, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.patches import PathPatch

    from linkwright.topping.head_pass import HeadPass

_MILLI = 1e3

# Places of the edge that are drawn, from before the head to behind it, and slices of the swept band.
_PLACES, _SLICES = 5, 240

# The band is drawn so far before and behind the head, over its radius.
_REACH = 1.25

# Width over height of the panel.
_PANEL = 1.5

# An edge at a large angle comes from far away: beyond so many diameters it is not drawn.
_FAR = 3.5

# Room about what is drawn, over the head's diameter.
_ROOM = 0.12


@styled
def top_view_figure(
    seen: HeadPass, greatest_offset: float = 0.0, last: tuple[float, float] | None = None
) -> Figure:
    """Draw the pass of an edge over a head from above, the row to the right.

    ``greatest_offset``: heads at this distance on both sides of the row are drawn lightly [m]; ``last``: the
    point that is reached last, x and y from the head's centre [m].
    """
    figure, (axes,) = panels(1, height=5.2)
    shown = _shown(seen)
    _band(axes, seen, shown)
    _heads(axes, seen, greatest_offset)
    _left(axes, seen)
    _edges(axes, seen, shown)
    if last is not None and not seen.outlines:
        x, y = _MILLI * last[0], _MILLI * (last[1] + seen.offset)
        axes.plot(x, y, "o", color=RED, markersize=6, label="point farthest from the edge's middle")
    _frame(axes, seen, shown, greatest_offset)
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper left", ncols=3, handlelength=1.8)
    return figure


def _shown(seen: HeadPass) -> slice:
    near = np.flatnonzero(np.abs(seen.normal) <= _REACH * 0.5 * seen.diameter)
    # An edge that stands may keep away from the head indefinitely.
    return slice(int(near[0]), int(near[-1]) + 1) if near.size else slice(0, len(seen.time))


def _band(axes: Axes, seen: HeadPass, shown: slice) -> None:
    axes.add_patch(_swept(_MILLI * seen.ends[:, shown]))
    middle = _MILLI * np.stack([seen.middle_x[shown], seen.middle_y[shown]])
    axes.plot(
        *middle, color=BLUE, linewidth=1.1, linestyle=(0, (5, 3)), label="path of the middle of the edge"
    )


def _swept(ends: Floats) -> PathPatch:
    """Slices between neighbouring places of an edge, all turning the same way, as one area."""
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path

    picked = np.unique(np.linspace(0, ends.shape[1] - 1, _SLICES).astype(int))
    right, left = ends[0, picked], ends[1, picked]
    corners = np.stack([right[:-1], right[1:], left[1:], left[:-1], right[:-1]], axis=1)
    across, along = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
    turned = across[:, 0] * along[:, 1] - across[:, 1] * along[:, 0] < 0
    corners[turned] = corners[turned][:, ::-1]
    codes = np.tile([Path.MOVETO, Path.LINETO, Path.LINETO, Path.LINETO, Path.CLOSEPOLY], len(corners))
    path = Path(corners.reshape(-1, 2), codes)
    return PathPatch(path, facecolor=SKY, alpha=0.22, linewidth=0, label="swept by the edge")


def _heads(axes: Axes, seen: HeadPass, greatest_offset: float) -> None:
    from matplotlib.patches import Circle

    radius = 0.5 * _MILLI * seen.diameter
    beside = {sign * _MILLI * greatest_offset for sign in (-1, 0, 1)} - {_MILLI * seen.offset}
    for nth, y in enumerate(sorted(beside)):
        words = "other heads, up to ±Δ" if nth == 0 and greatest_offset else None
        axes.add_patch(Circle((0, y), radius, fill=False, color=SOFT, linewidth=0.8, label=words))
    centre = (0, _MILLI * seen.offset)
    axes.add_patch(Circle(centre, radius, facecolor=GREEN, alpha=0.3, linewidth=0, label="the head"))
    axes.add_patch(Circle(centre, radius, fill=False, edgecolor=GREEN, linewidth=1.8))
    axes.plot(*centre, "+", color=GREEN, markersize=9)
    axes.axhline(0, color=SOFT, linewidth=0.9, linestyle=(0, (8, 3, 1, 3)))


def _left(axes: Axes, seen: HeadPass) -> None:
    from matplotlib.patches import Polygon

    for nth, outline in enumerate(seen.outlines):
        words = "left uncut" if nth == 0 else None
        corners = _MILLI * outline
        axes.add_patch(Polygon(corners, facecolor=RED, alpha=0.25, linewidth=0))
        axes.add_patch(Polygon(corners, fill=False, edgecolor=RED, hatch="/////", linewidth=1.2, label=words))


def _edges(axes: Axes, seen: HeadPass, shown: slice) -> None:
    ends = _MILLI * seen.ends[:, shown]
    places = np.linspace(0, ends.shape[1] - 1, _PLACES).astype(int)
    for nth, place in enumerate(places):
        share = 0.3 + 0.7 * nth / (_PLACES - 1)
        label = "the edge" if nth == _PLACES - 1 else None
        axes.plot(*ends[:, place].T, color=BLUE, alpha=share, linewidth=2.6, label=label)
    tip = ends[:, places[-1]].mean(axis=0)
    before = ends[:, places[-2]].mean(axis=0)
    arrow = {"arrowstyle": "-|>", "color": INK, "linewidth": 1.2}
    axes.annotate("", xy=tip + 0.35 * (tip - before), xytext=tip, arrowprops=arrow)


def _frame(axes: Axes, seen: HeadPass, shown: slice, greatest_offset: float) -> None:
    far, room = _FAR * _MILLI * seen.diameter, _ROOM * _MILLI * seen.diameter
    ends = np.clip(_MILLI * seen.ends[:, shown].reshape(-1, 2), -far, far)
    radius = 0.5 * _MILLI * seen.diameter
    x = [*ends[:, 0], -radius, radius]
    # The arrow goes on beyond the last place.
    x_high = max(x) + 0.1 * (max(x) - min(x))
    y = [*ends[:, 1], *(sign * (radius + _MILLI * greatest_offset) for sign in (-1, 1))]
    wide, high = x_high - min(x) + 2 * room, max(y) - min(y) + 2 * room
    # The panel is filled, whichever way the band is long.
    more_x, more_y = 0.5 * max(0.0, _PANEL * high - wide), 0.5 * max(0.0, wide / _PANEL - high)
    axes.set_aspect("equal")
    axes.set_xlim(min(x) - room - more_x, x_high + room + more_x)
    axes.set_ylim(min(y) - room - more_y, max(y) + room + more_y)
    axes.set_xlabel("along the row, in the sense of travel [mm]")
    axes.set_ylabel("across the row, to the left [mm]")
