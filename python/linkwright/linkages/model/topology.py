"""The names in a mechanism: which elements there are, what each makes, and what each refers to.

| element | makes the point | makes the links | makes the slides | refers to |
| --- | --- | --- | --- | --- |
| fixed point `P` | `P` | – | – | – |
| crank `A` | `A`, its pin | `A`, pivot → pin | – | a fixed point |
| linear driver `D` | `D` | – | `D` | its guide |
| cam `C` | `C`, on the follower | `C`, if it oscillates, pivot → `C` | `C`, if it translates | fixed points |
| slider `S` | `S` | `S.rod`, driving point → slider | `S` | a moving point, its guide |
| rocker `R` | `R`, joint | `R.coupler`, driving point → joint; `R.rocker`, pivot → joint | – | two points |
| slotted lever `L` | – | `L`, pivot → pin | `L`, distance along the slot | a moving point, a point |
| crossing `X` | `X`, the pin | – | `X.first`, `X.second` | two guides |
| yoke `Y` | `Y`, on slot and guide | `Y`, along the guide | `Y`; `Y.slot` | a moving point, its guide |
| rigid point `K` | `K` | – | – | a link |
| gear `G` | – | `G` | – | a point, links |
| rack `T` | `T` | – | `T` | a link, its guide |
| cable `H` | `H`, its end | – | `H`, free length | a link |
| joint `J` | `J` | – | `J`, if it has a guide | its guide |
| bar `B` | – | `B`, start → end | – | two points |
| cylinder `Z` | – | `Z`, barrel, start → end; `Z.rod`, end → start | `Z`, its length | two points |

A topology is taken from a checked mechanism or from the raw tables of a file.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from graphlib import CycleError, TopologicalSorter
from types import MappingProxyType
from typing import Literal, NamedTuple

from pydantic import BaseModel
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import fault, suggestion
from linkwright.kernel.description.place import keys, look
from linkwright.linkages.model.assembly import Build, Part, build
from linkwright.linkages.model.guide_faults import guide_faults

# The origin is a fixed point of every mechanism, unless a file gives this name to an element.
ORIGIN = "O"

Wanted = Literal["moving point", "fixed point", "point", "link"]


class ElementKind(NamedTuple):
    """One table of the mechanism: what each element of it makes, as endings of its name, and refers to."""

    table: str
    word: str
    points: tuple[str, ...] = ("",)
    links: tuple[str, ...] = ()
    slides: tuple[str, ...] = ()
    references: Mapping[str, Wanted] = MappingProxyType({})
    # Key and value that tell elements of one table apart; the first of such kinds is that without the key.
    variant: tuple[str, str] | None = None


def _guide(key: str, **others: Wanted) -> dict[str, Wanted]:
    return {**others, f"{key}.through": "point", f"{key}.on": "link"}


KINDS = (
    ElementKind("points", "fixed point"),
    ElementKind("cranks", "crank", links=("",), references={"pivot": "fixed point"}),
    ElementKind("linear_drivers", "linear driver", slides=("",), references=_guide("guide")),
    ElementKind(
        "cams",
        "cam",
        slides=("",),
        references={"pivot": "fixed point"},
        variant=("follower", "translating"),
    ),
    ElementKind(
        "cams",
        "cam",
        links=("",),
        references={"pivot": "fixed point", "arm_pivot": "fixed point"},
        variant=("follower", "oscillating"),
    ),
    ElementKind(
        "sliders",
        "slider",
        links=(".rod",),
        slides=("",),
        references={"crank": "moving point", "through": "point", "on": "link"},
    ),
    ElementKind(
        "rockers",
        "rocker",
        links=(".coupler", ".rocker"),
        references={"crank": "moving point", "pivot": "point"},
    ),
    ElementKind(
        "slotted_levers",
        "slotted lever",
        points=(),
        links=("",),
        slides=("",),
        references={"pin": "moving point", "pivot": "point"},
    ),
    ElementKind(
        "crossings",
        "crossing",
        slides=(".first", ".second"),
        references=_guide("first") | _guide("second"),
    ),
    ElementKind(
        "yokes",
        "yoke",
        links=("",),
        slides=("", ".slot"),
        references=_guide("guide", pin="moving point"),
    ),
    ElementKind("rigid_points", "rigid point", references={"link": "link"}),
    ElementKind(
        "gears",
        "gear",
        points=(),
        links=("",),
        references={"pivot": "point", "meshes": "link", "carrier": "link"},
    ),
    ElementKind("racks", "rack", slides=("",), references=_guide("guide", gear="link")),
    ElementKind("cables", "cable", slides=("",), references={"link": "link"}),
    ElementKind("joints", "joint", slides=("",), references=_guide("guide")),
    ElementKind("bars", "bar", points=(), links=("",), references={"start": "point", "end": "point"}),
    ElementKind(
        "cylinders",
        "cylinder",
        points=(),
        links=("", ".rod"),
        slides=("",),
        references={"start": "point", "end": "point"},
    ),
)

# The tables of a mechanism, each once.
TABLES = tuple(dict.fromkeys(kind.table for kind in KINDS))

# Tables of the elements that the drive moves; a cylinder with a length at the start is one of them too.
_DRIVERS = ("cranks", "linear_drivers", "cams")
_MOVED_BY = ("start_length", "law", "flow")


@dataclass(frozen=True, slots=True)
class Element:
    """One element: its kind, its name, the names that it refers to by key, and what else tells it apart."""

    kind: ElementKind
    name: str
    references: dict[str, str]
    redundant: bool = False
    is_driver: bool = False

    def made(self, endings: tuple[str, ...]) -> tuple[str, ...]:
        """Names of the points, links or slides with these endings."""
        return tuple(self.name + ending for ending in endings)


# Topologies of the mechanisms asked for last, which an analysis asks for a dozen times.
_KNOWN_MAX = 8
_known: dict[int, tuple[object, Topology]] = {}


@dataclass(frozen=True, slots=True)
class Topology:
    """All elements of a mechanism in the order of the file."""

    elements: list[Element] = field(default_factory=list)

    @classmethod
    def of(cls, mechanism: object) -> Topology:
        """Topology of a `Mechanism`, or of the table of a file without entries that are no tables."""
        known = _known.get(id(mechanism))
        if known is not None and known[0] is mechanism:
            return known[1]
        topology = cls(
            [element for kind in KINDS for element in _elements(kind, look(mechanism, kind.table))]
        )
        if isinstance(mechanism, BaseModel):
            # A checked mechanism is frozen: the same object has the same topology.
            if len(_known) >= _KNOWN_MAX:
                _known.pop(next(iter(_known)), None)
            _known[id(mechanism)] = (mechanism, topology)
        return topology

    def names(self, *tables: str) -> list[str]:
        """Names of the elements in some tables."""
        return [element.name for element in self.elements if element.kind.table in tables]

    @property
    def fixed_points(self) -> list[str]:
        """Names of the points at rest; the origin first."""
        origin = [] if any(element.name == ORIGIN for element in self.elements) else [ORIGIN]
        return origin + self.names("points")

    @property
    def moving_points(self) -> list[str]:
        """Names of the points that move."""
        moving = (element for element in self.elements if element.kind.table != "points")
        return [name for point in moving for name in point.made(point.kind.points)]

    @property
    def drivers(self) -> list[str]:
        """Names of the elements that the drive moves."""
        return [element.name for element in self.elements if element.is_driver]

    @property
    def slides(self) -> list[str]:
        """Names of the coordinates along guides."""
        free = {
            element.name
            for element in self.elements
            if element.kind.table == "joints" and not element.references
        }
        listed = (element for element in self.elements if element.name not in free)
        return [name for slide in listed for name in slide.made(slide.kind.slides)]

    @property
    def links(self) -> dict[str, str]:
        """Name of each link → name of the element that makes it."""
        return {name: element.name for element in self.elements for name in element.made(element.kind.links)}

    def candidates(self, wanted: Wanted) -> list[str]:
        """Names that a reference may have."""
        if wanted == "link":
            return list(self.links)
        fixed = self.fixed_points if wanted != "moving point" else []
        return fixed + (self.moving_points if wanted != "fixed point" else [])

    def build(self) -> Build:
        """The steps in which the mechanism is built, and what stands in their way."""
        parts = {
            element.name: self._part(element) for element in self.elements if element.kind.table != "points"
        }
        ignored = [element.name for element in self.elements if element.redundant]
        return build(parts, self.fixed_points, ignored)

    def _part(self, element: Element) -> Part:
        roles: dict[str, Literal["joint", "bar", "cylinder", "carried"]] = {
            "joints": "joint",
            "bars": "bar",
            "rigid_points": "carried",
        }
        kind = element.kind
        if kind.table == "cylinders" and element.is_driver:
            roles["cylinders"] = "cylinder"
        makes = (*element.made(kind.points), *element.made(kind.links))
        needs = tuple(dict.fromkeys(element.references.values()))
        return Part(roles.get(kind.table, "element"), needs, makes)

    def faults(self, *, values_fit: bool = True) -> list[InitErrorDetails]:
        """What is wrong: names twice, references to nothing, circles, joints held too little or too much.

        `values_fit`: whether every element is sound by itself; otherwise the mobility is left for later.
        """
        drivers = self.drivers
        driven = [e for e in self.elements if e.kind.table != "points" and e.name not in drivers]
        if driven and not drivers:
            remedy = "a linear driver or a cylinder with start_length is also possible"
            expected = "at least one crank, which moves the others"
            return [*self._twice(), fault("cranks", expected=expected, remedy=remedy)]
        faults = [*self._twice(), *self._unknown()]
        faults = [*faults, *self._circles()] if faults else [*self._circles(), *guide_faults(self)]
        return faults or ([*self._mobility()] if values_fit else [])

    def _mobility(self) -> Iterator[InitErrorDetails]:
        build = self.build()
        kinds = {element.name: element.kind for element in self.elements}
        for joint in build.loose:
            if build.stuck and (circle := self._mixed_circle(joint, build.stuck)):
                yield fault(
                    "joints",
                    joint,
                    found=circle,
                    expected="bars and guides connected to points that are defined before the joint",
                    remedy="describe the whole loop by joints and bars",
                )
                continue
            holds = [
                element.name
                for element in self.elements
                if joint in element.references.values() and not element.redundant
            ]
            yield fault(
                "joints",
                joint,
                found=_conditions(holds),
                expected="two bars or guides for each joint",
                remedy="the joint can still move with the crank held; add a bar or a guide",
            )
        for name in dict.fromkeys(build.surplus):
            yield fault(
                kinds[name].table,
                name,
                found="one constraint too many",
                expected="two bars or guides for each joint",
                remedy=self._too_many(name, is_bar=kinds[name].table == "bars"),
            )

    def _too_many(self, name: str, *, is_bar: bool) -> str:
        drivers = self._drivers(name)
        redundant = ", or write redundant = true to have its length checked" if is_bar else ""
        if len(drivers) > 1:
            return (
                f"the drivers {' and '.join(drivers)} both move the points that it connects; one suffices; "
                f"remove {name} or a driver{redundant}"
            )
        return (
            "over-constrained: the mechanism is locked unless the length fits exactly at every angle; "
            f"remove it{redundant}"
        )

    def _needs(self) -> dict[str, list[str]]:
        """Each element → the moving elements that it depends on, joints by the bars that hold them."""
        makers = {point: point for point in self.moving_points} | self.links
        needs = {e.name: [makers[n] for n in e.references.values() if n in makers] for e in self.elements}
        holding = ("bars", "cylinders")
        for bar in (e for e in self.elements if e.kind.table in holding and not e.redundant):
            for joint in set(needs[bar.name]) & set(self.names("joints")):
                needs[joint] += [end for end in needs[bar.name] if end != joint]
        return needs

    def drivers_of(self, name: str) -> list[str]:
        """Drivers that a point, a link or a slide hangs on."""
        slides = {slide: e.name for e in self.elements for slide in e.made(e.kind.slides)}
        return self._drivers((slides | self.links).get(name, name))

    def _drivers(self, name: str) -> list[str]:
        needs, drivers, open_ = self._needs(), {name}, [name]
        while open_:
            fresh = set(needs.get(open_.pop(), ())) - drivers
            drivers |= fresh
            open_ += fresh
        return [name for name in self.drivers if name in drivers]

    def _mixed_circle(self, joint: str, stuck: list[str]) -> str:
        """A circle from a joint through an element that depends on it; empty without one."""
        joints = set(self.names("joints"))
        waiting = {name: [n for n in needs if n in stuck] for name, needs in self._needs().items()}
        # Joints that hold each other are no circle: they are found together.
        for other in joints & set(waiting):
            waiting[other] = [n for n in waiting[other] if n not in joints]
        circle = _circle(waiting)
        return " → ".join(circle) if circle and joint in circle else ""

    def _twice(self) -> Iterator[InitErrorDetails]:
        first: dict[str, ElementKind] = {}
        for element in self.elements:
            before = first.setdefault(element.name, element.kind)
            if before is not element.kind:
                remedy = f'"{element.name}" is the name of a {before.word} already'
                yield fault(
                    element.kind.table, element.name, found=element.name, expected="a new name", remedy=remedy
                )

    def _unknown(self) -> Iterator[InitErrorDetails]:
        for element in self.elements:
            for key, wanted in element.kind.references.items():
                name = element.references.get(key)
                if name is not None and name not in self.candidates(wanted):
                    yield self.unknown(name, wanted, element.kind.table, element.name, *key.split("."))

    def unknown(self, name: str, wanted: Wanted, *place: str) -> InitErrorDetails:
        """The fault of a name that is not what is wanted at a place."""
        expected = f"the name of a {wanted}"
        remedy = self.instead(name) or suggestion(name, self.candidates(wanted))
        return fault(*place, found=name, expected=expected, remedy=remedy)

    def instead(self, name: str) -> str:
        """What a name stands for; empty if it stands for nothing."""
        if name in self.fixed_points:
            return f'"{name}" is a fixed point'
        word = next((element.kind.word for element in self.elements if element.name == name), "")
        word = "link" if name in self.links and not word else word
        return f'"{name}" is a {word}' if word else ""

    def _graph(self) -> dict[str, list[str]]:
        """Each moving element → the moving elements that it is built on; joints depend on their bars."""
        makers = {name: name for name in self.moving_points} | self.links
        for element in self.elements:
            makers.update(dict.fromkeys(element.made(element.kind.points), element.name))
        free = ("points", "joints", "bars", "cylinders")
        jointed = {element.name for element in self.elements if element.kind.table in free}
        return {
            element.name: [
                m for n in element.references.values() if (m := makers.get(n)) and m not in jointed
            ]
            for element in self.elements
            if element.kind.table not in free
        }

    def _circles(self) -> Iterator[InitErrorDetails]:
        graph = self._graph()
        while (circle := _circle(graph)) is not None:
            kind = next(element.kind for element in self.elements if element.name == circle[0])
            yield fault(
                kind.table,
                circle[0],
                found=" → ".join(circle),
                expected="elements that lead back to a crank",
                remedy="each of these is built on the next; drive one of them by another point",
            )
            graph = {name: needs for name, needs in graph.items() if name not in circle}


def _circle(graph: dict[str, list[str]]) -> list[str] | None:
    """One circle of a graph, from an element back to itself; None if there is none."""
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        circle: list[str] = error.args[1]
        return circle[::-1]
    return None


def _elements(kind: ElementKind, table: object) -> Iterator[Element]:
    for name in keys(table):
        element = look(table, name)
        if kind.variant is not None and (look(element, kind.variant[0]) == "oscillating") != bool(kind.links):
            continue
        elements: dict[str, object] = {}
        for key in kind.references:
            part: object = element
            for step in key.split("."):
                part = look(part, step)
            elements[key] = part
        names = {key: value for key, value in elements.items() if isinstance(value, str)}
        if kind.table == "joints" and look(element, "guide") is not None and not names:
            # A guide on the frame through the origin refers to nothing, and holds the joint all the same.
            names["guide"] = ORIGIN
        is_driver = kind.table in _DRIVERS or (
            kind.table == "cylinders" and any(look(element, key) is not None for key in _MOVED_BY)
        )
        yield Element(kind, name, names, look(element, "redundant") is True, is_driver)


def _conditions(holds: list[str]) -> str:
    if len(holds) > 1:
        return f"conditions shared with other free joints: {', '.join(holds)}"
    return f"one of two conditions: {holds[0]}" if holds else "no bar or guide"
