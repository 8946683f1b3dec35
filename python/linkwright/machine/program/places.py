"""Where points and links are in the program, and what waits for the initial assembly."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from linkwright import _core
from linkwright.linkages.model.element import Guide
from linkwright.linkages.model.mechanism import Mechanism
from linkwright.machine.program.numbers import Numbers


class Side(NamedTuple):
    """The sign of a dyad at a joint is that of the place where the joint is assembled."""

    joint: str
    slot: int
    pin: int
    # Point at the other end of a dyad RRR; a guide as its link, none for the frame, and direction in it.
    pivot: int | None = None
    guide: tuple[int | None, Any] | None = None


class Continuous(NamedTuple):
    """The continuous angle of a link."""

    name: str
    link: int
    winding: int
    centre: int
    # The revolution is the one in which the angle at the start is nearest to this.
    near: Any = 0.0


class Foldable(NamedTuple):
    """A dyad RRR or RRP that may have change points."""

    name: str
    element: int
    sign: int


class PendingGroup(NamedTuple):
    """A group, whose motion has to be followed once."""

    names: tuple[str, ...]
    element: int
    inverse_turns: int


Pending = Side | Continuous | Foldable | PendingGroup


@dataclass
class GuideLine:
    """A guide in the core's terms: point, link (none for the frame), direction in it, offset."""

    through: int
    link: int | None
    angle: Any
    offset: Any


class Places(Numbers):
    """Collects numbers and elements, each thing with the index that the core has for it.

    Indices count up as elements make things, and every element stands behind what it hangs on: the core
    checks both.
    """

    def __init__(self, mechanism: Mechanism) -> None:
        super().__init__()
        self.mechanism = mechanism
        self.links_of = mechanism.links()
        self.points: dict[str, int] = {}
        self.links: dict[str, int] = {}
        self.slides: dict[str, int] = {}
        self.dyads: list[str] = []
        self.ground: list[_core.GroundPoint] = []
        self.elements: list[_core.Element] = []
        self.pending: list[Pending] = []
        # Start point of each link, the origin being known even where an element bears its name.
        self.starts: dict[str, int] = {}
        self.origin = -1
        self.fixed: dict[str, Any] = {}

    def _point(self, name: str) -> int:
        return self.points.setdefault(name, len(self.points))

    def _slide(self, name: str) -> int:
        return self.slides.setdefault(name, len(self.slides))

    def _link(self, name: str) -> int:
        link = self.links.setdefault(name, len(self.links))
        if name in self.links_of:
            start = self.links_of[name].start
            self.starts[name] = self.points.get(start, self.origin)
        return link

    def _dyad(self, name: str) -> int:
        self.dyads.append(name)
        return len(self.dyads) - 1

    def _fixed_or_origin(self, name: str | None) -> int:
        return self.origin if name is None else self.points[name]

    def _fixed(self, name: str, x: Any, y: Any) -> int:
        point = self._point(name)
        self.ground.append(_core.GroundPoint(point=point, x=self.slot(x), y=self.slot(y)))
        return point

    # -- guides ------------------------------------------------------------------------------------------

    def _guide(self, guide: Guide) -> GuideLine:
        """A guide with its point and link found."""
        if guide.on is None:
            return GuideLine(self._fixed_or_origin(guide.through), None, guide.angle, guide.offset)
        through = self.starts[guide.on] if guide.through is None else self.points[guide.through]
        return GuideLine(through, self.links[guide.on], guide.angle, guide.offset)

    def _line(self, line: GuideLine) -> _core.Line:
        return _core.Line(
            through=line.through,
            link=line.link,
            cos=self.slot(np.cos(line.angle)),
            sin=self.slot(np.sin(line.angle)),
            offset=self.slot(line.offset),
        )

    # -- coupled motions ---------------------------------------------------------------------------------

    def _sum(self, start: Any, terms: list[tuple[int | None, Any]]) -> _core.Sum:
        """A constant and its terms: slides, or the crank angle where there is none, with their factors."""
        constant = self.slot(start)
        return _core.Sum(
            start=constant,
            terms=[_core.Term(slide=slide, factor=self.slot(factor)) for slide, factor in terms],
        )

    def _runner(self, name: str, line: GuideLine, start: Any, terms: list[tuple[int | None, Any]]) -> None:
        self.elements.append(
            _core.Element.Runner(
                point=self._point(name),
                slide=self._slide(name),
                line=self._line(line),
                place=self._sum(start, terms),
            )
        )

    def _turn(self, name: str, start: Any, terms: list[tuple[int | None, Any]]) -> None:
        self.elements.append(
            _core.Element.Turn(
                link=self._link(name), slide=self._slide(angle_name(name)), angle=self._sum(start, terms)
            )
        )

    def _angle(self, link: str) -> int:
        """The slide that holds the continuous angle of a link; made where it is first asked for."""
        name = angle_name(link)
        return self.slides[name] if name in self.slides else self._angle_near(link, name, 0.0)

    def _angle_near(self, link: str, name: str, near: Any) -> int:
        """A slide with the continuous angle of a link, starting in the revolution nearest to an angle."""
        angle = _core.Element.AngleOf(
            link=self.links[link], slide=self._slide(name), winding=self.slot(0.0), centre=self.slot(0.0)
        )
        self.pending.append(Continuous(link, angle.link, angle.winding, angle.centre, near))
        self.elements.append(angle)
        return angle.slide


def angle_name(link: str) -> str:
    """Name of the slide that holds the continuous angle of a link; no element can have it."""
    return f"{link}.angle"


def length_name(name: str) -> str:
    """Name of the slide that holds the given length of a cylinder; no element can have it."""
    return f"{name}.length"
