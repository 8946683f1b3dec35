"""The mechanism at one instant, drawn for paper from the parts of the moving sketch."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.figure.style import INK, LINES, PAPER, SOFT, WIDTH, named, styled
from linkwright.kernel.reader.numbers import quantity

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Scene = dict[str, Any]

# Width of the drawing in the units in which joints, blocks and hatches have their sizes, and the height that
# a tall machine may take [inch].
_ACROSS, _TALLEST = 640.0, 3.6

# Line widths of links [points].
_WIDTHS = {"crank": 5.0, "cable": 1.5, "arm": 3.0}

_FILL = "#eef1f4"


@styled
def sketch_figure(scene: Scene, place: float = 0.125) -> Figure:
    """Draw a scene of `moving_scene` to scale at one instant, from 0 to 1 of the motion that is drawn."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(WIDTH, _TALLEST), layout="constrained")
    axes = figure.subplots()
    axes.set_axis_off()
    axes.set_aspect("equal")
    paint(axes, scene, place)
    # Room for the names and hatches around what is drawn.
    left, bottom, right, top = axes.dataLim.extents
    room = 0.04 * max(right - left, top - bottom)
    axes.set_xlim(left - room, right + room)
    axes.set_ylim(bottom - room, top + room)
    figure.set_figheight(min(WIDTH * (top - bottom + 2 * room) / (right - left + 2 * room), _TALLEST))
    return figure


def paint(axes: Axes, scene: Scene, place: float) -> None:
    """Draw all parts of a scene at an instant, from behind to the front; ``place`` from 0 to 1."""
    painter = _Painter(axes, Pose(scene, place))
    for depth, part in enumerate(scene["parts"]):
        painter.draw(part, depth)


class Pose:
    """Where the points and links of a scene are at one instant; ``place`` in the motion, from 0 to 1."""

    def __init__(self, scene: Scene, place: float) -> None:
        self.scene, self.place = scene, place * (len(scene["angles"]) - 1)

    def at(self, name: str) -> Floats:
        """Where a point is [m]."""
        points = np.asarray(self.scene["points"][name])
        steps = np.arange(len(points))
        return np.array([np.interp(self.place, steps, points[:, axis]) for axis in (0, 1)])

    def carried(self, part: Scene, shape: Any) -> Floats:
        """A shape about the origin, along +x, moved to the part's point, turned with its link, (n, 2) [m]."""
        angle = float(part.get("angle") or 0.0)
        if part.get("link"):
            headings = self.scene["headings"][part["link"]]
            angle += float(np.interp(self.place, np.arange(len(headings)), headings))
        cos, sin = np.cos(angle), np.sin(angle)
        turned: Floats = np.asarray(shape, float) @ np.array([[cos, sin], [-sin, cos]]) + self.at(part["at"])
        return turned


class _Painter:
    """Draws the parts of a scene at one instant."""

    def __init__(self, axes: Axes, pose: Pose) -> None:
        self.axes, self.scene = axes, pose.scene
        self.at, self.carried, self.place = pose.at, pose.carried, pose.place
        scene = pose.scene
        left, bottom, right, top = scene["box"]
        self.unit = max(right - left, top - bottom, 1e-9) / _ACROSS
        self.depth = 0
        self.ends: dict[str, list[str]] = {}
        for part in scene["parts"]:
            if "from" in part:
                self.ends.setdefault(part["from"], []).append(part["to"])
                self.ends.setdefault(part["to"], []).append(part["from"])

    def draw(self, part: Scene, depth: int) -> None:
        self.depth = depth
        kind: Callable[[Scene], None] = getattr(self, f"_{part['kind']}")
        kind(part)

    def line(self, points: Any, colour: str, width: float, **more: Any) -> None:
        """A polyline, (n, 2) [m], with a width in points."""
        x, y = np.asarray(points).T
        more = {"solid_capstyle": "round", **more}
        self.axes.plot(x, y, color=colour, linewidth=width, zorder=2 + self.depth * 1e-3, **more)

    def area(self, points: Any, edge: str, fill: str, width: float = 1.5, alpha: float = 1.0) -> None:
        """A closed outline, (n, 2) [m], and what fills it."""
        x, y = np.asarray(points).T
        depth = 2 + self.depth * 1e-3
        self.axes.fill(x, y, facecolor=fill, edgecolor="none", alpha=alpha, zorder=depth)
        self.line(np.vstack([points, points[:1]]), edge, width)

    def hatch(self, middle: Floats, along: Floats, length: float) -> None:
        normal = np.array([along[1], -along[0]])
        for s in np.arange(-length / 2, length / 2 + 0.1 * self.unit, 8 * self.unit):
            foot = middle + s * along
            self.line([foot, foot - 6 * self.unit * along + 8 * self.unit * normal], SOFT, 0.7)

    def _guide(self, part: Scene) -> None:
        a, b = (np.array(end, float) for end in part["ends"])
        along = np.array([np.cos(part["angle"]), np.sin(part["angle"])])
        normal = np.array([along[1], -along[0]])
        length = float(np.hypot(*(b - a))) + 76 * self.unit
        middle = (a + b) / 2 + 16 * self.unit * normal
        self.line([middle - length / 2 * along, middle + length / 2 * along], SOFT, 1)
        self.hatch(middle, along, length)

    def _ground(self, part: Scene) -> None:
        foot = self.at(part["name"])
        u = self.unit
        self.area(foot + np.array([[0, 0], [-13, -22], [13, -22]]) * u, SOFT, _FILL, 1)
        self.hatch(foot + np.array([0, -22 * u]), np.array([1.0, 0.0]), 38 * u)
        self.words(foot + np.array([16, -18]) * u, part["name"])

    def words(self, place: Floats, text: str, **more: Any) -> None:
        from matplotlib.patheffects import withStroke

        x, y = place.tolist()
        drawn = self.axes.text(x, y, named(text), fontsize=8, color=SOFT, zorder=4, **more)
        # Lines do not run through it.
        drawn.set_path_effects([withStroke(linewidth=2, foreground=PAPER)])

    def _trace(self, part: Scene) -> None:
        self.line(self.scene["points"][part["name"]], SOFT, 0.8, linestyle=(0, (5, 3)))

    def _rail(self, part: Scene) -> None:
        (a, b), y = part["span"], part["offset"]
        for side in (-9 * self.unit, 9 * self.unit):
            ends = [[a - 16 * self.unit, y + side], [b + 16 * self.unit, y + side]]
            self.line(self.carried(part, ends), _colour(part), 1.3)

    def _slot(self, part: Scene) -> None:
        y = part["offset"]
        (a, b), (c, d) = part["bar"], part["span"]
        self.line(self.carried(part, [[0, 0], [0, y]]), _colour(part), 3.5)
        self.line(self.carried(part, [[a, y], [b, y]]), _colour(part), 12)
        self.line(self.carried(part, [[c, y], [d, y]]), "white", 7)

    def _gear(self, part: Scene) -> None:
        self.area(self.carried(part, part["radius"] * _CIRCLE), _colour(part), _FILL, 1.3, 0.35)
        if part.get("link"):
            self.line(self.carried(part, [[0, 0], [part["radius"], 0]]), _colour(part), 1.3)

    def _cam(self, part: Scene) -> None:
        for n, outline in enumerate(part["outlines"]):
            shape = self.carried(part, outline)
            self.area(shape, _colour(part), "none" if n else _colour(part), 1.6, 0.14)
        mark = self.carried(part, [[0, 0], part["outlines"][0][0]])
        self.line(mark, _colour(part), 0.9, linestyle=(0, (5, 4)))

    def _rod(self, part: Scene) -> None:
        if part["rod"]:
            self.line(self.carried(part, [part["place"], part["rod"]]), _colour(part), 3.5)

    def _roller(self, part: Scene) -> None:
        self._rod(part)
        radius = max(part["radius"], 4 * self.unit)
        outline = np.asarray(part["place"]) + radius * _CIRCLE
        self.area(self.carried(part, outline), _colour(part), _FILL, 1.6)

    def _face(self, part: Scene) -> None:
        self._rod(part)
        along = np.array([np.cos(part["along"]), np.sin(part["along"])])
        ends = [np.asarray(part["place"]) + end * along for end in part["ends"]]
        self.line(self.carried(part, ends), _colour(part), 3)

    def _belt(self, part: Scene) -> None:
        first, second = self.at(part["from"]), self.at(part["to"])
        r1, r2 = part["radii"]
        way = second - first
        distance, heading = float(np.hypot(*way)), float(np.arctan2(way[1], way[0]))
        lean = np.arccos((r1 + r2 if part["crossed"] else r1 - r2) / distance)
        for side in (lean, -lean):
            out = np.array([np.cos(heading + side), np.sin(heading + side)])
            self.line([first + r1 * out, second + (-r2 if part["crossed"] else r2) * out], INK, 1.2)

    def _rack(self, part: Scene) -> None:
        (a, b), u = part["span"], self.unit
        back = -8 * u if part["side"] == "right" else 8 * u
        self.line(self.carried(part, [[a - 30 * u, -back], [b + 30 * u, -back]]), _colour(part), 1.6)
        for s in np.arange(a - 30 * u, b + 30.1 * u, 10 * u):
            self.line(self.carried(part, [[s, -back], [s, 0]]), _colour(part), 1.2)

    def _arc(self, part: Scene) -> None:
        low, high = part["span"]
        angles = np.linspace(low, high, 40)
        shape = part["radius"] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
        # The arc is part of its link.
        self.area(self.carried(part, [[0, 0], *shape]), _colour(part), _colour(part), 1.0, 0.18)
        self.line(self.carried(part, shape), _colour(part), 3.5)

    def _link(self, part: Scene) -> None:
        ends = [self.at(part["from"]), self.at(part["to"])]
        self.line(ends, _colour(part), _WIDTHS.get(part["role"], 3.5))

    def _plate(self, part: Scene) -> None:
        corners = np.array([self.at(name) for name in part["corners"]])
        self.area(corners, _colour(part), _colour(part), 1.4, 0.18)

    def _spring(self, part: Scene) -> None:
        self.line(list(_coil(self.at(part["from"]), self.at(part["to"]), 9 * self.unit)), LINES[2], 1.2)

    def _rods(self, part: Scene) -> None:
        """A rod string in its well: tubing, barrel and plunger, rods in the colours of their stress."""
        x, half, top, (foot, head) = part["x"], part["half"], part["top"], part["barrel"]
        for side in (-half, half):
            self.line([[x + side, top], [x + side, head]], SOFT, 1.0)
            self.line([[x + 0.6 * side, head], [x + 0.6 * side, foot]], INK, 1.6)
        self.line([[x - 0.6 * half, foot], [x + 0.6 * half, foot]], INK, 1.6)
        self.hatch(np.array([x, top]), np.array([1.0, 0.0]), 6 * half)
        places = np.arange(len(self.scene["angles"]))
        heights, shares = (
            np.array([np.interp(self.place, places, row) for row in self.scene["rods"][key]])
            for key in ("heights", "shares")
        )
        for n in range(len(heights) - 1):
            ends = [[x, heights[n]], [x, heights[n + 1]]]
            self.mixed(ends, 0.5 * (shares[n] + shares[n + 1]), 4.0 * part["wide"][n])
        plunger = np.array([[-0.45, -0.9], [0.45, -0.9], [0.45, 0.9], [-0.45, 0.9]]) * half
        self.area(np.add(plunger, [x, heights[-1]]), INK, _FILL, 1.2)
        self._stress_scale(part)

    def _stress_scale(self, part: Scene) -> None:
        x, top = part["x"] + 2 * part["half"], part["top"] - 2 * part["half"]
        steps = np.linspace(top - 6 * part["half"], top, 13)
        for n, (low, high) in enumerate(pairwise(steps)):
            self.mixed([[x, low], [x, high]], n / 11, 4.0, capped=False)
        for height, value in ((steps[0], part["range"][0]), (top, part["range"][1])):
            words = quantity(value, "Pa", 3, usual="MPa")
            self.words(np.array([x + 0.5 * part["half"], height]), words, ha="left", va="center")

    def mixed(self, ends: Any, share: float, width: float, *, capped: bool = True) -> None:
        """A line in a colour between those of the lowest and of the highest stress."""
        more = {} if capped else {"solid_capstyle": "butt"}
        for colour, alpha in ((LINES[0], 1.0), (LINES[1], float(np.clip(share, 0, 1)))):
            self.line(ends, colour, width, alpha=alpha, **more)

    def _slider(self, part: Scene) -> None:
        width, height = np.array([44, 30] if part["heavy"] else [30, 22]) * self.unit
        box = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * [width / 2, height / 2]
        self.area(self.carried(part, box), _colour(part), _FILL, 1.8)

    def _mass(self, part: Scene) -> None:
        place = part.get("place")
        size = 4 if place else 7
        shape = self.carried(part, np.asarray(place or [0.0, 0.0]) + size * self.unit * _CIRCLE)
        self.area(shape, INK, INK, 0.5)

    def _point(self, part: Scene) -> None:
        place = self.at(part["name"])
        self.area(place + 5 * self.unit * _CIRCLE, INK, "white", 1.2)
        if part["slides"]:
            self.words(place + np.array([-16, 24 + 15 * part["series"]]) * self.unit, part["name"])
            return
        cos, sin = self.free_side(part["name"])
        sides = {"ha": ("right", "center", "left"), "va": ("top", "center", "bottom")}
        near = {
            key: side[1 + round(1.2 * part)]
            for (key, side), part in zip(sides.items(), (cos, sin), strict=True)
        }
        self.words(place + 12 * self.unit * np.array([cos, sin]), part["name"], **near)

    def free_side(self, name: str) -> tuple[float, float]:
        """Direction from a joint in the middle of the widest gap between its links."""
        ways = [self.at(end) - self.at(name) for end in self.ends.get(name, ())]
        if not ways:
            left, bottom, right, top = self.scene["box"]
            ways = [np.array([left + right, bottom + top]) / 2 - self.at(name)]
        angles = np.sort([np.arctan2(y, x) for x, y in ways])
        gaps = np.diff(angles, append=angles[0] + 2 * np.pi)
        side = float(angles[gaps.argmax()] + gaps.max() / 2)
        return float(np.cos(side)), float(np.sin(side))


_TURN = np.linspace(0, 2 * np.pi, 73)
_CIRCLE = np.stack([np.cos(_TURN), np.sin(_TURN)], axis=1)


def _colour(part: Scene) -> str:
    return LINES[part["series"] % len(LINES)]


def _coil(start: Floats, end: Floats, half_width: float) -> Iterator[Floats]:
    """Zigzag of a spring between two points [m]."""
    way = end - start
    normal = np.array([-way[1], way[0]]) / (float(np.hypot(*way)) or 1.0)
    for n in range(13):
        side = 0.0 if n < 2 or n > 10 else (half_width if n % 2 else -half_width)
        yield start + n / 12 * way + side * normal
