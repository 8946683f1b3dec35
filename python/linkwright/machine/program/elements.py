"""Rows of the core's program for the elements of a mechanism.

The tables of rows are described at `Row` in `crates/linkwright-core/src/plan.rs`. What cannot be known before
the mechanism has been placed once (the side of a joint that is given by its place, the revolutions of a link
that a gear hangs on, where a group starts) is left open here and noted in `Rows.pending`; `settle` fills it
in.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from linkwright.kernel.description import formula
from linkwright.linkages.model.assembly import Step
from linkwright.linkages.model.element import (
    Cable,
    Crank,
    Crossing,
    Gear,
    Guide,
    LinearDriver,
    Rack,
    Rocker,
    Slider,
    SlottedLever,
    Yoke,
)
from linkwright.linkages.model.mechanism import Mechanism
from linkwright.machine.program.numbers import Numbers

_RADIAN = 2 * np.pi


class Side(NamedTuple):
    """The sign of a dyad at a joint is that of the place where the joint is assembled."""

    joint: str
    slot: int
    pin: int
    # Point at the other end of a dyad RRR; a guide as link and direction in it.
    pivot: int | None = None
    guide: tuple[int, Any] | None = None


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
    row: int
    gap: int
    sign: int


class Solved(NamedTuple):
    """A group, whose motion has to be followed once."""

    names: tuple[str, ...]
    row: int
    tables: tuple[int, ...]
    inverse_turns: int


Pending = Side | Continuous | Foldable | Solved


@dataclass
class Placed:
    """A guide in the core's terms: point, link, direction in it, offset."""

    through: int
    link: int
    angle: Any
    offset: Any


class Rows(Numbers):
    """Collects numbers and rows while it walks through a mechanism."""

    def __init__(self, mechanism: Mechanism) -> None:
        self.mechanism = mechanism
        self.links_of = mechanism.links()
        super().__init__()
        self.points: dict[str, int] = {}
        self.links: dict[str, int] = {}
        self.slides: dict[str, int] = {}
        self.dyads: list[str] = []
        self.rows: list[list[int]] = []
        self.pending: list[Pending] = []
        # Start point of each link, the origin being known even where an element bears its name.
        self.starts: dict[str, int] = {}
        self.origin = -1
        self.fixed: dict[str, Any] = {}
        self.frame = -1
        # How many of the numbers are the mechanism's own, and how many there are before anything is settled.
        self.n_own = 0
        self.n_described = 0
        # Links that were placed before the group whose rows are being made.
        self.known: set[str] = set()

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

    # -- the walk ----------------------------------------------------------------------------------------

    def build(self) -> None:
        """Fixed points first, then the moving elements in build order."""
        self.origin = self._fixed("", 0.0, 0.0)
        self.fixed = self.mechanism.fixed_points()
        for name, point in self.fixed.items():
            self._fixed(name, point.x, point.y)
        steps = self.mechanism.steps()
        # The frame is the link after the last: all others must be known before the first guide.
        self.frame = len(self.links_of) + sum(self._hidden_links(step) for step in steps)
        for step in steps:
            if step.kind == "element":
                self._element(step.names[0])
            elif step.kind == "dyad":
                self._dyad_of_bars(step)
            else:
                self._group(step)
        # The hidden origin has served: nobody can ask for it by name.
        self.points.pop("")
        self.n_own = len(self.parameters)

    def _element(self, name: str) -> None:
        """The rows of one element, by the table that it stands in."""
        mechanism = self.mechanism
        makers = {
            "cranks": self._crank,
            "linear_drivers": self._linear_driver,
            "sliders": self._slider,
            "rockers": self._rocker,
            "slotted_levers": self._slotted_lever,
            "crossings": self._crossing,
            "yokes": self._yoke,
            "rigid_points": self._rigid_point,
            "gears": self._gear,
            "racks": self._rack,
            "cables": self._cable,
            "bars": self._bar,
        }
        for table, make in makers.items():
            found = getattr(mechanism, table).get(name)
            if found is not None:
                make(name, found)  # type: ignore[operator]
                return

    def _fixed(self, name: str, x: Any, y: Any) -> int:
        point = self._point(name)
        self.rows.append([0, point, *self.slots(x, y)])
        return point

    # -- drivers and dyads -------------------------------------------------------------------------------

    def _crank(self, name: str, crank: Crank) -> None:
        pivot = self._fixed_or_origin(crank.pivot)
        cam = crank.follows()
        if cam is not None:
            self._turn(name, crank.phase, [(self._programme(name, cam), crank.turn)])  # type: ignore[attr-defined]
            row = [4, self._point(name), self.links[name], pivot]
            self.rows.append(row + self.slots(crank.radius, 0.0))
            return
        if crank.law is not None:
            self._turn(name, crank.phase, [(self._law(name, crank.law, crank.constants), 1.0)])
            row = [4, self._point(name), self.links[name], pivot]
            self.rows.append(row + self.slots(crank.radius, 0.0))
            return
        row = [1, self._point(name), self._link(name), pivot]
        self.rows.append(row + self.slots(crank.radius, np.cos(crank.phase), np.sin(crank.phase)))

    def _linear_driver(self, name: str, driver: LinearDriver) -> None:
        cam = driver.follows()
        if cam is not None:
            terms = [(self._programme(name, cam), 1.0)]
        elif driver.law is not None:
            terms = [(self._law(name, driver.law, driver.constants), 1.0)]
        else:
            assert driver.per_turn is not None
            terms = [(-1, driver.per_turn / _RADIAN)]
        self._runner(name, self._guide(driver.guide), driver.start, terms)

    def _law(self, name: str, law: str, constants: dict[str, Any]) -> int:
        """A coordinate that is a formula of the crank angle."""
        slide = self._slide(f"{name}.law")
        known = {key: self.slot(value) for key, value in constants.items()}
        self.rows.append([14, slide, self._formula(formula.parse(law), known)])
        return slide

    def _programme(self, name: str, cam: Any) -> int:
        """A coordinate that follows the lift of a cam."""
        slide = self._slide(f"{name}.lift")
        self.rows.append([16, slide, self.slot(cam.phase), self._motion_law(cam.lift)])
        return slide

    def _slider(self, name: str, slider: Slider) -> None:
        if slider.on is not None or slider.through not in (None, *self.fixed):
            self._guided_rod(name, slider)
            return
        pin = self.points[slider.crank]
        driver = self.mechanism.cranks.get(slider.crank)
        through = self._fixed_or_origin(slider.through or (driver.pivot if driver else None))
        row = [2, self._point(name), self._link(f"{name}.rod"), self._slide(name), self._dyad(name), pin]
        sign = 1.0 if slider.assembly == "positive" else -1.0
        direction = (np.cos(slider.angle), np.sin(slider.angle))
        numbers = (slider.rod, 1.0 / slider.rod, slider.offset, *direction, sign)
        self._foldable(name, [*row, through, *self.slots(*numbers)], row[4])

    def _guided_rod(self, name: str, slider: Slider) -> None:
        guide = Guide(through=slider.through, on=slider.on, angle=slider.angle, offset=slider.offset)
        sign = 1.0 if slider.assembly == "positive" else -1.0
        self._rod(name, f"{name}.rod", slider.crank, self._guide(guide), slider.rod, sign)

    def _rod(self, name: str, link: str, pin: str, line: Placed, rod: Any, sign: float) -> int:
        """A rod from a pin to a slider on any guide; gives the slot of its sign."""
        row = [5, self._point(name), self._link(link), self._slide(name), self._dyad(name), self.points[pin]]
        row += [*self._line(line), *self.slots(rod, 1.0 / rod, sign)]
        return self._foldable(name, row, row[4])

    def _foldable(self, name: str, row: list[int], gap: int) -> int:
        """Adds the row of a dyad that may have change points; gives the slot of its sign."""
        self.pending.append(Foldable(name, len(self.rows), gap, row[-1]))
        self.rows.append(row)
        return row[-1]

    def _rocker(self, name: str, rocker: Rocker) -> None:
        links = (f"{name}.coupler", f"{name}.rocker")
        sign = 1.0 if rocker.assembly == "left" else -1.0
        self._dyad_rrr(name, links, (rocker.crank, rocker.pivot), (rocker.coupler, rocker.rocker), sign)

    def _dyad_rrr(
        self, name: str, links: Sequence[str], ends: Sequence[str], lengths: Sequence[Any], sign: float
    ) -> int:
        """Two links that meet in a joint; gives the slot of its sign."""
        row = [3, self._point(name), *(self._link(link) for link in links), self._dyad(name)]
        row += [self.points[end] for end in ends]
        row += self.slots(*lengths, *(1.0 / length for length in lengths), sign)
        return self._foldable(name, row, row[4])

    def _slotted_lever(self, name: str, lever: SlottedLever) -> None:
        sign = 1.0 if lever.assembly == "ahead" else -1.0
        row = [6, self._link(name), self._slide(name), self._dyad(name)]
        row += [self.points[lever.pin], self.points[lever.pivot]]
        self.rows.append(row + self.slots(lever.offset, sign))

    def _crossing(self, name: str, crossing: Crossing) -> None:
        slides = [self._slide(f"{name}.first"), self._slide(f"{name}.second")]
        lines = [self._guide(crossing.first), self._guide(crossing.second)]
        self._cross(name, slides, lines)

    def _cross(self, name: str, slides: list[int], lines: list[Placed]) -> None:
        row = [7, self._point(name), *slides, self._dyad(name)]
        self.rows.append(row + [each for line in lines for each in self._line(line)])

    def _yoke(self, name: str, yoke: Yoke) -> None:
        guide = self._guide(yoke.guide)
        slot = Placed(self.points[yoke.pin], guide.link, guide.angle + yoke.slot, 0.0)
        self._cross(name, [self._slide(name), self._slide(f"{name}.slot")], [guide, slot])
        terms = [] if yoke.guide.on is None else [(self._angle(yoke.guide.on), 1.0)]
        self._turn(name, guide.angle, terms)

    def _rigid_point(self, name: str, part: Any) -> None:
        row = [4, self._point(name), self.links[part.link], self.starts[part.link]]
        self.rows.append(row + self.slots(part.along, part.across))

    # -- guides ------------------------------------------------------------------------------------------

    def _guide(self, guide: Guide) -> Placed:
        """A guide with its point and link found."""
        if guide.on is None:
            return Placed(self._fixed_or_origin(guide.through), self.frame, guide.angle, guide.offset)
        through = self.starts[guide.on] if guide.through is None else self.points[guide.through]
        return Placed(through, self.links[guide.on], guide.angle, guide.offset)

    def _line(self, line: Placed) -> list[int]:
        numbers = (np.cos(line.angle), np.sin(line.angle), line.offset)
        return [line.through, line.link, *self.slots(*numbers)]

    # -- coupled motions ---------------------------------------------------------------------------------

    def _sum(self, start: Any, terms: list[tuple[int, Any]]) -> list[int]:
        """A constant and its terms; source −1 is the crank angle, another a slide."""
        row = [self.slot(start), len(terms)]
        for source, factor in terms:
            row += [source, self.slot(factor)]
        return row

    def _runner(self, name: str, line: Placed, start: Any, terms: list[tuple[int, Any]]) -> None:
        row = [9, self._point(name), self._slide(name), *self._line(line)]
        self.rows.append(row + self._sum(start, terms))

    def _turn(self, name: str, start: Any, terms: list[tuple[int, Any]]) -> None:
        row = [8, self._link(name), self._slide(_angle_name(name))]
        self.rows.append(row + self._sum(start, terms))

    def _angle(self, link: str) -> int:
        """The slide that holds the continuous angle of a link; made where it is first asked for."""
        name = _angle_name(link)
        return self.slides[name] if name in self.slides else self._angle_near(link, name, 0.0)

    def _angle_near(self, link: str, name: str, near: Any) -> int:
        """A slide with the continuous angle of a link, in the revolution of its start nearest to an angle."""
        row = [10, self.links[link], self._slide(name), *self.slots(0.0, 0.0)]
        self.pending.append(Continuous(link, row[1], row[-2], row[-1], near))
        self.rows.append(row)
        return row[2]

    def _gear(self, name: str, gear: Gear) -> None:
        """ψ = (1 − κ) ψ_carrier + κ ψ_other + phase, κ = −z_other/z where the sense is reversed."""
        ratio = gear.size_other / gear.size
        ratio = -ratio if gear.kind in ("external", "crossed_belt") else ratio
        terms = []
        if gear.meshes is not None:
            terms.append((self._angle(gear.meshes), ratio))
        if gear.carrier is not None:
            terms.append((self._angle(gear.carrier), 1.0 - ratio))
        self._turn(name, gear.phase, terms)

    def _rack(self, name: str, rack: Rack) -> None:
        """s = start ± R (ψ − ψ_guide): right of a gear that turns to the left the rack goes ahead."""
        radius = rack.radius if rack.side == "right" else -rack.radius
        terms = [(self._angle(rack.gear), radius)]
        if rack.guide.on is not None:
            terms.append((self._angle(rack.guide.on), -radius))
        self._runner(name, self._guide(rack.guide), rack.start, terms)

    def _cable(self, name: str, cable: Cable) -> None:
        """s = length ± R (reference − ψ): an arc to the left draws the cable in as it turns to the left."""
        radius = cable.radius if cable.side == "left" else -cable.radius
        line = Placed(self.starts[cable.link], self.frame, cable.angle, radius)
        start = cable.length + radius * cable.reference
        angle = self._angle_near(cable.link, _angle_name(name), cable.reference)
        self._runner(name, line, start, [(angle, -radius)])

    # -- joints and bars ---------------------------------------------------------------------------------

    def _bar(self, name: str, bar: Any) -> None:
        """A bar whose ends are placed; one that a dyad or a group has placed is there already."""
        if name in self.links:
            return
        ends = [self.points[bar.start], self.points[bar.end]]
        self.rows.append([13, self._link(name), *ends, self.slot(1.0 / bar.length)])

    def _hidden_links(self, step: Step) -> int:
        """How many links a dyad of bars needs beside the bars: one for each that starts at the joint."""
        if step.kind != "dyad":
            return 0
        return sum(
            self._is_reversed(bar, step.names[0]) for bar in step.conditions if bar in self.mechanism.bars
        )

    def _is_reversed(self, bar: str, joint: str) -> bool:
        return self.mechanism.bars[bar].start == joint

    def _held(self, bar: str, joint: str) -> tuple[str, str, Any]:
        """Link, far end and length of a bar that holds a joint; one that starts there has a hidden link."""
        found = self.mechanism.bars[bar]
        if self._is_reversed(bar, joint):
            return f"{bar} reversed", found.end, found.length
        return bar, found.start, found.length

    def _dyad_of_bars(self, step: Step) -> None:
        """A joint held by two bars, or by a bar and a guide, on the side where it is given."""
        joint = step.names[0]
        held = [self._held(bar, joint) for bar in step.conditions if bar in self.mechanism.bars]
        if len(held) == 2:
            links, ends, lengths = zip(*held, strict=True)
            place = len(self.pending)
            slot = self._dyad_rrr(joint, links, ends, lengths, 1.0)
            pin, pivot = (self.points[end] for end in ends)
            # The side is needed before change points are looked for.
            self.pending.insert(place, Side(joint, slot, pin, pivot))
            return
        link, end, length = held[0]
        guide = self.mechanism.joints[joint].guide
        assert guide is not None
        line = self._guide(guide)
        place = len(self.pending)
        slot = self._rod(joint, link, end, line, length, 1.0)
        self.pending.insert(place, Side(joint, slot, self.points[end], guide=(line.link, line.angle)))

    def _group(self, step: Step) -> None:
        """Joints that are found together."""
        joints = self.mechanism.joints
        self.known = set(self.links)
        bars = [name for name in step.conditions if name in self.mechanism.bars]
        for name in step.names:
            self._point(name)
        carried = self._carried(bars, step)
        bars = list(dict.fromkeys([*bars, *(self.mechanism.rigid_points[name].link for name in carried)]))
        coordinates = [value for name in step.names for value in (joints[name].x, joints[name].y)]
        tables = [self._table((0.0,), (float(np.ravel(value)[0]),)) for value in coordinates]
        turns = self.slot(1.0)
        row = [12, self._dyad(" and ".join(step.names)), turns, 1]
        row += [len(step.names), *(self.points[name] for name in step.names)]
        row += [len(tables), *tables]
        row += [len(carried), *(each for name in carried for each in self._carried_row(name))]
        row += [len(bars), *(each for name in bars for each in self._bar_row(name))]
        row += [len(step.conditions), *(each for name in step.conditions for each in self._condition(name))]
        self.pending.append(Solved(step.names, len(self.rows), tuple(tables), turns))
        self.rows.append(row)

    def _carried(self, bars: list[str], step: Step) -> list[str]:
        """Points fixed to bars of the group that its conditions refer to, each after those it hangs on."""
        found: list[str] = []

        def need(name: str) -> None:
            part = self.mechanism.rigid_points.get(name)
            if part is not None and name not in self.points:
                for end in (self.mechanism.bars[part.link].start, self.mechanism.bars[part.link].end):
                    need(end)
                self._point(name)
                found.append(name)

        for bar in bars:
            need(self.mechanism.bars[bar].start)
            need(self.mechanism.bars[bar].end)
        for name in step.conditions:
            guide = self.mechanism.joints[name].guide if name in self.mechanism.joints else None
            if guide is not None and guide.through is not None:
                need(guide.through)
        return found

    def _carried_row(self, name: str) -> list[int]:
        part = self.mechanism.rigid_points[name]
        bar = self.mechanism.bars[part.link]
        ends = [self.points[bar.start], self.points[bar.end]]
        return [self.points[name], *ends, *self.slots(part.along / bar.length, part.across / bar.length)]

    def _bar_row(self, name: str) -> list[int]:
        bar = self.mechanism.bars[name]
        ends = [self.points[bar.start], self.points[bar.end]]
        return [self._link(name), *ends, self.slot(1.0 / bar.length)]

    def _condition(self, name: str) -> list[int]:
        """A bar's length, or a joint on its guide."""
        if name in self.mechanism.bars:
            bar = self.mechanism.bars[name]
            return [0, self.points[bar.start], self.points[bar.end], self.slot(bar.length)]
        guide = self.mechanism.joints[name].guide
        assert guide is not None
        point, slide = self.points[name], self._slide(name)
        if guide.on in self.mechanism.bars and guide.on not in self.known:
            through = self.mechanism.bars[guide.on].start if guide.through is None else guide.through
            line = Placed(self.points[through], self.frame, guide.angle, guide.offset)
            return [2, point, *self._line(line), slide, *self._bar_row(guide.on)]
        return [1, point, *self._line(self._guide(guide)), slide]


def _angle_name(link: str) -> str:
    """Name of the slide that holds the continuous angle of a link; no element can have it."""
    return f"{link}.angle"
