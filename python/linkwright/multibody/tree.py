"""A mechanism as a tree of bodies: which joint carries each body, and which loops are left to close.

Guides enter the tree first, since programs close loops at pins only; then pins to the frame, so that chains
are short; then the others. A pin in a slot is a block in the slot, pinned to the pin. The frame of a body has
its x axis along the link, and its origin at the pin that carries it: as a rule the start of the link, as
positions in a machine file have.

Source: Featherstone, *Rigid Body Dynamics Algorithms*, chapter 8 (spanning tree and loop joints).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kinetostatics.places import Scene, left
from linkwright.kinetostatics.wrench import masses, turns_guide
from linkwright.linkages.model.element import Crank, Guide
from linkwright.linkages.model.structure import FRAME, Pair

Kind = Literal["hinge", "slide", "fixed"]


@dataclass(frozen=True)
class Body:
    """A body of the tree, with the joint that carries it."""

    name: str
    parent: str  # body that carries it, or the frame
    kind: Kind
    joint: str  # name of the joint: of the pair; empty if it is fixed to the parent
    point: str  # its origin
    place: Floats  # origin in the parent's frame, (2,) [m]
    turned: float  # its x axis from that of the parent [rad]
    axis: Floats  # of a slide in its own frame, (2,)
    start: float  # start of the link along x, and its length, for pictures [m]
    length: float
    mass: float  # zero for one without mass [kg]
    centre: Floats  # in its own frame, (2,) [m]
    inertia: float  # about its centre [kg m²]


@dataclass(frozen=True)
class Loop:
    """Two points of two bodies that coincide, which closes a loop."""

    name: str
    bodies: tuple[str, str]
    places: tuple[Floats, Floats]  # in the frames of both, (2,) [m]


@dataclass(frozen=True)
class Coupling:
    """A linear relation Σ c·q = 0 of the joints, counted from the initial position: teeth, belt, shaft."""

    name: str
    factors: dict[str, float]  # by joint


@dataclass(frozen=True)
class Tree:
    """A machine at a crank angle as a tree of bodies with loops and couplings."""

    scene: Scene
    crank: str  # joint of the crank that the drive turns
    bodies: dict[str, Body]  # each after the one that carries it
    loops: tuple[Loop, ...]
    couplings: tuple[Coupling, ...]

    def joints(self) -> dict[str, Body]:
        """Bodies by their joints, in the order of the tree."""
        return {body.joint: body for body in self.bodies.values() if body.joint}

    def chain(self, name: str) -> Iterator[Body]:
        """A body and those that carry it, up to the frame."""
        while name != FRAME:
            yield self.bodies[name]
            name = self.bodies[name].parent

    def turning(self, name: str, factor: float = 1.0) -> dict[str, float]:
        """The angle of a body as a sum of joint angles: joint → factor."""
        return {body.joint: factor for body in self.chain(name) if body.kind == "hinge"}

    def local(self, name: str, place: Floats) -> Floats:
        """A place on the plane (2,) in the frame of a body at the initial position."""
        point = "" if name == FRAME else self.bodies[name].point
        return turned(place - place_of(self.scene, point), -angle_of(self.scene, name))


def turned(vector: Floats, angle: float) -> Floats:
    """A vector (2,) turned by an angle."""
    rotated: Floats = np.cos(angle) * vector + np.sin(angle) * left(vector)
    return rotated


def added(*sums: dict[str, float]) -> dict[str, float]:
    """The sum of linear forms; factors of zero are left out."""
    names = dict.fromkeys(name for terms in sums for name in terms)
    total = {name: sum(terms.get(name, 0.0) for terms in sums) for name in names}
    return {name: factor for name, factor in total.items() if factor}


# -- frames --------------------------------------------------------------------------------------------------


def angle_of(scene: Scene, member: str) -> float:
    """Direction of the x axis of a body [rad]; a block has that of what turns its guide."""
    if member == FRAME:
        return 0.0
    if member in scene.structure.members:
        return float(scene.angle(scene.structure.members[member].link)[0])
    return angle_of(scene, carrying(scene, member)[0])


def place_of(scene: Scene, point: str) -> Floats:
    """Initial place of a point, (2,) [m]; the origin of the frame has no name."""
    return np.asarray(scene.point(point)[0])


def guide_body(pair: Pair) -> str:
    """The body that a guide or slot belongs to."""
    return pair.second if pair.kind == "slot" else pair.first


def _has_block(scene: Scene, pair: Pair) -> bool:
    """Whether a block of its own slides there: in a slot, and in the second guide of a crossing."""
    return pair.kind == "slot" or (
        pair.element in scene.mechanism.crossings and pair.name == f"{pair.element}.second"
    )


def is_split(scene: Scene, pair: Pair) -> bool:
    """Whether one body carries a guide and another turns it."""
    return pair.guide is not None and pair.kind == "guide" and turns_guide(pair.guide, scene) != pair.first


# Blocks that stand for a pin in a slot, or in a second guide, are named after the pair.
_BLOCK = ".block"


def carrying(scene: Scene, block: str) -> tuple[str, Pair]:
    """Body that carries a block, and the pair that it stands for."""
    pair = scene.structure.pairs[block.removesuffix(_BLOCK)]
    return guide_body(pair), pair


# -- tree ----------------------------------------------------------------------------------------------------


@dataclass
class _Edge:
    """A pair as a joint of the tree, or as what closes a loop."""

    kind: Kind
    first: str
    second: str
    pair: Pair
    guide: Guide | None = None


def tree(scene: Scene) -> Tree:
    """The tree of a machine whose mechanism has been found suitable (`refusals`)."""
    edges = sorted(_edges(scene), key=_rank)
    kept, closed = _spanning(edges)
    bodies = _bodies(scene, kept)
    cranks = [drive.member for drive in scene.structure.drives if drive.guide is None]
    made = Tree(scene, bodies[cranks[0]].joint, bodies, (), ())
    loops = [*(_loop(made, edge) for edge in closed), *_pins_of_blocks(made)]
    return Tree(scene, made.crank, bodies, tuple(loops), tuple(_couplings(made, cranks)))


def _rank(edge: _Edge) -> int:
    """Guides before pins to the frame before other pins."""
    return 0 if edge.kind != "hinge" else 1 if FRAME in (edge.first, edge.second) else 2


def _edges(scene: Scene) -> Iterator[_Edge]:
    cranks = _one_shaft(scene)
    for pair in scene.structure.pairs.values():
        if _has_block(scene, pair):
            yield _Edge("slide", guide_body(pair), pair.name + _BLOCK, pair, pair.guide)
        elif pair.kind == "guide":
            yield _Edge("slide", pair.first, pair.second, pair, pair.guide)
        elif pair.kind == "pin":
            fixed_to = cranks.get(pair.second) if pair.first == FRAME else None
            if fixed_to is None:
                yield _Edge("hinge", pair.first, pair.second, pair)
            else:
                yield _Edge("fixed", fixed_to, pair.second, pair)


def _one_shaft(scene: Scene) -> dict[str, str]:
    """Cranks on the pivot of the first: one body with it. Crank → first crank."""
    cranks = [drive.member for drive in scene.structure.drives if drive.guide is None]
    first = cranks[0]
    pivot = scene.structure.members[first].point
    return {name: first for name in cranks[1:] if scene.structure.members[name].point == pivot}


def _spanning(edges: list[_Edge]) -> tuple[list[_Edge], list[_Edge]]:
    """Edges of the tree and edges that close loops (Kruskal)."""
    group: dict[str, str] = {}

    def root(name: str) -> str:
        while group.get(name, name) != name:
            name = group[name]
        return name

    kept: list[_Edge] = []
    closed: list[_Edge] = []
    for edge in edges:
        first, second = root(edge.first), root(edge.second)
        (kept if first != second else closed).append(edge)
        group[second] = first
    return kept, closed


def _bodies(scene: Scene, edges: list[_Edge]) -> dict[str, Body]:
    """Bodies from the frame outwards, each followed by all that it carries, as files nest them."""
    bodies: dict[str, Body] = {}
    beside = [(FRAME, edge) for edge in reversed(edges) if FRAME in (edge.first, edge.second)]
    left_over = [edge for edge in edges if FRAME not in (edge.first, edge.second)]
    while beside:
        parent, edge = beside.pop()
        name = edge.second if edge.first == parent else edge.first
        carrier = "" if parent == FRAME else bodies[parent].point
        bodies[name] = _body(scene, name, (parent, carrier), edge)
        beside += [(name, edge) for edge in reversed(left_over) if name in (edge.first, edge.second)]
        left_over = [edge for edge in left_over if name not in (edge.first, edge.second)]
    return bodies


def _body(scene: Scene, name: str, parent: tuple[str, str], edge: _Edge) -> Body:
    """A body on its parent, of which name and origin are given."""
    member, link = scene.structure.members.get(name), scene.links.get(name)
    point = edge.pair.point if member is None or edge.kind == "hinge" else member.point
    own, carrier = angle_of(scene, name), angle_of(scene, parent[0])
    origin = place_of(scene, point)
    axis = np.array([1.0, 0.0])
    if edge.guide is not None:
        axis = turned(np.asarray(scene.direction(edge.guide)[0]), -own)
        # Travel counts as that of what slides, also where this carries its guide.
        axis = -axis if name == edge.first else axis
    mass, centre, inertia = _mass(scene, name, origin)
    return Body(
        name=name,
        parent=parent[0],
        kind=edge.kind,
        joint="" if edge.kind == "fixed" else edge.pair.name,
        point=point,
        place=turned(origin - place_of(scene, parent[1]), -carrier),
        turned=own - carrier,
        axis=axis,
        start=0.0 if link is None else float(turned(place_of(scene, link.start) - origin, -own)[0]),
        length=0.0 if link is None else float(link.length),
        mass=mass,
        centre=turned(centre - origin, -own),
        inertia=inertia,
    )


def _mass(scene: Scene, name: str, origin: Floats) -> tuple[float, Floats, float]:
    """Mass, place of its centre, (2,), and inertia about it; all masses on one body together."""
    own = [mass for mass in masses(scene) if mass.member == name]
    total = float(sum(mass.mass for mass in own))
    places = [np.asarray(mass.centre[0]) for mass in own]
    weighted = sum((mass.mass * place for mass, place in zip(own, places, strict=True)), np.zeros(2))
    centre = weighted / total if total else origin
    inertia = sum(
        mass.inertia + mass.mass * float((place - centre) @ (place - centre))
        for mass, place in zip(own, places, strict=True)
    )
    return total, centre, float(inertia)


# -- loops ---------------------------------------------------------------------------------------------------


def _loop(tree: Tree, edge: _Edge) -> Loop:
    """What closes a loop: a pin between two bodies, or a block in a guide."""
    place = place_of(tree.scene, edge.pair.point)
    return Loop(
        edge.pair.name,
        (edge.first, edge.second),
        (tree.local(edge.first, place), tree.local(edge.second, place)),
    )


def _pins_of_blocks(tree: Tree) -> Iterator[Loop]:
    """The pins of blocks in slots."""
    for pair in tree.scene.structure.pairs.values():
        if _has_block(tree.scene, pair):
            place = place_of(tree.scene, pair.point)
            bodies = (pair.first if pair.kind == "slot" else pair.second), pair.name + _BLOCK
            yield Loop(pair.name, bodies, (tree.local(bodies[0], place), tree.local(bodies[1], place)))


# -- couplings -----------------------------------------------------------------------------------------------


def _couplings(tree: Tree, cranks: list[str]) -> Iterator[Coupling]:
    """Cranks elsewhere on the shaft, linear drivers, teeth and belts, racks."""
    shaft = tree.turning(cranks[0], -1.0)
    for name in cranks[1:]:
        if tree.bodies[name].kind != "fixed":
            yield Coupling(name, added(tree.turning(name), shaft))
    mechanism = tree.scene.mechanism
    for name, driver in mechanism.linear_drivers.items():
        per_radian = (driver.per_turn or 0.0) / (2 * np.pi)
        yield Coupling(name, added(_travel(tree, name), _times(shaft, per_radian)))
    for name, gear in mechanism.gears.items():
        ratio = gear.size_other / gear.size
        ratio = -ratio if gear.kind in ("external", "crossed_belt") else ratio
        terms = [tree.turning(name)]
        terms += [tree.turning(gear.meshes, -ratio)] if gear.meshes is not None else []
        terms += [tree.turning(gear.carrier, ratio - 1.0)] if gear.carrier is not None else []
        yield Coupling(f"{name}.mesh", added(*terms))
    for name, rack in mechanism.racks.items():
        radius = rack.radius if rack.side == "right" else -rack.radius
        terms = [_travel(tree, name), tree.turning(rack.gear, -radius)]
        terms += [tree.turning(rack.guide.on, radius)] if rack.guide.on is not None else []
        yield Coupling(f"{name}.mesh", added(*terms))
    for name, cable in mechanism.cables.items():
        radius = cable.radius if cable.side == "left" else -cable.radius
        yield Coupling(f"{name}.cable", added(_travel(tree, name), tree.turning(cable.link, radius)))


def _travel(tree: Tree, block: str) -> dict[str, float]:
    """Travel of a block along its guide, by its own joint."""
    return {tree.bodies[block].joint: 1.0}


def _times(terms: dict[str, float], factor: float) -> dict[str, float]:
    return {name: factor * value for name, value in terms.items()}


def is_plain(crank: Crank) -> bool:
    """Whether a crank turns with the shaft, without a law of its own."""
    return crank.law is None and not crank.pushed and crank.follows() is None
