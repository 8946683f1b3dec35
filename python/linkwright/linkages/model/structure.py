"""The structure of a mechanism: its members, and the pairs through which they act on each other.

| element | members | pairs |
| --- | --- | --- |
| crank `A` | `A` | a pin at its pivot; the drive |
| linear driver `D` | block `D` | `D.guide`; the drive |
| slider `S` | `S.rod`, block `S` | pins at both ends of the rod; `S.guide` |
| rocker `R` | `R.coupler`, `R.rocker` | pins at driving point, joint and pivot |
| slotted lever `L` | `L` | a pin at the pivot; `L.slot` |
| crossing `X` | pin `X` | `X.first`, `X.second` |
| yoke `Y` | `Y` | `Y.guide`, `Y.slot` |
| gear `G` | `G` | a pin at its pivot; `G.mesh` |
| rack `T` | block `T` | `T.guide`, `T.mesh` |
| cable `H` | block `H`, its end | `H.guide`, which holds it in its line; `H.cable` |
| joint `J` | block `J`, if it has a guide | `J.guide` |
| bar `B` | `B` | pins at both ends |
| cylinder `Z` | `Z`, the barrel, and `Z.rod` | a pin at each end; `Z.guide`; the drive of a driver |

**Who carries a point.** A fixed point belongs to the frame; the pin of a crank to the crank; a joint of a
rocker to `R.rocker`; a slider, a rack, the end of a cable to its block; a point of a link to that link; a
joint of bars to its block, or without a guide to the first bar in the file that ends there and is not
redundant. Every other link that ends at a point has a pin of its own to the member that carries it: several
links on one pin are pairs with the carrier, not with one another.

**Names of pins.** A pin has the name of its point; where several links are on the point, ``point:link``.

A redundant bar hangs on its start, and its end moves freely along it: it carries what acts on itself, and
passes nothing on.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

from linkwright.linkages.model.element import Bar, Guide
from linkwright.linkages.model.mechanism import Mechanism
from linkwright.linkages.model.topology import ORIGIN

# Name of the member that is at rest; no element can have it, since names have no blank.
FRAME = "the frame"

PairKind = Literal["pin", "guide", "slot", "mesh", "rack", "cable"]


class Member(NamedTuple):
    """A rigid body.

    Attributes
    ----------
    name : str
        Of the link, or of the point of a block.
    point : str
        One of its points: the start of a link.
    link : str or None
        Link whose direction turns with it; None if it does not turn.
    turns : bool
        Whether it can take a moment; the pin of a crossing cannot.
    """

    name: str
    point: str
    link: str | None
    turns: bool = True


class Pair(NamedTuple):
    """Two members that act on each other.

    Attributes
    ----------
    name : str
        Unique among the pairs.
    kind : str
        ``"pin"``, ``"guide"``, ``"slot"`` (a pin in a slot), ``"mesh"``, ``"rack"`` or ``"cable"``.
    first, second : str
        Members; forces are those on the second.
    point : str
        Point where they meet; of a mesh the centre of the gear.
    guide : Guide or None
        Of a guide, a rack, a cable or a slot: what gives the direction.
    element : str
        Name of the element that it belongs to.
    """

    name: str
    kind: PairKind
    first: str
    second: str
    point: str
    guide: Guide | None = None
    element: str = ""


class Drive(NamedTuple):
    """A crank turned, or a block moved along its guide, by the drive; of a cylinder the rod in its barrel."""

    name: str
    member: str
    guide: Guide | None = None


@dataclass(frozen=True, slots=True)
class Structure:
    """Members and pairs of a mechanism.

    Attributes
    ----------
    members : dict of str to Member
        All that move, by name.
    pairs : dict of str to Pair
        By name.
    drives : tuple of Drive
        What the crankshaft moves.
    carriers : dict of str to str
        Name of each point → member that carries it.
    redundant : tuple of str
        Redundant bars.
    origin : str
        Name of the origin; empty where an element bears its name.
    """

    members: dict[str, Member]
    pairs: dict[str, Pair]
    drives: tuple[Drive, ...]
    carriers: dict[str, str]
    redundant: tuple[str, ...]
    origin: str

    def guide_point(self, guide: Guide) -> str:
        """The point that a guide passes through, or is offset from."""
        if guide.through is not None:
            return guide.through
        return self.origin if guide.on is None else self.members[guide.on].point


def structure(mechanism: Mechanism) -> Structure:
    """Members and pairs of a mechanism, in the order of the tables of the file."""
    return _Builder(mechanism).run()


def origin(mechanism: Mechanism) -> str:
    """Name of the origin; empty where an element bears its name."""
    return ORIGIN if ORIGIN in mechanism.fixed_points() else ""


def slider_guide(mechanism: Mechanism, name: str) -> Guide:
    """The guide of a slider, with the point that it hangs on by default: the pivot of its crank."""
    slider = mechanism.sliders[name]
    through = slider.through
    if through is None and slider.on is None and slider.crank in mechanism.cranks:
        through = mechanism.cranks[slider.crank].pivot
    # Checked numbers, which may carry derivatives.
    return Guide(through=through, on=slider.on).with_entries({"angle": slider.angle, "offset": slider.offset})


@dataclass(slots=True)
class _Builder:
    """Walks through the tables of a mechanism."""

    mechanism: Mechanism
    members: dict[str, Member] = field(default_factory=dict)
    pins: list[tuple[str, str, str]] = field(default_factory=list)
    others: list[Pair] = field(default_factory=list)
    drives: list[Drive] = field(default_factory=list)
    carriers: dict[str, str] = field(default_factory=dict)

    def run(self) -> Structure:
        self.carriers = dict(self._carried())
        for part in (self._cranks, self._linear_drivers, self._sliders, self._rockers, self._levers):
            part()
        for part in (self._crossings, self._yokes, self._gears, self._racks, self._cables, self._joints):
            part()
        self._bars()
        self._cylinders()
        redundant = tuple(name for name, bar in self.mechanism.bars.items() if bar.redundant)
        pairs = {pair.name: pair for pair in (*self._named_pins(), *self.others)}
        drives = tuple(self.drives)
        return Structure(self.members, pairs, drives, self.carriers, redundant, origin(self.mechanism))

    def _carried(self) -> Iterator[tuple[str, str]]:
        m = self.mechanism
        yield "", FRAME
        yield from ((name, FRAME) for name in m.fixed_points())
        own = (m.cranks, m.linear_drivers, m.sliders, m.crossings, m.yokes, m.racks, m.cables)
        yield from ((name, name) for table in own for name in table)
        yield from ((name, f"{name}.rocker") for name in m.rockers)
        yield from ((name, point.link) for name, point in m.rigid_points.items())
        for name, joint in m.joints.items():
            yield name, name if joint.guide is not None else next(self._held_by(name))

    def _held_by(self, joint: str) -> Iterator[str]:
        """Members that hold a joint: bars that are not redundant, then barrels and rods of cylinders."""
        for name, bar in self.mechanism.bars.items():
            if joint in (bar.start, bar.end) and not bar.redundant:
                yield name
        for name, cylinder in self.mechanism.cylinders.items():
            if joint in (cylinder.start, cylinder.end):
                yield name if joint == cylinder.start else f"{name}.rod"

    def _link(self, name: str, point: str) -> None:
        self.members[name] = Member(name, point, name)

    def _block(self, name: str, guide: Guide) -> None:
        self.members[name] = Member(name, name, guide.on)
        self._guide(f"{name}.guide", name, guide)

    def _guide(self, name: str, member: str, guide: Guide) -> None:
        first = FRAME if guide.on is None else guide.on
        if guide.on is None and guide.through is not None:
            # A guide that does not turn may ride on a block.
            first = self.carriers[guide.through]
        self.others.append(Pair(name, "guide", first, member, member, guide, member))

    def _pin(self, point: str, link: str) -> None:
        if self.carriers[point] != link:
            self.pins.append((point, self.carriers[point], link))

    def _named_pins(self) -> Iterator[Pair]:
        count = Counter(point for point, _, _ in self.pins)
        for point, first, second in self.pins:
            label = point or ORIGIN
            name = label if count[point] == 1 else f"{label}:{second}"
            yield Pair(name, "pin", first, second, point, element=second)

    # -- elements ----------------------------------------------------------------------------------------

    def _cranks(self) -> None:
        for name, crank in self.mechanism.cranks.items():
            pivot = crank.pivot or origin(self.mechanism)
            self._link(name, pivot)
            self._pin(pivot, name)
            self.drives.append(Drive(name, name))

    def _linear_drivers(self) -> None:
        for name, driver in self.mechanism.linear_drivers.items():
            self._block(name, driver.guide)
            self.drives.append(Drive(name, name, driver.guide))

    def _sliders(self) -> None:
        for name, slider in self.mechanism.sliders.items():
            rod = f"{name}.rod"
            self._link(rod, slider.crank)
            self._pin(slider.crank, rod)
            self._block(name, slider_guide(self.mechanism, name))
            self.pins.append((name, rod, name))

    def _rockers(self) -> None:
        for name, rocker in self.mechanism.rockers.items():
            coupler, lever = f"{name}.coupler", f"{name}.rocker"
            self._link(coupler, rocker.crank)
            self._link(lever, rocker.pivot)
            self._pin(rocker.crank, coupler)
            self.pins.append((name, coupler, lever))
            self._pin(rocker.pivot, lever)

    def _levers(self) -> None:
        for name, lever in self.mechanism.slotted_levers.items():
            self._link(name, lever.pivot)
            self._pin(lever.pivot, name)
            slot = Guide(on=name, through=lever.pivot).with_entries({"offset": lever.offset})
            self._slot(f"{name}.slot", name, lever.pin, slot)

    def _slot(self, name: str, member: str, pin: str, slot: Guide) -> None:
        self.others.append(Pair(name, "slot", self.carriers[pin], member, pin, slot, member))

    def _crossings(self) -> None:
        for name, crossing in self.mechanism.crossings.items():
            self.members[name] = Member(name, name, None, turns=False)
            self._guide(f"{name}.first", name, crossing.first)
            self._guide(f"{name}.second", name, crossing.second)

    def _yokes(self) -> None:
        for name, yoke in self.mechanism.yokes.items():
            self._link(name, name)
            self._guide(f"{name}.guide", name, yoke.guide)
            self._slot(
                f"{name}.slot",
                name,
                yoke.pin,
                Guide(on=name, through=name).with_entries({"angle": yoke.slot}),
            )

    def _gears(self) -> None:
        for name, gear in self.mechanism.gears.items():
            self._link(name, gear.pivot)
            # Two gears on one pivot are two pins, each with the carrier.
            self.pins.append((gear.pivot, self.carriers[gear.pivot], name))
            other = FRAME if gear.meshes is None else gear.meshes
            self.others.append(Pair(f"{name}.mesh", "mesh", other, name, gear.pivot, element=name))

    def _racks(self) -> None:
        for name, rack in self.mechanism.racks.items():
            self._block(name, rack.guide)
            self.others.append(Pair(f"{name}.mesh", "rack", rack.gear, name, name, rack.guide, name))

    def _cables(self) -> None:
        for name, cable in self.mechanism.cables.items():
            radius = cable.radius if cable.side == "left" else -cable.radius
            start = self.mechanism.links()[cable.link].start
            line = Guide(through=start).with_entries({"angle": cable.angle, "offset": radius})
            self._block(name, line)
            self.others.append(Pair(f"{name}.cable", "cable", cable.link, name, name, line, name))

    def _joints(self) -> None:
        for name, joint in self.mechanism.joints.items():
            if joint.guide is not None:
                self._block(name, joint.guide)

    def _bars(self) -> None:
        for name, bar in self.mechanism.bars.items():
            self._link(name, bar.start)
            self._pin(bar.start, name)
            if bar.redundant:
                self._loose_end(name, bar)
            else:
                self._pin(bar.end, name)

    def _cylinders(self) -> None:
        for name, cylinder in self.mechanism.cylinders.items():
            rod, bore = f"{name}.rod", Guide(on=name, through=cylinder.start)
            for member, point in ((name, cylinder.start), (rod, cylinder.end)):
                self._link(member, point)
                self._pin(point, member)
            self.others.append(Pair(f"{name}.guide", "guide", name, rod, cylinder.end, bore, name))
            if cylinder.drives:
                self.drives.append(Drive(name, rod, bore))

    def _loose_end(self, name: str, bar: Bar) -> None:
        """The end of a redundant bar, free along the bar."""
        self._slot(f"{name}.slot", name, bar.end, Guide(on=name, through=bar.start))
