"""The names in a mechanism: which elements there are, what each makes, and what each refers to.

| element | makes the point | makes the links | refers to |
| --- | --- | --- | --- |
| fixed point `P` | `P` | – | – |
| crank `A` | `A`, its pin | `A`, pivot → pin | a fixed point |
| slider `S` | `S` | `S.rod`, driving point → slider | a moving point, a fixed point |
| rocker `R` | `R`, joint | `R.coupler`, driving point → joint; `R.rocker`, pivot → joint | two points |
| rigid point `K` | `K` | – | a link |

An outline is taken from a checked mechanism or from the raw tables of a file.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from graphlib import CycleError, TopologicalSorter
from typing import Literal, NamedTuple

from pydantic_core import InitErrorDetails

from linkwright.machine.base import fault, suggestion
from linkwright.machine.plain import keys, look

# The origin is a fixed point of every mechanism, unless a file gives this name to an element.
ORIGIN = "O"

Wanted = Literal["moving point", "fixed point", "point", "link"]


class ElementKind(NamedTuple):
    """One table of the mechanism."""

    table: str
    word: str
    links: tuple[str, ...]
    references: dict[str, Wanted]


KINDS = (
    ElementKind("points", "fixed point", (), {}),
    ElementKind("cranks", "crank", ("",), {"pivot": "fixed point"}),
    ElementKind("sliders", "slider", (".rod",), {"crank": "moving point", "through": "fixed point"}),
    ElementKind("rockers", "rocker", (".coupler", ".rocker"), {"crank": "moving point", "pivot": "point"}),
    ElementKind("rigid_points", "rigid point", (), {"link": "link"}),
)


@dataclass(frozen=True, slots=True)
class Element:
    """One element: its kind, its name, and the names that it refers to by key."""

    kind: ElementKind
    name: str
    references: dict[str, str]


@dataclass(frozen=True, slots=True)
class Outline:
    """All elements of a mechanism in the order of the file."""

    elements: list[Element] = field(default_factory=list)

    @classmethod
    def of(cls, mechanism: object) -> Outline:
        """Outline of a mechanism, checked or raw.

        Parameters
        ----------
        mechanism : object
            A `Mechanism`, or the table of a file; entries that are no tables are passed over.
        """
        return cls([each for kind in KINDS for each in _elements(kind, look(mechanism, kind.table))])

    def names(self, *tables: str) -> list[str]:
        """Names of the elements in some tables."""
        return [each.name for each in self.elements if each.kind.table in tables]

    @property
    def fixed_points(self) -> list[str]:
        """Names of the points at rest; the origin first."""
        origin = [] if any(each.name == ORIGIN for each in self.elements) else [ORIGIN]
        return origin + self.names("points")

    @property
    def moving_points(self) -> list[str]:
        """Names of the points that move."""
        return self.names("cranks", "sliders", "rockers", "rigid_points")

    @property
    def links(self) -> dict[str, str]:
        """Name of each link → name of the element that makes it."""
        return {each.name + end: each.name for each in self.elements for end in each.kind.links}

    def candidates(self, wanted: Wanted) -> list[str]:
        """Names that a reference may have."""
        if wanted == "link":
            return list(self.links)
        fixed = self.fixed_points if wanted != "moving point" else []
        return fixed + (self.moving_points if wanted != "fixed point" else [])

    def order(self) -> list[str]:
        """Names of the moving elements, each after the elements that it is built on."""
        return list(TopologicalSorter(self._graph()).static_order())

    def faults(self) -> list[InitErrorDetails]:
        """What is wrong with the names: the same name twice, references to nothing, circles."""
        driven = self.names("sliders", "rockers", "rigid_points")
        if driven and not self.names("cranks"):
            return [*self._twice(), fault("cranks", expected="at least one crank, which moves the others")]
        return [*self._twice(), *self._unknown(), *self._circles()]

    def _twice(self) -> Iterator[InitErrorDetails]:
        """Names that an earlier element has."""
        first: dict[str, ElementKind] = {}
        for each in self.elements:
            before = first.setdefault(each.name, each.kind)
            if before is not each.kind:
                remedy = f'"{each.name}" is the name of a {before.word} already'
                yield fault(each.kind.table, each.name, found=each.name, expected="a new name", remedy=remedy)

    def _unknown(self) -> Iterator[InitErrorDetails]:
        """References to names that do not exist or are something else."""
        for each in self.elements:
            for key, name in each.references.items():
                wanted = each.kind.references[key]
                if name not in self.candidates(wanted):
                    yield self.unknown(name, wanted, each.kind.table, each.name, key)

    def unknown(self, name: str, wanted: Wanted, *place: str) -> InitErrorDetails:
        """The fault of a name that is not what is wanted at a place."""
        expected = f"the name of a {wanted}"
        remedy = self.instead(name) or suggestion(name, self.candidates(wanted))
        return fault(*place, found=name, expected=expected, remedy=remedy)

    def instead(self, name: str) -> str:
        """What a name stands for; empty if it stands for nothing."""
        if name in self.fixed_points:
            return f'"{name}" is a fixed point'
        word = next((each.kind.word for each in self.elements if each.name == name), "")
        word = "link" if name in self.links and not word else word
        return f'"{name}" is a {word}' if word else ""

    def _graph(self) -> dict[str, list[str]]:
        """Each moving element → the moving elements that it is built on."""
        makers = {name: name for name in self.moving_points} | self.links
        moving = [each for each in self.elements if each.kind.table != "points"]
        return {
            each.name: [makers[name] for name in each.references.values() if name in makers]
            for each in moving
        }

    def _circles(self) -> Iterator[InitErrorDetails]:
        """Elements that are built on one another in a circle."""
        graph = self._graph()
        while (circle := _circle(graph)) is not None:
            kind = next(each.kind for each in self.elements if each.name == circle[0])
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
    """The elements of one table."""
    for name in keys(table):
        element = look(table, name)
        found = {key: look(element, key) for key in kind.references}
        yield Element(kind, name, {key: value for key, value in found.items() if isinstance(value, str)})
